"""The driver says more later, or has to be asked: a part is taken back, another place is meant, two disagree."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.calendar import Appointment
from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.places import PlaceKind
from automotive_cosim.cockpit.signals import CABIN, HMI, HVAC, MEDIA, VOICE
from automotive_cosim.tasking.checks import AllOf, AppDataIs, AskedFirst, Entered, NotAsked, SignalIs
from automotive_cosim.tasking.dialogue import Says, Topic
from automotive_cosim.tasking.moves import Consult, Hear, Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.records import AppDataAt, EnteredAll, SaysFigure
from automotive_cosim.tasking.task import Ability, Half, Module, Start
from automotive_cosim.tasking.triggers import All, SignalHas
from automotive_cosim.tasks.hard.forms import (
    A_RED_LIGHT,
    BEA,
    ISLA,
    MALIK,
    ON_THE_ROAD,
    PARKED,
    THE_OTHER_WAITS,
    YUSUF,
    Moves,
    done,
    figure,
    hard,
    knowing,
    letter,
    with_papers,
    write_to,
    wrote,
)
from automotive_cosim.tasks.maps import SETS_OUT, named


def speaking(half: Half, *says: Says) -> Half:
    """The half with what the driver says later."""
    return replace(half, says=says)


STREET = replace(
    ON_THE_ROAD, signals={MEDIA.SOURCE.path: "DAB", MEDIA.ACTION.path: "PLAY", MEDIA.VOLUME.path: 70.0}
)
AIR = (
    Open("climate"),
    TapUntil("hvac.driver_temperature.decrease", "hvac.driver_temperature", "19.0 °C"),
    Slide("hvac.fan", param("percent")),
)
AIR_BACK = (
    Open("climate"),
    TapUntil("hvac.driver_temperature.increase", "hvac.driver_temperature", "21.0 °C"),
    Slide("hvac.fan", 30.0),
)
LIGHT = (
    Open("vehicle"),
    Tap("vehicle.tab.interior"),
    Slide("light.ambient", param("percent")),
    Tap("light.passenger_reading"),
)
LIGHT_BACK = (
    Open("vehicle"),
    Tap("vehicle.tab.interior"),
    Slide("light.ambient", 30.0),
    Tap("light.passenger_reading"),
)
SOUND = (Open("media"), Slide("media.volume", 40.0))
COOLER = AllOf(
    (
        SignalIs(HVAC.DRIVER_TEMPERATURE, (19.0,)),
        SignalIs(HVAC.PASSENGER_TEMPERATURE, (19.0,)),
        SignalIs(HVAC.FAN_SPEED, (param("percent"),)),
    )
)
BRIGHTER = AllOf(
    (SignalIs(CABIN.AMBIENT_LIGHT, (param("percent"),)), SignalIs(CABIN.PASSENGER_READING_LIGHT, (True,)))
)
QUIETER = SignalIs(MEDIA.VOLUME, (40.0,))
AS_IT_WAS = AllOf(
    (
        SignalIs(HVAC.DRIVER_TEMPERATURE, (21.0,)),
        SignalIs(HVAC.PASSENGER_TEMPERATURE, (21.0,)),
        SignalIs(HVAC.FAN_SPEED, (30.0,)),
    )
)
DARK_AGAIN = AllOf((SignalIs(CABIN.AMBIENT_LIGHT, (30.0,)), SignalIs(CABIN.PASSENGER_READING_LIGHT, (False,))))
BOTH_DONE = All((SignalHas(CABIN.PASSENGER_READING_LIGHT, True), SignalHas(HVAC.FAN_SPEED, param("percent"))))
NOT_THE_AIR = Says("No, leave the temperature and the fan as they were. The rest is fine, go on.", when=BOTH_DONE)
NOT_THE_LIGHT = Says("No, leave the lights as they were. The rest is fine, go on.", when=BOTH_DONE)
A_PART_BACK = hard(
    "hard_a_part_taken_back",
    Module.SYSTEM,
    (
        "19 degrees, fan {percent}; ambient light {percent} and the reading lamp over there; last, music at 40.",
        "Do these for me: both sides 19, blower {percent}, mood light {percent}, passenger's reading light on,"
        " volume"
        " 40.",
        "Cooler, 19 for all with the fan on {percent}. Then light: {percent} along the doors plus the passenger's"
        " lamp. And the stereo down to 40.",
        "I'd like 19 with the fan at {percent}, after that {percent} of mood lighting and the lamp on"
        " the passenger's side, and finally 40 on the sound.",
    ),
    speaking(
        done(
            STREET,
            AllOf((AS_IT_WAS, BRIGHTER, QUIETER)),
            (*AIR, *LIGHT, Hear("leave the temp"), *AIR_BACK, *SOUND),
            slips=(
                (*AIR, *LIGHT, Hear("leave the temp"), *SOUND),
                (*AIR, *LIGHT, Hear("leave the temp"), *AIR_BACK),
            ),
            may_write=frozenset(),
        ),
        NOT_THE_AIR,
    ),
    speaking(
        done(
            STREET,
            AllOf((COOLER, DARK_AGAIN, QUIETER)),
            (*AIR, *LIGHT, Hear("leave the lights"), *LIGHT_BACK, *SOUND),
            slips=((*AIR, *LIGHT, Hear("leave the lights"), *SOUND),),
            may_write=frozenset(),
        ),
        NOT_THE_LIGHT,
    ),
    "events: the driver takes back the air, or the lights",
    parameters={"percent": (50, 60, 70, 80, 90)},
    tags=frozenset({"two_modules"}),
    ability=Ability.CHAIN,
    guess_loses="After half of it the driver takes back a part, and only that.",
)

TURNED_JAPANESE = CarChange(4.0, HMI.LANGUAGE.path, "ja")
EAR = (
    Open("settings"),
    Tap("settings.page.sound"),
    Slide("sound.guidance", param("percent")),
    Slide("sound.calls", param("percent")),
    Slide("sound.bass", param("bass"), -10.0, 10.0),
    Slide("sound.treble", 3.0, -10.0, 10.0),
    Slide("sound.balance", 20.0, -100.0, 100.0),
)
HEARD = AllOf(
    (
        SignalIs(VOICE.GUIDANCE_VOLUME, (param("percent"),)),
        SignalIs(VOICE.CALL_VOLUME, (param("percent"),)),
        SignalIs(MEDIA.BASS, (param("bass"),)),
        SignalIs(MEDIA.TREBLE, (3.0,)),
        SignalIs(MEDIA.BALANCE, (20.0,)),
    )
)
ENGLISH = (Tap("settings.page.language"), Tap("language.en"))
NOT_MINE = Says(
    "Why is that in Japanese? I didn't do that, back to English.", when=SignalHas(HMI.LANGUAGE, "ja"), time_s=7.0
)
GUESTS = Says("Oh, Mr Sato likes it in Japanese. Leave it.", when=SignalHas(HMI.LANGUAGE, "ja"), time_s=7.0)
WHOSE_LANGUAGE = hard(
    "hard_whose_language",
    Module.SYSTEM,
    (
        "My hearing test says: guidance and calls {percent}, bass {bass}, treble 3, balance 20 to the right.",
        "Tune the sound to my ears: {percent} for voice and phone, plus {bass} bass, plus 3 treble, 20 right.",
        "Set what I hear: directions at {percent}, calls too, bass {bass} up, treble 3 up, and 20 over to the"
        " right.",
        "Sound page, please: spoken turns and phone {percent}, low end {bass}, high end 3, and the"
        " balance 20 over to the right.",
    ),
    speaking(
        done(
            replace(PARKED, interruptions=(TURNED_JAPANESE,)),
            AllOf((HEARD, SignalIs(HMI.LANGUAGE, ("en",)))),
            (*EAR, Hear("back to English"), *ENGLISH),
            slips=((*EAR, Hear("back to English")),),
            may_write=frozenset(),
            deadline=A_RED_LIGHT,
        ),
        NOT_MINE,
    ),
    speaking(
        done(
            replace(PARKED, interruptions=(TURNED_JAPANESE,)),
            HEARD,
            (*EAR, Hear("Leave it")),
            slips=((*EAR, *ENGLISH),),
            may_write=frozenset(),
            deadline=A_RED_LIGHT,
        ),
        GUESTS,
    ),
    "events: the driver wants the language back, or leaves it to a guest",
    parameters={"percent": (30, 40, 60, 70, 80), "bass": (2, 4, 6)},
    only_english="the driver wants the car back in English, or leaves it in Japanese",
    ability=Ability.CHAIN,
    guess_loses="The language changes half-way; only his remark tells whether it is to go back.",
)

MUSEUMS = named(PlaceKind.MUSEUM)
CAFES = named(PlaceKind.CAFE)[: len(MUSEUMS)]
AFTER = dict(zip(MUSEUMS, CAFES, strict=True))
CITY = with_papers(Start("london", "bloomsbury", start="2026-11-18T16:10:00"), contacts=knowing(BEA))


def _guided(kind: str, name: object) -> Moves:
    return (
        Open("map"),
        Tap("map.list.explore"),
        Tap(f"explore.kind.{kind}"),
        Tap(text=name),  # type: ignore[arg-type]
        SETS_OUT,
    )


ELSEWHERE = (*_guided("cafe", param("museum", AFTER)), *write_to(BEA), Tap(text="{words}"))
MUSEUM = (*_guided("museum", "{museum}"), *write_to(BEA), Tap(text="{words}"))
RATHER_THE_CAFE = hard(
    "hard_rather_the_cafe",
    Module.MAPS,
    (
        "Navigate to {museum} and text Bea '{words}'.",
        "Off to {museum}: guidance first, then a '{words}' to Bea.",
        "Bea waits for me at {museum}. Set it as the goal and send her '{words}'.",
        "{museum} is where we're going, start the route; Bea gets a '{words}' next.",
    ),
    speaking(
        done(
            CITY,
            AllOf(
                (
                    AppDataIs("navigation.destination", (param("museum", AFTER),)),
                    Entered("messages.sent", {"to": BEA, "text": "{words}"}),
                )
            ),
            (*_guided("museum", "{museum}"), Hear("the café"), *ELSEWHERE),
            slips=(MUSEUM,),
        ),
        Says(
            param(
                "museum",
                {museum: f"Wait, we know it already: to the café, {cafe}." for museum, cafe in AFTER.items()},
            ),
            changed=frozenset({"navigation.destination"}),
        ),
    ),
    speaking(
        done(
            CITY,
            AllOf(
                (
                    AppDataIs("navigation.destination", ("{museum}",)),
                    Entered("messages.sent", {"to": BEA, "text": "{words}"}),
                )
            ),
            (*_guided("museum", "{museum}"), Hear("the café"), *write_to(BEA), Tap(text="{words}")),
            slips=((*_guided("museum", "{museum}"), *ELSEWHERE),),
        ),
        Says(
            param(
                "museum",
                {
                    museum: f"Later we might go to the café, {cafe}, but not today."
                    for museum, cafe in AFTER.items()
                },
            ),
            changed=frozenset({"navigation.destination"}),
        ),
    ),
    "events: the driver changes the goal once it is set, or only talks about another day",
    parameters={"museum": MUSEUMS, "words": ("On my way", "Where are you?")},
    tags=frozenset({"two_modules"}),
    ability=Ability.CHAIN,
    guess_loses="The goal is set when the driver names another, as a change or as mere talk.",
)

PICK_UPS = ("16:00", "16:15", "16:45", "17:00", "17:15")
THIRTY_LATER = {"16:00": "16:30", "16:15": "16:45", "16:45": "17:15", "17:00": "17:30", "17:15": "17:45"}
QUARTERS = {"16:00": 6, "16:15": 7, "16:45": 9, "17:00": 10, "17:15": 11}
"""From 15:00 to half an hour later than that."""
DAY = (Appointment("09:00", "Briefing", "Work"), Appointment("15:00", "Pick up Ben", "Home"))
WRITES_SECOND = {time: f"Ben is done at {later}" for time, later in THIRTY_LATER.items()}
CORRECTS = {time: f"Sorry, at {later} I mean" for time, later in THIRTY_LATER.items()}
SAYS_LATER = {time: f"{later}, it's Malik who takes him there." for time, later in THIRTY_LATER.items()}
BENS_TIME = Topic(
    "the time of the pick-up",
    (("{time}", "Isla"), (param("time", THIRTY_LATER), "Malik")),
    param("time", SAYS_LATER),
    ("Ben", "time", "pick-up"),
)
MOVES_BEN = (Open("calendar"), Tap("calendar.1"), Tap("appointment.later", param("time", QUARTERS)))
BEN_AT = AppDataAt(
    "calendar.entries", 1, param("time", {time: {"at": later} for time, later in THIRTY_LATER.items()})
)


def _bens(*threads: object) -> Start:
    return with_papers(PARKED, contacts=knowing(ISLA, MALIK), threads=threads, agenda=DAY)


def _asking(half: Half) -> Half:
    return replace(half, topics=(BENS_TIME,))


BOTH_PARENTS = (*letter(ISLA), *letter(MALIK))
ASK_BEN = Consult(
    param(
        "time",
        {time: f"Is it {time} as Isla writes, or {later} as Malik does?" for time, later in THIRTY_LATER.items()},
    )
)
TWO_PARENTS = hard(
    "hard_two_parents_write",
    Module.APPS,
    (
        "Isla and Malik have written about Ben. Put the pick-up in my calendar at the right time.",
        "Correct when I'm to pick up Ben, it's in what his parents, Isla and Malik, sent.",
        "The time for Ben in my diary is wrong. Look at the messages of Malik and Isla and change it.",
        "Read Isla's and Malik's texts and set Ben's pick-up to the right time.",
    ),
    _asking(
        done(
            _bens(wrote(ISLA, "Ben is done at {time}"), wrote(MALIK, param("time", WRITES_SECOND))),
            AllOf((AskedFirst(BENS_TIME), BEN_AT)),
            (*BOTH_PARENTS, ASK_BEN, *MOVES_BEN),
            slips=((*BOTH_PARENTS, *MOVES_BEN),),
        )
    ),
    _asking(
        done(
            _bens(wrote(ISLA, "Ben is done at {time}", param("time", CORRECTS)), wrote(MALIK, "Isla knows when!")),
            AllOf((NotAsked(), BEN_AT)),
            (*BOTH_PARENTS, *MOVES_BEN),
            slips=((*BOTH_PARENTS, ASK_BEN, *MOVES_BEN),),
        )
    ),
    "content: the parents name two times, or one of them corrects herself and the other knows none",
    parameters={"time": PICK_UPS},
    tags=frozenset({"two_modules", "asking"}),
    ability=Ability.OCCUPANTS,
    guess_loses="Two parents give two times, or one corrects herself: to ask is right once and wrong once.",
)

LATE, MORE = (15, 20, 25, 35, 40), {15: 45, 20: 50, 25: 55, 35: 65, 40: 70}
DRAFT = (*write_to(YUSUF), Tap("thread.figure"), Tap("figure.say.late"))
UP = {late: late // 5 for late in LATE}
ON_TOP = dict.fromkeys(LATE, 1)
MAKE_IT_MORE = hard(
    "hard_half_an_hour_more",
    Module.COMMS,
    (
        "Tell Yusuf I'm {late} minutes late and put the screen on miles.",
        "Write Yusuf '{late} minutes late', and distances are to be in miles from now on.",
        "Miles on the display, please, and for Yusuf a message: {late} minutes late.",
        "Yusuf has to know, {late} minutes late. The units, by the way, should be miles.",
    ),
    speaking(
        done(
            with_papers(PARKED, contacts=knowing(YUSUF)),
            AllOf(
                (
                    SaysFigure(YUSUF, "minutes late", param("late", MORE), 0.0),
                    SignalIs(HMI.DISTANCE_UNIT, ("MILES",)),
                )
            ),
            (
                *DRAFT,
                Tap("figure.up", param("late", UP)),
                Hear("half an hour more"),
                Tap("figure.more"),
                Tap("figure.send"),
                Open("settings"),
                Tap("settings.distance.miles"),
            ),
            slips=(
                (
                    *DRAFT,
                    Tap("figure.up", param("late", UP)),
                    Hear("half an hour more"),
                    Tap("figure.send"),
                    Open("settings"),
                    Tap("settings.distance.miles"),
                ),
                (*figure(YUSUF, "late", Tap("figure.more")), Open("settings"), Tap("settings.distance.miles")),
            ),
            deadline=THE_OTHER_WAITS,
        ),
        Says("No, that won't do. Tell him half an hour more than I said.", step=6),
    ),
    speaking(
        done(
            with_papers(PARKED, contacts=knowing(YUSUF)),
            AllOf(
                (
                    SaysFigure(YUSUF, "minutes late", param("late"), 0.0),
                    SignalIs(HMI.DISTANCE_UNIT, ("KILOMETERS",)),
                )
            ),
            (*DRAFT, Tap("figure.up", param("late", UP)), Hear("keep kilometres"), Tap("figure.send")),
            slips=(
                (
                    *DRAFT,
                    Tap("figure.up", param("late", UP)),
                    Hear("keep kilometres"),
                    Tap("figure.send"),
                    Open("settings"),
                    Tap("settings.distance.miles"),
                ),
            ),
            deadline=THE_OTHER_WAITS,
        ),
        Says("On second thoughts, keep kilometres. The message stands.", step=6),
    ),
    "events: the driver corrects the figure, or takes the other wish back",
    parameters={"late": LATE},
    tags=frozenset({"two_modules"}),
    ability=Ability.CHAIN,
    guess_loses="The figure is nearly sent when the driver corrects it, or withdraws the other wish.",
)

WORDS = ("Yes", "Thank you", "On my way", "Where are you?", "I've arrived")
TO_ISLA = (*write_to(ISLA), Tap(text="{words}"))
NO_TO_ISLA = (*write_to(ISLA), Tap(text="No"))
TO_MALIK = (*write_to(MALIK), Tap(text="{words}"))
SENT_TO_ISLA = {"to": ISLA, "text": "{words}"}


def _sends(*entries: dict[str, str]) -> AllOf:
    return AllOf((EnteredAll("messages.sent", entries, in_order=True), SignalIs(VOICE.GUIDANCE, ("MUTED",))))


QUIET_MAP = (Open("map"), Tap("map.voice"))
BOTH_KNOWN = with_papers(PARKED, contacts=knowing(ISLA, MALIK))
MEANT_FOR_MALIK = hard(
    "hard_meant_for_malik",
    Module.COMMS,
    (
        "Text Isla '{words}', and then no more voice from the map.",
        "Isla gets a '{words}' from me; mute the guidance after that.",
        "First '{words}' to Isla. Next, switch the spoken directions off.",
        "A message, '{words}', for Isla, please, and silence from the navigation afterwards.",
    ),
    speaking(
        done(
            BOTH_KNOWN,
            _sends(SENT_TO_ISLA, {"to": ISLA, "text": "No"}, {"to": MALIK, "text": "{words}"}),
            (*TO_ISLA, Hear("meant for Malik"), *NO_TO_ISLA, *TO_MALIK, *QUIET_MAP),
            slips=(
                (*TO_ISLA, Hear("meant for Malik"), *TO_MALIK, *QUIET_MAP),
                (*TO_ISLA, Hear("meant for Malik"), *TO_MALIK, *NO_TO_ISLA, *QUIET_MAP),
                (*TO_ISLA, Hear("meant for Malik"), *NO_TO_ISLA, *TO_MALIK),
            ),
        ),
        Says(
            "Oh dear, that was meant for Malik. Write Isla 'No' first, then Malik what I told you.",
            changed=frozenset({"messages.sent"}),
        ),
    ),
    speaking(
        done(
            BOTH_KNOWN,
            _sends(SENT_TO_ISLA),
            (*TO_ISLA, Hear("nothing for him"), *QUIET_MAP),
            slips=((*TO_ISLA, Hear("nothing for him"), *TO_MALIK, *QUIET_MAP), (*TO_ISLA, Hear("nothing for him"))),
        ),
        Says(
            "Good. I thought for a moment that Malik should have it too, but there's nothing for him.",
            changed=frozenset({"messages.sent"}),
        ),
    ),
    "events: the driver finds that the wrong one got it, or that all is well",
    parameters={"words": WORDS},
    ability=Ability.CHAIN,
    guess_loses="The message has gone when the driver notices the name, or finds that it was right.",
)

TASKS = (A_PART_BACK, WHOSE_LANGUAGE, RATHER_THE_CAFE, TWO_PARENTS, MAKE_IT_MORE, MEANT_FOR_MALIK)
