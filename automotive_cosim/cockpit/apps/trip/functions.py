"""The function of the trip meters."""

from __future__ import annotations

from typing import Annotated, Literal

from automotive_cosim.cockpit.apps.trip.commands import ResetTrip
from automotive_cosim.cockpit.functions import CallMade, offered
from automotive_cosim.cockpit.state import State


@offered
def reset_trip(state: State, meter: Annotated[Literal["a", "b"], "Which trip meter."]) -> CallMade:
    """Reset a trip meter: count distance and time from here."""
    return ResetTrip(meter)


FUNCTIONS = (reset_trip,)
