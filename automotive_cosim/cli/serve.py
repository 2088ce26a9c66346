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
        str, typer.Option(help="Address to listen on; by default, only this machine can connect.")
    ] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(help="Port to listen on; 0 picks a free one.", metavar="N", parser=whole_number(0, 65535))
    ] = 0,
    play: Annotated[
        bool,
        typer.Option("--play", help="Let one person at a time operate the cockpit, judged as agents are."),
    ] = False,
    study: Annotated[
        Path | None,
        typer.Option(
            help="TOML file of a study: deals its episodes to several people, each on their own page.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    tasks_from: TasksFrom = None,
) -> None:
    """Show runs, results, tasks and scenarios in a browser; a run in progress is shown live.

    Open the address that it prints: anyone who has it can read what is in the folders and, with --play, play.
    Played episodes are recorded in the first folder; a study in a subfolder named after its file. Ctrl-C stops the
    server: runs do not depend on it, and a study resumes where it was.
    """
    from automotive_cosim.serve.server import WebServer

    default = Path("runs")
    if (play or study) and folders is None:
        default.mkdir(exist_ok=True)
    shown = folders if folders is not None else [default] if default.is_dir() else []
    game = dealt = None
    if play or study:
        from automotive_cosim.errors import UserError
        from automotive_cosim.serve.dealing import read_study
        from automotive_cosim.serve.play import Game
        from automotive_cosim.serve.study import PeopleStudy

        if (shown[0] / "steps.jsonl").exists() or (shown[0] / "manifest.json").exists():
            raise UserError(f"{shown[0]} is itself a record; give a folder of records")
        game = Game(shown[0]) if play else None
        dealt = PeopleStudy(read_study(study), shown[0] / study.stem) if study else None
    with WebServer(shown, host, port, game, dealt) as server:
        typer.echo(f"Open {server.address}")
        if dealt is not None:
            typer.echo(f"Participants open {server.people_address}")
        server.serve_forever(poll_interval=0.2)
