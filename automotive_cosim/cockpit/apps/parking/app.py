"""Parking: pays for a space from the car."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.parking.functions import FUNCTIONS
from automotive_cosim.cockpit.apps.parking.screens import parking
from automotive_cosim.cockpit.apps.parking.state import Parking
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say

APP = App(
    name="parking",
    title=say("Parking"),
    icon=Icon.TICKET,
    order=12,
    where=Where.STORE,
    about=say("Pay for a parking space from the car"),
    functions=FUNCTIONS,
    pages={"parking": AppPage(parking)},
    starts=lambda state, rng: (Parking(),),
)
