"""A session that is judged at its end, beside the same drive with nobody at the cockpit."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.baseline import Baseline
from automotive_cosim.episode.session import Session


@dataclass(kw_only=True)
class JudgedSession(Session, ABC):
    """A session on a task or on a drive."""

    baseline: Baseline
    """The same drive from the beginning with nobody at the cockpit, for comparison."""

    @property
    @abstractmethod
    def is_judged(self) -> bool:
        """Whether it has been judged: false while it runs, and if it broke."""

    @property
    def baseline_moments(self) -> tuple[Moment, ...]:
        """The baseline run from the beginning to now."""
        return self.baseline.until(self.moments[-1].time_s)
