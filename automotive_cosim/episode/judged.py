"""A session that is judged at its end, beside the same drive with nobody at the cockpit."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

from automotive_cosim.contracts import Action, ActionType, Feedback
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.cosim.simulation import TICK_S
from automotive_cosim.episode.baseline import Baseline
from automotive_cosim.episode.session import Session
from automotive_cosim.episode.specification import ROUNDING_S


@dataclass(kw_only=True)
class JudgedSession(Session, ABC):
    """A session on a task or on a drive."""

    baseline: Baseline
    """The same drive from the beginning with nobody at the cockpit, for comparison."""

    @property
    @abstractmethod
    def is_judged(self) -> bool:
        """Whether it has been judged: false while it runs, and if it broke."""

    def drive_on(self) -> None:
        """What is still driven once it is over, for the record.

        Raises:
            InfrastructureError: the road failed.
        """

    @property
    def baseline_moments(self) -> tuple[Moment, ...]:
        """The baseline run from the beginning to now."""
        return self.baseline.until(self.moments[-1].time_s)

    @property
    def _copies(self) -> Sequence[Baseline]:
        """All drives that go on beside this one with nobody at the cockpit."""
        return (self.baseline,)

    def _performed(self, action: Action) -> Feedback:
        if action.action_type is not ActionType.WAIT:
            for copy in self._copies:
                copy.part()
        return super()._performed(action)

    def _advance(self, duration_s: float) -> None:
        """Advances second by second together with the copies: all simulations run at the same time."""
        left_s = duration_s
        while left_s > ROUNDING_S and self.world.moment.driving.end is None:
            tick_s = min(TICK_S, left_s)
            for copy in self._copies:
                copy.prepare(tick_s)
                copy.start(self.world.moment.time_s + tick_s)
            passed = self._heard(self.world.advance(tick_s))
            for copy in self._copies:
                copy.see(passed)
                copy.follow(self.world.moment.time_s)
            self._passed(passed)
            left_s -= tick_s

    def _passed(self, moments: tuple[Moment, ...]) -> None:
        """Takes note of what has just been driven."""
        self.moments += moments
