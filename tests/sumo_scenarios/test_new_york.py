"""Manhattan as drawn against Manhattan as it is known."""

import gzip
import math
import xml.etree.ElementTree as ET
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest

from automotive_cosim import scenarios

Net = Callable[[str], Any]
Rides = Callable[[str], Any]

STATIONS = {
    # Junction of the net: longitude, latitude of the subway station there, degrees.
    "lexington_86": (-73.9556, 40.7795),
    "lexington_77": (-73.9599, 40.7736),
    "second_86": (-73.9517, 40.7778),
    "second_72": (-73.9584, 40.7688),
}

DOWNTOWN = ("5th Avenue", "Lexington Avenue", "2nd Avenue")
UPTOWN = ("Madison Avenue", "3rd Avenue", "1st Avenue")


def heads(edge: Any) -> tuple[float, float]:
    """Metres east and north."""
    (x0, y0), (x1, y1) = edge.getFromNode().getCoord(), edge.getToNode().getCoord()
    return x1 - x0, y1 - y0


def streets(net: Net, *names: str) -> list[Any]:
    return [edge for edge in net("new_york").getEdges() if edge.getName() in names]


@pytest.mark.parametrize("junction", STATIONS)
def test_corners_lie_where_manhattan_has_them(
    junction: str, metres: Callable[..., float], lonlat: Callable[..., Any]
) -> None:
    assert metres(STATIONS[junction], lonlat("new_york", junction)) < 60


def test_twenty_blocks_are_a_mile(net: Net) -> None:
    a, b = (net("new_york").getNode(f"park_{street}").getCoord() for street in (72, 86))
    assert 20 * math.dist(a, b) / 14 == pytest.approx(1609, rel=0.02)


def test_one_way_streets(net: Net) -> None:
    assert all(heads(edge)[1] < 0 for edge in streets(net, *DOWNTOWN))
    assert all(heads(edge)[1] > 0 for edge in streets(net, *UPTOWN))
    assert {heads(edge)[1] > 0 for edge in streets(net, "Park Avenue")} == {True, False}
    assert all(heads(edge)[0] < 0 for edge in streets(net, "East 73rd Street", "East 81st Street"))
    assert all(heads(edge)[0] > 0 for edge in streets(net, "East 74th Street", "East 82nd Street"))
    assert {heads(edge)[0] > 0 for edge in streets(net, "East 79th Street")} == {True, False}


def test_25_mph_but_for_the_school_zones(net: Net) -> None:
    for edge in net("new_york").getEdges():
        at_school = edge.getParam("hazard") == "school_zone"
        assert edge.getParam("maxspeed") == ("20 mph" if at_school else "25 mph"), edge.getID()


def test_the_school_zone_is_the_block_of_the_school(net: Net) -> None:
    zone = {edge.getName() for edge in net("new_york").getEdges() if edge.getParam("hazard") == "school_zone"}
    assert zone == {"Madison Avenue", "East 81st Street", "East 82nd Street"}


def test_it_is_a_school_morning() -> None:
    start = scenarios.load("new_york").start
    assert start.weekday() < 5
    assert 7 <= start.hour < 9


def test_every_corner_has_a_signal_and_none_lets_anybody_turn_on_red(net: Net) -> None:
    corners = [node for node in net("new_york").getNodes() if len(node.getIncoming()) > 1]
    assert all(node.getType() == "traffic_light" for node in corners)
    path = scenarios.load("new_york").folder / "new_york.net.xml.gz"
    phases = list(ET.fromstring(gzip.decompress(path.read_bytes())).iterfind("tlLogic/phase"))
    assert len(phases) >= 2 * len(corners)
    assert not any("s" in phase.get("state", "") for phase in phases), "s is SUMO's green arrow"


@pytest.mark.parametrize("trip", ["school", "madison"])
def test_the_ego_passes_the_school_at_20_mph(trip: str, net: Net, rides: Rides) -> None:
    ride = rides("new_york")[trip]
    zone = {edge.getID() for edge in net("new_york").getEdges() if edge.getParam("hazard") == "school_zone"}
    inside = [v for e, v in zip(ride.edges, ride.speed_mps, strict=True) if e in zone]
    assert len(inside) >= 5
    assert max(inside) <= 20 * 1.609344 / 3.6 + 0.1
    assert max(ride.speed_mps) > 10


def test_the_ego_turns_right_three_times(net: Net, rides: Rides) -> None:
    ride = rides("new_york")["right_turns"]
    edges = [net("new_york").getEdge(e) for e in dict.fromkeys(ride.edges) if not e.startswith(":")]
    turns = []
    for a, b in pairwise(edges):
        (x0, y0), (x1, y1) = heads(a), heads(b)
        turns.append((x0 * y1 - y0 * x1) / (math.hypot(x0, y0) * math.hypot(x1, y1)) < -0.9)
    assert sum(turns) == 3
