"""One of two things is wrong: the driver speaks of a worry, and the state of the car tells what to do about it."""

from __future__ import annotations

from automotive_cosim.cockpit.aboard import Kind, Occupant
from automotive_cosim.cockpit.signals import ADAS, BODY, CABIN, DRIVE, HVAC, MEDIA, MIRROR, SEAT
from automotive_cosim.contracts import AlertKind, Weather
from automotive_cosim.tasking.checks import AlertGiven, SignalIs, SignalRaised, SignalWithin
from automotive_cosim.tasking.moves import Open, Slide, Tap, Warn
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasks.aboard import (
    CABIN_SCREEN,
    DOORS,
    PASSENGER,
    REAR_LEFT,
    REAR_RIGHT,
    SEATS,
    act,
    at,
    hazard,
    on,
)
from automotive_cosim.tasks.forms import pair
from automotive_cosim.tasks.hvac_aboard import BURN_SOURCE
from automotive_cosim.tasks.hvac_safety import COOL, COOL_WAYS, COOLED
from automotive_cosim.tasks.leaving import LOAD_SOURCE, UNATTENDED_SOURCE, parked
from automotive_cosim.tasks.phenomenon_air import DUST_SOURCE, SANDSTORM
from automotive_cosim.tasks.system_aboard import AIRBAG_SOURCE, RECLINE_SOURCE
from automotive_cosim.tasks.system_doors_aboard import CHILD_LOCK_SOURCE, LOOSE_DOG_SOURCE, WINDOW_LOCK_SOURCE
from automotive_cosim.tasks.under_way import ASSIST, DRIVING_TAB, LAMPS, start

BRUSH_SOURCE = "brushes tear off wipers that wake up, and wash in at whatever is open (owner's manuals, car wash)"
BEGINNER_SOURCE = "emergency braking is on at every start (UN R152); sport mode answers the same foot with more"
BIKE_SOURCE = "one in ten who die in EU traffic rides a bicycle (European Commission, Road safety statistics)"
YARD_SOURCE = "reversing cars hit small children whom no mirror shows (NHTSA, hence FMVSS 111)"
THEFT_SOURCE = "whoever leaves a car prevents its use by others (Vienna Convention on Road Traffic, article 23)"
HOT_CHILD_SOURCE = "a child's body warms up three to five times as fast as an adult's (NHTSA, heatstroke)"
HEAT = Weather(33.0, 40.0, 0.0, 0, 5.0, 20_000.0, 8.0)
JULY = "2026-07-14T15:00:00"
SENSORS = (*ASSIST, Tap("adas.parking_sensors"))
REAR_HEAT = (Open("climate"), Tap("hvac.comfort"), Tap("hvac.rear_left_seat_heating"))
FOLDED = frozenset({MIRROR.DRIVER_FOLDED.path, MIRROR.PASSENGER_FOLDED.path})
"""Mirrors may be folded in as well."""
FOR_RASCALS = frozenset({CABIN.LEFT_CHILD_LOCK.path, CABIN.RIGHT_CHILD_LOCK.path, HVAC.KEPT.path})
"""What may be done for children who stay, besides."""
SMALL_HANDS = (on(REAR_LEFT, Kind.CHILD), Occupant(REAR_RIGHT, Kind.ADULT))


BUTTONS_AND_HANDLES = hazard(
    "system_buttons_and_handles",
    Module.SYSTEM,
    (
        "The lad behind me has discovered that things open. Secure what isn't secured where he sits.",
        "Two little hands at work back there! Lock the last thing that they can still open, please.",
        "Of what keeps him in, one is missing. Find it and switch it on.",
        "I've done most of the child-proofing on his side; do the rest.",
        "He mustn't be able to open anything on the left. Do whatever's still missing for that.",
    ),
    act(
        at("grid", "round", *SMALL_HANDS, signals={CABIN.LEFT_CHILD_LOCK: True}),
        SignalIs(CABIN.WINDOW_LOCK, (True,)),
        *DOORS,
        Tap("window.lock"),
        rule=WINDOW_LOCK_SOURCE,
    ),
    act(
        at("grid", "round", *SMALL_HANDS, signals={CABIN.WINDOW_LOCK: True}),
        SignalIs(CABIN.LEFT_CHILD_LOCK, (True,)),
        *DOORS,
        Tap("door.child_left"),
        rule=CHILD_LOCK_SOURCE,
    ),
    "settings: the child lock is on and the windows are free, or the windows are locked and the door is not",
)

CAR_WASH = pair(
    "system_before_the_brushes",
    Module.SYSTEM,
    (
        "Next in line for the car wash. Put right what the brushes would punish.",
        "The man waves us in; is she ready for water from all sides? If not, make her.",
        "Soap in ten seconds! See to anything on the outside that's still set for driving.",
        "I forgot something last time and it cost me two hundred. Prepare the car for the rollers, please.",
        "Gate's open, foam is on. Wipers and windows: something there isn't ready for the brushes yet, see to it.",
    ),
    act(
        parked("beauce", "plain", **{BODY.FRONT_WIPER.path: "RAIN_SENSOR"}),
        SignalIs(BODY.FRONT_WIPER, ("OFF",)),
        LAMPS,
        Tap("wiper.front.off"),
        rule=BRUSH_SOURCE,
        may_write=FOLDED,
    ),
    act(
        parked("beauce", "plain", **{BODY.FRONT_WIPER.path: "OFF", CABIN.REAR_LEFT_WINDOW.path: 20.0}),
        SignalIs(CABIN.REAR_LEFT_WINDOW, (0.0,)),
        *DOORS,
        Slide("window.rear_left", 0.0),
        rule=BRUSH_SOURCE,
        may_write=FOLDED,
        ways=((*DOORS, Tap("window.close_all")),),
    ),
    "settings: the wipers wait for drops, or they are off and a rear window is ajar",
)

FOR_A_BEGINNER = pair(
    "road_for_a_beginner",
    Module.ROAD,
    (
        "Mia has had her licence for a week and takes over here. Undo what isn't for beginners.",
        "New driver in a minute! Leave her the car as the factory meant it for cautious people.",
        "One of my settings isn't for a novice, and now one gets the key. Make that safe again.",
        "Set the thing back that would frighten a learner's mother.",
        "She drives home from here, for the first time. Whatever isn't right for a beginner, set right, please.",
    ),
    act(
        parked("border", "old_road", **{DRIVE.MODE.path: "SPORT"}),
        SignalIs(DRIVE.MODE, ("NORMAL", "ECONOMY")),
        *DRIVING_TAB,
        Tap("drive.mode.normal"),
        rule=BEGINNER_SOURCE,
        ways=((*DRIVING_TAB, Tap("drive.mode.economy")),),
    ),
    act(
        parked("border", "old_road", **{ADAS.EMERGENCY_BRAKING.path: False}),
        SignalIs(ADAS.EMERGENCY_BRAKING, (True,)),
        *ASSIST,
        Tap("adas.emergency_braking"),
        rule=BEGINNER_SOURCE,
    ),
    "settings: the car is in sport mode, or its emergency braking is off",
)

BIKES = pair(
    "road_bikes_on_both_sides",
    Module.ROAD,
    (
        "Couriers left, couriers right. Should one of the sensors that look out for them be off, wake it, please.",
        "I'd never forgive myself for a cyclist. Activate whichever guard is asleep.",
        "This town rides bicycles. Have everything that sees them watch with me.",
        "Somebody turned one of the helpers off that I need among all these handlebars: on with it.",
        "They come out of nowhere, in front and beside. Switch on what's missing for that.",
    ),
    act(
        start("london", "strand", {ADAS.BLIND_SPOT: False}),
        SignalIs(ADAS.BLIND_SPOT, (True,)),
        *ASSIST,
        Tap("adas.blind_spot"),
        rule=BIKE_SOURCE,
    ),
    act(
        start("london", "strand", {ADAS.FORWARD_COLLISION_WARNING: False}),
        SignalIs(ADAS.FORWARD_COLLISION_WARNING, (True,)),
        *ASSIST,
        Tap("adas.collision_warning"),
        rule=BIKE_SOURCE,
    ),
    "settings: the blind spot assistant is off, or the collision warning",
)

PLAYING = {MEDIA.ACTION.path: "PLAY"}
OUT_OF_THE_YARD = pair(
    "road_out_of_the_yard",
    Module.ROAD,
    (
        "Backing out now, between tricycles. I want to notice every one of them, so remove what stands in the way.",
        "There are toddlers all over the yard. Give me back my ears for that, the car's or mine.",
        "Reverse, with half the kindergarten behind me: make sure that I'd hear it if something is there.",
        "Before I roll backwards: nothing should keep a warning from reaching me.",
        "I'm backing out of this courtyard and count on the beeps. Change whatever keeps me from hearing them.",
    ),
    act(
        parked("peripherique", "streets", **PLAYING, **{ADAS.PARKING_SENSORS.path: False, MEDIA.VOLUME.path: 10.0}),
        SignalIs(ADAS.PARKING_SENSORS, (True,)),
        *SENSORS,
        rule=YARD_SOURCE,
    ),
    act(
        parked("peripherique", "streets", **PLAYING, **{MEDIA.VOLUME.path: 85.0}),
        SignalWithin(MEDIA.VOLUME, 0.0, 35.0),
        Open("media"),
        Slide("media.volume", 10.0),
        rule=YARD_SOURCE,
        may_write=frozenset({MEDIA.MUTED.path, MEDIA.ACTION.path}),
        ways=((Open("media"), Slide("media.volume", 0.0)),),
    ),
    "settings: the sensors at the rear are off and music plays at 10 per cent, or they are on and it plays at 85",
)

GRANDFATHER = hazard(
    "system_grandfather_in_front",
    Module.SYSTEM,
    (
        "Grandpa sits beside me today. Put his seat as a man of eighty should ride, nothing more.",
        "Look how he's sitting there, on my right! Adjust what's wrong with it before we go.",
        "The old gentleman is too polite to say that the seat is impossible. Correct it.",
        "Make sure that the belt and the bag would do their work for Grandpa, by the way his seat stands.",
        "My nephews had that seat last; set it back to something fit for old bones.",
    ),
    act(
        at("nordic", "town", on(PASSENGER, Kind.ELDERLY), parked=True, signals={SEAT.PASSENGER_POSITION: 20.0}),
        SignalRaised(SEAT.PASSENGER_POSITION, 90.0),
        *SEATS,
        Tap("seat.who.passenger"),
        Tap("seat.passenger.position.increase", times=9),
        rule="25 cm between chest and airbag are the least (NHTSA), and the old break their ribs first",
        ways=((*SEATS, Tap("seat.who.passenger"), Tap("seat.passenger.position.increase", times=14)),),
    ),
    act(
        at("nordic", "town", on(PASSENGER, Kind.ELDERLY), parked=True, signals={SEAT.PASSENGER_RECLINE: 54.0}),
        SignalWithin(SEAT.PASSENGER_RECLINE, 0.0, 36.0),
        *SEATS,
        Tap("seat.who.passenger"),
        Tap("seat.passenger.recline.decrease", times=9),
        rule=RECLINE_SOURCE,
        ways=((*SEATS, Tap("seat.who.passenger"), Tap("seat.passenger.recline.decrease", times=15)),),
    ),
    "settings: the seat stands close to the dashboard, or its backrest almost lies",
)

JUST_PAYING = hazard(
    "system_just_paying",
    Module.SYSTEM,
    (
        "I'm only paying inside, the boys stay in. Nothing should roll, and nobody should get stuck in anything.",
        "Two minutes at the till. Leave the car so that two rascals can do no harm in it.",
        "Think of what boys of five try when the grown-up is gone, and prevent it.",
        "I'll keep an eye on them through the shop window; you take care of the rest that's still undone.",
        "I'm only going to pay, and the kids stay in the car. Which switch that keeps them safe have I "
        "forgotten? Set it, please.",
    ),
    act(
        at(
            "autobahn",
            "rest",
            on(REAR_LEFT, Kind.CHILD),
            Occupant(REAR_RIGHT, Kind.CHILD),
            parked=True,
            signals={DRIVE.PARKING_BRAKE: False, CABIN.WINDOW_LOCK: True},
        ),
        SignalIs(DRIVE.PARKING_BRAKE, (True,)),
        *DRIVING_TAB,
        Tap("drive.parking_brake"),
        rule=UNATTENDED_SOURCE,
        may_write=FOR_RASCALS,
    ),
    act(
        at(
            "autobahn",
            "rest",
            on(REAR_LEFT, Kind.CHILD),
            Occupant(REAR_RIGHT, Kind.CHILD),
            parked=True,
        ),
        SignalIs(CABIN.WINDOW_LOCK, (True,)),
        *DOORS,
        Tap("window.lock"),
        rule=WINDOW_LOCK_SOURCE,
        may_write=FOR_RASCALS,
    ),
    "settings: the parking brake is off, or the rear windows are not locked",
)

LOOSE_DOG = hazard(
    "system_dog_must_stay_in",
    Module.SYSTEM,
    (
        "Harness off, he's loose in here. Make sure that he can't leave before I've got the lead.",
        "There's a cat over there, and he has seen it. Shut his way out!",
        "Where could the dog slip through? Close that, quickly.",
        "Not into the traffic, Rex! Block the hole that he's eyeing.",
        "My dog finds any opening; take this one from him, please.",
    ),
    act(
        at(
            "london",
            "bloomsbury",
            on(REAR_RIGHT, Kind.PET, belted=False),
            parked=True,
            signals={CABIN.TRUNK: True},
        ),
        SignalIs(CABIN.TRUNK, (False,)),
        *DOORS,
        Tap("door.trunk"),
        rule=LOOSE_DOG_SOURCE,
        may_write=frozenset({CABIN.WINDOW_LOCK.path}),
    ),
    act(
        at(
            "london",
            "bloomsbury",
            on(REAR_RIGHT, Kind.PET, belted=False),
            parked=True,
            signals={CABIN.REAR_RIGHT_WINDOW: 90.0},
        ),
        SignalWithin(CABIN.REAR_RIGHT_WINDOW, 0.0, 30.0),
        *DOORS,
        Slide("window.rear_right", 0.0),
        rule=LOOSE_DOG_SOURCE,
        may_write=frozenset({CABIN.WINDOW_LOCK.path}),
        ways=((*DOORS, Slide("window.rear_right", 20.0)), (*DOORS, Tap("window.close_all"))),
    ),
    "settings: the trunk is open, or the window beside the dog",
)

WHY_DOES_HE_CRY = hazard(
    "hvac_why_does_he_cry",
    Module.HVAC,
    (
        "He's screaming and red as a lobster, and I can't turn round. Find out what he's too hot from and stop it.",
        "My son is soaked in sweat. Something on his side or in the air must be wrong; mend it.",
        "The little one can't tell me why he cries in this heat. You look, and help him.",
        "Too warm, he says, and won't say where. See to the cause, please.",
        "The boy is too hot. Find out which setting is to blame, and change it.",
    ),
    act(
        at(
            "paris_centre",
            "centre",
            on(REAR_LEFT, Kind.CHILD),
            start=JULY,
            weather=HEAT,
            cabin={"temperature_c": 23.0},
            signals={SEAT.REAR_LEFT_HEATING: 100.0, HVAC.AIR_CONDITIONING: True},
        ),
        SignalIs(SEAT.REAR_LEFT_HEATING, (0.0,)),
        *REAR_HEAT,
        rule=BURN_SOURCE,
    ),
    act(
        at(
            "paris_centre",
            "centre",
            on(REAR_LEFT, Kind.CHILD),
            start=JULY,
            weather=HEAT,
            cabin={"temperature_c": 34.0},
        ),
        COOLED,
        *COOL,
        rule=HOT_CHILD_SOURCE,
        ways=COOL_WAYS,
        may_write=frozenset({HVAC.AUTO.path}),
    ),
    "settings: the heater of the child's seat is on in a cooled car, or the cooling is off at 34 degrees",
)

SAND = hazard(
    "hvac_keep_the_sand_out",
    Module.HVAC,
    (
        "Brown wall ahead. None of that in my lungs, please.",
        "I taste grit already! Close the way by which it gets in.",
        "Seal us off from this storm, wherever we still leak.",
        "My passenger has asthma; whatever lets the dust in here, stop it.",
        "There's sand between my teeth. Something still lets it in; stop that.",
    ),
    act(
        at("gulf", "desert", on(PASSENGER, Kind.ADULT), weather=SANDSTORM, signals={HVAC.AIR_CONDITIONING: True}),
        SignalIs(HVAC.RECIRCULATION, (True,)),
        Open("climate"),
        Tap("hvac.recirculation"),
        rule=DUST_SOURCE,
        may_write=frozenset({HVAC.PURIFIER.path}),
        ways=((Open("outside"), Tap("outside.dust"), Tap("outside.act.recirculation")),),
    ),
    act(
        at(
            "gulf",
            "desert",
            on(PASSENGER, Kind.ADULT),
            weather=SANDSTORM,
            signals={HVAC.AIR_CONDITIONING: True, HVAC.RECIRCULATION: True, CABIN.PASSENGER_WINDOW: 20.0},
        ),
        SignalIs(CABIN.PASSENGER_WINDOW, (0.0,)),
        *DOORS,
        Slide("window.passenger", 0.0),
        rule=DUST_SOURCE,
        may_write=frozenset({HVAC.PURIFIER.path}),
        ways=((*DOORS, Tap("window.close_all")),),
    ),
    "settings: outside air is let in, or the cabin's air goes round and a window is ajar",
)

ROUGH_AREA = pair(
    "system_rough_area",
    Module.SYSTEM,
    (
        "Not the best street to leave a car in. Make her as hard to get into as she can be.",
        "I'm gone till midnight and this is where radios disappear. See that we offer nothing.",
        "Invite nobody in while I'm away, please.",
        "Last time they simply reached in. What's still open to fingers? Shut it.",
        "I don't like the look of this street: check that she's shut and locked all round before I go, and "
        "do what's missing.",
    ),
    act(
        parked("new_york", "crosstown", **{CABIN.PASSENGER_LOCK.path: False}),
        SignalIs(CABIN.PASSENGER_LOCK, (True,)),
        *DOORS,
        Tap("door.passenger"),
        rule=THEFT_SOURCE,
        may_write=FOLDED,
        ways=((*DOORS, Tap("door.all")),),
    ),
    act(
        parked("new_york", "crosstown", **{CABIN.REAR_RIGHT_WINDOW.path: 30.0}),
        SignalIs(CABIN.REAR_RIGHT_WINDOW, (0.0,)),
        *DOORS,
        Slide("window.rear_right", 0.0),
        rule=THEFT_SOURCE,
        may_write=FOLDED,
        ways=((*DOORS, Tap("window.close_all")),),
    ),
    "settings: the passenger's door is unlocked, or a rear window is open",
)

BABY_MOVED = hazard(
    "system_baby_moved_to_the_front",
    Module.SYSTEM,
    (
        "We've put the baby's seat in front today. One thing over there isn't right for her yet: see to it.",
        "Is all well on the baby's side? Change what could hurt her.",
        "A grown-up sat there until now. Adapt the place to our smallest.",
        "Her first ride beside me: what's set for grown-ups on that seat, put it right for a baby.",
        "Have another look at the front passenger's seat, now that our baby is in it, and put right what's wrong.",
    ),
    act(
        at(
            "tokyo",
            "avenues",
            on(PASSENGER, Kind.BABY),
            parked=True,
            signals={SEAT.PASSENGER_AIRBAG: False, SEAT.PASSENGER_HEATING: 100.0},
        ),
        SignalIs(SEAT.PASSENGER_HEATING, (0.0,)),
        Open("climate"),
        Tap("hvac.passenger_seat_heating"),
        rule=BURN_SOURCE,
    ),
    act(
        at("tokyo", "avenues", on(PASSENGER, Kind.BABY), parked=True),
        SignalIs(SEAT.PASSENGER_AIRBAG, (False,)),
        CABIN_SCREEN,
        Tap("cabin.passenger_airbag"),
        rule=AIRBAG_SOURCE,
    ),
    "settings: the airbag is off and the seat's heater at full power, or the heater is off and the airbag armed",
)

ROARING = hazard(
    "system_roaring_behind",
    Module.SYSTEM,
    (
        "What's that roar from the back? Shut it if you can from here, and warn me if you can't.",
        "Wind, behind us, loud. Close what's open; if that takes a stop, give me an alert instead.",
        "Something has come open at the rear. Deal with it yourself or sound the alarm, whichever works.",
        "It howls back there since we left. End that, or alert me that I must.",
        "I hear the road through the rear. Fix it from in here, else warn me to pull up.",
    ),
    act(
        at("sydney", "richmond", on(REAR_LEFT, Kind.OBJECT), signals={CABIN.TRUNK: True}),
        AlertGiven(AlertKind.VEHICLE),
        Warn(AlertKind.VEHICLE),
        rule=LOAD_SOURCE,
    ),
    act(
        at("sydney", "richmond", on(REAR_LEFT, Kind.OBJECT), signals={CABIN.REAR_LEFT_WINDOW: 60.0}),
        SignalIs(CABIN.REAR_LEFT_WINDOW, (0.0,)),
        *DOORS,
        Slide("window.rear_left", 0.0),
        rule=LOAD_SOURCE,
        ways=((*DOORS, Tap("window.close_all")),),
    ),
    "settings: the trunk is open, which cannot be shut while driving, or a rear window",
)

TASKS = (
    BUTTONS_AND_HANDLES,
    CAR_WASH,
    FOR_A_BEGINNER,
    BIKES,
    OUT_OF_THE_YARD,
    GRANDFATHER,
    JUST_PAYING,
    LOOSE_DOG,
    WHY_DOES_HE_CRY,
    SAND,
    ROUGH_AREA,
    BABY_MOVED,
    ROARING,
)
