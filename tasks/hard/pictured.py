"""What is needed stands on a photo alone: a sign, a dial, a clock, a mark, a lamp, who sits where.

The list of elements says that a message has a photo, not what it shows. Each pair gives the photo another sense by
what it shows or by the words beside it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.apps.calendar import Appointment
from automotive_cosim.cockpit.apps.phone.state import EARLIER, Thread
from automotive_cosim.cockpit.belongings import Belongings
from automotive_cosim.cockpit.photos import Photo, Shows
from automotive_cosim.cockpit.signals import ADAS, CABIN, HVAC, LINK, SEAT
from automotive_cosim.tasking.checks import AllOf, AppDataIs, Entered, SignalIs
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import Choices, param
from automotive_cosim.tasking.records import AppDataAt, SaysFigure
from automotive_cosim.tasking.task import NEEDS_PICTURE, Ability, Module, Start, Task
from automotive_cosim.tasks.hard.forms import (
    BEA,
    ISLA,
    MALIK,
    OSKAR,
    PARKED,
    PRIYA,
    THEO,
    WANDA,
    YUSUF,
    Moves,
    answer,
    done,
    figure,
    hard,
    knowing,
    letter,
)


def sent(who: str, photo: Photo, *lines: Any, start: Start = PARKED, **papers: Any) -> Start:
    """The start with somebody known who has sent a photo."""
    thread = Thread(who, EARLIER, lines, unread=True, photo=photo)
    contacts = papers.pop("contacts", knowing(who))
    return replace(start, belongings=Belongings(contacts, (thread,), **papers))


def pictured(
    task_id: str,
    module: Module,
    says: tuple[str, ...],
    first: Any,
    second: Any,
    difference: str,
    guess_loses: str,
    **parameters: Choices,
) -> Task:
    """A pair that nobody can win who does not see the picture."""
    return hard(
        task_id,
        module,
        says,
        first,
        second,
        difference,
        parameters=parameters,
        tags=frozenset({NEEDS_PICTURE}),
        ability=Ability.CONTENT,
        guess_loses=guess_loses,
    )


STAYS = {"half an hour": 30, "an hour": 60, "two hours": 120, "four hours": 240}
MINUTES = param("stay", STAYS)
FOR_STAY = Tap(param("stay", {words: f"parking.time.{minutes}" for words, minutes in STAYS.items()}))
PAID = AllOf(
    (
        Entered("payments", {"zone": "Zone {zone}", "minutes": MINUTES}),
        AppDataIs("parking.zone", ("Zone {zone}",)),
        AppDataIs("parking.minutes", (MINUTES,)),
        Entered("messages.sent", {"to": ISLA, "text": "Yes"}),
    )
)
OTHER_ZONE = {"A": "B", "B": "C", "C": "A"}


def _ticket(zone: Any) -> Moves:
    return (*letter(ISLA), Open("parking"), Tap(text=zone), FOR_STAY, Tap("parking.pay"), *answer(ISLA, "Yes"))


SIGN = "That's the sign where you've parked, you'll need {stay}"
ZONE_ON_THE_SIGN = pictured(
    "hard_zone_on_the_sign",
    Module.APPS,
    (
        "Isla photographed the parking sign. Pay that zone for as long as she says and answer Yes; if its zone ends"
        " here, only No.",
        "Get the ticket by the sign on Isla's photo, the time's in her message, then text her 'Yes'. Where the sign"
        " says the zone is over, she gets a 'No' instead.",
        "What's on Isla's picture decides: a ticket for the zone it shows, her duration, and a yes to her,"
        " or nothing"
        " but a no if paid parking stops at that sign.",
        "Look at the sign Isla sent. Buy what it asks for, with the stay she writes, and tell her yes; if"
        " the sign ends the zone, tell her only no.",
    ),
    done(
        sent(ISLA, Photo(Shows.ZONE, param("zone")), SIGN),
        PAID,
        _ticket("Zone {zone}"),
        slips=(
            _ticket(param("zone", {zone: f"Zone {other}" for zone, other in OTHER_ZONE.items()})),
            (*letter(ISLA), *answer(ISLA, "No")),
        ),
    ),
    done(
        sent(ISLA, Photo(Shows.ZONE, param("zone"), struck=True), SIGN),
        Entered("messages.sent", {"to": ISLA, "text": "No"}),
        (*letter(ISLA), *answer(ISLA, "No")),
        slips=(_ticket("Zone {zone}"),),
    ),
    "content: the sign on the photo is for a zone, or for its end",
    stay=tuple(STAYS),
    zone=tuple(OTHER_ZONE),
    guess_loses="The letter, and whether the zone ends there, is on the photo alone.",
)

SHOWN = {"15:45": 3, "16:15": 5, "16:30": 6, "16:45": 7, "17:15": 9}
"""Time on the clock, and quarters of an hour from the appointment to it."""
HOUR_ON = {time: f"{int(time[:2]) + 1}{time[2:]}" for time in SHOWN}
MARKET = "Corner Market"
REPAIR = (Appointment("09:00", "Briefing", "Work"), Appointment("15:00", "Watch repair", MARKET))
OPEN = {MARKET: "Open until 20:00"}


def _moved(quarters: dict[str, int]) -> Moves:
    return (
        *letter(MALIK),
        Open("calendar"),
        Tap("calendar.1"),
        Tap("appointment.later", param("time", quarters)),
        *answer(MALIK, "Yes"),
    )


def _repair(times: dict[str, str]) -> AllOf:
    moved = param("time", {time: {"at": at} for time, at in times.items()})
    return AllOf((AppDataAt("calendar.entries", 1, moved), Entered("messages.sent", {"to": MALIK, "text": "Yes"})))


AS_SHOWN, AN_HOUR_ON = _moved(SHOWN), _moved({time: quarters + 4 for time, quarters in SHOWN.items()})
MALIKS_CLOCK = pictured(
    "hard_maliks_clock",
    Module.APPS,
    (
        "Malik has photographed a clock: that's when he can do my watch this afternoon. Put it in the calendar and"
        " tell him yes.",
        "Move the watch repair to the hour that Malik means with his picture of a clock, then answer 'Yes'.",
        "The repair's at another time today, see the clock in Malik's photo and what he writes with it. Correct my"
        " diary; he gets a yes.",
        "My watchmaker Malik sends a dial instead of a time. Shift our appointment accordingly and confirm: Yes.",
    ),
    done(
        sent(
            MALIK,
            Photo(Shows.CLOCK, param("time")),
            "When it's this time today. The clock is right!",
            agenda=REPAIR,
            details=OPEN,
        ),
        _repair({time: time for time in SHOWN}),
        AS_SHOWN,
        slips=(AN_HOUR_ON, (*letter(MALIK), *answer(MALIK, "Yes"))),
    ),
    done(
        sent(
            MALIK,
            Photo(Shows.CLOCK, param("time")),
            "When it's this time today. But mind, the clock is an hour slow!",
            agenda=REPAIR,
            details=OPEN,
        ),
        _repair(HOUR_ON),
        AN_HOUR_ON,
        slips=(AS_SHOWN,),
    ),
    "content: the clock on the photo is right, or an hour slow",
    time=tuple(SHOWN),
    guess_loses="The hands are on the photo, and a line with it may say that the clock is slow.",
)

REAR_SEATS = {"rear left": SEAT.REAR_LEFT_HEATING, "rear right": SEAT.REAR_RIGHT_HEATING}
BOTH_WARM = replace(PARKED, signals={seat.path: 50.0 for seat in REAR_SEATS.values()})
OTHER_SEAT = {"rear left": "rear_right", "rear right": "rear_left"}
SAME_SEAT = {seat: seat.replace(" ", "_") for seat in REAR_SEATS}


def _heated(seats: dict[str, str], taps: int) -> Moves:
    heat = Tap(param("seat", {seat: f"hvac.{key}_seat_heating" for seat, key in seats.items()}), taps)
    return (*letter(WANDA), Open("climate"), Tap("hvac.comfort"), heat, *answer(WANDA, "{words}"))


def _warm(level: float) -> AllOf:
    return AllOf(
        (
            SignalIs(param("seat", REAR_SEATS), (level,)),
            Entered("messages.sent", {"to": WANDA, "text": "{words}"}),
        )
    )


MARKED_SEAT = pictured(
    "hard_marked_seat",
    Module.HVAC,
    (
        "Wanda has marked a rear seat on a photo. A tick means its heating on High, a cross means off. Do that, the"
        " rest stays, and send her '{words}'.",
        "Heat the back seat that Wanda ticked in her picture fully, or turn it off if she crossed it out; then"
        " '{words}' to her.",
        "See the drawing from Wanda: crossed, that seat gets no heat any more, ticked, it gets the most. Only that"
        " one. She's to read '{words}'.",
        "Rear seat heating as on the plan that Wanda sent, tick for high and cross for none, followed by '{words}'"
        " for her.",
    ),
    done(
        sent(WANDA, Photo(Shows.SEAT, param("seat")), "About this seat in the back", start=BOTH_WARM),
        _warm(100.0),
        _heated(SAME_SEAT, 1),
        slips=(_heated(OTHER_SEAT, 1), _heated(SAME_SEAT, 2)),
    ),
    done(
        sent(WANDA, Photo(Shows.SEAT, param("seat"), struck=True), "About this seat in the back", start=BOTH_WARM),
        _warm(0.0),
        _heated(SAME_SEAT, 2),
        slips=(_heated(OTHER_SEAT, 2), _heated(SAME_SEAT, 1)),
    ),
    "content: the seat on the photo is ticked, or crossed out",
    seat=tuple(REAR_SEATS),
    words=("Yes", "Thank you", "On my way"),
    guess_loses="Which seat, and whether it is ticked or crossed out, is on the photo alone.",
)

CELSIUS = {1: 18.5, 2: 19.0, 3: 20.0, 4: 22.5, 5: 24.0}
FAHRENHEIT = {1: 66, 2: 69, 3: 72, 4: 75, 5: 79}
IN_HALVES = {turn: round((degrees - 32) / 1.8 * 2) / 2 for turn, degrees in FAHRENHEIT.items()}
"""Degrees Celsius, to the nearest half."""


def _like_home(degrees: dict[int, float]) -> Moves:
    way = {turn: "increase" if value > 21.0 else "decrease" for turn, value in degrees.items()}
    return (
        *letter(BEA),
        Open("climate"),
        TapUntil(
            param("turn", {turn: f"hvac.driver_temperature.{each}" for turn, each in way.items()}),
            "hvac.driver_temperature",
            param("turn", {turn: f"{value:.1f} °C" for turn, value in degrees.items()}),
        ),
        *answer(BEA, "I've arrived"),
    )


def _as_warm(degrees: dict[int, float]) -> AllOf:
    value = param("turn", degrees)
    return AllOf(
        (
            SignalIs(HVAC.DRIVER_TEMPERATURE, (value,)),
            SignalIs(HVAC.PASSENGER_TEMPERATURE, (value,)),
            Entered("messages.sent", {"to": BEA, "text": "I've arrived"}),
        )
    )


NUMBERS_ALONE = {turn: min(float(value), 28.0) for turn, value in FAHRENHEIT.items()}
BEAS_THERMOSTAT = pictured(
    "hard_beas_thermostat",
    Module.HVAC,
    (
        "Set the car to what Bea's thermostat shows on her photo, both sides, to the nearest half degree."
        " Then write"
        " her that I've arrived.",
        "Same temperature in here as at Bea's, see her picture; round to half a degree. After that an 'I've"
        " arrived'"
        " for her.",
        "Bea sent the dial of her heating. I want exactly that warmth for the two of us, in steps of one"
        " half, and a"
        " message to her: I've arrived.",
        "Whatever the needle on Bea's photo points at, make it that in the whole car (nearest half), and"
        " let her know"
        " I've arrived.",
    ),
    done(
        sent(BEA, Photo(Shows.WARMTH, param("turn", CELSIUS), "C"), "Come in, it's as warm as this here"),
        _as_warm(CELSIUS),
        _like_home(CELSIUS),
        slips=(_like_home({turn: value + 1.0 for turn, value in CELSIUS.items()}),),
    ),
    done(
        sent(BEA, Photo(Shows.WARMTH, param("turn", FAHRENHEIT), "F"), "Come in, it's as warm as this here"),
        _as_warm(IN_HALVES),
        _like_home(IN_HALVES),
        slips=(_like_home(NUMBERS_ALONE),),
    ),
    "content: the thermostat on the photo reads in degrees Celsius, or Fahrenheit",
    turn=tuple(CELSIUS),
    guess_loses="The needle and its unit are on the photo alone.",
)

PSI = {1: 32, 2: 34, 3: 36, 4: 38, 5: 40}
BAR = {1: 2.8, 2: 2.7, 3: 2.2, 4: 2.3, 5: 2.4}
BAR_IN_PSI = {turn: round(bar * 14.504) for turn, bar in BAR.items()}


def _pumped(psi: dict[int, int]) -> Moves:
    ups = Tap("figure.up", param("turn", {turn: value - 30 for turn, value in psi.items()}))
    return (*letter(THEO), *figure(OSKAR, "pressure", ups))


def _says_psi(psi: dict[int, int]) -> SaysFigure:
    return SaysFigure(OSKAR, "psi", param("turn", psi), 1.0)


THEOS_PUMP = pictured(
    "hard_theos_pump",
    Module.COMMS,
    (
        "Theo measured the tyre and photographed the gauge. Send Oskar the pressure in psi.",
        "Oskar needs to know, in psi, what the needle shows on the picture from Theo.",
        "There's a photo of the pump's dial from Theo; text Oskar how many psi that is.",
        "Read Theo's gauge for me and pass the value on to Oskar by message, psi, whatever the scale.",
    ),
    done(
        sent(
            THEO,
            Photo(Shows.PRESSURE, param("turn", PSI), "psi"),
            "All four tyres, after pumping",
            contacts=knowing(THEO, OSKAR),
        ),
        _says_psi(PSI),
        _pumped(PSI),
        slips=(_pumped({turn: psi + 3 for turn, psi in PSI.items()}),),
    ),
    done(
        sent(
            THEO,
            Photo(Shows.PRESSURE, param("turn", BAR), "bar"),
            "All four tyres, after pumping",
            contacts=knowing(THEO, OSKAR),
        ),
        _says_psi(BAR_IN_PSI),
        _pumped(BAR_IN_PSI),
        slips=(_pumped({turn: psi + 3 for turn, psi in BAR_IN_PSI.items()}),),
    ),
    "content: the gauge on the photo is in psi, or in bar",
    turn=tuple(PSI),
    guess_loses="The needle and its unit are on the photo alone.",
)

MPH = {20: 30, 25: 40, 35: 55, 45: 70, 50: 80}
"""Miles an hour, and the highest step of 5 km/h that is no faster."""
KMH = {mph: mph for mph in MPH}
FAST = replace(PARKED, signals={ADAS.LIMITER_SPEED.path: 100.0})


def _limited(kmh: dict[int, int]) -> Moves:
    return (
        *letter(YUSUF),
        Open("vehicle"),
        Tap("vehicle.tab.assistance"),
        TapUntil(
            "adas.limiter_speed.decrease",
            "adas.limiter_speed.value",
            param("figure", {figure: f"{value} km/h" for figure, value in kmh.items()}),
        ),
        Tap("adas.limiter"),
        *answer(YUSUF, "Thank you"),
    )


def _at_most(kmh: dict[int, int]) -> AllOf:
    return AllOf(
        (
            SignalIs(
                ADAS.LIMITER_SPEED, (param("figure", {figure: float(value) for figure, value in kmh.items()}),)
            ),
            SignalIs(ADAS.LIMITER_ACTIVE, (True,)),
            Entered("messages.sent", {"to": YUSUF, "text": "Thank you"}),
        )
    )


AT_YUSUFS_GATE = pictured(
    "hard_at_yusufs_gate",
    Module.ROAD,
    (
        "The sign at Yusuf's gate is on his photo. Have the limiter keep to it, the highest step that isn't above,"
        " and thank him.",
        "Limiter on for the estate, as the sign that Yusuf photographed has it, never faster; 'Thank you' to him.",
        "Yusuf sent a picture of the speed sign on his land. Set the limiter by it, rounding down, switch"
        " it on, then"
        " a thank you.",
        "On Yusuf's drive the sign in his message counts: limiter just at or under it, active, and he gets 'Thank"
        " you'.",
    ),
    done(
        sent(YUSUF, Photo(Shows.LIMIT, param("figure")), "We mean it!", start=FAST),
        _at_most(KMH),
        _limited(KMH),
        slips=(_limited(MPH),),
    ),
    done(
        sent(YUSUF, Photo(Shows.LIMIT, param("figure"), "mph"), "We mean it!", start=FAST),
        _at_most(MPH),
        _limited(MPH),
        slips=(_limited(KMH), _limited({mph: kmh + 5 for mph, kmh in MPH.items()})),
    ),
    "content: the sign on the photo is a European one in km/h, or an American one in mph",
    figure=tuple(MPH),
    guess_loses="The figure, and by the sign's form its unit, is on the photo alone.",
)

SIDES = {"left": "right", "right": "left"}
LOCKS = {"left": CABIN.LEFT_CHILD_LOCK, "right": CABIN.RIGHT_CHILD_LOCK}
PANES = {"left": CABIN.REAR_LEFT_WINDOW, "right": CABIN.REAR_RIGHT_WINDOW}
AIRED = replace(PARKED, signals={pane.path: 70.0 for pane in PANES.values()})


def _made_safe(sides: dict[str, str]) -> Moves:
    return (
        *letter(PRIYA),
        Open("vehicle"),
        Tap("vehicle.tab.doors"),
        Tap(param("half", {half: f"door.child_{side}" for half, side in sides.items()})),
        Slide(param("half", {half: f"window.rear_{side}" for half, side in sides.items()}), param("percent")),
    )


def _is_safe(sides: dict[str, str]) -> AllOf:
    return AllOf(
        (
            SignalIs(param("half", {half: LOCKS[side] for half, side in sides.items()}), (True,)),
            SignalIs(param("half", {half: PANES[side] for half, side in sides.items()}), (param("percent"),)),
        )
    )


AS_SEEN = {side: side for side in SIDES}
BENCH_PHOTO = pictured(
    "hard_photo_of_the_bench",
    Module.SYSTEM,
    (
        "Priya photographed how they'll sit behind. On the child's side the child lock on and the window to"
        " {percent}, the other side as it is.",
        "See on Priya's picture where the little one will sit: lock that rear door for children, its window down to"
        " {percent} only.",
        "Priya's photo shows the rear bench. Child safety for the kid's door, and {percent} for the pane"
        " next to it;"
        " nothing over there where the grown-up will be.",
        "The child behind, left or right, see what Priya sent: childproof its door, and leave its"
        " window open by {percent} only.",
    ),
    done(
        sent(
            PRIYA,
            Photo(Shows.BENCH, param("half")),
            "How they'll sit, taken through the windscreen from in front of the car",
            start=AIRED,
        ),
        _is_safe(SIDES),
        _made_safe(SIDES),
        slips=(_made_safe(AS_SEEN),),
    ),
    done(
        sent(
            PRIYA,
            Photo(Shows.BENCH, param("half"), struck=True),
            "How they'll sit, taken through the rear window from behind the car",
            start=AIRED,
        ),
        _is_safe(AS_SEEN),
        _made_safe(AS_SEEN),
        slips=(_made_safe(SIDES),),
    ),
    "content: the photo was taken from in front of the car, or from behind it",
    half=tuple(SIDES),
    percent=(10, 20, 30, 40, 50),
    guess_loses="Left and right on the photo are turned round if it was taken from in front.",
)

NETWORKS = ("Home-5G", "CityFree", "Garage", "Coffee-Guest")
NEXT_ONE = {name: NETWORKS[(at + 1) % 4] for at, name in enumerate(NETWORKS)}


def _joined(network: Any) -> Moves:
    return (
        *letter(ISLA),
        Open("settings"),
        Tap("settings.page.connections"),
        Tap("link.wifi"),
        Tap(text=network),
        Tap("link.mobile"),
    )


LAMPS = "The lamps on my router, as you asked"
ONE_LAMP = pictured(
    "hard_one_lamp",
    Module.SYSTEM,
    (
        "Isla's router has a lamp for each network, they're on her photo. If a single one is green, join that and"
        " mobile data off; if a single one is red, nothing but a No to Isla.",
        "Look at the lamps that Isla photographed. Just one green: Wi-Fi into it instead of mobile data."
        " Just one red: it's being repaired, text her no and leave it all.",
        "Go by Isla's picture: the only green network is ours, connect and drop the mobile data. But with only one"
        " red, stay as we are and tell her 'No'.",
        "Which network works shows in what Isla sent. One green lamp among red ones means get in there,"
        " without mobile data; a lone red one means no change and a 'No' for her.",
        "Photo from Isla, of her router: join the network whose lamp is the only green one, and no mobile data"
        " then. Should a red one be the odd one out, send her a No and touch nothing.",
    ),
    done(
        sent(ISLA, Photo(Shows.LAMPS, param("network")), LAMPS),
        AllOf(
            (
                SignalIs(LINK.WIFI, (True,)),
                AppDataIs("wifi.network", ("{network}",)),
                SignalIs(LINK.MOBILE_DATA, (False,)),
            )
        ),
        _joined("{network}"),
        slips=(_joined(param("network", NEXT_ONE)), (*letter(ISLA), *answer(ISLA, "No"))),
    ),
    done(
        sent(ISLA, Photo(Shows.LAMPS, param("network"), struck=True), LAMPS),
        Entered("messages.sent", {"to": ISLA, "text": "No"}),
        (*letter(ISLA), *answer(ISLA, "No")),
        slips=(_joined("{network}"), _joined(param("network", NEXT_ONE))),
    ),
    "content: one lamp on the photo is green, or one is red",
    network=NETWORKS,
    guess_loses="Which lamp is the odd one out, and its colour, is on the photo alone.",
)

TASKS = (
    ZONE_ON_THE_SIGN,
    MALIKS_CLOCK,
    MARKED_SEAT,
    BEAS_THERMOSTAT,
    THEOS_PUMP,
    AT_YUSUFS_GATE,
    BENCH_PHOTO,
    ONE_LAMP,
)
