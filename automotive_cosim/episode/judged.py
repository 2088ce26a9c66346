"""A session that is judged at its end, beside the same drive with nobody at the cockpit."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import takewhile

from automotive_cosim.contracts import Action, ActionType, Feedback
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.cosim.simulation import TICK_S, CoSimulation
from automotive_cosim.episode.session import Session
from automotive_cosim.episode.specification import ROUNDING_S


class Baseline:
    """The baseline run, driven along with the episode and only as far; the episode's branches share it.

    As long as the agent has done nothing, it is the episode's own drive, tick by tick, and takes over its moments.
    ``part`` then makes it a drive with a car of its own.
    """

    def __init__(self, world: CoSimulation) -> None:
        """Begins at the hand-over of the episode's world, which the episode keeps."""
        self._shared = world
        self._own: CoSimulation | None = None
        self._moments: list[Moment] = [world.moment]

    def part(self) -> None:
        """Makes it a drive of its own, just before the agent does something; may be called again."""
        if self._own is None:
            self._own = self._shared.shadow()

    def prepare(self, duration_s: float) -> None:
        """Parts if the episode is about to run for a time that ends between two ticks."""
        if duration_s % TICK_S:
            self.part()

    def see(self, passed: Sequence[Moment]) -> None:
        """Takes over what the episode has just driven, unless the two have parted."""
        if self._own is None:
            self._moments += passed

    def start(self, time_s: float) -> None:
        """Starts to run its traffic to a simulation time while the caller does something else."""
        if self._own is not None and self._is_before(time_s):
            self._own.traffic.start(TICK_S)

    def until(self, time_s: float) -> tuple[Moment, ...]:
        """Its moments from the hand-over to the first whole tick at or after that time, or to the end of its drive.

        Raises:
            TrafficError: the traffic simulation failed.
        """
        self.follow(time_s)
        last = next(
            (i for i, moment in enumerate(self._moments) if moment.time_s >= time_s - ROUNDING_S),
            len(self._moments) - 1,
        )
        return tuple(self._moments[: last + 1])

    def since(self, time_s: float) -> list[Moment]:
        """Its moments so far that are later than that."""
        later = takewhile(lambda moment: moment.time_s > time_s + ROUNDING_S, reversed(self._moments))
        return list(later)[::-1]

    def follow(self, time_s: float) -> None:
        """Drives to that simulation time.

        Raises:
            TrafficError: the traffic simulation failed.
        """
        while self._is_before(time_s):
            assert self._own is not None, "the episode's drive went on without the baseline run"
            self._moments += self._own.advance(TICK_S)

    def close(self) -> None:
        """Ends its drive; may be called again."""
        if self._own is not None:
            self._own.close()

    def _is_before(self, time_s: float) -> bool:
        last = self._moments[-1]
        return last.time_s < time_s - ROUNDING_S and last.driving.end is None


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
