"""docs/drives.md names every family, stunt, kind of event and wake as they are."""

from __future__ import annotations

from pathlib import Path

from automotive_cosim.drives.events import KINDS
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.staging import STUNTS
from automotive_cosim.drives.wakes import WAKES

PAGE = (Path(__file__).parents[2] / "docs" / "drives.md").read_text("utf-8")


def test_every_family_has_its_line() -> None:
    listed = [line for line in PAGE.splitlines() if line.startswith("| `")]
    assert listed == [
        f"| `{family.id}` | {family.season} | {family.about} | {', '.join(family.cast)} |"
        for family in FAMILIES.values()
    ]


def test_every_stunt_is_described() -> None:
    described = {
        kind for line in PAGE.splitlines() if line.startswith("| ") for kind in line.split("|")[1].split(", ")
    }
    assert {kind.strip() for kind in described} >= STUNTS.keys()


def test_every_kind_of_event_has_its_line() -> None:
    for kind in KINDS.values():
        alerts = ", ".join(sorted(kind.alerts)) or "words, or the switch"
        line = f"| {kind.name} | {kind.about} | {kind.bait} | {kind.source} | {kind.weight:g} | {alerts} |"
        assert line in PAGE.splitlines()


def test_all_that_wakes_has_its_line() -> None:
    assert all(f"| {wake.name} | {wake.about} |" in PAGE.splitlines() for wake in WAKES)
