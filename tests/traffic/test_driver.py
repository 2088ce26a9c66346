"""The driver's profiles, and how it makes room for others when told."""

import math
import shutil
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim.contracts import (
    KMH_PER_MPS,
    MPH_PER_MPS,
    Alert,
    AlertKind,
    DrivingState,
    IncidentKind,
    PullOver,
    RoadRequest,
    Severity,
    SlowDown,
)
from automotive_cosim.formats.incidents import Breakdown, EmergencyVehicle
from automotive_cosim.scenarios import Scenario, Trip, load
from automotive_cosim.traffic.base import Advance, DriverAt, EgoPlan, HaltAt, Traffic
from automotive_cosim.traffic.ego import DRIVES_ON, PARKS, PASS_SHARE, RELEASED, SETS_OFF
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.profiles import PROFILES
from automotive_cosim.traffic.road_weather import COMFORTABLE_MPS2
from tests.scripted.traffic import Scripted, Stretch
from tests.traffic.in_process import InProcess

Variant = Callable[[Callable[[Path], None]], Scenario]

SOUTH = Trip("south", "sws0", "s4se")
"""One lane."""

AMBULANCE = '\n[[incidents]]\nkind = "emergency"\nat_m = 260.0\nbehind_m = 200.0\n'


@pytest.fixture(scope="module")
def quiet(sumo: None, grid: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Forked]:
    """The grid with an ambulance behind the ego and nobody else."""
    folder = tmp_path_factory.mktemp("quiet") / "grid"
    shutil.copytree(grid.folder, folder)
    (folder / "grid.rou.xml").write_text("<routes/>")
    path = folder / "scenario.toml"
    path.write_text(path.read_text() + AMBULANCE)
    simulation = Forked(load(folder), seed=1)
    yield simulation
    simulation.close()


def warned(simulation: Forked, plan: EgoPlan, kind: AlertKind, after_m: float = 300.0) -> tuple[Traffic, Advance]:
    """Told after some way; drives on for a minute."""
    traffic = simulation.depart(plan)
    while traffic.state.distance_m < after_m:
        assert traffic.advance(0.1).states
    assert traffic.request(Alert(kind)).accepted
    return traffic, traffic.advance(60.0)


def kinds(drive: Advance) -> set[str]:
    return {event.kind for event in drive.events}


def is_past(states: tuple[DrivingState, ...]) -> bool:
    """Whether the ambulance was behind, then ahead."""
    behind = [state.around.emergency_behind is not None for state in states]
    ahead = [state.around.leader is not None and "ambulance" in state.around.leader.vehicle_id for state in states]
    return any(behind) and any(ahead[behind.index(True) :])


def needed_mps2(state: DrivingState) -> float:
    """Deceleration with which the car stops behind a vehicle ahead that stands; 0 without one."""
    leader = state.around.leader
    stands = leader is not None and leader.speed_mps < 0.1
    return state.speed_mps**2 / (2 * max(0.1, leader.gap_m)) if leader is not None and stands else 0.0


@pytest.mark.parametrize("driver", [name for name in PROFILES if name not in ("pressing", "tailgating")])
@pytest.mark.parametrize("with_ambulance", [False, True])
def test_nobody_closes_at_speed_on_what_stands(
    quiet: Forked, hurried: EgoPlan, driver: str, with_ambulance: bool
) -> None:
    """A driver on a drive brakes as comfortably as most people do (AASHTO: 3.4 m/s2), also before blue light."""
    stands = Breakdown(edge="s3s4", position_m=150.0, to_s=600.0)
    comes = (EmergencyVehicle(behind_m=60.0),) if with_ambulance else ()
    plan = replace(hurried, trip=SOUTH, driver=driver, brakes_early=True, incidents=(stands, *comes))
    with closing(quiet.depart(plan)) as traffic:
        states = traffic.advance(100.0).states
    assert any(needed_mps2(state) > 0 for state in states)
    assert max(map(needed_mps2, states)) <= COMFORTABLE_MPS2
    assert states[-1].end is None
    assert states[-1].speed_mps < 0.1


def test_whoever_gives_way_is_overtaken_on_a_single_lane(quiet: Forked, hurried: EgoPlan) -> None:
    plan = replace(hurried, trip=SOUTH, driver="calm")
    traffic, drive = warned(quiet, plan, AlertKind.YIELD)
    assert "driver_gives_way" in kinds(drive)
    assert min(state.speed_mps for state in drive.states) < 0.1
    assert is_past(drive.states)
    assert drive.states[-1].speed_mps > 5.0 or drive.states[-1].end is not None, "it drives on"
    traffic.close()
    with closing(quiet.depart(plan)) as idle:
        assert not is_past(idle.advance(90.0).states)


def test_giving_way_on_two_lanes_is_the_kerb_lane(quiet: Forked, hurried: EgoPlan) -> None:
    plan = replace(hurried, driver="calm")
    traffic, drive = warned(quiet, plan, AlertKind.YIELD)
    assert "driver_gives_way" in kinds(drive)
    assert {state.road.lane_index for state in drive.states[50:100]} == {0}
    assert min(state.speed_mps for state in drive.states[:100]) > 5.0
    assert is_past(drive.states)
    traffic.close()


def test_moving_over_leaves_the_kerb_or_slows_down(quiet: Forked, hurried: EgoPlan) -> None:
    plan = replace(hurried, driver="calm")
    traffic, drive = warned(quiet, plan, AlertKind.MOVE_OVER, 40.0)
    assert "driver_moves_over" in kinds(drive)
    assert 1 in {state.road.lane_index for state in drive.states[:150]}
    traffic.close()
    traffic, drive = warned(quiet, replace(plan, trip=SOUTH), AlertKind.MOVE_OVER, 40.0)
    assert "driver_slows" in kinds(drive)
    slow_kmh = 50.0 - 20.0 / MPH_PER_MPS * KMH_PER_MPS
    assert min(state.speed_mps for state in drive.states[:200]) * KMH_PER_MPS == pytest.approx(slow_kmh, abs=1.5)
    traffic.close()


def test_who_cannot_move_over_slows_down_shortly_before_it_and_goes_on_after_it() -> None:
    road = [Stretch("A", 500.0, 40.0), Stretch("B", 300.0, 40.0, incident=IncidentKind.BREAKDOWN)]
    with closing(Scripted(road, start_speed_kmh=40.0).depart(WATCHED)) as traffic:
        traffic.advance(10.0)
        traffic.request(Alert(AlertKind.MOVE_OVER))
        drive = traffic.advance(60.0)
    kmh = {round(state.distance_m): state.speed_mps * KMH_PER_MPS for state in drive.states}
    assert kmh[400] == pytest.approx(kmh[200], abs=1.0), "nobody slows down 100 m before it"
    assert kmh[498] == pytest.approx(40.0 * PASS_SHARE, abs=1.0)
    assert kmh[600] == pytest.approx(kmh[200], abs=1.0)
    assert [event.kind for event in drive.events] == ["driver_slows", RELEASED]


def test_a_speed_for_a_place_is_driven_from_there_on_and_as_long_as_it_lasts() -> None:
    """A zone of five minutes, entered by a driver who gets hurried in it."""
    road = [Stretch("A", 500.0, 50.0), Stretch("B", 2000.0, 30.0), Stretch("C", 900.0, 50.0)]
    plan = replace(WATCHED, moods=(DriverAt(80.0, "hurried"),))
    with closing(Scripted(road, start_speed_kmh=50.0).depart(plan)) as traffic:
        traffic.request(Alert(AlertKind.SPEED, speed_kmh=30.0))
        drive = traffic.advance(330.0)
    kmh = {round(state.distance_m): state.speed_mps * KMH_PER_MPS for state in drive.states}
    assert kmh[350] > 45.0
    assert max(kmh.get(at_m, 0.0) for at_m in range(505, 2490)) < 31.0
    (release,) = (event for event in drive.events if event.kind == RELEASED)
    assert release.text == "driver drives as before; what it was advised for is passed"
    assert max(kmh.values()) > 51.0


def test_advice_for_ice_holds_as_long_as_the_ice() -> None:
    icy = [Stretch(str(count), 1000.0, limit, friction=0.2) for count, limit in enumerate((80.0, 100.0, 80.0))]
    with closing(Scripted([*icy, Stretch("dry", 3000.0, 80.0)], start_speed_kmh=60.0).depart(WATCHED)) as traffic:
        traffic.request(Alert(AlertKind.SLIPPERY, speed_kmh=40.0))
        drive = traffic.advance(330.0)
    (release,) = (event for event in drive.events if event.kind == RELEASED)
    there = next(state for state in drive.states if state.time_s >= release.time_s)
    assert there.distance_m == pytest.approx(3000.0, abs=20.0)
    assert release.time_s > 200.0


def test_a_speed_for_a_jam_ends_with_it() -> None:
    road = [Stretch("A", 400.0, 50.0), Stretch("B", 200.0, 50.0, relative_speed=0.2), Stretch("C", 3000.0, 50.0)]
    with closing(Scripted(road, start_speed_kmh=50.0).depart(WATCHED)) as traffic:
        traffic.request(Alert(AlertKind.TRAFFIC, speed_kmh=20.0))
        drive = traffic.advance(110.0)
    (release,) = (event for event in drive.events if event.kind == RELEASED)
    there = next(state for state in drive.states if state.time_s >= release.time_s)
    assert 600.0 <= there.distance_m <= 640.0


@pytest.mark.sumo
@pytest.mark.parametrize(("lane", "side"), [(0, -1), (1, 1)])
def test_a_corridor_opens_between_the_lanes(variant: Variant, hurried: EgoPlan, lane: int, side: int) -> None:
    """With sublanes the car goes to the outer edge of its lane, and back to the middle afterwards."""
    import libsumo

    def sublanes(folder: Path) -> None:
        (folder / "grid.rou.xml").write_text("<routes/>")
        path = folder / "scenario.toml"
        path.write_text(path.read_text().replace("[ego]", "lateral_resolution_m = 0.8\n\n[ego]", 1))

    with closing(InProcess(variant(sublanes), seed=1)) as simulation:
        traffic = simulation.depart(replace(hurried, driver="calm"))
        traffic.advance(1.0)
        libsumo.vehicle.setParameter("ego", "laneChangeModel.lcKeepRight", "0")
        libsumo.vehicle.changeLane("ego", lane, 3.0)
        traffic.advance(6.0)
        assert traffic.state.road.lane_index == lane
        before_m = libsumo.vehicle.getLateralLanePosition("ego")
        traffic.request(Alert(AlertKind.CORRIDOR))
        drive = traffic.advance(10.0)
        assert "driver_makes_corridor" in kinds(drive)
        moved_m = libsumo.vehicle.getLateralLanePosition("ego") - before_m
        assert moved_m * side > 0.3
        assert traffic.state.road.lane_index == lane


def test_on_a_scripted_road_one_stops_to_give_way_and_goes_on() -> None:
    road = Scripted([Stretch("street", 2000.0, 50.0)], start_speed_kmh=50.0)
    traffic = road.depart(EgoPlan(SOUTH, "calm", 1))
    traffic.request(Alert(AlertKind.YIELD))
    states = traffic.advance(60.0).states
    standing_s = sum(state.speed_mps < 0.1 for state in states) * 0.1
    assert standing_s == pytest.approx(12.0, abs=1.0)
    assert states[-1].speed_mps > 10.0


def test_a_planned_halt_parks_off_the_motorway_and_goes_on() -> None:
    road = Scripted(
        [Stretch("motorway", 1500.0, 100.0, road_class="motorway"), Stretch("street", 2000.0, 50.0)],
        start_speed_kmh=100.0,
    )
    drive = road.depart(replace(EgoPlan(SOUTH, "calm", 1), halts=(HaltAt(20.0, 30.0),))).advance(180.0)
    parks, sets_off = (event for event in drive.events if event.kind in (PARKS, SETS_OFF))
    assert (parks.kind, sets_off.kind) == (PARKS, SETS_OFF)
    standing = [state for state in drive.states if state.speed_mps < 0.1]
    assert {state.road.name for state in standing} == {"street"}
    assert standing[0].time_s == pytest.approx(parks.time_s, abs=1.0)
    assert sets_off.time_s - parks.time_s == pytest.approx(30.0)
    assert standing[-1].time_s == pytest.approx(sets_off.time_s, abs=2.0)
    assert drive.states[-1].speed_mps > 10.0


# --- profiles ---------------------------------------------------------------------------------------------


def test_profiles_differ_in_speed_and_gap(forked: Forked, hurried: EgoPlan) -> None:
    speeds, gaps = {}, {}
    for name in PROFILES:
        with closing(forked.depart(replace(hurried, driver=name))) as traffic:
            traffic.advance(15.0)
            states = traffic.advance(100.0).states
        speeds[name] = max(state.speed_mps for state in states) * KMH_PER_MPS
        following = [
            state.around.leader.gap_m / state.speed_mps
            for state in states
            if state.around.leader and state.speed_mps > 8.0 and state.around.leader.gap_m < 40.0
        ]
        gaps[name] = min(following, default=9.0)
    assert speeds["calm"] < speeds["average"] + 0.5 < speeds["tailgating"] < speeds["hurried"]
    assert speeds["calm"] < 49.0
    assert gaps["tailgating"] < 1.0 < gaps["calm"]


WATCHED = replace(EgoPlan(SOUTH, "calm", 1), advice_s=120.0)
"""A driver of a drive, on whom advice lasts two minutes."""


def on_a_street(plan: EgoPlan = WATCHED, metres: float = 8000.0) -> Traffic:
    """A scripted street of 50 km/h."""
    return Scripted([Stretch("street", metres, 50.0)], start_speed_kmh=50.0).depart(plan)


def test_a_request_to_go_slower_ends_by_itself_and_the_release_is_told() -> None:
    traffic = on_a_street()
    traffic.request(SlowDown(20.0))
    drive = traffic.advance(180.0)
    slow = [state.time_s for state in drive.states if state.speed_mps * KMH_PER_MPS < 22.0]
    (release,) = (event for event in drive.events if event.kind == RELEASED)
    assert release.time_s == pytest.approx(120.0, abs=3.0)
    assert slow[-1] == pytest.approx(release.time_s, abs=2.0)
    assert drive.states[-1].speed_mps * KMH_PER_MPS > 40.0


def test_another_mood_ends_what_was_advised_and_the_release_is_told() -> None:
    traffic = on_a_street(replace(WATCHED, moods=(DriverAt(20.0, "hurried"),)))
    traffic.request(Alert(AlertKind.SPEED, speed_kmh=30.0))
    drive = traffic.advance(60.0)
    (release,) = (event for event in drive.events if event.kind == RELEASED)
    assert release.time_s == pytest.approx(20.0, abs=1.0)
    assert drive.states[-1].speed_mps * KMH_PER_MPS > 60.0


def test_an_advised_speed_ends_at_the_next_limit_and_its_end_is_told() -> None:
    streets = [Stretch("a", 400.0, 50.0), Stretch("b", 4000.0, 70.0)]
    traffic = Scripted(streets, start_speed_kmh=50.0).depart(WATCHED)
    traffic.request(Alert(AlertKind.SPEED, speed_kmh=30.0))
    drive = traffic.advance(90.0)
    told = [event.text for event in drive.events if "the advised speed has ended" in event.text]
    assert told == ["driver goes no faster than the limit; the advised speed has ended"]
    assert drive.states[-1].speed_mps * KMH_PER_MPS > 60.0


def test_nobody_gives_way_by_a_stop_far_beyond_a_tunnel() -> None:
    tube = [Stretch("tube", 3000.0, 80.0, in_tunnel=True), Stretch("open", 3000.0, 80.0)]
    traffic = Scripted(tube, start_speed_kmh=80.0).depart(WATCHED)
    traffic.request(Alert(AlertKind.YIELD))
    assert "driver_cannot_stop" in kinds(traffic.advance(10.0))


def test_a_request_for_the_limit_takes_advice_back() -> None:
    traffic = on_a_street()
    traffic.request(SlowDown(20.0))
    traffic.advance(30.0)
    traffic.request(SlowDown(50.0))
    drive = traffic.advance(30.0)
    (release,) = (event for event in drive.events if event.kind == RELEASED)
    assert "advice taken back" in release.text
    assert drive.states[-1].speed_mps * KMH_PER_MPS > 40.0


def test_a_request_for_the_limit_slows_a_driver_who_is_faster() -> None:
    speeding = Scripted([Stretch("street", 8000.0, 50.0)], start_speed_kmh=70.0).depart(
        replace(WATCHED, driver="hurried", seed=2)
    )
    before = speeding.advance(20.0).states[-1].speed_mps * KMH_PER_MPS
    speeding.request(SlowDown(50.0))
    drive = speeding.advance(20.0)
    assert before > 55.0 > 51.0 > drive.states[-1].speed_mps * KMH_PER_MPS
    assert RELEASED not in kinds(drive)


@pytest.mark.parametrize(
    "request_", [PullOver(), Alert(AlertKind.VEHICLE, Severity.CRITICAL)], ids=["asked", "red"]
)
def test_a_driver_who_is_told_to_stop_stops_and_drives_on(request_: RoadRequest) -> None:
    traffic = on_a_street()
    traffic.request(request_)
    drive = traffic.advance(240.0)
    standing_s = sum(state.speed_mps < 0.1 for state in drive.states) * 0.1
    assert standing_s == pytest.approx(120.0, abs=3.0)
    assert {"driver_pulls_over", DRIVES_ON} <= kinds(drive)
    assert drive.states[-1].speed_mps > 10.0


def test_in_a_task_a_request_lasts_for_good() -> None:
    traffic = on_a_street(replace(WATCHED, advice_s=math.inf))
    traffic.request(SlowDown(20.0))
    drive = traffic.advance(240.0)
    assert RELEASED not in kinds(drive)
    assert drive.states[-1].speed_mps * KMH_PER_MPS < 22.0
