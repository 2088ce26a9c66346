"""Tokyo as drawn against Tokyo as it is known."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from automotive_cosim import scenarios
from automotive_cosim.contracts import KMH_PER_MPS, LimitSource
from automotive_cosim.sumo_scenarios import build
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.network import Network, read_network

Rides = Callable[[str], Any]


@pytest.fixture(scope="module")
def tokyo() -> Network:
    return read_network(build.ROOT / "tokyo" / "tokyo.net.xml.gz")


@pytest.fixture(scope="module")
def forked(sumo: None, proof: None) -> Iterator[Forked]:
    simulation = Forked(scenarios.load("tokyo"), seed=1)
    yield simulation
    simulation.close()


def test_traffic_keeps_left(tokyo: Network) -> None:
    assert tokyo.map.left_hand


def test_narrow_streets_have_neither_sign_nor_centre_line(tokyo: Network) -> None:
    narrow = [edge for edge in tokyo.edges.values() if edge.road_class == "residential"]
    assert len({edge.name for edge in narrow}) >= 10
    for edge in narrow:
        assert (edge.limit_source, edge.centre_line, len(edge.lane_ids)) == (LimitSource.ASSUMED, False, 1)
        assert edge.name.endswith("-chome")
    avenues = [edge for edge in tokyo.edges.values() if edge.name.endswith("-dori")]
    assert {(edge.limit_source, edge.centre_line) for edge in avenues} == {(LimitSource.POSTED, True)}


def test_it_starts_after_the_law_changed() -> None:
    assert scenarios.load("tokyo").start.date().isoformat() > "2026-09-01"


@pytest.mark.parametrize(("trip", "metres_at_least"), [("narrow", 1300), ("narrow_west", 2500)])
def test_the_ego_drives_on_narrow_streets(trip: str, metres_at_least: float, tokyo: Network, rides: Rides) -> None:
    ride = rides("tokyo")[trip]
    narrow = {edge.edge_id for edge in tokyo.edges.values() if edge.centre_line is False}
    driven = sum(v for e, v in zip(ride.edges, ride.speed_mps, strict=True) if e in narrow)
    assert driven > metres_at_least


def test_a_hurried_driver_holds_45_where_the_law_says_30(forked: Forked) -> None:
    traffic = forked.depart(EgoPlan(scenarios.load("tokyo").trip("narrow"), "hurried", seed=2))
    states = traffic.advance(400).states
    traffic.close()
    longest = now = 0
    for state in states:
        fast = state.road.centre_line is False and state.speed_mps * KMH_PER_MPS > 45
        now = now + 1 if fast else 0
        longest = max(longest, now)
    assert longest * scenarios.load("tokyo").sumo.step_length_s >= 10


def test_the_ego_dives_into_the_tunnel_and_comes_up_again(tokyo: Network, rides: Rides) -> None:
    ride = rides("tokyo")["yamate_tunnel"]
    dark = [tokyo.edges[edge].in_tunnel for edge in ride.edges if edge in tokyo.edges]
    first, last = dark.index(True), len(dark) - dark[::-1].index(True)
    assert all(dark[first:last])
    assert last - first > 90
    assert first > 30 < len(dark) - last + 20


def test_the_avenues_are_signed_all_the_way(tokyo: Network, rides: Rides) -> None:
    met = {tokyo.edges[e] for e in rides("tokyo")["avenues"].edges if e in tokyo.edges}
    assert {edge.limit_source for edge in met} == {LimitSource.POSTED}
    assert {round(edge.speed_mps * KMH_PER_MPS) for edge in met} == {40, 50}
