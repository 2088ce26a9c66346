"""What the day holds: the calendar has it, or only that there is something."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.phone.state import Contact
from automotive_cosim.cockpit.signals import HMI, MEDIA
from automotive_cosim.tasking.checks import AllOf, AppDataIs, Entered, SignalIs
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.moves import Open, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasks.clarify.forms import clarify, entry, planned
from automotive_cosim.tasks.forms import AT_THE_KERB, FRIENDS, PARIS
from automotive_cosim.tasks.maps import SETS_OUT
from automotive_cosim.tasks.media import PLAYS
from automotive_cosim.tasks.system import LANGUAGES

LOOK = (Open("calendar"),)
ISLA, OSKAR = "Isla Brook", "Oskar Lindt"
PEOPLE = {"Isla": ISLA, "Oskar": OSKAR}
KNOWN = (Contact(ISLA, "555 31 40"), Contact(OSKAR, "555 84 26"))
WHO = Topic("whom", (("isla",), ("oskar",)), "{which}.", ("who", "whom", "{what}"))
FAVOURITE = (Open("phone"), Tap("phone.tab.favourites"), Tap(text=param("which", PEOPLE)))
EVENINGS = ("dinner", "concert", "game", "class")
MORNINGS_OUT = ("breakfast", "class", "lesson", "tour")
STAYS = {"one hour": 60, "two hours": 120}
WHOM = ("physio", "dentist", "hairdresser", "notary")
EARLY = replace(AT_THE_KERB, start="2026-11-18T05:10:00")
MORNINGS = ("7:30", "8:30")
SET_OUT = {"7:30": "07:30", "8:30": "08:30"}
HOW_EARLY = (("7 30", "07 30", "half past seven"), ("8 30", "08 30", "half past eight"))
AT_HALF_PAST = param("which", {"7:30": "At half past seven.", "8:30": "At half past eight."})
HOTELS, GYMS = ("Meridian", "Royal"), ("Iron", "Summit")
LISTS = ("Dance", "Sunday")
GUESTS = {"French": "Lyon", "German": "Hamburg", "Japanese": "Osaka"}
MEETING = entry("10:00", "Team meeting", "Work")

TASKS = (
    clarify(
        "clarify_whom_to_ring",
        Module.COMMS,
        (
            "Ring whoever I have the {what} with tonight, Isla or Oskar.",
            "I need to talk to the one who comes to the {what}: Oskar or Isla. Call, please.",
            "Get me Isla or Oskar on the line, the one I'm seeing for the {what}.",
            "Oskar, or Isla? Phone the right one about the {what}.",
            "It's about the {what} this evening, so could you call Isla, or is it Oskar?",
        ),
        WHO,
        "Who is the {what} with, Isla or Oskar?",
        Entered("calls", param("which", PEOPLE)),
        *FAVOURITE,
        Tap("contact.call"),
        untold=planned(PARIS, MEETING, entry("19:00", "Evening: {what}"), contacts=KNOWN),
        told=planned(PARIS, MEETING, entry("19:00", "Evening: {what} with {which}"), contacts=KNOWN),
        look=LOOK,
        difference="content: the calendar has the evening, or also with whom",
        parameters={"which": tuple(PEOPLE), "what": EVENINGS},
    ),
    clarify(
        "clarify_who_waits",
        Module.COMMS,
        (
            "I'll be ten minutes late for the {what}. Write that to Oskar or Isla, whoever waits there.",
            "Isla or Oskar will be standing there before the {what}: text that one that I'm 10 minutes late.",
            "Oskar, Isla? Let the one I meet for the {what} know that I'm late, ten minutes.",
            "Message the person I've the {what} with, that's Isla or Oskar, I'm ten minutes behind.",
            "Tell Oskar or Isla, whoever is coming to the {what}, that I'm ten minutes late.",
        ),
        WHO,
        "Who waits for you at the {what}, Isla or Oskar?",
        Entered("messages.sent", {"to": param("which", PEOPLE), "text": "I'll be 10 minutes late"}),
        *FAVOURITE,
        Tap("contact.message"),
        Tap(text="I'll be 10 minutes late"),
        untold=planned(PARIS, entry("08:20", "Go to the {what}"), MEETING, contacts=KNOWN),
        told=planned(PARIS, entry("08:20", "Go to the {what} with {which}"), MEETING, contacts=KNOWN),
        look=LOOK,
        difference="content: the calendar has the hour, or also with whom",
        parameters={"which": tuple(PEOPLE), "what": MORNINGS_OUT},
    ),
    clarify(
        "clarify_where_we_meet",
        Module.MAPS,
        (
            "Guide me to where I meet {who}, the Theatre or the Garden Car Park.",
            "{who} and I agreed on a car park, Garden or Theatre. Go there.",
            "Theatre Car Park, Garden Car Park: take me to the one I arranged with {who}.",
            "I'm to meet {who} at noon, was it the Garden or the Theatre Car Park? Start the route.",
            "Start guidance to the spot {who} and I settled on. Garden or Theatre Car Park, it's one of the two.",
        ),
        Topic(
            "which car park",
            (("theatre",), ("garden",)),
            param("which", {"Theatre": "At the Theatre Car Park.", "Garden": "At the Garden Car Park."}),
            ("car park", "{who}", "where", "meet"),
        ),
        "Where do you meet {who}, at the Theatre or the Garden Car Park?",
        AppDataIs("navigation.destination", ("{which} Car Park",)),
        Open("map"),
        Tap("map.list.explore"),
        Tap("explore.kind.parking"),
        Tap(text="{which} Car Park"),
        SETS_OUT,
        untold=planned(PARIS, MEETING, entry("12:00", "Meet {who}")),
        told=planned(PARIS, MEETING, entry("12:00", "Meet {who}", "{which} Car Park")),
        look=LOOK,
        difference="content: the calendar has when they meet, or also where",
        parameters={"which": ("Theatre", "Garden"), "who": FRIENDS},
    ),
    clarify(
        "clarify_which_hotel",
        Module.MAPS,
        (
            "Take me to the hotel where {who} has a room for us, Meridian or Royal.",
            "Which hotel are {who} and I staying at, the Royal or the Meridian? Drive there.",
            "To our hotel, please, the one that {who} booked. Meridian? Royal?",
            "{who} reserved at the Royal or at the Meridian. Set the route to it.",
            "Guide us to the Meridian or to the Royal, wherever {who}'s booking is.",
        ),
        Topic(
            "which hotel",
            (("meridian",), ("royal",)),
            "The {which}.",
            ("hotel", "{who}", "booked", "booking"),
        ),
        "Which hotel is it, the Meridian or the Royal?",
        AppDataIs("navigation.destination", ("Hotel {which}",)),
        Open("map"),
        Tap("map.list.explore"),
        Tap("explore.kind.hotel"),
        Tap(text="Hotel {which}"),
        SETS_OUT,
        untold=planned(PARIS, MEETING, entry("20:00", "Check in with {who}")),
        told=planned(PARIS, MEETING, entry("20:00", "Check in with {who}", "Hotel {which}")),
        look=LOOK,
        difference="content: the calendar has the booking's hour, or also the hotel",
        parameters={"which": HOTELS, "who": FRIENDS},
    ),
    clarify(
        "clarify_which_gym",
        Module.MAPS,
        (
            "I train with {who} today. Off to the gym.",
            "{who} is expecting me for training, drive me there.",
            "Today's workout with {who}: start guidance to it.",
            "To the gym that I go to with {who} this afternoon.",
            "Bring me where {who} and I do our training today.",
        ),
        Topic(
            "which gym",
            (("iron",), ("summit",), ("active",), ("pace",)),
            "The {which} Gym.",
            ("gym", "training", "{who}", "where"),
        ),
        "Which gym: Iron, Summit, Active or Pace?",
        AppDataIs("navigation.destination", ("{which} Gym",)),
        Open("map"),
        Tap("map.list.explore"),
        Tap("explore.kind.gym"),
        Tap(text="{which} Gym"),
        SETS_OUT,
        untold=planned(PARIS, MEETING, entry("16:00", "Training with {who}")),
        told=planned(PARIS, MEETING, entry("16:00", "Training with {who}", "{which} Gym")),
        look=LOOK,
        find=(Open("map"), Tap("map.list.explore"), Tap("explore.kind.gym")),
        difference="content: the calendar has the training, or also at which gym",
        parameters={"which": GYMS, "who": FRIENDS},
    ),
    clarify(
        "clarify_how_long_it_takes",
        Module.APPS,
        (
            "Parking in zone B for the whole appointment at the {whom}, one hour or two hours.",
            "I'm off to the {whom}. Two hours or one hour in zone B, as long as it takes there.",
            "One hour? Two hours? A zone B ticket until the {whom} has finished with me.",
            "Pay zone B for the time that the {whom} needs, that's two hours or one hour.",
            "Buy parking in zone B for exactly the time that the {whom} takes, two hours or one hour.",
        ),
        Topic(
            "how long it takes",
            (("one hour", "an hour", "1", "one"), ("two hours", "2", "two")),
            "It takes {which}.",
            ("long", "appointment", "{whom}", "time"),
        ),
        "How long does the {whom} take, one hour or two hours?",
        AllOf(
            (
                Entered("payments", {"zone": "Zone B", "minutes": param("which", STAYS)}),
                AppDataIs("parking.zone", ("Zone B",)),
                AppDataIs("parking.minutes", (param("which", STAYS),)),
            )
        ),
        Open("parking"),
        Tap(text="Zone B"),
        Tap(param("which", {words: f"parking.time.{minutes}" for words, minutes in STAYS.items()})),
        Tap("parking.pay"),
        untold=planned(AT_THE_KERB, MEETING, entry("11:30", "At the {whom}'s")),
        told=planned(AT_THE_KERB, MEETING, entry("11:30", "At the {whom}'s, {which}")),
        look=LOOK,
        difference="content: the calendar has the appointment, or also how long it takes",
        parameters={"which": tuple(STAYS), "whom": WHOM},
    ),
    clarify(
        "clarify_which_zone",
        Module.APPS,
        (
            "I've parked for the {whom}. Pay an hour, zone A or C, whichever it is round here.",
            "One hour of parking at my {whom}'s. C? A? You find the zone.",
            "Get the ticket for the {whom}, 60 minutes in the right zone, A or C.",
            "Is it zone C or A at the {whom}'s? An hour's ticket, please.",
            "Sixty minutes for my visit to the {whom}, in zone A or C, whichever it is there.",
        ),
        Topic(
            "which zone",
            (("a", "zone a"), ("c", "zone c")),
            "Zone {which}.",
            ("zone", "parking", "{whom}"),
        ),
        "Which zone is it at the {whom}'s, A or C?",
        AllOf(
            (
                Entered("payments", {"zone": "Zone {which}", "minutes": 60}),
                AppDataIs("parking.zone", ("Zone {which}",)),
            )
        ),
        Open("parking"),
        Tap(text="Zone {which}"),
        Tap("parking.pay"),
        untold=planned(AT_THE_KERB, MEETING, entry("08:30", "At the {whom}'s", "Second floor")),
        told=planned(AT_THE_KERB, MEETING, entry("08:30", "At the {whom}'s", "Second floor, park in zone {which}")),
        look=LOOK,
        difference="content: the calendar has the floor, or also the parking zone",
        parameters={"which": ("A", "C"), "whom": WHOM},
    ),
    clarify(
        "clarify_warm_when_we_leave",
        Module.HVAC,
        (
            "{who} and I set off this morning at 7:30 or 8:30. Have the car warm for that.",
            "Preheat so that it's cosy when {who} and I leave, 8:30 or 7:30.",
            "Half past seven, or half past eight? Cabin warm by the time I start with {who}.",
            "I don't want {who} to freeze when we get going at 8:30, or is it 7:30. Schedule the heating.",
            "Warm it up for our departure with {who}, be that 7:30 or 8:30.",
        ),
        Topic("when they leave", HOW_EARLY, AT_HALF_PAST, ("{who}", "when", "time", "leave")),
        "Do you leave with {who} at 7:30 or at 8:30?",
        AppDataIs("climate.schedule", (param("which", SET_OUT),)),
        Open("climate"),
        Tap("hvac.comfort"),
        TapUntil("climate.schedule.later", "climate.schedule.time", param("which", SET_OUT)),
        Tap("climate.schedule"),
        untold=planned(
            EARLY,
            entry("07:30", "Leave with {who}?"),
            entry("08:30", "Leave with {who}?"),
            entry("17:00", "Shopping"),
        ),
        told=planned(EARLY, entry(param("which", SET_OUT), "Leave with {who}"), entry("17:00", "Shopping")),
        look=LOOK,
        difference="content: the calendar has two hours for the departure, or one",
        parameters={"which": MORNINGS, "who": FRIENDS},
    ),
    clarify(
        "clarify_charged_when_we_leave",
        Module.APPS,
        (
            "I fetch {who} this morning, 8:30 or 7:30. The battery has to be ready by then.",
            "Charging done before I drive to {who}, at 7:30 or 8:30.",
            "Half past eight, half past seven? Schedule the charging for {who}'s pick-up.",
            "Full battery when I go and get {who}. 7:30? 8:30? Set the time.",
            "Be charged by the time I collect {who}, 8:30 or 7:30.",
        ),
        Topic("when she is fetched", HOW_EARLY, AT_HALF_PAST, ("{who}", "when", "time", "fetch")),
        "Do you fetch {who} at 7:30 or at 8:30?",
        AppDataIs("charging.schedule", (param("which", SET_OUT),)),
        Open("charging"),
        TapUntil("charging.schedule.later", "charging.schedule.time", param("which", SET_OUT)),
        Tap("charging.schedule"),
        untold=planned(EARLY, entry("17:00", "Bring {who} home")),
        told=planned(EARLY, entry(param("which", SET_OUT), "Fetch {who}"), entry("17:00", "Bring {who} home")),
        look=LOOK,
        difference="content: the calendar says when she is brought home, or also when she is fetched",
        parameters={"which": MORNINGS, "who": FRIENDS},
    ),
    clarify(
        "clarify_what_the_visitor_speaks",
        Module.SYSTEM,
        (
            "We collect the {guest} next. Screen into his language: French, German or Japanese.",
            "The display should greet the {guest} in his own tongue, Japanese, French or German.",
            "What does today's {guest} speak? German, Japanese, French: set the car to it.",
            "Switch the menus for our {guest}. It's French, German or Japanese he understands.",
            "Put the screen in the {guest}'s language, German, French or Japanese, whichever he speaks.",
        ),
        Topic(
            "which language",
            (("french",), ("german",), ("japanese",)),
            "He speaks {which}.",
            ("language", "{guest}", "speak"),
        ),
        "Which language does he speak: French, German or Japanese?",
        SignalIs(HMI.LANGUAGE, (param("which", LANGUAGES),)),
        Open("settings"),
        Tap("settings.page.language"),
        Tap(param("which", {name: f"language.{code}" for name, code in LANGUAGES.items()})),
        untold=planned(PARIS, entry("09:00", "Collect the {guest}"), MEETING),
        told=planned(
            PARIS,
            entry(
                "09:00",
                param("which", {k: f"Collect the {{guest}}, who comes from {v}" for k, v in GUESTS.items()}),
            ),
            MEETING,
        ),
        look=LOOK,
        difference="content: the calendar has the visit, or also the town that he comes from",
        parameters={"which": tuple(GUESTS), "guest": ("visitor", "client", "engineer", "speaker")},
    ),
    clarify(
        "clarify_list_for_the_party",
        Module.MEDIA,
        (
            "Let's hear tonight's list for the {what}, Dance or Sunday.",
            "Which playlist goes with the {what} this evening: Sunday or Dance? Play it.",
            "Get us into the mood for the {what} with the right list: it's Dance, or it's Sunday.",
            "I want to go through the music for the {what}, that's Sunday or Dance.",
            "Start Dance or Sunday, the list that's meant for the {what}.",
        ),
        Topic("which playlist", (("dance",), ("sunday",)), "{which}.", ("playlist", "list", "{what}", "music")),
        "Which playlist is for the {what}, Dance or Sunday?",
        AllOf((PLAYS, AppDataIs("media.playlist", ("{which}",)))),
        Open("media"),
        Tap("media.list.playlists"),
        Tap(text="{which}"),
        Tap("playlist.play"),
        untold=planned(PARIS, MEETING, entry("20:00", "Music for the {what}")),
        told=planned(PARIS, MEETING, entry("20:00", "Music for the {what}: {which}")),
        look=LOOK,
        difference="content: the calendar has the evening, or also its playlist",
        parameters={"which": LISTS, "what": ("birthday", "reunion", "wedding", "picnic")},
        may_write=frozenset({MEDIA.SELECTED.path}),
    ),
)
