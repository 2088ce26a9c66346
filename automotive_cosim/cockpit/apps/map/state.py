"""What the driver chose on the map, and the turns of the route."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from typing import Any

from automotive_cosim.cockpit.map import RoadMap
from automotive_cosim.cockpit.pois import Gazetteer
from automotive_cosim.cockpit.road import ICONS
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Answer, Reroute, Road, RoadRequest
from automotive_cosim.contracts.text import Text, say

RECENTS = 12
AVOIDABLE: Mapping[str, tuple[str, Icon]] = {
    "motorways": (say("Motorways"), Icon.MOTORWAY),
    "tolls": (say("Toll roads"), Icon.TOLL),
    "tunnels": (say("Tunnels"), Icon.TUNNEL),
    "ferries": (say("Ferries"), Icon.FERRY),
}
"""What a route can avoid."""
STRAIGHT_ON, U_TURN, ARRIVE = say("Go straight on"), say("Make a U-turn"), say("Arrive")
KEEP_LEFT, KEEP_RIGHT = say("Keep left"), say("Keep right")
TURN_LEFT, TURN_RIGHT = say("Turn left"), say("Turn right")
_AHEAD: Mapping[Text, Callable[[str], Text]] = {
    STRAIGHT_ON: lambda far: say("Go straight on in {distance}", distance=far),
    KEEP_LEFT: lambda far: say("Keep left in {distance}", distance=far),
    KEEP_RIGHT: lambda far: say("Keep right in {distance}", distance=far),
    TURN_LEFT: lambda far: say("Turn left in {distance}", distance=far),
    TURN_RIGHT: lambda far: say("Turn right in {distance}", distance=far),
    U_TURN: lambda far: say("Make a U-turn in {distance}", distance=far),
    ARRIVE: lambda far: say("Arrive in {distance}", distance=far),
}
"""How a manoeuvre is announced, by the distance to it."""


NO_GOAL = say("This route ends at no named destination: start guidance to one first")
"""Why no stop can be added."""


@dataclass(frozen=True, slots=True)
class Navigation(AppData):
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
        """A copy that avoids something, or no longer does."""
        return replace(self, avoid=tuple(k for k in AVOIDABLE if (wanted if k == name else k in self.avoid)))

    def commands(self) -> dict[str, Any]:
        """The driver's choices as app data; recent destinations follow from them."""
        return {
            "navigation.destination": self.destination,
            "navigation.onward": self.onward,
            "navigation.favourites": list(self.favourites),
            "navigation.avoid": list(self.avoid),
        }

    def names(self, state: State) -> Mapping[str, tuple[str, ...]]:
        """Favourites, and streets that are neither among them nor hidden behind another in a search."""
        places = (place.name for place in state.of(Gazetteer).places)
        found = "\n".join(("", *places, *state.roads.names, "")).casefold()
        streets = tuple(
            name
            for name in state.roads.names
            if name not in self.favourites
            and found.find(name.casefold()) == found.find(f"\n{name.casefold()}\n") + 1
        )
        return {"favourite_places": self.favourites, "streets": streets}

    def answered(self, state: State, request: RoadRequest, answer: Answer) -> None:
        """The new destination, and where the new route leads to, if to a place."""
        if not isinstance(request, Reroute) or not answer.accepted:
            return
        atlas = state.of(Gazetteer)
        if request.destination:
            state.keep(self.to(atlas.named(request.destination)))
        if not answer.reason:
            return
        place, onward = atlas.at(request.destination), state.of(Navigation).onward
        told: str = answer.reason
        if place is not None:
            goal = say("{place}, then {onward}", place=place.name, onward=onward) if onward else place.name
            told = say("{name}: {value}", name=goal, value=told)
        state.notify(told, ICONS[Reroute])


@dataclass(frozen=True, slots=True)
class Viewpoint(AppData):
    """How the driver looks at the map."""

    zoom: int = 1
    north_up: bool = False
    panned: tuple[float, float] | None = None
    """The map's point in metres of the network, if not the car."""

    def entered(self, state: State) -> None:
        """The map follows the car again."""
        if self.panned is not None:
            state.keep(replace(self, panned=None))


@dataclass(frozen=True, slots=True)
class Turn:
    """A turn from one street to another."""

    words: Text
    icon: Icon
    street: str
    """The street that it leads to."""
    after_m: float
    """Distance from the start of the route's first edge."""

    def ahead(self, distance: str) -> Text:
        """As it is announced at that distance."""
        return _AHEAD[self.words](distance)


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
        found.append(Turn(words, icon, following.name or say("Unnamed road"), driven_m))
    if known:
        found.append(Turn(ARRIVE, Icon.GOAL, known[-1].name or say("Unnamed road"), driven_m + known[-1].length_m))
    return tuple(found)


def _angle_deg(road: Road, following: Road) -> float:
    """The angle between them, clockwise, -180 to 180."""
    (ax, ay), (bx, by) = road.shape_m[-2:]
    (cx, cy), (dx, dy) = following.shape_m[:2]
    before, after = math.atan2(by - ay, bx - ax), math.atan2(dy - cy, dx - cx)
    return (math.degrees(before - after) + 180) % 360 - 180


def _manoeuvre(angle_deg: float, left_hand: bool) -> tuple[Text, Icon]:
    turn = abs(angle_deg)
    if turn < 20:
        return STRAIGHT_ON, Icon.STRAIGHT
    if turn < 50:
        return (KEEP_RIGHT, Icon.SLIGHT_RIGHT) if angle_deg > 0 else (KEEP_LEFT, Icon.SLIGHT_LEFT)
    if turn < 150:
        return (TURN_RIGHT, Icon.TURN_RIGHT) if angle_deg > 0 else (TURN_LEFT, Icon.TURN_LEFT)
    return U_TURN, Icon.TURN_BACK_RIGHT if left_hand else Icon.TURN_BACK
