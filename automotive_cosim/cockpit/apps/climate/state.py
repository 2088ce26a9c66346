"""When the cabin is prepared."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import Any

from automotive_cosim.cockpit.signals import HVAC
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.cockpit.timer import AT_SEVEN, Timer
from automotive_cosim.contracts import Surroundings
from automotive_cosim.contracts.text import say

PREPARING_MIN = 30
"""How long before the set time the climate control starts: heating and cooling take some twenty minutes."""


@dataclass(frozen=True, slots=True)
class ClimateSchedule(AppData):
    """The time at which the cabin is ready."""

    timer: Timer = AT_SEVEN

    def commands(self) -> dict[str, Any]:
        """The time; empty without."""
        return {"climate.schedule": self.timer.shown if self.timer.on else ""}

    def passed(self, state: State, before: Surroundings | None, dt_s: float) -> None:
        """Starts the climate control ahead of the set time, at which the cabin is ready."""
        if before is None or state.outside is None:
            return
        starts = self.timer.moved(-PREPARING_MIN).minute
        if self.timer.on and _minute(before.local_time) < starts <= _minute(state.outside.local_time):
            state.vehicle.command(HVAC.AUTO, True)
            state.notify(say("The cabin is being preconditioned for {time}", time=self.timer.shown), Icon.CLIMATE)


def _minute(time: datetime) -> float:
    """Minute of the day."""
    return time.hour * 60 + time.minute + time.second / 60
