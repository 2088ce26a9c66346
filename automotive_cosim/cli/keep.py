"""``automotive-cosim keep``: warm traffic that outlives the command."""

from __future__ import annotations

from typing import Annotated

import typer


def keep(
    minutes: Annotated[
        float, typer.Option(min=0, max=10_080, help="For how long what is not used is kept; 0 ends it now.")
    ] = 60.0,
) -> None:
    """Keep warm traffic for later commands, which fork from it instead of warming up; and show what is kept."""
    from automotive_cosim.traffic.keeper import MEMORY_SHARE, keep

    kept = keep(minutes)
    for line in kept if minutes else ():
        typer.echo(line)
    if minutes:
        most = f"what was used last, in at most {MEMORY_SHARE:.0%} of the memory"
        typer.echo(f"warm traffic is kept until it is not used for {minutes:g} min: {most}")
    else:
        typer.echo("no warm traffic is kept")
