"""Phone: favourites, recent calls, contacts, messages and the keypad."""

from __future__ import annotations

from automotive_cosim.cockpit.apps.phone.commands import Dial
from automotive_cosim.cockpit.apps.phone.handset import handset, handset_and_page
from automotive_cosim.cockpit.apps.phone.state import Directory, PastCall, Phone
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, row
from automotive_cosim.cockpit.messages import BACKSPACE, Key, Pick, Show
from automotive_cosim.cockpit.parts import choices, heading, note, rows, search
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, Label, Look, Row, Widget
from automotive_cosim.contracts.text import say

WAYS = {"in": Icon.CALL_IN, "out": Icon.CALL_OUT, "missed": Icon.CALL_MISSED}
TABS = (
    ("favourites", say("Favourites"), Icon.STAR),
    ("recents", say("Recents"), Icon.HISTORY),
    ("contacts", say("Contacts"), Icon.CONTACTS),
    ("messages", say("Messages"), Icon.MESSAGE),
    ("keypad", say("Keypad"), Icon.DIALPAD),
)
KEYS = "123456789*0#"
OPENS = say("Call or message")
"""What may be done with somebody whom a tap opens."""
ABOUT = 36
"""Height of the line above a list of people."""


def phone(state: State) -> tuple[Widget, ...]:
    """The phone screen."""
    shown = state.picked["phone"]
    pages = {
        "favourites": _favourites,
        "recents": _recents,
        "contacts": _contacts,
        "messages": _messages,
        "keypad": _keypad,
    }
    _, page = handset_and_page(state)
    return (
        handset(state),
        choices(
            page.top(64),
            "phone.tab",
            [(name, text, icon, shown == name, Pick("phone", name)) for name, text, icon in TABS],
        ),
        *pages[shown](page.below(64 + GAP), state),
    )


def _about(rect: Rect) -> Label:
    """What a tap on somebody does, above the list that fills the rest."""
    return heading(rect.top(28), say("Select a contact to call or message"), "phone.about")


def _favourites(rect: Rect, state: State) -> tuple[Widget, ...]:
    names = state.of(Phone).favourites
    if not names:
        return (note(rect, "phone.favourites.empty", say("No favourites yet: add them from a contact")),)
    return (
        _about(rect),
        rows(
            rect.below(ABOUT),
            "phone.favourites",
            say("Favourites"),
            state,
            len(names),
            lambda index, cell: Button(
                rect=cell,
                key=f"phone.favourite.{index}",
                text=names[index],
                description=OPENS,
                icon=Icon.ACCOUNT,
                icon_size=44,
                stacked=True,
                on_tap=Show("contact", names[index]),
            ),
            columns=3,
            height=128,
            gap=12,
        ),
    )


def _recents(rect: Rect, state: State) -> tuple[Widget, ...]:
    calls = (*state.of(Phone).made, *state.of(Directory).calls)

    def line(index: int, cell: Rect) -> Row:
        call: PastCall = calls[index]
        return Row(
            rect=cell,
            key=f"phone.recent.{index}",
            text=call.who,
            description=OPENS,
            detail={"in": say("Incoming"), "out": say("Outgoing"), "missed": say("Missed")}[call.way],
            trail=call.when,
            icon=WAYS[call.way],
            tone="warning" if call.way == "missed" else "accent",
            on_tap=Show("contact", call.who),
        )

    return (
        _about(rect),
        rows(rect.below(ABOUT), "phone.recents", say("Recent calls"), state, len(calls), line, height=64),
    )


def _contacts(rect: Rect, state: State) -> tuple[Widget, ...]:
    wanted = state.typed.get("phone.search", "").casefold().strip()
    found = tuple(contact for contact in state.of(Directory).contacts if wanted in contact.name.casefold())
    people = rect.below(72)
    return (
        search(
            rect.top(60),
            "phone.search",
            say("Search contacts"),
            say("Search contacts"),
            state,
            Show("contact", found[0].name) if found else None,
        ),
        *(
            (
                _about(people),
                rows(
                    people.below(ABOUT),
                    "phone.contacts",
                    say("Contacts"),
                    state,
                    len(found),
                    lambda index, cell: Row(
                        rect=cell,
                        key=f"phone.contact.{index}",
                        text=found[index].name,
                        description=OPENS,
                        trail=found[index].number,
                        icon=Icon.STAR if found[index].name in state.of(Phone).favourites else Icon.ACCOUNT,
                        on_tap=Show("contact", found[index].name),
                    ),
                    height=56,
                ),
            )
            if found
            else (note(people, "phone.contacts.empty", say("No contact with this name")),)
        ),
    )


def _messages(rect: Rect, state: State) -> tuple[Widget, ...]:
    threads = state.of(Directory).written(state.of(Phone))

    def line(index: int, cell: Rect) -> Row:
        thread = threads[index]
        new = thread.unread and thread.who not in state.of(Phone).read
        return Row(
            rect=cell,
            key=f"phone.thread.{index}",
            text=thread.who,
            detail=say("New message") if new else say("Read"),
            trail=thread.when,
            icon=Icon.MESSAGE,
            tone="good" if new else "muted",
            on_tap=Show("thread", thread.who),
        )

    return (rows(rect, "phone.threads", say("Messages"), state, len(threads), line, height=64),)


def _keypad(rect: Rect, state: State) -> tuple[Widget, ...]:
    number = state.typed.get("phone.number", "")
    locked = state.locked(Restriction.NO_DIALPAD)
    pad, _, side = row(rect, 420, 24, REST)
    shown, _, erase, _, call = column(side, 96, 16, 72, 16, 88)
    cells = [cell for line in pad.rows(4, 12) for cell in line.columns(3, 12)]
    empty = "" if number else say("Enter a number first")
    return (
        *(
            Button(
                rect=cell,
                key=f"phone.key.{'star' if digit == '*' else 'hash' if digit == '#' else digit}",
                text=digit,
                style=Type.HEADLINE,
                on_tap=Key("phone.number", digit),
                locked=locked,
            )
            for cell, digit in zip(cells, KEYS, strict=True)
        ),
        Card(
            rect=shown,
            children=(
                Label(
                    rect=shown.inset(20),
                    key="phone.number",
                    text=number or (say("Locked while driving") if locked else say("Number")),
                    description=say("Number to call"),
                    style=Type.TITLE,
                    tone="text" if number else "muted",
                    align="centre",
                    keeps_end=True,
                ),
            ),
        ),
        Button(
            rect=erase,
            key="phone.erase",
            text=say("Delete the last character"),
            icon=Icon.ERASE,
            on_tap=Key("phone.number", BACKSPACE),
            disabled=empty,
        ),
        Button(
            rect=call,
            key="phone.call_number",
            text=say("Call"),
            icon=Icon.PHONE,
            style=Type.TITLE,
            look=Look.ACCENT,
            on_tap=Dial(number),
            disabled=empty,
        ),
    )
