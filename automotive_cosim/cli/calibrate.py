"""``automotive-cosim scenarios calibrate``: a demand that reproduces counts in simulation."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from automotive_cosim.cli.options import AsJson, number, print_json, whole_number
from automotive_cosim.errors import UserError

if TYPE_CHECKING:
    from automotive_cosim.calibration import Calibration

HOURS = re.compile(r"(\d{1,2})(?:-(\d{1,2}))?")


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
    sites: Annotated[
        Path | None,
        typer.Option(
            help="Table with site and edge or lon,lat,bearing; or SUMO's file of detectors.",
            show_default="columns of --counts",
        ),
    ] = None,
    times: Annotated[
        Path | None,
        typer.Option(help="Measured travel times to compare: from_edge,to_edge,hour,seconds.", show_default="none"),
    ] = None,
    hours: Annotated[
        str, typer.Option(metavar="FIRST[-LAST]", help="Local hours to calibrate.", show_default="all counted")
    ] = "",
    at: Annotated[
        int | None,
        typer.Option(
            parser=whole_number(0, 23),
            metavar="HOUR",
            help="Local hour at which the ego departs.",
            show_default="the first",
        ),
    ] = None,
    hold_out: Annotated[
        float,
        typer.Option(parser=number(0.0, 0.9), metavar="SHARE", help="Share of the sites to hold out of the fit."),
    ] = 0.3,
    rounds: Annotated[
        int, typer.Option(parser=whole_number(1, 50), metavar="N", help="Maximum rounds of fit and simulation.")
    ] = 10,
    seed: Annotated[
        int, typer.Option(parser=whole_number(0, 2**31 - 2), metavar="N", help="Seed of everything random.")
    ] = 0,
    out: Annotated[Path | None, typer.Option(help="Folder to create.", show_default="SCENARIO_calibrated")] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an earlier calibration.")] = False,
    as_json: AsJson = False,
) -> None:
    """Fit a scenario's traffic to counts, and simulate until it matches them.

    Some sites are held out, to test the fit where nothing was counted. If the traffic gridlocks, the exit code is 1
    and nothing is written.
    """
    from automotive_cosim.calibration import CalibrationOptions, calibrate
    from automotive_cosim.report.calibration import write_page
    from automotive_cosim.report.charts import require_plots
    from automotive_cosim.scenery import open_scenario

    require_plots()
    given = open_scenario(scenario)
    here = given.folder if Path(scenario).is_dir() else Path(given.name)
    target = out or here.with_name(f"{here.name}_calibrated")
    options = CalibrationOptions(sites, times, _span(hours), at, hold_out, rounds, seed)
    found = calibrate(given, counts, target, options, lambda said, _share: typer.echo(said, err=True), force=force)
    page = None if found.gridlock else write_page(target)
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
    if page and not as_json:
        typer.echo(f"scenario: {target}\npage: {page}")


def _span(text: str) -> tuple[int, int] | None:
    """First and last hour."""
    if not text:
        return None
    found = HOURS.fullmatch(text)
    first, last = (int(found[1]), int(found[2] or found[1])) if found else (24, 24)
    if not first <= last < 24:
        raise UserError(f"--hours {text!r} is not FIRST-LAST, each from 0 to 23, such as 7-9")
    return first, last


def _print(found: Calibration) -> None:
    from rich.table import Table

    from automotive_cosim.cli.console import Console
    from automotive_cosim.report.calibration import MANY_HOURS, by_hour, findings, table

    shown = by_hour(found) if len(found.hours) > MANY_HOURS else table(found)
    made = Table(*shown.columns, box=None, header_style="bold", pad_edge=False)
    for column in made.columns[shown.heads :]:
        column.justify = "right"
    for row in shown.rows:
        made.add_row(*map(str, row))
    Console().print(made)
    for line in findings(found):
        typer.echo(line)
