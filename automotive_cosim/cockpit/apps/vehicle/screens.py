"""Vehicle: lamps and wipers with a view of the car, and driver assistance."""

from __future__ import annotations

from automotive_cosim.cockpit.apps.vehicle.state import WASH
from automotive_cosim.cockpit.cards import SMALL, choice, choices, content, heading, levels, stepper, switch
from automotive_cosim.cockpit.flow import Block, BlockItem, at, card, fill, framed, grid, line, panels, stack
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.signals import ADAS, BODY, GLASS, LIGHTS
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon
from automotive_cosim.cockpit.widgets import Button, CarView, Widget
from automotive_cosim.contracts.text import Quantity, listed, say

CAR_WIDTH = 340
TABS = (
    ("lights", say("Lights"), Icon.LOW_BEAM, "vehicle"),
    ("assistance", say("Assist"), Icon.CRUISE, "assistance"),
    ("driving", say("Driving"), Icon.DRIVE_MODE, "driving"),
    ("doors", say("Doors"), Icon.DOOR, "doors"),
    ("seats", say("Seats"), Icon.SEAT, "seats"),
    ("mirrors", say("Mirrors"), Icon.MIRROR, "mirrors"),
    ("interior", say("Inside"), Icon.DOME_LIGHT, "interior"),
)
"""Key, name and icon of each part of the car, and its screen."""


def page(state: State, *items: BlockItem) -> tuple[Widget, ...]:
    """The car on the left; on the right its parts, and below them what is given."""
    shown = [tab for tab in TABS if state.beside(tab[-1])]
    tabs = choices(
        "vehicle.tab", ((name, text, icon, state.screen == to, Show(to)) for name, text, icon, to in shown)
    )
    return fill(content(state), panels((CAR_WIDTH, _car(state)), stack((64, tabs), GAP, *items)))


def vehicle(state: State) -> tuple[Widget, ...]:
    """Lamps and wipers."""
    lamps = (LIGHTS.HIGH_BEAM, LIGHTS.FRONT_FOG, LIGHTS.REAR_FOG, LIGHTS.HAZARD)
    lights = card(
        heading(say("Lights")),
        8,
        (72, choice(LIGHTS.SWITCH, state)),
        REST,
        (116, grid(4, 12, *(switch(lamp, state) for lamp in lamps))),
        padding=SMALL,
    )
    return page(state, (272, lights), GAP, (REST, _wipers(state)))


def assistance(state: State) -> tuple[Widget, ...]:
    """Driver assistance, cruise control and limiter."""
    known = (
        ADAS.FORWARD_COLLISION_WARNING,
        ADAS.EMERGENCY_BRAKING,
        ADAS.SPEED_WARNING,
        ADAS.LANE_DEPARTURE,
        ADAS.LANE_KEEPING,
        ADAS.STABILITY_CONTROL,
        ADAS.BLIND_SPOT,
        ADAS.PARKING_SENSORS,
        ADAS.DRIVER_MONITORING,
    )
    tiles = grid(3, (10, 8), *(switch(signal, state) for signal in known))
    helpers = card(heading(say("Assistance")), 4, (REST, tiles), padding=(20, 14))
    return page(state, (236, helpers), GAP, (REST, _keeping(state)))


def _car(state: State) -> Block:
    """The car from above, with its lamps and its glass."""
    signals = state.signals
    fog = 1 - (1 - signals[GLASS.WINDSHIELD_FOG]) * (1 - signals[GLASS.WINDSHIELD_FILM])
    rear = 1 - (1 - signals[GLASS.REAR_FOG]) * (1 - signals[GLASS.REAR_FILM])
    lit = [
        name
        for name, lamp in (
            (say("position lamps"), LIGHTS.POSITION),
            (say("low beam"), LIGHTS.LOW_BEAM),
            (say("high beam"), LIGHTS.HIGH_BEAM),
            (say("front fog"), LIGHTS.FRONT_FOG),
            (say("rear fog"), LIGHTS.REAR_FOG),
            (say("hazard lights"), LIGHTS.HAZARD),
        )
        if signals[lamp]
    ]
    view = CarView(
        key="vehicle.car",
        description=say("The car, lit: {lamps}", lamps=listed(lit) if lit else say("nothing")),
        position=signals[LIGHTS.POSITION],
        low=signals[LIGHTS.LOW_BEAM],
        high=signals[LIGHTS.HIGH_BEAM],
        front_fog=signals[LIGHTS.FRONT_FOG],
        rear_fog=signals[LIGHTS.REAR_FOG],
        hazard=signals[LIGHTS.HAZARD],
        windshield=round(10 * fog),
        rear_window=round(10 * rear),
    )
    return framed(at(lambda box: box.middle(CAR_WIDTH - 40, box.height - 40), view))


def _wipers(state: State) -> Block:
    wash = Button(
        key="wiper.wash",
        text=say("Wash"),
        description=say("Washer fluid {share} %", share=f"{state.signals[BODY.WASHER_FLUID]:.0f}"),
        icon=Icon.WASHER,
        on_tap=WASH,
    )
    front = line((128, heading(say("Front wiper"))), 8, choice(BODY.FRONT_WIPER, state))
    rear = line((128, heading(say("Rear wiper"))), 8, choice(BODY.REAR_WIPER, state), 12, (150, wash))
    return framed(grid(1, 12, front, rear), (20, 14))


def _keeping(state: State) -> Block:
    """Cruise control on the left, the limiter on the right; only one of them is active."""
    off = "" if state.signals[ADAS.CRUISE_ENABLED] else say("Cruise control is disabled")
    gaps = [(seconds, Quantity(f"{seconds:.1f} s")) for seconds in (1.0, 1.5, 2.0, 2.5, 3.0)]
    cruise = stack(
        (54, switch(ADAS.CRUISE_ACTIVE, state, disabled=off)),
        8,
        (60, stepper(ADAS.CRUISE_SPEED, state.signals)),
        8,
        (56, grid(2, 10, switch(ADAS.CRUISE_ADAPTIVE, state), levels(ADAS.CRUISE_GAP, state, gaps))),
    )
    limiter = stack(
        (54, switch(ADAS.LIMITER_ACTIVE, state)),
        8,
        (60, stepper(ADAS.LIMITER_SPEED, state.signals)),
        8,
        (56, switch(ADAS.CRUISE_ENABLED, state)),
    )
    return framed(grid(2, 24, cruise, limiter), (20, 12))
