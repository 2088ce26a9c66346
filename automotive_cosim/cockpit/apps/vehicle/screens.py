"""Vehicle: lamps and wipers with a view of the car, and driver assistance."""

from __future__ import annotations

from automotive_cosim.cockpit.apps.vehicle.commands import Wash
from automotive_cosim.cockpit.commands import Set
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, panes, row
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.parts import choices, content, heading, levels, speed, speed_unit, stepper, switch
from automotive_cosim.cockpit.signals import ADAS, BODY, GLASS, LIGHTS, Signal
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, CarView, Label, Tile, Widget
from automotive_cosim.contracts.text import Quantity, listed, say, say_in

CAR_WIDTH = 340
WIPING = {
    "OFF": ("off", say("Off")),
    "RAIN_SENSOR": ("auto", say("Auto")),
    "INTERVAL": ("interval", say("Interval")),
    "SLOW": ("slow", say("Slow")),
    "MEDIUM": ("medium", say("Medium")),
    "FAST": ("fast", say("Fast")),
}


def vehicle(state: State) -> tuple[Widget, ...]:
    """Lamps and wipers."""
    signals = state.signals
    _, lights, _, wipers = column(right_side(state), 64 + GAP, 272, GAP, REST)
    head, _, turned, _, lit = column(lights.inset(20, 16), 28, 8, 72, REST, 116)
    switches = (
        ("off", say("Off"), Icon.LIGHTS_OFF, "OFF"),
        ("position", say_in("lights", "Position"), Icon.POSITION, "POSITION"),
        ("auto", say("Auto"), Icon.LIGHTS_AUTO, "AUTO"),
        ("low_beam", say("Low beam"), Icon.LOW_BEAM, "BEAM"),
    )
    lamps = (
        ("high_beam", say("High beam"), Icon.HIGH_BEAM, LIGHTS.HIGH_BEAM),
        ("front_fog", say("Front fog"), Icon.FRONT_FOG, LIGHTS.FRONT_FOG),
        ("rear_fog", say("Rear fog"), Icon.REAR_FOG, LIGHTS.REAR_FOG),
        ("hazard", say("Hazards"), Icon.HAZARD, LIGHTS.HAZARD),
    )
    now = signals[LIGHTS.SWITCH]
    return (
        car_card(state),
        tabs(state),
        Card(
            rect=lights,
            children=(
                heading(head, say("Lights")),
                choices(
                    turned,
                    "lights.switch",
                    [
                        (key, text, icon, now == value, Set(LIGHTS.SWITCH, value))
                        for key, text, icon, value in switches
                    ],
                ),
                *(
                    switch(cell, f"lights.{key}", name, icon, signal, signals)
                    for cell, (key, name, icon, signal) in zip(lit.columns(4, 12), lamps, strict=True)
                ),
            ),
        ),
        _wipers(wipers, state),
    )


def assistance(state: State) -> tuple[Widget, ...]:
    """Driver assistance, cruise control and limiter."""
    signals = state.signals
    _, helpers, _, keeping = column(right_side(state), 64 + GAP, 236, GAP, REST)
    head, _, switches = column(helpers.inset(20, 14), 28, 4, REST)
    known = (
        ("collision_warning", say("Collision warning"), Icon.COLLISION, ADAS.FORWARD_COLLISION_WARNING),
        ("emergency_braking", say("Emergency braking"), Icon.BRAKE, ADAS.EMERGENCY_BRAKING),
        ("speed_warning", say("Speed warning"), Icon.SPEED, ADAS.SPEED_WARNING),
        ("lane_departure", say("Lane departure"), Icon.LANE, ADAS.LANE_DEPARTURE),
        ("lane_keeping", say("Lane keeping"), Icon.STEERING, ADAS.LANE_KEEPING),
        ("stability_control", say("Stability control"), Icon.STABILITY, ADAS.STABILITY_CONTROL),
        ("blind_spot", say("Blind spot"), Icon.CAR_BESIDE, ADAS.BLIND_SPOT),
        ("parking_sensors", say("Parking sensors"), Icon.PARKING, ADAS.PARKING_SENSORS),
        ("driver_monitoring", say("Attention"), Icon.EYE, ADAS.DRIVER_MONITORING),
    )
    cells = [cell for line in switches.rows(3, 8) for cell in line.columns(3, 10)]
    return (
        car_card(state),
        tabs(state),
        Card(
            rect=helpers,
            children=(
                heading(head, say("Assistance")),
                *(
                    switch(cell, f"adas.{key}", name, icon, signal, signals)
                    for cell, (key, name, icon, signal) in zip(cells, known, strict=True)
                ),
            ),
        ),
        _keeping(keeping, state),
    )


def right_side(state: State) -> Rect:
    """The controls next to the car."""
    return panes(content(state), CAR_WIDTH, REST)[-1]


def tabs(state: State) -> Widget:
    """The parts of the car."""
    return choices(
        right_side(state).top(64),
        "vehicle.tab",
        [
            (name, text, icon, state.screen == screen, Show(screen))
            for name, text, icon, screen in (
                ("lights", say("Lights"), Icon.LOW_BEAM, "vehicle"),
                ("assistance", say("Assist"), Icon.CRUISE, "assistance"),
                ("driving", say("Driving"), Icon.DRIVE_MODE, "driving"),
                ("doors", say("Doors"), Icon.DOOR, "doors"),
                ("seats", say("Seats"), Icon.SEAT, "seats"),
                ("mirrors", say("Mirrors"), Icon.MIRROR, "mirrors"),
                ("interior", say("Inside"), Icon.DOME_LIGHT, "interior"),
            )
        ],
    )


def car_card(state: State) -> Widget:
    """The car from above, with its lamps and its glass."""
    signals = state.signals
    fog = 1 - (1 - signals[GLASS.WINDSHIELD_FOG]) * (1 - signals[GLASS.WINDSHIELD_FILM])
    rear = 1 - (1 - signals[GLASS.REAR_FOG]) * (1 - signals[GLASS.REAR_FILM])
    lit = [
        name
        for name, on in (
            (say("position lamps"), signals[LIGHTS.POSITION]),
            (say("low beam"), signals[LIGHTS.LOW_BEAM]),
            (say("high beam"), signals[LIGHTS.HIGH_BEAM]),
            (say("front fog"), signals[LIGHTS.FRONT_FOG]),
            (say("rear fog"), signals[LIGHTS.REAR_FOG]),
            (say("hazard lights"), signals[LIGHTS.HAZARD]),
        )
        if on
    ]
    rect = panes(content(state), CAR_WIDTH, REST)[0]
    return Card(
        rect=rect,
        children=(
            CarView(
                rect=rect.middle(CAR_WIDTH - 40, rect.height - 40),
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
            ),
        ),
    )


def _wipers(rect: Rect, state: State) -> Widget:
    inner = rect.inset(20, 14)
    front, rear = state.signals[BODY.FRONT_WIPER], state.signals[BODY.REAR_WIPER]
    upper, lower = inner.rows(2, 12)
    front_name, _, front_modes = row(upper, 128, 8, REST)
    rear_name, _, rear_modes, _, wash = row(lower, 128, 8, REST, 12, 150)
    return Card(
        rect=rect,
        children=(
            Label(rect=front_name, text=say("Front wiper"), style=Type.LABEL, tone="muted"),
            choices(
                front_modes,
                "wiper.front",
                [
                    (key, text, None, front == mode, Set(BODY.FRONT_WIPER, mode))
                    for mode, (key, text) in WIPING.items()
                ],
            ),
            Label(rect=rear_name, text=say("Rear wiper"), style=Type.LABEL, tone="muted"),
            choices(
                rear_modes,
                "wiper.rear",
                [
                    (key, text, None, rear == mode, Set(BODY.REAR_WIPER, mode))
                    for mode, (key, text) in WIPING.items()
                    if mode in BODY.REAR_WIPER.allowed
                ],
            ),
            Button(
                rect=wash,
                key="wiper.wash",
                text=say("Wash"),
                description=say("Washer fluid {share} %", share=f"{state.signals[BODY.WASHER_FLUID]:.0f}"),
                icon=Icon.WASHER,
                on_tap=Wash(),
            ),
        ),
    )


def _keeping(rect: Rect, state: State) -> Widget:
    """Cruise control on the left, the limiter on the right; only one of them is active."""
    signals = state.signals
    left, right = rect.inset(20, 12).columns(2, 24)
    _, following = column(left, 130, 56)
    _, available = column(right, 130, 56)
    adaptive, gap = following.columns(2, 10)
    off = "" if signals[ADAS.CRUISE_ENABLED] else say("Cruise control is disabled")
    return Card(
        rect=rect,
        children=(
            *_holder(
                left,
                "adas.cruise",
                say("Cruise control active"),
                say("Cruise control, set speed"),
                Icon.CRUISE,
                ADAS.CRUISE_ACTIVE,
                ADAS.CRUISE_SPEED,
                state,
                off,
            ),
            switch(adaptive, "adas.cruise_adaptive", say("Adaptive"), Icon.DISTANCE, ADAS.CRUISE_ADAPTIVE, signals),
            levels(
                gap,
                "adas.cruise_gap",
                say("Gap"),
                Icon.DISTANCE,
                ADAS.CRUISE_GAP,
                signals,
                [(seconds, Quantity(f"{seconds:.1f} s")) for seconds in (1.0, 1.5, 2.0, 2.5, 3.0)],
            ),
            *_holder(
                right,
                "adas.limiter",
                say("Limiter active"),
                say("Limiter, set speed"),
                Icon.SLOWER,
                ADAS.LIMITER_ACTIVE,
                ADAS.LIMITER_SPEED,
                state,
                "",
            ),
            switch(
                available,
                "adas.cruise_enabled",
                say("Cruise control available"),
                Icon.CRUISE,
                ADAS.CRUISE_ENABLED,
                signals,
            ),
        ),
    )


def _holder(
    rect: Rect,
    key: str,
    name: str,
    set_speed: str,
    icon: Icon,
    active: Signal[bool],
    target: Signal[float],
    state: State,
    disabled: str,
) -> tuple[Widget, ...]:
    signals = state.signals
    on = signals[active]
    tile, _, steps = column(rect, 54, 8, 60)

    def show(kmh: float) -> str:
        return f"{speed(signals, kmh)} {speed_unit(signals)}"

    return (
        Tile(
            rect=tile,
            key=key,
            text=name,
            icon=icon,
            checked=on,
            on_tap=Set(active, not on),
            disabled=disabled,
        ),
        *stepper(steps, f"{key}_speed", set_speed, target, signals, show),
    )
