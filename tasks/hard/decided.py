"""Two values are plausible, and a rule, a date, a reading or a later word decides which one is right."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat
from automotive_cosim.cockpit.apps.calendar import Appointment
from automotive_cosim.cockpit.signals import CABIN, HMI, HVAC, MEDIA
from automotive_cosim.tasking.checks import AllOf, Check, Entered, SignalIs
from automotive_cosim.tasking.dialogue import Says
from automotive_cosim.tasking.moves import Hear, Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.records import AppDataAt, SaysFigure
from automotive_cosim.tasking.task import Ability, Half, Module, Start
from automotive_cosim.tasks.forms import linked
from automotive_cosim.tasks.hard.dialogue import speaking
from automotive_cosim.tasks.hard.forms import (
    BEA,
    ISLA,
    OSKAR,
    PARKED,
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
    with_papers,
    wrote,
)

BOTH = (*letter(BEA), *letter(YUSUF))

BEAS_PERCENT = (15, 20, 25, 30, 35)
YUSUFS_PERCENT = {percent: percent + 30 for percent in BEAS_PERCENT}
RADIO_ON = {MEDIA.SOURCE.path: "FM", MEDIA.ACTION.path: "PLAY", MEDIA.VOLUME.path: 45.0}


def _music(source: str, percent: Any, loser: str) -> Moves:
    return (
        Open("memo"),
        *BOTH,
        Open("media"),
        Tap(f"media.source.{source}"),
        Slide("media.volume", percent),
        *answer(loser, "No"),
    )


def _plays(source: str, percent: Any, loser: str) -> AllOf:
    return AllOf(
        (
            SignalIs(MEDIA.SOURCE, (source,)),
            SignalIs(MEDIA.VOLUME, (percent,)),
            Entered("messages.sent", {"to": loser, "text": "No"}),
        )
    )


BEAS_MUSIC = _music("dab", param("percent"), YUSUF)
YUSUFS_MUSIC = _music("usb", param("percent", YUSUFS_PERCENT), BEA)


def _day(date: str) -> Start:
    return with_papers(
        replace(PARKED, start=f"{date}T14:05:00", signals=RADIO_ON),
        contacts=knowing(BEA, YUSUF),
        threads=(
            wrote(BEA, "Today I want digital radio, at {percent}"),
            wrote(YUSUF, param("percent", {own: f"USB stick, at {his}!" for own, his in YUSUFS_PERCENT.items()})),
        ),
        memos=("Music: Bea on odd dates, Yusuf on even ones", "Bulbs for the cellar"),
        agenda=(Appointment("18:30", "Choir", "Home"),),  # without one there is no calendar, which tells the date
    )


WHOSE_DAY = hard(
    "hard_whose_day",
    Module.MEDIA,
    (
        "Bea and Yusuf have each written what they want to hear, and how loud. My memo settles whose turn"
        " it is today."
        " Do that one's wish and text the other 'No'.",
        "Two wishes for the music, one from Yusuf and one from Bea. Whose day is it by my notes? Source and"
        " volume as"
        " that one writes; a 'No' to who has to wait.",
        "Put on what Bea or Yusuf asks for, whoever may choose today according to the memo, at the volume"
        " given. The"
        " one who may not gets a no.",
        "The memo on the music says who decides on a day like this. See the messages of Yusuf and Bea, fulfil one,"
        " refuse the other with 'No'.",
    ),
    done(
        _day("2026-11-18"),
        _plays("USB", param("percent", YUSUFS_PERCENT), BEA),
        YUSUFS_MUSIC,
        slips=(BEAS_MUSIC, _music("usb", param("percent"), BEA)),
    ),
    done(
        _day("2026-11-17"),
        _plays("DAB", param("percent"), YUSUF),
        BEAS_MUSIC,
        slips=(YUSUFS_MUSIC,),
    ),
    "date: the eighteenth of November, or the seventeenth",
    parameters={"percent": BEAS_PERCENT},
    tags=frozenset({"two_modules", "conflict"}),
    ability=Ability.OCCUPANTS,
    guess_loses="Two people want two kinds of music; a memo and the date tell whose turn it is.",
)

COLD, WARM = {1: 17.0, 2: 17.5, 3: 18.0, 4: 18.5, 5: 19.0}, {1: 24.0, 2: 23.5, 3: 25.0, 4: 24.5, 5: 24.0}
MIDDLE = {way: (COLD[way] + WARM[way]) / 2 for way in COLD}
NEAREST = {way: int(degrees * 2) / 2 for way, degrees in MIDDLE.items()}
"""The middle, down to the half degree."""


def _agreed(degrees: dict[int, float]) -> Moves:
    way = {each: "increase" if value > 21.0 else "decrease" for each, value in degrees.items()}
    return (
        Open("memo"),
        *BOTH,
        Open("climate"),
        TapUntil(
            param("way", {each: f"hvac.driver_temperature.{key}" for each, key in way.items()}),
            "hvac.driver_temperature",
            param("way", {each: f"{value:.1f} °C" for each, value in degrees.items()}),
        ),
        *answer(BEA, "Yes"),
    )


def _at(degrees: dict[int, float]) -> AllOf:
    value = param("way", degrees)
    return AllOf(
        (
            SignalIs(HVAC.DRIVER_TEMPERATURE, (value,)),
            SignalIs(HVAC.PASSENGER_TEMPERATURE, (value,)),
            Entered("messages.sent", {"to": BEA, "text": "Yes"}),
        )
    )


def _disagree(memo: str) -> Start:
    return with_papers(
        PARKED,
        contacts=knowing(BEA, YUSUF),
        threads=(
            wrote(
                BEA, param("way", {way: f"Make it {degrees:g} degrees, please" for way, degrees in COLD.items()})
            ),
            wrote(
                YUSUF, param("way", {way: f"I need {degrees:g} degrees, please" for way, degrees in WARM.items()})
            ),
        ),
        memos=("Filter changed in March", memo),
    )


HOW_THEY_AGREE = hard(
    "hard_how_they_agree",
    Module.HVAC,
    (
        "Bea and Yusuf want different temperatures, they've written which. Settle it as my memo says, for"
        " both front"
        " seats, and tell Bea yes.",
        "What they want is in the messages of Yusuf and Bea, how to settle it is in my notes. Set the whole car to"
        " that; Bea gets a 'Yes'.",
        "One is always cold: see Bea's and Yusuf's texts. There's a rule for it in the memos. One temperature for"
        " everybody by that rule, then 'Yes' to Bea.",
        "Read how warm Yusuf wants it and how warm Bea does, apply my note on quarrels about the"
        " heating, and answer Bea with a yes.",
    ),
    done(
        _disagree("Heating, if Bea and Yusuf disagree: the middle, rounded down to half a degree"),
        _at(NEAREST),
        _agreed(NEAREST),
        slips=(_agreed(WARM), _agreed(COLD)),
    ),
    done(
        _disagree("Heating, if Bea and Yusuf disagree: whoever wants it cooler has it so"),
        _at(COLD),
        _agreed(COLD),
        slips=(_agreed(NEAREST), _agreed(WARM)),
    ),
    "content: the memo's rule is the middle, or the cooler wish",
    parameters={"way": tuple(COLD)},
    tags=frozenset({"two_modules", "conflict"}),
    ability=Ability.OCCUPANTS,
    guess_loses="Two temperatures, and a memo with the rule that settles them.",
)

LEFT, RIGHT = Seat.REAR_LEFT, Seat.REAR_RIGHT
BENS = (Open("memo"), Open("cabin"), Slide("cabin.rear_screen", param("percent")), *answer(WANDA, "Yes"))
MIAS = (
    Open("memo"),
    Open("cabin"),
    Slide("cabin.rear_screen", 0.0),
    Open("vehicle"),
    Tap("vehicle.tab.doors"),
    Slide("window.rear_left", 30.0),
    Slide("window.rear_right", 30.0),
    *answer(WANDA, "Yes"),
)
TOLD_WANDA = Entered("messages.sent", {"to": WANDA, "text": "Yes"})


def _behind(left_kg: float, right_kg: float) -> Start:
    return with_papers(
        replace(
            PARKED,
            aboard=(Occupant(LEFT, Kind.CHILD, left_kg), Occupant(RIGHT, Kind.CHILD, right_kg)),
            signals={HMI.REAR_SCREEN.path: 50.0},
        ),
        contacts=knowing(WANDA),
        memos=(
            "Ben, left: rear screen at {percent}. Mia, right: rear screen off, both windows behind 30 % open",
            "The lighter child has the choice",
        ),
    )


LIGHTER_CHILD = hard(
    "hard_lighter_child",
    Module.SYSTEM,
    (
        "Ben and Mia quarrel in the back. Their wishes and the rule for such days are in my memos. Do what the rule"
        " says, for one child only, then text Wanda 'Yes'.",
        "Two children behind, two wishes, one rule, all of it in my notes. See who sits there, grant the right wish"
        " and none of the other's; Wanda gets a 'Yes'.",
        "Who of Mia and Ben has the choice today? Look at the memos and at the seats. Set what that child wants and"
        " tell Wanda yes.",
        "Settle the fight behind by the memo: one of Ben and Mia gets everything they want, the other"
        " nothing. A yes"
        " goes to Wanda.",
    ),
    done(
        _behind(27.0, 18.0),
        AllOf(
            (
                SignalIs(HMI.REAR_SCREEN, (0.0,)),
                SignalIs(CABIN.REAR_LEFT_WINDOW, (30.0,)),
                SignalIs(CABIN.REAR_RIGHT_WINDOW, (30.0,)),
                TOLD_WANDA,
            )
        ),
        MIAS,
        slips=(BENS, (*MIAS[:3], *answer(WANDA, "Yes"))),
    ),
    done(
        _behind(18.0, 27.0),
        AllOf((SignalIs(HMI.REAR_SCREEN, (param("percent"),)), TOLD_WANDA)),
        BENS,
        slips=(MIAS,),
    ),
    "occupants: the child on the right is the lighter one, or the child on the left",
    parameters={"percent": (20, 30, 70, 80, 90)},
    tags=frozenset({"two_modules", "conflict"}),
    ability=Ability.OCCUPANTS,
    guess_loses="The rule goes by weight, which only the cabin's screen tells.",
)

OLD_CODES = ("47", "83", "26", "91", "58")
NEW_CODES = {old: old[::-1] for old in OLD_CODES}


def _gate(turned: bool) -> Moves:
    codes = {old: new if turned else old for old, new in NEW_CODES.items()}
    last = (Tap(param("code", {old: f"phone.key.{code[at]}" for old, code in codes.items()})) for at in (0, 1))
    return (
        Open("memo"),
        Open("phone"),
        Tap("phone.tab.keypad"),
        *(Tap(f"phone.key.{digit}") for digit in "7700"),
        *last,
        Tap("phone.call_number"),
    )


def _at_the_gate(date: str, codes: Check, moves: Moves, wrong: Moves) -> Half:
    start = with_papers(
        replace(PARKED, start=f"{date}T14:05:00"),
        memos=(
            "Gate till November: dial 7700 {code}",
            param("code", {old: f"Gate from December on: dial 7700 {new}" for old, new in NEW_CODES.items()}),
        ),
    )
    return done(start, codes, moves, slips=(wrong,), may_write=frozenset())


GATE_FROM_DECEMBER = hard(
    "hard_gate_from_december",
    Module.COMMS,
    (
        "Open the gate for me: ring its number, it's in my memos, the one that's valid now.",
        "The gate opens on a call. Key in today's number from the notes and dial.",
        "We're at the gate. Look up what has to be dialled as of today, then call it by the keypad.",
        "Phone the gate, please; mind that its number changes, I've noted from when.",
    ),
    _at_the_gate(
        "2026-12-02",
        Entered("calls", param("code", {old: f"7700{new}" for old, new in NEW_CODES.items()})),
        _gate(True),
        _gate(False),
    ),
    _at_the_gate("2026-11-18", Entered("calls", "7700{code}"), _gate(False), _gate(True)),
    "date: the second of December, or the middle of November",
    parameters={"code": OLD_CODES},
    ability=Ability.RULE,
    guess_loses="Two numbers are noted; the date tells which is valid.",
)

OFFERED = {"the tablet": "Tablet", "your second phone": "Second phone"}
DEVICES = (Open("phone"), Tap("phone.devices"))


def _paired(text: Any) -> Moves:
    return (*letter(OSKAR), *DEVICES, Tap(text=text), *answer(OSKAR, "Yes"))


NOT_THERE = (*letter(OSKAR), *DEVICES, *answer(OSKAR, "No"))
READY = "I've set up {device} for the car, with your music on it"
DEVICE_FROM_OSKAR = hard(
    "hard_device_from_oskar",
    Module.COMMS,
    (
        "Oskar has made something ready for Bluetooth. Link what he writes and nothing else, and answer him"
        " Yes; No if"
        " the car doesn't find it.",
        "See Oskar's message: pair that device, then 'Yes' to him. Should it not be offered here, leave the phone"
        " linked as it is and write 'No'.",
        "Connect the gadget from Oskar's text and confirm with a yes. If that very one isn't in the list, no"
        " substitute, just tell him no.",
        "What Oskar has prepared should be paired here by Bluetooth; he gets a yes when it's done, or a no when the"
        " car doesn't have it on offer.",
    ),
    done(
        with_papers(PARKED, contacts=knowing(OSKAR), threads=(wrote(OSKAR, READY),)),
        AllOf(
            (
                linked("device", OFFERED),
                Entered("messages.sent", {"to": OSKAR, "text": "Yes"}),
            )
        ),
        _paired(param("device", OFFERED)),
        slips=(NOT_THERE, (*letter(OSKAR), *DEVICES, Tap(text=param("device", OFFERED)))),
    ),
    done(
        with_papers(PARKED, contacts=knowing(OSKAR), threads=(wrote(OSKAR, READY.format(device="{other}")),)),
        Entered("messages.sent", {"to": OSKAR, "text": "No"}),
        NOT_THERE,
        slips=(_paired("Tablet"), _paired("Second phone")),
    ),
    "content: a device that the car finds, or one that it does not",
    parameters={"device": tuple(OFFERED), "other": ("your old player", "the kitchen radio", "the work laptop")},
    ability=Ability.CONTENT,
    guess_loses="The device is named in a message, and may not be there.",
)

BASS, TREBLE = (2, 4, 6), (-3, -5)


def _tones(bass: Any, treble: Any) -> Moves:
    return (Slide("sound.bass", bass, -10.0, 10.0), Slide("sound.treble", treble, -10.0, 10.0))


AS_SAID, SWAPPED = _tones(param("bass"), param("treble")), _tones(param("treble"), param("bass"))
SOUND = (Open("settings"), Tap("settings.page.sound"))


def _tuned(bass: Any, treble: Any) -> AllOf:
    return AllOf(
        (
            SignalIs(MEDIA.BASS, (bass,)),
            SignalIs(MEDIA.TREBLE, (treble,)),
            SignalIs(MEDIA.BALANCE, (-20.0,)),
            Entered("messages.sent", {"to": THEO, "text": "Thank you"}),
        )
    )


BALANCED = Slide("sound.balance", -20.0, -100.0, 100.0)
IN_THE_CAR = with_papers(PARKED, contacts=knowing(THEO))
MIXED_UP = hard(
    "hard_mixed_up",
    Module.MEDIA,
    (
        "Theo's values for the sound: bass {bass}, treble {treble}. Then 20 to the left with the balance, and thank"
        " him by text.",
        "Set bass {bass} and treble {treble}, next the balance 20 left; Theo gets a 'Thank you' for the tip.",
        "The tone as Theo has it, bass {bass} and treble {treble}; after that shift the balance 20 to the left "
        "and write him 'Thank you'.",
        "First the low end to {bass}, the high end to {treble}. The balance goes 20 left then, and Theo is"
        " thanked.",
    ),
    speaking(
        done(
            IN_THE_CAR,
            _tuned(param("treble"), param("bass")),
            (*SOUND, *AS_SAID, Hear("mixed them up"), *SWAPPED, BALANCED, *answer(THEO, "Thank you")),
            slips=(
                (*SOUND, *AS_SAID, Hear("mixed them up"), BALANCED, *answer(THEO, "Thank you")),
                (*SOUND, *AS_SAID, Hear("mixed them up"), *SWAPPED),
            ),
            may_write=frozenset(),
        ),
        Says(
            "Sorry, I've mixed them up: what I said for the bass is for the treble, and the other way round.",
            step=4,
        ),
    ),
    speaking(
        done(
            IN_THE_CAR,
            _tuned(param("bass"), param("treble")),
            (*SOUND, *AS_SAID, Hear("right after all"), BALANCED, *answer(THEO, "Thank you")),
            slips=((*SOUND, *AS_SAID, Hear("right after all"), *SWAPPED, BALANCED, *answer(THEO, "Thank you")),),
            may_write=frozenset(),
        ),
        Says("I was afraid I'd mixed bass and treble up, but no, it's right after all. Go on.", step=4),
    ),
    "events: the driver has mixed two values up, or only thought so",
    parameters={"bass": BASS, "treble": TREBLE},
    tags=frozenset({"two_modules"}),
    ability=Ability.CHAIN,
    guess_loses="The driver finds, after both values are set, that they are swapped, or only thinks so.",
)

LATER = {30: 2, 45: 3, 60: 4}
"""Minutes, and taps of a quarter of an hour."""
MEETINGS = (
    Appointment("10:00", "Bank", "Work"),
    Appointment("12:00", "Meeting", "Work"),
    Appointment("15:00", "Meeting", "Home"),
)


def _later(entry: int) -> Moves:
    return (Open("calendar"), Tap(f"calendar.{entry}"), Tap("appointment.later", param("minutes", LATER)))


EARLIER = Tap("appointment.earlier", param("minutes", LATER))
BACK_AND_LATER = (EARLIER, *_later(2))


def _is_at(entry: int, hour: int) -> AllOf:
    moved = {minutes: {"at": f"{hour + minutes // 60}:{minutes % 60:02d}"} for minutes in LATER}
    return AllOf(
        (
            AppDataAt("calendar.entries", entry, param("minutes", moved)),
            Entered("messages.sent", {"to": ISLA, "text": "{words}"}),
        )
    )


MEETING_DAY = with_papers(PARKED, contacts=knowing(ISLA), agenda=MEETINGS)
NOT_THAT_MEETING = hard(
    "hard_not_that_meeting",
    Module.APPS,
    (
        "Move the meeting at noon {minutes} minutes later, then send Isla '{words}'.",
        "{minutes} minutes later with the twelve o'clock meeting, and after that Isla gets '{words}'.",
        "Shift my 12:00 by {minutes} minutes and text '{words}' to Isla.",
        "The meeting at twelve is {minutes} minutes later today. Correct it, next '{words}' for Isla.",
    ),
    speaking(
        done(
            MEETING_DAY,
            _is_at(2, 15),
            (*_later(1), Hear("the one at three"), *BACK_AND_LATER, *answer(ISLA, "{words}")),
            slips=(
                (*_later(1), Hear("the one at three"), *_later(2), *answer(ISLA, "{words}")),
                (*_later(1), Hear("the one at three"), *answer(ISLA, "{words}")),
            ),
            may_write=frozenset(),
        ),
        Says("Wait, I meant the one at three. Noon has to stay at noon.", changed=frozenset({"calendar.entries"})),
    ),
    speaking(
        done(
            MEETING_DAY,
            _is_at(1, 12),
            (*_later(1), Hear("three o'clock stays"), *answer(ISLA, "{words}")),
            slips=((*_later(1), Hear("three o'clock stays"), *BACK_AND_LATER, *answer(ISLA, "{words}")),),
            may_write=frozenset(),
        ),
        Says("Good. And the three o'clock stays where it is.", changed=frozenset({"calendar.entries"})),
    ),
    "events: the driver meant the other meeting, or is content",
    parameters={"minutes": tuple(LATER), "words": ("Yes", "Thank you", "On my way")},
    tags=frozenset({"two_modules"}),
    ability=Ability.CHAIN,
    guess_loses="The wrong meeting has been moved when the driver says so; it has to go back.",
)

LEGS = {1: (15, 16, 8), 2: (21, 17, 6), 3: (12, 18, 9), 4: (18, 21, 7), 5: (11, 19, 13)}
"""Kilometres of the three legs; no leg is longer than the other two together."""
TOTAL = {way: sum(legs) for way, legs in LEGS.items()}
BY_CAR = {way: legs[0] + legs[2] for way, legs in LEGS.items()}


def _driven(km: dict[int, int]) -> Moves:
    return (
        Open("memo"),
        *figure(
            BEA,
            "driven",
            Tap("figure.more", param("way", {way: total // 10 for way, total in km.items()})),
            Tap("figure.up", param("way", {way: total % 10 for way, total in km.items()})),
        ),
    )


def _legs(middle: str) -> Start:
    noted = {way: middle.format(a=a, b=b, c=c) for way, (a, b, c) in LEGS.items()}
    return with_papers(
        PARKED, contacts=knowing(BEA), memos=("Last year: 22, 35 and 19 km", param("way", noted), "New boots")
    )


LEGS_BY_CAR = hard(
    "hard_legs_by_car",
    Module.APPS,
    (
        "Add up what I drove on this year's round by car, it's in the memos, and send Bea the kilometres.",
        "Bea shares the costs: text her the km of the round that the car did, all legs together, see my"
        " notes of this"
        " year.",
        "From the memo of the tour, not last year's: the sum of the stretches by car goes to Bea as kilometres"
        " driven.",
        "How far did the car go, hut, lake and home? Total its distances in my note and message them to Bea.",
    ),
    done(
        _legs("Home to hut {a} km, to the lake and back {b} km on foot, hut to home by the other road {c} km"),
        SaysFigure(BEA, "driven", param("way", BY_CAR), 0.0),
        _driven(BY_CAR),
        slips=(_driven(TOTAL), _driven(dict.fromkeys(LEGS, 76))),
        may_write=frozenset(),
    ),
    done(
        _legs("Home to hut {a} km, hut to lake {b} km in the rain, lake to home {c} km"),
        SaysFigure(BEA, "driven", param("way", TOTAL), 0.0),
        _driven(TOTAL),
        slips=(_driven(BY_CAR),),
        may_write=frozenset(),
    ),
    "content: one stretch of the round was on foot, or all were by car",
    parameters={"way": tuple(LEGS)},
    tags=frozenset({"two_modules"}),
    ability=Ability.CONTENT,
    guess_loses="Which of three legs were driven is in the words of a memo, beside last year's.",
)

TASKS = (
    WHOSE_DAY,
    HOW_THEY_AGREE,
    LIGHTER_CHILD,
    GATE_FROM_DECEMBER,
    DEVICE_FROM_OSKAR,
    MIXED_UP,
    NOT_THAT_MEETING,
    LEGS_BY_CAR,
)
