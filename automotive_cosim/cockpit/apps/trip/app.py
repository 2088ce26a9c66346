"""Trip: two trip meters."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.trip.functions import FUNCTIONS
from automotive_cosim.cockpit.apps.trip.screens import trip, trip_b
from automotive_cosim.cockpit.apps.trip.state import TripMeters
from automotive_cosim.cockpit.size import Room
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say

APP = App(
    name="trip",
    title=say("Trip"),
    icon=Icon.TRIP,
    order=15,
    where=Where.STORE,
    about=say("Distance, time and consumption"),
    functions=FUNCTIONS,
    pages={"trip": AppPage(trip, Room.ONE), "trip_b": AppPage(trip_b, Room.ONE)},
    starts=lambda state, rng: (TripMeters(),),
)
