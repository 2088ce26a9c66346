"""HVAC, hints: the driver says how it feels, not what to do."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import company
from automotive_cosim.cockpit.signals import CABIN, HVAC, SEAT
from automotive_cosim.cockpit.vehicle import WINDOWS
from automotive_cosim.contracts import Weather
from automotive_cosim.tasking.checks import (
    AllOf,
    AnyOf,
    AppDataIs,
    SignalIs,
    SignalLowered,
    SignalRaised,
    SignalWithin,
)
from automotive_cosim.tasking.effects import CabinWarmer
from automotive_cosim.tasking.moves import Open, Slide, Tap, TapUntil
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Module, Start
from automotive_cosim.tasks.forms import ERRAND, PARIS, hinted
from automotive_cosim.tasks.hvac import SHUT_WINDOWS

COLD = replace(PARIS, cabin={"temperature_c": 12.0})
COLD_THERE, FROST_THERE = ("london", "new_york", "tokyo", "autobahn", "grid"), ("london", "grid")
"""Other scenarios in whose season a cabin can be that cold, and in which there can be frost tomorrow."""
HOT = Weather(34.0, 45.0, 0.0, 0, 10.0, 20_000.0, 8.0)
MILD = Weather(24.0, 60.0, 0.0, 1, 20.0, 20_000.0, 8.0)
"""Air that is damp enough to be dried by cooling."""
SPRING = Weather(16.0, 55.0, 0.0, 1, 20.0, 20_000.0, 14.0)
MORE_WARM_AIR = (Open("climate"), Tap("hvac.fan.max"))
NOTICED_K = 0.5
"""How much warmer a minute has to make the air to count: half a step of the set point; our choice."""
DOORS = (Open("vehicle"), Tap("vehicle.tab.doors"))
FRESH_AIR = AnyOf(
    (
        SignalIs(HVAC.RECIRCULATION, (False,)),
        *(SignalRaised(opening, 10.0) for opening in (*WINDOWS, CABIN.SUNROOF)),
    )
)
"""Fresh air: recirculation is off, or a window or the roof is open."""
FRESH_AIR_WAYS = (
    (*DOORS, Slide("window.driver", 30.0)),
    (*DOORS, Slide("window.passenger", 20.0)),
    (*DOORS, Slide("window.rear_left", 50.0)),
    (*DOORS, Slide("window.rear_right", 50.0)),
    (*DOORS, Slide("window.sunroof", 40.0)),
    (*DOORS, Tap("window.vent")),
)
SCHEDULE = (Open("climate"), Tap("hvac.comfort"))
BY_THEN = TapUntil("climate.schedule.later", "climate.schedule.time", "{time}")
LEAVING = {"07:30": "07:00", "08:00": "07:30", "08:30": "08:00", "09:00": "08:30", "09:30": "09:00"}
"""When the driver leaves, and half an hour before."""

TASKS = (
    hinted(
        "hvac_cold_hands",
        Module.HVAC,
        (
            "My hands are freezing.",
            "I can hardly feel my fingers.",
            "Brr, these thumbs are like ice.",
            "Should have brought gloves, my hands hurt.",
            "My knuckles are turning blue.",
        ),
        AnyOf(
            (
                SignalIs(SEAT.STEERING_WHEEL_HEATING, (100.0,)),
                CabinWarmer(NOTICED_K),
            )
        ),
        Open("climate"),
        Tap("hvac.steering_wheel_heating"),
        ways=(MORE_WARM_AIR,),
        start=COLD,
        scenarios=COLD_THERE,
    ),
    hinted(
        "hvac_stuffy",
        Module.HVAC,
        (
            "It feels stuffy in here.",
            "I can hardly breathe.",
            "This car is like a shut box.",
            "That stale smell gives me a headache.",
            "We've been breathing the same air for an hour.",
        ),
        FRESH_AIR,
        Open("climate"),
        Tap("hvac.recirculation"),
        ways=FRESH_AIR_WAYS,
        start=replace(PARIS, aboard=company(4), signals={HVAC.RECIRCULATION.path: True}),
    ),
    hinted(
        "hvac_cold_leather",
        Module.HVAC,
        (
            "The leather is ice cold under me.",
            "I'm sitting on a block of ice.",
            "My backside is freezing.",
            "Brr, whatever is under my legs is frozen stiff.",
            "This leather is freezing my backside off.",
        ),
        SignalIs(SEAT.DRIVER_HEATING, (50.0, 100.0)),
        Open("climate"),
        Tap("hvac.driver_seat_heating"),
        ways=((Open("climate"), Tap("hvac.driver_seat_heating", times=2)),),
        start=COLD,
        scenarios=COLD_THERE,
    ),
    hinted(
        "hvac_cold_toes",
        Module.HVAC,
        (
            "My toes are frozen.",
            "It's icy down by the pedals.",
            "I can't feel my ankles any more.",
            "These shoes are wet and cold.",
            "Everything below my knees is like ice.",
        ),
        AnyOf(
            (
                SignalIs(HVAC.AIR_DISTRIBUTION, ("DOWN",)),
                CabinWarmer(NOTICED_K),
            )
        ),
        Open("climate"),
        Tap("hvac.air.down"),
        ways=(MORE_WARM_AIR,),
        start=COLD,
        scenarios=COLD_THERE,
    ),
    hinted(
        "hvac_draught",
        Module.HVAC,
        (
            "There's a nasty draught right in my eyes.",
            "Something keeps blowing in my face.",
            "That breeze makes my eyes water.",
            "That wind on my forehead gets on my nerves.",
            "Can it stop puffing at me?",
        ),
        AnyOf((SignalIs(HVAC.AIR_DISTRIBUTION, ("UP", "DOWN")), SignalLowered(HVAC.FAN_SPEED, 30.0))),
        Open("climate"),
        Tap("hvac.air.down"),
        ways=((Open("climate"), Tap("hvac.air.up")), (Open("climate"), Slide("hvac.fan", 30.0))),
        start=replace(PARIS, signals={HVAC.FAN_SPEED.path: 80.0}),
    ),
    hinted(
        "hvac_wife_cold",
        Module.HVAC,
        (
            "My wife is shivering, I'm fine myself.",
            "She is cold over there, but not me.",
            "The one beside me has blue lips, leave my side as it is.",
            "My friend here is freezing, though I like it like this.",
            "My passenger is freezing; don't touch my side.",
        ),
        AnyOf(
            (SignalIs(SEAT.PASSENGER_HEATING, (50.0, 100.0)), SignalRaised(HVAC.PASSENGER_TEMPERATURE, 1.0)),
        ),
        Open("climate"),
        Tap("hvac.passenger_seat_heating"),
        ways=(
            (Open("climate"), Tap("hvac.passenger_seat_heating", times=2)),
            (Open("climate"), Tap("hvac.passenger_temperature.increase", times=3)),
        ),
        start=replace(PARIS, aboard=company(2), cabin={"temperature_c": 18.0}),
        tags=frozenset({"preference"}),
    ),
    hinted(
        "hvac_loud_but_cool",
        Module.HVAC,
        (
            "That roaring is unbearable, but keep us cool.",
            "I can't hear a word over this howling; don't let it get hot, though.",
            "Quieter, please, just without giving up the cold.",
            "The noise from the vents kills me, I still want it chilly.",
            "Turn that hurricane down, but it has to stay cool.",
        ),
        AllOf((SignalWithin(HVAC.FAN_SPEED, 10.0, 60.0), SignalIs(HVAC.AIR_CONDITIONING, (True,)))),
        Open("climate"),
        Slide("hvac.fan", 40.0),
        start=replace(
            PARIS,
            start="2026-07-21T14:15:00",
            weather=HOT,
            cabin={"temperature_c": 27.0},
            signals={HVAC.FAN_SPEED.path: 100.0, HVAC.AIR_CONDITIONING.path: True},
        ),
        tags=frozenset({"preference", "conflict"}),
    ),
    hinted(
        "hvac_parched",
        Module.HVAC,
        (
            "My contact lenses are as dry as paper.",
            "My throat is parched from this.",
            "I keep having to blink, it's bone-dry.",
            "Feels like sandpaper on the skin.",
            "There's no moisture left in the air in here.",
        ),
        SignalIs(HVAC.AIR_CONDITIONING, (False,)),
        Open("climate"),
        Tap("hvac.air_conditioning"),
        start=replace(
            PARIS,
            start="2026-07-21T14:15:00",
            weather=MILD,
            cabin={"humidity_pct": 20.0},
            signals={HVAC.AIR_CONDITIONING.path: True},
        ),
    ),
    hinted(
        "hvac_hay_fever",
        Module.HVAC,
        (
            "My hay fever is killing me.",
            "I can't stop sneezing, so much pollen.",
            "The birches are out and my nose is running.",
            "Achoo! The trees are in bloom, and I'm allergic.",
            "Blossom everywhere, my eyes itch like mad.",
        ),
        AllOf(
            (
                *(SignalIs(window, (0.0,)) for window in WINDOWS),
                AnyOf((SignalIs(HVAC.PURIFIER, (True,)), SignalIs(HVAC.RECIRCULATION, (True,)))),
            )
        ),
        *SHUT_WINDOWS,
        Open("climate"),
        Tap("hvac.purifier"),
        ways=(
            (*SHUT_WINDOWS, Open("climate"), Tap("hvac.recirculation")),
            (Open("climate"), Tap("hvac.purifier"), *SHUT_WINDOWS),
        ),
        start=replace(
            PARIS,
            start="2026-04-21T11:00:00",
            weather=SPRING,
            signals={window.path: 20.0 for window in WINDOWS},
        ),
        tags=frozenset({"two_modules"}),
    ),
    hinted(
        "hvac_stench_outside",
        Module.HVAC,
        (
            "That lorry stinks.",
            "Ugh, they're spreading manure out there.",
            "What a stench from that farm!",
            "Something foul is getting in.",
            "This diesel in front smells awful.",
        ),
        SignalIs(HVAC.RECIRCULATION, (True,)),
        Open("climate"),
        Tap("hvac.recirculation"),
    ),
    hinted(
        "hvac_sweaty_back",
        Module.HVAC,
        (
            "My shirt is sticking to the backrest.",
            "I'm drenched from the shoulders down.",
            "The leather glues itself to my thighs.",
            "Sweat is running down my spine.",
            "This seat makes me sweat, I'm wet where I lean.",
        ),
        AnyOf((SignalIs(SEAT.DRIVER_HEATING, (-50.0, -100.0)), SignalIs(HVAC.AIR_CONDITIONING, (True,)))),
        Open("climate"),
        Tap("hvac.driver_seat_airing"),
        ways=(
            (Open("climate"), Tap("hvac.driver_seat_airing", times=2)),
            (Open("climate"), Tap("hvac.air_conditioning")),
        ),
        start=Start("sydney", "richmond", start="2026-01-14T14:00:00", weather=HOT, cabin={"temperature_c": 32.0}),
        scenarios=("paris_centre", "tokyo", "new_york"),
    ),
    hinted(
        "hvac_no_ice_tomorrow",
        Module.HVAC,
        (
            "I'd rather not scrape ice when I leave at {time} tomorrow.",
            "Tomorrow I set off at {time}, and I hate a frosty wheel.",
            "At {time} I want to get into a car that's nice and warm.",
            "Early start, {time}, and it'll be below zero.",
            "Frost is forecast, and I have to go at {time}.",
        ),
        AppDataIs("climate.schedule", (param("time"), param("time", LEAVING))),
        *SCHEDULE,
        BY_THEN,
        Tap("climate.schedule"),
        ways=(
            (*SCHEDULE, replace(BY_THEN, text=param("time", LEAVING)), Tap("climate.schedule")),
            (*SCHEDULE, Tap("climate.schedule"), BY_THEN),
        ),
        deadline=ERRAND,
        scenarios=FROST_THERE,
        parameters={"time": tuple(LEAVING)},
    ),
)
