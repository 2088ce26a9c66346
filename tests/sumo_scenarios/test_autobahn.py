"""The A 5 as drawn: limits, lanes, exits, roadworks, and what the ego meets of them."""

from collections.abc import Callable
from itertools import groupby
from typing import Any

import pytest

from automotive_cosim import scenarios
from automotive_cosim.contracts import LimitSource
from automotive_cosim.traffic.network import read_network

Net = Callable[[str], Any]
Rides = Callable[[str], Any]


def a5(net: Net, key: str = "a5") -> list[Any]:
    return [edge for edge in net("autobahn").getEdges() if edge.getID().startswith(key)]


@pytest.mark.parametrize("way", ["a5_sued", "a5_nord"])
def test_each_way_has_kilometres_at_100_at_120_and_without_a_limit(way: str, net: Net) -> None:
    lengths = {
        sign: sum(e.getLength() for e in a5(net, way) if e.getParam("maxspeed") == sign)
        for sign in ("100", "120", "none")
    }
    assert all(length > 700 for length in lengths.values())
    assert lengths["none"] > 5000


def test_the_road_side_reads_no_limit_and_unsigned_limits() -> None:
    edges = read_network(scenarios.load("autobahn").folder / "autobahn.net.xml.gz").edges
    assert edges["a5_sued.10"].limit_mps is None
    assert edges["a5_sued.0"].limit_mps == pytest.approx(100 / 3.6, abs=0.01)
    assert edges["a5_sued.0"].built_up is False
    b486 = edges["b486.0"]
    assert (b486.limit_source, b486.built_up) == (LimitSource.ASSUMED, False)


def test_there_are_lanes_enough_for_an_emergency_corridor(net: Net) -> None:
    assert min(edge.getLaneNumber() for edge in a5(net)) >= 2


def test_the_roadworks_take_lanes_and_lower_the_limit(net: Net) -> None:
    (works,) = (one for one in scenarios.load("autobahn").incidents if one.kind == "roadworks")
    edge = net("autobahn").getEdge(works.edge)
    (before,) = edge.getIncoming()
    (earlier,) = before.getIncoming()
    assert works.kind == "roadworks"
    assert edge.getLaneNumber() < before.getLaneNumber() < earlier.getLaneNumber()
    assert edge.getSpeed() < before.getSpeed() < earlier.getSpeed()


def signs(ride: Any, net: Net) -> list[str]:
    """Limits on the A 5 in the order they are met."""
    met = [net("autobahn").getEdge(edge).getParam("maxspeed") for edge in ride.edges if edge.startswith("a5")]
    return [sign for sign, _ in groupby(met)]


def test_what_signs_the_ego_meets(rides: Rides, net: Net) -> None:
    ways = rides("autobahn")
    assert signs(ways["south"], net) == ["100", "120", "none", "120", "100", "80", "120", "none"]
    assert signs(ways["north"], net) == ["120", "none", "120", "100"]
    assert signs(ways["roadworks"], net) == ["none", "120", "100", "80", "120"]


@pytest.mark.parametrize("trip", ["south", "north"])
def test_the_ego_is_faster_than_120_where_there_is_no_limit(trip: str, rides: Rides, net: Net) -> None:
    ride = rides("autobahn")[trip]
    free = {edge.getID() for edge in a5(net) if edge.getParam("maxspeed") == "none"}
    fast = [speed for edge, speed in zip(ride.edges, ride.speed_mps, strict=True) if edge in free]
    assert max(fast) * 3.6 > 120


def test_the_ego_stops_by_at_the_rest_area(rides: Rides) -> None:
    assert rides("autobahn")["rest"].seconds_on("rast_s.0") > 20
