"""The notifications: what requires attention now, and earlier notices."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.notifications.screens import notifications
from automotive_cosim.cockpit.size import Room
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say

APP = App(
    name="notifications",
    title=say("Notices"),
    icon=Icon.BELL,
    order=19,
    where=Where.STATUS,
    pages={"notifications": AppPage(notifications, Room.ONE)},
)
