"""Looking at the road shows what SUMO has, and changes nothing."""

import math

import pytest

from automotive_cosim.contracts import Hazards, SumoSignal
from automotive_cosim.scenarios import Scenario, Trip
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.lookout import LOOK_RADIUS_M
from automotive_cosim.traffic.sumo import load_library
from tests.scripted.traffic import Leader, Scripted, Stretch
from tests.traffic.in_process import InProcess


@pytest.mark.sumo
def test_every_vehicle_is_where_sumo_has_it(grid: Scenario, hurried: EgoPlan) -> None:
    simulation = InProcess(grid, seed=1)
    try:
        traffic = simulation.depart(hurried)
        sumo = load_library()
        most = 0
        for _ in range(40):
            traffic.advance(1.0)
            seen = {vehicle.vehicle_id: vehicle for vehicle in traffic.look().vehicles}
            ego = seen["ego"]
            for name, vehicle in seen.items():
                assert (vehicle.x_m, vehicle.y_m) == sumo.position(name)
                assert vehicle.heading_deg == sumo.angle(name)
                assert vehicle.speed_mps == sumo.speed(name)
                assert vehicle.signals == sumo.vehicle.getSignals(name)
                assert (vehicle.length_m, vehicle.width_m) == (sumo.length(name), sumo.vehicle.getWidth(name))
                assert vehicle.kind == sumo.vehicle_class(name)
            here = ego.x_m, ego.y_m
            near = {name for name in sumo.vehicle_ids() if math.dist(sumo.position(name), here) < LOOK_RADIUS_M}
            assert near <= seen.keys(), "nobody near is missing"
            most = max(most, len(seen))
        assert most > 5
    finally:
        simulation.close()


@pytest.mark.sumo
def test_looking_changes_nothing_and_every_way_to_run_sees_the_same(
    grid: Scenario, forked: Forked, hurried: EgoPlan
) -> None:
    alone = forked.depart(hurried)
    unseen = [alone.advance(1.0) for _ in range(40)]
    alone.close()
    in_process = InProcess(grid, seed=1)
    views = []
    try:
        for simulation in (forked, in_process):
            traffic = simulation.depart(hurried)
            shapes = traffic.shapes()
            told, snapshots = [], []
            for _ in range(40):
                told.append(traffic.advance(1.0))
                snapshots.append(traffic.look())
                assert traffic.look() == snapshots[-1]
            assert told == unseen
            views.append((shapes, snapshots))
            traffic.close()
    finally:
        in_process.close()
    assert views[0] == views[1]
    shapes, snapshots = views[0]
    links = {link for lane in shapes.lanes for link in lane.links}
    for snapshot in snapshots:
        states = dict(snapshot.lights)
        assert links
        assert all(place < len(states[light]) for light, place in links)
    assert len({snapshot.lights for snapshot in snapshots}) > 1


@pytest.mark.sumo
def test_hazard_lights_are_seen_and_nothing_after_the_end(forked: Forked, hurried: EgoPlan) -> None:
    traffic = forked.depart(hurried)
    traffic.request(Hazards(True))
    traffic.advance(2.0)
    (ego,) = (each for each in traffic.look().vehicles if each.vehicle_id == "ego")
    assert ego.signals & SumoSignal.HAZARD
    assert (ego.x_m, ego.y_m, ego.speed_mps) == (traffic.state.x_m, traffic.state.y_m, traffic.state.speed_mps)
    traffic.advance(900.0)
    assert traffic.state.end is not None
    assert traffic.look().vehicles == ()
    traffic.close()


def test_a_scripted_road_shows_its_cars() -> None:
    stretch = Stretch(leader=Leader(30.0, 20.0), oncoming_gap_m=80.0)
    traffic = Scripted([stretch], heading_deg=0.0, start_speed_kmh=50.0).depart(EgoPlan(Trip("a", "b", "c")))
    seen = {each.vehicle_id: each for each in traffic.look().vehicles}
    assert seen["leader"].y_m - seen["leader"].length_m - seen["ego"].y_m == pytest.approx(30.0)
    assert seen["oncoming"].y_m - seen["ego"].y_m == pytest.approx(80.0)
    assert seen["oncoming"].x_m < 0
    assert seen["oncoming"].heading_deg == 180.0
    assert not seen["ego"].signals & SumoSignal.BRAKE
    traffic.advance(1.0)
    (ego,) = (each for each in traffic.look().vehicles if each.vehicle_id == "ego")
    assert ego.signals & SumoSignal.BRAKE, "the car in front is slower"
    assert [lane.line_m[0] for lane in traffic.shapes().lanes] == [(0.0, 0.0)]
