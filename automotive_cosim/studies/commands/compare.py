"""``automotive-cosim study compare``: two runs of one study."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from automotive_cosim.cli.options import AsJson, print_json, reads_results


@reads_results
def compare(
    first: Annotated[Path, typer.Argument(help="Results folder of a study.", show_default=False)],
    second: Annotated[Path, typer.Argument(help="The same of another run.", show_default=False)],
    as_json: AsJson = False,
) -> None:
    """Compare two runs of one study, as of two versions; exit code 1 if their rows differ."""
    from automotive_cosim.cli.console import Console
    from automotive_cosim.studies.versions import answer, compared, pairs

    found = pairs(first, second)
    table = compared(found)
    changed = {pair.name: list(pair.changed) for pair in found if pair.changed}
    if as_json:
        print_json({"same": all(pair.is_same for pair in found), "changed": changed, "figures": table.records()})
    else:
        console = Console(highlight=False)
        console.print(answer(found), soft_wrap=True)
        for name, what in changed.items():
            console.print(f"{name} was run with another {'; '.join(what)}", soft_wrap=True)
        console.print(table.markdown(), soft_wrap=True)
    raise typer.Exit(not all(pair.is_same for pair in found))
