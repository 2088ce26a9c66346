"""A user's own tasks: every ``.py`` file with ``TASKS`` in a folder."""

from __future__ import annotations

import hashlib
import os
import runpy
import traceback
from pathlib import Path

from automotive_cosim.errors import UserError
from automotive_cosim.tasking.catalogue import Catalogue
from automotive_cosim.tasking.own_files import VARIABLE, own_files
from automotive_cosim.tasking.task import Task


def add_folder(catalogue: Catalogue, folder: Path) -> None:
    """Adds the tasks of every file, in the order of their names.

    Raises:
        UserError: no such folder, nothing in it, or a file that cannot be used: file, line and reason.
    """
    for path in own_files(folder):
        for task in _read(path):
            try:
                catalogue.add(task)
            except ValueError as error:
                raise UserError(f"{path}, line {_line(path, task.id)}: {error}") from error


def digest() -> str:
    """Digest of the files with the catalogue's tasks, the phrasings in other languages and the user's own tasks; it
    changes with any of them."""
    here = Path(__file__).parent
    own = [path for pattern in ("*.py", "*/*.py", "phrasings/*.toml") for path in sorted(here.glob(pattern))]
    theirs = (Path(folder) for folder in filter(None, [os.environ.get(VARIABLE)]))
    found = hashlib.sha256()
    for path in (*own, *(path for folder in theirs for path in sorted(folder.glob("*.py")))):
        found.update(path.name.encode() + path.read_bytes())
    return found.hexdigest()[:12]


def _read(path: Path) -> tuple[Task, ...]:
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


def _line(path: Path, task_id: str) -> int:
    """The line where the id first occurs; 1 if it is computed."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return next((number for number, line in enumerate(lines, 1) if task_id in line), 1)
