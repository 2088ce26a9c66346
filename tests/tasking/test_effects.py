"""What a command does to the cabin decides, not its set point."""

from types import SimpleNamespace
from typing import Any

import pytest

from automotive_cosim.cockpit.signals import GLASS, HVAC, OUTSIDE, Signal, Signals
from automotive_cosim.cockpit.vehicle import Vehicle
from automotive_cosim.tasking.effects import EFFECTS, cabin_warmer, glass_clears


def moment(outside_c: float, cabin_c: float, *commands: tuple[Signal[Any], Any], fog: float = 0.0) -> Any:
    signals = Signals(
        {
            OUTSIDE.TEMPERATURE.path: outside_c,
            OUTSIDE.HUMIDITY.path: 90.0,
            HVAC.CABIN_TEMPERATURE.path: cabin_c,
            HVAC.CABIN_HUMIDITY.path: 60.0,
            HVAC.FAN_SPEED.path: 30.0,
            HVAC.RECIRCULATION.path: True,
            GLASS.WINDSHIELD_FOG.path: fog,
            GLASS.REAR_FOG.path: fog,
        }
    )
    car = Vehicle(signals)
    for signal, value in commands:
        car.command(signal, value)
    driving, weather = SimpleNamespace(speed_mps=8.0), SimpleNamespace(precipitation=0.0)
    return SimpleNamespace(signals=signals.snapshot(), driving=driving, weather=weather)


@pytest.mark.parametrize(
    ("command", "warms"),
    [
        ((HVAC.FAN_SPEED, 100.0), True),
        ((HVAC.MAX_DEFROST, True), True),
        ((HVAC.DRIVER_TEMPERATURE, 28.0), False),
        ((HVAC.AUTO, True), False),
        ((HVAC.FAN_SPEED, 10.0), False),
    ],
)
def test_where_the_heater_is_at_its_most_only_more_air_warms(command: tuple[Signal[Any], Any], warms: bool) -> None:
    start, now = moment(-14.0, 7.0), moment(-14.0, 7.0, command)
    assert cabin_warmer(0.5).holds(start, now, [start, now]) is warms


@pytest.mark.parametrize(
    ("commands", "clears"),
    [
        (((HVAC.FRONT_DEFROSTER, True),), True),
        (((HVAC.MAX_DEFROST, True),), True),
        (((HVAC.AIR_DISTRIBUTION, "UP"), (HVAC.RECIRCULATION, False)), True),
        (((HVAC.AIR_DISTRIBUTION, "UP"),), True),
        (((HVAC.AIR_DISTRIBUTION, "DOWN"),), False),
        (((HVAC.FAN_SPEED, 100.0),), False),
    ],
)
def test_warm_or_dry_air_at_the_glass_clears_it_however_it_gets_there(
    commands: tuple[tuple[Signal[Any], Any], ...], clears: bool
) -> None:
    start, now = moment(4.0, 21.0, fog=0.6), moment(4.0, 21.0, *commands, fog=0.6)
    assert glass_clears(rear=False, by=0.3).holds(start, now, [start, now]) is clears


def test_doing_nothing_has_no_effect() -> None:
    start = moment(4.0, 12.0, fog=0.5)
    for check in (cabin_warmer(0.01), glass_clears(rear=False, by=0.01), glass_clears(rear=True, by=0.01)):
        assert check.name in EFFECTS
        assert not check.holds(start, start, [start])
