"""The command of the trip meters."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from automotive_cosim.cockpit.apps.trip.state import TripMeter, TripMeters, odometer
from automotive_cosim.cockpit.state import Command, State
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say


@dataclass(frozen=True, slots=True)
class ResetTrip(Command):
    """Count distance and time from here."""

    meter: Literal["a", "b"] = "a"

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"trip.resets_b" if self.meter == "b" else "trip.resets"})

    def perform(self, state: State) -> Feedback:
        """The meter at zero."""
        trip, here = state.of(TripMeters), odometer(state)
        if self.meter == "a":
            state.keep(replace(trip, resets=trip.resets + 1, since=here))
            return Feedback(FeedbackCode.OK, say("the trip computer is reset"))
        state.keep(replace(trip, b=TripMeter(since=here, resets=trip.b.resets + 1)))
        return Feedback(FeedbackCode.OK, say("trip B is reset"))
