"""The road side's protocol: what every traffic simulation offers, whatever runs behind it.

A ``Simulation`` holds a scenario's traffic, loaded and warmed up without the ego. ``depart`` puts the ego into an
exact copy of it and gives a ``Traffic``: one drive, which can be branched at any instant. The implementations
(``in_process.InProcess``, ``fork.Forked``, ``scripted.Scripted``) are interchangeable; the SUMO ones give identical
states for one seed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from typing import Protocol

from automotive_cosim.contracts import Answer, DrivingState, RoadNetwork, RoadRequest, RouteOption
from automotive_cosim.scenarios import Trip, WeatherAt

WarmUpProgress = Callable[[float, float], None]
"""Told the simulated seconds of the warm-up that are done, and how many there are."""


@dataclass(frozen=True, slots=True)
class EgoPlan:
    """How the ego drives: its way, its driver, the seed of the driver's reactions, and under which sky."""

    trip: Trip
    driver: str = "average"
    seed: int = 0
    weather: tuple[WeatherAt, ...] = ()
    """What the road and its drivers meet; empty takes the scenario's own."""
    start: datetime | None = None
    """Local time at departure, zone-aware; None takes the scenario's own."""
    parked: bool = False
    """Stands beside the first lane of its trip and stays there."""
    wait_s: float = 0.0
    """Traffic that passes before it departs, so that it meets other cars and other lights."""


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened on the road in passing.

    | kind | what |
    |---|---|
    | ``driver_...`` | what the driver does after a request: slows, holds, ignores, opens_gap, gives_way, ... |
    | ``incident`` | an incident of the scenario begins or ends |
    | ``pet`` | the ego and another vehicle crossed within five seconds; the post-encroachment time comes first |
    | ``collision`` | two vehicles touched |
    | ``teleport`` | SUMO has taken a vehicle off its road because it stood too long |
    """

    time_s: float
    kind: str
    text: str


@dataclass(frozen=True, slots=True)
class Advance:
    """What one ``Traffic.advance`` saw."""

    states: tuple[DrivingState, ...]
    """One per SUMO step, in order; empty only if the ego had already ended."""
    events: tuple[Event, ...]


class Traffic(Protocol):
    """One drive of the ego through traffic."""

    @property
    def network(self) -> RoadNetwork:
        """The roads, as a map draws them."""
        ...

    @property
    def state(self) -> DrivingState:
        """The newest state."""
        ...

    def start(self, duration_s: float) -> None:
        """Begins in the background what the next call asks for, which must be ``advance`` of that duration, while
        the caller does something else. Does nothing where it runs in this process, or has been started already.

        Raises:
            TrafficError: the simulation died.
        """
        ...

    def advance(self, duration_s: float) -> Advance:
        """Lets the traffic run for ``duration_s``, or until the ego's drive ends.

        Raises:
            TrafficError: the simulation failed; the text names the cause.
        """
        ...

    def request(self, request: RoadRequest) -> Answer:
        """Asks something of the driver or the car. What cannot be done safely is refused with a reason."""
        ...

    def alternatives(self, age_s: float = 0.0) -> tuple[RouteOption, ...]:
        """The way that is being driven and up to three others, the quickest first, with the times that the traffic
        of the last five minutes took. Nothing of it is left in the simulation. Empty where the way is fixed.

        Args:
            age_s: how long ago those five minutes ended, at most ``congestion.OLDEST_NEWS_S``.

        Raises:
            TrafficError: the simulation failed.
        """
        ...

    def branch(self) -> Traffic:
        """An exact copy that drives on by itself from this instant."""
        ...

    def close(self) -> None:
        """Frees everything; harmless when called again."""
        ...


class Simulation(Protocol):
    """A scenario's traffic, warm, from which drives depart."""

    def depart(self, plan: EgoPlan) -> Traffic:
        """Puts the ego on its way and returns its drive at the first instant it is on the road.

        Raises:
            ScenarioError: its trip has no route, or its edges are not in the network.
            NoRoomError: no gap opened for it.
            TrafficError: the simulation failed.
        """
        ...

    def close(self) -> None:
        """Ends the simulation's process, if it has one; harmless when called again."""
        ...
