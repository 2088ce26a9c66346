"""The protocol of traffic simulations, independent of the implementation.

A ``Simulation`` holds a scenario's traffic, loaded and warmed up without the ego. ``depart`` puts the ego into an
exact copy of it and gives a ``Traffic``: one drive, which can be branched at any instant. The implementations
(``fork.Forked``, and those of the tests) are interchangeable and give identical states for one seed.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from datetime import datetime
from typing import Annotated, Protocol

from annotated_types import Ge, Gt

from automotive_cosim.contracts import (
    Answer,
    DrivingState,
    RoadNetwork,
    RoadRequest,
    RoadShapes,
    RoadSnapshot,
    RouteOption,
)
from automotive_cosim.formats.incidents import AnyIncident
from automotive_cosim.formats.scenario import Scenario, Trip, WeatherAt

WarmUpProgress = Callable[[float, float], None]
"""Called with the simulated seconds of the warm-up that are done, and their total."""


@dataclass(frozen=True, slots=True)
class DriverAt:
    """How the ego is driven from ``at_s`` on (seconds after its departure), until the next."""

    at_s: Annotated[float, Ge(0)]
    driver: str
    """Name of a driver profile."""


@dataclass(frozen=True, slots=True)
class HaltAt:
    """The ego is parked beside the road at the next place from ``at_s`` on (seconds after its departure) that is no
    motorway and no tunnel, and drives on after ``for_s``."""

    at_s: Annotated[float, Ge(0)]
    for_s: Annotated[float, Gt(0)]


@dataclass(frozen=True, slots=True)
class EgoPlan:
    """How the ego drives: its trip, its driver, the seed of the driver's reactions, and the weather."""

    trip: Trip
    driver: str = "average"
    seed: int = 0
    weather: tuple[WeatherAt, ...] = ()
    """The weather timeline; empty takes the scenario's own."""
    start: datetime | None = None
    """Local time at departure, zone-aware; None takes the scenario's own."""
    parked: bool = False
    """Whether it stays parked beside the first lane of its trip."""
    emission_class: str = ""
    """SUMO's emission class of the ego, such as ``Energy/default`` for an electric one; empty leaves SUMO's own."""
    wait_s: float = 0.0
    """Additional traffic time before it departs, so that it meets other cars and other signals."""
    onward: tuple[Trip, ...] = ()
    """Trips that it drives next, one after another and over again, each where one can go on from it
    (``rounds.Round``)."""
    moods: tuple[DriverAt, ...] = ()
    """Changes of the way it is driven, in the order of their times. Acceleration and gap when standing stay."""
    at_schools: tuple[str, ...] = ()
    """Names of the driver profiles in school zones at their hours: one for each zone that it enters, over and over
    again. Empty means that it is driven as elsewhere."""
    halts: tuple[HaltAt, ...] = ()
    """Where it is parked for a while, in the order of the times."""
    incidents: tuple[AnyIncident, ...] = ()
    """Staged on this drive besides the scenario's own; their times count from its departure."""
    advice_s: float = math.inf
    """For how long the driver keeps to what was asked or advised, and stops when asked to; by default for good."""
    keeps_stops: bool = False
    """Whether every other route that the car or SUMO finds passes the rest of the trip's ``via``, as its stops."""
    brakes_early: bool = False
    """Whether the driver brakes early and gently for what stands ahead, as attentive people do. SUMO's model brakes
    as late as it can: from 50 km/h at 21 m."""
    attention: bool = False
    """Whether the driver's attention can be elsewhere (``Aware``); by default it never is."""
    settles_s: float = 0.0
    """Over how many seconds the road takes on the grip of other weather; by default at once."""

    @property
    def advice_ends(self) -> bool:
        """Whether what was asked or advised ends, as on a drive."""
        return self.advice_s < math.inf


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened on the road.

    | kind | meaning |
    |---|---|
    | ``driver_...`` | the driver's reaction to a request: slows, holds, ignores, opens_gap, gives_way, ... |
    | ``driver_parks``, ``driver_sets_off`` | the ego is parked as planned, and drives on |
    | ``driver_goes_on`` | the driver has entered the next destination of the round |
    | ``driver_drives_on`` | a stop that was asked for is over |
    | ``driver_released`` | what was asked or advised has ended; the driver drives as before |
    | ``incident`` | an incident of the scenario begins or ends |
    | ``pet`` | the ego and another crossed or merged within five seconds, with their post-encroachment time |
    | ``collision`` | two vehicles touched |
    | ``teleport`` | SUMO has moved a vehicle because it stood too long |
    """

    time_s: float
    kind: str
    text: str


@dataclass(frozen=True, slots=True)
class Advance:
    """The result of one ``Traffic.advance``."""

    states: tuple[DrivingState, ...]
    """One per SUMO step, in order; empty only if the ego had already ended."""
    events: tuple[Event, ...]


class Traffic(Protocol):
    """One drive of the ego through traffic."""

    @property
    def network(self) -> RoadNetwork:
        """The road network for maps."""
        ...

    @property
    def state(self) -> DrivingState: ...

    def start(self, duration_s: float) -> None:
        """Starts the next call, which must be ``advance`` of that duration, in the background while the caller does
        something else. Does nothing if it runs in this process, or has been started already.

        Raises TrafficError: the simulation died."""
        ...

    def advance(self, duration_s: float) -> Advance:
        """Lets the traffic run for ``duration_s``, or until the ego's drive ends.

        Raises TrafficError: the simulation failed; the message names the cause."""
        ...

    def request(self, request: RoadRequest) -> Answer:
        """Makes a request to the driver or the car. What cannot be done safely is refused with a reason."""
        ...

    def alternatives(self, age_s: float = 0.0) -> tuple[RouteOption, ...]:
        """The present route and up to three others, the quickest first, with travel times of the last five minutes.
        It has no side effects on the simulation. Empty where the route cannot be changed.

        Args:
            age_s: how long ago those five minutes ended, at most ``contracts.OLDEST_NEWS_S``.

        Raises:
            TrafficError: the simulation failed."""
        ...

    def look(self) -> RoadSnapshot:
        """Every vehicle around the ego now, and the traffic lights. It has no side effects on the simulation.

        Raises TrafficError: the simulation failed."""
        ...

    def shapes(self) -> RoadShapes:
        """The lanes and junctions of the network. Raises TrafficError: the simulation failed."""
        ...

    def branch(self) -> Traffic:
        """An exact copy that is independent from this instant."""
        ...

    def close(self) -> None:
        """Frees everything; may be called again."""
        ...


class Simulation(Protocol):
    """A scenario's warm traffic, from which drives depart."""

    def depart(self, plan: EgoPlan) -> Traffic:
        """Starts the ego and returns its drive at the first instant it is on the road.

        Raises:
            ScenarioError: its trip has no route, or its edges are not in the network.
            NoRoomError: no gap opened for it.
            TrafficError: the simulation failed."""
        ...

    def close(self) -> None:
        """Ends the simulation's process, if it has one; may be called again."""
        ...


class WarmSimulations(Protocol):
    """Simulations by their scenario and seed, from which drives depart."""

    def held(
        self, scenario: Scenario, seed: int, progress: WarmUpProgress | None = None
    ) -> AbstractContextManager[Simulation]:
        """The warm simulation of a scenario, made now if there is none, and kept at least while it is held."""
        ...
