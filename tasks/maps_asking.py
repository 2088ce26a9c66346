"""Maps, wishes that do not say enough: which of several places, what to avoid."""

from __future__ import annotations

from automotive_cosim.tasking.checks import AppDataIs
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.moves import Move, Open, Tap
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Dimension, Module
from automotive_cosim.tasks.forms import (
    FRIENDS,
    PARIS,
    read_out,
    unclear,
    wrote,
)
from automotive_cosim.tasks.maps import SETS_OUT

SCHOOLS = ("Hill School", "River School", "Oak School", "Meadow School")
AVOIDED = {"toll roads": "tolls", "tunnels": "tunnels"}


def _of(kind: str) -> tuple[Move, ...]:
    """The places of that kind."""
    return Open("map"), Tap("map.list.explore"), Tap(f"explore.kind.{kind}")


def _to(kind: str, name: str) -> tuple[Move, ...]:
    """Guidance to a place of that kind."""
    return *_of(kind), Tap(text=name), SETS_OUT


TASKS = (
    unclear(
        "maps_ask_which_car_park",
        Module.MAPS,
        (
            "{who}'s waiting at a car park, Theatre or Garden. Take me there.",
            "To the car park where {who} is: it's the Theatre one or the Garden one.",
            "Theatre Car Park or Garden Car Park, wherever {who} stands. Start guidance.",
            "I'm picking {who} up at one of the car parks, Garden or Theatre.",
            "Guide me to {who}; she's at the Garden or the Theatre car park.",
        ),
        Topic(
            "which car park",
            (("theatre",), ("garden",)),
            param("which", {"Theatre": "She's at the Theatre Car Park.", "Garden": "At the Garden Car Park."}),
            ("car park", "{who}", "where"),
        ),
        "Where is {who}, at the Theatre or the Garden Car Park?",
        AppDataIs("navigation.destination", ("{which} Car Park",)),
        *_to("parking", "{which} Car Park"),
        untold=wrote(PARIS, ("{who}", "I'm standing in the car park, it's freezing!")),
        told=wrote(PARIS, ("{who}", "I'm standing in the {which} Car Park, it's freezing!")),
        look=read_out("{who}"),
        difference="content: she writes that she is waiting, or also where",
        parameters={"which": ("Theatre", "Garden"), "who": FRIENDS},
    ),
    unclear(
        "maps_ask_home_or_work",
        Module.MAPS,
        (
            "{who}'s standing at my door, at home or at work. Go there.",
            "Take me home or to work, wherever {who} is.",
            "{who} has come to see me. Home or office, drive to where she is.",
            "I'm meeting {who} at my place or at work. Start the guidance.",
            "Bring me to {who}: she's either at home or in the office.",
        ),
        Topic(
            "where {who} is",
            (("home", "house", "flat"), ("work", "office")),
            param("which", {"Home": "She's at home.", "Work": "She's at my office."}),
            ("{who}", "where"),
        ),
        "Is {who} at your home or at work?",
        AppDataIs("navigation.destination", ("{which}",)),
        Open("map"),
        Tap(text="{which}"),
        SETS_OUT,
        untold=wrote(PARIS, ("{who}", "I'm standing here, where are you?")),
        told=wrote(
            PARIS,
            (
                "{who}",
                param(
                    "which",
                    {"Home": "I'm at your home, where are you?", "Work": "I'm in your office, where are you?"},
                ),
            ),
        ),
        look=read_out("{who}"),
        difference="content: she writes that she is there, or also where",
        parameters={"which": ("Home", "Work"), "who": FRIENDS},
    ),
    unclear(
        "maps_ask_which_museum",
        Module.MAPS,
        (
            "The class of {school} is in a museum today. Take me to them.",
            "Drive to the museum where the children of {school} are.",
            "I have to take the kids of {school} their lunch boxes, to the museum.",
            "{school}'s outing has gone to a museum, that's where I have to be.",
            "My daughter's class, {school}, is visiting one of the museums; go there.",
        ),
        Topic(
            "which museum",
            (("city",), ("science",), ("modern",), ("maritime",)),
            "The {which} Museum.",
            ("museum", "class", "which one"),
        ),
        "Which museum: City, Science, Modern or Maritime?",
        AppDataIs("navigation.destination", ("{which} Museum",)),
        *_to("museum", "{which} Museum"),
        untold=wrote(PARIS, ("{school}", "The outing has left without its lunch boxes.")),
        told=wrote(PARIS, ("{school}", "The outing to the {which} Museum has left without its lunch boxes.")),
        look=read_out("{school}"),
        find=_of("museum"),
        difference="content: the school writes that an outing has left, or also where to",
        parameters={"which": ("City", "Science", "Modern", "Maritime"), "school": SCHOOLS},
        dimension=Dimension.IMPLICIT_INTENT,
    ),
    unclear(
        "maps_ask_what_to_avoid",
        Module.MAPS,
        (
            "Set the route to avoid what {who} can't bear: toll roads or tunnels.",
            "Avoid tunnels or toll roads, whichever {who} asks for.",
            "{who} doesn't want one of them, tunnels or tolls. Keep it off the route.",
            "Route options: no tolls or no tunnels, as {who} wishes.",
            "{who} has one request for the route, about tunnels or tolls. See to it.",
        ),
        Topic(
            "what to avoid",
            (("toll", "tolls", "toll roads"), ("tunnel", "tunnels")),
            param("which", {"toll roads": "Toll roads.", "tunnels": "Tunnels."}),
            ("{who}", "avoid"),
        ),
        "What does {who} want to avoid, toll roads or tunnels?",
        AppDataIs("navigation.avoid", (param("which", {words: [kind] for words, kind in AVOIDED.items()}),)),
        Open("map"),
        Tap("map.route"),
        Tap("route.tab.options"),
        Tap(param("which", {words: f"route.avoid.{kind}" for words, kind in AVOIDED.items()})),
        untold=wrote(PARIS, ("{who}", "See you at the corner! And please do as I asked.")),
        told=wrote(PARIS, ("{who}", "See you at the corner! And please no {which}.")),
        look=read_out("{who}"),
        difference="content: she reminds of her wish, or says what it is",
        parameters={"which": tuple(AVOIDED), "who": FRIENDS},
    ),
    unclear(
        "maps_ask_which_kitchen",
        Module.MAPS,
        (
            "Anchor Kitchen is shut today. Go to the one that {who} chooses instead, Basil or Cedar.",
            "They've closed Anchor Kitchen, so it's Basil or Cedar Kitchen now, {who} picked.",
            "Not Anchor Kitchen after all, it's closed; {who} decided between Basil and Cedar.",
            "Breakfast has moved from Anchor Kitchen to Basil or Cedar, wherever {who} has the table.",
            "Take us to Basil Kitchen or Cedar Kitchen, whichever {who} booked now that the Anchor is closed.",
        ),
        Topic(
            "which restaurant",
            (("basil",), ("cedar",)),
            param("which", {"Basil": "Basil Kitchen.", "Cedar": "Cedar Kitchen."}),
            ("restaurant", "kitchen", "{who}", "breakfast"),
        ),
        "Did {who} choose Basil Kitchen or Cedar Kitchen?",
        AppDataIs("navigation.destination", ("{which} Kitchen",)),
        *_to("restaurant", "{which} Kitchen"),
        untold=wrote(PARIS, ("{who}", "Table for two at nine, don't be late!")),
        told=wrote(PARIS, ("{who}", "Table for two at {which} Kitchen at nine, don't be late!")),
        look=read_out("{who}"),
        difference="content: she writes when the table is booked, or also where",
        parameters={"which": ("Basil", "Cedar"), "who": FRIENDS},
    ),
    unclear(
        "maps_ask_which_station",
        Module.MAPS,
        (
            "{who}'s train is coming in. Take me to the station.",
            "I'm fetching {who} from the train.",
            "To the station, {who} arrives soon.",
            "{who}'s on the train; let's pick her up.",
            "Drive to where {who} gets off the train.",
        ),
        Topic(
            "which station",
            (("central",), ("east",), ("west",)),
            "{which} Station.",
            ("station", "train", "{who}", "where"),
        ),
        "Which station: Central, East or West?",
        AppDataIs("navigation.destination", ("{which} Station",)),
        *_to("station", "{which} Station"),
        untold=wrote(PARIS, ("{who}", "I'm on the train, we're on time.")),
        told=wrote(PARIS, ("{who}", "I'm on the train to {which} Station, we're on time.")),
        look=read_out("{who}"),
        find=_of("station"),
        difference="content: she writes that she is on the train, or also where she gets off",
        parameters={"which": ("Central", "East", "West"), "who": FRIENDS},
        dimension=Dimension.IMPLICIT_INTENT,
    ),
)
