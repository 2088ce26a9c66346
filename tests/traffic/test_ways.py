"""Ways found without SUMO are the ways SUMO finds."""

from itertools import pairwise

import numpy as np
import pytest
import sumolib

from automotive_cosim.scenarios import load
from automotive_cosim.traffic.network import read_network
from automotive_cosim.traffic.ways import way_through, ways_from


@pytest.mark.parametrize("name", ["grid", "london", "autobahn"])
def test_what_can_be_reached_is_what_sumolib_reaches(name: str) -> None:
    net = next(load(name).folder.glob("*.net.xml*"))
    network, theirs = read_network(net), sumolib.net.readNet(str(net))
    rng = np.random.default_rng(4)
    edges = sorted(network.edges)
    for start, goal in rng.choice(edges, (25, 2)):
        if start == goal:
            continue
        way = ways_from(network, start).to(goal)
        there, _ = theirs.getFastestPath(theirs.getEdge(start), theirs.getEdge(goal), vClass="passenger")
        assert bool(way) == bool(there), (start, goal)


@pytest.mark.parametrize("name", ["grid", "london"])
def test_a_way_leads_on_and_is_as_long_as_its_parts(name: str) -> None:
    network = read_network(next(load(name).folder.glob("*.net.xml*")))
    start = sorted(network.edges)[0]
    ways = ways_from(network, start)
    for goal in list(ways.before)[:60]:
        way = ways.to(goal)
        inside = sum(network.crossings[here][there].length_m for here, there in pairwise(way))
        parts = sum(network.edges[edge].length_m for edge in way)
        assert ways.length_m[goal] == pytest.approx(inside + parts)
        assert len(set(way)) == len(way)


def test_the_nearest_edges_are_those_of_the_whole_search() -> None:
    network = read_network(next(load("london").folder.glob("*.net.xml*")))
    start = sorted(network.edges)[0]
    whole, near = ways_from(network, start), ways_from(network, start, 50)
    assert 49 <= len(near.before) < len(whole.before)
    reached = list(near.before)[:20]
    assert [near.to(edge) for edge in reached] == [whole.to(edge) for edge in reached]


def test_no_way_leads_to_what_is_no_edge() -> None:
    network = read_network(load("grid").folder / "grid.net.xml")
    assert way_through(network, ("cwc0", "nowhere")) == ()
    assert way_through(network, ("nowhere", "cwc0")) == ()
    assert way_through(network, ("cwc0",)) == ("cwc0",)
    assert ways_from(network, "cwc0").to("cwc0") == ()
