"""Trips driven in turn: each leg leads on to the next, on every network."""

from itertools import pairwise
from typing import Any

import pytest

from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.errors import ScenarioError
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.traffic.rounds import planned

EVERY = [pytest.param(family, id=family.id) for family in FAMILIES.values()]


@pytest.mark.slow
@pytest.mark.parametrize("family", EVERY)
def test_whichever_trip_comes_first_the_round_closes(family: Any) -> None:
    scenario = open_scenario(family.scenario)
    network = network_of(scenario)
    trips = [scenario.trip(name) for name in family.trips]
    for turned in range(len(trips)):
        first, *others = trips[turned:] + trips[:turned]
        round_ = planned(network, first, (*others, first))
        assert round_.first[0] == first.from_edge
        way, here = list(round_.first), round_.first[-1]
        for leg in range(2 * len(trips)):
            following = round_.following(network, here, leg)
            assert following[0] == here
            way += following[1:]
            here = following[-1]
        assert all(there in network.crossings[here] for here, there in pairwise(way))


def test_a_trip_without_a_way_back_is_refused() -> None:
    scenario = open_scenario("tokyo")
    first, lost = scenario.trip("avenues"), scenario.trip("yamate_tunnel")
    with pytest.raises(ScenarioError, match="'yamate_tunnel'"):
        planned(network_of(scenario), first, (lost, first))


def test_a_trip_that_ends_at_the_rim_is_driven_as_far_as_one_can_return() -> None:
    scenario = open_scenario("beauce")
    network = network_of(scenario)
    plain, villages = scenario.trip("plain"), scenario.trip("villages")
    round_ = planned(network, plain, (villages, plain))
    assert round_.first[0] == plain.from_edge
    assert plain.to_edge not in round_.first, "no way leads back from there"
    assert round_.legs[0][-1] in network.edges
