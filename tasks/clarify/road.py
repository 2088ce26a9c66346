"""What is out there and who is aboard: the map, the weather or the seats leave one choice, or several."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat, company
from automotive_cosim.cockpit.belongings import Belongings
from automotive_cosim.cockpit.signals import CABIN, DRIVE, MEDIA, SEAT
from automotive_cosim.contracts import Weather
from automotive_cosim.tasking.checks import AppDataIs, SignalIs
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.moves import Move, Open, Slide, Tap
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Module, Start, Task
from automotive_cosim.tasks.clarify.forms import clarify
from automotive_cosim.tasks.forms import FRIENDS, PARIS
from automotive_cosim.tasks.maps import SETS_OUT
from automotive_cosim.tasks.system import DOORS

AT_NIGHT = replace(PARIS, start="2026-11-17T22:40:00")
SIDES = ("left", "right")
SIDE = (("left",), ("right",))
BEHIND = {"left": Seat.REAR_LEFT, "right": Seat.REAR_RIGHT}
REAR_WINDOWS = {"left": CABIN.REAR_LEFT_WINDOW, "right": CABIN.REAR_RIGHT_WINDOW}
REAR_HEATING = {"left": SEAT.REAR_LEFT_HEATING, "right": SEAT.REAR_RIGHT_HEATING}
CHILD_LOCKS = {"left": CABIN.LEFT_CHILD_LOCK, "right": CABIN.RIGHT_CHILD_LOCK}
REAR = (Open("climate"), Tap("hvac.comfort"))
MODES = {"rain": "RAIN", "snow": "SNOW"}


def _to(kind: str) -> tuple[Move, ...]:
    return Open("map"), Tap("map.list.explore"), Tap(f"explore.kind.{kind}")


def _place(
    task_id: str,
    says: tuple[str, ...],
    kind: str,
    pattern: str,
    choices: tuple[str, str],
    question: str,
    is_open: str,
    is_shut: Any,
    difference: str,
    parameters: Mapping[str, tuple[Any, ...]],
    start: Start = PARIS,
) -> Task:
    """Two places, of which the map says that one is no choice, or that both are."""
    one, other = choices
    names = {each: pattern.format(each) for each in choices}

    def said(which: str) -> dict[str, Any]:
        return {names[each]: is_open if each == which else is_shut for each in choices}

    return clarify(
        task_id,
        Module.MAPS,
        says,
        Topic(
            f"which {kind}",
            ((one.lower(),), (other.lower(),)),
            param("which", {each: f"{names[each]}." for each in choices}),
            (kind, "which one", "where"),
        ),
        question,
        AppDataIs("navigation.destination", (param("which", names),)),
        *_to(kind),
        Tap(text=param("which", names)),
        SETS_OUT,
        untold=replace(start, belongings=Belongings(details=dict.fromkeys(names.values(), is_open))),
        told=replace(start, belongings=Belongings(details=param("which", {each: said(each) for each in choices}))),
        look=(*_to(kind), Tap(text=names[one]), *_to(kind), Tap(text=names[other])),
        difference=difference,
        parameters={"which": choices, **parameters},
    )


def _seated(*sides: str, asleep: bool = False) -> tuple[Occupant, ...]:
    return tuple(Occupant(BEHIND[side], Kind.CHILD, asleep=asleep) for side in sides)


ON_WHICH_SIDE: Any = param("which", {side: _seated(side) for side in SIDES})
ONE_BEHIND = replace(PARIS, aboard=ON_WHICH_SIDE)
TWO_BEHIND = replace(PARIS, aboard=_seated(*SIDES))

TASKS = (
    _place(
        "clarify_car_park_with_room",
        (
            "We're off to the {what}. Theatre or Bridge Car Park, wherever there's room; if both have some,"
            " I choose.",
            "Guide me to a space for the {what}: Bridge or Theatre Car Park. Should neither be full, I want"
            " to pick.",
            "We're late for the {what}. Take the car park that isn't full, Theatre or Bridge. Leave it to me"
            " if both would do.",
            "Parking for the {what}, at the Bridge or the Theatre. I'd like a say in it as long as both have"
            " space.",
            "Theatre, Bridge, which of the two car parks isn't full? There, for the {what}. Both free: up to me.",
        ),
        "parking",
        "{} Car Park",
        ("Theatre", "Bridge"),
        "Which car park, Theatre or Bridge?",
        "140 spaces free",
        "Full",
        "content: both car parks have spaces, or one is full",
        {"what": ("play", "concert", "show", "talk")},
        start=replace(PARIS, start="2026-11-18T19:15:00"),
    ),
    _place(
        "clarify_kitchen_that_is_open",
        (
            "Lunch with {who}: Basil or Cedar Kitchen, the one that's open. If it's both, I choose.",
            "{who} is hungry. To Cedar Kitchen or Basil Kitchen; with both of them open, let me decide.",
            "Drive {who} and me to Basil or Cedar Kitchen, not to a closed door. Two open ones, and I pick.",
            "See where {who} and I can eat now, Cedar Kitchen or Basil Kitchen, and set off. If there's a "
            "choice, it's mine.",
            "Is Basil Kitchen open today, or is it Cedar? Take {who} and me there; if both are, I'll tell"
            " you which.",
        ),
        "restaurant",
        "{} Kitchen",
        ("Basil", "Cedar"),
        "Which one, Basil Kitchen or Cedar Kitchen?",
        "Open until 15:00",
        "Closed today",
        "content: both restaurants are open, or one is closed",
        {"who": FRIENDS},
        start=replace(PARIS, start="2026-11-18T12:15:00", aboard=company(2)),
    ),
    _place(
        "clarify_pharmacy_at_night",
        (
            "I need {what} tonight. Linden or Crown Pharmacy, the one on duty; if both are, it's for me to say.",
            "We've run out of {what}. Guide me to Crown or Linden Pharmacy, whichever is still open. I"
            " choose if neither is shut.",
            "Find me {what} at this hour, Linden Pharmacy or Crown. Where I'd have the choice, let me make it.",
            "Off to fetch {what}, from Crown or from Linden Pharmacy, as they're open. Both? Then I'd like"
            " to pick.",
            "Which pharmacy is on duty tonight, Linden or Crown? Take me there for {what}; if both are, I choose.",
        ),
        "pharmacy",
        "{} Pharmacy",
        ("Linden", "Crown"),
        "Which pharmacy, Linden or Crown?",
        "On duty all night",
        "Closed until 08:00",
        "content: both pharmacies are on duty, or one is closed",
        {"what": ("painkillers", "cough syrup", "baby milk", "insulin")},
        AT_NIGHT,
    ),
    _place(
        "clarify_hotel_with_a_room",
        (
            "{who} and I need a bed: Astoria or Bellevue, the one with a room. If both have rooms, I choose.",
            "Take {who} and me to the Hotel Bellevue or the Astoria, not to one that's full. With two to"
            " pick from, I pick.",
            "I can't drive on. A room for {who} and me, at the Astoria, at the Bellevue? It's my decision if"
            " they both have one.",
            "See if the Bellevue or the Astoria has room for {who} and me, and go. Let me decide should it"
            " be both.",
            "Where do {who} and I sleep tonight, Astoria or Bellevue? Set out for the free one; two free"
            " ones, and I'll say.",
        ),
        "hotel",
        "Hotel {}",
        ("Astoria", "Bellevue"),
        "Which hotel, the Astoria or the Bellevue?",
        "Rooms free tonight",
        "No rooms tonight",
        "content: both hotels have rooms, or one is booked out",
        {"who": FRIENDS},
        replace(AT_NIGHT, aboard=company(2)),
    ),
    _place(
        "clarify_market_that_is_open",
        (
            "We're out of {what}. Fresh or Corner Market, the one that's open; I choose if both are.",
            "Drive me to Corner Market or Fresh Market for {what}, unless they're shut. If neither is, let"
            " me pick.",
            "I have to buy {what}: is it Fresh Market that's open, or Corner Market? Go. Should both be,"
            " I'll say which.",
            "Find out who still sells {what}, Corner Market or Fresh Market, and guide me. Two of them: my choice.",
            "For {what} I'd go to Fresh or to Corner Market. Take me to the one that's open, and if both"
            " are, leave it to me.",
        ),
        "shop",
        "{} Market",
        ("Fresh", "Corner"),
        "Which one, Fresh Market or Corner Market?",
        "Open until 21:00",
        "Closed for stocktaking",
        "content: both shops are open, or one is closed",
        {"what": ("milk", "bread", "coffee", "apples")},
    ),
    _place(
        "clarify_museum_that_is_open",
        (
            "I promised {who} a museum: Science or Maritime, the one that's open. If both are, I choose.",
            "{who} would love the Maritime or the Science Museum. Take us where it's open; I'd pick if it's both.",
            "Off we go with {who}: Science Museum or Maritime Museum, as long as it isn't closed. With a"
            " choice, it's mine.",
            "See which museum lets {who} and me in today, the Maritime or the Science. Both? Leave that to"
            " me, else start.",
            "Is the Science Museum closed, or the Maritime? Take {who} and me to the other one; if neither"
            " is closed, I decide.",
        ),
        "museum",
        "{} Museum",
        ("Science", "Maritime"),
        "Which museum, Science or Maritime?",
        "Open until 18:00",
        "Closed for repairs",
        "content: both museums are open, or one is closed",
        {"who": FRIENDS},
        start=replace(PARIS, start="2026-11-18T10:15:00", aboard=company(2)),
    ),
    clarify(
        "clarify_whose_window_behind",
        Module.SYSTEM,
        (
            "The little one needs air: window down by {percent} percent.",
            "Open a rear window by {percent}, next to the child.",
            "{percent} percent of window for the kid behind us.",
            "Wind the child's window down, {percent} percent.",
            "A bit of wind for the child, window at {percent}, please.",
        ),
        Topic(
            "which window",
            SIDE,
            param("which", {side: f"The one on the {side}." for side in SIDES}),
            ("window", "side", "child"),
        ),
        "Which window, on the left or on the right?",
        SignalIs(param("which", REAR_WINDOWS), (param("percent", {n: float(n) for n in (20, 30, 40)}),)),
        *DOORS,
        Slide("window.rear_{which}", param("percent", {n: float(n) for n in (20, 30, 40)})),
        untold=TWO_BEHIND,
        told=ONE_BEHIND,
        look=(),
        find=DOORS,
        difference="occupants: two children sit behind, or one",
        parameters={"which": SIDES, "percent": (20, 30, 40)},
    ),
    clarify(
        "clarify_whose_child_lock",
        Module.SYSTEM,
        (
            "{who} keeps playing with the handle. Child lock on, on her door.",
            "Lock the door beside {who} for children, just that one.",
            "Make sure {who} can't open her door from inside. Only hers.",
            "Child safety at {who}'s place, please, the other door as it is.",
            "{who}'s door gets the child lock.",
        ),
        Topic(
            "where {who} sits",
            SIDE,
            param("which", {side: f"She's on the {side}." for side in SIDES}),
            ("{who}", "side", "sit", "door"),
        ),
        "Does {who} sit on the left or on the right?",
        SignalIs(param("which", CHILD_LOCKS), (True,)),
        *DOORS,
        Tap("door.child_{which}"),
        untold=TWO_BEHIND,
        told=ONE_BEHIND,
        look=(),
        find=DOORS,
        difference="occupants: two children sit behind, or one",
        parameters={"which": SIDES, "who": FRIENDS},
    ),
    clarify(
        "clarify_whose_seat_behind",
        Module.HVAC,
        (
            "{who} back there is shivering. Heat her seat, {level}.",
            "Seat heating {level} for {who} behind me.",
            "Warm {who}'s seat on {level}; leave the one next to it.",
            "Put the heating in {who}'s seat, in the back, on {level}.",
            "Give {who} a warm seat: {level}, please.",
        ),
        Topic(
            "where {who} sits",
            SIDE,
            param("which", {side: f"She's on the {side}." for side in SIDES}),
            ("{who}", "side", "sit", "seat"),
        ),
        "Does {who} sit on the left or on the right?",
        SignalIs(param("which", REAR_HEATING), (param("level", {"low": 50.0, "high": 100.0}),)),
        *REAR,
        Tap("hvac.rear_{which}_seat_heating", times=param("level", {"low": 1, "high": 2})),
        untold=TWO_BEHIND,
        told=ONE_BEHIND,
        look=(),
        find=REAR,
        difference="occupants: two children sit behind, or one",
        parameters={"which": SIDES, "level": ("low", "high"), "who": FRIENDS},
    ),
    clarify(
        "clarify_sound_for_who_listens",
        Module.MEDIA,
        (
            "{who} wants to hear this in the back. Shift all the sound to her side.",
            "All the music over to {who}'s side, so that only she has it.",
            "Balance fully to where {who} is, behind.",
            "Move the sound across to {who}, all the way.",
            "Only {who} listens. Push the balance all the way over to her side of the car.",
        ),
        Topic(
            "where {who} sits",
            SIDE,
            param("which", {side: f"On the {side}." for side in SIDES}),
            ("{who}", "side", "sit"),
        ),
        "Which side is {who} on, left or right?",
        SignalIs(MEDIA.BALANCE, (param("which", {"left": -100.0, "right": 100.0}),)),
        Open("media"),
        Tap("media.sound"),
        Slide("sound.balance", param("which", {"left": -100.0, "right": 100.0}), -100.0, 100.0),
        untold=replace(TWO_BEHIND, signals={MEDIA.ACTION.path: "PLAY"}),
        told=replace(ONE_BEHIND, signals={MEDIA.ACTION.path: "PLAY"}),
        look=(),
        find=(Open("media"), Tap("media.sound")),
        difference="occupants: two children sit behind, or one",
        parameters={"which": SIDES, "who": FRIENDS},
    ),
    clarify(
        "clarify_mode_for_this_weather",
        Module.PHENOMENON,
        (
            "Mode for this weather, {how}: rain or snow.",
            "Set the drive mode to what's coming down, snow or rain, {how}.",
            "{how}: rain mode or snow mode, as it is.",
            "Drive mode to suit the weather, snow or rain. {how}.",
            "I need rain mode or snow mode now. Set the right one, {how}.",
        ),
        Topic(
            "what the weather is like",
            (("rain", "raining"), ("snow", "snowing")),
            param("which", {"rain": "Rain. It's pouring over the hill.", "snow": "Snow. It lies over the hill."}),
            ("weather", "mode"),
        ),
        "It's dry here. Is it for rain or for snow?",
        SignalIs(DRIVE.MODE, (param("which", MODES),)),
        Open("vehicle"),
        Tap("vehicle.tab.driving"),
        Tap("drive.mode.{which}"),
        untold=replace(PARIS, weather=Weather(1.0, 90.0, 0.0, 3, 100.0, 10_000.0, 10.0)),
        told=replace(
            PARIS,
            weather=param(
                "which",
                {
                    "rain": Weather(9.0, 92.0, 3.0, 63, 100.0, 6_000.0, 10.0),
                    "snow": Weather(-3.0, 92.0, 1.5, 73, 100.0, 3_000.0, 10.0),
                },
            ),
        ),
        look=(Open("outside"),),
        difference="weather: it is dry, or it rains or snows",
        parameters={"which": tuple(MODES), "how": ("please", "quickly", "before the bend", "right away")},
    ),
)
