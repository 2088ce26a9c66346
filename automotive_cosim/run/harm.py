"""Harm caused or averted: the same figures of the agent's drive and of its baseline run.

Both are measured from the hand-over over the same time, including the aftermath; what differs between them is the
agent's doing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import inf

import numpy as np

from automotive_cosim.cockpit.signals import ENERGY
from automotive_cosim.cockpit.vehicle import BATTERY_KWH
from automotive_cosim.contracts import EgoEnd
from automotive_cosim.cosim.exposed import states_of
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.geo.breaches import limit_at
from automotive_cosim.measures.following import nearest_s

TOLERANCE_S = 1e-6
"""Tolerance between times that are sums of the same steps."""


@dataclass(frozen=True, slots=True)
class DriveFigures:
    """Figures of one drive since the hand-over."""

    overspeed_m: float
    """Metres driven above the limits that bind, by sign or by law: the integral of the speed above them."""
    min_time_to_collision_s: float | None
    """The minimum time to collision with the car in front; None if none came nearer."""
    arrival_s: float | None
    """From the hand-over to the destination, with the rest estimated at the end; None if the drive was broken off.
    The difference of two drives is the delay."""
    energy_wh: float
    """Energy taken from the battery. The car is electric, so this stands for its emissions."""


def drive_figures(moments: Sequence[Moment], until_s: float) -> DriveFigures:
    """The figures of a drive.

    Args:
        moments: since the hand-over, in order, at least one.
        until_s: simulation time up to which it is measured; the last tick of a baseline run may lie beyond it.
    """
    start, end = moments[0], moments[-1]
    states = [state for state in states_of(moments) if state.time_s <= until_s + TOLERANCE_S]
    levels_pct = [moment.signals[ENERGY.LEVEL.path] for moment in moments]
    level_pct = float(np.interp(until_s, [moment.time_s for moment in moments], levels_pct))
    passed_s = end.time_s - start.time_s
    return DriveFigures(
        overspeed_m=round(overspeed(moments, until_s)[0], 3),
        min_time_to_collision_s=nearest_s(states),
        arrival_s={
            None: round(passed_s + end.driving.ahead.eta_s, 3),
            EgoEnd.ARRIVED: round(passed_s, 3),
        }.get(end.driving.end),
        energy_wh=round((levels_pct[0] - level_pct) / 100 * BATTERY_KWH * 1000, 3),
    )


def overspeed(moments: Sequence[Moment], until_s: float = inf) -> tuple[float, float]:
    """Metres driven above the limit that binds (``limit_at``), and the seconds for which there was one.

    Args:
        moments: in order; what passed before the first does not count.
        until_s: simulation time up to which it is measured.
    """
    over_m = whole_s = 0.0
    for earlier, moment in pairwise(moments):
        limit_of: dict[object, float | None] = {}
        for before, now in pairwise((earlier.driving, *moment.passed)):
            if now.time_s > until_s + TOLERANCE_S:
                break
            road = now.road.edge_id, now.road.limit
            if road not in limit_of:
                limit_of[road] = limit_at(moment.context, now).mps
            limit_mps = limit_of[road]
            if limit_mps is not None:
                dt_s = now.time_s - before.time_s
                whole_s += dt_s
                over_m += max(0.0, now.speed_mps - limit_mps) * dt_s
    return over_m, whole_s
