"""Outside: rain, fog, ice, glare, dust and air as sensed by the car, and remedies for each."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.outside.screens import outside
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say

APP = App(
    name="outside",
    title=say("Outside"),
    icon=Icon.OUTSIDE,
    order=6,
    where=Where.DOCK,
    pages={"outside": AppPage(outside)},
    aliases={"weather": "", "phenomenon": ""},
    picked={"outside": "rain"},
)
