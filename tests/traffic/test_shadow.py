"""A shadow is an exact copy of a drive, whatever the two are asked, and as good as free until they part."""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest

from automotive_cosim.contracts import Alert, AlertKind, Cruise, DrivingState, RoadRequest, SlowDown
from automotive_cosim.errors import TrafficError
from automotive_cosim.geo.weather import typical_weather
from automotive_cosim.scenarios import Trip, WeatherAt, open_scenario
from automotive_cosim.traffic.base import EgoPlan, Event, Traffic
from automotive_cosim.traffic.fork import Forked, Simulations
from automotive_cosim.traffic.future import KnownDrives, SharedFuture
from automotive_cosim.traffic.shadow import SharedTraffic
from tests.scripted.traffic import Scripted, Stretch

STEP_S = 0.1
ROAD = (Stretch("a", 300.0, 50.0), Stretch("b", 400.0, 80.0), Stretch("c", 300.0, 30.0))
ON_ROAD = EgoPlan(Trip("all", "a", "c"), "hurried", seed=3)
REQUESTS: tuple[RoadRequest, ...] = (Alert(AlertKind.SPEED), SlowDown(20.0), Cruise(30.0))
Depart = Callable[[], Traffic]


class Counted:
    """A drive that counts its branches, those of branches too."""

    def __init__(self, traffic: Traffic, made: list[int]) -> None:
        self._traffic, self._made = traffic, made
        self.network, self.request = traffic.network, traffic.request
        self.advance, self.alternatives, self.close = traffic.advance, traffic.alternatives, traffic.close

    @property
    def state(self) -> DrivingState:
        return self._traffic.state

    def branch(self) -> Counted:
        self._made.append(1)
        return Counted(self._traffic.branch(), self._made)


@pytest.fixture(params=["scripted", pytest.param("forked", marks=pytest.mark.sumo)])
def depart(request: pytest.FixtureRequest) -> Depart:
    if request.param == "scripted":
        simulation = Scripted(ROAD, step_length_s=STEP_S)
        return lambda: simulation.depart(ON_ROAD)
    forked: Forked = request.getfixturevalue("forked")
    plan: EgoPlan = request.getfixturevalue("hurried")
    return lambda: forked.depart(plan)


def driven(traffic: Traffic, *durations_s: float) -> tuple[list[DrivingState], list[Event]]:
    states, events = [traffic.state], []
    for duration_s in durations_s:
        passed = traffic.advance(duration_s)
        states += passed.states
        events += passed.events
    return states, events


@pytest.mark.parametrize("seed", range(8))
def test_a_shadow_drives_as_a_branch_does(depart: Depart, seed: int) -> None:
    """In slices of any length, ahead or behind, before and after requests to the one or the other."""
    draw = random.Random(seed)
    traffic = depart()
    traffic.advance(2.0)
    shared = SharedTraffic(traffic, STEP_S)
    branch, shadow = traffic.branch(), shared.shadow()
    first, second = driven(branch), driven(shadow)
    for _ in range(12):
        for _ in range(draw.randrange(3)):
            shared.advance(draw.choice((0.1, 0.5, 1.0, 2.3)))
        if draw.random() < 0.2:
            shared.request(draw.choice(REQUESTS))
        duration_s = draw.choice((0.1, 0.3, 1.0, 3.0))
        first, second = (
            tuple(old + new for old, new in zip(before, driven(each, duration_s), strict=True))
            for before, each in ((first, branch), (second, shadow))
        )
        assert shadow.state == branch.state
        if draw.random() < 0.1 and shadow.state.time_s >= shared.state.time_s:
            request = draw.choice(REQUESTS)
            assert shadow.request(request) == branch.request(request)
            assert shadow.alternatives() == branch.alternatives()
    assert first == second
    assert driven(shadow, 400.0) == driven(branch, 400.0)
    for each in (shadow, branch, shared):
        each.close()


def test_the_other_drive_does_not_feel_its_shadows(depart: Depart) -> None:
    plain, shared = depart(), SharedTraffic(depart(), STEP_S)
    shadows = [shared.shadow() for _ in range(3)]
    shadows[0].advance(3.0)
    shadows[1].request(SlowDown(10.0))
    assert driven(shared, 5.0, 0.5) == driven(plain, 5.0, 0.5)
    assert shared.alternatives() == plain.alternatives()
    assert shared.request(Cruise(20.0)) == plain.request(Cruise(20.0))
    assert driven(shared, 60.0) == driven(plain, 60.0)
    for each in (*shadows, shared, plain):
        each.close()


def test_it_branches_only_where_the_two_part() -> None:
    made: list[int] = []
    shared = SharedTraffic(Counted(Scripted(ROAD, step_length_s=STEP_S).depart(ON_ROAD), made), STEP_S)
    shadow = shared.shadow()
    for _ in range(20):
        shared.advance(1.0)
        assert shadow.advance(1.0).states[-1] == shared.state
        assert shadow.alternatives() == shared.alternatives()
    assert not made
    shared.request(SlowDown(20.0))
    shared.request(Cruise(20.0))
    shared.advance(5.0)
    shadow.advance(5.0)
    assert len(made) == 1
    assert shadow.state != shared.state


def test_the_end_of_the_drive_ends_its_shadow_without_a_branch() -> None:
    made: list[int] = []
    shared = SharedTraffic(Counted(Scripted(ROAD, step_length_s=STEP_S).depart(ON_ROAD), made), STEP_S)
    shadow = shared.shadow()
    assert shadow.advance(0.0).states == ()
    whole = shared.advance(2000.0)
    assert whole.states[-1].end is not None
    assert shadow.advance(2000.0) == whole
    assert shadow.advance(1.0).states == ()
    assert not made


def test_what_a_shadow_cannot_do() -> None:
    shared = SharedTraffic(Scripted(ROAD, step_length_s=STEP_S).depart(ON_ROAD), STEP_S)
    shadow, closed = shared.shadow(), shared.shadow()
    closed.close()
    shared.advance(1.0)
    for act in (lambda: shadow.request(SlowDown(20.0)), shadow.alternatives, shadow.branch):
        with pytest.raises(RuntimeError, match="in the past"):
            act()
    shared.close()
    assert shadow.advance(1.0).states, "what it was told it still knows"
    with pytest.raises(TrafficError, match="closed"):
        shadow.advance(1.0)


@pytest.mark.parametrize("seed", range(6))
def test_drives_into_one_future_are_branches(depart: Depart, seed: int) -> None:
    """In slices of any length, copies of copies, before and after requests of the one or the other."""
    draw = random.Random(seed)
    traffic = depart()
    traffic.advance(2.0)
    future = SharedFuture(traffic, STEP_S)
    branches: list[Traffic] = [traffic.branch()]
    drives: list[Traffic] = [future.drive()]
    for _ in range(24):
        which = draw.randrange(len(drives))
        branch, drive = branches[which], drives[which]
        what = draw.random()
        if what < 0.15:
            branches.append(branch.branch())
            drives.append(drive.branch())
        elif what < 0.3:
            request = draw.choice(REQUESTS)
            assert drive.request(request) == branch.request(request)
        elif what < 0.4:
            assert drive.alternatives() == branch.alternatives()
        else:
            duration_s = draw.choice((0.1, 0.3, 1.0, 8.0))
            assert driven(drive, duration_s) == driven(branch, duration_s)
    assert [drive.state for drive in drives] == [branch.state for branch in branches]
    for each in (*drives, *branches):
        each.close()
    future.close()


def test_a_future_is_driven_once(depart: Depart) -> None:
    made: list[int] = []
    traffic = depart()
    future = SharedFuture(Counted(traffic, made), STEP_S)
    whole = driven(future.drive(), 3.0, 400.0)
    drives = [future.drive() for _ in range(5)]
    assert [driven(drive, 403.0) for drive in drives] == [whole] * 5
    assert whole[0][-1].end is not None
    assert driven(drives[0], 1.0)[0] == [whole[0][-1]]
    assert len(made) == 1
    early = future.drive()
    early.advance(1.0)
    early.request(SlowDown(20.0))
    assert len(made) == 2
    assert driven(early, 5.0) != driven(future.drive(), 6.0)
    early.close()
    future.close()


@pytest.mark.sumo
def test_who_departs_alike_drives_as_if_alone(simulations: Simulations, monkeypatch: pytest.MonkeyPatch) -> None:
    """With reactions by one's own seed, in weather that the road does not feel; wet is another drive."""
    scenario, drives, departed = open_scenario("grid"), KnownDrives(simulations), list[EgoPlan]()
    dry, mild, wet = (
        (WeatherAt(0.0, typical_weather(code, celsius)),) for code, celsius in ((0, 5), (2, 15), (63, 9))
    )
    plans = [EgoPlan(scenario.trip("avenue"), seed=seed, weather=sky) for seed, sky in enumerate((dry, mild, wet))]
    with simulations.held(scenario, 0) as simulation:
        alone = [simulation.depart(plan) for plan in plans]
    depart = Forked.depart
    monkeypatch.setattr(Forked, "depart", lambda self, plan: departed.append(plan) or depart(self, plan))
    with drives.held(scenario, 0) as known:
        shared = [known.depart(plan) for plan in plans]
    assert departed == [plans[0], plans[2]]
    found = []
    for one, other in zip(alone, shared, strict=True):
        assert driven(one, 3.0, 9.0) == driven(other, 3.0, 9.0)
        assert one.request(SlowDown(15.0)) == other.request(SlowDown(15.0))
        after = driven(one, 12.0)
        assert after == driven(other, 12.0)
        found.append([event for event in after[1] if event.kind.startswith("driver_")])
        one.close()
        other.close()
    assert found[0] != found[1], "their drivers react otherwise"
    drives.close()
