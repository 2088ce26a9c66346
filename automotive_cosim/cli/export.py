"""``automotive-cosim export``: a kept trial in the formats of other tools."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import reads_results
from automotive_cosim.errors import UserError
from automotive_cosim.exchange.settings import ExportFormats

if TYPE_CHECKING:
    from automotive_cosim.exchange.recording import Recording

ROAD, SCENARIO, FCD, TABLE = "road.xodr", "scenario.xosc", "fcd.xml", "trajectories"


@reads_results
@takes(ExportFormats)
def export(
    trial: Annotated[
        Path,
        typer.Argument(
            help="Folder of `run` or `drive` with --out, or of one run in pictures/ of `eval`.",
            show_default=False,
        ),
    ],
    out: Annotated[Path | None, typer.Option(help="Folder for the files.", show_default="TRIAL/exchange")] = None,
    **settings: Any,
) -> None:
    """Write a kept run in the formats of others: OpenSCENARIO XML, OpenDRIVE, OSI, SSAM, FCD, CSV, Parquet."""
    from automotive_cosim.exchange.needs import check_formats
    from automotive_cosim.exchange.openscenario import write_openscenario
    from automotive_cosim.exchange.osi import trace_name, write_osi
    from automotive_cosim.exchange.recording import read_recording
    from automotive_cosim.exchange.ssam import write_trajectories
    from automotive_cosim.exchange.trajectories import write_csv, write_fcd, write_parquet
    from automotive_cosim.formats.writing import make_folder
    from automotive_cosim.run.store import cannot_write

    formats = filled(ExportFormats, settings)
    if not formats:
        raise UserError(
            "nothing to write; give --openscenario 1.3, --opendrive, --osi, --ssam, --fcd, --csv or --parquet"
        )
    check_formats(formats)
    recording = read_recording(trial)
    folder, written = out or trial / "exchange", []
    road = folder / ROAD if formats.opendrive else None
    trace = trace_name(recording) if formats.osi else ""
    try:
        folder = make_folder(out) if out else make_folder(trial, "exchange")
        for name, wanted, write in (
            (ROAD, formats.opendrive, _write_road),
            (
                SCENARIO,
                formats.openscenario,
                partial(write_openscenario, version=formats.openscenario or "", road=road),
            ),
            (f"{trace}.osi", formats.osi, partial(write_osi, road=road)),
            (f"{trace}.mcap", formats.osi, partial(write_osi, road=road)),
            (f"{TABLE}.trj", formats.ssam, write_trajectories),
            (FCD, formats.fcd, write_fcd),
            (f"{TABLE}.csv", formats.csv, write_csv),
            (f"{TABLE}.parquet", formats.parquet, write_parquet),
        ):
            if wanted:
                write(recording, folder / name)
                written.append(name)
    except OSError as error:
        raise cannot_write(folder, error) from error
    typer.echo(f"{', '.join(written)} in {folder}")


def _write_road(recording: Recording, target: Path) -> None:
    from automotive_cosim.exchange.opendrive import write_opendrive
    from automotive_cosim.scenarios import open_scenario
    from automotive_cosim.traffic.options import read_configuration

    write_opendrive(read_configuration(open_scenario(recording.scenario).config).net, target)
