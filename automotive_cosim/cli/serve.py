"""``automotive-cosim serve``: shows runs, results, tasks and scenarios in a browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.serve.settings import ServeSettings


@takes(ServeSettings)
def serve(
    folders: Annotated[
        list[Path] | None,
        typer.Argument(
            help="Folders of `run` or `eval`, or folders that hold them.", metavar="[RUNS]...", show_default="runs"
        ),
    ] = None,
    **settings: Any,
) -> None:
    """Show runs, results, tasks and scenarios in a browser; a run in progress is shown live.

    Open the address that it prints: anyone who has it can read what is in the folders and, with --play, play.
    Played episodes are recorded in the first folder; a study in a subfolder named after its file. Ctrl-C stops the
    server: runs do not depend on it, and a study resumes where it was."""
    from automotive_cosim.formats.writing import make_folder
    from automotive_cosim.serve.server import WebServer

    told, default = filled(ServeSettings, settings), Path("runs")
    if (told.play or told.study) and folders is None:
        make_folder(default)
    shown = folders if folders is not None else [default] if default.is_dir() else []
    game = dealt = None
    if told.play or told.study:
        from automotive_cosim.errors import UserError
        from automotive_cosim.run.trial_folder import is_trial
        from automotive_cosim.serve.dealing import read_study
        from automotive_cosim.serve.play import Game
        from automotive_cosim.serve.study import PeopleStudy

        if is_trial(shown[0]) or (shown[0] / "manifest.json").exists():
            raise UserError(f"{shown[0]} is itself a record; give a folder of records")
        game = Game(shown[0]) if told.play else None
        dealt = PeopleStudy(read_study(told.study), shown[0] / told.study.stem) if told.study else None
    with WebServer(shown, *told.http, game, dealt) as server:
        typer.echo(f"Open {server.address}")
        if dealt is not None:
            typer.echo(f"Participants open {server.people_address}")
        server.serve_forever(poll_interval=0.2)
