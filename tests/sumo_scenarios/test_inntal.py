"""What drivers under the gantries of the Inn valley are shown, as SUMO's variable speed signs have it."""

from contextlib import closing

import pytest

from automotive_cosim.contracts import KMH_PER_MPS, LimitSource
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Simulations

SHOWN = {
    "gantries": {("ost.0", lane, LimitSource.VARIABLE, 100) for lane in (0, 1)},
    "lanes": {("ost.3", 0, LimitSource.VARIABLE, 80), ("ost.3", 1, LimitSource.POSTED, 100)},
    "dark": {("west.2", lane, LimitSource.POSTED, 100) for lane in (0, 1)},
    "open": {("west.4", lane, LimitSource.ASSUMED, 130) for lane in (0, 1)},
}
"""By trip, what may hold in its first minute: edge, lane, source and km/h."""


@pytest.mark.slow
def test_a_sign_holds_for_the_lanes_it_hangs_over_and_a_dark_one_for_none(simulations: Simulations) -> None:
    scenario = open_scenario("inntal")
    for trip, may in SHOWN.items():
        plan = EgoPlan(scenario.trip(trip), "average", 0, scenario.weather, scenario.start)
        with simulations.held(scenario, 0, lambda done_s, total_s: None) as warm:
            traffic = warm.depart(plan)
        with closing(traffic):
            roads = [traffic.state.road, *(state.road for state in traffic.advance(60.0).states)]
        seen = {
            (road.edge_id, road.lane_index, road.limit.source, round((road.limit.mps or 0.0) * KMH_PER_MPS))
            for road in roads
        }
        assert seen, trip
        assert seen <= may, trip
