"""What requires attention: the same on the status bar's badge, in the notifications and on the home screen."""

from __future__ import annotations

from automotive_cosim.cockpit.signals import ENERGY, GLASS, TYRE
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon

LOW_KPA = 200.0
"""A fifth below the 250 kPa on the door frame, where UN R64 requires a tyre warning."""
LOW_BATTERY_PCT = 15.0
NOTICED = 0.2
"""Share of a hazard, such as of fogged glass, from which every screen speaks of it."""
TYRES = (TYRE.FRONT_LEFT, TYRE.FRONT_RIGHT, TYRE.REAR_LEFT, TYRE.REAR_RIGHT)


def wanting(state: State) -> tuple[tuple[str, Icon, str, str], ...]:
    """What requires attention: text, icon, and the screen where something can be done."""
    signals = state.signals
    low = [signal for signal in TYRES if signals[signal] < LOW_KPA]
    count = len(state.directory.unread(state.phone))
    return tuple(
        (text, icon, screen, item)
        for holds, text, icon, screen, item in (
            (count, f"{count} unread message{'s' if count != 1 else ''}", Icon.MESSAGE, "phone", "messages"),
            (bool(low), "Tyre pressure is low", Icon.TYRE, "driving", ""),
            (signals[ENERGY.LEVEL] <= LOW_BATTERY_PCT, "Battery is low", Icon.BATTERY, "charging", ""),
            (signals[GLASS.WINDSHIELD_FOG] >= NOTICED, "Windshield is fogged", Icon.DEFROST_FRONT, "climate", ""),
        )
        if holds
    )
