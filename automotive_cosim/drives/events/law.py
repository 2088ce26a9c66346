"""What law and measurement say at one moment, as the kinds of events need it. Only verified rules oblige."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from automotive_cosim.contracts import KMH_PER_MPS
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.changes import before
from automotive_cosim.geo.applied import AppliedRule
from automotive_cosim.geo.binding import BindingLimit
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.rules import Status

SLOW_KMH = 20.0
"""Below this speed, intelligent speed assistance need not act (Regulation (EU) 2021/1958, annex I)."""
REACTION_S = 1.1
"""Mean time from a warning to the brake (lognormal in the road's model of the driver)."""
TREND_S = 10.0
"""Over how long a reading is compared with itself to tell whether it rises or falls."""
BRAKING_MPS2 = 3.4
"""Comfortable deceleration of most drivers (AASHTO Green Book, stopping sight distance)."""


def speed_kmh(moment: Moment) -> float:
    """The car's speed."""
    return moment.driving.speed_mps * KMH_PER_MPS


def limit_here(moment: Moment) -> BindingLimit | None:
    """The limit that binds, from a sign or a verified rule; None if there is none."""
    limit = moment.context.binding_limit
    return limit if limit is not None and limit.status is Status.VERIFIED else None


def is_reduced(context: GeoContext, limit: BindingLimit) -> bool:
    """Whether weather, light or hour lowered it."""
    return any(found.rule.id == limit.rule for found in context.reduced_limits)


def certain(context: GeoContext, topic: str) -> Iterator[AppliedRule]:
    """The verified rules on a topic that certainly apply here and now."""
    return (
        found
        for found in context.rules
        if found.rule.topic == topic and found.certain and found.rule.status is Status.VERIFIED
    )


def says(context: GeoContext, topic: str, word: str) -> bool:
    """Whether a verified rule on a topic certainly says ``required`` or ``forbidden``."""
    return any(found.value == word for found in certain(context, topic))


def may_say(context: GeoContext, topic: str, word: str) -> bool:
    """Whether any rule on a topic, verified or not, may say ``required`` or ``forbidden`` here."""
    rules = (found for found in context.rules if found.rule.topic == topic)
    return any(
        found.value == word if found.certain else any(case.value == word for case in found.rule.cases)
        for found in rules
    )


def grows(drive: Sequence[Moment], path: str, by: float) -> bool:
    """Whether a signal has grown at least by so much within the last seconds of a drive, or since it began; with a
    negative ``by``, whether it has fallen."""
    change = float(drive[-1].signals[path]) - float(before(drive, TREND_S).signals[path])
    return change >= by if by > 0 else change <= by


def time_left_s(distance_m: float, speed_mps: float, end_mps: float = 0.0) -> float:
    """Seconds until a driver who is warned then no longer gets down to a speed comfortably at that distance."""
    braking_m = max(0.0, speed_mps**2 - end_mps**2) / (2 * BRAKING_MPS2)
    return (distance_m - braking_m) / max(speed_mps, 0.1) - REACTION_S
