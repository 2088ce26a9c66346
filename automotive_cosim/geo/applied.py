"""Which rules of a place apply to a road at one instant, and their answers."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from dataclasses import dataclass, field, replace
from datetime import datetime

from automotive_cosim.contracts import KMH_PER_MPS, STANDING_BELOW_MPS, DrivingState, GpsFix, RoadHere, Weather
from automotive_cosim.geo.place import Place
from automotive_cosim.geo.rulefacts import CONDITIONS, RuleFacts, Test
from automotive_cosim.geo.rules import TOPICS, Jurisdiction, Rule, Value
from automotive_cosim.geo.sun import Sun
from automotive_cosim.geo.text import Line
from automotive_cosim.geo.weather import phenomena

MOTORWAYS = ("motorway", "motorway_link")
STREETS = ("residential", "living_street", "pedestrian")
"""OSM highway values that imply built-up land if the network does not say."""

MAYBE_DUAL = ("trunk", "trunk_link", "primary", "secondary")
"""Roads that may have a central reservation if they have two lanes or more in one direction."""

OWN_LAW = frozenset(("living_street", "pedestrian", "cycle_street"))
"""Road classes with a limit of their own in most laws. A rule about built-up areas in general says nothing certain
about them: only one that names the class does."""

MAYBE_EXPRESSWAY = ("trunk", "trunk_link", "")
"""Roads that may be closed to slow traffic; the network does not say which."""


@dataclass(frozen=True, slots=True)
class AppliedRule:
    """A rule that place, road and date do not exclude here."""

    rule: Rule
    jurisdiction: str
    """Code of the country, region or city that the rule belongs to."""
    value: Value | None
    """Its answer now; None if it does not apply now."""
    certain: bool
    """False if the facts do not determine the answer."""


def built_up(road: RoadHere, place: Place) -> tuple[bool | None, str]:
    """Whether the road is in a built-up area, None if unknown, and the source of that (``GeoContext``)."""
    if road.built_up is not None:
        return road.built_up, "network"
    if road.road_class in MOTORWAYS:
        return False, "road class"
    if road.road_class in STREETS:
        return True, "road class"
    return (True, "place") if place.city else (None, "unknown")


def _dual_carriageway(road: RoadHere) -> bool | None:
    if road.road_class in MOTORWAYS:
        return True
    if road.lane_count >= 2 and (road.road_class in MAYBE_DUAL or not road.road_class):
        return None
    return False


def facts_at(
    driving: DrivingState,
    gps: GpsFix | None,
    weather: Weather | None,
    local_time: datetime,
    sun: Sun | None,
    is_built_up: bool | None,
) -> RuleFacts:
    """The input of rules: everything known about an instant."""
    road, around = driving.road, driving.around
    return RuleFacts(
        local_time=local_time,
        lon_deg=gps.lon_deg if gps else None,
        lat_deg=gps.lat_deg if gps else None,
        street=road.name,
        road_class=road.road_class,
        motorway=road.road_class in MOTORWAYS if road.road_class else None,
        dual_carriageway=_dual_carriageway(road),
        expressway=None if road.road_class in MAYBE_EXPRESSWAY else False,
        built_up=is_built_up,
        lit=road.lit,
        centre_line=road.centre_line,
        lanes=road.lane_count,
        tunnel=road.in_tunnel,
        speed_kmh=driving.speed_mps * KMH_PER_MPS,
        standing=driving.speed_mps < STANDING_BELOW_MPS,
        oncoming_m=around.oncoming.gap_m if around.oncoming else None,
        leader_m=around.leader.gap_m if around.leader else None,
        phenomena=phenomena(weather) if weather else None,
        visibility_m=weather.visibility if weather else None,
        after_sunset=sun.is_set if sun else None,
        trailer=driving.trailer is True,
    )


@dataclass(frozen=True, slots=True, eq=False)
class RulesHere:
    """What rules say here and now."""

    fixed_limits: tuple[AppliedRule, ...]
    reduced_limits: tuple[AppliedRule, ...]
    """Those under conditions of weather, light or hour."""
    others: tuple[AppliedRule, ...]
    """Those of other topics."""
    lines: tuple[Line, ...]
    """The others as an agent is told of them."""
    topics: tuple[str, ...]
    """Of the others that are told of unasked."""
    _shown: dict[tuple[bool, ...], tuple[Line, ...]] = field(default_factory=dict)

    def shown(self, matter: tuple[bool, ...]) -> tuple[Line, ...]:
        """The lines of the topics that matter, and one that names the others; those on request are not shown.

        Args:
            matter: for each of ``topics``.
        """
        if matter not in self._shown:
            told = {topic for topic, matters in zip(self.topics, matter, strict=True) if matters}
            kept = {
                found.rule.id for found in self.others if not found.rule.on_request and found.rule.topic in told
            }
            left = ", ".join(TOPICS[topic].casefold() for topic in self.topics if topic not in told)
            further = (Line(f"Further rules, by query: {left}", "place"),) if left else ()
            self._shown[matter] = (*(line for line in self.lines if line.source in kept), *further)
        return self._shown[matter]


def _applied(rule: Rule, jurisdiction: str, facts: RuleFacts) -> AppliedRule:
    return AppliedRule(rule, jurisdiction, *rule.answer(facts))


class _Said:
    """What the rules of some layers say, by the answers of their conditions: these are much the same from second to
    second, and a drive asks every second."""

    def __init__(self, layers: tuple[Jurisdiction, ...]) -> None:
        rules = (rule for layer in layers for named in layer.by_topic.values() for rule in named)
        tests = dict.fromkeys(test for rule in rules for test in rule.tests)
        self._place = Place(layers=layers)
        self._conditions = tuple((CONDITIONS[test.word].holds, test.argument) for test in tests)
        self._known: dict[Hashable, RulesHere] = {}

    def __call__(self, facts: RuleFacts) -> RulesHere:
        own = facts.road_class if facts.road_class in OWN_LAW else ""
        answers = own, *[holds(facts, argument) for holds, argument in self._conditions]
        said = self._known.get(answers)
        if said is None:
            if len(self._known) >= MOST_SAID:
                self._known.clear()
            found = tuple(limits(self._place, facts))
            others = tuple(_other_rules(self._place, facts))
            said = self._known[answers] = RulesHere(
                tuple(each for each in found if each.rule.fixed),
                tuple(each for each in found if not each.rule.fixed),
                others,
                tuple(Line(each.rule.line, each.rule.id) for each in others),
                tuple(dict.fromkeys(each.rule.topic for each in others if not each.rule.on_request)),
            )
        return said


_SAID: dict[tuple[int, ...], _Said] = {}
"""By the ids of layers, which it keeps."""
MOST_SAID = 512
"""Of places, and of answers at one of them, that are kept."""


def said_at(place: Place, facts: RuleFacts) -> RulesHere:
    """``limits`` here and now, and by topic the rules of the innermost layer that has one for this road."""
    layers = tuple(map(id, place.layers))
    if layers not in _SAID:
        if len(_SAID) >= MOST_SAID:
            _SAID.clear()
        _SAID[layers] = _Said(place.layers)
    return _SAID[layers](facts)


def limits(place: Place, facts: RuleFacts) -> Iterator[AppliedRule]:
    """The limits that this road may have, without those that an earlier one rules out.

    A limit that lowers signs is ruled out by its own layer only: fog also slows a street with a city's limit. On a
    road of ``OWN_LAW``, rules about its class come before all others, even those of a city; without one, no limit
    is certain."""
    own = facts.road_class in OWN_LAW
    named = own and any(
        _names(rule, facts.road_class) and rule.may_apply(facts) is not False
        for layer in place.layers
        for rule in layer.by_topic.get("limit", ())
    )
    doubts: list[frozenset[Test]] = []
    for layer in place.layers:
        for rule in layer.by_topic.get("limit", ()):
            about_it = _names(rule, facts.road_class)
            if rule.may_apply(facts) is False or (named and rule.fixed and not about_it):
                continue
            doubt = frozenset(test for test in rule.tests if test.fixed and test.holds(facts) is None)
            ruled_out = any(earlier <= doubt for earlier in doubts)
            if not ruled_out or rule.caps:
                found = _applied(rule, layer.code, facts)
                yield replace(found, certain=False) if own and rule.fixed and not about_it else found
            if rule.fixed:
                doubts.append(doubt)
                if not doubt:
                    break


def _names(rule: Rule, road_class: str) -> bool:
    return any(test.word == "road_classes" and road_class in test.argument for test in rule.tests)


def _other_rules(place: Place, facts: RuleFacts) -> Iterator[AppliedRule]:
    for topic in TOPICS:
        if topic == "limit":
            continue
        for layer in place.layers:
            applied = [rule for rule in layer.by_topic.get(topic, ()) if rule.may_apply(facts) is not False]
            yield from (_applied(rule, layer.code, facts) for rule in applied)
            if applied:
                break
