"""Reads what strangers have packed, in processes that may take so much memory and processor time and no more.

What reading may cost is a fixed amount and a multiple of the file's size (``bounds.Cost``). One that takes more is
refused, and the program that was asked to read it goes on.
"""

from __future__ import annotations

import os
import resource
import signal
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from pathlib import Path
from typing import Any, Self, TypeVar

from automotive_cosim.errors import UserError
from automotive_cosim.formats.bounds import BUNDLE, Cost
from automotive_cosim.formats.files import is_file

T = TypeVar("T")

ENDING = frozenset({signal.SIGINT, signal.SIGTERM})


class LimitedProcesses:
    """Some processes with limits (``setrlimit``)."""

    def __init__(self, path: Path, count: int = 1, cost: Cost | None = None) -> None:
        """Starts nothing before the first call.

        Args:
            path: file or folder of strangers.
            cost: what one call may take; by default what a bundle may."""
        self._path = path
        most = cost or BUNDLE
        size = path.stat().st_size if is_file(path) else sum(map(_bytes, path.rglob("*")))
        self._seconds = most.free_s + most.s_per_mb * (size >> 20)
        self._made = partial(
            ProcessPoolExecutor, count, initializer=_limit, initargs=(most.free_bytes + most.times * size,)
        )
        self._pool = self._made()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self._pool.shutdown(cancel_futures=True)

    def call(self, what: Callable[..., T], *given: Any) -> T:
        """What the function returns there; it and what it is given are pickled.

        Raises UserError: it takes more memory or time than a file of that size may, or is malformed."""
        return self._result(self._submitted(what, given))

    def map(self, what: Callable[..., T], *given: Iterable[Any]) -> Iterator[T]:
        """The same for many calls, in their order. Raises UserError: as ``call``."""
        futures = [self._submitted(what, each) for each in zip(*given, strict=True)]
        return map(self._result, futures)

    def _submitted(self, what: Callable[..., T], given: tuple[Any, ...]) -> Future[T]:
        """Signals wait meanwhile: a pool that is interrupted while it starts can be neither used nor ended."""
        before = signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
        try:
            return self._pool.submit(_call, self._path, self._seconds, what, given)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)

    def _result(self, future: Future[T]) -> T:
        try:
            return future.result()
        except (MemoryError, BrokenProcessPool) as error:
            if isinstance(error, BrokenProcessPool):  # which takes no further call
                self._pool = self._made()
            raise UserError(
                f"{self._path} takes more memory or processor time than a file of its size may: it is damaged, or "
                "made to do that"
            ) from error


def read_limited(read: Callable[[Path], T], path: Path, cost: Cost, error: type[UserError]) -> T:
    """What a function reads from a file, in a process of its own.

    Raises UserError: of that class: it takes more than it may, or the function refuses it."""
    try:
        with LimitedProcesses(path, cost=cost) as processes:
            return processes.call(read, path)
    except UserError as refused:
        raise error(*refused.args) from refused


def _bytes(path: Path) -> int:
    return path.lstat().st_size


def _limit(more_bytes: int) -> None:
    """Limits the memory of this process, and what its libraries print when they end; signals reach it."""
    signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    most = pages * resource.getpagesize() + more_bytes
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    resource.setrlimit(resource.RLIMIT_AS, (most if hard < 0 else min(most, hard), hard))


def _call(path: Path, seconds: int, what: Callable[..., T], given: tuple[Any, ...]) -> T:
    hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
    most = int(time.process_time()) + 1 + seconds
    resource.setrlimit(resource.RLIMIT_CPU, (most if hard < 0 else min(most, hard), hard))
    try:
        return what(*given)
    except UserError as error:  # whose class may not be made again from its words
        raise UserError(*error.args) from None
    except (LookupError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise UserError(f"{path} is incomplete or malformed: {error!r:.200}") from None
    except (Exception, KeyboardInterrupt, SystemExit):
        raise
    except BaseException as panic:  # of a library in Rust, whose class cannot be sent on
        raise UserError(f"{path} is incomplete or malformed: {panic!r:.200}") from None
