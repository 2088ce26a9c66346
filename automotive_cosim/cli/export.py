"""``automotive-cosim export``: a kept trial in the formats of other tools."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from automotive_cosim.cli.options import reads_results
from automotive_cosim.errors import UserError

ROAD, SCENARIO, TRACE, FCD, TABLE = "road.xodr", "scenario.xosc", "trace_gt.osi", "fcd.xml", "trajectories"


@reads_results
def export(
    trial: Annotated[
        Path,
        typer.Argument(
            help="Folder of `run` or `drive` with --out, or of one trial in pictures/ of `eval`.",
            show_default=False,
        ),
    ],
    openscenario: Annotated[
        str | None,
        typer.Option(help=f"Write {SCENARIO} in this version of OpenSCENARIO XML: 1.2 or 1.3.", metavar="VERSION"),
    ] = None,
    opendrive: Annotated[
        bool, typer.Option("--opendrive", help=f"Write the road as {ROAD}, which {SCENARIO} then names.")
    ] = False,
    osi: Annotated[bool, typer.Option("--osi", help=f"Write {TRACE}, a trace of OSI ground truth.")] = False,
    fcd: Annotated[bool, typer.Option("--fcd", help=f"Write {FCD}, SUMO's floating car data.")] = False,
    table: Annotated[bool, typer.Option("--csv", help=f"Write {TABLE}.csv.")] = False,
    parquet: Annotated[bool, typer.Option("--parquet", help=f"Write {TABLE}.parquet.")] = False,
    out: Annotated[Path | None, typer.Option(help="Folder for the files.", show_default="TRIAL/exchange")] = None,
) -> None:
    """Write a kept trial in the formats of others: OpenSCENARIO XML, OpenDRIVE, OSI, SUMO's FCD, CSV, Parquet."""
    from automotive_cosim.exchange.needs import check_formats
    from automotive_cosim.exchange.opendrive import write_opendrive
    from automotive_cosim.exchange.openscenario import write_openscenario
    from automotive_cosim.exchange.osi import write_osi
    from automotive_cosim.exchange.recording import read_recording
    from automotive_cosim.exchange.trajectories import write_csv, write_fcd, write_parquet
    from automotive_cosim.run.store import cannot_write
    from automotive_cosim.scenarios import open_scenario
    from automotive_cosim.traffic.options import read_configuration

    if not (openscenario or opendrive or osi or fcd or table or parquet):
        raise UserError("nothing to write; give --openscenario 1.3, --opendrive, --osi, --fcd, --csv or --parquet")
    check_formats(openscenario=openscenario, opendrive=opendrive, osi=osi, parquet=parquet)
    recording = read_recording(trial)
    folder = out or trial / "exchange"
    written = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if opendrive:
            write_opendrive(read_configuration(open_scenario(recording.scenario).config).net, folder / ROAD)
            written.append(ROAD)
        if openscenario:
            write_openscenario(recording, folder / SCENARIO, openscenario, folder / ROAD if opendrive else None)
            written.append(SCENARIO)
        if osi:
            write_osi(recording, folder / TRACE, folder / ROAD if opendrive else None)
            written.append(TRACE)
        for name, wanted, write in (
            (FCD, fcd, write_fcd),
            (f"{TABLE}.csv", table, write_csv),
            (f"{TABLE}.parquet", parquet, write_parquet),
        ):
            if wanted:
                write(recording, folder / name)
                written.append(name)
    except OSError as error:
        raise cannot_write(folder, error) from error
    typer.echo(f"{', '.join(written)} in {folder}")
