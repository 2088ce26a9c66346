"""What each staged incident is made of: the protocol of scenes, and its defaults."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import Protocol

from automotive_cosim.contracts import RoadIncident

CAR_SPACE_M = 7.5
"""Length of a stationary car with its gap: SUMO's defaults."""


class Scene(Protocol):
    """One staged incident."""

    def begin(self) -> str:
        """Starts it; returns a description of what happened, or an empty text."""
        ...

    def tick(self, local_time: datetime) -> str:
        """Called once per second while it lasts; returns a description of what happened."""
        ...

    def end(self) -> str:
        """Reverts it; returns a description of what happened."""
        ...

    def reported(self, slow: Mapping[str, float]) -> RoadIncident | None:
        """What live traffic reports while it lasts, for ``Situations.reported``; None if it cannot know."""
        ...


class QuietScene:
    """Defaults: most scenes do nothing while they last, and need no reverting."""

    def begin(self) -> str:
        """See ``Scene``."""
        return ""

    def tick(self, local_time: datetime) -> str:
        """See ``Scene``."""
        return ""

    def end(self) -> str:
        """See ``Scene``."""
        return ""

    def reported(self, slow: Mapping[str, float]) -> RoadIncident | None:
        """See ``Scene``."""
        return None
