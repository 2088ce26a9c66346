"""The gap of a demand by hand, and a demand that finds its routes."""

import json
from collections.abc import Mapping
from pathlib import Path

import pytest

from automotive_cosim import scenarios
from automotive_cosim.errors import UserError
from automotive_cosim.scenarios.variant import settings
from automotive_cosim.studies.equilibrium import optimum
from automotive_cosim.studies.equilibrium.equilibrium import RECORD, AssignmentStep, equilibrate, is_stuck
from automotive_cosim.studies.equilibrium.gap import DrivenTrip, EdgeTimes, Gap, measure
from automotive_cosim.studies.equilibrium.settings import EquilibriumSettings
from automotive_cosim.traffic import sumo_programs

FREE_S = {"a": 10.0, "b": 20.0, "c": 30.0, "d": 5.0}


def trip(name: str, exits_s: tuple[float, ...], edges: tuple[str, ...] = ("a", "b", "d")) -> DrivenTrip:
    return DrivenTrip(name, "car", 0.0, edges, exits_s)


def test_times_are_what_the_vehicles_took_in_the_interval_in_which_they_entered() -> None:
    times = EdgeTimes(
        FREE_S, [trip("x", (10.0, 110.0, 120.0)), trip("y", (20.0, 70.0, -1.0)), trip("z", (310.0, 340.0, 350.0))]
    )
    assert times.at("b", 0) == pytest.approx((100 + 50) / 2)
    assert times.at("b", 1) == pytest.approx(30.0)
    assert times.at("b", 2) == FREE_S["b"], "nobody drove it then"
    assert times.at("c", 0) == FREE_S["c"]
    assert times.at("a", 0) == FREE_S["a"], "the first edge is not driven whole"
    assert times.at("d", 0) == pytest.approx(10.0), "who has not left it says nothing"
    assert times.of(("a", "b", "d"), 10.0) == pytest.approx(75 + 10)
    assert times.of(("a", "b", "d"), 290.0) == pytest.approx(75 + 10), "d is entered in the next interval"
    assert times.of(("a", "c", "d"), 10.0) == pytest.approx(30 + 10)


def test_the_gap_is_what_was_lost_as_a_share_of_the_best() -> None:
    gap = Gap(trips=4, unfinished=0, own_s=440.0, best_s=400.0, better=0.5, teleports=0)
    assert gap.relative == pytest.approx(0.1)
    assert Gap(0, 0, 0.0, 0.0, 0.0, 0).relative == 0


def test_it_ends_once_the_gap_no_longer_falls() -> None:
    assert not is_stuck([0.3, 0.2, 0.25])
    assert not is_stuck([0.3, *[0.4] * 4, 0.29])
    assert is_stuck([0.3, *[0.4] * 4, 0.31])


def test_the_settings_keep_the_routes() -> None:
    text = settings('[sumo]\nconfig = "a.sumocfg"\nscale = 0.7\nbackground_rerouting = 0.6\n\n[ego]\n')
    assert text.count("scale = 1.0") == text.count("background_rerouting = 0.0") == 1
    assert "0.7" not in text
    assert "0.6" not in text


NODES = {
    "west": (0, 0),
    "fork": (300, 0),
    "gate": (1100, 0),
    "side": (800, 300),
    "join": (1300, 0),
    "east": (1600, 0),
}
EDGES = {
    "access": ("west", "fork", 300.0, 3),
    "main": ("fork", "join", 1000.0, 1),
    "out": ("fork", "side", 560.0, 1),
    "back": ("side", "join", 560.0, 1),
    "exit": ("join", "east", 300.0, 2),
}


SCENARIO = """name = "two"
title = "Two ways"
about = "Everybody is on one of two ways."
country = "FR"
start = "2026-03-10T08:30:00"
time_zone = "Europe/Paris"
has_place = false
weather = "climate"

[sumo]
config = "two.sumocfg"
warm_up_s = 0.0

[ego]
driver = "steady"

[[ego.trips]]
name = "across"
from_edge = "access"
to_edge = "exit"
"""


@pytest.fixture
def jammed(sumo: None, tmp_path: Path) -> Path:
    """Two ways of about the same length, and everybody on the shorter one, at more than a lane can carry."""
    return two_ways(tmp_path, EDGES, "access main exit", 1.2)


def two_ways(tmp_path: Path, drawn: Mapping[str, tuple[str, str, float, int]], route: str, period_s: float) -> Path:
    """A scenario in which everybody is on one way; the edge ``neck``, if there is one, is slow."""
    folder = tmp_path / "two"
    folder.mkdir()
    nodes = "".join(f'<node id="{name}" x="{x}" y="{y}" type="priority"/>' for name, (x, y) in NODES.items())
    edges = "".join(
        f'<edge id="{name}" from="{begin}" to="{end}" numLanes="{lanes}" speed="{5 if name == "neck" else 13}" '
        f'length="{length_m}"/>'
        for name, (begin, end, length_m, lanes) in drawn.items()
    )
    (tmp_path / "n.nod.xml").write_text(f"<nodes>{nodes}</nodes>")
    (tmp_path / "n.edg.xml").write_text(f"<edges>{edges}</edges>")
    files = ("-n", tmp_path / "n.nod.xml", "-e", tmp_path / "n.edg.xml", "-o", folder / "two.net.xml")
    built, printed = sumo_programs.run("netconvert", [*files, "--no-turnarounds"])
    assert built, printed
    (folder / "two.rou.xml").write_text(
        f'<routes><vType id="car"/><flow id="f" type="car" begin="0" end="900" period="{period_s:g}" '
        f'departLane="best" departSpeed="max"><route edges="{route}"/></flow></routes>'
    )
    (folder / "two.sumocfg").write_text(
        '<configuration><input><net-file value="two.net.xml"/><route-files value="two.rou.xml"/></input>'
        "</configuration>"
    )
    (folder / "scenario.toml").write_text(SCENARIO)
    return folder


def test_buses_on_a_way_of_their_own_count(sumo: None, tmp_path: Path) -> None:
    folder = two_ways(tmp_path, EDGES, "access main exit", 9.0)
    edges = tmp_path / "n.edg.xml"
    for name in ("out", "back"):
        edges.write_text(edges.read_text().replace(f'<edge id="{name}"', f'<edge id="{name}" allow="bus"'))
    built, printed = sumo_programs.run(
        "netconvert", ["-n", tmp_path / "n.nod.xml", "-e", edges, "-o", folder / "two.net.xml", "--no-turnarounds"]
    )
    assert built, printed
    demand = folder / "two.rou.xml"
    buses = '<vType id="bus" vClass="bus"/><flow id="g" type="bus" begin="0" end="900" period="90">'
    demand.write_text(
        demand.read_text().replace("</routes>", f'{buses}<route edges="access out back exit"/></flow></routes>')
    )
    assert measure(scenarios.load(folder), observe_s=600).trips >= 60


@pytest.mark.slow
def test_drivers_find_the_other_way(jammed: Path, tmp_path: Path) -> None:
    told: list[AssignmentStep] = []
    target = tmp_path / "found"
    steps = equilibrate(jammed, target, EquilibriumSettings(steps=4, gap=0.01, minutes=15), told.append)
    assert tuple(told) == steps
    assert steps[0].gap.relative > 0.05, "all are on one way"
    best = min(step.gap.relative for step in steps)
    assert best < steps[0].gap.relative / 2
    record = json.loads((target / RECORD).read_text())
    assert record["steps"][record["kept"]]["relative_gap"] == best
    routes = (target / "equilibrium.rou.xml").read_text()
    assert routes.count("access out back exit") > 50
    assert routes.count("<vehicle ") == steps[0].gap.trips + steps[0].gap.unfinished
    again = measure(scenarios.load(target), observe_s=900)
    assert again.relative == pytest.approx(best), "the folder is the step that was kept"
    with pytest.raises(UserError, match="exists"):
        equilibrate(jammed, target, EquilibriumSettings(), told.append)


def test_others_lose_by_what_a_road_takes_longer_than_when_it_is_calm() -> None:
    times = EdgeTimes(FREE_S, [trip("x", (10.0, 40.0, 45.0)), trip("y", (310.0, 410.0, 415.0))])
    assert times.least_s == {"b": 30.0, "d": 5.0}
    marginal = times.raised({"b": 25.0}, 4.0)
    assert marginal.at("b", 0) == pytest.approx(30 + 4 * 5)
    assert marginal.at("b", 1) == pytest.approx(100 + 4 * 75)
    assert marginal.at("d", 0) == pytest.approx(5.0), "nothing is known of a calm road"
    assert marginal.at("c", 0) == FREE_S["c"]
    assert times.at("b", 1) == pytest.approx(100.0)


@pytest.mark.slow
@pytest.mark.proof
def test_routes_that_take_less_in_all_than_those_that_drivers_find(sumo: None, tmp_path: Path) -> None:
    """The neck of the main way carries less than comes, and the other way takes 83 s longer: drivers queue until
    that takes as long, though fewer of them on the main way would cost less in all."""
    longer = EDGES | {
        "main": ("fork", "gate", 1000.0, 1),
        "neck": ("gate", "join", 200.0, 1),
        "out": ("fork", "side", 1300.0, 1),
        "back": ("side", "join", 1300.0, 1),
    }
    folder = two_ways(tmp_path, longer, "access main neck exit", 2.0)
    found, target = tmp_path / "found", tmp_path / "optimum"
    options = EquilibriumSettings(steps=6, gap=0.01, minutes=15)
    equilibrate(folder, found, options, lambda step: None)
    told: list[optimum.OptimumStep] = []
    compared = optimum.compare(found, target, options, (1, 2, 3), told.append)
    assert tuple(told) == compared.steps
    low, high = compared.interval
    assert low < compared.price_of_anarchy < high
    assert 1.03 < compared.price_of_anarchy < 1.2
    assert compared.kept > 0
    assert compared.steps[compared.kept].total.total_s < 0.96 * compared.steps[0].total.total_s
    assert len(compared.equilibrium) == len(compared.optimum) == 3
    ways = [(path / "equilibrium.rou.xml").read_text().count("access main neck exit") for path in (found, target)]
    assert ways[1] < ways[0], "fewer take the short way"
    assert json.loads((target / optimum.RECORD).read_text())["price_of_anarchy"] == compared.price_of_anarchy
    with pytest.raises(UserError, match="exists"):
        optimum.compare(found, target, options, (1, 2), told.append)


def test_demand_that_would_be_lost_is_refused(jammed: Path, tmp_path: Path) -> None:
    demand = jammed / "two.rou.xml"
    demand.write_text(demand.read_text().replace("</routes>", '<person id="p" depart="0"></person></routes>'))
    with pytest.raises(UserError, match="<person>"):
        equilibrate(jammed, tmp_path / "found", EquilibriumSettings(), lambda step: None)
    assert not (tmp_path / "found").exists()
