"""The geo-context: what holds where the car is, as data and as the text an agent reads."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from automotive_cosim.contracts import (
    KMH_PER_MPS,
    DrivingState,
    GpsFix,
    LimitSource,
    RoadHere,
    Weather,
)
from automotive_cosim.geo import text
from automotive_cosim.geo.climate import ClimateNorm, climate_norm
from automotive_cosim.geo.place import NOWHERE, Atlas, Place
from automotive_cosim.geo.rules import TOPICS, Rule, Value
from automotive_cosim.geo.situation import Situation, Test
from automotive_cosim.geo.sun import Sun, sun_at
from automotive_cosim.geo.weather import phenomena

MOTORWAYS = ("motorway", "motorway_link")
STREETS = ("residential", "living_street", "pedestrian")
"""OSM highway values that stand for built-up land where the network says nothing of it."""

MAYBE_DUAL = ("trunk", "trunk_link", "primary", "secondary")
"""Roads that may have a central reservation if they have two lanes or more in one direction."""

MAYBE_EXPRESSWAY = ("trunk", "trunk_link", "")
"""Roads that may be closed to slow traffic; the network does not say which."""

STANDING_BELOW_MPS = 0.1


@dataclass(frozen=True, slots=True)
class AppliedRule:
    """A rule that place, road and date leave open here."""

    rule: Rule
    jurisdiction: str
    """Code of the country, region or city whose rule it is."""
    value: Value | None
    """Its answer now: None if it does not apply now."""
    certain: bool
    """False where the situation does not tell whether it is this answer."""


@dataclass(frozen=True, slots=True)
class GeoContext:
    """Place, road, law, sky and weather at one instant. States facts and rules; judges nothing."""

    place: Place
    gps: GpsFix | None
    road: RoadHere
    speed_kmh: float
    heading_deg: float
    local_time: datetime
    built_up: bool | None
    built_up_source: str
    """``"network"``, ``"road class"``, ``"place"`` or ``"unknown"``."""
    posted_limit_kmh: float | None
    """None where no sign is known, or the sign lifts every limit."""
    default_limits: tuple[AppliedRule, ...]
    """The law's limit for this road. Several where the network does not tell which; none where no law is known."""
    reduced_limits: tuple[AppliedRule, ...]
    """Lower limits of this road under conditions of weather, light or hour, whether or not these hold now."""
    rules: tuple[AppliedRule, ...]
    """The other topics, in the order of ``rules.TOPICS``."""
    sun: Sun | None
    """None where the position is not known, as with ``climate``."""
    weather: Weather | None
    climate: ClimateNorm | None

    @property
    def country(self) -> str:
        """ISO 3166-1 code; empty where it is not known."""
        return self.place.country

    @property
    def default_limit(self) -> AppliedRule | None:
        """The law's limit for this road if there is no doubt which."""
        return self.default_limits[0] if len(self.default_limits) == 1 and self.default_limits[0].certain else None

    @property
    def speed_unit(self) -> str:
        """The country's: ``"km/h"`` or ``"mph"``; km/h where the country is not known."""
        return self.place.law.speed_unit if self.place.law else "km/h"

    def rule(self, topic: str) -> AppliedRule | None:
        """The first rule on a topic that applies now; None if there is none."""
        return next((found for found in self.rules if found.rule.topic == topic and found.value is not None), None)

    @property
    def lines(self) -> tuple[text.Line, ...]:
        """Every line of the text with what it rests on, the most important first."""
        return tuple(text.lines(self))

    def text(self, budget_tokens: int = text.BUDGET_TOKENS) -> str:
        """What holds here, one fact a line: as many lines, from the first, as the budget takes."""
        return text.within_budget(self.lines, budget_tokens)


class Geo:
    """Makes contexts. Holds nothing of a drive, so that branches share it.

    Args:
        folders: the user's own rule files, which stand before the shipped ones.
    """

    def __init__(self, folders: Sequence[Path] = ()) -> None:
        self.atlas = Atlas(folders)

    def locate(
        self, driving: DrivingState, gps: GpsFix | None, weather: Weather | None, local_time: datetime
    ) -> GeoContext:
        """What holds here and now.

        Args:
            driving: gives the road, the traffic and the motion; its position is not read.
            gps: gives the place, by its last fix; None leaves the place unknown.
            weather: None leaves it unknown.
            local_time: zone-aware.
        """
        place = self.atlas.place(gps.lon_deg, gps.lat_deg) if gps else NOWHERE
        sun = sun_at(gps.lon_deg, gps.lat_deg, local_time) if gps else None
        built_up, built_up_source = _built_up(driving.road, place)
        situation = _situation(driving, gps, weather, local_time, sun, built_up)
        road = driving.road
        limits = tuple(_limits(place, situation))
        posted = road.posted_limit_mps if road.limit_source is LimitSource.POSTED else None
        return GeoContext(
            place=place,
            gps=gps,
            road=road,
            speed_kmh=driving.speed_mps * KMH_PER_MPS,
            heading_deg=driving.heading_deg,
            local_time=local_time,
            built_up=built_up,
            built_up_source=built_up_source,
            posted_limit_kmh=None if posted is None else posted * KMH_PER_MPS,
            default_limits=tuple(found for found in limits if found.rule.fixed),
            reduced_limits=tuple(found for found in limits if not found.rule.fixed),
            rules=tuple(_other_rules(place, situation)),
            sun=sun,
            weather=weather,
            climate=climate_norm(gps.lon_deg, gps.lat_deg, local_time.month) if gps else None,
        )


def _built_up(road: RoadHere, place: Place) -> tuple[bool | None, str]:
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


def _situation(
    driving: DrivingState,
    gps: GpsFix | None,
    weather: Weather | None,
    local_time: datetime,
    sun: Sun | None,
    built_up: bool | None,
) -> Situation:
    road, around = driving.road, driving.around
    return Situation(
        local_time=local_time,
        lon_deg=gps.lon_deg if gps else None,
        lat_deg=gps.lat_deg if gps else None,
        street=road.name,
        road_class=road.road_class,
        motorway=road.road_class in MOTORWAYS if road.road_class else None,
        dual_carriageway=_dual_carriageway(road),
        expressway=None if road.road_class in MAYBE_EXPRESSWAY else False,
        built_up=built_up,
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
    )


def _applied(rule: Rule, jurisdiction: str, situation: Situation) -> AppliedRule:
    return AppliedRule(rule, jurisdiction, *rule.answer(situation))


def _limits(place: Place, situation: Situation) -> Iterator[AppliedRule]:
    """The limits that may be this road's, without those that an earlier one rules out.

    A limit that lowers signs is ruled out by its own layer only: fog slows a street of a city's limit too.
    """
    doubts: list[frozenset[Test]] = []
    for layer in place.layers:
        for rule in layer.by_topic.get("limit", ()):
            if rule.may_apply(situation) is False:
                continue
            doubt = frozenset(test for test in rule.tests if test.fixed and test.holds(situation) is None)
            ruled_out = any(earlier <= doubt for earlier in doubts)
            if not ruled_out or rule.caps:
                yield _applied(rule, layer.code, situation)
            if rule.fixed:
                doubts.append(doubt)
                if not doubt:
                    break


def _other_rules(place: Place, situation: Situation) -> Iterator[AppliedRule]:
    """Per topic the rules of the innermost layer that has one for this road."""
    for topic in TOPICS:
        if topic == "limit":
            continue
        for layer in place.layers:
            applied = [rule for rule in layer.by_topic.get(topic, ()) if rule.may_apply(situation) is not False]
            yield from (_applied(rule, layer.code, situation) for rule in applied)
            if applied:
                break
