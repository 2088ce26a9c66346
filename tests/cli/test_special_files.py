"""No command that reads a file or a folder waits for a pipe or opens a device or a socket."""

import os
import signal
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer
from typer.testing import CliRunner

from automotive_cosim.cli.main import app
from automotive_cosim.errors import UserError
from tests.laws import over

pytestmark = pytest.mark.sumo

PATIENCE_S = 30
"""A command that waits for a writer waits for ever; nothing here takes more than a second of its own."""
WRITTEN = {"out", "each", "junit"}
"""Parameters that name what is to be written."""
FORMS = ("pipe", "device", "socket", "folder")
"""What is given; the folder has a pipe for every file that a command may look for."""
INSIDE = (
    "manifest.json", "episodes.jsonl", "steps.jsonl", "trial.json", "shown.jsonl", "scenario.toml", "plan.toml",
    "bundle.json", "drive.jsonl", "traces", "decisions.csv.gz", "map.net.xml", "network.net.xml", "a.sumocfg",
    "own.py",
)  # fmt: skip


def commands(group: Any, names: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from commands(command, (*names, name))
        else:
            yield (*names, name), command


def reads_a_path(parameter: Any) -> bool:
    return parameter.type_descriptor.annotation is Path and parameter.name not in WRITTEN


def cases() -> Iterator[tuple[str, str, str]]:
    for names, command in commands(typer.main.get_command(app)):
        for parameter in command.params:
            if reads_a_path(parameter) and (parameter.name != "tasks_from" or names == ("run",)):
                for form in FORMS:
                    if (names, form) != (("mcp",), "folder"):  # it opens a scenario there when one is asked for
                        yield " ".join(names), parameter.name, form


@pytest.fixture(scope="module")
def special(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Path]]:
    folder = tmp_path_factory.mktemp("special")
    os.mkfifo(folder / "pipe")
    (folder / "folder").mkdir()
    for name in INSIDE:
        os.mkfifo(folder / "folder" / name)
    with socket.socket(socket.AF_UNIX) as listening:
        here = Path.cwd()
        os.chdir(folder)  # the address of a socket is short
        listening.bind("socket")
        os.chdir(here)
        yield {form: folder / form for form in FORMS} | {"device": Path("/dev/zero")}


def given(command: Any, name: str, path: Path, other: Path) -> list[str]:
    """A command line with that path, and something for all else that is required."""
    line: list[str] = []
    for parameter in command.params:
        value = "grid" if parameter.name in ("scenario", "name") else "x"
        if reads_a_path(parameter):
            value = str(path if parameter.name == name else other)
        if parameter.name in WRITTEN:
            value = str(other / "written")
        if parameter.param_type_name == "argument":
            line += [value] if parameter.required or parameter.name == name else []
        elif parameter.required or parameter.name == name:
            line += [parameter.opts[0], value]
    return line


@over(cases())
def test_no_command_waits_for_a_pipe_or_opens_a_device(names, name, form, special, tmp_path, monkeypatch):
    command = dict(commands(typer.main.get_command(app)))[tuple(names.split())]

    def gives_up(number: int, frame: object) -> None:
        raise AssertionError(f"it still waits after {PATIENCE_S} s")

    monkeypatch.chdir(tmp_path)
    environment, before = dict(os.environ), signal.signal(signal.SIGALRM, gives_up)
    signal.alarm(PATIENCE_S)
    try:
        ran = CliRunner().invoke(app, [*names.split(), *given(command, name, special[form], tmp_path)])
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
        os.environ.clear()  # --tasks-from is passed on in it
        os.environ.update(environment)
    if not isinstance(ran.exception, UserError | typer.TyperException):
        assert ran.exit_code == 2, (ran.exception, ran.output[-500:])
