"""The card at the side of the phone's screens: the present call, or the phone that is linked."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.phone.commands import DeclineCall, HangUp, TakeCall
from automotive_cosim.cockpit.apps.phone.state import Directory, OnCall, Phone
from automotive_cosim.cockpit.apps.settings.state import Connections
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, panes
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.parts import content, minutes
from automotive_cosim.cockpit.signals import LINK
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, Glyph, Label, Look, Tile, Widget
from automotive_cosim.contracts.text import counted, say, say_in


def handset_and_page(state: State) -> tuple[Rect, Rect]:
    """Boxes of the card and of what is beside it."""
    card, page = panes(content(state), 320, REST)
    return card, page


def handset(state: State) -> Widget:
    """The present call, or the phone's state, and permanent buttons."""
    rect, _ = handset_and_page(state)
    if rect.width > rect.height:
        call, acts = column(rect.inset(20), REST, 68)
        quiet, emergency = acts.columns(2, 12)
    else:
        call, quiet, _, emergency = column(rect.inset(20), REST, 68, 12, 68)
    calls = state.of(Phone)
    return Card(
        rect=rect,
        children=(
            *_call(call, state),
            Tile(
                rect=quiet,
                key="phone.do_not_disturb",
                text=say("Do not disturb"),
                icon=Icon.BELL_OFF,
                checked=calls.do_not_disturb,
                on_tap=Put(
                    replace(calls, do_not_disturb=not calls.do_not_disturb),
                    say("Calls and messages are announced")
                    if calls.do_not_disturb
                    else say("Calls and messages stay silent"),
                ),
            ),
            Button(
                rect=emergency,
                key="phone.emergency_call",
                text=say("Emergency call"),
                icon=Icon.PHONE_ALERT,
                look=Look.CRITICAL,
                on_tap=Show("emergency"),
            ),
        ),
    )


def _call(rect: Rect, state: State) -> tuple[Widget, ...]:
    """A picture, a name, a line below it, and what can be done, one above the other."""
    _, picture, _, name, _, line, _, acts = column(rect, 8, 88, 16, 36, 2, 30, 24, 88)
    now = state.of(Phone)
    if now.ringing is not None:
        return _ringing(picture, name, line, acts, now.ringing.who)
    if now.on_call is not None:
        return _on_call(picture, name, line, acts, now.on_call, state)
    return _linked(picture, name, line, acts.top(60), state)


def _linked(picture: Rect, name: Rect, line: Rect, act: Rect, state: State) -> tuple[Widget, ...]:
    on = state.signals[LINK.BLUETOOTH]
    count = len(state.of(Directory).unread(state.of(Phone)))
    return (
        Glyph(rect=picture, icon=Icon.PHONE, size=72, tone="accent"),
        Label(
            rect=name,
            key="phone.device",
            text=state.of(Connections).phone if on else say("No phone connected"),
            style=Type.STRONG,
            align="centre",
        ),
        Label(
            rect=line,
            key="phone.state",
            text=(counted("{n} unread message", "{n} unread messages", count) if count else say("No new messages"))
            if on
            else say("Bluetooth is off"),
            style=Type.LABEL,
            tone="muted",
            align="centre",
        ),
        Button(
            rect=act,
            key="phone.devices",
            text=say("Devices"),
            icon=Icon.BLUETOOTH,
            on_tap=Show("connections"),
        ),
    )


def _on_call(picture: Rect, name: Rect, line: Rect, acts: Rect, call: OnCall, state: State) -> tuple[Widget, ...]:
    mute, end = acts.columns(2, 12)
    return (
        Glyph(rect=picture, icon=Icon.IN_CALL, size=72, tone="good"),
        Label(
            rect=name,
            key="call.who",
            text=call.who,
            description=say("On the phone with"),
            style=Type.STRONG,
            align="centre",
        ),
        Label(
            rect=line,
            key="call.time",
            text=minutes(state.time_s - call.since_s),
            style=Type.LABEL,
            tone="muted",
            align="centre",
        ),
        Tile(
            rect=mute,
            key="call.mute",
            text=say("Mute"),
            icon=Icon.MICROPHONE_OFF,
            checked=call.muted,
            on_tap=Put(
                replace(state.of(Phone), on_call=replace(call, muted=not call.muted)),
                say("The microphone is on") if call.muted else say("The microphone is off"),
            ),
        ),
        Button(
            rect=end,
            key="call.end",
            text=say("End"),
            icon=Icon.HANG_UP,
            icon_size=32,
            look=Look.CRITICAL,
            stacked=True,
            on_tap=HangUp(),
        ),
    )


def _ringing(picture: Rect, name: Rect, line: Rect, acts: Rect, who: str) -> tuple[Widget, ...]:
    answer, decline = acts.columns(2, 12)
    return (
        Glyph(rect=picture, icon=Icon.CALL_IN, size=72, tone="good"),
        Label(
            rect=name,
            key="phone.ringing",
            text=who,
            description=say("Incoming call"),
            style=Type.STRONG,
            align="centre",
        ),
        Label(
            rect=line,
            text=say("Incoming call"),
            style=Type.LABEL,
            tone="muted",
            align="centre",
        ),
        Button(
            rect=answer,
            key="phone.answer",
            text=say_in("call", "Answer"),
            icon=Icon.PHONE,
            icon_size=32,
            look=Look.ACCENT,
            stacked=True,
            on_tap=TakeCall(),
        ),
        Button(
            rect=decline,
            key="phone.decline",
            text=say("Decline"),
            icon=Icon.HANG_UP,
            icon_size=32,
            look=Look.CRITICAL,
            stacked=True,
            on_tap=DeclineCall(),
        ),
    )
