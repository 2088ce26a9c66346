"""``automotive-cosim compare``: compares two evaluations, as a check for every change."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import print_json, reads_results, tells_json
from automotive_cosim.errors import UserError
from automotive_cosim.report.settings import CompareSettings


@tells_json
@reads_results
@takes(CompareSettings)
def compare(
    before: Annotated[Path, typer.Argument(help="Results folder of `eval` before the change.", show_default=False)],
    after: Annotated[Path, typer.Argument(help="Results folder of `eval` after the change.", show_default=False)],
    as_json: bool = False,
    **settings: Any,
) -> None:
    """Compare two evaluations on the same episodes.

    Exit code 1 if success, or the score of drives, fell by more than the threshold, or something that was planned
    was not run."""
    from automotive_cosim.formats.writing import write_whole
    from automotive_cosim.report import regression
    from automotive_cosim.run.store import read_manifest

    told = filled(CompareSettings, settings)
    for folder in (before, after):
        if "study" in read_manifest(folder)["plan"]:
            raise UserError(f"{folder} is a study; `automotive-cosim study compare` compares two of one kind")
    found = regression.changes(before, after, mixed=told.mixed_versions)
    if told.junit is not None:
        write_whole(told.junit, regression.junit(found))
    if told.markdown is not None:
        write_whole(told.markdown, regression.markdown(found, told.allowed))
    if as_json:
        print_json(regression.as_json(found, told.allowed))
    else:
        typer.echo(regression.plain(found, told.allowed), nl=False)
    if not all(each.passes(told.allowed) for each in found):
        raise typer.Exit(1)
