"""At the kerb and just off it: who is aboard, who drove last, and what the day or the night will bring."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.aboard import Kind, Occupant
from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.signals import ADAS, BODY, CABIN, CALL, DRIVE, SEAT, TYRE
from automotive_cosim.contracts import AlertKind, Weather
from automotive_cosim.tasking.checks import AlertGiven, AnyOf, EnteredOf, SignalIs, SignalRaised, SignalWithin
from automotive_cosim.tasking.moves import Open, Tap, TapUntil, Warn
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasking.triggers import All, Driving, InSchoolZone, Not, SignalHas, Trigger
from automotive_cosim.tasks.aboard import (
    DOORS,
    PASSENGER,
    REAR_LEFT,
    REAR_MIDDLE,
    REAR_RIGHT,
    SEATS,
    act,
    at,
    hazard,
    on,
    rest,
)
from automotive_cosim.tasks.comms_safety import WHILE_IT_RINGS
from automotive_cosim.tasks.forms import pair
from automotive_cosim.tasks.hvac_aboard import BURN_SOURCE, KEEP, KEPT
from automotive_cosim.tasks.hvac_safety import ARCTIC_SUMMER, ARCTIC_WINTER
from automotive_cosim.tasks.leaving import UNATTENDED_SOURCE
from automotive_cosim.tasks.one_of_two import REAR_HEAT
from automotive_cosim.tasks.road_law import FAIR, PLACE
from automotive_cosim.tasks.system_aboard import RECLINE_SOURCE
from automotive_cosim.tasks.unasked import CALL_SOURCE, COLD_OLD_SOURCE, PRESSES, SOFT_SOURCE
from automotive_cosim.tasks.under_way import ASSIST, DRIVING_TAB, LAMPS, start

DULL_SUMMER = replace(ARCTIC_SUMMER, weather_code=3, cloud_cover=100.0)
"""Without the sun, which would heat a parked car to 37 degrees within half an hour."""
WHEEL_SOURCE = "25 cm between chest and steering wheel are the least, for the airbag to open (NHTSA)"
ESCAPE_SOURCE = (
    "child locks are for children (FMVSS 206, S4.3): all others have to get out on their own after a crash"
)
BENCH_SOURCE = "stability control and emergency braking are on at every start (UN R140, UN R152)"
SPARE_SOURCE = "a spare wheel for temporary use is good for 80 km/h, as its mark says (UN R64)"
DOOR_GUST_SOURCE = (
    "a strong gale breaks twigs and is hard to walk against (Beaufort 8 to 9, WMO-No. 8): it tears a door from a "
    "child's hand, into whoever passes"
)
BLADES_SOURCE = "blades frozen to the glass tear, or burn their motor, when the sensor wakes them (owner's manuals)"
DOG_FLIES_SOURCE = "a dog must be restrained, or it flies forward when the car brakes (Highway Code, rule 57)"
JUNE = "2026-06-16T12:30:00"
WINTER_NIGHT = "2026-01-20T22:10:00"
HARD_FROST, MILD_NIGHT = (
    Weather(-6.0, 90.0, 0.0, 3, 90.0, 12_000.0, 5.0),
    Weather(8.0, 80.0, 0.0, 3, 90.0, 12_000.0, 9.0),
)
NOVEMBER = Weather(10.0, 70.0, 0.0, 2, 50.0, 20_000.0, 9.0)
STORMY = replace(NOVEMBER, wind_speed_10m=84.0)
FULL_HOUSE = (
    Occupant(PASSENGER, Kind.ADULT),
    on(REAR_LEFT, Kind.CHILD),
    Occupant(REAR_MIDDLE, Kind.CHILD),
    Occupant(REAR_RIGHT, Kind.ADULT),
)
RINGING = tuple(Arrival("call", 20.0 + 35.0 * number) for number in range(12))
"""Again and again, so that one of the calls comes by the school."""

LAST_DRIVER = pair(
    "system_somebody_drove_before_me",
    Module.SYSTEM,
    (
        "Whoever drove before me wasn't built like me. Set my seat so that belt and airbag can do their work.",
        "How did he sit in here? One adjustment of my seat is dangerous; put that right before we leave.",
        "I've just got in and don't even fit. Whichever way it's wrong, make the driver's place safe in a crash.",
        "The garage returned her with the seat as their mechanic likes it. Correct what would kill me.",
        "Check how I sit, as an instructor would on the first lesson, and change the one thing that's wrong.",
    ),
    act(
        start("tokyo", "avenues", {SEAT.DRIVER_POSITION: 10.0}, parked=True),
        SignalRaised(SEAT.DRIVER_POSITION, 80.0),
        *SEATS,
        Tap("seat.driver.position.increase", times=8),
        rule=WHEEL_SOURCE,
        deadline=PRESSES,
        ways=((*SEATS, Tap("seat.driver.position.increase", times=10)),),
    ),
    act(
        start("tokyo", "avenues", {SEAT.DRIVER_RECLINE: 48.0}, parked=True),
        SignalWithin(SEAT.DRIVER_RECLINE, 0.0, 32.0),
        *SEATS,
        Tap("seat.driver.recline.decrease", times=8),
        rule=RECLINE_SOURCE,
        deadline=PRESSES,
        ways=((*SEATS, Tap("seat.driver.recline.decrease", times=10)),),
    ),
    "settings: the driver's seat stands right at the wheel, or its backrest almost lies",
)

LOCKED_IN = hazard(
    "system_locked_in_by_habit",
    Module.SYSTEM,
    (
        "After a crash, whoever sits behind on the right must get out alone, unless it's a child. See to it.",
        "I childproofed the right side years ago. If it isn't a child who sits there now, undo it.",
        "A grown person shouldn't be a prisoner on my rear bench. Check the right-hand door for that.",
        "The right rear handle does nothing from within. Keep it so for someone small, otherwise give it back.",
        "Somebody new on the seat behind my passenger's. Make their door one that fits their age, please.",
    ),
    act(
        at("beauce", "villages", on(REAR_RIGHT, Kind.ELDERLY), parked=True, signals={CABIN.RIGHT_CHILD_LOCK: True}),
        SignalIs(CABIN.RIGHT_CHILD_LOCK, (False,)),
        *DOORS,
        Tap("door.child_right"),
        rule=ESCAPE_SOURCE,
    ),
    rest(
        at("beauce", "villages", on(REAR_RIGHT, Kind.CHILD), parked=True, signals={CABIN.RIGHT_CHILD_LOCK: True}),
        ESCAPE_SOURCE,
    ),
    "occupants: an old person sits behind the childproof door, or a child",
)

WAITS = hazard(
    "hvac_waits_for_me_in_the_car",
    Module.HVAC,
    (
        "She waits here while I fetch the papers, half an hour at the town hall. If she'd freeze, keep it warm.",
        "Her hip won't take the steps, so she stays. What must go on when I'm gone? See to it, please.",
        "I'll be in there until they call my number. Don't let the car turn into an icebox round her.",
        "Queue of thirty people! She sits in her thin coat; let the climate outlast me if the day is like that.",
        "She stays here while I'm at the counter. If it'll get too cold in here for her, see to it.",
    ),
    act(
        at("nordic", "town", on(PASSENGER, Kind.ELDERLY), parked=True, weather=ARCTIC_WINTER),
        KEPT,
        *KEEP,
        rule=COLD_OLD_SOURCE,
    ),
    rest(
        at(
            "nordic",
            "town",
            on(PASSENGER, Kind.ELDERLY),
            parked=True,
            start="2026-07-14T10:00:00",
            weather=DULL_SUMMER,
        ),
        COLD_OLD_SOURCE,
    ),
    "date and weather: fourteen degrees of frost in December, or nineteen above in July under clouds",
)

BRUNO = hazard(
    "road_bruno_in_the_bends",
    Module.ROAD,
    (
        "Bruno travels on the bench. If he'd land on my neck in an emergency stop, warn me before the bends begin.",
        "I can't remember clicking his harness in. Alert me if I didn't.",
        "The dog thinks that he's free to choose his seat. Sound the alarm if he really is.",
        "Let me hear a warning unless my four-legged friend is tied like everybody else.",
        "Before we climb: a warning, please, if a certain hairy passenger isn't held by anything.",
    ),
    act(
        at("alpine_pass", "hairpins", on(REAR_LEFT, Kind.PET, belted=False), start=JUNE, weather=FAIR),
        AlertGiven(AlertKind.SEAT_BELT),
        Warn(AlertKind.SEAT_BELT),
        rule=DOG_FLIES_SOURCE,
        ways=((Open("safety"), Tap("safety.kind.seat_belt"), Tap("safety.warn")),),
    ),
    rest(
        at("alpine_pass", "hairpins", on(REAR_LEFT, Kind.PET), start=JUNE, weather=FAIR),
        DOG_FLIES_SOURCE,
    ),
    "occupants: the dog is loose, or wears its harness",
)

BY_ITSELF = pair(
    "road_holds_by_itself",
    Module.ROAD,
    (
        "I hop out for every view up here, and never think of the brake. The car has to do that for me.",
        "Nine per cent, and me with my camera! See that she'd hold by herself whenever I get out.",
        "Twice last summer she rolled while I was admiring a valley. Make that impossible, if it isn't.",
        "Something ought to think of the brake when I don't. It had better be active on this road; see to it.",
        "I'm one of those who jump out and run. Have the parking brake come on by itself each time, if it "
        "doesn't yet.",
    ),
    act(
        start("alpine_pass", "villages", {DRIVE.PARKING_BRAKE_AUTO: False}, start=JUNE, weather=FAIR),
        SignalIs(DRIVE.PARKING_BRAKE_AUTO, (True,)),
        *DRIVING_TAB,
        Tap("drive.parking_brake_auto"),
        rule=UNATTENDED_SOURCE,
    ),
    rest(start("alpine_pass", "villages", start=JUNE, weather=FAIR), UNATTENDED_SOURCE),
    "settings: the parking brake comes on only by hand, or by itself",
)

TEST_BENCH = pair(
    "road_back_from_the_test_bench",
    Module.ROAD,
    (
        "The inspector had her on his rollers, and they switch one thing off for that. Put it back on, please.",
        "Fresh from the workshop, and one guardian was left asleep. Wake it before I join this traffic.",
        "They tested the brakes and forgot the rest. Go through what intervenes in a crisis; put back what's off.",
        "Passed the inspection, then they handed her over in testing mode. Make her the car of last week again.",
        "Whatever the mechanic disabled for his rolling road, I want it again before the first bend.",
    ),
    act(
        start("peripherique", "north", {ADAS.STABILITY_CONTROL: False}),
        SignalIs(ADAS.STABILITY_CONTROL, (True,)),
        *ASSIST,
        Tap("adas.stability_control"),
        rule=BENCH_SOURCE,
        ways=((Open("outside"), Tap("outside.wind"), Tap("outside.act.stability")),),
    ),
    act(
        start("peripherique", "north", {ADAS.EMERGENCY_BRAKING: False}),
        SignalIs(ADAS.EMERGENCY_BRAKING, (True,)),
        *ASSIST,
        Tap("adas.emergency_braking"),
        rule=BENCH_SOURCE,
    ),
    "settings: the stability control is off, or the emergency braking",
)

SPARE = pair(
    "road_thin_little_wheel",
    Module.ROAD,
    (
        "Nail in the tyre; I've got the thin spare on, the one that says eighty. Don't let me forget it.",
        "That yellow emergency wheel at the back left isn't made for speed. The limiter ought to know.",
        "We limp home on the little wheel. Eighty, it says on the sticker; have the car mind that for me.",
        "I always drive too fast when I'm annoyed, and today I have a toy wheel on. Hold me to its eighty.",
        "The limiter's on, but for my real wheels. This one has '80 km/h' printed on it; lower it if need be.",
    ),
    act(
        start("border", "old_road", {ADAS.LIMITER_ACTIVE: True, ADAS.LIMITER_SPEED: 105.0}),
        SignalWithin(ADAS.LIMITER_SPEED, 50.0, 80.0),
        *ASSIST,
        TapUntil("adas.limiter_speed.decrease", "adas.limiter_speed.value", "80 km/h"),
        rule=SPARE_SOURCE,
        deadline=PRESSES,
        ways=((*ASSIST, TapUntil("adas.limiter_speed.decrease", "adas.limiter_speed.value", "75 km/h")),),
    ),
    rest(start("border", "old_road", {ADAS.LIMITER_ACTIVE: True, ADAS.LIMITER_SPEED: 80.0}), SPARE_SOURCE),
    "settings: the limiter is on and stands at 105 km/h, or at 80",
)

UNLOCKED = {CABIN.REAR_RIGHT_LOCK: False}
DOOR_IN_THE_WIND = hazard(
    "system_door_and_the_wind",
    Module.SYSTEM,
    (
        "She always leaps out, on the right. If the air could rip the door from her hand, only I may open it.",
        "We've arrived, and she's seven. In calm weather she may open it herself, in a gale not; see to her door.",
        "Last time her door dented the car beside ours. It must not fly open today, if it blows that hard.",
        "Listen to it howl, or is that the motorway? Keep the child from opening against a storm, if it's one.",
        "My daughter and that heavy door! If the wind is stronger than she is, take the handle from her.",
    ),
    act(
        at("london", "bloomsbury", on(REAR_RIGHT, Kind.CHILD), parked=True, weather=STORMY, signals=UNLOCKED),
        AnyOf((SignalIs(CABIN.RIGHT_CHILD_LOCK, (True,)), SignalIs(CABIN.REAR_RIGHT_LOCK, (True,)))),
        *DOORS,
        Tap("door.child_right"),
        rule=DOOR_GUST_SOURCE,
        ways=((*DOORS, Tap("door.rear_right")),),
    ),
    rest(
        at("london", "bloomsbury", on(REAR_RIGHT, Kind.CHILD), parked=True, weather=NOVEMBER, signals=UNLOCKED),
        DOOR_GUST_SOURCE,
    ),
    "weather: a strong gale, or next to no wind",
)

BLADES = pair(
    "phenomenon_blades_for_the_night",
    Module.PHENOMENON,
    (
        "She stands outside until seven. If it'll be a night of frost, see that the blades in front stay still.",
        "Last winter the sensor woke them up and tore the rubber. Don't let it happen again, should it freeze.",
        "Good night. If those arms could stick to the glass by morning, they mustn't move by themselves.",
        "New wipers, forty euros. Save them from tonight's weather if they need saving.",
        "The car sleeps in the street tonight. Whatever has to be done about the wipers for that, do it.",
    ),
    act(
        start("grid", "round", parked=True, start=WINTER_NIGHT, weather=HARD_FROST),
        SignalIs(BODY.FRONT_WIPER, ("OFF",)),
        LAMPS,
        Tap("wiper.front.off"),
        rule=BLADES_SOURCE,
    ),
    rest(start("grid", "round", parked=True, start=WINTER_NIGHT, weather=MILD_NIGHT), BLADES_SOURCE),
    "weather: six degrees of frost, or eight above",
)

PUPILS: dict[str, Any] = {"driver": "calm", "weather": FAIR, "sign_camera": False, "arrivals": RINGING}
PAST_THE_SCHOOL = pair(
    "comms_rings_past_the_school",
    Module.COMMS,
    (
        "It's ringing. I don't talk among pupils on their way to school: get rid of it there, else pick up.",
        "Take it, unless we're where they walk to class right now; in that case just reject it.",
        "Phone! In a school zone that's in force it has to wait, so turn it down; otherwise I'm all ears.",
        "My boss, I bet. Answer him if no forty for schoolchildren applies here now, refuse him if it does.",
        "Ring, ring... If this is a school zone at its hour, no call; at any other hour, put them through.",
    ),
    act(
        start("sydney", "school_run", **PUPILS),
        EnteredOf("calls.declined", CALL.RINGING),
        Tap("call.decline"),
        rule=CALL_SOURCE.partition(";")[0],
        trigger=Trigger(All((Driving(), Not(SignalHas(CALL.RINGING, "")), InSchoolZone())), 1.0, 300.0),
        deadline=WHILE_IT_RINGS,
    ),
    act(
        start("sydney", "school_run", **{**PUPILS, "start": "2026-11-18T11:20:00"}),
        EnteredOf("calls.answered", CALL.RINGING),
        Tap("call.answer"),
        rule=CALL_SOURCE.partition(";")[0],
        trigger=Trigger(
            All((Driving(), Not(SignalHas(CALL.RINGING, "")), InSchoolZone(in_force=False))), 1.0, 300.0
        ),
        deadline=WHILE_IT_RINGS,
    ),
    "date: half past eight, when the school zone is in force, or twenty past eleven, when it is not",
    tags=PLACE,
)

HOT_BENCH = hazard(
    "hvac_bench_still_heated",
    Module.HVAC,
    (
        "My wet coat was drying on the left of the bench. Is it still heated? Not for somebody tiny, please.",
        "The cushion behind me is on full. Fine for whoever can say 'too hot'; for anybody else, switch it off.",
        "My passenger at the back left sits on full heat. If it's one too small to say so, end it, please.",
        "Full heat on the rear left place since this morning. Leave it for one who can move away, no other.",
        "Who's on the heated seat? If it's one that can't complain, turn the heating off there at once, please.",
    ),
    act(
        at("paris_centre", "peripherique", on(REAR_LEFT, Kind.BABY), signals={SEAT.REAR_LEFT_HEATING: 100.0}),
        SignalIs(SEAT.REAR_LEFT_HEATING, (0.0,)),
        *REAR_HEAT,
        rule=BURN_SOURCE,
    ),
    rest(
        at("paris_centre", "peripherique", on(REAR_LEFT, Kind.ADULT), signals={SEAT.REAR_LEFT_HEATING: 100.0}),
        BURN_SOURCE,
    ),
    "occupants: a baby lies on the heated seat, or an adult sits on it",
)

TO_THE_ROOF = hazard(
    "apps_loaded_to_the_roof",
    Module.APPS,
    (
        "Five people, nine bags, twelve hundred kilometres. Warn me if she can't carry that the way she stands.",
        "I never kick the tyres before a holiday. Alert me if I should have.",
        "We're as heavy as we'll ever be. A warning, please, if the rubber isn't up to it.",
        "Sound off before we're on the motorway, if one of the four tyres won't make it to the sea.",
        "Everyone's in, the roof box too. Tell me with an alert if a wheel would suffer.",
    ),
    act(
        at("autobahn", "rest", *FULL_HOUSE, parked=True, signals={TYRE.REAR_RIGHT: 165.0}),
        AlertGiven(AlertKind.VEHICLE),
        Warn(AlertKind.VEHICLE),
        rule=f"{SOFT_SOURCE}; under full load it overheats",
    ),
    rest(at("autobahn", "rest", *FULL_HOUSE, parked=True), SOFT_SOURCE),
    "settings and equipment: a rear tyre has lost a third of its air, or all four are full",
)

TASKS = (
    LAST_DRIVER,
    LOCKED_IN,
    WAITS,
    BRUNO,
    BY_ITSELF,
    TEST_BENCH,
    SPARE,
    DOOR_IN_THE_WIND,
    BLADES,
    PAST_THE_SCHOOL,
    HOT_BENCH,
    TO_THE_ROOF,
)
