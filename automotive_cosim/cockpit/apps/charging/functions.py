"""The function of the schedule."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from automotive_cosim.cockpit.apps.charging.state import ChargingSchedule
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.functions import CLOCK, CallMade, minute_of, offered
from automotive_cosim.cockpit.state import State
from automotive_cosim.contracts import Feedback


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
