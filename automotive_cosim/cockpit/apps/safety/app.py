"""Safety centre: warn the driver, ask to slow down or stop, call for help."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.safety.screens import emergency, safety
from automotive_cosim.cockpit.apps.safety.state import AlertDraft, Alerts
from automotive_cosim.cockpit.room import Room
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say, say_in

APP = App(
    name="safety",
    title=say("Safety"),
    short=say_in("dock", "Safety"),
    icon=Icon.SAFETY,
    order=4,
    where=Where.DOCK,
    pages={"safety": AppPage(safety), "emergency": AppPage(emergency, Room.ONE)},
    aliases={"safety centre": ""},
    starts=lambda state, rng: (AlertDraft(), Alerts()),
)
