"""Runs jobs in workers; finished jobs stay finished, however the run ends.

Jobs depend only on their setup, so neither their order, nor the number of workers, nor where they run affects the
results.
"""

from __future__ import annotations

import json
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Hashable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar

from automotive_cosim.contracts import Json
from automotive_cosim.errors import BudgetSpentError, InfrastructureError, NoRoomError, TriggerNotReachedError
from automotive_cosim.formats.files import read_json
from automotive_cosim.formats.layout import PICTURES, TRACES
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.run import worker
from automotive_cosim.run.budget import MeterHandle, Spent
from automotive_cosim.run.executor import CannotWrite, Executor, J, LostError, Opener, R, Runner, Worker, failed
from automotive_cosim.run.job_row import JobRow, from_json
from automotive_cosim.run.plan import Plan
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.queue import JobQueue, SimulationKey
from automotive_cosim.run.rows import TrialRow, kind_of
from automotive_cosim.run.settings import Budget, Pictures
from automotive_cosim.run.store import RowKind, Store, cannot_write, opened
from automotive_cosim.run.time_left import JobTurn, Pace
from automotive_cosim.run.trial import TrialSetup

FINAL_KINDS = frozenset({TriggerNotReachedError.__name__, NoRoomError.__name__})
"""Errors that are certain to recur, so retrying is useless."""
PATIENCE_S = 600.0
"""Wall time that a batch waits for its first worker, or for another one when all have died."""
SPENT = "spent.json"
"""File of an evaluation with a budget that says how much of it is spent."""
TELL_S = 10.0
"""Wall time after which progress is told again, though no job has ended: the first ones wait for their traffic."""
STILLBORN = 3
"""How many times in a row all workers may die before they are ready."""


@dataclass(frozen=True, slots=True)
class Progress(Generic[R]):
    """The progress of a run, counted in rows: a fleet has one for each car."""

    planned: int
    done: int
    """Those that need no further run, including those of earlier starts."""
    judged: int
    successes: int
    errors: int
    ran: int
    """Those that ended since this start."""
    seconds: float
    """Wall time since this start."""
    left_s: float | None
    """Wall time to the end, as estimated by ``Pace``; None while there is no basis for an estimate."""
    ended: R | None
    """The row of the job that has just ended; None at the start, and while all are running."""
    doing: tuple[str, ...] = ()
    """What workers say that they are doing for their jobs, each once."""
    budget: str = ""
    """What is left of the budget; empty without one."""
    stopped: str = ""
    """Why the rest is not run; empty if it is run or nothing is left."""


class _BatchPlan(Protocol):
    """What a batch runs; ``check`` raises a UserError for what does not exist or is out of range."""

    def check(self) -> object: ...

    def as_json(self) -> Json: ...

    def jobs(self) -> Sequence[Any]: ...


P = TypeVar("P", bound=_BatchPlan)


def kept(
    plan: _BatchPlan, folder: Path, row: RowKind[R], parts: tuple[str, ...] = ()
) -> AbstractContextManager[Store[R]]:
    """Checks a plan and opens its folder, new or to be resumed, whoever runs its jobs: workers or people.

    Raises UserError: the plan does not fit, or the folder cannot take its results."""
    plan.check()
    return opened(folder, plan.as_json(), row, parts, planned=sum(len(job.row_ids) for job in plan.jobs()))


@dataclass(frozen=True, slots=True)
class BatchKind(Generic[P, J, R]):
    """A kind of batch: what its workers do, and what comes of it."""

    row: RowKind[R]
    """Kind of its rows."""
    opener: Callable[..., AbstractContextManager[Runner[J, R]]]
    """Makes the runner of each worker, if it asks models, from the meter that they share."""
    parts: tuple[str, ...] = ()
    """Folders in its results folder."""
    asks_models: bool = False
    rounds: Callable[[P, Store[R]], Iterator[Sequence[J]]] = lambda plan, store: iter([plan.jobs()])
    """The jobs to run, and then, by what came of them, more."""

    def run(
        self,
        plan: P,
        folder: Path,
        *,
        executor: Executor = Processes(),  # noqa: B008, frozen
        retries: int = 1,
        budget: Budget = Budget(),  # noqa: B008, frozen
        tell: Callable[[Progress[R]], None] = lambda progress: None,
    ) -> Progress[R]:
        """Runs the remaining jobs of a plan; arguments and errors are those of ``run_plan``."""
        with (
            kept(plan, folder, self.row, self.parts) as store,
            executor.metered(budget, spent_before(store)) if self.asks_models else nullcontext() as meter,
        ):
            opener = self.opener if meter is None else partial(self.opener, meter)
            limit = meter if budget.is_limited else None
            end: Progress[R] | None = None
            for jobs in self.rounds(plan, store):
                end = run_jobs(
                    jobs, store, opener, executor=executor, retries=retries, limit=limit, budget=budget, tell=tell
                )
        assert end is not None  # a plan without a job is refused
        return end


def run_plan(
    plan: Plan,
    folder: Path,
    *,
    executor: Executor = Processes(),  # noqa: B008, frozen
    retries: int = 2,
    pictures: Pictures = Pictures.NONE,
    budget: Budget = Budget(),  # noqa: B008, frozen
    tell: Callable[[Progress[TrialRow]], None] = lambda progress: None,
) -> Progress[TrialRow]:
    """Runs the remaining trials of a plan and retries those that ended in an error.

    Args:
        folder: results folder, new or to be resumed.
        executor: where to run it; the results do not depend on it.
        retries: how many times a trial is retried after an infrastructure error before the error is recorded.
        budget: what it may spend on its models, with all earlier starts. Once it is spent, the rest is not run.
        tell: called at the start, after every trial, and in between if that takes long.

    Raises:
        UserError: the plan names something that does not exist, or the folder cannot take its results.
        InfrastructureError: no worker becomes available.
        KeyboardInterrupt: passed on; only the running trials are lost."""
    kind: BatchKind[Plan, TrialSetup, TrialRow] = BatchKind(
        kind_of, partial(worker.trials, pictures), (TRACES, PICTURES), asks_models=True
    )
    return kind.run(plan, folder, executor=executor, retries=retries, budget=budget, tell=tell)


def run_jobs(
    jobs: Sequence[J],
    store: Store[R],
    opener: Opener[J, R],
    *,
    executor: Executor = Processes(),  # noqa: B008, frozen
    retries: int = 2,
    limit: MeterHandle | None = None,
    budget: Budget = Budget(),  # noqa: B008, frozen
    tell: Callable[[Progress[R]], None] = lambda progress: None,
) -> Progress[R]:
    """Runs the jobs that have no row yet, or the row of an error.

    Args:
        store: where the rows are read and written.
        opener: makes the runner of each worker.
        retries: how many times a job is retried after an error before its row is written.
        limit: the meter of its budget, if it has one. Once it is spent, the rest is not run.
        budget: what the meter counts against, to tell what is left of it.
        tell: called at the start, after every job, and in between if that takes long.

    Raises:
        as ``run_plan``."""
    batch = _Batch(store, jobs, opener, executor, retries, tell, limit, budget)
    try:
        batch.run()
    finally:
        batch.close()
    return batch.progress


@dataclass(eq=False)
class _Place(Generic[J, R]):
    """A worker, and the job it has."""

    worker: Worker[J, R]
    job: J | None = None
    since_s: float = 0.0
    """When it was given the job (monotonic clock)."""
    is_cold: bool = True
    """Whether it has to warm up the simulation for the job."""
    warm: SimulationKey | None = None
    """The simulation it ran last."""
    warm_up_s: float | None = None
    """How long the warm-up for the job took, as the worker told its beginning and end."""
    is_warming: bool = False

    def give(self, job: J) -> None:
        self.is_cold = self.warm != job.simulation
        self.job, self.since_s, self.warm = job, time.monotonic(), job.simulation
        self.warm_up_s, self.is_warming = None, False
        self.worker.give(job)

    def note_phase(self) -> None:
        """Takes note of how far the worker is."""
        was_warming, self.is_warming = self.is_warming, self.worker.phase.is_warm_up
        if was_warming and not self.is_warming:
            self.warm_up_s = time.monotonic() - self.since_s

    def turn(self, job: J) -> JobTurn:
        """How long it has worked on its job, and how far it is."""
        seconds = time.monotonic() - self.since_s
        return JobTurn(job, self.is_cold, seconds, self.warm_up_s, self.is_warming, self.worker.phase.share)


@dataclass(slots=True)
class _RowCounts:
    """The newest rows, counted as they come."""

    judged: int = 0
    successes: int = 0
    errors: int = 0
    closed: int = 0
    """Rows that need no further run."""

    def count(self, row: JobRow | None, by: int = 1) -> None:
        if row is not None:
            self.judged += by * (row.error is None)
            self.successes += by * row.has_succeeded
            self.errors += by * (row.error is not None)
            self.closed += by * (not is_open(row))


class _Batch(Generic[J, R]):
    def __init__(
        self,
        store: Store[R],
        jobs: Sequence[J],
        opener: Opener[J, R],
        executor: Executor,
        retries: int,
        tell: Callable[[Progress[R]], None],
        limit: MeterHandle | None,
        budget: Budget,
    ) -> None:
        self._store = store
        self._opener = opener
        self._executor = executor
        self._jobs = {job.id: job for job in jobs}
        self._retries = retries
        self._tell = tell
        self._limit = limit
        self._budget = budget
        self._spent_before = Spent() if limit is None else limit.spent()
        self._stopped = ""
        self._began_s = time.monotonic()
        self._ran = self._given_up = self._stillborn = 0
        self._newest: R | None = None
        self._failures: dict[str, list[str]] = defaultdict(list)
        self._places: list[_Place[J, R]] = []
        self._queue = JobQueue(job for job in jobs if is_open(self._row(job)))
        self._counts = _RowCounts()
        self._alike: dict[Hashable, list[J]] = defaultdict(list)
        """Jobs that wait for the same situation."""
        earlier: list[JobTurn] = []
        tried: set[Hashable] = set()
        for job in jobs:
            situation, row = job.situation, self._row(job)
            self._alike[situation].append(job)
            for each in self._rows(job):
                self._counts.count(each)
            if row is not None and not is_open(row):
                tried.add(situation)
                if row.error is None:
                    earlier.append(JobTurn(job, False, row.wall_seconds))
        untried = {each: alike[0].simulation for each, alike in self._alike.items() if each not in tried}
        weights = {job.simulation[0]: job.warm_up_weight for job in jobs}
        self._pace = Pace(untried, earlier, weights)

    def run(self) -> None:
        self._tell(self.progress)
        for job in self._jobs.values():
            if (row := self._row(job)) is not None:
                self._give_up_like(job, row)
        while self._goes_on() or any(place.job for place in self._places):
            while self._goes_on() and len(self._places) < self._executor.count:
                self._places.append(_Place(self._executor.start(self._opener, self._store.folder)))
            if self._goes_on():
                self._hand_out()
            self._wait()

    def _row(self, job: J) -> R | None:
        """Its row; of several, one for which it must run again, if there is any."""
        rows = self._rows(job)
        return next(filter(is_open, rows), rows[0])

    def _rows(self, job: J) -> list[R | None]:
        return [self._store.rows.get(each) for each in job.row_ids]

    def close(self) -> None:
        for place in self._places:
            place.worker.end(at_once=place.job is not None)
        self._places.clear()

    @property
    def progress(self) -> Progress[R]:
        counts, spent = self._counts, None if self._limit is None else self._limit.spent()
        return Progress(
            planned=sum(len(job.row_ids) for job in self._jobs.values()),
            done=counts.closed + self._given_up,
            judged=counts.judged,
            successes=counts.successes,
            errors=counts.errors,
            ran=self._ran,
            seconds=time.monotonic() - self._began_s,
            left_s=self._expected_s(spent),
            budget="" if spent is None else spent.left_of(self._budget),
            ended=self._newest,
            stopped=self._stopped,
            doing=tuple(dict.fromkeys(place.worker.phase.words for place in self._places if place.job)),
        )

    def _expected_s(self, spent: Spent | None) -> float | None:
        """Until everything has ended, or the budget is spent at the present rate."""
        running = [place.turn(place.job) for place in self._places if place.job]
        idle = [place.warm for place in self._places if not place.job]
        idle += [None] * (self._executor.count - len(self._places))
        left_s = self._pace.left_s(self._queue.counts(), running, idle)
        if left_s is None or spent is None:
            return left_s
        used = spent.share_of(self._budget)
        since = used - self._spent_before.share_of(self._budget)
        return min(left_s, (time.monotonic() - self._began_s) * (1 - used) / since) if since else left_s

    def _hand_out(self) -> None:
        for place in self._places:
            if place.job is None and place.worker.is_ready:
                busy = Counter(other.warm for other in self._places if other.job)
                job = self._queue.take(place.warm, busy, self._pace.timed)
                if job is not None:
                    place.give(job)

    def _wait(self) -> None:
        """Waits until a worker answers, dies, becomes ready or exceeds its time limit; tells of it meanwhile."""
        awaited = [place for place in self._places if place.job or not place.worker.is_ready]
        handles = {handle: place for place in awaited for handle in place.worker.handles}
        now_s = time.monotonic()
        ends_s = [place.since_s + place.job.wall_s for place in awaited if place.job]
        left_s = max(0.0, min(ends_s, default=now_s + PATIENCE_S) - now_s)
        ready = self._executor.wait(list(handles), min(left_s, TELL_S) if ends_s else left_s)
        if ends_s and not ready:
            self._tell(replace(self.progress, ended=None))
        if not ends_s and not ready:
            raise InfrastructureError(f"no worker became ready in {PATIENCE_S:g} s; rerun the command to resume")
        for place in {handles[handle]: None for handle in ready}:
            self._answered(place)
        for place in awaited:
            if place.job and time.monotonic() - place.since_s >= place.job.wall_s:
                self._lost(place, "WallTime", f"took longer than {place.job.wall_s:g} s of wall time")

    def _answered(self, place: _Place[J, R]) -> None:
        try:
            answer = place.worker.answer()
        except LostError as error:
            self._lost(place, "WorkerDied", str(error))
            return
        if isinstance(answer, CannotWrite):
            raise cannot_write(self._store.folder, answer.error)
        if answer is None:
            self._stillborn = 0
            if place.job is not None:
                place.note_phase()
                self._tell(replace(self.progress, ended=None))
        elif place.job is not None:
            self._turn_over(place, place.job, answer)

    def _lost(self, place: _Place[J, R], kind: str, why: str) -> None:
        """Records the failed attempt of a worker that died."""
        self._places.remove(place)
        place.worker.end(at_once=True)
        if place.job is not None:
            self._turn_over(place, place.job, failed(place.job, kind, why))
            return
        self._stillborn += 1
        if self._stillborn >= STILLBORN * self._executor.count:
            raise InfrastructureError(f"no worker becomes ready: {why}; rerun the command to resume")

    def _turn_over(self, place: _Place[J, R], job: J, row: R) -> None:
        """Takes a job from a worker that has ended with it, or died."""
        turn, place.job = place.turn(job), None
        self._pace.took(turn, is_out_of_reach=row.error_kind in FINAL_KINDS)
        self._ended(job, replace(row, wall_seconds=round(turn.seconds, 3)))

    def _goes_on(self) -> bool:
        """Whether there are jobs to hand out, and a budget for them."""
        if self._queue and self._limit is not None and not self._stopped:
            self._stopped = self._limit.refusal()
        return bool(self._queue) and not self._stopped

    def _ended(self, job: J, row: R) -> None:
        self._note_spent()
        if row.error_kind == BudgetSpentError.__name__:  # counts as not run
            self._stopped = str(row.error)
            return
        failures = self._failures[job.id]
        if row.error is not None:
            failures.append(f"{row.error_kind}: {row.error}")
            if len(failures) <= self._retries and row.error_kind not in FINAL_KINDS:
                self._queue.put(job)
                return
        attempts = len(failures) + (row.error is None)
        self._newest = replace(row, attempts=attempts, failed_attempts=tuple(failures))
        for old in self._rows(job):
            self._counts.count(old, -1)
        self._store.append(self._newest)
        for new in self._rows(job):
            self._counts.count(new)
        self._ran += len(job.row_ids)
        self._given_up += sum(map(is_open, self._rows(job)))
        self._tell(self.progress)
        self._give_up_like(job, row)

    def _note_spent(self) -> None:
        """Writes down what has been spent, for ``spent_before`` of a later start."""
        if self._limit is not None:
            try:
                write_whole(self._store.folder / SPENT, json.dumps(asdict(self._limit.spent())) + "\n")
            except OSError as error:
                raise cannot_write(self._store.folder, error) from error

    def _give_up_like(self, job: J, row: R) -> None:
        """Records the jobs whose situation is known not to arise as errors, without another attempt."""
        if row.error is not None and row.error_kind in FINAL_KINDS:
            for other in self._alike.pop(job.situation, []):
                if self._queue.remove(other):
                    self._ended(other, failed(other, row.error_kind, row.error))


def spent_before(store: Store[R]) -> Spent:
    """What earlier starts have spent, as they noted it, or at least what their rows say."""
    # Without a model of this program's, an agent tells of itself what it has used, and nobody pays for it here.
    rows = [row for row in store.rows.values() if getattr(row, "model", "none") != "none"]
    tokens = sum(getattr(row, "tokens_in", 0) + getattr(row, "tokens_out", 0) for row in rows)
    usd = sum(getattr(row, "cost_usd", 0.0) for row in rows)
    path = store.folder / SPENT
    noted = from_json(Spent, read_json(path)) if path.is_file() else Spent()
    return Spent(max(tokens, noted.tokens), max(usd, noted.usd))


def is_open(row: JobRow | None) -> bool:
    """Whether a job must run: it has no row yet, or that of an error that may not recur."""
    return row is None or (row.error is not None and row.error_kind not in FINAL_KINDS)
