"""A copy of a drive that needs no simulation of its own until the two diverge.

    shared = SharedTraffic(traffic, step_s)
    shadow = shared.shadow()     # an exact copy from this instant
    shared.advance(1.0)          # simulated
    shadow.advance(1.0)          # reported by the other
    shared.request(alert)        # just before, the shadow gets a simulation of its own, by a branch

The baseline run of an episode is such a copy: most agents make no requests to the road, or late ones, and until
then a branch would only compute the same again. The two are driven in parallel; the states equal those of a branch.
"""

from __future__ import annotations

from collections import deque
from weakref import ref

from automotive_cosim.contracts import (
    Answer,
    Aware,
    DrivingState,
    RoadNetwork,
    RoadRequest,
    RoadShapes,
    RoadSnapshot,
    RouteOption,
)
from automotive_cosim.traffic.base import Advance, Event, Traffic

Passed = tuple[DrivingState, tuple[Event, ...]]
"""A step: its state, and what happened in it."""


def by_step(passed: Advance) -> list[Passed]:
    """What passed, step by step."""
    if not passed.events:
        return [(state, ()) for state in passed.states]
    events, steps = deque(passed.events), list[Passed]()
    for state in passed.states:
        happened = []
        while events and events[0].time_s <= state.time_s:
            happened.append(events.popleft())
        steps.append((state, tuple(happened)))
    return steps


class SharedTraffic:
    """A drive with shadows; otherwise it behaves like the drive that it wraps."""

    def __init__(self, traffic: Traffic, step_s: float) -> None:
        """Takes over a drive.

        Args:
            traffic: the drive, to be used only through this object."""
        self._traffic = traffic
        self.step_s = step_s
        self._shadows: list[ref[Shadow]] = []

    @property
    def wrapped(self) -> Traffic:
        """The drive that it took over."""
        return self._traffic

    @property
    def network(self) -> RoadNetwork:
        return self._traffic.network

    @property
    def state(self) -> DrivingState:
        return self._traffic.state

    def start(self, duration_s: float) -> None:
        self._traffic.start(duration_s)

    def advance(self, duration_s: float) -> Advance:
        passed = self._traffic.advance(duration_s)
        for shadow in self._living():
            shadow.see(passed)
        return passed

    def request(self, request: RoadRequest) -> Answer:
        """See ``Traffic.request``; every shadow is independent from here."""
        for shadow in self._living():
            shadow.part()
        return self._traffic.request(request)

    def alternatives(self, age_s: float = 0.0) -> tuple[RouteOption, ...]:
        options = self._traffic.alternatives(age_s)
        for shadow in self._living():
            shadow.hear(self.state.time_s, age_s, options)
        return options

    def look(self) -> RoadSnapshot:
        return self._traffic.look()

    def shapes(self) -> RoadShapes:
        return self._traffic.shapes()

    def branch(self) -> SharedTraffic:
        """See ``Traffic.branch``; it has no shadows."""
        return SharedTraffic(self._traffic.branch(), self.step_s)

    def shadow(self) -> SharedTraffic:
        """An exact copy from this instant, for somebody who makes no requests to the road."""
        shadow = Shadow(self, self.step_s)
        self._shadows.append(ref(shadow))
        return SharedTraffic(shadow, self.step_s)

    def dismiss(self, shadow: Shadow) -> None:
        """Stops reporting to a shadow."""
        self._shadows = [each for each in self._shadows if each() is not shadow]

    def _living(self) -> list[Shadow]:
        """Those that somebody still has; a ``WeakSet`` takes as long as all else of a second's report."""
        return [shadow for each in self._shadows if (shadow := each()) is not None]

    def close(self) -> None:
        """See ``Traffic.close``. A shadow without a simulation of its own cannot continue."""
        self._traffic.close()


class Shadow:
    """A copy of a drive that receives the other's states as long as both are the same."""

    def __init__(self, shared: SharedTraffic, step_s: float) -> None:
        self._shared = shared
        self._step_s = step_s
        self._state = shared.state
        self._own: Traffic | None = None
        self._ahead: deque[Passed] = deque()
        """Steps that the other has driven and this one has not."""
        self._heard: dict[tuple[float, float], tuple[RouteOption, ...]] = {}
        """Alternatives, by the time of the query and the age of the news."""

    @property
    def network(self) -> RoadNetwork:
        return self._shared.network

    @property
    def state(self) -> DrivingState:
        return self._state

    def start(self, duration_s: float) -> None:
        """See ``Traffic.start``; does nothing as long as it has no simulation of its own."""
        if self._own is not None and not self._ahead:
            self._own.start(duration_s)

    def advance(self, duration_s: float) -> Advance:
        """See ``Traffic.advance``. What the other has not driven yet is run in a simulation of its own."""
        steps = round(duration_s / self._step_s)
        told = [self._ahead.popleft() for _ in range(min(steps, len(self._ahead)))]
        states = tuple(state for state, _ in told)
        events = tuple(event for _, passed in told for event in passed)
        if len(told) < steps and (states or (self._state,))[-1].end is None:
            rest = self.part().advance((steps - len(told)) * self._step_s)
            states, events = states + rest.states, events + rest.events
        if states:
            self._state = states[-1]
        return Advance(states, events)

    def request(self, request: RoadRequest) -> Answer:
        """See ``Traffic.request``. What the driver was aware of is in the steps that the other has driven.

        Raises RuntimeError: the other is ahead already; make the request before it advances."""
        if self._ahead and isinstance(request, Aware):
            return Answer(True, "")
        return self._now().request(request)

    def alternatives(self, age_s: float = 0.0) -> tuple[RouteOption, ...]:
        """See ``Traffic.alternatives``.

        Raises RuntimeError: the other is ahead already, and made no query at this instant."""
        known = self._heard.get((self._state.time_s, age_s))
        if known is not None:
            return known
        if self._own is None and not self._ahead:
            return self._shared.alternatives(age_s)
        return self._now().alternatives(age_s)

    def look(self) -> RoadSnapshot:
        """See ``Traffic.look``. Raises RuntimeError: the other is ahead already."""
        return self._now().look()

    def shapes(self) -> RoadShapes:
        return self._shared.shapes()

    def branch(self) -> Traffic:
        """See ``Traffic.branch``. Raises RuntimeError: the other is ahead already."""
        return self._now().branch()

    def close(self) -> None:
        self._shared.dismiss(self)
        if self._own is not None:
            self._own.close()

    # --- reports from the other ----------------------------------------------------------------------------------

    def see(self, passed: Advance) -> None:
        """Stores the other's states."""
        self._ahead.extend(by_step(passed))

    def hear(self, time_s: float, age_s: float, options: tuple[RouteOption, ...]) -> None:
        """Stores the other's alternatives."""
        self._heard[time_s, age_s] = options

    def part(self) -> Traffic:
        """A simulation of its own, which begins where the other is now."""
        if self._own is None:
            self._own = self._shared.branch()
            self._shared.dismiss(self)
        return self._own

    def _now(self) -> Traffic:
        if self._ahead:
            raise RuntimeError("a shadow cannot act in the past; advance it first")
        return self.part()
