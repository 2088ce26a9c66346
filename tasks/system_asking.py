"""System, wishes that do not say enough: whose window, which lamp, profile, network, language."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.signals import CABIN, HMI, LINK
from automotive_cosim.tasking.checks import AllOf, AppDataIs, SeatRecalled, SignalIs
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.moves import Open, Slide, Tap
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Dimension, Module
from automotive_cosim.tasks.forms import (
    AT_THE_KERB,
    ELSEWHERE,
    FRIENDS,
    ON_THE_WAY,
    PARIS,
    PARKED_WHEN_WRITTEN,
    only,
    read_out,
    unclear,
    wrote,
)
from automotive_cosim.tasks.system import CONNECTIONS, DOORS, INSIDE, LANGUAGES, SEATS

FRONT_WINDOWS = {"driver": CABIN.DRIVER_WINDOW, "passenger": CABIN.PASSENGER_WINDOW}
READING_LIGHTS = {"driver": CABIN.DRIVER_READING_LIGHT, "passenger": CABIN.PASSENGER_READING_LIGHT}
DRIVER = ("driver", "driver's", "my", "mine", "your", "yours")
PASSENGER = ("passenger", "passenger's")
CHILD_LOCKS = {"left": CABIN.LEFT_CHILD_LOCK, "right": CABIN.RIGHT_CHILD_LOCK}

TASKS = (
    unclear(
        "system_ask_which_window",
        Module.SYSTEM,
        (
            "Close that window, there's a draught.",
            "Shut the window. Just the one, I need some air.",
            "One window up, please, it howls.",
            "The window that's open in front, close it.",
            "Put that window up, I can't hear myself think.",
        ),
        Topic(
            "which window",
            (DRIVER, PASSENGER),
            param("which", {"driver": "Mine.", "passenger": "The passenger's."}),
            ("window", "which", "side"),
        ),
        "Which window, the driver's or the passenger's?",
        SignalIs(param("which", FRONT_WINDOWS), (0.0,)),
        *DOORS,
        Slide("window.{which}", 0.0),
        untold=replace(PARIS, signals={window.path: param("level") for window in FRONT_WINDOWS.values()}),
        told=replace(PARIS, signals=only(FRONT_WINDOWS, 40.0, 0.0)),
        look=DOORS,
        difference="settings: both front windows are open, or only one of them",
        parameters={"which": tuple(FRONT_WINDOWS), "level": (30.0, 40.0, 50.0)},
        trigger=ON_THE_WAY,
    ),
    unclear(
        "system_ask_which_reading_light",
        Module.SYSTEM,
        (
            "Switch off just the one reading light.",
            "That reading lamp can go out now.",
            "One of the reading lights out, please.",
            "Nobody reads on that seat any more; that lamp off.",
            "One of the little spots over the seats isn't needed now.",
        ),
        Topic(
            "which reading light",
            (DRIVER, PASSENGER),
            param("which", {"driver": "The driver's.", "passenger": "The passenger's."}),
            ("light", "lamp", "which"),
        ),
        "Whose reading light, the driver's or the passenger's?",
        SignalIs(param("which", READING_LIGHTS), (False,)),
        *INSIDE,
        Tap("light.{which}_reading"),
        untold=replace(PARIS, signals={light.path: True for light in READING_LIGHTS.values()}),
        told=replace(PARIS, signals=only(READING_LIGHTS, True, False)),
        look=INSIDE,
        difference="settings: both reading lights are lit, or only one of them",
        parameters={"which": tuple(READING_LIGHTS)},
        trigger=ON_THE_WAY,
        scenarios=ELSEWHERE,
    ),
    unclear(
        "system_ask_which_seat_memory",
        Module.SYSTEM,
        (
            "Put my seat as I like it; {who} has stored hers over one of my two positions.",
            "Recall my seat, 1 or 2, {who} has taken the other.",
            "{who} sat here. Back to my own position, the one that's left of 1 and 2.",
            "My seat memory, please, not {who}'s.",
            "Seat and mirrors for me, 1 or 2; {who} has overwritten one.",
        ),
        Topic(
            "which seat memory",
            (("1", "one", "first"), ("2", "two", "second")),
            param("which", {1: "Mine is number 1.", 2: "Mine is number 2."}),
            ("seat", "memory", "position", "{who}"),
        ),
        "Which seat position is yours, 1 or 2?",
        SeatRecalled(param("which")),
        *SEATS,
        Tap("seat.memory.{which}"),
        untold=wrote(AT_THE_KERB, ("{who}", "Thanks for the car! I've stored my seat.")),
        told=wrote(
            AT_THE_KERB,
            (
                "{who}",
                param("which", {1: "Thanks for the car! My seat is on 2 now.", 2: "Thanks! My seat is on 1 now."}),
            ),
        ),
        look=read_out("{who}"),
        difference="content: she writes that she has stored her seat, or also where",
        parameters={"which": (1, 2), "who": FRIENDS},
        trigger=PARKED_WHEN_WRITTEN,
        dimension=Dimension.IMPLICIT_INTENT,
    ),
    unclear(
        "system_ask_which_profile",
        Module.SYSTEM,
        (
            "Load the profile that {who} wants me to use.",
            "{who} lends me the car. Switch to the profile I may have, Driver 2 or Guest.",
            "Change to Driver 2 or Guest, as {who} has it.",
            "The right profile, please. {who} knows which.",
            "It's {who}'s car, so use the profile she lets me have.",
        ),
        Topic(
            "which profile",
            (("driver 2", "driver two", "2"), ("guest",)),
            "{which}.",
            ("profile", "{who}"),
        ),
        "Which profile: Driver 2 or Guest?",
        AppDataIs("driver.profile", ("{which}",)),
        Open("settings"),
        Tap("settings.page.profiles"),
        Tap(text="{which}"),
        untold=wrote(AT_THE_KERB, ("{who}", "Have fun with my car, and use the profile I told you!")),
        told=wrote(AT_THE_KERB, ("{who}", "Have fun with my car, and use the profile {which}!")),
        look=read_out("{who}"),
        find=(Open("settings"), Tap("settings.page.profiles")),
        difference="content: the owner reminds of the profile, or names it",
        parameters={"which": ("Driver 2", "Guest"), "who": FRIENDS},
        trigger=PARKED_WHEN_WRITTEN,
    ),
    unclear(
        "system_ask_which_network",
        Module.SYSTEM,
        (
            "Join the Wi-Fi of this place, {who} knows its name, and no mobile data.",
            "Wi-Fi on, into {who}'s network; mobile data off.",
            "{who} lets us use her wireless. Get us in, it's Garage or Coffee-Guest, and save my mobile data.",
            "Connect to Garage or Coffee-Guest, whichever is {who}'s, instead of mobile data.",
            "Onto {who}'s Wi-Fi, please, and mobile data off.",
        ),
        Topic(
            "which network",
            (("garage",), ("coffee guest", "coffee")),
            param("which", {"Garage": "Garage.", "Coffee-Guest": "Coffee-Guest."}),
            ("network", "wi fi", "wifi", "{who}"),
        ),
        "Which network is {who}'s: Garage or Coffee-Guest?",
        AllOf(
            (
                SignalIs(LINK.WIFI, (True,)),
                AppDataIs("wifi.network", ("{which}",)),
                SignalIs(LINK.MOBILE_DATA, (False,)),
            )
        ),
        *CONNECTIONS,
        Tap("link.wifi"),
        Tap(text="{which}"),
        Tap("link.mobile"),
        untold=wrote(
            AT_THE_KERB, ("{who}", "You're welcome to use my Wi-Fi, Garage or Coffee-Guest, as I told you.")
        ),
        told=wrote(AT_THE_KERB, ("{who}", "You're welcome to use my Wi-Fi, {which}, as I told you.")),
        look=read_out("{who}"),
        find=read_out("{who}"),
        difference="content: the host names two networks, or hers",
        parameters={"which": ("Garage", "Coffee-Guest"), "who": FRIENDS},
        trigger=PARKED_WHEN_WRITTEN,
    ),
    unclear(
        "system_ask_which_language",
        Module.SYSTEM,
        (
            "The front desk sends us a {guest}. Screen in his language: French, German or Japanese.",
            "Put the display into what the {guest} from the front desk speaks, French, German or Japanese.",
            "Our {guest} gets in now. German, French or Japanese, the front desk knows.",
            "Japanese, French or German screens, please, for the {guest} whom the front desk announced.",
            "Make our {guest} feel at home: his language on the screen, German, French or Japanese.",
        ),
        Topic(
            "which language",
            (("french",), ("german",), ("japanese",)),
            "He speaks {which}.",
            ("language", "{guest}"),
        ),
        "Which language does he speak: French, German or Japanese?",
        SignalIs(HMI.LANGUAGE, (param("which", LANGUAGES),)),
        Open("settings"),
        Tap("settings.page.language"),
        Tap(param("which", {name: f"language.{code}" for name, code in LANGUAGES.items()})),
        untold=wrote(PARIS, ("Front desk", "Your {guest} is on the way down.")),
        told=wrote(PARIS, ("Front desk", "Your {guest} is on the way down. He speaks only {which}.")),
        look=read_out("Front desk"),
        difference="content: the front desk announces the guest, or also says what he speaks",
        parameters={"which": tuple(LANGUAGES), "guest": ("guest", "visitor", "client", "customer")},
        dimension=Dimension.IMPLICIT_INTENT,
    ),
    unclear(
        "system_ask_which_child_lock",
        Module.SYSTEM,
        (
            "We fetch {who} and Granny. Child lock on at the door where {who} is going to sit.",
            "{who} plays with door handles: lock hers for children before she and Granny get in.",
            "The child safety for the door on {who}'s side; Granny will have the other.",
            "Make sure that {who} can't get out once she sits next to Granny.",
            "Granny's door will be fine, but {who}'s needs the child lock when they get in.",
        ),
        Topic(
            "where {who} sits",
            (("left",), ("right",)),
            param("which", {"left": "On the left.", "right": "On the right."}),
            ("{who}", "side", "sit", "door"),
        ),
        "Will {who} sit on the left or on the right?",
        SignalIs(param("which", CHILD_LOCKS), (True,)),
        *DOORS,
        Tap("door.child_{which}"),
        untold=wrote(PARIS, ("Granny", "We're waiting outside, {who} and I with all the luggage!")),
        told=wrote(
            PARIS,
            (
                "Granny",
                param(
                    "which",
                    {
                        "left": "We're waiting outside! {who} wants the left door, so I get the right one.",
                        "right": "We're waiting outside! {who} wants the right door, so I get the left one.",
                    },
                ),
            ),
        ),
        look=read_out("Granny"),
        find=DOORS,
        difference="content: Granny writes that they are waiting, or also where the child will sit",
        parameters={"which": tuple(CHILD_LOCKS), "who": FRIENDS},
    ),
)
