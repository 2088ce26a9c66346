"""``automotive-cosim playback``: plays back a recorded episode."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from automotive_cosim.cli.options import reads_results
from automotive_cosim.contracts.plain import counted


@reads_results
def playback(
    folder: Annotated[Path, typer.Argument(help="Results folder of `run`.", show_default=False)],
    film: Annotated[Path | None, typer.Option(help="Write the screens as an animation, .webp or .gif.")] = None,
    speed: Annotated[float, typer.Option(help="How many times as fast as recorded.", min=0.1, max=1000)] = 4.0,
    wait: Annotated[bool, typer.Option("--wait/--at-once", help="Keep the recorded time between steps.")] = True,
) -> None:
    """Print a recorded episode step by step, at its recorded pace, or write its screens as an animation."""
    from time import sleep

    from automotive_cosim.errors import UserError
    from automotive_cosim.report.playback import frames, write_film

    if film is not None and film.suffix not in (".webp", ".gif"):
        raise UserError(f"{film} is not an animation; give --film a name ending in .webp or .gif")
    shown = list(frames(folder))
    if film is not None:
        write_film(shown, film, speed)
        typer.echo(f"{film} written, {counted(len(shown), 'step')}")
        return
    before_s = 0.0
    for frame in shown:
        if wait:
            sleep((frame.since_s - before_s) / speed)
        before_s = frame.since_s
        typer.echo(frame.words)
        typer.echo(f"     {frame.picture}")
