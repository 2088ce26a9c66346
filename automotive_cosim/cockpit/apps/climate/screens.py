"""Climate: both seats, fan and air, glass, and the cabin's air quality."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.climate.state import ClimateSchedule
from automotive_cosim.cockpit.commands import Put, Set
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, panes, row
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.parts import (
    choices,
    content,
    fact,
    grouped,
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
from automotive_cosim.contracts.text import Text, say

SEAT_LEVELS = ((0.0, say("Off")), (50.0, say("Low")), (100.0, say("High")))
AIRING_LEVELS = ((0.0, say("Off")), (-50.0, say("Low")), (-100.0, say("High")))
_SET = {"driver": say("Driver's temperature"), "passenger": say("Passenger's temperature")}
"""Names of what is set, by the seat."""
WHEEL_LEVELS = ((0.0, say("Off")), (100.0, say("On")))


def climate(state: State) -> tuple[Widget, ...]:
    """The climate screen."""
    driver, middle, passenger = _three(content(state))
    if state.roads.network.left_hand:
        driver, passenger = passenger, driver
    air, _, switches, _, glass = column(middle, 240, GAP, 188, GAP, REST)
    return (
        _zone(driver, "driver", say("Driver"), HVAC.DRIVER_TEMPERATURE, SEAT.DRIVER_HEATING, state),
        _zone(passenger, "passenger", say("Passenger"), HVAC.PASSENGER_TEMPERATURE, SEAT.PASSENGER_HEATING, state),
        _air(air, state),
        *_switches(switches, state),
        _glass(glass, state),
    )


def _three(rect: Rect) -> tuple[Rect, Rect, Rect]:
    """The seats on either side of what both share; where it is taller than wide, over it."""
    if rect.height > rect.width:
        seats, middle = panes(rect, REST, REST)
        driver, passenger = seats.columns(2, GAP)
        return driver, middle, passenger
    driver, middle, passenger = panes(rect, 264, REST, 264)
    return driver, middle, passenger


def _zone(rect: Rect, who: str, name: str, warmth: Signal[float], seat: Signal[float], state: State) -> Widget:
    signals = state.signals
    head, _, shown, _, steps, _, seats = column(rect.inset(20, 16), 30, 6, 88, 12, 64, REST, 260)
    tiles = seats.rows(3, 10)
    third = (
        levels(
            tiles[2],
            "hvac.steering_wheel_heating",
            say("Steering wheel heat"),
            Icon.STEERING,
            SEAT.STEERING_WHEEL_HEATING,
            signals,
            WHEEL_LEVELS,
        )
        if who == "driver"
        else switch(tiles[2], "hvac.sync", say("Sync"), Icon.SYNC, HVAC.SYNC, signals)
    )
    return Card(
        rect=rect,
        children=(
            heading(head, name),
            Label(
                rect=shown,
                key=f"hvac.{who}_temperature",
                text=temperature(signals, signals[warmth]),
                description=_SET[who],
                style=Type.DISPLAY,
                align="centre",
            ),
            *_plus_minus(steps, who, warmth, state),
            grouped(
                levels(
                    tiles[0],
                    f"hvac.{who}_seat_heating",
                    say("Seat heat"),
                    Icon.SEAT_HEATER,
                    seat,
                    signals,
                    SEAT_LEVELS,
                ),
                name,
            ),
            grouped(
                levels(
                    tiles[1],
                    f"hvac.{who}_seat_airing",
                    say("Seat ventilation"),
                    Icon.SEAT_COOLER,
                    seat,
                    signals,
                    AIRING_LEVELS,
                ),
                name,
            ),
            third,
        ),
    )


def _plus_minus(rect: Rect, who: str, warmth: Signal[float], state: State) -> tuple[Widget, ...]:
    less, _, more = stepper(rect, f"hvac.{who}_temperature", _SET[who], warmth, state.signals, str)
    return less, more


def _air(rect: Rect, state: State) -> Widget:
    signals = state.signals
    blower, _, name, _, ways_to = column(rect.inset(20, 16), 84, 10, 28, REST, 76)
    fan, _, fastest = row(blower, REST, 20, 88)
    flow = signals[HVAC.AIR_DISTRIBUTION]
    ways = (
        ("up", say("Windshield"), Icon.AIR_UP, "UP"),
        ("middle", say("Face"), Icon.AIR_MIDDLE, "MIDDLE"),
        ("down", say("Feet"), Icon.AIR_DOWN, "DOWN"),
    )
    return Card(
        rect=rect,
        children=(
            slider(fan, "hvac.fan", say("Fan speed"), Icon.CLIMATE, HVAC.FAN_SPEED, signals),
            Button(
                rect=fastest.middle(88, 64),
                key="hvac.fan.max",
                text=say("Max"),
                description=say("Fan at full speed"),
                on_tap=Set(HVAC.FAN_SPEED, HVAC.FAN_SPEED.high),
            ),
            heading(name, say("Airflow")),
            choices(
                ways_to,
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
        ("hvac.air_conditioning", say("A/C"), Icon.SNOWFLAKE, HVAC.AIR_CONDITIONING),
        ("hvac.auto", say("Auto"), Icon.AUTO, HVAC.AUTO),
        ("hvac.recirculation", say("Recirculate"), Icon.RECIRCULATION, HVAC.RECIRCULATION),
        ("hvac.max_cooling", say("Max A/C"), Icon.SNOWFLAKE, HVAC.MAX_COOLING),
        ("hvac.front_defroster", say("Front defrost"), Icon.DEFROST_FRONT, HVAC.FRONT_DEFROSTER),
        ("hvac.rear_defroster", say("Rear defrost"), Icon.DEFROST_REAR, HVAC.REAR_DEFROSTER),
        ("hvac.max_defrost", say("Max defrost"), Icon.DEFROST_FRONT, HVAC.MAX_DEFROST),
        ("hvac.purifier", say("Purifier"), Icon.PURIFIER, HVAC.PURIFIER),
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
            text=say("Cabin {temperature}", temperature=temperature(signals, signals[HVAC.CABIN_TEMPERATURE])),
            style=Type.LABEL,
        ),
        Label(
            rect=rect.bottom_part(30),
            key="hvac.cabin_humidity",
            text=say("Humidity {humidity} %", humidity=f"{signals[HVAC.CABIN_HUMIDITY]:.0f}"),
            style=Type.CAPTION,
            tone="muted",
        ),
    )


def _glass(rect: Rect, state: State) -> Widget:
    """The visibility through the windows."""
    signals = state.signals
    glazing, _, cabin, _, beside = row(rect.inset(20, 10), 344, 20, REST, 12, 112)
    panes = (
        ("windshield", say("Windshield"), signals[GLASS.WINDSHIELD_FOG], signals[GLASS.WINDSHIELD_FILM]),
        ("rear_window", say("Rear window"), signals[GLASS.REAR_FOG], signals[GLASS.REAR_FILM]),
    )
    children: list[Widget] = []
    for half, (key, name, fog, film) in zip(glazing.columns(2, 20), panes, strict=True):
        words, _, bar, _ = column(half, REST, 8, 8, 4)
        clear = round((1 - fog) * (1 - film) * 100)
        children += [
            Label(
                rect=words,
                key=f"glass.{key}",
                text=say("{pane} {state}", pane=name, state=glass_words(fog, film)[1]),
                style=Type.LABEL,
                lines=2,
            ),
            Bar(
                rect=bar,
                share=clear / 100,
                tone="good" if clear > 70 else "warning",
            ),
        ]
    more = Button(
        rect=beside,
        key="hvac.comfort",
        text=say("More"),
        description=say("Rear seats and schedule"),
        icon=Icon.CLOCK,
        on_tap=Show("comfort"),
    )
    return Card(rect=rect, children=(*children, *_cabin(cabin, state), more))


def glass_words(fog: float, film: float) -> tuple[Text, Text]:
    """How clear a pane is, by itself and after its name: fog inside, film outside, each 0 to 1."""
    if fog < 0.05 and film < 0.05:
        return say("Clear"), say("clear")
    share = f"{max(fog, film) * 100:.0f}"
    if fog >= film:
        return say("Fogged inside {share} %", share=share), say("fogged inside {share} %", share=share)
    return say("Wet outside {share} %", share=share), say("wet outside {share} %", share=share)


def comfort(state: State) -> tuple[Widget, ...]:
    """Rear seats and the climate schedule."""
    left, right = panes(content(state), REST, REST)
    return _rear(left, state), _schedule(right, state)


def _rear(rect: Rect, state: State) -> Widget:
    signals = state.signals
    head, _, seats, _, air, _, facts = column(rect.inset(28, 24), 40, 20, 120, 32, 48, 16, 212)
    tiles = seats.columns(2, 16)
    known = (
        ("temperature", say("Temperature"), temperature(signals, signals[HVAC.CABIN_TEMPERATURE])),
        ("humidity", say("Humidity"), f"{signals[HVAC.CABIN_HUMIDITY]:.0f} %"),
        ("air", say("Air intake"), say("Inside") if signals[HVAC.RECIRCULATION] else say("Outside")),
        ("purifier", say("Purifier"), say("On") if signals[HVAC.PURIFIER] else say("Off")),
        ("fine_dust", say("Fine particles"), f"{signals[HVAC.CABIN_FINE_DUST]:.0f} µg/m³"),
    )
    return Card(
        rect=rect,
        children=(
            title(head, Icon.SEAT_HEATER, say("Rear seats")),
            replace(
                levels(
                    tiles[0],
                    "hvac.rear_left_seat_heating",
                    say("Left"),
                    Icon.SEAT_HEATER,
                    SEAT.REAR_LEFT_HEATING,
                    signals,
                    SEAT_LEVELS,
                ),
                description=say("{name}: {value}", name=say("Rear left"), value=say("Seat heat")),
            ),
            replace(
                levels(
                    tiles[1],
                    "hvac.rear_right_seat_heating",
                    say("Right"),
                    Icon.SEAT_HEATER,
                    SEAT.REAR_RIGHT_HEATING,
                    signals,
                    SEAT_LEVELS,
                ),
                description=say("{name}: {value}", name=say("Rear right"), value=say("Seat heat")),
            ),
            title(air.left(air.width - 180), Icon.AIR_QUALITY, say("Cabin air")),
            Button(
                rect=air.right_part(160),
                key="comfort.cabin",
                text=say("Cabin"),
                description=say("Who is aboard, and keep climate on"),
                on_tap=Show("cabin"),
            ),
            *(
                widget
                for line, (key, name, value) in zip(facts.rows(5, 8), known, strict=True)
                for widget in fact(line, f"comfort.{key}", name, value)
            ),
        ),
    )


def _schedule(rect: Rect, state: State) -> Widget:
    head, _, prepare, _, time, _, about = column(rect.inset(28, 24), 40, 20, 68, 28, 72, 24, 64)
    timer = state.of(ClimateSchedule).timer
    on = timer.on
    return Card(
        rect=rect,
        children=(
            title(head, Icon.CLOCK, say("Schedule")),
            Tile(
                rect=prepare,
                key="climate.schedule",
                text=say("Precondition the cabin"),
                icon=Icon.CLIMATE,
                checked=on,
                on_tap=Put(
                    ClimateSchedule(replace(timer, on=not on)),
                    say("The schedule is off")
                    if on
                    else say("The cabin will be ready at {time}", time=timer.shown),
                ),
            ),
            *time_setter(
                time,
                "climate.schedule",
                timer,
                lambda moved: Put(ClimateSchedule(moved), say("The time is {time}", time=moved.shown)),
            ),
            Label(
                rect=about,
                key="climate.schedule.about",
                text=say("The climate control starts half an hour before, and the cabin is ready at this time."),
                style=Type.CAPTION,
                tone="muted",
                lines=3,
            ),
        ),
    )
