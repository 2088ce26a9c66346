"""Dubai as drawn against Dubai as it is known."""

from collections.abc import Callable
from datetime import timedelta
from typing import Any

import pytest
from shapely import LineString, Point

from automotive_cosim import scenarios
from automotive_cosim.contracts import KMH_PER_MPS, LimitSource
from automotive_cosim.geo.sun import elevation_deg
from automotive_cosim.geo.weather import phenomena
from automotive_cosim.sumo_scenarios import build
from automotive_cosim.traffic.network import Network, read_network

Net = Callable[[str], Any]
Rides = Callable[[str], Any]

STATIONS = {
    # Metro stations along Sheikh Zayed Road: longitude, latitude, degrees.
    "Al Safa": (55.2286, 25.1556),
    "Umm Al Sheif": (55.2079, 25.1347),
    "Mall of the Emirates": (55.2003, 25.1211),
    "Dubai Internet City": (55.1740, 25.1019),
}


@pytest.fixture(scope="module")
def gulf() -> Network:
    return read_network(build.ROOT / "gulf" / "gulf.net.xml.gz")


@pytest.mark.parametrize("station", STATIONS)
def test_sheikh_zayed_road_passes_the_stations(station: str, net: Net) -> None:
    dubai = net("gulf")
    here = Point(dubai.convertLonLat2XY(*STATIONS[station]))
    road = [edge for edge in dubai.getEdges() if edge.getName() == "Sheikh Zayed Road"]
    assert min(LineString(edge.getShape()).distance(here) for edge in road) < 300


def test_five_lanes_each_way_for_kilometres(gulf: Network, rides: Rides) -> None:
    ride = rides("gulf")["sheikh_zayed"]
    edges = [gulf.edges[edge] for edge in dict.fromkeys(ride.edges) if edge in gulf.edges]
    assert {(edge.road_class, len(edge.lane_ids)) for edge in edges} == {("motorway", 5)}
    limits = [round(edge.speed_mps * KMH_PER_MPS) for edge in edges]
    assert limits == sorted(limits)
    assert set(limits) == {100, 120}
    assert sum(ride.speed_mps) > 11_000


def test_the_service_road_leads_from_60_to_40_to_no_sign(gulf: Network, rides: Rides) -> None:
    edges = [gulf.edges[edge] for edge in rides("gulf")["service_road"].edges if edge in gulf.edges]
    service = [round(e.speed_mps * KMH_PER_MPS) for e in edges if e.name == "Sheikh Zayed Service Road"]
    assert list(dict.fromkeys(service)) == [60, 40]
    assert not any(edge.road_class == "motorway" for edge in edges)
    assert edges[-1].limit_source is LimitSource.ASSUMED


def test_it_is_hot_all_day_long() -> None:
    scenario = scenarios.load("gulf")
    assert scenario.weather[0].weather.temperature_2m == 44
    assert min(entry.weather.temperature_2m for entry in scenario.weather) >= 42
    assert elevation_deg(25.1, 55.2, scenario.start + timedelta(minutes=30)) > 45


def test_every_trip_meets_dust_and_the_desert_a_storm_by_day_without_lamps(gulf: Network, rides: Rides) -> None:
    timeline = scenarios.load("gulf").weather
    for trip, ride in rides("gulf").items():
        skies = [scenarios.weather_at(timeline, second) for second in range(len(ride.edges))]
        assert "dust" not in phenomena(skies[0])
        assert sum("dust" in phenomena(sky) for sky in skies) > 120, trip
    ride = rides("gulf")["desert"]
    unlit = [
        scenarios.weather_at(timeline, second).visibility
        for second, edge in enumerate(ride.edges)
        if edge in gulf.edges and gulf.edges[edge].lit is False
    ]
    assert sum(visibility_m < 500 for visibility_m in unlit) > 120
    assert all(gulf.edges[edge].built_up is False for edge in ride.edges[-120:] if edge in gulf.edges)
