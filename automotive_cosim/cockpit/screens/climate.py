"""Climate: both seats, fan and air, glass, and the cabin's air quality."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.messages import Put, Set, Show
from automotive_cosim.cockpit.screens.parts import (
    CONTENT,
    choices,
    fact,
    heading,
    levels,
    slider,
    stepper,
    switch,
    temperature,
    time_setter,
    title,
)
from automotive_cosim.cockpit.signals import GLASS, HVAC, SEAT, Signal
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Bar, Button, Card, Label, Tile, Widget

SEAT_LEVELS = ((0.0, "Off"), (50.0, "Low"), (100.0, "High"))
AIRING_LEVELS = ((0.0, "Off"), (-50.0, "Low"), (-100.0, "High"))
WHEEL_LEVELS = ((0.0, "Off"), (100.0, "On"))


def climate(state: State) -> tuple[Widget, ...]:
    """The climate screen."""
    zones = 264
    driver, passenger = CONTENT.left(zones), CONTENT.right_part(zones)
    if state.roads.network.left_hand:
        driver, passenger = passenger, driver
    middle = Rect(CONTENT.x + zones + GAP, CONTENT.y, CONTENT.width - 2 * (zones + GAP), CONTENT.height)
    return (
        _zone(driver, "driver", "Driver", HVAC.DRIVER_TEMPERATURE, SEAT.DRIVER_HEATING, state),
        _zone(passenger, "passenger", "Passenger", HVAC.PASSENGER_TEMPERATURE, SEAT.PASSENGER_HEATING, state),
        _air(middle.top(240), state),
        *_switches(Rect(middle.x, middle.y + 240 + GAP, middle.width, 188), state),
        _glass(middle.bottom_part(middle.height - 240 - 188 - 2 * GAP), state),
    )


def _zone(rect: Rect, who: str, name: str, warmth: Signal[float], seat: Signal[float], state: State) -> Widget:
    signals = state.signals
    inner = rect.inset(20, 16)
    tiles = Rect(inner.x, inner.bottom - 260, inner.width, 260).rows(3, 10)
    third = (
        levels(
            tiles[2],
            "hvac.steering_wheel_heating",
            "Wheel",
            Icon.STEERING,
            SEAT.STEERING_WHEEL_HEATING,
            signals,
            WHEEL_LEVELS,
        )
        if who == "driver"
        else switch(tiles[2], "hvac.sync", "Sync", Icon.SYNC, HVAC.SYNC, signals)
    )
    return Card(
        rect=rect,
        children=(
            heading(inner.top(30), name),
            Label(
                rect=Rect(inner.x, inner.y + 36, inner.width, 88),
                key=f"hvac.{who}_temperature",
                text=temperature(signals, signals[warmth]),
                description=f"{name}'s temperature",
                style=Type.DISPLAY,
                align="centre",
            ),
            *_plus_minus(Rect(inner.x, inner.y + 136, inner.width, 64), who, name, warmth, state),
            levels(tiles[0], f"hvac.{who}_seat_heating", "Seat heat", Icon.SEAT_HEATER, seat, signals, SEAT_LEVELS),
            levels(tiles[1], f"hvac.{who}_seat_airing", "Seat air", Icon.SEAT_COOLER, seat, signals, AIRING_LEVELS),
            third,
        ),
    )


def _plus_minus(rect: Rect, who: str, name: str, warmth: Signal[float], state: State) -> tuple[Widget, ...]:
    less, _, more = stepper(rect, f"hvac.{who}_temperature", f"{name}'s temperature", warmth, state.signals, "")
    return less, more


def _air(rect: Rect, state: State) -> Widget:
    signals = state.signals
    inner = rect.inset(20, 16)
    blower = inner.top(84)
    flow = signals[HVAC.AIR_DISTRIBUTION]
    ways = (
        ("up", "Windshield", Icon.AIR_UP, "UP"),
        ("middle", "Face", Icon.AIR_MIDDLE, "MIDDLE"),
        ("down", "Feet", Icon.AIR_DOWN, "DOWN"),
    )
    return Card(
        rect=rect,
        children=(
            slider(blower.left(blower.width - 108), "hvac.fan", "Fan speed", Icon.CLIMATE, HVAC.FAN_SPEED, signals),
            Button(
                rect=blower.right_part(88).middle(88, 64),
                key="hvac.fan.max",
                text="Max",
                description="Fan at full speed",
                on_tap=Set(HVAC.FAN_SPEED, HVAC.FAN_SPEED.high),
            ),
            heading(Rect(inner.x, inner.y + 94, inner.width, 28), "Air to"),
            choices(
                inner.bottom_part(76),
                "hvac.air",
                [
                    (key, text, icon, flow == value, Set(HVAC.AIR_DISTRIBUTION, value))
                    for key, text, icon, value in ways
                ],
            ),
        ),
    )


def _switches(rect: Rect, state: State) -> tuple[Widget, ...]:
    signals = state.signals
    upper, lower = rect.rows(2, 12)
    cells = (*upper.columns(4, 12), *lower.columns(4, 12))
    known = (
        ("hvac.air_conditioning", "A/C", Icon.SNOWFLAKE, HVAC.AIR_CONDITIONING),
        ("hvac.auto", "Auto", Icon.AUTO, HVAC.AUTO),
        ("hvac.recirculation", "Recirculate", Icon.RECIRCULATION, HVAC.RECIRCULATION),
        ("hvac.max_cooling", "Max A/C", Icon.SNOWFLAKE, HVAC.MAX_COOLING),
        ("hvac.front_defroster", "Front defrost", Icon.DEFROST_FRONT, HVAC.FRONT_DEFROSTER),
        ("hvac.rear_defroster", "Rear defrost", Icon.DEFROST_REAR, HVAC.REAR_DEFROSTER),
        ("hvac.max_defrost", "Max defrost", Icon.DEFROST_FRONT, HVAC.MAX_DEFROST),
        ("hvac.purifier", "Purifier", Icon.PURIFIER, HVAC.PURIFIER),
    )
    return tuple(
        switch(cell, key, name, icon, signal, signals)
        for cell, (key, name, icon, signal) in zip(cells, known, strict=True)
    )


def _cabin(rect: Rect, state: State) -> tuple[Widget, ...]:
    signals = state.signals
    return (
        Label(
            rect=rect.top(32),
            key="hvac.cabin_temperature",
            text=f"Cabin {temperature(signals, signals[HVAC.CABIN_TEMPERATURE])}",
            style=Type.LABEL,
        ),
        Label(
            rect=rect.bottom_part(30),
            key="hvac.cabin_humidity",
            text=f"Humidity {signals[HVAC.CABIN_HUMIDITY]:.0f} %",
            style=Type.CAPTION,
            tone="muted",
        ),
    )


def _glass(rect: Rect, state: State) -> Widget:
    """The visibility through the windows."""
    signals = state.signals
    inner = rect.inset(20, 10)
    halves = inner.left(344).columns(2, 20)
    panes = (
        ("windshield", "Windshield", signals[GLASS.WINDSHIELD_FOG], signals[GLASS.WINDSHIELD_FILM]),
        ("rear_window", "Rear window", signals[GLASS.REAR_FOG], signals[GLASS.REAR_FILM]),
    )
    children: list[Widget] = []
    for half, (key, name, fog, film) in zip(halves, panes, strict=True):
        clear = round((1 - fog) * (1 - film) * 100)
        children += [
            Label(
                rect=Rect(half.x, half.y, half.width, half.height - 20),
                key=f"glass.{key}",
                text=f"{name} {glass_words(fog, film)}",
                style=Type.LABEL,
                lines=2,
            ),
            Bar(
                rect=Rect(half.x, half.bottom - 12, half.width, 8),
                share=clear / 100,
                tone="good" if clear > 70 else "warning",
            ),
        ]
    more = Button(
        rect=inner.right_part(112),
        key="hvac.comfort",
        text="More",
        description="Rear seats and schedule",
        icon=Icon.CLOCK,
        on_tap=Show("comfort"),
    )
    cabin = Rect(inner.x + 364, inner.y, inner.width - 364 - 124, inner.height)
    return Card(rect=rect, children=(*children, *_cabin(cabin, state), more))


def glass_words(fog: float, film: float) -> str:
    """How clear a pane is: fog inside, film outside, each 0 to 1."""
    if fog < 0.05 and film < 0.05:
        return "clear"
    if fog >= film:
        return f"fogged inside {fog * 100:.0f} %"
    return f"wet outside {film * 100:.0f} %"


def comfort(state: State) -> tuple[Widget, ...]:
    """Rear seats and the climate schedule."""
    left, right = CONTENT.columns(2, GAP)
    return _rear(left, state), _schedule(right, state)


def _rear(rect: Rect, state: State) -> Widget:
    signals = state.signals
    inner = rect.inset(28, 24)
    tiles = Rect(inner.x, inner.y + 60, inner.width, 120).columns(2, 16)
    return Card(
        rect=rect,
        children=(
            title(inner.top(40), Icon.SEAT_HEATER, "Rear seats"),
            levels(
                tiles[0],
                "hvac.rear_left_seat_heating",
                "Left",
                Icon.SEAT_HEATER,
                SEAT.REAR_LEFT_HEATING,
                signals,
                SEAT_LEVELS,
            ),
            levels(
                tiles[1],
                "hvac.rear_right_seat_heating",
                "Right",
                Icon.SEAT_HEATER,
                SEAT.REAR_RIGHT_HEATING,
                signals,
                SEAT_LEVELS,
            ),
            title(Rect(inner.x, inner.y + 220, inner.width, 40), Icon.AIR_QUALITY, "Cabin air"),
            *fact(
                Rect(inner.x, inner.y + 276, inner.width, 36),
                "comfort.temperature",
                "Temperature",
                temperature(signals, signals[HVAC.CABIN_TEMPERATURE]),
            ),
            *fact(
                Rect(inner.x, inner.y + 320, inner.width, 36),
                "comfort.humidity",
                "Humidity",
                f"{signals[HVAC.CABIN_HUMIDITY]:.0f} %",
            ),
            *fact(
                Rect(inner.x, inner.y + 364, inner.width, 36),
                "comfort.air",
                "Air comes from",
                "Inside" if signals[HVAC.RECIRCULATION] else "Outside",
            ),
            *fact(
                Rect(inner.x, inner.y + 408, inner.width, 36),
                "comfort.purifier",
                "Purifier",
                "On" if signals[HVAC.PURIFIER] else "Off",
            ),
            *fact(
                Rect(inner.x, inner.y + 452, inner.width, 36),
                "comfort.fine_dust",
                "Fine dust",
                f"{signals[HVAC.CABIN_FINE_DUST]:.0f} µg/m³",
            ),
        ),
    )


def _schedule(rect: Rect, state: State) -> Widget:
    inner = rect.inset(28, 24)
    timer = state.desk.climate_at
    on = timer.on
    return Card(
        rect=rect,
        children=(
            title(inner.top(40), Icon.CLOCK, "Schedule"),
            Tile(
                rect=Rect(inner.x, inner.y + 60, inner.width, 68),
                key="climate.schedule",
                text="Prepare the cabin",
                icon=Icon.CLIMATE,
                checked=on,
                on_tap=Put(
                    "desk",
                    replace(state.desk, climate_at=replace(timer, on=not on)),
                    "The schedule is off" if on else f"The cabin is prepared for {timer.shown}",
                ),
            ),
            *time_setter(
                Rect(inner.x, inner.y + 156, inner.width, 72),
                "climate.schedule",
                timer,
                lambda moved: Put("desk", replace(state.desk, climate_at=moved), f"The time is {moved.shown}"),
            ),
            Label(
                rect=Rect(inner.x, inner.y + 252, inner.width, 64),
                key="climate.schedule.about",
                text="At this time the climate control starts by itself and holds the temperature that is set.",
                style=Type.CAPTION,
                tone="muted",
                lines=3,
            ),
        ),
    )
