"""Several sessions whose cars share a road: each acts at instants of its own, and the road runs once for all.

What a car asks the road for at an instant is asked for before the road runs on. So a session goes on to its next
tick, waits there until every car has come as far, and only then drives.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf
from typing import Generic, TypeVar

from automotive_cosim.episode.session import TakesTime

R = TypeVar("R")


@dataclass(slots=True)
class _Act(Generic[R]):
    """What a car is doing."""

    passing: TakesTime[R]
    now_s: Callable[[], float]
    wakes_s: float = 0.0
    """Simulation time at which it goes on."""


class Fleet(Generic[R]):
    """What the cars of a road are doing, each from one of its instants to another."""

    def __init__(self, step_s: float) -> None:
        """Begins with nobody doing anything, on a road with steps of that length."""
        self._step_s = step_s
        self._acts: dict[str, _Act[R]] = {}
        self._done: dict[str, R] = {}

    @property
    def busy(self) -> frozenset[str]:
        """The cars that are doing something."""
        return frozenset(self._acts)

    def begin(self, car: str, passing: TakesTime[R], now_s: Callable[[], float]) -> None:
        """Lets a car do something; what it does at this instant is done at once.

        Args:
            car: its name.
            passing: what it does.
            now_s: gives the simulation time to which the car has driven.
        """
        self._acts[car] = _Act(passing, now_s)
        self._go_on(car)

    def run(self) -> dict[str, R]:
        """Lets the road run until a car has done what it was doing; the results of those that have.

        Raises TrafficError: the traffic simulation failed."""
        while self._acts and not self._done:
            self.go(self.wakes_s)
        return self.done()

    @property
    def wakes_s(self) -> float:
        """Simulation time at which the next car goes on; infinite if none does anything."""
        return min((act.wakes_s for act in self._acts.values()), default=inf)

    def go(self, until_s: float) -> None:
        """Lets the cars go on whose time has come by then. Raises TrafficError: the traffic simulation failed."""
        for car in [car for car, act in self._acts.items() if act.wakes_s <= until_s + self._step_s / 2]:
            self._go_on(car)

    def done(self) -> dict[str, R]:
        """The results of the cars that have done what they were doing since this was last called."""
        done, self._done = self._done, {}
        return done

    def _go_on(self, car: str) -> None:
        """Lets a car do what is due up to its next tick."""
        act = self._acts[car]
        try:
            tick_s = next(act.passing)
        except StopIteration as over:
            del self._acts[car]
            self._done[car] = over.value
        else:
            act.wakes_s = act.now_s() + round(tick_s / self._step_s) * self._step_s
