"""Apps, wishes that do not say enough: which zone, how long, how far to charge, by when, which app."""

from __future__ import annotations

from automotive_cosim.cockpit.signals import ENERGY
from automotive_cosim.tasking.checks import AllOf, AppDataHas, AppDataIs, Entered, SignalIs
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Dimension, Module
from automotive_cosim.tasks.forms import (
    AT_THE_KERB,
    FRIENDS,
    PARIS,
    PARKED_WHEN_WRITTEN,
    read_out,
    unclear,
    wrote,
)

STAYS = {"one hour": 60, "two hours": 120, "four hours": 240}
APPS = {"memo": "memo", "trip": "trip computer"}

TASKS = (
    unclear(
        "apps_ask_which_zone",
        Module.APPS,
        (
            "Pay for an hour here. {who} knows which zone this is, A, B or C.",
            "One hour of parking in the zone that {who} knows.",
            "Get me a ticket for 60 minutes; it's zone A, B or C, as {who} has it.",
            "Buy an hour in the right zone, the one that {who} goes by.",
            "Park us here for an hour, zone as {who} says.",
        ),
        Topic(
            "which zone",
            (("a", "zone a"), ("b", "zone b"), ("c", "zone c")),
            "It's zone {which}.",
            ("zone", "parking", "{who}"),
        ),
        "Which zone is it: A, B or C?",
        AllOf(
            (
                Entered("payments", {"zone": "Zone {which}", "minutes": 60}),
                AppDataIs("parking.zone", ("Zone {which}",)),
            )
        ),
        Open("parking"),
        Tap(text="Zone {which}"),
        Tap("parking.pay"),
        untold=wrote(AT_THE_KERB, ("{who}", "Don't forget the ticket, they check every hour here.")),
        told=wrote(AT_THE_KERB, ("{who}", "Don't forget the ticket for zone {which}, they check every hour.")),
        look=read_out("{who}"),
        find=(Open("parking"),),
        difference="content: the friend reminds of the ticket, or also says for which zone",
        parameters={"which": ("A", "B", "C"), "who": FRIENDS},
        trigger=PARKED_WHEN_WRITTEN,
    ),
    unclear(
        "apps_ask_how_long",
        Module.APPS,
        (
            "Pay for zone B as long as my time at the {whom} takes.",
            "A ticket in zone B for the time I'm at the {whom}.",
            "Zone B, and the ticket has to last for the whole appointment at the {whom}.",
            "I'm going to my {whom}. Parking in zone B until I'm through.",
            "Buy zone B for however long the {whom} needs me.",
        ),
        Topic(
            "how long it takes",
            (("one hour", "an hour", "1", "one"), ("two hours", "2", "two"), ("four hours", "4", "four")),
            "It takes {which}.",
            ("long", "appointment", "{whom}", "time"),
        ),
        "How long does it take: one hour, two hours or four hours?",
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
        untold=wrote(AT_THE_KERB, ("Your {whom}", "We look forward to seeing you.")),
        told=wrote(AT_THE_KERB, ("Your {whom}", "We look forward to seeing you. It takes {which} today.")),
        look=read_out("Your {whom}"),
        difference="content: the message confirms the appointment, or also how long it takes",
        parameters={"which": tuple(STAYS), "whom": ("physio", "dentist", "hairdresser", "notary")},
        trigger=PARKED_WHEN_WRITTEN,
        dimension=Dimension.IMPLICIT_INTENT,
    ),
    unclear(
        "apps_ask_how_far_to_charge",
        Module.APPS,
        (
            "Set the charge limit to what the {whom} wants, 65 or 90.",
            "Charge limit: 90 or 65, whichever the {whom} recommends.",
            "The {whom} knows how full the battery should get, 65 or 90 percent. Set that.",
            "Limit the charging as the {whom} wants it, to 65 or to 90.",
            "65 or 90 percent? Whatever the {whom} says, make it the limit.",
        ),
        Topic("the charge limit", (("65",), ("90",)), "{which} percent.", ("limit", "{whom}", "percent", "charge")),
        "What did the {whom} say, 65 or 90 percent?",
        SignalIs(ENERGY.CHARGE_LIMIT, (param("which"),)),
        Open("charging"),
        Slide("charging.limit", param("which"), 50.0, 100.0),
        untold=wrote(PARIS, ("Your {whom}", "Your battery is checked. Please set the limit as discussed.")),
        told=wrote(PARIS, ("Your {whom}", "Your battery is checked. Please set the limit to {which} percent.")),
        look=read_out("Your {whom}"),
        difference="content: a message reminds of the limit, or also states it",
        parameters={"which": (65, 90), "whom": ("workshop", "dealer", "garage", "service centre")},
    ),
    unclear(
        "apps_ask_charged_by_when",
        Module.APPS,
        (
            "The car has to be charged when the {whom} come tomorrow. Set the time.",
            "Have it charged by the time the {whom} arrive, 7:30 or 8:30.",
            "Charging has to be done when the {whom} are there in the morning.",
            "Tomorrow the {whom} come, at 7:30 or at 8:30; full by then, please.",
            "Set the charging so that it's ready for the {whom}.",
        ),
        Topic(
            "when the {whom} come",
            (("7 30", "07 30", "half past seven"), ("8 30", "08 30", "half past eight")),
            param("which", {"07:30": "At half past seven.", "08:30": "At half past eight."}),
            ("{whom}", "when", "time"),
        ),
        "Do the {whom} come at 7:30 or at 8:30?",
        AppDataIs("charging.schedule", (param("which"),)),
        Open("charging"),
        TapUntil("charging.schedule.later", "charging.schedule.time", "{which}"),
        Tap("charging.schedule"),
        untold=wrote(PARIS, ("Your {whom}", "See you tomorrow at 7:30 or 8:30, as you told us on the phone.")),
        told=wrote(PARIS, ("Your {whom}", "See you tomorrow at {which}, as you told us on the phone.")),
        look=read_out("Your {whom}"),
        find=read_out("Your {whom}"),
        difference="content: they write two times, or one",
        parameters={"which": ("07:30", "08:30"), "whom": ("movers", "painters", "plumbers", "gardeners")},
    ),
    unclear(
        "apps_ask_which_app",
        Module.APPS,
        (
            "The {whom} wants one app off this car. Uninstall it.",
            "Remove the app that the {whom} complains about, memos or trip.",
            "Delete memos or the trip computer, whichever the {whom} doesn't allow.",
            "One of my apps has to go, the {whom} says. Take it off.",
            "Throw out the app that the {whom} won't have, trip or memos.",
        ),
        Topic(
            "which app",
            (("memo", "memos"), ("trip", "trip computer")),
            param("which", {"memo": "The memos.", "trip": "The trip computer."}),
            ("app", "{whom}"),
        ),
        "Which app has to go, the memos or the trip computer?",
        AppDataHas("apps.installed", "{which}", there=False),
        Open("apps"),
        Tap("apps.store"),
        Tap("store.{which}"),
        untold=wrote(AT_THE_KERB, ("Your {whom}", "Please uninstall the app that we talked about.")),
        told=wrote(
            AT_THE_KERB,
            (
                "Your {whom}",
                param("which", {app: f"Please uninstall the {name} app." for app, name in APPS.items()}),
            ),
        ),
        look=read_out("Your {whom}"),
        find=(Open("apps"), Tap("apps.store")),
        difference="content: a message reminds of an app, or names it",
        parameters={"which": tuple(APPS), "whom": ("fleet office", "company", "rental firm", "leasing firm")},
        trigger=PARKED_WHEN_WRITTEN,
    ),
)
