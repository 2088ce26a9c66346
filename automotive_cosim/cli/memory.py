"""``automotive-cosim show memory``: what ASURADA remembers from earlier episodes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from automotive_cosim.cli.options import print_json
from automotive_cosim.errors import UserError


def memory(
    file: Annotated[Path, typer.Argument(help="The file given to `run --memory`.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON list and nothing else.")] = False,
) -> None:
    """Show what ASURADA remembers: which strategy it tried where, for what, and how often it worked."""
    from automotive_cosim.agents.memory import Memory

    if not file.is_file():
        raise UserError(f"there is no memory in {file}; `automotive-cosim run --memory {file}` creates one")
    kept = list(Memory(file).all())
    if as_json:
        print_json([strategy.as_json() for strategy in kept])
        return
    for strategy in kept:
        typer.echo(f"{strategy.place}: “{strategy.goal}”")
        typer.echo(f"  when    {strategy.trigger}")
        typer.echo(f"  did     {strategy.steps}")
        typer.echo(f"  worked  {strategy.worked} of {strategy.worked + strategy.failed}")
    typer.echo("1 strategy" if len(kept) == 1 else f"{len(kept)} strategies")
