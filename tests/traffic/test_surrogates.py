"""Surrogate measures by plans whose outcome is known, and post-encroachment times of planned crossings."""

from __future__ import annotations

import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar
from xml.etree import ElementTree

import pytest

from automotive_cosim.measures.formulas import (
    crossing_time_to_collision_s,
    drac_mps2,
    mdrac_mps2,
    time_exposed,
    time_to_collision_s,
)
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.conflicts import LOOK_S, Conflicts
from automotive_cosim.traffic.sumo import load_library, start

LENGTH_M, WIDTH_M = 5.0, 1.8
SPAN_M = 20.0
"""Lanes inside the junction; those that cross do so in their middles."""


@pytest.mark.parametrize(
    ("gap_m", "ttc_s", "drac", "mdrac"), [(99.0, 9.9, 0.505, 0.562), (39.0, 3.9, 1.282, 1.724)]
)
def test_twenty_behind_ten_metres_per_second(gap_m: float, ttc_s: float, drac: float, mdrac: float) -> None:
    """The figures are those of SUMO's SSM device."""
    assert time_to_collision_s(gap_m, 10.0) == pytest.approx(ttc_s)
    assert drac_mps2(gap_m, 10.0) == pytest.approx(drac, abs=5e-4)
    assert mdrac_mps2(gap_m, 10.0) == pytest.approx(mdrac, abs=5e-4)


@pytest.mark.sumo
def test_following_is_measured_as_by_the_ssm_device(tmp_path: Path) -> None:
    """The least TTC, the largest DRAC and MDRAC of an approach, from the states beside the device."""
    (tmp_path / "r.nod.xml").write_text('<nodes><node id="a" x="0" y="0"/><node id="b" x="2000" y="0"/></nodes>')
    (tmp_path / "r.edg.xml").write_text('<edges><edge id="ab" from="a" to="b" numLanes="1" speed="30"/></edges>')
    files = ("-n", tmp_path / "r.nod.xml", "-e", tmp_path / "r.edg.xml", "-o", tmp_path / "r.net.xml")
    built, printed = sumo_programs.run("netconvert", files)
    assert built, printed
    device = {
        "has.ssm.device": "true",
        "device.ssm.measures": "TTC DRAC MDRAC",
        "device.ssm.thresholds": "30 0.1 0.1",
        "device.ssm.range": "300",
        "device.ssm.mdrac.prt": "1",
        "device.ssm.file": str(tmp_path / "ssm.xml"),
    }
    given = "".join(f'<param key="{key}" value="{value}"/>' for key, value in device.items())
    (tmp_path / "r.rou.xml").write_text(
        '<routes><vType id="t" speedFactor="1" speedDev="0" sigma="0"/><route id="r" edges="ab"/>'
        '<vehicle id="lead" type="t" route="r" depart="0" departPos="200" departSpeed="10"/>'
        f'<vehicle id="back" type="t" route="r" depart="0" departPos="96" departSpeed="20">{given}</vehicle>'
        "</routes>"
    )
    sumo = load_library()
    start(
        sumo,
        [
            *("sumo", "-n", str(tmp_path / "r.net.xml"), "-r", str(tmp_path / "r.rou.xml")),
            *("--step-length", "0.1", "--no-step-log", "--no-warnings"),
        ],
    )
    try:
        sumo.step()
        for vehicle, speed_mps in (("lead", 10.0), ("back", 20.0)):
            sumo.vehicle.setSpeedMode(vehicle, 0)
            sumo.vehicle.setSpeed(vehicle, speed_mps)
        pairs = []
        for step in range(90):
            sumo.step()
            gap_m = sumo.lane_position("lead") - sumo.length("lead") - sumo.lane_position("back")
            pairs.append((gap_m, sumo.speed("back") - sumo.speed("lead")))
            if step == 60:
                sumo.vehicle.setSpeed("back", 10.0)
        sumo.vehicle.remove("back")
        sumo.step()
    finally:
        sumo.close()
    (conflict,) = ElementTree.parse(tmp_path / "ssm.xml").getroot()
    measured = {child.tag: float(child.attrib["value"]) for child in conflict}
    reckoned = {
        "minTTC": min(filter(None, (time_to_collision_s(*pair) for pair in pairs))),
        "maxDRAC": max(filter(None, (drac_mps2(*pair) for pair in pairs))),
        "maxMDRAC": max(filter(None, (mdrac_mps2(*pair) for pair in pairs))),
    }
    assert reckoned == pytest.approx(measured, abs=0.006)


def test_without_closing_or_time_to_react_there_is_none() -> None:
    assert time_to_collision_s(10.0, 0.0) is drac_mps2(10.0, -1.0) is mdrac_mps2(10.0, 0.0) is None
    assert mdrac_mps2(10.0, 10.0) is None
    assert drac_mps2(0.0, 10.0) is None


def test_constant_closing_exposes_for_the_time_below_the_threshold() -> None:
    step_s, threshold_s, nearest_s = 0.001, 3.0, 0.5
    steps = [(i * step_s, 5.0 - i * step_s) for i in range(round((5.0 - nearest_s) / step_s) + 1)]
    tet_s, tit_s2 = time_exposed(steps, threshold_s)
    assert tet_s == pytest.approx(threshold_s - nearest_s, abs=2 * step_s)
    assert tit_s2 == pytest.approx((threshold_s - nearest_s) ** 2 / 2, abs=0.01)
    assert time_exposed([(0.0, None), (1.0, 9.0)], threshold_s) == (0.0, 0.0)


def test_a_crossing_collides_if_the_first_is_still_there() -> None:
    assert crossing_time_to_collision_s((5.0, 5.0), (12.0, 10.0), LENGTH_M) == pytest.approx(1.2)
    assert crossing_time_to_collision_s((5.0, 10.0), (12.0, 10.0), LENGTH_M) is None
    assert crossing_time_to_collision_s((5.0, 0.0), (12.0, 10.0), LENGTH_M) is None


class Junction:
    """SUMO at one junction: straight on or right, from the west and from the south."""

    SHAPES: ClassVar = {
        ":c_0_0": ((-10.0, 0.0), (10.0, 0.0)),
        ":c_1_0": ((0.0, -10.0), (0.0, 10.0)),
        ":c_2_0": ((-10.0, 0.0), (-2.0, 0.0), (0.0, -10.0)),
        ":c_3_0": ((0.0, -10.0), (2.0, -2.0), (10.0, 0.0)),
    }
    LINKS: ClassVar = {
        "w_0": (("e_0", ":c_0_0"), ("s_0", ":c_2_0")),
        "so_0": (("n_0", ":c_1_0"), ("e_0", ":c_3_0")),
    }

    def __init__(self) -> None:
        self.others: dict[str, dict[str, tuple[float, float]]] = {}
        """Position and speed of vehicles by lane and id."""
        self.lane = SimpleNamespace(
            getLength=lambda lane: SPAN_M,
            getShape=self.SHAPES.__getitem__,
            getInternalFoes=lambda lane: tuple(other for other in self.SHAPES if other != lane),
            getLastStepVehicleIDs=lambda lane: tuple(self.others.get(lane, ())),
            getLinks=lambda lane: tuple(
                (to, True, True, True, via, "M", "s", SPAN_M) for to, via in self.LINKS.get(lane, ())
            ),
        )
        self.junction = SimpleNamespace(getIncomingEdges=lambda junction: ("w", "so", ":c_0"))
        self.edge = SimpleNamespace(getLaneNumber=lambda edge: 1)
        self.vehicle = SimpleNamespace(getWidth=lambda vehicle: WIDTH_M)

    def length(self, vehicle: str) -> float:
        return LENGTH_M

    def lane_position(self, vehicle: str) -> float:
        return self._of(vehicle)[0]

    def speed(self, vehicle: str) -> float:
        return self._of(vehicle)[1]

    def _of(self, vehicle: str) -> tuple[float, float]:
        return next(known[vehicle] for known in self.others.values() if vehicle in known)


def told(ego_lane: str, ego: tuple[float, float], foe_lane: str, foe: tuple[float, float]) -> list[str]:
    """What is told of a drive at constant speeds; each enters its lane at a time with a speed."""
    sumo: Any = Junction()
    conflicts = Conflicts(sumo, "ego")
    words: list[str] = []
    for look in range(60):
        time_s = look * LOOK_S
        ego_m, foe_m = ((time_s - entered_s) * speed_mps for entered_s, speed_mps in (ego, foe))
        sumo.others = {foe_lane: {"foe": (foe_m, foe[1])}} if 0 <= foe_m <= SPAN_M else {}
        inside = 0 <= ego_m <= SPAN_M
        before = "w_0" if ego_m < 0 else "beyond_0"
        now: Any = SimpleNamespace(
            time_s=time_s,
            lane_id=ego_lane if inside else before,
            edge_id=":c_0" if inside else before.removesuffix("_0"),
            lane_position_m=ego_m if inside else 0.0,
            speed_mps=ego[1],
            route=SimpleNamespace(edge_ids=(before, "beyond")),
            index=0,
        )
        links = (("e_0", True, True, True, ego_lane),) if ego_m < 0 else ()
        sumo.vehicle.getNextLinks = lambda _, links=links: links
        words += [event.text for event in conflicts.look(now)]
    return words


@pytest.mark.parametrize(
    ("first_mps", "second_mps", "point_s", "swept_s"),
    [
        (10.0, 10.0, 2.0, 1.82),
        (12.0, 8.571, 2.0, 1.82),
        (10.0, 18.0, 2.5, 2.36),
        (5.0, 15.0, 3.0, 2.76),
        (10.0, 10.0, 0.7, 0.52),
    ],
)
@pytest.mark.parametrize("order", ["before", "after"])
def test_planned_crossings_come_out_to_a_step(
    order: str, first_mps: float, second_mps: float, point_s: float, swept_s: float
) -> None:
    """At the point as planned, by swept area as SUMO's SSM device measures it."""
    first = (2.0, first_mps)
    left_s = first[0] + (SPAN_M / 2 + LENGTH_M) / first_mps
    second = (left_s + point_s - SPAN_M / 2 / second_mps, second_mps)
    ego, foe = (first, second) if order == "before" else (second, first)
    (words,) = told(":c_0_0", ego, ":c_1_0", foe)
    match = re.fullmatch(rf"the ego crosses ([\d.]+) s {order} vehicle foe \(([\d.]+) s by swept area\)", words)
    assert match
    assert float(match[1]) == pytest.approx(point_s, abs=0.1)
    assert float(match[2]) == pytest.approx(swept_s, abs=0.1)


def test_who_comes_from_the_same_lane_crosses_nobody() -> None:
    assert told(":c_0_0", (4.0, 10.0), ":c_2_0", (2.0, 10.0)) == []


def test_who_leads_to_the_same_lane_merges() -> None:
    (words,) = told(":c_0_0", (6.0, 10.0), ":c_3_0", (2.0, 10.0))
    assert words.startswith("the ego merges ")
