"""Climate: both seats, fan and air, glass, and a schedule."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.climate.functions import FUNCTIONS
from automotive_cosim.cockpit.apps.climate.screens import climate, comfort
from automotive_cosim.cockpit.apps.climate.state import ClimateSchedule
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say

APP = App(
    name="climate",
    title=say("Climate"),
    icon=Icon.CLIMATE,
    order=3,
    where=Where.DOCK,
    functions=FUNCTIONS,
    pages={"climate": AppPage(climate), "comfort": AppPage(comfort)},
    aliases={"hvac": ""},
    starts=lambda state, rng: (ClimateSchedule(),),
)
