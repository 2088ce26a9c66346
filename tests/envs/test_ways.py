"""The navigation knows other ways to the goal, and the road agrees with the sky."""

from dataclasses import replace

import pytest

from automotive_cosim.contracts import Action, ActionType, Reroute
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.traffic.road_weather import condition_of

pytestmark = pytest.mark.sumo

WAIT = Action(ActionType.WAIT, seconds=1)


def test_other_ways_reach_the_cockpit_and_can_be_taken() -> None:
    env = CockpitEnv("hvac_fan_max", scenario="grid")
    env.reset(seed=1)
    env.step(replace(WAIT, seconds=10))
    env.step(WAIT)
    world = env.episode.world
    ways = world.moment.driving.ahead.alternatives
    assert 1 <= len(ways) <= 3
    route = world.moment.driving.ahead.route_edges
    for way in ways:
        assert (way.edges[0], way.edges[-1]) == (route[0], route[-1])
        assert way.edges != route
        assert way.eta_s > 0
    twin = world.branch()
    assert twin.traffic.request(Reroute(edges=ways[0].edges)).accepted
    assert twin.advance(2.0)[-1].driving.ahead.route_edges[-3:] == ways[0].edges[-3:]
    twin.close()
    env.close()


def test_the_road_is_as_the_sky_says() -> None:
    env = CockpitEnv("hvac_fan_max", scenario="border")
    env.reset(seed=1)
    moment = env.episode.moments[-1]
    assert moment.driving.road.friction == condition_of(moment.weather).friction < 0.5
    env.close()
