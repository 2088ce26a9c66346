"""Map: the road around the car, the route ahead, and destinations."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.map.functions import FUNCTIONS
from automotive_cosim.cockpit.apps.map.screens import map_screen
from automotive_cosim.cockpit.apps.map.state import Navigation, Viewpoint
from automotive_cosim.cockpit.apps.map.way import explore, place, route
from automotive_cosim.cockpit.pois import atlas
from automotive_cosim.cockpit.room import Room
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say


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
