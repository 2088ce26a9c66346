"""Charging: the battery, its charge limit and schedule, and stations nearby."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.map.screens import destination
from automotive_cosim.cockpit.apps.map.way import nearest
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.functions import CLOCK, CallMade, minute_of, offered
from automotive_cosim.cockpit.layout import REST, column, panes, row
from automotive_cosim.cockpit.parts import content, distance, heading, rows, slider, switch, time_setter, title
from automotive_cosim.cockpit.places import Gazetteer, PlaceKind
from automotive_cosim.cockpit.signals import ENERGY
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.timer import AT_SEVEN, Timer
from automotive_cosim.cockpit.widgets import Bar, Card, Label, Tile, Widget
from automotive_cosim.contracts import Feedback
from automotive_cosim.contracts.text import say


@dataclass(frozen=True, slots=True)
class ChargingSchedule(AppData):
    """The time by which the battery is charged."""

    timer: Timer = AT_SEVEN

    def commands(self) -> dict[str, Any]:
        """The time; empty without."""
        return {"charging.schedule": self.timer.shown if self.timer.on else ""}


def charging(state: State) -> tuple[Widget, ...]:
    """The battery, its charge limit and schedule, and stations nearby."""
    signals = state.signals
    left, right = panes(content(state), REST, REST)
    head, _, upper, _, bar, _, limit, _, flap, _, ready, _, time = column(
        left.inset(28, 20), 40, 8, 44, 8, 12, 14, 84, 16, 60, 12, 60, 16, 72
    )
    charge, _, reach = row(upper, 150, 10, REST)
    level, cable = signals[ENERGY.LEVEL], say("cable in") if signals[ENERGY.CABLE] else say("no cable")
    stations = nearest(state, state.of(Gazetteer).of(PlaceKind.CHARGING))
    timer = state.of(ChargingSchedule).timer
    return (
        Card(
            rect=left,
            children=(
                title(head, Icon.CHARGING, say("Charging")),
                Label(
                    rect=charge,
                    key="charging.level",
                    text=f"{level:.0f} %",
                    description=say("Battery"),
                    style=Type.HEADLINE,
                ),
                Label(
                    rect=reach,
                    key="charging.range",
                    text=say("{first}, {second}", first=distance(signals, signals[ENERGY.RANGE]), second=cable),
                    description=say("Range and cable"),
                    tone="muted",
                    style=Type.LABEL,
                    align="right",
                ),
                Bar(
                    rect=bar,
                    share=round(level / 100, 2),
                    tone="good" if level > 15 else "warning",
                ),
                slider(
                    limit,
                    "charging.limit",
                    say("Charge to"),
                    Icon.BATTERY,
                    ENERGY.CHARGE_LIMIT,
                    signals,
                ),
                switch(
                    flap,
                    "charging.flap",
                    say("Charging flap open"),
                    Icon.FLAP,
                    ENERGY.CHARGE_FLAP,
                    signals,
                    state.vehicle.held(ENERGY.CHARGE_FLAP),
                ),
                Tile(
                    rect=ready,
                    key="charging.schedule",
                    text=say("Ready at a set time"),
                    icon=Icon.CLOCK,
                    checked=timer.on,
                    on_tap=Put(
                        ChargingSchedule(replace(timer, on=not timer.on)),
                        say("Charging starts immediately")
                        if timer.on
                        else say("Charged by {shown}", shown=timer.shown),
                    ),
                ),
                *time_setter(
                    time,
                    "charging.schedule",
                    timer,
                    lambda moved: Put(ChargingSchedule(moved), say("The time is {time}", time=moved.shown)),
                ),
            ),
        ),
        heading(right.top(32), say("Stations nearby")),
        rows(
            right.below(44),
            "charging.stations",
            say("Charging stations"),
            state,
            len(stations),
            lambda index, cell: replace(
                destination(cell, f"charging.station.{index}", stations[index].name, state),
                detail=stations[index].detail,
            ),
            height=64,
        ),
    )


@offered
def schedule_charging(
    state: State, on: Annotated[bool, "Whether the schedule is on."], time: Annotated[str, CLOCK] = ""
) -> CallMade:
    """Have the battery charged by a time of day, or charge at once."""
    timer = state.of(ChargingSchedule).timer
    minute = minute_of(time) if time else timer.minute
    return (
        minute if isinstance(minute, Feedback) else Put(ChargingSchedule(replace(timer, on=on, minute=minute)), "")
    )


FUNCTIONS = (schedule_charging,)


APP = App(
    name="charging",
    title=say("Charging"),
    icon=Icon.CHARGING,
    order=11,
    where=Where.STORE,
    about=say("Charge limit, times and stations nearby"),
    functions=FUNCTIONS,
    pages={"charging": AppPage(charging)},
    starts=lambda state, rng: (ChargingSchedule(),),
)
