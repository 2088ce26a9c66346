"""Harm caused or averted: the same figures of the agent's drive and of the do-nothing twin's.

Both are watched from the hand-over over the same time, the aftermath included; what differs between them is what
the agent did.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from automotive_cosim.cockpit.signals import ENERGY
from automotive_cosim.cockpit.vehicle import BATTERY_KWH
from automotive_cosim.contracts import DrivingState, EgoEnd
from automotive_cosim.cosim.moment import Moment

TOLERANCE_S = 1e-6
"""Between times that are sums of the same steps."""


@dataclass(frozen=True, slots=True)
class DriveFigures:
    """One drive from the hand-over on."""

    overspeed_m: float
    """Metres driven beyond what the posted limits allow: the integral of the speed above them."""
    min_time_to_collision_s: float | None
    """The smallest to the car in front; None where none came nearer."""
    arrival_s: float | None
    """From the hand-over to the goal, what is left of it as estimated at the end; None where the drive was broken
    off. Of two drives the difference is the delay."""
    energy_wh: float
    """Taken from the battery. The car is electric, so that this stands for what it emits."""


def drive_figures(moments: Sequence[Moment], until_s: float) -> DriveFigures:
    """The figures of a drive.

    Args:
        moments: from the hand-over on, in order, at least one.
        until_s: simulation time up to which it is watched; the twin's last tick may lie beyond it.
    """
    start, end = moments[0], moments[-1]
    states = [start.driving, *(state for moment in moments[1:] for state in moment.passed)]
    states = [state for state in states if state.time_s <= until_s + TOLERANCE_S]
    levels_pct = [moment.signals[ENERGY.LEVEL.path] for moment in moments]
    level_pct = float(np.interp(until_s, [moment.time_s for moment in moments], levels_pct))
    passed_s = end.time_s - start.time_s
    return DriveFigures(
        overspeed_m=round(overspeed(states)[0], 3),
        min_time_to_collision_s=nearest_s(states),
        arrival_s={
            None: round(passed_s + end.driving.ahead.eta_s, 3),
            EgoEnd.ARRIVED: round(passed_s, 3),
        }.get(end.driving.end),
        energy_wh=round((levels_pct[0] - level_pct) / 100 * BATTERY_KWH * 1000, 3),
    )


def overspeed(states: Iterable[DrivingState]) -> tuple[float, float]:
    """Metres driven above the limit, and the seconds for which a limit was posted.

    Args:
        states: in order.
    """
    over_m = whole_s = 0.0
    for before, now in pairwise(states):
        if now.road.posted_limit_mps is not None:
            dt_s = now.time_s - before.time_s
            whole_s += dt_s
            over_m += max(0.0, now.speed_mps - now.road.posted_limit_mps) * dt_s
    return over_m, whole_s


def nearest_s(states: Iterable[DrivingState]) -> float | None:
    """The smallest time to collision with the car in front; None without one that came nearer."""
    times = [state.around.leader.time_to_collision_s for state in states if state.around.leader is not None]
    return min((round(time_s, 3) for time_s in times if time_s is not None), default=None)
