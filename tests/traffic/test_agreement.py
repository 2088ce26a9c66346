"""In this process or forked: the same seed gives the same drive, to the last bit."""

import xml.etree.ElementTree as ET
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import replace
from datetime import UTC
from pathlib import Path

import pytest

from automotive_cosim.contracts import Alert, AlertKind, Cruise, DrivingState, Hazards, Reroute, SlowDown
from automotive_cosim.errors import TrafficError
from automotive_cosim.scenarios import Scenario, WeatherAt, load, open_scenario
from automotive_cosim.traffic.base import EgoPlan, Event, Simulation, Traffic
from automotive_cosim.traffic.fork import Forked, Simulations
from automotive_cosim.traffic.options import Setup
from tests.traffic.in_process import InProcess, InProcessTraffic

pytestmark = pytest.mark.sumo

Edit = Callable[[Path], None]

Record = tuple[list[DrivingState], list[Event], list[object]]


def eventful(traffic: Traffic | InProcessTraffic) -> Record:
    """Several hundred steps, in advances of many lengths, with requests in between."""
    states, events, answers = [traffic.state], [], []
    for request in (
        None,
        Alert(AlertKind.SPEED, speed_kmh=40.0),
        Alert(AlertKind.DISTANCE),
        SlowDown(35.0),
        Reroute("Rue du Nord"),
        Hazards(True),
        Cruise(30.0),
        Reroute("nowhere at all"),
    ):
        if request is not None:
            answers.append(traffic.request(request))
        for duration_s in (0.1, 3.0, 1.4):
            drive = traffic.advance(duration_s)
            states += drive.states
            events += drive.events
    return states, events, answers


def drive_and_branch(simulation: Simulation, plan: EgoPlan) -> tuple[Record, Record]:
    traffic = simulation.depart(plan)
    record = eventful(traffic)
    branch = traffic.branch()
    assert branch.state == traffic.state
    branched = eventful(branch)
    assert branched == eventful(traffic)
    branch.close()
    traffic.close()
    return record, branched


def test_both_ways_to_run_it_agree(grid: Scenario, forked: Forked, hurried: EgoPlan) -> None:
    hurried = replace(hurried, wait_s=3.0)
    expected = drive_and_branch(forked, hurried)
    assert len(expected[0][0]) > 300
    assert any(event.kind == "driver_slows" for event in expected[0][1])
    in_process = InProcess(grid, seed=1)
    try:
        for _ in range(2):  # a second departure starts from the same traffic
            traffic = in_process.depart(hurried)
            assert (eventful(traffic), eventful(traffic)) == expected
    finally:
        in_process.close()


def test_a_later_departure_meets_other_traffic(forked: Forked, hurried: EgoPlan) -> None:
    now, later = forked.depart(hurried), forked.depart(replace(hurried, wait_s=41.0))
    assert later.state.time_s - now.state.time_s == pytest.approx(41.0, abs=10.0)
    speeds = [[state.speed_mps for state in drive.advance(60.0).states] for drive in (now, later)]
    assert speeds[0] != speeds[1]
    now.close()
    later.close()


def test_drives_from_one_warm_traffic_are_independent(forked: Forked, hurried: EgoPlan) -> None:
    first, second = forked.depart(hurried), forked.depart(hurried)
    ahead = first.advance(30.0).states
    assert second.advance(30.0).states == ahead
    first.close()
    assert second.advance(1.0).states
    second.close()


def test_another_seed_is_other_traffic(grid: Scenario, forked: Forked, hurried: EgoPlan) -> None:
    other = Forked(grid, seed=2)
    drives = [simulation.depart(hurried) for simulation in (forked, other)]
    assert drives[0].advance(60.0).states != drives[1].advance(60.0).states
    for drive in drives:
        drive.close()
    other.close()


def test_a_branch_outlives_what_it_came_from(grid: Scenario, hurried: EgoPlan) -> None:
    simulation = Forked(grid, seed=1)
    traffic = simulation.depart(hurried)
    branch = traffic.branch()
    twig = branch.branch()
    traffic.close()
    simulation.close()
    branch.close()
    assert twig.advance(5.0).states[-1].distance_m > 0
    twig.close()


def test_one_long_advance_equals_many_short_ones(forked: Forked, hurried: EgoPlan) -> None:
    whole, pieces = forked.depart(hurried), forked.depart(hurried)
    states = tuple(state for _ in range(100) for state in pieces.advance(0.1).states)
    assert whole.advance(10.0).states == states
    whole.close()
    pieces.close()


@pytest.mark.slow
def test_a_branch_reads_its_own_demand(variant: Callable[..., Scenario], walkable: Edit, hurried: EgoPlan) -> None:
    """SUMO reads a long demand piece by piece, far behind a fork; with sublanes, people and weather."""

    def long_demand(folder: Path) -> None:
        walkable(folder)
        edges = ("cwc0 c0c1 c1c2 c2c3 c3c4 c4ce", "cec4 c4c3 c3c2 c2c1 c1c0 c0cw", "sws0 s0s1 s1s2 s2s3 s3s4 s4se")
        rows = [
            f'<vehicle id="v{k}" depart="{k / 2:.1f}" departLane="best"><route edges="{edges[k % 3]}"/>'
            f'<param key="filler" value="{"x" * 2000}"/></vehicle>'
            for k in range(1200)
        ]
        rows.insert(0, '<personFlow id="p" begin="0" end="600" period="7"><walk edges="n2c2 c2s2"/></personFlow>')
        (folder / "grid.rou.xml").write_text("<routes>" + "\n".join(rows) + "</routes>")
        text = (folder / "scenario.toml").read_text().replace("step_length_s = 0.1", "step_length_s = 0.5")
        (folder / "scenario.toml").write_text(
            text.replace("background_rerouting = 0.6", "background_rerouting = 1\nlateral_resolution_m = 0.8")
        )

    scenario = variant(long_demand)
    assert (scenario.folder / "grid.rou.xml").stat().st_size > 2**21
    # a car that stands at the side sees the traffic go by
    codes = ((0.0, 2), (30.0, 63), (80.0, 75), (130.0, 66), (180.0, 2))
    sky = scenario.weather[0].weather
    weather = tuple(WeatherAt(at_s, replace(sky, weather_code=code)) for at_s, code in codes)
    trip = replace(hurried.trip, to_edge="n4ne", via=("s3s4", "n1n0"))
    plan = EgoPlan(trip, "calm", seed=3, weather=weather)
    simulation = Forked(scenario, seed=4)
    traffic = simulation.depart(plan)
    traffic.request(Cruise(6.0))
    traffic.advance(20.0)
    branch = traffic.branch()
    twig = branch.branch()
    expected = traffic.advance(200.0).states
    assert len(expected) >= 375
    assert max(state.vehicle_count for state in expected) > 20
    for other in (branch, twig):
        assert other.advance(200.0).states == expected
        other.close()
    traffic.close()
    simulation.close()


def rows_of(path: Path) -> dict[float, dict[str, str]]:
    """The ego's rows of SUMO's FCD output, by time."""
    return {
        float(step.attrib["time"]): row.attrib
        for step in ET.parse(path).getroot()
        for row in step
        if row.get("id") == "ego"
    }


def test_states_are_sumos_own_and_every_branch_writes_its_own(
    grid: Scenario, hurried: EgoPlan, tmp_path: Path
) -> None:
    """SUMO's FCD row of an instant stands one step before ``getTime``."""
    simulation = Forked(grid, seed=1, outputs=tmp_path)
    traffic = simulation.depart(hurried)
    before = traffic.advance(10.0).states
    branch = traffic.branch()
    branch.request(SlowDown(20.0))
    drives = [(before + each.advance(600.0).states) for each in (traffic, branch)]
    assert drives[0] != drives[1]
    for each in (branch, traffic, simulation):
        each.close()
    for states, name in zip(drives, ("drive-1", "drive-2"), strict=True):
        rows = rows_of(tmp_path / name / "fcd.xml")
        driving = [state for state in states if state.end is None]
        for state in driving:
            row = rows[round(state.time_s - grid.sumo.step_length_s, 3)]
            assert float(row["x"]) == pytest.approx(state.x_m, abs=1e-5)
            assert float(row["y"]) == pytest.approx(state.y_m, abs=1e-5)
            assert float(row["speed"]) == pytest.approx(state.speed_mps, abs=1e-5)
            assert row["lane"] == state.road.lane_id
        assert len(driving) + 1 == len(rows), "and the instant of its departure"
        trips = ET.parse(tmp_path / name / "tripinfo.xml").getroot()
        (ego,) = (trip for trip in trips if trip.get("id") == "ego")
        assert float(ego.attrib["arrival"]) == pytest.approx(states[-1].time_s - grid.sumo.step_length_s, abs=0.11)
    assert not rows_of(tmp_path / "warm" / "fcd.xml"), "the warm traffic has no ego"


def moved_and_warmed_up(places: Sequence[Scenario], trip: str) -> list[Record]:
    """A drive at each place in traffic that was moved there, which is as the one in traffic warmed up there."""
    records = []
    with closing(Simulations()) as shared:
        for there in places:
            plan = EgoPlan(there.trip(trip), "hurried", 7, load("grid").weather, there.start)
            moved = shared.warm(there, 1)
            record = drive_and_branch(moved, plan)
            with closing(Forked(there, 1)) as anew, closing(anew.depart(plan)) as drive:
                assert drive_and_branch(anew, plan) == record
                with closing(moved.depart(plan)) as same:
                    assert same.network == drive.network
            records.append(record[0])
    return records


def test_traffic_moved_to_another_place_is_as_if_it_had_been_warmed_up_there(
    variant: Callable[[Edit], Scenario],
) -> None:
    def shut(folder: Path) -> None:
        with (folder / "scenario.toml").open("a", encoding="utf-8") as file:
            file.write('\n[[incidents]]\nkind = "closure"\nedge = "n2n3"\nfrom_s = 5.0\n')

    folder = variant(shut).folder
    berlin, madrid, london = (
        open_scenario(folder, origin=origin) for origin in ((13.4, 52.5), (-3.7, 40.4), (-0.1, 51.5))
    )
    assert Setup(berlin).traffic == Setup(madrid).traffic != Setup(london).traffic, "on the left"
    told = [
        {event.text for event in events if "closed" in event.text}
        for _, events, _ in moved_and_warmed_up((berlin, madrid, london), "avenue")
    ]
    assert all(told)
    assert len(set(map(frozenset, told))) == 3, "streets have names in the language of the place"


def test_moved_traffic_keeps_the_limits_that_came_into_force_while_it_warmed_up() -> None:
    scenario = load("autobahn")
    short = replace(scenario.sumo, warm_up_s=30.0)
    places = [
        replace(open_scenario("autobahn", origin=origin), sumo=short) for origin in ((113.3, 23.1), (8.62, 49.93))
    ]
    assert Setup(places[0]).traffic == Setup(places[1]).traffic
    delays_s = [states[-1].ahead.delay_s for states, _, _ in moved_and_warmed_up(places, "south")]
    assert delays_s[0] == delays_s[1] > 0


def test_traffic_of_other_weather_hours_or_sides_is_not_the_same(grid: Scenario) -> None:
    (now,) = grid.weather
    others = [
        replace(grid, start=grid.start.replace(hour=3)),
        replace(grid, weather=(replace(now, weather=replace(now.weather, precipitation=2.0)),)),
        replace(grid, mirrored=True),
        replace(grid, sumo=replace(grid.sumo, scale=0.5)),
        replace(grid, incidents=load("autobahn").incidents),
    ]
    assert all(Setup(other).traffic != Setup(grid).traffic for other in others)
    assert Setup(grid, 1).traffic != Setup(grid, 2).traffic
    assert Setup(replace(grid, start=grid.start.replace(tzinfo=UTC))).traffic == Setup(grid).traffic


def test_the_pool_keeps_the_latest(grid: Scenario, hurried: EgoPlan) -> None:
    pool, grid = Simulations(count_limit=2), replace(grid, sumo=replace(grid.sumo, warm_up_s=5.0))
    first = pool.warm(grid, 1)
    traffic = first.depart(hurried)
    assert pool.warm(grid, 2) is not first
    assert pool.warm(grid, 1) is first
    pool.warm(grid, 3)
    assert pool.warm(grid, 1) is first, "the second was used longest ago"
    pool.warm(grid, 4)
    pool.warm(grid, 5)
    with pytest.raises(TrafficError, match="closed"):
        first.depart(hurried)
    assert traffic.advance(1.0).states
    traffic.close()
    pool.close()
    pool.close()


def test_of_one_traffic_at_two_places_the_pool_gives_up_one_first(grid: Scenario) -> None:
    elsewhere = open_scenario("grid", origin=(-3.7, 40.4))
    assert Setup(elsewhere).traffic != Setup(grid).traffic, "its weather is drawn"
    there = open_scenario("grid", origin=(13.4, 52.5))
    with closing(Simulations(count_limit=2)) as pool:
        home = pool.warm(grid, 1)
        pool.warm(elsewhere, 1)
        pool.warm(there, 1)
        assert pool.warm(grid, 1) is home, "used longest ago, but its traffic would have to be warmed up"
