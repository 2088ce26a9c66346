"""The launcher: every app, to be opened."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.launcher.screens import launcher
from automotive_cosim.cockpit.size import Room
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say

APP = App(
    name="apps",
    title=say("Apps"),
    icon=Icon.APPS,
    order=9,
    where=Where.DOCK,
    pages={"apps": AppPage(launcher, Room.ONE)},
)
