"""Climate: both seats, fan and air, glass, the cabin's air quality, and a schedule."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import datetime
from typing import Annotated, Any

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.cards import (
    SMALL,
    about,
    choice,
    content,
    fact,
    heading,
    levels,
    schedule,
    slider,
    stepper,
    switch,
    title,
)
from automotive_cosim.cockpit.commands import Put, Set
from automotive_cosim.cockpit.controls import CONTROLS, shown
from automotive_cosim.cockpit.flow import Block, at, card, fill, grid, line, panels, stack
from automotive_cosim.cockpit.functions import CLOCK, CallMade, minute_of, offered
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, panes
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.signals import GLASS, HVAC, SEAT, Signal
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.timer import AT_SEVEN, Timer
from automotive_cosim.cockpit.values import temperature
from automotive_cosim.cockpit.widgets import Bar, Button, Label, Tile, Widget
from automotive_cosim.contracts import Feedback, Surroundings
from automotive_cosim.contracts.text import Text, say

PREPARING_MIN = 30
"""How long before the set time the climate control starts: heating and cooling take some twenty minutes."""


@dataclass(frozen=True, slots=True)
class _ClimateSchedule(AppData):
    """The time at which the cabin is ready."""

    timer: Timer = AT_SEVEN

    def commands(self) -> dict[str, Any]:
        return {"climate.schedule": self.timer.shown if self.timer.on else ""}

    def passed(self, state: State, before: Surroundings | None, dt_s: float) -> None:
        """Starts the climate control ahead of the set time, at which the cabin is ready."""
        if not self.timer.on or before is None or state.outside is None:
            return
        starts = self.timer.moved(-PREPARING_MIN).minute
        if _minute(before.local_time) < starts <= _minute(state.outside.local_time):
            state.vehicle.command(HVAC.AUTO, True)
            state.notify(say("The cabin is being preconditioned for {time}", time=self.timer.shown), Icon.CLIMATE)


def _minute(time: datetime) -> float:
    """Minute of the day."""
    return time.hour * 60 + time.minute + time.second / 60


SEAT_LEVELS = ((0.0, say("Off")), (50.0, say("Low")), (100.0, say("High")))
AIRING_LEVELS = ((0.0, say("Off")), (-50.0, say("Low")), (-100.0, say("High")))
WHEEL_LEVELS = ((0.0, say("Off")), (100.0, say("On")))


def climate(state: State) -> tuple[Widget, ...]:
    """The climate screen."""
    driver, middle, passenger = _three(content(state))
    if state.roads.network.left_hand:
        driver, passenger = passenger, driver
    wheel = levels(SEAT.STEERING_WHEEL_HEATING, state, WHEEL_LEVELS)
    sync = switch(HVAC.SYNC, state)
    beside = _zone("passenger", say("Passenger"), HVAC.PASSENGER_TEMPERATURE, SEAT.PASSENGER_HEATING, sync, state)
    return (
        *fill(driver, _zone("driver", say("Driver"), HVAC.DRIVER_TEMPERATURE, SEAT.DRIVER_HEATING, wheel, state)),
        *fill(passenger, beside),
        *fill(middle, stack((240, _air(state)), GAP, (188, _switches(state)), GAP, (REST, _glass(state)))),
    )


def _three(rect: Rect) -> tuple[Rect, Rect, Rect]:
    """The seats on either side of what both share; where it is taller than wide, over it."""
    if rect.height > rect.width:
        seats, middle = panes(rect, REST, REST)
        driver, passenger = seats.columns(2, GAP)
        return driver, middle, passenger
    driver, middle, passenger = panes(rect, 264, REST, 264)
    return driver, middle, passenger


def _zone(who: str, name: str, warmth: Signal[float], seat: Signal[float], third: Tile, state: State) -> Block:
    control = CONTROLS[warmth]
    value = Label(
        key=control.key,
        text=shown(warmth, state.signals),
        description=control.name,
        style=Type.DISPLAY,
        align="centre",
    )
    steps = stepper(warmth, state.signals, bare=True)
    tiles = grid(
        1,
        10,
        levels(seat, state, SEAT_LEVELS, group=name),
        levels(
            seat,
            state,
            AIRING_LEVELS,
            key=f"hvac.{who}_seat_airing",
            name=say("Seat ventilation"),
            icon=Icon.SEAT_COOLER,
            group=name,
        ),
        third,
    )
    return card((30, heading(name)), 6, (88, value), 12, steps, REST, (260, tiles), padding=SMALL)


def _air(state: State) -> Block:
    fastest = Button(
        key="hvac.fan.max",
        text=say("Max"),
        description=say("Fan at full speed"),
        on_tap=Set(HVAC.FAN_SPEED, HVAC.FAN_SPEED.high),
    )
    return card(
        (84, line(slider(HVAC.FAN_SPEED, state), 20, (88, at(lambda box: box.middle(88, 64), fastest)))),
        10,
        heading(say("Airflow")),
        REST,
        (76, choice(HVAC.AIR_DISTRIBUTION, state)),
        padding=SMALL,
    )


def _switches(state: State) -> Block:
    known = (
        HVAC.AIR_CONDITIONING,
        HVAC.AUTO,
        HVAC.RECIRCULATION,
        HVAC.MAX_COOLING,
        HVAC.FRONT_DEFROSTER,
        HVAC.REAR_DEFROSTER,
        HVAC.MAX_DEFROST,
        HVAC.PURIFIER,
    )
    return grid(4, 12, *(switch(signal, state) for signal in known))


def _glass(state: State) -> Block:
    """The visibility through the windows, and the air in the cabin."""
    signals = state.signals
    glasses = (
        ("windshield", say("Windshield"), signals[GLASS.WINDSHIELD_FOG], signals[GLASS.WINDSHIELD_FILM]),
        ("rear_window", say("Rear window"), signals[GLASS.REAR_FOG], signals[GLASS.REAR_FILM]),
    )
    glazing = []
    for key, name, fog, film in glasses:
        text = say("{pane} {state}", pane=name, state=glass_words(fog, film)[1])
        clear = round((1 - fog) * (1 - film) * 100)
        words = Label(key=f"glass.{key}", text=text, style=Type.LABEL, lines=2)
        bar = Bar(share=clear / 100, tone="good" if clear > 70 else "warning")
        glazing.append(stack((REST, words), 8, (8, bar), 4))
    warmth = say("Cabin {temperature}", temperature=temperature(signals, signals[HVAC.CABIN_TEMPERATURE]))
    humidity = say("Humidity {humidity} %", humidity=f"{signals[HVAC.CABIN_HUMIDITY]:.0f}")
    cabin = stack(
        (32, Label(key="hvac.cabin_temperature", text=warmth, style=Type.LABEL)),
        REST,
        (30, about("hvac.cabin_humidity", humidity, 1)),
    )
    more = Button(
        key="hvac.comfort",
        text=say("More"),
        description=say("Rear seats and schedule"),
        icon=Icon.CLOCK,
        on_tap=Show("comfort"),
    )
    return card((REST, line((344, grid(2, 20, *glazing)), 20, cabin, 12, (112, more))), padding=(20, 10))


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
    return fill(content(state), panels(_rear(state), _schedule(state)))


def _rear(state: State) -> Block:
    signals = state.signals
    seats = (
        levels(signal, state, SEAT_LEVELS, told=say("{name}: {value}", name=name, value=say("Seat heat")))
        for signal, name in (
            (SEAT.REAR_LEFT_HEATING, say("Rear left")),
            (SEAT.REAR_RIGHT_HEATING, say("Rear right")),
        )
    )
    facts = (
        ("temperature", say("Temperature"), temperature(signals, signals[HVAC.CABIN_TEMPERATURE])),
        ("humidity", say("Humidity"), f"{signals[HVAC.CABIN_HUMIDITY]:.0f} %"),
        ("air", say("Air intake"), say("Inside") if signals[HVAC.RECIRCULATION] else say("Outside")),
        ("purifier", say("Purifier"), say("On") if signals[HVAC.PURIFIER] else say("Off")),
        ("fine_dust", say("Fine particles"), f"{signals[HVAC.CABIN_FINE_DUST]:.0f} µg/m³"),
    )
    cabin = Button(
        key="comfort.cabin",
        text=say("Cabin"),
        description=say("Who is aboard, and keep climate on"),
        on_tap=Show("cabin"),
    )
    return card(
        title(Icon.SEAT_HEATER, say("Rear seats")),
        20,
        (120, grid(2, 16, *seats)),
        32,
        (48, line(title(Icon.AIR_QUALITY, say("Cabin air")), 20, (160, cabin))),
        16,
        (212, grid(1, 8, *(fact(f"comfort.{key}", name, value) for key, name, value in facts))),
    )


def _schedule(state: State) -> Block:
    timer = state.of(_ClimateSchedule).timer
    prepare, time = schedule(
        "climate.schedule",
        say("Precondition the cabin"),
        Icon.CLIMATE,
        timer,
        _ClimateSchedule,
        say("The cabin will be ready at {time}", time=timer.shown),
        say("The schedule is off"),
    )
    words = say("The climate control starts half an hour before, and the cabin is ready at this time.")

    return card(
        title(Icon.CLOCK, say("Schedule")),
        20,
        (68, prepare),
        28,
        (72, time),
        24,
        (64, about("climate.schedule.about", words, 3)),
    )


@offered
def schedule_climate(
    state: State, on: Annotated[bool, "Whether the schedule is on."], time: Annotated[str, CLOCK] = ""
) -> CallMade:
    """Have the cabin prepared for a time of day, or not."""
    timer = state.of(_ClimateSchedule).timer
    minute = minute_of(time) if time else timer.minute
    return (
        minute if isinstance(minute, Feedback) else Put(_ClimateSchedule(replace(timer, on=on, minute=minute)), "")
    )


APP = App(
    name="climate",
    title=say("Climate"),
    icon=Icon.CLIMATE,
    order=3,
    where=Where.DOCK,
    functions=(schedule_climate,),
    pages={"climate": AppPage(climate, sided=True), "comfort": AppPage(comfort)},
    aliases={"hvac": ""},
    starts=lambda state, rng: (_ClimateSchedule(),),
)
