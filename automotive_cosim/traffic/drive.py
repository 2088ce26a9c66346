"""The loop of one drive, the same for every implementation: step, then driver."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from automotive_cosim.contracts import Answer, DrivingState, RoadRequest, RoadShapes, RoadSnapshot, RouteOption
from automotive_cosim.traffic.base import Advance, Event
from automotive_cosim.traffic.ego import Driver
from automotive_cosim.traffic.instant import Instant


class Stepper(Protocol):
    """Something that moves the ego by one step."""

    step_s: float

    def step(self, *, hazard_lights: bool) -> tuple[Instant, tuple[Event, ...]]:
        """The instant after one step, and its events; the last has its end set."""
        ...

    def alternatives(self, age_s: float) -> tuple[RouteOption, ...]: ...

    def look(self) -> RoadSnapshot: ...

    def shapes(self) -> RoadShapes: ...


class EgoDrive:
    """One drive on a road, from its first instant."""

    def __init__(self, road: Stepper, driver: Driver, now: Instant) -> None:
        """Takes over the road, and lets the driver set the pedals."""
        self._road = road
        self._driver = driver
        self._now = now
        driver.tick(now)

    @property
    def state(self) -> DrivingState:
        return self._now.state

    @property
    def has_ended(self) -> bool:
        """Whether the ego has arrived or is no longer on the road."""
        return self._now.end is not None

    def advance(self, duration_s: float, beat: Callable[[], None] | None = None) -> Advance:
        """See ``Traffic.advance``; ``beat`` is called after every step."""
        passed: list[Instant] = []
        events: list[Event] = []
        for _ in range(round(duration_s / self._road.step_s)):
            if self._now.end is not None:
                break
            events += self.step()
            passed.append(self._now)
            if beat is not None:
                beat()
        return Advance(tuple(instant.state for instant in passed), tuple(events))

    def step(self) -> tuple[Event, ...]:
        """One step of a drive that has not ended; what happened in it."""
        driver = self._driver
        self._now, events = self._road.step(hazard_lights=driver.hazard_lights)
        return events if self.has_ended else events + driver.tick(self._now)

    def request(self, request: RoadRequest) -> Answer:
        return self._driver.request(request, self.state)

    def alternatives(self, age_s: float) -> tuple[RouteOption, ...]:
        return () if self._now.end is not None else self._road.alternatives(age_s)

    def look(self) -> RoadSnapshot:
        return RoadSnapshot(self.state.time_s, (), ()) if self._now.end is not None else self._road.look()

    def shapes(self) -> RoadShapes:
        return self._road.shapes()
