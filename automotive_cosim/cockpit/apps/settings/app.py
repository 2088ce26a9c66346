"""Settings: display and units, sound, connections, language and time, privacy, profiles."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.settings.functions import FUNCTIONS
from automotive_cosim.cockpit.apps.settings.screens import (
    connections,
    language,
    privacy,
    profile_list,
    settings,
    sound,
)
from automotive_cosim.cockpit.apps.settings.state import Connections, profiles
from automotive_cosim.cockpit.apps.vehicle.state import CarMemory
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say, say_in

APP = App(
    name="settings",
    title=say("Settings"),
    short=say_in("dock", "Settings"),
    icon=Icon.SETTINGS,
    order=10,
    where=Where.DOCK,
    functions=FUNCTIONS,
    pages={
        "settings": AppPage(settings),
        "sound": AppPage(sound),
        "connections": AppPage(connections),
        "language": AppPage(language),
        "privacy": AppPage(privacy),
        "profiles": AppPage(profile_list),
    },
    aliases={"system": ""},
    starts=lambda state, rng: (Connections(), profiles(state.of(CarMemory))),
    turn=6,
)
