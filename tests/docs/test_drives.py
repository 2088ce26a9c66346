"""docs/drives.md names every family and every stunt as they are."""

from __future__ import annotations

from pathlib import Path

from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.staging import STUNTS

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
