"""HVAC, explicit requests: warm, cool or fresh air and seats."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat, company
from automotive_cosim.cockpit.signals import CABIN, HVAC, MIRROR, SEAT
from automotive_cosim.cockpit.vehicle import WINDOWS
from automotive_cosim.tasking.checks import AllOf, AppDataIs, SignalIs
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasks.forms import COMFORT, PARIS, asked

WITH_A_PASSENGER = replace(PARIS, aboard=company(2))
METRIC = ("tokyo", "autobahn", "sydney", "grid")
"""Other scenarios whose display uses degrees Celsius."""
WARM_DEGREES = (21.5, 22.0, 22.5, 23.0, 23.5, 24.0, 24.5, 25.0)
SEATS = (SEAT.DRIVER_HEATING, SEAT.PASSENGER_HEATING, SEAT.REAR_LEFT_HEATING, SEAT.REAR_RIGHT_HEATING)
TO_DEGREES = TapUntil("hvac.driver_temperature.increase", "hvac.driver_temperature", "{degrees:.1f} °C")
HEATED = {
    SEAT.DRIVER_HEATING.path: 100.0,
    SEAT.PASSENGER_HEATING.path: 50.0,
    SEAT.REAR_LEFT_HEATING.path: 100.0,
    SEAT.REAR_RIGHT_HEATING.path: 50.0,
    SEAT.STEERING_WHEEL_HEATING.path: 100.0,
}
FRONT_SEATS_UP = (Tap("hvac.driver_seat_heating", times=2), Tap("hvac.passenger_seat_heating", times=2))
REAR_SEATS_UP = (Tap("hvac.rear_left_seat_heating", times=2), Tap("hvac.rear_right_seat_heating", times=2))
FRONT_COLD = (
    Tap("hvac.driver_seat_heating"),
    Tap("hvac.passenger_seat_heating", times=2),
    Tap("hvac.steering_wheel_heating"),
)
REAR_COLD = (Tap("hvac.rear_left_seat_heating"), Tap("hvac.rear_right_seat_heating", times=2))
SHUT_WINDOWS = (Open("vehicle"), Tap("vehicle.tab.doors"), Tap("window.close_all"))
HEAT_MIRRORS = (
    Open("vehicle"),
    Tap("vehicle.tab.mirrors"),
    Tap("mirror.driver.heat"),
    Tap("mirror.passenger.heat"),
)

TASKS = (
    asked(
        "hvac_fan_max",
        Module.HVAC,
        (
            "Turn the fan speed to max.",
            "Fan all the way up, please.",
            "Full blast on the blower.",
            "Put the fan on its highest setting.",
            "Maximum air flow, quick.",
        ),
        SignalIs(HVAC.FAN_SPEED, (100.0,)),
        Open("climate"),
        Tap("hvac.fan.max"),
        deadline=COMFORT,
    ),
    asked(
        "hvac_driver_seat_heater",
        Module.HVAC,
        (
            "Turn on driver seat heater.",
            "Seat warmer on for me, please.",
            "Switch my seat heating on.",
            "Heat up the driver's seat.",
            "I'd like the seat heater on, where I sit.",
        ),
        SignalIs(SEAT.DRIVER_HEATING, (50.0, 100.0)),
        Open("climate"),
        Tap("hvac.driver_seat_heating"),
        ways=((Open("climate"), Tap("hvac.driver_seat_heating", times=2)),),
        deadline=COMFORT,
    ),
    asked(
        "hvac_driver_degrees",
        Module.HVAC,
        (
            "Set the temperature on my side to {degrees:g} degrees.",
            "{degrees:g} degrees for me, please.",
            "Make it {degrees:g} over here.",
            "I'd like {degrees:g} degrees at the driver's seat.",
        ),
        SignalIs(HVAC.DRIVER_TEMPERATURE, (param("degrees"),)),
        Open("climate"),
        TO_DEGREES,
        deadline=COMFORT,
        may_write=frozenset({HVAC.SYNC.path}),
        parameters={"degrees": WARM_DEGREES},
        scenarios=METRIC,
    ),
    asked(
        "hvac_passenger_degrees",
        Module.HVAC,
        (
            "Set just the passenger side to {degrees:g} degrees.",
            "Make it {degrees:g} for the one beside me, leave mine alone.",
            "{degrees:g} for my passenger, please, not for me.",
            "Passenger temperature {degrees:g}, mine stays.",
            "He wants {degrees:g} degrees over there, I don't.",
        ),
        SignalIs(HVAC.PASSENGER_TEMPERATURE, (param("degrees"),)),
        Open("climate"),
        TapUntil("hvac.passenger_temperature.increase", "hvac.passenger_temperature", "{degrees:.1f} °C"),
        start=WITH_A_PASSENGER,
        deadline=COMFORT,
        parameters={"degrees": WARM_DEGREES},
        scenarios=METRIC,
    ),
    asked(
        "hvac_two_zones",
        Module.HVAC,
        (
            "{mine:g} degrees for me and {yours:g} for my passenger.",
            "Driver {mine:g}, passenger {yours:g}, please.",
            "We can't agree: {yours:g} over there, {mine:g} here at the wheel.",
            "Split the temperature: my side {mine:g}, the other {yours:g}.",
            "Give her {yours:g} and give me {mine:g}.",
        ),
        AllOf(
            (
                SignalIs(HVAC.DRIVER_TEMPERATURE, (param("mine"),)),
                SignalIs(HVAC.PASSENGER_TEMPERATURE, (param("yours"),)),
            )
        ),
        Open("climate"),
        TapUntil("hvac.driver_temperature.increase", "hvac.driver_temperature", "{mine:.1f} °C"),
        TapUntil("hvac.passenger_temperature.decrease", "hvac.passenger_temperature", "{yours:.1f} °C"),
        ways=(
            (
                Open("climate"),
                TapUntil("hvac.passenger_temperature.decrease", "hvac.passenger_temperature", "{yours:.1f} °C"),
                TapUntil("hvac.driver_temperature.increase", "hvac.driver_temperature", "{mine:.1f} °C"),
            ),
        ),
        start=WITH_A_PASSENGER,
        parameters={"mine": (21.5, 22.0, 22.5, 23.0), "yours": (18.5, 19.0, 19.5, 20.0, 20.5)},
        scenarios=METRIC,
        tags=frozenset({"preference"}),
    ),
    asked(
        "hvac_air_direction",
        Module.HVAC,
        (
            "Send the air to the {where}.",
            "Air at the {where}, please.",
            "Blow it onto the {where} instead.",
            "I want the vents aimed towards the {where}.",
            "Set the air vents so that it goes to the {where}.",
        ),
        SignalIs(HVAC.AIR_DISTRIBUTION, (param("where", {"feet": "DOWN", "windshield": "UP"}),)),
        Open("climate"),
        Tap(param("where", {"feet": "hvac.air.down", "windshield": "hvac.air.up"})),
        deadline=COMFORT,
        parameters={"where": ("feet", "windshield")},
    ),
    asked(
        "hvac_fan_percent",
        Module.HVAC,
        (
            "Fan to {percent:g} percent.",
            "Put the blower at {percent:g}.",
            "I'd like the fan speed at {percent:g} %, please.",
            "Blower strength {percent:g}, thanks.",
            "Run the fan at {percent:g} percent.",
        ),
        SignalIs(HVAC.FAN_SPEED, (param("percent"),)),
        Open("climate"),
        Slide("hvac.fan", param("percent")),
        deadline=COMFORT,
        parameters={"percent": (10.0, 20.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0)},
    ),
    asked(
        "hvac_recirculation_purifier",
        Module.HVAC,
        (
            "Recirculation on, and the purifier too.",
            "Run the air purifier and recirculate.",
            "Shut off the outside air and clean what's in here.",
            "Purifier plus recirculating air, both, please.",
            "Switch to recirculated air, and the purifier on.",
        ),
        AllOf((SignalIs(HVAC.RECIRCULATION, (True,)), SignalIs(HVAC.PURIFIER, (True,)))),
        Open("climate"),
        Tap("hvac.recirculation"),
        Tap("hvac.purifier"),
        ways=((Open("climate"), Tap("hvac.purifier"), Tap("hvac.recirculation")),),
        deadline=COMFORT,
    ),
    asked(
        "hvac_all_seats_high",
        Module.HVAC,
        (
            "Heat all four seats on high.",
            "Every seat as warm as it gets, front and back.",
            "Full seat heating for everybody.",
            "The heaters under all of us to the maximum, rear ones too.",
            "We're frozen, turn each seat heater right up.",
        ),
        AllOf(tuple(SignalIs(seat, (100.0,)) for seat in SEATS)),
        Open("climate"),
        *FRONT_SEATS_UP,
        Tap("hvac.comfort"),
        *REAR_SEATS_UP,
        ways=((Open("climate"), Tap("hvac.comfort"), *REAR_SEATS_UP, Open("climate"), *FRONT_SEATS_UP),),
        start=replace(PARIS, aboard=company(4)),
    ),
    asked(
        "hvac_rear_seat_level",
        Module.HVAC,
        (
            "Seat heating at the back right, {level}.",
            "Warm the rear right seat on {level}, please.",
            "My kid behind the passenger wants the heater on {level}.",
            "Rear right: heat it, {level} setting.",
            "The right-hand seat in the back: heater to {level}.",
        ),
        SignalIs(SEAT.REAR_RIGHT_HEATING, (param("level", {"low": 50.0, "high": 100.0}),)),
        Open("climate"),
        Tap("hvac.comfort"),
        TapUntil(
            "hvac.rear_right_seat_heating",
            "hvac.rear_right_seat_heating",
            param("level", {"low": "Right: Low", "high": "Right: High"}),
        ),
        start=replace(PARIS, aboard=(Occupant(Seat.REAR_RIGHT, Kind.CHILD),)),
        deadline=COMFORT,
        parameters={"level": ("low", "high")},
    ),
    asked(
        "hvac_seat_airing",
        Module.HVAC,
        (
            "Ventilate my seat at full strength.",
            "Seat cooling for the driver, high.",
            "Strongest seat ventilation on my side, please.",
            "Cool the seat under me as much as you can.",
            "Driver's seat: air through it, top level.",
        ),
        SignalIs(SEAT.DRIVER_HEATING, (-100.0,)),
        Open("climate"),
        Tap("hvac.driver_seat_airing", times=2),
        deadline=COMFORT,
        start=replace(PARIS, cabin={"temperature_c": 27.0}),
    ),
    asked(
        "hvac_schedule",
        Module.HVAC,
        (
            "Have the climate start at {time}.",
            "Get the climate going by itself at {time}, please.",
            "Schedule the heating: {time}.",
            "Climate timer on, {time}.",
            "Let the air conditioning start by itself at {time}.",
        ),
        AppDataIs("climate.schedule", (param("time"),)),
        Open("climate"),
        Tap("hvac.comfort"),
        TapUntil("climate.schedule.later", "climate.schedule.time", "{time}"),
        Tap("climate.schedule"),
        ways=(
            (
                Open("climate"),
                Tap("hvac.comfort"),
                Tap("climate.schedule"),
                TapUntil("climate.schedule.later", "climate.schedule.time", "{time}"),
            ),
        ),
        parameters={"time": ("07:30", "08:00", "08:30", "09:00", "09:30", "10:00", "10:30", "11:00")},
    ),
    asked(
        "hvac_both_defrosters",
        Module.HVAC,
        (
            "Front and rear defrost on.",
            "Defrost both the windshield and the back window.",
            "Demist in front and behind, please.",
            "Both defrosters, now.",
            "Switch on the front defroster, and the rear one as well.",
        ),
        AllOf((SignalIs(HVAC.FRONT_DEFROSTER, (True,)), SignalIs(HVAC.REAR_DEFROSTER, (True,)))),
        Open("climate"),
        Tap("hvac.front_defroster"),
        Tap("hvac.rear_defroster"),
        ways=(
            (Tap("dock.front_defroster"), Tap("dock.rear_defroster")),
            (Open("climate"), Tap("hvac.rear_defroster"), Tap("hvac.front_defroster")),
        ),
        deadline=COMFORT,
    ),
    asked(
        "hvac_max_cooling_windows",
        Module.HVAC,
        (
            "Close windows and roof, then give me max A/C.",
            "Windows up, sunroof shut, cooling to the maximum.",
            "Shut all that's open, the roof too, A/C at full power.",
            "Maximum air conditioning, with nothing left open above or beside us, please.",
            "All windows and the sunroof shut, and the air conditioning on max!",
        ),
        AllOf((SignalIs(HVAC.MAX_COOLING, (True,)), *(SignalIs(one, (0.0,)) for one in (*WINDOWS, CABIN.SUNROOF)))),
        *SHUT_WINDOWS,
        Slide("window.sunroof", 0.0),
        Open("climate"),
        Tap("hvac.max_cooling"),
        start=replace(
            PARIS,
            cabin={"temperature_c": 30.0},
            signals={
                CABIN.DRIVER_WINDOW.path: 60.0,
                CABIN.REAR_RIGHT_WINDOW.path: 30.0,
                CABIN.SUNROOF.path: 40.0,
                CABIN.SUNROOF_SHADE.path: 0.0,
            },
        ),
        tags=frozenset({"two_modules"}),
    ),
    asked(
        "hvac_mirrors_and_rear_window",
        Module.HVAC,
        (
            "Heat both mirrors and the rear window.",
            "Defrost the outside mirrors and the back glass.",
            "Mirror heating left and right, rear defroster as well.",
            "Back window, door mirrors: warm them up, please.",
            "Get the ice off behind and off the two mirrors.",
        ),
        AllOf(
            tuple(
                SignalIs(heater, (True,))
                for heater in (HVAC.REAR_DEFROSTER, MIRROR.DRIVER_HEATING, MIRROR.PASSENGER_HEATING)
            )
        ),
        Open("climate"),
        Tap("hvac.rear_defroster"),
        *HEAT_MIRRORS,
        ways=((*HEAT_MIRRORS, Tap("dock.rear_defroster")),),
        tags=frozenset({"two_modules"}),
    ),
    asked(
        "hvac_heating_all_off",
        Module.HVAC,
        (
            "Switch off the seat heating, all four, and the wheel's too.",
            "Steering wheel, front seats, rear seats: heaters off.",
            "No more heated seats anywhere, no heated wheel.",
            "Stop heating the seats, all of them, and the wheel.",
            "All heated seats and the heated steering wheel: off.",
        ),
        AllOf(tuple(SignalIs(heater, (0.0,)) for heater in (*SEATS, SEAT.STEERING_WHEEL_HEATING))),
        Open("climate"),
        *FRONT_COLD,
        Tap("hvac.comfort"),
        *REAR_COLD,
        ways=((Open("climate"), Tap("hvac.comfort"), *REAR_COLD, Open("climate"), *FRONT_COLD),),
        start=replace(PARIS, signals=HEATED),
    ),
    asked(
        "hvac_no_draught",
        Module.HVAC,
        (
            "{degrees:g} degrees for me, but blow it at my feet, I hate it in my face.",
            "I can't stand a draught up here: air down low, and {degrees:g} on my side.",
            "Set my temperature to {degrees:g} with the air going to the footwell only.",
            "Nothing against my head, please: feet, and make it {degrees:g}.",
            "{degrees:g} degrees for me, with all the air at my feet.",
        ),
        AllOf((SignalIs(HVAC.DRIVER_TEMPERATURE, (param("degrees"),)), SignalIs(HVAC.AIR_DISTRIBUTION, ("DOWN",)))),
        Open("climate"),
        Tap("hvac.air.down"),
        TO_DEGREES,
        ways=((Open("climate"), TO_DEGREES, Tap("hvac.air.down")),),
        deadline=COMFORT,
        parameters={"degrees": WARM_DEGREES},
        scenarios=METRIC,
        tags=frozenset({"preference"}),
    ),
    asked(
        "hvac_auto_degrees",
        Module.HVAC,
        (
            "Climate on auto at {degrees:g} degrees.",
            "Automatic mode, {degrees:g} for the driver.",
            "Let it regulate itself, and hold {degrees:g} on my side.",
            "Auto, please, set to {degrees:g}.",
            "I want {degrees:g} in here, the automatic can do the rest.",
        ),
        AllOf((SignalIs(HVAC.AUTO, (True,)), SignalIs(HVAC.DRIVER_TEMPERATURE, (param("degrees"),)))),
        Open("climate"),
        Tap("hvac.auto"),
        TO_DEGREES,
        ways=((Open("climate"), TO_DEGREES, Tap("hvac.auto")),),
        deadline=COMFORT,
        parameters={"degrees": WARM_DEGREES},
        scenarios=METRIC,
    ),
)
