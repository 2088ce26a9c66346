"""London as drawn against London as it is known."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from automotive_cosim import scenarios
from automotive_cosim.traffic.network import read_network

Net = Callable[[str], Any]
Rides = Callable[[str], Any]

POSTED = {
    # The edge of the Congestion Charge zone.
    "Euston Road": "30 mph",
    "Marylebone Road": "30 mph",
    "Pentonville Road": "30 mph",
    # Transport for London's inside it, since March 2020.
    "Victoria Embankment": "20 mph",
    # The boroughs' own.
    "Strand": "20 mph",
    "Kingsway": "20 mph",
    "High Holborn": "20 mph",
    "Southampton Row": "20 mph",
    "Gower Street": "20 mph",
    "Gray's Inn Road": "20 mph",
    "Fleet Street": "20 mph",
}

LANDMARKS = {
    # Junction of the net: longitude, latitude of the station or square beside it, degrees.
    "holborn": (-0.1200, 51.5174),
    "st_giles": (-0.1305, 51.5164),
    "leicester_square": (-0.1281, 51.5113),
    "cambridge_circus": (-0.1289, 51.5133),
    "trafalgar": (-0.1270, 51.5080),
    "temple": (-0.1141, 51.5111),
    "chancery_holborn": (-0.1111, 51.5183),
    "gower_euston": (-0.1359, 51.5258),
    "russell_sq_ne": (-0.1244, 51.5230),
    "lancaster": (-0.1194, 51.5117),
}


@pytest.mark.parametrize("street", POSTED)
def test_signs(street: str, net: Net) -> None:
    edges = [edge for edge in net("london").getEdges() if edge.getName() == street]
    assert {edge.getParam("maxspeed") for edge in edges} == {POSTED[street]}


@pytest.mark.parametrize("junction", LANDMARKS)
def test_junctions_lie_where_london_has_them(
    junction: str, metres: Callable[..., float], lonlat: Callable[..., Any]
) -> None:
    assert metres(LANDMARKS[junction], lonlat("london", junction)) < 150


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
