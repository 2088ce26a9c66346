"""London as drawn against London as it is known."""

from collections.abc import Callable
from typing import Any

import pytest

from automotive_cosim import scenarios
from automotive_cosim.traffic.network import read_network

Net = Callable[[str], Any]
Rides = Callable[[str], Any]


def test_traffic_keeps_left(net: Net) -> None:
    assert read_network(scenarios.load("london").folder / "london.net.xml.gz").map.left_hand
    east, west = (net("london").getEdge(edge) for edge in ("euston.1", "-euston.1"))
    assert east.getShape()[0][1] > west.getShape()[-1][1], "eastbound drives on the northern side"


def test_the_underpass_is_a_tunnel_northwards_only(net: Net) -> None:
    (tunnel,) = [edge for edge in net("london").getEdges() if edge.getParam("tunnel") == "yes"]
    assert tunnel.getName() == "Strand Underpass"
    assert 350 < tunnel.getLength() < 550
    assert tunnel.getToNode().getCoord()[1] > tunnel.getFromNode().getCoord()[1]


def signs(ride: Any, net: Net) -> list[str]:
    """Limits in the order they are met, junctions left out."""
    met = [net("london").getEdge(e).getParam("maxspeed") for e in ride.edges if not e.startswith(":")]
    return [sign for i, sign in enumerate(met) if i == 0 or met[i - 1] != sign]


@pytest.mark.parametrize(
    ("trip", "met"),
    [
        ("kingsway", ["20 mph", "30 mph"]),
        ("euston", ["30 mph", "20 mph"]),
        ("strand", ["20 mph"]),
        ("bloomsbury", ["20 mph"]),
    ],
)
def test_what_signs_the_ego_meets(trip: str, met: list[str], rides: Rides, net: Net) -> None:
    assert signs(rides("london")[trip], net) == met


def test_the_ego_drives_through_the_underpass(rides: Rides) -> None:
    assert rides("london")["kingsway"].seconds_on("underpass.0") > 30


def test_the_ego_reaches_30_mph_on_the_euston_road(rides: Rides) -> None:
    ride = rides("london")["euston"]
    assert max(v for e, v in zip(ride.edges, ride.speed_mps, strict=True) if e.startswith("euston")) > 12.5
