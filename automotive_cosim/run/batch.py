"""Runs jobs in workers; what is done stays done, whatever ends the run.

Jobs depend on nothing but their setup, so neither their order, nor the number of workers, nor where they are shows
in the results.
"""

from __future__ import annotations

import time
from collections import Counter, defaultdict, deque
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from automotive_cosim.contracts import Json
from automotive_cosim.errors import InfrastructureError, TriggerNotReachedError
from automotive_cosim.run import worker
from automotive_cosim.run.collect import Pictures, failed
from automotive_cosim.run.executor import CannotWrite, Executor, Job, LostError, Opener, Worker
from automotive_cosim.run.plan import Plan
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.store import Store, cannot_write, opened

FINAL_KINDS = frozenset({TriggerNotReachedError.__name__})
"""Errors that come again for certain, so that trying again is no use."""
SHARED_FROM = 4
"""So many episodes must be left of a simulation for a second worker to warm it up too."""
PATIENCE_S = 600.0
"""Wall time that a batch waits for its first worker, or for another one when all are lost."""
STILLBORN = 3
"""So often all workers in a row may be lost before they are ready."""


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a run is."""

    planned: int
    done: int
    """Jobs that need no further run, those of earlier starts included."""
    judged: int
    successes: int
    errors: int
    ran: int
    """Jobs that ended since this start."""
    seconds: float
    """Wall time since this start."""
    ended: Json | None
    """The row of the job that ended just now; None at the start."""

    @property
    def left_s(self) -> float | None:
        """Wall time to the end at the pace so far; None before the first episode has ended."""
        return self.seconds / self.ran * (self.planned - self.done) if self.ran else None


def run_plan(
    plan: Plan,
    folder: Path,
    *,
    executor: Executor = Processes(),  # noqa: B008, frozen
    retries: int = 2,
    pictures: Pictures = Pictures.NONE,
    tell: Callable[[Progress], None] = lambda progress: None,
) -> Progress:
    """Runs what is left of a plan; episodes that ended in an error are tried again.

    Args:
        plan: what to run.
        folder: where the results are or go.
        executor: where to run it.
        retries: how often an episode that the machinery broke is tried again before it is put down as an error.
        pictures: which to keep.
        tell: called at the start and after every episode.

    Raises:
        UserError: the plan names what does not exist, or the folder cannot take its results.
        InfrastructureError: there is no worker to be had.
        KeyboardInterrupt: passed on; the running episodes are lost, and no other.
    """
    plan.check()
    jobs = plan.jobs()
    with opened(folder, plan.as_json()) as store:
        opener = partial(worker.episodes, pictures)
        return run_jobs(jobs, store, opener, failed, executor=executor, retries=retries, tell=tell)


def run_jobs(
    jobs: Sequence[Job],
    store: Store,
    opener: Opener,
    failed: Callable[[Any, str, str], Json],
    *,
    executor: Executor = Processes(),  # noqa: B008, frozen
    retries: int = 2,
    tell: Callable[[Progress], None] = lambda progress: None,
) -> Progress:
    """Runs those of the jobs that have no row yet, or one of an error; the rows hold ``id`` and ``error``.

    Args:
        jobs: what to run.
        store: where the rows are and go.
        opener: makes what runs them, in each worker.
        failed: the row of a job whose worker is no more, from the job, the kind of error and why.
        executor: where to run them.
        retries: how often a job that ended in an error is tried again before its row is put down.
        tell: called at the start and after every job.

    Raises:
        as ``run_plan``.
    """
    batch = _Batch(store, jobs, opener, failed, executor, retries, tell)
    try:
        batch.run()
    finally:
        batch.close()
    return batch.progress


@dataclass(eq=False)
class _Place:
    """A worker, and the job it has."""

    worker: Worker
    job: Job | None = None
    since_s: float = 0.0
    """When it was given the job, monotonic."""
    warm: tuple[str, int] | None = None
    """The simulation it ran last."""

    def give(self, job: Job) -> None:
        self.job, self.since_s, self.warm = job, time.monotonic(), job.simulation
        self.worker.give(job)


@dataclass
class _Queue:
    """Jobs by the simulation they need."""

    groups: dict[tuple[str, int], deque[Job]] = field(default_factory=lambda: defaultdict(deque))

    def put(self, jobs: Iterable[Job]) -> None:
        for job in jobs:
            self.groups[job.simulation].append(job)

    def take(self, warm: tuple[str, int] | None, busy: Counter[tuple[str, int]]) -> Job | None:
        """The next job for a worker: of the simulation it has, else of one that nobody has, else shared work."""
        if warm is not None and self.groups.get(warm):
            return self.groups[warm].popleft()
        left = {key: len(jobs) for key, jobs in self.groups.items() if jobs}
        free = {key: count for key, count in left.items() if not busy[key]}
        pool = free or {key: count for key, count in left.items() if count >= SHARED_FROM}
        return self.groups[max(pool, key=lambda key: pool[key])].popleft() if pool else None

    def __bool__(self) -> bool:
        return any(self.groups.values())


class _Batch:
    def __init__(
        self,
        store: Store,
        jobs: Sequence[Job],
        opener: Opener,
        failed: Callable[[Any, str, str], Json],
        executor: Executor,
        retries: int,
        tell: Callable[[Progress], None],
    ) -> None:
        self._store = store
        self._opener = opener
        self._failed = failed
        self._executor = executor
        self._jobs = {job.id: job for job in jobs}
        self._retries = retries
        self._tell = tell
        self._began_s = time.monotonic()
        self._ran = self._given_up = self._stillborn = 0
        self._newest: Json | None = None
        self._failures: dict[str, list[str]] = defaultdict(list)
        self._places: list[_Place] = []
        self._out_of_reach: dict[Hashable, Json] = {}
        self._queue = _Queue()
        for job in jobs:
            self._note(job, store.rows.get(job.id))
        self._queue.put(job for job in jobs if _is_open(store.rows.get(job.id)))

    def run(self) -> None:
        self._tell(self.progress)
        while self._queue or any(place.job for place in self._places):
            while self._queue and len(self._places) < self._executor.count:
                self._places.append(_Place(self._executor.start(self._opener, self._store.folder)))
            self._hand_out()
            self._wait()

    def close(self) -> None:
        for place in self._places:
            place.worker.end(at_once=place.job is not None)
        self._places.clear()

    @property
    def progress(self) -> Progress:
        rows = [row for id_, row in self._store.rows.items() if id_ in self._jobs]
        judged = [row for row in rows if row["error"] is None]
        return Progress(
            planned=len(self._jobs),
            done=sum(not _is_open(row) for row in rows) + self._given_up,
            judged=len(judged),
            successes=sum(bool(row.get("success")) for row in judged),
            errors=len(rows) - len(judged),
            ran=self._ran,
            seconds=time.monotonic() - self._began_s,
            ended=self._newest,
        )

    def _hand_out(self) -> None:
        for place in self._places:
            if place.job is None and place.worker.is_ready:
                job = self._next(place)
                if job is not None:
                    place.give(job)

    def _next(self, place: _Place) -> Job | None:
        """What to run there; what is known to be out of reach is put down as such, without another try."""
        busy = Counter(other.job.simulation for other in self._places if other.job)
        while (job := self._queue.take(place.warm, busy)) is not None:
            known = self._out_of_reach.get(job.situation)
            if known is None:
                return job
            row = known | self._failed(job, known["error_kind"], known["error"])
            self._ended(job, row | {"wall_seconds": 0.0})
        return None

    def _note(self, job: Job, row: Json | None) -> None:
        if row is not None and row["error_kind"] in FINAL_KINDS:
            self._out_of_reach[job.situation] = row

    def _wait(self) -> None:
        """Waits for an answer, a death, a worker that becomes ready, or the end of somebody's time."""
        awaited = [place for place in self._places if place.job or not place.worker.is_ready]
        if not awaited:  # the last ones were known to be out of reach
            return
        handles = {handle: place for place in awaited for handle in place.worker.handles}
        now_s = time.monotonic()
        ends_s = [place.since_s + place.job.wall_s for place in awaited if place.job]
        ready = self._executor.wait(list(handles), max(0.0, min(ends_s, default=now_s + PATIENCE_S) - now_s))
        if not ends_s and not ready:
            raise InfrastructureError(f"no worker has become ready in {PATIENCE_S:g} s; the same command goes on")
        for place in {handles[handle]: None for handle in ready}:
            self._answered(place)
        for place in awaited:
            if place.job and time.monotonic() - place.since_s >= place.job.wall_s:
                self._lost(place, "WallTime", f"took longer than {place.job.wall_s:g} s of wall time")

    def _answered(self, place: _Place) -> None:
        try:
            answer = place.worker.answer()
        except LostError as error:
            self._lost(place, "WorkerDied", str(error))
            return
        if isinstance(answer, CannotWrite):
            raise cannot_write(self._store.folder, answer.error)
        job, place.job = place.job, None
        if answer is None:
            self._stillborn = 0
        elif job is not None:
            self._ended(job, answer)

    def _lost(self, place: _Place, kind: str, why: str) -> None:
        """Puts down the job of a worker that is no more."""
        job, place.job = place.job, None
        self._places.remove(place)
        place.worker.end(at_once=True)
        if job is not None:
            self._ended(job, self._failed(job, kind, why))
            return
        self._stillborn += 1
        if self._stillborn >= STILLBORN * self._executor.count:
            raise InfrastructureError(f"no worker gets ready: {why}; the same command goes on")

    def _ended(self, job: Job, row: Json) -> None:
        failures = self._failures[job.id]
        if row["error"] is not None:
            failures.append(f"{row['error_kind']}: {row['error']}")
            if len(failures) <= self._retries and row["error_kind"] not in FINAL_KINDS:
                self._queue.put([job])
                return
        self._note(job, row)
        attempts = len(failures) + (row["error"] is None)
        self._newest = row | {"attempts": attempts, "failed_attempts": failures}
        self._store.append(self._newest)
        self._ran += 1
        self._given_up += _is_open(row)
        self._tell(self.progress)


def _is_open(row: Json | None) -> bool:
    """Whether an episode is to be run: it has no line yet, or one of an error that may not come again."""
    return row is None or (row["error"] is not None and row["error_kind"] not in FINAL_KINDS)
