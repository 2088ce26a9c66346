"""``automotive-cosim measures``: surrogate measures of safety of recorded trials, as CSV."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.contracts.plain import counted
from automotive_cosim.measures.thresholds import Thresholds


@takes(Thresholds, only=["ttc_s"])
def measures(
    record: Annotated[
        Path,
        typer.Argument(
            help="Folder of `run` or `eval`, of one of its runs in pictures/, or a road.jsonl.gz.",
            show_default=False,
        ),
    ],
    everyone: Annotated[
        bool, typer.Option("--everyone", help="All pairs of vehicles, and not only those with the ego.")
    ] = False,
    readings: Annotated[
        bool, typer.Option("--readings", help="A line for each pair and second, and not for each encounter.")
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(
            help="File for the table: Parquet if its name ends in .parquet, else CSV.",
            show_default="standard output",
        ),
    ] = None,
    **settings: Any,
) -> None:
    """Print the encounters of recorded runs with their surrogate measures of safety, as CSV or Parquet.

    Those of an evaluation have a first column `trial`, with the id."""
    from automotive_cosim.exchange.needs import check_formats
    from automotive_cosim.exchange.trajectories import write_frame
    from automotive_cosim.formats.writing import write_whole
    from automotive_cosim.measures.encounters import (
        Encounter,
        PairReading,
        as_csv,
        as_frame,
        encounters,
        pair_readings,
    )
    from automotive_cosim.run.road import read_record, roads_in

    roads = {"": record} if record.is_file() else roads_in(record)
    check_formats(["parquet"] if out is not None and out.suffix == ".parquet" else [])
    thresholds = filled(Thresholds, settings)
    ego = None if everyone else "ego"
    kind: type[Encounter] | type[PairReading] = PairReading if readings else Encounter
    rows: list[Any] = []
    trials: list[str] = []
    seconds = 0
    for trial, path in roads.items():
        scenes = [(second.at_s, second.vehicles) for second in read_record(path).seconds]
        mine = list((pair_readings if readings else encounters)(scenes, ego, thresholds))
        rows += mine
        trials += [trial] * len(mine)
        seconds += len(scenes)
    column = None if "" in roads else trials
    if not rows:
        whose = "any two vehicles" if everyone else "the ego and another vehicle (--everyone looks at all pairs)"
        typer.echo(
            f"no encounters within {thresholds.range_m:g} m in {counted(seconds, 'second')}, of {whose}", err=True
        )
    if out is None:
        typer.echo(as_csv(rows, kind, column), nl=False)
        return
    if out.suffix == ".parquet":
        write_frame(as_frame(rows, kind, column), out)
    else:
        write_whole(out, as_csv(rows, kind, column))
    typer.echo(f"{counted(len(rows), 'line')} in {out}")
