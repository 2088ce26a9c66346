"""Runs jobs in worker processes; what is done stays done, whatever ends the run.

Jobs depend on nothing but their setup, so neither their order nor the number of workers shows in the results.
"""

from __future__ import annotations

import multiprocessing
import time
from collections import Counter, defaultdict, deque
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from multiprocessing import connection
from pathlib import Path
from typing import Any, Protocol

from automotive_cosim.contracts import Json
from automotive_cosim.errors import TriggerNotReachedError
from automotive_cosim.run import worker
from automotive_cosim.run.collect import Pictures, failed
from automotive_cosim.run.plan import Plan
from automotive_cosim.run.store import Store, cannot_write, opened

FINAL_KINDS = frozenset({TriggerNotReachedError.__name__})
"""Errors that come again for certain, so that trying again is no use."""
SHARED_FROM = 4
"""So many episodes must be left of a simulation for a second worker to warm it up too."""


class Job(Protocol):
    """Something to run that depends on nothing but itself. It is sent to a worker."""

    @property
    def id(self) -> str:
        """Of its row."""
        ...

    @property
    def simulation(self) -> tuple[str, int]:
        """What warm simulation it starts from; a worker does those of one after the other."""
        ...

    @property
    def wall_s(self) -> float:
        """Wall time that it may take."""
        ...


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

    @property
    def left_s(self) -> float | None:
        """Wall time to the end at the pace so far; None before the first episode has ended."""
        return self.seconds / self.ran * (self.planned - self.done) if self.ran else None


def run_plan(
    plan: Plan,
    folder: Path,
    *,
    workers: int = 1,
    retries: int = 2,
    pictures: Pictures = Pictures.NONE,
    tell: Callable[[Progress], None] = lambda progress: None,
) -> Progress:
    """Runs what is left of a plan; episodes that ended in an error are tried again.

    Args:
        plan: what to run.
        folder: where the results are or go.
        workers: processes.
        retries: how often an episode that the machinery broke is tried again before it is put down as an error.
        pictures: which to keep.
        tell: called at the start and after every episode.

    Raises:
        UserError: the plan names what does not exist, or the folder cannot take its results.
        KeyboardInterrupt: passed on; the running episodes are lost, and no other.
    """
    plan.check()
    jobs = plan.jobs()
    with opened(folder, plan.as_json()) as store:
        opener = partial(worker.episodes, folder, pictures)
        return run_jobs(jobs, store, opener, failed, workers=workers, retries=retries, tell=tell)


def run_jobs(
    jobs: Sequence[Job],
    store: Store,
    opener: worker.Opener,
    failed: Callable[[Any, str, str], Json],
    *,
    workers: int = 1,
    retries: int = 2,
    tell: Callable[[Progress], None] = lambda progress: None,
) -> Progress:
    """Runs those of the jobs that have no row yet, or one of an error; the rows hold ``id`` and ``error``.

    Args:
        jobs: what to run.
        store: where the rows are and go.
        opener: makes what runs them, in each worker.
        failed: the row of a job whose worker is no more, from the job, the kind of error and why.
        workers: processes.
        retries: how often a job that ended in an error is tried again before its row is put down.
        tell: called at the start and after every job.

    Raises:
        as ``run_plan``.
    """
    batch = _Batch(store, jobs, opener, failed, retries, tell)
    try:
        batch.run(workers)
    finally:
        batch.close()
    return batch.progress


class _Worker:
    """One process, and the job it has."""

    def __init__(self, opener: worker.Opener) -> None:
        context = multiprocessing.get_context("spawn")
        self.pipe, theirs = context.Pipe()
        self.process = context.Process(target=worker.work, args=(theirs, opener), daemon=False)
        self.process.start()
        theirs.close()
        self.job: Job | None = None
        self.since_s = 0.0

    def give(self, job: Job) -> None:
        """Sends it a job; one that has died meanwhile is found out when its answer is waited for."""
        self.job, self.since_s = job, time.monotonic()
        with suppress(OSError):
            self.pipe.send(job)

    def end(self, *, at_once: bool) -> None:
        """Ends it."""
        if at_once:
            self.process.kill()
        else:
            with suppress(OSError):
                self.pipe.send(None)
        self.process.join()
        self.pipe.close()


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
        opener: worker.Opener,
        failed: Callable[[Any, str, str], Json],
        retries: int,
        tell: Callable[[Progress], None],
    ) -> None:
        self._store = store
        self._opener = opener
        self._failed = failed
        self._jobs = {job.id: job for job in jobs}
        self._retries = retries
        self._tell = tell
        self._began_s = time.monotonic()
        self._ran = self._given_up = 0
        self._failures: dict[str, list[str]] = defaultdict(list)
        self._workers: list[_Worker] = []
        self._warm: dict[_Worker, tuple[str, int]] = {}
        self._queue = _Queue()
        self._queue.put(job for job in jobs if _is_open(store.rows.get(job.id)))

    def run(self, count: int) -> None:
        self._tell(self.progress)
        while self._queue or any(worker.job for worker in self._workers):
            while self._queue and len(self._workers) < count:
                self._workers.append(_Worker(self._opener))
            self._hand_out()
            self._wait()

    def close(self) -> None:
        for each in self._workers:
            each.end(at_once=each.job is not None)
        self._workers.clear()

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
        )

    def _hand_out(self) -> None:
        for each in self._workers:
            if each.job is None:
                busy = Counter(other.job.simulation for other in self._workers if other.job)
                job = self._queue.take(self._warm.get(each), busy)
                if job is not None:
                    self._warm[each] = job.simulation
                    each.give(job)

    def _wait(self) -> None:
        """Waits for an answer, a death, or the end of somebody's time."""
        busy = [each for each in self._workers if each.job is not None]
        now_s = time.monotonic()
        ends_s = [each.since_s + each.job.wall_s for each in busy if each.job]
        handles = {handle: each for each in busy for handle in (each.pipe, each.process.sentinel)}
        ready = connection.wait(list(handles), max(0.0, min(ends_s) - now_s))
        for each in {handles[handle]: None for handle in ready}:  # type: ignore[index]
            self._answered(each)
        for each in busy:
            if each.job and time.monotonic() - each.since_s >= each.job.wall_s:
                self._lost(each, "WallTime", f"took longer than {each.job.wall_s:g} s of wall time")

    def _answered(self, each: _Worker) -> None:
        assert each.job is not None
        try:
            answer = each.pipe.recv() if each.pipe.poll() else None
        except (EOFError, OSError):
            answer = None
        if answer is None:
            each.process.join()
            self._lost(each, "WorkerDied", f"its process ended with code {each.process.exitcode}")
            return
        if isinstance(answer, worker.CannotWrite):
            raise cannot_write(self._store.folder, answer.error)
        job, each.job = each.job, None
        self._ended(job, answer)

    def _lost(self, each: _Worker, kind: str, why: str) -> None:
        """Puts down the job of a worker that is no more."""
        job, each.job = each.job, None
        assert job is not None
        self._workers.remove(each)
        self._warm.pop(each, None)
        each.end(at_once=True)
        self._ended(job, self._failed(job, kind, why))

    def _ended(self, job: Job, row: Json) -> None:
        failures = self._failures[job.id]
        if row["error"] is not None:
            failures.append(f"{row['error_kind']}: {row['error']}")
            if len(failures) <= self._retries and row["error_kind"] not in FINAL_KINDS:
                self._queue.put([job])
                return
        attempts = len(failures) + (row["error"] is None)
        self._store.append(row | {"attempts": attempts, "failed_attempts": failures})
        self._ran += 1
        self._given_up += _is_open(row)
        self._tell(self.progress)


def _is_open(row: Json | None) -> bool:
    """Whether an episode is to be run: it has no line yet, or one of an error that may not come again."""
    return row is None or (row["error"] is not None and row["error_kind"] not in FINAL_KINDS)
