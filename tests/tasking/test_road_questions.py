"""Questions about the car in front, the range and the speed that an alert names, on moments made by hand."""

from types import SimpleNamespace
from typing import Any

import pytest

from automotive_cosim.cockpit.signals import ENERGY
from automotive_cosim.contracts import (
    KMH_PER_MPS,
    NO_LIMIT,
    AlertKind,
    Limit,
    LimitSource,
    OtherVehicle,
    PullOver,
    Reroute,
    RoadRequest,
    SlowDown,
    TrafficLight,
)
from automotive_cosim.tasking.checks import AlertGiven, road_asked
from automotive_cosim.tasking.triggers import (
    green_light,
    leader_brakes,
    leader_is,
    out_of_range,
    red_light,
    slow_leader_within,
)


def moment(leader: OtherVehicle | None = None, range_m: float = 0.0, left_m: float = 0.0) -> Any:
    driving = SimpleNamespace(around=SimpleNamespace(leader=leader), ahead=SimpleNamespace(route_left_m=left_m))
    return SimpleNamespace(driving=driving, signals={ENERGY.RANGE.path: range_m})


def alerted(*given: dict[str, Any]) -> Any:
    return SimpleNamespace(commands={"alerts": list(given)})


def asked(*requests: RoadRequest) -> Any:
    return SimpleNamespace(commands={"requests": list(requests)})


@pytest.mark.parametrize(
    ("gap_m", "speed_mps", "holds"),
    [(100.0, 0.0, True), (100.0, 5.0, True), (100.0, 9.0, False), (201.0, 0.0, False)],
)
def test_a_slow_leader_is_near_and_slow(gap_m: float, speed_mps: float, holds: bool):
    slow = slow_leader_within(25.0, 200.0)
    assert slow(moment(OtherVehicle("other", gap_m, speed_mps, None))) is holds
    assert not slow(moment())


def test_what_leads_is_told_by_its_class_and_its_brake_lamps():
    lorry = moment(OtherVehicle("other", 40.0, 20.0, None, kind="truck", is_braking=True))
    assert leader_is("truck", 40.0)(lorry)
    assert not leader_is("passenger", 40.0)(lorry)
    assert not leader_is("truck", 39.0)(lorry)
    assert leader_brakes(40.0)(lorry)
    assert not leader_brakes(40.0, False)(lorry)
    assert not leader_brakes(39.0)(lorry)
    assert not any(holds(moment()) for holds in (leader_is("truck", 40.0), leader_brakes(40.0, False)))


@pytest.mark.parametrize(
    ("state", "is_red", "is_green"), [("r", True, False), ("G", False, True), ("y", False, False)]
)
def test_a_signal_is_red_or_green_or_neither(state: str, is_red: bool, is_green: bool):
    now = moment()
    now.driving.ahead.next_light = TrafficLight("light", state, 50.0)
    assert (red_light(60.0)(now), green_light(60.0)(now)) == (is_red, is_green)
    assert not red_light(49.0)(now)
    assert not green_light(49.0)(now)


def test_out_of_range_compares_with_the_way_left():
    assert out_of_range()(moment(range_m=9_000.0, left_m=9_001.0))
    assert not out_of_range()(moment(range_m=9_000.0, left_m=9_000.0))


@pytest.mark.parametrize(
    ("advised_kmh", "may_be_silent", "must_advise"),
    [(None, True, False), (32.0, True, True), (32.19, True, True), (40.0, False, False)],
)
def test_an_alert_names_the_speed_where_no_sign_does(
    advised_kmh: float | None, may_be_silent: bool, must_advise: bool
):
    start, now = alerted(), alerted({"kind": AlertKind.SPEED, "speed_kmh": advised_kmh})
    assert AlertGiven(AlertKind.SPEED, 32.2).holds(start, now, [now]) is may_be_silent
    assert AlertGiven(AlertKind.SPEED, 32.2, must_advise=True).holds(start, now, [now]) is must_advise


@pytest.mark.parametrize(
    ("limit_kmh", "advised_kmh", "is_right"),
    [(50.0, None, True), (50.0, 30.0, True), (50.0, 50.0, True), (50.0, 70.0, False), (None, 120.0, True)],
)
def test_an_alert_that_asks_for_no_speed_may_advise_any_that_is_allowed(
    limit_kmh: float | None, advised_kmh: float | None, is_right: bool
):
    start, now = alerted(), alerted({"kind": AlertKind.YIELD, "speed_kmh": advised_kmh})
    limit = NO_LIMIT if limit_kmh is None else Limit(limit_kmh / KMH_PER_MPS, LimitSource.POSTED)
    now.driving = SimpleNamespace(road=SimpleNamespace(limit=limit))
    assert AlertGiven(AlertKind.YIELD).holds(start, now, [now]) is is_right


@pytest.mark.parametrize(
    ("requests", "any_reroute", "that_reroute"),
    [
        ((), False, False),
        ((Reroute("A 4"),), True, True),
        ((Reroute("A 44"),), True, False),
        ((Reroute(edges=("A 4",)),), True, False),
        ((PullOver(),), False, False),
        ((Reroute("A 4"), Reroute("A 4")), False, False),
    ],
)
def test_a_request_counts_by_its_class_or_as_it_is(
    requests: tuple[RoadRequest, ...], any_reroute: bool, that_reroute: bool
):
    before = SlowDown(30.0)
    start, now = asked(before), asked(before, *requests)
    assert road_asked(Reroute).holds(start, now, [now]) is any_reroute
    assert road_asked(Reroute("A 4")).holds(start, now, [now]) is that_reroute
