"""Kiruna as drawn against Kiruna as it is known."""

from collections.abc import Callable
from datetime import timedelta
from itertools import pairwise
from typing import Any

import pytest

from automotive_cosim import scenarios
from automotive_cosim.contracts import KMH_PER_MPS, LimitSource
from automotive_cosim.geo.sun import elevation_deg
from automotive_cosim.geo.weather import phenomena
from automotive_cosim.sumo_scenarios import build
from automotive_cosim.traffic.network import Network, read_network

Net = Callable[[str], Any]
Rides = Callable[[str], Any]


@pytest.fixture(scope="module")
def nordic() -> Network:
    return read_network(build.ROOT / "nordic" / "nordic.net.xml.gz")


def test_the_sun_does_not_rise_but_it_is_not_night() -> None:
    start = scenarios.load("nordic").start
    day = [start.replace(hour=0) + timedelta(minutes=10 * step) for step in range(144)]
    assert max(elevation_deg(67.85, 20.25, at) for at in day) < -0.833
    drive = [start + timedelta(minutes=minute) for minute in range(0, 60, 10)]
    assert min(elevation_deg(67.85, 20.25, at) for at in drive) > -6


def test_it_snows_ever_more() -> None:
    skies = [entry.weather for entry in scenarios.load("nordic").weather]
    assert all("snow" in phenomena(sky) and sky.temperature_2m < -10 for sky in skies)
    assert all(later.visibility < earlier.visibility for earlier, later in pairwise(skies))
    assert "heavy_snow" in phenomena(skies[-1])


def lit(nordic: Network, ride: Any) -> list[bool | None]:
    """Lamps or none along a ride, each stretch once."""
    kinds = [nordic.edges[edge].lit for edge in ride.edges if edge in nordic.edges]
    return [kind for i, kind in enumerate(kinds) if i == 0 or kind != kinds[i - 1]]


@pytest.mark.parametrize(
    ("trip", "stretches"),
    [
        ("e10_south", [True, False]),
        ("kurravaara", [False, True]),
        ("jukkasjarvi", [True, False, True]),
        ("town", [True]),
    ],
)
def test_lamps_begin_and_end_on_the_way(trip: str, stretches: list[bool], nordic: Network, rides: Rides) -> None:
    assert lit(nordic, rides("nordic")[trip]) == stretches


def test_the_e10_is_dark_for_kilometres_at_100(nordic: Network, rides: Rides) -> None:
    ride = rides("nordic")["e10_south"]
    dark = [
        speed_mps
        for edge, speed_mps in zip(ride.edges, ride.speed_mps, strict=True)
        if edge in nordic.edges and nordic.edges[edge].lit is False and edge.startswith("e10")
    ]
    assert sum(dark) > 15_000
    assert max(dark) * KMH_PER_MPS > 95


def test_the_law_alone_limits_the_road_from_kurravaara(nordic: Network, rides: Rides) -> None:
    first = nordic.edges[rides("nordic")["kurravaara"].edges[0]]
    assert (first.limit_source, first.built_up, first.lit) == (LimitSource.ASSUMED, False, False)
    assert round(first.speed_mps * KMH_PER_MPS) == 70


def test_the_town_has_a_school_at_30(net: Net, rides: Rides) -> None:
    school = [e for e in net("nordic").getEdges() if e.getParam("hazard") == "school_zone"]
    assert {e.getParam("maxspeed") for e in school} == {"30"}
    assert {e.getID() for e in school} & set(rides("nordic")["town"].edges)
