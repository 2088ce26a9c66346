"""Who may drive a road: the access keys of the OSM wiki's pages "Key:access" and "Conditional restrictions".

Four laws hold for all of them:

* The nearer key wins: of the car before of motor vehicles before of vehicles before of everybody, and within one of
  them, of one direction before of both.
* A list lets a car in if any of its values does: ``no;destination`` lets it in, ``psv;delivery`` does not.
* A direction all of whose lanes are for buses is closed to cars.
* A value that is not known to let a car in keeps it out, and is told.
* A road for cars with passengers (``hov``) is closed to a driver alone, unless a key about cars opens it, and told.

Conditions on the clock, the calendar and the weather are kept for the drive (``at_hours``), others are told.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from automotive_cosim.traffic.posted_limits import clauses, is_understood

KEYS = ("motorcar", "motor_vehicle", "vehicle", "access")
"""Access keys that are about cars, the most specific first."""

ENDS = ("forward", "backward")
"""Directions, as they end a key: with the nodes of the way, and against them."""

OPEN = frozenset(
    ("yes", "permissive", "designated", "destination", "customers", "public", "unknown", "discouraged", "variable",
     "true", "1")
)  # fmt: skip
"""Values that let an ordinary car in, to its destination at least."""

CLOSED = frozenset(
    ("no", "private", "agricultural", "forestry", "agricultural/forestry", "military", "emergency", "psv", "bus",
     "taxi", "tourist_bus", "coach", "delivery", "loading", "official", "permit", "hgv", "goods", "bicycle", "foot",
     "horse", "moped", "motorcycle", "residents", "resident", "employees", "employee", "staff", "members",
     "students", "school", "service", "maintenance", "authorized", "authorised", "false", "0")
)  # fmt: skip
"""Values for others than an ordinary car."""

HOV_ONLY = frozenset(("designated", "only", "2", "2+", "3", "3+"))
"""Values of ``hov`` of what a driver alone may not use (OSM wiki, "Key:hov"; numbers are its older form)."""

GONE = ("abandoned", "demolished", "destroyed", "disused", "planned", "proposed", "razed", "removed")
"""Keys about what is no road any more, or not yet (OSM wiki, "Lifecycle prefix")."""

TOLD = frozenset(
    (*(f"{key}=yes" for key in GONE), "4wd_only=yes", "4wd_only=recommended", "construction=yes",
     "construction=minor", "construction=widening", "hov=lane", "ice_road=yes", "impassable=yes",
     "low_emission_zone=yes",
     "seasonal=yes", "seasonal=winter", "seasonal=summer", "seasonal=spring", "seasonal=autumn",
     "seasonal=wet_season", "seasonal=dry_season", "toll=yes", "toll:motor_vehicle=yes", "toll:motorcar=yes",
     "winter_road=yes")
)  # fmt: skip
"""Tags of roads that are open to cars at a price, or not to every car, or not always, which are told."""

TOO_SMALL = {"maxheight": 1.9, "maxwidth": 2.0, "maxlength": 5.0, "maxweight": 2.5}
"""Limits of size, metres and tonnes, below which not every car passes (OSM wiki, "Key:maxwidth", ...)."""

DOUBTED = frozenset(("unknown", "discouraged", "variable"))
"""Values that let a car in and are told all the same."""

OF_THE_VEHICLE = re.compile(
    r"weight|length|width|height|axle|load|wheels|draught|trailer|caravan|hazmat|emission|fuel|stay|occupants"
    r"|hgv|goods|bus|psv|taxi|permit|residents?|delivery|disabled|agricultural|forestry|emergency|electric"
)
"""Conditions on a vehicle or its driver that an ordinary car does not meet."""


class Access(NamedTuple):
    """Whether cars may drive in one direction."""

    is_open: bool
    tag: str = ""
    """The tag that says so, ``"motor_vehicle=no"``; empty where none does."""
    is_doubtful: bool = False
    """Whether to tell about that tag: its value is unknown, or contradicts itself."""


def access(tags: Mapping[str, str], direction: str = "") -> Access:
    """Whether cars may pass: along a way in a direction of ``ENDS``, or a node, which has none."""
    if tags.get("highway") == "construction":
        date = f", opening_date={tags['opening_date']}" if "opening_date" in tags else ""
        return Access(False, f"highway=construction{date}", is_doubtful=True)
    hov = _hov(tags, direction)
    for key in KEYS:
        for name in (f"{key}:{direction}", key) if direction else (key,):
            if tags.get(name):
                found = _read(name, tags[name])
                return Access(True, f"{hov}, {found.tag}", is_doubtful=True) if hov and found.is_open else found
    if hov:
        return Access(False, hov, is_doubtful=True)
    for key in KEYS:
        for name in (f"{key}:lanes:{direction}", f"{key}:lanes") if direction else ():
            lanes = tags.get(name, "").split("|")
            if any(lanes):
                is_open = any(not lane or _read(name, lane).is_open for lane in lanes)
                return Access(is_open, f"{name}={tags[name]}")
    for name in (f"psv:lanes:{direction}", f"bus:lanes:{direction}"):
        if set(tags.get(name, "").split("|")) == {"designated"}:
            return Access(is_open=False, tag=f"{name}={tags[name]}")
    return Access(is_open=True)


def _hov(tags: Mapping[str, str], direction: str) -> str:
    """The tag that gives a road to cars with passengers, ``"hov=designated"``; empty without one."""
    for name in (f"hov:{direction}", "hov", f"hov:lanes:{direction}", "hov:lanes"):
        value = tags.get(name, "")
        if value and all(lane.strip() in HOV_ONLY for lane in value.split("|")):
            return f"{name}={value}"
    return ""


def at_hours(tags: Mapping[str, str], direction: str) -> str:
    """When cars may pass along a way in a direction of ``ENDS`` other than always or never, for ``timed_access``:
    ``"no @ (Mo-Fr 07:30-08:30)"``, ``"no @ (24/7); yes @ (18:00-06:00)"``; empty if no hour changes the answer."""
    if not has_conditions(tags) or tags.get("highway") == "construction":
        return ""
    usual = access(tags, direction).is_open
    found: list[tuple[bool, str]] = []
    for key in reversed(KEYS):
        for name in (key, f"{key}:{direction}"):
            if tags.get(name):
                found.clear()
            for value, condition, _ in clauses(tags.get(f"{name}:conditional", "")):
                if not OF_THE_VEHICLE.search(condition) and is_understood(condition):
                    found.append((lets_in(value), condition))
    for name in ("hov", f"hov:{direction}"):
        for value, condition, _ in clauses(tags.get(f"{name}:conditional", "")):
            if (value in HOV_ONLY or value in ("yes", "no")) and is_understood(condition):
                found.append((value not in HOV_ONLY, condition))
    if all(is_open is usual for is_open, _ in found):
        return ""
    return timed([*([] if usual else [(False, ALWAYS)]), *found])


def has_conditions(tags: Mapping[str, str]) -> bool:
    """Whether any tag holds under a condition."""
    return any(key.endswith(":conditional") for key in tags)


ALWAYS = "24/7"


def timed(found: Iterable[tuple[bool, str]]) -> str:
    """What ``timed_access`` reads, of whether cars may pass and under which condition."""
    return "; ".join(f"{'yes' if is_open else 'no'} @ ({condition})" for is_open, condition in found)


def lets_in(value: str) -> bool:
    """Whether one value, or a list of values, lets an ordinary car in."""
    return _read("", value).is_open


def doubts(tags: Mapping[str, str]) -> Iterator[str]:
    """The tags whose value is doubtful, and those under conditions that are not understood."""
    for direction in ENDS:
        found = access(tags, direction)
        if found.is_doubtful:
            yield found.tag
    yield from _conditional(tags)
    yield from small(tags)
    for key, value in tags.items():
        if key.startswith("hov") and not key.endswith((":conditional", ":minimum")):
            words = {word.strip() for word in value.split("|")}
            if not words <= HOV_ONLY | {"yes", "no", "lane", "", "none"} or (":lanes" in key and "lane" in words):
                yield f"{key}={value}"
        is_timed = key.startswith("hov") and key.endswith(":conditional")
        is_unread = is_timed and not all(is_understood(when) for _, when, _ in clauses(value))
        if f"{key}={value}" in TOLD or is_unread or (is_timed and ":lanes" in key):
            yield f"{key}={value}"


def small(tags: Mapping[str, str]) -> Iterator[str]:
    """The tags by which a road, or a barrier, is too low, narrow, short or weak for some cars."""
    for key, least in TOO_SMALL.items():
        number = re.fullmatch(r"(\d+(?:\.\d+)?) ?[mt]?", tags.get(key, ""))
        if number and float(number[1]) < least:
            yield f"{key}={tags[key]}"


def _conditional(tags: Mapping[str, str]) -> Iterator[str]:
    """Conditions not understood that change the answer for a car. A nearer key without condition leaves them
    without effect."""
    usual = any(access(tags, direction).is_open for direction in ENDS)
    for key in KEYS:
        for ending in ("", *(f":{direction}" for direction in ENDS)):
            name = f"{key}{ending}:conditional"
            for value, condition, _ in clauses(tags.get(name, "")):
                concerns = lets_in(value) is not usual and not OF_THE_VEHICLE.search(condition)
                if concerns and not is_understood(condition):
                    yield f"{name}={tags[name]}"
                    break
        if key in tags:
            return


def _read(name: str, value: str) -> Access:
    parts = [part.strip() for part in re.split("[;,]", value)]
    words = [part.lower() for part in parts]
    is_open = any(word in OPEN for word in words)
    known = all(word in OPEN | CLOSED for word in words) and words == parts
    contradicts = "yes" in words and "no" in words
    return Access(is_open, f"{name}={value}", not known or contradicts or bool(DOUBTED & set(words)))
