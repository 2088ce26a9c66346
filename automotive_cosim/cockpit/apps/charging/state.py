"""When the battery is charged."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from automotive_cosim.cockpit.state import AppData
from automotive_cosim.cockpit.timer import AT_SEVEN, Timer


@dataclass(frozen=True, slots=True)
class ChargingSchedule(AppData):
    """The time by which the battery is charged."""

    timer: Timer = AT_SEVEN

    def commands(self) -> dict[str, Any]:
        """The time; empty without."""
        return {"charging.schedule": self.timer.shown if self.timer.on else ""}
