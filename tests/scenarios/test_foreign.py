"""Any SUMO scenario and any network run as they are, from folders that nothing is written to."""

import pickle
import re
import shutil
from contextlib import closing
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

from automotive_cosim import scenarios
from automotive_cosim.contracts import EgoEnd
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.errors import ScenarioError, UnknownNameError, UserError
from automotive_cosim.scenarios import Scenario, open_scenario
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.scenarios.routes import LONG_M, chosen_trips, edges_at
from automotive_cosim.scenarios.variant import new_folder, write_variant
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.georeference import GeoReference
from automotive_cosim.traffic.network import known_network, read_network
from automotive_cosim.traffic.options import Setup, copied, read_configuration, run_options
from automotive_cosim.traffic.ways import way_through

GRID = scenarios.load("grid").folder
TOML = "scenario.toml"

OTHERS = {
    "ingolstadt1": "ingolstadt/ingolstadt1/ingolstadt1.sumocfg",
    "ingolstadt7": "ingolstadt/ingolstadt7/ingolstadt7.sumocfg",
    "bologna": "bologna/acosta/run.sumocfg",
}

OUTPUTS = '<output><summary-output value="summary.xml"/><fcd-output value="fcd.xml"/></output>'
DETECTOR = '<e1Detector id="d" lane="c1c2_0" pos="50" period="60" file="detector.xml"/>'
ROUTE = '<route id="r" edges="cwc0 c0c1 c1c2 c2c3 c3c4 c4ce"/>'
FLOW = '<flow id="f" route="r" begin="36000" end="90000" period="6"/>'


@pytest.fixture
def foreign(tmp_path: Path) -> Path:
    """A configuration that begins at ten, writes wherever it can and has a detector."""
    shutil.copy(GRID / "grid.net.xml", tmp_path / "town.net.xml")
    (tmp_path / "town.rou.xml").write_text(f"<routes>{ROUTE}{FLOW}</routes>")
    (tmp_path / "town.add.xml").write_text(f"<additional>{DETECTOR}</additional>")
    (tmp_path / "town.sumocfg").write_text(
        '<configuration><input><net-file value="town.net.xml"/><route-files value="town.rou.xml"/>'
        '<additional-files value="town.add.xml"/></input>'
        '<time><begin value="36000"/><end value="39600"/><step-length value="0.5"/></time>'
        f"{OUTPUTS}</configuration>"
    )
    return tmp_path / "town.sumocfg"


def _listing(folder: Path) -> dict[str, tuple[int, int]]:
    return {
        str(path.relative_to(folder)): (path.stat().st_size, path.stat().st_mtime_ns)
        for path in folder.rglob("*")
        if path.is_file()
    }


def _drive(scenario: Scenario, trip: int = 0, *, for_s: float = 5.0) -> tuple[float, int, EgoEnd | None]:
    """Simulation time at departure, vehicles there, and how the drive ended, if it did."""
    with closing(Forked(scenario, seed=1)) as simulation:
        plan = EgoPlan(scenario.ego.trips[trip])
        with closing(simulation.depart(plan)) as traffic:
            first = traffic.state
            traffic.advance(for_s)
            return first.time_s, first.vehicle_count, traffic.state.end


def test_a_configuration_is_read_for_what_it_says(foreign: Path) -> None:
    scenario = open_scenario(foreign)
    assert (scenario.name, scenario.country, scenario.has_place) == ("town", "FR", True)
    assert (scenario.as_stated, scenario.sumo.step_length_s, scenario.sumo.action_step_length_s) == (
        True,
        0.5,
        None,
    )
    assert scenario.weather == ()
    assert str(scenario.start.tzinfo) == "Europe/Paris"
    after_midnight_s = scenario.start.hour * 3600 + scenario.start.minute * 60 + scenario.start.second
    assert after_midnight_s == 36_000 + scenario.sumo.warm_up_s
    runs_with, without = scenario.notes
    assert "runs as `sumo -c` runs it" in runs_with
    assert "step-length" not in runs_with
    assert without == "town.sumocfg runs without its summary-output, fcd-output"


def test_what_works_in_parallel_and_other_settings_that_are_not_kept_are_told(
    foreign: Path, tmp_path: Path
) -> None:
    more = '<threads value="4"/><device.rerouting.threads value="2"/><step-length value="2"/>'
    foreign.write_text(foreign.read_text().replace('<step-length value="0.5"/>', more))
    scenario = open_scenario(foreign)
    assert any("step-length 1 instead of 2, so figures differ" in note for note in scenario.notes)
    assert any("threads, device.rerouting.threads set aside" in note for note in scenario.notes)
    (tmp_path / "scratch").mkdir()
    options = run_options(copied(read_configuration(foreign), tmp_path / "scratch"), Setup(scenario))
    assert not [name for name in options if "threads" in name or "action" in name]
    assert (options["step-length"], options["end"]) == ("1", "39600")
    shutil.copytree(GRID, tmp_path / "grid")
    described = tmp_path / "grid" / "grid.sumocfg"
    described.write_text(described.read_text().replace("<time>", '<time><threads value="4"/>'))
    assert any("threads set aside" in note for note in open_scenario(described.parent).notes)


@pytest.mark.sumo
def test_it_runs_from_its_own_begin_and_leaves_its_folder_alone(foreign: Path) -> None:
    before = _listing(foreign.parent)
    scenario = open_scenario(foreign)
    departed_s, vehicles, _ = _drive(scenario, for_s=60.0)
    assert departed_s >= 36_000 + scenario.sumo.warm_up_s
    assert vehicles > 1
    assert _listing(foreign.parent) == before


def test_cars_that_are_to_reroute_do_so_again_and_again(foreign: Path, tmp_path: Path) -> None:
    """SUMO's own period is 0, with which its devices choose at the departure and never again."""
    scenario = open_scenario(foreign)
    asked = replace(scenario, sumo=replace(scenario.sumo, background_rerouting=0.5))
    folders = tmp_path / "kept", tmp_path / "asked"
    for folder, of, period in zip(folders, (scenario, asked), (None, "60"), strict=True):
        folder.mkdir()
        options = run_options(copied(read_configuration(foreign), folder), Setup(of))
        assert options.get("device.rerouting.period") == period
        assert (options.get("device.rerouting.probability") == "0.5") is (period is not None)


def test_a_folder_with_one_configuration_opens_as_that(foreign: Path) -> None:
    assert open_scenario(foreign.parent) == open_scenario(foreign)
    shutil.copy(foreign, foreign.with_name("other.sumocfg"))
    with pytest.raises(ScenarioError, match=r"name one of other\.sumocfg, town\.sumocfg"):
        open_scenario(foreign.parent)


@pytest.mark.sumo
@pytest.mark.parametrize("name", ["grid", pytest.param("paris_centre", marks=pytest.mark.proof)])
def test_a_bare_network_runs_with_light_traffic_and_says_so(name: str) -> None:
    net = next(scenarios.load(name).folder.glob("*.net.xml*"))
    scenario = open_scenario(net)
    assert scenario.name == name
    assert any("no traffic of its own" in note for note in scenario.notes)
    _, vehicles, end = _drive(scenario)
    assert vehicles > 3
    assert end is None


@pytest.mark.sumo
def test_a_bare_network_is_read_once_and_drives_as_if_read_twice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    net = tmp_path / "town.net.xml"
    shutil.copy(GRID / "grid.net.xml", net)
    scenario = open_scenario(net)
    known, _ = known_network(scenario.config)
    assert known is not None
    assert pickle.loads(known.pickled) == read_network(net)
    states = []
    for _ in range(2):
        with (
            closing(Forked(scenario, seed=1)) as simulation,
            closing(simulation.depart(EgoPlan(scenario.ego.trips[0]))) as traffic,
        ):
            traffic.advance(60.0)
            states.append((traffic.network, traffic.state))
        monkeypatch.setattr("automotive_cosim.traffic.remote.known_network", lambda config: (None, None))
    assert states[0] == states[1]


def test_light_traffic_is_the_seeds(tmp_path: Path) -> None:
    scenario = open_scenario(GRID / "grid.net.xml")
    written = []
    for number, seed in enumerate((1, 1, 2)):
        scratch = tmp_path / str(number)
        scratch.mkdir()
        run_options(copied(read_configuration(scenario.config), scratch), Setup(scenario, seed))
        written.append((scratch / "random.add.xml").read_text())
    assert written[0] == written[1] != written[2]
    assert written[0].count("<flow ") > 20
    network = network_of(scenario)
    for route in re.findall(r'<route edges="([^"]+)"/>', written[0]):
        assert all(there in network.crossings[here] for here, there in pairwise(route.split()))


@pytest.mark.parametrize("name", scenarios.shipped())
def test_drawn_ways_lead_from_start_to_goal_and_are_long(name: str) -> None:
    network = network_of(scenarios.load(name))
    trips = chosen_trips(network, "", "")
    assert len(trips) > 1
    longest = 0.0
    lengths = []
    for trip in trips:
        way = way_through(network, (trip.from_edge, trip.to_edge))
        assert way[0] == trip.from_edge
        assert way[-1] == trip.to_edge
        assert all(there in network.crossings[here] for here, there in pairwise(way))
        lengths.append(sum(network.edges[edge].length_m for edge in way))
        longest = max(longest, lengths[-1])
    assert min(lengths) >= 0.4 * min(longest, LONG_M)
    assert chosen_trips(network, "", "") == trips


def test_a_way_between_places_however_they_are_named() -> None:
    network = network_of(scenarios.load("grid"))
    edge = network.edges["n1n2"]
    lon_deg, lat_deg = GeoReference(network.map).lon_lat(*edge.shape_m[0])
    assert edges_at(network, "n1n2") == ("n1n2",)
    assert "n1n2" in edges_at(network, edge.name.upper())
    found = network.edges[edges_at(network, f"{lon_deg}, {lat_deg}")[0]]
    assert {found.from_node, found.to_node} & {edge.from_node, edge.to_node}
    (trip,) = chosen_trips(network, "cwc0", edge.name)
    assert trip.from_edge == "cwc0"
    assert network.edges[trip.to_edge].name == edge.name
    drawn = chosen_trips(network, "", "c4ce")
    assert {trip.to_edge for trip in drawn} == {"c4ce"}


@pytest.mark.parametrize(
    ("places", "said"),
    [
        (("Avenue Central", ""), "did you mean 'Avenue Centrale'"),
        (("c1c22", ""), "did you mean 'c1c2'"),
        (("zzzzzzzz", ""), "a street's name, an edge's id or LON,LAT"),
        (("2.35,48.85", ""), "km from the nearest road"),
        (("c1c2", "c1c2"), "no route for a car leads"),
    ],
)
def test_a_place_that_is_none_is_one_line(places: tuple[str, str], said: str) -> None:
    with pytest.raises(ScenarioError, match=said) as caught:
        open_scenario("grid", from_place=places[0], to_place=places[1])
    assert "\n" not in str(caught.value)


def test_the_ego_drives_the_way_that_was_asked_for(simulations) -> None:
    env = CockpitEnv(
        "hvac_fan_max", scenario="grid", from_place="Rue du Sud", to_place="n4ne", simulations=simulations
    )
    env.reset(seed=2)
    route = env.episode.moments[0].driving.ahead.route_edges
    assert route[-1] == "n4ne"
    assert env.episode.drive[0].driving.road.name == "Rue du Sud"
    env.close()


def test_which_of_the_drawn_ways_is_the_seeds(foreign: Path, simulations) -> None:
    departures = []
    for seed in (1, 1, 2, 3, 4):
        env = CockpitEnv("hvac_fan_max", scenario=str(foreign), simulations=simulations)
        env.reset(seed=seed)
        departures.append(env.episode.drive[0].driving.ahead.route_edges)
        env.close()
    assert departures[0] == departures[1]
    assert len(set(departures)) > 1


def test_what_is_no_scenario_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "x.osm.xml").write_text("<osm/>")
    (tmp_path / "x.rou.xml").write_text("<routes/>")
    (tmp_path / "x.sumocfg").write_text("<configuration")
    (tmp_path / "y.sumocfg").write_text("<configuration/>")
    (tmp_path / "z.net.xml").write_text("<net>")
    for name, said in (
        ("x.osm.xml", "scenarios import"),
        ("x.rou.xml", "its root is <routes>"),
        ("x.sumocfg", "is not XML"),
        ("y.sumocfg", "names no net-file"),
        ("z.net.xml", "not a complete SUMO network"),
        ("missing.sumocfg", "there is no file"),
    ):
        with pytest.raises(ScenarioError, match=said) as caught:
            open_scenario(tmp_path / name)
        assert "\n" not in str(caught.value), name
    with pytest.raises(UnknownNameError, match="did you mean 'grid'"):
        open_scenario("gird")


@pytest.mark.parametrize("text", ["ten", "nan", "1:2"])
def test_a_begin_that_is_no_time_is_one_line(foreign: Path, text: str) -> None:
    foreign.write_text(foreign.read_text().replace("36000", text))
    with pytest.raises(ScenarioError, match=f"begin = '{text}' is not a number"):
        open_scenario(foreign)


def test_a_begin_may_be_a_clock_time(foreign: Path) -> None:
    foreign.write_text(foreign.read_text().replace("36000", "10:00:00"))
    assert open_scenario(foreign).start.hour == 10


# --- without a place --------------------------------------------------------------------------------------


def _without_projection(net: Path) -> None:
    net.write_text(re.sub(r'projParameter="[^"]*"', 'projParameter="!"', net.read_text()))


def test_a_network_without_projection_runs_without_gps_and_says_so(foreign: Path, simulations) -> None:
    _without_projection(foreign.with_name("town.net.xml"))
    scenario = open_scenario(foreign)
    assert (scenario.has_place, scenario.country) == (False, "")
    assert any("has no projection" in note and "without GPS" in note for note in scenario.notes)
    env = CockpitEnv("hvac_fan_max", scenario=str(foreign), simulations=simulations, render_mode="rgb_array")
    encoded, _ = env.reset(seed=1)
    assert encoded["gps"]["available"] == 0
    assert env.episode.moments[0].gps is None
    assert env.episode.moments[0].context.country == ""
    assert "Position: unknown" in (env.episode.observation.context or "")
    assert env.render() is not None
    env.close()


def test_it_can_be_placed(foreign: Path) -> None:
    _without_projection(foreign.with_name("town.net.xml"))
    scenario = open_scenario(foreign, origin=(11.32, 44.4957))
    assert (scenario.has_place, scenario.country) == (True, "IT")
    assert not any("without GPS" in note for note in scenario.notes)


@pytest.mark.sumo
def test_a_scenarios_folder_without_projection_is_refused_unless_gps_is_asked_to_be_absent(tmp_path: Path) -> None:
    folder = tmp_path / "flat"
    shutil.copytree(GRID, folder)
    _without_projection(folder / "grid.net.xml")
    with pytest.raises(ScenarioError, match="has no projection") as caught:
        Forked(open_scenario(folder))
    assert "\n" not in str(caught.value)
    assert "--no-gps" in str(caught.value)
    for env in (
        CockpitEnv("hvac_fan_max", scenario=str(folder), gps=False),
        CockpitEnv("hvac_fan_max", scenario="grid", gps=False),
    ):
        env.reset(seed=1)
        assert env.episode.moments[0].gps is None
        assert env.episode.moments[0].context.country == ""
        env.close()


# --- the networks of others ----------------------------------------------------------------------


@pytest.mark.proof
@pytest.mark.parametrize("name", OTHERS)
def test_real_scenarios_run_with_their_own_demand(name: str, simulations, data_of_others) -> None:
    path = data_of_others(OTHERS[name])
    before = _listing(path.parent)
    scenario = open_scenario(path)
    env = CockpitEnv("hvac_fan_max", scenario=str(path), simulations=simulations)
    env.reset(seed=1)
    driving = env.episode.moments[0].driving
    assert driving.vehicle_count > 8
    assert not any("no traffic of its own" in note for note in scenario.notes)
    if name == "bologna":
        assert any("without GPS" in note for note in scenario.notes)
        assert env.episode.moments[0].gps is None
    else:
        assert env.episode.moments[0].context.country == "DE"
        assert scenario.start.hour == 16
    env.close()
    assert _listing(path.parent) == before


def test_a_copy_with_another_demand_has_the_configurations_files_and_no_others(tmp_path: Path) -> None:
    """Without ``scenario.toml``; its scale and share of rerouting cars were those of the old demand."""
    here, there = tmp_path / "here", tmp_path / "there"
    shutil.copytree(GRID, here)
    (here / "scenario.toml").unlink()
    (here / "diary.txt").touch()
    config = here / "grid.sumocfg"
    options = '<scale value="2"/><device.rerouting.probability value="0.5"/><end value="99"/>'
    config.write_text(config.read_text().replace("</configuration>", f"{options}</configuration>"))
    given = open_scenario(config)
    assert (given.sumo.scale, given.sumo.background_rerouting) == (2.0, 0.5)
    routes = ("mine.rou.xml", '<routes><trip id="a" depart="0" from="c0c1" to="c2c3"/></routes>')
    with new_folder(there) as draft:
        write_variant(draft, given, read_configuration(config), routes, ("record.json", {}))
    made = open_scenario(there)
    assert (made.sumo.scale, made.sumo.background_rerouting) == (1.0, 0.0)
    assert "end" not in read_configuration(made.config).options
    files = read_configuration(made.config).files
    assert [path.name for path in files["route-files"]] == ["mine.rou.xml"]
    named = {path.name for paths in files.values() for path in paths}
    assert {path.name for path in there.iterdir()} == named | {"grid.sumocfg", "record.json"}


@pytest.fixture
def given(tmp_path: Path) -> Path:
    """Somebody's scenario, with more in its folder than its configuration names, and somebody else's secrets."""
    here, outside = tmp_path / "here", tmp_path / "outside"
    shutil.copytree(GRID, here)
    outside.mkdir()
    for name in ("private.xml", "private.md"):
        (outside / name).write_text("<additional/>")
    (here / "parts").mkdir()
    (here / "parts" / "inner.xml").write_text("<additional/>")
    (here / "outer.xml").write_text('<additional><include href="parts/inner.xml"/></additional>')
    (here / "diary.txt").touch()
    (here / "endless").symlink_to("/dev/zero")
    (here / "all").symlink_to(outside)
    config = here / "grid.sumocfg"
    more = '<additional-files value="outer.xml"/>'
    config.write_text(config.read_text().replace("</configuration>", f"{more}</configuration>"))
    return here


def _copy(given: Path) -> Path:
    there = given.parent / "there"
    scenario = open_scenario(given)
    routes = ("mine.rou.xml", '<routes><trip id="a" depart="0" from="c0c1" to="c2c3"/></routes>')
    with new_folder(there) as draft:
        write_variant(draft, scenario, read_configuration(scenario.config), routes, ("record.json", {}))
    return there


def test_a_copy_has_the_files_that_its_files_name_and_no_others(given: Path) -> None:
    there = _copy(given)
    assert {path.relative_to(there).as_posix() for path in there.rglob("*") if path.is_file()} == {
        "README.md", "grid.net.xml", "grid.sumocfg", "mine.rou.xml", "outer.xml", "parts/inner.xml", "record.json",
        "scenario.toml",
    }  # fmt: skip
    assert open_scenario(there).sumo.scale == 1.0
    with pytest.raises(UserError, match="exists; give --out"):
        _copy(given)


@pytest.mark.parametrize(
    "name", ["README.md", "grid.net.xml", "outer.xml", "parts/inner.xml", "parts", "scenario.toml"]
)
def test_a_copy_goes_through_no_link_out_of_the_folder_and_leaves_nothing(given: Path, name: str) -> None:
    inside, moved = given / name, given.parent / "outside" / "moved"
    inside.rename(moved)
    inside.symlink_to(moved)
    with pytest.raises(UserError, match=r"is a link that leads out of .*put the file itself there") as refused:
        _copy(given)
    assert "\n" not in str(refused.value)
    assert {path.name for path in given.parent.iterdir()} == {"here", "outside"}


def test_a_copy_is_bounded(given: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("automotive_cosim.scenarios.variant.MOST_COPIED_BYTES", 1000)
    with pytest.raises(UserError, match=r"grid.net.xml is too large to be copied"):
        _copy(given)
    assert {path.name for path in given.parent.iterdir()} == {"here", "outside"}
