"""In which directions cars may drive a road: the keys about one-way roads, and access by direction.

The words are those of the OSM wiki's page "Key:oneway", and those of ``IMPLIED``. The nearer key wins
(``oneway:motorcar`` before ``oneway:motor_vehicle`` before ``oneway:vehicle`` before ``oneway``), and an access key
of one direction (``motor_vehicle:backward=no``) closes it whatever ``oneway`` says.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from automotive_cosim.osm import access
from automotive_cosim.traffic.posted_limits import clauses, is_understood

KEYS = ("oneway:motorcar", "oneway:motor_vehicle", "oneway:vehicle", "oneway")


class Implied(NamedTuple):
    """Whether a tag implies one direction, where no key about it is there."""

    one_way: bool
    source: str
    """The OSM wiki's page that says so."""
    told: bool = False
    """Whether such a road without ``oneway`` is told: most of them have one direction, and a mapper forgot it."""


IMPLIED: Mapping[tuple[str, str], Implied] = {
    ("highway", "motorway"): Implied(True, "Tag:highway=motorway: implies oneway=yes"),
    ("junction", "roundabout"): Implied(True, "Tag:junction=roundabout: implies oneway=yes"),
    ("junction", "circular"): Implied(True, "Tag:junction=circular: implies oneway=yes"),
    ("highway", "motorway_link"): Implied(False, "Tag:highway=motorway_link: implies nothing", told=True),
    ("highway", "trunk_link"): Implied(False, "Tag:highway=trunk_link: implies nothing"),
    ("highway", "primary_link"): Implied(False, "Tag:highway=primary_link: implies nothing"),
    ("highway", "secondary_link"): Implied(False, "Tag:highway=secondary_link: implies nothing"),
    ("highway", "tertiary_link"): Implied(False, "Tag:highway=tertiary_link: implies nothing"),
    ("highway", "trunk"): Implied(False, "Tag:highway=trunk: implies nothing"),
    ("junction", "jughandle"): Implied(False, "Tag:junction=jughandle: oneway is to be added", told=True),
    ("junction", "filter"): Implied(False, "Key:junction: a value without implications"),
    ("junction", "intersection"): Implied(False, "Key:junction: a value without implications"),
    ("motorroad", "yes"): Implied(False, "Key:motorroad: implies access, not direction"),
    ("dual_carriageway", "yes"): Implied(False, "Key:dual_carriageway: is added to oneway=yes", told=True),
}
"""What the tags of a road say about its direction. No link implies one."""

IMPLYING = ("highway", "junction")
NOTHING = Implied(False, "")

ROUND = ("roundabout", "circular")
"""Values of ``junction`` for roads around an island."""


class Directions(NamedTuple):
    """Whether cars may drive with the nodes of a way, and against them."""

    forward: bool
    backward: bool

    @property
    def is_two_way(self) -> bool:
        """Whether both are open."""
        return self.forward and self.backward

    def open(self, end: str) -> bool:
        """The one of ``access.ENDS``."""
        return self.backward if end == "backward" else self.forward


WITH, AGAINST, BOTH = Directions(True, False), Directions(False, True), Directions(True, True)

VALUES = {
    "yes": WITH,
    "true": WITH,
    "1": WITH,
    "-1": AGAINST,
    "reverse": AGAINST,
    "no": BOTH,
    "false": BOTH,
    "0": BOTH,
    "alternating": BOTH,
    "reversible": WITH,
}
DOUBTED = frozenset(("alternating", "reversible"))
"""Values that no network of fixed directions can have, which are told."""


def directions(tags: Mapping[str, str]) -> Directions:
    """The directions open to cars, at some hours at least; neither where they may not drive at all."""
    return Directions(*(_is_open(tags, end) or bool(at_hours(tags, end)) for end in access.ENDS))


def at_hours(tags: Mapping[str, str], end: str) -> str:
    """When cars may drive in a direction of ``access.ENDS`` other than always or never, for ``timed_access``; empty
    if no hour changes the answer. Where both access and direction depend on hours, only access does here; and a
    one-way road of several lanes keeps them all, since a network cannot turn lanes round."""
    if not access.has_conditions(tags):
        return ""
    found = access.at_hours(tags, end) if _signed(tags).open(end) else ""
    if found or not access.access(tags, end).is_open or any(access.at_hours(tags, each) for each in access.ENDS):
        return found
    said = [(VALUES[value].open(end), condition) for value, condition in _conditional(tags) if value in VALUES]
    usual = _signed(tags).open(end)
    if all(is_open is usual for is_open, _ in said) or not (usual or tags.get("lanes", "1") == "1"):
        return ""
    return access.timed([*([] if usual else [(False, access.ALWAYS)]), *said])


def _is_open(tags: Mapping[str, str], end: str) -> bool:
    return _signed(tags).open(end) and access.access(tags, end).is_open


def _conditional(tags: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """The values of the nearest key under conditions that can be read, with these."""
    key = next((key for key in KEYS if tags.get(key) or tags.get(f"{key}:conditional")), "")
    for value, condition, _ in clauses(tags.get(f"{key}:conditional", "")):
        if not access.OF_THE_VEHICLE.search(condition) and is_understood(condition):
            yield value, condition


def doubts(tags: Mapping[str, str]) -> Iterator[str]:
    """Tags that are not understood, or hold under conditions that are not."""
    for key in KEYS:
        value = tags.get(key, "")
        if value and (value.strip() not in VALUES or value in DOUBTED):
            yield f"{key}={value}"
        timed = tags.get(f"{key}:conditional") and any(at_hours(tags, end) for end in access.ENDS)
        if tags.get(f"{key}:conditional") and (not timed or any(access.at_hours(tags, end) for end in access.ENDS)):
            yield f"{key}:conditional={tags[f'{key}:conditional']}"
    if _signed(tags) is BOTH:
        # OSMnx writes oneway=no on all roads whose direction the map leaves to what they are.
        is_said = any(tags.get(key) for key in KEYS)
        yield from (
            f"{key}={value} {'with oneway=no' if is_said else 'without oneway'}, both directions"
            for (key, value), row in IMPLIED.items()
            if (row.one_way if is_said else row.told) and tags.get(key) == value
        )


def _signed(tags: Mapping[str, str]) -> Directions:
    for key in KEYS:
        value = tags.get(key, "").strip().lower()
        if value in VALUES:
            return VALUES[value]
    return WITH if any(IMPLIED.get((key, tags.get(key, "")), NOTHING).one_way for key in IMPLYING) else BOTH
