"""Phone: calls, contacts and messages."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.messages import (
    BACKSPACE,
    Back,
    DeclineCall,
    Dial,
    HangUp,
    Key,
    Pick,
    Put,
    Read,
    SendReply,
    Show,
    TakeCall,
)
from automotive_cosim.cockpit.people import TEMPLATES, PastCall
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.screens.media import minutes
from automotive_cosim.cockpit.screens.parts import CONTENT, choices, heading, note, rows, search
from automotive_cosim.cockpit.signals import LINK
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, Choice, Glyph, Label, Look, Row, Tile, Widget

LEFT, RIGHT = CONTENT.left(320), CONTENT.right_part(CONTENT.width - 320 - GAP)
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
    return (
        _side(state),
        choices(
            RIGHT.top(64),
            "phone.tab",
            [(name, text, icon, shown == name, Pick("phone", name)) for name, text, icon in TABS],
        ),
        *pages[shown](RIGHT.below(64 + GAP), state),
    )


def _side(state: State) -> Widget:
    """The present call, or the phone's state, and permanent buttons."""
    inner = LEFT.inset(20)
    calls = state.phone
    return Card(
        rect=LEFT,
        children=(
            *_line(inner, state),
            Tile(
                rect=Rect(inner.x, inner.bottom - 148, inner.width, 68),
                key="phone.do_not_disturb",
                text="Do not disturb",
                icon=Icon.BELL_OFF,
                checked=calls.do_not_disturb,
                on_tap=Put(
                    "phone",
                    replace(calls, do_not_disturb=not calls.do_not_disturb),
                    "Calls and messages are announced"
                    if calls.do_not_disturb
                    else "Calls and messages stay silent",
                ),
            ),
            Button(
                rect=inner.bottom_part(68),
                key="phone.emergency_call",
                text="Emergency call",
                icon=Icon.PHONE_ALERT,
                look=Look.CRITICAL,
                on_tap=Show("emergency"),
            ),
        ),
    )


def _line(inner: Rect, state: State) -> tuple[Widget, ...]:
    if state.phone.ringing is not None:
        return _ringing(inner, state.phone.ringing.who)
    return _on_call(inner, state) if state.phone.on_call else _linked(inner, state)


def _linked(inner: Rect, state: State) -> tuple[Widget, ...]:
    on = state.signals[LINK.BLUETOOTH]
    count = len(state.directory.unread(state.phone))
    return (
        Glyph(rect=Rect(inner.x, inner.y + 8, inner.width, 88), icon=Icon.PHONE, size=72, tone="accent"),
        Label(
            rect=Rect(inner.x, inner.y + 112, inner.width, 36),
            key="phone.device",
            text=state.desk.device if on else "No phone paired",
            style=Type.STRONG,
            align="centre",
        ),
        Label(
            rect=Rect(inner.x, inner.y + 150, inner.width, 30),
            key="phone.state",
            text=(f"{count} unread message{'s' if count != 1 else ''}" if count else "No new messages")
            if on
            else "Bluetooth is off",
            style=Type.LABEL,
            tone="muted",
            align="centre",
        ),
        Button(
            rect=Rect(inner.x, inner.y + 204, inner.width, 60),
            key="phone.devices",
            text="Devices",
            icon=Icon.BLUETOOTH,
            on_tap=Show("connections"),
        ),
    )


def _on_call(inner: Rect, state: State) -> tuple[Widget, ...]:
    call = state.phone.on_call
    assert call is not None
    mute, end = Rect(inner.x, inner.y + 204, inner.width, 88).columns(2, 12)
    return (
        Glyph(rect=Rect(inner.x, inner.y + 8, inner.width, 88), icon=Icon.IN_CALL, size=72, tone="good"),
        Label(
            rect=Rect(inner.x, inner.y + 112, inner.width, 36),
            key="call.who",
            text=call.who,
            description="On the phone with",
            style=Type.STRONG,
            align="centre",
        ),
        Label(
            rect=Rect(inner.x, inner.y + 150, inner.width, 30),
            key="call.time",
            text=minutes(state.time_s - call.since_s),
            style=Type.LABEL,
            tone="muted",
            align="centre",
        ),
        Tile(
            rect=mute,
            key="call.mute",
            text="Mute",
            icon=Icon.MICROPHONE_OFF,
            checked=call.muted,
            on_tap=Put(
                "phone",
                replace(state.phone, on_call=replace(call, muted=not call.muted)),
                "The microphone is on" if call.muted else "The microphone is off",
            ),
        ),
        Button(
            rect=end,
            key="call.end",
            text="End",
            icon=Icon.HANG_UP,
            icon_size=32,
            look=Look.CRITICAL,
            stacked=True,
            on_tap=HangUp(),
        ),
    )


def _ringing(inner: Rect, who: str) -> tuple[Widget, ...]:
    answer, decline = Rect(inner.x, inner.y + 204, inner.width, 88).columns(2, 12)
    return (
        Glyph(rect=Rect(inner.x, inner.y + 8, inner.width, 88), icon=Icon.CALL_IN, size=72, tone="good"),
        Label(
            rect=Rect(inner.x, inner.y + 112, inner.width, 36),
            key="phone.ringing",
            text=who,
            description="Is calling",
            style=Type.STRONG,
            align="centre",
        ),
        Label(
            rect=Rect(inner.x, inner.y + 150, inner.width, 30),
            text="Incoming call",
            style=Type.LABEL,
            tone="muted",
            align="centre",
        ),
        Button(
            rect=answer,
            key="phone.answer",
            text="Answer",
            icon=Icon.PHONE,
            icon_size=32,
            look=Look.ACCENT,
            stacked=True,
            on_tap=TakeCall(),
        ),
        Button(
            rect=decline,
            key="phone.decline",
            text="Decline",
            icon=Icon.HANG_UP,
            icon_size=32,
            look=Look.CRITICAL,
            stacked=True,
            on_tap=DeclineCall(),
        ),
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
            lambda index, cell: Choice(
                rect=cell,
                key=f"phone.favourite.{index}",
                text=names[index],
                icon=Icon.ACCOUNT,
                look="boxed",
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
    pad = rect.left(420)
    cells = [cell for line in pad.rows(4, 12) for cell in line.columns(3, 12)]
    side = rect.right_part(rect.width - 420 - 24)
    erase, call = Rect(side.x, side.y + 112, side.width, 72), Rect(side.x, side.y + 200, side.width, 88)
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
            rect=side.top(96),
            children=(
                Label(
                    rect=side.top(96).inset(20),
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


def contact(state: State) -> tuple[Widget, ...]:
    """One person."""
    who = state.picked.get("contact") or state.directory.contacts[0].name
    number = state.directory.number(who)
    favourite = who in state.phone.favourites
    card = RIGHT.top(264)
    buttons = RIGHT.below(264 + GAP).top(108).columns(3, GAP)
    return (
        _side(state),
        Button(rect=RIGHT.left(64).top(64), key="contact.back", description="Back", icon=Icon.BACK, on_tap=Back()),
        Glyph(rect=Rect(card.x, card.y + 24, card.width, 120), icon=Icon.ACCOUNT, size=112, tone="accent"),
        Label(
            rect=Rect(card.x, card.y + 152, card.width, 48),
            key="contact.name",
            text=who,
            style=Type.HEADLINE,
            align="centre",
        ),
        Label(
            rect=Rect(card.x, card.y + 206, card.width, 36),
            key="contact.number",
            text="" if number == who else number,
            description="Number",
            tone="muted",
            align="centre",
        ),
        Button(
            rect=buttons[0],
            key="contact.call",
            text="Call",
            icon=Icon.PHONE,
            icon_size=36,
            look=Look.ACCENT,
            stacked=True,
            on_tap=Dial(who),
        ),
        Button(
            rect=buttons[1],
            key="contact.message",
            text="Message",
            icon=Icon.MESSAGE,
            icon_size=36,
            stacked=True,
            on_tap=Show("thread", who),
        ),
        Button(
            rect=buttons[2],
            key="contact.favourite",
            text="Remove favourite" if favourite else "Add favourite",
            icon=Icon.STAR if favourite else Icon.STAR_OUTLINE,
            icon_size=36,
            stacked=True,
            on_tap=Put(
                "phone",
                state.phone.with_favourite(who, not favourite),
                f"{who} is no longer a favourite" if favourite else f"{who} is now a favourite",
            ),
        ),
    )


def thread(state: State) -> tuple[Widget, ...]:
    """Somebody's messages, and replies that one tap sends. While driving, messages are read out instead."""
    who = state.picked.get("thread") or state.directory.threads[0].who
    known = state.directory.thread(who, state.phone)
    hidden = state.locked(Restriction.NO_TEXT_MESSAGE)
    opened = who in state.phone.read or not (known and known.unread)
    sent = [(sent.text, "You") for sent in state.phone.sent if sent.to == who]
    said = [(text, who) for text in known.lines] if known else []
    lines = [*(said if opened and not hidden else []), *sent]
    left, right = RIGHT.left(500), RIGHT.right_part(RIGHT.width - 500 - GAP)
    bar = left.top(64)
    read = Rect(left.x, left.bottom - 64, left.width, 64)
    return (
        _side(state),
        Button(rect=bar.left(64), key="thread.back", description="Back", icon=Icon.BACK, on_tap=Back()),
        Label(rect=Rect(bar.x + 80, bar.y, bar.width - 80, 64), key="thread.who", text=who, style=Type.TITLE),
        *(
            (
                rows(
                    Rect(left.x, left.y + 76, left.width, left.height - 152),
                    "thread.lines",
                    "Messages",
                    state,
                    len(lines),
                    lambda index, cell: Row(
                        rect=cell,
                        key=f"thread.line.{index}",
                        text=lines[index][1],
                        detail=lines[index][0],
                        icon=Icon.REPLY if lines[index][1] == "You" else Icon.MESSAGE,
                    ),
                    height=88,
                ),
            )
            if lines
            else (
                note(
                    left.below(76),
                    "thread.hidden",
                    hidden if hidden and said else "Not opened yet" if said else "No messages yet",
                ),
            )
        ),
        Button(
            rect=read,
            key="thread.read",
            text="Read out" if hidden else "Open",
            icon=Icon.VOICE if hidden else Icon.EYE,
            on_tap=Read(who),
            disabled="" if said and not opened else "There is nothing new to read",
        ),
        heading(right.top(28), "Answer"),
        rows(
            right.below(36),
            "thread.answers",
            "Answers",
            state,
            len(TEMPLATES),
            lambda index, cell: Row(
                rect=cell,
                key=f"thread.answer.{index}",
                text=TEMPLATES[index],
                icon=Icon.REPLY,
                on_tap=SendReply(who, TEMPLATES[index]),
            ),
            height=56,
        ),
    )
