"""To watch, and to leave things alone: for a while something tempts, and only one event asks for an act."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat, company
from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.signals import CABIN, ENERGY, HMI, HVAC, LIGHTS, LINK, MEDIA, SEAT, TYRE
from automotive_cosim.contracts import AlertKind
from automotive_cosim.tasking.checks import AlertGiven, AllOf, Check, Entered, SignalIs, SignalWithin
from automotive_cosim.tasking.dialogue import Says
from automotive_cosim.tasking.history import After, Lasted, Watched
from automotive_cosim.tasking.moves import Hear, Open, Slide, Tap, Warn
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Ability, Deadline, Half, Module, Start
from automotive_cosim.tasks.hard.forms import (
    BEA,
    ON_THE_ROAD,
    OSKAR,
    PARKED,
    PRIYA,
    READ,
    SCHOOL,
    Moves,
    answer,
    done,
    hard,
    knowing,
    letter,
    told,
    wait,
    with_papers,
)

WATCH_S = 45.0
THEN_ENOUGH = Deadline(85.0, "three quarters of a minute to watch, as he asked, and as long again to look about")
DOORS = (Open("vehicle"), Tap("vehicle.tab.doors"))
NINE_S = wait(9)
WATCHING = NINE_S * 5
"""Enough of it, and not enough without the last."""


def _watched(
    start: Start,
    event: Arrival | CarChange | None,
    goal: tuple[Check, ...],
    moves: Moves,
    *slips: Moves,
    may_write: frozenset[str] = READ,
    deadline: Deadline = THEN_ENOUGH,
) -> Half:
    return done(
        start if event is None else replace(start, interruptions=(event,)),
        AllOf(goal),
        moves,
        slips=slips,
        may_write=may_write,
        deadline=deadline,
    )


WHEELS = {
    "front left": TYRE.FRONT_LEFT,
    "front right": TYRE.FRONT_RIGHT,
    "rear left": TYRE.REAR_LEFT,
    "rear right": TYRE.REAR_RIGHT,
}
ITS_PATH = param("wheel", {wheel: tyre.path for wheel, tyre in WHEELS.items()})
LOOK = (Open("vehicle"), Tap("vehicle.tab.driving"))
AFTER_THE_KERB = hard(
    "hard_under_two_bar",
    Module.ROAD,
    (
        "I've clipped a kerb. Watch the tyres for three quarters of a minute: a vehicle alert if one goes under 2"
        " bar,"
        " not a word above that.",
        "Keep the pressures in view, forty-five seconds. Below 2 bar, whichever wheel, alert me to the car;"
        " anything"
        " else can wait for the garage.",
        "For the next three quarters of a minute tell me of a tyre with less than 2 bar by the vehicle alert. If"
        " they"
        " all stay over it, leave me in peace.",
        "That was a hard kerb. Look at the tyres for forty-five seconds and give me the vehicle alert"
        " only if one drops below 2 bar.",
    ),
    _watched(
        ON_THE_ROAD,
        CarChange(8.0, ITS_PATH, 226.0, over_s=20.0),
        (Watched(WATCH_S),),
        (*LOOK, *WATCHING),
        (*LOOK, *wait(40), Warn(AlertKind.VEHICLE)),
        LOOK,
    ),
    _watched(
        ON_THE_ROAD,
        CarChange(8.0, ITS_PATH, 150.0, over_s=20.0),
        (After(SignalWithin(param("wheel", WHEELS), 0.0, 200.0), AlertGiven(AlertKind.VEHICLE)),),
        (*LOOK, *wait(30), Warn(AlertKind.VEHICLE)),
        (*LOOK, Warn(AlertKind.VEHICLE)),
        (*LOOK, *WATCHING),
        deadline=Deadline(70.0, "it is that soft after half a minute, and goes on rolling on its rim"),
    ),
    "events: a tyre falls to a little over 2 bar, or to far less",
    parameters={"wheel": tuple(WHEELS)},
    ability=Ability.RESTRAINT,
    guess_loses="A pressure falls in both halves; where it stops decides, and that shows only after half a minute.",
)

BABY = (Occupant(Seat.REAR_LEFT, Kind.BABY, asleep=True),)
SOFTLY = (Open("media"), Slide("media.volume", param("percent")))
SOFT = SignalIs(MEDIA.VOLUME, (param("percent"),))
NURSERY = with_papers(replace(ON_THE_ROAD, aboard=BABY), contacts=knowing(OSKAR))
LET_IT_RING = hard(
    "hard_let_it_ring",
    Module.COMMS,
    (
        "Music to {percent}. For the next three quarters of a minute let every call ring, neither take it nor turn"
        " it"
        " down; only the school is put through.",
        "Volume {percent}, and hands off the phone for forty-five seconds, whoever rings. The one exception is the"
        " school: answer that.",
        "Turn it to {percent}. Calls may ring themselves out for three quarters of a minute, don't pick up, don't"
        " reject; if it's the school, connect me.",
        "Sound down to {percent}. Then just keep an ear on the phone for some forty-five seconds: pick up if it's"
        " the school; anyone else rings on, don't decline.",
    ),
    _watched(
        NURSERY,
        Arrival("call", 9.0, OSKAR),
        (SOFT, Watched(WATCH_S)),
        (*SOFTLY, *WATCHING),
        (*SOFTLY, *wait(10), Tap("call.answer"), *wait(36)),
        (*SOFTLY, *wait(10), Tap("call.decline"), *wait(36)),
    ),
    _watched(
        NURSERY,
        Arrival("call", 9.0, SCHOOL),
        (SOFT, Entered("calls.answered", SCHOOL)),
        (*SOFTLY, *wait(9), Tap("call.answer")),
        (*SOFTLY, *WATCHING),
        deadline=Deadline(38.0, "a call rings for 30 s (ETSI TS 122 082), and it comes after 9 s"),
    ),
    "events: a friend rings, or the school",
    parameters={"percent": (5, 10, 15, 20, 25)},
    ability=Ability.RESTRAINT,
    guess_loses="A ringing phone asks to be taken or turned down; one caller only may be taken, and none declined.",
)

CHILDREN = (Occupant(Seat.REAR_LEFT, Kind.CHILD), Occupant(Seat.REAR_RIGHT, Kind.CHILD))
BLOWING = (Open("climate"), Slide("hvac.fan", param("fan")))
BLOWS = SignalIs(HVAC.FAN_SPEED, (param("fan"),))
SHUT_ROOF = (*DOORS, Slide("window.sunroof", 0.0))
UP_TO_THIRTY = hard(
    "hard_children_and_roof",
    Module.SYSTEM,
    (
        "Fan to {fan}. The children may have the roof open up to 30; keep watch for three quarters of a minute,"
        " and if they open it wider than that, shut it.",
        "Blower {fan}, then mind the sunroof for forty-five seconds: up to 30 it's theirs, wider and you close it"
        " altogether.",
        "Set {fan} on the fan. Let the kids have some sky, 30 percent of roof at the most; beyond that it's to be"
        " shut, for the next three quarters of a minute.",
        "{fan} for the fan, please. Watch the roof for some forty-five seconds: open by 30 or less it stays as"
        " they like it, by more than that it gets closed.",
    ),
    _watched(
        replace(ON_THE_ROAD, aboard=CHILDREN),
        CarChange(12.0, CABIN.SUNROOF.path, 30.0),
        (BLOWS, Watched(WATCH_S)),
        (*BLOWING, *DOORS, *WATCHING),
        (*BLOWING, *wait(20), *SHUT_ROOF, *wait(26)),
        (*BLOWING, *DOORS),
    ),
    _watched(
        replace(ON_THE_ROAD, aboard=CHILDREN),
        CarChange(12.0, CABIN.SUNROOF.path, 80.0),
        (BLOWS, SignalIs(CABIN.SUNROOF, (0.0,)), Watched(WATCH_S)),
        (*BLOWING, *wait(15), *SHUT_ROOF, *NINE_S, *NINE_S, *NINE_S),
        (*BLOWING, *WATCHING),
        (*BLOWING, *DOORS),
        may_write=frozenset({CABIN.SUNROOF_SHADE.path}),
    ),
    "events: the roof slides open by 30, or by 80",
    parameters={"fan": (20, 40, 50, 60, 70)},
    ability=Ability.RESTRAINT,
    guess_loses="The roof opens in both halves, and only beyond a figure is it to be shut.",
)

PLAYLISTS = ("Road trip", "Sunday", "Dance", "Calm", "Classics")
PLAYS = (
    Open("media"),
    Tap("media.list.playlists"),
    Tap(text="{playlist}"),
    Tap("playlist.play"),
)
ON = SignalIs(MEDIA.ACTION, ("PLAY",))
HERS = replace(ON_THE_ROAD, aboard=company(2))
UP_TO_SIXTY = hard(
    "hard_up_to_sixty",
    Module.MEDIA,
    (
        "Play {playlist}. My wife may turn it up to 60; if it gets louder than that within three quarters of a"
        " minute,"
        " back to 60.",
        "{playlist}, please, and guard the volume for forty-five seconds: up to 60 she can do as she likes, above"
        " it"
        " goes down to 60 again.",
        "Start {playlist}. She loves it loud. Leave the knob to her, except beyond 60, then set 60; mind it for"
        " three"
        " quarters of a minute.",
        "Put {playlist} on and keep an eye on the loudness for about forty-five seconds. It's hers to choose up to"
        " 60;"
        " past that, bring it to 60.",
    ),
    _watched(
        HERS,
        CarChange(18.0, MEDIA.VOLUME.path, 55.0, over_s=8.0),
        (ON, Watched(WATCH_S)),
        (*PLAYS, *WATCHING),
        (*PLAYS, *wait(26), Slide("media.volume", 30.0), *wait(20)),
        PLAYS,
        may_write=frozenset({MEDIA.SELECTED.path, MEDIA.SOURCE.path, "media.playlist"}),
    ),
    _watched(
        HERS,
        CarChange(18.0, MEDIA.VOLUME.path, 80.0, over_s=8.0),
        (ON, SignalIs(MEDIA.VOLUME, (60.0,)), Watched(WATCH_S)),
        (*PLAYS, *wait(28), Slide("media.volume", 60.0), *NINE_S, *NINE_S),
        (*PLAYS, *WATCHING),
        (*PLAYS, *wait(28), Slide("media.volume", 30.0), *wait(15)),
        may_write=frozenset({MEDIA.SELECTED.path, MEDIA.SOURCE.path, "media.playlist"}),
    ),
    "events: the passenger turns it up to 55, or to 80",
    parameters={"playlist": PLAYLISTS},
    tags=frozenset({"preference"}),
    ability=Ability.RESTRAINT,
    guess_loses="It gets louder in both halves, and the passenger may have it so up to a figure.",
)

HERE = ("I'm at the car", "It's me at the door", "Here I am, right behind you", "I'm next to you, it's cold!")
PLATFORM = with_papers(replace(PARKED, start="2026-11-17T18:20:00"), contacts=knowing(BEA, OSKAR))
OPENS = (*DOORS, Tap("door.all"))
LOCKS = (CABIN.DRIVER_LOCK, CABIN.PASSENGER_LOCK, CABIN.REAR_LEFT_LOCK, CABIN.REAR_RIGHT_LOCK)
SHE_COMES = (Open("phone"), Tap("phone.tab.messages"), *wait(12))
WAIT_FOR_BEA = hard(
    "hard_doors_for_bea",
    Module.SYSTEM,
    (
        "I'm shutting my eyes. Doors stay locked until Bea writes that she's at the car, then unlock all; watch for"
        " three quarters of a minute.",
        "For forty-five seconds look out for Bea's message: when she's here, all doors open for her. For nobody"
        " else,"
        " and no answers to anybody.",
        "Keep us locked. Only if Bea texts within three quarters of a minute that she has arrived, release every"
        " door;"
        " what others want can wait.",
        "Bea will write when she's at the car. Then unlock the lot, not before, and not for others. Stay with it"
        " for"
        " about forty-five seconds and answer no one.",
    ),
    _watched(
        PLATFORM,
        Arrival("message", 10.0, OSKAR, "{here}. Let me in, please"),
        (Watched(WATCH_S),),
        (*SHE_COMES, Tap(text=OSKAR), *NINE_S, *NINE_S, *NINE_S, *NINE_S),
        (*SHE_COMES, *letter(OSKAR), *OPENS, *wait(30)),
        (*SHE_COMES, *answer(OSKAR, "No"), *wait(30)),
    ),
    _watched(
        PLATFORM,
        Arrival("message", 10.0, BEA, "{here}"),
        (After(Watched(10.0), AllOf(tuple(SignalIs(lock, (False,)) for lock in LOCKS))),),
        (*SHE_COMES, *letter(BEA), *OPENS),
        (*SHE_COMES, *letter(BEA), *wait(40)),
        OPENS,
    ),
    "events: somebody else wants to be let in, or she does",
    parameters={"here": HERE},
    ability=Ability.RESTRAINT,
    guess_loses="Somebody writes to be let in in both halves; the doors are to open for one of them.",
)

A_MINUTE = Deadline(90.0, "a minute to watch, as he asked, and half a minute to look about")
LIMITS = (60.0, 70.0, 90.0, 100.0)
AT_THE_POST = replace(PARKED, signals={ENERGY.LEVEL.path: 12.0, ENERGY.CHARGE_FLAP.path: True})
PLUGGED_IN = SignalIs(ENERGY.CABLE, (True,))
CHARGES = Slide("charging.limit", param("limit"), 50.0, 100.0)
ONCE_PLUGGED_IN = hard(
    "hard_once_plugged_in",
    Module.APPS,
    (
        "I'm off for the cable. Once it's plugged in, set the charge limit to {limit:g}; before that don't touch"
        " it."
        " Give me a minute.",
        "As soon as the cable is in, charge to {limit:g}. If it isn't within a minute, everything stays"
        " as it"
        " is: then the post is dead and I park elsewhere.",
        "Wait for the plug, up to a minute. In: limit {limit:g}. Not in: leave the limit alone,"
        " I'm at"
        " another post then.",
        "For a minute, keep checking whether I've plugged us in, and only then set the charge limit to {limit:g}.",
    ),
    _watched(
        AT_THE_POST,
        None,
        (Watched(60.0),),
        (Open("charging"), *(NINE_S * 7)),
        (Open("charging"), CHARGES, *wait(61)),
        (Open("charging"), *wait(61), CHARGES),
        deadline=A_MINUTE,
    ),
    _watched(
        AT_THE_POST,
        CarChange(20.0, ENERGY.CABLE.path, True),
        (After(PLUGGED_IN, SignalIs(ENERGY.CHARGE_LIMIT, (param("limit"),))),),
        (Open("charging"), *wait(24), CHARGES),
        (Open("charging"), CHARGES, *wait(61)),
        (Open("charging"), *(NINE_S * 7)),
    ),
    "events: no cable comes, or one is plugged in after a while",
    parameters={"limit": LIMITS},
    ability=Ability.RESTRAINT,
    guess_loses="The limit may be set only after the plug is in, and it may never be.",
)

BELTS = {"left": SEAT.REAR_LEFT_BELT, "right": SEAT.REAR_RIGHT_BELT}
OPENED = CarChange(10.0, param("side", {side: belt.path for side, belt in BELTS.items()}), False)
WHILE_PARKED = hard(
    "hard_belts_while_parked",
    Module.SYSTEM,
    (
        "Watch the children for three quarters of a minute. Parked, they may undo their belts; on the road I want"
        " the"
        " belt alert if one does. Window lock on, too.",
        "Lock the rear windows, then mind the belts behind for forty-five seconds: an open one is only worth a"
        " seat-belt warning if the car isn't parked.",
        "Rear window switches blocked, please. And for the next three quarters of a minute a belt alert as soon as"
        " a"
        " child unbuckles, unless we're parked.",
        "Lock the windows in the back. The kids' belts: keep watch for about forty-five seconds and alert me when "
        "one is undone on a drive, but not while we're parked.",
    ),
    _watched(
        replace(PARKED, aboard=CHILDREN),
        OPENED,
        (SignalIs(CABIN.WINDOW_LOCK, (True,)), Watched(WATCH_S)),
        (*DOORS, Tap("window.lock"), Open("cabin"), *WATCHING),
        (*DOORS, Tap("window.lock"), Open("cabin"), *wait(20), Warn(AlertKind.SEAT_BELT), *wait(20)),
        may_write=frozenset(),
    ),
    _watched(
        replace(ON_THE_ROAD, aboard=CHILDREN),
        OPENED,
        (
            SignalIs(CABIN.WINDOW_LOCK, (True,)),
            After(SignalIs(param("side", BELTS), (False,)), AlertGiven(AlertKind.SEAT_BELT)),
        ),
        (*DOORS, Tap("window.lock"), Open("cabin"), *wait(12), Warn(AlertKind.SEAT_BELT)),
        (*DOORS, Tap("window.lock"), Open("cabin"), *WATCHING),
        (*DOORS, Tap("window.lock"), Open("cabin"), Warn(AlertKind.SEAT_BELT)),
        may_write=frozenset(),
        deadline=Deadline(40.0, "it is undone after 10 s, and half a minute without a belt is too long"),
    ),
    "motion: parked, or on the road",
    parameters={"side": tuple(BELTS)},
    ability=Ability.RESTRAINT,
    guess_loses="A belt is undone in both halves, and matters only in the car that is not parked.",
)

SHARE = (Open("settings"), Tap("settings.page.privacy"), Tap("privacy.position"))
FOLLOWED = with_papers(ON_THE_ROAD, contacts=knowing(PRIYA, OSKAR))
SHARED = SignalIs(LINK.SHARE_POSITION, (True,))
STOP = "Stop sharing your position now"
PRIYA_MAY_END_IT = hard(
    "hard_priya_may_end_it",
    Module.SYSTEM,
    (
        "'{words}' to Priya, then share our position for three quarters of a minute and stop. She alone may end it"
        " sooner.",
        "Text Priya '{words}' and let the car be seen for forty-five seconds, then no more; earlier only if she"
        " asks"
        " for it, not for anybody else.",
        "Position sharing on after a '{words}' to Priya. Off again in three quarters of a minute, or as soon as"
        " Priya"
        " writes that it's enough; others don't count.",
        "Write Priya '{words}' and start sharing where we are. It's to run for about forty-five seconds unless she"
        " herself calls it off; then end it.",
    ),
    _watched(
        FOLLOWED,
        Arrival("message", 18.0, OSKAR, STOP),
        (told(PRIYA, "{words}"), Lasted(SHARED, 38.0, 62.0), SignalIs(LINK.SHARE_POSITION, (False,))),
        (*answer(PRIYA, "{words}"), *SHARE, *wait(45), Tap("privacy.position")),
        (*answer(PRIYA, "{words}"), *SHARE, *wait(16), Tap("privacy.position")),
        (*answer(PRIYA, "{words}"), *SHARE, *wait(45)),
    ),
    _watched(
        FOLLOWED,
        Arrival("message", 18.0, PRIYA, STOP),
        (told(PRIYA, "{words}"), Lasted(SHARED, 5.0, 32.0), SignalIs(LINK.SHARE_POSITION, (False,))),
        (*answer(PRIYA, "{words}"), *SHARE, *wait(14), *letter(PRIYA), *SHARE),
        (*answer(PRIYA, "{words}"), *SHARE, *wait(45), Tap("privacy.position")),
    ),
    "events: somebody else wants it ended, or she does",
    parameters={"words": ("On my way", "Where are you?", "Yes")},
    tags=frozenset({"two_modules"}),
    ability=Ability.RESTRAINT,
    guess_loses="The same words come in both halves, from her and from somebody who has no say in it.",
)

STRANDED = replace(PARKED, start="2026-11-17T17:40:00", signals={LIGHTS.HAZARD.path: True})
LAMPS = (Open("vehicle"), Tap("vehicle.tab.lights"))
TOW_TRUCK = hard(
    "hard_till_the_tow_truck",
    Module.ROAD,
    (
        "The hazards stay on till the tow truck stands before us, then off, and the ambient light to {percent}."
        " Watch three quarters of a minute with me.",
        "We're waiting for the tow truck. Once it's here: hazard lights off, ambient light {percent}. Until then"
        " nothing, for the next forty-five seconds.",
        "Don't touch the hazards before the tow truck has come; when it has, off with them and put the ambient"
        " light at {percent}. Give it three quarters of a minute.",
        "I'll say when I see our tow truck: then hazards off and the ambient light to {percent}. If it isn't here"
        " in some forty-five seconds, leave everything as it is.",
    ),
    replace(
        _watched(
            STRANDED,
            None,
            (Watched(WATCH_S),),
            (*LAMPS, *NINE_S, *NINE_S, Hear("only a delivery"), *NINE_S, *NINE_S, *NINE_S),
            (*LAMPS, Hear("only a delivery"), Tap("lights.hazard"), Open("vehicle"), *wait(30)),
            (*LAMPS, Hear("only a delivery")),
        ),
        says=(Says("There's a lorry. No, it's only a delivery for next door.", time_s=16.0),),
    ),
    replace(
        _watched(
            STRANDED,
            None,
            (SignalIs(LIGHTS.HAZARD, (False,)), SignalIs(CABIN.AMBIENT_LIGHT, (param("percent"),))),
            (
                *LAMPS,
                Hear("with a crane"),
                Tap("lights.hazard"),
                Tap("vehicle.tab.interior"),
                Slide("light.ambient", param("percent")),
            ),
            (*LAMPS, Hear("with a crane"), *wait(30)),
            (*LAMPS, Hear("with a crane"), Tap("lights.hazard")),
        ),
        says=(Says("There's a lorry. Yes, with a crane, he's waving to us.", time_s=16.0),),
    ),
    "events: the lorry that comes is not theirs, or it is",
    parameters={"percent": (60, 70, 80, 90)},
    ability=Ability.RESTRAINT,
    guess_loses="A lorry comes in both halves; what the driver says of it tells whether it is the one.",
)

DIMMED = (Open("settings"), Slide("settings.brightness", param("percent")), Tap("settings.page.connections"))
DIM = SignalIs(HMI.BRIGHTNESS, (param("percent"),))
LINKS = hard(
    "hard_one_link_may_drop",
    Module.COMMS,
    (
        "Screen to {percent}. Isla walks off with my phone, so Bluetooth will drop: leave it. Mobile data must"
        " stay on"
        " for the next three quarters of a minute; if it goes, switch it on again.",
        "Brightness {percent}, then watch the links for forty-five seconds. The phone may go, no reconnecting;"
        " only if"
        " the mobile data drops, put that back.",
        "{percent} for the display. Should Bluetooth break off in the next three quarters of a minute that's Isla"
        " with"
        " the phone, fine. If it's the mobile data, turn it on once more.",
        "Dim the screen to {percent} and mind the connections for about forty-five seconds: losing Bluetooth is"
        " expected, losing mobile data is not, restore that one alone.",
    ),
    _watched(
        PARKED,
        CarChange(14.0, LINK.BLUETOOTH.path, False),
        (DIM, Watched(WATCH_S)),
        (*DIMMED, *WATCHING),
        (*DIMMED, *wait(15), Tap("link.bluetooth"), *wait(30)),
        DIMMED,
        may_write=frozenset(),
    ),
    _watched(
        PARKED,
        CarChange(14.0, LINK.MOBILE_DATA.path, False),
        (DIM, SignalIs(LINK.MOBILE_DATA, (True,)), Watched(WATCH_S)),
        (*DIMMED, *wait(15), Tap("link.mobile"), *wait(30)),
        (*DIMMED, *WATCHING),
        DIMMED,
        may_write=frozenset(),
    ),
    "events: the phone's link drops, or the mobile data",
    parameters={"percent": (20, 30, 40, 50)},
    tags=frozenset({"two_modules"}),
    ability=Ability.RESTRAINT,
    guess_loses="A link drops in both halves, and one of them is meant to.",
)

TASKS = (
    AFTER_THE_KERB,
    LET_IT_RING,
    UP_TO_THIRTY,
    UP_TO_SIXTY,
    WAIT_FOR_BEA,
    ONCE_PLUGGED_IN,
    WHILE_PARKED,
    PRIYA_MAY_END_IT,
    TOW_TRUCK,
    LINKS,
)
