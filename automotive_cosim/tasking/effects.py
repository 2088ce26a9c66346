"""Checks of what a command does to the cabin, against doing nothing: a set point is no warmth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.cabin import FOG_OPAQUE, Air, Cabin, CabinStart
from automotive_cosim.cockpit.signals import GLASS, HVAC, OUTSIDE, Signals
from automotive_cosim.cockpit.vehicle import Vehicle
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.tasking.checks import goal

AHEAD_S = 60.0
"""How far ahead the cabin is forecast: a minute in which somebody who is cold would notice a difference."""
HEATING = frozenset(
    signal.path
    for signal in (
        HVAC.DRIVER_TEMPERATURE,
        HVAC.PASSENGER_TEMPERATURE,
        HVAC.FAN_SPEED,
        HVAC.AUTO,
        HVAC.AIR_CONDITIONING,
        HVAC.AIR_DISTRIBUTION,
        HVAC.RECIRCULATION,
        HVAC.FRONT_DEFROSTER,
        HVAC.REAR_DEFROSTER,
        HVAC.MAX_DEFROST,
    )
)
"""What may be commanded to warm or dry the air."""


@goal("the cabin {by_k:g} K warmer in a minute than with the settings of the start", writes=lambda *values: HEATING)
def cabin_warmer(hand_over: Moment, now: Moment, trace: Sequence[Moment], by_k: float) -> bool:
    """In a minute the air of the cabin is warmer by some kelvins than with the settings of the hand-over."""
    acted, idle = (_in_a_minute(settings.signals, now) for settings in (now, hand_over))
    return acted.temperature_c - idle.temperature_c >= by_k


@goal(
    lambda rear, by: f"the {'rear window' if rear else 'windshield'} clearing, by {by:.0%} within a minute",
    writes=lambda *values: HEATING,
)
def glass_clears(hand_over: Moment, now: Moment, trace: Sequence[Moment], rear: bool, by: float) -> bool:
    """In a minute the fog on the inside of a pane is less than with the settings of the hand-over, by a share.

    Args:
        rear: the rear window, not the windshield.
        by: share of the road that the fog hides no longer, 0 to 1."""
    acted, idle = (_in_a_minute(settings.signals, now) for settings in (now, hand_over))
    if rear:
        return idle.rear_window.fog_inside - acted.rear_window.fog_inside >= by
    return idle.windshield.fog_inside - acted.windshield.fog_inside >= by


EFFECTS = frozenset(("cabin_warmer", "glass_clears"))
"""Checks of an effect: whatever brings it about is right."""


def _in_a_minute(settings: Mapping[str, Any], now: Moment) -> Cabin:
    """The cabin after ``AHEAD_S`` from now with these settings."""
    signals = now.signals
    outside = Air(signals[OUTSIDE.TEMPERATURE.path], signals[OUTSIDE.HUMIDITY.path], 0.0, now.driving.speed_mps)
    start = CabinStart(
        temperature_c=signals[HVAC.CABIN_TEMPERATURE.path], humidity_pct=signals[HVAC.CABIN_HUMIDITY.path]
    )
    cabin = Cabin.at(start, outside)
    cabin = replace(
        cabin,
        windshield=replace(cabin.windshield, fog=signals[GLASS.WINDSHIELD_FOG.path] * FOG_OPAQUE),
        rear_window=replace(cabin.rear_window, fog=signals[GLASS.REAR_FOG.path] * FOG_OPAQUE),
    )
    return cabin.after(AHEAD_S, Vehicle(Signals(settings)).controls(now.weather.precipitation), outside)
