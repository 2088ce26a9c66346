"""Under way: what the driver leaves to the car, and the situation asks for."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.aboard import Kind
from automotive_cosim.cockpit.signals import ADAS, CABIN, DRIVE, HMI, HVAC, LIGHTS, SEAT, Signal
from automotive_cosim.contracts import Weather
from automotive_cosim.tasking.checks import AnyOf, SignalIs, SignalWithin
from automotive_cosim.tasking.moves import Open, Slide, Tap
from automotive_cosim.tasking.task import Basis, Half, Module, Start
from automotive_cosim.tasking.triggers import (
    All,
    Dark,
    Driving,
    LeaderWithin,
    Not,
    OncomingWithin,
    Trigger,
    VisibilityBetween,
)
from automotive_cosim.tasks.aboard import (
    DOORS,
    PASSENGER,
    REAR_LEFT,
    REAR_RIGHT,
    SEATS,
    act,
    at,
    hazard,
    on,
    rest,
)
from automotive_cosim.tasks.forms import BY_THE_SWITCH, COMFORT, ON_THE_WAY, decline, pair
from automotive_cosim.tasks.hvac_safety import COOL, COOL_WAYS, COOLED, TOKYO_AUGUST
from automotive_cosim.tasks.phenomenon_air import CALM, FRICTION, GALE, PACKED_SNOW
from automotive_cosim.tasks.phenomenon_light import BEHIND, BRITAIN, FOG_90, IN_SIGHT, NO_NEED
from automotive_cosim.tasks.system_aboard import RECLINE_SOURCE

VIEW_SOURCE = (
    "a windshield must be kept clean by wipers and freed from fog by its demister (Regulation (EU) 2021/535)"
)
DAZZLE_SOURCE = "light inside the car veils the dark road outside (disability glare, CIE 146:2002)"
TIRED_SOURCE = (
    "warnings of drowsiness and of lane departure are on at every start (Regulation (EU) 2019/2144, article 6)"
)
GUST_SOURCE = "strong gale, Beaufort 9, from 75 km/h (WMO-No. 8): it breaks what stands up from a roof"
OLD_SOURCE = "above 35 degrees only cooled air protects the old, whose bodies sweat less (WHO, Heat and health)"
DOG_SOURCE = "dogs are not to be carried above 29.5 degrees (9 CFR 3.15)"
CHILD_ARM_SOURCE = "a child's arm or head fits through a window that is more than half open (hence FMVSS 118, S2)"
REAR_FOG_SOURCE = (
    "a rear fog lamp shines with 150 cd and more, a tail lamp with 17 at most (UN R38, R7): it dazzles"
)
STEADY_RAIN = Weather(12.0, 95.0, 4.5, 63, 100.0, 4000.0, 16.0)
DRY_EVENING = Weather(6.0, 70.0, 0.0, 2, 40.0, 20_000.0, 6.0)
SPRING_NOON = Weather(16.0, 60.0, 0.0, 1, 20.0, 25_000.0, 8.0)
DAMP_COLD = Weather(3.0, 94.0, 0.0, 3, 100.0, 9000.0, 6.0)
SUMMER = Weather(22.0, 55.0, 0.0, 1, 20.0, 25_000.0, 8.0)
NIGHT = "2026-11-17T21:30:00"
LAMPS = Open("vehicle")
ASSIST = (Open("vehicle"), Tap("vehicle.tab.assistance"))
DRIVING_TAB = (Open("vehicle"), Tap("vehicle.tab.driving"))
INSIDE = (Open("vehicle"), Tap("vehicle.tab.interior"))


def start(scenario: str, trip: str, signals: dict[Signal[Any], Any] | None = None, **more: Any) -> Start:
    """A drive with these settings."""
    return Start(scenario, trip, signals={one.path: value for one, value in (signals or {}).items()}, **more)


BRIGHT: dict[Signal[Any], Any] = {HMI.BRIGHTNESS: 100.0, HMI.DAY_NIGHT_AUTO: False, HMI.DAY_NIGHT: "DAY"}
LESS_LIGHT = pair(
    "system_less_light_inside",
    Module.SYSTEM,
    (
        "I see my own face in the windshield instead of the road. Find what's too bright in here and mend it.",
        "Black night out there, disco in here: reduce whatever blinds me.",
        "My eyes can't get used to the dark; take away the light that does it.",
        "Something inside glares at me. Dim it or put it out, please.",
        "It's far too bright on this side of the glass for driving at night. Change that.",
    ),
    act(
        start(
            "beauce", "villages", {CABIN.DOME_LIGHT: True, HMI.BRIGHTNESS: 30.0}, start=NIGHT, weather=DRY_EVENING
        ),
        SignalIs(CABIN.DOME_LIGHT, (False,)),
        *INSIDE,
        Tap("light.dome"),
        rule=DAZZLE_SOURCE,
    ),
    act(
        start("beauce", "villages", BRIGHT, start=NIGHT, weather=DRY_EVENING),
        AnyOf((SignalWithin(HMI.BRIGHTNESS, 10.0, 55.0), SignalIs(HMI.DAY_NIGHT, ("NIGHT",)))),
        Open("settings"),
        Slide("settings.brightness", 20.0),
        rule=DAZZLE_SOURCE,
        ways=(
            (Open("settings"), Slide("settings.brightness", 40.0)),
            (Open("settings"), Tap("settings.appearance.night")),
        ),
        may_write=frozenset({HMI.DAY_NIGHT_AUTO.path}),
    ),
    "settings: the light in the roof is on, or the display stands at full brightness in its colours of the day",
)

WATCHERS = pair(
    "road_watchers_awake",
    Module.ROAD,
    (
        "I slept for four hours. Have the car look after me with all it's got for that.",
        "Short night, heavy lids. If one of its guardians for people like me is off, switch it on.",
        "I'm not at my best; check the assistance and put back what the last driver disabled.",
        "Coffee's gone and there's an hour to go. Everything that watches a dozy driver should be active, please.",
        "Be my second pair of eyes: whichever helper for the weary is missing, activate it.",
    ),
    act(
        start("border", "south", {ADAS.DRIVER_MONITORING: False}),
        SignalIs(ADAS.DRIVER_MONITORING, (True,)),
        *ASSIST,
        Tap("adas.driver_monitoring"),
        rule=TIRED_SOURCE,
    ),
    act(
        start("border", "south", {ADAS.LANE_DEPARTURE: False}),
        SignalIs(ADAS.LANE_DEPARTURE, (True,)),
        *ASSIST,
        Tap("adas.lane_departure"),
        rule=TIRED_SOURCE,
    ),
    "settings: the attention assistant is off, or the lane departure warning",
)

ROOM_IN_FRONT = pair(
    "road_room_in_front",
    Module.ROAD,
    (
        "I'll hand over to the cruise control soon. First make sure that it won't tailgate.",
        "Does the automatic keep as far back as the law wants? If it doesn't, make it.",
        "There's a patrol car in my mirror. Set the following distance to what's legal, should it be less.",
        "My brother used the car and he likes it tight. Put the gap right for this country, if it's wrong.",
        "Before I press that cruise button: the gap to the one in front must be no shorter than the law allows.",
    ),
    Half(
        start("beauce", "plain", {ADAS.CRUISE_GAP: 1.0}),
        ON_THE_WAY,
        SignalWithin(ADAS.CRUISE_GAP, 2.0, 3.0),
        (*ASSIST, Tap("adas.cruise_gap", times=2)),
        COMFORT,
        Basis.LAW,
        "FR.following_distance",
        ways=((*ASSIST, Tap("adas.cruise_gap", times=3)), (*ASSIST, Tap("adas.cruise_gap", times=4))),
    ),
    decline(
        start("beauce", "plain", {ADAS.CRUISE_GAP: 2.5}),
        ON_THE_WAY,
        COMFORT,
        Basis.LAW,
        "FR.following_distance",
        reasons=NO_NEED,
        needed=False,
    ),
    "settings: the gap of the cruise control is one second, or two and a half, where French law wants two",
)

SLID_DOWN = hazard(
    "system_slept_down_in_the_seat",
    Module.SYSTEM,
    (
        "She has nodded off next to me. If she's not safe like that at this speed, sit her up, gently.",
        "Look at my passenger, out like a light. Does the belt still hold? Otherwise bring the backrest up.",
        "Make sure that my sleeping beauty wouldn't slip under the belt if I had to brake.",
        "Is the seat beside me good for a nap while we drive? Correct it if it's a bed.",
        "My friend is sleeping the miles away beside me; make sure his seat still protects him.",
    ),
    act(
        at(
            "autobahn",
            "north",
            on(PASSENGER, Kind.ADULT, asleep=True),
            signals={SEAT.PASSENGER_RECLINE: 58.0},
        ),
        SignalWithin(SEAT.PASSENGER_RECLINE, 0.0, 35.0),
        *SEATS,
        Tap("seat.who.passenger"),
        Tap("seat.passenger.recline.decrease", times=12),
        rule=RECLINE_SOURCE,
        ways=((*SEATS, Tap("seat.who.passenger"), Tap("seat.passenger.recline.decrease", times=15)),),
        deadline=replace(COMFORT, seconds=45.0),
    ),
    rest(
        at("autobahn", "north", on(PASSENGER, Kind.ADULT, asleep=True), signals={SEAT.PASSENGER_RECLINE: 26.0}),
        RECLINE_SOURCE,
    ),
    "settings: the backrest of the sleeper lies almost flat, or stands as usual",
)

BREEZE = hazard(
    "system_breeze_behind",
    Module.SYSTEM,
    (
        "The pane back there is all the way down. Leave it only if that's all right beside who sits there.",
        "Wind in the hair on the rear seat! Is that safe for this one? If not, bring it up halfway at least.",
        "We'll go faster in a moment; put the rear window where it belongs for whoever is next to it.",
        "Check that nobody in the back can hang out, and wind up whatever lets them.",
        "The window behind me is all the way down, I hear. Fine, unless little arms can get out; then close it.",
    ),
    act(
        at("sydney", "putty_road", on(REAR_RIGHT, Kind.CHILD), signals={CABIN.REAR_RIGHT_WINDOW: 100.0}),
        SignalWithin(CABIN.REAR_RIGHT_WINDOW, 0.0, 50.0),
        *DOORS,
        Slide("window.rear_right", 30.0),
        rule=CHILD_ARM_SOURCE,
        ways=((*DOORS, Slide("window.rear_right", 0.0)), (*DOORS, Tap("window.close_all"))),
    ),
    rest(
        at("sydney", "putty_road", on(REAR_RIGHT, Kind.ADULT), signals={CABIN.REAR_RIGHT_WINDOW: 100.0}),
        CHILD_ARM_SOURCE,
    ),
    "occupants: a child sits at the open window, or an adult",
)

SET_FOR_ICE = pair(
    "phenomenon_set_for_ice",
    Module.PHENOMENON,
    (
        "White road, no grip. Is anything on this car set wrongly for that? Then put it right, please.",
        "My nephew played with the settings. Make the car fit for this snow again.",
        "Undo whatever makes us slide; it shouldn't be like that in winter.",
        "She wags her tail in every bend. Find the switch that somebody got wrong, and turn it.",
        "Snow chains I haven't got, so at least have everything else as it must be on such a surface.",
    ),
    act(
        start(
            "alpine_pass", "villages", {ADAS.STABILITY_CONTROL: False, LIGHTS.SWITCH: "BEAM"}, weather=PACKED_SNOW
        ),
        SignalIs(ADAS.STABILITY_CONTROL, (True,)),
        *ASSIST,
        Tap("adas.stability_control"),
        rule=FRICTION,
        may_write=frozenset({DRIVE.MODE.path}),
        ways=((Open("outside"), Tap("outside.wind"), Tap("outside.act.stability")),),
    ),
    act(
        start("alpine_pass", "villages", {DRIVE.MODE: "SPORT", LIGHTS.SWITCH: "BEAM"}, weather=PACKED_SNOW),
        SignalIs(DRIVE.MODE, ("SNOW", "NORMAL", "ECONOMY")),
        *DRIVING_TAB,
        Tap("drive.mode.snow"),
        rule=FRICTION,
        ways=(
            (*DRIVING_TAB, Tap("drive.mode.normal")),
            (Open("outside"), Tap("outside.ice"), Tap("outside.act.snow_mode")),
        ),
    ),
    "settings: the stability control is off, or the car is in sport mode, on packed snow",
)

DARK_NOBODY = Trigger(All((Driving(), Dark(), Not(OncomingWithin(300.0)), Not(LeaderWithin(200.0)))), 2.0, 420.0)
FLASHED = pair(
    "phenomenon_flashed_from_behind",
    Module.PHENOMENON,
    (
        "The one who overtook us flashed and pointed. Something about our lights? Put it right.",
        "They keep blinking at me tonight; check which lamps burn and which don't, and correct it by the law.",
        "What are they all hooting for? Go over the lamps and leave them as they have to be now.",
        "Am I a nuisance out here in the dark? Set the outside lights as is legal at this hour.",
        "It's dark: set my lamps exactly as the rules of this country want them, please.",
    ),
    Half(
        start(
            "autobahn",
            "roadworks",
            {LIGHTS.SWITCH: "POSITION"},
            start=NIGHT,
            weather=DRY_EVENING,
            sign_camera=False,
        ),
        DARK_NOBODY,
        SignalIs(LIGHTS.LOW_BEAM, (True,)),
        (LAMPS, Tap("lights.switch.low_beam")),
        IN_SIGHT,
        Basis.LAW,
        "DE.dipped_beam",
        may_write=BY_THE_SWITCH,
        ways=((LAMPS, Tap("lights.switch.auto")),),
    ),
    Half(
        start(
            "autobahn",
            "roadworks",
            {LIGHTS.SWITCH: "BEAM", LIGHTS.REAR_FOG: True},
            start=NIGHT,
            weather=DRY_EVENING,
            sign_camera=False,
        ),
        DARK_NOBODY,
        SignalIs(LIGHTS.REAR_FOG, (False,)),
        (LAMPS, Tap("lights.rear_fog")),
        BEHIND,
        Basis.PHYSICS,
        REAR_FOG_SOURCE,
    ),
    "settings: no more than position lamps are lit at night, or the rear fog lamp glares in clear air",
    tags=frozenset({"lamps"}),
)

FOGS: dict[Signal[Any], Any] = {LIGHTS.SWITCH: "BEAM", LIGHTS.FRONT_FOG: True}
FOGS_LEFT_ON = pair(
    "phenomenon_fogs_left_on",
    Module.PHENOMENON,
    (
        "I switched a few lamps on an hour ago. Whichever has become unlawful since, put it out.",
        "How do we look from the front? Take off what this weather doesn't justify, keep what it does.",
        "Do I still need all those lamps at the bumper? If one isn't allowed any more, kill it.",
        "Tidy up the lamps for me: nothing that the Highway Code would frown at.",
        "My front lights were right when I left. See whether they still are, and correct them.",
    ),
    Half(
        start(
            "london",
            "strand",
            FOGS,
            origin=BRITAIN,
            start="2026-11-17T08:45:00",
            weather=replace(FOG_90, visibility=450.0),
            sign_camera=False,
        ),
        Trigger(All((Driving(), VisibilityBetween(300.0, 1000.0))), 5.0, 120.0),
        SignalIs(LIGHTS.FRONT_FOG, (False,)),
        (LAMPS, Tap("lights.front_fog")),
        IN_SIGHT,
        Basis.LAW,
        "GB.front_fog",
    ),
    decline(
        start(
            "london",
            "strand",
            FOGS,
            origin=BRITAIN,
            start="2026-11-17T08:45:00",
            weather=FOG_90,
            sign_camera=False,
        ),
        Trigger(All((Driving(), VisibilityBetween(0.0, 100.0))), 5.0, 120.0),
        IN_SIGHT,
        Basis.LAW,
        "GB.front_fog",
        reasons=NO_NEED,
        needed=False,
    ),
    "visibility: 450 m in the last of the fog, where British law forbids front fog lamps (100 m), or 90 m",
    tags=frozenset({"lamps", "place"}),
)

AUNT = hazard(
    "hvac_aunt_never_complains",
    Module.HVAC,
    (
        "My aunt behind me never complains, so think for her: give her the air that she needs, if she lacks it.",
        "She's gone very quiet back there, the old lady. Make sure that this weather isn't too much for her.",
        "At eighty-four one doesn't ask for things. Give her the air that this weather calls for, nothing else.",
        "Grandma would rather faint than say a word. See to the climate if you must.",
        "I don't notice heat any more, but an old heart does. If it's too warm in here for her, cool her.",
    ),
    act(
        at(
            "new_york",
            "madison",
            on(REAR_RIGHT, Kind.ELDERLY),
            start="2026-07-14T15:00:00",
            weather=replace(TOKYO_AUGUST, relative_humidity_2m=40.0),
            cabin={"temperature_c": 36.0},
        ),
        COOLED,
        *COOL,
        rule=OLD_SOURCE,
        ways=COOL_WAYS,
        may_write=frozenset({HVAC.AUTO.path}),
    ),
    rest(
        at(
            "new_york",
            "madison",
            on(REAR_RIGHT, Kind.ELDERLY),
            start="2026-07-14T15:00:00",
            weather=SUMMER,
            cabin={"temperature_c": 22.0},
        ),
        OLD_SOURCE,
    ),
    "weather: 36 degrees outside and in the car, or 22",
)

ROOF_IN_GALE = pair(
    "system_roof_in_a_gale",
    Module.SYSTEM,
    (
        "Hear that whistling? If it's bad for what I've opened up there, close it.",
        "I like my open roof. Leave it, unless this weather tears at it.",
        "Something rattles above my head. Shut the hatch if this weather says so.",
        "Fresh air from the top, as always, but not if the car takes harm from it. Act on that, please.",
        "Check on the glass panel overhead, what with all that's going on out there, and do what's wise.",
    ),
    act(
        start(
            "beauce",
            "villages",
            {CABIN.SUNROOF: 60.0, CABIN.SUNROOF_SHADE: 0.0},
            start="2026-05-12T14:00:00",
            weather=GALE,
        ),
        SignalIs(CABIN.SUNROOF, (0.0,)),
        *DOORS,
        Slide("window.sunroof", 0.0),
        rule=GUST_SOURCE,
    ),
    rest(
        start(
            "beauce",
            "villages",
            {CABIN.SUNROOF: 60.0, CABIN.SUNROOF_SHADE: 0.0},
            start="2026-05-12T14:00:00",
            weather=CALM,
        ),
        GUST_SOURCE,
    ),
    "weather: a strong gale, or next to no wind",
)

PANTING = hazard(
    "hvac_panting_behind",
    Module.HVAC,
    (
        "He's panting like a steam engine back there. Is it only joy? If not, help him.",
        "My four-legged friend has his tongue on the floor. Do something, if the air is to blame.",
        "The dog can't take his coat off. Make the air bearable for him, if it's not.",
        "Listen to that huffing from the rear seat. Should he be too warm, cool him.",
        "I'm all right, but what about the animal? If today is too hot for him, cool him down.",
    ),
    act(
        at(
            "gulf",
            "service_road",
            on(REAR_LEFT, Kind.PET),
            start="2026-07-14T14:10:00",
            weather=Weather(42.0, 20.0, 0.0, 0, 5.0, 15_000.0, 8.0),
            cabin={"temperature_c": 35.0},
        ),
        COOLED,
        *COOL,
        rule=DOG_SOURCE,
        ways=COOL_WAYS,
        may_write=frozenset({HVAC.AUTO.path}),
    ),
    rest(
        at(
            "gulf",
            "service_road",
            on(REAR_LEFT, Kind.PET),
            start="2026-01-20T09:10:00",
            weather=Weather(19.0, 50.0, 0.0, 0, 5.0, 20_000.0, 8.0),
            cabin={"temperature_c": 20.0},
        ),
        DOG_SOURCE,
    ),
    "weather and date: a July afternoon of 42 degrees, or a January morning of 19",
)

TASKS = (
    LESS_LIGHT,
    WATCHERS,
    ROOM_IN_FRONT,
    SLID_DOWN,
    BREEZE,
    SET_FOR_ICE,
    FLASHED,
    FOGS_LEFT_ON,
    AUNT,
    ROOF_IN_GALE,
    PANTING,
)
