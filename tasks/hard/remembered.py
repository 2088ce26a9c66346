"""Several trips of one driver: what he said on one is noted in the car, holds on another, and may be withdrawn."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat
from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.signals import CABIN, ENERGY, HMI, HVAC, LINK, MEDIA, SEAT, VOICE
from automotive_cosim.tasking.checks import AllOf, AppDataIs, Check, Entered, SeatRecalled, SignalIs
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import FromCockpit, param
from automotive_cosim.tasking.records import EnteredAll
from automotive_cosim.tasking.task import Ability, Deadline, Half, Module, Start
from automotive_cosim.tasks.hard.forms import (
    AS_A_PASSENGER,
    ISLA,
    MALIK,
    ON_THE_ROAD,
    OSKAR,
    PARKED,
    PRIYA,
    READ,
    WANDA,
    Moves,
    answer,
    done,
    figure,
    hard,
    knowing,
    letter,
    told,
    wait,
    with_papers,
    wrote,
)
from automotive_cosim.tasks.maps import SETS_OUT

NOTES = (Open("memo"),)
THURSDAY = "2026-11-19T09:40:00"
LATER = "I'm driving, I'll call later"


def _trips(start: Start, *notes: Any, at: str = THURSDAY, **papers: Any) -> Start:
    """The start with what was said on the trips of this week, as the car has noted it."""
    return with_papers(replace(start, start=at), memos=notes, **papers)


def _recalled(start: Start, goal: tuple[Check, ...], moves: Moves, *slips: Moves, **more: Any) -> Half:
    settings: dict[str, Any] = {"deadline": AS_A_PASSENGER, "may_write": frozenset[str]()} | more
    return done(start, AllOf(goal), moves, slips=slips, **settings)


DEGREES = {23: (4, 22, 2), 24: (6, 22, 2), 25: (8, 23, 4), 26: (10, 24, 6)}
"""What was said first, the half degrees to it from 21, and the same of what was said later."""
MOTHER = (Occupant(Seat.PASSENGER, Kind.ELDERLY),)


def _for_mother(ups: dict[int, int]) -> Moves:
    return (
        *NOTES,
        Open("climate"),
        Tap("hvac.passenger_temperature.increase", param("first", ups)),
        Tap("hvac.passenger_seat_heating", 2),
        *answer(ISLA, "On my way"),
    )


def _mother(withdrawn: str, degrees: dict[int, float], ups: dict[int, int], wrong: dict[int, int]) -> Half:
    second = {first: withdrawn.format(degrees=later) for first, (_, later, _) in DEGREES.items()}
    start = _trips(
        replace(ON_THE_ROAD, aboard=MOTHER),
        param("first", second),
        "Tue 17 Nov: I want the news on the hour",
        "Mon 16 Nov: With my mother beside me, {first} on her side and her seat on high",
        contacts=knowing(ISLA),
    )
    return _recalled(
        start,
        (
            SignalIs(HVAC.PASSENGER_TEMPERATURE, (param("first", degrees),)),
            SignalIs(SEAT.PASSENGER_HEATING, (100.0,)),
            told(ISLA, "On my way"),
        ),
        _for_mother(ups),
        _for_mother(wrong),
        may_write=frozenset({HVAC.SYNC.path}),
    )


FIRST_UPS = {first: ups for first, (ups, _, _) in DEGREES.items()}
LATER_UPS = {first: ups for first, (_, _, ups) in DEGREES.items()}
MY_MOTHER = hard(
    "hard_my_mother_again",
    Module.HVAC,
    (
        "My mother is with me again. Her side the way I told you this week, it's among the memos, and 'On my way'"
        " to"
        " Isla.",
        "You noted on our last trips how my mother likes it; set her place like that now. Then text Isla 'On my"
        " way'.",
        "Mother beside me: make it warm for her as my notes of these days have it, and write Isla that I'm on my"
        " way.",
        "My mother is beside me. Do for her what I asked for on our earlier trips, it's in the memos. Isla"
        " gets"
        " 'On my way'.",
    ),
    _mother(
        "Wed 18 Nov: Too hot for my mother. {degrees} from now on, the seat still on high",
        {first: float(later) for first, (_, later, _) in DEGREES.items()},
        LATER_UPS,
        FIRST_UPS,
    ),
    _mother(
        "Wed 18 Nov: For my father {degrees} will do, tell me when he gets in",
        {first: float(first) for first in DEGREES},
        FIRST_UPS,
        LATER_UPS,
    ),
    "content: the degrees for his mother were changed on Wednesday, or those for his father given",
    parameters={"first": tuple(DEGREES)},
    tags=frozenset({"preference", "two_modules"}),
    ability=Ability.MEMORY,
    guess_loses="Two figures are noted; the later one replaces the first, or is about somebody else.",
)

OPTIONS = (Open("map"), Tap("map.route"), Tap("route.tab.options"))


def _avoiding(*kinds: str) -> Moves:
    return (
        *NOTES,
        *OPTIONS,
        *(Tap(f"route.avoid.{kind}") for kind in kinds),
        Open("map"),
        Tap(text="{place}"),
        SETS_OUT,
    )


def _tolls(note: str, avoided: list[str], moves: Moves, *wrong: Moves) -> Half:
    start = _trips(
        Start("london", "bloomsbury"),
        note,
        "Tue 17 Nov: And no ferries either, I get seasick",
        "Mon 16 Nov: Never by toll roads, from today",
    )
    return _recalled(
        start,
        (AppDataIs("navigation.avoid", (avoided,)), AppDataIs("navigation.destination", (param("place"),))),
        moves,
        *wrong,
    )


THE_WAY_I_LIKE = hard(
    "hard_the_way_i_like",
    Module.MAPS,
    (
        "To {place}, and leave out of the route whatever I've ruled out on our trips this week. It's in the memos.",
        "Guide me to {place} by the rules that I gave you since Monday, as far as they still hold; see the notes.",
        "{place}, please. What I don't want on the way I've told you on Monday, Tuesday and Wednesday: set that"
        " first.",
        "Take me to {place}; keep off what my notes of the last days forbid, and off nothing else.",
    ),
    _tolls(
        "Wed 18 Nov: Toll roads are all right again, the firm pays them now",
        ["ferries"],
        _avoiding("ferries"),
        _avoiding("tolls", "ferries"),
        _avoiding("tolls"),
    ),
    _tolls(
        "Wed 18 Nov: I'm late, so by the toll road this once",
        ["tolls", "ferries"],
        _avoiding("tolls", "ferries"),
        _avoiding("ferries"),
    ),
    "content: toll roads are allowed again for good, or were for one trip",
    parameters={"place": FromCockpit("favourite_places")},
    tags=frozenset({"preference"}),
    ability=Ability.MEMORY,
    guess_loses="Three notes, of which the last withdraws the first, or made one exception on Wednesday.",
)

CHARGES = {65: 90, 70: 85, 75: 95, 60: 100}
READY = ("05:30", "06:00", "06:30")


def _tonight(limit: Any) -> Moves:
    return (
        *NOTES,
        Open("charging"),
        Slide("charging.limit", limit, 50.0, 100.0),
        TapUntil("charging.schedule.earlier", "charging.schedule.time", "{ready}"),
        Tap("charging.schedule"),
        *answer(ISLA, "Yes"),
    )


def _friday(note: str, limit: Any, wrong: Any) -> Half:
    start = _trips(
        replace(PARKED, signals={ENERGY.LEVEL.path: 40.0}),
        note,
        param(
            "usual",
            {
                usual: f"Tue 17 Nov: On Fridays charge to {more}, we go to the hut"
                for usual, more in CHARGES.items()
            },
        ),
        "Mon 16 Nov: Charge to {usual} at home, ready by {ready}",
        at="2026-11-20T19:30:00",
        contacts=knowing(ISLA),
    )
    return _recalled(
        start,
        (
            SignalIs(ENERGY.CHARGE_LIMIT, (limit,)),
            AppDataIs("charging.schedule", ("{ready}",)),
            told(ISLA, "Yes"),
        ),
        _tonight(limit),
        _tonight(wrong),
    )


USUAL, MORE = (
    param("usual", {usual: float(usual) for usual in CHARGES}),
    param("usual", {usual: float(more) for usual, more in CHARGES.items()}),
)
CHARGE_AS_TOLD = hard(
    "hard_charge_as_told",
    Module.APPS,
    (
        "We're home. Charging as I told you this week, limit and hour, and 'Yes' to Isla when it's set.",
        "Set the charging for tonight, a Friday, by what you've noted of my wishes since Monday; Isla gets a"
        " 'Yes'.",
        "Tonight's charge: limit and time are in my notes of the week, mind what still holds. Tell Isla yes.",
        "It's Friday evening at home. Set the charge limit and the ready time as my memos of this week"
        " say, then text Isla 'Yes'.",
    ),
    _friday("Wed 18 Nov: The hut is sold, so Fridays are as the other days", USUAL, MORE),
    _friday("Wed 18 Nov: The hut is let this winter, but my Fridays stay as I said", MORE, USUAL),
    "content: the rule for Fridays was dropped on Wednesday, or kept",
    parameters={"usual": tuple(CHARGES), "ready": READY},
    tags=frozenset({"preference", "two_modules"}),
    ability=Ability.MEMORY,
    guess_loses="Friday had a limit of its own, which a later note withdraws or confirms.",
)

LATE = (15, 20, 25, 35, 40)
QUARTER_STEPS = param("late", {late: late // 5 for late in LATE})


def _tells_boss(boss: str) -> Moves:
    return (*NOTES, *figure(boss, "late", Tap("figure.up", QUARTER_STEPS)), *answer(WANDA, "Yes"))


def _boss(note: str, boss: str, other: str) -> Half:
    start = _trips(
        replace(ON_THE_ROAD, interruptions=(Arrival("message", 6.0, other, "Where are you? They're all here!"),)),
        note,
        "Tue 17 Nov: The sitter, that's Wanda",
        "Mon 16 Nov: When I say the boss I mean Priya",
        contacts=knowing(PRIYA, MALIK, WANDA),
    )
    late = {"to": boss, "text": "I'll be {late} minutes late"}
    sent = EnteredAll("messages.sent", (late, {"to": WANDA, "text": "Yes"}))
    return _recalled(start, (sent,), _tells_boss(boss), _tells_boss(other), (*NOTES, *answer(WANDA, "Yes")))


THE_BOSS = hard(
    "hard_tell_the_boss",
    Module.COMMS,
    (
        "Tell the boss by text that I'm {late} minutes late, and the sitter 'Yes'. You know who they are, I told"
        " you"
        " this week.",
        "{late} minutes late, that to the boss; a 'Yes' to the sitter. Who is who is among the notes of our trips.",
        "Write to the boss: {late} minutes late. And 'Yes' to our sitter. I said on Monday and since whom I mean.",
        "The boss must know that I'll be {late} minutes late, and the sitter gets a 'Yes'. For the names see "
        "the memos of this week.",
    ),
    _boss("Wed 18 Nov: Priya has left us. The boss is Malik now", MALIK, PRIYA),
    _boss("Wed 18 Nov: Malik says he's the boss now. He wishes", PRIYA, MALIK),
    "content: another one has become the boss, or only says so",
    parameters={"late": LATE},
    ability=Ability.MEMORY,
    guess_loses="Two names are noted for one word, and the later one holds only if it was meant.",
)

SEATS = (Open("vehicle"), Tap("vehicle.tab.seats"))
SAT_ELSEWHERE = replace(
    PARKED,
    signals={SEAT.DRIVER_POSITION.path: 220.0, SEAT.DRIVER_HEIGHT.path: 60.0, SEAT.DRIVER_RECLINE.path: 30.0},
)


def _sits(slot: int) -> Moves:
    return (*NOTES, *SEATS, Tap(f"seat.memory.{slot}"), *answer(OSKAR, "{words}"))


def _seat(hour: str, slot: int, *wrong: int) -> Half:
    start = _trips(
        SAT_ELSEWHERE,
        "Wed 18 Nov: 2 hurts my back. After dark I'll sit as in 3 instead",
        "Tue 17 Nov: After dark put me as in seat memory 2, I see better",
        "Mon 16 Nov: By day I want the seat as in memory 1",
        at=f"2026-11-19T{hour}:00",
        contacts=knowing(OSKAR),
    )
    slips = tuple(_sits(other) for other in wrong)
    return _recalled(start, (SeatRecalled(slot), told(OSKAR, "{words}")), _sits(slot), *slips)


MY_SEAT = hard(
    "hard_seat_for_this_hour",
    Module.SYSTEM,
    (
        "Somebody has moved my seat. Put it as I want it at this hour, by what I've told you this week, and text"
        " Oskar"
        " '{words}'.",
        "My seat, please, the place for this time of day that I named on our trips; then '{words}' to Oskar.",
        "Recall the seat that my notes of these days have for now. Oskar gets '{words}'.",
        "Which seat memory do I use at an hour like this? It's in the memos, the latest word counts. Recall that"
        " one and"
        " send Oskar '{words}'.",
    ),
    _seat("19:20", 3, 2, 1),
    _seat("11:20", 1, 3, 2),
    "time of day: after dark, or by day",
    parameters={"words": ("On my way", "Yes", "Thank you")},
    tags=frozenset({"preference", "two_modules"}),
    ability=Ability.MEMORY,
    guess_loses="Three places are noted: one by day, one after dark, and one in place of that.",
)

HEARD = (Open("settings"), Tap("settings.page.sound"), Slide("sound.guidance", param("percent")))
REFUSED = (*NOTES, *HEARD, *wait(6), Tap("call.reply"), Tap(text=LATER))
TAKEN = (*NOTES, *HEARD, *wait(6), Tap("call.answer"))
AT_GUIDANCE = SignalIs(VOICE.GUIDANCE_VOLUME, (param("percent"),))
RINGS = Deadline(36.0, "a call rings for 30 s (ETSI TS 122 082), and it comes after 8 s")


def _isla_rings(note: str, goal: tuple[Check, ...], moves: Moves, wrong: Moves) -> Half:
    start = _trips(
        replace(ON_THE_ROAD, interruptions=(Arrival("call", 8.0, ISLA),)),
        note,
        "Tue 17 Nov: Isla is the exception, put her through at any hour",
        "Mon 16 Nov: Before nine I take no calls: answer that I'm driving, call later",
        at="2026-11-19T08:10:00",
        contacts=knowing(ISLA),
    )
    return _recalled(start, (AT_GUIDANCE, *goal), moves, wrong, deadline=RINGS)


CALLS_AS_TOLD = hard(
    "hard_calls_as_told",
    Module.COMMS,
    (
        "Guidance volume {percent}, and if somebody rings, treat the call as I've told you on the trips this week.",
        "Set the spoken directions to {percent}. A call may come: what to do with it you have in the notes since"
        " Monday.",
        "{percent} for the voice of the map. Should the phone ring, go by my rules of these days, they're memos.",
        "The guidance voice at {percent}, please. For calls at this hour my notes of the week hold; handle"
        " the one that comes by them.",
    ),
    _isla_rings(
        "Wed 18 Nov: No more exception for Isla, she talks too long",
        (Entered("calls.declined", ISLA), told(ISLA, LATER)),
        REFUSED,
        TAKEN,
    ),
    _isla_rings(
        "Wed 18 Nov: Isla has a new number, it's in the phone already",
        (Entered("calls.answered", ISLA),),
        TAKEN,
        REFUSED,
    ),
    "content: the exception for her was withdrawn on Wednesday, or her number changed",
    parameters={"percent": (20, 30, 40, 60, 70)},
    tags=frozenset({"preference", "two_modules"}),
    ability=Ability.MEMORY,
    guess_loses=(
        "The call comes at an awkward moment, and a rule, its exception and the end of that are in three notes."
    ),
)

MINUTES = {"two hours": 120, "four hours": 240, "half an hour": 30}


def _ticket(zone: str) -> Moves:
    return (
        *NOTES,
        Open("parking"),
        Tap(f"parking.zone.{zone.lower()}"),
        Tap(param("short", {short: f"parking.time.{minutes}" for short, minutes in MINUTES.items()})),
        Tap("parking.pay"),
        *answer(WANDA, "Thank you"),
    )


def _office(note: str, zone: str, other: str) -> Half:
    start = _trips(
        PARKED,
        note,
        "Tue 17 Nov: But on Thursdays it's {short} at the office",
        "Mon 16 Nov: At the office always zone C, for an hour",
        contacts=knowing(WANDA),
    )
    minutes = param("short", MINUTES)
    return _recalled(
        start,
        (
            Entered("payments", {"zone": f"Zone {zone}", "minutes": minutes}),
            AppDataIs("parking.zone", (f"Zone {zone}",)),
            AppDataIs("parking.minutes", (minutes,)),
            told(WANDA, "Thank you"),
        ),
        _ticket(zone),
        _ticket(other),
    )


OFFICE_TICKET = hard(
    "hard_office_on_thursday",
    Module.APPS,
    (
        "We're at the office. Pay for parking the way I told you this week, as it holds for today, and thank"
        " Wanda.",
        "The ticket for the office, by my notes since Monday; it's Thursday. Wanda gets a 'Thank you'.",
        "Parking here at work: zone and time are in what I said on our trips. Buy that, then 'Thank you' to Wanda.",
        "Buy the parking ticket for the office as my memos of this week have it for a Thursday, and send Wanda"
        " 'Thank you'.",
    ),
    _office("Wed 18 Nov: They've put up new signs at the office, it's zone B now", "B", "C"),
    _office("Wed 18 Nov: At the gym it's zone B, for half an hour", "C", "B"),
    "content: the office's zone has changed, or the gym's was named",
    parameters={"short": tuple(MINUTES)},
    tags=frozenset({"two_modules"}),
    ability=Ability.MEMORY,
    guess_loses="A rule, its exception for today, and a change that is about this place or another.",
)

GLOWS = {10: 30, 20: 50, 40: 20, 50: 10}
"""Ambient light, and brightness of the screen."""
RED, BLUE = "#FF5C5C", "#4FA8FF"
DIMMED = (
    *NOTES,
    Open("settings"),
    Slide("settings.brightness", param("glow", {glow: float(screen) for glow, screen in GLOWS.items()})),
    Open("vehicle"),
    Tap("vehicle.tab.interior"),
    Slide("light.ambient", param("glow")),
)
REDDENED = (*DIMMED, Tap("light.colour.red"))


def _night(note: str, colour: str, moves: Moves, wrong: Moves) -> Half:
    screen = param(
        "glow",
        {glow: f"Mon 16 Nov: After dark ambient light {glow}, screen {each}" for glow, each in GLOWS.items()},
    )
    start = _trips(
        replace(ON_THE_ROAD, interruptions=(Arrival("message", 7.0, OSKAR, "Don't you see well in red light?"),)),
        note,
        "Tue 17 Nov: And make the ambient light red at night",
        screen,
        at="2026-11-19T21:10:00",
        contacts=knowing(OSKAR),
    )
    return _recalled(
        start,
        (
            SignalIs(CABIN.AMBIENT_LIGHT, (param("glow"),)),
            SignalIs(HMI.BRIGHTNESS, (param("glow", {glow: float(each) for glow, each in GLOWS.items()}),)),
            SignalIs(CABIN.AMBIENT_COLOUR, (colour,)),
            told(OSKAR, "On my way"),
        ),
        (*moves, *answer(OSKAR, "On my way")),
        (*wrong, *answer(OSKAR, "On my way")),
    )


NIGHT_LIGHT = hard(
    "hard_light_as_told",
    Module.SYSTEM,
    (
        "It's dark: light and screen as I've told you on the trips this week, then 'On my way' to Oskar.",
        "Make it my night in here, ambient light and display, by the notes you have of it. Oskar gets 'On my way'.",
        "Night drive. How I want the glow and the screen is in my memos since Monday; set it, and text Oskar that"
        " I'm on"
        " my way.",
        "For the dark, put ambient light, its colour and the screen the way my notes of these days have it, and"
        " write"
        " Oskar 'On my way'.",
    ),
    _night("Wed 18 Nov: Red is awful. Leave the colour as it always was", BLUE, DIMMED, REDDENED),
    _night("Wed 18 Nov: My sister finds red awful. I like it", RED, REDDENED, DIMMED),
    "content: he has withdrawn the colour, or tells that his sister dislikes it",
    parameters={"glow": tuple(GLOWS)},
    tags=frozenset({"preference", "two_modules"}),
    ability=Ability.MEMORY,
    guess_loses="The last note speaks against the colour in both halves, once for him and once for somebody else.",
)

PRIVACY = (Open("settings"), Tap("settings.page.privacy"))
GO_HOME = (*NOTES, Open("map"), Tap(text="Home"), SETS_OUT, *PRIVACY, Tap("privacy.position"))
TELL_ALL = (*GO_HOME, Tap("settings.page.connections"), Tap("link.hotspot"))


def _shares(note: str, hotspot: bool, moves: Moves, wrong: Moves) -> Half:
    start = _trips(
        Start("london", "bloomsbury"),
        note,
        "Tue 17 Nov: And the hotspot on the way home as well, for the children",
        "Mon 16 Nov: On the way home always share my position with the family",
        contacts=knowing(ISLA),
    )
    return _recalled(
        start,
        (
            AppDataIs("navigation.destination", ("Home",)),
            SignalIs(LINK.SHARE_POSITION, (True,)),
            SignalIs(LINK.HOTSPOT, (hotspot,)),
            told(ISLA, "{words}"),
        ),
        (*moves, *answer(ISLA, "{words}")),
        (*wrong, *answer(ISLA, "{words}")),
    )


SHARED_HOME = hard(
    "hard_home_and_shared",
    Module.SYSTEM,
    (
        "Home now, with what I want switched on for the way home; I told you on our trips. '{words}' to Isla.",
        "Guide me home. What's to be on meanwhile is in your notes of the week, no more than that. Isla gets"
        " '{words}'.",
        "Off home! Set the switches as I've said since Monday for that way, and text Isla '{words}'.",
        "Start the way home, switch on just what my memos of these days want for it, and write Isla '{words}'.",
    ),
    _shares(
        "Wed 18 Nov: The children have their own network now, they need none of ours", False, GO_HOME, TELL_ALL
    ),
    _shares("Wed 18 Nov: The children are mad about our network in the car", True, TELL_ALL, GO_HOME),
    "content: the children have a network of their own, or love the car's",
    parameters={"words": ("On my way", "Yes", "Where are you?")},
    tags=frozenset({"preference", "two_modules"}),
    ability=Ability.MEMORY,
    guess_loses="The second switch follows from a note that is about the children, and does not name it.",
)

LOUDNESS = {15: 40, 20: 45, 25: 50, 35: 60}
"""For the one child, and for the other."""
CHILD = (Occupant(Seat.REAR_RIGHT, Kind.CHILD),)


def _played(name: str, volume: Any) -> Moves:
    return (
        *NOTES,
        *letter(WANDA),
        Open("media"),
        Tap("media.list.playlists"),
        Tap(text=name),
        Tap("playlist.play"),
        Slide("media.volume", volume),
        *answer(WANDA, "Thank you"),
    )


BENS, MIAS = (
    param("soft", {soft: float(soft) for soft in LOUDNESS}),
    param("soft", {soft: float(loud) for soft, loud in LOUDNESS.items()}),
)


def _which_child(line: str, name: str, volume: Any, *wrong: Moves) -> Half:
    start = _trips(
        replace(
            ON_THE_ROAD, aboard=CHILD, interruptions=(Arrival("message", 9.0, WANDA, "And drive safely, you two!"),)
        ),
        "Wed 18 Nov: Ben has outgrown Calm, he gets Sunday now, as loud as before",
        param(
            "soft",
            {soft: f"Tue 17 Nov: If it's Mia who's with us: Dance, at {loud}" for soft, loud in LOUDNESS.items()},
        ),
        "Mon 16 Nov: With Ben in the back play Calm, at {soft}",
        contacts=knowing(WANDA),
        threads=(wrote(WANDA, line),),
    )
    return _recalled(
        start,
        (
            SignalIs(MEDIA.ACTION, ("PLAY",)),
            AppDataIs("media.playlist", (name,)),
            SignalIs(MEDIA.VOLUME, (volume,)),
            told(WANDA, "Thank you"),
        ),
        _played(name, volume),
        *wrong,
        may_write=READ | {MEDIA.SOURCE.path, MEDIA.SELECTED.path},
    )


MUSIC_FOR = hard(
    "hard_music_for_the_child",
    Module.MEDIA,
    (
        "Wanda has written which of the two I've got behind me. Play what I told you this week for that child, as"
        " loud"
        " as I said, and thank her.",
        "Ben or Mia? Wanda's message says. Then the music for that one by my notes since Monday, volume too; she"
        " gets a"
        " 'Thank you'.",
        "For the child in the back, Wanda wrote who it is, put on what belongs to it by our last trips, at the"
        " right"
        " volume, and thank Wanda.",
        "See from Wanda's text who sits behind me, play that child's list at that child's volume as the memos have"
        " it,"
        " and send her 'Thank you'.",
    ),
    _which_child("It's Ben who's with you", "Sunday", BENS, _played("Calm", BENS), _played("Dance", MIAS)),
    _which_child("It's Mia who's with you", "Dance", MIAS, _played("Sunday", BENS)),
    "content: the child is Ben, whose list has changed, or Mia",
    parameters={"soft": tuple(LOUDNESS)},
    tags=frozenset({"preference", "two_modules"}),
    ability=Ability.MEMORY,
    guess_loses="Three lists and two volumes are noted; who sits behind is in a message.",
)

TASKS = (
    MY_MOTHER,
    THE_WAY_I_LIKE,
    CHARGE_AS_TOLD,
    THE_BOSS,
    MY_SEAT,
    CALLS_AS_TOLD,
    OFFICE_TICKET,
    NIGHT_LIGHT,
    SHARED_HOME,
    MUSIC_FOR,
)
