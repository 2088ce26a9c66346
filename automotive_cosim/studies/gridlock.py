"""Whether the traffic still flows; measurements in a gridlock say nothing about rerouting.

A gridlock is judged by the vehicles that stand still on the road. Vehicles that find no room to enter are no sign
of it: at a full edge of the network they wait for a gap while everyone else drives. They are counted and reported.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from automotive_cosim.studies.calls.accounts import HALTED_MPS, STUCK_S, TrafficSummary

MEASURED_EVERY_S = 300.0
"""Time between two measurements of the traffic as a whole."""

STUCK_SHARE = 0.05
TELEPORTED_SHARE = 0.01
"""Gridlock if more than these shares of the vehicles on the road wait, or of those departed were teleported."""

STANDING_SHARE = 0.5
STANDING = 2
"""Also a gridlock if more than this share stands still in this many measurements in a row."""

FEW = 40
"""Shares are taken of at least this many vehicles, as two or three at a red light are no gridlock."""


@dataclass(frozen=True, slots=True)
class Gridlock:
    """Why the traffic counts as gridlocked."""

    rule: str
    """The rule that detected it, in two or three words."""
    why: str
    """The figures behind it."""


def gridlock(summaries: Sequence[TrafficSummary]) -> Gridlock | None:
    """Why the traffic counts as gridlocked; None while it flows.

    Args:
        summaries: measurements of one simulation, in order, about ``MEASURED_EVERY_S`` apart."""
    if not summaries:
        return None
    last = summaries[-1]
    if last.stuck > STUCK_SHARE * max(FEW, last.running):
        why = f"{last.stuck} of {last.running} vehicles have been waiting for {STUCK_S:g} s or longer"
        return Gridlock("waiting for long", why)
    if last.teleported > TELEPORTED_SHARE * last.departed:
        return Gridlock("teleports", f"{last.teleported} teleports in {last.departed} departures")
    recent = summaries[-STANDING:]
    if len(recent) == STANDING and all(each.halted > STANDING_SHARE * max(FEW, each.running) for each in recent):
        told = ", then ".join(f"{each.halted} of {each.running}" for each in recent)
        return Gridlock("standing", f"{told} vehicles are slower than {HALTED_MPS:g} m/s")
    return None
