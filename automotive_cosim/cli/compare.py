"""``automotive-cosim compare``: compares two evaluations, as a check for every change."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from automotive_cosim.cli.options import AsJson, TasksFrom, print_json, reads_results
from automotive_cosim.errors import UserError


@reads_results
def compare(
    before: Annotated[Path, typer.Argument(help="Results folder of `eval` before the change.", show_default=False)],
    after: Annotated[Path, typer.Argument(help="Results folder of `eval` after the change.", show_default=False)],
    threshold: Annotated[
        float,
        typer.Option(
            help="By how many percentage points success, or points the score of drives, may fall.", metavar="POINTS"
        ),
    ] = 0.0,
    junit: Annotated[
        Path | None, typer.Option(help="File for a JUnit report with one case per instance.", show_default=False)
    ] = None,
    markdown: Annotated[
        Path | None, typer.Option(help="File for a summary in Markdown.", show_default=False)
    ] = None,
    mixed: Annotated[
        bool,
        typer.Option("--mixed-versions", help="Compare even if two minor versions of automotive-cosim ran them."),
    ] = False,
    as_json: AsJson = False,
    tasks_from: TasksFrom = None,
) -> None:
    """Compare two evaluations on the same instances.

    Exit code 1 if success, or the score of drives, fell by more than the threshold, or something that was planned
    was not run.
    """
    from automotive_cosim.formats.files import write_whole
    from automotive_cosim.report import regression
    from automotive_cosim.run.store import read_manifest

    if not 0 <= threshold <= 100:
        raise UserError(f"--threshold is {threshold:g}; give percentage points from 0 to 100")
    for folder in (before, after):
        if "study" in read_manifest(folder)["plan"]:
            raise UserError(f"{folder} is a study; `automotive-cosim study compare` compares two of one kind")
    found = regression.changes(before, after, mixed=mixed)
    for path, text in ((junit, regression.junit(found)), (markdown, regression.markdown(found, threshold / 100))):
        if path is not None:
            write_whole(path, text)
    if as_json:
        print_json(regression.as_json(found, threshold / 100))
    else:
        typer.echo(regression.plain(found, threshold / 100), nl=False)
    if not all(each.passes(threshold / 100) for each in found):
        raise typer.Exit(1)
