"""A time of day at which something happens."""

from __future__ import annotations

from dataclasses import dataclass, replace


@dataclass(frozen=True, slots=True)
class Timer:
    """A time of day at which something happens."""

    on: bool = False
    minute: int = 7 * 60
    """Minute of the day."""

    @property
    def shown(self) -> str:
        """The time as hours and minutes."""
        return f"{self.minute // 60:02d}:{self.minute % 60:02d}"

    def moved(self, minutes: int) -> Timer:
        """A copy with another time of day."""
        return replace(self, minute=(self.minute + minutes) % 1440)


AT_SEVEN = Timer()
"""Off."""
