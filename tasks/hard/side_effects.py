"""What the obvious button does besides, and what has to be put back: links, windows, both seats, lamps."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import company
from automotive_cosim.cockpit.apps.calendar import Appointment
from automotive_cosim.cockpit.signals import BODY, CABIN, HMI, HVAC, LINK, MEDIA, MIRROR, SEAT, VOICE
from automotive_cosim.cockpit.vehicle import WINDOWS
from automotive_cosim.contracts import Weather
from automotive_cosim.tasking.checks import AllOf, AppDataIs, Entered, SignalIs
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Ability, Deadline, Module
from automotive_cosim.tasks.hard.forms import (
    A_RED_LIGHT,
    MALIK,
    ON_THE_ROAD,
    PARKED,
    THE_OTHER_WAITS,
    Moves,
    done,
    hard,
    knowing,
    with_papers,
    write_to,
)

CONNECTIONS = (Open("settings"), Tap("settings.page.connections"))
BLUETOOTH = (*CONNECTIONS, Tap("link.bluetooth"))
TOLD = {
    "I've arrived": "I've arrived",
    "yes": "Yes",
    "no": "No",
    "thank you": "Thank you",
    "on my way": "On my way",
}
TEXT_MALIK = (*write_to(MALIK), Tap(text=param("words", TOLD)))
UNPAIRED = with_papers(
    replace(PARKED, signals={LINK.BLUETOOTH.path: False, MEDIA.SOURCE.path: "DAB"}), contacts=knowing(MALIK)
)
BLUETOOTH_BACK = hard(
    "hard_bluetooth_back",
    Module.COMMS,
    (
        "Bluetooth is off to save the phone. Send Malik '{words}' anyway, and leave the link as you found it.",
        "Malik needs a '{words}' from me. Whatever has to be switched on for that goes off again afterwards.",
        "Text '{words}' to Malik; the phone isn't linked, so link it for that and then break the link once more.",
        "Get '{words}' through to Malik and end with everything as it is now, the wireless link to my phone"
        " included.",
    ),
    done(
        UNPAIRED,
        AllOf(
            (
                Entered("messages.sent", {"to": MALIK, "text": param("words", TOLD)}),
                SignalIs(LINK.BLUETOOTH, (False,)),
            )
        ),
        (*BLUETOOTH, *TEXT_MALIK, *BLUETOOTH),
        slips=((*BLUETOOTH, *TEXT_MALIK), TEXT_MALIK),
        deadline=THE_OTHER_WAITS,
    ),
    parameters={"words": tuple(TOLD)},
    tags=frozenset({"two_modules"}),
    ability=Ability.CHAIN,
    guess_loses="The link has to come on for the message and go off after it; either half alone leaves it wrong.",
)

STAYS = {"half an hour": 30, "one hour": 60, "two hours": 120, "four hours": 240}
PAY = (
    Open("parking"),
    Tap(text="Zone {zone}"),
    Tap(param("stay", {words: f"parking.time.{minutes}" for words, minutes in STAYS.items()})),
    Tap("parking.pay"),
)
MOBILE = (*CONNECTIONS, Tap("link.mobile"))
DATA_FOR_A_TICKET = hard(
    "hard_data_for_a_ticket",
    Module.APPS,
    (
        "Roaming costs a fortune, so mobile data stays off. Only for paying {stay} in zone {zone} may you use it.",
        "Buy {stay} of parking, zone {zone}. The data link on for that and not a moment longer.",
        "Zone {zone}, {stay}, please pay. If that needs the network: on, pay, off again.",
        "I keep the car offline abroad. Get me a ticket for {stay} in {zone} all the same, then take"
        " it offline again.",
    ),
    done(
        replace(PARKED, signals={LINK.MOBILE_DATA.path: False}),
        AllOf(
            (
                Entered("payments", {"zone": "Zone {zone}", "minutes": param("stay", STAYS)}),
                AppDataIs("parking.zone", ("Zone {zone}",)),
                AppDataIs("parking.minutes", (param("stay", STAYS),)),
                SignalIs(LINK.MOBILE_DATA, (False,)),
            )
        ),
        (*MOBILE, *PAY, *MOBILE),
        slips=(PAY, (*MOBILE, *PAY)),
        may_write=frozenset(),
    ),
    parameters={"stay": tuple(STAYS), "zone": ("B", "C")},
    tags=frozenset({"two_modules"}),
    ability=Ability.CHAIN,
    guess_loses="The payment is refused without the data link, which must be off again at the end.",
)

DOORS = (Open("vehicle"), Tap("vehicle.tab.doors"))
HOT = Weather(34.0, 45.0, 0.0, 0, 10.0, 20_000.0, 8.0)
OPEN_CAR = replace(
    ON_THE_ROAD,
    start="2026-07-21T14:15:00",
    weather=HOT,
    cabin={"temperature_c": 38.0},
    signals={window.path: 60.0 for window in WINDOWS},
)
CRACKED = (
    *DOORS,
    Slide("window.driver", 20.0),
    Slide("window.passenger", 20.0),
    Slide("window.rear_left", 20.0),
    Slide("window.rear_right", 20.0),
)
COOL = (
    Open("climate"),
    Tap("hvac.air_conditioning"),
    Slide("hvac.fan", param("fan")),
    TapUntil("hvac.driver_temperature.decrease", "hvac.driver_temperature", "{degrees}.0 °C"),
)
COOL_WITH_AIR = hard(
    "hard_cool_with_a_crack",
    Module.HVAC,
    (
        "It's an oven. A/C on, fan {fan}, {degrees} degrees for both of us, but leave each window open a fifth.",
        "Cooling, please, at {degrees} with the blower on {fan}. I'd still like a gap: all four windows at 20"
        " percent.",
        "Get the air conditioning going, {degrees} on both sides and {fan} on the fan; windows not shut, just 20"
        " percent each.",
        "Make it cold: air conditioning on, {fan} on the fan, {degrees} left and right, and all four windows"
        " at 20.",
    ),
    done(
        OPEN_CAR,
        AllOf(
            (
                *(SignalIs(window, (20.0,)) for window in WINDOWS),
                SignalIs(HVAC.AIR_CONDITIONING, (True,)),
                SignalIs(HVAC.FAN_SPEED, (param("fan"),)),
                SignalIs(HVAC.DRIVER_TEMPERATURE, (param("degrees"),)),
                SignalIs(HVAC.PASSENGER_TEMPERATURE, (param("degrees"),)),
            )
        ),
        (*CRACKED, *COOL),
        slips=((*COOL, *CRACKED), (*DOORS, Tap("window.close_all"), *COOL)),
        may_write=frozenset(),
        deadline=A_RED_LIGHT,
    ),
    parameters={"fan": (60, 70, 80, 90), "degrees": (18, 19)},
    tags=frozenset({"two_modules", "conflict"}),
    ability=Ability.CHAIN,
    guess_loses=(
        "Cooling comes on only with the windows nearly closed, and the button that closes them all closes too much."
    ),
)

WARM = (17, 18, 19, 20, 21)
SWAPPED = {
    HVAC.SYNC.path: False,
    HVAC.DRIVER_TEMPERATURE.path: 23.5,
    HVAC.PASSENGER_TEMPERATURE.path: param("warm", {warm: float(warm) for warm in WARM}),
    SEAT.DRIVER_HEATING.path: 100.0,
    SEAT.PASSENGER_HEATING.path: -50.0,
}
DRIVERS_SIDE = (
    TapUntil("hvac.driver_temperature.decrease", "hvac.driver_temperature", "{warm}.0 °C"),
    Tap("hvac.driver_seat_heating"),
    Tap("hvac.driver_seat_airing"),
)
PASSENGERS_SIDE = (
    TapUntil("hvac.passenger_temperature.increase", "hvac.passenger_temperature", "23.5 °C"),
    Tap("hvac.passenger_seat_heating", 2),
)
SWAP_SIDES = hard(
    "hard_swap_sides",
    Module.HVAC,
    (
        "You've mixed the two of us up: my degrees and my seat are hers, and hers mine. Swap them.",
        "Temperature and seat got put on the wrong sides just now. Left to right and right to left, please.",
        "That's exactly the wrong way round! What I have she wanted, warmth and seat; exchange the two sides.",
        "Correct yourself: her setting is on my side and mine on hers, degrees and seats alike.",
    ),
    done(
        replace(ON_THE_ROAD, signals=SWAPPED, aboard=company(2)),
        AllOf(
            (
                SignalIs(HVAC.DRIVER_TEMPERATURE, (param("warm", {warm: float(warm) for warm in WARM}),)),
                SignalIs(HVAC.PASSENGER_TEMPERATURE, (23.5,)),
                SignalIs(SEAT.DRIVER_HEATING, (-50.0,)),
                SignalIs(SEAT.PASSENGER_HEATING, (100.0,)),
            )
        ),
        (Open("climate"), *DRIVERS_SIDE, *PASSENGERS_SIDE),
        slips=(
            (Open("climate"), *DRIVERS_SIDE),
            (Open("climate"), *PASSENGERS_SIDE),
            (Open("climate"), Tap("hvac.sync")),
        ),
        may_write=frozenset(),
        deadline=A_RED_LIGHT,
    ),
    parameters={"warm": WARM},
    tags=frozenset({"preference"}),
    ability=Ability.OCCUPANTS,
    guess_loses="Each side has what the other wants; levelling them, or setting one, gives nobody what is theirs.",
)

EVENING = replace(
    ON_THE_ROAD,
    start="2026-11-17T22:40:00",
    signals={
        CABIN.DOME_LIGHT.path: True,
        CABIN.DRIVER_READING_LIGHT.path: True,
        CABIN.PASSENGER_READING_LIGHT.path: True,
        CABIN.AMBIENT_LIGHT.path: 80.0,
        MEDIA.SOURCE.path: "DAB",
        MEDIA.ACTION.path: "PLAY",
        VOICE.GUIDANCE_VOLUME.path: 80.0,
    },
)
INSIDE = (Open("vehicle"), Tap("vehicle.tab.interior"))
DARKENED = (
    *INSIDE,
    Tap("light.dome"),
    Tap("light.driver_reading"),
    Tap("light.passenger_reading"),
    Slide("light.ambient", 0.0),
    Open("settings"),
    Slide("settings.brightness", param("percent")),
    Open("media"),
    Tap("media.play"),
)
DARK_AND_QUIET = hard(
    "hard_dark_and_quiet",
    Module.SYSTEM,
    (
        "Everything that shines in here off, the display down to {percent}, and stop the radio: I can't see"
        " the road.",
        "Kill all the light inside and the music; screen at {percent}. The glare is making me blind.",
        "Too bright, too loud. All lamps in the cabin out, the glow along the doors too, radio stopped, display"
        " {percent}.",
        "I need it dark around me: no lamp on inside, the screen at {percent}, and the radio stopped.",
    ),
    done(
        EVENING,
        AllOf(
            (
                SignalIs(CABIN.DOME_LIGHT, (False,)),
                SignalIs(CABIN.DRIVER_READING_LIGHT, (False,)),
                SignalIs(CABIN.PASSENGER_READING_LIGHT, (False,)),
                SignalIs(CABIN.AMBIENT_LIGHT, (0.0,)),
                SignalIs(HMI.BRIGHTNESS, (param("percent"),)),
                SignalIs(MEDIA.ACTION, ("STOP",)),
            )
        ),
        DARKENED,
        slips=((*DARKENED, Open("vehicle"), Tap("vehicle.tab.lights"), Tap("lights.switch.off")), DARKENED[:-3]),
        may_write=frozenset(),
        deadline=Deadline(
            45.0, "eyes begin to adapt only once it is dark (CIE 88:2004); the lit stretch ends in under a minute"
        ),
    ),
    parameters={"percent": (10, 20, 30, 40, 50)},
    tags=frozenset({"two_modules"}),
    ability=Ability.CHAIN,
    guess_loses="What shines is on three screens, and the switch that ends all light ends that on the road too.",
)

AGENDA = (
    Appointment(param("first"), "Dentist", "Work"),
    Appointment("13:15", "Lunch with Bea", "Home"),
    Appointment("17:30", "Call with Tokyo", "Work"),
)
EARLIER = {"10:00": "09:00", "10:30": "09:30", "11:00": "10:00", "11:30": "10:30", "12:00": "11:00"}


def _earlier(*entries: int) -> Moves:
    return tuple(
        move
        for at in entries
        for move in (Open("calendar"), Tap(f"calendar.{at}"), Tap("appointment.hour_earlier"))
    )


HOUR_OFF = hard(
    "hard_calendar_an_hour_off",
    Module.APPS,
    (
        "The clocks went back and you've entered today's dates an hour too late. Put all of them right.",
        "Every appointment today stands one hour late because of winter time; correct the lot.",
        "All of today's entries are to be an hour earlier, you forgot the time change.",
        "You got the clock change wrong: put each of today's appointments an hour earlier, please.",
    ),
    done(
        with_papers(PARKED, agenda=AGENDA),
        AppDataIs(
            "calendar.entries",
            (
                param(
                    "first",
                    {
                        at: [
                            {"at": then, "title": "Dentist", "place": "Work"},
                            {"at": "12:15", "title": "Lunch with Bea", "place": "Home"},
                            {"at": "16:30", "title": "Call with Tokyo", "place": "Work"},
                        ]
                        for at, then in EARLIER.items()
                    },
                ),
            ),
        ),
        _earlier(0, 1, 2),
        slips=(_earlier(0, 1), (*_earlier(0, 1, 2), Tap("appointment.hour_earlier"))),
        may_write=frozenset(),
    ),
    parameters={"first": tuple(EARLIER)},
    ability=Ability.CHAIN,
    guess_loses="Three entries move, each on a page of its own, and one that is moved twice is wrong again.",
)

WASH = (
    Open("vehicle"),
    Tap("vehicle.tab.mirrors"),
    Tap("mirror.driver.fold"),
    Tap("mirror.passenger.fold"),
    Tap("vehicle.tab.doors"),
    Tap("window.close_all"),
    Slide("window.sunroof", 0.0),
    Tap("window.lock"),
    Tap("vehicle.tab.lights"),
    Tap("wiper.front.off"),
)
CAR_WASH = hard(
    "hard_car_wash",
    Module.SYSTEM,
    (
        "Car wash: everything shut, mirrors in, no wiping by itself, rear windows blocked, and recirculate the"
        " air.",
        "Get us ready for the brushes, windows and roof closed, wipers dead, both mirrors folded, window switches"
        " locked, no outside air.",
        "We roll into the wash in a moment. Fold the mirrors, close the lot, front wiper off, kids' windows locked,"
        " air recirculating.",
        "For the car wash: mirrors folded, all windows and the sunroof shut, the front wipers off, the rear "
        "window switches locked, and recirculation.",
    ),
    done(
        replace(
            PARKED,
            signals={window.path: 30.0 for window in WINDOWS[:2]} | {CABIN.SUNROOF.path: 50.0},
            aboard=param("people", {people: company(people) for people in (1, 2, 3, 4, 5)}),
        ),
        AllOf(
            (
                *(SignalIs(window, (0.0,)) for window in (*WINDOWS, CABIN.SUNROOF)),
                *(SignalIs(mirror, (True,)) for mirror in (MIRROR.DRIVER_FOLDED, MIRROR.PASSENGER_FOLDED)),
                SignalIs(CABIN.WINDOW_LOCK, (True,)),
                SignalIs(BODY.FRONT_WIPER, ("OFF",)),
                SignalIs(HVAC.RECIRCULATION, (True,)),
            )
        ),
        (*WASH, Open("climate"), Tap("hvac.recirculation")),
        slips=(
            (
                *(move for move in WASH if not isinstance(move, Slide)),
                Open("climate"),
                Tap("hvac.recirculation"),
            ),
            (*WASH[:-1], Tap("wiper.front.interval"), Open("climate"), Tap("hvac.recirculation")),
            WASH,
        ),
        may_write=frozenset({CABIN.SUNROOF_SHADE.path}),
    ),
    parameters={"people": (1, 2, 3, 4, 5)},
    tags=frozenset({"two_modules"}),
    ability=Ability.CHAIN,
    guess_loses="Ten things on five screens, of which the usual button covers only some.",
)

TASKS = (
    BLUETOOTH_BACK,
    DATA_FOR_A_TICKET,
    COOL_WITH_AIR,
    SWAP_SIDES,
    DARK_AND_QUIET,
    HOUR_OFF,
    CAR_WASH,
)
