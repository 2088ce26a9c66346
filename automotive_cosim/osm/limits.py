"""Turns speed limits as written in OSM into what netconvert understands.

Values follow the OSM wiki's pages "Key:maxspeed" and "Key:source:maxspeed": a number (km/h), ``30 mph``, ``none``,
``walk``, or the zone that implies the limit (``FR:urban``, ``DE:zone:30``, ``GB:nsl_single``).
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from automotive_cosim.osm.country import LIVING_STREET_KMH, assumed_limit_kmh, limits_of

WALK_KMH = 7.0
"""``maxspeed=walk``: walking pace as interpreted by German courts (StVO sign 325)."""

MPH_COUNTRIES = frozenset(("GB", "US", "IM", "GG", "JE"))
"""Countries where a bare number in a zone's name (``GB:20``) means miles per hour."""

LIMIT_KEYS = ("maxspeed", "maxspeed:forward", "maxspeed:backward")

ZONE_KEYS = ("zone:maxspeed", "source:maxspeed", "maxspeed:type")
"""Keys that name the zone whose sign sets the limit, when ``maxspeed`` itself doesn't."""

_NUMBER = re.compile(r"(\d+(?:\.\d+)?)\s*(km/h|kmh|kph|mph)?")
_ZONE = re.compile(r"([A-Z]{2})(?:-[A-Z0-9]+)?:(.+)")
_ZONE_NUMBER = re.compile(r"(?:zone:?)?(\d+)")


def complete(tags: Mapping[str, str], country: str, *, built_up: bool) -> dict[str, str]:
    """Tags in which netconvert finds the way's limit.

    A limit that the map states goes into ``maxspeed``. An assumed one goes into ``maxspeed:forward``, which
    netconvert obeys for both directions without keeping it as a parameter of the edge: this is how the network
    distinguishes posted from assumed limits. ``maxspeed:backward`` is kept only if there is an opposite direction,
    because netconvert would otherwise add one.
    """
    done = {key: value for key, value in tags.items() if key not in LIMIT_KEYS}
    stated = stated_limit(tags)
    if stated is None:
        dual = tags.get("oneway") == "yes" or "motorroad" in tags
        assumed = assumed_limit_kmh(country, tags["highway"], built_up=built_up, dual=dual)
        return done | {"maxspeed:forward": f"{assumed:g}"}
    signs = {"maxspeed": stated, "maxspeed:forward": _sign(tags.get("maxspeed:forward", ""))}
    if tags.get("oneway", "no") == "no" and "junction" not in tags and not tags["highway"].startswith("motorway"):
        signs["maxspeed:backward"] = _sign(tags.get("maxspeed:backward", ""))
    return done | {key: sign for key, sign in signs.items() if sign is not None}


def stated_limit(tags: Mapping[str, str]) -> str | None:
    """The limit the map states, as netconvert reads it (``"50"``, ``"30 mph"``, ``"none"``), or None."""
    for key in LIMIT_KEYS:
        limit = _sign(tags.get(key, ""))
        if limit is not None:
            return limit
    zones = (_zone_limit(tags.get(key, "")) for key in ZONE_KEYS)
    return next((limit for limit in zones if limit is not None), None)


def zone_of(tags: Mapping[str, str]) -> str:
    """The zone that a road's tags put it in (``"urban"``, ``"rural"``, ``"30"``, …), "" without one."""
    for key in ("zone:traffic", "maxspeed", *ZONE_KEYS):
        zone = _ZONE.fullmatch(tags.get(key, ""))
        if zone:
            return zone[2]
    return ""


def _sign(value: str) -> str | None:
    """One value of ``maxspeed``; of several (``"70;90"``) the lowest."""
    if value in ("none", "unlimited"):
        return "none"
    if value == "walk":
        return f"{WALK_KMH:g}"
    numbers = [match for match in map(_NUMBER.fullmatch, map(str.strip, value.split(";"))) if match]
    if not numbers:
        return _zone_limit(value)
    lowest = min(numbers, key=lambda match: float(match[1]))
    return f"{lowest[1]} mph" if lowest[2] == "mph" else lowest[1]


def _zone_limit(value: str) -> str | None:
    zone = _ZONE.fullmatch(value)
    if not zone:
        return None
    number = _ZONE_NUMBER.fullmatch(zone[2])
    if number:
        return f"{number[1]} mph" if zone[1] in MPH_COUNTRIES else number[1]
    limits = limits_of(zone[1])
    kmh = {
        "urban": limits.town,
        "rural": limits.rural,
        "nsl_single": limits.rural,
        "trunk": limits.dual,
        "nsl_dual": limits.dual,
        "motorway": limits.motorway,
        "living_street": LIVING_STREET_KMH,
    }.get(zone[2])
    return None if kmh is None else f"{kmh:g}"
