"""The form of a scenario: the tables of ``scenario.toml``, each field with its unit in its name."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from automotive_cosim.contracts import Weather
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.scenarios.incidents import Incident


@dataclass(frozen=True, slots=True)
class Sumo:
    """``[sumo]``: how SUMO runs."""

    config: str
    """The ``.sumocfg``, relative to the folder."""
    step_length_s: float = 0.1
    """0.1 for safety (the ego acts each step), 1 for studies."""
    action_step_length_s: float = 1.0
    """How often the other drivers act; a multiple of the step length."""
    warm_up_s: float = 900.0
    """Traffic runs this long before the ego departs."""
    scale: float = 1.0
    """Multiplies the demand."""
    background_rerouting: float = 0.6
    """Share of the other vehicles that reroute by current travel times."""
    random_traffic_per_km_h: float = 0.0
    """Vehicles that set out each hour per kilometre of lane, from and to anywhere: for a network without demand of
    its own."""
    lateral_resolution_m: float | None = None
    """Width of SUMO's sublanes, e.g. 0.8: vehicles then make a corridor for blue lights, at about twice the cost.
    None keeps each vehicle in the middle of its lane."""


@dataclass(frozen=True, slots=True)
class Trip:
    """``[[ego.trips]]``: one way through the network."""

    name: str
    from_edge: str
    to_edge: str
    via: tuple[str, ...] = ()
    about: str = ""


@dataclass(frozen=True, slots=True)
class Ego:
    """``[ego]``: the car that the cockpit belongs to."""

    trips: tuple[Trip, ...]
    driver: str = "average"
    """Name of a driver profile (``traffic.profiles.PROFILES``)."""
    any_trip: bool = False
    """Which of the trips is driven is drawn by seed."""


DRAWN = "climate"
"""What a scenario says instead of a timeline to have its weather drawn."""


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
    best: str
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
    maxspeed: tuple[str, ...] = ()
    """What its signs say, as OpenStreetMap writes it: ``"50"``, ``"20 mph"``, ``"none"``; ``"unposted"`` where no
    sign stands. Each of these, and no other."""


@dataclass(frozen=True, slots=True)
class Scenario:
    """One ``scenario.toml``, checked."""

    name: str
    title: str
    about: str
    folder: Path
    country: str
    """ISO 3166-1 code the map's defaults were taken from; where the car is follows from its position."""
    start: datetime
    """Local time at simulation second ``warm_up_s``; zone-aware."""
    sumo: Sumo
    ego: Ego
    weather: tuple[WeatherAt, ...]
    """Empty if the file says ``weather = "climate"``: drawn by seed from the climate of the place and month."""
    incidents: tuple[Incident, ...] = ()
    connectivity: tuple[LinkAt, ...] = ()
    has_place: bool = True
    """False: its network lies nowhere on earth, so that there is no GPS and no place is known."""
    origin: tuple[float, float] | None = None
    """Longitude and latitude that the network's middle is moved to; None leaves it where it is."""
    streets: tuple[Street, ...] = ()
    """Streets that the network must have; ``scenarios check`` looks for them."""
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
