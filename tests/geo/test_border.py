"""A drive in SUMO across the Irish border: sign, unit and lamp rules change in the second the line is crossed."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pytest
import sumolib

from automotive_cosim import geo as geography
from automotive_cosim import scenarios
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.cosim.simulation import TICK_S, couple
from automotive_cosim.geo.place import NEAR_BORDER_M
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Simulations

LINES = {"north": "line.n", "south": "line.s", "old_road": "old_line"}
"""The junction on the border, by trip."""
LAW = {"IE": "IE", "GB": "GB-NIR"}
"""Whose lamp rules apply, by country."""


@dataclass(frozen=True)
class Crossing:
    moments: tuple[Moment, ...]
    left_hand: bool
    """Of SUMO's network."""
    crossed_s: float
    """When SUMO's car passed the line, to a tenth of a second."""

    @property
    def before(self) -> Moment:
        """The last moment well before the line."""
        return next(moment for moment in reversed(self.moments) if moment.time_s < self.crossed_s - 2)

    @property
    def after(self) -> Moment:
        """The first moment well after it."""
        return next(moment for moment in self.moments if moment.time_s > self.crossed_s + 2)


@pytest.fixture(scope="module")
def line_y_m() -> dict[str, float]:
    """The y of each trip's line, network coordinates. The roads run north there."""
    folder = scenarios.load("border").folder
    net = sumolib.net.readNet(str(folder / "border.net.xml.gz"))
    return {trip: net.getNode(node).getCoord()[1] for trip, node in LINES.items()}


@pytest.fixture(scope="module")
def cross(simulations: Simulations, line_y_m: dict[str, float]) -> Callable[[str], Crossing]:
    done: dict[str, Crossing] = {}

    def drive(trip: str) -> Crossing:
        if trip not in done:
            done[trip] = _drive(simulations, trip, line_y_m[trip])
        return done[trip]

    return drive


def _drive(simulations: Simulations, trip: str, line_y_m: float) -> Crossing:
    scenario = scenarios.load("border")
    scenario = replace(scenario, sumo=replace(scenario.sumo, warm_up_s=60.0))
    traffic = simulations.warm(scenario, 5).depart(EgoPlan(scenario.trip(trip), seed=5))
    cockpit = Cockpit(traffic.network, rng=np.random.default_rng(1))
    world = couple(
        traffic,
        cockpit,
        scenario,
        gps_rng=np.random.default_rng(2),
        weather=scenario.weather,
        departure=scenario.start,
    )
    moments = [world.moment]
    while not moments[-1].driving.end and (moments[-1].context.country == moments[0].context.country):
        moments += world.advance(TICK_S)
    moments += world.advance(60.0)
    world.close()
    states = [state for moment in moments for state in moment.passed]
    crossed_s = next(
        after.time_s for before, after in pairwise(states) if (before.y_m - line_y_m) * (after.y_m - line_y_m) <= 0
    )
    return Crossing(tuple(moments), traffic.network.left_hand, crossed_s)


@pytest.mark.parametrize("trip", LINES)
def test_law_and_sign_change_in_the_second_the_line_is_crossed(cross: Callable[[str], Crossing], trip: str) -> None:
    crossing = cross(trip)
    countries = [moment.context.country for moment in crossing.moments]
    changes = [
        after for before, after in pairwise(crossing.moments) if before.context.country != after.context.country
    ]
    assert {countries[0], countries[-1]} == {"IE", "GB"}
    assert len(changes) == 1, "the law changes once and stays"
    # The receiver is off by some metres, a tick is one second.
    assert changes[0].time_s == pytest.approx(crossing.crossed_s, abs=TICK_S + 0.5)
    signs = [
        after
        for before, after in pairwise(crossing.moments)
        if before.driving.road.limit.mps != after.driving.road.limit.mps
    ]
    assert min(abs(sign.time_s - crossing.crossed_s) for sign in signs) <= TICK_S + 0.5


@pytest.mark.parametrize(
    ("trip", "before", "after"),
    [
        ("north", "100 km/h (posted on N1)", "70 mph (posted on A1)"),
        ("south", "70 mph (posted on A1)", "100 km/h (posted on N1)"),
        ("old_road", "80 km/h (posted on Old Dublin Road)", "60 mph (posted on Dublin Road)"),
    ],
)
def test_the_limit_is_told_in_the_countrys_unit(
    cross: Callable[[str], Crossing], trip: str, before: str, after: str
) -> None:
    crossing = cross(trip)
    assert f"Speed limit here: {before}" in crossing.before.context.text()
    assert f"Speed limit here: {after}" in crossing.after.context.text()
    units = [moment.context.speed_unit for moment in (crossing.before, crossing.after)]
    assert units == [before.split()[1], after.split()[1]]


@pytest.mark.parametrize("trip", LINES)
def test_the_lamp_rules_change_in_falling_snow(cross: Callable[[str], Crossing], trip: str) -> None:
    """1500 m of sight: Ireland allows fog lamps in falling snow, the United Kingdom under about 100 m only."""
    expected = {"IE": "allowed", "GB": "forbidden"}
    for moment in cross(trip).moments:
        for topic in ("front_fog", "rear_fog"):
            rule = moment.context.rule(topic)
            assert rule is not None
            assert rule.value == expected[moment.context.country]
            assert rule.rule.id == f"{LAW[moment.context.country]}.{topic}"


def test_the_border_is_flagged_near_it_only(cross: Callable[[str], Crossing], line_y_m: dict[str, float]) -> None:
    """The coast is a border of no country: farther out nothing is near."""
    for moment in cross("north").moments:
        far_m = abs(moment.driving.y_m - line_y_m["north"])
        other = {"IE": "GB", "GB": "IE"}[moment.context.country]
        if far_m < 0.9 * NEAR_BORDER_M:
            assert other in moment.context.place.near_border_to
        if far_m > 5 * NEAR_BORDER_M:
            assert moment.context.place.near_border_to == ()


def test_a_lamp_left_on_is_broken_from_the_line_on(cross: Callable[[str], Crossing]) -> None:
    """The same fog lamps, never touched: lawful south of the line, an interval that begins at it to the north."""
    crossing = cross("north")
    on = {"Vehicle.Body.Lights.Fog.Front.IsOn": True, "Vehicle.Body.Lights.Fog.Rear.IsOn": True}
    lit = [replace(moment, signals={**moment.signals, **on}) for moment in crossing.moments]
    lamps = [found for found in geography.violations(lit) if found.rule.endswith("_fog")]
    assert {found.rule for found in lamps} == {"GB-NIR.front_fog", "GB-NIR.rear_fog"}
    for found in lamps:
        assert found.from_s == pytest.approx(crossing.crossed_s, abs=TICK_S + 0.5)
        assert found.to_s == crossing.moments[-1].time_s


@pytest.mark.parametrize("trip", LINES)
def test_both_sides_keep_left_on_paper_and_on_the_road(cross: Callable[[str], Crossing], trip: str) -> None:
    crossing = cross(trip)
    assert crossing.left_hand
    assert {law.driving_side for moment in crossing.moments if (law := moment.context.place.law)} == {"left"}
