"""Cabin: who is aboard, how warm it will be for those who stay, and what is switched for them."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage
from automotive_cosim.cockpit.cards import SMALL, content, heading, slider, switch
from automotive_cosim.cockpit.flow import Block, at, card, fill, grid, line, panels, stack
from automotive_cosim.cockpit.forecast import MINUTES, cabin_c
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.occupants import Kind, Occupant, Seat, seated
from automotive_cosim.cockpit.signals import HMI, HVAC, SEAT
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.values import temperature
from automotive_cosim.cockpit.widgets import Glyph, Label, Widget
from automotive_cosim.contracts.text import say

PLAN_WIDTH = 736
LINE = 32
SEATS = {
    Seat.DRIVER: say("Driver"),
    Seat.PASSENGER: say("Passenger"),
    Seat.REAR_LEFT: say("Rear left"),
    Seat.REAR_MIDDLE: say("Rear middle"),
    Seat.REAR_RIGHT: say("Rear right"),
}
KINDS = {
    Kind.ADULT: (say("Adult"), Icon.ACCOUNT),
    Kind.ELDERLY: (say("Elderly person"), Icon.ELDERLY),
    Kind.CHILD: (say("Child"), Icon.CHILD_STANDING),
    Kind.BABY: (say("Baby"), Icon.CHILD),
    Kind.PET: (say("Pet"), Icon.PET),
    Kind.OBJECT: (say("Object"), Icon.OBJECT),
}
AHEAD_MIN = (10, int(MINUTES), 30)
"""Minutes after which the forecast is shown."""


def cabin(state: State) -> tuple[Widget, ...]:
    """The seats from above on the left, the forecast and the switches on the right."""
    tiles = grid(2, 12, switch(SEAT.BELT_REMINDER, state), switch(SEAT.PASSENGER_AIRBAG, state))
    for_them = card((REST, grid(1, 10, tiles, slider(HMI.REAR_SCREEN, state))), padding=(20, 14))
    right = stack((308, _forecast(state)), GAP, (REST, for_them))
    return fill(content(state), panels((PLAN_WIDTH, _plan(state)), right))


def _plan(state: State) -> Block:
    """The front seats above, the rear bench below, as seen by who sits in them."""
    aboard = {one.seat: one for one in seated(state.signals)}
    front, rear = (
        [_seat(seat, aboard.get(seat)) for seat in line] for line in (tuple(SEATS)[:2], tuple(SEATS)[2:])
    )
    seats = grid(1, 12, grid(2, 12, *front), grid(3, 12, *rear))
    return card((30, heading(say("Who is aboard"))), 6, (REST, seats), padding=SMALL)


def _seat(seat: Seat, one: Occupant | None) -> Block:
    key, name = f"cabin.{seat}", heading(SEATS[seat])
    if one is None:
        empty = Label(key=key, text=say("Empty"), description=SEATS[seat], tone="muted")
        return card((30, line(name, 48)), 4, (40, empty), padding=(18, 14), look="raised")
    kind, icon = KINDS[one.kind]
    told = [(f"{key}.weight", f"{one.weight_kg:g} kg")]
    if one.kind is not Kind.OBJECT:
        told.append((f"{key}.awake", say("Asleep") if one.asleep else say("Awake")))
    told.append((f"{key}.belt", say("Buckled") if one.belted else say("Unbuckled")))
    picture = Glyph(icon=icon, size=38, tone="accent")
    return card(
        (30, line(name, (48, at(lambda box: box.top(40).right_part(40), picture)))),
        4,
        (44, Label(key=key, text=kind, description=SEATS[seat], style=Type.TITLE)),
        10,
        *((LINE, Label(key=fact, text=text, style=Type.LABEL)) for fact, text in told),
        padding=(18, 14),
        look="raised",
    )


def _forecast(state: State) -> Block:
    """How warm the air will be once the driver has left, with the climate control off and on."""

    def warmth(minutes: int, climate: bool) -> Label:
        told = (
            say("Climate on, in {minutes} min", minutes=minutes)
            if climate
            else say("Climate off, in {minutes} min", minutes=minutes)
        )
        return Label(
            key=f"cabin.forecast.{'on' if climate else 'off'}.{minutes}",
            text=temperature(state.signals, cabin_c(state.vehicle, minutes, climate=climate), 0),
            description=told,
            style=Type.STRONG,
            align="right",
        )

    names = (
        Label(text=text, style=Type.LABEL, tone="muted", align="right")
        for text in (say("Climate off"), say("Climate on"))
    )
    lines = [line(130, grid(2, 12, *names))]
    for minutes in AHEAD_MIN:
        values = grid(2, 12, warmth(minutes, False), warmth(minutes, True))
        lines.append(line((130, heading(say("In {minutes} min", minutes=minutes))), values))
    return card(
        (30, heading(say("Cabin after you leave"))),
        10,
        (160, grid(1, 0, *lines)),
        REST,
        switch(HVAC.KEPT, state),
        padding=SMALL,
    )


APP = App(name="cabin", title=say("Cabin"), icon=Icon.CONTACTS, order=17, pages={"cabin": AppPage(cabin)})
