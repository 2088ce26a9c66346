"""What a worker is doing with its job, for whoever waits: its first minutes are the traffic's, not the agent's.

A worker's process says where this goes with ``telling``; elsewhere nobody is told.
"""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.session import Session
from automotive_cosim.run.observer import Shot, TrialObserver
from automotive_cosim.scenarios import Scenario

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
        amount: how far it is, such as ``120 of 600 s``.
        is_warm_up: see ``JobPhase``.
        share: see ``JobPhase``.
    """
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


class PhaseObserver(TrialObserver):
    """Tells the phases of a trial, the agent's by its steps or, on a drive, by the time."""

    _session: Session | None = None

    def loading(self, scenario: Scenario) -> None:
        doing(f"loading {scenario.name}", is_warm_up=True)

    def warming(self, scenario: str, done_s: float, total_s: float) -> None:
        warming_up(done_s, total_s)

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        if self._session is None:
            doing("driving to the hand-over")
        elif self._watches and (most_s := self._session.setup.max_sim_s):
            done_s = min(self._session.seconds, most_s)
            doing("agent on watch", f"{done_s:.0f} of {most_s:.0f} s", share=done_s / most_s)

    def begun(self, session: Session, shot: Shot) -> None:
        self._session = session
        if self._watches:
            doing("agent on watch", share=0.0)
        else:
            doing("agent at work", "step 0")

    def stepped(self, shot: Shot) -> None:
        if not self._watches:
            doing("agent at work", f"step {len(shot.session.steps) - 1}")

    @property
    def _watches(self) -> bool:
        """Whether it is a drive, of which the time says more than the step."""
        return self._session is not None and self._session.observation.on_watch
