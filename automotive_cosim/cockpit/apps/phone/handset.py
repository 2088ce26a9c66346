"""The card at the side of the phone's screens: the present call, or the phone that is linked."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.phone.commands import DECLINE_CALL, HANG_UP, TAKE_CALL
from automotive_cosim.cockpit.apps.phone.state import Directory, OnCall, Phone
from automotive_cosim.cockpit.apps.settings.state import Connections
from automotive_cosim.cockpit.cards import content
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.flow import Block, BlockPart, fill, framed, grid, panels, stack
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.signals import LINK
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.values import minutes
from automotive_cosim.cockpit.widgets import Button, Glyph, Label, Look, Tile, Tone, Widget
from automotive_cosim.contracts.text import counted, say, say_in


def beside_handset(state: State, page: BlockPart) -> tuple[Widget, ...]:
    """A screen of the phone: the card, and a page."""
    return fill(content(state), panels((320, _handset(state)), page))


def _handset(state: State) -> BlockPart:
    """The present call, or the phone's state, and permanent buttons."""
    phone = state.of(Phone)
    on = phone.do_not_disturb
    quiet = Tile(
        key="phone.do_not_disturb",
        text=say("Do not disturb"),
        icon=Icon.BELL_OFF,
        checked=on,
        on_tap=Put(
            replace(phone, do_not_disturb=not on),
            say("Calls and messages are announced") if on else say("Calls and messages stay silent"),
        ),
    )
    emergency = Button(
        key="phone.emergency_call",
        text=say("Emergency call"),
        icon=Icon.PHONE_ALERT,
        look=Look.CRITICAL,
        on_tap=Show("emergency"),
    )
    call = (
        _ringing(phone.ringing.who)
        if phone.ringing
        else _on_call(phone, phone.on_call, state)
        if phone.on_call
        else _linked(state)
    )

    def divide(box: Rect) -> tuple[Rect, ...]:
        """The buttons stand side by side where there is the room."""
        if box.width > box.height:
            above, acts = column(box, REST, 68)
            return above, *acts.columns(2, 12)
        above, first, _, second = column(box, REST, 68, 12, 68)
        return above, first, second

    return framed(Block((call, quiet, emergency), divide), (20, 20))


def _call(icon: Icon, tone: Tone, name: Label, line: Label, acts: tuple[int, BlockPart]) -> Block:
    """A picture, a name, a line below it, and what can be done, one above the other."""
    picture = Glyph(icon=icon, size=72, tone=tone)
    return stack(8, (88, picture), 16, (36, name), 2, (30, line), 24, acts, REST)


def _name(key: str, text: str, about: str = "") -> Label:
    return Label(key=key, text=text, description=about, style=Type.STRONG, align="centre")


def _line(key: str, text: str) -> Label:
    return Label(key=key, text=text, style=Type.LABEL, tone="muted", align="centre")


def _act(key: str, text: str, icon: Icon, look: Look, on_tap: Message) -> Button:
    return Button(key=key, text=text, icon=icon, icon_size=32, look=look, stacked=True, on_tap=on_tap)


def _linked(state: State) -> Block:
    on = state.signals[LINK.BLUETOOTH]
    count = len(state.of(Directory).unread(state.of(Phone)))
    new = counted("{n} unread message", "{n} unread messages", count) if count else say("No new messages")
    devices = Button(key="phone.devices", text=say("Devices"), icon=Icon.BLUETOOTH, on_tap=Show("connections"))
    return _call(
        Icon.PHONE,
        "accent",
        _name("phone.device", state.of(Connections).phone if on else say("No phone connected")),
        _line("phone.state", new if on else say("Bluetooth is off")),
        (60, devices),
    )


def _on_call(phone: Phone, call: OnCall, state: State) -> Block:
    mute = Tile(
        key="call.mute",
        text=say("Mute"),
        icon=Icon.MICROPHONE_OFF,
        checked=call.muted,
        on_tap=Put(
            replace(phone, on_call=replace(call, muted=not call.muted)),
            say("The microphone is on") if call.muted else say("The microphone is off"),
        ),
    )
    end = _act("call.end", say("End"), Icon.HANG_UP, Look.CRITICAL, HANG_UP)
    return _call(
        Icon.IN_CALL,
        "good",
        _name("call.who", call.who, say("On the phone with")),
        _line("call.time", minutes(state.time_s - call.since_s)),
        (88, grid(2, 12, mute, end)),
    )


def _ringing(who: str) -> Block:
    answer = _act("phone.answer", say_in("call", "Answer"), Icon.PHONE, Look.ACCENT, TAKE_CALL)
    decline = _act("phone.decline", say("Decline"), Icon.HANG_UP, Look.CRITICAL, DECLINE_CALL)
    return _call(
        Icon.CALL_IN,
        "good",
        _name("phone.ringing", who, say("Incoming call")),
        _line("", say("Incoming call")),
        (88, grid(2, 12, answer, decline)),
    )
