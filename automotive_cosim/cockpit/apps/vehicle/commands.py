"""Commands of the car: horn and washer."""

from __future__ import annotations

from dataclasses import dataclass, replace

from automotive_cosim.cockpit.apps.vehicle.state import CarMemory
from automotive_cosim.cockpit.signals import BODY, DRIVE
from automotive_cosim.cockpit.state import Command, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say

WASH_PCT = 2.0
"""Share of the washer's tank used per wash."""


@dataclass(frozen=True, slots=True)
class Honk(Command):
    """Sound the horn."""

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"horn"})

    def perform(self, state: State) -> Feedback:
        """The sound, until the next second."""
        car = state.of(CarMemory)
        state.keep(replace(car, horns=car.horns + 1))
        state.signals[DRIVE.HORN] = True
        return Feedback(FeedbackCode.OK, say("the horn sounds"))


@dataclass(frozen=True, slots=True)
class Wash(Command):
    """Wash the windshield."""

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"washer"})

    def perform(self, state: State) -> Feedback:
        """The wash, if there is fluid."""
        left, car = state.signals[BODY.WASHER_FLUID], state.of(CarMemory)
        if left < WASH_PCT:
            return state.refused(say("The washer's tank is empty"))
        state.signals[BODY.WASHER_FLUID] = left - WASH_PCT
        state.keep(replace(car, washes=car.washes + 1))
        return state.said(say("The windshield is washed"), Icon.WASHER)
