"""Equipment that the car has and that is out of order: the button is there, and says so."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import company
from automotive_cosim.cockpit.lacking import Lacking
from automotive_cosim.cockpit.signals import CABIN, ENERGY, HVAC, SEAT
from automotive_cosim.tasking.checks import Counted, SignalIs
from automotive_cosim.tasking.moves import Open, Slide, Tap
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasks.limits.forms import ON_THE_ROAD, OUT_OF_ORDER, PARKED, unequipped
from automotive_cosim.tasks.limits.unfitted import CLIMATE, DOORS, LEVELS, WARM

INSIDE = (Open("vehicle"), Tap("vehicle.tab.interior"))
FRONT_WINDOWS = {"my": "driver", "the passenger's": "passenger"}
OPENED = {"my": CABIN.DRIVER_WINDOW, "the passenger's": CABIN.PASSENGER_WINDOW}

TASKS = (
    unequipped(
        "limits_rear_defroster",
        Module.PHENOMENON,
        (
            "Clear the rear window, heat it.",
            "Rear defroster on.",
            "The glass behind is all misted over; switch on its heating wires.",
            "Demist the back window, please.",
            "Rear window heating, quick.",
        ),
        SignalIs(HVAC.REAR_DEFROSTER, (True,)),
        *CLIMATE,
        Tap("hvac.rear_defroster"),
        lacks=Lacking("rear defroster", (HVAC.REAR_DEFROSTER,), is_broken=True),
        look=CLIMATE,
        answer="The rear defroster is out of order and has to be repaired.",
        tells=(("rear", "back", "behind"), OUT_OF_ORDER),
        instead=((*CLIMATE, Tap("hvac.front_defroster")), (*CLIMATE, Tap("hvac.max_defrost"))),
    ),
    unequipped(
        "limits_washer",
        Module.PHENOMENON,
        (
            "There's a squashed fly right before my eyes. Wash it off.",
            "Spray the windshield once.",
            "Washer, please, one squirt.",
            "The pane is dirty, water on it.",
            "Rinse the front window for me.",
        ),
        Counted("washer"),
        Open("vehicle"),
        Tap("wiper.wash"),
        lacks=Lacking(
            "windshield washer",
            keys=("wiper.wash", "outside.wash"),
            functions=("wash_windshield",),
            is_broken=True,
        ),
        look=(Open("vehicle"),),
        answer="The windshield washer is out of order, so nothing is sprayed.",
        tells=(("washer", "spray", "water", "wash"), OUT_OF_ORDER),
        instead=((Open("vehicle"), Tap("wiper.front.fast")), (Open("vehicle"), Tap("wiper.front.slow"))),
    ),
    unequipped(
        "limits_charging_flap",
        Module.APPS,
        (
            "I want to charge: flap open.",
            "I'm standing at the post, cable in hand. Open up for it, please.",
            "Let me plug in: open the charge port.",
            "The lid over the charging socket, open it.",
            "Pop the charge flap.",
        ),
        SignalIs(ENERGY.CHARGE_FLAP, (True,)),
        Open("charging"),
        Tap("charging.flap"),
        lacks=Lacking("charging flap", (ENERGY.CHARGE_FLAP,), is_broken=True),
        look=(Open("charging"),),
        answer="The charging flap is out of order; it has to be repaired before you can plug in.",
        tells=(("flap", "port", "lid", "charging"), OUT_OF_ORDER),
        instead=((*DOORS, Tap("door.trunk")), (Open("charging"), Tap("charging.schedule"))),
        start=PARKED,
    ),
    unequipped(
        "limits_front_window",
        Module.SYSTEM,
        (
            "Open {whose} window by {percent:g} percent.",
            "{percent:g} percent of fresh air through {whose} window.",
            "Lower {whose} window to {percent:g}.",
            "Wind {whose} window down, {percent:g} percent.",
            "Let {whose} window down by {percent:g} percent, please.",
        ),
        SignalIs(param("whose", OPENED), (param("percent"),)),
        *DOORS,
        Slide(param("whose", {whose: f"window.{seat}" for whose, seat in FRONT_WINDOWS.items()}), param("percent")),
        lacks=Lacking("front window motors", (CABIN.DRIVER_WINDOW, CABIN.PASSENGER_WINDOW), is_broken=True),
        look=DOORS,
        answer="The motors of the front windows are out of order and need repair.",
        tells=(("window", "windows"), OUT_OF_ORDER),
        instead=((*DOORS, Slide("window.rear_left", param("percent"))), (*DOORS, Slide("window.sunroof", 20.0))),
        parameters={"whose": tuple(FRONT_WINDOWS), "percent": (30.0, 40.0, 50.0)},
    ),
    unequipped(
        "limits_reading_light",
        Module.SYSTEM,
        (
            "My wife wants to read. Her lamp on, please.",
            "Reading light for the passenger.",
            "Switch on the spot above the seat next to me.",
            "Give my passenger some light for her book.",
            "The little lamp over the passenger seat, on.",
        ),
        SignalIs(CABIN.PASSENGER_READING_LIGHT, (True,)),
        *INSIDE,
        Tap("light.passenger_reading"),
        lacks=Lacking("passenger's reading light", (CABIN.PASSENGER_READING_LIGHT,), is_broken=True),
        look=INSIDE,
        answer="The passenger's reading light is out of order.",
        tells=(("light", "lamp"), OUT_OF_ORDER),
        instead=((*INSIDE, Tap("light.dome")), (*INSIDE, Tap("light.driver_reading"))),
        start=replace(ON_THE_ROAD, start="2026-11-17T22:40:00", aboard=company(2)),
    ),
    unequipped(
        "limits_passenger_seat_heater",
        Module.HVAC,
        (
            "Warm the seat beside me, {level}.",
            "Passenger's seat heating on {level}.",
            "My mother, here on my side, is cold: heat her seat, {level}.",
            "Seat heat {level} for the passenger, please.",
            "Put the heater in the passenger seat on {level}.",
        ),
        SignalIs(SEAT.PASSENGER_HEATING, (param("level", WARM),)),
        *CLIMATE,
        Tap("hvac.passenger_seat_heating", times=param("level", LEVELS)),
        lacks=Lacking("passenger's seat heating", (SEAT.PASSENGER_HEATING,), (1.0, 100.0), is_broken=True),
        look=CLIMATE,
        answer="The heating of the passenger's seat is out of order and has to be repaired.",
        tells=(("seat", "heating", "heater"), OUT_OF_ORDER),
        instead=(
            (*CLIMATE, Tap("hvac.driver_seat_heating", times=param("level", LEVELS))),
            (*CLIMATE, Tap("hvac.air.down")),
        ),
        start=replace(ON_THE_ROAD, aboard=company(2)),
        parameters={"level": tuple(LEVELS)},
    ),
    unequipped(
        "limits_boot_lid",
        Module.SYSTEM,
        (
            "Open the boot.",
            "Tailgate up, my hands are full.",
            "I want to load the shopping, open the trunk.",
            "Trunk, please.",
            "Raise the tailgate for me.",
        ),
        SignalIs(CABIN.TRUNK, (True,)),
        *DOORS,
        Tap("door.trunk"),
        lacks=Lacking("trunk", (CABIN.TRUNK,), is_broken=True),
        look=DOORS,
        answer="I cannot open the trunk: its drive is out of order and has to be repaired.",
        tells=(("trunk", "boot", "tailgate"), OUT_OF_ORDER),
        instead=((*DOORS, Tap("door.all")), (*DOORS, Tap("door.rear_left"))),
        start=PARKED,
    ),
)
