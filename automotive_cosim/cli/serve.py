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
    tasks_from: TasksFrom = None,
) -> None:
    """Show runs, results, tasks and scenarios in a browser; a run that is under way is shown live.

    Open the address that it prints: whoever has it can read what is in the folders, and change nothing. Ctrl-C ends
    it; no run depends on it.
    """
    from automotive_cosim.serve.server import WebServer

    default = Path("runs")
    shown = folders if folders is not None else [default] if default.is_dir() else []
    with WebServer(shown, host, port) as server:
        typer.echo(f"Open {server.address}")
        server.serve_forever(poll_interval=0.2)
