"""Road: settings of speed, lane and distance assistants, requested explicitly."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.signals import ADAS, LIGHTS
from automotive_cosim.tasking.checks import AllOf, AnyOf, SignalIs, SignalRaised
from automotive_cosim.tasking.moves import Open, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Module, Task
from automotive_cosim.tasks.forms import PARIS, asked, hinted
from automotive_cosim.tasks.road_lamps import LAMP_TASKS
from automotive_cosim.tasks.road_law import LAW_TASKS
from automotive_cosim.tasks.road_signs import SIGN_TASKS
from automotive_cosim.tasks.road_traffic import TRAFFIC_TASKS

ASSIST = (Open("vehicle"), Tap("vehicle.tab.assistance"))
SLOW_SET = replace(PARIS, signals={ADAS.CRUISE_SPEED.path: 10.0, ADAS.LIMITER_SPEED.path: 20.0})
PLAIN_CRUISE = replace(PARIS, signals={ADAS.CRUISE_SPEED.path: 10.0, ADAS.CRUISE_ADAPTIVE.path: False})
UNHELPED = replace(
    PARIS,
    signals={ADAS.LANE_KEEPING.path: False, ADAS.LANE_DEPARTURE.path: False, ADAS.SPEED_WARNING.path: False},
)
CLOSE_SET = replace(PARIS, signals={ADAS.CRUISE_GAP.path: 1.0})
STEPS_KMH = (30, 35, 40, 45, 50, 55, 60)
CRUISE_KMH = (15, 20, 25, 30)
"""Speeds to hold: no more than is posted on the slowest streets."""
IN_TOWN = ("london", "new_york", "tokyo", "sydney", "grid")
"""Other scenarios in which so slow a cruise is not in the way."""
TAPS = {1.5: 1, 2.0: 2, 2.5: 3, 3.0: 4}
"""Taps on the gap's tile, which begins at one second, by desired seconds."""
SWITCHES = {
    "lane keeping": (ADAS.LANE_KEEPING, "adas.lane_keeping"),
    "lane departure": (ADAS.LANE_DEPARTURE, "adas.lane_departure"),
    "blind spot": (ADAS.BLIND_SPOT, "adas.blind_spot"),
    "parking sensor": (ADAS.PARKING_SENSORS, "adas.parking_sensors"),
}
HELPERS = {name: signal for name, (signal, _) in SWITCHES.items()}
TILES = {name: tile for name, (_, tile) in SWITCHES.items()}

GENERAL: tuple[Task, ...] = (
    asked(
        "road_cruise_at",
        Module.ROAD,
        (
            "Set cruise control to {speed} km/h.",
            "Cruise at {speed}, please.",
            "Hold {speed} for me so my foot can rest.",
            "Put the cruise on, {speed} will do.",
            "Let the car keep {speed} by itself.",
        ),
        AllOf((SignalIs(ADAS.CRUISE_ACTIVE, (True,)), SignalIs(ADAS.CRUISE_SPEED, (param("speed"),)))),
        *ASSIST,
        TapUntil("adas.cruise_speed.increase", "adas.cruise_speed.value", "{speed} km/h"),
        Tap("adas.cruise"),
        start=SLOW_SET,
        parameters={"speed": CRUISE_KMH},
        scenarios=IN_TOWN,
    ),
    asked(
        "road_limiter_at",
        Module.ROAD,
        (
            "Speed limiter at {speed}, switched on.",
            "Don't let me go over {speed} km/h.",
            "Cap it at {speed}, I keep the pedal.",
            "Limit me to {speed}.",
            "Make sure that I can't drive faster than {speed}.",
        ),
        AllOf((SignalIs(ADAS.LIMITER_ACTIVE, (True,)), SignalIs(ADAS.LIMITER_SPEED, (param("speed"),)))),
        *ASSIST,
        TapUntil("adas.limiter_speed.increase", "adas.limiter_speed.value", "{speed} km/h"),
        Tap("adas.limiter"),
        start=SLOW_SET,
        parameters={"speed": STEPS_KMH},
    ),
    asked(
        "road_gap_of",
        Module.ROAD,
        (
            "Set the cruise gap to {gap} seconds.",
            "Stay {gap} s off the one in front, please.",
            "I want the distance control at {gap} s.",
            "Following gap: {gap}.",
            "Have cruise stay {gap} seconds behind, as I always like it.",
        ),
        SignalIs(ADAS.CRUISE_GAP, (param("gap"),)),
        *ASSIST,
        Tap("adas.cruise_gap", times=param("gap", TAPS)),
        start=CLOSE_SET,
        parameters={"gap": tuple(TAPS)},
        tags=frozenset({"preference"}),
    ),
    asked(
        "road_adaptive_cruise",
        Module.ROAD,
        (
            "Adaptive cruise at {speed}, with {gap} seconds of room.",
            "Cruise on: {speed} km/h, follow the car ahead, gap {gap}.",
            "Let it drive {speed} on its own and stay {gap} s off whoever is before us.",
            "Do {speed} for me, adaptive, {gap} s to the next one.",
            "Switch adaptive on, then {gap} s gap, then hold {speed}.",
        ),
        AllOf(
            (
                SignalIs(ADAS.CRUISE_ACTIVE, (True,)),
                SignalIs(ADAS.CRUISE_ADAPTIVE, (True,)),
                SignalIs(ADAS.CRUISE_GAP, (param("gap"),)),
                SignalIs(ADAS.CRUISE_SPEED, (param("speed"),)),
            )
        ),
        *ASSIST,
        Tap("adas.cruise_adaptive"),
        Tap("adas.cruise_gap", times=param("gap", {2.5: 1, 3.0: 2})),
        TapUntil("adas.cruise_speed.increase", "adas.cruise_speed.value", "{speed} km/h"),
        Tap("adas.cruise"),
        start=PLAIN_CRUISE,
        parameters={"speed": CRUISE_KMH, "gap": (2.5, 3.0)},
        scenarios=IN_TOWN,
    ),
    asked(
        "road_helper_off",
        Module.ROAD,
        (
            "Turn the {helper} assistant off.",
            "No more {helper} help, please.",
            "Kill the {helper} thing, it beeps all day.",
            "I don't need the {helper} assistance on this drive.",
            "I never use the {helper} assistant, disable that.",
        ),
        SignalIs(param("helper", HELPERS), (False,)),
        *ASSIST,
        Tap(param("helper", TILES)),
        parameters={"helper": tuple(SWITCHES)},
    ),
    asked(
        "road_hazard_lights",
        Module.ROAD,
        (
            "Hazard lights on!",
            "Put on the four-way flashers.",
            "Start the warning blinkers, quickly.",
            "Flash both sides for those behind us.",
            "Hazards, now.",
        ),
        SignalIs(LIGHTS.HAZARD, (True,)),
        Open("safety"),
        Tap("safety.hazard_lights"),
        ways=((Open("vehicle"), Tap("lights.hazard")),),
    ),
    hinted(
        "road_wandering",
        Module.ROAD,
        (
            "I catch myself drifting over the white line.",
            "My steering is all over the place this morning.",
            "We just wandered towards the kerb again, didn't we?",
            "Somehow I can't hold her straight today.",
            "Oops, nearly over the line on the left. Something should watch the lane for me.",
        ),
        AnyOf((SignalIs(ADAS.LANE_KEEPING, (True,)), SignalIs(ADAS.LANE_DEPARTURE, (True,)))),
        *ASSIST,
        Tap("adas.lane_keeping"),
        ways=((*ASSIST, Tap("adas.lane_departure")),),
        start=UNHELPED,
    ),
    hinted(
        "road_heavy_foot",
        Module.ROAD,
        (
            "My foot is getting heavy, and I have two tickets already.",
            "Another fine this month and my wife will sell the car.",
            "I never notice when I creep up past what's allowed.",
            "They flashed me here last week; not again, please.",
            "It runs so quietly that I always end up too fast.",
        ),
        AnyOf((SignalIs(ADAS.SPEED_WARNING, (True,)), SignalIs(ADAS.LIMITER_ACTIVE, (True,)))),
        *ASSIST,
        Tap("adas.speed_warning"),
        ways=((*ASSIST, Tap("adas.limiter")),),
        start=UNHELPED,
    ),
    hinted(
        "road_too_near",
        Module.ROAD,
        (
            "When the car drives itself it sits on everyone's bumper; I hate that.",
            "Whenever it follows someone I could read the other one's phone. Bit more space, as I like it.",
            "I'm a nervous passenger of my own car, it crowds whoever is in front.",
            "Your automatic following makes me press an imaginary pedal.",
            "I prefer to hang back a good deal further than this thing does.",
        ),
        SignalRaised(ADAS.CRUISE_GAP, 0.5),
        *ASSIST,
        Tap("adas.cruise_gap"),
        ways=((*ASSIST, Tap("adas.cruise_gap", times=2)), (*ASSIST, Tap("adas.cruise_gap", times=4))),
        start=CLOSE_SET,
        tags=frozenset({"preference"}),
    ),
)

TASKS = (*GENERAL, *LAW_TASKS, *LAMP_TASKS, *SIGN_TASKS, *TRAFFIC_TASKS)
