"""In which directions cars may drive a road: the keys about one-way roads, and access by direction.

The words are those of the OSM wiki's pages "Key:oneway" and "Tag:junction=roundabout". The nearer key wins
(``oneway:motorcar`` before ``oneway:motor_vehicle`` before ``oneway:vehicle`` before ``oneway``), and an access key
of one direction (``motor_vehicle:backward=no``) closes it whatever ``oneway`` says.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from automotive_cosim.osm import access
from automotive_cosim.traffic.posted import clauses, is_understood

KEYS = ("oneway:motorcar", "oneway:motor_vehicle", "oneway:vehicle", "oneway")

ROUND = ("roundabout", "circular")
"""Values of ``junction`` that imply one direction."""


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
        if tags.get(f"{key}:conditional") and not any(at_hours(tags, end) for end in access.ENDS):
            yield f"{key}:conditional={tags[f'{key}:conditional']}"


def _signed(tags: Mapping[str, str]) -> Directions:
    for key in KEYS:
        value = tags.get(key, "").strip().lower()
        if value in VALUES:
            return VALUES[value]
    is_round = tags.get("junction") in ROUND
    return WITH if is_round or tags.get("highway", "").startswith("motorway") else BOTH
