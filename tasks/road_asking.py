"""Road, wishes that do not say enough: which helper, what gap, what speed, which mode."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.signals import ADAS, DRIVE
from automotive_cosim.tasking.checks import AllOf, SignalIs
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.moves import Open, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Dimension, Module
from automotive_cosim.tasks.forms import (
    ELSEWHERE,
    ON_THE_WAY,
    PARIS,
    only,
    read_out,
    unclear,
    wrote,
)
from automotive_cosim.tasks.road import ASSIST, CLOSE_SET, SLOW_SET, TAPS

LANE = {"lane_keeping": ADAS.LANE_KEEPING, "lane_departure": ADAS.LANE_DEPARTURE}
BEEPERS = {"blind_spot": ADAS.BLIND_SPOT, "parking_sensors": ADAS.PARKING_SENSORS}
MODES = {"economy": "ECONOMY", "sport": "SPORT"}

TASKS = (
    unclear(
        "road_ask_which_lane_helper",
        Module.ROAD,
        (
            "Switch that lane thing off.",
            "That lane assistant gets on my nerves, off with it.",
            "One of the lane assistants has to go, please.",
            "I don't need that lane gadget, the one that annoys me. Off.",
            "One of the lane helpers can stop now, just one.",
        ),
        Topic(
            "which lane assistant",
            (("keeping", "keep"), ("departure", "warning", "leaving")),
            param("which", {"lane_keeping": "Lane keeping.", "lane_departure": "The departure warning."}),
            ("lane", "which one"),
        ),
        "Which one, lane keeping or lane departure?",
        SignalIs(param("which", LANE), (False,)),
        *ASSIST,
        Tap("adas.{which}"),
        untold=PARIS,
        told=replace(PARIS, signals=only(LANE, True, False)),
        look=ASSIST,
        find=ASSIST,
        difference="settings: lane keeping and lane departure are both on, or only one of them",
        parameters={"which": tuple(LANE)},
        trigger=ON_THE_WAY,
        scenarios=ELSEWHERE,
    ),
    unclear(
        "road_ask_which_sensors",
        Module.ROAD,
        (
            "This beeping, blind spot or parking, one of them! Switch it off.",
            "Off with the one that cries wolf, parking or blind spot.",
            "The parking or the blind-spot sensors warn of every cyclist. Enough of those.",
            "Stop the sensors that beep all the time, for parking or for the blind spot.",
            "I don't want to be beeped at: blind spot or parking, off with the culprit.",
        ),
        Topic(
            "which sensors",
            (("blind spot", "blind"), ("parking",)),
            param("which", {"blind_spot": "Those for the blind spot.", "parking_sensors": "The parking sensors."}),
            ("sensors", "sensor", "beep", "beeping"),
        ),
        "Which sensors: blind spot or parking?",
        SignalIs(param("which", BEEPERS), (False,)),
        *ASSIST,
        Tap("adas.{which}"),
        untold=PARIS,
        told=replace(PARIS, signals=only(BEEPERS, True, False)),
        look=ASSIST,
        find=ASSIST,
        difference="settings: blind spot and parking sensors are both on, or only one of them",
        parameters={"which": tuple(BEEPERS)},
        trigger=ON_THE_WAY,
        scenarios=ELSEWHERE,
        dimension=Dimension.IMPLICIT_INTENT,
    ),
    unclear(
        "road_ask_which_gap",
        Module.ROAD,
        (
            "Set the gap of the cruise control to what {who} wants.",
            "My driving instructor {who} has a gap for my cruise control, set that.",
            "The time gap as {who} teaches it, two or three seconds.",
            "Cruise gap: three seconds or two, whatever {who} says.",
            "Set the cruise control's gap to the seconds that {who} insists on, please.",
        ),
        Topic(
            "which gap",
            (("2", "two", "2 0"), ("3", "three", "3 0")),
            "{which} seconds.",
            ("gap", "seconds", "distance", "instructor", "{who}"),
        ),
        "Which gap: two or three seconds?",
        SignalIs(ADAS.CRUISE_GAP, (param("which"),)),
        *ASSIST,
        Tap("adas.cruise_gap", times=param("which", TAPS)),
        untold=wrote(
            CLOSE_SET, ("{who}", "Well done yesterday! Two or three seconds, you know your gap. See you on Monday.")
        ),
        told=wrote(
            CLOSE_SET, ("{who}", "Well done yesterday! {which} seconds, that's your gap. See you on Monday.")
        ),
        look=read_out("{who}"),
        find=read_out("{who}"),
        difference="content: the instructor names two gaps, or the one",
        parameters={"which": (2.0, 3.0), "who": ("Ms Novak", "Mr Novak", "Ms Stern", "Mr Stern")},
    ),
    unclear(
        "road_ask_which_limit",
        Module.ROAD,
        (
            "Limiter on, at the speed that {who} can stand.",
            "{who} has a limit for us, 30 or 40. Set the limiter to it.",
            "Set the speed limiter for {who}, who can stand 40 or 30.",
            "We promised {who} not to go faster than what's bearable. Limiter, please.",
            "Put {who}'s speed into the limiter and switch it on.",
        ),
        Topic("which speed", (("30",), ("40",)), "{which}.", ("speed", "limit", "limiter", "{who}", "fast")),
        "Which speed did {who} say, 30 or 40?",
        AllOf((SignalIs(ADAS.LIMITER_ACTIVE, (True,)), SignalIs(ADAS.LIMITER_SPEED, (param("which"),)))),
        *ASSIST,
        TapUntil("adas.limiter_speed.increase", "adas.limiter_speed.value", "{which} km/h"),
        Tap("adas.limiter"),
        untold=wrote(SLOW_SET, ("{who}", "No faster than 30 or 40 once I'm in your car, as I told you!")),
        told=wrote(SLOW_SET, ("{who}", "No faster than {which} once I'm in your car, as I told you!")),
        look=read_out("{who}"),
        find=read_out("{who}"),
        difference="content: the passenger names two speeds, or the one",
        parameters={"which": (30, 40), "who": ("Grandma", "Grandpa", "Aunt Ida", "Uncle Leo")},
    ),
    unclear(
        "road_ask_which_mode",
        Module.ROAD,
        (
            "Put the car in the mode for the {team}'s drive, economy or sport.",
            "The {team} wants sport or economy mode, set that.",
            "Drive mode as the {team} wants it: sport, or economy.",
            "Economy or sport, whatever the {team} measures today.",
            "Use the mode that the {team} needs, sport or economy.",
        ),
        Topic(
            "which mode",
            (("economy", "eco"), ("sport", "sports")),
            param("which", {"economy": "Economy.", "sport": "Sport."}),
            ("mode", "{team}"),
        ),
        "Which mode, economy or sport?",
        SignalIs(DRIVE.MODE, (param("which", MODES),)),
        Open("vehicle"),
        Tap("vehicle.tab.driving"),
        Tap("drive.mode.{which}"),
        untold=wrote(PARIS, ("The {team}", "We're ready to measure. Good luck!")),
        told=wrote(PARIS, ("The {team}", "We're ready to measure the {which} mode. Good luck!")),
        look=read_out("The {team}"),
        difference="content: they are ready, or also says for which mode",
        parameters={"which": tuple(MODES), "team": ("test team", "measuring team", "magazine", "engineers")},
    ),
)
