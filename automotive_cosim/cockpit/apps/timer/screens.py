"""The timer: its length, the time that is left, and the button that starts and stops it."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.timer.commands import StartTimer, StopTimer
from automotive_cosim.cockpit.apps.timer.state import MOST_MIN, STEP_MIN, Countdown
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.layout import REST, column, row
from automotive_cosim.cockpit.parts import HELD_STEPS, choices, content, heading, minutes, title
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.widgets import Bar, Button, Card, Label, Look, Widget
from automotive_cosim.contracts.text import say

LENGTHS_MIN = (5, 10, 15, 20, 30, 60, 120)


def timer(state: State) -> tuple[Widget, ...]:
    """While it runs, another length makes it end earlier or later."""
    area = content(state)
    head, _, line, _, bar, _, name, _, lengths, _, act = column(
        area.inset(32, 24), 40, 32, 104, 20, 12, 40, 28, 8, 72, REST, 88
    )
    less, time, more = row(line, 104, REST, 104)
    now = state.of(Countdown)
    runs = now.begun_s is not None
    left_s = now.left_s(state.time_s)

    def put(length: Countdown) -> Put:
        return Put(length, say("{minutes} minutes are set", minutes=length.minutes))

    def step(key: str, words: str, icon: Icon, by_min: int, bound: int, why: str) -> Button:
        return Button(
            rect=less if by_min < 0 else more,
            key=f"timer.{key}",
            description=words,
            icon=icon,
            icon_size=44,
            on_tap=put(now.longer(by_min)),
            on_hold=put(now.longer(HELD_STEPS * by_min)),
            disabled=why if now.minutes == bound else "",
        )

    return (
        Card(
            rect=area,
            children=(
                title(head, Icon.CLOCK, say("Timer"), "timer.title"),
                step("less", say("Five minutes less"), Icon.MINUS, -STEP_MIN, STEP_MIN, say("It is at its lowest")),
                Label(
                    rect=time,
                    key="timer.left",
                    text=minutes(left_s),
                    description=say("Time left") if runs else say("Duration"),
                    style=Type.DISPLAY,
                    align="centre",
                ),
                step("more", say("Five minutes more"), Icon.PLUS, STEP_MIN, MOST_MIN, say("It is at its highest")),
                Bar(rect=bar, share=round(left_s / (60 * now.minutes), 2)),
                heading(name, say("Minutes")),
                choices(
                    lengths,
                    "timer.length",
                    [
                        (str(length), str(length), None, length == now.minutes, put(replace(now, minutes=length)))
                        for length in LENGTHS_MIN
                    ],
                ),
                Button(
                    rect=act,
                    key="timer.run",
                    text=say("Stop") if runs else say("Start"),
                    icon=Icon.STOP if runs else Icon.PLAY,
                    icon_size=34,
                    style=Type.TITLE,
                    look=Look.CRITICAL if runs else Look.ACCENT,
                    on_tap=StopTimer() if runs else StartTimer(),
                ),
            ),
        ),
    )
