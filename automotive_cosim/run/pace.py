"""How long the rest of a batch takes, from what its jobs have taken so far.

A worker that turns to another simulation warms it up first: that job is *cold* and takes the warm-up beside its own
time. The own time goes by the kind of job (who acts) and by the scenario: it is expected to be the mean over the
warm jobs of that kind in that scenario, drawn towards the mean of the kind while few are known. A warm-up is what
the cold jobs took beyond that. A situation that does not come about takes its time once for all jobs that wait for
it. With these times the rest is played through as the queue will hand it out.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Container, Hashable, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field
from heapq import heapify, heappop, heappush

from automotive_cosim.run.executor import Job
from automotive_cosim.run.queue import Simulation, next_simulation

TRIALS = 3
"""So many jobs of a kind must have ended in a warm simulation before it is known how long the others take."""
DRAWN_BY = 2.0
"""What is known of all scenarios weighs as much as so many jobs of one."""
HALF = 0.5
"""A running job counts as half a job of its time so far, as on average it is half done: the short ones end first
and would make the mean too small. One that is overdue is expected to take half as long again."""
STEPS = 200
"""The rest is played through in about so many steps, however many jobs there are."""

Waiting = Mapping[Simulation, Mapping[Hashable, int]]


@dataclass(frozen=True, slots=True)
class Turn:
    """A worker's time with a job."""

    job: Job
    is_cold: bool
    """The worker had to warm the simulation up."""
    seconds: float
    """So far, or in all."""

    @property
    def scenario(self) -> str:
        """Where it takes place."""
        return self.job.simulation[0]


class Pace:
    """Hears how long each job took and says how long the others will take."""

    def __init__(self, untried: Mapping[Hashable, Simulation]) -> None:
        """Knows of no job yet.

        Args:
            untried: the simulation of each situation of which it is not known whether it comes about.
        """
        self._untried = dict(untried)
        self._own: dict[Hashable, _Means] = defaultdict(_Means)
        self._search = _Means()
        self._cold: list[Turn] = []

    @property
    def timed(self) -> frozenset[Hashable]:
        """Kinds of which enough jobs are known."""
        return frozenset(kind for kind, means in self._own.items() if means.count >= TRIALS)

    def took(self, turn: Turn, *, is_out_of_reach: bool) -> None:
        """A job has ended, well or not; ``is_out_of_reach`` says that its situation did not come about."""
        if self._untried.pop(turn.job.situation, None) is not None:
            self._search.add(turn.scenario, turn.seconds if is_out_of_reach else 0.0)
        if is_out_of_reach:
            return
        if turn.is_cold:
            self._cold.append(turn)
        else:
            self._own[turn.job.kind].add(turn.scenario, turn.seconds)

    def left_s(self, waiting: Waiting, running: Sequence[Turn], idle: Sequence[Simulation | None]) -> float | None:
        """Wall time until everything has ended; None while too little is known of a kind of job that waits.

        Args:
            waiting: how many jobs wait, by simulation and kind.
            running: the jobs that workers have.
            idle: what each of the other workers, also of those yet to be started, has warm.
        """
        if not self._knows(waiting, {*idle, *(turn.job.simulation for turn in running)}):
            return None
        expected = _Expected(self._own, self._cold, running)
        untried = Counter(self._untried.values())
        work = {
            simulation: _Work(
                sum(kinds.values()),
                sum(count * expected.own_s(kind, simulation[0]) for kind, count in kinds.items())
                + untried[simulation] * self._search.of(simulation[0]),
                expected.warm_up_s(simulation[0]),
            )
            for simulation, kinds in waiting.items()
        }
        places = [_Place(expected.rest_s(turn), turn.job.simulation, is_busy=True) for turn in running]
        places += [_Place(0.0, simulation) for simulation in idle]
        return _played_s(work, places)

    def _knows(self, waiting: Waiting, held: Container[Simulation | None]) -> bool:
        """A job that is alone in its simulation is cold: its own time need not be known apart from the warm-up."""
        needed: Counter[Hashable] = Counter()
        for simulation, kinds in waiting.items():
            if simulation in held or sum(kinds.values()) > 1:
                needed.update(kinds)
        known = all(self._own[kind].count >= min(TRIALS, count) for kind, count in needed.items())
        return known and (bool(self._cold) or any(means.count for means in self._own.values()))


@dataclass(slots=True)
class _Means:
    """Means by scenario, each drawn towards the mean of all."""

    sums: dict[str, tuple[float, float]] = field(default_factory=dict)
    """By scenario, seconds and number of jobs."""
    total_s: float = 0.0
    count: float = 0.0

    def add(self, scenario: str, seconds: float, count: float = 1.0) -> None:
        sum_s, known = self.sums.get(scenario, (0.0, 0.0))
        self.sums[scenario] = sum_s + seconds, known + count
        self.total_s += seconds
        self.count += count

    def of(self, scenario: str) -> float:
        """Zero while nothing is known at all."""
        if not self.count:
            return 0.0
        sum_s, known = self.sums.get(scenario, (0.0, 0.0))
        return (sum_s + DRAWN_BY * self.total_s / self.count) / (known + DRAWN_BY)


class _Expected:
    """How long jobs and warm-ups are expected to take."""

    def __init__(self, own: Mapping[Hashable, _Means], cold: Sequence[Turn], running: Sequence[Turn]) -> None:
        self._own = {kind: deepcopy(means) for kind, means in own.items() if means.count}
        for turn in running:
            if not turn.is_cold and turn.job.kind in self._own:
                self._own[turn.job.kind].add(turn.scenario, turn.seconds, HALF)
        self._warm_ups = _Means()
        for turn in [turn for turn in cold if turn.job.kind in self._own] or cold:
            self._warm_ups.add(turn.scenario, max(0.0, turn.seconds - self.own_s(turn.job.kind, turn.scenario)))

    def own_s(self, kind: Hashable, scenario: str) -> float:
        """A job's time in a warm simulation; zero while nothing is known, so that all counts as warm-up."""
        return self._own[kind].of(scenario) if kind in self._own else 0.0

    def warm_up_s(self, scenario: str) -> float:
        """What a cold job takes more."""
        return self._warm_ups.of(scenario)

    def rest_s(self, turn: Turn) -> float:
        """What a running job will yet take."""
        takes_s = self.own_s(turn.job.kind, turn.scenario)
        takes_s += self.warm_up_s(turn.scenario) if turn.is_cold else 0.0
        return max(takes_s - turn.seconds, HALF * turn.seconds)


@dataclass(frozen=True, slots=True)
class _Work:
    """What waits of one simulation."""

    count: int
    own_s: float
    """Of all together."""
    warm_up_s: float


@dataclass(order=True, slots=True)
class _Place:
    """A worker while the rest is played through."""

    free_s: float
    """From now."""
    warm: Simulation | None = field(compare=False)
    is_busy: bool = field(default=False, compare=False)


def _played_s(work: Mapping[Simulation, _Work], places: list[_Place]) -> float:
    """When the last worker ends, if everything takes as long as expected."""
    left = {simulation: each.count for simulation, each in work.items()}
    busy = Counter(place.warm for place in places if place.is_busy)
    at_once = max(1, sum(left.values()) // STEPS)
    end_s = 0.0
    heapify(places)
    while places:
        place = heappop(places)
        end_s = max(end_s, place.free_s)
        if place.is_busy:
            busy[place.warm] -= 1
        simulation = next_simulation(left, place.warm, busy)
        if simulation is None:
            continue
        each, count = work[simulation], min(at_once, left[simulation])
        takes_s = each.own_s * count / each.count + (0.0 if simulation == place.warm else each.warm_up_s)
        left[simulation] -= count
        if not left[simulation]:
            del left[simulation]
        busy[simulation] += 1
        heappush(places, _Place(place.free_s + takes_s, simulation, is_busy=True))
    return end_s
