"""Phenomenon: water, ice, wind, low sun and dust; place and sky decide what is right."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import company
from automotive_cosim.cockpit.signals import DRIVE, HVAC, LIGHTS, OUTSIDE
from automotive_cosim.contracts import AlertKind, Reason, Weather
from automotive_cosim.tasking.checks import AlertGiven, Check, SignalIs
from automotive_cosim.tasking.moves import Move, Open, Tap
from automotive_cosim.tasking.task import Basis, Deadline, Dimension, Half, Module, Start, Task
from automotive_cosim.tasking.triggers import (
    All,
    Driving,
    LessGripThan,
    Not,
    OnRoadClass,
    SignalAbove,
    SignalBelow,
    SpeedBetween,
    Trigger,
    TriggerCondition,
    Unposted,
)
from automotive_cosim.tasks.forms import decline
from automotive_cosim.tasks.phenomenon_light import FRANCE, GERMANY

RAIN = Weather(11.0, 95.0, 4.0, 63, 100.0, 4000.0, 20.0)
"""Steady rain, 4 mm/h."""
GLAZE = Weather(-1.0, 98.0, 1.5, 67, 100.0, 3000.0, 12.0)
"""Freezing rain."""
LAMPS_ON = {LIGHTS.SWITCH.path: "BEAM"}
"""Nobody drives through snow or a downpour without."""
PACKED_SNOW = Weather(-6.0, 92.0, 1.5, 73, 100.0, 1500.0, 14.0)
DOWNPOUR = Weather(9.0, 96.0, 9.0, 65, 100.0, 1500.0, 22.0)
CLEAR, OVERCAST = Weather(7.0, 60.0, 0.0, 0, 0.0, 30_000.0, 8.0), Weather(7.0, 75.0, 0.0, 3, 100.0, 30_000.0, 8.0)
GALE, CALM = Weather(17.0, 55.0, 0.0, 2, 40.0, 25_000.0, 84.0), Weather(17.0, 55.0, 0.0, 2, 40.0, 25_000.0, 9.0)
SANDSTORM = Weather(43.0, 18.0, 0.0, 31, 70.0, 400.0, 55.0)
HAZELESS = Weather(31.0, 60.0, 0.0, 0, 5.0, 20_000.0, 12.0)
ALREADY = (Reason.ALREADY_SO,)
FRICTION = (
    "road friction: black ice 0.15 to 0.30, packed snow 0.20 to 0.30, wet 0.7 to 0.8 (VTI meddelande 911A, 2001)"
)


def alert(kind: AlertKind) -> tuple[Move, ...]:
    """Moves through the safety centre to an alert of that kind."""
    return Open("safety"), Tap(f"safety.kind.{kind}"), Tap("safety.warn")


def _pair(
    task_id: str,
    dimension: Dimension,
    says: tuple[str, ...],
    first: Half,
    second: Half,
    difference: str,
    tags: frozenset[str] = frozenset(),
    **parameters: tuple[str, ...],
) -> Task:
    return Task(
        task_id, Module.PHENOMENON, dimension, says, first, second, difference, parameters=parameters, tags=tags
    )


def _warned(
    kind: AlertKind,
    start: Start,
    quiet: Start,
    trouble: TriggerCondition,
    calm: TriggerCondition,
    deadline: Deadline,
    source: str,
    ways: tuple[tuple[Move, ...], ...] = (),
    for_s: float = 3.0,
) -> tuple[Half, Half]:
    """Two halves: in one, the driver has to be warned; in the other, there is nothing to warn of."""
    trigger = Trigger(All((Driving(), trouble)), for_s=for_s, within_s=300.0)
    first = Half(start, trigger, AlertGiven(kind), alert(kind), deadline, Basis.PHYSICS, source, ways=ways)
    rest = Trigger(All((Driving(), calm)), for_s=for_s, within_s=300.0)
    return first, decline(quiet, rest, deadline, Basis.PHYSICS, source, reasons=ALREADY, needed=False)


def _set(
    start: Start, trouble: TriggerCondition, goal: Check, moves: tuple[Move, ...], deadline: Deadline, source: str
) -> Half:
    """A half in which a setting has to match the conditions outside."""
    trigger = Trigger(All((Driving(), trouble)), for_s=3.0, within_s=300.0)
    return Half(start, trigger, goal, moves, deadline, Basis.PHYSICS, source)


MOTORWAY_RAIN = Start(
    "autobahn",
    "south",
    FRANCE,
    start="2026-06-16T12:30:00",
    weather=RAIN,
    sign_camera=False,
)
BRISK = Trigger(
    All((SpeedBetween(114.0, 131.0), Unposted(), OnRoadClass(("motorway",)))), for_s=3.0, within_s=500.0
)
OVERTAKEN = Deadline(8.0, "at 115 km/h the car covers 256 m in 8 s; braking from there on a wet road takes 90 m")
SKID = Deadline(8.0, "at 50 km/h braking on black ice takes 65 m (v^2 / 2 mu g, mu 0.15): 8 s are 111 m")
ROAD_MODE = Deadline(
    10.0, "at 50 km/h the car covers 139 m in 10 s, further than the stopping distance on snow (39 m)"
)
BLINDED = Deadline(
    8.0, "at 80 km/h the car covers 178 m in 8 s against the sun: the next bend or pedestrian is nearer"
)
GUST = Deadline(10.0, "a gust lasts for some 10 s; in 10 s at 70 km/h the car meets the next gap in the trees")
LUNGS = Deadline(
    20.0, "the cabin's air takes the outside's dust within a minute: a third of that is a fair time to act"
)
DUST_SOURCE = "European Air Quality Index (EEA): PM2.5 above 90 ug/m3 is very poor; the flap shuts it out"
DAMP_SOURCE = (
    "air that only goes round gathers the breath of four people: ASHRAE Fundamentals, 60 g of vapour an hour"
)

TASKS = (
    _pair(
        "phenomenon_wet_motorway",
        Dimension.ENVIRONMENT_ALERTS,
        (
            "Am I over what's permitted {wet}? Warn me if so.",
            "Warn me if this speed is illegal {wet}.",
            "Too quick for the law {wet}? Then warn me.",
            "I never know whether there's another limit {wet}. Alert me if I'm past it.",
            "Check my speed against the rules {wet}, and warn me if it's wrong.",
        ),
        Half(
            MOTORWAY_RAIN,
            BRISK,
            AlertGiven(AlertKind.SPEED, 110.0),
            alert(AlertKind.SPEED),
            OVERTAKEN,
            Basis.LAW,
            "FR.limit.motorway.rain",
        ),
        decline(
            replace(MOTORWAY_RAIN, origin=GERMANY),
            BRISK,
            OVERTAKEN,
            Basis.LAW,
            "DE.limit.motorway",
            reasons=ALREADY,
            needed=False,
        ),
        "place: in rain France lowers motorways to 110 km/h, Germany has no limit there",
        frozenset({"place"}),
        wet=("in the rain", "in this wet", "on a wet motorway", "with the road this wet"),
    ),
    _pair(
        "phenomenon_drive_mode_by_road",
        Dimension.ENVIRONMENT_ALERTS,
        (
            "Put {car} in the mode that suits this surface.",
            "Set {car} up for what's on the ground.",
            "Which driving mode for a day like this? Choose it for {car}.",
            "The road has changed, adapt {car} to it.",
            "Choose the driving mode so that {car} holds this road.",
        ),
        _set(
            Start("alpine_pass", "villages", weather=PACKED_SNOW, signals=LAMPS_ON),
            LessGripThan(0.4),
            SignalIs(DRIVE.MODE, ("SNOW",)),
            (Open("vehicle"), Tap("vehicle.tab.driving"), Tap("drive.mode.snow")),
            ROAD_MODE,
            FRICTION,
        ),
        _set(
            Start("alpine_pass", "villages", weather=DOWNPOUR, signals=LAMPS_ON),
            All((LessGripThan(0.8), Not(LessGripThan(0.5)))),
            SignalIs(DRIVE.MODE, ("RAIN",)),
            (Open("vehicle"), Tap("vehicle.tab.driving"), Tap("drive.mode.rain")),
            ROAD_MODE,
            FRICTION,
        ),
        "weather: packed snow, or a wet road in heavy rain",
        car=("the car", "her", "my car", "the old girl"),
    ),
    _pair(
        "phenomenon_slippery",
        Dimension.ENVIRONMENT_ALERTS,
        (
            "Alert me if {road} has turned into an ice rink.",
            "Does {road} still hold? Warn me if it doesn't.",
            "Check the grip on {road}, and alert me if it's gone.",
            "Warn me at once if {road} has become treacherous.",
            "It feels odd. Has {road} iced over? Sound the alarm if so.",
        ),
        *_warned(
            AlertKind.SLIPPERY,
            Start("nordic", "town", start="2026-03-17T12:00:00", weather=GLAZE),
            Start("nordic", "town", start="2026-03-17T12:00:00", weather=replace(RAIN, temperature_2m=6.0)),
            LessGripThan(0.2),
            All((LessGripThan(0.8), Not(LessGripThan(0.5)))),
            SKID,
            FRICTION,
            ways=((Open("outside"), Tap("outside.ice"), Tap("outside.warn")),),
        ),
        "weather: freezing rain, or plain rain at 6 degrees",
        road=("the road", "the surface", "the tarmac", "this street"),
    ),
    _pair(
        "phenomenon_bad_air",
        Dimension.ENVIRONMENT_ALERTS,
        (
            "What {we} breathe in here is foul: outside air or recirculated, set it right.",
            "The air's awful for {us}: outside or inside, take the better one.",
            "Choose where our air comes from, {we} feel rotten.",
            "Fresh or circulating, whichever is healthier for {us} right now.",
            "Something's wrong with the air. Switch between fresh and recirculated, if that helps {us}.",
        ),
        _set(
            Start(
                "gulf",
                "desert",
                weather=SANDSTORM,
                aboard=company(4),
                cabin={"temperature_c": 24.0, "humidity_pct": 45.0},
                signals={HVAC.AIR_CONDITIONING.path: True},
            ),
            SignalAbove(HVAC.CABIN_FINE_DUST, 90.0),
            SignalIs(HVAC.RECIRCULATION, (True,)),
            (Open("climate"), Tap("hvac.recirculation")),
            LUNGS,
            DUST_SOURCE,
        ),
        decline(
            Start(
                "gulf",
                "desert",
                weather=HAZELESS,
                aboard=company(4),
                cabin={"wet_clothes": True, "temperature_c": 24.0, "humidity_pct": 75.0},
                signals={HVAC.AIR_CONDITIONING.path: True},
            ),
            Trigger(All((Driving(), SignalBelow(HVAC.CABIN_FINE_DUST, 25.0))), for_s=3.0, within_s=300.0),
            LUNGS,
            Basis.PHYSICS,
            DAMP_SOURCE,
            reasons=ALREADY,
            needed=False,
        ),
        "weather: a sandstorm comes in from outside, or clean air does and carries off the breath of four people",
        frozenset({"conflict"}),
        we=("we", "the kids", "the four of us", "all of us"),
        us=("us", "the passengers", "everyone", "my lot"),
    ),
    _pair(
        "phenomenon_low_sun",
        Dimension.ENVIRONMENT_ALERTS,
        (
            "Will {sun} blind me? Give a warning if it does.",
            "Does {sun} ahead dazzle? Warn me if it does.",
            "I'm sensitive to {sun}: alert me if it gets in my eyes.",
            "Anything up front like {sun} that robs my sight? Warn me.",
            "Warn me if {sun} is a problem just now.",
        ),
        *_warned(
            AlertKind.VISIBILITY,
            Start("beauce", "plain", start="2026-11-17T08:50:00", weather=CLEAR),
            Start("beauce", "plain", start="2026-11-17T08:50:00", weather=OVERCAST),
            SignalAbove(OUTSIDE.GLARE, 40.0),
            SignalBelow(OUTSIDE.GLARE, 5.0),
            BLINDED,
            "a sun below 25 degrees straight ahead veils what is in front of it (disability glare, CIE 146:2002)",
            ways=((Open("outside"), Tap("outside.glare"), Tap("outside.warn")),),
        ),
        "weather: a clear sky with the sun low ahead, or an overcast one at the same hour",
        sun=("the sun", "that low sun", "the morning sun", "sunlight"),
    ),
    _pair(
        "phenomenon_gale",
        Dimension.ENVIRONMENT_ALERTS,
        (
            "Warn me if {wind} has become dangerous.",
            "Is {wind} strong enough to shove us about? An alert then, please.",
            "Check {wind} for me and sound off if it's above gale force.",
            "If {wind} isn't harmless, I want an alarm.",
            "It's a light car, so warn me about {wind} if it matters here.",
        ),
        *_warned(
            AlertKind.WEATHER,
            Start("sydney", "putty_road", weather=GALE),
            Start("sydney", "putty_road", weather=CALM),
            SignalAbove(OUTSIDE.WIND, 75.0),
            SignalBelow(OUTSIDE.WIND, 20.0),
            GUST,
            "strong gale, Beaufort 9, from 75 km/h (WMO-No. 8); the German weather service warns from 65 km/h",
            ways=((Open("outside"), Tap("outside.wind"), Tap("outside.warn")),),
        ),
        "weather: a strong gale, or next to no wind",
        wind=("the wind", "this wind", "the crosswind", "the wind out here"),
    ),
)
