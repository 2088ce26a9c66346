"""Changes of the car that nobody commands."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import pytest

from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.signals import (
    BODY,
    CABIN,
    DRIVE,
    ENERGY,
    LIGHTS,
    MOTION,
    OCCUPANT,
    SEAT,
    TYRE,
    Signal,
)
from automotive_cosim.contracts import Surroundings
from automotive_cosim.errors import CosimError

Make = Callable[..., Cockpit]


def drive(cockpit: Cockpit, around: Surroundings, from_s: int, to_s: int) -> None:
    for second in range(from_s + 1, to_s + 1):
        driving = replace(around.driving, time_s=around.driving.time_s + second)
        cockpit.sense(replace(around, driving=driving), 1.0)


def test_a_switch_turns_at_its_time_and_can_be_turned_back(make: Make, around: Surroundings) -> None:
    cockpit = make(
        changes=[CarChange(5.0, BODY.FRONT_WIPER.path, "OFF"), CarChange(9.0, SEAT.DRIVER_BELT.path, False)]
    )
    drive(cockpit, around, 0, 4)
    assert cockpit.signals[BODY.FRONT_WIPER] == "RAIN_SENSOR"
    drive(cockpit, around, 4, 5)
    assert cockpit.signals[BODY.FRONT_WIPER] == "OFF"
    cockpit.inject(BODY.FRONT_WIPER.path, "SLOW")
    assert cockpit.signals[SEAT.DRIVER_BELT]
    drive(cockpit, around, 5, 12)
    assert not cockpit.signals[SEAT.DRIVER_BELT]
    assert cockpit.signals[BODY.FRONT_WIPER] == "SLOW"


def test_what_is_locked_while_driving_can_still_spring_open(make: Make, around: Surroundings) -> None:
    cockpit = make(changes=[CarChange(1.0, CABIN.TRUNK.path, True)])
    drive(cockpit, around, 0, 1)
    assert cockpit.signals[CABIN.TRUNK]


def test_what_somebody_has_to_get_out_for_waits_until_the_car_stands(make: Make, around: Surroundings) -> None:
    shut = CarChange(3.0, CABIN.TRUNK.path, False, once_standing=True)
    cockpit = make(changes=[CarChange(1.0, CABIN.TRUNK.path, True), shut])
    drive(cockpit, around, 0, 10)
    assert cockpit.signals[CABIN.TRUNK]
    drive(cockpit, replace(around, driving=replace(around.driving, speed_mps=0.0)), 10, 11)
    assert not cockpit.signals[CABIN.TRUNK]


def test_in_a_parked_car_times_count_from_when_it_was_parked(make: Make, around: Surroundings) -> None:
    gone = CarChange(3.0, OCCUPANT.DRIVER.occupied.path, False, once_parked=True)
    cockpit = make(changes=[gone], lookout=True)
    drive(cockpit, around, 0, 10)
    assert cockpit.signals[MOTION.GEAR] == "D"
    parked = replace(around, driving=replace(around.driving, speed_mps=0.0), parked=True)
    drive(cockpit, parked, 10, 13)
    assert (cockpit.signals[MOTION.GEAR], cockpit.signals[DRIVE.PARKING_BRAKE]) == ("P", True)
    assert cockpit.signals[OCCUPANT.DRIVER.occupied]
    drive(cockpit, parked, 13, 14)
    assert not cockpit.signals[OCCUPANT.DRIVER.occupied]
    assert "Driver has left, nobody aboard" in [sight.text for sight in cockpit.sights]
    drive(cockpit, around, 14, 15)
    assert (cockpit.signals[MOTION.GEAR], cockpit.signals[DRIVE.PARKING_BRAKE]) == ("D", False)


def test_nothing_that_changes_by_itself_counts_as_a_command(make: Make, around: Surroundings) -> None:
    cockpit, other = make(changes=[CarChange(1.0, LIGHTS.SWITCH.path, "BEAM")]), make()
    drive(cockpit, around, 0, 2)
    drive(other, around, 0, 2)
    assert cockpit.signals[LIGHTS.LOW_BEAM]
    assert cockpit.given == other.given == ()


@pytest.mark.parametrize("signal", [TYRE.FRONT_LEFT, TYRE.REAR_RIGHT])
def test_a_tyre_leaks_evenly_and_the_others_do_not(make: Make, around: Surroundings, signal: Signal[float]) -> None:
    cockpit, whole = make(changes=[CarChange(10.0, signal.path, 150.0, over_s=100.0)]), make()
    lost = []
    for second in range(0, 140, 10):
        drive(cockpit, around, second, second + 10)
        drive(whole, around, second, second + 10)
        lost.append(whole.signals[signal] - cockpit.signals[signal])
        for tyre in {TYRE.FRONT_LEFT, TYRE.FRONT_RIGHT, TYRE.REAR_LEFT, TYRE.REAR_RIGHT} - {signal}:
            assert cockpit.signals[tyre] == whole.signals[tyre]
    assert lost[0] == pytest.approx(0.0, abs=1.5)
    steps = [later - earlier for earlier, later in pairwise(lost[1:10])]
    assert max(steps) - min(steps) < 0.1 * max(steps)
    assert lost[-1] == pytest.approx(lost[-2], abs=0.5)
    assert lost[-1] == pytest.approx(100.0, rel=0.1)


def test_the_battery_goes_on_from_where_it_fell_to(make: Make, around: Surroundings) -> None:
    cockpit = make(changes=[CarChange(5.0, ENERGY.LEVEL.path, 10.0, over_s=10.0)])
    drive(cockpit, around, 0, 15)
    assert cockpit.signals[ENERGY.LEVEL] == pytest.approx(10.0, abs=0.1)
    drive(cockpit, around, 15, 60)
    assert 9.5 < cockpit.signals[ENERGY.LEVEL] < 10.0


def test_a_copy_has_the_same_changes_before_it(make: Make, around: Surroundings) -> None:
    cockpit = make(
        changes=[CarChange(5.0, SEAT.DRIVER_BELT.path, False), CarChange(3.0, TYRE.REAR_LEFT.path, 180.0, 9.0)]
    )
    drive(cockpit, around, 0, 4)
    twin = cockpit.copy()
    drive(cockpit, around, 4, 20)
    drive(twin, around, 4, 20)
    assert twin.signals.snapshot() == cockpit.signals.snapshot()


@pytest.mark.parametrize(
    "change",
    [
        CarChange(-1.0, SEAT.DRIVER_BELT.path, False),
        CarChange(float("nan"), SEAT.DRIVER_BELT.path, False),
        CarChange(1.0, SEAT.DRIVER_BELT.path, False, over_s=5.0),
        CarChange(1.0, SEAT.DRIVER_BELT.path, 0.5),
        CarChange(1.0, "Vehicle.Nothing", False),
        CarChange(1.0, TYRE.REAR_LEFT.path, 9000.0),
    ],
)
def test_an_impossible_change_is_refused_before_the_drive(make: Make, change: CarChange) -> None:
    with pytest.raises(CosimError):
        make(changes=[change])
