"""The form of a scenario: the tables of ``scenario.toml``, each field with its unit in its name."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import Annotated
from unicodedata import combining, normalize

from annotated_types import Ge, Gt, Le, MinLen

from automotive_cosim.contracts import Weather
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.formats.annotations import Called, Latitude, Longitude, OneOf
from automotive_cosim.formats.incidents import AnyIncident, EdgeId


@dataclass(frozen=True, slots=True)
class Sumo:
    """``[sumo]``: how SUMO runs."""

    config: Annotated[str, MinLen(1)]
    """The ``.sumocfg``, relative to the folder."""
    step_length_s: Annotated[float, Ge(0.01), Le(10)] = 0.1
    """0.1 for safety (the ego acts each step), 1 for studies."""
    # None, which a scenario.toml cannot say, leaves it to the .sumocfg
    action_step_length_s: Annotated[float, Ge(0.01), Le(10)] | None = 1.0
    """How often the other drivers act; a multiple of the step length. With it, SUMO integrates ballistically."""
    warm_up_s: Annotated[float, Ge(0), Le(86_400)] = 900.0
    """Traffic runs this long before the ego departs."""
    scale: Annotated[float, Ge(0), Le(100)] = 1.0
    """Factor on the demand."""
    background_rerouting: Annotated[float, Ge(0), Le(1)] = 0.6
    """Share of the other vehicles that reroute by current travel times."""
    random_traffic_per_km_h: Annotated[float, Ge(0)] = 0.0
    """Random departures per hour and kilometre of lane, for a network without demand of its own."""
    redraws_trips: bool = False
    """Whether every seed is another day: each trip of the route files is taken none, one or several times."""
    lateral_resolution_m: Annotated[float, Gt(0)] | None = None
    """Width of SUMO's sublanes, e.g. 0.8: vehicles then form a corridor for blue lights, at about twice the cost.
    None keeps each vehicle in the middle of its lane."""

    def stepping(self, step_s: float) -> Sumo:
        """The same in steps of another length; nobody acts more often than that."""
        action_s = self.action_step_length_s
        return replace(
            self, step_length_s=step_s, action_step_length_s=None if action_s is None else max(step_s, action_s)
        )


@dataclass(frozen=True, slots=True)
class Trip:
    """``[[ego.trips]]``: one route through the network."""

    name: str
    """Name by which tasks and incidents refer to it."""
    from_edge: EdgeId
    """Where it begins."""
    to_edge: EdgeId
    """Where it ends."""
    via: tuple[EdgeId, ...] = ()
    """Edges on the way, in driving order."""
    about: str = ""
    """A description for human readers."""
    from_m: Annotated[float, Ge(0)] | None = None
    """Where the front bumper is at first, from the start of ``from_edge``; without it, near its start."""
    from_lane: Annotated[int, Ge(0)] = 0
    """With ``from_m``: among the lanes for cars, 0 nearest the kerb."""
    from_kmh: Annotated[float, Ge(0)] = 0.0
    """With ``from_m``: the speed at first, at most the limit."""


@dataclass(frozen=True, slots=True)
class Ego:
    """``[ego]``: the car that the cockpit belongs to."""

    trips: Annotated[tuple[Trip, ...], MinLen(1), Called("a list of [[ego.trips]] entries, not empty")]
    """The trips that it may drive; a task selects one."""
    driver: str = "average"
    """Name of a driver profile (``traffic.profiles.PROFILES``)."""
    any_trip: bool = False
    """Whether the trip is drawn by seed."""


@dataclass(frozen=True, slots=True)
class WeatherAt:
    """``[[weather]]``: the weather from ``at_s`` on (seconds after the ego's departure), held until the next."""

    at_s: float
    weather: Weather


LINKS = ("none", "4g", "5g")
"""Kinds of the car's link, from worst to best."""


@dataclass(frozen=True, slots=True)
class LinkAt:
    """``[[connectivity]]``: what the network offers the car from ``at_s`` on (seconds after the ego's departure),
    held until the next."""

    at_s: float
    """Seconds after the ego's departure."""
    best: Annotated[str, OneOf(LINKS)]
    """The best available link, of ``LINKS``; on the road, e.g. in a tunnel, it may be worse or none."""


def link_at(timeline: Sequence[LinkAt], since_departure_s: float) -> str:
    """The best link that a timeline allows at an instant; before its first entry, there is no limit.

    Args:
        timeline: entries in the order of their ``at_s``.
        since_departure_s: seconds after the ego's departure."""
    index = bisect_right([entry.at_s for entry in timeline], since_departure_s) - 1
    return timeline[index].best if index >= 0 else LINKS[-1]


def weather_at(timeline: Sequence[WeatherAt], since_departure_s: float) -> Weather:
    """The weather of a timeline at an instant; before its first entry, that entry applies.

    Args:
        timeline: entries in the order of their ``at_s``, at least one.
        since_departure_s: seconds after the ego's departure."""
    index = bisect_right([entry.at_s for entry in timeline], since_departure_s) - 1
    return timeline[max(index, 0)].weather


def weather_since(timeline: Sequence[WeatherAt], passed_s: float) -> tuple[WeatherAt, ...]:
    """The same weather for a car that departs that many seconds later."""
    return tuple(replace(entry, at_s=entry.at_s - passed_s) for entry in timeline)


@dataclass(frozen=True, slots=True)
class Street:
    """``[[streets]]``: a street to check in the network."""

    name: str
    """As the network spells it."""
    maxspeed: tuple[str, ...] = ()
    """The limits of its signs, in OpenStreetMap's notation: ``"50"``, ``"20 mph"``, ``"none"``; ``"unposted"``
    where there is no sign. All of these, and no others."""


Origin = Annotated[tuple[Longitude, Latitude], Called("a pair [lon, lat] in degrees")]


@dataclass(frozen=True, slots=True, kw_only=True)
class Described:
    """The content of a ``scenario.toml``."""

    name: str
    """The folder's name, by which commands refer to it."""
    title: str
    """For human readers, one line."""
    about: str
    """For human readers, a sentence or two."""
    country: str
    """ISO 3166-1 code of the map's defaults; the law that applies follows from the car's position."""
    sumo: Sumo
    """How SUMO runs."""
    ego: Ego
    """The car that the cockpit belongs to."""
    incidents: Annotated[tuple[AnyIncident, ...], Called("a list of [[incidents]] entries")] = ()
    """Incidents staged on the roads."""
    connectivity: Annotated[tuple[LinkAt, ...], Called("a list of [[connectivity]] entries")] = ()
    """The car's link over time, in the order of ``at_s``; unlimited without entries."""
    has_place: bool = True
    """False if the network has no position on earth, so there is no GPS and no known place."""
    origin: Origin | None = None
    """Longitude and latitude to which the network's middle is moved; without it, the network stays where it is."""
    streets: Annotated[tuple[Street, ...], Called("a list of [[streets]] entries")] = ()
    """Streets that the network must have; ``scenarios check`` verifies them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario(Described):
    """A scenario to run: the content of its file, with its folder and start time."""

    folder: Path
    start: datetime
    """Local time at simulation second ``warm_up_s``; zone-aware."""
    weather: tuple[WeatherAt, ...]
    """Empty if the file says ``weather = "climate"``: drawn by seed from the climate of the place and month."""
    notes: tuple[str, ...] = ()
    """Assumptions, in words for the user."""
    language: str = ""
    """Of the names of streets in a network that is moved, as an ISO 639-1 code."""
    as_stated: bool = False
    """Whether it is SUMO's own experiment: the traffic of a ``.sumocfg`` without a ``scenario.toml``, to which a
    run adds nothing but the ego."""
    mirrored: bool = False
    """Whether the network is the mirror image of the one in its file, because traffic keeps the other side."""

    @property
    def config(self) -> Path:
        """The scenario's ``.sumocfg``."""
        return self.folder / self.sumo.config

    def trip(self, name: str) -> Trip:
        """The ego trip of that name, or with that number, or the only one whose name begins so; accents and case do
        not count then.

        Raises UnknownNameError: the scenario has no such trip."""
        trips = self.ego.trips
        for trip in trips:
            if trip.name == name:
                return trip
        if name.isdecimal() and 0 < int(name) <= len(trips):
            return trips[int(name) - 1]
        begun = [trip for trip in trips if name and _plain(trip.name).startswith(_plain(name))]
        if len(begun) == 1:
            return begun[0]
        raise UnknownNameError(f"trip of scenario {self.name!r}", name, (trip.name for trip in trips))


def _plain(name: str) -> str:
    """A name without accents and case."""
    return "".join(each for each in normalize("NFKD", name.casefold()) if not combining(each))
