"""Surrogate measures of safety: time to collision, DRAC and PET of the ego."""

import re
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest
from shapely import LineString, Point

from automotive_cosim.scenarios import Scenario, Trip
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.instant import packed_other
from automotive_cosim.traffic.records import make_other
from tests.traffic.in_process import InProcess

Variant = Callable[[Callable[[Path], None]], Scenario]


@pytest.mark.parametrize(("gap_m", "closing_mps"), [(10.0, 5.0), (40.0, 0.5), (3.0, 12.0)])
def test_braking_at_the_drac_just_avoids_the_crash(gap_m: float, closing_mps: float) -> None:
    seen = make_other(*packed_other("v", gap_m, 3.0, closing_mps))
    assert seen.drac_mps2 is not None
    assert seen.time_to_collision_s is not None
    assert closing_mps**2 / (2 * seen.drac_mps2) == pytest.approx(gap_m)
    assert seen.time_to_collision_s * closing_mps == pytest.approx(gap_m)


def test_who_falls_behind_is_no_danger() -> None:
    for closing_mps in (0.0, -3.0):
        seen = make_other(*packed_other("v", 5.0, 10.0, closing_mps))
        assert (seen.time_to_collision_s, seen.drac_mps2) == (None, None)
    assert make_other(*packed_other("v", -1.0, 10.0, 2.0)).drac_mps2 is not None, "finite when they touch"


def crossing_traffic(folder: Path) -> None:
    """A stream over the avenue, which has priority."""
    (folder / "grid.rou.xml").write_text("""<routes>
        <flow id="across" begin="0" end="900" period="4" departSpeed="max"><route edges="n2c2 c2s2"/></flow>
        </routes>""")


@pytest.mark.sumo
def test_crossing_times_are_those_of_the_drive(variant: Variant, hurried: EgoPlan) -> None:
    """Each PET that is told equals the one found by looking at SUMO on every step."""
    import libsumo

    passages: dict[str, list[tuple[float, float, float]]] = {}
    told = {}
    with closing(InProcess(variant(crossing_traffic), seed=1)) as simulation:
        traffic = simulation.depart(replace(hurried, driver="average"))
        while traffic.state.end is None and traffic.state.time_s < 400.0:
            drive = traffic.advance(0.1)
            told |= {event.text: event.time_s for event in drive.events if event.kind == "pet"}
            for vehicle in libsumo.vehicle.getIDList():
                x_m, y_m = libsumo.vehicle.getPosition(vehicle)
                passages.setdefault(vehicle, []).append((traffic.state.time_s, x_m, y_m))
    assert told
    for text in told:
        match = re.fullmatch(
            r"the ego crosses ([\d.]+) s (before|after) vehicle (\S+) \((-?[\d.]+) s by swept area\)", text
        )
        assert match
        pet_s, order, other = float(match[1]), match[2], match[3]
        own, foe = passages["ego"], passages[other]
        first, second = (own, foe) if order == "before" else (foe, own)
        ways = [LineString([(x, y) for _, x, y in rows]) for rows in (first, second)]
        point = Point(ways[0].intersection(ways[1]).representative_point())
        reached = [
            min(((Point(x, y).distance(point), time_s, index) for index, (time_s, x, y) in enumerate(rows)))
            for rows in (first, second)
        ]
        length_m = 4.5 if order == "before" else 5.0
        behind = first[reached[0][2] :]
        left_s = next((time_s for time_s, x, y in behind if Point(x, y).distance(point) >= length_m), behind[-1][0])
        assert reached[1][1] - left_s == pytest.approx(pet_s, abs=0.6)


def test_a_drive_alone_has_no_conflicts(forked: Forked, variant: Variant, hurried: EgoPlan) -> None:
    def empty(folder: Path) -> None:
        (folder / "grid.rou.xml").write_text("<routes/>")

    round_trip = replace(hurried, driver="calm", trip=Trip("round", "sws0", "s0sw", ("s3s4", "n4n3", "n1n0")))
    kinds = []
    for simulation in (forked, Forked(variant(empty), seed=1)):
        with closing(simulation.depart(round_trip)) as traffic:
            kinds.append([event.kind for event in traffic.advance(400.0).events])
    simulation.close()
    assert "pet" in kinds[0]
    assert not kinds[1]
