"""Functions of the timer."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from annotated_types import Ge, Le, MultipleOf

from automotive_cosim.cockpit.apps.timer.commands import StartTimer, StopTimer
from automotive_cosim.cockpit.apps.timer.state import MOST_MIN, STEP_MIN, Countdown
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.functions import CallMade, offered
from automotive_cosim.cockpit.state import State


@offered
def set_timer(
    state: State, minutes: Annotated[int, "Its length.", Ge(STEP_MIN), Le(MOST_MIN), MultipleOf(STEP_MIN)]
) -> CallMade:
    """Set the length of the timer; one that runs ends earlier or later."""
    return Put(replace(state.of(Countdown), minutes=minutes), "")


@offered
def run_timer(state: State, on: Annotated[bool, "True starts it, false stops it."]) -> CallMade:
    """Start the timer with the length that is set, or stop it."""
    return StartTimer() if on else StopTimer()


FUNCTIONS = (set_timer, run_timer)
