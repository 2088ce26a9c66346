"""Vehicle: lamps and wipers with a view of the car, and driver assistance."""

from __future__ import annotations

from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.messages import Set, Show, Wash
from automotive_cosim.cockpit.screens.parts import (
    CONTENT,
    choices,
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
    right = right_side()
    lights = Rect(right.x, right.y + 64 + GAP, right.width, 272)
    inner = lights.inset(20, 16)
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
                heading(inner.top(28), "Lights"),
                choices(
                    Rect(inner.x, inner.y + 36, inner.width, 72),
                    "lights.switch",
                    [
                        (key, text, icon, now == value, Set(LIGHTS.SWITCH, value))
                        for key, text, icon, value in switches
                    ],
                ),
                *(
                    switch(cell, f"lights.{key}", name, icon, signal, signals)
                    for cell, (key, name, icon, signal) in zip(
                        inner.bottom_part(116).columns(4, 12), lamps, strict=True
                    )
                ),
            ),
        ),
        _wipers(Rect(right.x, lights.bottom + GAP, right.width, right.bottom - lights.bottom - GAP), state),
    )


def assistance(state: State) -> tuple[Widget, ...]:
    """Driver assistance, cruise control and limiter."""
    signals = state.signals
    right = right_side()
    helpers = Rect(right.x, right.y + 64 + GAP, right.width, 236)
    inner = helpers.inset(20, 14)
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
    cells = [cell for line in inner.below(32).rows(3, 8) for cell in line.columns(3, 10)]
    return (
        car_card(state),
        tabs(state),
        Card(
            rect=helpers,
            children=(
                heading(inner.top(28), "Assistance"),
                *(
                    switch(cell, f"adas.{key}", name, icon, signal, signals)
                    for cell, (key, name, icon, signal) in zip(cells, known, strict=True)
                ),
            ),
        ),
        _keeping(Rect(right.x, helpers.bottom + GAP, right.width, right.bottom - helpers.bottom - GAP), state),
    )


def right_side() -> Rect:
    """The controls next to the car."""
    return CONTENT.right_part(CONTENT.width - CAR_WIDTH - GAP)


def tabs(state: State) -> Widget:
    """The parts of the car."""
    return choices(
        right_side().top(64),
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
    rect = CONTENT.left(CAR_WIDTH)
    return Card(
        rect=rect,
        children=(
            CarView(
                rect=rect.inset(20),
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
    wash = lower.right_part(150)
    return Card(
        rect=rect,
        children=(
            Label(rect=upper.left(128), text="Front wiper", style=Type.LABEL, tone="muted"),
            choices(
                upper.right_part(upper.width - 136),
                "wiper.front",
                [
                    (key, text, None, front == mode, Set(BODY.FRONT_WIPER, mode))
                    for mode, (key, text) in WIPING.items()
                ],
            ),
            Label(rect=lower.left(128), text="Rear wiper", style=Type.LABEL, tone="muted"),
            choices(
                Rect(lower.x + 136, lower.y, lower.width - 136 - 162, lower.height),
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
    inner = rect.inset(20, 12)
    left, right = inner.columns(2, 24)
    adaptive, gap = Rect(left.x, left.y + 130, left.width, 56).columns(2, 10)
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
                Rect(right.x, right.y + 130, right.width, 56),
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
    shown = f"{speed(signals, signals[target])} {speed_unit(signals)}"
    return (
        Tile(
            rect=rect.top(54),
            key=key,
            text=name,
            icon=icon,
            checked=on,
            on_tap=Set(active, not on),
            disabled=disabled,
        ),
        *stepper(
            Rect(rect.x, rect.y + 62, rect.width, 60), f"{key}_speed", f"{name}, set speed", target, signals, shown
        ),
    )
