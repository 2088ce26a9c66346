"""Which job a worker gets next: one of the simulation that it has warm, so that few are warmed up twice."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Container, Hashable, Iterable, Mapping
from typing import Generic

from automotive_cosim.run.executor import J

Simulation = tuple[str, int]
SHARED_FROM = 4
"""So many jobs must be left of a simulation for a second worker to warm it up too."""


def next_simulation(
    left: Mapping[Simulation, int], warm: Simulation | None, busy: Mapping[Simulation | None, int]
) -> Simulation | None:
    """What a worker turns to: the simulation it has, else one that nobody has, else one that is worth sharing.

    Args:
        left: jobs that wait, by simulation; at least one each.
        warm: what the worker ran last.
        busy: how many workers run which.
    """
    if warm in left:
        return warm
    free = [each for each in left if not busy.get(each)] or [each for each in left if left[each] >= SHARED_FROM]
    return max(free, key=lambda each: left[each], default=None)


class JobQueue(Generic[J]):
    """Jobs that wait, by simulation and kind."""

    def __init__(self, jobs: Iterable[J]) -> None:
        self._groups: dict[Simulation, dict[Hashable, deque[J]]] = {}
        self._left: Counter[Simulation] = Counter()
        for job in jobs:
            self.put(job)

    def put(self, job: J) -> None:
        """Adds a job."""
        self._groups.setdefault(job.simulation, {}).setdefault(job.kind, deque()).append(job)
        self._left[job.simulation] += 1

    def take(
        self, warm: Simulation | None, busy: Mapping[Simulation | None, int], timed: Container[Hashable]
    ) -> J | None:
        """The next job for a worker, of ``next_simulation``.

        Args:
            warm: what the worker ran last.
            busy: how many workers run which.
            timed: kinds of which it is known how long they take; others go first where it can be told, which is in
                a warm simulation, and last in a cold one.
        """
        simulation = next_simulation(self._left, warm, busy)
        if simulation is None:
            return None
        kinds = self._groups[simulation]
        kind = next((kind for kind in kinds if (kind in timed) is not (simulation == warm)), next(iter(kinds)))
        job = kinds[kind][0]
        self.remove(job)
        return job

    def remove(self, job: J) -> bool:
        """Takes a certain job; false if it does not wait."""
        kinds = self._groups.get(job.simulation, {})
        if job not in kinds.get(job.kind, ()):
            return False
        kinds[job.kind].remove(job)
        if not kinds[job.kind]:
            del kinds[job.kind]
        self._left[job.simulation] -= 1
        if not self._left[job.simulation]:
            del self._left[job.simulation], self._groups[job.simulation]
        return True

    def counts(self) -> dict[Simulation, dict[Hashable, int]]:
        """How many wait."""
        return {
            simulation: {kind: len(jobs) for kind, jobs in kinds.items()}
            for simulation, kinds in self._groups.items()
        }

    def __bool__(self) -> bool:
        return bool(self._groups)
