"""Navigation: the driver's choices, and the turns of the route."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from typing import Any

from automotive_cosim.cockpit.map import RoadMap
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Road

RECENTS = 12
AVOIDABLE: Mapping[str, tuple[str, Icon]] = {
    "motorways": ("Motorways", Icon.MOTORWAY),
    "tolls": ("Toll roads", Icon.TOLL),
    "tunnels": ("Tunnels", Icon.TUNNEL),
    "ferries": ("Ferries", Icon.FERRY),
}
"""What a route can avoid."""


@dataclass(frozen=True, slots=True)
class Navigation:
    """The driver's choices. Destinations are names of places and streets."""

    destination: str = ""
    onward: str = ""
    """The destination after a stop."""
    favourites: tuple[str, ...] = ()
    recents: tuple[str, ...] = ()
    avoid: tuple[str, ...] = ()

    def to(self, name: str) -> Navigation:
        """With a new destination; the last ones are remembered, newest first."""
        recents = (name, *(known for known in self.recents if known != name))
        return replace(
            self, destination=name, onward="" if self.onward == name else self.onward, recents=recents[:RECENTS]
        )

    def with_favourite(self, name: str, wanted: bool) -> Navigation:
        """With or without that favourite, at the end of the list."""
        rest = tuple(known for known in self.favourites if known != name)
        return replace(self, favourites=(*rest, name) if wanted else rest)

    def with_avoided(self, name: str, wanted: bool) -> Navigation:
        """With or without avoiding something."""
        return replace(self, avoid=tuple(k for k in AVOIDABLE if (wanted if k == name else k in self.avoid)))

    def commands(self) -> dict[str, Any]:
        """The driver's choices as app data; recent destinations follow from them."""
        return {
            "navigation.destination": self.destination,
            "navigation.onward": self.onward,
            "navigation.favourites": list(self.favourites),
            "navigation.avoid": list(self.avoid),
        }


@dataclass(frozen=True, slots=True)
class Turn:
    """A turn from one street to another."""

    words: str
    icon: Icon
    street: str
    """The street that it leads to."""
    after_m: float
    """Distance from the start of the route's first edge."""


@lru_cache(maxsize=16)
def turns(roads: RoadMap, route: tuple[str, ...]) -> tuple[Turn, ...]:
    """The turns of a route: where its street changes its name or direction clearly, and the end of it."""
    found: list[Turn] = []
    known = [road for road in map(roads.find, route) if road is not None]
    driven_m = 0.0
    for road, following in pairwise(known):
        driven_m += road.length_m
        angle = _angle_deg(road, following)
        if following.name == road.name and abs(angle) < 50:
            continue
        words, icon = _manoeuvre(angle, roads.network.left_hand)
        found.append(Turn(words, icon, following.name or "Unnamed road", driven_m))
    if known:
        found.append(Turn("Arrive", Icon.GOAL, known[-1].name or "Unnamed road", driven_m + known[-1].length_m))
    return tuple(found)


def _angle_deg(road: Road, following: Road) -> float:
    """The angle between them, clockwise, -180 to 180."""
    (ax, ay), (bx, by) = road.shape_m[-2:]
    (cx, cy), (dx, dy) = following.shape_m[:2]
    before, after = math.atan2(by - ay, bx - ax), math.atan2(dy - cy, dx - cx)
    return (math.degrees(before - after) + 180) % 360 - 180


def _manoeuvre(angle_deg: float, left_hand: bool) -> tuple[str, Icon]:
    side = "right" if angle_deg > 0 else "left"
    turn = abs(angle_deg)
    if turn < 20:
        return "Go straight on", Icon.STRAIGHT
    if turn < 50:
        return f"Keep {side}", Icon.SLIGHT_RIGHT if side == "right" else Icon.SLIGHT_LEFT
    if turn < 150:
        return f"Turn {side}", Icon.TURN_RIGHT if side == "right" else Icon.TURN_LEFT
    return "Make a U-turn", Icon.TURN_BACK_RIGHT if left_hand else Icon.TURN_BACK
