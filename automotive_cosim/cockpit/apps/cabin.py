"""Cabin: who is aboard, how warm it will be for those who stay, and what is switched for them."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage
from automotive_cosim.cockpit.forecast import MINUTES, cabin_c
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, panes, row
from automotive_cosim.cockpit.occupants import Kind, Occupant, Seat, seated
from automotive_cosim.cockpit.parts import content, heading, slider, switch, temperature
from automotive_cosim.cockpit.signals import HMI, HVAC, SEAT
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Card, Glyph, Label, Widget
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
    plan, right = panes(content(state), PLAN_WIDTH, REST)
    forecast, _, switches = column(right, 308, GAP, REST)
    return _plan(plan, state), _forecast(forecast, state), _for_them(switches, state)


def _plan(rect: Rect, state: State) -> Widget:
    """The front seats above, the rear bench below, as seen by who sits in them."""
    head, _, seats = column(rect.inset(20, 16), 30, 6, REST)
    front, rear = seats.rows(2, 12)
    cells = (*front.columns(2, 12), *rear.columns(3, 12))
    aboard = {one.seat: one for one in seated(state.signals)}
    tiles = (_seat(cell, seat, aboard.get(seat)) for cell, seat in zip(cells, SEATS, strict=True))
    return Card(rect=rect, children=(heading(head, say("Who is aboard")), *tiles))


def _seat(rect: Rect, seat: Seat, one: Occupant | None) -> Widget:
    head, _, what, _, facts = column(rect.inset(18, 14), 30, 4, 44, 10, REST)
    title, picture = row(head, REST, 48)
    key = f"cabin.{seat}"
    name = heading(title, SEATS[seat])
    if one is None:
        empty = Label(rect=what.top(40), key=key, text=say("Empty"), description=SEATS[seat], tone="muted")
        return Card(rect=rect, look="raised", children=(name, empty))
    kind, icon = KINDS[one.kind]
    told = [(f"{key}.weight", f"{one.weight_kg:g} kg")]
    if one.kind is not Kind.OBJECT:
        told.append((f"{key}.awake", say("Asleep") if one.asleep else say("Awake")))
    told.append((f"{key}.belt", say("Buckled") if one.belted else say("Unbuckled")))
    return Card(
        rect=rect,
        look="raised",
        children=(
            name,
            Glyph(rect=picture.top(40).right_part(40), icon=icon, size=38, tone="accent"),
            Label(rect=what, key=key, text=kind, description=SEATS[seat], style=Type.TITLE),
            *(
                Label(rect=line, key=fact, text=text, style=Type.LABEL)
                for line, (fact, text) in zip(column(facts, *(len(told) * [LINE])), told, strict=True)
            ),
        ),
    )


def _forecast(rect: Rect, state: State) -> Widget:
    """How warm the air will be once the driver has left, with the climate control off and on."""
    head, _, table, _, keep = column(rect.inset(20, 16), 30, 10, 160, REST, 60)
    lines = table.rows(4, 0)
    children: list[Widget] = [
        heading(head, say("Cabin after you leave")),
        *(
            Label(rect=cell, text=text, style=Type.LABEL, tone="muted", align="right")
            for cell, text in zip(_columns(lines[0])[1:], (say("Climate off"), say("Climate on")), strict=True)
        ),
    ]
    for line, minutes in zip(lines[1:], AHEAD_MIN, strict=True):
        name, *values = _columns(line)
        children.append(
            Label(rect=name, text=say("In {minutes} min", minutes=minutes), style=Type.LABEL, tone="muted")
        )
        for cell, climate in zip(values, (False, True), strict=True):
            children.append(
                Label(
                    rect=cell,
                    key=f"cabin.forecast.{'on' if climate else 'off'}.{minutes}",
                    text=temperature(state.signals, cabin_c(state.vehicle, minutes, climate=climate), 0),
                    description=say("Climate on, in {minutes} min", minutes=minutes)
                    if climate
                    else say("Climate off, in {minutes} min", minutes=minutes),
                    style=Type.STRONG,
                    align="right",
                )
            )
    kept = switch(keep, "cabin.keep_climate", say("Keep climate on"), Icon.CLIMATE, HVAC.KEPT, state.signals)
    return Card(rect=rect, children=(*children, kept))


def _columns(line: Rect) -> tuple[Rect, Rect, Rect]:
    """Name, climate off, climate on."""
    name, values = row(line, 130, REST)
    off, on = values.columns(2, 12)
    return name, off, on


def _for_them(rect: Rect, state: State) -> Widget:
    inner, signals = rect.inset(20, 14), state.signals
    upper, lower = inner.rows(2, 10)
    reminder, airbag = upper.columns(2, 12)
    return Card(
        rect=rect,
        children=(
            switch(
                reminder,
                "cabin.belt_reminder",
                say("Belt chime"),
                Icon.SEAT_BELT,
                SEAT.BELT_REMINDER,
                state.signals,
            ),
            switch(
                airbag,
                "cabin.passenger_airbag",
                say("Passenger airbag"),
                Icon.AIRBAG,
                SEAT.PASSENGER_AIRBAG,
                signals,
                state.vehicle.held(SEAT.PASSENGER_AIRBAG),
            ),
            slider(
                lower, "cabin.rear_screen", say("Rear screen, brightness"), Icon.SCREEN, HMI.REAR_SCREEN, signals
            ),
        ),
    )


APP = App(
    name="cabin",
    title=say("Cabin"),
    icon=Icon.CONTACTS,
    order=17,
    pages={"cabin": AppPage(cabin)},
)
