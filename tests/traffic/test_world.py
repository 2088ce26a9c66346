"""The ego in SUMO: what its state says, how its drive ends, and what its driver does."""

import math
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

from automotive_cosim.contracts import (
    KMH_PER_MPS,
    Alert,
    AlertKind,
    Answer,
    Cruise,
    DrivingState,
    EgoEnd,
    Hazards,
    LimitSource,
    PullOver,
    Reroute,
    Severity,
    SlowDown,
)
from automotive_cosim.scenarios import Scenario, Trip, load, open_scenario
from automotive_cosim.traffic.base import Advance, EgoPlan, Traffic
from automotive_cosim.traffic.congestion import SAMPLE_PERIOD_S
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.sumo import load_library
from tests.traffic.in_process import InProcess

pytestmark = pytest.mark.sumo

Variant = Callable[[Callable[[Path], None]], Scenario]


@pytest.fixture(scope="module")
def empty(grid: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Forked]:
    """The grid without other traffic."""
    import shutil

    folder = tmp_path_factory.mktemp("empty") / "grid"
    shutil.copytree(grid.folder, folder)
    (folder / "grid.rou.xml").write_text("<routes/>")
    simulation = Forked(load(folder), seed=1)
    yield simulation
    simulation.close()


@pytest.fixture
def in_process(grid: Scenario) -> Iterator[InProcess]:
    simulation = InProcess(grid, seed=1)
    yield simulation
    simulation.close()


def at_speed(simulation: Forked, plan: EgoPlan, speed_kmh: float) -> Traffic:
    """On the middle of the avenue, driving steadily."""
    traffic = simulation.depart(plan)
    while traffic.state.distance_m < 500.0 or traffic.state.speed_mps * KMH_PER_MPS <= speed_kmh:
        assert traffic.advance(0.1).states
    return traffic


def to_tunnel(traffic: Traffic) -> None:
    """Into the mouth of the tunnel."""
    while not traffic.state.road.in_tunnel:
        assert traffic.advance(0.1).states


def speeds_kmh(drive: Advance) -> list[float]:
    return [state.speed_mps * KMH_PER_MPS for state in drive.states]


def sideways_mps2(before: DrivingState, after: DrivingState) -> float:
    turned_deg = abs((after.heading_deg - before.heading_deg + 180) % 360 - 180)
    return math.radians(turned_deg) * after.speed_mps / (after.time_s - before.time_s)


# --- the state --------------------------------------------------------------------------------------------


def test_states_are_consistent(forked: Forked, hurried: EgoPlan, grid: Scenario) -> None:
    traffic = forked.depart(replace(hurried, trip=grid.trip("round")))
    states = (traffic.state, *traffic.advance(600.0).states)
    assert states[-1].end is EgoEnd.ARRIVED
    step_s = grid.sumo.step_length_s
    for before, after in pairwise(states[:-1]):
        assert after.time_s - before.time_s == pytest.approx(step_s)
        assert after.distance_m - before.distance_m == pytest.approx(after.speed_mps * step_s, abs=0.05)
        moved_m = math.dist((before.x_m, before.y_m), (after.x_m, after.y_m))
        assert moved_m <= max(before.speed_mps, after.speed_mps) * step_s + 4.0, "no jump but a change of lane"
        assert before.ahead.route_left_m - after.ahead.route_left_m == pytest.approx(
            after.distance_m - before.distance_m, abs=1.0
        )
        assert after.ahead.eta_s >= after.ahead.delay_s >= 0
        assert 0 < after.ahead.relative_speed <= 1
        assert after.ahead.relative_speed * after.ahead.eta_s == pytest.approx(
            after.ahead.eta_s - after.ahead.delay_s, abs=1e-6
        )
        assert 0 <= after.road.lane_index < max(2, after.road.lane_count)
        assert after.standing_s == 0 or after.speed_mps < 0.1
    assert states[-2].ahead.route_left_m < 3.0
    assert {state.road.name for state in states} >= {"Rue du Sud", "Rue de l'Est", "Rue du Nord", "Rue de l'Ouest"}
    traffic.close()


def test_roads_say_what_the_map_says(forked: Forked, hurried: EgoPlan, grid: Scenario) -> None:
    traffic = forked.depart(replace(hurried, trip=grid.trip("tunnel"), driver="average"))
    street = traffic.state
    assert (street.road.name, street.road.road_class) == ("Rue du Nord", "residential")
    assert street.road.limit.mps == pytest.approx(30 / KMH_PER_MPS, abs=0.01)
    assert street.road.limit.source is LimitSource.ASSUMED
    assert (street.road.lit, street.road.built_up, street.road.centre_line) == (True, True, False)
    assert not street.road.in_tunnel
    to_tunnel_m = street.ahead.tunnel_distance_m
    assert to_tunnel_m is not None
    to_tunnel(traffic)
    assert traffic.state.distance_m == pytest.approx(to_tunnel_m, abs=2.0)
    assert traffic.state.ahead.tunnel_distance_m == 0.0
    assert traffic.state.lon_deg == pytest.approx(0.1107, abs=0.002)
    assert traffic.state.lat_deg == pytest.approx(49.4976, abs=0.002)
    assert traffic.state.heading_deg == pytest.approx(92.2, abs=1.0), "grid convergence of UTM"
    traffic.close()


def test_the_leader_is_where_sumo_has_it(in_process: InProcess, hurried: EgoPlan) -> None:
    import libsumo

    traffic = in_process.depart(replace(hurried, driver="average"))
    seen = 0
    for _ in range(600):
        traffic.advance(0.1)
        leader, road = traffic.state.around.leader, traffic.state.road
        if leader is None or libsumo.vehicle.getRoadID(leader.vehicle_id) != road.edge_id:
            continue
        rear_m = libsumo.vehicle.getLanePosition(leader.vehicle_id) - libsumo.vehicle.getLength(leader.vehicle_id)
        assert leader.gap_m == pytest.approx(rear_m - road.lane_position_m, abs=0.1)
        assert leader.speed_mps == libsumo.vehicle.getSpeed(leader.vehicle_id)
        seen += 1
    assert seen > 50


def test_oncoming_vehicles_are_ahead_and_near(in_process: InProcess, hurried: EgoPlan) -> None:
    import libsumo

    traffic = in_process.depart(hurried)
    seen = 0
    for _ in range(100):
        traffic.advance(0.5)
        state = traffic.state
        if state.end is None and (other := state.around.oncoming):
            x_m, y_m = libsumo.vehicle.getPosition(other.vehicle_id)
            east, north = (f(math.radians(state.heading_deg)) for f in (math.sin, math.cos))
            assert (x_m - state.x_m) * east + (y_m - state.y_m) * north > -1.0
            assert math.dist((x_m, y_m), (state.x_m, state.y_m)) == pytest.approx(other.gap_m)
            turned_deg = abs((libsumo.vehicle.getAngle(other.vehicle_id) - state.heading_deg) % 360 - 180)
            assert turned_deg < 100
            assert other.gap_m <= 310
            seen += 1
    assert seen > 20


def test_vehicles_are_counted_as_sumo_counts_them(in_process: InProcess, hurried: EgoPlan) -> None:
    import libsumo

    traffic = in_process.depart(hurried)
    counts = []
    while traffic.advance(1.0).states and traffic.state.end is None:
        assert traffic.state.vehicle_count == libsumo.vehicle.getIDCount()
        counts.append(traffic.state.vehicle_count)
    assert len(set(counts)) > 5


def test_an_ambulance_behind_is_seen(variant: Variant, hurried: EgoPlan) -> None:
    def ambulance(folder: Path) -> None:
        (folder / "grid.rou.xml").write_text("""<routes>
            <vType id="ambulance" vClass="emergency" speedFactor="1.5" maxSpeed="40">
                <param key="has.bluelight.device" value="true"/></vType>
            <vehicle id="help" type="ambulance" depart="75"><route edges="cwc0 c0c1 c1c2 c2c3 c3c4 c4ce"/></vehicle>
            </routes>""")

    simulation = Forked(variant(ambulance), seed=1)
    traffic = simulation.depart(replace(hurried, driver="calm"))
    states = traffic.advance(60.0).states
    seen = [state for state in states if state.around.emergency_behind]
    assert seen
    assert {state.around.emergency_behind.vehicle_id for state in seen if state.around.emergency_behind} == {"help"}
    assert seen[0].time_s > 75
    gaps = [state.around.emergency_behind.gap_m for state in seen if state.around.emergency_behind]
    assert max(gaps) <= 300
    assert gaps[-1] < gaps[0]
    traffic.close()
    simulation.close()


# --- ends -------------------------------------------------------------------------------------------------


def test_arrival(empty: Forked, hurried: EgoPlan) -> None:
    traffic = empty.depart(hurried)
    drive = traffic.advance(600.0)
    assert [state.end for state in drive.states[-2:]] == [None, EgoEnd.ARRIVED]
    assert replace(drive.states[-1], end=None, time_s=drive.states[-2].time_s) == drive.states[-2]
    assert traffic.advance(10.0) == Advance((), ())
    assert traffic.request(SlowDown(30.0)) == Answer(False, "the drive has ended: arrived")
    traffic.close()


def test_collision(in_process: InProcess, hurried: EgoPlan) -> None:
    import libsumo

    drive = _collided(in_process, hurried)
    assert "ego" not in libsumo.vehicle.getIDList()
    assert drive.states[-1].end is EgoEnd.COLLIDED
    assert "ego hits wall" in [event.text for event in drive.events]


@pytest.mark.parametrize("action", ["none", "warn", "teleport"])
def test_a_collision_takes_the_ego_off_the_road_whatever_it_does_to_others(
    action: str, variant: Variant, hurried: EgoPlan
) -> None:
    import libsumo

    simulation = _stated(variant, action)
    try:
        assert _collided(simulation, hurried).states[-1].end is EgoEnd.COLLIDED
        assert simulation.world is not None
        for _ in range(200):
            simulation.world.step()
        assert "ego" not in libsumo.vehicle.getIDList()
    finally:
        simulation.close()


def _stated(variant: Variant, action: str) -> InProcess:
    """The grid with SUMO's own action on collisions."""

    def edit(folder: Path) -> None:
        path = folder / "grid.sumocfg"
        path.write_text(
            path.read_text().replace("<processing>", f'<processing><collision.action value="{action}"/>')
        )

    scenario = open_scenario(variant(edit).config)
    assert scenario.as_stated
    return InProcess(replace(scenario, sumo=replace(scenario.sumo, warm_up_s=10.0)), seed=1)


def test_a_collision_that_lasts_is_told_once(variant: Variant, hurried: EgoPlan) -> None:
    import libsumo

    simulation = _stated(variant, "warn")
    try:
        traffic = simulation.depart(hurried)
        traffic.advance(1.0)
        lane, position_m = traffic.state.road.lane_id, traffic.state.road.lane_position_m
        for name, ahead_m in (("wall", 200.0), ("hitter", 150.0)):
            libsumo.vehicle.add(
                name, "automotive_cosim.ego", departLane=lane[-1], departPos=str(position_m + ahead_m)
            )
            libsumo.vehicle.setLaneChangeMode(name, 0)
            libsumo.vehicle.setSpeedMode(name, 0)
            libsumo.vehicle.setSpeed(name, 0.0)
        libsumo.vehicle.setSpeed("ego", 0.0)
        libsumo.vehicle.setSpeed("hitter", 10.0)
        events = traffic.advance(6.0).events
        libsumo.vehicle.setSpeed("hitter", 0.0)
        libsumo.route.add("short", ["c1c2"])
        libsumo.vehicle.add("passer", "short", departPos="last", departSpeed="max")
        events += traffic.advance(6.0).events
        assert "passer" not in libsumo.vehicle.getIDList()
        assert len(libsumo.simulation.getCollisions()) == 1, "it goes on"
        assert [event.text for event in events if event.kind == "collision"] == ["hitter hits wall"]
    finally:
        simulation.close()


def _collided(simulation: InProcess, plan: EgoPlan) -> Advance:
    """The ego drives into a car that stands."""
    import libsumo

    traffic = simulation.depart(plan)
    traffic.advance(1.0)
    lane, position_m = traffic.state.road.lane_id, traffic.state.road.lane_position_m
    libsumo.vehicle.add("wall", "automotive_cosim.ego", departLane=lane[-1], departPos=str(position_m + 200))
    libsumo.vehicle.setSpeed("wall", 0.0)
    for vehicle in ("ego", "wall"):
        libsumo.vehicle.setLaneChangeMode(vehicle, 0)
    libsumo.vehicle.setSpeedMode("ego", 0)
    libsumo.vehicle.setSpeed("ego", 20.0)
    return traffic.advance(10.0)


def test_removal(in_process: InProcess, hurried: EgoPlan) -> None:
    import libsumo

    traffic = in_process.depart(hurried)
    traffic.advance(1.0)
    libsumo.vehicle.remove("ego")
    assert traffic.advance(10.0).states[-1].end is EgoEnd.REMOVED


def test_teleport(variant: Variant, hurried: EgoPlan) -> None:
    import libsumo

    def impatient(folder: Path) -> None:
        path = folder / "grid.sumocfg"
        path.write_text(path.read_text().replace('time-to-teleport value="300"', 'time-to-teleport value="5"'))
        (folder / "grid.rou.xml").write_text("<routes/>")

    simulation = InProcess(variant(impatient), seed=1)
    try:
        traffic = simulation.depart(hurried)
        libsumo.vehicle.setSpeed("ego", 0.0)
        drive = traffic.advance(60.0)
        assert drive.states[-1].end is EgoEnd.TELEPORTED
        assert [event.kind for event in drive.events] == ["teleport"]
    finally:
        simulation.close()


# --- the driver -------------------------------------------------------------------------------------------


def test_a_hurried_driver_holds_eighty_in_a_fifty(empty: Forked, hurried: EgoPlan) -> None:
    traffic = at_speed(empty, hurried, 78.0)
    driven = speeds_kmh(traffic.advance(8.0))
    assert min(driven) > 78.0
    assert max(driven) < 84.0
    assert traffic.state.road.limit.mps == pytest.approx(50 / KMH_PER_MPS, abs=0.01)
    traffic.close()


def test_an_alert_slows_the_driver_for_good(empty: Forked, hurried: EgoPlan) -> None:
    traffic = at_speed(empty, hurried, 79.0)
    warned_s = traffic.state.time_s
    assert traffic.request(Alert(AlertKind.SPEED)).accepted
    drive = traffic.advance(15.0)
    (slows,) = [event for event in drive.events if event.kind == "driver_slows"]
    assert 0.3 < slows.time_s - warned_s < 3.0
    assert slows.text == f"driver slows to 50 km/h, {slows.time_s - warned_s:.1f} s after the alert"
    before = [state for state in drive.states if state.time_s <= slows.time_s]
    assert min(state.speed_mps for state in before) * KMH_PER_MPS > 77.0
    assert min(state.acceleration_mps2 for state in drive.states) > -2.5, "smoothly"
    assert speeds_kmh(drive)[-1] == pytest.approx(50.0, abs=1.0)
    afterwards = traffic.advance(300.0)
    limits_kmh = [(state.road.limit.mps or math.inf) * KMH_PER_MPS for state in afterwards.states]
    assert all(speed <= limit + 0.5 for speed, limit in zip(speeds_kmh(afterwards), limits_kmh, strict=True))
    assert traffic.state.end is EgoEnd.ARRIVED
    traffic.close()


def test_who_is_not_warned_goes_on(empty: Forked, hurried: EgoPlan) -> None:
    warned = at_speed(empty, hurried, 79.0)
    idle = warned.branch()
    warned.request(Alert(AlertKind.SPEED))
    assert warned.advance(10.0).states[-1].speed_mps < idle.advance(10.0).states[-1].speed_mps - 5.0
    warned.close()
    idle.close()


def test_a_critical_alert_brakes_harder(empty: Forked, hurried: EgoPlan) -> None:
    soft = at_speed(empty, hurried, 79.0)
    hard = soft.branch()
    soft.request(Alert(AlertKind.SPEED, Severity.WARNING, speed_kmh=30.0))
    hard.request(Alert(AlertKind.SPEED, Severity.CRITICAL, speed_kmh=30.0))
    slowest = [min(state.acceleration_mps2 for state in drive.advance(12.0).states) for drive in (soft, hard)]
    assert slowest[1] < slowest[0] - 0.5
    assert speeds_kmh(hard.advance(0.1))[0] == pytest.approx(30.0, abs=1.5)
    soft.close()
    hard.close()


def test_compliance_and_reaction_are_drawn_from_the_plan(empty: Forked, hurried: EgoPlan) -> None:
    reactions = set()
    for seed in range(25):
        traffic = empty.depart(replace(hurried, driver="drowsy", seed=seed))
        traffic.request(Alert(AlertKind.SPEED))
        (event,) = traffic.advance(10.0).events
        reactions.add((event.kind == "driver_ignores", round(event.time_s - 60.1, 1)))
        traffic.close()
    assert {ignores for ignores, _ in reactions} == {True, False}
    assert len({delay_s for _, delay_s in reactions}) > 5


def test_requests_hold(empty: Forked, hurried: EgoPlan) -> None:
    traffic = at_speed(empty, hurried, 79.0)
    assert traffic.request(Cruise(60.0)) == Answer(True, "The car will go no faster than 60 km/h")
    assert speeds_kmh(traffic.advance(9.0))[-1] == pytest.approx(60.0, abs=1.0)
    assert traffic.request(SlowDown(40.0)).accepted
    assert speeds_kmh(traffic.advance(9.0))[-1] == pytest.approx(40.0, abs=1.0)
    assert traffic.request(Hazards(True)).accepted
    assert traffic.advance(0.1).states[-1].hazard_lights
    traffic.request(Hazards(False))
    assert not traffic.advance(0.1).states[-1].hazard_lights
    traffic.close()


def test_pulling_over_stops_beside_the_lane(forked: Forked, hurried: EgoPlan) -> None:
    traffic = at_speed(forked, hurried, 40.0)
    assert traffic.request(PullOver()).accepted
    drive = traffic.advance(120.0)
    assert traffic.state.standing_s > 20.0
    assert "driver_pulls_over" in {event.kind for event in drive.events}
    assert traffic.state.road.lane_index == 0
    assert min(state.acceleration_mps2 for state in drive.states) > -5.0
    where = traffic.state.distance_m
    assert traffic.advance(400.0).states[-1].distance_m == where, "neither driving on nor teleported"
    assert traffic.state.end is None
    traffic.close()


def test_dangerous_requests_are_refused(empty: Forked, hurried: EgoPlan, grid: Scenario) -> None:
    traffic = empty.depart(replace(hurried, trip=grid.trip("tunnel")))
    to_tunnel(traffic)
    answers = {
        request: traffic.request(request)
        for request in (PullOver(), SlowDown(0.0), SlowDown(math.nan), Cruise(-5.0), Reroute("Rue de Rivoli"))
    }
    assert not any(answer.accepted for answer in answers.values())
    assert "tunnel" in answers[PullOver()].reason
    assert "Rue de Rivoli" in answers[Reroute("Rue de Rivoli")].reason
    traffic.close()


def test_a_reroute_changes_the_way(empty: Forked, hurried: EgoPlan) -> None:
    traffic = at_speed(empty, replace(hurried, driver="average"), 45.0)
    while traffic.state.road.edge_id.startswith(":"):
        assert "junction" in traffic.request(Reroute("Rue du Nord")).reason
        traffic.advance(0.1)
    assert traffic.request(Reroute("Rue du Nord")).accepted
    assert traffic.state.ahead.route_edges[-1] == "c4ce", "the state is that before the request"
    traffic.advance(0.1)
    assert traffic.state.ahead.route_edges[-1] != "c4ce"
    assert "Rue du Nord" in {state.road.name for state in traffic.advance(200.0).states}
    traffic.close()


def test_a_given_route_is_checked_piece_by_piece(empty: Forked, hurried: EgoPlan) -> None:
    traffic = empty.depart(hurried)
    assert traffic.state.road.edge_id == "cwc0"
    for edges, said in (
        (("c0c1", "c1c2"), "must begin where the car is"),
        (("cwc0", "n3n4"), "no route from 'cwc0' to 'n3n4'"),
        (("cwc0", "elsewhere"), "no edge 'elsewhere'"),
    ):
        answer = traffic.request(Reroute(edges=edges))
        assert not answer.accepted
        assert said in answer.reason
    way = ("cwc0", "c0s0", "s0sw")
    assert traffic.request(Reroute(edges=way)).accepted
    states = traffic.advance(300.0).states
    assert traffic.state.end is EgoEnd.ARRIVED
    assert {state.road.edge_id for state in states if not state.road.edge_id.startswith(":")} == set(way)
    traffic.close()


def test_a_turn_that_is_too_near_is_not_taken(empty: Forked, hurried: EgoPlan) -> None:
    """A few metres before the junction the next edge stays, whatever the new goal."""
    traffic = empty.depart(hurried)
    while traffic.state.road.edge_id != "c0c1" or traffic.state.road.lane_position_m < 160.0:
        traffic.advance(0.1)
    assert not traffic.request(Reroute(edges=("c0c1", "c1n1"))).accepted
    assert traffic.request(Reroute("n1c1")).accepted
    traffic.advance(0.1)
    assert traffic.state.ahead.route_edges[:2] == ("c0c1", "c1c2")
    traffic.close()


def test_nobody_corners_at_the_speed_of_the_straight(empty: Forked, hurried: EgoPlan, grid: Scenario) -> None:
    peaks = []
    for driver in ("average", "hurried"):
        traffic = empty.depart(replace(hurried, trip=grid.trip("round"), driver=driver))
        states = traffic.advance(600.0).states
        inside = [pair for pair in pairwise(states) if pair[0].road.edge_id == pair[1].road.edge_id]
        peaks.append(max(sideways_mps2(*pair) for pair in inside if pair[0].road.edge_id.startswith(":")))
        traffic.close()
    assert peaks[1] < 1.3 * peaks[0]


def test_the_drive_that_arrives_as_congestion_is_sampled_ends_as_an_arrival(forked: Forked) -> None:
    """It leaves the network in the very step in which the network's speeds are sampled."""
    plan = EgoPlan(Trip("out", "c4ce", "c4ce"), seed=1)
    with closing(forked.depart(plan)) as early:
        arrives_s = early.advance(60.0).states[-1].time_s
    with closing(forked.depart(replace(plan, wait_s=-arrives_s % SAMPLE_PERIOD_S))) as traffic:
        last = traffic.advance(60.0).states[-1]
    assert last.time_s % SAMPLE_PERIOD_S == pytest.approx(0.0, abs=1e-6)
    assert last.end is EgoEnd.ARRIVED


def test_congestion_goes_by_vehicles_and_not_by_lanes(in_process: InProcess, hurried: EgoPlan) -> None:
    """SUMO's own mean of an edge takes its empty lanes for free flow; nobody drives in those."""
    import libsumo

    traffic, diluted = in_process.depart(hurried), 0
    for _ in range(12):
        traffic.advance(5.0)
        found: dict[str, list[float]] = {}
        for lane_id, speed_mps, _ in load_library().on_lanes((), {}, {}):
            found.setdefault(lane_id.rpartition("_")[0], []).append(speed_mps)
        for edge_id in libsumo.edge.getIDList():
            own = [libsumo.vehicle.getSpeed(vehicle) for vehicle in libsumo.edge.getLastStepVehicleIDs(edge_id)]
            assert sorted(found.get(edge_id, [])) == sorted(own), edge_id
            diluted += bool(own) and libsumo.edge.getLastStepMeanSpeed(edge_id) > max(own) + 1.0
    assert diluted, "nowhere would it have mattered"
