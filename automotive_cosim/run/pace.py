"""Estimates how long the rest of a batch takes, from what its jobs have taken so far.

A worker that changes to another simulation warms it up first: that job is *cold* and takes the warm-up on top of
its own time. The own time depends on the kind of job (which agent acts) and on the scenario. So a job is expected
to take the mean of the warm jobs of its kind in its scenario, drawn towards the mean of its kind while few are
known, and a warm-up what the cold ones took beyond that. The sum is divided by the workers that have work.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic

from automotive_cosim.run.executor import J

SimulationKey = tuple[str, int]
SHARED_FROM = 4
"""This many jobs must wait for a simulation before a second worker warms it up too."""
DRAWN_BY = 2.0
"""The mean over all scenarios weighs as much as this many jobs of one."""


@dataclass(frozen=True, slots=True)
class JobTurn(Generic[J]):
    """The time that a worker spends on a job."""

    job: J
    is_cold: bool
    """Whether the worker had to warm up its simulation."""
    seconds: float
    """Seconds so far, or in total."""


@dataclass(slots=True)
class _Means:
    """Means by scenario, each drawn towards the mean of all."""

    scenarios: dict[str, tuple[float, int]] = field(default_factory=dict)
    total_s: float = 0.0
    count: int = 0

    def add(self, scenario: str, seconds: float) -> None:
        total_s, count = self.scenarios.get(scenario, (0.0, 0))
        self.scenarios[scenario] = total_s + seconds, count + 1
        self.total_s += seconds
        self.count += 1

    def of(self, scenario: str) -> float:
        """The mean; zero while nothing is known at all."""
        if not self.count:
            return 0.0
        total_s, count = self.scenarios.get(scenario, (0.0, 0))
        return (total_s + DRAWN_BY * self.total_s / self.count) / (count + DRAWN_BY)


class Pace:
    """Is told how long each job took, and estimates how long the others will take."""

    def __init__(self) -> None:
        self._own: dict[Hashable, _Means] = defaultdict(_Means)
        self._cold: list[JobTurn[Any]] = []

    def took(self, turn: JobTurn[Any]) -> None:
        """Takes note of a job that has ended, with or without an error."""
        if turn.is_cold:
            self._cold.append(turn)
        else:
            self._own[turn.job.kind].add(turn.job.simulation[0], turn.seconds)

    def left_s(
        self, waiting: Mapping[SimulationKey, Mapping[Hashable, int]], running: Sequence[JobTurn[Any]], workers: int
    ) -> float | None:
        """Wall time until everything has ended; None while nothing is known of some kind of job.

        Args:
            waiting: how many jobs wait, by simulation and kind, in the order in which they are taken.
            running: the jobs that workers are running.
            workers: how many there are or may be.
        """
        warm_ups = self._warm_ups()
        busy = Counter(turn.job.simulation for turn in running)
        works_s = [max(0.0, self._takes_s(turn, warm_ups) - turn.seconds) for turn in running]
        longest_s, seats = max(works_s, default=0.0), len(running)
        for simulation, kinds in waiting.items():
            held, count = busy[simulation], sum(kinds.values())
            if any(not self._own[kind].count and (held or count > 1) for kind in kinds):
                return None
            work_s = sum(self._own[kind].of(simulation[0]) * number for kind, number in kinds.items())
            work_s += 0.0 if held else warm_ups.of(simulation[0])
            free = max(0 if held else 1, count - SHARED_FROM + (1 if held else 0))
            works_s.append(work_s)
            longest_s = max(longest_s, work_s / min(workers, held + free))
            seats += free
        shared = min(workers, seats)
        if not shared or not (self._cold or self._own):
            return None
        again = max(0, shared - len({*waiting, *busy}))
        return max(longest_s, (sum(works_s) + again * warm_ups.of("")) / shared)

    def _takes_s(self, turn: JobTurn[Any], warm_ups: _Means) -> float:
        scenario = turn.job.simulation[0]
        return self._own[turn.job.kind].of(scenario) + (warm_ups.of(scenario) if turn.is_cold else 0.0)

    def _warm_ups(self) -> _Means:
        found = _Means()
        known = [turn for turn in self._cold if self._own[turn.job.kind].count] or self._cold
        for turn in known:
            scenario = turn.job.simulation[0]
            found.add(scenario, max(0.0, turn.seconds - self._own[turn.job.kind].of(scenario)))
        return found
