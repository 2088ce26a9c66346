"""``automotive-cosim serve``: shows runs, results, tasks and scenarios in a browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from automotive_cosim.cli.options import TasksFrom, whole_number


def serve(
    folders: Annotated[
        list[Path] | None,
        typer.Argument(
            help="Folders of `run` or `eval`, or folders that hold them.",
            metavar="[RUNS]...",
            show_default="runs",
        ),
    ] = None,
    host: Annotated[
        str, typer.Option(help="Address to listen on; by default nobody on another machine can connect.")
    ] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(help="Port to listen on; 0 takes a free one.", metavar="N", parser=whole_number(0, 65535))
    ] = 0,
    play: Annotated[
        bool,
        typer.Option(
            "--play", help="Let one person at a time play: work the cockpit, and be judged as agents are."
        ),
    ] = False,
    tasks_from: TasksFrom = None,
) -> None:
    """Show runs, results, tasks and scenarios in a browser; a run that is under way is shown live.

    Open the address that it prints: whoever has it can read what is in the folders and, with --play, play; played
    episodes are recorded in the first folder. Ctrl-C ends it; no run depends on it.
    """
    from automotive_cosim.serve.server import WebServer

    default = Path("runs")
    if play and folders is None:
        default.mkdir(exist_ok=True)
    shown = folders if folders is not None else [default] if default.is_dir() else []
    game = None
    if play:
        from automotive_cosim.errors import UserError
        from automotive_cosim.serve.play import Game

        if (shown[0] / "steps.jsonl").exists() or (shown[0] / "manifest.json").exists():
            raise UserError(f"{shown[0]} is a record itself; give --play a folder that holds records")
        game = Game(shown[0])
    with WebServer(shown, host, port, game) as server:
        typer.echo(f"Open {server.address}")
        server.serve_forever(poll_interval=0.2)
