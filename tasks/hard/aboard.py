"""Who is aboard, what the hour allows and what comes meanwhile decide which of the same wishes hold."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat, company
from automotive_cosim.cockpit.apps.calendar import Appointment
from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.signals import CABIN, HMI, HVAC, MEDIA, SEAT, TYRE
from automotive_cosim.contracts import Action, ActionType, AlertKind, Weather
from automotive_cosim.tasking.checks import AlertGiven, AllOf, AppDataIs, Entered, SignalIs
from automotive_cosim.tasking.history import Lasted
from automotive_cosim.tasking.moves import Do, Open, Slide, Tap, Warn
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.records import SaysFigure
from automotive_cosim.tasking.task import Ability, Deadline, Half, Module, Start
from automotive_cosim.tasks.hard.forms import (
    A_RED_LIGHT,
    BEA,
    ISLA,
    MALIK,
    ON_THE_ROAD,
    OSKAR,
    PARKED,
    THE_OTHER_WAITS,
    Moves,
    done,
    figure,
    hard,
    knowing,
    letter,
    with_papers,
    write_to,
)

PLAYLISTS = ("Road trip", "Sunday", "Dance", "Calm", "Classics")
PLAY_LIST = (
    Open("cabin"),
    Open("media"),
    Tap("media.list.playlists"),
    Tap(text="{playlist}"),
    Tap("playlist.play"),
    Tap("media.sound"),
)
TO_THE_FRONT = (Slide("sound.fader", 100.0, -100.0, 100.0), Slide("sound.media", 25.0))
LOUD = (Slide("sound.media", 60.0),)
LIST_PLAYS = (SignalIs(MEDIA.ACTION, ("PLAY",)), AppDataIs("media.playlist", ("{playlist}",)))
BABY = (Occupant(Seat.REAR_RIGHT, Kind.BABY, asleep=True),)
BOX = (Occupant(Seat.REAR_RIGHT, Kind.OBJECT),)
ASLEEP_BEHIND = hard(
    "hard_if_someone_sleeps",
    Module.MEDIA,
    (
        "Put {playlist} on, volume 60. If anybody's asleep in the back, though: 25, and only from the speakers in"
        " front. Tell Isla '{words}'.",
        "Music! {playlist} at 60; but with a sleeper behind us just 25 and the fader fully forward. And text Isla"
        " '{words}'.",
        "Check who's asleep on the rear seats. Nobody: {playlist} on 60. Somebody: {playlist}, 25, front speakers"
        " alone. Isla gets '{words}'.",
        "I'd like {playlist} at 60, unless it wakes someone back there; then quieter, at 25, and all of it to the"
        " front. After that '{words}' to Isla, please.",
    ),
    done(
        with_papers(replace(ON_THE_ROAD, aboard=BABY), contacts=knowing(ISLA)),
        AllOf(
            (
                *LIST_PLAYS,
                SignalIs(MEDIA.FADER, (100.0,)),
                SignalIs(MEDIA.VOLUME, (25.0,)),
                Entered("messages.sent", {"to": ISLA, "text": "{words}"}),
            )
        ),
        (*PLAY_LIST, *TO_THE_FRONT, *write_to(ISLA), Tap(text="{words}")),
        slips=(
            (*PLAY_LIST, *LOUD, *write_to(ISLA), Tap(text="{words}")),
            (*PLAY_LIST, Slide("sound.media", 25.0), *write_to(ISLA), Tap(text="{words}")),
        ),
        may_write=frozenset({MEDIA.SOURCE.path, MEDIA.SELECTED.path}),
        deadline=A_RED_LIGHT,
    ),
    done(
        with_papers(replace(ON_THE_ROAD, aboard=BOX), contacts=knowing(ISLA)),
        AllOf(
            (
                *LIST_PLAYS,
                SignalIs(MEDIA.VOLUME, (60.0,)),
                Entered("messages.sent", {"to": ISLA, "text": "{words}"}),
            )
        ),
        (*PLAY_LIST, *LOUD, *write_to(ISLA), Tap(text="{words}")),
        slips=((*PLAY_LIST, *TO_THE_FRONT, *write_to(ISLA), Tap(text="{words}")),),
        may_write=frozenset({MEDIA.SOURCE.path, MEDIA.SELECTED.path}),
        deadline=A_RED_LIGHT,
    ),
    "occupants: a baby asleep on the rear seat, or a box",
    parameters={"playlist": PLAYLISTS, "words": ("On my way", "Yes")},
    tags=frozenset({"two_modules"}),
    ability=Ability.OCCUPANTS,
    guess_loses="Who sits behind, and whether they sleep, shows on one screen and decides how loud it may be.",
)

FAMILY = (
    Occupant(Seat.PASSENGER, Kind.ADULT),
    Occupant(Seat.REAR_LEFT, Kind.CHILD),
    Occupant(Seat.REAR_RIGHT, Kind.CHILD),
)
UNBELTED = (*FAMILY[:2], replace(FAMILY[2], belted=False))
OFF_WE_GO = (
    Open("cabin"),
    Open("vehicle"),
    Tap("vehicle.tab.doors"),
    Tap("door.child_left"),
    Tap("door.child_right"),
    Tap("window.lock"),
    *write_to(BEA),
    Tap(text="{words}"),
)
EVERYBODY_BELTED = hard(
    "hard_once_all_are_belted",
    Module.SYSTEM,
    (
        "Is everyone strapped in? Then child locks on, rear windows blocked and '{words}' to Bea, please. If not,"
        " only warn me.",
        "Belts first: if one is open, sound the belt alert and touch nothing else. All closed: both child locks,"
        " window lock, and text Bea '{words}'.",
        "Check the buckles. Should all be done up, lock the kids' doors and windows and send Bea '{words}';"
        " otherwise just alert me to the belt.",
        "We only go with every belt closed. Closed: child locks left and right, window lock, '{words}' for"
        " Bea. Open:"
        " a seat-belt warning and nothing more.",
    ),
    done(
        with_papers(replace(PARKED, aboard=FAMILY), contacts=knowing(BEA)),
        AllOf(
            (
                SignalIs(CABIN.LEFT_CHILD_LOCK, (True,)),
                SignalIs(CABIN.RIGHT_CHILD_LOCK, (True,)),
                SignalIs(CABIN.WINDOW_LOCK, (True,)),
                Entered("messages.sent", {"to": BEA, "text": "{words}"}),
            )
        ),
        OFF_WE_GO,
        slips=((Open("cabin"), Warn(AlertKind.SEAT_BELT)), (*OFF_WE_GO, Warn(AlertKind.SEAT_BELT))),
        may_write=frozenset(),
        deadline=A_RED_LIGHT,
    ),
    done(
        with_papers(replace(PARKED, aboard=UNBELTED), contacts=knowing(BEA)),
        AlertGiven(AlertKind.SEAT_BELT),
        (Open("cabin"), Open("safety"), Tap("safety.kind.seat_belt"), Tap("safety.warn")),
        slips=(OFF_WE_GO, (*OFF_WE_GO, Warn(AlertKind.SEAT_BELT))),
        ways=((Warn(AlertKind.SEAT_BELT),),),
        may_write=frozenset(),
        deadline=A_RED_LIGHT,
    ),
    "occupants: all are belted, or the child on the right is not",
    parameters={"words": ("On my way", "Yes", "Thank you", "Where are you?", "No")},
    tags=frozenset({"conflict"}),
    ability=Ability.OCCUPANTS,
    guess_loses="One belt of four may be open, which only the cabin's screen tells.",
)

LEFT_CHILD = (Occupant(Seat.REAR_LEFT, Kind.CHILD), Occupant(Seat.REAR_RIGHT, Kind.ELDERLY))
RIGHT_CHILD = (Occupant(Seat.REAR_LEFT, Kind.ELDERLY), Occupant(Seat.REAR_RIGHT, Kind.CHILD))
BOTH_OPEN = {CABIN.REAR_LEFT_WINDOW.path: 40.0, CABIN.REAR_RIGHT_WINDOW.path: 40.0}


def _for_child(side: str) -> Moves:
    return (
        Open("cabin"),
        Open("vehicle"),
        Tap("vehicle.tab.doors"),
        Tap(f"door.child_{side}"),
        Slide(f"window.rear_{side}", 0.0),
        Open("climate"),
        Tap("hvac.comfort"),
        Tap(f"hvac.rear_{side}_seat_heating"),
        *write_to(BEA),
        Tap(text="{words}"),
    )


CHILDS_SIDE = hard(
    "hard_childs_side",
    Module.SYSTEM,
    (
        "Where the child sits: window up, child lock on, seat heating low. My mother's side stays as it is. Bea:"
        " '{words}'.",
        "On the kid's side of the bench I want the lock for children, a closed window and a bit of seat heat; Bea"
        " gets a '{words}'.",
        "Child lock, window shut, seat heat on low, but just on the side with the child, then text Bea '{words}'.",
        "Do for our little one in the back: close that window, lock that door for children, heat that seat,"
        " one step."
        " And '{words}' to Bea.",
    ),
    done(
        with_papers(replace(ON_THE_ROAD, aboard=LEFT_CHILD, signals=BOTH_OPEN), contacts=knowing(BEA)),
        AllOf(
            (
                SignalIs(CABIN.LEFT_CHILD_LOCK, (True,)),
                SignalIs(CABIN.REAR_LEFT_WINDOW, (0.0,)),
                SignalIs(SEAT.REAR_LEFT_HEATING, (50.0,)),
                Entered("messages.sent", {"to": BEA, "text": "{words}"}),
            )
        ),
        _for_child("left"),
        slips=(_for_child("right"), (*_for_child("left")[:-5], *_for_child("right")[1:])),
        may_write=frozenset(),
        deadline=A_RED_LIGHT,
    ),
    done(
        with_papers(replace(ON_THE_ROAD, aboard=RIGHT_CHILD, signals=BOTH_OPEN), contacts=knowing(BEA)),
        AllOf(
            (
                SignalIs(CABIN.RIGHT_CHILD_LOCK, (True,)),
                SignalIs(CABIN.REAR_RIGHT_WINDOW, (0.0,)),
                SignalIs(SEAT.REAR_RIGHT_HEATING, (50.0,)),
                Entered("messages.sent", {"to": BEA, "text": "{words}"}),
            )
        ),
        _for_child("right"),
        slips=(_for_child("left"),),
        may_write=frozenset(),
        deadline=A_RED_LIGHT,
    ),
    "occupants: the child sits on the left, or on the right",
    parameters={"words": ("On my way", "Yes", "Thank you", "Where are you?", "No")},
    tags=frozenset({"two_modules"}),
    ability=Ability.OCCUPANTS,
    guess_loses="Child and grandmother may sit either way round.",
)

SPRING = Weather(16.0, 55.0, 0.0, 1, 20.0, 20_000.0, 14.0)
DENTIST = (Appointment("09:00", "Stand-up", "Work"), Appointment("14:00", "Dentist, 45 min", "Work"))
STANDING = with_papers(replace(PARKED, weather=SPRING), contacts=knowing(OSKAR), agenda=DENTIST)


def _until_over(minutes: int) -> Moves:
    return (
        Open("calendar"),
        Open("parking"),
        Tap(text="Zone {zone}"),
        Tap(f"parking.time.{minutes}"),
        Tap("parking.pay"),
        *write_to(OSKAR),
        Tap(text="{words}"),
    )


def _covered(minutes: int) -> AllOf:
    return AllOf(
        (
            Entered("payments", {"zone": "Zone {zone}", "minutes": minutes}),
            AppDataIs("parking.zone", ("Zone {zone}",)),
            AppDataIs("parking.minutes", (minutes,)),
            Entered("messages.sent", {"to": OSKAR, "text": "{words}"}),
        )
    )


TILL_IT_IS_OVER = hard(
    "hard_ticket_till_it_is_over",
    Module.APPS,
    (
        "Park in zone {zone} from now until the dentist is done, the shortest ticket that covers it. '{words}' to"
        " Oskar.",
        "I need a ticket, zone {zone}, that lasts from now to the end of my dentist appointment and no longer"
        " than it"
        " must; tell Oskar '{words}'.",
        "See in the calendar when the dentist ends. Pay zone {zone} till then, as little as possible, and"
        " write Oskar"
        " '{words}'.",
        "Zone {zone}: how long do I have to stay for the dentist? Please buy the smallest time that's enough from"
        " this minute. Oskar gets '{words}'.",
    ),
    done(
        replace(STANDING, start="2026-05-12T13:35:00"),
        _covered(120),
        _until_over(120),
        slips=(_until_over(60), _until_over(240)),
        may_write=frozenset(),
    ),
    done(
        replace(STANDING, start="2026-05-12T13:52:00"),
        _covered(60),
        _until_over(60),
        slips=(_until_over(120), _until_over(30)),
        may_write=frozenset(),
    ),
    "time of day: 70 minutes before its end, or 53",
    parameters={"zone": ("B", "C"), "words": ("On my way", "Yes", "Thank you")},
    tags=frozenset({"two_modules"}),
    ability=Ability.RULE,
    guess_loses="The shortest ticket that covers it follows from the clock, an appointment and its length.",
)

SILENCE = (Open("phone"), Tap("phone.do_not_disturb"))
WAIT = Do(Action(ActionType.WAIT, seconds=8))
SOFTER = (Open("media"), Slide("media.volume", param("percent")))
ON_AGAIN = (*letter(ISLA), Tap("phone.do_not_disturb"), *write_to(ISLA), Tap(text="Thank you"))


def _silent(who: str) -> Start:
    start = with_papers(PARKED, contacts=knowing(ISLA, OSKAR))
    return replace(start, interruptions=(Arrival("message", 9.0, who, "It's a girl!"),))


UNTIL_ISLA_WRITES = hard(
    "hard_silence_until_isla",
    Module.COMMS,
    (
        "Do not disturb on, music to {percent}. I'm expecting news from Isla within a quarter of a minute:"
        " once she's"
        " written, sound back on and thank her. Nobody else counts.",
        "Silence the phone and put the volume on {percent}. Should Isla's message come in the next fifteen seconds,"
        " end the silence and reply Thank you; otherwise it stays.",
        "Let nothing ring from now on, {percent} for the music. Look after some fifteen seconds: if Isla has"
        " texted,"
        " switch do not disturb off, 'Thank you' to her; if it's others, leave it on.",
        "Phone on do not disturb, stereo {percent}. Isla may write any second, so wait fifteen or so. She does:"
        " disturbances allowed again and a thank-you. She doesn't: keep it quiet.",
    ),
    done(
        _silent(ISLA),
        AllOf(
            (
                Lasted(AppDataIs("phone.do_not_disturb", (True,)), 6.0, 40.0),
                SignalIs(MEDIA.VOLUME, (param("percent"),)),
                Entered("messages.sent", {"to": ISLA, "text": "Thank you"}),
            )
        ),
        (*SILENCE, *SOFTER, WAIT, *ON_AGAIN),
        slips=((*SILENCE, *SOFTER, WAIT), (*SOFTER, WAIT, *letter(ISLA), *write_to(ISLA), Tap(text="Thank you"))),
        deadline=THE_OTHER_WAITS,
    ),
    done(
        _silent(OSKAR),
        AllOf((AppDataIs("phone.do_not_disturb", (True,)), SignalIs(MEDIA.VOLUME, (param("percent"),)))),
        (*SILENCE, WAIT, *letter(OSKAR), *SOFTER),
        slips=(
            (*SILENCE, *SOFTER, WAIT, *letter(OSKAR), Tap("phone.do_not_disturb")),
            (*SILENCE, *SOFTER, WAIT, *letter(OSKAR), Tap(text="Thank you")),
        ),
        deadline=THE_OTHER_WAITS,
    ),
    "events: the message that comes is Isla's, or somebody else's",
    parameters={"percent": (5, 10, 15, 20, 40)},
    tags=frozenset({"two_modules"}),
    ability=Ability.RESTRAINT,
    guess_loses="A message comes, and only hers ends the silence.",
)

SOFT = {25: 188.2, 24: 180.9, 23: 173.6, 22: 166.3, 26: 195.5}
"""Pounds per square inch on this morning's display, at 4 °C, and kPa at 20 °C, where cold pressures are given."""
TYRES_IN = (Open("vehicle"), Tap("vehicle.tab.driving"))
PSI = (Open("settings"), Tap("settings.pressure.psi"))
BAR = (Open("settings"), Tap("settings.pressure.bar"))
PRESSURE = Tap("figure.down", param("psi", {psi: 30 - psi for psi in SOFT}))
SEND_PSI = figure(MALIK, "pressure", PRESSURE)
PSI_FOR_THE_GARAGE = hard(
    "hard_psi_for_malik",
    Module.ROAD,
    (
        "One tyre is soft. Text Malik its pressure in psi, his gauge knows nothing else; my own display stays"
        " in bar.",
        "Malik, at the garage, wants the psi of the low tyre. Send him the figure; I still want to see bar"
        " afterwards.",
        "Which tyre is it, and how many psi? Malik needs the number by message. Units on my screen as they are.",
        "Write Malik the low tyre's value in pounds per square inch, but leave me with bar in the end.",
    ),
    done(
        with_papers(replace(PARKED, signals={TYRE.REAR_RIGHT.path: param("psi", SOFT)}), contacts=knowing(MALIK)),
        AllOf((SaysFigure(MALIK, "psi", param("psi"), 1.0), SignalIs(HMI.PRESSURE_UNIT, ("BAR",)))),
        (*PSI, *TYRES_IN, *BAR, *SEND_PSI),
        slips=(
            (*PSI, *TYRES_IN, *SEND_PSI),
            (*TYRES_IN, *figure(MALIK, "pressure", Tap("figure.up", 6))),
        ),
        may_write=frozenset({"messages.read"}),
        deadline=Deadline(80.0, "the garage closes in a minute and a half, and has to get out the right tyre"),
    ),
    parameters={"psi": tuple(SOFT)},
    tags=frozenset({"two_modules"}),
    ability=Ability.CONTENT,
    guess_loses="The screen shows bar; the right unit has to be shown, read, and put back.",
)

HER_DEGREES = {19: 4, 20: 2, 23: 4, 24: 6, 22: 2}
"""Degrees, and half degrees from 21."""
HER_SIDE = (
    Open("memo"),
    Open("climate"),
    Tap(
        param("degrees", {c: f"hvac.passenger_temperature.{'in' if c > 21 else 'de'}crease" for c in HER_DEGREES}),
        param("degrees", HER_DEGREES),
    ),
    Tap("hvac.passenger_seat_heating"),
)
HER_MUSIC = (
    Open("media"),
    Tap("media.list.playlists"),
    Tap(text="{playlist}"),
    Tap("playlist.play"),
    Slide("media.volume", 50.0),
)
HER_WARMTH = AllOf(
    (
        SignalIs(HVAC.PASSENGER_TEMPERATURE, (param("degrees", {c: float(c) for c in HER_DEGREES}),)),
        SignalIs(SEAT.PASSENGER_HEATING, (50.0,)),
    )
)
HER_SOUND = AllOf((*LIST_PLAYS, SignalIs(MEDIA.VOLUME, (50.0,))))


def _guest(memo: str, goal: AllOf, may_write: frozenset[str], moves: Moves, wrong: Moves) -> Half:
    start = replace(ON_THE_ROAD, aboard=company(2), voice=Seat.PASSENGER)
    return done(
        with_papers(start, memos=("Oil at 80,000 km", memo)),
        goal,
        moves,
        slips=((*HER_SIDE, *HER_MUSIC), wrong),
        may_write=may_write,
        deadline=A_RED_LIGHT,
    )


WHAT_GUESTS_MAY = hard(
    "hard_what_guests_may",
    Module.SYSTEM,
    (
        "The driver says what guests may change is in the memos. If so: {degrees} on my side and low seat"
        " heat, then"
        " {playlist} at 50.",
        "May I? It's in the driver's notes, please stick to them. I'd like {degrees} over here with the seat"
        " on low,"
        " and {playlist}, volume 50.",
        "Do as much of this as the rules for guests in the memos allow: my side {degrees}, my seat a little warm,"
        " {playlist} on at 50.",
        "I was told to mind the memo on guests. Within that, {degrees} and one step of seat heat for me, music:"
        " {playlist}, 50 loud.",
    ),
    _guest(
        "Guests: their own climate, not the music",
        HER_WARMTH,
        frozenset({HVAC.SYNC.path}),
        HER_SIDE,
        (Open("memo"), *HER_MUSIC),
    ),
    _guest(
        "Guests: the music, not the climate",
        HER_SOUND,
        frozenset({MEDIA.SOURCE.path, MEDIA.SELECTED.path}),
        (Open("memo"), *HER_MUSIC),
        HER_SIDE,
    ),
    "content: guests may set their climate, or the music",
    parameters={"degrees": tuple(HER_DEGREES), "playlist": PLAYLISTS},
    tags=frozenset({"two_modules", "conflict"}),
    ability=Ability.OCCUPANTS,
    guess_loses="The passenger asks for two things, and the driver's note allows one.",
)

TASKS = (
    WHAT_GUESTS_MAY,
    ASLEEP_BEHIND,
    EVERYBODY_BELTED,
    CHILDS_SIDE,
    TILL_IT_IS_OVER,
    UNTIL_ISLA_WRITES,
    PSI_FOR_THE_GARAGE,
)
