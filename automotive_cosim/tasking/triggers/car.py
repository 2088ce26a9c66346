"""The car's own signals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from automotive_cosim.cockpit.signals import Signal
from automotive_cosim.cosim.moment import Moment


@dataclass(frozen=True, slots=True)
class SignalAbove:
    """A numeric signal is greater than ``value``, e.g. the fog on a window."""

    signal: Signal[float]
    value: float

    def __call__(self, moment: Moment) -> bool:
        """Whether the signal's value qualifies."""
        return float(moment.signals[self.signal.path]) > self.value

    def __str__(self) -> str:
        return f"{self.signal.path} above {self.value:g}"


@dataclass(frozen=True, slots=True)
class SignalBelow:
    """A numeric signal is less than ``value``, e.g. the battery's level."""

    signal: Signal[float]
    value: float

    def __call__(self, moment: Moment) -> bool:
        """Whether the signal's value qualifies."""
        return float(moment.signals[self.signal.path]) < self.value

    def __str__(self) -> str:
        return f"{self.signal.path} below {self.value:g}"


@dataclass(frozen=True, slots=True)
class SignalHas:
    """A signal has that value, e.g. a lamp that is on."""

    signal: Signal[Any]
    value: Any

    def __call__(self, moment: Moment) -> bool:
        """Whether the signal's value qualifies."""
        return bool(moment.signals[self.signal.path] == self.value)

    def __str__(self) -> str:
        return f"{self.signal.path} is {'empty' if self.value == '' else self.value}"
