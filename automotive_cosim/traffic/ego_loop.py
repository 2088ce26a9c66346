"""The loop of one drive, the same for every implementation: step, then driver."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from automotive_cosim.contracts import (
    Answer,
    DrivingState,
    Reroute,
    RoadRequest,
    RoadShapes,
    RoadSnapshot,
    RouteOption,
)
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


class EgoLoop:
    """One drive on a road, from its first instant."""

    def __init__(
        self, road: Stepper, driver: Driver, now: Instant, *, take: Callable[[], None] | None = None
    ) -> None:
        """Takes over the road, and lets the driver set the pedals.

        Args:
            road: what moves the ego.
            driver: its driver.
            now: the first instant.
            take: SUMO goes on driving it as it does until the cockpit asks for something other than a route; then
                this is called, and from there on the driver drives. None where he does from the first instant."""
        self._road = road
        self._driver = driver
        self._now = now
        self._take = take
        if take is None:
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
        return self.proceed(*self._road.step(hazard_lights=self.hazard_lights))

    @property
    def hazard_lights(self) -> bool:
        """Whether they are on."""
        return self._driver.hazard_lights

    @property
    def driver_state(self) -> tuple[object, ...]:
        """What the driver has in mind, and draws next (``Driver.state``)."""
        return self._driver.state

    def react_anew(self, seed: int) -> None:
        self._driver.react_anew(seed)

    def proceed(self, now: Instant, events: tuple[Event, ...]) -> tuple[Event, ...]:
        """Takes the instant after a step and its events, and gives the driver his turn; all that happened."""
        self._now = now
        return events if self.has_ended or self._take is not None else events + self._driver.tick(now)

    def request(self, request: RoadRequest) -> Answer:
        if self._take is not None and not self.has_ended and not isinstance(request, Reroute):
            self._take()
            self._take = None
            self._driver.tick(self._now)
        return self._driver.request(request, self.state)

    def alternatives(self, age_s: float) -> tuple[RouteOption, ...]:
        return () if self._now.end is not None else self._road.alternatives(age_s)

    def look(self) -> RoadSnapshot:
        return RoadSnapshot(self.state.time_s, (), ()) if self._now.end is not None else self._road.look()

    def shapes(self) -> RoadShapes:
        return self._road.shapes()
