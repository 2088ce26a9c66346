"""HVAC, wishes that do not say enough: whose side, which seat, which glass, what time."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import company
from automotive_cosim.cockpit.signals import HVAC, SEAT
from automotive_cosim.tasking.checks import AppDataIs, SignalIs
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.moves import Open, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Dimension, Module
from automotive_cosim.tasks.forms import (
    ELSEWHERE,
    FRIENDS,
    ON_THE_WAY,
    PARIS,
    only,
    read_out,
    unclear,
    wrote,
)

CLIMATE = Open("climate")
FRONT_SEATS = {"driver": SEAT.DRIVER_HEATING, "passenger": SEAT.PASSENGER_HEATING}
DEFROSTERS = {"front": HVAC.FRONT_DEFROSTER, "rear": HVAC.REAR_DEFROSTER}
SIDES = {"driver": HVAC.DRIVER_TEMPERATURE, "passenger": HVAC.PASSENGER_TEMPERATURE}
TIMES = ("07:30", "08:00")
TWO = replace(PARIS, aboard=company(2))

TASKS = (
    unclear(
        "hvac_ask_which_seat",
        Module.HVAC,
        (
            "That seat's getting too hot. Heating off, just that one.",
            "One of the seats is roasting, switch its heating off.",
            "No more heat in that seat, please.",
            "One seat is like a stove. Stop it, and leave the rest alone.",
            "One of the seat heaters is too hot, turn that one off.",
        ),
        Topic(
            "whose seat",
            (("driver", "driver's", "my", "yours", "your"), ("passenger", "passenger's")),
            param("which", {"driver": "Mine, the driver's.", "passenger": "The passenger's."}),
            ("seat", "which seat", "whose"),
        ),
        "Whose seat: the driver's or the passenger's?",
        SignalIs(param("which", FRONT_SEATS), (0.0,)),
        CLIMATE,
        TapUntil("hvac.{which}_seat_heating", "hvac.{which}_seat_heating", "Seat heat: Off"),
        untold=replace(PARIS, signals={seat.path: param("heat") for seat in FRONT_SEATS.values()}),
        told=replace(PARIS, signals=only(FRONT_SEATS, 100.0, 0.0)),
        look=(CLIMATE,),
        difference="settings: both front seats are heated, or only one of them",
        parameters={"which": tuple(FRONT_SEATS), "heat": (50.0, 100.0)},
        trigger=ON_THE_WAY,
    ),
    unclear(
        "hvac_ask_which_defroster",
        Module.HVAC,
        (
            "Switch that defroster off again.",
            "One of the windows is clear now: that defroster off, please.",
            "I don't need that window heater any more.",
            "There's one defroster too many, and it's noisy. Stop that one.",
            "One of the defrosters can stop now, just the one.",
        ),
        Topic(
            "which defroster",
            (("front", "windshield", "windscreen"), ("rear", "back")),
            param("which", {"front": "The one in front.", "rear": "The rear one."}),
            ("defroster", "window", "which one"),
        ),
        "The front defroster or the rear one?",
        SignalIs(param("which", DEFROSTERS), (False,)),
        Tap("dock.{which}_defroster"),
        untold=replace(PARIS, signals={each.path: True for each in DEFROSTERS.values()}),
        told=replace(PARIS, signals=only(DEFROSTERS, True, False)),
        look=(),
        difference="settings: both defrosters run, or only one of them",
        parameters={"which": tuple(DEFROSTERS)},
        trigger=ON_THE_WAY,
        scenarios=ELSEWHERE,
    ),
    unclear(
        "hvac_ask_whose_side",
        Module.HVAC,
        (
            "One of us is too warm. Give that side {degrees} degrees.",
            "{degrees} degrees on the side that's too hot, please.",
            "It's stuffy for one of us: {degrees} over there.",
            "Set the side of whoever is sweating to {degrees}.",
            "One side is too warm; make that one {degrees}.",
        ),
        Topic(
            "whose side",
            (("driver", "driver's", "you", "yours", "your", "my"), ("passenger", "passenger's")),
            param("which", {"driver": "Mine, on the driver's side.", "passenger": "The passenger's side."}),
            ("side", "who", "whose"),
        ),
        "Who is too warm, the driver or the passenger?",
        SignalIs(param("which", SIDES), (param("degrees"),)),
        CLIMATE,
        TapUntil("hvac.{which}_temperature.decrease", "hvac.{which}_temperature", "{degrees}.0 °C"),
        untold=replace(TWO, signals={HVAC.SYNC.path: False, **{side.path: 22.0 for side in SIDES.values()}}),
        told=replace(TWO, signals={HVAC.SYNC.path: False, **only(SIDES, 24.0, 20.0)}),
        look=(CLIMATE,),
        difference="settings: both sides are set to 22 degrees, or one to 24 and the other to 20",
        parameters={"which": tuple(SIDES), "degrees": (17, 18, 19)},
        trigger=ON_THE_WAY,
        dimension=Dimension.IMPLICIT_INTENT,
    ),
    unclear(
        "hvac_ask_where_to_blow",
        Module.HVAC,
        (
            "{who} knows where the air should go: the feet or the windshield. Do that.",
            "The air to the feet or to the windshield, as {who} wants it.",
            "Point the air at the windshield or the feet, whichever {who} prefers.",
            "{who} has a wish for the vents: feet or windshield.",
            "Blow down at the feet or up the windshield, as {who} would have it.",
        ),
        Topic(
            "where the air goes",
            (("feet", "foot", "down"), ("windshield", "windscreen", "up")),
            param("which", {"feet": "To the feet.", "windshield": "To the windshield."}),
            ("air", "where"),
        ),
        "Should the air go to the feet or to the windshield?",
        SignalIs(HVAC.AIR_DISTRIBUTION, (param("which", {"feet": "DOWN", "windshield": "UP"}),)),
        CLIMATE,
        Tap(param("which", {"feet": "hvac.air.down", "windshield": "hvac.air.up"})),
        untold=wrote(PARIS, ("{who}", "See you soon, I'm waiting at the corner.")),
        told=wrote(
            PARIS,
            (
                "{who}",
                param(
                    "which",
                    {
                        "feet": "My toes are frozen, air down there when I get in!",
                        "windshield": "Air up when I get in, last time I saw nothing!",
                    },
                ),
            ),
        ),
        look=read_out("{who}"),
        difference="content: what the friend has written is about something else, or says where",
        parameters={"which": ("feet", "windshield"), "who": FRIENDS},
    ),
    unclear(
        "hvac_ask_warm_by_when",
        Module.HVAC,
        (
            "Have the car warm when we pick {who} up tomorrow, 7:30 or 8 it was.",
            "Warm the cabin for fetching {who} in the morning; her parents know if it's 7:30 or 8.",
            "{who} has to be fetched tomorrow, at 07:30 or 08:00. I want it warm by then.",
            "Preheat for {who}'s pick-up, half past seven or eight o'clock.",
            "By the time we collect {who}, 7:30 or 8:00, the car has to be cosy.",
        ),
        Topic(
            "when {who} is picked up",
            (("07 30", "7 30", "half past seven", "half past 7"), ("08 00", "8 00", "eight", "8", "08")),
            param("which", {"07:30": "At half past seven.", "08:00": "At eight."}),
            ("{who}", "when", "time"),
        ),
        "Is {who} picked up at 7:30 or at 8:00?",
        AppDataIs("climate.schedule", (param("which"),)),
        CLIMATE,
        Tap("hvac.comfort"),
        TapUntil("climate.schedule.later", "climate.schedule.time", "{which}"),
        Tap("climate.schedule"),
        untold=wrote(
            PARIS,
            ("{who}'s mother", "{who} is ready at 7:30 tomorrow."),
            ("{who}'s father", "{who} is ready at 8:00 tomorrow."),
        ),
        told=wrote(
            PARIS,
            (
                "{who}'s mother",
                param(
                    "which",
                    {
                        "07:30": "{who} is ready at 7:30 tomorrow.",
                        "08:00": "Her father knows when to fetch {who}.",
                    },
                ),
            ),
            (
                "{who}'s father",
                param(
                    "which",
                    {
                        "07:30": "Her mother knows when to fetch {who}.",
                        "08:00": "{who} is ready at 8:00 tomorrow.",
                    },
                ),
            ),
        ),
        look=read_out("{who}'s mother", "{who}'s father"),
        difference="content: the parents have written different times, or only one of them a time",
        parameters={"which": TIMES, "who": FRIENDS},
    ),
)
