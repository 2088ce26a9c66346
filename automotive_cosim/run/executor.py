"""Where a batch runs its jobs: what processes of this machine and actors of a Ray cluster have in common."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from automotive_cosim.contracts import Json


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
    def wall_s(self) -> float:
        """Wall time that it may take."""
        ...


Runner = Callable[[Any, Path], Json]
"""Runs a job, writes what is kept of it below the folder, and returns its row, whatever went wrong.

OSError if something cannot be written.
"""

Opener = Callable[[], AbstractContextManager[Runner]]
"""Makes a worker's runner; it is sent to the worker, so it is a function of a module or a partial of one."""


class LostError(Exception):
    """A worker is no more; why is told."""


@dataclass(frozen=True, slots=True)
class CannotWrite:
    """Says that the results cannot be kept: everything has to stop."""

    error: OSError


class Worker(Protocol):
    """Runs one job after the other."""

    @property
    def is_ready(self) -> bool:
        """Whether it can begin with a job at once."""
        ...

    @property
    def handles(self) -> Sequence[Any]:
        """What ``Executor.wait`` watches: one of them stirs when there is an answer to be had."""
        ...

    def give(self, job: Job) -> None:
        """Sends it a job; one that has died meanwhile is found out when its answer is waited for."""
        ...

    def answer(self) -> Json | CannotWrite | None:
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

    def start(self, opener: Opener, folder: Path) -> Worker:
        """A new worker.

        Args:
            opener: makes its runner.
            folder: where the files of its jobs go.
        """
        ...

    def wait(self, handles: Sequence[Any], timeout_s: float) -> Sequence[Any]:
        """Those of the handles that have stirred, none after so long."""
        ...
