"""Maps, hints: the driver says what is wanted or wrong, not where to go or what to switch."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat, company
from automotive_cosim.cockpit.places import PlaceKind
from automotive_cosim.cockpit.signals import ENERGY, VOICE
from automotive_cosim.contracts import Reroute
from automotive_cosim.tasking.checks import (
    AllOf,
    AnyOf,
    AppDataHas,
    AppDataIs,
    RoadAsked,
    SignalIs,
    SignalLowered,
    SignalWithin,
)
from automotive_cosim.tasking.moves import Open, Slide, Tap
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Module, Start
from automotive_cosim.tasking.triggers import All, DelayAbove, SpeedBetween, Trigger
from automotive_cosim.tasks.forms import ERRAND, PARIS, hinted
from automotive_cosim.tasks.maps import SETS_OUT, TOWNS, named

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

ASLEEP_BESIDE = (Occupant(Seat.PASSENGER, Kind.ELDERLY, asleep=True),)

TASKS = (
    hinted(
        "maps_hungry",
        Module.MAPS,
        (
            "My stomach is growling.",
            "We left without any breakfast.",
            "The whole family is starving.",
            "I'd give anything for a decent meal.",
            "If I don't get something to eat soon I'll turn grumpy.",
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
            "I need plasters, I've cut my thumb.",
            "This cough keeps getting worse, some syrup would do me good.",
            "We've run out of fever medicine, and my little one at home is burning up.",
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
            "With so few kilometres left we had better plug in somewhere.",
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
            "We won't get home today, where could we spend the night?",
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
        start=replace(PARIS, aboard=company(2)),
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
            "Hush a bit for the sleeper; without any directions I'm helpless, though.",
            "Granny dozed off. I still have to hear where to go.",
        ),
        AllOf((SignalIs(VOICE.GUIDANCE, ("UNMUTED",)), SignalWithin(VOICE.GUIDANCE_VOLUME, 5.0, 40.0))),
        Open("settings"),
        Tap("settings.page.sound"),
        Slide("sound.guidance", 15.0),
        start=replace(PARIS, aboard=ASLEEP_BESIDE, signals={VOICE.GUIDANCE_VOLUME.path: 80.0}),
        tags=frozenset({"conflict", "two_modules"}),
    ),
    hinted(
        "maps_dislikes",
        Module.MAPS,
        (
            "Just so you know, {dislike}.",
            "Mind that {dislike} when you plan my drives.",
            "{dislike}, so spare me that.",
            "Whatever route you pick for me, {dislike}.",
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
