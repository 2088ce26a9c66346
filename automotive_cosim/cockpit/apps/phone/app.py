"""Phone: calls, contacts and messages."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.phone.figure import figure
from automotive_cosim.cockpit.apps.phone.functions import FUNCTIONS
from automotive_cosim.cockpit.apps.phone.person import contact, thread
from automotive_cosim.cockpit.apps.phone.screens import phone
from automotive_cosim.cockpit.apps.phone.state import Phone, directory
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say, say_in


def starts(state: State, rng: np.random.Generator) -> Iterable[AppData]:
    """Draws the phone book, past calls and messages."""
    book = directory(rng)
    return book, Phone(book.favourites)


APP = App(
    name="phone",
    title=say("Phone"),
    short=say_in("dock", "Phone"),
    icon=Icon.PHONE,
    order=8,
    where=Where.DOCK,
    functions=FUNCTIONS,
    pages={
        "phone": AppPage(phone),
        "contact": AppPage(contact),
        "thread": AppPage(thread),
        "figure": AppPage(figure),
    },
    aliases={"comms": "", "messages": "messages"},
    picked={"phone": "favourites"},
    starts=starts,
    turn=3,
)
