"""What requires attention: the same on the status bar's badge, in the notifications and on the home screen."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from automotive_cosim.cockpit.occupants import Kind, seated
from automotive_cosim.cockpit.signals import ADAS, CABIN, ENERGY, LIGHTS, MOTION, OUTSIDE, TYRE
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.telltales import Telltale
from automotive_cosim.contracts.text import listed, say

LOW_KPA = 200.0
"""A fifth below the 250 kPa on the door frame, where UN R64 requires a tyre warning."""
LOW_BATTERY_PCT = 15.0
NOTICED = 0.2
"""Share of a hazard, such as of fogged glass, from which every screen speaks of it."""
TYRES = (TYRE.FRONT_LEFT, TYRE.FRONT_RIGHT, TYRE.REAR_LEFT, TYRE.REAR_RIGHT)


ICE_C = 3.0
"""Temperature below which cars warn of ice: the road can be colder than the air."""


def lit(state: State) -> tuple[Telltale, ...]:
    """The tell-tales that are lit, the more urgent first."""
    signals = state.signals
    unbelted = any(not one.belted and one.kind is not Kind.OBJECT for one in seated(signals))
    soft = any(signals[signal] < LOW_KPA for signal in TYRES)
    empty = signals[ENERGY.LEVEL] <= LOW_BATTERY_PCT
    parked = signals[MOTION.GEAR] == "P"
    holds = {
        Telltale.WARNING: soft or empty or (signals[CABIN.TRUNK] and not parked),
        Telltale.BELT: unbelted and not parked,
        Telltale.DOOR: signals[CABIN.TRUNK],
        Telltale.BATTERY: empty,
        Telltale.HAZARD: signals[LIGHTS.HAZARD],
        Telltale.TYRE: soft,
        Telltale.STABILITY: not signals[ADAS.STABILITY_CONTROL],
        Telltale.FROST: signals[OUTSIDE.TEMPERATURE] <= ICE_C,
        Telltale.CABLE: signals[ENERGY.CABLE],
        Telltale.HIGH_BEAM: signals[LIGHTS.HIGH_BEAM],
        Telltale.LOW_BEAM: signals[LIGHTS.LOW_BEAM] and not signals[LIGHTS.HIGH_BEAM],
        Telltale.POSITION: signals[LIGHTS.POSITION] and not (signals[LIGHTS.LOW_BEAM] or signals[LIGHTS.HIGH_BEAM]),
        Telltale.FRONT_FOG: signals[LIGHTS.FRONT_FOG],
        Telltale.REAR_FOG: signals[LIGHTS.REAR_FOG],
    }
    return tuple(telltale for telltale in Telltale if holds[telltale])


NAMES: Mapping[Telltale, str] = {
    Telltale.WARNING: say("Warning"),
    Telltale.BELT: say("Seat belt"),
    Telltale.DOOR: say("Trunk"),
    Telltale.BATTERY: say("Battery"),
    Telltale.HAZARD: say("Hazards"),
    Telltale.TYRE: say("Tyre pressure"),
    Telltale.STABILITY: say("Stability control off"),
    Telltale.FROST: say("Frost"),
    Telltale.CABLE: say("Charging cable"),
    Telltale.HIGH_BEAM: say("High beam"),
    Telltale.LOW_BEAM: say("Low beam"),
    Telltale.POSITION: say("Position lamps"),
    Telltale.FRONT_FOG: say("Front fog"),
    Telltale.REAR_FOG: say("Rear fog"),
}


def lit_in_words(telltales: Iterable[Telltale]) -> str:
    """The tell-tales that are lit, for the list."""
    names = [NAMES[telltale] for telltale in telltales]
    return say("Dashboard lights: {lit}", lit=listed(names)) if names else say("Dashboard lights")
