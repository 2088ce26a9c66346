"""The timeline of an episode, in seconds since the hand-over, and roads and speeds in words."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from automotive_cosim.cockpit.actions import action_in_words
from automotive_cosim.contracts import KMH_PER_MPS, ActionType, Limit, RoadHere
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.geo.breaches import limit_at
from automotive_cosim.geo.text import amount_of_speed
from automotive_cosim.interface.trace import Step

ROUNDING_KMH = 1.0
"""A speedometer's last digit: a speed this much above the limit counts as at the limit."""

NAMELESS = {
    "motorway": "a motorway",
    "residential": "a residential street",
    "track": "a track",
    "unclassified": "a minor road",
    **{f"{road}_link": "a slip road" for road in ("motorway", "trunk", "primary", "secondary", "tertiary")},
}
"""Names of unnamed roads, by class, where OpenStreetMap's word for the class is not what people say."""


def road_in_words(road: RoadHere) -> str:
    """A road by its name, else by its class."""
    if road.name or not road.road_class:
        return road.name or "an unnamed road"
    if road.road_class in NAMELESS:
        return NAMELESS[road.road_class]
    words = road.road_class.replace("_", " ")
    return f"{'an' if words[0] in 'aeiou' else 'a'} {words}" + ("" if words.endswith("street") else " road")


def speed_in_words(speed_mps: float, limit: Limit, unit: str) -> str:
    """A speed and the limit in the unit of the place: ``"48 km/h, 50 posted"``, ``"30 mph, no limit known"``."""
    return f"{amount_of_speed(speed_mps * KMH_PER_MPS, unit)}, {limit_in_words(limit, unit)}"


def limit_in_words(limit: Limit, unit: str) -> str:
    """A limit with its source, in the unit of the place but without it."""
    if limit.kmh is None:
        return "no limit" if limit.is_posted else "no limit known"
    amount = amount_of_speed(limit.kmh, unit).partition(" ")[0]
    return f"{amount} posted" if limit.is_posted else f"{amount} by law"


def limit_kmh(limit: Limit) -> float | None:
    """A limit in km/h, to a tenth; None if there is none."""
    return None if limit.kmh is None else round(limit.kmh, 1)


def is_over(speed_kmh: float, limit_kmh: float | None) -> bool:
    """Above the limit by more than a speedometer's last digit."""
    return limit_kmh is not None and speed_kmh > limit_kmh + ROUNDING_KMH


QUIET = frozenset({ActionType.WAIT, ActionType.STATUS})


@dataclass(frozen=True, slots=True)
class TimelineEntry:
    """One event of an episode."""

    at_s: float
    """Seconds since the hand-over; negative before it."""
    kind: str
    """One of departure, hand_over, action, said, alert, road, limit, goal, declared, end."""
    text: str


@dataclass(frozen=True, slots=True)
class Sample:
    """The drive at one instant."""

    at_s: float
    speed_kmh: float
    limit_kmh: float | None
    """The limit that binds, by sign or by law."""
    road: str
    x_m: float
    y_m: float
    heading_deg: float
    speed_unit: str = "km/h"
    """The unit of the place's signs, ``"km/h"`` or ``"mph"``."""


def samples(moments: Iterable[Moment], hand_over_s: float) -> tuple[Sample, ...]:
    """The drive in compact rows, one per moment, rounded to what a plot shows."""
    return tuple(
        Sample(
            at_s=round(moment.time_s - hand_over_s, 2),
            speed_kmh=round(moment.driving.speed_mps * KMH_PER_MPS, 2),
            limit_kmh=limit_kmh(limit_at(moment.context)),
            road=moment.driving.road.name,
            x_m=round(moment.driving.x_m, 2),
            y_m=round(moment.driving.y_m, 2),
            heading_deg=round(moment.driving.heading_deg, 1),
            speed_unit=moment.context.speed_unit,
        )
        for moment in moments
    )


def timeline(moments: Sequence[Moment], steps: Sequence[Step], goal_s: float | None) -> tuple[TimelineEntry, ...]:
    """The events of an episode in order.

    Args:
        moments: from departure to the end of the aftermath.
        steps: from the hand-over to the end.
        goal_s: seconds from the hand-over until the goal held for the rest of the episode."""
    zero_s = steps[0].moment.time_s
    entries = [
        _entry(moments[0], zero_s, "departure", "departs on"),
        _entry(steps[0].moment, zero_s, "hand_over", "hand-over to the agent on"),
        *_heard(steps[0], zero_s),
        *_goal(goal_s),
        *_actions(steps, zero_s),
        *_roadside(moments, zero_s),
        *_back_at_limit(moments, zero_s),
    ]
    return tuple(sorted(entries, key=lambda entry: entry.at_s))


def _entry(moment: Moment, zero_s: float, kind: str, text: str) -> TimelineEntry:
    driving = moment.driving
    speed = speed_in_words(driving.speed_mps, limit_at(moment.context), moment.context.speed_unit)
    return TimelineEntry(round(moment.time_s - zero_s, 2), kind, f"{text} {road_in_words(driving.road)}: {speed}")


def _goal(goal_s: float | None) -> Iterable[TimelineEntry]:
    if goal_s:
        yield TimelineEntry(round(goal_s, 2), "goal", "goal reached and kept to the end")


def _actions(steps: Sequence[Step], zero_s: float) -> Iterable[TimelineEntry]:
    """The agent's actions, each at the instant of the observation that it answers."""
    for before, step in pairwise(steps):
        at_s = round(before.moment.time_s - zero_s, 2)
        given = step.moment.commands["alerts"][len(before.moment.commands["alerts"]) :]
        action = step.action
        words = action_in_words(action, before.elements)
        if action is None or action.action_type not in QUIET:
            yield TimelineEntry(at_s, "action", words)
        for text in step.said:
            yield TimelineEntry(round(step.moment.time_s - zero_s, 2), "said", f"the driver says “{text}”")
        yield from _heard(step, zero_s)
        for alert in given:
            yield TimelineEntry(at_s, "alert", f"alert to the driver: {alert['kind']} ({alert['severity']})")
        if action is not None and action.action_type is ActionType.STATUS:
            yield TimelineEntry(at_s, "declared", words)


def _heard(step: Step, zero_s: float) -> Iterable[TimelineEntry]:
    """What reached the agent of what was said, if it hears."""
    for text in step.heard or ():
        words = f"the agent hears “{text}” in {step.cabin_db:.0f} dB(A)"
        yield TimelineEntry(round(step.moment.time_s - zero_s, 2), "said", words)


def _roadside(moments: Sequence[Moment], zero_s: float) -> Iterable[TimelineEntry]:
    for moment in moments:
        for event in moment.events:
            yield TimelineEntry(round(event.time_s - zero_s, 2), "road", event.text)
        if moment.driving.end is not None:
            yield TimelineEntry(round(moment.time_s - zero_s, 2), "end", f"the drive ends: {moment.driving.end}")


def _back_at_limit(moments: Sequence[Moment], zero_s: float) -> Iterable[TimelineEntry]:
    """The first time after the hand-over at which a speed above the limit has fallen to it."""
    passed = [(moment, state) for moment in moments for state in moment.passed if state.time_s >= zero_s]
    for (_, before), (moment, now) in pairwise(passed):
        if now.speed_mps >= before.speed_mps:
            continue
        limit_mps = limit_at(moment.context, now).mps
        if limit_mps is None:
            continue
        at_most_mps = limit_mps + ROUNDING_KMH / KMH_PER_MPS
        if before.speed_mps > at_most_mps >= now.speed_mps:
            speed = amount_of_speed(now.speed_mps * KMH_PER_MPS, moment.context.speed_unit)
            yield TimelineEntry(round(now.time_s - zero_s, 2), "limit", f"back at the limit: {speed}")
            return
