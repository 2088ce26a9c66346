"""Cabin: who is aboard, how warm it will be for those who stay, and what is switched for them."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage
from automotive_cosim.cockpit.apps.cabin.screens import cabin
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say

APP = App(
    name="cabin",
    title=say("Cabin"),
    icon=Icon.CONTACTS,
    order=17,
    pages={"cabin": AppPage(cabin)},
)
