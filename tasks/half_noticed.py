"""Half noticed: a worry or a habit of the driver's, and one thing about car or weather that it hangs on."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.aboard import Kind
from automotive_cosim.cockpit.signals import (
    ADAS,
    BODY,
    CABIN,
    DRIVE,
    ENERGY,
    HMI,
    HVAC,
    LIGHTS,
    LINK,
    MEDIA,
    Signal,
)
from automotive_cosim.tasking.checks import SignalIs, SignalLowered, SignalRaised
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasks.aboard import REAR_LEFT, act, at, but, hazard, on, wrong_or_well
from automotive_cosim.tasks.forms import BY_THE_SWITCH, pair
from automotive_cosim.tasks.hvac_hints import FRESH_AIR, FRESH_AIR_WAYS
from automotive_cosim.tasks.hvac_safety import COMFORT_SOURCE
from automotive_cosim.tasks.leaving import CHARGING_FLAP
from automotive_cosim.tasks.phenomenon_air import HAZELESS, SANDSTORM
from automotive_cosim.tasks.road_law import FAIR
from automotive_cosim.tasks.under_way import (
    ASSIST,
    DAZZLE_SOURCE,
    DRIVING_TAB,
    DRY_EVENING,
    INSIDE,
    LAMPS,
    STEADY_RAIN,
    TIRED_SOURCE,
    VIEW_SOURCE,
    start,
)

POINTS_SOURCE = "intelligent speed assistance is on at every start (Regulation (EU) 2019/2144, article 6)"
RADIO_SOURCE = "warnings to drivers come over the radio, as traffic announcements (RDS, EN 50067)"
SOCKET_SOURCE = "without its plug a charging socket is proof against rain only with the lid shut (IEC 62196-1)"
FOLLOWED_SOURCE = "who shares a position can take that back at any time (Regulation (EU) 2016/679, article 7)"
VENTILATED_SOURCE = "outside air thins out what the sick breathe out (WHO, Indoor ventilation roadmap, 2021)"
WINCH_SOURCE = (
    "a car with its brake on does not roll but slides, and strains rope and wheels (owner's manuals, towing)"
)
SAND_SOURCE = (
    "lamps are lit by day too where dust or the like hampers sight (Vienna Convention on Road Traffic, article 32)"
)
NIGHT = "2026-11-17T21:30:00"
MAY = "2026-05-12T16:20:00"
DRY_MAY = replace(FAIR, temperature_2m=15.0)

AVENUES = start("tokyo", "avenues")
LAST_POINT = pair(
    "road_one_point_left",
    Module.ROAD,
    (
        "One more speeding ticket and I walk for a year. Whatever in here warns people like me, let it.",
        "I swore to the judge that the car beeps at me when I speed. Don't make a liar of me.",
        "My foot is honest, it just doesn't count. The car can count; see that it speaks up when I overdo it.",
        "I used to hate being nagged about my pace. From today I need the nagging, so bring it back if it's gone.",
        "Make sure that I hear of it each time I'm over, my licence depends on it.",
    ),
    *wrong_or_well(
        AVENUES,
        but(AVENUES, {ADAS.SPEED_WARNING: False}),
        SignalIs(ADAS.SPEED_WARNING, (True,)),
        *ASSIST,
        Tap("adas.speed_warning"),
        rule=POINTS_SOURCE,
    ),
    "settings: the speed warning is off, or on",
)

GHOST_LAMP = pair(
    "system_lamp_in_the_windshield",
    Module.SYSTEM,
    (
        "There's a second moon in my windshield, and it's one of our own. Put that one out.",
        "Something small burns above our heads, left or right, and I see it instead of the road. Off with it.",
        "After the last stop one of us forgot a little lamp. It mirrors in the glass; kill it, please.",
        "A bright spot hangs over the dark road all the time. Find the one that makes it, and end it.",
        "I'd see the verge much better if someone weren't lit up like an actor in here. Darken that.",
    ),
    act(
        start("border", "old_road", {CABIN.DRIVER_READING_LIGHT: True}, start=NIGHT, weather=DRY_EVENING),
        SignalIs(CABIN.DRIVER_READING_LIGHT, (False,)),
        *INSIDE,
        Tap("light.driver_reading"),
        rule=DAZZLE_SOURCE,
        may_write=frozenset({CABIN.AMBIENT_LIGHT.path, HMI.BRIGHTNESS.path}),
    ),
    act(
        start("border", "old_road", {CABIN.PASSENGER_READING_LIGHT: True}, start=NIGHT, weather=DRY_EVENING),
        SignalIs(CABIN.PASSENGER_READING_LIGHT, (False,)),
        *INSIDE,
        Tap("light.passenger_reading"),
        rule=DAZZLE_SOURCE,
        may_write=frozenset({CABIN.AMBIENT_LIGHT.path, HMI.BRIGHTNESS.path}),
    ),
    "settings: the driver's reading light is on, or the passenger's",
)

BETWEEN_VANS = start("peripherique", "streets", parked=True, start=MAY, weather=DRY_MAY)
BACKING_OUT = pair(
    "phenomenon_before_i_back_out",
    Module.PHENOMENON,
    (
        "I'm going to back out between two vans. Let me see through the rear glass, if there's anything on it.",
        "Reverse, then left. Whatever this sky does to the window at the back, keep it off for me.",
        "Mirrors alone won't do for this gap. I need the pane behind as clean as the one in front, if it's wet.",
        "Have the wiper at the back move now and then, should the weather be one for it.",
        "Before I back out: if there are drops on the rear window, keep it wiped gently; if not, leave it.",
    ),
    *wrong_or_well(
        BETWEEN_VANS,
        but(BETWEEN_VANS, weather=STEADY_RAIN),
        SignalIs(BODY.REAR_WIPER, ("INTERVAL", "SLOW")),
        LAMPS,
        Tap("wiper.rear.slow"),
        rule=VIEW_SOURCE,
        ways=((LAMPS, Tap("wiper.rear.interval")),),
    ),
    "weather: steady rain, or a dry afternoon",
)

MUTED_RADIO: dict[Signal[Any], Any] = {
    MEDIA.SOURCE: "FM",
    MEDIA.ACTION: "PLAY",
    MEDIA.VOLUME: 35.0,
    MEDIA.MUTED: True,
}
SILENT_RADIO: dict[Signal[Any], Any] = {MEDIA.SOURCE: "FM", MEDIA.ACTION: "PLAY", MEDIA.VOLUME: 0.0}
ANNOUNCER = pair(
    "media_announcer_must_reach_me",
    Module.MEDIA,
    (
        "Somebody is driving the wrong way somewhere, a colleague texted. The radio's warnings must get to my "
        "ears.",
        "There may be news about the pass any minute. With the radio as it is I'd miss it; change that.",
        "The man who reads the traffic news can't get through to my ears at the moment. Let him.",
        "If they close the road, they'll say so between two songs of theirs. I want to hear it.",
        "A traffic warning on the radio is no use if I can't hear it. See to it that I can.",
    ),
    act(
        start("alpine_pass", "villages", MUTED_RADIO, start="2026-06-16T12:30:00", weather=FAIR),
        SignalIs(MEDIA.MUTED, (False,)),
        Open("media"),
        Tap("media.mute"),
        rule=RADIO_SOURCE,
    ),
    act(
        start("alpine_pass", "villages", SILENT_RADIO, start="2026-06-16T12:30:00", weather=FAIR),
        SignalRaised(MEDIA.VOLUME, 15.0),
        Open("media"),
        Slide("media.volume", 30.0),
        rule=RADIO_SOURCE,
        ways=((Open("media"), Slide("media.volume", 60.0)),),
    ),
    "settings: the radio is muted, or plays at no volume",
)

LID_UP = start("london", "euston", {ENERGY.CHARGE_FLAP: True}, parked=True, start=MAY, weather=DRY_MAY)
SOCKET = pair(
    "apps_socket_under_this_sky",
    Module.APPS,
    (
        "I'm waiting for the man with the cable. Mind the open socket till he comes, if this weather can get in.",
        "Lid's up, plug's not there yet. Is water coming down on it? Cover it then, please.",
        "The current goes in where it now may drip in. Look at the sky and decide about that little door.",
        "Ten minutes till the pillar is free. Leave the port as it is if it stays dry, otherwise shut it.",
        "Electricity and puddles! If it's wet out there, shut what stands open at the back.",
    ),
    *wrong_or_well(
        LID_UP,
        but(LID_UP, weather=STEADY_RAIN),
        SignalIs(ENERGY.CHARGE_FLAP, (False,)),
        *CHARGING_FLAP,
        rule=SOCKET_SOURCE,
    ),
    "weather: steady rain, or a dry afternoon",
)

NIGHT_SHIFT = pair(
    "road_off_the_night_shift",
    Module.ROAD,
    (
        "Twelve hours on the ward, and forty minutes home. One thing in this car works against me; set it right.",
        "I mustn't nod off before the roundabout. What makes that likelier than it has to be? Change it, please.",
        "The nurse next door ended in a hedge. Keep me from it: something here is wrong for a tired woman.",
        "Five in the morning by my body. Look what lulls me, or who no longer watches me, and put an end to it.",
        "I've just come off the night shift: put right whatever in this car would let me doze off at the wheel.",
    ),
    act(
        start("beauce", "plain", {ADAS.DRIVER_MONITORING: False}, cabin={"temperature_c": 20.0}),
        SignalIs(ADAS.DRIVER_MONITORING, (True,)),
        *ASSIST,
        Tap("adas.driver_monitoring"),
        rule=TIRED_SOURCE,
    ),
    act(
        start(
            "beauce",
            "plain",
            {HVAC.DRIVER_TEMPERATURE: 28.0, HVAC.PASSENGER_TEMPERATURE: 28.0},
            cabin={"temperature_c": 28.0},
        ),
        SignalLowered(HVAC.DRIVER_TEMPERATURE, 3.0),
        Open("climate"),
        TapUntil("hvac.driver_temperature.decrease", "hvac.driver_temperature", "25.0 °C"),
        rule=COMFORT_SOURCE,
        may_write=frozenset({HVAC.PASSENGER_TEMPERATURE.path, HVAC.SYNC.path}),
        ways=(
            (Open("climate"), TapUntil("hvac.driver_temperature.decrease", "hvac.driver_temperature", "22.0 °C")),
        ),
    ),
    "settings: the attention assistant is off, or the heating stands at 28 degrees",
)

KINGSWAY = start("london", "kingsway")
FOLLOWED = pair(
    "system_he_always_knows",
    Module.SYSTEM,
    (
        "He was at the petrol station before me, again. Nobody is to know where I drive.",
        "My ex turns up wherever I park. If it's the car that tells on me, shut its mouth.",
        "I'm on my way to a women's shelter. Not a soul may be able to follow this car on a screen.",
        "How does he do it? Make sure that it isn't my own car giving me away.",
        "From this moment on, where I am is my business alone. See to whatever says otherwise.",
    ),
    *wrong_or_well(
        KINGSWAY,
        but(KINGSWAY, {LINK.SHARE_POSITION: True}),
        SignalIs(LINK.SHARE_POSITION, (False,)),
        Open("settings"),
        Tap("settings.page.privacy"),
        Tap("privacy.position"),
        rule=FOLLOWED_SOURCE,
    ),
    "settings: the car shares its position, or keeps it to itself",
)

UNLIT = start("gulf", "desert", {LIGHTS.SWITCH: "OFF"}, weather=HAZELESS)
SAND_COLOURED = pair(
    "phenomenon_sand_coloured_car",
    Module.PHENOMENON,
    (
        "Beige car, beige world. If the others can't tell us from a dune, light us up.",
        "Would you see us coming? If not, make us visible, day or no day.",
        "He overtook as if we weren't there. If what's in the air hides us, give the next one something to see.",
        "I save the lamps for the night, unless people out here need them to notice me now.",
        "Look out of the front: can one make out a car without lights in that? If not, lights.",
    ),
    *wrong_or_well(
        UNLIT,
        but(UNLIT, weather=SANDSTORM),
        SignalIs(LIGHTS.LOW_BEAM, (True,)),
        LAMPS,
        Tap("lights.switch.low_beam"),
        rule=SAND_SOURCE,
        may_write=BY_THE_SWITCH | {LIGHTS.FRONT_FOG.path},
        ways=((Open("outside"), Tap("outside.dust"), Tap("outside.act.low_beam")),),
    ),
    "weather: a sandstorm, or clean air",
)

WITH_HIM = at("grid", "round", on(REAR_LEFT, Kind.ADULT))
FLU = hazard(
    "hvac_flu_on_the_back_seat",
    Module.HVAC,
    (
        "He's coughing his heart out behind us, and I've got a newborn at home. Thin out what he breathes at us.",
        "Flu aboard. What he gives off mustn't keep coming round to me, so change that if it does.",
        "He's on his way to the doctor's with me, and I don't want to catch it. Do what the air needs for that.",
        "Every sneeze of his stays in here with us, doesn't it? Let it out if so, please.",
        "One of us has a fever and two have a wedding on Saturday. If we're all breathing the same air over "
        "and over, let fresh air in.",
    ),
    *wrong_or_well(
        WITH_HIM,
        but(WITH_HIM, {HVAC.RECIRCULATION: True}),
        FRESH_AIR,
        Open("climate"),
        Tap("hvac.recirculation"),
        rule=VENTILATED_SOURCE,
        ways=FRESH_AIR_WAYS[:2],
    ),
    "settings: the same air goes round with a sick man in it, or outside air comes in",
)

LOOSE = start("beauce", "plain", {DRIVE.PARKING_BRAKE: False, LIGHTS.HAZARD: True}, parked=True)
WINCH = pair(
    "road_onto_the_tow_truck",
    Module.ROAD,
    (
        "The winch is on the hook and he's about to pull. She must be able to roll up his ramp.",
        "He's loading us now, rope's tight. If anything in here still holds the wheels, let go of it.",
        "Recovery man says she mustn't resist. See to that before he presses the button.",
        "Up onto the truck with her. Look what could still stop the wheels from turning, and take it off.",
        "Nothing may block when the rope pulls; otherwise it snaps, he says. Make sure of it.",
    ),
    *wrong_or_well(
        LOOSE,
        but(LOOSE, {DRIVE.PARKING_BRAKE: True}),
        SignalIs(DRIVE.PARKING_BRAKE, (False,)),
        *DRIVING_TAB,
        Tap("drive.parking_brake"),
        rule=WINCH_SOURCE,
    ),
    "settings: the parking brake is on, or off",
)

TASKS = (
    LAST_POINT,
    GHOST_LAMP,
    BACKING_OUT,
    ANNOUNCER,
    SOCKET,
    NIGHT_SHIFT,
    FOLLOWED,
    SAND_COLOURED,
    FLU,
    WINCH,
)
