"""Something comes in between: a call, a message that changes the plan, a change of the car that nobody made."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import company
from automotive_cosim.cockpit.apps.calendar import Appointment
from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.places import PlaceKind
from automotive_cosim.cockpit.signals import ADAS, CABIN, HMI, HVAC, TYRE, VOICE
from automotive_cosim.cockpit.vehicle import WINDOWS
from automotive_cosim.contracts import Action, ActionType, AlertKind
from automotive_cosim.tasking.checks import AlertGiven, AllOf, Entered, SignalIs
from automotive_cosim.tasking.moves import Do, Open, Slide, Tap, TypeText, Warn
from automotive_cosim.tasking.parameters import FromCockpit, param
from automotive_cosim.tasking.records import AppDataAt, EnteredAll
from automotive_cosim.tasking.task import Ability, Deadline, Module, Start
from automotive_cosim.tasks.hard.forms import (
    BEFORE_LEAVING,
    ON_THE_ROAD,
    OSKAR,
    PARKED,
    SCHOOL,
    THE_OTHER_WAITS,
    WANDA,
    YUSUF,
    Moves,
    done,
    hard,
    knowing,
    letter,
    with_letter,
    with_papers,
    write_to,
)
from automotive_cosim.tasks.maps import named

LATER = "I'm driving, I'll call later"
FIRST_PROPOSAL = {"16:30": 4, "17:00": 6, "17:15": 7, "16:15": 3, "16:45": 5}
"""Time, and quarters of an hour from 15:30."""
THEN_RATHER = {"16:30": "17:30", "17:00": "18:00", "17:15": "18:15", "16:15": "17:15", "16:45": "17:45"}
"""What she proposes next, an hour later."""
RATHER = {time: f"No wait, {rather} is better" for time, rather in THEN_RATHER.items()}
DAY = (
    Appointment("10:00", "Bank", "Work"),
    Appointment("15:30", "Rehearsal with Wanda", "Work"),
    Appointment("19:30", "Choir with Oskar", "Home"),
)
MOVED = (
    *letter(WANDA),
    Open("calendar"),
    Tap("calendar.1"),
    Tap("appointment.later", param("time", FIRST_PROPOSAL)),
)
AGREED = (*write_to(WANDA), Tap(text="Yes"))


def _rehearsal(interruption: Arrival) -> Start:
    start = with_letter(
        PARKED, WANDA, "Could we start at {time} today?", agenda=DAY, contacts=knowing(WANDA, OSKAR)
    )
    return replace(start, interruptions=(interruption,))


MOVED_TWICE = hard(
    "hard_moved_twice",
    Module.APPS,
    (
        "Wanda wants to rehearse at another time. Move it in my calendar as she says and answer Yes.",
        "Put the rehearsal where Wanda would like it, then confirm to her with a plain yes.",
        "Look what Wanda proposes for our rehearsal; correct the diary, write Yes back.",
        "Move today's appointment with Wanda to whatever she wants in the end, and tell her yes.",
    ),
    done(
        _rehearsal(Arrival("message", 8.0, WANDA, param("time", RATHER))),
        AllOf(
            (
                AppDataAt("calendar.entries", 1, param("time", {k: {"at": v} for k, v in THEN_RATHER.items()})),
                Entered("messages.sent", {"to": WANDA, "text": "Yes"}),
            )
        ),
        (*MOVED, *letter(WANDA), Open("calendar"), Tap("calendar.1"), Tap("appointment.hour_later"), *AGREED),
        slips=((*MOVED, *AGREED),),
        deadline=BEFORE_LEAVING,
    ),
    done(
        _rehearsal(Arrival("message", 8.0, OSKAR, param("time", RATHER))),
        AllOf(
            (
                AppDataAt("calendar.entries", 1, param("time", {k: {"at": k} for k in THEN_RATHER})),
                Entered("messages.sent", {"to": WANDA, "text": "Yes"}),
            )
        ),
        (*MOVED, *letter(OSKAR), *AGREED),
        slips=(
            (*MOVED, *letter(OSKAR), Open("calendar"), Tap("calendar.1"), Tap("appointment.hour_later"), *AGREED),
        ),
        deadline=BEFORE_LEAVING,
    ),
    "events: the later time comes from her, or from somebody else about another matter",
    parameters={"time": tuple(FIRST_PROPOSAL)},
    ability=Ability.CHAIN,
    guess_loses="The time that is right at first is wrong when the second message comes from the same person.",
)

NAMED = (*named(PlaceKind.PHARMACY)[:3], *named(PlaceKind.MUSEUM)[:2])
BLOOMSBURY = Start("london", "bloomsbury", parked=True)


def _save(name: str) -> Moves:
    return (Open("map"), TypeText("map.search", name), Tap("map.place.0"), Tap("place.save"))


def _called_by(who: str) -> Start:
    start = with_papers(BLOOMSBURY, contacts=knowing(SCHOOL, OSKAR))
    return replace(start, interruptions=(Arrival("call", 6.0, who),))


SAVED = EnteredAll("navigation.favourites", ("{street}", "{place}"))
PAUSE = Do(Action(ActionType.WAIT, seconds=2))
REFUSE = (PAUSE, Tap("call.reply"), Tap(text=LATER))
CALL_WHILE_TYPING = hard(
    "hard_call_while_typing",
    Module.MAPS,
    (
        "Save {street} and {place} for the tour. If the school rings, put them through at once; anybody else gets"
        " the 'driving, later' line.",
        "I need {street} and then {place} among my places. Calls meanwhile: the school yes, others by message that"
        " I'm driving.",
        "Type in {street}, keep it, and the same with {place}. Only the school may interrupt us, answer that; turn"
        " the rest away in writing: driving, later.",
        "Two addresses to store, {street} plus {place}. Pick up for the school; whoever else calls is told that I'm"
        " at the wheel.",
    ),
    done(
        _called_by(OSKAR),
        AllOf(
            (
                SAVED,
                Entered("calls.declined", OSKAR),
                Entered("messages.sent", {"to": OSKAR, "text": LATER}),
            )
        ),
        (*_save("{street}"), *REFUSE, *_save("{place}")),
        slips=(
            (*_save("{street}"), *REFUSE),
            (*_save("{street}"), PAUSE, Tap("call.answer"), *_save("{place}")),
        ),
    ),
    done(
        _called_by(SCHOOL),
        AllOf((SAVED, Entered("calls.answered", SCHOOL))),
        (*_save("{street}"), PAUSE, Tap("call.answer"), *_save("{place}")),
        slips=((*_save("{street}"), *REFUSE, *_save("{place}")),),
    ),
    "events: a friend rings, or the school",
    parameters={"street": FromCockpit("streets"), "place": NAMED},
    ability=Ability.CHAIN,
    guess_loses="The caller decides whether the call is taken; and the second address is still to be saved.",
)

AIRED = {window.path: 40.0 for window in WINDOWS} | {CABIN.SUNROOF.path: 20.0, HVAC.RECIRCULATION.path: True}
DOORS = (Open("vehicle"), Tap("vehicle.tab.doors"))
SHUT = (*DOORS, Tap("window.close_all"))
ROOF = Slide("window.sunroof", 0.0)
AIR = (Open("climate"), Tap("hvac.recirculation"), Tap("hvac.purifier"), Slide("hvac.fan", param("fan")))
WINDOW_COMES_DOWN = hard(
    "hard_window_comes_down",
    Module.SYSTEM,
    (
        "Dusty road ahead: every window and the roof shut, fresh air on, purifier on, fan {fan}; lock the rear"
        " switches when all is closed.",
        "Close us up, roof included, recirculation off, cleaner running, blower at {fan}, and in the end the kids'"
        " window buttons blocked with nothing left open.",
        "I want the car tight, all glass up, the purifier going, outside air in, {fan} on the fan; finally the"
        " window"
        " lock, so that it stays so.",
        "Shut everything, take in fresh air through the purifier, and put the fan on {fan}. Last of"
        " all lock the windows in the back.",
    ),
    done(
        replace(
            ON_THE_ROAD,
            signals=AIRED,
            aboard=company(4),
            interruptions=(CarChange(6.0, CABIN.REAR_LEFT_WINDOW.path, 60.0),),
        ),
        AllOf(
            (
                *(SignalIs(window, (0.0,)) for window in (*WINDOWS, CABIN.SUNROOF)),
                SignalIs(HVAC.RECIRCULATION, (False,)),
                SignalIs(HVAC.PURIFIER, (True,)),
                SignalIs(HVAC.FAN_SPEED, (param("fan"),)),
                SignalIs(CABIN.WINDOW_LOCK, (True,)),
            )
        ),
        (*SHUT, ROOF, *AIR, *SHUT, Tap("window.lock")),
        slips=((*SHUT, ROOF, *AIR, *DOORS, Tap("window.lock")), (*SHUT, *AIR, *SHUT, Tap("window.lock"))),
        may_write=frozenset({CABIN.SUNROOF_SHADE.path}),
        deadline=Deadline(45.0, "500 m of good road are left, some 45 s at 40 km/h; then the dust comes in"),
    ),
    parameters={"fan": (50, 60, 70, 80, 90)},
    ability=Ability.CHAIN,
    guess_loses=(
        "A window opens again after all have been closed; only a second look finds it before they are locked."
    ),
)

BARE = {
    ADAS.LANE_KEEPING.path: False,
    ADAS.LANE_DEPARTURE.path: False,
    ADAS.BLIND_SPOT.path: False,
    ADAS.SPEED_WARNING.path: False,
    ADAS.CRUISE_SPEED.path: 80.0,
}
HELPS = (ADAS.LANE_KEEPING, ADAS.LANE_DEPARTURE, ADAS.BLIND_SPOT, ADAS.SPEED_WARNING)
ALL_HELP = (
    Open("vehicle"),
    Tap("vehicle.tab.assistance"),
    Tap("adas.lane_keeping"),
    Tap("adas.lane_departure"),
    Tap("adas.blind_spot"),
    Tap("adas.speed_warning"),
    Tap("adas.cruise_speed.increase", param("cruise", {kmh: (kmh - 80) // 5 for kmh in (90, 95, 100, 105, 110)})),
)
READY = AllOf((*(SignalIs(one, (True,)) for one in HELPS), SignalIs(ADAS.CRUISE_SPEED, (param("cruise"),))))
LEAK = CarChange(6.0, TYRE.REAR_LEFT.path, 150.0, over_s=4.0)
SOFT_TYRE_MEANWHILE = hard(
    "hard_soft_tyre_meanwhile",
    Module.ROAD,
    (
        "Get us ready for the motorway: lane keeping, lane departure, blind spot and the speed warning on,"
        " cruise set"
        " to {cruise}. And alert me if a tyre gets low, I hit that kerb.",
        "All four back on, both lane helpers, blind spot, speeding reminder; {cruise} in the cruise control but not"
        " active. Should a tyre lose air meanwhile, warn me.",
        "I want lane keeping, lane departure, blind spot and speed warning running, and {cruise} as the speed to"
        " cruise at. I don't trust the tyres after that bump: sound a vehicle alert if one drops.",
        "Turn on all the assistance that's off, but neither limiter nor cruise; cruise is only to be set to"
        " {cruise}. Keep an eye on the tyre pressures meanwhile and warn me about the car if they aren't right.",
    ),
    done(
        replace(ON_THE_ROAD, signals=BARE, interruptions=(LEAK,)),
        AllOf((READY, AlertGiven(AlertKind.VEHICLE))),
        (*ALL_HELP, Tap("vehicle.tab.driving"), Warn(AlertKind.VEHICLE)),
        slips=(ALL_HELP,),
        may_write=frozenset(),
    ),
    done(
        replace(ON_THE_ROAD, signals=BARE),
        READY,
        (Open("notifications"), *ALL_HELP),
        slips=((*ALL_HELP, Warn(AlertKind.VEHICLE)),),
        may_write=frozenset(),
    ),
    "events: a tyre loses its air while that is done, or none does",
    parameters={"cruise": (90, 95, 100, 105, 110)},
    tags=frozenset({"two_modules"}),
    ability=Ability.CHAIN,
    guess_loses=(
        "Whether a tyre loses air shows only while, or after, the rest is done; a warning in advance is false half"
        " of the time."
    ),
)

VISITORS = (
    Open("settings"),
    Tap("settings.distance.miles"),
    Tap("settings.temperature.fahrenheit"),
    Tap("settings.pressure.psi"),
    Slide("settings.brightness", param("percent")),
    Tap("settings.page.language"),
    Tap("language.time.12"),
    Tap("settings.page.sound"),
    Slide("sound.guidance", param("percent")),
)
LANGUAGE_MIDWAY = hard(
    "hard_language_midway",
    Module.SYSTEM,
    (
        "For our visitors: miles, Fahrenheit, psi, twelve-hour clock, brightness and guidance volume both at"
        " {percent}. They may play with the rest themselves.",
        "Make the units American, all of them, with am and pm; display and directions on {percent}. Whatever my"
        " guests change meanwhile is theirs.",
        "Mrs Mori takes over in a minute: distances in miles, degrees in F, tyres in psi, 12 h, then {percent} for"
        " screen and spoken turns. Leave what she sets alone.",
        "Our guests read miles, Fahrenheit, psi and a clock of twelve hours; guidance volume and "
        "brightness go to {percent}. What they tap themselves stays.",
    ),
    done(
        replace(PARKED, interruptions=(CarChange(5.0, HMI.LANGUAGE.path, "ja"),)),
        AllOf(
            (
                SignalIs(HMI.DISTANCE_UNIT, ("MILES",)),
                SignalIs(HMI.TEMPERATURE_UNIT, ("F",)),
                SignalIs(HMI.PRESSURE_UNIT, ("PSI",)),
                SignalIs(HMI.TIME_FORMAT, ("HR_12",)),
                SignalIs(HMI.BRIGHTNESS, (param("percent"),)),
                SignalIs(VOICE.GUIDANCE_VOLUME, (param("percent"),)),
            )
        ),
        VISITORS,
        slips=((*VISITORS, Tap("settings.page.language"), Tap("language.en")), VISITORS[:-2]),
        may_write=frozenset(),
        deadline=THE_OTHER_WAITS,
    ),
    parameters={"percent": (20, 30, 40, 80, 90)},
    only_english="a guest turns the car from English to Japanese",
    ability=Ability.CHAIN,
    guess_loses="The screen changes its language half-way, and it is not for the agent to change it back.",
)

RING_BACK = hard(
    "hard_draft_through_a_call",
    Module.COMMS,
    (
        "Tell Yusuf by text that I'm {late} minutes late. Should he ring first, answer and don't send it any more.",
        "Write Yusuf that I'll be {late} minutes late, unless he calls before it's sent: then just put him"
        " through.",
        "A message to Yusuf, {late} minutes late. If it's him on the phone meanwhile, I'll tell him myself, no"
        " text.",
        "Yusuf should get my delay of {late} minutes in writing. Only if he phones before that, take the call and"
        " drop the message; others go unanswered.",
    ),
    done(
        replace(with_papers(PARKED, contacts=knowing(YUSUF, OSKAR)), interruptions=(Arrival("call", 5.0, YUSUF),)),
        Entered("calls.answered", YUSUF),
        (
            *write_to(YUSUF),
            Tap("thread.figure"),
            Tap("figure.say.late"),
            Tap("figure.up", 2),
            Tap("call.answer"),
        ),
        slips=(
            (
                *write_to(YUSUF),
                Tap("thread.figure"),
                Tap("figure.say.late"),
                Tap("figure.up", 2),
                Tap("call.answer"),
                Tap("figure.up", param("late", {minutes: minutes // 5 - 2 for minutes in (15, 20, 25, 35, 40)})),
                Tap("figure.send"),
            ),
        ),
        may_write=frozenset({"messages.read"}),
        deadline=Deadline(34.0, "a call rings for 30 s (ETSI TS 122 082), and it comes after 5 s"),
    ),
    done(
        replace(with_papers(PARKED, contacts=knowing(YUSUF, OSKAR)), interruptions=(Arrival("call", 5.0, OSKAR),)),
        Entered("messages.sent", {"to": YUSUF, "text": "I'll be {late} minutes late"}),
        (
            *write_to(YUSUF),
            Tap("thread.figure"),
            Tap("figure.say.late"),
            Tap("figure.up", param("late", {minutes: minutes // 5 for minutes in (15, 20, 25, 35, 40)})),
            Tap("figure.send"),
        ),
        slips=(
            (
                *write_to(YUSUF),
                Tap("thread.figure"),
                Tap("figure.say.late"),
                Tap("figure.up", 2),
                Tap("call.answer"),
            ),
        ),
        deadline=Deadline(34.0, "a call rings for 30 s (ETSI TS 122 082), and it comes after 5 s"),
    ),
    "events: Yusuf rings while the message is put together, or somebody else",
    parameters={"late": (15, 20, 25, 35, 40)},
    ability=Ability.CHAIN,
    guess_loses="Who rings decides whether the message is still to be sent, when it is nearly ready.",
)

TASKS = (
    MOVED_TWICE,
    CALL_WHILE_TYPING,
    WINDOW_COMES_DOWN,
    SOFT_TYRE_MEANWHILE,
    LANGUAGE_MIDWAY,
    RING_BACK,
)
