"""The timer: its length, the time that is left, and the button that starts and stops it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any

from annotated_types import Ge, Le, MultipleOf

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.cards import HELD_STEPS, choices, content, heading, title
from automotive_cosim.cockpit.commands import Put, SimpleCommand
from automotive_cosim.cockpit.flow import card, fill, line
from automotive_cosim.cockpit.functions import CallMade, offered
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.room import Room
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.values import minutes
from automotive_cosim.cockpit.widgets import Bar, Button, Label, Look, Widget
from automotive_cosim.contracts import Feedback, Severity, Surroundings
from automotive_cosim.contracts.text import say

STEP_MIN, MOST_MIN = 5, 240


@dataclass(frozen=True, slots=True)
class _Countdown(AppData):
    """The length that is set, and the countdown that runs."""

    minutes: int = 15
    begun_s: float | None = None
    """Simulation time at which it began; None while none runs."""

    def longer(self, by_min: int) -> _Countdown:
        """Longer, or shorter, within the bounds; one that runs ends later, or earlier."""
        return replace(self, minutes=min(MOST_MIN, max(STEP_MIN, self.minutes + by_min)))

    def left_s(self, time_s: float) -> float:
        """Seconds until it ends."""
        passed_s = 0.0 if self.begun_s is None else time_s - self.begun_s
        return max(0.0, 60 * self.minutes - passed_s)

    def commands(self) -> dict[str, Any]:
        """The length, and whether it runs."""
        return {"timer.minutes": self.minutes, "timer.running": self.begun_s is not None}

    def passed(self, state: State, before: Surroundings | None, dt_s: float) -> None:
        """Tells the driver when it is over."""
        if self.begun_s is not None and self.left_s(state.time_s) <= 0:
            state.keep(replace(self, begun_s=None))
            words = say("{minutes} minutes are up", minutes=self.minutes)
            state.notify(words, Icon.CLOCK, Severity.WARNING, opens=("timer", ""))


def _start_timer(state: State) -> Feedback:
    """Count down from the length that is set."""
    now = state.of(_Countdown)
    return state.change(
        replace(now, begun_s=state.time_s), say("the timer runs for {minutes} minutes", minutes=now.minutes)
    )


START_TIMER = SimpleCommand(_start_timer, ("timer.running",))


def _stop_timer(state: State) -> Feedback:
    """Stop the countdown."""
    return state.change(replace(state.of(_Countdown), begun_s=None), say("The timer is stopped"))


STOP_TIMER = SimpleCommand(_stop_timer, ("timer.running",))


LENGTHS_MIN = (5, 10, 15, 20, 30, 60, 120)


def timer(state: State) -> tuple[Widget, ...]:
    """While it runs, another length makes it end earlier or later."""
    now = state.of(_Countdown)
    runs = now.begun_s is not None
    left_s = now.left_s(state.time_s)

    def put(length: _Countdown) -> Put:
        return Put(length, say("{minutes} minutes are set", minutes=length.minutes))

    def step(key: str, words: str, icon: Icon, by_min: int, bound: int, why: str) -> Button:
        return Button(
            key=f"timer.{key}",
            description=words,
            icon=icon,
            icon_size=44,
            on_tap=put(now.longer(by_min)),
            on_hold=put(now.longer(HELD_STEPS * by_min)),
            disabled=why if now.minutes == bound else "",
        )

    less = step("less", say("Five minutes less"), Icon.MINUS, -STEP_MIN, STEP_MIN, say("It is at its lowest"))
    more = step("more", say("Five minutes more"), Icon.PLUS, STEP_MIN, MOST_MIN, say("It is at its highest"))
    time = Label(
        key="timer.left",
        text=minutes(left_s),
        description=say("Time left") if runs else say("Duration"),
        style=Type.DISPLAY,
        align="centre",
    )
    lengths = [
        (str(length), str(length), None, length == now.minutes, put(replace(now, minutes=length)))
        for length in LENGTHS_MIN
    ]
    act = Button(
        key="timer.run",
        text=say("Stop") if runs else say("Start"),
        icon=Icon.STOP if runs else Icon.PLAY,
        icon_size=34,
        style=Type.TITLE,
        look=Look.CRITICAL if runs else Look.ACCENT,
        on_tap=STOP_TIMER if runs else START_TIMER,
    )
    whole = card(
        title(Icon.CLOCK, say("Timer"), "timer.title"),
        32,
        (104, line((104, less), time, (104, more))),
        20,
        (12, Bar(share=round(left_s / (60 * now.minutes), 2))),
        40,
        heading(say("Minutes")),
        8,
        (72, choices("timer.length", lengths)),
        REST,
        (88, act),
        padding=(32, 24),
    )
    return fill(content(state), whole)


@offered
def set_timer(
    state: State, minutes: Annotated[int, "Its length.", Ge(STEP_MIN), Le(MOST_MIN), MultipleOf(STEP_MIN)]
) -> CallMade:
    """Set the length of the timer; one that runs ends earlier or later."""
    return Put(replace(state.of(_Countdown), minutes=minutes), "")


@offered
def run_timer(state: State, on: Annotated[bool, "True starts it, false stops it."]) -> CallMade:
    """Start the timer with the length that is set, or stop it."""
    return START_TIMER if on else STOP_TIMER


APP = App(
    name="timer",
    title=say("Timer"),
    icon=Icon.CLOCK,
    order=20,
    where=Where.STORE,
    about=say("Counts down minutes and alerts you"),
    preinstalled=False,
    functions=(set_timer, run_timer),
    pages={"timer": AppPage(timer, Room.ONE)},
    starts=lambda state, rng: (_Countdown(),),
)
