"""Checks of what happened in between: an order, a length of time, a time of day, a wait, what held meanwhile."""

from __future__ import annotations

from collections.abc import Sequence

from automotive_cosim.cosim.moment import Moment
from automotive_cosim.tasking.checks import Check, goal


@goal("{then}, after {first}", writes=lambda first, then: first.writes | then.writes)
def after(hand_over: Moment, now: Moment, trace: Sequence[Moment], first: Check, then: Check) -> bool:
    """One thing came true no earlier than another had, and still is."""
    if not then.holds(hand_over, now, trace):
        return False
    for at, moment in enumerate(trace):
        until = trace[: at + 1]
        if first.holds(hand_over, moment, until):
            return True
        if then.holds(hand_over, moment, until):
            return False
    return False


@goal("for {from_s:g} to {to_s:g} s and no longer: {check}", writes=lambda check, from_s, to_s: check.writes)
def lasted(
    hand_over: Moment, now: Moment, trace: Sequence[Moment], check: Check, from_s: float, to_s: float
) -> bool:
    """Something held without a break for a time within two bounds, and no longer does."""
    longest_s, since_s = 0.0, None
    for at, moment in enumerate(trace):
        if not check.holds(hand_over, moment, trace[: at + 1]):
            since_s = None
            continue
        since_s = moment.time_s if since_s is None else since_s
        longest_s = max(longest_s, moment.time_s - since_s)
    return since_s is None and from_s <= longest_s <= to_s


@goal("not before {clock}: {check}", writes=lambda check, clock: check.writes)
def not_before(hand_over: Moment, now: Moment, trace: Sequence[Moment], check: Check, clock: str) -> bool:
    """Something holds, and did at no moment before a time of day.

    Args:
        clock: local hours and minutes, as ``22:00``, of the same day."""
    return check.holds(hand_over, now, trace) and not any(
        check.holds(hand_over, moment, trace[: at + 1])
        for at, moment in enumerate(trace)
        if f"{moment.local_time:%H:%M}" < clock
    )


@goal("watched for {seconds:g} s", writes=lambda seconds: frozenset())
def watched(hand_over: Moment, now: Moment, trace: Sequence[Moment], seconds: float) -> bool:
    """So much time has passed since the hand-over: who was asked to watch has not ended it before."""
    return now.time_s - hand_over.time_s >= seconds - 1e-9


@goal(
    "{check}, while {condition} ({for_s:g} s or more)",
    writes=lambda condition, check, for_s: condition.writes | check.writes,
)
def while_(
    hand_over: Moment, now: Moment, trace: Sequence[Moment], condition: Check, check: Check, for_s: float
) -> bool:
    """As long as one thing held, another did; the one held for some time.

    Args:
        for_s: least time for which the condition must have held in all."""
    held_s, before_s = 0.0, trace[0].time_s
    for at, moment in enumerate(trace):
        until = trace[: at + 1]
        if condition.holds(hand_over, moment, until):
            if not check.holds(hand_over, moment, until):
                return False
            held_s += moment.time_s - before_s
        before_s = moment.time_s
    return held_s >= for_s
