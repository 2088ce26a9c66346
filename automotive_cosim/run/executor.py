"""Where a batch runs its jobs: what processes of this machine and actors of a Ray cluster have in common."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, TypeVar

from automotive_cosim.run.row import JobRow


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
    def situation(self) -> Hashable:
        """What has to come about before anybody acts: where it does not for one job, it does not for its likes."""
        ...

    @property
    def kind(self) -> Hashable:
        """What tells how long it takes, given the simulation: jobs of one kind take about as long."""
        ...

    @property
    def wall_s(self) -> float:
        """Wall time that it may take."""
        ...


J = TypeVar("J", bound=Job)
R = TypeVar("R", bound=JobRow)
J_contra = TypeVar("J_contra", bound=Job, contravariant=True)
R_co = TypeVar("R_co", bound=JobRow, covariant=True)

Runner = Callable[[J, Path], R]
"""Runs a job, writes what is kept of it below the folder, and returns its row, whatever went wrong.

OSError if something cannot be written.
"""

Opener = Callable[[], AbstractContextManager[Runner[J, R]]]
"""Makes a worker's runner; it is sent to the worker, so it is a function of a module or a partial of one."""


class LostError(Exception):
    """A worker is no more; why is told."""


@dataclass(frozen=True, slots=True)
class CannotWrite:
    """Says that the results cannot be kept: everything has to stop."""

    error: OSError


class Worker(Protocol[J_contra, R_co]):
    """Runs one job after the other."""

    @property
    def is_ready(self) -> bool:
        """Whether it can begin with a job at once."""
        ...

    @property
    def handles(self) -> Sequence[Any]:
        """What ``Executor.wait`` watches: one of them stirs when there is an answer to be had."""
        ...

    def give(self, job: J_contra) -> None:
        """Sends it a job; one that has died meanwhile is found out when its answer is waited for."""
        ...

    def answer(self) -> R_co | CannotWrite | None:
        """What it has to say: the row of its job, whose files are in place; None if it has only become ready.

        Raises:
            LostError: it is no more.
            UserError: it cannot work, and neither can others like it.
        """
        ...

    def end(self, *, at_once: bool) -> None:
        """Ends it; ``at_once`` in the midst of a job."""
        ...


class Executor(Protocol):
    """Makes workers and waits for them; a context manager, which ends whatever it has started of its own."""

    @property
    def count(self) -> int:
        """Workers to have; it may change."""
        ...

    def __enter__(self) -> Executor: ...

    def __exit__(self, *error: object) -> None: ...

    def start(self, opener: Opener[J, R], folder: Path) -> Worker[J, R]:
        """A new worker.

        Args:
            opener: makes its runner.
            folder: where the files of its jobs go.
        """
        ...

    def wait(self, handles: Sequence[Any], timeout_s: float) -> Sequence[Any]:
        """Those of the handles that have stirred, none after so long."""
        ...
