"""What somebody likes: the driver has noted it in a memo, or nobody but him knows."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat, company
from automotive_cosim.cockpit.signals import ADAS, CABIN, DRIVE, ENERGY, HVAC, LINK, MEDIA
from automotive_cosim.tasking.checks import AllOf, AppDataIs, SeatRecalled, SignalIs
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasks.clarify.forms import clarify, noted
from automotive_cosim.tasks.forms import AT_THE_KERB, FRIENDS, PARIS
from automotive_cosim.tasks.media import PLAYS
from automotive_cosim.tasks.road import ASSIST, CLOSE_SET, TAPS
from automotive_cosim.tasks.system import CONNECTIONS, INSIDE, SEATS

CLIMATE = Open("climate")
MEMOS = (Open("memo"),)
TWO = replace(PARIS, aboard=company(2), signals={HVAC.SYNC.path: False})
AFTER_DARK = replace(PARIS, start="2026-11-17T21:10:00", aboard=company(2))
MUSIC = replace(PARIS, signals={MEDIA.ACTION.path: "PLAY", MEDIA.VOLUME.path: 70.0})
CHILD = replace(MUSIC, aboard=(Occupant(Seat.REAR_RIGHT, Kind.CHILD),))
LOADS = ("trailer", "caravan", "roof box", "bikes on the back")
TRIPS = ("mountains", "lake", "coast", "cottage")
SOURCES = {"the stick": "USB", "digital radio": "DAB"}
LISTS = ("Dance", "Classics", "Sunday")
AVOIDED = {"toll roads": "tolls", "tunnels": "tunnels"}
VENTS = {"feet": "DOWN", "windshield": "UP"}
MODES = {"economy": "ECONOMY", "sport": "SPORT"}

TASKS = (
    clarify(
        "clarify_how_warm",
        Module.HVAC,
        (
            "{who} is riding with me. Put her side on the temperature she likes, 19 or 23.",
            "Was it 23 degrees or 19? Passenger side the way {who} likes it.",
            "{who} feels comfortable at 19 or at 23, I mix it up. Set the seat beside me to hers.",
            "Make it right for {who} over there, 23 or 19 degrees.",
            "Her usual temperature for {who}, please, on her side only. 19? 23?",
        ),
        Topic(
            "how warm {who} likes it",
            (("19", "nineteen"), ("23", "twenty three")),
            "{which} degrees.",
            ("warm", "temperature", "degrees", "{who}"),
        ),
        "How warm does {who} like it, 19 or 23 degrees?",
        SignalIs(HVAC.PASSENGER_TEMPERATURE, (param("which", {19: 19.0, 23: 23.0}),)),
        CLIMATE,
        TapUntil(
            param("which", {19: "hvac.passenger_temperature.decrease", 23: "hvac.passenger_temperature.increase"}),
            "hvac.passenger_temperature",
            "{which}.0 °C",
        ),
        untold=noted(TWO, "{who}: birthday on 3 March"),
        told=noted(TWO, "{who}: birthday on 3 March, likes the car at {which} degrees"),
        look=MEMOS,
        difference="content: a memo has her birthday, or also how warm she likes it",
        parameters={"which": (19, 23), "who": FRIENDS},
    ),
    clarify(
        "clarify_how_bright",
        Module.SYSTEM,
        (
            "Ambient light the way {who} likes it, 20 or 60 percent.",
            "{who} wants to nap: does she have the mood light on 60 or on 20? Set it.",
            "Dim the ambient lighting to {who}'s level. 20, 60, one of the two.",
            "Mood lighting for {who}, please: it's either 60 or 20.",
            "Give {who} her light along the doors, 20 or 60, whichever she sleeps with.",
        ),
        Topic(
            "how bright {who} likes it",
            (("20", "twenty"), ("60", "sixty")),
            "{which} percent.",
            ("light", "bright", "percent", "{who}"),
        ),
        "Does {who} want 20 or 60 percent?",
        SignalIs(CABIN.AMBIENT_LIGHT, (param("which", {20: 20.0, 60: 60.0}),)),
        *INSIDE,
        Slide("light.ambient", param("which", {20: 20.0, 60: 60.0})),
        untold=noted(AFTER_DARK, "{who} sleeps best in the car"),
        told=noted(AFTER_DARK, "{who} sleeps best in the car, ambient light {which} percent"),
        look=MEMOS,
        difference="content: a memo says that she sleeps in the car, or also with how much light",
        parameters={"which": (20, 60), "who": FRIENDS},
    ),
    clarify(
        "clarify_how_loud",
        Module.MEDIA,
        (
            "{who} comes along today. Music no louder than she can bear, 20 or 40.",
            "Turn the music down to what {who} puts up with: 40 or 20.",
            "Music at {who}'s volume, please, 20 or 40 percent.",
            "Not so loud once we have {who} in here. 40, or was it 20? Do it now.",
            "How {who} likes her music: 20 or 40. Set it like that.",
        ),
        Topic(
            "how loud {who} likes it",
            (("20", "twenty"), ("40", "forty")),
            "{which} percent.",
            ("loud", "volume", "percent", "{who}"),
        ),
        "How loud does {who} like it, 20 or 40 percent?",
        SignalIs(MEDIA.VOLUME, (param("which", {20: 20.0, 40: 40.0}),)),
        Open("media"),
        Slide("media.volume", param("which", {20: 20.0, 40: 40.0})),
        untold=noted(MUSIC, "{who} has sensitive ears"),
        told=noted(MUSIC, "{who} has sensitive ears, no music above {which} percent"),
        look=MEMOS,
        difference="content: a memo says that she has sensitive ears, or also how loud it may be",
        parameters={"which": (20, 40), "who": FRIENDS},
    ),
    clarify(
        "clarify_which_gap",
        Module.ROAD,
        (
            "I'm driving with the {load}. Cruise gap as I always have it then, two or three seconds.",
            "Set the time gap that I keep with the {load}: three seconds or two.",
            "With the {load} I want my usual distance on the cruise control, 2 or 3 seconds.",
            "Cruise control: the gap for the {load}, three or two, you know me.",
            "Two seconds or three, whichever I drive with the {load}. Put the gap on that.",
        ),
        Topic(
            "which gap",
            (("2", "two", "2 0"), ("3", "three", "3 0")),
            "{which} seconds.",
            ("gap", "seconds", "distance", "{load}"),
        ),
        "Which gap do you keep with the {load}, two or three seconds?",
        SignalIs(ADAS.CRUISE_GAP, (param("which", {2: 2.0, 3: 3.0}),)),
        *ASSIST,
        Tap("adas.cruise_gap", times=param("which", {2: TAPS[2.0], 3: TAPS[3.0]})),
        untold=noted(CLOSE_SET, "{load}: check the straps every hour"),
        told=noted(CLOSE_SET, "{load}: check the straps every hour, keep a gap of {which} seconds"),
        look=MEMOS,
        difference="content: a memo reminds of the straps, or also of the gap",
        parameters={"which": (2, 3), "load": LOADS},
    ),
    clarify(
        "clarify_whose_seat_memory",
        Module.SYSTEM,
        (
            "{who} takes the wheel. Move the seat to her place, 1 or 2.",
            "Seat memory for {who}, it's one of the two.",
            "I'm handing over to {who}; recall seat 2 or 1, whichever is hers.",
            "Get the driver's seat ready for {who}: memory 1 or memory 2.",
            "{who} drives now. Her seat position, please, first or second.",
        ),
        Topic(
            "which seat memory is hers",
            (("1", "one", "first"), ("2", "two", "second")),
            param("which", {1: "Hers is number 1.", 2: "Hers is number 2."}),
            ("seat", "memory", "position", "{who}"),
        ),
        "Which seat memory is {who}'s, 1 or 2?",
        SeatRecalled(param("which")),
        *SEATS,
        Tap("seat.memory.{which}"),
        untold=noted(AT_THE_KERB, "{who} is insured on our car until December"),
        told=noted(AT_THE_KERB, "{who} is insured on our car until December, her seat is number {which}"),
        look=MEMOS,
        find=SEATS,
        difference="content: a memo says that she is insured, or also which seat memory is hers",
        parameters={"which": (1, 2), "who": FRIENDS},
    ),
    clarify(
        "clarify_charge_for_the_trip",
        Module.APPS,
        (
            "Tomorrow it's off to the {trip}. Charge limit as last time, 70 or 90.",
            "Limit the charging to what the way to the {trip} takes: 90 or 70 percent.",
            "For the {trip} I charge to 70, or to 90? Set the limit I use.",
            "Charging limit for the {trip}, please: 90 percent or 70.",
            "How full do I charge for the {trip}, 70 or 90? Make that the limit.",
        ),
        Topic(
            "how far to charge",
            (("70", "seventy"), ("90", "ninety")),
            "{which} percent.",
            ("charge", "limit", "percent", "{trip}"),
        ),
        "Do you charge to 70 or to 90 percent for the {trip}?",
        SignalIs(ENERGY.CHARGE_LIMIT, (param("which", {70: 70.0, 90: 90.0}),)),
        Open("charging"),
        Slide("charging.limit", param("which", {70: 70.0, 90: 90.0}), 50.0, 100.0),
        untold=noted(PARIS, "To the {trip}: bring the long cable"),
        told=noted(PARIS, "To the {trip}: bring the long cable, charge to {which} percent"),
        look=MEMOS,
        difference="content: a memo about the trip names the cable, or also how far to charge",
        parameters={"which": (70, 90), "trip": TRIPS},
    ),
    clarify(
        "clarify_what_she_cannot_bear",
        Module.MAPS,
        (
            "We're picking up {who}. Keep off the route what she can't stand, tunnels or toll roads.",
            "Route options for {who}: no toll roads, or no tunnels. I forget.",
            "Avoid tolls or tunnels from now on, whichever {who} hates.",
            "{who} comes along, so the route must do without tunnels, or without tolls.",
            "Is it the toll roads or the tunnels? Set the route up without what {who} dislikes.",
        ),
        Topic(
            "what to avoid",
            (("toll", "tolls", "toll roads"), ("tunnel", "tunnels")),
            param("which", {"toll roads": "Toll roads.", "tunnels": "Tunnels."}),
            ("{who}", "avoid", "stand"),
        ),
        "What can {who} not stand, toll roads or tunnels?",
        AppDataIs("navigation.avoid", (param("which", {words: [kind] for words, kind in AVOIDED.items()}),)),
        Open("map"),
        Tap("map.route"),
        Tap("route.tab.options"),
        Tap(param("which", {words: f"route.avoid.{kind}" for words, kind in AVOIDED.items()})),
        untold=noted(PARIS, "{who} gets car-sick, so ginger sweets"),
        told=noted(PARIS, "{who} gets car-sick, so ginger sweets and no {which}"),
        look=MEMOS,
        difference="content: a memo says that she gets car-sick, or also what to avoid",
        parameters={"which": tuple(AVOIDED), "who": FRIENDS},
    ),
    clarify(
        "clarify_where_she_wants_the_air",
        Module.HVAC,
        (
            "We're picking up {who}. Air to where she likes it, the feet or the windshield.",
            "Send the air to the windshield or the feet, as {who} likes it.",
            "Down at the feet, or up the windshield? Vents for {who}, please.",
            "{who} always has the vents the same way when she's with us, windshield or feet. Set them.",
            "Set the air the way {who} likes it, feet or windshield.",
        ),
        Topic(
            "where she wants the air",
            (("feet", "foot", "down"), ("windshield", "windscreen", "up")),
            param("which", {"feet": "To the feet.", "windshield": "To the windshield."}),
            ("air", "where", "vents", "{who}"),
        ),
        "Where does {who} want the air, at the feet or at the windshield?",
        SignalIs(HVAC.AIR_DISTRIBUTION, (param("which", VENTS),)),
        CLIMATE,
        Tap(param("which", {"feet": "hvac.air.down", "windshield": "hvac.air.up"})),
        untold=noted(PARIS, "{who} likes it fresh"),
        told=noted(PARIS, "{who} likes it fresh: air to the {which}"),
        look=MEMOS,
        difference="content: a memo says that she likes it fresh, or also where the air has to go",
        parameters={"which": tuple(VENTS), "who": FRIENDS},
    ),
    clarify(
        "clarify_whose_network",
        Module.SYSTEM,
        (
            "We're at {who}'s. Onto her Wi-Fi, Garage or Coffee-Guest, and mobile data off.",
            "Use {who}'s wireless instead of my mobile data; it's Coffee-Guest or Garage.",
            "Wi-Fi on and into the network of {who}, that's Garage or Coffee-Guest. No mobile data.",
            "Save my mobile data: join Coffee-Guest or Garage, the one that belongs to {who}.",
            "Get us onto {who}'s Wi-Fi, Garage or Coffee-Guest; then mobile data can go off.",
        ),
        Topic(
            "which network is hers",
            (("garage",), ("coffee guest", "coffee")),
            param("which", {"Garage": "Garage.", "Coffee-Guest": "Coffee-Guest."}),
            ("network", "wi fi", "wifi", "{who}"),
        ),
        "Which network is {who}'s: Garage or Coffee-Guest?",
        AllOf(
            (
                SignalIs(LINK.WIFI, (True,)),
                AppDataIs("wifi.network", ("{which}",)),
                SignalIs(LINK.MOBILE_DATA, (False,)),
            )
        ),
        *CONNECTIONS,
        Tap("link.wifi"),
        Tap(text="{which}"),
        Tap("link.mobile"),
        untold=noted(AT_THE_KERB, "{who}: third bell from the top"),
        told=noted(AT_THE_KERB, "{who}: third bell from the top, her Wi-Fi is {which}"),
        look=MEMOS,
        difference="content: a memo says where she lives, or also which network is hers",
        parameters={"which": ("Garage", "Coffee-Guest"), "who": FRIENDS},
    ),
    clarify(
        "clarify_where_the_story_is",
        Module.MEDIA,
        (
            "{who}'s bedtime story, please. It's on the stick, or it comes on digital radio.",
            "Go over to digital radio or to the stick, wherever {who} has her story.",
            "Stick or digital radio? Switch to the one with {who}'s story.",
            "Play {who} her story: digital radio, or the stick, one of them has it.",
            "{who} would like her story. The stick? Digital radio? The right source, please.",
        ),
        Topic(
            "where her story is",
            (("usb", "stick"), ("digital", "dab", "radio")),
            param("which", {"the stick": "It's on the stick.", "digital radio": "On the digital radio."}),
            ("source", "story", "{who}"),
        ),
        "Is {who}'s story on the stick or on digital radio?",
        AllOf((PLAYS, SignalIs(MEDIA.SOURCE, (param("which", SOURCES),)))),
        Open("media"),
        Tap(param("which", {"the stick": "media.source.usb", "digital radio": "media.source.dab"})),
        untold=noted(CHILD, "{who} has a story every evening"),
        told=noted(CHILD, "{who} has a story every evening, on {which}"),
        look=MEMOS,
        difference="content: a memo says that she has a story, or also where it is",
        parameters={"which": tuple(SOURCES), "who": FRIENDS},
    ),
    clarify(
        "clarify_which_list_calms",
        Module.MEDIA,
        (
            "{who} is on edge. Put on the list that calms her: Dance, Classics or Sunday.",
            "Which of Sunday, Dance and Classics sends {who} to sleep? That playlist, please.",
            "Play {who}'s favourite, Classics, Sunday or Dance.",
            "My playlist that {who} likes best: there are Dance, Sunday and Classics.",
            "Start the one {who} always asks for. Sunday, Classics, Dance...",
        ),
        Topic(
            "which playlist", tuple((name.lower(),) for name in LISTS), "{which}.", ("playlist", "list", "{who}")
        ),
        "Which playlist does {who} like: Dance, Classics or Sunday?",
        AllOf((PLAYS, AppDataIs("media.playlist", ("{which}",)))),
        Open("media"),
        Tap("media.list.playlists"),
        Tap(text="{which}"),
        Tap("playlist.play"),
        untold=noted(PARIS, "{who} loves music in the car"),
        told=noted(PARIS, "{who} loves music in the car, above all {which}"),
        look=MEMOS,
        difference="content: a memo says that she loves music, or also which list",
        parameters={"which": LISTS, "who": FRIENDS},
        may_write=frozenset({MEDIA.SELECTED.path}),
    ),
    clarify(
        "clarify_mode_for_the_trip",
        Module.ROAD,
        (
            "The way to the {trip} starts here. My usual drive mode for it, economy or sport.",
            "Sport or economy, what do I drive to the {trip} in? Set that.",
            "Drive mode for the {trip}: economy, or sport, as always.",
            "For the {trip} the car goes into sport, or into economy. The one I like there.",
            "Economy or sport: put it in the mode I keep for the {trip}.",
        ),
        Topic(
            "which mode",
            (("economy", "eco"), ("sport", "sports")),
            param("which", {"economy": "Economy.", "sport": "Sport."}),
            ("mode", "{trip}"),
        ),
        "Which mode do you drive to the {trip} in, economy or sport?",
        SignalIs(DRIVE.MODE, (param("which", MODES),)),
        Open("vehicle"),
        Tap("vehicle.tab.driving"),
        Tap("drive.mode.{which}"),
        untold=noted(PARIS, "Way to the {trip}: stop at the mill for pies"),
        told=noted(PARIS, "Way to the {trip}: stop at the mill for pies, drive it in {which}"),
        look=MEMOS,
        difference="content: a memo about the way names a stop, or also the mode",
        parameters={"which": tuple(MODES), "trip": TRIPS},
    ),
)
