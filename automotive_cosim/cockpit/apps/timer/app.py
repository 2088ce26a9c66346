"""Timer: tells the driver when some minutes are over, such as those of a parking disc or until a break."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.timer.functions import FUNCTIONS
from automotive_cosim.cockpit.apps.timer.screens import timer
from automotive_cosim.cockpit.apps.timer.state import Countdown
from automotive_cosim.cockpit.size import Room
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say

APP = App(
    name="timer",
    title=say("Timer"),
    icon=Icon.CLOCK,
    order=20,
    where=Where.STORE,
    about=say("Counts down minutes and alerts you"),
    preinstalled=False,
    functions=FUNCTIONS,
    pages={"timer": AppPage(timer, Room.ONE)},
    starts=lambda state, rng: (Countdown(),),
)
