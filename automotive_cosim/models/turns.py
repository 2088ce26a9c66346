"""Turns at an endpoint that allows only so many questions a minute."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Protocol


class Turns(Protocol):
    """Hands out turns to episodes that share one model."""

    def wait_s(self, model: str, per_minute: float) -> float:
        """Takes the next turn at a model, and returns the seconds until it."""
        ...


class LocalTurns:
    """Turns for one process; any thread may take one."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        """All turns are free.

        Args:
            clock: seconds.
        """
        self._clock = clock
        self._lock = threading.Lock()
        self._next_s: dict[str, float] = {}

    def wait_s(self, model: str, per_minute: float) -> float:
        with self._lock:
            now_s = self._clock()
            turn_s = max(now_s, self._next_s.get(model, now_s))
            self._next_s[model] = turn_s + 60 / per_minute
            return turn_s - now_s
