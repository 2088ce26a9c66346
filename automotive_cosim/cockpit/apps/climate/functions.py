"""The function of the schedule."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from automotive_cosim.cockpit.apps.climate.state import ClimateSchedule
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.functions import CLOCK, CallMade, minute_of, offered
from automotive_cosim.cockpit.state import State
from automotive_cosim.contracts import Feedback


@offered
def schedule_climate(
    state: State, on: Annotated[bool, "Whether the schedule is on."], time: Annotated[str, CLOCK] = ""
) -> CallMade:
    """Have the cabin prepared for a time of day, or not."""
    timer = state.of(ClimateSchedule).timer
    minute = minute_of(time) if time else timer.minute
    return (
        minute if isinstance(minute, Feedback) else Put(ClimateSchedule(replace(timer, on=on, minute=minute)), "")
    )


FUNCTIONS = (schedule_climate,)
