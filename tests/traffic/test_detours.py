"""Traffic with routes of its own finds its way round whatever is closed: no vehicle ends the run."""

from collections import Counter
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest

from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.incidents import Closure, Incident, Roadworks
from automotive_cosim.scenarios import Scenario, open_scenario
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.detours import Detours
from tests.traffic.in_process import InProcess

CLOSED = "B2C2"


@dataclass
class Drive:
    """What happened: ids of vehicles."""

    detours: Detours
    departed: set[str] = field(default_factory=set)
    arrived: set[str] = field(default_factory=set)
    teleported: set[str] = field(default_factory=set)
    on_closed: set[str] = field(default_factory=set)
    """Who was on the closed road while it was closed."""


@pytest.fixture(scope="module")
def town(sumo: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A grid of netgenerate, with duarouter's fixed routes between random edges, two vehicles a second."""
    folder = tmp_path_factory.mktemp("town")
    grid = ("--grid", "--grid.number", "5", "--grid.length", "150", "--default.lanenumber", "2")
    assert sumo_programs.run("netgenerate", [*grid, "-o", folder / "town.net.xml"])[0]
    random = np.random.default_rng(1)
    letters = "ABCDE"
    edges = [f"{letters[x]}{y}{letters[x + 1]}{y}" for x in range(4) for y in range(5)]
    trips = "".join(
        '<trip id="t{}" depart="{}" from="{}" to="{}"/>'.format(n, n / 2, *random.choice(edges, 2, replace=False))
        for n in range(400)
    )
    (folder / "trips.xml").write_text(f"<routes>{trips}</routes>")
    routes = ("-n", folder / "town.net.xml", "-r", folder / "trips.xml", "-o", folder / "town.rou.xml")
    assert sumo_programs.run("duarouter", [*routes, "--ignore-errors"])[0]
    return folder


def scenario(folder: Path, *demand: str) -> Scenario:
    """The town with its routes, or with a demand of one's own."""
    routes = folder / "town.rou.xml"
    if demand:
        routes = folder / "own.rou.xml"
        routes.write_text(f"<routes>{''.join(demand)}</routes>")
    config = folder / "town.sumocfg"
    config.write_text(
        f'<configuration><net-file value="town.net.xml"/><route-files value="{routes.name}"/></configuration>'
    )
    opened = open_scenario(str(config))
    return replace(opened, sumo=replace(opened.sumo, warm_up_s=0.0, step_length_s=1.0))


def driven(opened: Scenario, *staged: Incident, duration_s: int = 600) -> Drive:
    """Runs it, and asks SUMO what happened."""
    with closing(InProcess(opened, seed=1, allow_unprojected=True)) as simulation:
        world = simulation.world
        assert world is not None
        for incident in staged:
            world.stage(incident)
        import libsumo

        drive = Drive(world.detours)
        for _ in range(duration_s):
            world.step()
            drive.departed.update(libsumo.simulation.getDepartedIDList())
            drive.arrived.update(libsumo.simulation.getArrivedIDList())
            drive.teleported.update(libsumo.simulation.getStartingTeleportIDList())
            if world.detours.are_needed:
                drive.on_closed.update(libsumo.edge.getLastStepVehicleIDs(CLOSED))
        return drive


@pytest.mark.sumo
def test_fixed_routes_go_round_a_closure(town: Path) -> None:
    """Also of who departs later. Who wants to go there stops before it, who would set out there is left out."""
    free = driven(scenario(town))
    shut = driven(scenario(town), Closure(edge=CLOSED))
    assert not shut.teleported
    assert not shut.on_closed
    assert free.arrived == free.departed, "or the next line says nothing"
    assert shut.arrived == shut.departed
    assert len(free.departed) - len(shut.departed) == shut.detours.kept_in > 0
    assert shut.detours.cut_short > 0


OVER = '<route id="over" edges="A2B2 B2C2 C2D2"/>'


@pytest.mark.sumo
@pytest.mark.parametrize(
    ("demand", "cut_short", "kept_in"),
    [
        (f'{OVER}<flow id="f" begin="30" end="90" period="20" route="over"/>', 0, 0),
        ('<vehicle id="v" depart="30"><route edges="A2B2 B2C2"/></vehicle>', 1, 0),
        ('<trip id="t" depart="30" from="A2B2" to="B2C2"/>', 1, 0),
        ('<vehicle id="v" depart="5"><route edges="A2B2 B2C2"/></vehicle>', 1, 0),
        (f'{OVER}<vehicle id="v" depart="5" route="over"/>', 0, 0),
        ('<vehicle id="v" depart="30"><route edges="B2C2 C2D2"/></vehicle>', 0, 1),
        ('<trip id="t" depart="30" from="B2C2" to="D2E2"/>', 0, 1),
        ('<flow id="f" begin="30" end="60" period="20"><route edges="B2C2 C2D2"/></flow>', 0, 2),
        (f'<vType id="p" vClass="authority"/>{OVER}<vehicle id="v" type="p" depart="30" route="over"/>', 0, 0),
    ],
    ids=[
        "flow",
        "goes-there",
        "trip-there",
        "on-its-way-there",
        "on-its-way",
        "sets-out",
        "trip-from",
        "flow-from",
        "police",
    ],
)
def test_every_kind_of_demand_goes_round(town: Path, demand: str, cut_short: int, kept_in: int) -> None:
    drive = driven(scenario(town, demand), Closure(edge=CLOSED, from_s=10.0), duration_s=200)
    assert (drive.detours.cut_short, drive.detours.kept_in) == (cut_short, kept_in)
    assert not drive.teleported
    assert drive.arrived == drive.departed
    assert bool(drive.departed) != bool(kept_in)
    assert bool(drive.on_closed) == ("authority" in demand)


@pytest.mark.sumo
def test_so_do_they_round_roadworks_that_take_a_turn(town: Path) -> None:
    """Only the right lane of the closed road leads to the right."""
    right = '<route id="right" edges="A2B2 B2C2 C2C1"/><flow id="f" begin="0" end="90" period="15" route="right"/>'
    drive = driven(
        scenario(town, right), Roadworks(edge=CLOSED, limit_kmh=30, closed_lanes=(0,), from_s=20.0), duration_s=250
    )
    assert drive.arrived == drive.departed
    assert not drive.teleported


@pytest.mark.sumo
def test_a_route_that_is_broken_anyway_is_named(town: Path) -> None:
    with pytest.raises(ScenarioError, match=r"vehicle 'v' sets out .* cannot drive its route 'A2B2 C2D2'; mend"):
        driven(scenario(town, '<vehicle id="v" depart="5"><route edges="A2B2 C2D2"/></vehicle>'))


@pytest.mark.sumo
@pytest.mark.parametrize(
    "config",
    [
        "ingolstadt/ingolstadt1/ingolstadt1.sumocfg",
        "ingolstadt/ingolstadt7/ingolstadt7.sumocfg",
        "bologna/acosta/run.sumocfg",
    ],
)
def test_other_peoples_demand_goes_round_its_busiest_road(
    config: str, data_of_others: Callable[[str], Path]
) -> None:
    opened = open_scenario(data_of_others(config))
    opened = replace(opened, sumo=replace(opened.sumo, warm_up_s=200.0, step_length_s=1.0))
    with closing(InProcess(opened, seed=1, allow_unprojected=True)) as simulation:
        world = simulation.world
        assert world is not None
        import libsumo

        ahead = Counter(
            edge
            for each in libsumo.vehicle.getIDList()
            for edge in libsumo.vehicle.getRoute(each)[libsumo.vehicle.getRouteIndex(each) + 1 : -1]
        )
        busiest = next(edge for edge, _ in ahead.most_common() if edge in world.network.edges)
        world.stage(Closure(edge=busiest))
        world.step()
        for _ in range(15):  # who was in the junction before it comes in
            world.step()
        there = set(libsumo.edge.getLastStepVehicleIDs(busiest))
        for _ in range(400):
            world.step()
            assert set(libsumo.edge.getLastStepVehicleIDs(busiest)) <= there, "nobody enters it any more"
        assert ahead[busiest] > 3, "or nobody had to go round"
