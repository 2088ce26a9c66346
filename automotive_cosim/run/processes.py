"""Runs jobs in processes of this machine: others, or this one."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, suppress
from dataclasses import dataclass
from multiprocessing import connection, parent_process
from multiprocessing.connection import Connection
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic

from automotive_cosim.agents.cleanup import children, end_all, strangers, take_orphans
from automotive_cosim.run.budget import Meter, MeterHandle, Spent, served
from automotive_cosim.run.executor import CannotWrite, J, JobPhase, LostError, Opener, R, Runner, Worker, telling
from automotive_cosim.run.settings import Budget

if TYPE_CHECKING:
    from multiprocessing.context import ForkServerContext

PRELOADED = ["automotive_cosim.agents", "pydantic"]
"""What workers have from the process that they are forked from: most of what they import, but nothing that depends
on the environment, as the catalogue does (``tasking.own_files``)."""

ORPHANS_S = 3.0
"""Wall time in which the agents' processes of a killed worker have to end by themselves."""


@dataclass(frozen=True, slots=True)
class Processes:
    """A number of processes, each with its own warm simulations."""

    count: int = 1

    def __enter__(self) -> Processes:
        return self

    def __exit__(self, *error: object) -> None:
        """Does nothing: a batch ends its workers."""

    def metered(self, budget: Budget, before: Spent) -> AbstractContextManager[MeterHandle]:
        """See ``Executor.metered``; the meter is in this process."""
        return served(Meter(budget, before))

    def start(self, opener: Opener[J, R], folder: Path) -> Worker[J, R]:
        return _Process(opener, folder)

    def wait(self, handles: Sequence[Any], timeout_s: float) -> Sequence[Any]:
        return connection.wait(handles, timeout_s)


class Here(Processes):
    """Runs jobs in this process, one by one, for those that depend on earlier rows; none is ended early."""

    def start(self, opener: Opener[J, R], folder: Path) -> _Here[J, R]:
        return _Here(opener, folder)

    def wait(self, handles: Sequence[Any], timeout_s: float) -> Sequence[Any]:
        return handles


class _Here(Generic[J, R]):
    is_ready, phase = True, JobPhase()

    def __init__(self, opener: Opener[J, R], folder: Path) -> None:
        self._ends, self._folder = ExitStack(), folder
        self._run = self._ends.enter_context(opener())
        self._answer: R | CannotWrite | None = None

    @property
    def handles(self) -> Sequence[Any]:
        return (self,)

    def give(self, job: J) -> None:
        self._answer = _answered(self._run, job, self._folder)

    def answer(self) -> R | CannotWrite | None:
        return self._answer

    def end(self, *, at_once: bool) -> None:
        self._ends.close()


class _Ready:
    """Says that a process has started and can take a job."""


class _Process(Generic[J, R]):
    def __init__(self, opener: Opener[J, R], folder: Path) -> None:
        context = _context()
        self._pipe, theirs = context.Pipe()
        work = (theirs, opener, folder, dict(os.environ))
        self._process = context.Process(target=_work, args=work, daemon=False)
        take_orphans()
        self._known = frozenset(children())
        self._process.start()
        theirs.close()
        self.is_ready = False
        self.phase = JobPhase()

    @property
    def handles(self) -> Sequence[Any]:
        return self._pipe, self._process.sentinel

    def give(self, job: J) -> None:
        self.phase = JobPhase()
        with suppress(OSError):
            self._pipe.send(job)

    def answer(self) -> R | CannotWrite | None:
        try:
            answer: R | CannotWrite | _Ready | JobPhase | None = self._pipe.recv() if self._pipe.poll() else None
        except (EOFError, OSError):
            answer = None
        if answer is None:
            self._process.join()
            raise LostError(f"the worker died with exit code {self._process.exitcode}")
        if isinstance(answer, _Ready):
            self.is_ready = True
            return None
        if isinstance(answer, JobPhase):
            self.phase = answer
            return None
        return answer

    def end(self, *, at_once: bool) -> None:
        if at_once:
            self._process.kill()
        else:
            with suppress(OSError):
                self._pipe.send(None)
        self._process.join()
        self._pipe.close()
        if at_once:
            end_all(lambda: strangers(self._known), ORPHANS_S)


def _context() -> ForkServerContext:
    """Workers are forked from a process that has imported most of the package, and start in a third of the time."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(PRELOADED)
    return context


# --- in the process ---------------------------------------------------------------------------------------


def _work(jobs: Connection, opener: Opener[J, R], folder: Path, environment: Mapping[str, str]) -> None:
    """Says that it is ready, then answers each job with its row, until it receives None.

    The parent handles Ctrl-C; when the parent is gone, this process ends at once. The environment is the parent's
    now, not that of when the first worker was started."""
    os.environ.clear()
    os.environ.update(environment)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    with opener() as run, telling(jobs.send):
        jobs.send(_Ready())
        while (job := jobs.recv()) is not None:
            jobs.send(_answered(run, job, folder))


def _answered(run: Runner[J, R], job: J, folder: Path) -> R | CannotWrite:
    try:
        return run(job, folder)
    except OSError as error:
        return CannotWrite(error)


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)
