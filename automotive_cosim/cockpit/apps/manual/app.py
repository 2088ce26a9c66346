"""Manual: the owner's handbook."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.manual.functions import FUNCTIONS
from automotive_cosim.cockpit.apps.manual.screens import manual
from automotive_cosim.cockpit.apps.manual.state import ManualFilm
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say

APP = App(
    name="manual",
    title=say("Manual"),
    icon=Icon.MANUAL,
    order=13,
    where=Where.STORE,
    about=say("The owner's handbook, to search in"),
    functions=FUNCTIONS,
    pages={"manual": AppPage(manual)},
    picked={"manual": "0"},
    starts=lambda state, rng: (ManualFilm(),),
)
