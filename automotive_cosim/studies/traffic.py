"""Whether the traffic still flows; measurements in a gridlock say nothing about rerouting."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from automotive_cosim.traffic.accounts import STUCK_S, Pulse

PULSE_S = 300.0
"""Time between two measurements of the traffic as a whole."""

STUCK_SHARE = 0.05
TELEPORTED_SHARE = 0.01
"""Gridlock if more than these shares of the vehicles on the road wait, or of the departed were teleported."""

GROWING = 3
BACKLOG_SHARE = 0.05
"""Gridlock too if the backlog grew over this many measurements and exceeds this share of those on the road."""


def gridlock(pulses: Sequence[Pulse]) -> str:
    """Why the traffic counts as gridlocked; empty while it flows.

    Args:
        pulses: measurements of one simulation, in order, about ``PULSE_S`` apart.
    """
    if not pulses:
        return ""
    last = pulses[-1]
    if last.stuck > STUCK_SHARE * last.running:
        return f"{last.stuck} of {last.running} vehicles have been waiting for {STUCK_S:g} s or longer"
    if last.teleported > TELEPORTED_SHARE * last.departed:
        return f"{last.teleported} teleports in {last.departed} departures"
    backlog = [pulse.backlog for pulse in pulses[-GROWING:]]
    grows = len(backlog) == GROWING and all(before < after for before, after in pairwise(backlog))
    if grows and backlog[-1] > BACKLOG_SHARE * last.running:
        return f"{backlog[-1]} vehicles find no room to enter, and their number keeps growing"
    return ""
