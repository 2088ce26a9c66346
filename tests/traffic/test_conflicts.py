"""Post-encroachment times of planned crossings."""

import re
from types import SimpleNamespace
from typing import Any, ClassVar

import pytest

from automotive_cosim.traffic.conflicts import LOOK_S, Conflicts

LENGTH_M, WIDTH_M = 5.0, 1.8
SPAN_M = 20.0
"""Lanes inside the junction; those that cross do so in their middles."""


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
