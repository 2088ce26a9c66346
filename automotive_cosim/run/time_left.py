"""Estimates how long the rest of a batch takes, from what its jobs have taken so far.

A worker that changes to another simulation warms it up first: that job is *cold* and takes the warm-up on top of
its own time. The own time depends on the kind of job (which agent acts) and on the scenario: it is expected to be
the mean over the warm jobs of that kind in that scenario, drawn towards the mean of the kind while few are known.
A warm-up takes what the cold jobs took beyond that, if its end is not told. Where workers tell how far they are, a
job that is half done counts as half a job, and so does a warm-up. A situation that does not arise costs its time
once for all jobs that wait for it. With these times the rest is played through the way the queue will hand it out.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Container, Hashable, Iterable, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field
from heapq import heapify, heappop, heappush
from statistics import fmean

from automotive_cosim.run.executor import Job
from automotive_cosim.run.queue import SimulationKey, next_simulation

TRIALS = 3
"""This many jobs of a kind must have ended in a warm simulation before it is known how long the others take."""
LEAST_SHARE, LEAST_S = 0.1, 15.0
"""If they tell how far they are, so much of one must be done instead, and so many seconds be spent on it: the first
seconds say little."""
DRAWN_BY = 2.0
"""The mean over all scenarios weighs as much as this many jobs of one; so does that over all earlier starts, which
may have been on another machine."""
ARISEN = 8.0
"""Most situations arise: this many count as having arisen before anything is known, of all and of each scenario."""
HALF = 0.5
"""A running job that does not tell how far it is counts as half a job with its time so far, since on average it is
half done: the short ones end first and would make the mean too small. One that is overdue is expected to take half
as long again."""
ODD = 3.0
"""A running job counts at most this many times the mean, as its situation may not arise."""
STEPS = 200
"""The rest is played through in about this many steps, however many jobs there are."""

Waiting = Mapping[SimulationKey, Mapping[Hashable, int]]


@dataclass(frozen=True, slots=True)
class JobTurn:
    """The time that a worker spends on a job."""

    job: Job
    is_cold: bool
    """Whether the worker had to warm up its simulation."""
    seconds: float
    """Seconds so far, or in total."""
    warm_up_s: float | None = None
    """Those that went into the warm-up; None if its end has not been told."""
    is_warming: bool = False
    """Whether it is told to be still in the warm-up."""
    share: float | None = None
    """How much of the warm-up is done, or after it of the job itself, 0 to 1; None if it is not told."""

    @property
    def scenario(self) -> str:
        """Where it takes place."""
        return self.job.simulation[0]

    @property
    def own_share(self) -> float | None:
        """How much of the job itself is done; None if it is not told, or its warm-up goes on."""
        return None if self.is_warming else self.share

    @property
    def own_s(self) -> float | None:
        """Seconds spent on the job itself; None if they are not known."""
        if not self.is_cold:
            return self.seconds
        return None if self.warm_up_s is None else self.seconds - self.warm_up_s


class Pace:
    """Is told how long each job took, and estimates how long the others will take."""

    def __init__(
        self, untried: Mapping[Hashable, SimulationKey], earlier: Iterable[JobTurn], weights: Mapping[str, float]
    ) -> None:
        """Knows only what was measured before.

        Args:
            untried: for each situation of which it is not known whether it arises, its simulation.
            earlier: jobs of earlier starts. The longest of each simulation is taken for a cold one.
            weights: of the warm-up in each scenario, see ``Job``."""
        self._weights = weights
        self._untried = dict(untried)
        self._own: dict[Hashable, _Means] = defaultdict(_Means)
        self._search = _Means(drawn_by=ARISEN)
        self._search.add("", 0.0, ARISEN)
        self._cold: list[JobTurn] = []
        self._has_begun = False
        self._telling: set[Hashable] = set()
        """Kinds of jobs that tell how far they are."""
        for (kind, scenario), seconds in _warm(earlier).items():
            self._own[kind].add(scenario, DRAWN_BY * fmean(seconds), DRAWN_BY)

    @property
    def timed(self) -> frozenset[Hashable]:
        """Kinds of which enough jobs have been measured."""
        return frozenset(kind for kind, means in self._own.items() if means.count >= TRIALS)

    def took(self, turn: JobTurn, *, is_out_of_reach: bool) -> None:
        """Takes note of a job that has ended; ``is_out_of_reach`` if its situation did not arise."""
        self._has_begun = True
        if self._untried.pop(turn.job.situation, None) is not None:
            self._search.add(turn.scenario, turn.seconds if is_out_of_reach else 0.0)
        if is_out_of_reach:
            return
        if turn.is_cold:
            self._cold.append(turn)
        if turn.own_s is not None:
            self._own[turn.job.kind].add(turn.scenario, turn.own_s)

    def left_s(
        self, waiting: Waiting, running: Sequence[JobTurn], idle: Sequence[SimulationKey | None]
    ) -> float | None:
        """Wall time until everything has ended; None while too little is known of some kind of waiting job.

        Args:
            waiting: how many jobs wait, by simulation and kind.
            idle: the warm simulation of each other worker, including those yet to be started."""
        if not self._knows(waiting, running, {*idle, *(turn.job.simulation for turn in running)}):
            return None
        expected = _Expected(self._own, self._cold, running, self._weights)
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
        places = [_Worker(expected.rest_s(turn), turn.job.simulation, is_busy=True) for turn in running]
        places += [_Worker(0.0, simulation) for simulation in idle]
        return _played_s(work, places)

    def _knows(self, waiting: Waiting, running: Sequence[JobTurn], held: Container[SimulationKey | None]) -> bool:
        """Whether there is a basis. A job alone in its simulation is cold, so only the sum of its times matters."""
        told: dict[Hashable, _Means] = defaultdict(_Means)
        for turn in running:
            if turn.own_share is not None and turn.own_s is not None:
                told[turn.job.kind].add(turn.scenario, turn.own_s, turn.own_share)
        needed: Counter[Hashable] = Counter()
        for simulation, kinds in waiting.items():
            if simulation in held or sum(kinds.values()) > 1:
                needed.update(kinds)

        def is_known(kind: Hashable) -> bool:
            ended, now = self._own[kind], told[kind]
            is_told = ended.count + now.count >= LEAST_SHARE and ended.total_s + now.total_s >= LEAST_S
            return ended.count >= min(TRIALS, max(1, needed[kind])) or (kind in self._telling and is_told)

        self._telling.update(told)
        return all(map(is_known, needed)) and (self._has_begun or any(map(is_known, tuple(told))))


@dataclass(slots=True)
class _Means:
    """Means by scenario, each drawn towards the mean of all."""

    drawn_by: float = DRAWN_BY
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
        """The mean; zero while nothing is known at all."""
        if not self.count:
            return 0.0
        sum_s, known = self.sums.get(scenario, (0.0, 0.0))
        return (sum_s + self.drawn_by * self.total_s / self.count) / (known + self.drawn_by)


def _warm(turns: Iterable[JobTurn]) -> dict[tuple[Hashable, str], list[float]]:
    """Seconds of the jobs by kind and scenario, without the longest one of each simulation."""
    longest: dict[SimulationKey, JobTurn] = {}
    found: dict[tuple[Hashable, str], list[float]] = defaultdict(list)
    for turn in sorted(turns, key=lambda turn: turn.seconds, reverse=True):
        if longest.setdefault(turn.job.simulation, turn) is not turn:
            found[turn.job.kind, turn.scenario].append(turn.seconds)
    return found


class _Expected:
    """How long jobs and warm-ups are expected to take."""

    def __init__(
        self,
        own: Mapping[Hashable, _Means],
        cold: Sequence[JobTurn],
        running: Sequence[JobTurn],
        weights: Mapping[str, float],
    ) -> None:
        self._weights = weights
        self._own = defaultdict(_Means, {kind: deepcopy(means) for kind, means in own.items() if means.count})
        self._warm_ups = _Means()
        for turn in running:
            kind, scenario = turn.job.kind, turn.scenario
            if turn.is_warming and turn.share is not None:
                self._warm_ups.add(scenario, turn.seconds / weights[scenario], turn.share)
            elif turn.own_share is not None and turn.own_s is not None:
                self._own[kind].add(scenario, turn.own_s, turn.own_share)
            elif not turn.is_cold and kind in self._own:
                self._own[kind].add(scenario, min(turn.seconds, ODD * own[kind].of(scenario)), HALF)
        told = [turn for turn in cold if turn.warm_up_s is not None]
        for turn in told or [turn for turn in cold if turn.job.kind in self._own] or cold:
            rest_s = max(0.0, turn.seconds - self.own_s(turn.job.kind, turn.scenario))
            warm_up_s = rest_s if turn.warm_up_s is None else turn.warm_up_s
            self._warm_ups.add(turn.scenario, warm_up_s / weights[turn.scenario])

    def own_s(self, kind: Hashable, scenario: str) -> float:
        """A job's time in a warm simulation; zero while nothing is known, so that all counts as warm-up."""
        return self._own[kind].of(scenario) if kind in self._own else 0.0

    def warm_up_s(self, scenario: str) -> float:
        """Additional seconds of a cold job."""
        return self._weights[scenario] * self._warm_ups.of(scenario)

    def rest_s(self, turn: JobTurn) -> float:
        """Remaining seconds of a running job."""
        own_s, warm_up_s = self.own_s(turn.job.kind, turn.scenario), self.warm_up_s(turn.scenario)
        if turn.is_warming and turn.share is not None:
            return (1 - turn.share) * warm_up_s + own_s
        if turn.own_share is not None and turn.own_s is not None:  # its own pace counts as far as it is
            return (1 - turn.own_share) * ((1 - turn.own_share) * own_s + turn.own_s)
        takes_s = own_s + (warm_up_s if turn.is_cold else 0.0)
        return max(takes_s - turn.seconds, HALF * turn.seconds)


@dataclass(frozen=True, slots=True)
class _Work:
    """The waiting jobs of one simulation."""

    count: int
    own_s: float
    """Of all of them together."""
    warm_up_s: float


@dataclass(order=True, slots=True)
class _Worker:
    """A worker while the rest is played through."""

    free_s: float
    """From now."""
    warm: SimulationKey | None = field(compare=False)
    is_busy: bool = field(default=False, compare=False)


def _played_s(work: Mapping[SimulationKey, _Work], places: list[_Worker]) -> float:
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
        heappush(places, _Worker(place.free_s + takes_s, simulation, is_busy=True))
    return end_s
