"""The form of a scenario: the tables of ``scenario.toml``, each field with its unit in its name."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Annotated

from annotated_types import Ge, Gt, Le, MinLen

from automotive_cosim.contracts import Weather
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.formats.annotations import Called, Latitude, Longitude, OneOf
from automotive_cosim.scenarios.incidents import AnyIncident, Edge


@dataclass(frozen=True, slots=True)
class Sumo:
    """``[sumo]``: how SUMO runs."""

    config: Annotated[str, MinLen(1)]
    """The ``.sumocfg``, relative to the folder."""
    step_length_s: Annotated[float, Ge(0.01), Le(10)] = 0.1
    """0.1 for safety (the ego acts each step), 1 for studies."""
    action_step_length_s: Annotated[float, Ge(0.01), Le(10)] = 1.0
    """How often the other drivers act; a multiple of the step length."""
    warm_up_s: Annotated[float, Ge(0), Le(86_400)] = 900.0
    """Traffic runs this long before the ego departs."""
    scale: Annotated[float, Ge(0), Le(100)] = 1.0
    """Multiplies the demand."""
    background_rerouting: Annotated[float, Ge(0), Le(1)] = 0.6
    """Share of the other vehicles that reroute by current travel times."""
    random_traffic_per_km_h: Annotated[float, Ge(0)] = 0.0
    """Vehicles that set out each hour per kilometre of lane, from and to anywhere: for a network without demand of
    its own."""
    lateral_resolution_m: Annotated[float, Gt(0)] | None = None
    """Width of SUMO's sublanes, e.g. 0.8: vehicles then make a corridor for blue lights, at about twice the cost.
    None keeps each vehicle in the middle of its lane."""


@dataclass(frozen=True, slots=True)
class Trip:
    """``[[ego.trips]]``: one way through the network."""

    name: str
    """By which tasks and incidents mean it."""
    from_edge: Edge
    """Where it begins."""
    to_edge: Edge
    """Where it ends."""
    via: tuple[Edge, ...] = ()
    """Edges on the way, in driving order."""
    about: str = ""
    """For people."""


@dataclass(frozen=True, slots=True)
class Ego:
    """``[ego]``: the car that the cockpit belongs to."""

    trips: Annotated[tuple[Trip, ...], MinLen(1), Called("a list of [[ego.trips]] entries, not empty")]
    """The ways it may drive; a task says which."""
    driver: str = "average"
    """Name of a driver profile (``traffic.profiles.PROFILES``)."""
    any_trip: bool = False
    """Which of the trips is driven is drawn by seed."""


@dataclass(frozen=True, slots=True)
class WeatherAt:
    """``[[weather]]``: the weather from ``at_s`` on (seconds after the ego's departure), held until the next."""

    at_s: float
    weather: Weather


LINKS = ("none", "4g", "5g")
"""Kinds of a car's link to the outside, the better ones last."""


@dataclass(frozen=True, slots=True)
class LinkAt:
    """``[[connectivity]]``: what the network offers the car from ``at_s`` on (seconds after the ego's departure),
    held until the next."""

    at_s: float
    """Seconds after the ego's departure."""
    best: Annotated[str, OneOf(LINKS)]
    """The best link there is, of ``LINKS``; where the road is it may still be worse, or none."""


def link_at(timeline: Sequence[LinkAt], since_departure_s: float) -> str:
    """The best link that a timeline leaves at an instant; before its first entry there is no bound.

    Args:
        timeline: entries in the order of their ``at_s``.
        since_departure_s: seconds after the ego's departure.
    """
    index = bisect_right([entry.at_s for entry in timeline], since_departure_s) - 1
    return timeline[index].best if index >= 0 else LINKS[-1]


def weather_at(timeline: Sequence[WeatherAt], since_departure_s: float) -> Weather:
    """The weather of a timeline at an instant; before its first entry that first entry holds.

    Args:
        timeline: entries in the order of their ``at_s``, at least one.
        since_departure_s: seconds after the ego's departure.
    """
    index = bisect_right([entry.at_s for entry in timeline], since_departure_s) - 1
    return timeline[max(index, 0)].weather


@dataclass(frozen=True, slots=True)
class Street:
    """``[[streets]]``: a street the scenario is about."""

    name: str
    """As the network spells it."""
    maxspeed: tuple[str, ...] = ()
    """What its signs say, as OpenStreetMap writes it: ``"50"``, ``"20 mph"``, ``"none"``; ``"unposted"`` where no
    sign stands. Each of these, and no other."""


Origin = Annotated[tuple[Longitude, Latitude], Called("a pair [lon, lat] in degrees")]


@dataclass(frozen=True, slots=True, kw_only=True)
class Described:
    """What a ``scenario.toml`` says as it is."""

    name: str
    """The folder's, as commands take it."""
    title: str
    """For people, one line."""
    about: str
    """For people, a sentence or two."""
    country: str
    """ISO 3166-1 code the map's defaults were taken from; where the car is follows from its position."""
    sumo: Sumo
    """How SUMO runs."""
    ego: Ego
    """The car that the cockpit belongs to."""
    incidents: Annotated[tuple[AnyIncident, ...], Called("a list of [[incidents]] entries")] = ()
    """What is staged on the roads."""
    connectivity: Annotated[tuple[LinkAt, ...], Called("a list of [[connectivity]] entries")] = ()
    """What the network offers the car, in the order of ``at_s``; nothing bounds it without."""
    has_place: bool = True
    """False: its network lies nowhere on earth, so that there is no GPS and no place is known."""
    origin: Origin | None = None
    """Longitude and latitude that the network's middle is moved to; without it stays where it is."""
    streets: Annotated[tuple[Street, ...], Called("a list of [[streets]] entries")] = ()
    """Streets that the network must have; ``scenarios check`` looks for them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario(Described):
    """A scenario to run: what its file says, and where and when that is."""

    folder: Path
    start: datetime
    """Local time at simulation second ``warm_up_s``; zone-aware."""
    weather: tuple[WeatherAt, ...]
    """Empty if the file says ``weather = "climate"``: drawn by seed from the climate of the place and month."""
    notes: tuple[str, ...] = ()
    """What was assumed for want of better, in words for the user."""

    @property
    def config(self) -> Path:
        """The scenario's ``.sumocfg``."""
        return self.folder / self.sumo.config

    def trip(self, name: str) -> Trip:
        """The ego trip of that name.

        Raises:
            UnknownNameError: the scenario has none such.
        """
        for trip in self.ego.trips:
            if trip.name == name:
                return trip
        raise UnknownNameError(f"trip of scenario {self.name!r}", name, (trip.name for trip in self.ego.trips))
