"""What people aboard do with their hands after a warning: the driver wipes wet glass, puts the phone away, and
everybody buckles up."""

from __future__ import annotations

from collections.abc import Iterator

from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.notices import NOTICED
from automotive_cosim.cockpit.occupants import SIGNALS, seated
from automotive_cosim.cockpit.signals import BODY, CALL, GLASS, HVAC, LIGHTS, Signals
from automotive_cosim.traffic.ego import BUCKLES, CLEARS_VIEW, WAKES_UP

SEEN = NOTICED / 4
"""Share of the glass that is wet or fogged from which a driver who is told of it does something about it."""


def handled(reaction: str, signals: Signals) -> Iterator[CarChange]:
    """What is turned, opened or shut now.

    Args:
        reaction: kind of the driver's reaction on the road (``traffic.base.Event``).
        signals: the car as it is.
    """
    if reaction == WAKES_UP and signals[CALL.PHONE] == "HAND":
        yield CarChange(0.0, CALL.PHONE.path, "AWAY")
    elif reaction == CLEARS_VIEW:
        if signals[BODY.FRONT_WIPER] == "OFF" and signals[GLASS.WINDSHIELD_FILM] >= SEEN:
            yield CarChange(0.0, BODY.FRONT_WIPER.path, "RAIN_SENSOR")
        if signals[GLASS.WINDSHIELD_FOG] >= SEEN:
            yield CarChange(0.0, HVAC.FRONT_DEFROSTER.path, True)
        if signals[LIGHTS.SWITCH] == "OFF":
            yield CarChange(0.0, LIGHTS.SWITCH.path, "AUTO")
    elif reaction == BUCKLES:
        for one in seated(signals):
            if not one.belted:
                yield CarChange(0.0, SIGNALS[one.seat].belted.path, True)
