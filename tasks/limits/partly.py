"""Things that the car does in part: the function is there, and the value that is asked for is not."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.lacking import Lacking
from automotive_cosim.cockpit.signals import ADAS, BODY, CABIN, DRIVE, ENERGY, HMI, HVAC
from automotive_cosim.tasking.checks import SignalIs
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasks.limits.broken import INSIDE
from automotive_cosim.tasks.limits.forms import NOT_THERE, ON_THE_ROAD, unequipped
from automotive_cosim.tasks.limits.unfitted import ASSIST, CLIMATE

DRIVING = (Open("vehicle"), Tap("vehicle.tab.driving"))
LANGUAGE = (Open("settings"), Tap("settings.page.language"))
MODES = {"snow": "Snow", "sport": "Sport"}
COLOURS = {"red": "#FF5C5C", "green": "#45D18A"}
LANGUAGES = {"Japanese": "ja", "German": "de"}
LIMITS = (10, 15, 20, 25)
PERCENT = (90.0, 95.0, 100.0)
COOL = {"16": 16.0, "16.5": 16.5, "17": 17.0, "17.5": 17.5}

TASKS = (
    unequipped(
        "limits_coldest_air",
        Module.HVAC,
        (
            "{degrees} degrees for me.",
            "Cool it down to {degrees} on my side.",
            "Driver's temperature: {degrees}.",
            "I'd like the air at {degrees} degrees over here.",
            "Set my climate zone to {degrees} degrees.",
        ),
        SignalIs(HVAC.DRIVER_TEMPERATURE, (param("degrees", COOL),)),
        *CLIMATE,
        TapUntil(
            "hvac.driver_temperature.decrease",
            "hvac.driver_temperature",
            param("degrees", {said: f"{celsius:.1f} °C" for said, celsius in COOL.items()}),
        ),
        lacks=Lacking(
            "temperatures below 18 °C",
            (HVAC.DRIVER_TEMPERATURE, HVAC.PASSENGER_TEMPERATURE),
            (0.0, 17.9),
            keys=(
                "hvac.driver_temperature",
                "hvac.passenger_temperature",
                "dock.driver_temperature.value",
                "dock.passenger_temperature.value",
            ),
        ),
        look=CLIMATE,
        answer="This car cannot be set below 18 degrees; {degrees} is not possible.",
        tells=(("18", "eighteen", "{degrees}"), NOT_THERE),
        instead=(
            (*CLIMATE, TapUntil("hvac.driver_temperature.decrease", "hvac.driver_temperature", "18.0 °C")),
            (*CLIMATE, Tap("hvac.fan.max")),
        ),
        start=replace(ON_THE_ROAD, signals={HVAC.SYNC.path: False}),
        parameters={"degrees": tuple(COOL)},
        scenarios=(),
    ),
    unequipped(
        "limits_charge_to_the_brim",
        Module.APPS,
        (
            "Charge limit {percent:g} percent, we drive far tomorrow.",
            "Let it charge up to {percent:g}.",
            "I need {percent:g} percent in the battery next time, raise the limit.",
            "Charging should only stop at {percent:g} %.",
            "Raise the charge limit to {percent:g} percent.",
        ),
        SignalIs(ENERGY.CHARGE_LIMIT, (param("percent"),)),
        Open("charging"),
        Slide("charging.limit", param("percent"), 50.0, 100.0),
        lacks=Lacking("charge limit above 80 %", (ENERGY.CHARGE_LIMIT,), (80.1, 100.0)),
        look=(Open("charging"),),
        answer="This car's battery takes no limit above 80 percent; {percent:g} percent cannot be set.",
        tells=(("80", "eighty", "{percent:g}"), NOT_THERE),
        instead=(
            (Open("charging"), Slide("charging.limit", 75.0, 50.0, 100.0)),
            (Open("charging"), Tap("charging.schedule")),
        ),
        parameters={"percent": PERCENT},
    ),
    unequipped(
        "limits_drive_mode",
        Module.ROAD,
        (
            "Drive mode {mode}, please.",
            "Put the car into {mode} mode.",
            "Change to {mode}, I want to try how it drives.",
            "Switch the drive to {mode}.",
            "I'd like to go on in {mode} mode.",
        ),
        SignalIs(DRIVE.MODE, (param("mode", {mode: mode.upper() for mode in MODES}),)),
        *DRIVING,
        Tap("drive.mode.{mode}"),
        lacks=Lacking("snow or sport mode", (DRIVE.MODE,), ("SNOW", "SPORT")),
        look=DRIVING,
        answer="This car has no {mode} mode; there are normal, economy and rain.",
        tells=(("{mode}",), NOT_THERE),
        instead=((*DRIVING, Tap("drive.mode.rain")), (*DRIVING, Tap("drive.mode.economy"))),
        parameters={"mode": tuple(MODES)},
    ),
    unequipped(
        "limits_ambient_colour",
        Module.SYSTEM,
        (
            "Ambient light in {colour}.",
            "Make the glow along the doors {colour}.",
            "Mood lighting {colour}, please.",
            "Let the strips in the doors shine {colour}.",
            "Change the ambient colour to {colour}.",
        ),
        SignalIs(CABIN.AMBIENT_COLOUR, (param("colour", COLOURS),)),
        *INSIDE,
        Tap("light.colour.{colour}"),
        lacks=Lacking("red or green ambient light", (CABIN.AMBIENT_COLOUR,), tuple(COLOURS.values())),
        look=INSIDE,
        answer="The ambient light has no {colour}; it can be warm, blue or violet.",
        tells=(("{colour}",), NOT_THERE),
        instead=((*INSIDE, Tap("light.colour.violet")), (*INSIDE, Tap("light.colour.warm"))),
        parameters={"colour": tuple(COLOURS)},
    ),
    unequipped(
        "limits_slow_limiter",
        Module.ROAD,
        (
            "Limiter at {speed}, we're in the campsite in a minute.",
            "Don't let me get faster than {speed}: set the limiter's speed to that.",
            "Speed limiter: {speed} km/h.",
            "Put the limiter's speed at {speed}, I'll switch it on myself.",
            "{speed} km/h for the limiter's set speed.",
        ),
        SignalIs(ADAS.LIMITER_SPEED, (param("speed", {n: float(n) for n in LIMITS}),)),
        *ASSIST,
        TapUntil("adas.limiter_speed.decrease", "adas.limiter_speed.value", "{speed} km/h"),
        lacks=Lacking(
            "limiter below 30 km/h", (ADAS.LIMITER_SPEED,), (0.0, 29.9), keys=("adas.limiter_speed.value",)
        ),
        look=ASSIST,
        answer="The limiter of this car cannot be set below 30 km/h.",
        tells=(("30", "thirty", "{speed}"), NOT_THERE),
        instead=(
            (*ASSIST, TapUntil("adas.limiter_speed.decrease", "adas.limiter_speed.value", "30 km/h")),
            (*ASSIST, Tap("adas.limiter")),
        ),
        parameters={"speed": LIMITS},
        scenarios=(),
    ),
    unequipped(
        "limits_language",
        Module.SYSTEM,
        (
            "Show everything in {language}.",
            "Change the car's language to {language}.",
            "My colleague takes over the wheel; he reads {language}.",
            "Menus in {language}, please.",
            "Set the screen to {language}.",
        ),
        SignalIs(HMI.LANGUAGE, (param("language", LANGUAGES),)),
        *LANGUAGE,
        Tap(param("language", {name: f"language.{code}" for name, code in LANGUAGES.items()})),
        lacks=Lacking("Japanese or German", (HMI.LANGUAGE,), ("ja", "de")),
        look=LANGUAGE,
        answer="{language} is not installed in this car: it has English and French.",
        tells=(("{language}",), NOT_THERE),
        instead=((*LANGUAGE, Tap("language.fr")),),
        parameters={"language": tuple(LANGUAGES)},
    ),
    unequipped(
        "limits_air_to_the_feet",
        Module.HVAC,
        (
            "Warm air to my feet.",
            "Direct the air down to the floor.",
            "My toes are freezing, blow it at our feet.",
            "Air to the footwell, please.",
            "Let the air come out at the bottom.",
        ),
        SignalIs(HVAC.AIR_DISTRIBUTION, ("DOWN",)),
        *CLIMATE,
        Tap("hvac.air.down"),
        lacks=Lacking("air vents for the feet", (HVAC.AIR_DISTRIBUTION,), ("DOWN",)),
        look=CLIMATE,
        answer="There are no vents for the feet in this car, only for face and windshield.",
        tells=(("feet", "footwell", "floor", "foot"), NOT_THERE),
        instead=((*CLIMATE, Tap("hvac.air.up")), (*CLIMATE, Tap("hvac.driver_seat_heating"))),
    ),
    unequipped(
        "limits_tyres_in_psi",
        Module.SYSTEM,
        (
            "Show tyre pressures in psi.",
            "I only think in psi, change the unit.",
            "Tyres in pounds per square inch, please.",
            "Pressure unit: psi.",
            "Display psi for the tyres.",
        ),
        SignalIs(HMI.PRESSURE_UNIT, ("PSI",)),
        Open("settings"),
        Tap("settings.pressure.psi"),
        lacks=Lacking("display in psi", (HMI.PRESSURE_UNIT,), ("PSI",)),
        look=(Open("settings"),),
        answer="This car cannot show psi, only bar and kPa.",
        tells=(("psi",), NOT_THERE),
        instead=(
            (Open("settings"), Tap("settings.pressure.kpa")),
            (Open("settings"), Tap("settings.distance.miles")),
        ),
    ),
    unequipped(
        "limits_fastest_wiping",
        Module.PHENOMENON,
        (
            "Wipers at {pace} speed.",
            "Front wiper {pace}.",
            "Set the windshield wipers to {pace}.",
            "{pace} wiping, please, at the front.",
            "Have the front wipers go at a {pace} pace.",
        ),
        SignalIs(BODY.FRONT_WIPER, (param("pace", {"medium": "MEDIUM", "fast": "FAST"}),)),
        Open("vehicle"),
        Tap("wiper.front.{pace}"),
        lacks=Lacking("medium or fast wiping", (BODY.FRONT_WIPER,), ("MEDIUM", "FAST")),
        look=(Open("vehicle"),),
        answer="The wipers of this car have no {pace} speed: interval, slow or automatic.",
        tells=(("{pace}",), NOT_THERE),
        instead=((Open("vehicle"), Tap("wiper.front.slow")), (Open("vehicle"), Tap("wiper.front.interval"))),
        parameters={"pace": ("medium", "fast")},
    ),
)
