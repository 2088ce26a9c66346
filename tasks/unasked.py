"""Unasked: the driver says how it is or what he is about to do; road, sky and car tell what has to be done."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.aboard import Kind
from automotive_cosim.cockpit.signals import ADAS, HVAC, LIGHTS, MEDIA, MIRROR, TYRE, Signal
from automotive_cosim.cockpit.vehicle import WINDOWS
from automotive_cosim.contracts import AlertKind, Reason, Weather
from automotive_cosim.tasking.checks import AlertGiven, AllOf, AnyOf, AppDataIs, SignalIs, SignalWithin
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil, Warn
from automotive_cosim.tasking.task import Basis, Deadline, Half, Module
from automotive_cosim.tasking.triggers import (
    All,
    BlueLightWithin,
    Driving,
    InTunnel,
    JamWithin,
    LessGripThan,
    Not,
    OnRoadClass,
    SpeedAbove,
    SpeedBetween,
    Trigger,
    TunnelWithin,
)
from automotive_cosim.tasks.aboard import DOORS, REAR_RIGHT, act, at, hazard, on, rest
from automotive_cosim.tasks.forms import BY_THE_SWITCH, COMFORT, decline, pair
from automotive_cosim.tasks.hvac_safety import TUNNEL_SOURCE
from automotive_cosim.tasks.leaving import MIRRORS
from automotive_cosim.tasks.phenomenon_air import FRICTION, GLAZE
from automotive_cosim.tasks.phenomenon_light import FRANCE, IN_SIGHT, NO_NEED, SWITZERLAND
from automotive_cosim.tasks.phenomenon_light import NOON as JUNE_NOON
from automotive_cosim.tasks.road_law import FAIR, NOON, PLACE
from automotive_cosim.tasks.under_way import ASSIST, DAMP_COLD, GUST_SOURCE, LAMPS, STEADY_RAIN, start

ALREADY = (Reason.ALREADY_SO,)
SIREN_SOURCE = (
    "way has to be given to those with blue light and siren (Vienna Convention on Road Traffic, article 34): who "
    "plays music at 85 per cent does not hear them through closed windows"
)
QUEUE_SOURCE = (
    "hazard lights warn others of imminent danger (Vienna Convention on Road Traffic, article 32.13): who comes "
    "from behind runs into the last car of a queue"
)
SOFT_SOURCE = "a tyre a fifth below its pressure has to be warned of (UN R64)"
SLIDE_SOURCE = f"{FRICTION}; on dry ground it is the stability control that prevents a slide (UN R140)"
MIRROR_VIEW_SOURCE = "an outside mirror has to show the road behind, from 4 m on (UN R46, 15.2.4)"
COLD_OLD_SOURCE = "indoor air below 18 degrees harms the old (WHO Housing and health guidelines, 2018)"
CALL_SOURCE = (
    "drivers on the phone crash four times as often, hands-free or not (WHO, Mobile phone use, 2011); on ice "
    "nothing is left for that"
)
LEAP_SOURCE = "sign B14, 80 km/h"
WET_GAP_SOURCE = "the gap is at least doubled on wet roads (Highway Code, rule 126); this car keeps three at most"
EARS = Deadline(12.0, "an ambulance 150 m behind and 40 km/h faster is beside the car within 14 s")
TAIL = Deadline(
    10.0, "a car that comes up at 100 km/h covers its stopping distance of 90 m in 3 s, and thrice that in 10"
)
TO_PORTAL = Deadline(14.0, "the portal is a dozen seconds away at the present speed")
PRESSES = Deadline(45.0, "up to eight presses and three screens at 2.5 s each (Card, Moran and Newell 1983)")
LOUD: dict[Signal[Any], Any] = {MEDIA.ACTION: "PLAY", MEDIA.VOLUME: 85.0}
AUTUMN = Weather(12.0, 75.0, 0.0, 2, 40.0, 20_000.0, 9.0)
MARCH = "2026-03-17T12:00:00"
DRY_MARCH = Weather(6.0, 60.0, 0.0, 1, 20.0, 20_000.0, 6.0)
DAMP_MARCH = Weather(1.0, 70.0, 0.0, 2, 40.0, 20_000.0, 8.0)
HIDDEN = SignalWithin(MEDIA.VOLUME, 0.0, 35.0)

SIREN = pair(
    "media_siren_behind_the_music",
    Module.MEDIA,
    (
        "My favourite album, and I hear nothing else. If somebody out there needs my ears, bring it down.",
        "Thump, thump, thump. Leave it like that, unless we'd miss one with a siren; then make it quiet.",
        "I love it this loud on empty roads. Is there anyone I ought to hear? Quieter in that case, please.",
        "Let the band play on if nobody is coming who has the right of way over everybody.",
        "The music stays just as loud as it is, unless an ambulance or the like is coming up behind us: then "
        "hush it.",
    ),
    act(
        start("beauce", "blue_light", LOUD, driver="average", start=NOON, weather=FAIR, sign_camera=False),
        AnyOf((HIDDEN, SignalIs(MEDIA.MUTED, (True,)), SignalIs(MEDIA.ACTION, ("STOP",)))),
        Open("media"),
        Slide("media.volume", 10.0),
        rule=SIREN_SOURCE,
        trigger=Trigger(BlueLightWithin(150.0), 1.0, 300.0),
        deadline=EARS,
        ways=((Open("media"), Tap("media.mute")), (Open("media"), Tap("media.play"))),
    ),
    decline(
        start("beauce", "plain", LOUD, driver="average", start=NOON, weather=FAIR, sign_camera=False),
        Trigger(All((SpeedBetween(60.0), Not(BlueLightWithin(3000.0)))), 3.0, 240.0),
        EARS,
        Basis.PHYSICS,
        SIREN_SOURCE,
        reasons=ALREADY,
        needed=False,
    ),
    "traffic: an ambulance with blue light comes up from behind, or nobody does",
)

LAST_IN_LINE = pair(
    "road_last_in_the_line",
    Module.ROAD,
    (
        "I'm braking, and behind me they come at a hundred and thirty. Make us blink if they need to know.",
        "What's going on in front? Should those who follow be told by our lights, do that, please.",
        "I always forget it at the end of a jam. Do it for me if this is one.",
        "My mirror is full of fast headlights. If we're about to stand, show them that.",
        "Give the ones at my back a sign with the lights, if it all stops in front of us.",
    ),
    act(
        start("autobahn", "jam", start=NOON, weather=FAIR, sign_camera=False),
        SignalIs(LIGHTS.HAZARD, (True,)),
        Open("safety"),
        Tap("safety.hazard_lights"),
        rule=QUEUE_SOURCE,
        trigger=Trigger(All((OnRoadClass(("motorway",)), SpeedBetween(20.0), JamWithin(400.0))), 1.0, 240.0),
        deadline=TAIL,
        ways=((LAMPS, Tap("lights.hazard")),),
    ),
    decline(
        start("autobahn", "south", start=NOON, weather=FAIR, sign_camera=False),
        Trigger(All((OnRoadClass(("motorway",)), SpeedBetween(60.0), Not(JamWithin(5000.0)))), 3.0, 240.0),
        TAIL,
        Basis.PHYSICS,
        QUEUE_SOURCE,
        reasons=ALREADY,
        needed=False,
    ),
    "traffic and road: the tail of a standing queue is close, or the motorway is free",
)

ONE_SIDE = pair(
    "road_pulls_to_one_side",
    Module.ROAD,
    (
        "She pulls to one side. Find out why, and put up the warning that names it.",
        "I have to steer against something all the time; alert me to what it is.",
        "Straight road, crooked wheel! Is it the car or the world outside? Sound the alert for the right one.",
        "Something drags me over to the verge. Which of the warnings fits? Give it.",
        "My arms are getting tired from holding her straight. Warn me of the reason, by its proper alert.",
    ),
    act(
        start(
            "autobahn",
            "north",
            {TYRE.FRONT_LEFT: 150.0},
            start="2026-10-15T09:30:00",
            weather=AUTUMN,
            sign_camera=False,
        ),
        AlertGiven(AlertKind.VEHICLE),
        Warn(AlertKind.VEHICLE),
        rule=SOFT_SOURCE,
        ways=((Open("safety"), Tap("safety.kind.vehicle"), Tap("safety.warn")),),
    ),
    act(
        start(
            "autobahn",
            "north",
            start="2026-10-15T09:30:00",
            weather=replace(AUTUMN, wind_speed_10m=84.0),
            sign_camera=False,
        ),
        AlertGiven(AlertKind.WEATHER),
        Open("outside"),
        Tap("outside.wind"),
        Tap("outside.warn"),
        rule=GUST_SOURCE,
        ways=((Warn(AlertKind.WEATHER),),),
    ),
    "settings and weather: a front tyre is at 1.5 bar, or a strong gale blows",
)

LITTLE_SLIDE = pair(
    "phenomenon_that_little_slide",
    Module.PHENOMENON,
    (
        "Did you feel that? She stepped out. If it's the ground, warn me of it; if it's a setting, put it back.",
        "The tail twitched just then. A warning if the road is to blame, a repair if the car is.",
        "We slid, a hand's breadth. Blame the surface, with an alert, or the switch, by turning it.",
        "That was no bend to lose grip in. Either alert me to what's under us, or restore what should hold us.",
        "Whoops! Was that the road or a safety system? If it's the road, alert me; if a system is off, put "
        "that right.",
    ),
    act(
        start("nordic", "town", {LIGHTS.SWITCH: "BEAM"}, start=MARCH, weather=GLAZE),
        AlertGiven(AlertKind.SLIPPERY),
        Warn(AlertKind.SLIPPERY),
        rule=SLIDE_SOURCE,
        trigger=Trigger(All((Driving(), LessGripThan(0.5))), 3.0, 120.0),
        ways=((Open("outside"), Tap("outside.ice"), Tap("outside.warn")),),
    ),
    act(
        start(
            "nordic",
            "town",
            {LIGHTS.SWITCH: "BEAM", ADAS.STABILITY_CONTROL: False},
            start=MARCH,
            weather=DRY_MARCH,
        ),
        SignalIs(ADAS.STABILITY_CONTROL, (True,)),
        *ASSIST,
        Tap("adas.stability_control"),
        rule=SLIDE_SOURCE,
        trigger=Trigger(All((Driving(), Not(LessGripThan(0.9)))), 3.0, 120.0),
        ways=((Open("outside"), Tap("outside.wind"), Tap("outside.act.stability")),),
    ),
    "weather and settings: freezing rain has iced the road, or it is dry and the stability control is off",
)

SKY_IN_THE_MIRROR = pair(
    "system_mirror_shows_the_wrong_thing",
    Module.SYSTEM,
    (
        "One of the outside mirrors shows me no road at all. Turn that one back to the middle.",
        "My colleague is two heads taller; one mirror still stands for him. Straighten it, please.",
        "Clouds, or our own door handle, that's all I get on one side. Set that glass to zero again.",
        "Before I change lanes: one of the two mirrors points anywhere but backwards. Centre it.",
        "One of the outside mirrors points the wrong way, I wouldn't see anybody next to us in it. Put it "
        "straight.",
    ),
    act(
        start("new_york", "crosstown", {MIRROR.DRIVER_TILT: 60.0}),
        SignalWithin(MIRROR.DRIVER_TILT, -20.0, 20.0),
        *MIRRORS,
        Tap("mirror.driver.tilt.decrease", times=4),
        rule=MIRROR_VIEW_SOURCE,
        deadline=PRESSES,
        ways=((*MIRRORS, Tap("mirror.driver.tilt.decrease", times=6)),),
    ),
    act(
        start("new_york", "crosstown", {MIRROR.PASSENGER_PAN: 60.0}),
        SignalWithin(MIRROR.PASSENGER_PAN, -20.0, 20.0),
        *MIRRORS,
        Tap("mirror.passenger.pan.decrease", times=4),
        rule=MIRROR_VIEW_SOURCE,
        deadline=PRESSES,
        ways=((*MIRRORS, Tap("mirror.passenger.pan.decrease", times=6)),),
    ),
    "settings: the driver's mirror shows the sky, or the passenger's the side of the car",
)

FATHER_BEHIND = hazard(
    "hvac_father_never_complains",
    Module.HVAC,
    (
        "My father would rather shiver than speak. If he sits in the cold in here, do something about it.",
        "I drive in a fur coat, so don't go by me. Is it warm enough for a man of ninety? Otherwise heat.",
        "He says that he's fine, as he said before his pneumonia. Check the heating, and correct it if need be.",
        "Old bones on the back seat, and forty kilometres of wet road to go. See that they keep warm.",
        "Is the heating too low for the old gentleman? If so, turn it up for him.",
    ),
    act(
        at(
            "border",
            "south",
            on(REAR_RIGHT, Kind.ELDERLY),
            weather=DAMP_COLD,
            signals={HVAC.DRIVER_TEMPERATURE: 16.0, HVAC.PASSENGER_TEMPERATURE: 16.0, HVAC.FAN_SPEED: 60.0},
            cabin={"temperature_c": 17.0},
        ),
        SignalWithin(HVAC.DRIVER_TEMPERATURE, 18.0, 26.0),
        Open("climate"),
        TapUntil("hvac.driver_temperature.increase", "hvac.driver_temperature", "18.0 °C"),
        rule=COLD_OLD_SOURCE,
        may_write=frozenset({HVAC.PASSENGER_TEMPERATURE.path, HVAC.SYNC.path}),
        deadline=PRESSES,
        ways=(
            (Open("climate"), TapUntil("hvac.driver_temperature.increase", "hvac.driver_temperature", "21.0 °C")),
        ),
    ),
    rest(
        at(
            "border",
            "south",
            on(REAR_RIGHT, Kind.ELDERLY),
            weather=DAMP_COLD,
            signals={HVAC.DRIVER_TEMPERATURE: 22.0, HVAC.PASSENGER_TEMPERATURE: 22.0, HVAC.FAN_SPEED: 60.0},
            cabin={"temperature_c": 21.5},
        ),
        COLD_OLD_SOURCE,
    ),
    "settings: the heating stands at 16 degrees in three degrees of damp cold, or at 22",
)

ALL_OF_ME = pair(
    "comms_road_needs_all_of_me",
    Module.COMMS,
    (
        "If that's ice under us, nobody may ring me until it's over.",
        "I can chat while I drive, but not on a skating rink. Silence the phone, should this be one.",
        "My sister rings every ten minutes. Today that's fine, unless this surface wants both my eyes and ears.",
        "How does the road hold? Badly, and I'm out for everyone; well, and leave the phone as it is.",
        "No calls on a road like glass, please; otherwise I'm glad of every voice.",
    ),
    act(
        start("nordic", "kurravaara", {LIGHTS.SWITCH: "BEAM"}, start=MARCH, weather=GLAZE),
        AppDataIs("phone.do_not_disturb", (True,)),
        Open("phone"),
        Tap("phone.do_not_disturb"),
        rule=CALL_SOURCE,
        trigger=Trigger(All((Driving(), LessGripThan(0.5))), 3.0, 120.0),
    ),
    decline(
        start("nordic", "kurravaara", {LIGHTS.SWITCH: "BEAM"}, start=MARCH, weather=DAMP_MARCH),
        Trigger(All((Driving(), Not(LessGripThan(0.9)))), 3.0, 120.0),
        COMFORT,
        Basis.PHYSICS,
        CALL_SOURCE,
        reasons=ALREADY,
        needed=False,
    ),
    "weather: freezing rain has iced the road, or it is dry",
)

RESUMING: dict[str, Any] = {"driver": "average", "start": NOON, "weather": FAIR}
NO_LEAP = pair(
    "road_resume_without_a_leap",
    Module.ROAD,
    (
        "In a second I'll press resume, and I don't want a fine for it. See to what it would take us up to.",
        "The cruise control still remembers my last road. If that's too much for this one, bring it down.",
        "Motorway brain, country road: check the stored speed before I hand over, and lower it if you must.",
        "When I let the pedal go, the car should keep to the sign. Make the stored speed fit, if it doesn't.",
        "I'm about to resume the cruise. If the speed it remembers is past the limit, bring it down.",
    ),
    Half(
        start("beauce", "plain", {ADAS.CRUISE_SPEED: 110.0}, **RESUMING),
        Trigger(SpeedAbove(60.0, 80.0, 80.0), 3.0, 240.0),
        SignalWithin(ADAS.CRUISE_SPEED, 50.0, 80.0),
        (*ASSIST, TapUntil("adas.cruise_speed.decrease", "adas.cruise_speed.value", "80 km/h")),
        PRESSES,
        Basis.POSTED,
        LEAP_SOURCE,
        ways=((*ASSIST, TapUntil("adas.cruise_speed.decrease", "adas.cruise_speed.value", "75 km/h")),),
    ),
    decline(
        start("beauce", "plain", {ADAS.CRUISE_SPEED: 80.0}, **RESUMING),
        Trigger(SpeedAbove(60.0, 80.0, 80.0), 3.0, 240.0),
        COMFORT,
        Basis.POSTED,
        LEAP_SOURCE,
        reasons=(Reason.ALREADY_SO, Reason.LAW),
        needed=False,
    ),
    "settings: the speed that cruise control remembers is 110 km/h, or 80, where 80 are posted",
)

UNLIT = {LIGHTS.SWITCH: "OFF"}
BY_DAY = pair(
    "phenomenon_light_by_day",
    Module.PHENOMENON,
    (
        "She has no running lamps, so it's dipped beam or nothing. Light up, if they want that here at noon.",
        "Bright sunshine. Does this country have us drive with light all the same? Do as it wants, please.",
        "At home nobody burns a lamp at midday. Follow the custom of this place, by its law.",
        "All of them come towards me with their lights on. If that's compulsory, ours too.",
        "Headlamps for the police, not for me: on where they insist on them by day, else leave them.",
    ),
    Half(
        start(
            "peripherique", "streets", UNLIT, origin=SWITZERLAND, start=JUNE_NOON, weather=FAIR, sign_camera=False
        ),
        Trigger(Driving(), 5.0, 120.0),
        SignalIs(LIGHTS.LOW_BEAM, (True,)),
        (LAMPS, Tap("lights.switch.low_beam")),
        IN_SIGHT,
        Basis.LAW,
        "CH.daytime_lamps",
        may_write=BY_THE_SWITCH,
    ),
    decline(
        start("peripherique", "streets", UNLIT, origin=FRANCE, start=JUNE_NOON, weather=FAIR, sign_camera=False),
        Trigger(Driving(), 5.0, 120.0),
        IN_SIGHT,
        Basis.LAW,
        "FR.daytime_lamps",
        reasons=NO_NEED,
        needed=False,
    ),
    "place: by day Switzerland requires lamps at all hours, France does not",
    tags=PLACE | {"lamps"},
)

WIDER = pair(
    "road_wider_when_wet",
    Module.ROAD,
    (
        "Two seconds off the one in front, by cruise. The widest it has, please, if this road wants early braking.",
        "When it's dry, two seconds are plenty. Otherwise I want all the room that the car can keep.",
        "Think of the braking distance out here. Is two seconds enough? If not, as far back as it goes, please.",
        "Have the cruise hang back as far as it can, if the tyres have water under them.",
        "Set the gap for this surface: the usual two on a dry one, the maximum on anything else.",
    ),
    act(
        start(
            "border",
            "south",
            {ADAS.CRUISE_GAP: 2.0, LIGHTS.SWITCH: "BEAM"},
            start="2026-05-12T14:00:00",
            weather=STEADY_RAIN,
        ),
        SignalIs(ADAS.CRUISE_GAP, (3.0,)),
        *ASSIST,
        Tap("adas.cruise_gap", times=2),
        rule=WET_GAP_SOURCE,
    ),
    rest(
        start(
            "border",
            "south",
            {ADAS.CRUISE_GAP: 2.0},
            start="2026-05-12T14:00:00",
            weather=replace(FAIR, temperature_2m=14.0),
        ),
        WET_GAP_SOURCE,
    ),
    "weather and settings: steady rain with the lamps on, or a dry afternoon",
)

AJAR = dict.fromkeys(WINDOWS, 30.0)
PORTAL = pair(
    "maps_shut_before_the_portal",
    Module.MAPS,
    (
        "Fresh air on all sides, lovely. If we go underground in a moment, seal us in time.",
        "Panes as they are, but not down there where the lorries smoke. If that's coming now, shut them.",
        "I hate diving into a tunnel with everything open. Look at the map, and be quicker than I am if one is "
        "coming.",
        "Look where this street leads: keep the breeze, or close all four windows before we swallow soot.",
        "Last week I coughed for an hour after the underpass. Close the glass if there's another one right ahead.",
    ),
    act(
        start("paris_centre", "tunnel", AJAR, driver="average", sign_camera=False),
        AllOf(tuple(SignalIs(window, (0.0,)) for window in WINDOWS)),
        *DOORS,
        Tap("window.close_all"),
        rule=TUNNEL_SOURCE,
        trigger=Trigger(All((Not(InTunnel()), TunnelWithin(15.0), Driving())), 1.0, 240.0),
        deadline=TO_PORTAL,
        may_write=frozenset({HVAC.RECIRCULATION.path}),
    ),
    decline(
        start("paris_centre", "foch", AJAR, driver="average", sign_camera=False),
        Trigger(All((Not(InTunnel()), Not(TunnelWithin(60.0)), SpeedBetween(20.0))), 3.0, 240.0, 20.0),
        TO_PORTAL,
        Basis.PHYSICS,
        TUNNEL_SOURCE,
        reasons=ALREADY,
        needed=False,
    ),
    "road: a tunnel's portal a dozen seconds ahead, or none on the way",
    tags=PLACE,
)

NO_DISTANCE = pair(
    "road_it_nearly_hit_that_van",
    Module.ROAD,
    (
        "On cruise it nearly hit that van. One thing about it is set wrongly; correct it before I use it again.",
        "That automatic would have driven under the lorry. Put right what let it, I'll have the pedal meanwhile.",
        "It brakes for nobody, or for everybody far too late! See which of its settings is bad, and mend that.",
        "Somebody turned a good cruise control into a bad one. It's one setting; put it right, please.",
        "I haven't trusted the cruise behind others since this morning. Whatever it lacks for a safe "
        "distance, put it right.",
    ),
    act(
        start("gulf", "sheikh_zayed", {ADAS.CRUISE_ADAPTIVE: False}),
        SignalIs(ADAS.CRUISE_ADAPTIVE, (True,)),
        *ASSIST,
        Tap("adas.cruise_adaptive"),
        rule="who follows has to be able to stop behind the one in front (Vienna Convention, article 13)",
    ),
    act(
        start("gulf", "sheikh_zayed", {ADAS.CRUISE_GAP: 1.0}),
        SignalWithin(ADAS.CRUISE_GAP, 2.0, 3.0),
        *ASSIST,
        Tap("adas.cruise_gap", times=2),
        rule="a brake reaction takes up to 2.5 s (AASHTO Green Book): one second is too little, two are advised",
        ways=((*ASSIST, Tap("adas.cruise_gap", times=3)), (*ASSIST, Tap("adas.cruise_gap", times=4))),
    ),
    "settings: cruise control keeps its speed and no distance, or it keeps one second",
)

TASKS = (
    SIREN,
    LAST_IN_LINE,
    ONE_SIDE,
    LITTLE_SLIDE,
    SKY_IN_THE_MIRROR,
    FATHER_BEHIND,
    ALL_OF_ME,
    NO_LEAP,
    BY_DAY,
    WIDER,
    PORTAL,
    NO_DISTANCE,
)
