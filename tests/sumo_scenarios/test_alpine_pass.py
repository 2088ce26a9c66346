"""The San Bernardino as drawn against the San Bernardino as it is known."""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest

from automotive_cosim import scenarios
from automotive_cosim.contracts import LimitSource
from automotive_cosim.traffic.network import read_network

Net = Callable[[str], Any]
Rides = Callable[[str], Any]


def tunnel(net: Net) -> list[Any]:
    return [edge for edge in net("alpine_pass").getEdges() if edge.getParam("tunnel") == "yes"]


def test_the_tunnel_is_long_and_has_one_lane_each_way_at_80(net: Net) -> None:
    for way in (True, False):
        edges = [edge for edge in tunnel(net) if edge.getID().startswith("-") is way]
        assert sum(edge.getLength() for edge in edges) == pytest.approx(6600, abs=300)
        assert {(e.getLaneNumber(), e.getParam("maxspeed"), e.getParam("lit")) for e in edges} == {(1, "80", "yes")}


def test_villages_are_signed_50_and_the_roads_between_them_are_not_signed() -> None:
    edges = read_network(scenarios.load("alpine_pass").folder / "alpine_pass.net.xml.gz").edges
    village, between = edges["nufenen.0"], edges["rheinwald.1"]
    assert (village.built_up, village.limit_source) == (True, LimitSource.POSTED)
    assert (between.built_up, between.limit_source) == (False, LimitSource.ASSUMED)
    assert village.limit_mps == pytest.approx(50 / 3.6, abs=0.01)
    assert between.limit_mps == pytest.approx(80 / 3.6, abs=0.01)


def slope_pct(edge: Any) -> float:
    """From end to end, per cent."""
    shape = edge.getShape3D()
    length = sum(math.dist(a[:2], b[:2]) for a, b in pairwise(shape))
    return 100 * abs(shape[-1][2] - shape[0][2]) / length


def test_the_descents_are_steep_but_no_steeper_than_roads_are(net: Net) -> None:
    slopes = {edge.getID(): slope_pct(edge) for edge in net("alpine_pass").getEdges()}
    assert all(slopes[edge] > 5 for edge in ("a13.9", "a13.10", "a13.11", "moesola.1", "moesola.2"))
    assert max(slopes.values()) < 10


def test_it_snows_below_zero() -> None:
    weather = scenarios.load("alpine_pass").weather[0].weather
    assert weather.weather_code in (71, 73, 75)
    assert weather.temperature_2m < 0


def test_the_ego_is_in_the_tunnel_for_minutes(net: Net, rides: Rides) -> None:
    ids = [edge.getID() for edge in tunnel(net)]
    assert rides("alpine_pass")["tunnel"].seconds_on(*ids) > 240


def test_the_ego_drives_kilometres_downhill(net: Net, rides: Rides) -> None:
    ride = rides("alpine_pass")["descent"]
    steep = [v for e, v in zip(ride.edges, ride.speed_mps, strict=True) if e in {"a13.9", "a13.10", "a13.11"}]
    assert sum(steep) > 11_000


@pytest.mark.parametrize("trip", ["villages", "hairpins"])
def test_the_ego_leaves_and_enters_villages(trip: str, net: Net, rides: Rides) -> None:
    edges = [net("alpine_pass").getEdge(e) for e in rides("alpine_pass")[trip].edges if not e.startswith(":")]
    zones = [edge.getParam("zone:traffic") for edge in edges]
    assert sum(a != b for a, b in pairwise(zones)) >= 4
