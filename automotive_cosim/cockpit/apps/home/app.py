"""Home: the map, the drive, and every app at a glance."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.home.screens import home
from automotive_cosim.cockpit.size import Room
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say, say_in

APP = App(
    name="home",
    title=say("Home"),
    short=say_in("dock", "Home"),
    icon=Icon.HOME,
    order=1,
    where=Where.DOCK,
    pages={"home": AppPage(home, Room.WHOLE)},
)
