"""The speed limits that OSM tags state, one for each direction of a road, and the zone that they put it in.

The words are those of the OSM wiki's pages "Key:maxspeed", "Key:maxspeed:type", "Key:source:maxspeed",
"Key:zone:maxspeed", "Key:zone:traffic" and "Lanes". Four laws hold for all of them:

* A sign wins: a zone never overrides a ``maxspeed``.
* The nearer key wins: of the car before of every vehicle, and then of one direction before of both.
* A number in a zone's name (``DE:zone30``, ``GB:20``) is the limit on the zone's signs.
* A zone without a number (``FR:urban``, ``US-CA:rural``) states no limit: the law of that place sets it.
* What nobody could have signed (500 km/h, ``none`` in a living street) states no limit either, and is told.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from automotive_cosim.osm.country import KMH_PER_MPH, country_codes
from automotive_cosim.traffic.posted_limits import WALK_KMH

LEAST_KMH, MOST_KMH, MOST_MPH = 3.0, 160.0, 85.0
"""The lowest and the highest limit that any country posts: walking pace; the United Arab Emirates; Texas."""

UNLIMITED_CLASSES = frozenset(("motorway", "motorway_link", "trunk", "trunk_link"))
"""Roads that can have no limit, as can one with ``motorroad=yes``; nothing else does outside the Isle of Man."""

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
    "urban_motorway": True,
    "urban_trunk": True,
    "school": None,
    "pedestrian": None,
    "pedestrian_zone": None,
    "walk": None,
    "bicycle_road": None,
    "bicycle_zone": None,
    "cyclestreet": None,
    "cycle_street": None,
    "rural": False,
    "trunk": False,
    "expressway": False,
    "motorroad": False,
    "motorway": False,
    "nsl_single": False,
    "nsl_dual": False,
}
"""Whether a zone is in a built-up area; None if its name does not say."""

WALKING_ZONES = frozenset(("walk", "pedestrian", "pedestrian_zone"))
"""Zones in which a car that may be there goes at walking pace."""

CYCLE_ZONES = frozenset(("bicycle_road", "bicycle_zone", "cyclestreet", "cycle_street"))
"""Zones under the law of cycle streets."""

PLACES = {"UK": "GB", "BE-BRU": "BE-brussels", "GB-UKM": "GB"}
"""Prefixes that mappers write, and the place that they mean."""

NO_UNIT = "limits without mph, read as km/h"
"""The doubt about a number without mph where signs are in miles."""

KMH_PER_KNOT = 1.852

_NUMBER = re.compile(r"(\d+(?:\.\d+)?)\s*(km/h|kmh|kph|kmph|mph|knots)?", re.IGNORECASE)
_ZONE = re.compile(r"([A-Za-z]{2}(?:-[A-Za-z0-9]+)?):\s*(\S.*)")
_ZONE_NUMBER = re.compile(r"(?:zone[:_]?)?(\d+)")


def zone_of(value: str) -> "Zone | None":
    """The zone that a value names; None if it names none, or one of a country that does not exist."""
    match = _ZONE.fullmatch(value.strip())
    if match is None:
        return None
    place = match[1].upper()
    place = PLACES.get(place, place)
    name = re.sub(r"[\s-]+", "_", match[2].strip().lower())
    return Zone(place, name) if place[:2] in country_codes() else None


class Zone(NamedTuple):
    """A zone such as ``US-CA:urban``."""

    place: str
    """ISO 3166-1 or -2 code, or the code of a city's rules."""
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
        sign = f"{number[1]} mph" if self.country in MPH_COUNTRIES else number[1]
        return sign if _is_possible(sign) else None


@dataclass(frozen=True, slots=True)
class Stated:
    """The limits that a way's tags state, as netconvert reads them (``"50"``, ``"30 mph"``, ``"none"``); None where
    they state none. Of lanes with signs of their own, the highest; None if some have none."""

    forward: str | None
    """In the direction of the way's nodes."""
    backward: str | None
    lanes_forward: tuple[str | None, ...] = ()
    """Those of each lane from the left, if any has a sign of its own; None where it has none."""
    lanes_backward: tuple[str | None, ...] = ()

    def of(self, edge_id: str) -> str | None:
        """The one of an edge: netconvert marks the direction against the way's nodes by a minus."""
        return self.backward if edge_id.startswith("-") else self.forward

    def lanes(self, edge_id: str) -> tuple[str | None, ...]:
        """Those of an edge's lanes."""
        return self.lanes_backward if edge_id.startswith("-") else self.lanes_forward


def stated_limits(tags: Mapping[str, str], country: str = "") -> Stated:
    """The limits for a car that the tags of a way state; the country decides where there may be none."""
    zone = next(_signs_of_zones(tags), None)
    may_be_none = may_be_unlimited(tags, country)
    ends = ("forward", "backward")
    whole = [_nearest(tags, direction, may_be_none=may_be_none) or zone for direction in ends]
    lanes = [_of_lanes(tags, direction, may_be_none=may_be_none) for direction in ends]
    for number, parts in enumerate(lanes):
        signs = [part or whole[number] for part in parts]
        if signs:
            known = [sign for sign in signs if sign is not None]
            whole[number] = max(known, key=kmh_of) if len(known) == len(signs) else None
            lanes[number] = tuple(signs)
    return Stated(whole[0], whole[1], lanes[0], lanes[1])


def may_be_unlimited(tags: Mapping[str, str], country: str = "") -> bool:
    """Whether ``none`` can be true of a road."""
    road_class = tags.get("highway", "motorway")
    in_town = built_up_of(tags) or any(zone.sign for zone in zones_of(tags))
    fast = road_class in UNLIMITED_CLASSES or tags.get("motorroad") == "yes"
    free = country == "IM" and road_class not in ("residential", "living_street")
    return (fast or free) and not in_town


def conditional_of(tags: Mapping[str, str], direction: str) -> str:
    """The limits under conditions for cars in one direction, in OpenStreetMap's words. Of several that hold, the
    last is in force: one for cars before one for all, one for the direction before one for both."""
    keys = (f"{key}{ending}:conditional" for key in reversed(CAR_KEYS) for ending in ("", f":{direction}"))
    return "; ".join(tags[key] for key in keys if tags.get(key))


def zones_of(tags: Mapping[str, str]) -> Iterator[Zone]:
    """The zones that a way's tags name, the ones about traffic in general first."""
    for key in ("zone:traffic", *CAR_KEYS, *ZONE_KEYS):
        for value in _parts(tags.get(key, "")):
            zone = zone_of(value)
            if zone:
                yield zone


def built_up_of(tags: Mapping[str, str]) -> bool | None:
    """Whether a way's tags put it in a built-up area; None if they do not say."""
    named = (BUILT_UP_ZONES.get(zone.name) for zone in zones_of(tags))
    return next((built_up for built_up in named if built_up is not None), None)


def doubts(tags: Mapping[str, str], country: str) -> Iterator[str]:
    """What to check in a way's limits: ``NO_UNIT``, values that are no limit (``"maxspeed=fast"``) or that nobody
    could have signed there, zones that do not exist, and a sign in a zone with another number."""
    may_be_none = may_be_unlimited(tags, country)
    for key in _limit_keys(("", ":forward", ":backward")):
        value = tags.get(key, "")
        sign = _sign(value)
        if value and not _ZONE.fullmatch(value.strip()) and (sign is None or (sign == "none" and not may_be_none)):
            yield f"{key}={value}"
        numbers = [match for match in map(_NUMBER.fullmatch, _parts(value)) if match]
        if country in MPH_COUNTRIES and any(match[2] is None for match in numbers):
            yield NO_UNIT
    for key in ("maxspeed:lanes", "maxspeed:lanes:forward", "maxspeed:lanes:backward"):
        parts = {_sign(part.strip()) for part in tags.get(key, "").split("|") if part.strip()}
        if None in parts or ("none" in parts and not may_be_none):
            yield f"{key}={tags[key]}"
    for key in ("zone:traffic", *CAR_KEYS, *ZONE_KEYS):
        for value in filter(_ZONE.fullmatch, _parts(tags.get(key, ""))):
            zone = zone_of(value)
            if zone is None or (zone.sign is None and zone.name not in BUILT_UP_ZONES):
                yield f"{key}={value}"
    signs = set(_signs_of_zones(tags))
    forward = _nearest(tags, "forward", may_be_none=may_be_none)
    if forward and signs and forward not in signs:
        yield f"maxspeed={forward} in a zone of {min(signs, key=kmh_of)}, the zone"


def _limit_keys(endings: Sequence[str]) -> Iterator[str]:
    return (f"{key}{ending}" for key in CAR_KEYS for ending in endings)


def _nearest(tags: Mapping[str, str], direction: str, *, may_be_none: bool) -> str | None:
    """The limit of a direction: its own, or the one of both."""
    for key in _limit_keys((f":{direction}", "")):
        sign = _sign(tags.get(key, ""))
        if sign is not None and (sign != "none" or may_be_none):
            return sign
    return None


def _of_lanes(tags: Mapping[str, str], direction: str, *, may_be_none: bool) -> tuple[str | None, ...]:
    """The signs of each lane of a direction from the left; empty if no lane has one of its own."""
    text = tags.get(f"maxspeed:lanes:{direction}") or tags.get("maxspeed:lanes", "")
    signs = [_sign(part.strip()) for part in text.split("|")]
    found = tuple(sign if sign != "none" or may_be_none else None for sign in signs)
    return found if any(found) else ()


def _signs_of_zones(tags: Mapping[str, str]) -> Iterator[str]:
    for key in ("maxspeed", *ZONE_KEYS):
        for value in _parts(tags.get(key, "")):
            zone = zone_of(value)
            sign = zone.sign if zone else _sign(value) if key == "zone:maxspeed" else None
            if sign is not None and sign != "none":
                yield sign


def _sign(value: str) -> str | None:
    """One value of ``maxspeed``; of several (``"70;90"``) the lowest."""
    if value in ("none", "unlimited"):
        return "none"
    if value == "walk":
        return f"{WALK_KMH:g}"
    numbers = [match for match in map(_NUMBER.fullmatch, _parts(value)) if match]
    signs = [_in_unit(match[1], (match[2] or "").lower()) for match in numbers]
    return min(filter(_is_possible, signs), key=kmh_of, default=None)


def _in_unit(number: str, unit: str) -> str:
    if unit == "knots":
        return f"{float(number) * KMH_PER_KNOT:g}"
    return f"{number} mph" if unit == "mph" else number


def _is_possible(sign: str) -> bool:
    """Whether any country posts such a number."""
    most_kmh = MOST_MPH * KMH_PER_MPH if sign.endswith("mph") else MOST_KMH
    return LEAST_KMH <= kmh_of(sign) <= most_kmh


def _parts(value: str) -> Iterator[str]:
    return (part.strip() for part in value.split(";"))


def kmh_of(sign: str) -> float:
    """The limit in km/h; infinite for ``"none"``."""
    if sign == "none":
        return float("inf")
    number, _, unit = sign.partition(" ")
    return float(number) * (KMH_PER_MPH if unit == "mph" else 1.0)
