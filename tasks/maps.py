"""Maps: destinations, routes, guidance, charging and parking on the way."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.places import SORTS, PlaceKind
from automotive_cosim.cockpit.signals import ENERGY, VOICE
from automotive_cosim.contracts import Reroute
from automotive_cosim.tasking.checks import (
    AllOf,
    AnyOf,
    AppDataHas,
    AppDataIs,
    Entered,
    RoadAsked,
    SignalIs,
    SignalLowered,
    SignalWithin,
)
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil, TypeText
from automotive_cosim.tasking.parameters import FromCockpit, param
from automotive_cosim.tasking.task import Module, Start
from automotive_cosim.tasking.triggers import All, DelayAbove, SpeedBetween, Trigger
from automotive_cosim.tasks.forms import COMFORT, ERRAND, PARIS, asked, hinted, locked


def named(*kinds: PlaceKind) -> tuple[str, ...]:
    """Every name that a place of these kinds can have."""
    return tuple(SORTS[kind].pattern.format(word) for kind in kinds for word in SORTS[kind].words.split())


SETS_OUT = TapUntil("place.start", "place.start", "You are already on the way there", at_most=8)
"""Repeated if necessary: inside a junction, the route is fixed."""
STOPS_THERE = TapUntil("place.stop", "place.stop", "You are already on the way there", at_most=8)
CITIES = ("london", "new_york", "tokyo")
"""Scenarios with places of every kind."""
TOWNS = (*CITIES, "grid")
"""Scenarios with streets in every direction."""
SPOKEN: dict[str, PlaceKind] = {
    "supermarket": PlaceKind.SHOP,
    "coffee place": PlaceKind.CAFE,
    "museum": PlaceKind.MUSEUM,
    "hotel": PlaceKind.HOTEL,
    "pharmacy": PlaceKind.PHARMACY,
    "charging point": PlaceKind.CHARGING,
    "car park": PlaceKind.PARKING,
    "restaurant": PlaceKind.RESTAURANT,
}
"""What the driver says, and the kind of place meant."""
ALL_NAMED = {
    name: kind
    for kind, sort in SORTS.items()
    if sort.count == len(sort.words.split()) and kind not in (PlaceKind.HOME, PlaceKind.WORK)
    for name in named(kind)
}
"""Places that every larger town has, and their kinds."""
AVOIDED = {
    "motorways and toll roads": ["motorways", "tolls"],
    "motorways and tunnels": ["motorways", "tunnels"],
    "motorways and ferries": ["motorways", "ferries"],
    "toll roads and tunnels": ["tolls", "tunnels"],
    "toll roads and ferries": ["tolls", "ferries"],
    "tunnels and ferries": ["tunnels", "ferries"],
}
DISLIKES = {
    "I get seasick the moment a deck moves": "ferries",
    "boats make me ill": "ferries",
    "I panic as soon as there's rock above my head": "tunnels",
    "I can't breathe underground": "tunnels",
    "I never carry coins for barriers": "tolls",
    "I won't pay anybody for the asphalt under my wheels": "tolls",
    "lorries at a hundred an hour scare me to death": "motorways",
    "three lanes of racing cars are too much for me": "motorways",
}
"""What the driver says, and what the route should avoid."""

EXPLICIT = (
    asked(
        "maps_go_to_saved",
        Module.MAPS,
        (
            "Take me to {place}.",
            "Navigate to {place}, it's one of my saved places.",
            "{place}, please, you have the address.",
            "Let's drive to {place} from the list of favourites.",
        ),
        AppDataIs("navigation.destination", (param("place"),)),
        Open("map"),
        Tap(text="{place}"),
        SETS_OUT,
        parameters={"place": FromCockpit("favourite_places")},
        scenarios=TOWNS,
    ),
    asked(
        "maps_any_of_a_kind",
        Module.MAPS,
        (
            "Take me to a {kind}, any will do.",
            "Is there a {kind} near here? Go there.",
            "Find some {kind} and start the guidance.",
            "I want to stop at a {kind}, I don't care which.",
            "Next {kind}, please.",
        ),
        AppDataIs("navigation.destination", param("kind", {words: named(kind) for words, kind in SPOKEN.items()})),
        Open("map"),
        Tap("map.list.explore"),
        Tap(param("kind", {words: f"explore.kind.{kind}" for words, kind in SPOKEN.items()})),
        Tap("explore.place.0"),
        SETS_OUT,
        parameters={"kind": tuple(SPOKEN)},
        scenarios=TOWNS,
    ),
    asked(
        "maps_save_place",
        Module.MAPS,
        (
            "Save {place} for later.",
            "Remember {place} among my places.",
            "Add {place} to the favourites on the map.",
            "Star {place}, I might go there one day.",
        ),
        AppDataHas("navigation.favourites", param("place")),
        Open("map"),
        Tap("map.list.explore"),
        Tap(param("place", {name: f"explore.kind.{kind}" for name, kind in ALL_NAMED.items()})),
        Tap(text="{place}"),
        Tap("place.save"),
        parameters={"place": tuple(ALL_NAMED)},
        scenarios=CITIES,
    ),
    asked(
        "maps_forget_place",
        Module.MAPS,
        (
            "Forget {place}.",
            "Delete {place} from my saved destinations.",
            "{place} can go from the list, I never drive there.",
            "Take the star away from {place} on the map.",
        ),
        AppDataHas("navigation.favourites", param("place"), there=False),
        Open("map"),
        Tap(text="{place}"),
        Tap("place.save"),
        parameters={"place": FromCockpit("favourite_places")},
    ),
    asked(
        "maps_avoid_two",
        Module.MAPS,
        (
            "Avoid {what}.",
            "Keep me away from {what}, please.",
            "Route options: no {what}.",
            "From now on I don't want any {what} on my way.",
        ),
        AppDataIs("navigation.avoid", (param("what", AVOIDED),)),
        Open("map"),
        Tap("map.route"),
        Tap("route.tab.options"),
        Tap(param("what", {words: f"route.avoid.{first}" for words, (first, _) in AVOIDED.items()})),
        Tap(param("what", {words: f"route.avoid.{second}" for words, (_, second) in AVOIDED.items()})),
        ways=(
            (
                Open("map"),
                Tap("map.route"),
                Tap("route.tab.options"),
                Tap(param("what", {words: f"route.avoid.{second}" for words, (_, second) in AVOIDED.items()})),
                Tap(param("what", {words: f"route.avoid.{first}" for words, (first, _) in AVOIDED.items()})),
            ),
        ),
        parameters={"what": tuple(AVOIDED)},
    ),
    asked(
        "maps_voice_for_alerts_only",
        Module.MAPS,
        (
            "Spoken guidance for alerts only.",
            "The voice should just announce warnings.",
            "Don't read me every turn, only speak up when something is wrong.",
            "Guidance: alerts yes, directions no.",
        ),
        SignalIs(VOICE.GUIDANCE, ("ALERT_ONLY",)),
        Open("map"),
        Tap("map.route"),
        Tap("route.tab.options"),
        Tap("route.voice.alerts"),
    ),
    asked(
        "maps_voice_off",
        Module.MAPS,
        (
            "Navigation voice off.",
            "Mute the directions completely.",
            "Switch the talking of the map off.",
            "No spoken turns at all, I know the way.",
        ),
        SignalIs(VOICE.GUIDANCE, ("MUTED",)),
        Open("map"),
        Tap("map.voice"),
        ways=((Open("map"), Tap("map.route"), Tap("route.tab.options"), Tap("route.voice.off")),),
        deadline=COMFORT,
    ),
    asked(
        "maps_voice_at",
        Module.MAPS,
        (
            "Guidance volume to {percent}.",
            "Let the navigation speak at {percent} percent.",
            "Set how loud the directions are: {percent}.",
            "I want the voice that tells me the turns on {percent}.",
        ),
        SignalIs(VOICE.GUIDANCE_VOLUME, (param("percent"),)),
        Open("settings"),
        Tap("settings.page.sound"),
        Slide("sound.guidance", param("percent")),
        parameters={"percent": (10, 15, 20, 25, 30, 35, 65, 70, 75, 80, 85, 90)},
        tags=frozenset({"two_modules"}),
    ),
    asked(
        "maps_faster_way",
        Module.MAPS,
        (
            "Look for a faster route.",
            "Is there a quicker way? Find it.",
            "Recalculate with the traffic of this minute.",
            "Check again which road gets me there soonest.",
        ),
        RoadAsked(Reroute()),
        Open("map"),
        Tap("map.faster_route"),
        ways=((Open("map"), Tap("map.route"), Tap("route.tab.ways"), Tap(text="Look for a faster route")),),
        deadline=COMFORT,
    ),
    asked(
        "maps_charge_on_the_way",
        Module.MAPS,
        (
            "I'm going to {place}, but stop for charging on the way.",
            "To {place} with a charging stop, please.",
            "First some station to charge, afterwards {place}.",
            "Plan {place} as the goal and put a charger in between.",
        ),
        AllOf(
            (
                AppDataIs("navigation.destination", named(PlaceKind.CHARGING)),
                AppDataIs("navigation.onward", (param("place"),)),
            )
        ),
        Open("map"),
        Tap(text="{place}"),
        SETS_OUT,
        Open("map"),
        Tap("map.list.explore"),
        Tap("explore.kind.charging"),
        Tap("explore.place.0"),
        STOPS_THERE,
        parameters={"place": FromCockpit("favourite_places")},
        scenarios=TOWNS,
    ),
    asked(
        "maps_drive_and_pay",
        Module.MAPS,
        (
            "Take me to {park} and pay {stay} there.",
            "{park}: start guidance, and get the ticket for {stay}.",
            "I'll leave the car at {park}, go there and buy {stay}.",
            "Guide me to {park}; parking time {stay}, paid in advance.",
        ),
        AllOf(
            (
                AppDataIs("navigation.destination", (param("park"),)),
                Entered("payments", {"minutes": param("stay", {"two hours": 120, "four hours": 240})}),
                AppDataIs("parking.minutes", (param("stay", {"two hours": 120, "four hours": 240}),)),
            )
        ),
        Open("map"),
        Tap("map.list.explore"),
        Tap("explore.kind.parking"),
        Tap(text="{park}"),
        SETS_OUT,
        Tap("place.pay"),
        Tap(param("stay", {"two hours": "parking.time.120", "four hours": "parking.time.240"})),
        Tap("parking.pay"),
        parameters={"park": named(PlaceKind.PARKING), "stay": ("two hours", "four hours")},
        tags=frozenset({"two_modules"}),
        scenarios=CITIES,
    ),
    asked(
        "maps_go_and_tell",
        Module.MAPS,
        (
            "Take me to {place} and text {contact} that I'm on my way.",
            "{place}, please; {contact} should get the message that I'm coming.",
            "Start guidance towards {place}, then write 'On my way' to {contact}.",
            "I'm off to {place}: set the route and let {contact} know.",
        ),
        AllOf(
            (
                AppDataIs("navigation.destination", (param("place"),)),
                Entered("messages.sent", {"to": param("contact"), "text": "On my way"}),
            )
        ),
        Open("map"),
        Tap(text="{place}"),
        SETS_OUT,
        Open("phone"),
        Tap(text="{contact}"),
        Tap("contact.message"),
        Tap(text="On my way"),
        parameters={"place": FromCockpit("favourite_places"), "contact": FromCockpit("favourite_contacts")},
        tags=frozenset({"two_modules"}),
        scenarios=TOWNS,
    ),
    asked(
        "maps_go_avoiding",
        Module.MAPS,
        (
            "To {place}, but without {what}.",
            "Avoid {what} and then guide me to {place}.",
            "I want to get to {place}; no {what} on the route, please.",
            "Set {what} to be kept away from, afterwards {place} as the goal.",
        ),
        AllOf(
            (
                AppDataIs("navigation.destination", (param("place"),)),
                AppDataIs("navigation.avoid", (param("what", AVOIDED),)),
            )
        ),
        Open("map"),
        Tap("map.route"),
        Tap("route.tab.options"),
        Tap(param("what", {words: f"route.avoid.{first}" for words, (first, _) in AVOIDED.items()})),
        Tap(param("what", {words: f"route.avoid.{second}" for words, (_, second) in AVOIDED.items()})),
        Open("map"),
        Tap(text="{place}"),
        SETS_OUT,
        parameters={"place": FromCockpit("favourite_places"), "what": tuple(AVOIDED)},
        scenarios=TOWNS,
    ),
    asked(
        "maps_go_quietly",
        Module.MAPS,
        (
            "Set out for {place}, without any voice.",
            "Guide me to {place} in silence.",
            "{place}, and not a spoken word on the way.",
            "Start the route to {place} but keep the speech muted.",
        ),
        AllOf(
            (AppDataIs("navigation.destination", (param("place"),)), SignalIs(VOICE.GUIDANCE, ("MUTED",))),
        ),
        Open("map"),
        Tap("map.voice"),
        Tap(text="{place}"),
        SETS_OUT,
        ways=((Open("map"), Tap(text="{place}"), SETS_OUT, Tap("map.voice")),),
        parameters={"place": FromCockpit("favourite_places")},
        scenarios=TOWNS,
    ),
    locked(
        "maps_save_street",
        Module.MAPS,
        (
            "Save the street {street}.",
            "Look {street} up on the map and keep it.",
            "Search for {street} and put it among my places.",
            "I'll want {street} again, so find it and star it.",
            "{street}: type it, keep it on the list.",
        ),
        AppDataHas("navigation.favourites", param("street")),
        Open("map"),
        TypeText("map.search", "{street}"),
        Tap("map.place.0"),
        Tap("place.save"),
        parameters={"street": FromCockpit("streets")},
        scenarios=TOWNS,
    ),
)

IMPLICIT = (
    hinted(
        "maps_hungry",
        Module.MAPS,
        (
            "My stomach is growling.",
            "We haven't eaten since breakfast.",
            "The whole family is starving back there.",
            "I'd give anything for a decent meal.",
            "If I don't get a bite soon I'll turn grumpy.",
        ),
        AppDataIs("navigation.destination", named(PlaceKind.RESTAURANT, PlaceKind.CAFE)),
        Open("map"),
        Tap("map.list.explore"),
        Tap("explore.kind.restaurant"),
        Tap("explore.place.0"),
        SETS_OUT,
        ways=((Open("map"), Tap("map.list.explore"), Tap("explore.kind.cafe"), Tap("explore.place.0"), SETS_OUT),),
        deadline=ERRAND,
        scenarios=TOWNS,
    ),
    hinted(
        "maps_headache",
        Module.MAPS,
        (
            "My head is splitting and I'm out of aspirin.",
            "I've left my pills at home.",
            "We need plasters, the child cut his knee.",
            "This cough keeps getting worse, some syrup would do me good.",
            "Got nothing left against the fever, and the little one is burning up.",
        ),
        AppDataIs("navigation.destination", named(PlaceKind.PHARMACY)),
        Open("map"),
        Tap("map.list.explore"),
        Tap("explore.kind.pharmacy"),
        Tap("explore.place.1"),
        SETS_OUT,
        deadline=ERRAND,
        scenarios=TOWNS,
    ),
    hinted(
        "maps_nearly_empty",
        Module.MAPS,
        (
            "We're not going to make it home on what's left in the battery.",
            "The percentage up there worries me.",
            "I forgot to plug in last night.",
            "Running on the last drop of current, aren't we?",
            "With so few kilometres in the tank I won't dare the ring road.",
        ),
        AppDataIs("navigation.destination", named(PlaceKind.CHARGING)),
        Open("map"),
        Tap("map.list.explore"),
        Tap("explore.kind.charging"),
        Tap("explore.place.0"),
        SETS_OUT,
        ways=((Open("charging"), Tap("charging.station.0"), SETS_OUT),),
        start=replace(PARIS, signals={ENERGY.LEVEL.path: 7.0}),
        deadline=ERRAND,
        scenarios=TOWNS,
    ),
    hinted(
        "maps_bed_for_the_night",
        Module.MAPS,
        (
            "I can't go on today, I need a bed.",
            "We'd better sleep somewhere in this town and drive on tomorrow.",
            "Too late to get home, where could we spend the night?",
            "A shower and a pillow, that's all I want now.",
            "My eyes are closing, let's check in anywhere.",
        ),
        AppDataIs("navigation.destination", named(PlaceKind.HOTEL)),
        Open("map"),
        Tap("map.list.explore"),
        Tap("explore.kind.hotel"),
        Tap("explore.place.0"),
        SETS_OUT,
        deadline=ERRAND,
        scenarios=TOWNS,
    ),
    hinted(
        "maps_talks_too_much",
        Module.MAPS,
        (
            "That lady keeps interrupting us.",
            "I've driven here a hundred times, nobody needs to tell me where to turn.",
            "Left, right, left, right; it never shuts up!",
            "We're trying to have a conversation and get talked over all the time.",
        ),
        AnyOf((SignalIs(VOICE.GUIDANCE, ("MUTED", "ALERT_ONLY")), SignalLowered(VOICE.GUIDANCE_VOLUME, 25.0))),
        Open("map"),
        Tap("map.voice"),
        ways=(
            (Open("map"), Tap("map.route"), Tap("route.tab.options"), Tap("route.voice.alerts")),
            (Open("settings"), Tap("settings.page.sound"), Slide("sound.guidance", 10.0)),
        ),
    ),
    hinted(
        "maps_sleeper_beside",
        Module.MAPS,
        (
            "She's asleep beside me, and I've never driven here before.",
            "My wife wants to nap, but I'd get lost if nobody told me where to turn.",
            "Hush a bit for the kids; without any directions I'm helpless, though.",
            "Granny dozed off. I still have to hear where to go.",
        ),
        AllOf((SignalIs(VOICE.GUIDANCE, ("UNMUTED",)), SignalWithin(VOICE.GUIDANCE_VOLUME, 5.0, 25.0))),
        Open("settings"),
        Tap("settings.page.sound"),
        Slide("sound.guidance", 15.0),
        start=replace(PARIS, signals={VOICE.GUIDANCE_VOLUME.path: 80.0}),
        tags=frozenset({"conflict", "two_modules"}),
    ),
    hinted(
        "maps_dislikes",
        Module.MAPS,
        (
            "Just so you know, {dislike}.",
            "Mind that {dislike} when you plan my drives.",
            "{dislike}, so spare me that.",
            "My doctor shakes his head, but {dislike}.",
        ),
        AppDataHas("navigation.avoid", param("dislike", DISLIKES)),
        Open("map"),
        Tap("map.route"),
        Tap("route.tab.options"),
        Tap(param("dislike", {words: f"route.avoid.{what}" for words, what in DISLIKES.items()})),
        parameters={"dislike": tuple(DISLIKES)},
        deadline=ERRAND,
        tags=frozenset({"preference"}),
    ),
    hinted(
        "maps_going_nowhere",
        Module.MAPS,
        (
            "This is going nowhere, and {who} can't wait.",
            "We've been crawling for ages; {who} will be furious.",
            "Nobody moves an inch up there! What am I to tell {who}?",
            "At this rate I could walk to {who}.",
        ),
        RoadAsked(Reroute),
        Open("map"),
        Tap("map.faster_route"),
        ways=((Open("map"), Tap("map.route"), Tap("route.tab.ways"), Tap("route.way.0")),),
        start=Start("paris_centre", "jam"),
        trigger=Trigger(All((DelayAbove(60.0), SpeedBetween(0.5, 15.0))), for_s=4.0, within_s=400.0),
        parameters={"who": ("my boss", "my daughter", "the dentist", "the notary", "our guests", "my choir")},
        scenarios=(),
    ),
)

TASKS = (*EXPLICIT, *IMPLICIT)
