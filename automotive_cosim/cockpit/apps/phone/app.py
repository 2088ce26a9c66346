"""Phone: calls, contacts and messages."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Annotated

import numpy as np

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.phone.commands import (
    DECLINE_CALL,
    HANG_UP,
    NOBODY_CALLS,
    TAKE_CALL,
    Dial,
    Read,
    SendReply,
)
from automotive_cosim.cockpit.apps.phone.figure import SENTENCES, figure
from automotive_cosim.cockpit.apps.phone.person import contact, thread
from automotive_cosim.cockpit.apps.phone.screens import phone
from automotive_cosim.cockpit.apps.phone.state import TEMPLATES, Directory, Phone, directory, in_own_words
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.functions import CLOCK, CallMade, disabled, locked, minute_of, named, offered
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.signals import HMI, LINK
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say, say_in
from automotive_cosim.formats.annotations import OneOf

ContactName = Annotated[str, "Name of a contact, as the screens of the phone tell it."]
NOBODY = Feedback(FeedbackCode.NO_SUCH_ELEMENT, say("No contact with this name"))


@offered
def call(state: State, who: Annotated[str, "Name of a contact; only while parked also a number."]) -> CallMade:
    """Call somebody."""
    if who and not set(who) - set("0123456789*# "):
        return locked(state, Restriction.NO_DIALPAD) or Dial(who)
    found = _found(state, who)
    return found if isinstance(found, Feedback) else Dial(found)


@offered
def handle_call(
    state: State,
    act: Annotated[
        str,
        OneOf(("answer", "decline", "hang_up", "mute", "unmute")),
        "Answer or decline the ringing call; end, mute or unmute the present one.",
    ],
) -> CallMade:
    """Do something with the call that rings or goes on."""
    phone = state.of(Phone)
    match act:
        case "answer":
            return TAKE_CALL if phone.ringing else NOBODY_CALLS
        case "decline":
            return DECLINE_CALL if phone.ringing else NOBODY_CALLS
        case "hang_up":
            return HANG_UP
        case _:
            if phone.on_call is None:
                return Feedback(FeedbackCode.NO_EFFECT, say("there is no call"))
            return Put(replace(phone, on_call=replace(phone.on_call, muted=act == "mute")), "")


@offered
def send_message(state: State, to: ContactName, text: Annotated[str, OneOf(TEMPLATES), "The message."]) -> CallMade:
    """Send somebody a message. It cannot be taken back."""
    found = _found(state, to)
    return found if isinstance(found, Feedback) else SendReply(found, TEMPLATES[TEMPLATES.index(text)])


@offered
def write_message(
    state: State, to: ContactName, text: Annotated[str, "The message, at most 120 characters are sent."]
) -> CallMade:
    """Send somebody a message in own words, where no text of send_message fits; while driving it is dictated. It
    cannot be taken back."""
    found, words = _found(state, to), in_own_words(text, state.signals[HMI.LANGUAGE])
    if isinstance(found, Feedback):
        return found
    if not words:
        return disabled(say("Write or dictate the message first"))
    if state.locked(Restriction.NO_KEYBOARD) and not state.signals[LINK.VOICE_ASSISTANT]:
        return disabled(say("The microphone is off"))
    return SendReply(found, words, own=True)


@offered
def send_figure(
    state: State,
    to: ContactName,
    sentence: Annotated[
        str, OneOf(SENTENCES), "; ".join(f"{key}: {each.text('...')}" for key, each in SENTENCES.items())
    ],
    figure: Annotated[str, f"The figure in the sentence. {CLOCK} for arrive, a number for the others."],
) -> CallMade:
    """Send somebody a message with a figure. It cannot be taken back."""
    found = _found(state, to)
    if isinstance(found, Feedback):
        return found
    said = SENTENCES[sentence]
    value: float | Feedback
    try:
        value = minute_of(figure) if ":" in figure or sentence == "arrive" else float(figure)
    except ValueError:
        value = Feedback(FeedbackCode.REFUSED, say("“{figure}” is not a number", figure=figure))
    if isinstance(value, Feedback):
        return value
    if not 0 <= value <= said.most:
        return Feedback(
            FeedbackCode.REFUSED,
            say("{figure} is out of range; it goes from 0 to {most}", figure=figure, most=f"{said.most:g}"),
        )
    return SendReply(found, said.said(value))


@offered
def read_messages(state: State, who: ContactName) -> CallMade:
    """Have somebody's new messages read out; everybody in the car hears them. Parked, they are opened."""
    found = _found(state, who)
    if isinstance(found, Feedback):
        return found
    phone = state.of(Phone)
    known = state.of(Directory).thread(found, phone)
    if known is None or found in phone.read or not known.unread:
        return disabled(say("There is nothing new to read"))
    return Read(found)


@offered
def favourite_contact(
    state: State, who: ContactName, on: Annotated[bool, "Whether it is a favourite from now on."]
) -> CallMade:
    """Make a contact a favourite, or no longer."""
    found = _found(state, who)
    return found if isinstance(found, Feedback) else Put(state.of(Phone).with_favourite(found, on), "")


@offered
def do_not_disturb(state: State, on: Annotated[bool, "Whether calls and messages stay silent."]) -> CallMade:
    """Keep calls and messages silent, or announce them."""
    return Put(replace(state.of(Phone), do_not_disturb=on), "")


def _found(state: State, name: str) -> str | Feedback:
    """The contact of that name. Those that the screen lists can be chosen at any time; to find another one, one
    has to type, which is locked while driving."""
    book, phone = state.of(Directory), state.of(Phone)
    names = [contact.name for contact in book.contacts]
    listed = (
        *phone.favourites,
        *(each.who for each in (*phone.made, *book.calls)),
        *(thread.who for thread in book.written(phone)),
        *names[: state.entries_limit],
        *((phone.ringing.who,) if phone.ringing else ()),
    )
    found = named(name, (*listed, *names))
    if found is None:
        return NOBODY
    return found if found in listed else locked(state, Restriction.LIMIT_CONTENT) or found


FUNCTIONS = (
    call,
    handle_call,
    send_message,
    write_message,
    send_figure,
    read_messages,
    favourite_contact,
    do_not_disturb,
)


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
