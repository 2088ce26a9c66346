"""The scripted road behaves as the protocol says, with the same driver."""

from itertools import pairwise
from types import MappingProxyType

import pytest
from pyproj import Transformer

from automotive_cosim.contracts import (
    KMH_PER_MPS,
    Alert,
    AlertKind,
    Cruise,
    DrivingState,
    EgoEnd,
    Hazards,
    IncidentKind,
    LimitSource,
    PullOver,
    Reroute,
    RoadIncident,
    SlowDown,
)
from automotive_cosim.errors import ScenarioError, TrafficError, UnknownNameError
from automotive_cosim.scenarios import Trip
from automotive_cosim.traffic.base import Advance, EgoPlan, Simulation, Traffic
from automotive_cosim.traffic.profiles import PROFILES
from tests.scripted.traffic import Leader, Scripted, Stretch

TRIP = Trip("any", "", "")
ROAD = (
    Stretch("Rue A", 400.0, 50.0),
    Stretch("Tunnel B", 300.0, 50.0, in_tunnel=True),
    Stretch("Rue C", 300.0, 30.0, LimitSource.ASSUMED, leader=Leader(40.0, 20.0)),
    Stretch("Route D", 800.0, None, road_class="motorway", built_up=False, oncoming_gap_m=120.0),
    Stretch("Rue E", 500.0, 50.0, relative_speed=0.2),
)


def depart(*stretches: Stretch, driver: str = "average", seed: int = 0, speed_kmh: float = 0.0) -> Traffic:
    simulation: Simulation = Scripted(stretches or ROAD, start_speed_kmh=speed_kmh)
    return simulation.depart(EgoPlan(TRIP, driver, seed))


def kmh(state: DrivingState) -> float:
    return state.speed_mps * KMH_PER_MPS


@pytest.mark.parametrize("driver", PROFILES)
def test_kinematics_hold(driver: str) -> None:
    profile = PROFILES[driver]
    traffic = depart(driver=driver)
    states = (traffic.state, *traffic.advance(2000.0).states)
    assert states[-1].end is EgoEnd.ARRIVED
    for before, after in pairwise(states[:-1]):
        step_s = after.time_s - before.time_s
        assert step_s == pytest.approx(0.1)
        assert after.distance_m - before.distance_m == pytest.approx(after.speed_mps * step_s)
        assert after.acceleration_mps2 == pytest.approx((after.speed_mps - before.speed_mps) / step_s, abs=1e-6)
        assert -9.0 <= after.acceleration_mps2 <= profile.acceleration_mps2 + 1e-6
        limit_mps = after.road.limit.mps or 142 / KMH_PER_MPS
        assert after.speed_mps <= max(profile.speed_ratio * limit_mps, before.speed_mps) + 1e-6
        assert after.ahead.route_left_m == pytest.approx(2300.0 - after.distance_m)
    assert list(dict.fromkeys(state.road.name for state in states)) == [part.name for part in ROAD]


def test_the_state_says_what_the_script_says() -> None:
    traffic = depart()
    states = traffic.advance(1000.0).states
    by_name = MappingProxyType({state.road.name: state for state in states})
    assert by_name["Tunnel B"].road.in_tunnel
    assert by_name["Rue C"].road.limit.source is LimitSource.ASSUMED
    assert by_name["Route D"].road.limit.mps is None
    assert by_name["Route D"].around.oncoming is not None
    assert by_name["Rue E"].ahead.jam_distance_m == 0.0
    assert states[0].ahead.tunnel_distance_m == pytest.approx(400.0 - states[0].distance_m)
    jam = states[0].ahead.jam_distance_m
    assert jam == pytest.approx(1800.0 - states[0].distance_m)
    assert states[0].ahead.jam_length_m == pytest.approx(500.0)


def test_places_follow_the_maps_projection() -> None:
    simulation = Scripted(ROAD, origin=(11.57, 48.14), heading_deg=30.0)
    assert simulation.network.projection is not None
    to_wgs84 = Transformer.from_crs(simulation.network.projection, "EPSG:4326", always_xy=True)
    for state in simulation.depart(EgoPlan(TRIP)).advance(1000.0).states[::100]:
        lon_deg, lat_deg = to_wgs84.transform(state.x_m, state.y_m)
        assert state.lon_deg == pytest.approx(lon_deg, abs=1e-7)
        assert state.lat_deg == pytest.approx(lat_deg, abs=1e-7)
    nowhere = Scripted(ROAD, origin=None)
    assert nowhere.network.projection is None
    assert nowhere.depart(EgoPlan(TRIP)).state.lon_deg is None


def test_a_branch_goes_on_alike_and_alone() -> None:
    traffic = depart(driver="hurried", seed=3)
    traffic.advance(20.0)
    traffic.request(Alert(AlertKind.SPEED))
    branch = traffic.branch()
    idle = traffic.branch()
    idle.request(Cruise(20.0))
    expected = traffic.advance(60.0)
    assert branch.advance(60.0) == expected
    assert idle.advance(60.0) != expected
    traffic.close()
    with pytest.raises(TrafficError, match="closed"):
        traffic.advance(1.0)
    assert branch.advance(1.0).states


def test_advances_add_up_and_end() -> None:
    whole, pieces = depart(), depart()
    states = tuple(state for _ in range(50) for state in pieces.advance(0.3).states)
    assert whole.advance(15.0).states == states
    assert whole.advance(2000.0).states[-1].end is EgoEnd.ARRIVED
    assert whole.advance(1.0) == Advance((), ())
    assert not whole.request(SlowDown(30.0)).accepted


def test_the_driver_slows_after_an_alert_and_stays_slow() -> None:
    traffic = depart(Stretch("long", 5000.0, 50.0), driver="hurried", seed=3, speed_kmh=50.0)
    while kmh(traffic.state) < 79.5:
        assert traffic.advance(0.1).states
    assert traffic.request(Alert(AlertKind.SPEED)).accepted
    drive = traffic.advance(60.0)
    assert [event.kind for event in drive.events] == ["driver_slows"]
    slowing = [state for state in drive.states if state.acceleration_mps2 < -0.01]
    assert min(state.acceleration_mps2 for state in slowing) > -1.6
    assert all(abs(kmh(state) - 50.0) < 0.5 for state in drive.states[-400:])


def test_an_advised_speed_ends_with_its_limit() -> None:
    traffic = depart(Stretch("a", 800.0, 50.0), Stretch("b", 1500.0, 80.0), driver="calm", speed_kmh=40.0)
    traffic.request(Alert(AlertKind.SCHOOL, speed_kmh=30.0))
    states = traffic.advance(300.0).states
    on_a = [state for state in states if state.road.name == "a"]
    assert kmh(on_a[-1]) == pytest.approx(30.0, abs=0.5)
    assert kmh(states[len(on_a) + 600]) == pytest.approx(76.0, abs=0.5)


def test_a_distance_alert_opens_the_gap() -> None:
    road = Stretch("behind", 20_000.0, 80.0, leader=Leader(60.0, 60.0))
    traffic = depart(road, driver="hurried", seed=3, speed_kmh=60.0)
    idle = traffic.branch()
    assert traffic.request(Alert(AlertKind.DISTANCE)).accepted
    gaps = []
    for drive in (traffic, idle):
        drive.advance(200.0)
        leader = drive.state.around.leader
        assert leader is not None
        gaps.append(leader.gap_m / drive.state.speed_mps)
    assert gaps[1] < 1.2
    assert gaps[0] >= 1.9


def test_stopping_and_what_cannot_be_done() -> None:
    traffic = depart(speed_kmh=50.0)
    assert not traffic.request(Reroute("elsewhere")).accepted
    assert not traffic.request(SlowDown(1.0)).accepted
    assert traffic.request(Hazards(True)).accepted
    assert traffic.request(PullOver()).accepted
    drive = traffic.advance(60.0)
    assert traffic.state.hazard_lights
    assert traffic.state.standing_s > 35.0
    assert min(state.acceleration_mps2 for state in drive.states) > -2.5
    assert traffic.state.speed_mps == 0.0


def test_crawling_on_a_motorway_is_refused() -> None:
    traffic = depart(Stretch("A 1", 3000.0, 130.0, road_class="motorway"), speed_kmh=110.0)
    assert not traffic.request(SlowDown(40.0)).accepted
    assert traffic.request(SlowDown(90.0)).accepted
    jam = depart(Stretch("A 1", 3000.0, 130.0, road_class="motorway", relative_speed=0.2), speed_kmh=20.0)
    assert jam.request(SlowDown(40.0)).accepted


def test_hitting_the_leader_is_a_collision() -> None:
    wall = Stretch("wall", 300.0, 50.0, leader=Leader(8.0, 0.0))
    traffic = depart(Stretch("free", 300.0, 50.0), wall)
    assert traffic.advance(100.0).states[-1].end is EgoEnd.COLLIDED


def test_what_makes_no_road_is_refused() -> None:
    for stretches in ((), (Stretch(length_m=0.0),)):
        with pytest.raises(ScenarioError, match="at least one stretch"):
            Scripted(stretches)
    with pytest.raises(UnknownNameError, match="average"):
        Scripted(ROAD).depart(EgoPlan(TRIP, "averag"))


def test_time_to_collision_is_the_gap_over_the_closing_speed() -> None:
    seen = set()
    for state in depart(driver="hurried").advance(1000.0).states[:-1]:
        if (leader := state.around.leader) is not None:
            closing_mps = state.speed_mps - leader.speed_mps
            expected = leader.gap_m / closing_mps if closing_mps > 1e-3 else None
            assert leader.time_to_collision_s == (expected if expected is None else pytest.approx(expected))
            seen.add(expected is None)
    assert seen == {True, False}


def test_live_traffic_tells_of_incidents() -> None:
    traffic = depart(Stretch("Rue A"), Stretch("Rue B", incident=IncidentKind.ROADWORKS))
    expected = (RoadIncident(IncidentKind.ROADWORKS, "stretch1", 0.0),)
    assert traffic.state.ahead.incidents == expected
    assert traffic.advance(5.0).states[-1].ahead.incidents == expected
