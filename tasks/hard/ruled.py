"""Which rule holds here: the place, the hour, the road or a text tells, and no line of the context says it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.apps.calendar import Appointment
from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.signals import ADAS, LINK, TYRE
from automotive_cosim.contracts import AlertKind, Weather
from automotive_cosim.tasking.checks import AlertGiven, AllOf, AppDataIs, Check, Entered, SignalIs
from automotive_cosim.tasking.moves import Move, Open, Tap, TapUntil, Warn
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.records import AppDataAt
from automotive_cosim.tasking.task import Ability, Half, Module, Start
from automotive_cosim.tasking.triggers import (
    All,
    BuiltUp,
    Driving,
    InCountry,
    OnRoadClass,
    Parked,
    Trigger,
    TriggerCondition,
)
from automotive_cosim.tasks.hard.forms import (
    A_RED_LIGHT,
    AS_A_PASSENGER,
    BEA,
    ISLA,
    MALIK,
    ON_THE_ROAD,
    OSKAR,
    PRIYA,
    THEO,
    YUSUF,
    Moves,
    answer,
    done,
    hard,
    knowing,
    letter,
    told,
    with_letter,
    with_papers,
)
from automotive_cosim.tasks.maps import SETS_OUT, STOPS_THERE

LEEDS, LYON, DARMSTADT = (-1.55, 53.80), (4.85, 45.75), (8.62, 49.93)
ORLEANS, SPLUEGEN, MILAN, BUFFALO = (1.90, 47.95), (9.20, 46.50), (9.19, 45.46), (-78.70, 43.00)
GREY = Weather(9.0, 80.0, 0.0, 3, 90.0, 20_000.0, 12.0)
MILD = Weather(20.0, 55.0, 0.0, 2, 40.0, 20_000.0, 10.0)
PLACE = frozenset({"place"})
ASSIST = (Open("vehicle"), Tap("vehicle.tab.assistance"))


def _in(country: str, condition: TriggerCondition = Driving()) -> Trigger:  # noqa: B008, it is frozen
    return Trigger(All((condition, InCountry(country))), for_s=3.0, within_s=60.0)


def _street(origin: tuple[float, float], start: str = "2026-11-18T10:10:00", weather: Weather = GREY) -> Start:
    return Start("grid", "avenue", origin, start=start, weather=weather)


# --- by place -----------------------------------------------------------------------------------------------

CALLS = {"16:00": (1, 0), "16:30": (1, 2), "17:00": (2, 0), "17:15": (2, 1), "18:30": (3, 2)}
"""The hour in London, and the hours and quarters from 15:00 to it."""
LATER = {at: f"{int(at[:2]) + 1}{at[2:]}" for at in CALLS}
DIARY = (Appointment("09:00", "Briefing", "Work"), Appointment("15:00", "Call with London", "Work"))


def _call(hours: int) -> Moves:
    return (
        *letter(PRIYA),
        Open("calendar"),
        Tap("calendar.1"),
        Tap("appointment.hour_later", param("hour", {at: far[0] + hours for at, far in CALLS.items()})),
        Tap("appointment.later", param("hour", {at: far[1] for at, far in CALLS.items()})),
        *answer(PRIYA, "Yes"),
    )


def _called(origin: tuple[float, float], country: str, at: dict[str, str], hours: int) -> Half:
    start = with_letter(
        _street(origin), PRIYA, "The London office would rather talk later:", "{hour}, their time", agenda=DIARY
    )
    moved = param("hour", {hour: {"at": here} for hour, here in at.items()})
    return done(
        start,
        AllOf((AppDataAt("calendar.entries", 1, moved), told(PRIYA, "Yes"))),
        _call(hours),
        slips=(_call(1 - hours), _call(hours)[:-5]),
        deadline=AS_A_PASSENGER,
        trigger=_in(country),
    )


THEIR_TIME = hard(
    "hard_their_time",
    Module.APPS,
    (
        "Priya has a new time for the call with London. Put it into my calendar for where I am, and tell her yes.",
        "Look at Priya's message and move the London call to that moment, as my own clock will show it. 'Yes' to"
        " her.",
        "The London call has moved, see Priya's text. Correct the diary in local time and confirm to Priya: Yes.",
        "My calendar runs on the clock here. Move the London call to the time Priya wrote, then answer her 'Yes'.",
    ),
    _called(LYON, "FR", LATER, 1),
    _called(LEEDS, "GB", {at: at for at in CALLS}, 0),
    "place: Lyon, an hour ahead of London, or Leeds",
    parameters={"hour": tuple(CALLS)},
    tags=PLACE | {"two_modules"},
    ability=Ability.RULE,
    guess_loses="The figure in the message is the one to enter only where the clocks are London's.",
)

STAYS = {"an hour": 60, "two hours": 120, "four hours": 240}
TICKET = (
    Open("memo"),
    Open("parking"),
    Tap("parking.zone.b"),
    Tap(param("stay", {stay: f"parking.time.{minutes}" for stay, minutes in STAYS.items()})),
    Tap("parking.pay"),
    *answer(ISLA, "Yes"),
)
NO_TICKET = (Open("memo"), *answer(ISLA, "No"))


def _bastille(origin: tuple[float, float], country: str, goal: Check, moves: Moves, wrong: Moves) -> Half:
    start = with_papers(
        replace(_street(origin, "2026-07-14T10:20:00", MILD), parked=True),
        contacts=knowing(ISLA),
        memos=("Sign here: zone B, ticket 9 to 19, not on Sundays and public holidays", "Sun cream"),
    )
    return done(
        start,
        goal,
        moves,
        slips=(wrong,),
        may_write=frozenset(),
        deadline=A_RED_LIGHT,
        trigger=_in(country, Parked()),
    )


NATIONAL_DAY = hard(
    "hard_ticket_on_that_day",
    Module.APPS,
    (
        "I've noted the parking sign. If we need a ticket today, {stay} and 'Yes' to Isla; if not, only 'No' to"
        " her.",
        "Isla asks whether we have to pay here. See my memo of the sign: yes means {stay} bought and a Yes to her,"
        " else nothing but a No.",
        "Do the meters count today? The sign is in my notes. Buy {stay} if they do and text Isla yes; text her no"
        " if"
        " they don't.",
        "Go by the sign in the memos and by what day it is here: {stay} of parking and a 'Yes' for Isla, or just"
        " 'No' for her when it's free.",
    ),
    _bastille(LYON, "FR", told(ISLA, "No"), NO_TICKET, TICKET),
    _bastille(
        LEEDS,
        "GB",
        AllOf(
            (
                Entered("payments", {"zone": "Zone B", "minutes": param("stay", STAYS)}),
                AppDataIs("parking.zone", ("Zone B",)),
                AppDataIs("parking.minutes", (param("stay", STAYS),)),
                told(ISLA, "Yes"),
            )
        ),
        TICKET,
        NO_TICKET,
    ),
    "place: the fourteenth of July in Lyon, where it is a public holiday, or in Leeds",
    parameters={"stay": tuple(STAYS)},
    tags=PLACE | {"two_modules"},
    ability=Ability.RULE,
    guess_loses="The sign excepts holidays, and the date is one in one country and a plain Tuesday in the other.",
)

EVENING = "2026-11-18T20:10:00"
ENDINGS = ("0142", "0163", "0177", "0128", "0185")


def _dialled(prefix: str) -> dict[str, str]:
    return {ending: f"{prefix}113496{ending}" for ending in ENDINGS}


def _dials(prefix: str) -> Moves:
    last: tuple[Move, ...] = tuple(
        Tap(param("ending", {ending: f"phone.key.{ending[at]}" for ending in ENDINGS})) for at in range(4)
    )
    fixed = tuple(Tap(f"phone.key.{digit}") for digit in f"{prefix}113496")
    return (*letter(MALIK), Open("phone"), Tap("phone.tab.keypad"), *fixed, *last, Tap("phone.call_number"))


def _rung(origin: tuple[float, float], country: str, prefix: str, wrong: str) -> Half:
    start = with_letter(
        replace(_street(origin, EVENING), parked=True),
        MALIK,
        "I'm in the Leeds office tonight:",
        "0113 496 {ending}",
    )
    return done(
        start,
        Entered("calls", param("ending", _dialled(prefix))),
        _dials(prefix),
        slips=(_dials(wrong), _dials("0"), (Open("phone"), Tap(text=MALIK), Tap("contact.call"))),
        deadline=AS_A_PASSENGER,
        trigger=_in(country, Parked()),
    )


FROM_ABROAD = hard(
    "hard_ring_leeds",
    Module.COMMS,
    (
        "Ring Malik on the number he has written, from the keypad, the way it has to be dialled from here.",
        "Malik is in Leeds and has sent his line there. Key it in so that it gets through from this country, and"
        " call.",
        "Call Malik's office number, it's in his message; dial all the digits that it takes from where we stand.",
        "Dial Malik at the English number that he texted. Type what has to be typed in this country.",
    ),
    _rung(LYON, "FR", "0044", "01144"),
    _rung(BUFFALO, "US", "01144", "0044"),
    "place: France, from where calls abroad begin with 00, or the United States, where they do with 011",
    parameters={"ending": ENDINGS},
    tags=PLACE,
    ability=Ability.RULE,
    guess_loses=(
        "As it is written the number works in England alone, and the way out of the country differs by country."
    ),
)

NETWORKS = {"Garage": "Coffee-Guest", "CityFree": "Garage", "Coffee-Guest": "CityFree", "Home-5G": "Garage"}
CONNECTIONS = (Open("settings"), Tap("settings.page.connections"))


def _joins(network: Any) -> Moves:
    return (Open("memo"), *CONNECTIONS, Tap("link.wifi"), Tap(text=network), *answer(OSKAR, "Thank you"))


def _guest(origin: tuple[float, float], country: str, network: Any, other: Any) -> Half:
    start = with_papers(
        replace(_street(origin, EVENING), parked=True),
        contacts=knowing(OSKAR),
        memos=(
            param(
                "network",
                {old: f"Garage wall: guest network {old}, from 12/11 on {new}" for old, new in NETWORKS.items()},
            ),
            "Oskar's jack is in the trunk",
        ),
    )
    return done(
        start,
        AllOf((SignalIs(LINK.WIFI, (True,)), AppDataIs("wifi.network", (network,)), told(OSKAR, "Thank you"))),
        _joins(network),
        slips=(_joins(other),),
        may_write=frozenset(),
        trigger=_in(country, Parked()),
    )


NEW_NETWORK = param("network", NETWORKS)
WHICH_DATE = hard(
    "hard_guest_network_from",
    Module.SYSTEM,
    (
        "Join the guests' network of this garage, the one that's right today; my memo has the notice. Thank Oskar.",
        "The notice on the garage wall is in my notes. Connect by Wi-Fi to what it says for today, then 'Thank you'"
        " to Oskar.",
        "Wi-Fi, please: which of the two networks counts now is in the memo, as it's written on the wall here."
        " Oskar"
        " gets a thank you.",
        "Get us onto the guest Wi-Fi. I copied the sign, date and all, into my memos. And text Oskar 'Thank you'.",
    ),
    _guest(LEEDS, "GB", NEW_NETWORK, "{network}"),
    _guest(BUFFALO, "US", "{network}", NEW_NETWORK),
    "place: England, where 12/11 was last week, or New York State, where it is next month",
    parameters={"network": tuple(NETWORKS)},
    tags=PLACE | {"two_modules"},
    ability=Ability.RULE,
    guess_loses="On the eighteenth of November 12/11 is past or to come, by how the country writes dates.",
)

PLATES = {10: 15, 15: 20, 20: 30, 25: 40, 30: 45}
"""A figure in miles an hour, and the highest step of 5 km/h that is no faster."""


def _slowed(kmh: dict[int, int]) -> Moves:
    wanted = param("plate", {plate: f"{each} km/h" for plate, each in kmh.items()})
    return (
        *letter(YUSUF),
        *ASSIST,
        TapUntil("adas.limiter_speed.decrease", "adas.limiter_speed.value", wanted),
        Tap("adas.limiter"),
        *answer(YUSUF, "On my way"),
    )


def _estate(origin: tuple[float, float], country: str, kmh: dict[int, int], wrong: dict[int, int]) -> Half:
    start = with_letter(
        replace(_street(origin), signals={ADAS.LIMITER_SPEED.path: 80.0}),
        YUSUF,
        "We've put up a sign at the gate:",
        "{plate}, like those on your roads here",
    )
    return done(
        start,
        AllOf(
            (
                SignalIs(ADAS.LIMITER_SPEED, (param("plate", {each: float(step) for each, step in kmh.items()}),)),
                SignalIs(ADAS.LIMITER_ACTIVE, (True,)),
                told(YUSUF, "On my way"),
            )
        ),
        _slowed(kmh),
        slips=(_slowed(wrong),),
        deadline=AS_A_PASSENGER,
        trigger=_in(country),
    )


SAME_PLATE = {plate: plate for plate in PLATES}
NO_UNIT = hard(
    "hard_figure_without_unit",
    Module.ROAD,
    (
        "Yusuf has a speed sign at his gate now. Limiter to the fastest step it allows, on, and tell him 'On my"
        " way'.",
        "See what Yusuf's new sign says and set the limiter by it, never above, switched on; he gets 'On my way'.",
        "Have the limiter hold what is written at Yusuf's gate, rounded down to a step, active. Then text him that"
        " I'm"
        " on my way.",
        "There's a number on a plate at Yusuf's, it's in his message. Limiter on, at the fastest step"
        " that it allows and no faster, and 'On my way' to him.",
    ),
    _estate(LEEDS, "GB", PLATES, SAME_PLATE),
    _estate(LYON, "FR", SAME_PLATE, PLATES),
    "place: England, whose signs are in miles an hour, or France",
    parameters={"plate": tuple(PLATES)},
    tags=PLACE | {"two_modules"},
    ability=Ability.RULE,
    guess_loses="The message gives a figure without a unit; which one its signs mean, the country tells.",
)

MARKET = "Family Market"
WORDS = ("On my way", "Yes", "Thank you")
HOME = (Open("map"), Tap(text="Home"), SETS_OUT)
SHOPPING = (*HOME, Open("map"), Tap("map.list.explore"), Tap("explore.kind.shop"), Tap(text=MARKET), STOPS_THERE)
TELL_BEA = answer(BEA, "{words}")


def _sunday(origin: tuple[float, float], country: str, goal: tuple[Check, ...], moves: Moves, wrong: Moves) -> Half:
    start = with_papers(
        Start(
            "london",
            "bloomsbury",
            origin,
            start="2026-11-15T12:40:00",
            weather=GREY,
            interruptions=(Arrival("message", 5.0, BEA, "And eggs, if you pass a shop!"),),
        ),
        contacts=knowing(BEA),
        details={MARKET: "Supermarket, 900 m², bakery, free parking"},
    )
    return done(
        start,
        AllOf((*goal, told(BEA, "{words}"))),
        (*moves, *TELL_BEA),
        slips=((*wrong, *TELL_BEA),),
        may_write=frozenset(),
        deadline=AS_A_PASSENGER,
        trigger=_in(country),
    )


BY_THE_SHOP = (AppDataIs("navigation.destination", (MARKET,)), AppDataIs("navigation.onward", ("Home",)))
STRAIGHT_HOME = (AppDataIs("navigation.destination", ("Home",)), AppDataIs("navigation.onward", ("",)))
SHOPS_TODAY = hard(
    "hard_milk_today",
    Module.MAPS,
    (
        "We need milk. If supermarkets may open in this country today, home by way of Family Market; if not,"
        " straight"
        " home. Bea gets '{words}'.",
        "Home, stopping at Family Market, unless shops like that are shut today by law here; then home without a"
        " stop."
        " Text Bea '{words}'.",
        "Is it any use to try Family Market today? Then put it in on the way home, otherwise just home. '{words}'"
        " to"
        " Bea.",
        "Take me home, by way of Family Market if the law lets supermarkets open on a day like this where we "
        "are. And write Bea '{words}'.",
    ),
    _sunday(DARMSTADT, "DE", STRAIGHT_HOME, HOME, SHOPPING),
    _sunday(LEEDS, "GB", BY_THE_SHOP, SHOPPING, HOME),
    "place: a Sunday in Germany, or in England",
    parameters={"words": WORDS},
    tags=PLACE | {"two_modules"},
    ability=Ability.RULE,
    guess_loses="The page of the shop has no hours; the day and the country's law of shop hours decide.",
)

TERMS = {
    "CH 110, F 120, D 130, others 100": (110, 100),
    "CH 100, F 110, D 120, others 90": (100, 90),
    "D 130, F 130, CH 120, others 110": (120, 110),
    "F 120, CH 90, D 110, others 105": (90, 105),
}
ALPS = Start(
    "autobahn", "north", start="2026-06-17T12:30:00", weather=Weather(18.0, 55.0, 0.0, 1, 20.0, 20_000.0, 8.0)
)


def _rented(at: int) -> Moves:
    wanted = param("terms", {terms: f"{kmh[at]} km/h" for terms, kmh in TERMS.items()})
    return (
        Open("memo"),
        *ASSIST,
        TapUntil("adas.cruise_speed.increase", "adas.cruise_speed.value", wanted),
        *answer(PRIYA, "Thank you"),
    )


def _hired(origin: tuple[float, float], country: str, at: int) -> Half:
    start = with_papers(
        replace(ALPS, origin=origin, sign_camera=False),
        contacts=knowing(PRIYA),
        memos=("Hire car, page 4: no faster than {terms}", "Hire car, page 6: full on return"),
    )
    fastest = param("terms", {terms: float(kmh[at]) for terms, kmh in TERMS.items()})
    return done(
        start,
        AllOf((SignalIs(ADAS.CRUISE_SPEED, (fastest,)), told(PRIYA, "Thank you"))),
        _rented(at),
        slips=(_rented(1 - at),),
        may_write=frozenset(),
        deadline=AS_A_PASSENGER,
        trigger=_in(country),
    )


HIRE_CAR = hard(
    "hard_terms_of_hire",
    Module.ROAD,
    (
        "Set cruise control, just the speed, to the most that the hire firm allows in this country; it's in my"
        " memos."
        " Thank Priya.",
        "My notes have what the contract permits. Make the highest speed for here the set speed, don't switch"
        " cruise"
        " on, and text Priya 'Thank you'.",
        "Put in as cruising speed what the terms of hire give for where we are now, not active yet. Priya gets a"
        " thank you.",
        "How fast may this hired car go here by the contract? That goes into cruise control as the set speed,"
        " without"
        " starting it; then thank Priya.",
    ),
    _hired(SPLUEGEN, "CH", 0),
    _hired(MILAN, "IT", 1),
    "place: Switzerland, which the terms name, or Italy, which is among the others",
    parameters={"terms": tuple(TERMS)},
    tags=PLACE | {"two_modules"},
    ability=Ability.RULE,
    guess_loses="Four speeds in one line of a memo; the country that the car is in tells which.",
)

# --- by road, hour and text ---------------------------------------------------------------------------------

TOWING = {"100, 80, 50": (100, 80), "90, 75, 50": (90, 75), "80, 70, 40": (80, 70), "100, 70, 45": (100, 70)}
"""Speeds on motorways, on other roads outside towns, and in towns."""


def _tows(at: int) -> Moves:
    wanted = param("speeds", {speeds: f"{kmh[at]} km/h" for speeds, kmh in TOWING.items()})
    return (
        *letter(THEO),
        *ASSIST,
        TapUntil("adas.limiter_speed.decrease", "adas.limiter_speed.value", wanted),
        Tap("adas.limiter"),
        *answer(THEO, "Thank you"),
    )


def _towed(trip: str, at: int, *road: TriggerCondition) -> Half:
    start = with_letter(
        replace(
            ALPS,
            trip=trip,
            origin=DARMSTADT,
            signals={ADAS.LIMITER_SPEED.path: 120.0},
            interruptions=(Arrival("message", 8.0, THEO, "And go slowly, wherever you are!"),),
        ),
        THEO,
        "Limits of my caravan, motorway first",
        "then country roads and towns: {speeds}",
    )
    return done(
        start,
        AllOf(
            (
                SignalIs(
                    ADAS.LIMITER_SPEED,
                    (param("speeds", {speeds: float(kmh[at]) for speeds, kmh in TOWING.items()}),),
                ),
                SignalIs(ADAS.LIMITER_ACTIVE, (True,)),
                told(THEO, "Thank you"),
            )
        ),
        _tows(at),
        slips=(_tows(1 - at),),
        deadline=AS_A_PASSENGER,
        trigger=Trigger(All((Driving(), *road)), 3.0, 300.0),
    )


KIND_OF_ROAD = hard(
    "hard_caravan_on_this_road",
    Module.ROAD,
    (
        "Theo has sent how fast his caravan may go. Limiter to what holds on the road we're on, switch it on, "
        "thank him.",
        "Three speeds in Theo's message, one of them is for this kind of road: that into the limiter, on, and"
        " 'Thank"
        " you' to Theo.",
        "With Theo's caravan in tow, how fast may it be on a road like this one? Limiter active at that, then a"
        " thank you for him.",
        "Find in Theo's text the top speed for the sort of road under us and have the limiter keep it. Thank him"
        " afterwards.",
    ),
    _towed("north", 0, OnRoadClass(("motorway",))),
    _towed("roadworks", 1, OnRoadClass(("secondary",)), BuiltUp(False)),
    "road: a motorway, or a country road",
    parameters={"speeds": tuple(TOWING)},
    tags=PLACE | {"two_modules"},
    ability=Ability.RULE,
    guess_loses="Three speeds stand in a row; which is meant, the class of the present road tells.",
)

LUNA, AZUR = "Café Luna", "Café Azur"
CAFES = (Open("map"), Tap("map.list.explore"), Tap("explore.kind.cafe"))


def _sits(name: str) -> Moves:
    return (*CAFES, Tap(text=LUNA), *CAFES, Tap(text=name), SETS_OUT, *answer(BEA, "{words}"))


def _terrace(hour: str, name: str, other: str) -> Half:
    start = with_papers(
        Start("london", "bloomsbury", start=f"2026-11-18T{hour}:00", weather=GREY),
        contacts=knowing(BEA),
        details={LUNA: "Garden café, open from sunrise to sunset", AZUR: "Open until 22:00"},
    )
    return done(
        start,
        AllOf((AppDataIs("navigation.destination", (name,)), told(BEA, "{words}"))),
        _sits(name),
        slips=(_sits(other),),
        may_write=frozenset(),
        deadline=AS_A_PASSENGER,
    )


TILL_SUNSET = hard(
    "hard_open_till_sunset",
    Module.MAPS,
    (
        "To Café Luna, if its page says that it's still open at this hour; otherwise to Café Azur. '{words}' to"
        " Bea.",
        "Check the hours of Café Luna and take me there while it's open. If it has closed, Café Azur. Tell Bea"
        " '{words}'.",
        "Bea likes Café Luna. Guide me to it unless by its hours we're too late already, then Café Azur will do;"
        " text her '{words}'.",
        "Café Luna or, should it be shut by now, Café Azur: look up the one, drive to the right one, and write Bea"
        " '{words}'.",
    ),
    _terrace("15:10", LUNA, AZUR),
    _terrace("16:40", AZUR, LUNA),
    "time of day: an hour before sunset, or half an hour after it",
    parameters={"words": WORDS},
    tags=frozenset({"two_modules"}),
    ability=Ability.RULE,
    guess_loses="It is open to sunset, and no screen says when that is on a London afternoon in November.",
)

LEADS = {1: (2.4, 2.9), 2: (2.5, 2.9), 3: (2.3, 3.0), 4: (2.5, 3.0)}
"""Pressures on the door frame, light and laden, between which a fifth off makes the difference for 2.2 bar."""
HANDBOOK = (Open("manual"), Tap("manual.topic.2"), Open("memo"), Open("vehicle"), Tap("vehicle.tab.driving"))
PUMP = (*HANDBOOK, Warn(AlertKind.VEHICLE))
ENOUGH = (*HANDBOOK, *answer(MALIK, "No"))


def _door_frame(at: int, goal: Check, moves: Moves, wrong: Moves) -> Half:
    noted = {lead: f"Door frame, all four tyres: {bar[at]} bar" for lead, bar in LEADS.items()}
    start = with_papers(
        replace(
            ON_THE_ROAD,
            start="2026-11-18T10:10:00",
            weather=GREY,
            signals={TYRE.REAR_RIGHT.path: 231.0},
        ),
        contacts=knowing(MALIK),
        memos=("Malik: tyres before the winter?", param("lead", noted)),
    )
    return done(start, goal, moves, slips=(wrong,), may_write=frozenset(), deadline=A_RED_LIGHT)


BY_THE_HANDBOOK = hard(
    "hard_air_by_the_handbook",
    Module.ROAD,
    (
        "Malik asks if a tyre needs air. By the handbook's rule and my memo of the door frame: a vehicle alert if"
        " one"
        " does, else a 'No' to him.",
        "The handbook says when to add air, my notes have the pressure from the door frame. Does a tyre need some?"
        " Warn me about the car then; if none does, text Malik 'No'.",
        "Check all four against what I noted and what the handbook tells: only if one is too low by that, alert me"
        " to"
        " it. Otherwise Malik gets a 'No'.",
        "Go by the handbook on tyre pressures, with the door frame's figure from my memos. One too soft: sound the"
        " vehicle alert. None: write Malik no.",
    ),
    _door_frame(1, AlertGiven(AlertKind.VEHICLE), PUMP, ENOUGH),
    _door_frame(0, told(MALIK, "No"), ENOUGH, PUMP),
    "content: the pressure on the door frame is a fifth above the softest tyre's, or is not",
    parameters={"lead": tuple(LEADS)},
    tags=frozenset({"two_modules"}),
    ability=Ability.RULE,
    guess_loses="The softest tyre is too soft by a rule in the handbook and a figure in a memo, or by neither.",
)

TASKS = (
    THEIR_TIME,
    NATIONAL_DAY,
    FROM_ABROAD,
    WHICH_DATE,
    NO_UNIT,
    SHOPS_TODAY,
    HIRE_CAR,
    KIND_OF_ROAD,
    TILL_SUNSET,
    BY_THE_HANDBOOK,
)
