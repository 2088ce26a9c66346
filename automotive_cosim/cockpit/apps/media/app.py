"""Media: what plays, the controls, and tracks, playlists, stations, podcasts."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.media.functions import FUNCTIONS
from automotive_cosim.cockpit.apps.media.screens import media, playlist
from automotive_cosim.cockpit.apps.media.state import Listening, library
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say


def starts(state: State, rng: np.random.Generator) -> Iterable[AppData]:
    """Draws what there is to hear."""
    there = library(rng)
    return there, Listening(there.playlists, there.favourites)


APP = App(
    name="media",
    title=say("Media"),
    icon=Icon.MEDIA,
    order=7,
    where=Where.DOCK,
    functions=FUNCTIONS,
    pages={"media": AppPage(media), "playlist": AppPage(playlist)},
    aliases={"music": "", "radio": ""},
    picked={"media.list": "all"},
    starts=starts,
    turn=1,
)
