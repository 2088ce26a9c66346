"""``automotive-cosim scenarios``: lists, checks, draws and imports scenarios."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from automotive_cosim import scenarios
from automotive_cosim.cli.batches import tell_notes
from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import print_json, tell_opening, tells_json
from automotive_cosim.contracts.plain import counted, megabytes_in_words
from automotive_cosim.errors import UserError
from automotive_cosim.osm.area import Area
from automotive_cosim.osm.settings import ImportOptions

if TYPE_CHECKING:
    from rich.text import Text

    from automotive_cosim.contracts import Json, Tell
    from automotive_cosim.osm.report import ImportReport
    from automotive_cosim.scenarios import Scenario
    from automotive_cosim.scenarios.check import ScenarioProof
    from automotive_cosim.scenarios.streets import StreetEdges
    from automotive_cosim.traffic.stability import Stability

app = typer.Typer(help="List, check, draw and import scenarios.", no_args_is_help=True)


@app.command("list")
@tells_json
def list_scenarios(as_json: bool = False) -> None:
    """List the scenarios that come with the package."""
    from automotive_cosim.scenarios.listing import listed

    if as_json:
        print_json({"scenarios": [_shown(scenarios.load(name)) for name in scenarios.shipped()]})
        return
    rows = [("name", "country", "title", "ego trips"), *listed()]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        typer.echo("  ".join(map(str.ljust, row, widths)).rstrip())


MOST_STREETS, MOST_OF_A_STREET = 8, 6
"""Streets, and edges of each, that `scenarios show` lists; `--json` lists all."""
WHICH = "A shipped scenario's name, a scenario's folder, any .sumocfg or .net.xml(.gz)"


@app.command("show")
@tells_json
def show(scenario: Annotated[str, typer.Argument(help=f"{WHICH}.")], as_json: bool = False) -> None:
    """Show one scenario: its place, time, weather, ego trips, and the edges that options like --incident name."""
    from automotive_cosim.scenarios import open_scenario
    from automotive_cosim.scenarios.streets import streets

    tell_opening(scenario)
    found = open_scenario(scenario)
    known = streets(found)
    if as_json:
        print_json({**_shown(found), **_edges_json(known)})
        return
    tell_notes([found], runs=False)
    typer.echo(f"{found.name}: {found.title}\n{found.about.strip()}\n")
    for label, value in (
        ("folder", found.folder),
        ("country", found.country or "unknown"),
        ("starts", f"{found.start:%A %Y-%m-%d %H:%M %Z}"),
        ("weather", _weather(found)),
        ("steps", f"{found.sumo.step_length_s:g} s, after {found.sumo.warm_up_s:g} s of warm-up"),
        ("demand", f"scale {found.sumo.scale:g}, {found.sumo.background_rerouting:.0%} reroute"),
        ("driver", found.ego.driver),
    ):
        typer.echo(f"{label:<9}{value}")
    for place, trip in enumerate(found.ego.trips, 1):
        typer.echo(f"{f'trip {place}':<9}{trip.name}: {trip.about or f'{trip.from_edge} to {trip.to_edge}'}")
    for place, line in enumerate(_edges_told(known)):
        typer.echo(f"{'' if place else 'edges':<9}{line}")
    typer.echo(f"{'':<9}all of them: automotive-cosim scenarios show {scenario} --json")


def _edges_told(known: Sequence[StreetEdges]) -> Iterator[str]:
    """How many edges there are, and the first of the longest streets."""
    named = [street for street in known if street.name]
    count = sum(len(street.edges) for street in known)
    yield f"{counted(count, 'edge')} open to cars, on {counted(len(named), 'named street')}" + (
        "; the longest:" if named else ", such as:"
    )
    for street in (named or known)[:MOST_STREETS]:
        ids = [edge.edge_id for edge in street.edges]
        more = f" and {len(ids) - MOST_OF_A_STREET} more" if len(ids) > MOST_OF_A_STREET else ""
        yield f"{street.name or 'without a name'}: {', '.join(ids[:MOST_OF_A_STREET])}{more}"


def _edges_json(known: Sequence[StreetEdges]) -> Json:
    return {
        "edge_count": sum(len(street.edges) for street in known),
        "edges": [
            {
                "id": edge.edge_id,
                "street": edge.name,
                "length_m": round(edge.length_m, 1),
                "road_class": edge.road_class,
            }
            for street in known
            for edge in street.edges
        ],
    }


def _shown(scenario: Scenario) -> Json:
    """A scenario as a JSON object."""
    return {
        "name": scenario.name,
        "title": scenario.title,
        "about": scenario.about.strip(),
        "folder": str(scenario.folder),
        "country": scenario.country,
        "starts": scenario.start.isoformat(),
        "weather": _weather(scenario),
        "step_length_s": scenario.sumo.step_length_s,
        "warm_up_s": scenario.sumo.warm_up_s,
        "demand_scale": scenario.sumo.scale,
        "rerouting_share": scenario.sumo.background_rerouting,
        "driver": str(scenario.ego.driver),
        "trips": [
            {"name": trip.name, "about": trip.about, "from_edge": trip.from_edge, "to_edge": trip.to_edge}
            for trip in scenario.ego.trips
        ],
        "notes": list(scenario.notes),
    }


def _weather(scenario: Scenario) -> str:
    if not scenario.weather:
        return "drawn by seed from the climate of the place and month"
    first = scenario.weather[0].weather
    changes = f", {counted(len(scenario.weather) - 1, 'change')} to come" if len(scenario.weather) > 1 else ""
    return f"{first.temperature_2m:g} °C, {first.precipitation:g} mm/h, visibility {first.visibility:g} m{changes}"


Names = Annotated[
    list[str] | None,
    typer.Argument(
        help=f"{WHICH}; by default, all shipped scenarios.", metavar="[SCENARIO]...", show_default=False
    ),
]


@app.command("check")
@tells_json
def check_scenarios(
    names: Names = None,
    quick: Annotated[bool, typer.Option("--quick", help="Skip the hour of traffic.")] = False,
    as_json: bool = False,
) -> None:
    """Prove that scenarios are as described; exit code 1 if one is not.

    Each is loaded, warmed up and located. Its streets and limits are compared with those that it states, every trip
    of the ego is driven to its end, its situations must occur, and its traffic must flow for an hour."""
    from automotive_cosim.scenarios import open_scenario
    from automotive_cosim.scenarios.check import check

    proofs = []
    tell_opening(*names or ())
    for scenario in [open_scenario(name) for name in names or scenarios.shipped()]:
        tell_notes([scenario])
        with _progress() as tell:
            proofs.append(check(scenario, quick=quick, tell=tell))
        if not as_json:
            _print_proof(proofs[-1])
    ok = all(proof.ok for proof in proofs)
    if as_json:
        print_json({"ok": ok, "scenarios": [proof.as_json() for proof in proofs]})
    if not ok:
        raise typer.Exit(1)


def _print_proof(proof: ScenarioProof) -> None:
    from rich.table import Table
    from rich.text import Text

    from automotive_cosim.cli.console import Console

    table = Table(box=None, show_header=False, pad_edge=False)
    for item in proof.items:
        table.add_row("", _yes_or_no(item.ok), Text(item.name), Text(item.detail))
    console = Console(highlight=False)
    console.print(Text.assemble((proof.scenario, "bold"), " holds: ", _yes_or_no(proof.ok)))
    console.print(table)


def _yes_or_no(ok: bool) -> Text:
    from rich.text import Text

    return Text("yes", "green") if ok else Text("no", "bold red")


@app.command("render")
def render(
    names: Names = None,
    out: Annotated[
        Path | None,
        typer.Option(help="A .png or .webp file, or a folder for several.", show_default="runs/maps/NAME.webp"),
    ] = None,
) -> None:
    """Draw scenarios from above: road classes, names, limits, tunnels and the ego's trips."""
    from automotive_cosim.scenarios import open_scenario
    from automotive_cosim.scenarios.picture import ENDINGS, save_picture

    tell_opening(*names or ())
    found = [open_scenario(name) for name in names or scenarios.shipped()]
    to_file = out is not None and not out.is_dir() and bool(out.suffix)
    if out and to_file and (out.suffix.lower() not in ENDINGS or len(found) > 1):
        wanted = "a folder" if len(found) > 1 else f"a file that ends in {' or '.join(ENDINGS)}"
        raise UserError(f"--out {out} does not fit; give {wanted}")
    for scenario in found:
        target = out if out and to_file else (out or Path("runs/maps")) / f"{scenario.name}.webp"
        unwritten = save_picture(scenario, target)
        typer.echo(f"{target} written")
        if unwritten:
            left_out = counted(len(unwritten), "street name")
            typer.echo(f"{left_out} left out, such as {unwritten[0]}: no installed font has that script", err=True)


@app.command("import")
@takes(ImportOptions)
def import_scenario(
    file: Annotated[
        Path,
        typer.Argument(
            help="OSM extract: .osm, .osm.gz, .osm.bz2, .osm.pbf or Overpass JSON; or OpenSCENARIO XML: .xosc."
        ),
    ],
    out: Annotated[Path | None, typer.Option(help="Folder to create; by default, the scenario's name.")] = None,
    network: Annotated[
        Path | None,
        typer.Option(
            help="For a .xosc file: a SUMO network instead of the OpenDRIVE file that it names.", show_default=False
        ),
    ] = None,
    ego: Annotated[str, typer.Option(help="For a .xosc file: the entity that is the cockpit's car.")] = "ego",
    **settings: Any,
) -> None:
    """Turn an OpenStreetMap extract, or a scenario in OpenSCENARIO XML, into a scenario.

    The traffic is scaled down until it flows after its warm-up: for half an hour (--minutes) in steps of 1 s, then
    for ten minutes in the scenario's own. Reading the map, building the
    network and testing the traffic take one to three minutes for a city district."""
    from automotive_cosim.osm.importer import import_map, scenario_name

    options = filled(ImportOptions, settings)
    if file.suffix == ".xosc":
        from automotive_cosim.exchange.incoming import import_openscenario

        made = import_openscenario(
            file,
            out or Path(options.name or file.stem),
            network,
            ego,
            country=options.country,
            replaces=options.replaces,
        )
        typer.echo(f"{made} written; run it with `automotive-cosim run --scenario {made}`")
        return
    name = options.name or scenario_name(file)
    folder = out or Path(name)
    started_s = time.monotonic()
    with _progress() as tell:
        report = import_map(file, folder, options, tell)
    _print_report(report, name, folder, time.monotonic() - started_s)


@app.command("download")
def download_map(
    bbox: Annotated[
        Area,
        typer.Option(
            metavar="W,S,E,N",
            help="West, south, east and north, in degrees.",
            parser=Area.parse,
            show_default=False,
        ),
    ],
    endpoint: Annotated[
        str,
        typer.Option(
            envvar="AUTOMOTIVE_COSIM_OVERPASS",
            metavar="URL",
            help="URL of an Overpass server's interpreter; its operator sets the terms of use.",
        ),
    ],
    out: Annotated[Path, typer.Option(help="File to create, for `scenarios import`.")] = Path("map.osm"),
) -> None:
    """Fetch the roads of an area from an Overpass server of your choice."""
    from automotive_cosim.osm.folder import ATTRIBUTION
    from automotive_cosim.osm.overpass import download

    with _progress() as tell:
        found = download(endpoint, bbox, out, tell=tell)
    dated = f", as of {found.map_date}" if found.map_date else ""
    typer.echo(f"{out}: {megabytes_in_words(found.size_mb)}{dated}\n{ATTRIBUTION}")
    if found.note:
        typer.echo(found.note)
    typer.echo(f"turn it into a scenario: automotive-cosim scenarios import {out}")


SAY_EVERY_S = 30.0
"""Minimum wall time between two lines about the same activity in a log."""


@contextmanager
def _progress() -> Iterator[Tell]:
    """The current activity on stderr: one changing line in a terminal, occasional lines in a log."""
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    from automotive_cosim.cli.console import Console

    console = Console(stderr=True)
    if not console.is_terminal:
        yield _into_log()
        return
    columns = (TextColumn("{task.description}", markup=False), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=None)

        def tell(stage: str, share: float | None) -> None:
            bar.update(task, description=stage, total=None if share is None else 1.0, completed=share or 0.0)

        yield tell


def _into_log() -> Tell:
    said, said_at_s = "", -math.inf

    def tell(stage: str, share: float | None) -> None:
        nonlocal said, said_at_s
        now_s, what = time.monotonic(), stage.partition(",")[0]
        if what == said and now_s - said_at_s < SAY_EVERY_S:
            return
        said, said_at_s = what, now_s
        typer.echo(stage if share is None else f"{stage}: {share:.0%} done", err=True)

    return tell


def _agreement(report: ImportReport) -> str:
    if not report.differences:
        return (
            "access, direction, limit, name, class, tunnel and lanes of every edge; barriers and turns;"
            " what was not followed is below, as guessed"
        )
    return f"all but {counted(len(report.differences), 'property', 'properties')}:"


def _tested(flow: Stability) -> str:
    """How many vehicles were teleported in the last test of the traffic, with its steps."""
    return f"{flow.teleports} in the last test, {flow.observed_s / 60:.0f} min in steps of {flow.step_length_s:g} s"


DIFFERENCES_SHOWN = 20
"""How many the terminal lists; ``import.json`` has all."""


def _print_report(report: ImportReport, name: str, folder: Path, took_s: float) -> None:
    from rich.table import Table

    from automotive_cosim.cli.console import Console
    from automotive_cosim.osm.doubts import by_kind

    size_mb = sum(path.stat().st_size for path in folder.iterdir()) / 1e6
    flow = report.stability
    table = Table(box=None, show_header=False, pad_edge=False)
    for label, value in (
        ("scenario", f"{name}, in {folder}"),
        *([("within", ",".join(f"{side:g}" for side in report.bbox))] if report.bbox else []),
        ("country", report.country + (", driving on the left" if report.left_hand else "")),
        ("edges", f"{report.edges} ({report.road_km:.1f} km)"),
        ("limits", f"posted on {report.posted_share:.1%} of the length, assumed on the rest"),
        ("derestricted", f"{report.derestricted_km:.1f} km"),
        ("as mapped", _agreement(report)),
        *(("", text) for text in report.differences[:DIFFERENCES_SHOWN]),
        *([("", "…; import.json has all")] if len(report.differences) > DIFFERENCES_SHOWN else []),
        ("signals", f"{report.signals}, roundabouts {report.roundabouts}"),
        ("tunnels", f"{counted(report.tunnels, 'edge')} ({report.tunnel_km:.1f} km)"),
        ("lamps", f"known for {report.lit_known_share:.0%} of the length"),
        ("built-up", f"area or not: known for {report.built_up_known_share:.0%} of the length"),
        ("schools", f"{report.school_zone_km:.1f} km; time-dependent limits on {report.timed_limit_km:.1f} km"),
        *(
            [
                (
                    "timed",
                    f"{report.timed_access_km:.1f} km and {counted(report.timed_turns, 'turn')} open to cars at "
                    "certain hours only",
                )
            ]
            if report.timed_access_km or report.timed_turns
            else []
        ),
        ("bus lanes", f"{report.bus_lane_km:.1f} km, speed cameras {report.speed_cameras}"),
        ("ground", ", ".join(f"{count:,} of {kind}" for kind, count in report.ground.items())),
        ("traffic", f"{report.vehicles_per_hour:.0f} vehicles per hour, about {flow.vehicles_mean:.0f} at a time"),
        ("scale", f"{report.scale:g} of the requested density"),
        ("halted", f"{flow.halted_share_mean:.1%} on average, {flow.halted_share_max:.1%} in the worst minute"),
        ("teleports", _tested(flow)),
        ("took", f"{took_s:.0f} s, {megabytes_in_words(size_mb)}"),
        *(("guessed" if index == 0 else "", text) for index, text in enumerate(by_kind(report.guessed))),
        ("drive it", f"automotive-cosim run --scenario {folder}"),
        ("map", report.attribution),
    ):
        table.add_row(label, value)
    Console().print(table)
