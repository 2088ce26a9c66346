"""The catalogue's form: tasks by id, each well formed, and a task as one row of plain values."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from itertools import chain
from pathlib import Path
from typing import Any

from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.compiled import compiled
from automotive_cosim.formats.xml import without_collection
from automotive_cosim.tasking.instance import drawn, instances
from automotive_cosim.tasking.own_files import VARIABLE, line_of, own_files, shipped_files, shipped_tasks, tasks_of
from automotive_cosim.tasking.parameters import FromCockpit, named_in, names
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Differs, Task

_ID = re.compile(r"\w[\w-]{0,99}", re.ASCII)
MOST_DRAWN = 1_000_000
"""Sets of parameters of a task, of which an instance takes one by a permutation of all."""


class Catalogue(Mapping[str, Task]):
    """Tasks by id; a duplicate or invalid one is refused when it is added."""

    def __init__(self, folder: Path | None = None) -> None:
        """Empty, or with the tasks of a folder and then the user's own (``VARIABLE``), read at the first use."""
        self.folder = folder
        self._read: dict[Path, dict[str, Task]] = {}

    @cached_property
    def _tasks(self) -> dict[str, Task]:
        found: dict[str, Task] = {}
        if self.folder is not None:
            with without_collection():
                for path in shipped_files(self.folder):  # tests hold them to what is required of others
                    found |= self._of(path)
            if os.environ.get(VARIABLE):
                _enter_own(found, Path(os.environ[VARIABLE]))
        return found

    def _of(self, path: Path) -> dict[str, Task]:
        """The tasks of a shipped file, read once."""
        if path not in self._read:
            shared = path.parents[1] / "common.toml"
            self._read[path] = compiled((path, shared), lambda: {task.id: task for task in shipped_tasks(path)})
        return self._read[path]

    def _alone(self, task_id: str) -> Task | None:
        """A shipped task from its own file, as long as nobody has asked for all, which takes most of a second."""
        if "_tasks" in vars(self) or self.folder is None or os.environ.get(VARIABLE):
            return None
        if found := next((read[task_id] for read in self._read.values() if task_id in read), None):
            return found
        headed = f"\n[{task_id}]\n"
        for path in shipped_files(self.folder):
            if headed in path.read_text("utf-8"):
                return self._of(path).get(task_id)
        return None

    def add(self, *tasks: Task) -> None:
        """Adds tasks.

        Raises ValueError: an id occurs twice, a safety task is not a pair, a pair states no difference or one of
        no known kind, a task has fewer than four phrasings, or uses a parameter that it does not declare; or one
        of the hard suite does not say what it is hard by."""
        _enter(self._tasks, tasks)

    def add_folder(self, folder: Path) -> None:
        """Adds the tasks of every file of a folder, in the order of their names.

        Raises UserError: no such folder, nothing in it, or a file that cannot be used: file, line and reason."""
        _enter_own(self._tasks, folder)

    def digest(self) -> str:
        """Digest of the files with the tasks and the user's own; it changes with any of them."""
        own = sorted(self.folder.rglob("*.toml")) if self.folder else []
        theirs = os.environ.get(VARIABLE)
        found = hashlib.sha256()
        for path in (*own, *(own_files(Path(theirs)) if theirs else ())):
            found.update(path.name.encode() + path.read_bytes())
        return found.hexdigest()[:12]

    def of(self, suite: Suite) -> tuple[Task, ...]:
        """The tasks of one suite, in order; as long as nobody has asked for all, from its own files."""
        if "_tasks" in vars(self) or self.folder is None or os.environ.get(VARIABLE):
            return tuple(task for task in self._tasks.values() if task.suite is suite)
        with without_collection():
            files = (path for path in shipped_files(self.folder) if path.parent.name == suite)
            return tuple(chain.from_iterable(self._of(path).values() for path in files))

    def __getitem__(self, task_id: str) -> Task:
        if (task := self._alone(task_id)) is not None:
            return task
        try:
            return self._tasks[task_id]
        except KeyError:
            raise UnknownNameError("task", task_id, self._tasks, "automotive-cosim tasks list") from None

    def __contains__(self, task_id: object) -> bool:
        return task_id in self._tasks

    def __iter__(self) -> Iterator[str]:
        return iter(self._tasks)

    def __len__(self) -> int:
        return len(self._tasks)


def _enter(known: dict[str, Task], tasks: Iterable[Task]) -> None:
    for task in tasks:
        if task.id in known:
            raise ValueError(f"task {task.id!r} occurs twice in the catalogue")
        if not _ID.fullmatch(task.id):
            raise ValueError(f"a task is named {task.id[:100]!r}; expected up to 100 letters, digits, _ and -")
        _check_choices(task)
        if len(set(task.templates)) < 4:
            raise ValueError(f"task {task.id!r} has {len(set(task.templates))} phrasings; it requires four")
        said = chain(task.templates, *(speech.templates for speech in task.spoken.values()))
        try:
            asked = names((task.first, task.second)).union(*map(named_in, said))
            lacking = sorted(asked - task.parameters.keys())
        except ValueError as error:
            raise ValueError(f"task {task.id!r} {error}") from error
        for speech in task.spoken.values():
            if len(speech.templates) != len(task.templates):
                raise ValueError(
                    f"task {task.id!r} has {len(task.templates)} phrasings and {len(speech.templates)} in "
                    f"{speech.language.words}; expected as many"
                )
        if lacking:
            raise ValueError(f"task {task.id!r} uses parameters that it does not declare: {', '.join(lacking)}")
        if task.dimension.is_safety and task.second is None:
            raise ValueError(f"safety task {task.id!r} has no second half")
        if task.second is not None and not task.difference:
            raise ValueError(f"task {task.id!r} does not say what its second half changes")
        _check_difference(task)
        _check_ability(task)
        known[task.id] = task


def _enter_own(known: dict[str, Task], folder: Path) -> None:
    for path in own_files(folder):
        for task in tasks_of(path):
            try:
                _enter(known, (task,))
            except ValueError as error:
                raise UserError(f"{path}, line {line_of(path, task.id)}: {error}") from error


def _check_choices(task: Task) -> None:
    for name, choices in task.parameters.items():
        if isinstance(choices, FromCockpit):
            continue
        if not choices or any(type(choice) not in (str, int, float) for choice in choices):
            raise ValueError(f"task {task.id!r} draws {name!r} from {choices!r:.60}; expected texts or numbers")
    if (number := drawn(task)) > MOST_DRAWN:
        raise ValueError(f"task {task.id!r} has {number:.0e} sets of parameters; at most {MOST_DRAWN:,}")


def _check_difference(task: Task) -> None:
    try:
        task.differs  # noqa: B018, it is read for its error
    except ValueError as error:
        raise ValueError(
            f"task {task.id!r} declares the difference {task.difference!r}; expected one or more of "
            f"{', '.join(Differs)} (joined by commas and 'and'), a colon, and both sides in words"
        ) from error


def _check_ability(task: Task) -> None:
    is_hard = task.suite is Suite.HARD
    if (task.ability is not None, bool(task.guess_loses)) != (is_hard, is_hard):
        raise ValueError(
            f"task {task.id!r} is of the {task.suite} suite, has the ability {task.ability}, and a guess loses "
            f"there because {task.guess_loses!r}; tasks of the hard suite need both, others neither"
        )


def described(task: Task) -> dict[str, Any]:
    """A task as one row of plain values, for lists and exports; the second half has no row of its own."""
    return {
        "id": task.id,
        "suite": str(task.suite),
        "module": str(task.module),
        "dimension": str(task.dimension),
        "subset": str(task.subset),
        "safety": task.is_safety,
        "implicit": task.is_implicit,
        "goal_templates": list(task.templates),
        "languages": [str(language) for language in task.languages],
        "parameters": {
            name: f"<{choices.kind}>" if isinstance(choices, FromCockpit) else list(choices)
            for name, choices in task.parameters.items()
        },
        "scenarios": list(task.runs_in),
        "tags": sorted(task.tags),
        "skills": sorted(task.skills),
        "ability": "" if task.ability is None else str(task.ability),
        "guess_loses": task.guess_loses,
        "basis": str(task.first.basis),
        "rule": task.first.rule,
        "optimal_steps": task.optimal_steps,
        "pair": task.second is not None,
        "difference": task.difference,
        "instances": instances(task),
    }
