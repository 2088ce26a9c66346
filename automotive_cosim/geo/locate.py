"""Finds what holds where the car is: drive, last fix, weather and clock -> ``GeoContext``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import datetime
from pathlib import Path

from automotive_cosim.contracts import (
    KMH_PER_MPS,
    STANDING_BELOW_MPS,
    DrivingState,
    GpsFix,
    LimitSource,
    RoadHere,
    Weather,
)
from automotive_cosim.geo.climate import climate_norm
from automotive_cosim.geo.context import AppliedRule, GeoContext
from automotive_cosim.geo.place import NOWHERE, Atlas, Place
from automotive_cosim.geo.rules import TOPICS, Rule
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
