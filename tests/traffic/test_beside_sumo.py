"""What of SUMO decides what the ego is told, and what SUMO does when it is asked: each row against SUMO itself.

Every row was seen in SUMO 1.28.0. One that fails with another version tells what that version does differently.
"""

import xml.etree.ElementTree as ET
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, field, replace
from datetime import time
from pathlib import Path
from typing import Any

import pytest

from automotive_cosim.contracts import DrivingState
from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.incidents import Closure, EmergencyVehicle, Roadworks, SchoolZone
from automotive_cosim.scenarios import Scenario, open_scenario
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.ego_loop import EgoLoop
from automotive_cosim.traffic.sumo import EGO
from automotive_cosim.traffic.world import World
from tests.traffic.in_process import InProcess

pytestmark = pytest.mark.sumo

NODES = {
    **{"a": (0, 0), "b": (800, 0), "c": (2000, 0), "d": (2800, 0)},
    **{"q": (1400, 300), "s": (1400, -300), "north": (2000, 300), "south": (2000, -300)},
}
CAR = '<vType id="car" sigma="0" speedFactor="1" speedDev="0"/>'
CARS = CAR + '<flow id="car" type="car" end="9999" period="20" departSpeed="max"><route edges="e1 e2 e3"/></flow>'
FIRST, LAST = '<edge id="e1" from="a" to="b" speed="25"/>', '<edge id="e3" from="c" to="d" speed="25"/>'
MIDDLE = '<edge id="e2" from="b" to="c" speed="25"/>'
LINE = FIRST + MIDDLE + LAST
QUICK = '<edge id="q1" from="b" to="q" speed="20"/><edge id="q2" from="q" to="c" speed="20"/>'
SLOW = '<edge id="s1" from="b" to="s" speed="12"/><edge id="s2" from="s" to="c" speed="12"/>'
LIMITED = '<types><type id="own" speed="{}"><restriction vClass="passenger" speed="{}"/></type></types>'
SIGN = '<variableSpeedSign id="v" lanes="{}">{}</variableSpeedSign>'
STEP = '<step time="{}" speed="{}"/>'


@dataclass(frozen=True)
class Road:
    """A network with its demand."""

    edges: str = LINE
    routes: str = CARS
    more: str = ""
    """Additional elements."""
    types: str = ""
    nodes: Mapping[str, str] = field(default_factory=dict)
    """Types of nodes."""
    options: tuple[str, ...] = ()
    """Of netconvert."""
    files: Mapping[str, str] = field(default_factory=dict)
    """Those that the additional file includes."""

    def opened(self, folder: Path, warm_up_s: float = 200.0, rerouting: float = 0.0) -> Scenario:
        """Writes it, and opens it as a scenario."""
        nodes = "".join(
            f'<node id="{name}" x="{x}" y="{y}" {self.nodes.get(name, "")}/>' for name, (x, y) in NODES.items()
        )
        (folder / "n.nod.xml").write_text(f"<nodes>{nodes}</nodes>")
        (folder / "n.edg.xml").write_text(f"<edges>{self.edges}</edges>")
        (folder / "n.typ.xml").write_text(self.types or "<types/>")
        plain: list[str | Path] = ["-n", folder / "n.nod.xml", "-e", folder / "n.edg.xml"]
        net: list[str | Path] = [
            "-t",
            folder / "n.typ.xml",
            "--no-turnarounds",
            *self.options,
            "-o",
            folder / "n.net.xml",
        ]
        built = sumo_programs.run("netconvert", [*plain, *net])
        assert built[0], built[1]
        (folder / "n.rou.xml").write_text(f"<routes>{self.routes}</routes>")
        (folder / "n.add.xml").write_text(f"<additional>{self.more}</additional>")
        names = {"net-file": "n.net.xml", "route-files": "n.rou.xml", "additional-files": "n.add.xml"}
        inputs = "".join(f'<{name} value="{value}"/>' for name, value in names.items())
        (folder / "n.sumocfg").write_text(f"<configuration>{inputs}</configuration>")
        for name, text in self.files.items():
            (folder / name).write_text(f"<additional>{text}</additional>")
        opened = open_scenario(folder / "n.sumocfg", from_place="e1", to_place="e3", gps=False)
        sumo = replace(
            opened.sumo,
            warm_up_s=warm_up_s,
            step_length_s=1.0,
            action_step_length_s=1.0,
            background_rerouting=rerouting,
        )
        return replace(opened, sumo=sumo)


@contextmanager
def running(scenario: Scenario) -> Iterator[tuple[InProcess, World, Any]]:
    """The simulation, its world, and libsumo."""
    with closing(InProcess(scenario, seed=1, allow_unprojected=True)) as simulation:
        assert simulation.world is not None
        import libsumo

        yield simulation, simulation.world, libsumo


def driven(drive: EgoLoop) -> Iterator[DrivingState]:
    """The states of a drive, second by second, to its end."""
    while drive.state.end is None:
        yield drive.state
        drive.advance(1.0)


def depart(world: World, scenario: Scenario, driver: str = "steady", *incidents: EmergencyVehicle) -> EgoLoop:
    return world.depart(EgoPlan(scenario.ego.trips[0], driver, seed=1, incidents=incidents))


# --- limits -----------------------------------------------------------------------------------------------

TWO_LANES = (
    '<edge id="e2" from="b" to="c" numLanes="2" speed="25"><lane index="0" speed="15"/>'
    '<lane index="1" speed="20"/></edge>'
)
OWN = '<edge id="e2" from="b" to="c" type="own" numLanes="1"/>'

LIMITS = {
    "a variable sign": Road(more=SIGN.format("e2_0", STEP.format(0, 12))),
    "a variable sign that changes": Road(
        more=SIGN.format("e2_0", STEP.format(0, 12) + STEP.format(260, 20) + STEP.format(290, -1))
    ),
    "a calibrator": Road(
        more='<calibrator id="k" edge="e2" pos="0"><flow begin="0" end="999" speed="12"/></calibrator>'
    ),
    "lower for cars": Road(FIRST + OWN + LAST, types=LIMITED.format(25, 12)),
    "higher for cars": Road(FIRST + OWN + LAST, types=LIMITED.format(12, 25)),
    "lower for cars, a lower sign": Road(
        FIRST + OWN + LAST, more=SIGN.format("e2_0", STEP.format(0, 8)), types=LIMITED.format(25, 12)
    ),
    "lower for cars, a higher sign": Road(
        FIRST + OWN + LAST, more=SIGN.format("e2_0", STEP.format(0, 20)), types=LIMITED.format(25, 12)
    ),
    "lane by lane": Road(FIRST + TWO_LANES + LAST),
}


@pytest.mark.parametrize("name", LIMITS)
def test_the_limit_told_is_what_sumo_lets_a_car_drive_and_no_jam(name: str, tmp_path: Path) -> None:
    """The present one and the next; and at its limits the traffic is neither slow nor late."""
    scenario = LIMITS[name].opened(tmp_path)
    with running(scenario) as (_, world, libsumo):
        drive = depart(world, scenario)
        first = drive.state.ahead
        told, allowed = [], []
        for state in driven(drive):
            if not state.road.edge_id.startswith(":"):
                told.append(state.road.limit.mps)
                allowed.append(libsumo.vehicle.getAllowedSpeed(EGO))
            assert state.ahead.slow_edges == ()
    assert told == pytest.approx(allowed, abs=0.01)
    later = next((mps for mps in told if mps != told[0]), None)
    assert (later is None) is ("higher for cars" in name)
    if "changes" not in name:
        assert (None if first.next_limit is None else first.next_limit.mps) == later
    assert first.delay_s < 8.0


@pytest.mark.parametrize("how", ["a school's hours", "roadworks"])
def test_traffic_is_not_slow_because_of_a_limit_that_has_ended(how: str, tmp_path: Path) -> None:
    scenario = Road().opened(tmp_path)
    limit, hours = 36.0, {"opens": time(7), "closes": time(scenario.start.hour, scenario.start.minute + 3)}
    with running(scenario) as (_, world, libsumo):
        if how == "roadworks":
            world.stage(Roadworks(edge="e2", limit_kmh=limit, to_s=180.0))
        else:
            world.stage(SchoolZone(edges=("e2",), limit_kmh=limit, **hours))
        for _ in range(170):
            world.step()
        assert libsumo.lane.getMaxSpeed("e2_0") == 10
        for _ in range(60):
            world.step()
            assert world.congestion.slow_edges() == ()
        assert libsumo.lane.getMaxSpeed("e2_0") == 25


# --- whose speeds count -----------------------------------------------------------------------------------

BESIDE = (
    '<edge id="e2" from="b" to="c" numLanes="2" speed="25">'
    '<lane index="0" allow="{0}"/><lane index="1" disallow="{0}"/></edge>'
)
SLOWLY = '<vType id="other" vClass="{}" maxSpeed="4" sigma="0"/>'
OTHERS = SLOWLY + '<flow id="other" type="other" begin="0" end="9999" period="10"><route edges="e2"/></flow>'

KEPT = CAR.replace("/>", ' lcSpeedGain="0" lcKeepRight="9"/>').replace("car", "kept")

SPEEDS = {
    "cars in a slower lane": Road(
        FIRST + TWO_LANES + LAST,
        KEPT + '<flow id="k" type="kept" end="9999" period="9" departLane="0"><route edges="e2"/></flow>' + CARS,
    ),
    "bicycles on their lane": Road(FIRST + BESIDE.format("bicycle") + LAST, OTHERS.format("bicycle") + CARS),
    "buses on their lane": Road(FIRST + BESIDE.format("bus") + LAST, OTHERS.format("bus") + CARS),
    "trams on their lane": Road(FIRST + BESIDE.format("tram") + LAST, OTHERS.format("tram") + CARS),
    **{
        f"{kind}s beside cars": Road(
            LINE.replace('id="e2"', 'id="e2" numLanes="3"'),
            SLOWLY.format(kind).replace('"4"', '"15"')
            + '<vTypeDistribution id="mix" vTypes="other"/>'
            + '<flow id="o" type="mix" end="9999" period="10" departLane="0"><route edges="e2"/></flow>'
            + CARS,
        )
        for kind in ("truck", "trailer", "coach")
    },
    "a van that stops in a lane": Road(
        LINE.replace('id="e2"', 'id="e2" numLanes="2"'),
        '<vehicle id="van" depart="5" departLane="0"><route edges="e2 e3"/>'
        '<stop lane="e2_0" endPos="400" duration="9999"/></vehicle>' + CARS,
    ),
    **{
        f"one car in {each} stops {how}": Road(
            LINE.replace('id="e2"', f'id="e2" numLanes="{1 if parks else 2}"'),
            CARS.replace('id="car" type', 'id="stops" type')
            .replace('"20"', f'"{20 * each}"')
            .replace("</flow>", f'<stop lane="e2_0" endPos="600" duration="60" {parks}/></flow>')
            + CARS.removeprefix(CAR),
        )
        for each, how, parks in (
            (3, "in a lane", ""),
            (6, "in a lane", ""),
            (2, "beside the road", 'parking="true"'),
            (4, "beside the road", 'parking="true"'),
        )
    },
    "bicycles beside cars": Road(
        LINE.replace('id="e2"', 'id="e2" numLanes="3"'),
        SLOWLY.format("bicycle")
        + '<flow id="o" type="other" end="9999" period="10" departLane="0"><route edges="e2"/></flow>'
        + CARS,
    ),
}


@pytest.mark.parametrize("name", SPEEDS)
def test_the_delay_told_is_what_cars_lose(name: str, tmp_path: Path) -> None:
    scenario = SPEEDS[name].opened(tmp_path)
    with running(scenario) as (_, world, libsumo):
        drive = depart(world, scenario)
        first, lost_s = drive.state.ahead, 0.0
        for _ in driven(drive):
            with suppress(libsumo.TraCIException):
                lost_s = libsumo.vehicle.getTimeLoss(EGO)
    assert first.slow_edges == ()
    assert first.delay_s == pytest.approx(lost_s, abs=4.0)


@pytest.mark.parametrize("stop", ["", 'duration="60"', 'duration="60" parking="true"', 'until="200"'])
def test_a_planned_stop_is_no_lost_time_for_sumo(stop: str, tmp_path: Path) -> None:
    """In its ``tripinfo``, braking and setting off again are none either; in its ``edgeData`` they are."""
    planned = f'<stop lane="e2_0" endPos="600" {stop}/>' if stop else ""
    flows = '<edgeData id="m" file="edges.xml"/>'
    Road(
        routes=f'{CAR}<vehicle id="v" type="car" depart="0" departSpeed="max"><route edges="e1 e2 e3"/>{planned}'
        "</vehicle>"
    ).opened(tmp_path)
    (tmp_path / "flows.xml").write_text(f"<additional>{flows}</additional>")
    done, told = sumo_programs.run(
        "sumo", ["-c", "n.sumocfg", "-a", "flows.xml", "--tripinfo-output", "trips.xml"], tmp_path
    )
    assert done, told
    trip = next(ET.parse(tmp_path / "trips.xml").iter("tripinfo"))
    edges = {each.attrib["id"]: each.attrib for each in ET.parse(tmp_path / "edges.xml").iter("edge")}
    assert (float(trip.attrib["timeLoss"]), float(trip.attrib["waitingTime"])) == (0, 0)
    assert (float(trip.attrib["stopTime"]) > 0) is bool(stop)
    assert float(edges["e2"]["timeLoss"]) == pytest.approx(7.5 * bool(stop), abs=0.1)


def test_a_car_on_the_other_side_is_still_on_its_own_road(tmp_path: Path) -> None:
    """SUMO gives the opposite edge, its limit and position, no leader and a wrong distance driven."""
    back = '<edge id="-e2" from="c" to="b" speed="18"/><edge id="-e1" from="b" to="a" speed="18"/>'
    slow = '<vType id="slow" maxSpeed="6" sigma="0" speedDev="0" lcOpposite="0"/>'
    flow = '<flow id="slow" type="slow" end="9999" period="60" departSpeed="max"><route edges="e1 e2 e3"/></flow>'
    scenario = Road(LINE + back, slow + flow, options=("--opposites.guess",)).opened(tmp_path)
    with running(scenario) as (_, world, libsumo):
        drive = depart(world, scenario)
        seen = {}
        for state in driven(drive):
            if libsumo.vehicle.getRoadID(EGO).startswith("-"):
                seen[state.time_s] = state
                assert libsumo.vehicle.getLeader(EGO, 200.0) is None
            if state.time_s - 1 in seen:  # even while it is on its own side again
                before = seen[state.time_s - 1]
                went_m = state.x_m - before.x_m
                assert state.distance_m - before.distance_m == pytest.approx(went_m, abs=0.5)
                assert before.ahead.route_left_m - state.ahead.route_left_m == pytest.approx(went_m, abs=0.5)
        assert seen
        for state in seen.values():
            assert state.road.edge_id in ("e1", "e2")
            assert state.road.lane_id == f"{state.road.edge_id}_0"
            assert state.road.limit.mps == 25
            assert state.road.lane_position_m == pytest.approx(
                state.x_m - 800 * (state.road.edge_id == "e2"), abs=15
            )
        led = [state.around.leader for state in seen.values() if state.around.leader is not None]
        assert led
        assert all(leader.time_to_collision_s is None for leader in led)


# --- what is closed, and what is a signal -----------------------------------------------------------------

CLOSED = '<rerouter id="r" edges="e1"><interval begin="0" end="9999"><{}/></interval></rerouter>'


@pytest.mark.parametrize(
    ("how", "is_closed"),
    [
        ('closingReroute id="e2"', True),
        ('closingReroute id="e2" disallow="all"', True),
        ('closingReroute id="e2" allow="bus"', True),
        ('closingReroute id="e2" disallow="bus"', False),
        ('closingReroute id="e2" allow="passenger"', False),
        ('closingLaneReroute id="e2_0" disallow="passenger"', True),
        ('closingLaneReroute id="e2_0" disallow="bus"', False),
    ],
)
@pytest.mark.parametrize("is_included", [False, True])
def test_drawn_trips_begin_and_end_where_cars_may_drive(
    how: str, is_closed: bool, is_included: bool, tmp_path: Path
) -> None:
    rerouter = CLOSED.format(how)
    road = Road(LINE + QUICK, more=rerouter)
    if is_included:
        road = replace(road, more='<include href="more.xml"/>', files={"more.xml": rerouter})
    scenario = road.opened(tmp_path)
    drawn = open_scenario(scenario.config, gps=False).ego.trips
    ends = {edge for trip in drawn for edge in (trip.from_edge, trip.to_edge)}
    assert ("e2" not in ends) is is_closed
    with running(scenario) as (_, world, libsumo):
        ways = {libsumo.vehicle.getRoute(each)[1] for each in libsumo.vehicle.getIDList()}
        assert ("e2" not in ways) is is_closed
        if "allow" in how and is_closed:
            on_it = open_scenario(scenario.config, gps=False, from_place="e2", to_place="e3")
            with pytest.raises(ScenarioError, match="no route for a car leads from 'e2'"):
                depart(world, on_it)


def test_a_rerouters_own_file_is_told_because_sumo_does_not_read_it(tmp_path: Path) -> None:
    inner = CLOSED.format('closingReroute id="e2"')
    outer = '<rerouter id="r" edges="e1" file="r.xml"/>'
    road = Road(LINE + QUICK, more=outer)
    (tmp_path / "r.xml").write_text(f"<additional>{inner}</additional>")
    with running(scenario := road.opened(tmp_path)) as (_, _, libsumo):
        assert {libsumo.vehicle.getRoute(each)[1] for each in libsumo.vehicle.getIDList()} == {"e2"}, "of SUMO"
    assert any("does not read the file 'r.xml' of rerouter 'r'" in note for note in scenario.notes)


@pytest.mark.parametrize("whose", ['vTypes="lorry"', 'off="true"', 'probability="0"'])
def test_a_rerouter_for_others_or_that_is_off_closes_nothing_to_the_ego(whose: str, tmp_path: Path) -> None:
    more = CLOSED.format('closingReroute id="e2"').replace("<rerouter", f"<rerouter {whose}")
    scenario = Road(LINE + QUICK, more='<vType id="lorry" vClass="truck"/>' + more).opened(tmp_path)
    drawn = open_scenario(scenario.config, gps=False).ego.trips
    assert "e2" in {edge for trip in drawn for edge in (trip.from_edge, trip.to_edge)}
    on_it = open_scenario(scenario.config, gps=False, from_place="e2", to_place="e3")
    with running(scenario) as (_, world, libsumo):
        assert {libsumo.vehicle.getRoute(each)[1] for each in libsumo.vehicle.getIDList()} == {"e2"}, "of SUMO"
        assert depart(world, on_it).state.road.edge_id == "e2"


RAILS = '<edge id="r1" from="north" to="c" allow="rail"/><edge id="r2" from="c" to="south" allow="rail"/>'
TRAINS = (
    '<vType id="train" vClass="rail"/>'
    '<flow id="t" type="train" end="9999" period="90"><route edges="r1 r2"/></flow>'
)


@pytest.mark.parametrize("sends", ['destProbReroute id="t"', 'routeProbReroute id="other"'])
def test_a_rerouter_sends_others_elsewhere_and_not_the_ego(sends: str, tmp_path: Path) -> None:
    turn = '<edge id="t" from="c" to="south" speed="12"/>'
    more = '<route id="other" edges="e1 q1 q2 t"/>' + CLOSED.format(sends)
    with running(scenario := Road(LINE + QUICK + turn, more=more).opened(tmp_path)) as (_, world, libsumo):
        drive = depart(world, scenario)
        goals = {state.ahead.route_edges[-1] for state in driven(drive)}
        others = {libsumo.vehicle.getRoute(each)[-1] for each in libsumo.vehicle.getIDList()}
    assert goals == {"e3"}
    assert "t" in others
    assert drive.state.road.edge_id == "e3"


def test_a_rail_crossing_is_no_signal(tmp_path: Path) -> None:
    scenario = Road(LINE + RAILS, TRAINS + CARS, nodes={"c": 'type="rail_crossing"'}).opened(tmp_path)
    with running(scenario) as (_, world, libsumo):
        assert libsumo.trafficlight.getIDList() == ("c",)
        assert not any(way.has_signal for ways in world.network.crossings.values() for way in ways.values())


# --- what is asked of SUMO --------------------------------------------------------------------------------

CRAWLERS = (
    '<vType id="crawler" sigma="0" maxSpeed="0.5"/>'
    '<flow id="crawler" type="crawler" end="999" period="20"><route edges="q1 q2 e3"/></flow>'
)
FORK = LINE + QUICK + SLOW


def ways(libsumo: Any) -> set[str]:
    return {libsumo.vehicle.getRoute(each)[1] for each in libsumo.vehicle.getIDList() if each.startswith("car")}


CYCLED = '<edge id="e2" from="b" to="c" numLanes="2" speed="25"><lane index="0" allow="bicycle" speed="4"/></edge>'


def test_a_trip_takes_the_quickest_way_whatever_the_limit_of_the_cycle_lane(tmp_path: Path) -> None:
    """SUMO's free flow on a road is lane 0's."""
    scenario = Road(FIRST + CYCLED + LAST + SLOW, routes="").opened(tmp_path, warm_up_s=0.0)
    with running(scenario) as (_, world, libsumo):
        assert libsumo.simulation.findRoute("e1", "e3").edges == ("e1", "s1", "s2", "e3")
        depart(world, scenario)
        assert libsumo.vehicle.getRoute(EGO) == ("e1", "e2", "e3")


def test_a_detour_is_the_quickest_way_at_the_speeds_driven(tmp_path: Path) -> None:
    """``rerouteTraveltime`` alone goes by the limits, into the jam."""
    scenario = Road(FORK, CRAWLERS + CARS).opened(tmp_path, warm_up_s=300.0)
    with running(scenario) as (_, world, libsumo):
        car = next(each for each in libsumo.vehicle.getIDList() if libsumo.vehicle.getRoadID(each) == "e1")
        libsumo.lane.setDisallowed("e2_0", ["all"])
        libsumo.vehicle.rerouteTraveltime(car, False)
        assert libsumo.vehicle.getRoute(car)[1] == "q1", "of SUMO"
        libsumo.lane.setDisallowed("e2_0", [])
        libsumo.vehicle.setRoute(car, ["e1", "e2", "e3"])
        world.stage(Closure(edge="e2"))
        for _ in range(60):
            world.step()
        assert ways(libsumo) - {"e2"} == {"s1"}


WIDE = "".join(
    f'<edge id="{name}" from="{start}" to="{end}" numLanes="2" speed="14"/>'
    for name, start, end in (
        ("e1", "a", "b"),
        ("e2", "b", "c"),
        ("e3", "c", "d"),
        ("q1", "b", "q"),
        ("q2", "q", "c"),
    )
)
OTHER_DRIVERS = CARS.replace('period="20"', 'period="12"').replace('speedDev="0"', 'lcStrategic="1.5"')
AMBULANCE = (
    '<vType id="amb" vClass="emergency" speedFactor="2.4"><param key="has.bluelight.device" value="true"/></vType>'
)
COMES = '<vehicle id="amb{0}" type="amb" depart="{0}" departSpeed="max"><route edges="{1}"/></vehicle>'
LIGHTS = {"b": 'type="traffic_light"', "c": 'type="traffic_light"'}


def coming(*times_and_ways: tuple[int, str]) -> Road:
    """Ambulances of the scenario's own."""
    return Road(WIDE, OTHER_DRIVERS + AMBULANCE + "".join(COMES.format(*each) for each in times_and_ways))


def staged(*from_s: float, blue_light: bool = True) -> tuple[EmergencyVehicle, ...]:
    return tuple(
        EmergencyVehicle(blue_light=blue_light, speed_ratio=2.4, behind_m=100.0, from_s=each) for each in from_s
    )


PASSING: Mapping[str, tuple[Road, tuple[EmergencyVehicle, ...], bool]] = {
    "a van": (Road(WIDE, OTHER_DRIVERS), staged(0.0, blue_light=False), False),
    "an ambulance": (Road(WIDE, OTHER_DRIVERS), staged(0.0), False),
    "two in succession": (Road(WIDE, OTHER_DRIVERS), staged(0.0, 30.0), False),
    "two together": (Road(WIDE, OTHER_DRIVERS), staged(0.0, 4.0), False),
    "in a corridor at lights": (Road(WIDE, OTHER_DRIVERS, nodes=LIGHTS), staged(0.0), True),
    "one that arrives": (coming((212, "e1 e2")), (), True),
    "one that turns off": (coming((212, "e1 q1")), (), False),
    "three, of which one arrives": (coming((212, "e1 e2"), (216, "e1 e2 e3"), (219, "e1 e2 e3")), (), False),
}
"""The road, what is staged, and whether there are sublanes."""


@pytest.mark.parametrize("name", PASSING)
def test_after_an_ambulance_each_driver_is_who_they_were(name: str, tmp_path: Path) -> None:
    """SUMO's device leaves lane changes and place in the lane changed for good, and draws the speed anew. After
    ambulances of the scenario's own, that is SUMO's experiment, and the ego alone is who it was."""
    road, blue, has_sublanes = PASSING[name]
    scenario = road.opened(tmp_path)
    if has_sublanes:
        scenario = replace(scenario, sumo=replace(scenario.sumo, lateral_resolution_m=0.8))

    def told(libsumo: Any) -> dict[str, tuple[Any, ...]]:
        of = libsumo.vehicle
        return {
            each: (
                round(of.getSpeedFactor(each), 6),
                *(of.getLaneChangeMode(each), of.getLateralAlignment(each), of.getSpeedMode(each)),
                *(of.getParameter(each, f"laneChangeModel.lc{what}") for what in ("Strategic", "SpeedGain")),
                *(of.getColor(each), of.getTypeID(each).partition("@")[0], of.getMinGap(each), of.getTau(each)),
            )
            for each in of.getIDList()
            if each == EGO or each.startswith("car" if blue else EGO)
        }

    touched, gone_s, ahead_s = set(), 0, 0
    with running(scenario) as (_, world, libsumo):
        drive = depart(world, scenario, "hurried", *blue)
        before: dict[str, tuple[Any, ...]] = {}
        for number, state in enumerate(driven(drive)):
            there = [each for each in libsumo.vehicle.getIDList() if each.startswith(("automotive_cosim", "amb"))]
            if now := told(libsumo):
                touched |= {each for each, values in now.items() if values[1] == 1605}
            if number < 3:
                before.pop(EGO, None)  # it is still being set up
            before = now | before
            gone_s = 0 if there or state.distance_m < 300 else gone_s + 1
            if gone_s > 2:
                assert now == {each: before[each] for each in now}
            is_ahead = all(libsumo.vehicle.getPosition(each)[0] > state.x_m + 60 for each in there)
            ahead_s = ahead_s + 1 if is_ahead and number > 3 else 0
            if ahead_s > 2:  # SUMO still writes the place in the lane while it is on the same road
                assert now[EGO][3:] == before[EGO][3:]
    assert before[EGO][0] == round(1 + 31 / (14 * 3.6), 6)
    assert gone_s > 5
    if name != "one that turns off":
        assert (EGO in touched) is (name != "a van")
    assert len(touched) > 1 or not blue or name == "a van"


@pytest.mark.parametrize(("device", "is_told"), [("true", True), ("false", False)])
def test_an_ambulance_is_told_with_its_blue_lights_on(device: str, is_told: bool, tmp_path: Path) -> None:
    """SUMO shows the light on every vehicle of the class, and models it by the device."""
    param = f'<param key="has.bluelight.device" value="{device}"/>'
    kind = f'<vType id="amb" vClass="emergency" speedFactor="2">{param}</vType>'
    vehicle = '<vehicle id="amb" type="amb" depart="215" departSpeed="max"><route edges="e1 e2 e3"/></vehicle>'
    scenario = Road(routes=CAR + kind + vehicle).opened(tmp_path)
    with running(scenario) as (_, world, _):
        drive = depart(world, scenario)
        assert any(state.around.emergency_behind for state in driven(drive)) is is_told


@pytest.mark.parametrize("lanes", [1, 2])
@pytest.mark.parametrize("again", [False, True])
def test_roadworks_hold_their_limit_beside_a_sign_of_sumos(lanes: int, again: bool, tmp_path: Path) -> None:
    """Each step of a sign writes the lane's speed, the same as was written to it or not; here also a sign
    for one of two lanes, and works that begin before others have ended."""
    steps = ((0, 20.0), (60, 10.0), (80, 15.0), (100, 22.0), (120, 9.0), (160, -1))
    sign = SIGN.format("e2_0", "".join(STEP.format(at_s, mps) for at_s, mps in steps))
    road = Road(LINE.replace('id="e2"', f'id="e2" numLanes="{lanes}"'), more=sign)
    shown = []
    with running(road.opened(tmp_path, warm_up_s=30.0)) as (_, world, libsumo):
        world.stage(Roadworks(edge="e2", limit_kmh=36, from_s=10.0, to_s=110.0))
        if again:
            world.stage(Roadworks(edge="e2", limit_kmh=18, from_s=50.0, to_s=80.0))
        for _ in range(150):
            world.step()
            limits = [round(libsumo.lane.getMaxSpeed(f"e2_{lane}"), 3) for lane in range(lanes)]
            shown.append((limits, list(world.network.edges["e2"].lane_mps)))
    now = [shown[at_s - 31] for at_s in (35, 45, 65, 85, 105, 125, 145, 165)]
    assert all(sumo_mps == told_mps for sumo_mps, told_mps in now)
    first = [20, 10, 10, 5 if again else 10, 5 if again else 10, 9, 9, 25]
    assert [sumo_mps[0] for sumo_mps, _ in now] == first
    if lanes == 2:
        second = [25, *first[1:5], 10, 25, 25]
        assert [sumo_mps[1] for sumo_mps, _ in now] == second


def test_no_sign_is_put_up_where_sumo_keeps_another_limit_for_cars(tmp_path: Path) -> None:
    scenario = LIMITS["lower for cars"].opened(tmp_path)
    with running(scenario) as (_, world, libsumo):
        libsumo.lane.setMaxSpeed("e2_0", 5)
        world.step()
        (car, *_) = (each for each in libsumo.vehicle.getIDList() if libsumo.vehicle.getRoadID(each) == "e2")
        assert libsumo.vehicle.getAllowedSpeed(car) == 12, "of SUMO"
        with pytest.raises(ScenarioError, match="'e2' has a limit for cars in its type"):
            world.stage(Roadworks(edge="e2", limit_kmh=36))
