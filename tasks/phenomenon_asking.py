"""Phenomenon, wishes that do not say enough: which wiper, lamp or mirror, what lies ahead, what helps."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.signals import BODY, DRIVE, HVAC, LIGHTS, MIRROR
from automotive_cosim.tasking.checks import SignalIs
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.moves import Open, Tap
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Dimension, Module
from automotive_cosim.tasks.forms import (
    ELSEWHERE,
    FRIENDS,
    ON_THE_WAY,
    PARIS,
    only,
    read_out,
    unclear,
    wrote,
)
from automotive_cosim.tasks.phenomenon import DRIVING_TAB, MIRRORS_TAB, VEHICLE

WIPERS = {"front": BODY.FRONT_WIPER, "rear": BODY.REAR_WIPER}
FOG_LAMPS = {"front": LIGHTS.FRONT_FOG, "rear": LIGHTS.REAR_FOG}
HEATED_MIRRORS = {"driver": MIRROR.DRIVER_HEATING, "passenger": MIRROR.PASSENGER_HEATING}
BEAM = {LIGHTS.SWITCH.path: "BEAM"}
MODES = {"rain": "RAIN", "snow": "SNOW"}
REMEDIES = {"recirculation": HVAC.RECIRCULATION, "purifier": HVAC.PURIFIER}

TASKS = (
    unclear(
        "phenomenon_ask_which_wiper",
        Module.PHENOMENON,
        (
            "One wiper squeaks, stop it.",
            "Wiper off, that glass is dry.",
            "It only rubs now. Turn that wiper off.",
            "That's enough of that wiper.",
            "One of the wipers can rest now.",
        ),
        Topic(
            "which wiper",
            (("front", "windshield", "windscreen"), ("rear", "back")),
            param("which", {"front": "The one in front.", "rear": "The rear one."}),
            ("wiper", "which one"),
        ),
        "Which wiper, the front or the rear one?",
        SignalIs(param("which", WIPERS), ("OFF",)),
        VEHICLE,
        Tap("wiper.{which}.off"),
        untold=replace(PARIS, signals={wiper.path: param("pace") for wiper in WIPERS.values()}),
        told=replace(PARIS, signals=only(WIPERS, "SLOW", "OFF")),
        look=(VEHICLE,),
        difference="settings: front and rear wiper are on, or only one of them",
        parameters={"which": tuple(WIPERS), "pace": ("SLOW", "INTERVAL")},
        trigger=ON_THE_WAY,
    ),
    unclear(
        "phenomenon_ask_which_fog_lamp",
        Module.PHENOMENON,
        (
            "Just the one fog lamp off.",
            "It's clearing up, so switch the fog light off, just that one.",
            "Put that fog lamp out, please.",
            "I forgot one fog light. Off with that.",
            "One of the fog lamps isn't needed any more.",
        ),
        Topic(
            "which fog lamp",
            (("front",), ("rear", "back")),
            param("which", {"front": "The front ones.", "rear": "The rear one."}),
            ("fog", "lamp", "light", "which one"),
        ),
        "Which fog lamp, front or rear?",
        SignalIs(param("which", FOG_LAMPS), (False,)),
        VEHICLE,
        Tap("lights.{which}_fog"),
        untold=replace(PARIS, signals={**BEAM, **{lamp.path: True for lamp in FOG_LAMPS.values()}}),
        told=replace(PARIS, signals={**BEAM, **only(FOG_LAMPS, True, False)}),
        look=(VEHICLE,),
        difference="settings: front and rear fog lamps are lit, or only one of them",
        parameters={"which": tuple(FOG_LAMPS)},
        trigger=ON_THE_WAY,
        scenarios=ELSEWHERE,
    ),
    unclear(
        "phenomenon_ask_which_mirror",
        Module.PHENOMENON,
        (
            "Heating off in just one of the mirrors.",
            "One mirror's clear, stop heating that one.",
            "One of the mirrors needn't be heated any longer.",
            "Off with the heating of that outside mirror.",
            "One mirror is dry by now, so that one can cool off.",
        ),
        Topic(
            "which mirror",
            (("driver", "driver's", "my", "your"), ("passenger", "passenger's")),
            param("which", {"driver": "The one on my side, the driver's.", "passenger": "The passenger's."}),
            ("mirror", "which", "side"),
        ),
        "Which mirror, the driver's or the passenger's?",
        SignalIs(param("which", HEATED_MIRRORS), (False,)),
        VEHICLE,
        MIRRORS_TAB,
        Tap("mirror.{which}.heat"),
        untold=replace(PARIS, signals={heating.path: True for heating in HEATED_MIRRORS.values()}),
        told=replace(PARIS, signals=only(HEATED_MIRRORS, True, False)),
        look=(VEHICLE, MIRRORS_TAB),
        difference="settings: both outside mirrors are heated, or only one of them",
        parameters={"which": tuple(HEATED_MIRRORS)},
        trigger=ON_THE_WAY,
        scenarios=ELSEWHERE,
        dimension=Dimension.IMPLICIT_INTENT,
    ),
    unclear(
        "phenomenon_ask_what_lies_ahead",
        Module.PHENOMENON,
        (
            "{who} has just crossed the pass. Choose the drive mode for what's up there, rain or snow.",
            "Rain mode or snow mode, whatever {who} found on the pass.",
            "Get the car ready for the pass: snow or rain, {who} comes from there.",
            "The mode for the weather that {who} has seen, rain or snow.",
            "Put the drive mode right for up there, snow or rain; {who} meant to write which.",
        ),
        Topic(
            "what the pass is like",
            (("rain", "raining"), ("snow", "snowing")),
            param("which", {"rain": "Rain, I'm told.", "snow": "Snow, I'm told."}),
            ("pass", "{who}", "weather", "mode"),
        ),
        "What is it like on the pass, rain or snow?",
        SignalIs(DRIVE.MODE, (param("which", MODES),)),
        VEHICLE,
        DRIVING_TAB,
        Tap("drive.mode.{which}"),
        untold=wrote(PARIS, ("{who}", "We've crossed the pass. Awful weather up there!")),
        told=wrote(PARIS, ("{who}", "We've crossed the pass. Awful weather, nothing but {which}!")),
        look=read_out("{who}"),
        difference="content: the friend writes of awful weather, or also of which kind",
        parameters={"which": tuple(MODES), "who": FRIENDS},
        dimension=Dimension.IMPLICIT_INTENT,
    ),
    unclear(
        "phenomenon_ask_what_helps",
        Module.PHENOMENON,
        (
            "Do what {who} advises against this smell: recirculation or the purifier.",
            "Against the stink, switch on what helped {who}, the purifier or recirculation.",
            "{who} had this too and knows what cures it, purifier or recirculation.",
            "Recirculation or purifier, whichever {who} swears by.",
            "It smells. Turn on what helped {who}, the purifier or recirculation.",
        ),
        Topic(
            "what helps",
            (("recirculation", "recirculate"), ("purifier",)),
            param("which", {"recirculation": "Recirculation.", "purifier": "The purifier."}),
            ("smell", "{who}", "helps"),
        ),
        "What helped {who}, recirculation or the purifier?",
        SignalIs(param("which", REMEDIES), (True,)),
        Open("climate"),
        Tap("hvac.{which}"),
        untold=wrote(PARIS, ("{who}", "We had that smell too, but we got rid of it.")),
        told=wrote(PARIS, ("{who}", "We had that smell too, but the {which} got rid of it.")),
        look=read_out("{who}"),
        difference="content: the friend knows the smell, or also says what helps",
        parameters={"which": tuple(REMEDIES), "who": FRIENDS},
    ),
)
