"""Two trip meters."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from automotive_cosim.cockpit.signals import ENERGY
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.contracts import Surroundings

Reading = tuple[float, float, float]
"""Driven metres, simulation time in seconds and battery level in percent."""


def odometer(state: State) -> Reading:
    """The present reading."""
    driven_m = 0.0 if state.outside is None else state.outside.driving.distance_m
    return driven_m, state.time_s, state.signals[ENERGY.LEVEL]


@dataclass(frozen=True, slots=True)
class TripMeter:
    """What a trip meter has counted up to a reading of the odometer, from which it counts on."""

    driven_m: float = 0.0
    took_s: float = 0.0
    used_kwh: float = 0.0
    since: Reading = (0.0, 0.0, 0.0)
    """Driven metres, time and battery (``odometer``) from which it counts on: at departure or the reset."""
    resets: int = 0

    def at(self, reading: Reading, battery_kwh: float) -> tuple[float, float, float]:
        """Metres, seconds and kWh that it shows at a reading of the odometer."""
        (metres, seconds, level), (from_m, from_s, from_level) = reading, self.since
        used_kwh = max(0.0, from_level - level) / 100 * battery_kwh
        return self.driven_m + max(0.0, metres - from_m), self.took_s + seconds - from_s, self.used_kwh + used_kwh


FROM_HERE = TripMeter()
"""A trip meter that has counted nothing yet."""


@dataclass(frozen=True, slots=True)
class TripMeters(AppData):
    """Trip A counts from its reset, trip B keeps counting when A is reset."""

    resets: int = 0
    since: Reading = (0.0, 0.0, 0.0)
    """From which trip A counts."""
    b: TripMeter = FROM_HERE

    def commands(self) -> dict[str, Any]:
        """How often each was reset."""
        return {"trip.resets": self.resets, "trip.resets_b": self.b.resets}

    def passed(self, state: State, before: Surroundings | None, dt_s: float) -> None:
        """At departure, both count on from here."""
        if before is None:
            here = odometer(state)
            state.keep(replace(self, since=here, b=replace(self.b, since=here)))
