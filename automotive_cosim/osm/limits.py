"""The speed limits that OSM tags state, one for each direction of a road, and the zone that they put it in.

The words are those of the OSM wiki's pages "Key:maxspeed", "Key:maxspeed:type", "Key:source:maxspeed",
"Key:zone:maxspeed", "Key:zone:traffic" and "Lanes". Four laws hold for all of them:

* A sign wins: a zone never overrides a ``maxspeed``.
* The nearer key wins: of the car before of every vehicle, of one direction before of both.
* A number in a zone's name (``DE:zone30``, ``GB:20``) is the limit on the zone's signs.
* A zone without a number (``FR:urban``, ``US-CA:rural``) states no limit: the law of that place sets it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from automotive_cosim.osm.country import KMH_PER_MPH

WALK_KMH = 7.0
"""``maxspeed=walk``: walking pace as interpreted by German courts (StVO sign 325)."""

# fmt: off
MPH_COUNTRIES = frozenset((
    "AG", "AI", "AS", "BS", "BZ", "DM", "FK", "GB", "GD", "GG", "GU", "IM", "JE", "KN", "KY", "LC", "LR", "MP",
    "MS", "PR", "SH", "TC", "US", "VC", "VG", "VI", "WS",
))
# fmt: on
"""Countries and territories whose signs are in miles per hour, as is a bare number in a zone's name (``GB:20``)."""

CAR_KEYS = ("maxspeed:motorcar", "maxspeed:motor_vehicle", "maxspeed")
"""Limits that bind cars, the most specific first."""

ZONE_KEYS = ("zone:maxspeed", "maxspeed:type", "source:maxspeed")
"""Keys that name the zone whose sign sets the limit, if ``maxspeed`` itself does not."""

BUILT_UP_ZONES = {
    "urban": True,
    "living_street": True,
    "nsl_restricted": True,
    "school": None,
    "rural": False,
    "trunk": False,
    "motorway": False,
    "nsl_single": False,
    "nsl_dual": False,
}
"""Whether a zone is in a built-up area; None if its name does not say."""

NO_UNIT = "no unit"
"""The doubt about a number without mph where signs are in miles: it is read as km/h."""

_NUMBER = re.compile(r"(\d+(?:\.\d+)?)\s*(km/h|kmh|kph|mph)?")
_ZONE = re.compile(r"([A-Z]{2}(?:-[A-Z0-9]+)?):(.+)")
_ZONE_NUMBER = re.compile(r"(?:zone:?)?(\d+)")


class Zone(NamedTuple):
    """A zone such as ``US-CA:urban``."""

    place: str
    """ISO 3166-1 or -2 code."""
    name: str
    """``"urban"``, ``"rural"``, ``"motorway"``, ``"nsl_dual"``, ``"30"``, …"""

    @property
    def country(self) -> str:
        """ISO 3166-1 code."""
        return self.place[:2]

    @property
    def sign(self) -> str | None:
        """The limit that its name states, as netconvert reads it, None if it states none."""
        number = _ZONE_NUMBER.fullmatch(self.name)
        if number is None:
            return None
        return f"{number[1]} mph" if self.country in MPH_COUNTRIES else number[1]


@dataclass(frozen=True, slots=True)
class Stated:
    """The limits that a way's tags state, as netconvert reads them (``"50"``, ``"30 mph"``, ``"none"``); None where
    they state none."""

    forward: str | None
    """In the direction of the way's nodes."""
    backward: str | None

    def of(self, edge_id: str) -> str | None:
        """The one of an edge: netconvert marks the direction against the way's nodes by a minus."""
        return self.backward if edge_id.startswith("-") else self.forward


def stated_limits(tags: Mapping[str, str]) -> Stated:
    """The limits for a car that the tags of a way state."""
    zone = next(_signs_of_zones(tags), None)
    forward, backward = (_nearest(tags, direction) for direction in ("forward", "backward"))
    return Stated(forward or zone, backward or zone)


def zones_of(tags: Mapping[str, str]) -> Iterator[Zone]:
    """The zones that a way's tags name, the ones about traffic in general first."""
    for key in ("zone:traffic", *CAR_KEYS, *ZONE_KEYS):
        zone = _ZONE.fullmatch(tags.get(key, ""))
        if zone:
            yield Zone(zone[1], zone[2])


def built_up_of(tags: Mapping[str, str]) -> bool | None:
    """Whether a way's tags put it in a built-up area; None if they do not say."""
    named = (BUILT_UP_ZONES.get(zone.name) for zone in zones_of(tags))
    return next((built_up for built_up in named if built_up is not None), None)


def doubts(tags: Mapping[str, str], country: str) -> Iterator[str]:
    """What to check in a way's limits: ``NO_UNIT``, and values that are no limit (``"maxspeed=fast"``)."""
    for key in _limit_keys(("", ":forward", ":backward")):
        value = tags.get(key, "")
        if value and _sign(value) is None and not _ZONE.fullmatch(value):
            yield f"{key}={value}"
        numbers = [match for match in map(_NUMBER.fullmatch, _parts(value)) if match]
        if country in MPH_COUNTRIES and any(match[2] is None for match in numbers):
            yield NO_UNIT


def _limit_keys(endings: Iterable[str]) -> Iterator[str]:
    return (f"{key}{ending}" for ending in endings for key in CAR_KEYS)


def _nearest(tags: Mapping[str, str], direction: str) -> str | None:
    """The limit of a direction: its own, the one of both, or the highest of its lanes."""
    for key in _limit_keys((f":{direction}", "")):
        sign = _sign(tags.get(key, ""))
        if sign is not None:
            return sign
    lanes = tags.get(f"maxspeed:lanes:{direction}") or tags.get("maxspeed:lanes", "")
    signs = [sign for sign in map(_sign, lanes.split("|")) if sign is not None]
    return max(signs, key=kmh_of, default=None)


def _signs_of_zones(tags: Mapping[str, str]) -> Iterator[str]:
    for key in ("maxspeed", *ZONE_KEYS):
        value = tags.get(key, "")
        zone = _ZONE.fullmatch(value)
        sign = Zone(zone[1], zone[2]).sign if zone else _sign(value) if key == "zone:maxspeed" else None
        if sign is not None:
            yield sign


def _sign(value: str) -> str | None:
    """One value of ``maxspeed``; of several (``"70;90"``) the lowest."""
    if value in ("none", "unlimited"):
        return "none"
    if value == "walk":
        return f"{WALK_KMH:g}"
    numbers = [match for match in map(_NUMBER.fullmatch, _parts(value)) if match and float(match[1]) > 0]
    signs = [f"{match[1]} mph" if match[2] == "mph" else match[1] for match in numbers]
    return min(signs, key=kmh_of, default=None)


def _parts(value: str) -> Iterator[str]:
    return (part.strip() for part in value.split(";"))


def kmh_of(sign: str) -> float:
    """The limit in km/h; infinite for ``"none"``."""
    if sign == "none":
        return float("inf")
    number, _, unit = sign.partition(" ")
    return float(number) * (KMH_PER_MPH if unit == "mph" else 1.0)
