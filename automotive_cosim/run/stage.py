"""What a worker is doing with its job, for whoever waits: its first minutes are the traffic's, not the agent's.

A worker's process says where this goes with ``telling``; elsewhere nobody is told.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

from automotive_cosim.run.observer import Shot, TrialObserver
from automotive_cosim.scenarios import Scenario

EVERY_S = 1.0
"""Wall time between two amounts of the same stage."""
_TELL: ContextVar[Callable[[str, str], None]] = ContextVar("tell_stage", default=lambda what, amount: None)


def doing(what: str, amount: str = "") -> None:
    """Says what is being done for the job.

    Args:
        what: the stage, such as ``warming up traffic``.
        amount: how far it is, such as ``120 of 600 s``.
    """
    _TELL.get()(what, amount)


@contextmanager
def telling(tell: Callable[[str], None]) -> Iterator[None]:
    """Hands on every new stage, and the amounts of one not more often than ``EVERY_S``."""
    said, said_s = "", 0.0

    def hand_on(what: str, amount: str) -> None:
        nonlocal said, said_s
        now_s = time.monotonic()
        if what != said or (amount and now_s - said_s >= EVERY_S):
            said, said_s = what, now_s
            tell(", ".join(filter(None, (what, amount))))

    token = _TELL.set(hand_on)
    try:
        yield
    finally:
        _TELL.reset(token)


class StageObserver(TrialObserver[Any, Any]):
    """Tells the stages of a trial, the agent's by its steps."""

    def loading(self, scenario: Scenario) -> None:
        """See ``Observer.loading``."""
        doing(f"loading {scenario.name}")

    def warming(self, scenario: str, done_s: float, total_s: float) -> None:
        """See ``Observer.warming``."""
        doing("warming up traffic", f"{done_s:.0f} of {total_s:.0f} s")

    def begun(self, session: Any, shot: Shot) -> None:
        """See ``TrialObserver.begun``."""
        doing("agent at work", "step 0")

    def stepped(self, shot: Shot) -> None:
        """See ``TrialObserver.stepped``."""
        doing("agent at work", f"step {len(shot.session.steps) - 1}")
