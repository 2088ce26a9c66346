"""Vehicle: lamps and wipers, assistance, doors, seats, mirrors, and the lights inside."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.vehicle.body import doors, driving, interior, mirrors, seats
from automotive_cosim.cockpit.apps.vehicle.functions import FUNCTIONS
from automotive_cosim.cockpit.apps.vehicle.screens import assistance, vehicle
from automotive_cosim.cockpit.apps.vehicle.state import car
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say, say_in

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
        "mirrors": AppPage(mirrors),
        "interior": AppPage(interior),
    },
    aliases={"road": ""},
    picked={"seats": "driver"},
    starts=lambda state, rng: (car(rng),),
    turn=4,
)
