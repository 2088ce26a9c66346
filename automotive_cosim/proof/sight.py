"""What tells the halves of a pair apart at first sight, and what their declared difference may change.

A pair declares kinds of difference (``tasking.task.Differs``). Each frees some facets of the first observation. All
others have to be the same, or an agent could tell the halves apart by what has nothing to do with the task.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from datetime import datetime
from enum import StrEnum
from typing import Any

from automotive_cosim.cockpit.signals import GLASS
from automotive_cosim.contracts import Element, Observation, VehicleState
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.tasking.task import Differs


class Facet(StrEnum):
    """A part of what an agent sees first."""

    WORDS = "what the driver says"
    PLACE = "the place"
    CLIMATE = "the climate"
    ROAD = "the road"
    SIGN = "the sign"
    VIEW = "the map and the way ahead"
    LINK = "fix and connection"
    MOTION = "gear and restrictions"
    SPEED = "the speed"
    TRAFFIC = "the car in front"
    CLOCK = "the clock"
    SKY = "light and sun"
    WEATHER = "the weather"
    OUTSIDE = "what reaches the car from outside"
    LAMPS = "the lamps"
    CABIN = "air and glass of the cabin"
    SETTINGS = "the settings"
    BATTERY = "the battery"
    SCREEN = "the screen"


_DRIVING = {Facet.SPEED, Facet.TRAFFIC, Facet.VIEW}
"""What other drivers and another pace change."""
_SKY = {Facet.SKY, Facet.OUTSIDE, Facet.LAMPS, Facet.CABIN, *_DRIVING}
FREED: Mapping[Differs, frozenset[Facet]] = {
    Differs.PLACE: frozenset({Facet.PLACE, Facet.SIGN, Facet.CLIMATE}),
    Differs.ROAD: frozenset(
        {Facet.PLACE, Facet.ROAD, Facet.SIGN, Facet.LINK, Facet.OUTSIDE, Facet.LAMPS, Facet.MOTION, *_DRIVING}
    ),
    Differs.TRAFFIC: frozenset({Facet.MOTION, *_DRIVING}),
    Differs.WEATHER: frozenset({Facet.WEATHER, *_SKY}),
    Differs.VISIBILITY: frozenset({Facet.WEATHER, *_SKY}),
    Differs.DATE: frozenset({Facet.CLOCK, Facet.CLIMATE, Facet.ROAD, Facet.SIGN, *_SKY}),
    Differs.TIME: frozenset({Facet.CLOCK, Facet.ROAD, Facet.SIGN, *_SKY}),
    Differs.MOTION: frozenset({Facet.MOTION, Facet.SCREEN, *_DRIVING}),
    Differs.SETTINGS: frozenset({Facet.SETTINGS, Facet.CABIN}),
}
"""What each kind of difference may change. A road has its tunnels; the rules that the context names follow from all
of it and are free."""

READINGS: Mapping[str, tuple[Facet, float]] = {
    "speed_kmh": (Facet.SPEED, 0.1),
    "gear": (Facet.MOTION, 0.0),
    "restrictions": (Facet.MOTION, 0.0),
    "ambient_temperature_c": (Facet.WEATHER, 0.1),
    "cabin_temperature_c": (Facet.CABIN, 1.0),
    "cabin_humidity_pct": (Facet.CABIN, 6.0),
    "rain_intensity_pct": (Facet.OUTSIDE, 1.0),
    "driver_temperature_set_c": (Facet.SETTINGS, 0.0),
    "fan_speed_pct": (Facet.SETTINGS, 0.0),
    "is_low_beam_on": (Facet.LAMPS, 0.0),
    "is_high_beam_on": (Facet.LAMPS, 0.0),
    "is_front_fog_on": (Facet.LAMPS, 0.0),
    "is_rear_fog_on": (Facet.LAMPS, 0.0),
    "is_hazard_on": (Facet.LAMPS, 0.0),
    "energy_level_pct": (Facet.BATTERY, 1.5),
    "range_km": (Facet.BATTERY, 6.0),
    "speed_limit_sign_kmh": (Facet.ROAD, 0.0),
    "leader_gap_m": (Facet.TRAFFIC, 0.0),
    "leader_time_to_collision_s": (Facet.TRAFFIC, 0.0),
}
"""Facet of each reading, and by how much it may differ all the same: what one or two minutes of driving make, by
which the same situation comes earlier or later."""
_ELEMENTS: Mapping[str, Facet] = {
    "home.map": Facet.VIEW,
    "map.": Facet.VIEW,
    "home.street": Facet.VIEW,
    "home.turn": Facet.VIEW,
    "home.route": Facet.VIEW,
    "home.speed": Facet.SPEED,
    "status.speed": Facet.SPEED,
    "status.gear": Facet.MOTION,
    "status.clock": Facet.CLOCK,
    "status.limit_sign": Facet.ROAD,
    "status.connectivity": Facet.LINK,
    "status.gps": Facet.LINK,
    "status.outside_temperature": Facet.WEATHER,
    "status.low_beam": Facet.LAMPS,
    "status.high_beam": Facet.LAMPS,
    "home.outside": Facet.OUTSIDE,
    "home.cabin": Facet.CABIN,
    "home.battery": Facet.BATTERY,
    "home.range": Facet.BATTERY,
    "status.battery": Facet.BATTERY,
    "dock.": Facet.SETTINGS,
}
"""Facet of elements by the beginning of their resource id; all others belong to the screen."""
_EXACT = frozenset({Facet.SCREEN, Facet.SETTINGS})
"""Facets whose elements are compared with their numbers; those of the others are the readings'."""
_FOLLOWS = ("home.media.", "home.cabin_note", "status.notifications")
"""Elements that follow from others: the song from the clock, the note and the notices from the car's readings."""
_LINES: Mapping[str, Facet] = {
    "place": Facet.PLACE,
    "climate": Facet.CLIMATE,
}
"""Facet of the lines of the geo-context by their source; the motion and the position are read from the car."""
CLOCKS_WITHIN_S = 300.0
"""How far apart the local times of hand-overs may be; a later departure into the same traffic makes two minutes."""
FOG_WITHIN = 0.2
"""How much the share of fogged glass may differ."""
_NUMBER = re.compile(r"-?\d+(?:[.,:]\d+)*")


def undeclared(
    differs: frozenset[Differs], one: tuple[Observation, Moment], other: tuple[Observation, Moment]
) -> Iterator[str]:
    """What differs between two first observations though nothing declared frees it, in words.

    Args:
        differs: the declared kinds of difference.
        one: first observation of a half, with its moment.
        other: that of the other half.
    """
    free = frozenset[Facet]().union(*(FREED[kind] for kind in differs))
    seen, as_well = (dict(_facts(*each)) for each in (one, other))
    for name, (facet, _, tolerance) in {**seen, **as_well}.items():
        if facet in free:
            continue
        has, had = (facts[name][1] if name in facts else None for facts in (seen, as_well))
        if not _alike(has, had, tolerance):
            yield f"{facet}, {name}: {_shown(has)} in one half, {_shown(had)} in the other"


Fact = tuple[str, tuple[Facet, Any, float]]


def _facts(observation: Observation, moment: Moment) -> Iterator[Fact]:
    """Each with its name, facet and tolerance."""
    yield "the goal", (Facet.WORDS, observation.goal, 0.0)
    yield "the local time", (Facet.CLOCK, _clock(moment.local_time), CLOCKS_WITHIN_S)
    yield "a position fix", (Facet.LINK, observation.gps is not None and observation.gps.has_fix, 0.0)
    yield "the connection", (Facet.LINK, moment.connectivity.online, 0.0)
    yield "as given", (Facet.WEATHER, moment.weather, 0.0)
    assert observation.vehicle is not None
    assert observation.elements is not None
    yield from _readings(observation.vehicle)
    for glass in (GLASS.WINDSHIELD_FOG, GLASS.REAR_FOG):
        yield glass.path, (Facet.CABIN, moment.signals[glass.path], FOG_WITHIN)
    yield from _on_screen(observation.elements)
    yield from _in_context(moment.context)


def _readings(vehicle: VehicleState) -> Iterator[Fact]:
    for name, (facet, tolerance) in READINGS.items():
        yield name, (facet, getattr(vehicle, name), tolerance)


def _on_screen(elements: tuple[Element, ...]) -> Iterator[Fact]:
    counts: dict[str, int] = {}
    for element in elements:
        name = element.resource_id
        if not name or name.startswith(_FOLLOWS):
            continue  # without a name: the streets on the map
        counts[name] = counts.get(name, 0) + 1
        facet = next((facet for begin, facet in _ELEMENTS.items() if name.startswith(begin)), Facet.SCREEN)
        words = f"{element.text} {element.content_description}".strip()
        words = words if facet in _EXACT else _NUMBER.sub("#", words)
        state = (element.is_enabled, element.is_checked, element.is_selected)
        yield f"{name} {counts[name]}", (facet, (words, *state), 0.0)


def _in_context(context: GeoContext) -> Iterator[Fact]:
    sun = context.sun
    if sun is not None:
        yield "the darkness", (Facet.SKY, sun.darkness, 0.0)
        yield "glare of the sun", (Facet.SKY, sun.glares(context.heading_deg), 0.0)
    for facet in set(_LINES.values()):
        lines = tuple(line.text for line in context.lines if _LINES.get(line.source) is facet)
        yield f"{facet} in the context", (facet, lines, 0.0)
    road = context.road
    yield "kind", (Facet.ROAD, (road.road_class, road.lit), 0.0)
    yield "tunnel or school zone", (Facet.ROAD, (road.in_tunnel, road.school_zone), 0.0)
    yield "sign", (Facet.SIGN, context.posted_limit_kmh, 0.1)


def _clock(time: datetime) -> float:
    """Seconds of the local clock and calendar."""
    return time.replace(tzinfo=None).timestamp()


def _alike(one: Any, other: Any, tolerance: float) -> bool:
    if tolerance and isinstance(one, float) and isinstance(other, float):
        return bool(abs(one - other) <= tolerance)
    return bool(one == other)


def _shown(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.1f}"
    return "; ".join(map(str, value)) if isinstance(value, tuple) else str(value)
