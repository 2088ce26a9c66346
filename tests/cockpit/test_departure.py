"""However long the way to the hand-over took, no screen tells it."""

from collections.abc import Callable
from dataclasses import replace
from datetime import timedelta
from typing import Any

import pytest

from automotive_cosim.cockpit.apps.phone.arrivals import RINGS_S, Arrival
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.signals import CABIN, CALL, ENERGY, HVAC, MEDIA, SEAT
from automotive_cosim.contracts import Surroundings

Make = Callable[..., Cockpit]
SET = {
    HVAC.FAN_SPEED.path: 60.0,
    HVAC.DRIVER_TEMPERATURE.path: 26.0,
    SEAT.DRIVER_HEATING.path: 100.0,
    MEDIA.ACTION.path: "PLAY",
    CABIN.SUNROOF.path: 40.0,
    ENERGY.LEVEL.path: 16.0,
}
"""What runs, plays and warms, and a battery that would be low soon."""
MESSAGE, CALL_AND_MESSAGE = Arrival("message", 5.0), (Arrival("call", 8.0), Arrival("message", 5.0))


def driven(make: Make, around: Surroundings, way_s: int, **options: Any) -> tuple[Cockpit, Cockpit, Surroundings]:
    """A cockpit after a way, the same at its departure, and the surroundings there."""
    cockpit = make(signals=SET, cabin={"temperature_c": 15.0, "wet_clothes": True}, **options)
    departed, now = cockpit.copy(), around
    for second in range(1, way_s + 1):
        driving = replace(around.driving, time_s=around.driving.time_s + second, distance_m=14.0 * second)
        now = replace(around, driving=driving, local_time=around.local_time + timedelta(seconds=second))
        cockpit.sense(now, 1.0)
    return cockpit, departed, now


def arrived(make: Make, around: Surroundings, way_s: int, with_air: bool = True, **options: Any) -> Cockpit:
    cockpit, departed, now = driven(make, around, way_s, **options)
    earlier = replace(now, local_time=around.local_time)
    return cockpit.freshened(departed, earlier, timedelta(seconds=way_s), with_air=with_air)


@pytest.mark.slow
@pytest.mark.parametrize("arrivals", [(), (MESSAGE,), CALL_AND_MESSAGE])
def test_no_screen_tells_how_long_the_way_was(
    make: Make, around: Surroundings, walker: Callable[[Cockpit], tuple[Any, ...]], arrivals: tuple[Arrival, ...]
) -> None:
    short, long = (arrived(make, around, way_s, arrivals=arrivals) for way_s in (40, 400))
    assert short.signals.snapshot() == long.signals.snapshot()
    assert short.commands() == long.commands()
    views = list(zip(walker(short), walker(long), strict=True))
    assert len(views) > 40
    for one, other in views:
        assert one.way == other.way
        assert one.cockpit.elements() == other.cockpit.elements(), one.name


def test_without_the_air_only_that_has_become_what_the_way_made(make: Make, around: Surroundings) -> None:
    cockpit, departed, _ = driven(make, around, 60)
    kept = arrived(make, around, 60, with_air=False)
    air = {HVAC.CABIN_TEMPERATURE, HVAC.CABIN_HUMIDITY, SEAT.DRIVER_TEMPERATURE}
    assert all(kept.signals[signal] == cockpit.signals[signal] != departed.signals[signal] for signal in air)
    for signal in (ENERGY.LEVEL, ENERGY.RANGE):
        assert kept.signals[signal] == departed.signals[signal] > cockpit.signals[signal]


def test_what_arrives_later_still_does_and_what_rings_goes_on(make: Make, around: Surroundings) -> None:
    arrivals = (Arrival("call", 30.0), Arrival("message", 45.0))
    cockpit = arrived(make, around, 35, arrivals=arrivals)
    assert cockpit.signals[CALL.RINGING]
    unread = cockpit.signals[CALL.UNREAD]
    for second in range(36, 30 + int(RINGS_S) + 1):
        cockpit.sense(replace(around, driving=replace(around.driving, time_s=around.driving.time_s + second)), 1.0)
        assert cockpit.signals[CALL.UNREAD] == unread + (second >= 45)
    assert not cockpit.signals[CALL.RINGING]
