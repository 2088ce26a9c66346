"""The files of tasks: TOML (``reading``), and of a user's own also Python with ``TASKS``."""

from __future__ import annotations

import os
import runpy
import tomllib
import traceback
from collections.abc import Collection, Iterable, Iterator
from dataclasses import fields, is_dataclass
from datetime import datetime
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.registry import by_any_name
from automotive_cosim.contracts.roads import RoadNetwork
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.files import open_file
from automotive_cosim.formats.toml import Document, read_toml
from automotive_cosim.scenarios.listing import shipped
from automotive_cosim.tasking.binding import rules_of
from automotive_cosim.tasking.moves import Open
from automotive_cosim.tasking.reading import shared, tasks_in
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Basis, Half, Module, Task


@cache
def data_keys() -> frozenset[str]:
    """The keys of ``Moment.commands``."""
    nowhere = RoadNetwork((), (0.0, 0.0, 1.0, 1.0), None, (0.0, 0.0), False)
    return frozenset(Cockpit(nowhere, rng=np.random.default_rng(0)).commands())


def check(half: Half) -> Iterator[tuple[str, UserError]]:
    """The names in a half that are unknown and the dates that are none, each with the field that it is in."""
    start = half.start
    try:
        if start.start is not None and datetime.fromisoformat(start.start).tzinfo is not None:
            raise ValueError
    except ValueError:
        told = f"start is {start.start!r}; it must be a local date and time, as in 2026-06-16T12:30:00"
        yield "start", UserError(told)
    try:
        _ = half.basis is Basis.LAW and rules_of(half)
    except UserError as error:
        yield "basis", error
    if start.scenario not in shipped() and not os.path.exists(start.scenario):  # noqa: PTH110, false if too long
        yield "start", UnknownNameError("scenario", start.scenario, shipped(), "automotive-cosim scenarios list")
    for field, ways in (("moves", (half.moves,)), ("ways", half.ways), ("slips", half.slips)):
        screens = {move.app for way in ways for move in way if isinstance(move, Open)}
        for name in screens - by_any_name().keys():
            yield field, UnknownNameError("screen", name, by_any_name())
    for field, keys in (("goal", {*_keys(half.goal)}), ("may_write", half.may_write)):
        yield from ((field, UnknownNameError("entry of the data", key, data_keys())) for key in _beyond(keys))


def _beyond(keys: Collection[str]) -> list[str]:
    """Those that the car does not have."""
    return sorted(key for key in keys if not key.startswith("Vehicle.") and key not in data_keys())


def _keys(part: Any) -> Iterator[str]:
    """The keys of the apps' data that a goal names."""
    if isinstance(part, tuple):
        for each in part:
            yield from _keys(each)
    elif is_dataclass(part):
        for each in fields(part):
            value = getattr(part, each.name)
            if each.name == "key" and isinstance(value, str):
                yield value
            else:
                yield from _keys(value)


VARIABLE = "AUTOMOTIVE_COSIM_TASKS"
"""Environment variable with the folder of the user's own, so that worker processes load it too."""


def shipped_files(folder: Path) -> tuple[Path, ...]:
    """The files of the catalogue: suite by suite, in the order of the modules."""
    every = (folder / suite / f"{module}.toml" for suite in Suite for module in Module)
    return tuple(path for path in every if path.is_file())


def own_files(folder: Path) -> list[Path]:
    """The files of a user, in the order of their names.

    Raises UserError: no such folder, no file in it, or something that is no regular file."""
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
    """The tasks of a file. Raises UserError: it cannot be used: file, line and reason."""
    if path.suffix == ".py":
        return _by_python(path)
    from automotive_cosim.tasking.own_files import check  # with the whole car, which the catalogue does without

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
