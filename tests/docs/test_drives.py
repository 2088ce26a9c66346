"""docs/reference/drives.md describes every staging and what a driver does after an alert, as they are."""

from pathlib import Path

from automotive_cosim.contracts import AlertKind
from automotive_cosim.drives.staging import STAGED
from automotive_cosim.traffic.ego import (
    BELT_KINDS,
    BRAKING_MPS2,
    EASING_MPS2,
    GAP_KINDS,
    ROOM_KINDS,
    SAFE_HEADWAY_S,
    SPEED_KINDS,
    VIEW_KINDS,
    WAKING_KINDS,
)
from automotive_cosim.traffic.profiles import PROFILES

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "drives.md").read_text("utf-8")


def test_every_staging_is_described() -> None:
    described = {
        kind for line in PAGE.splitlines() if line.startswith("| ") for kind in line.split("|")[1].split(", ")
    }
    assert {kind.strip() for kind in described} >= STAGED


def test_what_a_driver_does_after_each_alert_is_told() -> None:
    begun = PAGE.split("## What a warning does", 1)[1].split("\n## ", 1)[0]
    rows = [line.split("|")[1:3] for line in begun.splitlines() if line.startswith("| ")][1:]
    told = (SPEED_KINDS, GAP_KINDS, ROOM_KINDS, WAKING_KINDS, VIEW_KINDS, BELT_KINDS)
    noted = frozenset(AlertKind).difference(*told)
    assert [kinds.strip() for kinds, _ in rows] == [", ".join(sorted(kinds)) for kinds in (*told, noted)]
    assert f"at {EASING_MPS2:g} m/s2, after a critical alert at {BRAKING_MPS2:g} m/s2" in rows[0][1]
    assert SAFE_HEADWAY_S == 2.0
    assert "two seconds" in rows[1][1]
    reactions_s = [each.reaction_s for each in PROFILES.values()]
    assert f"a median of {min(reactions_s)} to {max(reactions_s)} s" in begun
    follows = [100 * each.compliance for each in PROFILES.values()]
    assert f"follows {min(follows):.0f} to {max(follows):.0f} % of the alerts" in begun
