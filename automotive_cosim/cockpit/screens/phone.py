"""Phone: favourites, recent calls, contacts, messages and the keypad."""

from __future__ import annotations

from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, row
from automotive_cosim.cockpit.messages import BACKSPACE, Dial, Key, Pick, Show
from automotive_cosim.cockpit.people import PastCall
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.screens.handset import handset, handset_and_page
from automotive_cosim.cockpit.screens.parts import choices, note, rows, search
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, Label, Look, Row, Widget

WAYS = {"in": Icon.CALL_IN, "out": Icon.CALL_OUT, "missed": Icon.CALL_MISSED}
TABS = (
    ("favourites", "Favourites", Icon.STAR),
    ("recents", "Recents", Icon.HISTORY),
    ("contacts", "Contacts", Icon.CONTACTS),
    ("messages", "Messages", Icon.MESSAGE),
    ("keypad", "Keypad", Icon.DIALPAD),
)
KEYS = "123456789*0#"


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


def _favourites(rect: Rect, state: State) -> tuple[Widget, ...]:
    names = state.phone.favourites
    if not names:
        return (note(rect, "phone.favourites.empty", "No favourites yet: add them from a contact"),)
    return (
        rows(
            rect,
            "phone.favourites",
            "Favourites",
            state,
            len(names),
            lambda index, cell: Button(
                rect=cell,
                key=f"phone.favourite.{index}",
                text=names[index],
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
    calls = (*state.phone.made, *state.directory.calls)

    def line(index: int, cell: Rect) -> Row:
        call: PastCall = calls[index]
        return Row(
            rect=cell,
            key=f"phone.recent.{index}",
            text=call.who,
            detail={"in": "Received", "out": "Made", "missed": "Missed"}[call.way],
            trail=call.when,
            icon=WAYS[call.way],
            tone="warning" if call.way == "missed" else "accent",
            on_tap=Show("contact", call.who),
        )

    return (rows(rect, "phone.recents", "Recent calls", state, len(calls), line, height=64),)


def _contacts(rect: Rect, state: State) -> tuple[Widget, ...]:
    wanted = state.typed.get("phone.search", "").casefold().strip()
    found = tuple(contact for contact in state.directory.contacts if wanted in contact.name.casefold())
    bar = rect.top(60)
    return (
        search(
            bar,
            "phone.search",
            "Search contacts",
            "Search contacts",
            state,
            Show("contact", found[0].name) if found else None,
        ),
        rows(
            rect.below(72),
            "phone.contacts",
            "Contacts",
            state,
            len(found),
            lambda index, cell: Row(
                rect=cell,
                key=f"phone.contact.{index}",
                text=found[index].name,
                trail=found[index].number,
                icon=Icon.STAR if found[index].name in state.phone.favourites else Icon.ACCOUNT,
                on_tap=Show("contact", found[index].name),
            ),
            height=56,
        )
        if found
        else note(rect.below(72), "phone.contacts.empty", "No contact with this name"),
    )


def _messages(rect: Rect, state: State) -> tuple[Widget, ...]:
    threads = state.directory.written(state.phone)

    def line(index: int, cell: Rect) -> Row:
        thread = threads[index]
        new = thread.unread and thread.who not in state.phone.read
        return Row(
            rect=cell,
            key=f"phone.thread.{index}",
            text=thread.who,
            detail="New message" if new else "Read",
            trail=thread.when,
            icon=Icon.MESSAGE,
            tone="good" if new else "muted",
            on_tap=Show("thread", thread.who),
        )

    return (rows(rect, "phone.threads", "Messages", state, len(threads), line, height=64),)


def _keypad(rect: Rect, state: State) -> tuple[Widget, ...]:
    number = state.typed.get("phone.number", "")
    locked = state.locked(Restriction.NO_DIALPAD)
    pad, _, side = row(rect, 420, 24, REST)
    shown, _, erase, _, call = column(side, 96, 16, 72, 16, 88)
    cells = [cell for line in pad.rows(4, 12) for cell in line.columns(3, 12)]
    empty = "" if number else "Enter a number first"
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
                    text=number[-14:] or ("Locked while driving" if locked else "Number"),
                    description="Number to call",
                    style=Type.TITLE,
                    tone="text" if number else "muted",
                    align="centre",
                ),
            ),
        ),
        Button(
            rect=erase,
            key="phone.erase",
            text="Delete the last character",
            icon=Icon.ERASE,
            on_tap=Key("phone.number", BACKSPACE),
            disabled=empty,
        ),
        Button(
            rect=call,
            key="phone.call_number",
            text="Call",
            icon=Icon.PHONE,
            style=Type.TITLE,
            look=Look.ACCENT,
            on_tap=Dial(number),
            disabled=empty,
        ),
    )
