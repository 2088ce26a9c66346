"""Drives on, and calls back at every instant at which a decision is due."""

from __future__ import annotations

from collections.abc import Callable

from automotive_cosim.contracts import DrivingState
from automotive_cosim.studies.reroute.plan import StudyPlan
from automotive_cosim.traffic.base import Traffic

LOOK_S = 10.0
"""Time between two checks for a due decision, and between two samples of the traffic's speeds."""


def drive_on(
    traffic: Traffic,
    plan: StudyPlan,
    decide: Callable[[DrivingState], bool],
    most: int | None = None,
    advance: Callable[[float], object] | None = None,
) -> float:
    """Drives until the drive or its decisions are over.

    Args:
        traffic: the drive.
        plan: which delay makes a decision due, and how often.
        decide: called while one is due; true if there was something to decide, so the next is due later.
        most: the drive ends after this many decisions; None drives to the destination.
        advance: drives on by that many seconds; None uses the traffic's own.

    Returns:
        The greatest expected delay at any check.
    """
    advance = advance or traffic.advance
    begun_s = traffic.state.time_s
    due_s = begun_s + LOOK_S
    decided, most_delay_s = 0, 0.0
    advance(LOOK_S)
    while (now := traffic.state).end is None and now.time_s - begun_s < plan.limit_s:
        most_delay_s = max(most_delay_s, now.ahead.delay_s)
        is_due = now.time_s >= due_s - 1e-9 and now.ahead.delay_s >= plan.least_delay_s
        if is_due and not now.road.edge_id.startswith(":") and decide(now):
            due_s = now.time_s + plan.every_s
            decided += 1
            if decided == most:
                break
        advance(LOOK_S)
    return most_delay_s
