"""In which directions cars may drive a road: the keys about one-way roads, and access by direction.

The words are those of the OSM wiki's pages "Key:oneway" and "Tag:junction=roundabout". The nearer key wins
(``oneway:motorcar`` before ``oneway:motor_vehicle`` before ``oneway:vehicle`` before ``oneway``), and an access key
of one direction (``motor_vehicle:backward=no``) closes it whatever ``oneway`` says.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from automotive_cosim.osm import access

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
    may = _signed(tags)
    return Directions(
        *(
            is_open and (access.access(tags, end).is_open or bool(access.at_hours(tags, end)))
            for is_open, end in zip(may, access.ENDS, strict=True)
        )
    )


def doubts(tags: Mapping[str, str]) -> Iterator[str]:
    """Tags that are not understood, or only true at times."""
    for key in KEYS:
        value = tags.get(key, "")
        if value and (value.strip() not in VALUES or value in DOUBTED):
            yield f"{key}={value}"
        if tags.get(f"{key}:conditional"):
            yield f"{key}:conditional={tags[f'{key}:conditional']}"


def _signed(tags: Mapping[str, str]) -> Directions:
    for key in KEYS:
        value = tags.get(key, "").strip().lower()
        if value in VALUES:
            return VALUES[value]
    is_round = tags.get("junction") in ROUND
    return WITH if is_round or tags.get("highway", "").startswith("motorway") else BOTH
