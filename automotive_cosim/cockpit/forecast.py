"""The cabin after the driver has left it: how warm those who stay will have it."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from automotive_cosim.cockpit.cabin import SUN_W, Air, Controls, parked_c
from automotive_cosim.cockpit.occupants import Seat, breath
from automotive_cosim.cockpit.signals import HVAC, OUTSIDE
from automotive_cosim.cockpit.vehicle import Vehicle

MINUTES = 20.0
"""How far ``HVAC.FORECAST`` looks ahead: a stop at a shop."""


def cabin_c(vehicle: Vehicle, minutes: float, *, climate: bool) -> float:
    """Temperature of the air some minutes after the driver has left.

    Args:
        vehicle: as it is left, with its windows and who else is aboard.
        climate: whether the climate control goes on by itself, at the temperature that is set."""
    now = vehicle.signals
    outside = Air(now[OUTSIDE.TEMPERATURE], now[OUTSIDE.HUMIDITY], 0.0, 0.0)
    left = _left(vehicle.controls(0.0), climate, breath(now, without=Seat.DRIVER))
    return parked_c(now[HVAC.CABIN_TEMPERATURE], minutes, left, outside, SUN_W * now[OUTSIDE.LIGHT] / 100)


@lru_cache(maxsize=256)
def _left(controls: Controls, climate: bool, people: float) -> Controls:
    """How a car is left. Cached, as it is asked for every second."""
    return replace(controls, fan_pct=100.0 if climate else 0.0, air_conditioning=climate, people=people)
