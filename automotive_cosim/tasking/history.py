"""Checks of what happened in between: an order, a length of time, a time of day, a wait, what held meanwhile."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from automotive_cosim.cosim.moment import Moment
from automotive_cosim.tasking.checks import Check


@dataclass(frozen=True, slots=True)
class After:
    """One thing came true no earlier than another had, and still is."""

    first: Check
    then: Check

    @property
    def writes(self) -> frozenset[str]:
        return self.first.writes | self.then.writes

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether ``then`` holds, and did not before ``first`` had held."""
        if not self.then.holds(start, now, trace):
            return False
        for at, moment in enumerate(trace):
            until = trace[: at + 1]
            if self.first.holds(start, moment, until):
                return True
            if self.then.holds(start, moment, until):
                return False
        return False

    def __str__(self) -> str:
        return f"{self.then}, after {self.first}"


@dataclass(frozen=True, slots=True)
class Lasted:
    """Something held without a break for a time within two bounds, and no longer does."""

    check: Check
    from_s: float
    to_s: float

    @property
    def writes(self) -> frozenset[str]:
        return self.check.writes

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether its longest stretch is within the bounds and over."""
        longest_s, since_s = 0.0, None
        for at, moment in enumerate(trace):
            if not self.check.holds(start, moment, trace[: at + 1]):
                since_s = None
                continue
            since_s = moment.time_s if since_s is None else since_s
            longest_s = max(longest_s, moment.time_s - since_s)
        return since_s is None and self.from_s <= longest_s <= self.to_s

    def __str__(self) -> str:
        return f"for {self.from_s:g} to {self.to_s:g} s and no longer: {self.check}"


@dataclass(frozen=True, slots=True)
class NotBefore:
    """Something holds, and did at no moment before a time of day."""

    check: Check
    clock: str
    """Local hours and minutes, as ``22:00``, of the same day."""

    @property
    def writes(self) -> frozenset[str]:
        return self.check.writes

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether it holds and came true at that time or later."""
        return self.check.holds(start, now, trace) and not any(
            self.check.holds(start, moment, trace[: at + 1])
            for at, moment in enumerate(trace)
            if f"{moment.local_time:%H:%M}" < self.clock
        )

    def __str__(self) -> str:
        return f"not before {self.clock}: {self.check}"


@dataclass(frozen=True, slots=True)
class Watched:
    """So much time has passed since the hand-over: who was asked to watch has not ended it before."""

    seconds: float

    @property
    def writes(self) -> frozenset[str]:
        return frozenset()

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        return now.time_s - start.time_s >= self.seconds - 1e-9

    def __str__(self) -> str:
        return f"watched for {self.seconds:g} s"


@dataclass(frozen=True, slots=True)
class While:
    """As long as one thing held, another did; the one held for some time."""

    condition: Check
    check: Check
    for_s: float
    """Least time for which the condition must have held in all."""

    @property
    def writes(self) -> frozenset[str]:
        return self.condition.writes | self.check.writes

    def holds(self, start: Moment, now: Moment, trace: Sequence[Moment]) -> bool:
        """Whether the check held at every moment at which the condition did."""
        held_s, before_s = 0.0, trace[0].time_s
        for at, moment in enumerate(trace):
            until = trace[: at + 1]
            if self.condition.holds(start, moment, until):
                if not self.check.holds(start, moment, until):
                    return False
                held_s += moment.time_s - before_s
            before_s = moment.time_s
        return held_s >= self.for_s

    def __str__(self) -> str:
        return f"{self.check}, while {self.condition} ({self.for_s:g} s or more)"
