"""What each staged incident is made of."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime

from automotive_cosim.contracts import RoadIncident

CAR_SPACE_M = 7.5
"""Length of a stationary car with its gap: SUMO's defaults."""


class StagedIncident:
    """An incident in SUMO; most do nothing while they last, and need no reverting."""

    closed: tuple[str, ...] = ()
    """Lanes that it keeps cars out of while it lasts."""

    def begin(self) -> str:
        """Starts it; returns a description of what happened, or an empty text."""
        return ""

    def tick(self, local_time: datetime) -> str:
        """Called once per second while it lasts; returns a description of what happened."""
        return ""

    def end(self) -> str:
        """Reverts it; returns a description of what happened."""
        return ""

    def reported(self, slow: Mapping[str, float]) -> RoadIncident | None:
        """What live traffic reports while it lasts, for ``Incidents.reported``; None if it cannot know."""
        return None
