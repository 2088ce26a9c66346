"""Jobs, and the protocols of executors, which run them in processes of this machine or in actors of a Ray cluster.

A worker tells with ``telling`` what it is doing with its job, whose first minutes are the traffic's and not the
agent's; elsewhere nobody is told.
"""

from __future__ import annotations

import errno
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol, TypeVar

from automotive_cosim.errors import CosimError
from automotive_cosim.run.budget import MeterHandle, Spent
from automotive_cosim.run.job_row import JobRow
from automotive_cosim.run.settings import Budget


class Job(ABC):
    """Something to run that depends only on itself. It is sent to a worker."""

    __slots__ = ()

    @property
    @abstractmethod
    def id(self) -> str:
        """Id of its row, which can be a file name."""

    @property
    def row_ids(self) -> Sequence[str]:
        """Ids of all rows that it makes, its own first."""
        return (self.id,)

    @property
    @abstractmethod
    def simulation(self) -> tuple[str, int]:
        """The warm simulation that it starts from; a worker runs the jobs of one simulation in a row."""

    @property
    @abstractmethod
    def wall_s(self) -> float:
        """Limit of its wall time."""

    @abstractmethod
    def planned(self) -> JobRow:
        """Its row, as far as it is known before it runs."""

    @property
    def situation(self) -> Hashable:
        """The situation that must arise first; if it does not for one job, it does not for any."""
        return self.id

    @property
    def kind(self) -> Hashable:
        """Determines how long it takes in a given simulation: jobs of one kind take about the same time."""
        return ""

    @property
    def warm_up_weight(self) -> float:
        """How long the warm-up of its simulation takes, as a share of that of a large town."""
        return 1.0


J = TypeVar("J", bound=Job)
R = TypeVar("R", bound=JobRow)
J_contra = TypeVar("J_contra", bound=Job, contravariant=True)
R_co = TypeVar("R_co", bound=JobRow, covariant=True)

# An alias of variables without bounds, as pyright refuses to specialize one whose bound is a protocol.
_J = TypeVar("_J")
_R = TypeVar("_R")
Runner = Callable[[_J, Path], _R]
"""Runs a job, writes the files to keep into the folder, and returns its row, even after an error.

OSError if something cannot be written."""

Opener = Callable[[], AbstractContextManager[Runner[J, R]]]
"""Makes a worker's runner; it is sent to the worker, so it must be a module's function or a partial of one."""


NOT_WRITABLE = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS})
"""Errors of a disk that takes no more, which no other try mends."""


def failed(job: Job, kind: str, why: str) -> Any:
    """The row of a job that ended in an infrastructure error."""
    return replace(job.planned(), error=why, error_kind=kind)


def failed_by(job: Job, error: Exception) -> Any:
    """The same by an error, of which a fault in this package or in an agent is told by its class too.

    Raises OSError: the disk takes no more. All others would end so, some of them after they have asked a model."""
    if isinstance(error, OSError) and error.errno in NOT_WRITABLE:
        raise error
    name = type(error).__name__
    return failed(job, name, str(error) if isinstance(error, CosimError) else f"{name}: {error}")


def tried(run: Runner[J, R]) -> Runner[J, R]:
    """A runner whose every error becomes a row, but for files that cannot be written."""

    def row_of(job: J, folder: Path) -> R:
        try:
            return run(job, folder)
        except OSError:
            raise
        except Exception as error:  # must not end the others; it is counted and listed
            row: R = failed_by(job, error)
            return row

    return row_of


@contextmanager
def alone(run: Runner[J, R]) -> Iterator[Runner[J, R]]:
    """Makes the runner of a worker whose jobs share nothing."""
    yield tried(run)


class LostError(Exception):
    """A worker has died; the message says why."""


@dataclass(frozen=True, slots=True)
class CannotWrite:
    """Raised if the results cannot be kept: everything has to stop."""

    error: OSError


class Worker(Protocol[J_contra, R_co]):
    """Runs one job after the other."""

    @property
    def is_ready(self) -> bool:
        """Whether it can start a job at once."""
        ...

    @property
    def phase(self) -> JobPhase:
        """How far it last said that it is with its job."""
        ...

    @property
    def handles(self) -> Sequence[Any]:
        """Handles for ``Executor.wait``; one of them becomes ready when there is an answer."""
        ...

    def give(self, job: J_contra) -> None:
        """Sends it a job; if it has died in the meantime, waiting for its answer reveals that."""
        ...

    def answer(self) -> R_co | CannotWrite | None:
        """Its answer: the row of its job, whose files are in place, or None if it has only become ready,
        or said how far it is.

        Raises:
            LostError: it has died.
            UserError: it cannot work, and neither can others like it."""
        ...

    def end(self, *, at_once: bool) -> None:
        """Ends it; with ``at_once`` even during a job."""
        ...


class Executor(Protocol):
    """Makes workers and waits for them; a context manager that ends whatever it has started itself."""

    def metered(self, budget: Budget, before: Spent) -> AbstractContextManager[MeterHandle]:
        """A meter that all its workers can use."""
        ...

    @property
    def count(self) -> int:
        """The number of workers to have; it may change."""
        ...

    def __enter__(self) -> Executor: ...

    def __exit__(self, *error: object) -> None: ...

    def start(self, opener: Opener[J, R], folder: Path) -> Worker[J, R]:
        """A new worker.

        Args:
            opener: makes the worker's runner.
            folder: where to put the files of its jobs."""
        ...

    def wait(self, handles: Sequence[Any], timeout_s: float) -> Sequence[Any]:
        """The handles that are ready; empty after the timeout."""
        ...


EVERY_S = 1.0
"""Wall time between two amounts of the same phase."""


@dataclass(frozen=True, slots=True)
class JobPhase:
    """How far a job is."""

    words: str = ""
    """What is being done for it; empty if that is not told."""
    is_warm_up: bool = False
    """Whether that is done once for all jobs of its simulation."""
    share: float | None = None
    """How much of the warm-up is done, or else of the rest of the job, 0 to 1; None if that is not known."""


_TELL: ContextVar[Callable[[str, str, bool, float | None], None]] = ContextVar(
    "tell_phase", default=lambda what, amount, is_warm_up, share: None
)


def doing(what: str, amount: str = "", *, is_warm_up: bool = False, share: float | None = None) -> None:
    """Says what is being done for the job.

    Args:
        what: the phase, such as ``warming up traffic``.
        amount: how far it is, such as ``120 of 600 s``."""
    _TELL.get()(what, amount, is_warm_up, share)


@contextmanager
def telling(tell: Callable[[JobPhase], None]) -> Iterator[None]:
    """Hands on every new phase, and the amounts and shares of one not more often than ``EVERY_S``."""
    said, said_s = "", 0.0

    def hand_on(what: str, amount: str, is_warm_up: bool, share: float | None) -> None:
        nonlocal said, said_s
        now_s = time.monotonic()
        if what != said or ((amount or share is not None) and now_s - said_s >= EVERY_S):
            said, said_s = what, now_s
            tell(JobPhase(", ".join(filter(None, (what, amount))), is_warm_up, share))

    token = _TELL.set(hand_on)
    try:
        yield
    finally:
        _TELL.reset(token)


def warming_up(done_s: float, total_s: float) -> None:
    """Says how far the warm-up of the traffic is, in simulated seconds."""
    doing(
        "warming up traffic",
        f"{done_s:.0f} of {total_s:.0f} s",
        is_warm_up=True,
        share=done_s / total_s if total_s else 1.0,
    )
