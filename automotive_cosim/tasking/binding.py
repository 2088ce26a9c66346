"""Binds a half to the sign or the law of a place that is not its own, or says what is missing there.

A task is written for one scenario. In any other network, what is right rests on what is in force there: a sign that
is posted there, or a verified rule of that place on the same topic with the same answer. A limit that the map only
assumes is no sign, and the article of another country no law.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from automotive_cosim.contracts import KMH_PER_MPS, LimitSource, Road
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.geo.applied import AppliedRule
from automotive_cosim.geo.context import GeoContext, answer
from automotive_cosim.geo.place import Atlas, shipped
from automotive_cosim.geo.rules import TOPICS, Rule, Status, Value
from automotive_cosim.geo.text import KM_PER_MILE, amount_of_speed
from automotive_cosim.tasking.task import Basis, Half
from automotive_cosim.tasking.triggers import All, Not, Situation, TriggerCondition

ABOUT_SIGNS = frozenset(("speed_above", "lower_limit_within", "in_school_zone"))
"""Conditions on a posted limit."""


POSTED_LIMIT = "a posted limit"
"""The need of a half that is about a sign."""


class UnmetNeedError(Exception):
    """A place lacks what a half needs; the text says what."""


def needs(half: Half) -> tuple[str, ...]:
    """What a place must have for the half to be judged there, in words."""
    if half.basis is Basis.LAW:
        return tuple(
            f"a verified rule on the {TOPICS[rule.topic].lower()} (compare {rule.id})" for rule in rules_of(half)
        )
    if _about_signs(half):
        return (POSTED_LIMIT,)
    if half.basis is Basis.POSTED and half.start.origin is not None:
        return (f"signs in {_unit_at_home(half)}",)
    return ()


def bound(half: Half, context: GeoContext) -> str:
    """The sign or the rule on which the half rests at another place, for its verdict.

    Raises UnmetNeedError: the place has none."""
    if half.basis is Basis.LAW:
        return ", ".join(_law_here(rule, context) for rule in rules_of(half))
    if _about_signs(half):
        return _sign_here(context)
    if half.basis is Basis.POSTED and half.start.origin is not None and context.speed_unit != _unit_at_home(half):
        raise UnmetNeedError(f"signs are in {context.speed_unit} there, not in {_unit_at_home(half)}")
    return half.rule


def _about_signs(half: Half) -> bool:
    return half.basis is Basis.POSTED and any(
        isinstance(condition, Situation) and condition.name in ABOUT_SIGNS
        for condition in _parts(half.trigger.condition)
    )


def _parts(condition: TriggerCondition) -> Iterator[TriggerCondition]:
    match condition:
        case All(conditions):
            for each in conditions:
                yield from _parts(each)
        case Not(inner):
            yield from _parts(inner)
        case _:
            yield condition


def never_here(half: Half, roads: Sequence[Road]) -> str:
    """The condition of the trigger that no road of a network meets, without incidents and limits by the clock, so
    that the half comes about nowhere in it; empty if there is none, or only driving can tell."""
    together = [half.trigger.condition]
    while together:
        condition = together.pop()
        if isinstance(condition, All):
            together += condition.conditions
        elif not any(_may_hold(condition, road) for road in roads):
            return str(condition)
    return ""


def _may_hold(condition: TriggerCondition, road: Road) -> bool:
    limit_mps = road.limit_mps if road.limit_source is LimitSource.POSTED else None
    match condition:
        case Situation("in_tunnel" | "tunnel_within" | "tunnel_on_route"):
            return road.in_tunnel
        case Situation("on_road_class", (classes,)):
            return bool(road.road_class in classes)
        case Situation("on_street", (name,)):
            return bool(road.name == name)
        case Situation("lanes", (count,)):
            return bool(road.lane_count >= count)
        case Situation("in_school_zone"):
            return road.school_zone
        case Situation("speed_above", (_, from_kmh, to_kmh)):
            return limit_mps is not None and from_kmh <= round(limit_mps * KMH_PER_MPS, 1) <= to_kmh
        case _:
            return True


def _sign_here(context: GeoContext) -> str:
    road = context.road
    if road.limit.posted_mps is None:
        raise UnmetNeedError("no limit is posted there, the map only assumes one")
    amount = amount_of_speed(road.limit.posted_mps * KMH_PER_MPS, context.speed_unit)
    where = f" on {road.name}" if road.name else ""
    return f"sign, {amount}{where}" + (f"; {context.country}" if context.country else "")


def _unit_at_home(half: Half) -> str:
    assert half.start.origin is not None
    law = shipped().place(*half.start.origin).law
    return law.speed_unit if law else "km/h"


def rules_of(half: Half) -> tuple[Rule, ...]:
    """The rules of law that a half names. Raises UnknownNameError: there is no such rule."""
    return tuple(_rule(rule_id.strip(), shipped()) for rule_id in half.rule.split(","))


def _rule(rule_id: str, atlas: Atlas) -> Rule:
    known = {rule.id: rule for entry in atlas.country(rule_id[:2]) for rule in entry.rules}
    if rule_id not in known:
        raise UnknownNameError("rule of law", rule_id, known, "automotive-cosim show context")
    return known[rule_id]


def _law_here(rule: Rule, context: GeoContext) -> str:
    """The verified rule in force here on the same topic with the same answer."""
    wanted = answer(rule, context)
    topic = TOPICS[rule.topic].lower()
    found = (
        list(_limits(context)) if rule.topic == "limit" else [here for here in [context.rule(rule.topic)] if here]
    )
    where = f"the law of {context.place.country_name}" if context.place.country_name else "no law known there"
    if not found:
        raise UnmetNeedError(f"{where} says nothing certain on this: {topic}")
    here = min(found, key=_kmh) if rule.topic == "limit" else found[0]
    if here.rule.id != rule.id and (wanted is None or not _same(here, wanted, rule.unit)):
        raise UnmetNeedError(f"{where} answers differently than {rule.id}: {topic} ({here.rule.id})")
    if here.rule.status is not Status.VERIFIED:
        raise UnmetNeedError(f"{here.rule.id} is not verified but {here.rule.status}; no verdict may rest on it")
    return f"{here.rule.id} ({here.rule.status} {here.rule.as_of})"


def _limits(context: GeoContext) -> Iterator[AppliedRule]:
    """The limits in force now, of the law."""
    if context.default_limit is not None:
        yield context.default_limit
    yield from (found for found in context.reduced_limits if found.certain and found.value is not None)


def _same(here: AppliedRule, wanted: Value, unit: str) -> bool:
    if isinstance(wanted, str) or isinstance(here.value, str):
        return here.value == wanted
    return abs(_kmh(here) - wanted * (KM_PER_MILE if unit == "mph" else 1.0)) < 0.5


def _kmh(found: AppliedRule) -> float:
    if found.value is None or isinstance(found.value, str):
        return float("inf")
    return found.value * (KM_PER_MILE if found.rule.unit == "mph" else 1.0)
