"""Calendar: the day's appointments."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.calendar.functions import FUNCTIONS
from automotive_cosim.cockpit.apps.calendar.screens import appointment, calendar
from automotive_cosim.cockpit.apps.calendar.state import agenda
from automotive_cosim.cockpit.places import Gazetteer
from automotive_cosim.cockpit.size import Room
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say

APP = App(
    name="calendar",
    title=say("Calendar"),
    icon=Icon.CALENDAR,
    order=16,
    where=Where.STORE,
    about=say("Today's appointments and how to get there"),
    functions=FUNCTIONS,
    pages={"calendar": AppPage(calendar, Room.ONE), "appointment": AppPage(appointment, Room.ONE)},
    preinstalled=False,
    starts=lambda state, rng: (agenda(rng, state.of(Gazetteer)),),
    turn=5,
)
