"""Commands of the car: horn and washer."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.vehicle.state import CarMemory
from automotive_cosim.cockpit.commands import SimpleCommand
from automotive_cosim.cockpit.signals import BODY, DRIVE
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say

WASH_PCT = 2.0
"""Share of the washer's tank used per wash."""


def _honk(state: State) -> Feedback:
    """Sound the horn."""
    car = state.of(CarMemory)
    state.keep(replace(car, horns=car.horns + 1))
    state.signals[DRIVE.HORN] = True
    return Feedback(FeedbackCode.OK, say("the horn sounds"))


HONK = SimpleCommand(_honk, ("horn",))


def _wash(state: State) -> Feedback:
    """Wash the windshield."""
    left, car = state.signals[BODY.WASHER_FLUID], state.of(CarMemory)
    if left < WASH_PCT:
        return state.refused(say("The washer's tank is empty"))
    state.signals[BODY.WASHER_FLUID] = left - WASH_PCT
    state.keep(replace(car, washes=car.washes + 1))
    return state.said(say("The windshield is washed"), Icon.WASHER)


WASH = SimpleCommand(_wash, ("washer",))
