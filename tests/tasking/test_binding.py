"""A safety task in another network rests on what is in force there, or says what is missing."""

from datetime import datetime
from functools import cache
from zoneinfo import ZoneInfo

import pytest

from automotive_cosim.contracts import (
    Around,
    DrivingState,
    GpsFix,
    Limit,
    LimitSource,
    Road,
    RoadAhead,
    RoadHere,
    Weather,
)
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.locate import Geo
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.tasking.binding import UnmetNeedError, bound, needs, never_here
from automotive_cosim.tasking.task import Basis, Half
from automotive_cosim.tasks import CATALOGUE
from tests.laws import over

INGOLSTADT, LYON, CHARTRES, BERLIN, CAIRO = (
    (11.42, 48.76),
    (4.85, 45.75),
    (1.5, 48.4),
    (13.4, 52.4),
    (31.24, 30.04),
)
FOG = Weather(6.0, 99.0, 0.0, 45, 100.0, 120.0, 3.0)
PAIRS = [(name, half) for name in CATALOGUE if CATALOGUE[name].is_safety for half in CATALOGUE[name].halves]


def context(
    place: tuple[float, float],
    *,
    limit_kmh: float | None = 50.0,
    source: LimitSource = LimitSource.POSTED,
    built_up: bool | None = True,
    weather: Weather = FOG,
) -> GeoContext:
    limit = Limit(None if limit_kmh is None else limit_kmh / 3.6, source)
    road = RoadHere("e", "e_0", 0, 1, 10.0, "Ringstraße", "primary", limit, False, None, built_up, None, 1.0)
    driving = DrivingState(
        time_s=0.0,
        x_m=0.0,
        y_m=0.0,
        lon_deg=place[0],
        lat_deg=place[1],
        heading_deg=90.0,
        speed_mps=22.0,
        acceleration_mps2=0.0,
        standing_s=0.0,
        distance_m=0.0,
        road=road,
        ahead=RoadAhead(1000.0, 100.0, 0.0, 1.0, None, 0.0, None, None, None, None, None),
        around=Around(None, None, None, None, 1.0),
        hazard_lights=False,
        vehicle_count=1,
    )
    noon = datetime(2026, 10, 5, 12, tzinfo=ZoneInfo("Europe/Paris"))
    return Geo().locate(driving, GpsFix(True, *place, 3.0, 0.0, 90.0), weather, noon)


def half(task: str, name: str = "first") -> Half:
    return CATALOGUE[task].half(name)


def test_a_sign_is_the_one_that_stands_there() -> None:
    assert bound(half("road_speed_80_in_50"), context(INGOLSTADT)) == "sign, 50 km/h on Ringstraße; DE"
    assert bound(half("road_twenty_miles"), context((-1.5, 52.2), limit_kmh=32.19)).startswith("sign, 20 mph")


@pytest.mark.parametrize("limit_kmh", [50.0, None])
def test_an_assumed_limit_is_no_sign(limit_kmh: float | None) -> None:
    there = context(INGOLSTADT, limit_kmh=limit_kmh, source=LimitSource.ASSUMED)
    with pytest.raises(UnmetNeedError, match="only assumes"):
        bound(half("road_speed_80_in_50"), there)


def test_the_law_is_that_of_the_place() -> None:
    french = half("phenomenon_rear_fog_in_mist")
    assert french.rule == "FR.rear_fog"
    assert bound(french, context(LYON)).startswith("FR.rear_fog (verified")
    with pytest.raises(UnmetNeedError, match=r"Germany answers differently than FR\.rear_fog.*DE\.rear_fog"):
        bound(french, context(BERLIN))
    german = half("phenomenon_rear_fog_in_mist", "second")
    assert bound(german, context(INGOLSTADT)).startswith("DE.rear_fog (verified")


def test_no_verdict_rests_on_a_rule_that_was_not_read_or_a_place_without_law() -> None:
    with pytest.raises(UnmetNeedError, match="is not verified but"):
        bound(half("road_headway"), context((-0.1, 51.9)))
    with pytest.raises(UnmetNeedError, match="no law known there"):
        bound(half("road_headway"), context((-30.0, 40.0)))


def test_a_limit_of_the_law_must_be_certain_and_as_high() -> None:
    german = half("road_unsigned_town", "second")
    assert german.rule == "DE.limit.built_up"
    unposted = LimitSource.ASSUMED
    assert bound(german, context(INGOLSTADT, source=unposted)).startswith("DE.limit.built_up (verified")
    assert bound(german, context(CHARTRES, source=unposted)).startswith("FR.limit.built_up (verified")
    with pytest.raises(UnmetNeedError, match="differently"):
        bound(german, context((-3.2, 51.5), source=unposted))
    with pytest.raises(UnmetNeedError, match="nothing certain"):
        bound(german, context(INGOLSTADT, source=unposted, built_up=None))
    with pytest.raises(UnmetNeedError, match="differently"):
        bound(german, context(CAIRO, source=unposted))


@over(PAIRS)
def test_every_half_of_a_pair_says_what_it_needs(task_id: str, half_name: str) -> None:
    """And nothing that is judged by law comes through at sea."""
    each = CATALOGUE[task_id].half(half_name)
    if each.basis is Basis.LAW:
        assert all(need.startswith("a verified rule") for need in needs(each))
        assert len(needs(each)) == 1 + each.rule.count(",")
        with pytest.raises(UnmetNeedError):
            bound(each, context((-30.0, 40.0), limit_kmh=None, source=LimitSource.ASSUMED))
    if each.basis in (Basis.PHYSICS, Basis.WISH):
        assert bound(each, context((-30.0, 40.0))) == each.rule


@pytest.mark.slow
@over([(name, half) for name in CATALOGUE for half in CATALOGUE[name].halves])
def test_no_half_is_refused_in_its_own_network(name: str, half: str) -> None:
    start = CATALOGUE[name].half(half).start
    roads, changes = _roads(start.scenario, start.origin)
    assert changes or not never_here(CATALOGUE[name].half(half), roads)


@cache
def _roads(scenario: str, origin: tuple[float, float] | None) -> tuple[tuple[Road, ...], bool]:
    """The roads of a task's place, and whether incidents or limits by the clock change them."""
    opened = open_scenario(scenario, origin=origin)
    network = network_of(opened)
    return network.map.roads, bool(opened.incidents) or any(edge.timed_limits for edge in network.edges.values())


def test_what_no_road_of_a_place_has_is_told() -> None:
    tunnel = next(
        half
        for task in CATALOGUE.values()
        for half in map(task.half, task.halves)
        if "in a tunnel" in str(half.trigger.condition).split(", ")
    )
    roads, _ = _roads("grid", None)
    assert never_here(tunnel, roads) == ""
    assert never_here(tunnel, [road for road in roads if not road.in_tunnel]) == "in a tunnel"
