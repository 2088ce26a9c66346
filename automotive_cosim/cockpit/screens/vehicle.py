"""Vehicle: lamps and wipers with a view of the car, and driver assistance."""

from __future__ import annotations

from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, panes, row
from automotive_cosim.cockpit.messages import Set, Show, Wash
from automotive_cosim.cockpit.screens.parts import (
    choices,
    content,
    heading,
    levels,
    speed,
    speed_unit,
    stepper,
    switch,
)
from automotive_cosim.cockpit.signals import ADAS, BODY, GLASS, LIGHTS, Signal
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, CarView, Label, Tile, Widget

CAR_WIDTH = 340
WIPING = {
    "OFF": ("off", "Off"),
    "RAIN_SENSOR": ("auto", "Auto"),
    "INTERVAL": ("interval", "Interval"),
    "SLOW": ("slow", "Slow"),
    "MEDIUM": ("medium", "Medium"),
    "FAST": ("fast", "Fast"),
}


def vehicle(state: State) -> tuple[Widget, ...]:
    """Lamps and wipers."""
    signals = state.signals
    _, lights, _, wipers = column(right_side(state), 64 + GAP, 272, GAP, REST)
    head, _, turned, _, lit = column(lights.inset(20, 16), 28, 8, 72, REST, 116)
    switches = (
        ("off", "Off", Icon.LIGHTS_OFF, "OFF"),
        ("position", "Position", Icon.POSITION, "POSITION"),
        ("auto", "Auto", Icon.LIGHTS_AUTO, "AUTO"),
        ("low_beam", "Low beam", Icon.LOW_BEAM, "BEAM"),
    )
    lamps = (
        ("high_beam", "High beam", Icon.HIGH_BEAM, LIGHTS.HIGH_BEAM),
        ("front_fog", "Front fog", Icon.FRONT_FOG, LIGHTS.FRONT_FOG),
        ("rear_fog", "Rear fog", Icon.REAR_FOG, LIGHTS.REAR_FOG),
        ("hazard", "Hazards", Icon.HAZARD, LIGHTS.HAZARD),
    )
    now = signals[LIGHTS.SWITCH]
    return (
        car_card(state),
        tabs(state),
        Card(
            rect=lights,
            children=(
                heading(head, "Lights"),
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
        ("collision_warning", "Collision warning", Icon.COLLISION, ADAS.FORWARD_COLLISION_WARNING),
        ("emergency_braking", "Emergency braking", Icon.BRAKE, ADAS.EMERGENCY_BRAKING),
        ("speed_warning", "Speed warning", Icon.SPEED, ADAS.SPEED_WARNING),
        ("lane_departure", "Lane departure", Icon.LANE, ADAS.LANE_DEPARTURE),
        ("lane_keeping", "Lane keeping", Icon.STEERING, ADAS.LANE_KEEPING),
        ("stability_control", "Stability control", Icon.STABILITY, ADAS.STABILITY_CONTROL),
        ("blind_spot", "Blind spot", Icon.CAR_BESIDE, ADAS.BLIND_SPOT),
        ("parking_sensors", "Parking sensors", Icon.PARKING, ADAS.PARKING_SENSORS),
        ("driver_monitoring", "Attention", Icon.EYE, ADAS.DRIVER_MONITORING),
    )
    cells = [cell for line in switches.rows(3, 8) for cell in line.columns(3, 10)]
    return (
        car_card(state),
        tabs(state),
        Card(
            rect=helpers,
            children=(
                heading(head, "Assistance"),
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
                ("lights", "Lights", Icon.LOW_BEAM, "vehicle"),
                ("assistance", "Assist", Icon.CRUISE, "assistance"),
                ("driving", "Driving", Icon.DRIVE_MODE, "driving"),
                ("doors", "Doors", Icon.DOOR, "doors"),
                ("seats", "Seats", Icon.SEAT, "seats"),
                ("mirrors", "Mirrors", Icon.MIRROR, "mirrors"),
                ("interior", "Inside", Icon.DOME_LIGHT, "interior"),
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
            ("position lamps", signals[LIGHTS.POSITION]),
            ("low beam", signals[LIGHTS.LOW_BEAM]),
            ("high beam", signals[LIGHTS.HIGH_BEAM]),
            ("front fog", signals[LIGHTS.FRONT_FOG]),
            ("rear fog", signals[LIGHTS.REAR_FOG]),
            ("hazard lights", signals[LIGHTS.HAZARD]),
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
                description="The car, lit: " + (", ".join(lit) or "nothing"),
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
            Label(rect=front_name, text="Front wiper", style=Type.LABEL, tone="muted"),
            choices(
                front_modes,
                "wiper.front",
                [
                    (key, text, None, front == mode, Set(BODY.FRONT_WIPER, mode))
                    for mode, (key, text) in WIPING.items()
                ],
            ),
            Label(rect=rear_name, text="Rear wiper", style=Type.LABEL, tone="muted"),
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
                text="Wash",
                description=f"Washer fluid {state.signals[BODY.WASHER_FLUID]:.0f} %",
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
    off = "" if signals[ADAS.CRUISE_ENABLED] else "Cruise control is disabled"
    return Card(
        rect=rect,
        children=(
            *_holder(
                left,
                "adas.cruise",
                "Cruise control",
                Icon.CRUISE,
                ADAS.CRUISE_ACTIVE,
                ADAS.CRUISE_SPEED,
                state,
                off,
            ),
            switch(adaptive, "adas.cruise_adaptive", "Adaptive", Icon.DISTANCE, ADAS.CRUISE_ADAPTIVE, signals),
            levels(
                gap,
                "adas.cruise_gap",
                "Gap",
                Icon.DISTANCE,
                ADAS.CRUISE_GAP,
                signals,
                [(seconds, f"{seconds:.1f} s") for seconds in (1.0, 1.5, 2.0, 2.5, 3.0)],
            ),
            *_holder(
                right, "adas.limiter", "Limiter", Icon.SLOWER, ADAS.LIMITER_ACTIVE, ADAS.LIMITER_SPEED, state, ""
            ),
            switch(
                available,
                "adas.cruise_enabled",
                "Cruise control available",
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
    icon: Icon,
    active: Signal[bool],
    target: Signal[float],
    state: State,
    disabled: str,
) -> tuple[Widget, ...]:
    signals = state.signals
    on = signals[active]
    tile, _, steps = column(rect, 54, 8, 60)
    shown = f"{speed(signals, signals[target])} {speed_unit(signals)}"
    return (
        Tile(
            rect=tile,
            key=key,
            text=f"{name} active",
            icon=icon,
            checked=on,
            on_tap=Set(active, not on),
            disabled=disabled,
        ),
        *stepper(steps, f"{key}_speed", f"{name}, set speed", target, signals, shown),
    )
