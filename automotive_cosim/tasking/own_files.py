"""The files of tasks: TOML (``reading``), and of a user's own also Python with ``TASKS``."""

from __future__ import annotations

import runpy
import tomllib
import traceback
from collections.abc import Iterable
from pathlib import Path

from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import open_file
from automotive_cosim.formats.toml import Document, read_toml
from automotive_cosim.tasking.reading import shared, tasks_in
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Module, Task

VARIABLE = "AUTOMOTIVE_COSIM_TASKS"
"""Environment variable with the folder of the user's own, so that worker processes load it too."""


def shipped_files(folder: Path) -> tuple[Path, ...]:
    """The files of the catalogue: suite by suite, in the order of the modules."""
    every = (folder / suite / f"{module}.toml" for suite in Suite for module in Module)
    return tuple(path for path in every if path.is_file())


def own_files(folder: Path) -> list[Path]:
    """The files of a user, in the order of their names.

    Raises:
        UserError: no such folder, no file in it, or something that is no regular file.
    """
    if not folder.is_dir():
        raise UserError(f"--tasks-from {folder} is no folder; give one that holds .toml files, or .py with TASKS")
    found = (path for path in folder.iterdir() if path.suffix in (".py", ".toml"))
    paths = sorted(path for path in found if not path.name.startswith("_"))
    if not paths:
        raise UserError(
            f"--tasks-from {folder} holds no .toml and no .py file; a .py needs TASKS, a tuple of tasks"
        )
    for path in paths:
        try:
            open_file(path).close()
        except OSError as error:
            raise UserError(f"--tasks-from: cannot read {path}: {error.strerror or error}") from error
    return paths


def tasks_of(path: Path) -> Iterable[Task]:
    """The tasks of a file.

    Raises:
        UserError: it cannot be used: file, line and reason.
    """
    if path.suffix == ".py":
        return _by_python(path)
    from automotive_cosim.tasking.known import check  # with the whole car, which the catalogue does without

    return tasks_in(read_toml(path), shared(), check)


def shipped_tasks(path: Path) -> Iterable[Task]:
    """The tasks of a file of the catalogue, without the care that a stranger's file takes."""
    text = path.read_text("utf-8")
    return tasks_in(Document(path, tomllib.loads(text), UserError, text), shared())


def line_of(path: Path, task_id: str) -> int:
    """The line where the id first occurs; 1 if it is computed."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return next((number for number, line in enumerate(lines, 1) if task_id in line), 1)


def _by_python(path: Path) -> tuple[Task, ...]:
    try:
        tasks = runpy.run_path(str(path)).get("TASKS")
    except SyntaxError as error:
        raise UserError(f"{path}, line {error.lineno}: {error.msg}") from error
    except (Exception, SystemExit) as error:  # a user's file may raise anything
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)]
        where = f", line {lines[-1]}" if lines else ""
        raise UserError(f"{path}{where}: {type(error).__name__}: {error}") from error
    if not isinstance(tasks, tuple | list) or not all(isinstance(task, Task) for task in tasks):
        raise UserError(f"{path} has no TASKS, a tuple of automotive_cosim.tasking.task.Task")
    return tuple(tasks)
