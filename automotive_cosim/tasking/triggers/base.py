"""What a trigger is, and how conditions go together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from automotive_cosim.cosim.moment import Moment

WALKING_MPS = 2.0
STANDING_MPS = 0.1
ANY = 1e9
"""Farther, faster and more than anything."""


class TriggerCondition(Protocol):
    """A question about one moment."""

    def __call__(self, moment: Moment) -> bool:
        """True while it holds."""
        ...


@dataclass(frozen=True, slots=True)
class Trigger:
    """The situation a task starts from: ``condition`` has held for ``for_s`` without a break."""

    condition: TriggerCondition
    for_s: float
    within_s: float
    """Simulated seconds from departure after which the trigger counts as not reached."""


@dataclass(frozen=True, slots=True)
class All:
    """Every one of them holds."""

    conditions: tuple[TriggerCondition, ...]

    def __call__(self, moment: Moment) -> bool:
        """Asks each."""
        return all(condition(moment) for condition in self.conditions)

    def __str__(self) -> str:
        return ", ".join(map(str, self.conditions))


@dataclass(frozen=True, slots=True)
class Not:
    """It does not hold."""

    condition: TriggerCondition

    def __call__(self, moment: Moment) -> bool:
        """Asks it."""
        return not self.condition(moment)

    def __str__(self) -> str:
        return f"not: {self.condition}"
