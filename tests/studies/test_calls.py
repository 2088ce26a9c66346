"""What studies call in the process of a simulation, against SUMO itself."""

from dataclasses import replace
from pathlib import Path

import pytest

from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.incidents import Breakdown, Roadworks
from automotive_cosim.studies.calls.divert import divert
from automotive_cosim.studies.calls.flow import SignalControl, flow, take
from automotive_cosim.studies.calls.ledger import Ledger, own_choice
from automotive_cosim.traffic.running import Running
from automotive_cosim.traffic.sumo import EGO, load_library
from tests.traffic.test_beside_sumo import (
    CARS,
    CRAWLERS,
    FIRST,
    LAST,
    LINE,
    QUICK,
    RAILS,
    SLOW,
    TRAINS,
    Road,
    depart,
    running,
)

pytestmark = pytest.mark.sumo


def test_a_rail_crossing_is_no_signal_to_control(tmp_path: Path) -> None:
    scenario = Road(LINE + RAILS, TRAINS + CARS, nodes={"c": 'type="rail_crossing"'}).opened(tmp_path)
    with running(scenario) as (_, world, libsumo):
        before = libsumo.trafficlight.getProgram("c")
        with pytest.raises(ScenarioError, match="no signals to control"):
            take(Running(world), SignalControl(control="static"), 0)
        assert libsumo.trafficlight.getProgram("c") == before


def test_the_choice_of_sumos_device_sees_the_traffic_though_nobody_has_one(tmp_path: Path) -> None:
    scenario = Road(FIRST + LAST + QUICK + SLOW, CRAWLERS).opened(tmp_path, warm_up_s=300.0)
    with running(scenario) as (_, world, libsumo):
        world.prepare_copies()
        depart(world, scenario)
        assert libsumo.vehicle.getRoute(EGO)[1] == "q1"
        libsumo.vehicle.rerouteTraveltime(EGO, False)
        assert libsumo.vehicle.getRoute(EGO)[1] == "q1", "of SUMO"
        assert own_choice(Running(world))[1] == "s1"


def test_cars_that_are_told_to_take_another_way_keep_it(tmp_path: Path) -> None:
    """SUMO's device turns back at its next period who was given a slower way."""
    road = Road(FIRST.replace("25", "10") + LAST + QUICK + SLOW, CARS.replace("e2", "q1 q2"))
    with running(replace(road.opened(tmp_path, rerouting=1.0), as_stated=False)) as (_, world, libsumo):
        other = max(libsumo.vehicle.getIDList(), key=libsumo.vehicle.getDeparture)
        libsumo.vehicle.setRoute(other, ("e1", "s1", "s2", "e3"))
        took, could = divert(Running(world), ("e1", "q1", "q2", "e3"), ("e1", "s1", "s2", "e3"), 1.0, 0)
        assert len(took) == could > 1
        for _ in range(75):
            world.step()
        assert libsumo.vehicle.getRoute(other)[1] == "q1", "of SUMO"
        assert {libsumo.vehicle.getRoute(each)[1] for each in took if each in libsumo.vehicle.getIDList()} == {"s1"}


def test_a_queue_is_as_long_as_those_who_wait(tmp_path: Path) -> None:
    """SUMO's queue output counts from the end of the lane: over the free road before a breakdown too."""
    scenario = Road().opened(tmp_path, warm_up_s=100.0)
    with running(scenario) as (_, world, libsumo):
        world.stage(Breakdown(edge="e2", position_m=100.0))
        for _ in range(120):
            world.step()
        found = Ledger(load_library(), 1.0).queues_m()
        waiting = [each for each in libsumo.vehicle.getIDList() if libsumo.vehicle.getWaitingTime(each) > 0]
        assert len(waiting) > 2
        assert found == {"e2_0": 7.5 * len(waiting)}


@pytest.mark.parametrize(("stop", "stood_s"), [('parking="true" ', 0.0), ("", 60.0)])
def test_who_stands_at_a_stop_is_no_queue_and_loses_no_time(stop: str, stood_s: float, tmp_path: Path) -> None:
    """SUMO's time loss and waiting time leave stops out; those who stand behind in the lane wait."""
    bus = (
        '<vehicle id="bus" depart="5" departSpeed="max"><route edges="e2 e3"/>'
        f'<stop lane="e2_0" endPos="600" duration="999" {stop}/></vehicle>'
    )
    with running(Road(routes=CARS + bus).opened(tmp_path, warm_up_s=100.0)) as (_, world, libsumo):
        world.stage(Roadworks(edge="e2", limit_kmh=45))
        copy = Running(world)
        copy.watchers.append(Ledger(load_library(), 1.0))
        _, found = flow(copy, 60.0, 60.0)
        assert libsumo.vehicle.isStopped("bus")
        assert found.slowed["e2"] == (0.5, stood_s)
        waiting = [each for each in libsumo.vehicle.getIDList() if libsumo.vehicle.getWaitingTime(each) > 0]
        assert bool(waiting) is bool(stood_s)
        assert found.queues[-1] == ({"e2_0": 7.5 * len(waiting)} if waiting else {})
        assert "bus" not in waiting


def test_who_collides_has_not_arrived(tmp_path: Path) -> None:
    """SUMO lists both among those that have arrived."""
    with running(replace(Road().opened(tmp_path), as_stated=False)) as (_, world, libsumo):
        ledger = Ledger(load_library(), 1.0)
        front, rear, *_ = sorted(libsumo.vehicle.getIDList(), key=libsumo.vehicle.getDistance, reverse=True)[1:]
        libsumo.vehicle.setSpeed(front, 0)
        libsumo.vehicle.setSpeedMode(rear, 0)
        libsumo.vehicle.setSpeed(rear, 25)
        arrived: set[str] = set()
        for _ in range(80):
            world.step()
            ledger.after_step()
            arrived |= set(libsumo.simulation.getArrivedIDList())
        assert {front, rear} <= arrived, "of SUMO"
        assert not {front, rear} & ledger.arrivals_s.keys()
        assert ledger.summary().collided == 2


def test_who_is_removed_by_a_calibrator_has_not_arrived(tmp_path: Path) -> None:
    """SUMO lists them among those that have arrived, one step after they have gone."""
    calibrator = '<calibrator id="k" edge="e2" pos="0" freq="60"><flow begin="0" end="999" vehsPerHour="60"'
    route = '<route id="r" edges="e2 e3"/>'
    road = Road(routes=CARS.replace('"20"', '"10"'), more=f'{route}{calibrator} route="r"/></calibrator>')
    with running(road.opened(tmp_path)) as (_, world, libsumo):
        ledger, listed, last = Ledger(load_library(), 1.0), set(), {}
        for _ in range(200):
            last |= {each: libsumo.vehicle.getRoadID(each) for each in libsumo.vehicle.getIDList()}
            world.step()
            ledger.after_step()
            listed |= set(libsumo.simulation.getArrivedIDList())
    arrived = {each for each in listed if last[each] == "e3"}
    assert len(listed - arrived) > 5, "of SUMO"
    assert ledger.arrivals_s.keys() == arrived
    assert arrived
