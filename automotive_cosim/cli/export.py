"""``automotive-cosim export``: a kept trial in the formats of other tools."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from automotive_cosim.cli.options import reads_results

if TYPE_CHECKING:
    from automotive_cosim.exchange.recording import Recording

ROAD, SCENARIO, FCD, TABLE = "road.xodr", "scenario.xosc", "fcd.xml", "trajectories"


@reads_results
def export(
    trial: Annotated[
        Path,
        typer.Argument(
            help="Folder of `run` with --out, or of one run in pictures/ of `eval`.", show_default=False
        ),
    ],
    formats: Annotated[
        list[str],
        typer.Argument(
            metavar="FORMAT...",
            help="openscenario-1.3, openscenario-1.2, opendrive (which the scenario then names), osi, ssam, fcd, "
            "csv or parquet.",
            show_default=False,
        ),
    ],
    out: Annotated[Path | None, typer.Option(help="Folder for the files.", show_default="TRIAL/exchange")] = None,
) -> None:
    """Write a kept run in the formats of others: OpenSCENARIO XML, OpenDRIVE, OSI, SSAM, FCD, CSV, Parquet."""
    from automotive_cosim.exchange.needs import OPENSCENARIO, check_formats
    from automotive_cosim.exchange.openscenario import write_openscenario
    from automotive_cosim.exchange.osi import trace_name, write_osi
    from automotive_cosim.exchange.recording import read_recording
    from automotive_cosim.exchange.ssam import write_trajectories
    from automotive_cosim.exchange.trajectories import write_csv, write_fcd, write_parquet
    from automotive_cosim.formats.writing import make_folder
    from automotive_cosim.run.store import cannot_write

    check_formats(formats)
    recording = read_recording(trial)
    folder, written = out or trial / "exchange", []
    road = folder / ROAD if "opendrive" in formats else None
    trace = trace_name(recording) if "osi" in formats else ""
    try:
        folder = make_folder(out) if out else make_folder(trial, "exchange")
        versions = [version for word, version in OPENSCENARIO.items() if word in formats]
        for name, wanted, write in (
            (ROAD, "opendrive" in formats, _write_road),
            (SCENARIO, bool(versions), partial(write_openscenario, version="".join(versions[-1:]), road=road)),
            (f"{trace}.osi", "osi" in formats, partial(write_osi, road=road)),
            (f"{trace}.mcap", "osi" in formats, partial(write_osi, road=road)),
            (f"{TABLE}.trj", "ssam" in formats, write_trajectories),
            (FCD, "fcd" in formats, write_fcd),
            (f"{TABLE}.csv", "csv" in formats, write_csv),
            (f"{TABLE}.parquet", "parquet" in formats, write_parquet),
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
