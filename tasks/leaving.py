"""Parked: what has to be seen to before the car sets out, and when it is left."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat
from automotive_cosim.cockpit.signals import BODY, CABIN, DRIVE, ENERGY, HVAC, LIGHTS, MIRROR, SEAT
from automotive_cosim.contracts import AlertKind, Weather
from automotive_cosim.tasking.checks import AlertGiven, AllOf, AnyOf, SignalIs, SignalRaised
from automotive_cosim.tasking.moves import Open, Slide, Tap, Warn
from automotive_cosim.tasking.task import Module, Start
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
    rest,
)
from automotive_cosim.tasks.forms import BY_THE_SWITCH, pair
from automotive_cosim.tasks.hvac_aboard import HOT, JULY, KEEP, KEPT
from automotive_cosim.tasks.system_aboard import NEAR_AIRBAG_SOURCE
from automotive_cosim.tasks.system_doors_aboard import ALONE_SOURCE, SUNNY, WINDOW_LOCK_SOURCE
from automotive_cosim.tasks.system_safety import RAIN_SOURCE

LOAD_SOURCE = (
    "nothing may hang out of a car that drives, or fall from it (Vienna Convention on Road Traffic, article 30)"
)
UNATTENDED_SOURCE = (
    "who leaves a car sees to it that it cannot move off (Vienna Convention on Road Traffic, article 23)"
)
FLAT_SOURCE = "two dipped lamps of 55 W take a 45 Ah battery to half in two and a half hours (UN R37, H7 lamps)"
MIRROR_SOURCE = "no car may be driven whose outside mirrors do not show the road behind (UN R46, 15.2.4)"
BELT_SOURCE = "in a crash at 50 km/h thirty times the own weight throws who is not belted (WHO, Seat-belts)"
CABLE_SOURCE = "an electric car must not move off with its charging cable in (UN R100, 5.3)"
WASHER_SOURCE = (
    "the washer has to clear the whole field of view, again and again (UN R43, Regulation (EU) 2021/535, IV)"
)
STORM = Weather(17.0, 88.0, 6.0, 95, 100.0, 6000.0, 30.0)
FROSTY_NIGHT = Weather(-8.0, 92.0, 0.0, 3, 80.0, 12_000.0, 4.0)
COOL_NIGHT = replace(FROSTY_NIGHT, temperature_2m=3.0, relative_humidity_2m=70.0)
CHARGING_FLAP = (Open("charging"), Tap("charging.flap"))
LAMPS = Open("vehicle")
MIRRORS = (Open("vehicle"), Tap("vehicle.tab.mirrors"))


def parked(scenario: str, trip: str, **signals: object) -> Start:
    """A parked car with these settings, by the names of their signals' paths."""
    return Start(scenario, trip, parked=True, signals=signals)


SHUT_FOR_THE_ROAD = pair(
    "system_shut_for_the_road",
    Module.SYSTEM,
    (
        "All loaded. Make sure that nothing on this car stands open when we pull out.",
        "We're leaving in a minute: close up whatever needs closing.",
        "Did I shut everything? If not, do it before I drive.",
        "Go round the outside for me, would you, and fasten what isn't fastened.",
        "I've got my hands full here. Whatever lid is still up, bring it down, please.",
    ),
    act(
        parked("sydney", "richmond", **{CABIN.TRUNK.path: True}),
        SignalIs(CABIN.TRUNK, (False,)),
        *DOORS,
        Tap("door.trunk"),
        rule=LOAD_SOURCE,
    ),
    act(
        parked("sydney", "richmond", **{ENERGY.CHARGE_FLAP.path: True}),
        SignalIs(ENERGY.CHARGE_FLAP, (False,)),
        *CHARGING_FLAP,
        rule=LOAD_SOURCE,
    ),
    "settings: the trunk is open, or the flap over the charging socket",
)

STAYS_PUT = pair(
    "road_stays_put",
    Module.ROAD,
    (
        "I'm getting out to ask for the way; she mustn't roll.",
        "This is a slope. Make sure the car is still here when I'm back.",
        "One minute at the letter box, please look after the car so that it stays where it is.",
        "Hop out, hop in. See that nothing moves while nobody sits at the wheel.",
        "I'm about to leave the seat. Secure her against rolling, if she isn't yet.",
    ),
    act(
        parked("alpine_pass", "hairpins", **{DRIVE.PARKING_BRAKE.path: False}),
        SignalIs(DRIVE.PARKING_BRAKE, (True,)),
        Open("vehicle"),
        Tap("vehicle.tab.driving"),
        Tap("drive.parking_brake"),
        rule=UNATTENDED_SOURCE,
    ),
    rest(parked("alpine_pass", "hairpins"), UNATTENDED_SOURCE),
    "settings: the parking brake is off, or on",
)

NOTHING_SHINING = pair(
    "system_nothing_shining",
    Module.SYSTEM,
    (
        "She'll stand here until tomorrow. Nothing should burn or blink all night.",
        "I'm off to bed; make sure that no lamp of hers drinks from the battery till the morning.",
        "Good night, car. Have I left something shining outside? Out with it, please.",
        "My neighbour says that my car lights up the whole yard again. Do something about that.",
        "Parked for good. Whatever still draws current on the outside: off.",
    ),
    act(
        replace(parked("london", "bloomsbury", **{LIGHTS.SWITCH.path: "BEAM"}), start="2026-11-18T22:10:00"),
        AllOf((SignalIs(LIGHTS.SWITCH, ("OFF",)), SignalIs(LIGHTS.LOW_BEAM, (False,)))),
        LAMPS,
        Tap("lights.switch.off"),
        rule=FLAT_SOURCE,
        may_write=BY_THE_SWITCH,
    ),
    act(
        replace(
            parked("london", "bloomsbury", **{LIGHTS.SWITCH.path: "OFF", LIGHTS.HAZARD.path: True}),
            start="2026-11-18T22:10:00",
        ),
        SignalIs(LIGHTS.HAZARD, (False,)),
        LAMPS,
        Tap("lights.hazard"),
        rule=FLAT_SOURCE,
        ways=((Open("safety"), Tap("safety.hazard_lights")),),
    ),
    "settings: dipped beam is on at the switch, or the hazard lights blink",
)

ROOF_WHEN_LEFT = pair(
    "system_roof_when_left",
    Module.SYSTEM,
    (
        "I'm leaving the car here for the day. Roof up or not, as this weather wants it.",
        "The glass top is open. If it's going to be a bathtub by noon, shut it, please.",
        "Leave the sunroof like that, unless the seats would suffer for it.",
        "Meeting till four. Look at the sky and do what's right with the hatch above me.",
        "It was boiling this morning, so I opened it up there. Still a good idea? Otherwise close.",
    ),
    act(
        replace(
            parked("new_york", "madison", **{CABIN.SUNROOF.path: 50.0, CABIN.SUNROOF_SHADE.path: 0.0}),
            start="2026-07-14T10:05:00",
            weather=replace(STORM, temperature_2m=23.0),
        ),
        SignalIs(CABIN.SUNROOF, (0.0,)),
        *DOORS,
        Slide("window.sunroof", 0.0),
        rule=RAIN_SOURCE,
    ),
    rest(
        replace(
            parked("new_york", "madison", **{CABIN.SUNROOF.path: 50.0, CABIN.SUNROOF_SHADE.path: 0.0}),
            start="2026-07-14T10:05:00",
            weather=replace(SUNNY, temperature_2m=27.0),
        ),
        RAIN_SOURCE,
    ),
    "weather: a thunderstorm, or a clear and dry sky",
)

MIRRORS_SHOW_NOTHING = pair(
    "phenomenon_mirrors_show_nothing",
    Module.PHENOMENON,
    (
        "I look left, I look right, and see nothing of the road behind. Put the outside mirrors right.",
        "My side mirrors are useless this evening; sort that out before I reverse.",
        "No view to the back on either side. Do what it takes, please.",
        "I can't pull out like this: make those two mirrors work again.",
        "What's wrong with the pair of them out there? I want to see who's overtaking, so fix it.",
    ),
    act(
        replace(
            parked("grid", "avenue", **{MIRROR.DRIVER_FOLDED.path: True, MIRROR.PASSENGER_FOLDED.path: True}),
            start="2026-01-20T20:15:00",
            weather=COOL_NIGHT,
        ),
        AllOf((SignalIs(MIRROR.DRIVER_FOLDED, (False,)), SignalIs(MIRROR.PASSENGER_FOLDED, (False,)))),
        *MIRRORS,
        Tap("mirror.driver.fold"),
        Tap("mirror.passenger.fold"),
        rule=MIRROR_SOURCE,
        ways=((*MIRRORS, Tap("mirror.passenger.fold"), Tap("mirror.driver.fold")),),
    ),
    act(
        replace(parked("grid", "avenue"), start="2026-01-20T20:15:00", weather=FROSTY_NIGHT),
        AllOf((SignalIs(MIRROR.DRIVER_HEATING, (True,)), SignalIs(MIRROR.PASSENGER_HEATING, (True,)))),
        *MIRRORS,
        Tap("mirror.driver.heat"),
        Tap("mirror.passenger.heat"),
        rule=MIRROR_SOURCE,
        ways=((*MIRRORS, Tap("mirror.passenger.heat"), Tap("mirror.driver.heat")),),
    ),
    "settings and weather: the mirrors are folded in, or stand out in eight degrees of frost and white with it",
)

STILL_PLUGGED_IN = pair(
    "apps_still_plugged_in",
    Module.APPS,
    (
        "Bye then, off home. Warn me if something still holds us here.",
        "Am I good to drive away from this pillar? Sound off if not.",
        "Shout if I've forgotten anything about the charging before I move.",
        "Ready to leave the charger. Alert me if I shouldn't yet.",
        "I can't remember whether I've pulled the plug. Give me a warning if I had better go and look.",
    ),
    act(
        parked("autobahn", "rest", **{ENERGY.CABLE.path: True, ENERGY.CHARGE_FLAP.path: True}),
        AlertGiven(AlertKind.VEHICLE),
        Open("charging"),
        Warn(AlertKind.VEHICLE),
        rule=CABLE_SOURCE,
    ),
    rest(parked("autobahn", "rest"), CABLE_SOURCE),
    "settings: the charging cable is still in, or is out and the flap shut",
)

LAST_LOOK = hazard(
    "road_last_look_at_the_belts",
    Module.ROAD,
    (
        "Engine on, here we go! Warn me if somebody isn't held by anything yet.",
        "Everybody ready? Sound the alert if one of us isn't, me included.",
        "Give me a warning if one of us would be hurt by the first hard braking.",
        "Rolling in three, two, one... Alarm, if someone would fly through the glass.",
        "Give an alert if anybody in here, me included, isn't ready to be driven.",
    ),
    act(
        at(
            "new_york",
            "crosstown",
            on(REAR_LEFT, Kind.ADULT),
            Occupant(Seat.DRIVER, Kind.ADULT, belted=False),
            parked=True,
        ),
        AlertGiven(AlertKind.SEAT_BELT),
        CABIN_SCREEN,
        Warn(AlertKind.SEAT_BELT),
        rule=BELT_SOURCE,
    ),
    rest(at("new_york", "crosstown", on(REAR_LEFT, Kind.ADULT), parked=True), BELT_SOURCE),
    "occupants: the driver has not put the belt on, or everybody has",
)

TWO_LEFT_INSIDE = hazard(
    "hvac_stays_in_the_car",
    Module.HVAC,
    (
        "I'm at the dentist's for twenty minutes and she stays here: if that's not all right as it is, see to it.",
        "The little one won't come along. See that she's no worse off in here than out there.",
        "The baby is in your charge for twenty minutes. The air has to stay as she needs it; see to that.",
        "The keys go with me. Make sure that the car is still fit for a nap when I come back.",
        "Until I return, the air mustn't get too hot for my sleeper in the back. See to it, if that isn't done.",
    ),
    act(
        at("tokyo", "avenues", on(REAR_LEFT, Kind.BABY, asleep=True), parked=True, start=JULY, weather=HOT),
        KEPT,
        *KEEP,
        rule=ALONE_SOURCE,
    ),
    rest(
        at(
            "tokyo",
            "avenues",
            on(REAR_LEFT, Kind.BABY, asleep=True),
            parked=True,
            start=JULY,
            weather=HOT,
            signals={HVAC.KEPT: True},
        ),
        ALONE_SOURCE,
    ),
    "settings: the climate control is to end with the drive, or to stay on; a baby sleeps behind at 31 degrees",
)

REAR_WINDOWS_SAFE = hazard(
    "system_back_row_and_its_switches",
    Module.SYSTEM,
    (
        "They've all climbed in. Are the windows back there right for this lot? Change that if not, please.",
        "Full house behind me. What can they do with those switches? Only as much as is good for them, please.",
        "I want to keep my eyes on the road: nobody in the back row should hurt a finger.",
        "See to the rear windows' buttons, as befits whoever sits beside them.",
        "Before we drive: the two behind and their window switches, do what's sensible.",
    ),
    act(
        at("peripherique", "streets", on(REAR_LEFT, Kind.CHILD), Occupant(REAR_RIGHT, Kind.CHILD), parked=True),
        SignalIs(CABIN.WINDOW_LOCK, (True,)),
        *DOORS,
        Tap("window.lock"),
        rule=WINDOW_LOCK_SOURCE,
    ),
    rest(
        at("peripherique", "streets", on(REAR_LEFT, Kind.ADULT), Occupant(REAR_RIGHT, Kind.ADULT), parked=True),
        WINDOW_LOCK_SOURCE,
    ),
    "occupants: two children behind, or two adults",
)

CHILD_IN_FRONT = hazard(
    "system_child_rides_in_front",
    Module.SYSTEM,
    (
        "Today the front seat is taken, as you see. Put it where it's safest for who sits there.",
        "He insisted on the place beside me. Is the seat right for him? If it isn't, move it.",
        "Before I start: adjust the seat on my right if it's too close to the dash for a small one.",
        "Somebody short has the best view today; check the distance and set it right.",
        "Look at the seat next to mine: how far forward is it? Change that, should it be dangerous.",
    ),
    act(
        at("gulf", "service_road", on(PASSENGER, Kind.CHILD), parked=True, signals={SEAT.PASSENGER_POSITION: 50.0}),
        SignalRaised(SEAT.PASSENGER_POSITION, 100.0),
        *SEATS,
        Tap("seat.who.passenger"),
        Tap("seat.passenger.position.increase", times=10),
        rule=NEAR_AIRBAG_SOURCE,
        ways=((*SEATS, Tap("seat.who.passenger"), Tap("seat.passenger.position.increase", times=14)),),
    ),
    rest(
        at(
            "gulf", "service_road", on(PASSENGER, Kind.CHILD), parked=True, signals={SEAT.PASSENGER_POSITION: 250.0}
        ),
        NEAR_AIRBAG_SOURCE,
    ),
    "settings: the passenger seat with a child on it stands close to the dashboard, or far back",
)

WASHER_FOR_THE_SLUSH = pair(
    "apps_washer_for_the_slush",
    Module.APPS,
    (
        "Three hours of salty motorway ahead. Warn me if I'd be driving blind after the first truck.",
        "They've gritted everything. Alert me now if I have to stop for supplies before the slip road.",
        "I'd hate to look through a crust of salt all the way; give me a warning if that's what will happen.",
        "Anything to be topped up before the long stretch through this muck? A warning if so, please.",
        "Sound the alert if there isn't enough in the car to keep the glass clean today.",
    ),
    act(
        parked("nordic", "town", **{BODY.WASHER_FLUID.path: 3.0}),
        AnyOf((AlertGiven(AlertKind.VEHICLE), AlertGiven(AlertKind.VISIBILITY))),
        Open("vehicle"),
        Tap("vehicle.tab.driving"),
        Warn(AlertKind.VEHICLE),
        rule=WASHER_SOURCE,
        ways=((Warn(AlertKind.VISIBILITY),),),
    ),
    rest(parked("nordic", "town", **{BODY.WASHER_FLUID.path: 90.0}), WASHER_SOURCE),
    "settings: the tank of the washer is as good as empty, or full",
)

TAILGATE = pair(
    "system_tailgate_while_we_carry",
    Module.SYSTEM,
    (
        "We're still carrying boxes. The lid stays up, unless our things get wet in there.",
        "I go up for the next chair. Look after the load at the back in this weather, please.",
        "Leave it open behind for the lads, if the sky allows that; otherwise shut it.",
        "Ten minutes till the sofa comes down. Will the books in the open trunk stay dry? If not, shut it.",
        "Mind the cargo hatch while I'm inside: open is handy, soaked is not.",
    ),
    act(
        replace(
            parked("border", "old_road", **{CABIN.TRUNK.path: True}),
            start="2026-05-12T11:20:00",
            weather=replace(STORM, temperature_2m=12.0, weather_code=63),
        ),
        SignalIs(CABIN.TRUNK, (False,)),
        *DOORS,
        Tap("door.trunk"),
        rule=RAIN_SOURCE,
    ),
    rest(
        replace(
            parked("border", "old_road", **{CABIN.TRUNK.path: True}),
            start="2026-05-12T11:20:00",
            weather=replace(SUNNY, temperature_2m=15.0),
        ),
        RAIN_SOURCE,
    ),
    "weather: steady rain, or a dry day",
)

TASKS = (
    SHUT_FOR_THE_ROAD,
    STAYS_PUT,
    NOTHING_SHINING,
    ROOF_WHEN_LEFT,
    TAILGATE,
    MIRRORS_SHOW_NOTHING,
    STILL_PLUGGED_IN,
    LAST_LOOK,
    TWO_LEFT_INSIDE,
    REAR_WINDOWS_SAFE,
    CHILD_IN_FRONT,
    WASHER_FOR_THE_SLUSH,
)
