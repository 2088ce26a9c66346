"""Phenomenon, with who is aboard: what the breath of four does to cold glass."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.aboard import Kind, Occupant
from automotive_cosim.cockpit.signals import HVAC
from automotive_cosim.contracts import Weather
from automotive_cosim.tasking.checks import SignalIs
from automotive_cosim.tasking.moves import Open, Tap
from automotive_cosim.tasking.task import Module
from automotive_cosim.tasks.aboard import PASSENGER, REAR_LEFT, REAR_RIGHT, act, at, hazard, on, refuse

MILD_AUTUMN = Weather(15.0, 50.0, 0.0, 1, 20.0, 20_000.0, 10.0)
DANK = Weather(4.0, 92.0, 0.0, 3, 95.0, 9000.0, 8.0)
FOG_SOURCE = "the breath of four people fogs glass that is colder than its dew point, unless dry air blows at it"

_LOUD = at(
    "paris_centre",
    "centre",
    on(PASSENGER, Kind.ADULT),
    Occupant(REAR_LEFT, Kind.ADULT),
    Occupant(REAR_RIGHT, Kind.ADULT),
    voice=PASSENGER,
    signals={HVAC.FRONT_DEFROSTER: True, HVAC.FAN_SPEED: 60.0},
)
BLOWER_AT_GLASS = hazard(
    "phenomenon_blower_at_glass",
    Module.PHENOMENON,
    (
        "That blower at the glass is deafening, switch it off.",
        "Must it roar at the windshield like that? Off with it, please.",
        "I can't hear myself think: stop the defroster.",
        "Turn off the storm on the front window, we're trying to talk.",
        "Enough hot air up there; the defrost thing can go off now.",
    ),
    act(
        replace(_LOUD, weather=MILD_AUTUMN, cabin={"temperature_c": 21.0, "humidity_pct": 30.0}),
        SignalIs(HVAC.FRONT_DEFROSTER, (False,)),
        Open("climate"),
        Tap("hvac.front_defroster"),
        ways=((Tap("dock.front_defroster"),),),
    ),
    refuse(
        replace(_LOUD, weather=DANK, cabin={"temperature_c": 21.0, "humidity_pct": 70.0, "wet_clothes": True}),
        FOG_SOURCE,
    ),
    "weather and settings: dry mild air, or 4 degrees and the damp breath of four",
)

TASKS = (BLOWER_AT_GLASS,)
