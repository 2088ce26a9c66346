"""Windsor and the Putty Road as drawn against what is known of them."""

import re
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from datetime import time, timedelta
from itertools import dropwhile, takewhile
from typing import Any

import pytest

from automotive_cosim import scenarios
from automotive_cosim.contracts import KMH_PER_MPS, LimitSource
from automotive_cosim.geo.locate import Geo
from automotive_cosim.sumo_scenarios import build
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.network import Network, read_network

Net = Callable[[str], Any]
Rides = Callable[[str], Any]

DIPPED_WITHIN_M = 200.0
"""Australian Road Rules, rule 218."""


@pytest.fixture(scope="module")
def sydney() -> Network:
    return read_network(build.ROOT / "sydney" / "sydney.net.xml.gz")


@pytest.fixture(scope="module")
def forked(sumo: None, proof: None) -> Iterator[Forked]:
    simulation = Forked(scenarios.load("sydney"), seed=1)
    yield simulation
    simulation.close()


def test_traffic_keeps_left(sydney: Network) -> None:
    assert sydney.map.left_hand


def school_zones(net: Net) -> dict[str, str]:
    """Hours of each edge in a school zone."""
    return {
        edge.getID(): edge.getParam("maxspeed:conditional")
        for edge in net("sydney").getEdges()
        if edge.getParam("hazard") == "school_zone"
    }


def test_school_zones_are_in_force_at_the_start(net: Net) -> None:
    scenario = scenarios.load("sydney")
    zones = school_zones(net)
    assert len(zones) == 8
    assert scenario.start.isoweekday() <= 5
    for hours in zones.values():
        assert hours.startswith("40 @ (Mo-Fr ")
        spans = [tuple(map(time.fromisoformat, span)) for span in re.findall(r"(\d\d:\d\d)-(\d\d:\d\d)", hours)]
        arrival = scenario.start + timedelta(minutes=15)
        assert any(start <= scenario.start.time() and arrival.time() <= end for start, end in spans)


def test_the_ego_meets_40_at_school_hours_and_50_later(forked: Forked) -> None:
    scenario = scenarios.load("sydney")
    plan = EgoPlan(scenario.trip("school_run"), "average", 1)
    seen = {}
    for start in (scenario.start, scenario.start.replace(hour=11)):
        with closing(forked.depart(replace(plan, start=start))) as traffic:
            states = list(dropwhile(lambda state: not state.road.school_zone, traffic.advance(900.0).states))
            zone, inside = states[0], list(takewhile(lambda state: state.road.school_zone, states))
        context = Geo().locate(zone, None, None, start)
        assert zone.road.school_zone
        assert "Posted for certain hours: 40 km/h Mo-Fr 08:00-09:30, 14:30-16:00" in context.text()
        seen[start.hour] = (
            round((zone.road.limit.mps or 0) * KMH_PER_MPS),
            zone.road.limit_by_clock,
            max(state.speed_mps for state in inside[100:]) * KMH_PER_MPS > 43,
            context.lines[3].text,
        )
    assert seen == {
        8: (40, True, False, "Speed limit here: 40 km/h (posted on Dight Street)"),
        11: (50, False, True, "Speed limit here: 50 km/h (posted on Dight Street)"),
    }


@pytest.mark.parametrize(("trip", "zones_met"), [("school_run", 2), ("richmond", 1), ("putty_road", 0)])
def test_the_ego_passes_schools(trip: str, zones_met: int, net: Net, rides: Rides) -> None:
    met = set(school_zones(net)) & set(rides("sydney")[trip].edges)
    assert len(met) == zones_met
    assert all(rides("sydney")[trip].seconds_on(edge) >= 10 for edge in met)


def test_the_putty_road_is_dark_for_kilometres_at_80_and_at_100(sydney: Network, rides: Rides) -> None:
    ride = rides("sydney")["putty_road"]
    driven: dict[int, float] = {80: 0.0, 100: 0.0}
    for edge_id, speed_mps in zip(ride.edges, ride.speed_mps, strict=True):
        edge = sydney.edges.get(edge_id)
        if edge is not None and edge.lit is False:
            assert (edge.built_up, edge.limit_source) == (False, LimitSource.POSTED)
            driven[round(edge.speed_mps * KMH_PER_MPS)] += speed_mps
    assert min(driven.values()) > 8000


def test_in_the_dark_others_come_within_the_distance_of_high_beam_and_leave_it(forked: Forked) -> None:
    traffic = forked.depart(EgoPlan(scenarios.load("sydney").trip("putty_road")))
    states = traffic.advance(1200).states
    traffic.close()
    dark = [state.around for state in states if state.road.lit is False]
    oncoming, leader = (
        [other is not None and other.gap_m <= DIPPED_WITHIN_M for other in others]
        for others in ([around.oncoming for around in dark], [around.leader for around in dark])
    )
    alone = [not (a or b) for a, b in zip(oncoming, leader, strict=True)]
    assert min(sum(oncoming), sum(leader), sum(alone)) * 0.1 > 20
