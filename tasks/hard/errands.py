"""Errands over several apps: what one of them says decides what is done in the next."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.calendar import Appointment
from automotive_cosim.cockpit.signals import ENERGY, MEDIA
from automotive_cosim.tasking.checks import AllOf, AppDataIs, Entered, SignalIs
from automotive_cosim.tasking.moves import Open, Slide, Tap
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.records import AppDataAt, AppDataWithout, EnteredAll, SaysFigure
from automotive_cosim.tasking.task import Ability, Half, Module, Start
from automotive_cosim.tasks.hard.forms import (
    BEA,
    BEFORE_LEAVING,
    ISLA,
    MALIK,
    OSKAR,
    PARKED,
    PRIYA,
    THE_OTHER_WAITS,
    THEO,
    WANDA,
    Moves,
    done,
    figure,
    hard,
    knowing,
    letter,
    with_letter,
    with_papers,
    write_to,
    wrote,
)
from automotive_cosim.tasks.maps import SETS_OUT, STOPS_THERE

CITY = with_papers(Start("london", "bloomsbury", start="2026-11-18T16:10:00"), contacts=knowing(BEA))
UNION, SUN = "Union Market", "Sun Pharmacy"


def _looked_up(kind: str, name: str) -> Moves:
    return (Open("map"), Tap("map.list.explore"), Tap(f"explore.kind.{kind}"), Tap(text=name))


def _via(kind: str, first: str, second_kind: str, second: str) -> Moves:
    return (
        *_looked_up("shop", UNION),
        *_looked_up("pharmacy", SUN),
        *_looked_up(second_kind, second),
        SETS_OUT,
        *_looked_up(kind, first),
        STOPS_THERE,
        *write_to(BEA),
        Tap(text=param("words")),
    )


MARKET_FIRST = _via("shop", UNION, "pharmacy", SUN)
PHARMACY_FIRST = _via("pharmacy", SUN, "shop", UNION)


def _ordered(market: str, pharmacy: str, first: str, then: str, right: Moves, wrong: Moves) -> Half:
    start = with_papers(CITY, details={UNION: f"Open until {market}", SUN: f"Open until {pharmacy}"})
    goal = AllOf(
        (
            AppDataIs("navigation.destination", (first,)),
            AppDataIs("navigation.onward", (then,)),
            Entered("messages.sent", {"to": BEA, "text": param("words")}),
        )
    )
    return done(start, goal, right, slips=(wrong,), may_write=frozenset())


CLOSES_FIRST = hard(
    "hard_what_closes_first",
    Module.MAPS,
    (
        "Union Market and Sun Pharmacy, both today: the one that closes earlier comes first. Tell Bea '{words}'.",
        "Two stops, Sun Pharmacy and Union Market, in the order of their closing times; '{words}' to Bea.",
        "I need something from Union Market and something from Sun Pharmacy. Start with whichever shuts"
        " sooner, then"
        " the other. Bea gets '{words}'.",
        "Plan Sun Pharmacy plus Union Market for me, the one that shuts first before the other, and"
        " text Bea '{words}'.",
    ),
    _ordered("17:00", "20:00", UNION, SUN, MARKET_FIRST, PHARMACY_FIRST),
    _ordered("21:00", "18:00", SUN, UNION, PHARMACY_FIRST, MARKET_FIRST),
    "content: the market closes first, or the pharmacy",
    parameters={"words": ("On my way", "Yes", "Thank you", "Where are you?", "No")},
    tags=frozenset({"two_modules"}),
    ability=Ability.PLANNING,
    guess_loses="The order follows from closing times that stand on the pages of two places.",
)

BOUGHT = {"B, half an hour": 1.3, "A, half an hour": 2.0, "C, two hours": 2.4, "B, an hour": 2.5, "C, an hour": 1.2}
"""Zone and time, and the price, which the ticket shows."""
ZONE = param("ticket", {ticket: f"parking.zone.{ticket[0].lower()}" for ticket in BOUGHT})
MINUTES = {"half an hour": 30, "an hour": 60, "two hours": 120}
STAY = {ticket: MINUTES[ticket[3:]] for ticket in BOUGHT}
BUY = (
    Open("parking"),
    Tap(ZONE),
    Tap(param("ticket", {ticket: f"parking.time.{minutes}" for ticket, minutes in STAY.items()})),
    Tap("parking.pay"),
)
COINS = Tap("figure.more", param("ticket", {ticket: int(price) for ticket, price in BOUGHT.items()}))
CENTS = Tap("figure.up", param("ticket", {ticket: round(10 * (price % 1)) for ticket, price in BOUGHT.items()}))
PRICE_TO_ISLA = hard(
    "hard_price_to_isla",
    Module.APPS,
    (
        "Buy a ticket for zone {ticket}, and write Isla what it has cost, to the tenth; she pays me back.",
        "Parking, zone {ticket}. Isla wants to know the price paid, one decimal, by message.",
        "Pay for {ticket}; then Isla gets the amount in a text, rounded to tenths.",
        "Zone {ticket}: get that ticket, and send Isla exactly how much it came to (one decimal place).",
    ),
    done(
        with_papers(PARKED, contacts=knowing(ISLA)),
        AllOf(
            (
                Entered(
                    "payments",
                    param(
                        "ticket",
                        {ticket: {"zone": f"Zone {ticket[0]}", "minutes": STAY[ticket]} for ticket in BOUGHT},
                    ),
                ),
                AppDataIs("parking.zone", (param("ticket", {ticket: f"Zone {ticket[0]}" for ticket in BOUGHT}),)),
                AppDataIs("parking.minutes", (param("ticket", STAY),)),
                SaysFigure(ISLA, "paid", param("ticket", BOUGHT), 0.05),
            )
        ),
        (*BUY, *figure(ISLA, "paid", COINS, CENTS)),
        slips=((*BUY, *figure(ISLA, "paid", Tap("figure.more", 4))), figure(ISLA, "paid", COINS, CENTS)),
        deadline=THE_OTHER_WAITS,
    ),
    parameters={"ticket": tuple(BOUGHT)},
    tags=frozenset({"two_modules"}),
    ability=Ability.CONTENT,
    guess_loses="The price is on the ticket, and differs by zone and time.",
)

LEVELS = (64, 43, 57, 36, 62)
LEFT_OVER = {level: level - 10 for level in LEVELS}
TEN = {level: f"figure.{'more' if target >= 50 else 'less'}" for level, target in LEFT_OVER.items()}
UNITS = {level: f"figure.{'up' if target >= 50 else 'down'}" for level, target in LEFT_OVER.items()}
BATTERY_FOR_THEO = hard(
    "hard_battery_for_theo",
    Module.APPS,
    (
        "Theo takes the car from here. Text him what the battery will have when he gets it: now, less ten for"
        " my last"
        " errand. And cap charging at {limit}.",
        "What's in the battery, minus 10 points that I still need? Send Theo that percentage, and set the"
        " charge limit"
        " to {limit}.",
        "Write Theo the charge he'll find, ten percent below the present one, then put the limit for charging at"
        " {limit}.",
        "Charge limit {limit}; and Theo should hear by message how many percent I leave him, that is ten under"
        " what's"
        " shown.",
    ),
    done(
        with_papers(
            replace(PARKED, signals={ENERGY.LEVEL.path: param("level", {x: float(x) for x in LEVELS})}),
            contacts=knowing(THEO),
        ),
        AllOf(
            (
                SaysFigure(THEO, "battery", param("level", LEFT_OVER), 1.0),
                SignalIs(ENERGY.CHARGE_LIMIT, (param("limit"),)),
            )
        ),
        (
            Open("charging"),
            Slide("charging.limit", param("limit"), 50.0, 100.0),
            *figure(
                THEO,
                "level",
                Tap(param("level", TEN), param("level", {x: abs(t - 50) // 10 for x, t in LEFT_OVER.items()})),
                Tap(param("level", UNITS), param("level", {x: abs(t - 50) % 10 for x, t in LEFT_OVER.items()})),
            ),
        ),
        slips=(
            (
                Open("charging"),
                Slide("charging.limit", param("limit"), 50.0, 100.0),
                *figure(THEO, "level", Tap("figure.more", 2)),
            ),
        ),
        deadline=THE_OTHER_WAITS,
    ),
    parameters={"level": LEVELS, "limit": (60, 70, 90, 100)},
    tags=frozenset({"two_modules"}),
    ability=Ability.CONTENT,
    guess_loses="The level that is shown is not the one to be told: ten are still to be used.",
)

TODAY = (
    Appointment("10:30", "Osteopath", "Work"),
    Appointment("14:00", "Coffee with Priya", "Home"),
    Appointment("18:30", "Theatre", "Home"),
)
LATER_THAN_14 = {"14:45": 3, "15:00": 4, "15:15": 5, "15:30": 6, "15:45": 7}
THANKS = (*write_to(PRIYA), Tap(text="Thank you"))
TAKES_OUT = (*letter(PRIYA), Open("calendar"), Tap("calendar.1"), Tap("appointment.remove"), *THANKS)
PUTS_OFF = (
    *letter(PRIYA),
    Open("calendar"),
    Tap("calendar.1"),
    Tap("appointment.later", param("time", LATER_THAN_14)),
    *THANKS,
)
OFF_OR_LATER = hard(
    "hard_off_or_later",
    Module.APPS,
    (
        "Priya has written about our coffee. Bring my calendar into line with that and thank her.",
        "Something's up with Priya's coffee; do to my diary what she writes, then send 'Thank you'.",
        "Update the coffee date as Priya's message says, be it gone or moved, and reply Thank you.",
        "See what Priya has to say about this afternoon and put the calendar right by it; she gets a thank you.",
    ),
    done(
        with_letter(PARKED, PRIYA, "Would {time} have been better?", "I'm ill, so no coffee today", agenda=TODAY),
        AllOf(
            (AppDataWithout("calendar.entries", 1), Entered("messages.sent", {"to": PRIYA, "text": "Thank you"}))
        ),
        TAKES_OUT,
        slips=(PUTS_OFF,),
    ),
    done(
        with_letter(PARKED, PRIYA, "Still ill this morning, but", "coffee at {time} is fine!", agenda=TODAY),
        AllOf(
            (
                AppDataAt("calendar.entries", 1, param("time", {time: {"at": time} for time in LATER_THAN_14})),
                Entered("messages.sent", {"to": PRIYA, "text": "Thank you"}),
            )
        ),
        PUTS_OFF,
        slips=(TAKES_OUT,),
    ),
    "content: the coffee is off, or later",
    parameters={"time": tuple(LATER_THAN_14)},
    ability=Ability.CONTENT,
    guess_loses="One line speaks of another time and one of illness: what holds is the whole of them.",
)

THINGS = ("candles", "lemons", "coffee", "matches", "rice")
SHOPPING = ("call the plumber", "bread", "oat milk", "{thing}", "book the ferry")
GOT = (*letter(OSKAR), Open("memo"))


def _shopping(line: str, kept: tuple[str, ...], deletes: Moves, wrong: Moves) -> Half:
    start = with_letter(PARKED, OSKAR, "In the shop now.", line, memos=SHOPPING)
    goal = AllOf(
        (
            AppDataIs(
                "apps.memos",
                (param("thing", {thing: [each.format(thing=thing) for each in kept] for thing in THINGS}),),
            ),
            Entered("messages.sent", {"to": OSKAR, "text": "Thank you"}),
        )
    )
    thanks = (*write_to(OSKAR), Tap(text="Thank you"))
    return done(start, goal, (*GOT, *deletes, *thanks), slips=((*GOT, *wrong, *thanks),))


def _strikes(*things: str) -> Moves:
    return tuple(move for thing in things for move in (Tap(text=thing), Tap("note.delete")))


BREAD_MILK = _strikes("bread", "oat milk")
SHOPPING_DONE = hard(
    "hard_shopping_done",
    Module.APPS,
    (
        "Oskar is at the shop. Delete what he has got from my memos and thank him.",
        "Strike off my notes whatever Oskar writes that he's bought; send him a thank you.",
        "Clear those memos that Oskar has taken care of, only those, then text him Thank you.",
        "See which things on my list Oskar already has and remove them. A 'Thank you' goes back to him.",
    ),
    _shopping(
        "I have bread and oat milk, no {thing} left!",
        ("call the plumber", "{thing}", "book the ferry"),
        BREAD_MILK,
        (*BREAD_MILK, *_strikes("{thing}")),
    ),
    _shopping(
        "I have the {thing}, bread too, no oat milk left!",
        ("call the plumber", "oat milk", "book the ferry"),
        _strikes("bread", "{thing}"),
        BREAD_MILK,
    ),
    "content: he has one or the other",
    parameters={"thing": THINGS},
    ability=Ability.CONTENT,
    guess_loses="Some of what he names he has got, some he has not.",
)

TUNING = {-4: "bass -4", -2: "bass -2", 3: "bass 3", 5: "bass 5", 7: "bass 7"}
TUNE = (
    Open("memo"),
    Open("media"),
    Tap("media.sound"),
    Slide("sound.bass", param("bass"), -10.0, 10.0),
    Slide("sound.middle", 2.0, -10.0, 10.0),
    Slide("sound.treble", -3.0, -10.0, 10.0),
    Slide("sound.fader", -20.0, -100.0, 100.0),
    Slide("sound.media", 45.0),
    Open("media"),
    Tap("media.play"),
)
SOUND_FROM_MEMO = hard(
    "hard_sound_from_memo",
    Module.MEDIA,
    (
        "Somebody has played with the equaliser. My values are in the memos, fader and volume too; then play.",
        "Set the sound as I noted it, all five figures, and start the music.",
        "I wrote down bass, middle, treble, fader and volume once. Restore them from there and press play.",
        "Bring the stereo back to what my memo says, five numbers in all; afterwards let it run.",
    ),
    done(
        with_papers(
            replace(PARKED, signals={MEDIA.BASS.path: 9.0, MEDIA.TREBLE.path: 9.0, MEDIA.FADER.path: 60.0}),
            memos=(
                "Mum's birthday: tulips",
                param("bass", {x: f"Car: {words}, mid 2, treble -3" for x, words in TUNING.items()}),
                "Car: fader 20 rear, volume 45",
            ),
        ),
        AllOf(
            (
                SignalIs(MEDIA.BASS, (param("bass"),)),
                SignalIs(MEDIA.MIDDLE, (2.0,)),
                SignalIs(MEDIA.TREBLE, (-3.0,)),
                SignalIs(MEDIA.FADER, (-20.0,)),
                SignalIs(MEDIA.VOLUME, (45.0,)),
                SignalIs(MEDIA.ACTION, ("PLAY",)),
            )
        ),
        TUNE,
        slips=(TUNE[:-1], (*TUNE[:5], Slide("sound.treble", 3.0, -10.0, 10.0), *TUNE[6:])),
        may_write=frozenset({MEDIA.SELECTED.path}),
    ),
    parameters={"bass": tuple(TUNING)},
    tags=frozenset({"two_modules"}),
    ability=Ability.CONTENT,
    guess_loses="Five figures in two memos; one is told as rear, not front.",
)

FREE_SUMMER = (Appointment("09:00", "Stand-up", "Work"), Appointment("16:30", "Malik's farewell", "Work"))
ROUND = (OSKAR, WANDA, MALIK)
TELLS = tuple({"to": who, "text": "I'll be {late} minutes late"} for who in ROUND)
SAME_TO_ALL = tuple(move for who in ROUND for move in (*write_to(who), Tap("thread.figure"), Tap("figure.send")))
TELL_THE_ROUND = hard(
    "hard_tell_the_round",
    Module.COMMS,
    (
        "The round tonight, it's in my memos who that is: each of them is to know I'm {late} minutes late.",
        "Text everyone on the memo for tonight that I'll be {late} minutes late.",
        "{late} minutes late for the card players. Their names are noted; write to every one.",
        "Tell all those who play tonight, see my notes, that they have to wait: {late} minutes late.",
    ),
    done(
        with_papers(PARKED, contacts=knowing(*ROUND, ISLA), memos=("Tonight: Oskar, Wanda, Malik", "Sunday: Isla")),
        EnteredAll("messages.sent", TELLS),
        (
            Open("memo"),
            *write_to(OSKAR),
            Tap("thread.figure"),
            Tap("figure.say.late"),
            Tap("figure.up", param("late", {late: late // 5 for late in (10, 15, 20, 25, 35)})),
            Tap("figure.send"),
            *SAME_TO_ALL[6:],
        ),
        slips=(
            (
                Open("memo"),
                *write_to(OSKAR),
                Tap("thread.figure"),
                Tap("figure.say.late"),
                Tap("figure.up", param("late", {late: late // 5 for late in (10, 15, 20, 25, 35)})),
                Tap("figure.send"),
                *SAME_TO_ALL[6:12],
            ),
        ),
        deadline=BEFORE_LEAVING,
    ),
    parameters={"late": (10, 15, 20, 25, 35)},
    ability=Ability.CONTENT,
    guess_loses="Who belongs to the round is in a memo, and each gets a message of his own.",
)

PROPOSED = {"16:00": 2, "16:30": 4, "17:00": 6, "17:30": 8, "16:45": 5}
"""Time, and quarters of an hour from 15:30."""
LESSON = Appointment("15:30", "Lesson with Wanda", "Work")
MOVES_LESSON = (
    *letter(WANDA),
    Open("calendar"),
    Tap("calendar.0"),
    Tap("appointment.later", param("time", PROPOSED)),
)
YES_WANDA, NO_WANDA = ((*write_to(WANDA), Tap(text=word)) for word in ("Yes", "No"))


def _lesson(*others: Appointment) -> Start:
    return with_letter(PARKED, WANDA, "Would {time} do for you too?", agenda=(LESSON, *others))


FREE_THEN = hard(
    "hard_free_at_that_time",
    Module.APPS,
    (
        "Wanda wants another time for the lesson. If I've nothing else then, move it and tell her yes; if I"
        " have, just"
        " no.",
        "Check whether I'm free when Wanda proposes. Free: shift our lesson there and reply Yes. Booked: reply No,"
        " leave it.",
        "Look at Wanda's message and at my diary. Should nothing clash, put the lesson to her time, Yes to her."
        " Otherwise a No.",
        "Can the lesson be when Wanda says? Change it and send Yes, please, unless there's something at that very"
        " time, then No.",
    ),
    done(
        _lesson(Appointment("19:00", "Choir", "Home")),
        AllOf(
            (
                AppDataAt("calendar.entries", 0, param("time", {time: {"at": time} for time in PROPOSED})),
                Entered("messages.sent", {"to": WANDA, "text": "Yes"}),
            )
        ),
        (*MOVES_LESSON, *YES_WANDA),
        slips=((*letter(WANDA), Open("calendar"), *NO_WANDA), (*MOVES_LESSON,)),
    ),
    done(
        _lesson(Appointment(param("time"), "Notary", "Work"), Appointment("19:00", "Choir", "Home")),
        Entered("messages.sent", {"to": WANDA, "text": "No"}),
        (*letter(WANDA), Open("calendar"), *NO_WANDA),
        slips=((*MOVES_LESSON, *YES_WANDA),),
    ),
    "content: nothing else at that time, or the notary",
    parameters={"time": tuple(PROPOSED)},
    ability=Ability.CONTENT,
    guess_loses="Whether that time is free is in the calendar, the time in her message.",
)

EARLY = {"18:15": "19:00", "18:30": "19:15", "18:45": "19:30", "19:00": "19:45", "18:00": "18:45"}
"""When the one comes, and the other."""
TO_LATER = {"18:15": 4, "18:30": 5, "18:45": 6, "19:00": 7, "18:00": 3}
"""Quarters of an hour from 18:00 to the later time."""
DINNER = (Appointment("09:30", "Bank", "Work"), Appointment("18:00", "Dinner", "Home"))
COMES_AT = {early: f"I'll be with you at {late}" for early, late in EARLY.items()}


def _dinner(sooner: str, later: str) -> Half:
    start = with_papers(
        PARKED,
        contacts=knowing(OSKAR, WANDA),
        agenda=DINNER,
        threads=tuple(
            wrote(who, "I'll be with you at {early}" if who == sooner else param("early", COMES_AT))
            for who in (OSKAR, WANDA)
        ),
    )
    goal = AllOf(
        (
            AppDataAt(
                "calendar.entries", 1, param("early", {early: {"at": late} for early, late in EARLY.items()})
            ),
            Entered("messages.sent", {"to": sooner, "text": "Thank you"}),
        )
    )

    def thanking(who: str) -> Moves:
        return (
            *letter(OSKAR),
            *letter(WANDA),
            Open("calendar"),
            Tap("calendar.1"),
            Tap("appointment.later", param("early", TO_LATER)),
            *write_to(who),
            Tap(text="Thank you"),
        )

    return done(start, goal, thanking(sooner), slips=(thanking(later),))


LATER_OF_TWO = hard(
    "hard_later_of_two",
    Module.APPS,
    (
        "Oskar and Wanda write when they come. Dinner is when the later one is there: change it. Whoever comes"
        " first"
        " gets a thank you.",
        "Put the dinner in my calendar to the later of Wanda's and Oskar's arrivals, and send 'Thank you' to the"
        " earlier guest.",
        "We eat once both Oskar and Wanda are here, correct the entry by their messages. The first of them to"
        " arrive"
        " is to be thanked in writing.",
        "Two guests, Wanda and Oskar, two times: move dinner to the later one and text Thank you to"
        " whoever could have come sooner.",
    ),
    _dinner(OSKAR, WANDA),
    _dinner(WANDA, OSKAR),
    "content: he comes first, or she does",
    parameters={"early": tuple(EARLY)},
    ability=Ability.CONTENT,
    guess_loses="Two messages give two times; dinner follows the one, the thanks go to the other.",
)

HOURS = {"one hour": 60, "two hours": 120, "four hours": 240}
DAYS = ("today", "this afternoon")


def _cheaper(zone: str, other: str, dearer: str) -> Half:
    paid = AllOf(
        (
            Entered("payments", {"zone": f"Zone {zone}", "minutes": param("stay", HOURS)}),
            AppDataIs("parking.zone", (f"Zone {zone}",)),
            AppDataIs("parking.minutes", (param("stay", HOURS),)),
            Entered("messages.sent", {"to": ISLA, "text": "Thank you"}),
        )
    )

    def paying(which: str) -> Moves:
        return (
            *letter(ISLA),
            Open("parking"),
            Tap(text=f"Zone {other}"),
            Tap(text=f"Zone {which}"),
            Tap(param("stay", {words: f"parking.time.{minutes}" for words, minutes in HOURS.items()})),
            Tap("parking.pay"),
            *write_to(ISLA),
            Tap(text="Thank you"),
        )

    start = with_letter(PARKED, ISLA, f"Zones {zone} and {other} are near {{when}}")
    return done(start, paid, paying(zone), slips=(paying(dearer),))


CHEAPER_ZONE = hard(
    "hard_cheaper_zone",
    Module.APPS,
    (
        "Isla says which zones are near. Pay {stay} in the cheaper one of those and text her 'Thank you'.",
        "Of the zones in Isla's message take the one that costs less, {stay}, then send Isla a thank you.",
        "{stay} of parking where it's cheapest, but only in a zone that Isla names. Thank you to her.",
        "Compare the prices of what Isla suggests and buy {stay} in the better deal; she's to be thanked by text.",
    ),
    _cheaper("B", "A", "C"),
    _cheaper("C", "B", "B"),
    "content: she names A and B, or B and C",
    parameters={"stay": tuple(HOURS), "when": DAYS},
    ability=Ability.PLANNING,
    guess_loses="Prices show only when a zone is chosen, and she names two of the three.",
)

TASKS = (
    FREE_THEN,
    LATER_OF_TWO,
    CHEAPER_ZONE,
    CLOSES_FIRST,
    PRICE_TO_ISLA,
    BATTERY_FOR_THEO,
    OFF_OR_LATER,
    SHOPPING_DONE,
    SOUND_FROM_MEMO,
    TELL_THE_ROUND,
)
