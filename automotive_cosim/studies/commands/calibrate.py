"""``automotive-cosim scenarios calibrate``: a demand that reproduces counts in simulation."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import print_json, tells_json
from automotive_cosim.studies.calibration.settings import CalibrationOptions

if TYPE_CHECKING:
    from automotive_cosim.studies.calibration.result import Calibration


@tells_json
@takes(CalibrationOptions, but=("seed",))
def calibrate_scenario(
    scenario: Annotated[
        str, typer.Argument(help="A scenario's folder, a shipped one's name, or any .sumocfg.", show_default=False)
    ],
    counts: Annotated[
        Path,
        typer.Option(
            help="Hourly counts: a workbook or CSV with site,hour,vehicles_per_hour and edge or lon,lat,bearing;"
            " Open Data Paris' (medians over Mondays to Fridays); SUMO's edge data; or what its detectors counted.",
            show_default=False,
        ),
    ],
    out: Annotated[Path | None, typer.Option(help="Folder to create.", show_default="SCENARIO_calibrated")] = None,
    as_json: bool = False,
    **settings: Any,
) -> None:
    """Fit a scenario's traffic to counts, and simulate until it matches them.

    Some sites are held out, to test the fit where nothing was counted. If the traffic gridlocks, the exit code is 1
    and nothing is written."""
    from automotive_cosim.report.charts import require_plots
    from automotive_cosim.scenarios import open_scenario
    from automotive_cosim.studies.calibration.calibrate import calibrate
    from automotive_cosim.studies.calibration.page import PAGE, write_page

    require_plots()
    given = open_scenario(scenario)
    here = given.folder if Path(scenario).is_dir() else Path(given.name)
    target = out or here.with_name(f"{here.name}_calibrated")
    options = filled(CalibrationOptions, settings)
    found = calibrate(
        given, counts, target, options, lambda said, _share: typer.echo(said, err=True), finish=write_page
    )
    if as_json:
        print_json({"out": None if found.gridlock else str(target), **found.record()})
    else:
        _print(found)
    if found.gridlock:
        typer.echo(
            f"the fitted traffic gridlocks: {found.gridlock}; nothing is written. Check the warnings, leave out"
            " counts that contradict others, or start from other traffic",
            err=True,
        )
        raise typer.Exit(1)
    if not as_json:
        typer.echo(f"scenario: {target}\npage: {target / PAGE}")


def _print(found: Calibration) -> None:
    from rich.table import Table

    from automotive_cosim.cli.console import Console
    from automotive_cosim.studies.calibration.page import MANY_HOURS, by_hour, findings, table

    shown = by_hour(found) if len(found.hours) > MANY_HOURS else table(found)
    made = Table(*shown.columns, box=None, header_style="bold", pad_edge=False)
    for column in made.columns[shown.heads :]:
        column.justify = "right"
    for row in shown.rows:
        made.add_row(*map(str, row))
    Console().print(made)
    for line in findings(found):
        typer.echo(line)
