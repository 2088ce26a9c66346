"""Map: the road around the car, the route ahead, and destinations."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated

import numpy as np
from annotated_types import Ge, Le

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.map.commands import Guide, Take
from automotive_cosim.cockpit.apps.map.screens import away, map_screen, matches
from automotive_cosim.cockpit.apps.map.state import AVOIDABLE, NO_GOAL, Navigation, Viewpoint
from automotive_cosim.cockpit.apps.map.way import explore, place, route
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.functions import CallMade, as_told, disabled, locked, named, offered, reading
from automotive_cosim.cockpit.pois import Gazetteer, atlas
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.room import Room
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say
from automotive_cosim.formats.annotations import OneOf

NOWHERE = Feedback(FeedbackCode.NO_SUCH_ELEMENT, say("No street or place with this name"))
PlaceName = Annotated[str, "Name of a place or street, as search_places or a screen tells it."]


@offered
def navigate_to(
    state: State,
    place: Annotated[str, "Name of a place or street; empty keeps the destination and looks for a faster route."],
    as_stop: Annotated[bool, "Whether to stop there on the way to the present destination."] = False,
) -> CallMade:
    """Start guidance to a place or street."""
    if not place.strip():
        return Guide("")
    found = _found(state, place)
    if isinstance(found, Feedback):
        return found
    goal = state.of(Navigation).destination
    if goal == found:
        return disabled(say("Already navigating there"))
    if as_stop and not goal:
        return disabled(NO_GOAL)
    return Guide(found, goal) if as_stop else Guide(found)


@offered
def take_route(
    state: State, number: Annotated[int, "Number of the route, as the screen route has it.", Ge(2), Le(9)]
) -> CallMade:
    """Take another route to the same destination."""
    ways = () if state.outside is None else state.outside.driving.ahead.alternatives
    if number - 2 >= len(ways):
        return disabled(f"there is no route {number}; {1 + len(ways)} are known")
    return Take(ways[number - 2].edges)


@offered
def avoid_on_route(
    state: State,
    what: Annotated[str, OneOf(AVOIDABLE), "What to avoid."],
    on: Annotated[bool, "Whether to avoid it from now on."],
) -> CallMade:
    """Have routes avoid something, or no longer."""
    return Put(state.of(Navigation).with_avoided(what, on), "")


@offered
def save_place(state: State, place: PlaceName, on: Annotated[bool, "Whether it is saved from now on."]) -> CallMade:
    """Save a place or street among the destinations, or remove it from them."""
    found = _found(state, place)
    return found if isinstance(found, Feedback) else Put(state.of(Navigation).with_favourite(found, on), "")


@reading
def search_places(
    state: State, text: Annotated[str, "Part of the name of a place or street, in any case."]
) -> Feedback:
    """Search places and streets by name. As on the screen, not while driving."""
    if refusal := locked(state, Restriction.NO_KEYBOARD):
        return refusal
    twin = state.copy()
    twin.typed = {"map.search": text}
    atlas = state.of(Gazetteer)
    return as_told(
        [
            {
                "name": str(name),
                "street": str(found.street if (found := atlas.find(name)) else name),
                "detail": str(found.detail if found else ""),
                "distance": away(state, name),
            }
            for name in matches(twin)
        ]
    )


def _found(state: State, name: str) -> str | Feedback:
    """The place or street of that name. Those that the screen lists can be chosen at any time; any other street has
    to be typed, which is locked while driving."""
    navigation, atlas = state.of(Navigation), state.of(Gazetteer)
    listed = (*navigation.favourites, *navigation.recents, *(place.name for place in atlas.places))
    found = named(name, (*listed, *state.roads.names))
    if found is None:
        return NOWHERE
    return found if found in listed else locked(state, Restriction.NO_KEYBOARD) or found


FUNCTIONS = (navigate_to, take_route, avoid_on_route, save_place, search_places)


def starts(state: State, rng: np.random.Generator) -> Iterable[AppData]:
    """Draws the places."""
    places = atlas(state.roads, rng, state.places_on)
    return places, Navigation(favourites=places.favourites), Viewpoint()


APP = App(
    name="map",
    title=say("Map"),
    icon=Icon.MAP,
    order=2,
    where=Where.DOCK,
    functions=FUNCTIONS,
    pages={
        "map": AppPage(map_screen, Room.WHOLE),
        "explore": AppPage(explore, Room.WHOLE),
        "place": AppPage(place, Room.WHOLE),
        "route": AppPage(route, Room.WHOLE),
    },
    aliases={"maps": "", "navigation": ""},
    picked={"map.list": "saved", "explore": "all", "route": "turns"},
    starts=starts,
    turn=2,
)
