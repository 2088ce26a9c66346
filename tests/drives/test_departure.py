"""Drives in SUMO: they depart as planned, never arrive, and can be copied."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from hashlib import sha256
from itertools import pairwise
from typing import Any

import pytest

from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.pois import Gazetteer
from automotive_cosim.cockpit.signals import BODY, CABIN, CALL, LIGHTS, MOTION, OCCUPANT, SEAT, Signal
from automotive_cosim.contracts import KMH_PER_MPS, Alert, AlertKind, IncidentKind, SightKind, Weather
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.cosim.simulation import CoSimulation
from automotive_cosim.drives.departure import depart, departed_on_a_free_road
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.script import DriveScript
from automotive_cosim.errors import NoRoomError, ScenarioError, UnknownNameError
from automotive_cosim.formats.incidents import AheadIncident, EmergencyVehicle
from automotive_cosim.interface.trace import canonical, plain
from automotive_cosim.scenarios import Trip, WeatherAt
from automotive_cosim.traffic.base import DriverAt, EgoPlan
from automotive_cosim.traffic.ego import BUCKLES, CLEARS_VIEW, WAKES_UP
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.traffic.rounds import loop_with
from tests.drives.scenes import found

DRY = Weather(16.0, 60.0, 0.0, 1, 20.0, 24000.0, 8.0)
LAPS = DriveScript(
    family="laps",
    seed=1,
    scenario="grid",
    trips=("tunnel", "round", "avenue"),
    duration_s=600.0,
    start="2026-06-09T08:30:00",
    weather=(WeatherAt(0.0, DRY),),
)


REACTIONS = frozenset({WAKES_UP, CLEARS_VIEW, BUCKLES})


@contextmanager
def departed(script: DriveScript, simulations: Simulations) -> Iterator[CoSimulation]:
    world = depart(script, simulations)
    try:
        yield world
    finally:
        world.close()


def driven(script: DriveScript, simulations: Simulations, for_s: float) -> tuple[Moment, ...]:
    with departed(script, simulations) as world:
        return (world.moment, *world.advance(for_s))


def digest(moments: tuple[Moment, ...]) -> str:
    parts = (canonical([plain(moment.driving), dict(moment.signals), plain(moment.sights)]) for moment in moments)
    return sha256(b"".join(parts)).hexdigest()


@pytest.mark.slow
@pytest.mark.parametrize(("family", "seed"), [("beauce_june", 0), ("nordic_july", 2)])
def test_one_can_drive_on_from_every_place(simulations: Simulations, family: str, seed: int) -> None:
    with departed(FAMILIES[family].draw(seed), simulations) as world:
        ways = world.traffic.network.junctions_m
        route = world.moment.driving.ahead.route_edges
        places = world.cockpit.state.of(Gazetteer).places
    assert places
    for place in places:
        assert {place.edge_id, route[-1]} <= loop_with(ways, place.edge_id)


@pytest.mark.slow
def test_the_car_drives_on_at_every_destination(simulations: Simulations) -> None:
    moments = driven(replace(LAPS, coarse=True), simulations, 800.0)
    assert len(moments) == 801
    assert all(moment.driving.end is None for moment in moments)
    goals = dict.fromkeys(moment.driving.ahead.route_edges[-1] for moment in moments)
    assert len(goals) == 3
    assert max(moment.driving.standing_s for moment in moments) < 60
    assert all(here.driving.distance_m <= there.driving.distance_m for here, there in pairwise(moments))


@pytest.mark.slow
def test_the_same_plan_gives_the_same_trace(simulations: Simulations) -> None:
    script = replace(FAMILIES["grid_june"].draw(3), seed=1)
    assert digest(driven(script, simulations, 200.0)) == digest(driven(script, simulations, 200.0))


@pytest.mark.slow
def test_a_branch_and_a_shadow_go_on_as_the_drive_does(simulations: Simulations) -> None:
    script = replace(FAMILIES["grid_january"].draw(2), seed=1)
    with departed(script, simulations) as world:
        world.advance(100.0)
        branch, shadow = world.branch(), world.shadow()
        try:
            own = digest(world.advance(150.0))
            assert digest(branch.advance(150.0)) == own
            assert digest(shadow.advance(150.0)) == own
        finally:
            branch.close()
            shadow.close()


@pytest.mark.slow
def test_what_is_planned_comes_at_its_time(simulations: Simulations) -> None:
    rain = replace(DRY, precipitation=4.0, weather_code=63, cloud_cover=100.0, visibility=6000.0)
    script = replace(
        LAPS,
        changes=(CarChange(30.0, SEAT.DRIVER_BELT.path, False), CarChange(40.0, CABIN.TRUNK.path, True)),
        arrivals=(Arrival("call", 50.0),),
        weather=(WeatherAt(0.0, DRY), WeatherAt(60.0, rain)),
        moods=(DriverAt(70.0, "hurried"), DriverAt(100.0, "calm")),
    )
    moments = driven(script, simulations, 140.0)

    def first(holds: Callable[[Moment], Any]) -> int:
        return next(second for second, moment in enumerate(moments) if holds(moment))

    assert first(lambda moment: not moment.signals[SEAT.DRIVER_BELT.path]) == 30
    assert first(lambda moment: moment.signals[CABIN.TRUNK.path]) == 40
    assert first(lambda moment: moment.signals[CALL.RINGING.path]) in (50, 51)
    assert first(lambda moment: moment.weather == rain) in (60, 61)

    def over_kmh(moment: Moment) -> float:
        return (moment.driving.speed_mps - (moment.driving.road.limit.mps or 0.0)) * KMH_PER_MPS

    assert max(map(over_kmh, moments[:70])) < 3
    assert max(map(over_kmh, moments[71:100])) > 8
    assert max(map(over_kmh, moments[125:])) < 3


@pytest.mark.slow
def test_a_mood_that_comes_ends_what_an_alert_had_brought_about(simulations: Simulations) -> None:
    script = replace(LAPS, driver="hurried", moods=(DriverAt(120.0, "hurried"),))
    with departed(script, simulations) as world:
        world.advance(20.0)
        world.traffic.request(Alert(AlertKind.SPEED))
        after = world.advance(200.0)
    fast = [moment.driving.speed_mps > (moment.driving.road.limit.mps or 99.0) + 1 for moment in after]
    assert not any(fast[30:98])
    assert any(fast[102:])


@pytest.mark.slow
def test_a_car_parks_beside_the_road_with_somebody_in_it_and_drives_on(simulations: Simulations) -> None:
    script = FAMILIES["grid_june"].draw(2)
    (left,) = (one for one in script.staged if one.kind == "left_behind")
    moments = driven(replace(script, seed=1), simulations, left.at_s + 260.0)
    parked = [moment for moment in moments if moment.signals[MOTION.GEAR.path] == "P"]
    assert [moment.driving.speed_mps for moment in parked] == pytest.approx([0.0] * len(parked), abs=0.1)
    assert 130 <= len(parked) <= 150
    alone = [moment for moment in parked if not moment.signals[OCCUPANT.DRIVER.occupied.path]]
    assert {
        sight.text for moment in alone for sight in moment.sights if sight.kind is SightKind.WITHOUT_DRIVER
    } == {"Driver has left, aboard: Child"}
    (event,) = (event for event in found(moments, "left_behind") if not event.lookalike)
    assert event.obliged_s == pytest.approx(event.observable_s + 15.0)
    assert event.due_until_s is not None
    assert event.deadline_s is not None
    assert event.due_until_s > event.deadline_s
    assert moments[-1].driving.speed_mps > 1.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("signal", "wrong", "kind", "right"),
    [
        (CALL.PHONE, "HAND", AlertKind.DISTRACTION, "AWAY"),
        (CALL.PHONE, "CRADLE", AlertKind.DISTRACTION, "CRADLE"),
        (SEAT.DRIVER_BELT, False, AlertKind.SEAT_BELT, True),
        (LIGHTS.SWITCH, "OFF", AlertKind.VISIBILITY, "AUTO"),
        (BODY.FRONT_WIPER, "OFF", AlertKind.WEATHER, "RAIN_SENSOR"),
        (BODY.FRONT_WIPER, "OFF", AlertKind.SPEED, "OFF"),
    ],
)
def test_a_warning_moves_the_driver_s_hands(
    simulations: Simulations, signal: Signal[Any], wrong: Any, kind: AlertKind, right: Any
) -> None:
    """As the driver says so, not only in words."""
    wet = replace(DRY, precipitation=5.0, weather_code=63)
    script = replace(LAPS, driver="calm", changes=(CarChange(5.0, signal.path, wrong),))
    with departed(replace(script, weather=(WeatherAt(0.0, wet),)), simulations) as world:
        before = world.advance(45.0)[-1]
        assert world.traffic.request(Alert(kind)).accepted
        after = world.advance(8.0)
    assert before.signals[signal.path] == wrong
    assert after[-1].signals[signal.path] == right
    if right != wrong:
        turned = next(moment for moment in after if moment.signals[signal.path] == right)
        assert any(event.kind in REACTIONS for event in turned.events)


@pytest.mark.slow
def test_a_van_is_no_ambulance(simulations: Simulations) -> None:
    for blue_light in (True, False):
        comes = EmergencyVehicle(from_s=60.0, behind_m=150.0, blue_light=blue_light)
        moments = driven(replace(LAPS, scenario="beauce", trips=("plain",), incidents=(comes,)), simulations, 150.0)
        seen = [moment.driving.around.emergency_behind is not None for moment in moments]
        closing = [
            follower is not None and follower.speed_mps > moment.driving.speed_mps + 3
            for moment in moments
            for follower in (moment.driving.around.follower,)
        ]
        assert any(seen) is blue_light
        assert any(closing)


@pytest.mark.slow
@pytest.mark.parametrize("what", ["breakdown", "roadworks", "jam"])
def test_an_incident_ahead_is_on_the_way_and_its_lookalike_is_not(simulations: Simulations, what: Any) -> None:
    for other_way in (False, True):
        incident = AheadIncident(what=what, from_s=20.0, to_s=490.0, ahead_m=1500.0, other_way=other_way)
        script = replace(LAPS, scenario="beauce", trips=("plain",), incidents=(incident,), coarse=True)
        moments = driven(script, simulations, 500.0)
        told = [one for moment in moments for one in moment.driving.ahead.incidents]
        assert {one.kind for one in told} == {IncidentKind(what)}
        noticed = [sight for moment in moments for sight in moment.sights if str(sight.kind) == what]
        assert bool(noticed) is not other_way
        assert not noticed or max(sight.distance_m or 0.0 for sight in noticed) < 1600


@pytest.mark.parametrize(
    ("change", "error", "told"),
    [
        ({"trips": ("nowhere",)}, UnknownNameError, "nowhere"),
        ({"scenario": "atlantis"}, UnknownNameError, "atlantis"),
        ({"driver": "nobody"}, UnknownNameError, "nobody"),
        ({"scenario": "tokyo", "trips": ("avenues", "yamate_tunnel")}, ScenarioError, "yamate_tunnel"),
    ],
)
@pytest.mark.slow
def test_what_cannot_be_driven_is_refused(
    simulations: Simulations, change: dict[str, Any], error: type[Exception], told: str
) -> None:
    with pytest.raises(error, match=told):
        depart(replace(LAPS, **change), simulations)


class _Full:
    """Traffic without a gap on some roads."""

    def __init__(self, full: set[str]) -> None:
        self.full = full

    def depart(self, plan: EgoPlan) -> Any:
        if plan.trip.name in self.full:
            raise NoRoomError(f"no gap on {plan.trip.name}")
        return plan


@pytest.mark.parametrize(
    ("full", "round_"),
    [((), "abc"), ("a", "bca"), ("ab", "cab"), ("abc", "")],
)
def test_a_drive_begins_with_the_next_trip_if_the_first_ones_road_is_full(full: Sequence[str], round_: str) -> None:
    a, b, c = (Trip(name, f"{name}1", f"{name}2") for name in "abc")
    plan = EgoPlan(a, "average", 1, onward=(b, c, a))
    simulation: Any = _Full(set(full))
    if not round_:
        with pytest.raises(NoRoomError, match="no gap on a"):
            departed_on_a_free_road(simulation, plan)
        return
    begun, traffic = departed_on_a_free_road(simulation, plan)
    assert traffic is begun
    assert [begun.trip.name, *(trip.name for trip in begun.onward)] == [*round_, round_[0]]
