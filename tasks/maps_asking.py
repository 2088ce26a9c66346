"""Maps, wishes that do not say enough: which of several places, what to avoid."""

from __future__ import annotations

from automotive_cosim.tasking.checks import AppDataIs
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.moves import Move, Open, Tap
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Dimension, Module
from automotive_cosim.tasks.forms import PARIS, read_out, unclear, wrote
from automotive_cosim.tasks.maps import SETS_OUT

AVOIDED = {"toll roads": "tolls", "tunnels": "tunnels"}


def _to(kind: str, name: str) -> tuple[Move, ...]:
    """Guidance to a place of that kind."""
    return Open("map"), Tap("map.list.explore"), Tap(f"explore.kind.{kind}"), Tap(text=name), SETS_OUT


TASKS = (
    unclear(
        "maps_ask_which_car_park",
        Module.MAPS,
        (
            "Lena's waiting at a car park, Theatre or Garden. Take me there.",
            "To the car park where Lena is: it's the Theatre one or the Garden one.",
            "Theatre Car Park or Garden Car Park, wherever Lena stands. Start guidance.",
            "I'm picking Lena up at one of the car parks, Garden or Theatre.",
            "Guide me to Lena; she's at the Garden or the Theatre car park.",
        ),
        Topic(
            "which car park",
            (("theatre",), ("garden",)),
            param("which", {"Theatre": "She's at the Theatre Car Park.", "Garden": "At the Garden Car Park."}),
            ("car park", "lena", "where"),
        ),
        "Where is Lena, at the Theatre or the Garden Car Park?",
        AppDataIs("navigation.destination", ("{which} Car Park",)),
        *_to("parking", "{which} Car Park"),
        untold=wrote(PARIS, ("Lena Costa", "I'm standing in the car park, it's freezing!")),
        told=wrote(PARIS, ("Lena Costa", "I'm standing in the {which} Car Park, it's freezing!")),
        look=read_out("Lena Costa"),
        difference="content: Lena writes that she is waiting, or also where",
        parameters={"which": ("Theatre", "Garden")},
    ),
    unclear(
        "maps_ask_home_or_work",
        Module.MAPS,
        (
            "Petra's standing at my door, at home or at work. Go there.",
            "Take me home or to work, wherever Petra is.",
            "Petra has come to see me. Home or office, drive to where she is.",
            "I'm meeting Petra at my place or at work. Start the guidance.",
            "Bring me to Petra: she's either at home or in the office.",
        ),
        Topic(
            "where Petra is",
            (("home", "house", "flat"), ("work", "office")),
            param("which", {"Home": "She's at home.", "Work": "She's at my office."}),
            ("petra", "where"),
        ),
        "Is Petra at your home or at work?",
        AppDataIs("navigation.destination", ("{which}",)),
        Open("map"),
        Tap(text="{which}"),
        SETS_OUT,
        untold=wrote(PARIS, ("Petra Adler", "I'm standing here, where are you?")),
        told=wrote(
            PARIS,
            (
                "Petra Adler",
                param(
                    "which",
                    {"Home": "I'm at your home, where are you?", "Work": "I'm in your office, where are you?"},
                ),
            ),
        ),
        look=read_out("Petra Adler"),
        difference="content: Petra writes that she is there, or also where",
        parameters={"which": ("Home", "Work")},
    ),
    unclear(
        "maps_ask_which_museum",
        Module.MAPS,
        (
            "The class is in a museum today. Take me to them.",
            "Drive to the museum where the children are.",
            "I have to collect the kids from their museum trip.",
            "The school outing ends at the museum, that's where I have to go.",
            "My daughter's class is visiting one of the museums; go there.",
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
        untold=wrote(PARIS, ("School", "The outing ends at four. Please be punctual.")),
        told=wrote(PARIS, ("School", "The outing ends at four, at the {which} Museum. Please be punctual.")),
        look=read_out("School"),
        difference="content: the school writes when the outing ends, or also where",
        parameters={"which": ("City", "Science", "Modern", "Maritime")},
        dimension=Dimension.IMPLICIT_INTENT,
    ),
    unclear(
        "maps_ask_what_to_avoid",
        Module.MAPS,
        (
            "Set the route to avoid what my passenger can't bear: toll roads or tunnels.",
            "Avoid tunnels or toll roads, whichever Rosa asked for.",
            "Rosa doesn't want one of them, tunnels or tolls. Keep it off the route.",
            "Route options: no tolls or no tunnels, as Rosa wishes.",
            "Rosa has one request for the route, about tunnels or tolls. See to it.",
        ),
        Topic(
            "what to avoid",
            (("toll", "tolls", "toll roads"), ("tunnel", "tunnels")),
            param("which", {"toll roads": "Toll roads.", "tunnels": "Tunnels."}),
            ("rosa", "avoid"),
        ),
        "What does Rosa want to avoid, toll roads or tunnels?",
        AppDataIs("navigation.avoid", (param("which", {words: [kind] for words, kind in AVOIDED.items()}),)),
        Open("map"),
        Tap("map.route"),
        Tap("route.tab.options"),
        Tap(param("which", {words: f"route.avoid.{kind}" for words, kind in AVOIDED.items()})),
        untold=wrote(PARIS, ("Rosa Bianchi", "See you at the corner! And please do as I asked.")),
        told=wrote(PARIS, ("Rosa Bianchi", "See you at the corner! And please no {which}.")),
        look=read_out("Rosa Bianchi"),
        difference="content: Rosa reminds of her wish, or says what it is",
        parameters={"which": tuple(AVOIDED)},
    ),
    unclear(
        "maps_ask_which_kitchen",
        Module.MAPS,
        (
            "Anchor Kitchen is shut tonight. Go to the one that Quinn chose instead, Basil or Cedar.",
            "They've closed Anchor Kitchen, so it's Basil or Cedar Kitchen now, Quinn picked.",
            "Not Anchor Kitchen after all, it's closed; Quinn decided between Basil and Cedar.",
            "Dinner has moved from Anchor Kitchen to Basil or Cedar, ask nobody but Quinn or me.",
            "Basil Kitchen or Cedar Kitchen, whatever Quinn booked now that the Anchor is closed.",
        ),
        Topic(
            "which restaurant",
            (("basil",), ("cedar",)),
            param("which", {"Basil": "Basil Kitchen.", "Cedar": "Cedar Kitchen."}),
            ("restaurant", "kitchen", "quinn", "dinner"),
        ),
        "Did Quinn choose Basil Kitchen or Cedar Kitchen?",
        AppDataIs("navigation.destination", ("{which} Kitchen",)),
        *_to("restaurant", "{which} Kitchen"),
        untold=wrote(PARIS, ("Quinn Farrow", "Table for two at eight, don't be late!")),
        told=wrote(PARIS, ("Quinn Farrow", "Table for two at {which} Kitchen at eight, don't be late!")),
        look=read_out("Quinn Farrow"),
        difference="content: Quinn writes when the table is booked, or also where",
        parameters={"which": ("Basil", "Cedar")},
    ),
    unclear(
        "maps_ask_which_station",
        Module.MAPS,
        (
            "Elif's train is coming in. Take me to the station.",
            "I'm fetching Elif from the train.",
            "To the station, Elif arrives soon.",
            "Elif's on the train; let's pick her up.",
            "Drive to where Elif gets off the train.",
        ),
        Topic(
            "which station",
            (("central",), ("east",), ("west",)),
            "{which} Station.",
            ("station", "train", "elif", "where"),
        ),
        "Which station: Central, East or West?",
        AppDataIs("navigation.destination", ("{which} Station",)),
        *_to("station", "{which} Station"),
        untold=wrote(PARIS, ("Elif Moreau", "I'm on the train, we're on time.")),
        told=wrote(PARIS, ("Elif Moreau", "I'm on the train to {which} Station, we're on time.")),
        look=read_out("Elif Moreau"),
        difference="content: Elif writes that she is on the train, or also where she gets off",
        parameters={"which": ("Central", "East", "West")},
        dimension=Dimension.IMPLICIT_INTENT,
    ),
)
