"""Warm simulations that the environments of a process share unless they are given others."""

from __future__ import annotations

import os
import threading
import weakref
from collections.abc import Callable

from automotive_cosim.traffic.fork import Simulations

COUNT_LIMIT = 16
"""Most simulations kept: as many vectors have environments with traffic of their own."""


class SharedPool:
    """Simulations that end when the last environment that uses them is closed, or gone."""

    def __init__(self) -> None:
        """Starts without simulations and without environments."""
        self._lock = threading.Lock()
        self._begin()

    def join(self, user: object) -> tuple[Simulations, Callable[[], object]]:
        """The simulations, and what the user calls when it needs them no more, also more than once."""
        with self._lock:
            if self._process != os.getpid():  # forked: what is kept belongs to the process before
                self._begin()
            self._users += 1
            return self._simulations, weakref.finalize(user, self._leave, self._simulations)

    def _begin(self) -> None:
        self._process, self._users = os.getpid(), 0
        self._simulations = Simulations(COUNT_LIMIT)

    def _leave(self, simulations: Simulations) -> None:
        with self._lock:
            if simulations is not self._simulations:
                return
            self._users -= 1
            if not self._users:
                simulations.close()


POOL = SharedPool()
