"""The store: apps that can be installed and removed."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.store.functions import FUNCTIONS
from automotive_cosim.cockpit.apps.store.screens import store
from automotive_cosim.cockpit.apps.store.state import Installed
from automotive_cosim.cockpit.registry import apps_in
from automotive_cosim.cockpit.size import Room
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say

APP = App(
    name="store",
    title=say("Store"),
    icon=Icon.STORE,
    order=18,
    functions=FUNCTIONS,
    pages={"store": AppPage(store, Room.ONE)},
    starts=lambda state, rng: (Installed(tuple(app.name for app in apps_in(Where.STORE) if app.preinstalled)),),
)
