"""Charging: the battery, its charge limit and schedule, and stations nearby."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.map.screens import destination
from automotive_cosim.cockpit.apps.map.way import nearest
from automotive_cosim.cockpit.cards import content, heading, rows, schedule, slider, switch, title
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.flow import card, fill, line, panels, stack
from automotive_cosim.cockpit.functions import CLOCK, CallMade, minute_of, offered
from automotive_cosim.cockpit.pois import Gazetteer, PoiKind
from automotive_cosim.cockpit.signals import ENERGY
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.timer import AT_SEVEN, Timer
from automotive_cosim.cockpit.values import distance
from automotive_cosim.cockpit.widgets import Bar, Label, Widget
from automotive_cosim.contracts import Feedback
from automotive_cosim.contracts.text import say


@dataclass(frozen=True, slots=True)
class _ChargingSchedule(AppData):
    """The time by which the battery is charged."""

    timer: Timer = AT_SEVEN

    def commands(self) -> dict[str, Any]:
        return {"charging.schedule": self.timer.shown if self.timer.on else ""}


def charging(state: State) -> tuple[Widget, ...]:
    """The battery, its charge limit and schedule, and stations nearby."""
    signals, timer = state.signals, state.of(_ChargingSchedule).timer
    level, cable = signals[ENERGY.LEVEL], say("cable in") if signals[ENERGY.CABLE] else say("no cable")
    far = say("{first}, {second}", first=distance(signals, signals[ENERGY.RANGE]), second=cable)
    charge = Label(key="charging.level", text=f"{level:.0f} %", description=say("Battery"), style=Type.HEADLINE)
    reach = Label(
        key="charging.range",
        text=far,
        description=say("Range and cable"),
        tone="muted",
        style=Type.LABEL,
        align="right",
    )
    ready, time = schedule(
        "charging.schedule",
        say("Ready at a set time"),
        Icon.CLOCK,
        timer,
        _ChargingSchedule,
        say("Charged by {shown}", shown=timer.shown),
        say("Charging starts immediately"),
    )
    battery = card(
        title(Icon.CHARGING, say("Charging")),
        8,
        (44, line((150, charge), 10, reach)),
        8,
        (12, Bar(share=round(level / 100, 2), tone="good" if level > 15 else "warning")),
        14,
        slider(ENERGY.CHARGE_LIMIT, state),
        16,
        switch(ENERGY.CHARGE_FLAP, state),
        12,
        ready,
        16,
        (72, time),
        padding=(28, 20),
    )
    stations = rows(
        "charging.stations",
        say("Charging stations"),
        state,
        nearest(state, state.of(Gazetteer).of(PoiKind.CHARGING)),
        lambda index, each: replace(destination(f"charging.station.{index}", each.name, state), detail=each.detail),
    )
    return fill(content(state), panels(battery, stack((32, heading(say("Stations nearby"))), 12, stations)))


@offered
def schedule_charging(
    state: State, on: Annotated[bool, "Whether the schedule is on."], time: Annotated[str, CLOCK] = ""
) -> CallMade:
    """Have the battery charged by a time of day, or charge at once."""
    timer = state.of(_ChargingSchedule).timer
    minute = minute_of(time) if time else timer.minute
    return (
        minute if isinstance(minute, Feedback) else Put(_ChargingSchedule(replace(timer, on=on, minute=minute)), "")
    )


APP = App(
    name="charging",
    title=say("Charging"),
    icon=Icon.CHARGING,
    order=11,
    where=Where.STORE,
    about=say("Charge limit, times and stations nearby"),
    functions=(schedule_charging,),
    pages={"charging": AppPage(charging)},
    starts=lambda state, rng: (_ChargingSchedule(),),
)
