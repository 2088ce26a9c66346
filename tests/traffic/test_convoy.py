"""Several equipped cars in one traffic: alone, one is what it always was; beside others, each sees the road."""

from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace

import pytest

from automotive_cosim.contracts import Reroute, SlowDown
from automotive_cosim.errors import ScenarioError
from automotive_cosim.scenarios import Scenario
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked, RemoteTraffic

SECOND = "ego.1"


@pytest.fixture
def first(forked: Forked, hurried: EgoPlan) -> Iterator[RemoteTraffic]:
    with closing(forked.depart(hurried)) as traffic:
        yield traffic


def beside(first: RemoteTraffic, plan: EgoPlan, car: str = SECOND) -> RemoteTraffic:
    """Another car, once it has entered."""
    first.road.send(car, plan)
    for _ in range(60):
        first.advance(1.0)
        for entered in first.road.entered():
            return entered
    raise AssertionError("it has not entered")


def others(traffic: RemoteTraffic) -> dict[str, tuple[float, float, float]]:
    """Where every vehicle around a car is, and how fast."""
    return {each.vehicle_id: (each.x_m, each.y_m, each.speed_mps) for each in traffic.look().vehicles}


def test_a_cockpit_in_a_car_that_drives_anyway_changes_nothing(first: RemoteTraffic) -> None:
    first.advance(5.0)
    with closing(first.branch()) as alone:
        some = sorted(others(first).keys() - {"ego"})[:3]
        equipped = []
        for vehicle in some:
            try:
                equipped.append(first.road.equip(vehicle, EgoPlan(None)))  # type: ignore[arg-type]
            except ScenarioError as error:
                assert vehicle in str(error)
        assert equipped
        for _ in range(30):
            assert first.advance(1.0) == alone.advance(1.0)
            assert others(first) == others(alone)
            for car in equipped:
                if car.advance(1.0).states and car.state.end is None and car.car in others(first):
                    car.alternatives()
                    assert (car.state.x_m, car.state.y_m, car.state.speed_mps) == others(first)[car.car]


def test_its_driver_does_what_the_cockpit_asks(first: RemoteTraffic) -> None:
    first.advance(5.0)
    vehicle = max(
        (each for each in first.look().vehicles if each.vehicle_id != "ego"), key=lambda each: each.speed_mps
    )
    car = first.road.equip(vehicle.vehicle_id, EgoPlan(None, "calm"))  # type: ignore[arg-type]
    before_mps = car.state.speed_mps
    assert car.request(SlowDown(20.0)).accepted
    first.advance(12.0)
    events = car.advance(12.0).events
    assert any(event.kind == "driver_slows" for event in events)
    assert car.state.speed_mps < min(before_mps, 6.0)


def test_cars_enter_are_read_at_the_same_steps_and_leave(
    first: RemoteTraffic, grid: Scenario, hurried: EgoPlan
) -> None:
    second = beside(first, replace(hurried, trip=grid.trip("round"), driver="average"))
    assert second.state.time_s == first.state.time_s
    for duration_s in (1.0, 0.5, 2.3):
        one, other = first.advance(duration_s), second.advance(duration_s)
        assert [state.time_s for state in one.states] == [state.time_s for state in other.states]
    assert "ego" in others(second)
    assert others(second)["ego"] == (second.state.x_m, second.state.y_m, second.state.speed_mps)
    assert others(second)[SECOND] == others(first)["ego"]
    second.close()
    assert first.advance(5.0).states
    with pytest.raises(ScenarioError, match=SECOND):
        first.road.send(SECOND, hurried)


def test_who_is_behind_cannot_ask(first: RemoteTraffic, hurried: EgoPlan) -> None:
    second = beside(first, hurried)
    first.advance(1.0)
    with pytest.raises(RuntimeError, match="in the past"):
        second.request(SlowDown(20.0))
    second.advance(1.0)
    assert second.request(SlowDown(20.0)).accepted


def test_the_others_of_a_branch_do_what_they_do_beside_the_original(
    first: RemoteTraffic, grid: Scenario, hurried: EgoPlan
) -> None:
    second = beside(first, replace(hurried, trip=grid.trip("round")))
    with closing(first.branch()) as silent:

        def ride(*cars: RemoteTraffic) -> None:
            for _ in range(10):
                for car in cars:
                    car.advance(1.0)

        ride(first, second)
        assert second.request(SlowDown(15.0)).accepted
        second.request(Reroute())
        ride(first, second)
        ride(silent)
        ride(silent)
        assert others(silent) == others(first)  # nothing but what both cockpits asked for has happened
        assert first.request(SlowDown(15.0)).accepted
        ride(first, second)
        ride(silent)
        assert others(silent)["ego"] != others(first)["ego"]


def test_a_whole_fleet_falls_silent_on_a_branch_of_its_road(
    first: RemoteTraffic, grid: Scenario, hurried: EgoPlan
) -> None:
    second = beside(first, replace(hurried, trip=grid.trip("round")))
    silent, again = first.road.branch(), first.road.branch()
    assert [car.car for car in silent] == ["ego", SECOND]

    def ride(*cars: RemoteTraffic) -> None:
        for _ in range(15):
            for car in cars:
                car.advance(1.0)

    for cars in ((first, second), again):
        assert all(car.request(SlowDown(15.0)).accepted for car in cars)
        ride(*cars)
    ride(*silent)
    assert others(again[0]) == others(first)
    assert [car.state for car in again] == [first.state, second.state]
    assert all(others(silent[0])[car] != others(first)[car] for car in others(first).keys() & {SECOND})
    assert silent[0].state.speed_mps > first.state.speed_mps
    for cars in (silent, again):
        for car in cars:
            car.close()
