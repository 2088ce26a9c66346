"""Describes roads and speeds in words, for timelines, live views and pages."""

from __future__ import annotations

from automotive_cosim.contracts import KMH_PER_MPS, Limit, RoadHere
from automotive_cosim.geo.text import amount_of_speed

ROUNDING_KMH = 1.0
"""A speedometer's last digit: a speed this much above the limit counts as at the limit."""

NAMELESS = {
    "motorway": "a motorway",
    "residential": "a residential street",
    "track": "a track",
    "unclassified": "a minor road",
    **{f"{road}_link": "a slip road" for road in ("motorway", "trunk", "primary", "secondary", "tertiary")},
}
"""Names of unnamed roads, by class, where OpenStreetMap's word for the class is not what people say."""


def road_in_words(road: RoadHere) -> str:
    """A road by its name, else by its class."""
    if road.name or not road.road_class:
        return road.name or "an unnamed road"
    if road.road_class in NAMELESS:
        return NAMELESS[road.road_class]
    words = road.road_class.replace("_", " ")
    return f"{'an' if words[0] in 'aeiou' else 'a'} {words}" + ("" if words.endswith("street") else " road")


def speed_in_words(speed_mps: float, limit: Limit, unit: str) -> str:
    """A speed and the limit in the unit of the place: ``"48 km/h, 50 posted"``, ``"30 mph, no limit known"``."""
    return f"{amount_of_speed(speed_mps * KMH_PER_MPS, unit)}, {limit_in_words(limit, unit)}"


def limit_in_words(limit: Limit, unit: str) -> str:
    """A limit with its source, in the unit of the place but without it."""
    if limit.kmh is None:
        return "no limit" if limit.is_posted else "no limit known"
    amount = amount_of_speed(limit.kmh, unit).partition(" ")[0]
    return f"{amount} posted" if limit.is_posted else f"{amount} by law"


def limit_kmh(limit: Limit) -> float | None:
    """A limit in km/h, to a tenth; None if there is none."""
    return None if limit.kmh is None else round(limit.kmh, 1)


def is_over(speed_kmh: float, limit_kmh: float | None) -> bool:
    """Above the limit by more than a speedometer's last digit."""
    return limit_kmh is not None and speed_kmh > limit_kmh + ROUNDING_KMH
