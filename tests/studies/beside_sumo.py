"""What a run makes of a ``.sumocfg``, beside what ``sumo -c`` makes of it with the same seed.

``python -m tests.studies.beside_sumo`` writes the tables of ``docs/reference/beside-sumo.md``.
"""

import os
import re
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import closing, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import fmean, median

from automotive_cosim import scenarios
from automotive_cosim.contracts import EgoEnd
from automotive_cosim.errors import NoRoomError
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.studies.calls.flow import flow
from automotive_cosim.studies.calls.ledger import keep_ledger, run_on
from automotive_cosim.studies.congestion.outputs import read_flows
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.options import Configuration, edge_data, read_configuration
from automotive_cosim.traffic.sumo_programs import environment, program, run
from tests.scenarios.test_foreign import OTHERS

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "beside-sumo.md"
CLASSES = ["passenger", "private", "hov", "evehicle", "taxi", "delivery", "truck", "trailer", "bus", "coach"]
CLASSES += ["motorcycle", "moped", "bicycle", "emergency", "authority", "army", "vip", "custom1"]
MADE = "all classes of vehicle"
SEED = 1
INTERVAL_S = 60.0
DEPARTURES, DEPARTS_EVERY_S, LONGEST_DRIVE_S = 4, 240.0, 3600.0
NOTICED_S = 10.0
"""Below so much, a delay told is no news, and a ratio to it is chance."""
FIGURES = ("vehicle-km", "vehicle-h", "h lost", "h standing")


@dataclass(frozen=True, slots=True)
class Side:
    """Some minutes without an ego, in a run or in SUMO: lines of edgeData, ``FIGURES`` over all edges by the
    program that reads our outputs, and the tripinfo of each vehicle that has arrived, if wanted."""

    edges: list[str]
    figures: tuple[float, ...]
    trips: dict[str, str]


def beside(config: Path, warm_s: float = 120.0, drive_s: float = 240.0, *, trips: bool = True) -> tuple[Side, Side]:
    """Ours and SUMO's, from the configuration's begin; the edges count after ``warm_s``."""
    scenario = open_scenario(config)
    scenario = replace(scenario, sumo=replace(scenario.sumo, warm_up_s=warm_s))
    given = read_configuration(scenario.config)
    with tempfile.TemporaryDirectory() as scratch:
        ours, sumos = Path(scratch) / "ours", Path(scratch) / "sumos"
        for name, flow_s in (("edges.xml", INTERVAL_S), ("tripinfo.xml", None))[: 1 + trips]:
            _ours(scenario, drive_s, ours, flow_s).joinpath(name).rename(ours / name)
        _sumos(given, sumos, warm_s, drive_s, "--precision=4")
        if trips:
            _sumos(given, sumos / "trips", warm_s, drive_s, "--precision=6", "--tripinfo-output=../tripinfo.xml")
        return _side(ours, given), _side(sumos, given)


def _ours(scenario: scenarios.Scenario, drive_s: float, folder: Path, flow_s: float | None) -> Path:
    """A copy of the warm traffic to which nothing is done, as a congestion study drives it; returns its outputs."""
    outputs = folder / f"flow{flow_s}"
    outputs.mkdir(parents=True)
    with closing(Forked(scenario, SEED, allow_unprojected=True, outputs=outputs, flow_s=flow_s)) as warm:
        warm.call(keep_ledger)
        with closing(warm.copy()) as copy:
            copy.begin(flow, drive_s, INTERVAL_S)
            copy.ended()
        assert copy.outputs is not None
        return copy.outputs


def _sumos(given: Configuration, folder: Path, warm_s: float, drive_s: float, *options: str) -> None:
    """SUMO's run of the configuration itself."""
    from_s = given.begin_s + warm_s
    folder.mkdir(exist_ok=True)
    (folder / "flow.add.xml").write_text(edge_data("edges.xml", from_s, INTERVAL_S))
    added = ",".join(map(str, (*given.files.get("additional-files", ()), "flow.add.xml")))
    end = [] if from_s + drive_s >= given.number("end", 1e9) else ["--end", from_s + drive_s]
    command = [program("sumo"), "-c", given.path.absolute(), "-a", added, "--seed", SEED, *end, *options]
    command += ["--no-step-log", "--no-warnings", "--log", os.devnull]
    subprocess.run(list(map(str, command)), check=True, cwd=folder, env=environment(), stdout=subprocess.DEVNULL)


def _side(folder: Path, given: Configuration) -> Side:
    edges, trips = folder / "edges.xml", folder / "tripinfo.xml"
    flows = [each.flow for each in read_flows(folder, given.begin_s)]
    km = sum(each.distance_m for each in flows) / 1000
    hours = (sum(getattr(each, of) for each in flows) / 3600 for of in ("time_s", "lost_s", "standing_s"))
    found = re.finditer(r'<tripinfo id="([^"]*)"[^>]*', trips.read_text(encoding="utf-8") if trips.exists() else "")
    return Side(
        re.findall("<(?:interval|edge) .*", edges.read_text(encoding="utf-8")),
        (km, *hours),
        # without the devices, which make the outputs
        {each[1]: re.sub(' devices="[^"]*"', "", each[0]).rstrip("/ ") for each in found},
    )


def made(folder: Path, end_s: int = 360) -> Path:
    """A network with every class of vehicle, sublanes, people on foot, devices that are drawn, and a flow that only
    ``end`` spaces out."""
    grid = "--grid --grid.number 4 --grid.length 180 -L 2 --sidewalks.guess --crossings.guess --bikelanes.guess"
    assert run("netgenerate", [*grid.split(), "--no-turnarounds", "--tls.guess", "-o", "made.net.xml"], folder)[0]
    types = "".join(f'<vType id="{each}" vClass="{each}"/>' for each in CLASSES)
    ways = ("A0A1", "D3D2"), ("D0C0", "A3B3"), ("A2B2", "D1D0"), ("C3C2", "B0A0")
    flows = "".join(
        f'<flow id="f{number}" type="{each}" begin="0" end="{end_s}" probability="0.03" departSpeed="max" '
        f'from="{ways[number % 4][0]}" to="{ways[number % 4][1]}"/>'
        for number, each in enumerate(CLASSES)
    )
    (folder / "made.rou.xml").write_text(
        f'<routes>{types}<vTypeDistribution id="mix" vTypes="truck moped passenger"/>{flows}'
        '<flow id="mixed" type="mix" begin="0" number="60" from="B3B2" to="C0C1" departLane="random"/>'
        f'<personFlow id="p" begin="0" end="{end_s}" period="9"><walk from="A0A1" to="C2C3"/></personFlow></routes>'
    )
    (folder / "made.sumocfg").write_text(
        '<configuration><net-file value="made.net.xml"/><route-files value="made.rou.xml"/>'
        f'<end value="{end_s}"/>'
        '<step-length value="0.5"/><lateral-resolution value="0.8"/>'
        '<device.friction.probability value="0.3"/><device.driverstate.probability value="0.2"/>'
        '<device.rerouting.probability value="0.4"/><device.rerouting.period value="30"/></configuration>'
    )
    return folder / "made.sumocfg"


def networks(folder: Path) -> Iterator[tuple[str, Path]]:
    """The shipped networks, those of others that are there, and a generated one."""
    for name in scenarios.shipped():
        yield name, scenarios.load(name).config
    data = os.environ.get("AUTOMOTIVE_COSIM_TEST_DATA")
    yield from ((name, Path(data) / path) for name, path in OTHERS.items() if data and (Path(data) / path).exists())
    yield MADE, made(folder)


def delays(
    scenario: scenarios.Scenario, departures: int = DEPARTURES
) -> Iterator[tuple[float, float, float, float]]:
    """Of each drive that arrives, in seconds: the delay that the ego is told at its departure, what it then takes
    longer than at the limits, the time that it is told, and the time that it takes."""
    with closing(Forked(scenario, SEED, allow_unprojected=True)) as warm:
        warm.call(keep_ledger)
        for number in range(departures):
            if number:
                warm.call(run_on, DEPARTS_EVERY_S)
            for trip in scenario.ego.trips:
                with suppress(NoRoomError), closing(warm.depart(EgoPlan(trip, "steady", SEED))) as drive:
                    first = drive.state
                    while drive.state.end is None and drive.state.time_s < first.time_s + LONGEST_DRIVE_S:
                        drive.advance(60.0)
                    if drive.state.end is EgoEnd.ARRIVED:
                        took_s, told = drive.state.time_s - first.time_s, first.ahead
                        yield told.delay_s, took_s - told.eta_s + told.delay_s, told.eta_s, took_s


def delay_table(folder: Path) -> Iterator[str]:
    """The lines of the page's table of delays, of shipped networks as their ``scenario.toml`` has them but
    for incidents, which nobody could foresee."""
    yield "| network | drives | told, s | lost, s | lost/told, median | time taken/told, median | farthest off |"
    yield "|---|---:|---:|---:|---:|---:|---|"
    for name, config in networks(folder):
        if name == MADE:  # it has traffic for six minutes
            continue
        if name in scenarios.shipped():
            scenario = replace(scenarios.load(name), incidents=())
        else:
            scenario = open_scenario(config)
        rows = list(delays(scenario))
        told_s, lost_s, eta_s, took_s = zip(*rows, strict=True)
        ratios = [lost / told for told, lost, *_ in rows if told >= NOTICED_S]
        ratio = f"{median(ratios):.2f}" if ratios else "–"
        times = median(took / eta for eta, took in zip(eta_s, took_s, strict=True))
        told, lost, *_ = max(rows, key=lambda row: abs(row[0] - row[1]))
        worst = f"told {told:.0f} s, lost {lost:.0f} s"
        means = f"{fmean(told_s):.0f} | {fmean(lost_s):.0f}"
        yield f"| {name} | {len(rows)} | {means} | {ratio} | {times:.2f} | {worst} |"


def table(folder: Path) -> Iterator[str]:
    """The lines of the page's table of outputs."""
    yield f"| network | vehicles arrived | of these otherwise | {' | '.join(FIGURES)} | difference |"
    yield "|---|" + "---:|" * (3 + len(FIGURES))
    for name, config in networks(folder):
        ours, sumos = beside(config)
        most = max(abs(one - two) for one, two in zip(ours.figures, sumos.figures, strict=True))
        other = {vehicle for vehicle, _ in ours.trips.items() ^ sumos.trips.items()}
        cells = [name, len(sumos.trips), len(other), *(f"{each:.3f}" for each in ours.figures)]
        yield f"| {' | '.join(map(str, cells))} | {most:.9g} |"


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as there:
        page = PAGE.read_text(encoding="utf-8")
        for made_of in (table, delay_table):
            lines = list(made_of(Path(there)))
            page = re.sub(rf"{re.escape(lines[0])}\n(\|.*\n)*", "\n".join(lines) + "\n", page)
        PAGE.write_text(page, encoding="utf-8")
