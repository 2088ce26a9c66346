"""Drives from one instant that share a future until they ask the road for something.

    future = SharedFuture(traffic, step_s)
    one, other = future.drive(), future.drive()      # exact copies of the drive at that instant
    one.advance(60.0)                                # simulated
    other.advance(60.0)                              # known already
    other.request(alert)                             # only now it gets a simulation of its own

The gates of a task play it some hundred times from one hand-over, and few of the actions reach the road: without
this, each play would fork a simulation and drive the same again. The states equal those of a branch.
"""

from __future__ import annotations

from automotive_cosim.contracts import (
    Answer,
    DrivingState,
    RoadNetwork,
    RoadRequest,
    RoadShapes,
    RoadSnapshot,
    RouteOption,
)
from automotive_cosim.traffic.base import Advance, Traffic
from automotive_cosim.traffic.shadow import Passed, by_step


class SharedFuture:
    """What a drive comes to if nobody asks it for anything: driven once, as far as somebody wants to know."""

    def __init__(self, traffic: Traffic, step_s: float) -> None:
        """Takes over a drive, which stays where it is.

        Args:
            traffic: the drive, to be used only through this object.
        """
        self.begin = traffic
        self._step_s = step_s
        self._front: Traffic | None = None
        """The drive at the end of what is known; None until something is."""
        self._known: list[Passed] = []
        self._heard: dict[tuple[int, float], tuple[RouteOption, ...]] = {}
        """Alternatives, by the number of steps driven and the age of the news."""

    def drive(self) -> FutureDrive:
        """A drive from the instant at which this begins."""
        return FutureDrive(self)

    def known(self, done: int, duration_s: float) -> list[Passed]:
        """The steps of a duration after so many steps; fewer if the drive ends.

        Raises:
            TrafficError: the simulation failed.
        """
        until = done + round(duration_s / self._step_s)
        missing = until - len(self._known)
        if missing > 0 and (not self._known or self._known[-1][0].end is None):
            if self._front is None:
                self._front = self.begin.branch()
            self._known += by_step(self._front.advance(missing * self._step_s))
        return self._known[done:until]

    def at(self, done: int) -> Traffic:
        """A simulation of its own, after so many steps.

        Raises:
            TrafficError: the simulation failed.
        """
        if self._front is not None and done == len(self._known):
            return self._front.branch()
        traffic = self.begin.branch()
        if done:
            traffic.advance(done * self._step_s)
        return traffic

    def alternatives(self, done: int, age_s: float) -> tuple[RouteOption, ...]:
        """See ``Traffic.alternatives``, after so many steps."""
        key = done, age_s
        if key not in self._heard:
            if self._front is not None and done == len(self._known):
                self._heard[key] = self._front.alternatives(age_s)
            else:
                traffic = self.at(done)
                self._heard[key] = traffic.alternatives(age_s)
                traffic.close()
        return self._heard[key]

    def close(self) -> None:
        """Ends it; drives with a simulation of their own continue until they are closed."""
        if self._front is not None:
            self._front.close()
        self.begin.close()


class FutureDrive:
    """A drive into a future; it gets a simulation of its own when it asks the road for something."""

    def __init__(self, future: SharedFuture, done: int = 0, state: DrivingState | None = None) -> None:
        self._future = future
        self._done = done
        self._state = future.begin.state if state is None else state
        self._own: Traffic | None = None

    @property
    def network(self) -> RoadNetwork:
        return self._future.begin.network

    @property
    def state(self) -> DrivingState:
        return self._state if self._own is None else self._own.state

    def start(self, duration_s: float) -> None:
        """See ``Traffic.start``; does nothing as long as it has no simulation of its own."""
        if self._own is not None:
            self._own.start(duration_s)

    def advance(self, duration_s: float) -> Advance:
        if self._own is not None:
            return self._own.advance(duration_s)
        passed = self._future.known(self._done, duration_s)
        self._done += len(passed)
        if passed:
            self._state = passed[-1][0]
        return Advance(tuple(state for state, _ in passed), tuple(each for _, events in passed for each in events))

    def request(self, request: RoadRequest) -> Answer:
        return self._now().request(request)

    def alternatives(self, age_s: float = 0.0) -> tuple[RouteOption, ...]:
        if self._own is not None:
            return self._own.alternatives(age_s)
        return self._future.alternatives(self._done, age_s)

    def look(self) -> RoadSnapshot:
        return self._now().look()

    def shapes(self) -> RoadShapes:
        return self._future.begin.shapes()

    def branch(self) -> Traffic:
        return FutureDrive(self._future, self._done, self._state) if self._own is None else self._own.branch()

    def close(self) -> None:
        """See ``Traffic.close``; the future stays for others."""
        if self._own is not None:
            self._own.close()

    def _now(self) -> Traffic:
        if self._own is None:
            self._own = self._future.at(self._done)
        return self._own
