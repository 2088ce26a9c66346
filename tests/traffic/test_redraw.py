"""Another day of the same demand: who travels differs by seed, what has a timetable does not."""

import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from automotive_cosim import scenarios
from automotive_cosim.traffic.options import Setup, copied, read_configuration, run_options
from automotive_cosim.traffic.redraw import WINDOW_S, redraw

TRIPS = 2000
DEMAND = f"""<routes>
    <vType id="car"/>
    <route id="r" edges="a b"/>
    <flow id="f" begin="50" end="900" period="7" route="r"/>
    <vehicle id="bus" type="car" line="7" depart="1000" route="r"/>
    <vehicle id="late" type="car" depart="1000"><route edges="a b"/><stop lane="a_0" duration="20"/></vehicle>
    <vehicle id="waits" type="car" depart="triggered" route="r"/>
    {"".join(f'<trip id="t{n}" type="car" depart="{n}" from="a" to="b"/>' for n in range(TRIPS))}
</routes>"""


@pytest.fixture
def demand(tmp_path: Path) -> Path:
    path = tmp_path / "demand.rou.xml"
    path.write_text(DEMAND)
    return path


def elements(path: Path) -> list[ET.Element]:
    return list(ET.parse(path).getroot())


def test_a_day_is_its_seeds(demand: Path, tmp_path: Path) -> None:
    days = [redraw(demand, tmp_path / f"{n}.xml", seed).read_bytes() for n, seed in enumerate((1, 1, 2))]
    assert days[0] == days[1] != days[2]


def test_trips_are_drawn_once_on_average_near_their_time(demand: Path, tmp_path: Path) -> None:
    found = [each for each in elements(redraw(demand, tmp_path / "day.xml", 3)) if each.tag == "trip"]
    assert len(found) == pytest.approx(TRIPS, abs=4 * TRIPS**0.5)
    assert len({each.attrib["id"] for each in found}) == len(found)
    taken = {each.attrib["id"].partition(".")[0] for each in found}
    assert len(taken) / TRIPS == pytest.approx(1 - np.exp(-1), abs=0.05), "more than a third stays at home"
    for each in found:
        meant_s = float(each.attrib["id"].partition(".")[0][1:])
        assert float(each.attrib["depart"]) >= 0
        assert abs(float(each.attrib["depart"]) - meant_s) <= WINDOW_S + 0.01


def test_what_has_a_timetable_or_draws_by_itself_stays(demand: Path, tmp_path: Path) -> None:
    before, after = elements(demand), elements(redraw(demand, tmp_path / "day.xml", 4))
    kept = {each.attrib["id"]: ET.tostring(each).strip() for each in before if each.tag != "trip"}
    assert {each.attrib["id"]: ET.tostring(each).strip() for each in after if each.tag != "trip"} == kept


def test_departures_are_in_order_after_the_types(demand: Path, tmp_path: Path) -> None:
    after = elements(redraw(demand, tmp_path / "day.xml", 5))
    assert [each.tag for each in after[:2]] == ["vType", "route"]
    times_s = [
        float(each.get("depart", each.get("begin", ""))) for each in after[2:] if each.get("depart") != "triggered"
    ]
    assert times_s == sorted(times_s)


def test_a_scenario_that_redraws_reads_another_day_for_every_seed(demand: Path, tmp_path: Path) -> None:
    grid = scenarios.load("grid")
    other = replace(grid, sumo=replace(grid.sumo, redraws_trips=True))
    configuration = read_configuration(grid.config)
    own = replace(configuration, files={**configuration.files, "route-files": (demand,)})

    def route_file(scenario: scenarios.Scenario, seed: int) -> bytes:
        scratch = tmp_path / f"{scenario.sumo.redraws_trips}-{seed}"
        scratch.mkdir(exist_ok=True)
        return (scratch / run_options(copied(own, scratch), Setup(scenario, seed))["route-files"]).read_bytes()

    assert route_file(grid, 1) == route_file(grid, 2) == demand.read_bytes()
    assert len({route_file(other, 1), route_file(other, 2), demand.read_bytes()}) == 3
