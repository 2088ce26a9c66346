"""Which job a worker gets next: preferably one of its own warm simulation, so that few are warmed up twice."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Container, Hashable, Iterable, Mapping
from itertools import count
from typing import Generic

from automotive_cosim.run.executor import J

SimulationKey = tuple[str, int]
SHARED_FROM = 4
"""This many jobs must be waiting for a simulation before a second worker warms it up too."""


def next_simulation(
    left: Mapping[SimulationKey, int], warm: SimulationKey | None, busy: Mapping[SimulationKey | None, int]
) -> SimulationKey | None:
    """The simulation for a worker: its own, else one that no worker has, else one that is worth sharing.

    Args:
        left: number of waiting jobs by simulation, at least one each.
        warm: the simulation that the worker ran last.
        busy: number of workers that run each."""
    if warm in left:
        return warm
    free = [each for each in left if not busy.get(each)] or [each for each in left if left[each] >= SHARED_FROM]
    return max(free, key=lambda each: left[each], default=None)


class JobQueue(Generic[J]):
    """Waiting jobs by simulation and kind."""

    def __init__(self, jobs: Iterable[J]) -> None:
        self._groups: dict[SimulationKey, dict[Hashable, deque[tuple[int, J]]]] = {}
        self._numbers = count()
        self._left: Counter[SimulationKey] = Counter()
        for job in jobs:
            self.put(job)

    def put(self, job: J) -> None:
        self._groups.setdefault(job.simulation, {}).setdefault(job.kind, deque()).append((next(self._numbers), job))
        self._left[job.simulation] += 1

    def take(
        self, warm: SimulationKey | None, busy: Mapping[SimulationKey | None, int], timed: Container[Hashable]
    ) -> J | None:
        """The next job for a worker, of ``next_simulation``.

        Args:
            warm: the simulation that the worker ran last.
            busy: number of workers that run each.
            timed: kinds whose duration is known. The others go first in a warm simulation, where it can be
                measured, and last in a cold one."""
        simulation = next_simulation(self._left, warm, busy)
        if simulation is None:
            return None
        kinds = self._groups[simulation]
        wanted = [kind for kind in kinds if (kind in timed) is not (simulation == warm)] or list(kinds)
        _, job = min(kinds[kind][0] for kind in wanted)
        self.remove(job)
        return job

    def remove(self, job: J) -> bool:
        """Takes a particular job; false if it is not waiting."""
        kinds = self._groups.get(job.simulation, {})
        waiting = kinds.get(job.kind, deque())
        place = next((place for place, (_, each) in enumerate(waiting) if each == job), None)
        if place is None:
            return False
        del waiting[place]
        if not kinds[job.kind]:
            del kinds[job.kind]
        self._left[job.simulation] -= 1
        if not self._left[job.simulation]:
            del self._left[job.simulation], self._groups[job.simulation]
        return True

    def counts(self) -> dict[SimulationKey, dict[Hashable, int]]:
        """The number of waiting jobs."""
        return {
            simulation: {kind: len(jobs) for kind, jobs in kinds.items()}
            for simulation, kinds in self._groups.items()
        }

    def __bool__(self) -> bool:
        return bool(self._groups)
