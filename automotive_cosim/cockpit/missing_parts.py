"""One thing that a car lacks, as data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from automotive_cosim.cockpit.signals import Signal
from automotive_cosim.contracts.text import say


@dataclass(frozen=True, slots=True)
class Lacking:
    """Equipment that a car was never fitted with, or that is out of order."""

    what: str
    """In words, such as ``seat ventilation``."""
    signals: tuple[Signal[Any], ...] = ()
    """What it commands or measures."""
    part: tuple[Any, ...] | None = None
    """The values that are lacking: two numbers, from the one to the other, or texts one by one; None for all."""
    keys: tuple[str, ...] = ()
    """Widgets that show it, or command it otherwise than by its signals."""
    functions: tuple[str, ...] = ()
    """Functions of apps that command it."""
    is_broken: bool = False
    """Whether the car has it, out of order."""

    @property
    def words(self) -> str:
        """What the car says of it."""
        if self.is_broken:
            return say("Not working: {what}", what=self.what)
        return say("This car has no {what}", what=self.what)

    @property
    def is_range(self) -> bool:
        """Whether only some numbers of it are lacking."""
        return self.part is not None and isinstance(self.part[0], float)

    def bars(self, signal: Signal[Any], value: Any) -> bool:
        """Whether a value cannot be set for want of it."""
        if signal not in self.signals:
            return False
        if self.part is None:
            return True
        if self.is_range:
            low, high = self.part
            return bool(low <= value <= high)
        return value in self.part
