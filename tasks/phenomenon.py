"""Phenomenon: effects of sky, surface and air on the drive."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat, company
from automotive_cosim.cockpit.signals import BODY, DRIVE, GLASS, HVAC, LIGHTS, MIRROR, OUTSIDE
from automotive_cosim.contracts import Weather
from automotive_cosim.tasking.checks import AllOf, AnyOf, Counted, SignalIs
from automotive_cosim.tasking.effects import GlassClears
from automotive_cosim.tasking.moves import Open, Tap
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Basis, Deadline, Dimension, Half, Module, Start, Task
from automotive_cosim.tasking.triggers import All, Driving, LessGripThan, SignalAbove, Trigger
from automotive_cosim.tasks import phenomenon_air, phenomenon_light
from automotive_cosim.tasks.forms import BY_THE_SWITCH, PARIS, asked, hinted

DAMP: Mapping[str, Any] = {
    "aboard": company(4),
    "cabin": {"temperature_c": 17.0, "humidity_pct": 75.0},
    "signals": {HVAC.RECIRCULATION.path: True},
}
"""Four people in wet coats, and their air goes round."""
COLD_DAMP = Weather(4.0, 92.0, 0.0, 3, 95.0, 9000.0, 8.0)
MUGGY = Weather(25.0, 97.0, 0.0, 3, 90.0, 6000.0, 3.0)
"""After a summer storm: dew point above 24 degrees."""
RAIN = Weather(9.0, 96.0, 8.0, 65, 100.0, 3000.0, 22.0)
"""Heavy rain, 8 mm/h."""
CHILLED = {"temperature_c": 17.0, "humidity_pct": 45.0}
WIPING = ("INTERVAL", "SLOW", "MEDIUM", "FAST")
PACES = ("interval", "slow", "medium", "fast")
REAR_WIPING = ("INTERVAL", "SLOW")
BLIND = Deadline(
    10.0, "at 30 km/h the car covers 83 m blind in 10 s; a glance away should last 2 s at most (NHTSA 2013)"
)

FRONT_WINDOW = Task(
    id="phenomenon_front_window_fogged",
    module=Module.PHENOMENON,
    dimension=Dimension.DRIVING_ALIGNMENT,
    templates=(
        "The front window is foggy{urge}.",
        "I can't see through the windshield, it's all fogged up{urge}.",
        "The windshield has gone milky{urge}.",
        "Quick, steamed-up glass ahead of me{urge}!",
        "I can hardly make out the bonnet through the glass{urge}.",
    ),
    parameters={"urge": ("", ", do something", ", help", ", clear it", ", I'm driving blind")},
    first=Half(
        start=Start("paris_centre", "centre", weather=COLD_DAMP, **DAMP),
        trigger=Trigger(All((Driving(), SignalAbove(GLASS.WINDSHIELD_FOG, 0.3))), for_s=2.0, within_s=240.0),
        goal=AnyOf((SignalIs(HVAC.FRONT_DEFROSTER, (True,)), GlassClears(rear=False, by=0.3))),
        moves=(Open("climate"), Tap("hvac.front_defroster")),
        ways=(
            (Open("climate"), Tap("hvac.max_defrost")),
            (Open("climate"), Tap("hvac.air.up"), Tap("hvac.recirculation")),
        ),
        deadline=BLIND,
        basis=Basis.PHYSICS,
        rule="glass below the cabin's dew point fogs inside: dry warm air clears it",
    ),
    second=Half(
        start=Start(
            "paris_centre",
            "centre",
            start="2026-08-18T08:15:00",
            weather=MUGGY,
            cabin=CHILLED,
            signals={HVAC.AIR_CONDITIONING.path: True, HVAC.DRIVER_TEMPERATURE.path: 16.0},
        ),
        trigger=Trigger(All((Driving(), SignalAbove(GLASS.WINDSHIELD_FILM, 0.3))), for_s=2.0, within_s=240.0),
        goal=SignalIs(BODY.FRONT_WIPER, WIPING),
        moves=(Open("vehicle"), Tap("wiper.front.slow")),
        deadline=BLIND,
        basis=Basis.PHYSICS,
        rule="glass below the dew point outside fogs outside: only a wiper clears it at once",
    ),
    difference="weather, date, occupants and settings: a cold damp November and the recirculated breath of four "
    "fog the glass inside, a muggy August and chilled air outside",
)

REAR_WINDOW = Task(
    id="phenomenon_rear_window_fogged",
    module=Module.PHENOMENON,
    dimension=Dimension.ENVIRONMENT_ALERTS,
    templates=(
        "Rear glass is fogging up too{urge}.",
        "I can't make out anything behind me{urge}.",
        "The back window is useless{urge}.",
        "Nothing to see out of the back any more{urge}.",
        "All I see in the inside mirror is grey{urge}.",
    ),
    parameters={"urge": ("", ", sort it out", ", please", ", fix that", " and I want to pull out")},
    first=Half(
        start=Start("paris_centre", "centre", weather=COLD_DAMP, **DAMP),
        trigger=Trigger(All((Driving(), SignalAbove(GLASS.REAR_FOG, 0.3))), for_s=2.0, within_s=240.0),
        goal=AnyOf((SignalIs(HVAC.REAR_DEFROSTER, (True,)), GlassClears(rear=True, by=0.1))),
        moves=(Open("climate"), Tap("hvac.rear_defroster")),
        ways=((Open("climate"), Tap("hvac.max_defrost")), (Open("climate"), Tap("hvac.recirculation"))),
        deadline=BLIND,
        basis=Basis.PHYSICS,
        rule="glass below the cabin's dew point fogs inside: heating it clears it",
    ),
    second=Half(
        start=Start("paris_centre", "centre", weather=RAIN, cabin=CHILLED | {"temperature_c": 21.0}),
        trigger=Trigger(
            All((Driving(), SignalAbove(GLASS.REAR_FILM, 0.3))), for_s=2.0, within_s=240.0, after_s=30.0
        ),
        goal=SignalIs(BODY.REAR_WIPER, REAR_WIPING),
        moves=(Open("vehicle"), Tap("wiper.rear.slow")),
        deadline=BLIND,
        basis=Basis.PHYSICS,
        rule="rain lies on the outside: only a wiper clears it",
    ),
    difference="weather, occupants and settings: damp cold air, the recirculated breath of four, where the glass "
    "fogs inside; heavy rain, where the drops lie outside",
)

WET_STREET = replace(PARIS, weather=Weather(9.0, 94.0, 3.0, 63, 100.0, 4000.0, 18.0))
"""Rain of 3 mm/h, in which visibility is soon poor without wipers."""
FROSTY = replace(PARIS, start="2026-01-20T11:00:00", weather=Weather(-7.0, 88.0, 0.0, 1, 10.0, 15_000.0, 5.0))
SNOWED_IN = replace(
    PARIS,
    start="2026-01-20T11:00:00",
    weather=Weather(-3.0, 92.0, 1.2, 73, 100.0, 1200.0, 14.0),
    signals={LIGHTS.SWITCH.path: "BEAM"},
)
SMOKY = replace(
    PARIS,
    start="2026-06-16T11:00:00",
    weather=Weather(24.0, 40.0, 0.0, 7, 60.0, 1500.0, 30.0),
    aboard=(*company(2), Occupant(Seat.REAR_RIGHT, Kind.BABY)),
)
"""Dust in the wind."""
VEHICLE, DRIVING_TAB, MIRRORS_TAB = Open("vehicle"), Tap("vehicle.tab.driving"), Tap("vehicle.tab.mirrors")
DRIVER_MIRROR, PASSENGER_MIRROR = Tap("mirror.driver.heat"), Tap("mirror.passenger.heat")
BOTH_MIRRORS = AllOf((SignalIs(MIRROR.DRIVER_HEATING, (True,)), SignalIs(MIRROR.PASSENGER_HEATING, (True,))))
PURPOSES = ("a mountain pass", "the ski resort", "the pass road", "the snow up there", "the high valley")

GENERAL = (
    asked(
        "phenomenon_wiper_pace",
        Module.PHENOMENON,
        (
            "Front wiper to {pace}.",
            "Wipe the windshield at the {pace} setting.",
            "I want {pace} on the wipers now.",
            "Windscreen wipers, {pace}, please.",
            "Don't leave it to the rain sensor: wipe at {pace}.",
        ),
        SignalIs(BODY.FRONT_WIPER, (param("pace", {word: word.upper() for word in PACES}),)),
        VEHICLE,
        Tap("wiper.front.{pace}"),
        start=WET_STREET,
        parameters={"pace": PACES},
    ),
    asked(
        "phenomenon_rain_setting",
        Module.PHENOMENON,
        (
            "Dipped beam on, rain mode, front wiper {pace} and the rear wiper {rear}.",
            "It's pouring. I need headlights, the rain program, {pace} for the windscreen, {rear} for the hatch.",
            "Set the car up for the wet: rain mode, headlights, front wiper {pace}, rear wiper {rear}.",
            "Get us ready for rain: wipers {pace} in front and {rear} at the back, low beam, driving mode rain.",
            "A cloudburst! Low beam, rain mode, front wiper on {pace}, rear wiper on {rear}.",
        ),
        AllOf(
            (
                SignalIs(LIGHTS.LOW_BEAM, (True,)),
                SignalIs(DRIVE.MODE, ("RAIN",)),
                SignalIs(BODY.FRONT_WIPER, (param("pace", {word: word.upper() for word in PACES}),)),
                SignalIs(BODY.REAR_WIPER, (param("rear", {"interval": "INTERVAL", "slow": "SLOW"}),)),
            )
        ),
        VEHICLE,
        Tap("lights.switch.low_beam"),
        Tap("wiper.front.{pace}"),
        Tap("wiper.rear.{rear}"),
        DRIVING_TAB,
        Tap("drive.mode.rain"),
        start=WET_STREET,
        may_write=BY_THE_SWITCH,
        parameters={"pace": PACES, "rear": ("interval", "slow")},
    ),
    asked(
        "phenomenon_ready_for_snow",
        Module.PHENOMENON,
        (
            "We're off to {goal}: snow mode, both mirrors heated, rear defroster and dipped beam on.",
            "Before {goal}, heat the two mirrors and the back window, put low beam on and the snow mode in.",
            "Winter setup for {goal}. That means snow mode, mirror heating left and right, rear defrost, low beam.",
            "Low beam, rear window heating, mirror heat on either side, snow mode. We're nearly at {goal}.",
            "I like it all on for {goal}: rear defroster, mirror heaters, dipped headlights, driving mode snow.",
        ),
        AllOf(
            (
                SignalIs(DRIVE.MODE, ("SNOW",)),
                SignalIs(HVAC.REAR_DEFROSTER, (True,)),
                SignalIs(LIGHTS.LOW_BEAM, (True,)),
                BOTH_MIRRORS,
            )
        ),
        VEHICLE,
        Tap("lights.switch.low_beam"),
        DRIVING_TAB,
        Tap("drive.mode.snow"),
        MIRRORS_TAB,
        DRIVER_MIRROR,
        PASSENGER_MIRROR,
        Tap("dock.rear_defroster"),
        start=FROSTY,
        may_write=BY_THE_SWITCH,
        parameters={"goal": PURPOSES},
        tags=frozenset({"two_modules", "preference"}),
    ),
    asked(
        "phenomenon_wash_and_wipe",
        Module.PHENOMENON,
        (
            "Squirt the windshield twice because of {dirt}, then leave the wipers {after}.",
            "Two rounds of washer fluid against {dirt}, and set the front wiper {after} afterwards.",
            "Get rid of {dirt}: wash two times, wiper {after} from then on.",
            "I can't see for {dirt}. Wash twice, and have my wipers {after} afterwards.",
            "Double wash of the front screen, please, it's {dirt}; wiping {after} when done.",
        ),
        AllOf(
            (
                Counted("washer", 2),
                SignalIs(BODY.FRONT_WIPER, (param("after", {"off": "OFF", "on interval": "INTERVAL"}),)),
            )
        ),
        VEHICLE,
        Tap("wiper.wash", times=2),
        Tap(param("after", {"off": "wiper.front.off", "on interval": "wiper.front.interval"})),
        parameters={"dirt": ("flies", "dust", "pollen", "salt", "bird droppings"), "after": ("off", "on interval")},
    ),
    hinted(
        "phenomenon_drops_on_glass",
        Module.PHENOMENON,
        (
            "It's all running down in front of my eyes{where}.",
            "The drops are blurring everything{where}.",
            "I might as well be under water{where}.",
            "Of all places it had to rain{where}, I can't make out the road.",
            "Everything out there is a blur of water{where}.",
        ),
        SignalIs(BODY.FRONT_WIPER, (*WIPING, "RAIN_SENSOR")),
        VEHICLE,
        Tap("wiper.front.medium"),
        ways=tuple((VEHICLE, Tap(f"wiper.front.{setting}")) for setting in ("auto", "interval", "slow", "fast")),
        start=replace(WET_STREET, signals={BODY.FRONT_WIPER.path: "OFF"}),
        trigger=Trigger(All((Driving(), SignalAbove(GLASS.WINDSHIELD_FILM, 0.3))), for_s=2.0, within_s=120.0),
        deadline=BLIND,
        parameters={"where": (" here", " now", " at this junction", " in the traffic")},
    ),
    hinted(
        "phenomenon_frosted_sides",
        Module.PHENOMENON,
        (
            "Left and right of me there's nothing but frost{plea}.",
            "I can't tell who's overtaking, it's iced over on both sides{plea}.",
            "Those two out there on the doors are white{plea}.",
            "Changing lanes is a gamble: frozen, the pair of them{plea}.",
            "I can't see back along the car, the mirrors have frozen over{plea}.",
        ),
        BOTH_MIRRORS,
        VEHICLE,
        MIRRORS_TAB,
        DRIVER_MIRROR,
        PASSENGER_MIRROR,
        ways=((VEHICLE, MIRRORS_TAB, PASSENGER_MIRROR, DRIVER_MIRROR),),
        start=FROSTY,
        parameters={"plea": ("", ", please", ", do something", ", and I have to pull over", ", help me out")},
    ),
    hinted(
        "phenomenon_spinning_wheels",
        Module.PHENOMENON,
        (
            "My wheels just spin at every start{place}.",
            "It's all white and I'm sliding{place}.",
            "No bite at all from the tyres{place}, and it keeps falling.",
            "She wags her tail whenever I touch the pedal{place}.",
            "It's like driving on soap{place}, the wheels just spin.",
        ),
        SignalIs(DRIVE.MODE, ("SNOW",)),
        VEHICLE,
        DRIVING_TAB,
        Tap("drive.mode.snow"),
        ways=((Open("outside"), Tap("outside.ice"), Tap("outside.act.snow_mode")),),
        start=SNOWED_IN,
        trigger=Trigger(All((Driving(), LessGripThan(0.5))), for_s=3.0, within_s=60.0),
        parameters={"place": ("", " here", " on this hill", " on this bridge", " in this street")},
    ),
    hinted(
        "phenomenon_dust_gets_in",
        Module.PHENOMENON,
        (
            "There's grit between my teeth{who}.",
            "It tickles the throat, all that stuff blowing in{who}.",
            "The wind carries half a building site through the vents{who}.",
            "I taste sand{who}.",
            "Everyone's coughing from what comes off the fields{who}.",
        ),
        AnyOf((SignalIs(HVAC.RECIRCULATION, (True,)), SignalIs(HVAC.PURIFIER, (True,)))),
        Open("climate"),
        Tap("hvac.recirculation"),
        ways=(
            (Open("climate"), Tap("hvac.purifier")),
            (Open("outside"), Tap("outside.dust"), Tap("outside.act.recirculation")),
        ),
        start=SMOKY,
        trigger=Trigger(All((Driving(), SignalAbove(OUTSIDE.FINE_DUST, 90.0))), for_s=3.0, within_s=60.0),
        parameters={"who": ("", ", and I have asthma", ", my eyes water", ", the baby too", ", can't be healthy")},
        tags=frozenset({"preference"}),
    ),
)

TASKS = (FRONT_WINDOW, REAR_WINDOW, *phenomenon_light.TASKS, *phenomenon_air.TASKS, *GENERAL)
