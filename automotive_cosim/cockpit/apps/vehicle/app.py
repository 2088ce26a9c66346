"""Vehicle: lamps and wipers, assistance, doors, seats, mirrors, and the lights inside."""

from __future__ import annotations

from typing import Annotated

from annotated_types import Ge, Le

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.vehicle.body import doors, driving, interior, mirrors, seats
from automotive_cosim.cockpit.apps.vehicle.screens import assistance, vehicle
from automotive_cosim.cockpit.apps.vehicle.state import HONK, REMEMBERED, SLOTS, WASH, CarMemory, car
from automotive_cosim.cockpit.commands import Put, SetAll
from automotive_cosim.cockpit.functions import CallMade, disabled, offered
from automotive_cosim.cockpit.signals import SEAT
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say, say_in

Slot = Annotated[int, "Number of the stored position.", Ge(1), Le(SLOTS)]


@offered
def honk(state: State) -> CallMade:
    """Sound the horn."""
    return HONK


@offered
def wash_windshield(state: State) -> CallMade:
    """Wash the windshield."""
    return WASH


@offered
def recall_seat(state: State, position: Slot) -> CallMade:
    """Move the driver's seat and the mirrors to a stored position. Only at a standstill."""
    if held := state.vehicle.held(SEAT.DRIVER_POSITION):
        return Feedback(FeedbackCode.RESTRICTED, held)
    values = tuple(zip(REMEMBERED, state.of(CarMemory).memory[position - 1], strict=True))
    return SetAll(values, say("seat and mirrors are set as in {position}", position=position))


@offered
def store_seat(state: State, position: Slot) -> CallMade:
    """Store the present position of the driver's seat and the mirrors."""
    car = state.of(CarMemory)
    if car.memory[position - 1] == tuple(state.signals[signal] for signal in REMEMBERED):
        return disabled(say("The seat is already in this position"))
    return Put(car.with_memory(position - 1, state.signals), "")


FUNCTIONS = (honk, wash_windshield, recall_seat, store_seat)


APP = App(
    name="vehicle",
    title=say("Vehicle"),
    short=say_in("dock", "Vehicle"),
    icon=Icon.VEHICLE,
    order=5,
    where=Where.DOCK,
    functions=FUNCTIONS,
    pages={
        "vehicle": AppPage(vehicle),
        "assistance": AppPage(assistance),
        "driving": AppPage(driving),
        "doors": AppPage(doors),
        "seats": AppPage(seats),
        "mirrors": AppPage(mirrors, sided=True),
        "interior": AppPage(interior),
    },
    aliases={"road": ""},
    picked={"seats": "driver"},
    starts=lambda state, rng: (car(rng),),
    turn=4,
)
