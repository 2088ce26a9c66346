"""Apps: charging, parking, manual, memos, trip and store."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.signals import ENERGY
from automotive_cosim.tasking.checks import (
    AllOf,
    AnyOf,
    AppDataHas,
    AppDataIs,
    Counted,
    Entered,
    SignalIs,
    SignalWithin,
)
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasks.apps_safety import PAIRS
from automotive_cosim.tasks.forms import AT_REST, AT_THE_KERB, COMFORT, PARIS, asked, hinted, locked

STAYS = {"half an hour": 30, "one hour": 60, "two hours": 120, "four hours": 240}
"""What the driver says, and the minutes meant."""
HALF_HOURS = ("07:30", "08:00", "08:30", "09:00", "09:30", "10:00")
"""Times a few taps after 07:00, where a timer starts."""
HALF_AN_HOUR_BEFORE = dict(zip(HALF_HOURS, ("07:00", *HALF_HOURS), strict=False))
"""When the climate control may start by itself for a cabin that is warm at that time."""
CHARGE_BY = TapUntil("charging.schedule.later", "charging.schedule.time", "{time}")
WARM_BY = TapUntil("climate.schedule.later", "climate.schedule.time", "{time}")

EXPLICIT = (
    asked(
        "apps_pay_parking",
        Module.APPS,
        (
            "Pay for {stay} in zone {zone}.",
            "Parking ticket, zone {zone}, {stay}.",
            "I'm leaving the car in zone {zone}: {stay} should do, pay it.",
            "Buy me {stay} of parking over in zone {zone}.",
        ),
        AllOf(
            (
                Entered("payments", {"zone": "Zone {zone}", "minutes": param("stay", STAYS)}),
                AppDataIs("parking.zone", ("Zone {zone}",)),
                AppDataIs("parking.minutes", (param("stay", STAYS),)),
            )
        ),
        Open("parking"),
        Tap(text="Zone {zone}"),
        Tap(param("stay", {words: f"parking.time.{minutes}" for words, minutes in STAYS.items()})),
        Tap("parking.pay"),
        start=AT_THE_KERB,
        trigger=AT_REST,
        parameters={"stay": tuple(STAYS), "zone": ("A", "B", "C")},
    ),
    asked(
        "apps_charge_plan",
        Module.APPS,
        (
            "Charge to {percent} percent and be ready by {time}.",
            "Full to {percent} at {time}, please.",
            "Set the limit at {percent} and have the battery done by {time}.",
            "I leave at {time} tomorrow and want {percent} percent by then.",
        ),
        AllOf(
            (SignalIs(ENERGY.CHARGE_LIMIT, (param("percent"),)), AppDataIs("charging.schedule", (param("time"),)))
        ),
        Open("charging"),
        Slide("charging.limit", param("percent"), 50.0, 100.0),
        Tap("charging.schedule"),
        CHARGE_BY,
        ways=(
            (
                Open("charging"),
                CHARGE_BY,
                Tap("charging.schedule"),
                Slide("charging.limit", param("percent"), 50.0, 100.0),
            ),
        ),
        parameters={"percent": (50, 55, 60, 65, 70, 75, 85, 90, 95, 100), "time": HALF_HOURS},
    ),
    asked(
        "apps_ready_to_leave",
        Module.APPS,
        (
            "Tomorrow at {time} I want the battery at {percent} and the cabin warm.",
            "For tomorrow, charge to {percent} by {time}, and preheat for the same hour.",
            "Tomorrow at {time}: {percent} percent charged, air conditioned in time.",
            "I set off at {time}. Have the car warmed up and charged to {percent} percent by then.",
        ),
        AllOf(
            (
                SignalIs(ENERGY.CHARGE_LIMIT, (param("percent"),)),
                AppDataIs("charging.schedule", (param("time"),)),
                AppDataIs("climate.schedule", (param("time"), param("time", HALF_AN_HOUR_BEFORE))),
            )
        ),
        Open("charging"),
        Slide("charging.limit", param("percent"), 50.0, 100.0),
        Tap("charging.schedule"),
        CHARGE_BY,
        Open("climate"),
        Tap("hvac.comfort"),
        WARM_BY,
        Tap("climate.schedule"),
        parameters={"percent": (85, 90, 95, 100), "time": HALF_HOURS[:4]},
        tags=frozenset({"two_modules"}),
    ),
    asked(
        "apps_start_memo",
        Module.APPS,
        (
            "Start a voice memo.",
            "Record what I say now.",
            "Take this down, I'm dictating.",
            "New voice note, please, start it.",
        ),
        AppDataIs("apps.recording", (True,)),
        Open("memo"),
        Tap("memo.record"),
        deadline=COMFORT,
    ),
    asked(
        "apps_reset_trip",
        Module.APPS,
        (
            "Reset the trip computer.",
            "Count the kilometres from here.",
            "Zero the distance and consumption, please.",
            "I want a fresh start on the trip meter.",
        ),
        Counted("trip.resets"),
        Open("trip"),
        Tap("trip.reset"),
        deadline=COMFORT,
    ),
    locked(
        "apps_install_calendar",
        Module.APPS,
        (
            "Install the calendar.",
            "Get me the calendar app from the store.",
            "I need my appointments in the car, download that thing.",
            "Add the calendar to the apps, please.",
        ),
        AppDataHas("apps.installed", "calendar"),
        Open("apps"),
        Tap("apps.store"),
        Tap("store.calendar"),
    ),
    locked(
        "apps_remove_app",
        Module.APPS,
        (
            "Uninstall the {app} app.",
            "Throw {app} out, I never use that app.",
            "Remove {app} from the car's apps.",
            "Get rid of the app called {app}, please.",
        ),
        AppDataHas("apps.installed", "{app}", there=False),
        Open("apps"),
        Tap("apps.store"),
        Tap("store.{app}"),
        parameters={"app": ("charging", "parking", "manual", "memo", "trip")},
    ),
    locked(
        "apps_open_flap",
        Module.APPS,
        (
            "Open the charging flap.",
            "Flap open, I'll plug in.",
            "Uncover the charge port, please.",
            "Open it where the charging cable goes in.",
        ),
        SignalIs(ENERGY.CHARGE_FLAP, (True,)),
        Open("charging"),
        Tap("charging.flap"),
    ),
)

IMPLICIT = (
    hinted(
        "apps_brilliant_idea",
        Module.APPS,
        (
            "I just had an idea that I mustn't forget.",
            "Quick, before it slips my mind again!",
            "Somebody ought to write down what I'm about to say.",
            "If only I had pen and paper right now.",
        ),
        AnyOf((AppDataIs("apps.recording", (True,)), Entered("apps.memos"))),
        Open("memo"),
        Tap("memo.record"),
        ways=((Open("memo"), Tap("memo.record", times=2)),),
    ),
    hinted(
        "apps_battery_to_last",
        Module.APPS,
        (
            "I want these cells to last ten years.",
            "They say it's bad to fill it to the brim every night.",
            "My dealer told me never to go all the way up, it ages the pack.",
            "I only do short trips this month, so don't charge it fuller than is good for it.",
        ),
        SignalWithin(ENERGY.CHARGE_LIMIT, 50.0, 80.0),
        Open("charging"),
        Slide("charging.limit", 80.0, 50.0, 100.0),
        start=replace(PARIS, signals={ENERGY.CHARGE_LIMIT.path: 100.0}),
        tags=frozenset({"preference"}),
    ),
)

TASKS = (*EXPLICIT, *IMPLICIT, *PAIRS)
