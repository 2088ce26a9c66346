"""Maps, explicit requests: destinations, routes, guidance, charging and parking on the way."""

from __future__ import annotations

from automotive_cosim.cockpit.places import SORTS, PlaceKind
from automotive_cosim.cockpit.signals import VOICE
from automotive_cosim.contracts import Reroute
from automotive_cosim.tasking.checks import AllOf, AppDataHas, AppDataIs, Entered, RoadAsked, SignalIs
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil, TypeText
from automotive_cosim.tasking.parameters import FromCockpit, param
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasks.forms import COMFORT, asked, locked


def named(*kinds: PlaceKind) -> tuple[str, ...]:
    """Every name that a place of these kinds can have."""
    return tuple(SORTS[kind].pattern.format(word) for kind in kinds for word in SORTS[kind].words.split())


SETS_OUT = TapUntil("place.start", "place.start", "Navigating there", at_most=8)
"""Repeated if necessary: inside a junction, the route is fixed."""
STOPS_THERE = TapUntil("place.stop", "place.start", "Navigating there", at_most=8)
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

TASKS = (
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
            "Save {place} for me, I might go there one day.",
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
            "Just warn me when I need it, no turn-by-turn directions.",
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
            "I want the voice that reads out the turns at {percent}.",
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
            "Set {place} as the destination, with a charging stop on the way.",
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
            "No {what} on the route, please; then take me to {place}.",
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
            "Navigate to {place}, but keep the voice muted.",
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
            "Find {street} on the map and save it for me.",
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
