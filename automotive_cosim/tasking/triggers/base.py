"""What a trigger is, and how conditions are combined."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from automotive_cosim.cosim.moment import Moment

WALKING_MPS = 2.0
STANDING_MPS = 0.1
ANY = 1e9
"""Larger than any distance, speed or amount."""


class TriggerCondition(Protocol):
    """A predicate on one moment."""

    def __call__(self, moment: Moment) -> bool:
        """Whether it holds at a moment."""
        ...


@dataclass(frozen=True, slots=True)
class Trigger:
    """The situation that starts a task: ``condition`` has held for ``for_s`` without interruption."""

    condition: TriggerCondition
    for_s: float
    within_s: float
    """Simulated seconds from departure after which the trigger counts as not reached."""
    after_s: float = 0.0
    """Simulated seconds from departure before which it does not count: with it, both halves of a pair have been
    under way equally long, and clock, cabin and battery tell nothing."""


@dataclass(frozen=True, slots=True)
class All:
    """All of the conditions hold."""

    conditions: tuple[TriggerCondition, ...]

    def __call__(self, moment: Moment) -> bool:
        return all(condition(moment) for condition in self.conditions)

    def __str__(self) -> str:
        return ", ".join(map(str, self.conditions))


@dataclass(frozen=True, slots=True)
class Not:
    """The condition does not hold."""

    condition: TriggerCondition

    def __call__(self, moment: Moment) -> bool:
        return not self.condition(moment)

    def __str__(self) -> str:
        return f"not: {self.condition}"
