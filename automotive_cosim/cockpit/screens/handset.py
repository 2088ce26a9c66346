"""The card at the side of the phone's screens: the present call, or the phone that is linked."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.messages import DeclineCall, HangUp, Put, Show, TakeCall
from automotive_cosim.cockpit.screens.media import minutes
from automotive_cosim.cockpit.screens.parts import CONTENT
from automotive_cosim.cockpit.signals import LINK
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, Glyph, Label, Look, Tile, Widget

LEFT, RIGHT = CONTENT.left(320), CONTENT.right_part(CONTENT.width - 320 - GAP)
"""The card, and the space beside it."""


def handset(state: State) -> Widget:
    """The present call, or the phone's state, and permanent buttons."""
    inner = LEFT.inset(20)
    calls = state.phone
    return Card(
        rect=LEFT,
        children=(
            *_call(inner, state),
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


def _call(inner: Rect, state: State) -> tuple[Widget, ...]:
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
