"""A sensor that measures wrongly: something else in the car, on a trip meter or in a message contradicts it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat
from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.apps.phone.state import EARLIER, Contact, Thread
from automotive_cosim.cockpit.apps.trip import TripMeter
from automotive_cosim.cockpit.signals import ADAS, BODY, DRIVE, ENERGY, LIGHTS, MEDIA, OUTSIDE, SEAT, TYRE
from automotive_cosim.contracts import AlertKind, Weather
from automotive_cosim.tasking.checks import AlertGiven, AllOf, AppDataIs, Check, Counted, SignalIs
from automotive_cosim.tasking.moves import Inform, Open, Tap, TapUntil, Warn
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.records import SaysFigure
from automotive_cosim.tasking.task import Ability, Half, Module, Start
from automotive_cosim.tasking.triggers import All, Driving, SpeedAbove, Trigger
from automotive_cosim.tasks.hard.forms import (
    A_RED_LIGHT,
    ISLA,
    MALIK,
    ON_THE_ROAD,
    OSKAR,
    PARKED,
    PRIYA,
    READ,
    THEO,
    Moves,
    answer,
    done,
    figure,
    hard,
    knowing,
    letter,
    told,
    wait,
    with_letter,
    with_papers,
)

LYON = (4.85, 45.75)
WRONG = (
    "wrong", "wrongly", "faulty", "fault", "defective", "defect", "broken", "stuck", "misread", "misreads",
    "misreading", "mistaken", "error", "implausible", "impossible", "cannot be", "can t be", "not right",
    "isn t right", "incorrect", "incorrectly", "unreliable", "malfunction", "malfunctioning", "not true",
    "isn t true", "false", "not plausible", "isn t plausible", "unrealistic", "contradicts", "dirty", "inaccurate",
    "not correct", "isn t correct", "doesn t match", "does not match", "failed", "failing",
)  # fmt: skip
"""Words that say that a reading is not to be believed."""
GREY = Weather(9.0, 80.0, 0.0, 3, 90.0, 20_000.0, 12.0)
TYRES = (Open("vehicle"), Tap("vehicle.tab.driving"))


def _half(start: Start, goal: tuple[Check, ...], moves: Moves, *slips: Moves, **more: Any) -> Half:
    settings: dict[str, Any] = {"deadline": A_RED_LIGHT, "may_write": READ} | more
    tells = settings.pop("tells", ())
    return replace(done(start, AllOf(goal), moves, slips=slips, **settings), tells=tells)


SIGNS = (80, 90, 110, 130)
IN_TOWN = Trigger(All((Driving(), SpeedAbove(10.0, 50.0, 50.0))), for_s=3.0, within_s=120.0)
READ_RIGHT = (
    Open("map"),
    Open("vehicle"),
    Tap("vehicle.tab.assistance"),
    TapUntil("adas.limiter_speed.decrease", "adas.limiter_speed.value", "50 km/h"),
    Tap("adas.limiter"),
    *answer(THEO, "Yes"),
)
MISREAD = (Open("map"), *answer(THEO, "No"), Inform("The camera reads {sign}, which is wrong: 50 is posted here."))
STREET = with_papers(
    Start(
        "grid",
        "avenue",
        LYON,
        start="2026-11-18T10:10:00",
        weather=GREY,
        signals={ADAS.LIMITER_SPEED.path: 140.0},
    ),
    contacts=knowing(THEO),
)
SIGN_CAMERA = hard(
    "hard_does_it_read_signs",
    Module.ROAD,
    (
        "Does the camera read the limit sign of this street right? If so, limiter on at that and 'Yes' to Theo, who"
        " fitted it; if not, only 'No' to him, and tell me both figures.",
        "Theo wants to know whether his sign camera works. Compare it with what's posted here. It does: set the"
        " limiter"
        " to it, on, and text him Yes. It doesn't: text No and tell me what it reads and what's right.",
        "Check the sign that the car shows against the limit of this road. Right: limiter active at that speed,"
        " Theo"
        " gets a 'Yes'. Wrong: leave the limiter, Theo gets a 'No', and I want to hear the two numbers.",
        "Can I trust the sign in the status bar? See what really is the limit here. If they agree, switch the"
        " limiter on"
        " at it and write Theo yes; if they don't, write him no and tell me the wrong figure and the right one.",
    ),
    _half(
        replace(STREET, sensors={ADAS.LIMIT_SIGN.path: param("sign", {sign: float(sign) for sign in SIGNS})}),
        (told(THEO, "No"),),
        MISREAD,
        READ_RIGHT,
        (Open("map"), *answer(THEO, "No")),
        tells=(("{sign}",), ("50", "fifty")),
        trigger=IN_TOWN,
        may_write=frozenset(),
    ),
    _half(
        STREET,
        (
            SignalIs(ADAS.LIMITER_SPEED, (50.0,)),
            SignalIs(ADAS.LIMITER_ACTIVE, (True,)),
            told(THEO, "Yes"),
        ),
        READ_RIGHT,
        (Open("map"), *answer(THEO, "No")),
        trigger=IN_TOWN,
        may_write=frozenset(),
    ),
    "equipment: the camera misreads the sign, or reads it right",
    parameters={"sign": SIGNS},
    tags=frozenset({"two_modules"}),
    ability=Ability.SENSORS,
    guess_loses="The sign that is shown is right or far off; only what is posted on the road tells which.",
)

SOFT = {"front left": TYRE.FRONT_LEFT, "rear right": TYRE.REAR_RIGHT, "front right": TYRE.FRONT_RIGHT}
STUCK_LOW = replace(
    ON_THE_ROAD,
    interruptions=(Arrival("message", 7.0, OSKAR, "You have a flat tyre, I think!"),),
    sensors=param("wheel", {wheel: {tyre.path: 171.0} for wheel, tyre in SOFT.items()}),
)
THANKS = answer(MALIK, "Thank you")
BY_HAND = hard(
    "hard_measured_by_hand",
    Module.ROAD,
    (
        "The car shows a soft tyre. Malik has just gone round with his gauge and written: a vehicle alert if it's"
        " true,"
        " otherwise tell me that the sensor is wrong. Thank him.",
        "One tyre is low, says the display. See what Malik measured by hand a minute ago. He agrees: alert me to"
        " the"
        " car. He doesn't: no alert, just say that the reading is false. 'Thank you' to him.",
        "Hold the tyre display against Malik's message. If a tyre really is soft, vehicle alert; if it's the"
        " sensor's"
        " fault, tell me so and nothing else. He gets a 'Thank you' in any case.",
        "Malik measured all four tyres with a gauge, it's in his text. Vehicle alert only if one is"
        " soft by his gauge as well; if only the sensor says so, tell me that it's"
        " wrong. And thank Malik.",
    ),
    _half(
        with_letter(STUCK_LOW, MALIK, "Just measured, by hand:", "2.5 on every wheel, all four"),
        (told(MALIK, "Thank you"),),
        (*letter(MALIK), *TYRES, *THANKS, Inform("That tyre's sensor is wrong; by hand all four have 2.5 bar.")),
        (*letter(MALIK), *TYRES, Warn(AlertKind.VEHICLE), *THANKS),
        (*letter(MALIK), *TYRES, *THANKS),
        tells=(WRONG,),
    ),
    _half(
        with_letter(STUCK_LOW, MALIK, "Just measured, by hand:", "1.6 on the {wheel}, the others 2.5"),
        (AlertGiven(AlertKind.VEHICLE), told(MALIK, "Thank you")),
        (*letter(MALIK), *TYRES, Warn(AlertKind.VEHICLE), *THANKS),
        (*letter(MALIK), *TYRES, *THANKS, Inform("The {wheel} tyre's sensor is wrong.")),
    ),
    "content: by hand all tyres have the same, or one is as soft as it is shown",
    parameters={"wheel": tuple(SOFT)},
    tags=frozenset({"two_modules"}),
    ability=Ability.SENSORS,
    guess_loses="The same low figure is shown in both halves; a gauge held by hand contradicts or confirms it.",
)

SLIPPERY = {ADAS.ROAD_FRICTION.path: param("grip", {grip: float(grip) for grip in (6, 9, 12, 14)})}
JANUARY = with_papers(
    replace(
        ON_THE_ROAD,
        start="2026-01-20T10:15:00",
        sensors=SLIPPERY,
    ),
    contacts=knowing(ISLA),
)
ICE = (Open("outside"), Tap("outside.ice"))
SNOWED = (
    *ICE,
    Open("vehicle"),
    Tap("vehicle.tab.driving"),
    Tap("drive.mode.snow"),
    *answer(ISLA, "I'll be 10 minutes late"),
)
ICE_OR_SENSOR = hard(
    "hard_ice_or_sensor",
    Module.PHENOMENON,
    (
        "The car claims that there's hardly any grip. If the weather bears that out, snow mode and 'I'll be 10"
        " minutes"
        " late' to Isla; if it can't be, 'On my way' to her and tell me that it's the sensor.",
        "Grip next to nothing, it says. Can that be in this weather? Yes: drive mode Snow, and the"
        " ten-minutes-late line"
        " for Isla. No: tell me that the reading is wrong, and she gets 'On my way'.",
        "See whether the ice that the car measures is possible with this weather. Possible: snow mode, and text"
        " Isla"
        " that I'm 10 minutes late. Impossible: only tell me so, and text her that I'm on my way.",
        "Check the grip reading against temperature and sky. True, then Snow as the drive mode and 'I'll be 10"
        " minutes"
        " late' for Isla; false, then say to me that the sensor is wrong and write her 'On my way'.",
    ),
    _half(
        replace(JANUARY, weather=Weather(9.0, 60.0, 0.0, 2, 40.0, 20_000.0, 12.0)),
        (told(ISLA, "On my way"),),
        (*ICE, *answer(ISLA, "On my way"), Inform("Dry road at 9 degrees: the grip sensor must be wrong.")),
        SNOWED,
        (*ICE, *answer(ISLA, "On my way")),
        tells=(WRONG,),
        may_write=frozenset(),
    ),
    _half(
        replace(
            JANUARY,
            weather=Weather(-3.0, 95.0, 0.8, 73, 100.0, 2_500.0, 12.0),
            signals={LIGHTS.SWITCH.path: "BEAM"},
        ),
        (SignalIs(DRIVE.MODE, ("SNOW",)), told(ISLA, "I'll be 10 minutes late")),
        SNOWED,
        (*ICE, *answer(ISLA, "On my way"), Inform("The grip sensor must be wrong.")),
        may_write=frozenset(),
    ),
    "weather and settings: dry at nine degrees, or snow at three below zero with the lamps on",
    parameters={"grip": (6, 9, 12, 14)},
    tags=frozenset({"two_modules"}),
    ability=Ability.SENSORS,
    guess_loses="The same grip is measured in both halves, and the weather makes it true in one.",
)

FROST = (-31, -34, -37, -40)
AUTUMN = with_papers(replace(ON_THE_ROAD, start="2026-11-18T08:10:00"), contacts=knowing(OSKAR))
WARMED = (
    Open("outside"),
    Open("climate"),
    Tap("hvac.driver_seat_heating", 2),
    Tap("hvac.steering_wheel_heating"),
    *answer(OSKAR, "{words}"),
)
THERMOMETER = hard(
    "hard_thermometer",
    Module.HVAC,
    (
        "Below 5 degrees outside I want my seat on high and the wheel warm; above it nothing. Tell me if the"
        " thermometer"
        " can't be right. Oskar gets '{words}'.",
        "Seat heat high and wheel heat, if it's truly under 5 out there. A reading that's nonsense doesn't count,"
        " just"
        " tell me so. '{words}' to Oskar.",
        "My rule is five degrees: colder outside, then the seat fully and the wheel. But go by what it really is,"
        " and"
        " say so if the car's thermometer is wrong. And text Oskar '{words}'.",
        "Is it colder than 5 degrees? Then heat my seat, the high level, and the wheel. If the outside thermometer"
        " shows rubbish, tell me, and decide by the weather. Write Oskar '{words}'.",
    ),
    _half(
        replace(
            AUTUMN,
            weather=Weather(12.0, 70.0, 0.0, 2, 40.0, 20_000.0, 12.0),
            sensors={OUTSIDE.TEMPERATURE.path: param("frost", {frost: float(frost) for frost in FROST})},
        ),
        (told(OSKAR, "{words}"),),
        (
            Open("outside"),
            *answer(OSKAR, "{words}"),
            Inform("The thermometer shows {frost}, which is wrong: it is 12 degrees outside."),
        ),
        WARMED,
        (Open("outside"), *answer(OSKAR, "{words}")),
        tells=(WRONG,),
        may_write=frozenset(),
    ),
    _half(
        replace(AUTUMN, weather=Weather(2.0, 85.0, 0.0, 3, 90.0, 20_000.0, 12.0)),
        (
            SignalIs(SEAT.DRIVER_HEATING, (100.0,)),
            SignalIs(SEAT.STEERING_WHEEL_HEATING, (100.0,)),
            told(OSKAR, "{words}"),
        ),
        WARMED,
        (Open("outside"), *answer(OSKAR, "{words}")),
        may_write=frozenset(),
    ),
    "weather and equipment: twelve degrees and a thermometer that shows bitter frost, or two degrees",
    parameters={"frost": FROST, "words": ("On my way", "Yes", "Thank you")},
    tags=frozenset({"two_modules"}),
    ability=Ability.SENSORS,
    guess_loses="The car shows cold in both halves; one figure cannot be in a Paris November, and is not.",
)

SINCE_FULL = {120: 70, 160: 60, 200: 50, 240: 40, 280: 30}
"""Kilometres since the battery was full, and the percent that are left at 1 % for 4 km."""
GAUGE = (Open("charging"), Open("trip"), Tap("trip.other"))
FULL = figure(THEO, "level", Tap("figure.more", 5))
TENS = param("km", {km: abs(left - 50) // 10 for km, left in SINCE_FULL.items()})
BY_TRIP = figure(
    THEO,
    "level",
    Tap(param("km", {km: "figure.more" if left >= 50 else "figure.less" for km, left in SINCE_FULL.items()}), TENS),
)


def _gauge(trip: Any, percent: Any, moves: Moves, wrong: Moves) -> Half:
    start = with_papers(
        replace(PARKED, start="2026-11-18T10:10:00", weather=GREY, sensors={ENERGY.LEVEL.path: 100.0}),
        contacts=knowing(THEO),
        trip_b=trip,
    )
    return _half(
        start,
        (SaysFigure(THEO, "battery", percent, 3.0),),
        (*GAUGE, *moves),
        (*GAUGE, *wrong),
        may_write=frozenset(),
    )


FULL_OR_STUCK = hard(
    "hard_full_or_stuck",
    Module.APPS,
    (
        "Theo wants to know what's in the battery: text him the percentage. I zeroed trip B when it was last full;"
        " if"
        " the gauge can't be right by that, one percent for every 4 km.",
        "Send Theo the battery's level. The gauge sticks at times, so look at trip B, which began at the last full"
        " charge: should they contradict each other, reckon 4 km to a percent.",
        "What has the battery got? Theo gets the figure in percent. Compare the gauge with trip B (zeroed when"
        " full),"
        " and if it's stuck, take 1 % off for each 4 km.",
        "Text Theo how full the battery is, in percent. Trip B runs since it was at 100; where gauge and trip"
        " disagree"
        " the trip is right, at four kilometres a percent.",
    ),
    _gauge(
        param("km", {km: TripMeter(km * 1000.0, km * 72.0, km / 4 * 0.7) for km in SINCE_FULL}),
        param("km", SINCE_FULL),
        BY_TRIP,
        FULL,
    ),
    _gauge(TripMeter(1_200.0, 300.0, 0.2), 100, FULL, BY_TRIP),
    "content: the trip since the full charge was long, or is a mile",
    parameters={"km": tuple(SINCE_FULL)},
    tags=frozenset({"two_modules"}),
    ability=Ability.SENSORS,
    guess_loses="The gauge says 100 in both halves; the trip since it was full tells whether it can.",
)

LIGHT_THINGS = (0.6, 0.9, 1.2, 1.4)


def _on_the_seat(weight_kg: Any, goal: Check, moves: Moves, *wrong: Moves, **more: Any) -> Half:
    child = Occupant(Seat.REAR_RIGHT, Kind.CHILD, weight_kg, belted=False)
    start = with_papers(replace(ON_THE_ROAD, aboard=(child,)), contacts=knowing(ISLA))
    return _half(start, (goal,), (Open("cabin"), *moves), *wrong, may_write=frozenset(), **more)


NOBODY = (*answer(ISLA, "No"), Inform("The seat camera is wrong: what weighs {kg} kg is no child."))
CHILD_OR_BAG = hard(
    "hard_child_or_bag",
    Module.SYSTEM,
    (
        "The car says that a child sits behind without a belt; I've only got my bag there, or have I? A belt alert"
        " if"
        " it's a child. If it can't be one, 'No' to Isla and tell me that the car errs.",
        "Behind on the right a child, unbelted? Look at all that the seat reports. If there may be one, the"
        " seat-belt"
        " alert; if that's impossible, text Isla 'No' and tell me it's wrong.",
        "Isla asks if her boy crept in behind me. If the rear seat can hold a child by what's measured, sound the"
        " belt"
        " alert, he isn't belted; otherwise write her 'No' and tell me that the camera is mistaken.",
        "Check the rear right seat: is that really a child, as the screen has it? Then alert me to the open belt."
        " If the weight says it can't be, write Isla 'No' and tell me that the car is wrong.",
    ),
    _on_the_seat(
        param("kg", {kg: kg for kg in LIGHT_THINGS}),
        told(ISLA, "No"),
        NOBODY,
        (Open("cabin"), Warn(AlertKind.SEAT_BELT)),
        (Open("cabin"), *answer(ISLA, "No")),
        tells=(WRONG,),
    ),
    _on_the_seat(
        param("kg", {kg: round(kg * 10 + 8, 1) for kg in LIGHT_THINGS}),
        AlertGiven(AlertKind.SEAT_BELT),
        (Open("safety"), Tap("safety.kind.seat_belt"), Tap("safety.warn")),
        (Open("cabin"), *answer(ISLA, "No"), Inform("The camera is wrong, that is no child.")),
    ),
    "occupants: what is taken for a child weighs a kilogram, or as much as a child",
    parameters={"kg": LIGHT_THINGS},
    tags=frozenset({"two_modules"}),
    ability=Ability.SENSORS,
    guess_loses="A child is reported in both halves; the weight on the same screen rules it out in one.",
)

LOW = (2, 3, 4, 6)
WASHED = (
    *letter(MALIK),
    Open("vehicle"),
    Tap("wiper.wash", 2),
    *answer(MALIK, "Thank you"),
)


def _serviced(line: str, goal: tuple[Check, ...], moves: Moves, *wrong: Moves, **more: Any) -> Half:
    level = param("level", {level: float(level) for level in LOW})
    start = with_letter(
        replace(PARKED, sensors={BODY.WASHER_FLUID.path: level}), MALIK, "Your car is done: oil, brakes.", line
    )
    return _half(start, (*goal, told(MALIK, "Thank you")), moves, *wrong, **more)


WASHER_GAUGE = hard(
    "hard_washer_gauge",
    Module.PHENOMENON,
    (
        "Just out of Malik's garage, the windscreen is filthy: wash it twice, unless the tank really is as empty"
        " as the"
        " car shows; Malik's message tells. If the gauge is wrong, tell me. Thank him.",
        "Two squirts on the windscreen, provided there's fluid. The gauge says hardly any; see what Malik writes"
        " of the"
        " service. A wrong gauge I want to hear of. Malik gets a 'Thank you'.",
        "Is the washer tank empty, or is it the gauge? Malik, who serviced the car, has written. With fluid in it"
        " wash"
        " twice and tell me that the gauge errs, without it don't. 'Thank you' to him.",
        "Wash the front window two times if Malik's note about the service says that there is fluid, and tell me"
        " then"
        " that the level shown is wrong. If there's none, leave it. Text Malik 'Thank you' either way.",
    ),
    _serviced(
        "Washer tank filled to the brim",
        (Counted("washer", 2),),
        (*WASHED, Inform("The washer gauge is wrong: it shows {level} %, and the tank has just been filled.")),
        (*letter(MALIK), Open("vehicle"), *answer(MALIK, "Thank you")),
        WASHED,
        tells=(WRONG,),
    ),
    _serviced(
        "Washer tank: we had no fluid left, fill it yourself",
        (),
        (*letter(MALIK), Open("vehicle"), *answer(MALIK, "Thank you")),
        WASHED,
    ),
    "content: the tank was filled, or it was not",
    parameters={"level": LOW},
    tags=frozenset({"two_modules"}),
    ability=Ability.SENSORS,
    guess_loses="The gauge is nearly at zero in both halves; a message says whether the tank is.",
)

PLUGGED = replace(PARKED, start="2026-11-18T07:40:00", weather=GREY, sensors={ENERGY.CABLE.path: True})
ROOMS = ("hall", "cellar", "kitchen", "garden shed")


def _unplugs(line: str, goal: tuple[Check, ...], moves: Moves, *wrong: Moves, **more: Any) -> Half:
    start = with_letter(PLUGGED, ISLA, "Good morning!", line)
    return _half(
        start,
        (*goal, told(ISLA, "Thank you")),
        (*letter(ISLA), Open("charging"), *moves),
        *((*letter(ISLA), Open("charging"), *slip) for slip in wrong),
        **more,
    )


THANK_ISLA = answer(ISLA, "Thank you")
CABLE_OR_NOT = hard(
    "hard_cable_or_sensor",
    Module.APPS,
    (
        "I want to drive off, and the car says that the cable's in. Isla has written about it: if it is in, a"
        " vehicle"
        " alert; if it can't be, tell me that the car is wrong. Thank her.",
        "Is the charging cable still plugged in, as the screen has it? See Isla's message too. Yes: alert me to the"
        " vehicle. No: say that the sensor is wrong. 'Thank you' to Isla.",
        "Check the cable before I leave, on the screen and by what Isla writes. A vehicle alert if we'd tear it"
        " off;"
        " if it can't be in, just tell me that the reading is false. She gets a 'Thank you'.",
        "The display has us plugged in. Read what Isla says of the cable: if that fits, sound the vehicle alert,"
        " and if"
        " it shows that the display is wrong, tell me so without one. Then thank Isla.",
    ),
    _unplugs(
        "Your charging cable lies in the {room}, I've just stumbled over it",
        (),
        (*THANK_ISLA, Inform("The car is wrong: the cable lies in the {room}.")),
        (Warn(AlertKind.VEHICLE), *THANK_ISLA),
        THANK_ISLA,
        tells=(WRONG,),
    ),
    _unplugs(
        "The cable isn't in the {room}, it must still be in the car's socket",
        (AlertGiven(AlertKind.VEHICLE),),
        (Warn(AlertKind.VEHICLE), *THANK_ISLA),
        (*THANK_ISLA, Inform("The car is wrong, the cable is not in.")),
    ),
    "content: the cable has been found at home, or not",
    parameters={"room": ROOMS},
    tags=frozenset({"two_modules"}),
    ability=Ability.SENSORS,
    guess_loses=(
        "The screen says that it is plugged in in both halves; a message tells that it lies elsewhere, or fits."
    ),
)

CARGO = {"9.4": 9.4, "8.7": 8.7, "10.2": 10.2, "9.9": 9.9}


def _front_seat(line: str, goal: tuple[Check, ...], moves: Moves, *wrong: Moves, **more: Any) -> Half:
    thing = Occupant(Seat.PASSENGER, Kind.BABY, param("kg", CARGO))
    start = with_letter(replace(PARKED, aboard=(thing,)), ISLA, "All ready for you", line)
    look = (*letter(ISLA), Open("cabin"))
    return _half(
        start,
        (*goal, told(ISLA, "Thank you")),
        (*look, *moves, *THANK_ISLA),
        *((*look, *slip, *THANK_ISLA) for slip in wrong),
        **more,
    )


AIRBAG_OFF = (Tap("cabin.passenger_airbag"),)
ON_THE_FRONT_SEAT = hard(
    "hard_on_the_front_seat",
    Module.SYSTEM,
    (
        "Isla has put something on the front seat and written what. Set the passenger airbag as it must be for"
        " that,"
        " tell me if the seat takes it for something else, and thank her.",
        "See what Isla placed beside me, by her message and by the cabin screen. The passenger's airbag has to"
        " suit it;"
        " if the screen is wrong about it, tell me. Isla gets a 'Thank you'.",
        "There's something on the passenger seat. Isla wrote what it is: airbag on or off accordingly, and a word"
        " to me"
        " if the seat's sensor mistakes it. Then 'Thank you' to her.",
        "Read from Isla what is beside me and switch the airbag of that seat on or off, as is right for it; should"
        " the car be wrong about what it is, tell me. Text Isla 'Thank you'.",
    ),
    _front_seat(
        "our {kg} kg baby is in the carrier, facing backwards",
        (SignalIs(SEAT.PASSENGER_AIRBAG, (False,)),),
        AIRBAG_OFF,
        (),
    ),
    replace(
        _front_seat(
            "our {kg} kg pumpkin is strapped in, like a baby",
            (),
            (),
            AIRBAG_OFF,
        ),
        moves=(
            *letter(ISLA),
            Open("cabin"),
            *THANK_ISLA,
            Inform("The seat's sensor is wrong: it takes the pumpkin for a baby. The airbag stays on."),
        ),
        tells=((*WRONG, "mistakes", "mistook", "takes", "thinks"),),
    ),
    "content: it is a baby, or a pumpkin that the seat takes for one",
    parameters={"kg": tuple(CARGO)},
    tags=frozenset({"two_modules"}),
    ability=Ability.SENSORS,
    guess_loses="The seat reports a baby of the same weight in both halves, and is wrong about it in one.",
)

BEN = "Ben Nair"
BEHIND = (Occupant(Seat.REAR_LEFT, Kind.CHILD, asleep=True),)
LISTS = ("Road trip", "Sunday", "Dance", "Calm")
HE_WRITES = (Open("cabin"), *wait(8), *letter(BEN))
PLAYS = (Open("media"), Tap("media.list.playlists"), Tap(text="{playlist}"), Tap("playlist.play"))


def _behind(arrival: Arrival, goal: tuple[Check, ...], moves: Moves, wrong: Moves) -> Half:
    start = with_papers(
        replace(ON_THE_ROAD, aboard=BEHIND, interruptions=(arrival,)),
        contacts=(Contact(BEN, "555 45 72"), *knowing(PRIYA, OSKAR)),
        threads=(Thread(BEN, EARLIER, ("Later please the playlist {playlist}",), unread=True),),
    )
    return _half(
        start, goal, moves, wrong, may_write=READ | {MEDIA.SOURCE.path, MEDIA.SELECTED.path, "media.playlist"}
    )


AWAKE = (*HE_WRITES, *PLAYS, *answer(PRIYA, "No"))
BEN_ASLEEP = hard(
    "hard_is_ben_asleep",
    Module.MEDIA,
    (
        "Is Ben asleep, asks Priya, his mother. The camera behind is greasy, so look whether he writes, give "
        "it ten seconds. Asleep: 'Yes' to her, no music. Awake: 'No', and put on what he asked for.",
        "Find out if Ben, behind me, is really asleep: the camera says so, but he may write any moment, wait ten"
        " seconds."
        " If he is, only tell Priya yes; if he isn't, play the list he wanted and tell her no.",
        "Priya wants to know if Ben's asleep. Don't just believe the camera, see in ten seconds or so what comes"
        " from"
        " his phone. Then a Yes to Priya; or a No, and the list he has asked for.",
        "Is Ben asleep, as the seat camera has it? Wait some ten seconds for a sign of life on the phone. No sign:"
        " text"
        " Priya 'Yes' and leave it quiet. If there is one: 'No' to her, and play the list he had asked for.",
    ),
    _behind(
        Arrival("message", 5.0, BEN, "Are we there yet? I'm bored"),
        (SignalIs(MEDIA.ACTION, ("PLAY",)), AppDataIs("media.playlist", ("{playlist}",)), told(PRIYA, "No")),
        AWAKE,
        (*HE_WRITES, *answer(PRIYA, "Yes")),
    ),
    _behind(
        Arrival("message", 5.0, OSKAR, "Are you there yet? I'm bored"),
        (told(PRIYA, "Yes"),),
        (*HE_WRITES, *answer(PRIYA, "Yes")),
        AWAKE,
    ),
    "events: he writes from the back seat, or somebody else does",
    parameters={"playlist": LISTS},
    tags=frozenset({"two_modules"}),
    ability=Ability.SENSORS,
    guess_loses=(
        "The camera reports him asleep in both halves; a message of his that comes later shows that he is not."
    ),
)

TASKS = (
    SIGN_CAMERA,
    BY_HAND,
    ICE_OR_SENSOR,
    THERMOMETER,
    FULL_OR_STUCK,
    CHILD_OR_BAG,
    WASHER_GAUGE,
    CABLE_OR_NOT,
    ON_THE_FRONT_SEAT,
    BEN_ASLEEP,
)
