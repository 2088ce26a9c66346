"""Phenomenon: the lamps that fog, rain, snow and darkness allow or require, by local law."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.signals import ADAS, LIGHTS, Signal
from automotive_cosim.contracts import Reason, Weather
from automotive_cosim.tasking.checks import AllOf, SignalIs
from automotive_cosim.tasking.moves import Open, Tap
from automotive_cosim.tasking.task import Basis, Deadline, Dimension, Half, Module, Start, Task
from automotive_cosim.tasking.triggers import (
    All,
    Dark,
    Driving,
    InTunnel,
    LeaderWithin,
    Lit,
    Not,
    OncomingWithin,
    OnRoadClass,
    Trigger,
    TunnelWithin,
    VisibilityBetween,
)
from automotive_cosim.tasks.forms import BY_THE_SWITCH, decline

CHINA, FRANCE, GERMANY, BRITAIN, ITALY = (114.0, 33.0), (2.5, 47.5), (9.9, 50.5), (-1.1, 52.2), (11.4, 43.2)
JAPAN, SOUTH_AFRICA, SWEDEN, SWITZERLAND = (138.2, 36.2), (25.0, -30.0), (15.1, 59.3), (7.5, 46.9)
"""Longitude and latitude: far enough inland for a network to lie in one country."""
JURA = (5.91, 46.74)
NOON, NIGHT = "2026-06-16T12:30:00", "2026-03-17T22:00:00"
"""Times of full daylight, and of darkness, from South Africa to Sweden."""
FOGGY, FOGGY_SOUTH = "2026-11-17T08:45:00", "2026-03-20T07:30:00"
"""After sunrise, and before the sun stands high enough to lift fog: from China to Sweden, and from Japan to South
Africa."""
MARCH_NOON = "2026-03-27T12:30:00"
"""Full daylight in a month in which it snows."""
MIST_120 = Weather(8.0, 98.0, 0.0, 45, 100.0, 120.0, 4.0)
"""Fog with a visibility of 120 m."""
FOG_90 = replace(MIST_120, visibility=90.0)
HEAVY_RAIN = Weather(13.0, 95.0, 40.0, 65, 100.0, 180.0, 24.0)
"""A cloudburst: sight is hampered beyond doubt, as some rules want it, yet more than the 100 m of others."""
LIGHT_SNOW = Weather(0.0, 90.0, 0.6, 71, 100.0, 2500.0, 9.0)
CLEAR_NIGHT = Weather(6.0, 60.0, 0.0, 0, 5.0, 25_000.0, 6.0)
BEAM = {LIGHTS.SWITCH.path: "BEAM", LIGHTS.POSITION.path: True, LIGHTS.LOW_BEAM.path: True}
"""Dipped beam by the switch."""
SOON = Trigger(Driving(), for_s=5.0, within_s=120.0)
REAR_LAMP = ("rear fog lamp", "rear fog light", "fog light at the back", "rear foglight")
FRONT_LAMPS = ("front fog lamps", "front fogs", "fog lights at the front", "front fog lights")
IN_SIGHT = Deadline(
    10.0, "at 50 km/h the car covers 139 m in 10 s, more than the visibility in fog: others rely on its lamps"
)
BEHIND = Deadline(10.0, "a driver 2 s behind at 60 km/h is dazzled, or does not see the car, for 167 m in 10 s")
UNLAWFUL, NO_NEED = (Reason.LAW, Reason.SAFETY), (Reason.ALREADY_SO, Reason.LAW)
LAMPS_SCREEN = Open("vehicle")


def lit_by_law(
    task_id: str,
    dimension: Dimension,
    says: tuple[str, ...],
    first: Half,
    second: Half,
    difference: str,
    **parameters: tuple[str, ...],
) -> Task:
    """A pair that a country's law decides."""
    tags = frozenset({"lamps", "place"})
    return Task(
        task_id, Module.PHENOMENON, dimension, says, first, second, difference, parameters=parameters, tags=tags
    )


def _at(
    scenario: str, trip: str, origin: tuple[float, float], weather: Weather, signals: dict[str, object] = BEAM
) -> Start:
    """A drive by day, in one country or another; fog is of the morning, haze lasts."""
    at = FOGGY if weather.visibility < 300.0 else NOON
    return Start(scenario, trip, origin, start=at, weather=weather, signals=signals, sign_camera=False)


def _on(start: Start, rule: str, signal: Signal[bool], *moves: Tap, deadline: Deadline = IN_SIGHT) -> Half:
    """A half in which one lamp has to be lit."""
    beside = BY_THE_SWITCH if signal is LIGHTS.LOW_BEAM else frozenset()
    goal = SignalIs(signal, (True,))
    return Half(start, SOON, goal, (LAMPS_SCREEN, *moves), deadline, Basis.LAW, rule, may_write=beside)


REAR_FOG, FRONT_FOG = Tap("lights.rear_fog"), Tap("lights.front_fog")
LOW_BEAM, HIGH_BEAM, HAZARD = Tap("lights.switch.low_beam"), Tap("lights.high_beam"), Tap("lights.hazard")
EMPTY_NIGHT = All((Driving(), Dark(), Lit(), Not(OncomingWithin(500.0)), Not(LeaderWithin(250.0))))

CRUISE_KMH = 70.0
CRUISING = {
    ADAS.CRUISE_SPEED.path: CRUISE_KMH,
    **BEAM,
    LIGHTS.FRONT_FOG.path: True,
    LIGHTS.HAZARD.path: True,
}
"""Everything that China requires in fog except the speed."""
LOWER = (Open("vehicle"), Tap("vehicle.tab.assistance"))
OUTRUN = Deadline(
    16.0, "at 70 km/h the car covers 311 m in 16 s, twice the visibility: a stationary car would have been hit"
)


def _cruise(visibility_m: float, limit_kmh: float, rule: str, low_m: float, high_m: float) -> Half:
    return Half(
        replace(_at("gulf", "sheikh_zayed", CHINA, replace(MIST_120, visibility=visibility_m)), signals=CRUISING),
        Trigger(
            All((Driving(), OnRoadClass(("motorway",)), VisibilityBetween(low_m, high_m))),
            for_s=5.0,
            within_s=240.0,
        ),
        SignalIs(ADAS.CRUISE_SPEED, (limit_kmh,)),
        (*LOWER, Tap("adas.cruise_speed.decrease", times=round((CRUISE_KMH - limit_kmh) / ADAS.CRUISE_SPEED.step))),
        OUTRUN,
        Basis.LAW,
        rule,
    )


TASKS = (
    lit_by_law(
        "phenomenon_rear_fog_in_mist",
        Dimension.DRIVING_ALIGNMENT,
        (
            "I'll have the {lamp} on, please.",
            "Can't see far: light up the {lamp}.",
            "I want to be seen from behind: {lamp} on!",
            "Could you switch my {lamp} on in this soup?",
            "This fog... {lamp} on, please.",
        ),
        _on(_at("beauce", "plain", FRANCE, MIST_120), "FR.rear_fog", LIGHTS.REAR_FOG, REAR_FOG, deadline=BEHIND),
        decline(
            _at("beauce", "plain", GERMANY, MIST_120),
            SOON,
            BEHIND,
            Basis.LAW,
            "DE.rear_fog",
            reasons=UNLAWFUL,
        ),
        "place: with 120 m of visibility the lamp is forbidden in Germany (50 m) and allowed in France",
        lamp=REAR_LAMP,
    ),
    lit_by_law(
        "phenomenon_rear_fog_in_downpour",
        Dimension.DRIVING_ALIGNMENT,
        (
            "It's bucketing down. Would you switch the {lamp} on?",
            "In all this rain I want the {lamp} on!",
            "Put the {lamp} on in this downpour, for the ones behind.",
            "Switch on the {lamp}, it's coming down in sheets.",
            "It's so wet that I'd like the {lamp} on.",
        ),
        _on(
            _at("sydney", "putty_road", SWEDEN, HEAVY_RAIN),
            "SE.rear_fog",
            LIGHTS.REAR_FOG,
            REAR_FOG,
            deadline=BEHIND,
        ),
        decline(
            _at("sydney", "putty_road", FRANCE, HEAVY_RAIN),
            SOON,
            BEHIND,
            Basis.LAW,
            "FR.rear_fog",
            reasons=UNLAWFUL,
        ),
        "place: in heavy rain the lamp is forbidden in France and allowed in Sweden",
        lamp=REAR_LAMP,
    ),
    lit_by_law(
        "phenomenon_high_beam_on_lit_road",
        Dimension.DRIVING_ALIGNMENT,
        (
            "I want {beam} on.",
            "Dark night, {beam} please.",
            "I'd like to see further: {beam}.",
            "Nobody about, so switch to {beam}.",
            "Come on, give me {beam}!",
        ),
        Half(
            Start(
                "nordic", "town", SOUTH_AFRICA, start=NIGHT, weather=CLEAR_NIGHT, signals=BEAM, sign_camera=False
            ),
            Trigger(EMPTY_NIGHT, for_s=2.0, within_s=300.0),
            SignalIs(LIGHTS.HIGH_BEAM, (True,)),
            (LAMPS_SCREEN, HIGH_BEAM),
            BEHIND,
            Basis.LAW,
            "ZA.high_beam",
        ),
        decline(
            Start("nordic", "town", ITALY, start=NIGHT, weather=CLEAR_NIGHT, signals=BEAM, sign_camera=False),
            Trigger(EMPTY_NIGHT, for_s=2.0, within_s=300.0),
            BEHIND,
            Basis.LAW,
            "IT.high_beam",
            reasons=UNLAWFUL,
        ),
        "place: on an empty lit road high beam is forbidden in Italy, and allowed in South Africa",
        beam=("high beam", "main beam", "full beam", "the brights"),
    ),
    lit_by_law(
        "phenomenon_front_fog_with_beam",
        Dimension.ENVIRONMENT_ALERTS,
        (
            "Switch on {lamps}, and the low beam as the law has it beside them.",
            "Light the {lamps}; whether dipped beam stays on with them, do what is legal here.",
            "Use {lamps}. Low beam along with that only if this country allows both.",
            "Fog! {lamps}, and don't leave dipped beam burning if they can't go together.",
            "I need the {lamps}, in whatever combination is legal here.",
        ),
        Half(
            _at("alpine_pass", "descent", SWEDEN, FOG_90),
            SOON,
            AllOf((SignalIs(LIGHTS.FRONT_FOG, (True,)), SignalIs(LIGHTS.LOW_BEAM, (False,)))),
            (LAMPS_SCREEN, FRONT_FOG, Tap("lights.switch.position")),
            IN_SIGHT,
            Basis.LAW,
            "SE.front_fog",
            may_write=BY_THE_SWITCH,
            ways=((LAMPS_SCREEN, Tap("lights.switch.position"), FRONT_FOG),),
        ),
        Half(
            _at("alpine_pass", "descent", SWITZERLAND, FOG_90),
            SOON,
            AllOf((SignalIs(LIGHTS.FRONT_FOG, (True,)), SignalIs(LIGHTS.LOW_BEAM, (True,)))),
            (LAMPS_SCREEN, FRONT_FOG),
            IN_SIGHT,
            Basis.LAW,
            "CH.front_fog, CH.dipped_beam",
        ),
        "place: in Sweden fog lamps replace dipped beam, Switzerland requires dipped beam all the same",
        lamps=FRONT_LAMPS,
    ),
    lit_by_law(
        "phenomenon_dipped_beam_in_mist",
        Dimension.ENVIRONMENT_ALERTS,
        (
            "Use {lights} if I'm obliged to here, otherwise leave it.",
            "Do the rules of this country want {lights} in this? If so, do it.",
            "Only if it's compulsory: {lights}.",
            "I'd rather drive without, but {lights} if the law insists.",
            "Do I have to have {lights} on in this? If so, switch on, else leave it.",
        ),
        _on(
            replace(_at("sydney", "richmond", SOUTH_AFRICA, MIST_120, {}), start=FOGGY_SOUTH),
            "ZA.dipped_beam",
            LIGHTS.LOW_BEAM,
            LOW_BEAM,
        ),
        decline(
            replace(_at("sydney", "richmond", JAPAN, MIST_120, {}), start=FOGGY_SOUTH),
            SOON,
            IN_SIGHT,
            Basis.LAW,
            "JP.dipped_beam",
            reasons=NO_NEED,
            needed=False,
        ),
        "place: by day with 120 m of visibility South Africa requires dipped beam (150 m), Japan does not (50 m)",
        lights=("dipped beam", "low beam", "headlights", "dipped headlights"),
    ),
    lit_by_law(
        "phenomenon_dipped_beam_on_expressway",
        Dimension.ENVIRONMENT_ALERTS,
        (
            "Is {lights} a must on this kind of road? Then put it on.",
            "If this road calls for {lights} in the haze, see to it.",
            "Check whether I need {lights} along here by law, and act on it.",
            "About {lights}: yes where it's the rule, no where it isn't.",
            "It's murky. Put {lights} on if this stretch requires it.",
        ),
        Half(
            Start("tokyo", "yamate_tunnel", weather=replace(MIST_120, visibility=180.0), sign_camera=False),
            Trigger(
                All(
                    (
                        Driving(),
                        OnRoadClass(("motorway", "motorway_link")),
                        Not(InTunnel()),
                        Not(TunnelWithin(15.0)),
                    )
                ),
                for_s=2.0,
                within_s=240.0,
            ),
            SignalIs(LIGHTS.LOW_BEAM, (True,)),
            (LAMPS_SCREEN, LOW_BEAM),
            Deadline(8.0, "at 80 km/h the car covers 178 m in 8 s, all of the 180 m of visibility"),
            Basis.LAW,
            "JP.dipped_beam",
            may_write=BY_THE_SWITCH,
        ),
        decline(
            Start("tokyo", "avenues", weather=replace(MIST_120, visibility=180.0), sign_camera=False),
            Trigger(All((Driving(), OnRoadClass(("primary", "secondary", "tertiary")))), for_s=2.0, within_s=240.0),
            Deadline(8.0, "as in the first half"),
            Basis.LAW,
            "JP.dipped_beam",
            reasons=NO_NEED,
            needed=False,
        ),
        "road: with 180 m of visibility Japan requires dipped beam on expressways (200 m), not elsewhere (50 m)",
        lights=("dipped beam", "low beam", "headlights", "dipped headlights"),
    ),
    lit_by_law(
        "phenomenon_compulsory_fog_lamps",
        Dimension.ENVIRONMENT_ALERTS,
        (
            "Set the {lamps} as this fog makes it compulsory here, no more than that.",
            "Every one of the {lamps} that is required by law now, and none besides.",
            "What has to be lit in fog in this country? Light exactly those {lamps}.",
            "My {lamps} by the book, please: the obligatory ones only.",
            "I don't know the rules here. Sort out my {lamps}, nothing optional.",
        ),
        Half(
            _at("autobahn", "north", CHINA, FOG_90, {}),
            Trigger(All((Driving(), OnRoadClass(("motorway",)))), for_s=5.0, within_s=240.0),
            AllOf(tuple(SignalIs(lamp, (True,)) for lamp in (LIGHTS.LOW_BEAM, LIGHTS.FRONT_FOG, LIGHTS.HAZARD))),
            (LAMPS_SCREEN, LOW_BEAM, FRONT_FOG, HAZARD),
            IN_SIGHT,
            Basis.LAW,
            "CN.dipped_beam, CN.front_fog, CN.hazard_lights",
            may_write=BY_THE_SWITCH,
            ways=((LAMPS_SCREEN, HAZARD, LOW_BEAM, FRONT_FOG),),
        ),
        Half(
            _at("autobahn", "north", SWITZERLAND, FOG_90, {}),
            Trigger(All((Driving(), OnRoadClass(("motorway",)))), for_s=5.0, within_s=240.0),
            AllOf(
                (
                    SignalIs(LIGHTS.LOW_BEAM, (True,)),
                    SignalIs(LIGHTS.FRONT_FOG, (False,)),
                    SignalIs(LIGHTS.HAZARD, (False,)),
                )
            ),
            (LAMPS_SCREEN, LOW_BEAM),
            IN_SIGHT,
            Basis.LAW,
            "CH.dipped_beam, CH.front_fog",
            may_write=BY_THE_SWITCH,
        ),
        "place: China requires dipped beam, front fog lamps and hazard lights in fog, Switzerland only dipped beam",
        lamps=("lamps", "lights", "outside lights", "exterior lamps"),
    ),
    lit_by_law(
        "phenomenon_rear_fog_left_on",
        Dimension.ENVIRONMENT_ALERTS,
        (
            "The {lamp} is still burning. Off with it, unless the law lets me keep it.",
            "Am I allowed to leave the {lamp} lit? If not, kill it.",
            "I'd like to keep the {lamp} on. Legal here? If not, off with it.",
            "Somebody flashed at me, it's the {lamp}. Put it out if it's against the rules here.",
            "Is the {lamp} allowed here? If not, switch off.",
        ),
        Half(
            _at("border", "old_road", GERMANY, FOG_90, BEAM | {LIGHTS.REAR_FOG.path: True}),
            SOON,
            SignalIs(LIGHTS.REAR_FOG, (False,)),
            (LAMPS_SCREEN, REAR_FOG),
            BEHIND,
            Basis.LAW,
            "DE.rear_fog",
        ),
        decline(
            _at("border", "old_road", SWITZERLAND, FOG_90, BEAM | {LIGHTS.REAR_FOG.path: True}),
            SOON,
            BEHIND,
            Basis.LAW,
            "CH.rear_fog",
            reasons=NO_NEED,
            needed=False,
        ),
        "place: with 90 m of visibility in fog the lamp is forbidden in Germany (50 m) and allowed in Switzerland",
        lamp=REAR_LAMP,
    ),
    lit_by_law(
        "phenomenon_front_fog_in_haze",
        Dimension.ENVIRONMENT_ALERTS,
        (
            "Get the {lamps} going.",
            "Bit hazy in town, {lamps} please.",
            "Light {lamps}, will you, the street looks grey.",
            "Misty here. I fancy the {lamps}.",
            "Could you put the {lamps} on for this stretch?",
        ),
        _on(
            _at("london", "euston", ITALY, replace(MIST_120, temperature_2m=14.0, visibility=400.0)),
            "IT.front_fog",
            LIGHTS.FRONT_FOG,
            FRONT_FOG,
        ),
        decline(
            _at("london", "euston", BRITAIN, replace(MIST_120, temperature_2m=14.0, visibility=400.0)),
            SOON,
            IN_SIGHT,
            Basis.LAW,
            "GB.front_fog",
            reasons=UNLAWFUL,
        ),
        "place: with 400 m of visibility in fog the lamps are forbidden in Britain (100 m) and allowed in Italy",
        lamps=FRONT_LAMPS,
    ),
    lit_by_law(
        "phenomenon_rear_fog_in_light_snow",
        Dimension.ENVIRONMENT_ALERTS,
        (
            "It's snowing! I should have the {lamp} on.",
            "It has begun to snow, so I'd like the {lamp}.",
            "Turn the {lamp} on, they can't see me through the flakes.",
            "As long as it's snowing I want the {lamp} lit.",
            "There's snow in the air, so {lamp} on, please.",
        ),
        _on(
            replace(_at("border", "north", JURA, LIGHT_SNOW), start=MARCH_NOON),
            "FR.rear_fog",
            LIGHTS.REAR_FOG,
            REAR_FOG,
            deadline=BEHIND,
        ),
        decline(
            replace(_at("border", "north", SWEDEN, LIGHT_SNOW), start=MARCH_NOON),
            SOON,
            BEHIND,
            Basis.LAW,
            "SE.rear_fog",
            reasons=UNLAWFUL,
        ),
        "place: light snow is not enough for the lamp in Sweden, snow of any kind is in France",
        lamp=REAR_LAMP,
    ),
    lit_by_law(
        "phenomenon_cruise_in_fog",
        Dimension.ENVIRONMENT_ALERTS,
        (
            "Before I engage it, bring {cruise} to what the law permits at this visibility, exactly.",
            "Preset {cruise} at the highest number that's legal in fog like this.",
            "How fast may I go in here? Have {cruise} ready there.",
            "I'll want {cruise} soon. The maximum allowed with such a view, please.",
            "Bring {cruise} to the limit for this fog, no lower; don't switch anything on.",
        ),
        _cruise(80.0, 40.0, "CN.limit.visibility_100", 50.0, 100.0),
        _cruise(150.0, 60.0, "CN.limit.visibility_200", 100.0, 200.0),
        "visibility: under 100 m Chinese motorways allow 40 km/h, under 200 m 60 km/h",
        cruise=("the cruise", "cruise control", "the cruise speed", "the speed of the cruise control"),
    ),
)
