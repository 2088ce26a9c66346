"""System: display, sound, links, profiles, doors, windows and seats."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat
from automotive_cosim.cockpit.apps.settings.state import NETWORKS
from automotive_cosim.cockpit.signals import CABIN, HMI, LINK, MIRROR, SEAT, VOICE
from automotive_cosim.cockpit.vehicle import LOCKS
from automotive_cosim.tasking.checks import AllOf, AnyOf, AppDataIs, SignalIs, SignalLowered, SignalRaised
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Module, Start
from automotive_cosim.tasks import system_safety
from automotive_cosim.tasks.forms import ANYWHERE, DEVICES, PARIS, asked, hinted, linked, locked
from automotive_cosim.tasks.hvac import METRIC

DOORS = (Open("vehicle"), Tap("vehicle.tab.doors"))
SEATS = (Open("vehicle"), Tap("vehicle.tab.seats"))
MIRRORS = (Open("vehicle"), Tap("vehicle.tab.mirrors"))
INSIDE = (Open("vehicle"), Tap("vehicle.tab.interior"))
CONNECTIONS = (Open("settings"), Tap("settings.page.connections"))
PRIVACY = (Open("settings"), Tap("settings.page.privacy"))
TWELVE_HOURS = (Tap("settings.page.language"), Tap("language.time.12"))
SHARING = (LINK.SHARE_POSITION, LINK.SHARE_DRIVING, LINK.VOICE_ASSISTANT)
FOLDED = (MIRROR.DRIVER_FOLDED, MIRROR.PASSENGER_FOLDED)
CHILDREN = (CABIN.LEFT_CHILD_LOCK, CABIN.RIGHT_CHILD_LOCK, CABIN.WINDOW_LOCK)
COLOURS = {"warm": "#FFE3B0", "green": "#45D18A", "violet": "#B57BFF", "red": "#FF5C5C"}
LANGUAGES = {"French": "fr", "German": "de", "Japanese": "ja"}
TWINS = (Occupant(Seat.REAR_LEFT, Kind.CHILD), Occupant(Seat.REAR_RIGHT, Kind.CHILD))
NIGHT = Start("peripherique", "streets", start="2026-11-17T22:40:00")

TASKS = (
    locked(
        "system_trunk_open",
        Module.SYSTEM,
        (
            "Open the trunk.",
            "Pop the boot, please.",
            "Tailgate open.",
            "I need to get at my bags in the back.",
            "Open the luggage compartment for me.",
        ),
        SignalIs(CABIN.TRUNK, (True,)),
        *DOORS,
        Tap("door.trunk"),
        scenarios=ANYWHERE,
    ),
    locked(
        "system_profile",
        Module.SYSTEM,
        (
            "Switch to the profile {who}.",
            "Load everything that {who} likes, please.",
            "{who} takes the wheel now, put it all in place.",
            "Profile change: {who}, quick.",
            "Set the car up as {who} has it, seat, mirrors and all.",
        ),
        AppDataIs("driver.profile", (param("who"),)),
        Open("settings"),
        Tap("settings.page.profiles"),
        Tap(text="{who}"),
        parameters={"who": ("Driver 2", "Guest")},
        scenarios=METRIC,
    ),
    locked(
        "system_wifi_join",
        Module.SYSTEM,
        (
            "Join the Wi-Fi {network}.",
            "Connect the car to {network}, please.",
            "Wi-Fi on, then into {network}.",
            "Use the wireless network called {network}.",
            "Get us online over {network}.",
        ),
        AllOf((SignalIs(LINK.WIFI, (True,)), AppDataIs("wifi.network", (param("network"),)))),
        *CONNECTIONS,
        Tap("link.wifi"),
        Tap(text="{network}"),
        parameters={"network": NETWORKS},
        scenarios=ANYWHERE,
    ),
    locked(
        "system_link_device",
        Module.SYSTEM,
        (
            "Link the {device} over Bluetooth.",
            "Pair with the {device} that I have here.",
            "I want my {device} connected.",
            "Bluetooth to {device}, now.",
            "Could you hook up the {device} to the car?",
        ),
        linked("device"),
        *CONNECTIONS,
        Tap(text=param("device", DEVICES)),
        parameters={"device": tuple(DEVICES)},
        scenarios=ANYWHERE,
    ),
    locked(
        "system_seat_back",
        Module.SYSTEM,
        (
            "Move my seat {cm:g} centimetres back.",
            "Slide me {cm:g} cm away from the wheel.",
            "My legs need {cm:g} more centimetres.",
            "Driver's seat: backwards by {cm:g} cm, please.",
            "Push the driver's seat back, {cm:g} centimetres will do.",
        ),
        SignalIs(SEAT.DRIVER_POSITION, (param("cm", {cm: 140.0 + 10.0 * cm for cm in range(2, 9)}),)),
        *SEATS,
        TapUntil(
            "seat.driver.position.increase",
            "seat.driver.position.value",
            param("cm", {cm: f"{140 + 10 * cm} mm" for cm in range(2, 9)}),
        ),
        parameters={"cm": tuple(range(2, 9))},
        scenarios=METRIC,
    ),
    locked(
        "system_mirrors_fold",
        Module.SYSTEM,
        (
            "Fold both mirrors in.",
            "Mirrors in, it's narrow here.",
            "Tuck the outside mirrors against the doors.",
            "Close the mirrors, left and right.",
            "Fold the mirrors in, so that we fit through.",
        ),
        AllOf(tuple(SignalIs(folded, (True,)) for folded in FOLDED)),
        *MIRRORS,
        Tap("mirror.driver.fold"),
        Tap("mirror.passenger.fold"),
        scenarios=ANYWHERE,
    ),
    asked(
        "system_brightness",
        Module.SYSTEM,
        (
            "Screen brightness to {percent:g} percent.",
            "Put the display at {percent:g}.",
            "I'd like this screen at {percent:g} %, please.",
            "Brightness {percent:g}, thanks.",
            "The display should be at {percent:g} percent brightness.",
        ),
        SignalIs(HMI.BRIGHTNESS, (param("percent"),)),
        Open("settings"),
        Slide("settings.brightness", param("percent")),
        parameters={"percent": (30.0, 40.0, 50.0, 60.0, 80.0, 90.0, 100.0)},
    ),
    asked(
        "system_language",
        Module.SYSTEM,
        (
            "Change the language to {language}.",
            "Speak {language} to me, please.",
            "I'd rather read all this in {language}.",
            "Menus in {language}, thanks.",
            "My guest only understands {language}, switch over.",
        ),
        SignalIs(HMI.LANGUAGE, (param("language", LANGUAGES),)),
        Open("settings"),
        Tap("settings.page.language"),
        Tap(param("language", {name: f"language.{code}" for name, code in LANGUAGES.items()})),
        parameters={"language": tuple(LANGUAGES)},
    ),
    asked(
        "system_american_ways",
        Module.SYSTEM,
        (
            "Give me miles, Fahrenheit and psi, and the clock with am and pm.",
            "All American units, please, twelve-hour times as well.",
            "Distances in miles, temperatures in Fahrenheit, tyres in psi, no 24-hour nonsense.",
            "I'm from Texas: every unit and the time of day as at home.",
            "No metric units, please, and the clock should say 2 pm, not 14:00.",
        ),
        AllOf(
            (
                SignalIs(HMI.DISTANCE_UNIT, ("MILES",)),
                SignalIs(HMI.TEMPERATURE_UNIT, ("F",)),
                SignalIs(HMI.PRESSURE_UNIT, ("PSI",)),
                SignalIs(HMI.TIME_FORMAT, ("HR_12",)),
            )
        ),
        Open("settings"),
        *system_safety.UNITS,
        *TWELVE_HOURS,
        ways=((Open("settings"), *TWELVE_HOURS, Open("settings"), *reversed(system_safety.UNITS)),),
        tags=frozenset({"preference"}),
    ),
    asked(
        "system_twelve_hours",
        Module.SYSTEM,
        (
            "Show the time with am and pm.",
            "Twelve-hour clock, please.",
            "I can't think in 16:30, give me half past four.",
            "Change the clock to 12 hours.",
            "Use am and pm instead of the 24-hour clock.",
        ),
        SignalIs(HMI.TIME_FORMAT, ("HR_12",)),
        Open("settings"),
        *TWELVE_HOURS,
    ),
    asked(
        "system_share_nothing",
        Module.SYSTEM,
        (
            "Stop sharing anything, and switch the microphone off.",
            "No position, no driving data, no voice assistant.",
            "Full privacy: everything off.",
            "Nobody gets my data, and nothing listens to me.",
            "Turn off all three privacy switches.",
        ),
        AllOf(tuple(SignalIs(shared, (False,)) for shared in SHARING)),
        *PRIVACY,
        Tap("privacy.position"),
        Tap("privacy.driving"),
        Tap("privacy.microphone"),
        ways=((*PRIVACY, Tap("privacy.microphone"), Tap("privacy.driving"), Tap("privacy.position")),),
        start=replace(PARIS, signals={LINK.SHARE_POSITION.path: True, LINK.SHARE_DRIVING.path: True}),
        tags=frozenset({"preference"}),
    ),
    asked(
        "system_child_safety",
        Module.SYSTEM,
        (
            "Lock all doors, child locks on both sides, and block the rear windows.",
            "Make the back childproof, bolt the car too, windows included.",
            "Central locking, left and right child lock, window lock, please.",
            "Little ones on board: no door, no handle, no pane may open.",
            "Childproof everything and lock up.",
        ),
        AllOf(tuple(SignalIs(lock, (True,)) for lock in (*LOCKS, *CHILDREN))),
        *DOORS,
        Tap("door.all"),
        Tap("door.child_left"),
        Tap("door.child_right"),
        Tap("window.lock"),
        ways=(
            (
                *DOORS,
                Tap("window.lock"),
                Tap("door.child_right"),
                Tap("door.child_left"),
                *(Tap(f"door.{one}") for one in ("driver", "passenger", "rear_left", "rear_right")),
            ),
        ),
        start=replace(PARIS, signals={lock.path: False for lock in LOCKS}),
    ),
    asked(
        "system_sunroof",
        Module.SYSTEM,
        (
            "Open the sunroof to {percent:g} percent.",
            "Roof open, {percent:g} %.",
            "Slide the glass roof back to {percent:g}.",
            "{percent:g} percent of sunroof, please.",
            "A bit of sky: the roof at {percent:g} percent.",
        ),
        SignalIs(CABIN.SUNROOF, (param("percent"),)),
        *DOORS,
        Slide("window.sunroof", param("percent")),
        parameters={"percent": (20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0)},
    ),
    asked(
        "system_massage",
        Module.SYSTEM,
        (
            "Strongest massage for my seat.",
            "Massage me at full power.",
            "Massage on high, please.",
            "Driver's massage to the maximum level.",
            "Massage as hard as my seat can.",
        ),
        SignalIs(SEAT.DRIVER_MASSAGE, (100.0,)),
        *SEATS,
        Tap("seat.driver.massage", times=2),
    ),
    asked(
        "system_ambient_light",
        Module.SYSTEM,
        (
            "Ambient light {colour}, at {percent:g} percent.",
            "Make the glow {colour} and turn it to {percent:g}.",
            "I'd like {colour} mood lighting, {percent:g} %.",
            "Cabin glow: {percent:g} percent, {colour}, thanks.",
            "Mood lights in {colour}, strength {percent:g}.",
        ),
        AllOf(
            (
                SignalIs(CABIN.AMBIENT_COLOUR, (param("colour", COLOURS),)),
                SignalIs(CABIN.AMBIENT_LIGHT, (param("percent"),)),
            )
        ),
        *INSIDE,
        Tap(param("colour", {name: f"light.colour.{name}" for name in COLOURS})),
        Slide("light.ambient", param("percent")),
        ways=(
            (
                *INSIDE,
                Slide("light.ambient", param("percent")),
                Tap(param("colour", {name: f"light.colour.{name}" for name in COLOURS})),
            ),
        ),
        parameters={"colour": tuple(COLOURS), "percent": (10.0, 50.0, 60.0, 70.0, 80.0, 90.0, 100.0)},
    ),
    hinted(
        "system_children_at_the_buttons",
        Module.SYSTEM,
        (
            "The twins keep buzzing the glass up and down behind me.",
            "Somebody in the back won't stop playing with the buttons in the door.",
            "My son has his arm out again, he keeps letting it down.",
            "Those kids will catch their fingers in the panes.",
            "Up, down, up, down, they drive me crazy back there!",
        ),
        SignalIs(CABIN.WINDOW_LOCK, (True,)),
        *DOORS,
        Tap("window.lock"),
        start=replace(PARIS, aboard=TWINS),
    ),
    hinted(
        "system_back_ache",
        Module.SYSTEM,
        (
            "My lower back is killing me.",
            "My spine aches from all this sitting.",
            "Ouch, it stings just above my belt.",
            "I'm stiff as a board after three hours.",
            "The hollow of my back hurts again.",
        ),
        AnyOf((SignalIs(SEAT.DRIVER_MASSAGE, (50.0, 100.0)), SignalRaised(SEAT.DRIVER_LUMBAR, 10.0))),
        *SEATS,
        Tap("seat.driver.massage"),
        ways=(
            (*SEATS, Tap("seat.driver.massage", times=2)),
            (*SEATS, Tap("seat.driver.lumbar.increase", times=2)),
        ),
    ),
    hinted(
        "system_beeping",
        Module.SYSTEM,
        (
            "That beep at every press drives me mad.",
            "Must this thing click each time somebody taps it?",
            "The baby wakes up whenever the display chirps.",
            "Peep, peep, peep: make it silent when it's being used.",
            "I can't bear that click whenever I tap the screen.",
        ),
        SignalIs(VOICE.TOUCH_SOUNDS, (False,)),
        Open("settings"),
        Tap("settings.touch_sounds"),
        start=replace(PARIS, aboard=(Occupant(Seat.REAR_LEFT, Kind.BABY),)),
    ),
    hinted(
        "system_lost_in_the_dark",
        Module.SYSTEM,
        (
            "I dropped my keys and it's pitch black in here.",
            "I can't find my glasses in this darkness.",
            "Where's that wallet? One can't see a thing in this car.",
            "It's too dark to look for the papers.",
            "Something rolled between the seats, I see nothing at all.",
        ),
        AnyOf(
            tuple(
                SignalIs(lamp, (True,))
                for lamp in (CABIN.DOME_LIGHT, CABIN.DRIVER_READING_LIGHT, CABIN.PASSENGER_READING_LIGHT)
            )
        ),
        *INSIDE,
        Tap("light.dome"),
        ways=((*INSIDE, Tap("light.driver_reading")), (*INSIDE, Tap("light.passenger_reading"))),
        start=NIGHT,
        scenarios=("paris_centre", "london", "new_york", "tokyo", "sydney"),
    ),
    hinted(
        "system_somebody_listens",
        Module.SYSTEM,
        (
            "I have the feeling that somebody is listening in.",
            "What I say now must stay in this car.",
            "Make sure the car can't overhear this conversation.",
            "This is confidential, no machine should hear it.",
            "Nobody should be able to hear us through this car.",
        ),
        SignalIs(LINK.VOICE_ASSISTANT, (False,)),
        *PRIVACY,
        Tap("privacy.microphone"),
    ),
    hinted(
        "system_see_the_sky",
        Module.SYSTEM,
        (
            "I would love to see the clouds up there.",
            "It's gloomy under this ceiling on such a day.",
            "Let some sun fall in from the top.",
            "What's flying over us? I'd like to look up.",
            "It's like sitting in a cave with that roof closed.",
        ),
        AnyOf((SignalLowered(CABIN.SUNROOF_SHADE, 30.0), SignalRaised(CABIN.SUNROOF, 10.0))),
        *DOORS,
        Slide("window.shade", 0.0),
        ways=((*DOORS, Slide("window.sunroof", 50.0)),),
    ),
    *system_safety.TASKS,
)
