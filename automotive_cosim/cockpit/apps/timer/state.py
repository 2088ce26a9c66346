"""The countdown."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Severity, Surroundings
from automotive_cosim.contracts.text import say

STEP_MIN, MOST_MIN = 5, 240


@dataclass(frozen=True, slots=True)
class Countdown(AppData):
    """The length that is set, and the countdown that runs."""

    minutes: int = 15
    begun_s: float | None = None
    """Simulation time at which it began; None while none runs."""

    def longer(self, by_min: int) -> Countdown:
        """Longer, or shorter, within the bounds; one that runs ends later, or earlier."""
        return replace(self, minutes=min(MOST_MIN, max(STEP_MIN, self.minutes + by_min)))

    def left_s(self, time_s: float) -> float:
        """Seconds until it ends."""
        passed_s = 0.0 if self.begun_s is None else time_s - self.begun_s
        return max(0.0, 60 * self.minutes - passed_s)

    def commands(self) -> dict[str, Any]:
        """The length, and whether it runs."""
        return {"timer.minutes": self.minutes, "timer.running": self.begun_s is not None}

    def passed(self, state: State, before: Surroundings | None, dt_s: float) -> None:
        """Tells the driver when it is over."""
        if self.begun_s is not None and self.left_s(state.time_s) <= 0:
            state.keep(replace(self, begun_s=None))
            words = say("{minutes} minutes are up", minutes=self.minutes)
            state.notify(words, Icon.CLOCK, Severity.WARNING, opens=("timer", ""))
