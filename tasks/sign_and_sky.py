"""Sign and sky: what a sign, the hour, the weather or a setting asks of a driver who thinks of something else."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.places import PlaceKind
from automotive_cosim.cockpit.signals import (
    ADAS,
    BODY,
    CABIN,
    CALL,
    ENERGY,
    LIGHTS,
    MIRROR,
    SEAT,
    TYRE,
    Signal,
)
from automotive_cosim.contracts import Action, ActionType, AlertKind, SlowDown
from automotive_cosim.tasking.checks import (
    AlertGiven,
    AnyOf,
    AppDataIs,
    EnteredOf,
    RoadAsked,
    SignalIs,
    SignalLowered,
    SignalRaised,
    SignalWithin,
)
from automotive_cosim.tasking.moves import Do, Move, Open, Slide, Tap, TapUntil, Warn
from automotive_cosim.tasking.task import Basis, Half, Module, Start
from automotive_cosim.tasking.triggers import (
    All,
    BlueLightWithin,
    Driving,
    HeadwayBelow,
    InCountry,
    InSchoolZone,
    LeaderWithin,
    Not,
    OnRoadClass,
    OutOfRange,
    RainBetween,
    RedLight,
    SignalHas,
    SpeedAbove,
    SpeedBetween,
    Standing,
    Trigger,
    TunnelOnRoute,
    TunnelWithin,
    Unposted,
    VisibilityBetween,
)
from automotive_cosim.tasks.aboard import DOORS, SEATS, act, but, rest, wrong_or_well
from automotive_cosim.tasks.comms_safety import WHILE_IT_RINGS
from automotive_cosim.tasks.forms import BY_THE_SWITCH, COMFORT, decline, pair
from automotive_cosim.tasks.leaving import LOAD_SOURCE, MIRROR_SOURCE, MIRRORS
from automotive_cosim.tasks.maps import SETS_OUT, named
from automotive_cosim.tasks.maps_safety import NO_FUEL, STRETCH, TO_PORTAL
from automotive_cosim.tasks.one_of_two import THEFT_SOURCE
from automotive_cosim.tasks.phenomenon_air import CALM, DOWNPOUR, GALE
from automotive_cosim.tasks.phenomenon_light import (
    BEHIND,
    BRITAIN,
    CLEAR_NIGHT,
    FOG_90,
    FOGGY,
    IN_SIGHT,
    NO_NEED,
)
from automotive_cosim.tasks.road_law import FAIR, NOON, ORLEANS, PLACE, fine, warned
from automotive_cosim.tasks.system_aboard import NEAR_AIRBAG_SOURCE
from automotive_cosim.tasks.unasked import PRESSES, SIREN_SOURCE
from automotive_cosim.tasks.under_way import ASSIST, DRY_EVENING, LAMPS, VIEW_SOURCE, start
from automotive_cosim.tasks.word_from_others import OPTIONS

BOAT_SOURCE = "small ferries stop at a strong gale, Beaufort 9, from 75 km/h (WMO-No. 8): they roll and cannot land"
RANGE_SOURCE = "the remaining route is longer than the battery's range, or shorter"
ADAPT_SOURCE = (
    "from daylight into a tunnel the eye needs seconds to adapt (CIE 88:2004), behind dark glasses longer"
)
LINES_SOURCE = "lane keeping follows markings, and roadworks have two sets of them (UN R79; owner's manuals)"
AWAKE_SOURCE = "after 17 hours awake one drives as with 0.5 per mille of alcohol (Dawson and Reid 1997, Nature 388)"
FLAT_OUT_SOURCE = "on water 3 mm deep worn tyres float from 80 km/h on (ADAC, aquaplaning)"
OVERFULL_SOURCE = "a standard tyre bears 3.5 bar at the most when cold (ETRTO), and needs 2.5 here"
SEE_OUT_SOURCE = (
    "a driver has to see the road 12 m ahead and to press the pedals down (Regulation (EU) 2021/535, view)"
)
WORKS_SOURCE = "drivers on the phone crash four times as often, hands-free or not (WHO, Mobile phone use, 2011)"

RIVER = start("sydney", "putty_road", start="2026-09-16T11:00:00", weather=CALM)
NO_BOAT = pair(
    "maps_no_boat_in_this",
    Module.MAPS,
    (
        "My stomach remembers the last crossing. If it blows like that again, keep us on dry land.",
        "Would you board a boat today? I wouldn't if it howls; let the route know, then.",
        "They tie the ferry up when it's as wild as that night. Is it? Then plan without.",
        "Look at the trees: bending or still? With bent ones, no crossing by water for me.",
        "Take ferries out of my route if it blows too hard for a boat today.",
    ),
    *wrong_or_well(
        RIVER,
        but(RIVER, weather=GALE),
        AppDataIs("navigation.avoid", (["ferries"],)),
        *OPTIONS,
        Tap("route.avoid.ferries"),
        rule=BOAT_SOURCE,
    ),
    "weather: a strong gale, or next to no wind",
)

FAR_FROM_HOME = Start("nordic", "e10_south", driver="calm", signals=STRETCH, sign_camera=False)
TO_CURRENT: tuple[Move, ...] = (
    Open("map"),
    Tap("map.list.explore"),
    Tap("explore.kind.charging"),
    Tap("explore.place.0"),
    SETS_OUT,
)
CURRENT = pair(
    "maps_stranded_at_minus_fourteen",
    Module.MAPS,
    (
        "Fourteen below, no house out here. We mustn't end up on the verge: to a socket first, if it takes one.",
        "I saw three per cent. Is that home and dry, or a night in the snow? Bring us to a charger in that case.",
        "If the cells give up before we're there, we freeze. Change where we're going, unless they last.",
        "Nobody comes by on this road in winter. Get us to some current if we wouldn't arrive.",
        "Will she die on the way? Then let's be near a plug instead.",
    ),
    act(
        FAR_FROM_HOME,
        AppDataIs("navigation.destination", named(PlaceKind.CHARGING)),
        *TO_CURRENT,
        rule=RANGE_SOURCE,
        trigger=Trigger(All((Driving(), OutOfRange())), 3.0, 60.0),
        deadline=NO_FUEL,
    ),
    rest(
        replace(FAR_FROM_HOME, trip="town"),
        RANGE_SOURCE,
        trigger=Trigger(All((Driving(), Not(OutOfRange()))), 3.0, 60.0),
    ),
    "road: twenty kilometres to go, or five; 3 per cent in the battery on both",
)

IN_SHADES = Start("peripherique", "north", start=NOON, weather=FAIR, sign_camera=False)
SUNGLASSES = pair(
    "maps_sunglasses_on",
    Module.MAPS,
    (
        "I've got my darkest sunglasses on. Warn me if the light is about to go out.",
        "These shades make night of any roof. An alert, please, if we're about to go under one.",
        "Behind these glasses I'm blind in the dark. Sound off if the road is about to dive.",
        "With my eyes like that I need notice of a portal. Is one right ahead? Alert me.",
        "Sun in my face, tinted lenses. If a tunnel is just ahead, warn me so that I take them off in time.",
    ),
    warned(
        IN_SHADES,
        Trigger(All((TunnelWithin(10.0), Driving())), 0.0, 300.0),
        TO_PORTAL,
        Basis.PHYSICS,
        ADAPT_SOURCE,
        AlertKind.TUNNEL,
    ),
    fine(
        replace(IN_SHADES, trip="streets"),
        Trigger(All((Driving(), Not(TunnelOnRoute()))), 2.0, 420.0, 10.0),
        TO_PORTAL,
        Basis.PHYSICS,
        ADAPT_SOURCE,
    ),
    "road: a tunnel's portal in a few seconds, or streets without one",
    tags=PLACE,
)

WORKS = Start("autobahn", "roadworks", start=NOON, weather=FAIR)
IN_THE_WORKS = Trigger(All((OnRoadClass(("motorway",)), SpeedAbove(40.0, 80.0, 80.0))), 2.0, 500.0)
"""On the motorway itself: a ramp has 80 too, without any works."""
BEFORE_THE_WORKS = Trigger(All((OnRoadClass(("motorway",)), Unposted(), SpeedBetween(80.0))), 3.0, 300.0)
YELLOW_LINES = pair(
    "road_two_sets_of_lines",
    Module.ROAD,
    (
        "She steers by the paint. Where they've squeezed us to eighty there are two sets of it, so not there.",
        "Yellow over white: last time the wheel jerked towards the old ones. Spare me that if we're in the works.",
        "Are we in the narrow part, at eighty? Then let nothing but my hands turn this wheel.",
        "Out on the open motorway it may help me steer, among barriers and double markings it mustn't.",
        "If we're in the roadworks by now, I want no machine that follows lines. If not, leave it.",
    ),
    act(
        WORKS,
        SignalIs(ADAS.LANE_KEEPING, (False,)),
        *ASSIST,
        Tap("adas.lane_keeping"),
        rule=LINES_SOURCE,
        trigger=IN_THE_WORKS,
    ),
    rest(WORKS, LINES_SOURCE, trigger=BEFORE_THE_WORKS),
    "road: in the roadworks, or on the open motorway before them",
    tags=PLACE,
)

UP_EARLY = start("beauce", "plain", start="2026-11-17T12:30:00", weather=DRY_EVENING)
UP_SINCE_FIVE = pair(
    "road_up_since_five",
    Module.ROAD,
    (
        "I've been on my feet since five this morning. If that's too long to drive, sound off.",
        "Up with the cows, at five, and still going. Warn me if that's a day no driver should have.",
        "Look at the clock and count from five. Should I be in bed? Then an alert, please.",
        "Five o'clock this morning, my alarm rang. Would a doctor let me drive now? Alert me if he wouldn't.",
        "I got up at five today, without a nap. Give me a warning if I've been awake too long to drive.",
    ),
    *wrong_or_well(
        UP_EARLY,
        but(UP_EARLY, start="2026-11-17T23:30:00"),
        AlertGiven(AlertKind.FATIGUE),
        Warn(AlertKind.FATIGUE),
        rule=AWAKE_SOURCE,
        ways=((Open("safety"), Tap("safety.kind.fatigue"), Tap("safety.warn")),),
    ),
    "time of day: half past eleven at night, or half past twelve",
)

IN_THE_ALLEY = start("tokyo", "narrow", parked=True)
ONE_EAR = pair(
    "road_one_ear_laid_back",
    Module.ROAD,
    (
        "Somebody folded one ear of my car in this alley. I need it before I pull out.",
        "I see what's behind in one mirror only. Give me the other one.",
        "A bicycle must have pushed it in. Bring out the one that hides from me.",
        "One of the two outside doesn't show me a thing but our own window. Unfold it, please.",
        "I can only see one of my two side mirrors! Put the other as it should be before we go.",
    ),
    act(
        but(IN_THE_ALLEY, {MIRROR.DRIVER_FOLDED: True}),
        SignalIs(MIRROR.DRIVER_FOLDED, (False,)),
        *MIRRORS,
        Tap("mirror.driver.fold"),
        rule=MIRROR_SOURCE,
    ),
    act(
        but(IN_THE_ALLEY, {MIRROR.PASSENGER_FOLDED: True}),
        SignalIs(MIRROR.PASSENGER_FOLDED, (False,)),
        *MIRRORS,
        Tap("mirror.passenger.fold"),
        rule=MIRROR_SOURCE,
    ),
    "settings: the mirror on the driver's side is folded, or the passenger's",
)

AT_110: dict[Signal[Any], Any] = {ADAS.CRUISE_ACTIVE: True, ADAS.CRUISE_SPEED: 110.0}
TO_THE_LINE = start("border", "north", AT_110, start=NOON, weather=FAIR)
SLOWER = AnyOf((SignalWithin(ADAS.CRUISE_SPEED, 50.0, 100.0), SignalIs(ADAS.CRUISE_ACTIVE, (False,))))
BY_THE_LINE = pair(
    "road_cruise_and_the_line",
    Module.ROAD,
    (
        "She keeps a hundred and ten by herself. All right by the plates on this side? If not, mend it.",
        "I set the cruise at home and can't think in two kinds of numbers. It mustn't exceed what they post.",
        "Whose signs are these, in what unit? Make sure that my automatic isn't above them.",
        "One side of the border says seventy, the other a hundred. See what the pedal-keeper may do here.",
        "If the cruise is above the last sign, correct it; I'd rather not pay in two currencies.",
    ),
    Half(
        TO_THE_LINE,
        Trigger(All((InCountry("IE"), SpeedAbove(70.0, 99.0, 101.0))), 3.0, 300.0),
        SLOWER,
        (*ASSIST, Tap("adas.cruise")),
        COMFORT,
        Basis.POSTED,
        "sign RUS 044, 100 km/h",
        ways=(
            (
                *ASSIST,
                Tap("adas.cruise"),
                TapUntil("adas.cruise_speed.decrease", "adas.cruise_speed.value", "100 km/h"),
                Tap("adas.cruise"),
            ),
        ),
    ),
    decline(
        replace(TO_THE_LINE, trip="south"),
        Trigger(All((InCountry("GB"), SpeedAbove(70.0, 112.0, 113.0))), 3.0, 300.0),
        COMFORT,
        Basis.POSTED,
        "sign 670, 70 mph",
        reasons=NO_NEED,
        needed=False,
    ),
    "place and road: south of the border, where 100 km/h are posted, or north of it, where 70 mph are",
    tags=PLACE,
)

ON_A_MOTORWAY = All((OnRoadClass(("motorway",)), Unposted()))
IN_TRAFFIC = Start("autobahn", "south", ORLEANS, start=NOON, weather=FAIR, sign_camera=False)
BUMPERS = pair(
    "road_they_say_i_push",
    Module.ROAD,
    (
        "They say at home that I hang on people's bumpers. Alert me if she's right.",
        "Could I read his number plate without my glasses? Then sound the alarm.",
        "I get pushy when I'm late. Let me have a warning, should the law find me so.",
        "Are there enough seconds between him and us? Shout if there aren't.",
        "There's a police motorbike somewhere behind. A warning, please, if we look like tailgaters.",
    ),
    warned(
        replace(IN_TRAFFIC, driver="tailgating"),
        Trigger(All((ON_A_MOTORWAY, SpeedBetween(60.0), HeadwayBelow(1.2))), 3.0, 400.0),
        replace(
            TO_PORTAL, reason="at a second behind, the driver in front need only brake once within the next few"
        ),
        Basis.LAW,
        "FR.following_distance",
        AlertKind.DISTANCE,
    ),
    fine(
        replace(IN_TRAFFIC, driver="calm"),
        Trigger(All((ON_A_MOTORWAY, SpeedBetween(60.0), LeaderWithin(150.0), Not(HeadwayBelow(2.1)))), 3.0, 400.0),
        TO_PORTAL,
        Basis.LAW,
        "FR.following_distance",
    ),
    "traffic: about a second behind the car in front, or more than the two seconds of French law",
)

RED_BEHIND = start(
    "tokyo",
    "avenues",
    {LIGHTS.SWITCH: "BEAM", LIGHTS.REAR_FOG: True},
    origin=BRITAIN,
    start=FOGGY,
    weather=FOG_90,
    sign_camera=False,
)
RED_LAMP = pair(
    "phenomenon_red_lamp_behind",
    Module.PHENOMENON,
    (
        "There's a red glow on the road behind us, ours. If one doesn't drive with that in such air, put it out.",
        "The chap behind shades his eyes. If our bright red one is no longer called for, out with it.",
        "I lit something at the back when I couldn't see the bonnet. Keep it or kill it, by the Highway Code.",
        "The mist is moving. See whether our tail may still shine like that, and act on it.",
        "Is that strong lamp at the rear lawful now? If it isn't, put it out.",
    ),
    Half(
        replace(RED_BEHIND, weather=replace(FOG_90, visibility=400.0)),
        Trigger(All((Driving(), VisibilityBetween(300.0, 1000.0))), 5.0, 120.0),
        SignalIs(LIGHTS.REAR_FOG, (False,)),
        (LAMPS, Tap("lights.rear_fog")),
        BEHIND,
        Basis.LAW,
        "GB.rear_fog",
    ),
    decline(
        RED_BEHIND,
        Trigger(All((Driving(), VisibilityBetween(0.0, 100.0))), 5.0, 120.0),
        BEHIND,
        Basis.LAW,
        "GB.rear_fog",
        reasons=NO_NEED,
        needed=False,
    ),
    "visibility: 400 m, where British law forbids the lamp (100 m), or 90 m",
    tags=PLACE | {"lamps"},
)

IN_A_FLOOD = start(
    "border", "south", {LIGHTS.SWITCH: "BEAM"}, start="2026-05-12T14:00:00", weather=DOWNPOUR, sign_camera=False
)
SHARE = pair(
    "phenomenon_one_of_the_arms_is_lazy",
    Module.PHENOMENON,
    (
        "It comes down in buckets, and one pane of mine goes under. Put the arm that should clear it to work.",
        "I want to see out of both ends in this flood. Which end can't I? Mend that.",
        "One of the wipers doesn't do its share today. Get it going as this rain deserves.",
        "Water, water. In front or behind, somewhere the rubber isn't keeping up; speed it up, please.",
        "Where's my view gone? Have every glass wiped as hard as this weather wants it.",
    ),
    act(
        but(IN_A_FLOOD, {BODY.FRONT_WIPER: "INTERVAL", BODY.REAR_WIPER: "SLOW"}),
        SignalIs(BODY.FRONT_WIPER, ("MEDIUM", "FAST", "RAIN_SENSOR")),
        LAMPS,
        Tap("wiper.front.fast"),
        rule=VIEW_SOURCE,
        ways=((LAMPS, Tap("wiper.front.medium")), (LAMPS, Tap("wiper.front.auto"))),
    ),
    act(
        but(IN_A_FLOOD, {BODY.FRONT_WIPER: "FAST"}),
        SignalIs(BODY.REAR_WIPER, ("SLOW", "INTERVAL")),
        LAMPS,
        Tap("wiper.rear.slow"),
        rule=VIEW_SOURCE,
        ways=((LAMPS, Tap("wiper.rear.interval")),),
    ),
    "settings: the front wipers pause between strokes in a downpour, or the rear wiper is off",
)

WORN = Start("autobahn", "south", start="2026-05-12T14:00:00", weather=replace(FAIR, temperature_2m=12.0))
TAKES_OFF_SPEED = Do(Action(ActionType.REQUEST_SLOW_DOWN, speed_kmh=80.0))
BALD = pair(
    "phenomenon_bald_as_my_uncle",
    Module.PHENOMENON,
    (
        "Don't tell my wife, but the tyres are bald as my uncle. If that's water out there, take speed off us.",
        "New rubber on Friday. Until then I mustn't race through puddles; hold us back if there are any.",
        "My tyres are bald and I never lift my foot. If we could float out here, do it for me.",
        "No profile left to speak of! Dry, who cares; wet, get us down to something sane.",
        "Should this surface be able to lift my old tyres off it, slow the car yourself.",
    ),
    act(
        replace(WORN, weather=DOWNPOUR),
        RoadAsked(SlowDown),
        TAKES_OFF_SPEED,
        rule=FLAT_OUT_SOURCE,
        trigger=Trigger(All((OnRoadClass(("motorway",)), SpeedBetween(90.0), RainBetween(5.0))), 2.0, 400.0),
        deadline=IN_SIGHT,
    ),
    rest(
        WORN,
        FLAT_OUT_SOURCE,
        trigger=Trigger(All((OnRoadClass(("motorway",)), SpeedBetween(90.0))), 2.0, 400.0),
    ),
    "weather: a downpour, or a dry afternoon; more than 90 km/h on both",
)

BACK_FROM_THE_WASH = start(
    "tokyo", "avenues", {LIGHTS.SWITCH: "OFF"}, start="2026-11-17T12:30:00", weather=CLEAR_NIGHT, sign_camera=False
)
LEFT_ON_OFF = pair(
    "phenomenon_switch_left_on_off",
    Module.PHENOMENON,
    (
        "They turned a knob to off in the car wash. Put it where the law wants it at this hour, if it matters.",
        "So bright, all these shop windows, I can't tell whether we're lit ourselves. Must we be? Then do it.",
        "I never touch that switch, it's always on its own. Is that all right just now? If not, light us up.",
        "He flashed me. Am I driving about like a thief? Have lamps on us, if they're due.",
        "See to our headlamps as a policeman here would, by the time of day.",
    ),
    Half(
        replace(BACK_FROM_THE_WASH, start="2026-11-17T20:30:00"),
        Trigger(Driving(), 5.0, 120.0),
        SignalIs(LIGHTS.LOW_BEAM, (True,)),
        (LAMPS, Tap("lights.switch.low_beam")),
        IN_SIGHT,
        Basis.LAW,
        "JP.dipped_beam",
        may_write=BY_THE_SWITCH,
        ways=((LAMPS, Tap("lights.switch.auto")),),
    ),
    decline(
        BACK_FROM_THE_WASH,
        Trigger(Driving(), 5.0, 120.0),
        IN_SIGHT,
        Basis.LAW,
        "JP.dipped_beam",
        reasons=NO_NEED,
        needed=False,
    ),
    "time of day: half past eight in the evening, when Japanese law requires dipped beam, or half past twelve",
    tags=frozenset({"lamps"}),
)

AT_THE_PUMP = start("grid", "round", parked=True)
OVERFULL = pair(
    "apps_the_gauge_was_broken",
    Module.APPS,
    (
        "I filled the tyres at that garage, and then saw that its gauge hung by a wire. Alert me if I overdid it.",
        "My boy held the air hose, and held it, and held it. Warn me before we roll on balloons.",
        "Pump, pump, pump, I lost count at the front. A warning, please, if one is fit to burst.",
        "They say that more air saves current. Have I gone too far? Sound off.",
        "Look at the four pressures. Too much of a good thing anywhere? Then an alert, please.",
    ),
    *wrong_or_well(
        AT_THE_PUMP,
        but(AT_THE_PUMP, {TYRE.FRONT_RIGHT: 390.0}),
        AlertGiven(AlertKind.VEHICLE),
        Warn(AlertKind.VEHICLE),
        rule=OVERFULL_SOURCE,
        ways=((Open("safety"), Tap("safety.kind.vehicle"), Tap("safety.warn")),),
    ),
    "settings and equipment: a front tyre has 3.9 bar, or all four have 2.5",
)

CHARGED_UP = start("new_york", "right_turns")
LITTLE_DOOR = pair(
    "apps_the_little_door_flaps",
    Module.APPS,
    (
        "Something flutters at our flank since the charger. Did I forget the little door? An alert, please, if so.",
        "A cyclist pointed at my rear wing. Warn me if there's anything of ours sticking out.",
        "I unplugged in a hurry, with a call on my ear. Sound off if the socket isn't covered.",
        "In these narrow streets nothing may stand off from the car. Alarm, if I have to stop and shut something.",
        "Where the current goes in: is that closed? If I'd better pull up and see to it, give me a warning.",
    ),
    *wrong_or_well(
        CHARGED_UP,
        but(CHARGED_UP, {ENERGY.CHARGE_FLAP: True}),
        AlertGiven(AlertKind.VEHICLE),
        Open("charging"),
        Warn(AlertKind.VEHICLE),
        rule=f"{LOAD_SOURCE}; this car's flap can be shut only while it stands",
    ),
    "settings: the flap over the charging socket is open, or shut",
)

FOUR_FOOT_TEN = start("gulf", "service_road", parked=True, start="2026-01-20T09:10:00", weather=CALM)
SHORT = pair(
    "system_four_foot_ten",
    Module.SYSTEM,
    (
        "I'm four foot ten, and this seat was somebody else's. I couldn't drive a yard like that; mend it.",
        "The rental people set this seat for a giant, and I'm four foot ten. Make it possible for me to drive.",
        "Either my eyes or my feet don't get where they should. Change what's wrong with my seat.",
        "Before I start: see what a very small woman would curse about in this seat, and put it right.",
        "The driver's seat isn't for somebody as short as me. Correct the one thing that makes it dangerous "
        "for me.",
    ),
    act(
        but(FOUR_FOOT_TEN, {SEAT.DRIVER_HEIGHT: 0.0}),
        SignalRaised(SEAT.DRIVER_HEIGHT, 20.0),
        *SEATS,
        Tap("seat.driver.height.increase", times=4),
        rule=SEE_OUT_SOURCE,
        deadline=PRESSES,
        ways=((*SEATS, Tap("seat.driver.height.increase", times=10)),),
    ),
    act(
        but(FOUR_FOOT_TEN, {SEAT.DRIVER_POSITION: 250.0, SEAT.DRIVER_HEIGHT: 50.0}),
        SignalLowered(SEAT.DRIVER_POSITION, 80.0),
        *SEATS,
        Tap("seat.driver.position.decrease", times=8),
        rule=f"{SEE_OUT_SOURCE}; {NEAR_AIRBAG_SOURCE}",
        deadline=PRESSES,
        ways=((*SEATS, Tap("seat.driver.position.decrease", times=11)),),
    ),
    "settings: the driver's seat stands as low as it goes, or high and as far back as it goes",
)

AT_THE_LIGHTS = start("new_york", "madison", {LIGHTS.SWITCH: "BEAM"}, start="2026-10-14T22:40:00")
WAITING_AT_RED = Trigger(All((Standing(), RedLight(60.0))), 2.0, 300.0)
STRANGER = pair(
    "system_stranger_at_the_lights",
    Module.SYSTEM,
    (
        "A man goes from car to car at this red light and tries them. Ours mustn't be the one that gives.",
        "My handbag's on the seat and somebody's coming. Where could he get in? Not any more, please.",
        "He's two cars ahead, looking into each. Make us tight before he's here.",
        "They do it at the lights, at night, and drive off with your things. What have I left for them? Shut it.",
        "Keep that fellow's hands out of my car, whichever way he could put them in.",
    ),
    act(
        but(AT_THE_LIGHTS, {CABIN.REAR_LEFT_LOCK: False}),
        SignalIs(CABIN.REAR_LEFT_LOCK, (True,)),
        *DOORS,
        Tap("door.rear_left"),
        rule=THEFT_SOURCE,
        trigger=WAITING_AT_RED,
        ways=((*DOORS, Tap("door.all")),),
    ),
    act(
        but(AT_THE_LIGHTS, {CABIN.PASSENGER_WINDOW: 60.0}),
        SignalIs(CABIN.PASSENGER_WINDOW, (0.0,)),
        *DOORS,
        Slide("window.passenger", 0.0),
        rule=THEFT_SOURCE,
        trigger=WAITING_AT_RED,
        ways=((*DOORS, Tap("window.close_all")),),
    ),
    "settings: a rear door is unlocked, or the passenger's window is open",
)

BARRIERS = pair(
    "comms_between_the_barriers",
    Module.COMMS,
    (
        "Three metres of lane, and a lorry beside me: if we're in that, nobody may ring me until we're out.",
        "I do my calls on the wide road. Where they've put barriers and an eighty, I'm not in.",
        "One ring in the narrow bit and I'm in the wall. See where we are, and keep the phone quiet if need be.",
        "Colleagues ring all morning. Fine, except between those yellow lines; no calls at all in there.",
        "While it's tight here I'm out for everyone. If it isn't tight yet, let them call.",
    ),
    act(
        WORKS,
        AppDataIs("phone.do_not_disturb", (True,)),
        Open("phone"),
        Tap("phone.do_not_disturb"),
        rule=WORKS_SOURCE,
        trigger=IN_THE_WORKS,
    ),
    rest(WORKS, WORKS_SOURCE, trigger=BEFORE_THE_WORKS),
    "road: in the roadworks, or on the open motorway before them",
    tags=PLACE,
)

AT_80 = SpeedAbove(50.0, 80.0, 80.0)
RINGING = tuple(Arrival("call", 15.0 + 33.0 * number, "Yasmin") for number in range(14))
"""Again and again, so that one of the calls comes with the ambulance."""
RINGS: dict[str, Any] = {"driver": "average", "start": NOON, "weather": FAIR, "arrivals": RINGING}
WITH_THE_SIREN = pair(
    "comms_rings_with_the_siren",
    Module.COMMS,
    (
        "Phone! I can't talk while I make room for somebody in a hurry. Look behind us, then take it or don't.",
        "It's ringing. Only if nobody with a blue light wants past; otherwise get rid of the caller.",
        "Answer that, unless an ambulance needs all my attention first; then refuse it.",
        "Her again! If there's a siren coming up, I'm spared: decline. If not, put her on.",
        "Ring ring! Pick up if the road behind is quiet, reject if help is on its way through.",
    ),
    act(
        start("beauce", "blue_light", **RINGS),
        EnteredOf("calls.declined", CALL.RINGING),
        Tap("call.decline"),
        rule=SIREN_SOURCE.partition(":")[0],
        trigger=Trigger(All((AT_80, BlueLightWithin(450.0), Not(SignalHas(CALL.RINGING, "")))), 1.0, 400.0),
        deadline=WHILE_IT_RINGS,
    ),
    act(
        start("beauce", "plain", **RINGS),
        EnteredOf("calls.answered", CALL.RINGING),
        Tap("call.answer"),
        rule=SIREN_SOURCE.partition(":")[0],
        trigger=Trigger(All((AT_80, Not(BlueLightWithin(3000.0)), Not(SignalHas(CALL.RINGING, "")))), 1.0, 400.0),
        deadline=WHILE_IT_RINGS,
    ),
    "traffic: an ambulance with blue light comes up from behind, or nobody does",
)

AT_FIFTY: dict[Signal[Any], Any] = {ADAS.CRUISE_ACTIVE: True, ADAS.CRUISE_SPEED: 50.0}
PAST_PUPILS: dict[str, Any] = {"driver": "calm", "weather": FAIR, "sign_camera": False}
HELD_AT_FIFTY = start("sydney", "school_run", AT_FIFTY, start="2026-11-18T11:20:00", **PAST_PUPILS)
PAST_THE_GATE = pair(
    "road_fifty_past_the_gate",
    Module.ROAD,
    (
        "Fifty, kept by the car, past a school. That's fine when they're all inside; correct it if they aren't.",
        "I let the cruise do the streets. If the yellow sign is awake, it's too fast for it; see to that.",
        "Drop-off time or not? The machine doesn't know, and it holds fifty. Put it right, if it's the hour.",
        "A fine outside a school is the last thing I need. Does what we're holding fit the plate's hours? Make it.",
        "If the school's limit holds at this hour, bring the cruise down to it.",
    ),
    Half(
        replace(HELD_AT_FIFTY, start=None),
        Trigger(All((InSchoolZone(), Driving())), 1.0, 300.0),
        AnyOf((SignalWithin(ADAS.CRUISE_SPEED, 10.0, 40.0), SignalIs(ADAS.CRUISE_ACTIVE, (False,)))),
        (*ASSIST, Tap("adas.cruise")),
        COMFORT,
        Basis.POSTED,
        "sign R4-230, 40 km/h on school days 8.00-9.30",
        ways=((*ASSIST, Tap("adas.cruise"), Tap("adas.cruise_speed.decrease", times=2), Tap("adas.cruise")),),
    ),
    decline(
        HELD_AT_FIFTY,
        Trigger(All((InSchoolZone(in_force=False), Driving())), 1.0, 300.0),
        COMFORT,
        Basis.POSTED,
        "sign R4-1, 50 km/h",
        reasons=NO_NEED,
        needed=False,
    ),
    "date: twenty past eight, when the school zone's 40 km/h apply, or twenty past eleven, when 50 do",
    tags=PLACE,
)

TASKS = (
    NO_BOAT,
    CURRENT,
    SUNGLASSES,
    YELLOW_LINES,
    UP_SINCE_FIVE,
    ONE_EAR,
    BY_THE_LINE,
    BUMPERS,
    RED_LAMP,
    SHARE,
    BALD,
    LEFT_ON_OFF,
    OVERFULL,
    LITTLE_DOOR,
    SHORT,
    STRANGER,
    BARRIERS,
    WITH_THE_SIREN,
    PAST_THE_GATE,
)
