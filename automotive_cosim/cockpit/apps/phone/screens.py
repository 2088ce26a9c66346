"""Phone: favourites, recent calls, contacts, messages and the keypad."""

from __future__ import annotations

from automotive_cosim.cockpit.apps.phone.commands import Dial
from automotive_cosim.cockpit.apps.phone.handset import beside_handset
from automotive_cosim.cockpit.apps.phone.state import Contact, Directory, PastCall, Phone, Thread
from automotive_cosim.cockpit.cards import choices, heading, note, rows, search
from automotive_cosim.cockpit.flow import Block, BlockPart, framed, grid, line, stack
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.messages import BACKSPACE, Key, Pick, Show
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Button, Label, Look, Row, Widget
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


def phone(state: State) -> tuple[Widget, ...]:
    """The phone screen."""
    shown = state.picked["phone"]
    parts = {
        "favourites": _favourites,
        "recents": _recents,
        "contacts": _contacts,
        "messages": _messages,
        "keypad": _keypad,
    }
    tabs = choices(
        "phone.tab", ((name, text, icon, shown == name, Pick("phone", name)) for name, text, icon in TABS)
    )
    return beside_handset(state, stack((64, tabs), GAP, (REST, parts[shown](state))))


def _people(people: BlockPart) -> Block:
    """A list of people, under what a tap on one does."""
    return stack(heading(say("Select a contact to call or message"), "phone.about"), 8, people)


def _favourites(state: State) -> BlockPart:
    names = state.of(Phone).favourites

    def entry(index: int, name: str) -> Button:
        return Button(
            key=f"phone.favourite.{index}",
            text=name,
            description=OPENS,
            icon=Icon.ACCOUNT,
            icon_size=44,
            stacked=True,
            on_tap=Show("contact", name),
        )

    if not names:
        return note("phone.favourites.empty", say("No favourites yet: add them from a contact"))
    return _people(rows("phone.favourites", say("Favourites"), state, names, entry, columns=3, height=128, gap=12))


def _recents(state: State) -> BlockPart:
    calls = (*state.of(Phone).made, *state.of(Directory).calls)

    def entry(index: int, call: PastCall) -> Row:
        return Row(
            key=f"phone.recent.{index}",
            text=call.who,
            description=OPENS,
            detail={"in": say("Incoming"), "out": say("Outgoing"), "missed": say("Missed")}[call.way],
            trail=call.when,
            icon=WAYS[call.way],
            tone="warning" if call.way == "missed" else "accent",
            on_tap=Show("contact", call.who),
        )

    return _people(rows("phone.recents", say("Recent calls"), state, calls, entry))


def _contacts(state: State) -> BlockPart:
    wanted = state.typed.get("phone.search", "").casefold().strip()
    found = tuple(contact for contact in state.of(Directory).contacts if wanted in contact.name.casefold())

    def entry(index: int, contact: Contact) -> Row:
        return Row(
            key=f"phone.contact.{index}",
            text=contact.name,
            description=OPENS,
            trail=contact.number,
            icon=Icon.STAR if contact.name in state.of(Phone).favourites else Icon.ACCOUNT,
            on_tap=Show("contact", contact.name),
        )

    first = Show("contact", found[0].name) if found else None
    field = search("phone.search", say("Search contacts"), say("Search contacts"), state, first)
    people = _people(rows("phone.contacts", say("Contacts"), state, found, entry, height=56))
    return stack(
        (60, field), 12, (REST, people if found else note("phone.contacts.empty", say("No contact with this name")))
    )


def _messages(state: State) -> BlockPart:
    phone = state.of(Phone)

    def entry(index: int, thread: Thread) -> Row:
        new = thread.unread and thread.who not in phone.read
        return Row(
            key=f"phone.thread.{index}",
            text=thread.who,
            detail=say("New message") if new else say("Read"),
            trail=thread.when,
            icon=Icon.MESSAGE,
            tone="good" if new else "muted",
            on_tap=Show("thread", thread.who),
        )

    return rows("phone.threads", say("Messages"), state, state.of(Directory).written(phone), entry)


def _keypad(state: State) -> BlockPart:
    number = state.typed.get("phone.number", "")
    locked = state.locked(Restriction.NO_DIALPAD)
    empty = "" if number else say("Enter a number first")
    keys = (
        Button(
            key=f"phone.key.{'star' if digit == '*' else 'hash' if digit == '#' else digit}",
            text=digit,
            style=Type.HEADLINE,
            on_tap=Key("phone.number", digit),
            locked=locked,
        )
        for digit in KEYS
    )
    shown = Label(
        key="phone.number",
        text=number or (say("Locked while driving") if locked else say("Number")),
        description=say("Number to call"),
        style=Type.TITLE,
        tone="text" if number else "muted",
        align="centre",
        keeps_end=True,
    )
    erase = Button(
        key="phone.erase",
        text=say("Delete the last character"),
        icon=Icon.ERASE,
        on_tap=Key("phone.number", BACKSPACE),
        disabled=empty,
    )
    call = Button(
        key="phone.call_number",
        text=say("Call"),
        icon=Icon.PHONE,
        style=Type.TITLE,
        look=Look.ACCENT,
        on_tap=Dial(number),
        disabled=empty,
    )
    side = stack((96, framed(shown, (20, 20))), 16, (72, erase), 16, (88, call), REST)
    return line((420, grid(3, 12, *keys)), 24, side)
