"""What is needed later is worked out and set now: a route for a trailer, times to leave, tickets, networks."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.parking import PRICES
from automotive_cosim.cockpit.signals import BODY, CABIN, ENERGY, LINK, VOICE
from automotive_cosim.tasking.checks import AllOf, AppDataIs, Counted, Entered, SignalIs
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import FromCockpit, param
from automotive_cosim.tasking.records import EnteredAll
from automotive_cosim.tasking.task import Ability, Half, Module, Start
from automotive_cosim.tasks.forms import linked
from automotive_cosim.tasks.hard.forms import (
    A_RED_LIGHT,
    BEA,
    ISLA,
    MALIK,
    ON_THE_ROAD,
    PARKED,
    READ,
    THEO,
    Moves,
    done,
    hard,
    knowing,
    letter,
    with_letter,
    with_papers,
    write_to,
)
from automotive_cosim.tasks.maps import SETS_OUT

CITY = Start("london", "bloomsbury", start="2026-11-18T16:10:00")


def _towing(*avoided: str) -> Moves:
    return (
        *letter(THEO),
        Open("map"),
        Tap("map.route"),
        Tap("route.tab.options"),
        *(Tap(f"route.avoid.{name}") for name in avoided),
        Tap("route.voice.alerts"),
        Open("map"),
        Tap(text="{place}"),
        SETS_OUT,
    )


def _pulled(message: str, avoided: list[str], others: tuple[str, ...]) -> Half:
    goal = AllOf(
        (
            AppDataIs("navigation.avoid", (avoided,)),
            SignalIs(VOICE.GUIDANCE, ("ALERT_ONLY",)),
            AppDataIs("navigation.destination", (param("place"),)),
        )
    )
    start = with_letter(CITY, THEO, "About the trailer:", message)
    slips = (_towing(*others), _towing(avoided[0]))
    return done(start, goal, _towing(*avoided), slips=slips)


TRAILER_ROUTE = hard(
    "hard_trailer_route",
    Module.MAPS,
    (
        "Theo has written where his trailer mustn't go. Rule that out, voice for alerts only, then to {place}.",
        "Plan the way to {place} as Theo's message demands for the trailer; spoken guidance just for warnings.",
        "We tow Theo's trailer to {place}. Keep us off whatever he says isn't allowed with it, and no chatter but"
        " alerts.",
        "Guide me to {place}, minding the two things that Theo texts about his trailer. The voice may only warn.",
    ),
    _pulled("no tunnels and no ferries with it!", ["tunnels", "ferries"], ("motorways", "tolls")),
    _pulled("no motorways, no toll roads with it!", ["motorways", "tolls"], ("tunnels", "ferries")),
    "content: tunnels and ferries are out, or motorways and toll roads",
    parameters={"place": FromCockpit("favourite_places")},
    tags=frozenset({"two_modules"}),
    ability=Ability.PLANNING,
    guess_loses="Four kinds of roads can be ruled out; his message alone tells which two.",
)

THERE_AT = ("09:30", "10:00", "10:30", "11:00", "11:30")
HOUR = {"09:30": "08:30", "10:00": "09:00", "10:30": "09:30", "11:00": "10:00", "11:30": "10:30"}
HALF_HOUR = {"09:30": "09:00", "10:00": "09:30", "10:30": "10:00", "11:00": "10:30", "11:30": "11:00"}
EARLIER = {
    "08:30": "08:00",
    "09:00": "08:30",
    "09:30": "09:00",
    "10:00": "09:30",
    "10:30": "10:00",
    "11:00": "10:30",
}


def _ready(leaves: dict[str, str]) -> Moves:
    return (
        *letter(ISLA),
        Open("charging"),
        TapUntil("charging.schedule.later", "charging.schedule.time", param("time", leaves)),
        Tap("charging.schedule"),
        Open("climate"),
        Tap("hvac.comfort"),
        TapUntil("climate.schedule.later", "climate.schedule.time", param("time", leaves)),
        Tap("climate.schedule"),
    )


def _leaving(way: str, leaves: dict[str, str], others: dict[str, str]) -> Half:
    half_an_hour_before = {time: EARLIER[leaves[time]] for time in leaves}
    goal = AllOf(
        (
            AppDataIs("charging.schedule", (param("time", leaves),)),
            AppDataIs("climate.schedule", (param("time", leaves), param("time", half_an_hour_before))),
        )
    )
    start = with_letter(PARKED, ISLA, "Be here at {time} tomorrow!", way)
    warm_before = list(_ready(leaves))
    warm_before[7 + 2] = TapUntil(
        "climate.schedule.later", "climate.schedule.time", param("time", half_an_hour_before)
    )
    return done(
        start,
        goal,
        _ready(leaves),
        ways=(tuple(warm_before),),
        slips=(_ready(others), _ready({t: t for t in leaves})),
    )


LEAVE_IN_TIME = hard(
    "hard_leave_in_time",
    Module.APPS,
    (
        "Isla has told me when to be there and how far it is. The car's to be charged and warm when I have to"
        " leave.",
        "Work out from Isla's message when I must set off tomorrow: battery done and cabin heated by that time.",
        "For tomorrow: charging finished and the heating timed to my departure. Arrival time and the drive are in"
        " what Isla wrote.",
        "Look in Isla's text for the hour and the length of the drive; I want the car charged and"
        " warm when I set off.",
    ),
    _leaving("It's an hour's drive.", HOUR, HALF_HOUR),
    _leaving("It's half an hour's drive.", HALF_HOUR, HOUR),
    "content: the drive takes an hour, or half an hour",
    parameters={"time": THERE_AT},
    tags=frozenset({"two_modules"}),
    ability=Ability.PLANNING,
    guess_loses="Both times follow from an arrival and the length of the drive, which only her message has.",
)

STAYS = {"half an hour": 30, "two hours": 120, "four hours": 240}


def _bought(zone: str) -> dict[str, dict[str, object]]:
    """Payments in a zone by the time that is said."""
    return {
        words: {"zone": zone, "minutes": minutes, "price": round(PRICES[zone] * minutes / 60, 2)}
        for words, minutes in STAYS.items()
    }


BOTH_PAID = (param("car", _bought("Zone A")), param("trailer", _bought("Zone C")))


def _ticket(zone: str, stay: str) -> Moves:
    return (
        Tap(f"parking.zone.{zone}"),
        Tap(param(stay, {words: f"parking.time.{minutes}" for words, minutes in STAYS.items()})),
        Tap("parking.pay"),
    )


THANKED = (*write_to(ISLA), Tap(text="Thank you"))
TWO_TICKETS = hard(
    "hard_two_tickets",
    Module.APPS,
    (
        "Two tickets: {car} in zone A for the car, then {trailer} in C where the trailer stands. Thank Isla by"
        " text.",
        "Pay {car} in A and after that {trailer} in zone C, the trailer's there; Isla gets a 'Thank you'.",
        "The car's in A for {car}, the trailer in C for {trailer}: please pay in that order and send Isla our thank"
        " you.",
        "Pay for parking twice, first A and {car}, then C and {trailer}. When that's done, send Isla 'Thank you'.",
    ),
    done(
        with_papers(PARKED, contacts=knowing(ISLA)),
        AllOf(
            (
                EnteredAll("payments", BOTH_PAID, in_order=True),
                AppDataIs("parking.zone", ("Zone C",)),
                AppDataIs("parking.minutes", (param("trailer", STAYS),)),
                Entered("messages.sent", {"to": ISLA, "text": "Thank you"}),
            )
        ),
        (Open("parking"), *_ticket("a", "car"), *_ticket("c", "trailer"), *THANKED),
        slips=(
            (Open("parking"), *_ticket("a", "car"), Tap("parking.zone.c"), *THANKED),
            (Open("parking"), *_ticket("c", "trailer"), *_ticket("a", "car"), *THANKED),
            (Open("parking"), *_ticket("a", "trailer"), *_ticket("c", "car"), Tap("parking.pay"), *THANKED),
        ),
        may_write=frozenset(),
    ),
    parameters={"car": tuple(STAYS), "trailer": tuple(STAYS)},
    ability=Ability.CHAIN,
    guess_loses=(
        "Two payments that cannot be taken back, each with its own zone and time, in one form that keeps the last"
        " values."
    ),
)

NETWORKS = ("CityFree", "Garage", "Coffee-Guest")
DEVICES = {"the tablet": "Tablet", "my second phone": "Second phone"}
ONLINE = (
    Open("memo"),
    Open("settings"),
    Tap("settings.page.connections"),
    Tap("link.wifi"),
    Tap(text="{network}"),
    Tap("link.mobile"),
    Tap(text=param("device", DEVICES)),
)
HOTEL_NETWORK = hard(
    "hard_hotel_network",
    Module.SYSTEM,
    (
        "Wi-Fi instead of mobile data: the hotel's network is in my memos. Pair {device}, and tell Bea I've"
        " arrived.",
        "Join the network that I noted for the hotel, switch the mobile data off, Bluetooth to {device}, then 'I've"
        " arrived' to Bea.",
        "Get us on the hotel Wi-Fi, name in the notes, end the roaming, link {device}; Bea hears that I've"
        " arrived.",
        "No more mobile data please, but the Wi-Fi from my hotel memo, and make {device} known to the car. A text"
        " to Bea, I've arrived.",
    ),
    done(
        with_papers(
            PARKED,
            contacts=knowing(BEA),
            memos=("Home: Home-5G", "Hotel: room 214, {network}", "Office: Garage or none"),
        ),
        AllOf(
            (
                SignalIs(LINK.WIFI, (True,)),
                AppDataIs("wifi.network", ("{network}",)),
                SignalIs(LINK.MOBILE_DATA, (False,)),
                linked("device", DEVICES),
                Entered("messages.sent", {"to": BEA, "text": "I've arrived"}),
            )
        ),
        (*ONLINE, *write_to(BEA), Tap(text="I've arrived")),
        slips=(
            (*ONLINE[:-2], *ONLINE[-1:], *write_to(BEA), Tap(text="I've arrived")),
            (*ONLINE[:4], Tap(text="Home-5G"), *ONLINE[5:], *write_to(BEA), Tap(text="I've arrived")),
        ),
        may_write=READ,
    ),
    parameters={"network": NETWORKS, "device": tuple(DEVICES)},
    tags=frozenset({"two_modules"}),
    ability=Ability.CHAIN,
    guess_loses=(
        "Four networks, three devices: the memo names one, and the mobile data must go only after it is joined."
    ),
)

DOORS = (Open("vehicle"), Tap("vehicle.tab.doors"))
UNLOAD = (
    Open("charging"),
    Tap("charging.flap"),
    *DOORS,
    Tap("door.trunk"),
    *write_to(BEA),
    Tap(text="I've arrived"),
)
ONLY_THE_TRUNK = (Open("charging"), *DOORS, Tap("door.trunk"), *write_to(BEA), Tap(text="{words}"))
IN_THE_YARD = with_papers(PARKED, contacts=knowing(BEA))
CABLE_IN = hard(
    "hard_cable_in_or_not",
    Module.APPS,
    (
        "Open flap and trunk and text Bea 'I've arrived'. If the cable's still in, leave the flap and write"
        " '{words}'"
        " instead.",
        "Trunk open. The charging flap too, and 'I've arrived' to Bea, unless it's plugged in: then not the"
        " flap, and"
        " Bea gets '{words}'.",
        "I'm going to unload: boot up. No cable in the car? Then uncover the socket and tell Bea I've arrived."
        " Cable"
        " in? Only '{words}' to her.",
        "See whether we're plugged in. If we aren't, open flap and trunk and tell Bea 'I've arrived'."
        " If we are, only the trunk, and Bea gets '{words}'.",
    ),
    done(
        IN_THE_YARD,
        AllOf(
            (
                SignalIs(ENERGY.CHARGE_FLAP, (True,)),
                SignalIs(CABIN.TRUNK, (True,)),
                Entered("messages.sent", {"to": BEA, "text": "I've arrived"}),
            )
        ),
        UNLOAD,
        slips=(ONLY_THE_TRUNK,),
        may_write=frozenset(),
    ),
    done(
        replace(IN_THE_YARD, signals={ENERGY.CHARGE_FLAP.path: True, ENERGY.CABLE.path: True}),
        AllOf((SignalIs(CABIN.TRUNK, (True,)), Entered("messages.sent", {"to": BEA, "text": "{words}"}))),
        ONLY_THE_TRUNK,
        slips=(UNLOAD,),
        may_write=frozenset(),
    ),
    "settings: no cable, or the cable still in",
    parameters={"words": ("Where are you?", "Yes", "No", "Thank you", "On my way")},
    tags=frozenset({"two_modules"}),
    ability=Ability.PLANNING,
    guess_loses="Whether the cable is in shows on the charging screen alone.",
)

LOOK = (Open("vehicle"), Tap("vehicle.tab.driving"), Tap("vehicle.tab.lights"))
TO_MALIK = (*write_to(MALIK), Tap(text="{words}"))
WASH_IT = (*LOOK, Tap("wiper.wash", 3), Tap("wiper.rear.interval"))
FILTHY = with_papers(ON_THE_ROAD, contacts=knowing(MALIK))
WASHER_ENOUGH = hard(
    "hard_washer_enough",
    Module.PHENOMENON,
    (
        "Wash the windscreen three times and let the rear wiper go now and then. With under a fifth of fluid don't"
        " wash, text Malik '{words}'.",
        "Three squirts for the glass in front, rear wiper on interval, provided the tank has 20 percent. Otherwise"
        " none of that, but '{words}' to Malik.",
        "Is there 20 percent of washer fluid? If yes wash three times and put the back wiper on interval; if not,"
        " Malik gets a '{words}'.",
        "Check the washer tank. At 20 percent or more, wash three times and put the rear wiper on"
        " interval. Below that, only '{words}' for Malik, please.",
    ),
    done(
        FILTHY,
        AllOf((Counted("washer", 3), SignalIs(BODY.REAR_WIPER, ("INTERVAL",)))),
        WASH_IT,
        slips=(WASH_IT[:-1], (*LOOK, *TO_MALIK)),
        may_write=frozenset(),
        deadline=A_RED_LIGHT,
    ),
    done(
        replace(FILTHY, signals={BODY.WASHER_FLUID.path: 12.0}),
        Entered("messages.sent", {"to": MALIK, "text": "{words}"}),
        (*LOOK, *TO_MALIK),
        slips=(WASH_IT,),
        may_write=frozenset(),
        deadline=A_RED_LIGHT,
    ),
    "settings: the tank is four fifths full, or nearly empty",
    parameters={"words": ("Where are you?", "Yes", "No", "Thank you", "On my way")},
    tags=frozenset({"two_modules"}),
    ability=Ability.PLANNING,
    guess_loses="The level of the fluid is behind a screen, and decides between washing and a message.",
)

WAY_KM = {80: 170, 90: 180, 100: 190, 110: 210, 120: 240}
"""Kilometres one way that 279 km of range suffice for, there and back, and others that they do not."""
COMES = (*letter(BEA), Open("charging"), *write_to(BEA), Tap(text="Yes"))
CHARGES = (
    *letter(BEA),
    Open("charging"),
    Slide("charging.limit", 100.0, 50.0, 100.0),
    *write_to(BEA),
    Tap(text="No"),
)
FAR_ENOUGH = hard(
    "hard_far_enough",
    Module.APPS,
    (
        "Bea writes how far it is to hers. If what's in the battery takes us there and back, tell her Yes; if it"
        " doesn't, No, and set the charge limit to 100.",
        "Can we make it to Bea's and home without charging? Her message has the way. Please text her Yes or No, and"
        " for a No put the limit at 100.",
        "Compare the range with the road to Bea, both directions. Enough: 'Yes' to her. Too little: 'No', and"
        " let it"
        " charge to 100 next time.",
        "See Bea's message for the kilometres and double them. If our range covers that she gets a"
        " Yes; if not, a No, and our charge limit goes to 100.",
    ),
    done(
        with_letter(PARKED, BEA, "Do come! It's {km} km to us."),
        Entered("messages.sent", {"to": BEA, "text": "Yes"}),
        COMES,
        slips=(CHARGES,),
    ),
    done(
        with_letter(PARKED, BEA, param("km", {km: f"Do come! It's {far} km to us." for km, far in WAY_KM.items()})),
        AllOf((SignalIs(ENERGY.CHARGE_LIMIT, (100.0,)), Entered("messages.sent", {"to": BEA, "text": "No"}))),
        CHARGES,
        slips=(COMES, (*letter(BEA), Open("charging"), *write_to(BEA), Tap(text="No"))),
    ),
    "content: a way that the range covers twice, or only once",
    parameters={"km": tuple(WAY_KM)},
    tags=frozenset({"two_modules"}),
    ability=Ability.PLANNING,
    guess_loses="There and back against the range: the distance is in a message, the range on another screen.",
)

TASKS = (TRAILER_ROUTE, LEAVE_IN_TIME, TWO_TICKETS, HOTEL_NETWORK, CABLE_IN, WASHER_ENOUGH, FAR_ENOUGH)
