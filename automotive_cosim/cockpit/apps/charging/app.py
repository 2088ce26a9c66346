"""Charging: the battery, its charge limit and schedule, and stations nearby."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.charging.functions import FUNCTIONS
from automotive_cosim.cockpit.apps.charging.screens import charging
from automotive_cosim.cockpit.apps.charging.state import ChargingSchedule
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say

APP = App(
    name="charging",
    title=say("Charging"),
    icon=Icon.CHARGING,
    order=11,
    where=Where.STORE,
    about=say("Charge limit, times and stations nearby"),
    functions=FUNCTIONS,
    pages={"charging": AppPage(charging)},
    starts=lambda state, rng: (ChargingSchedule(),),
)
