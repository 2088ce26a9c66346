"""What people play for the record: an evaluation of the agent ``human``, which every report reads.

The model of a row is the person's code name. If a person plays an instance again, it is a new repeat, so that the
first attempt is never replaced.
"""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Generic

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import Clock
from automotive_cosim.episode.conditions import Conditions, with_conditions
from automotive_cosim.errors import UserError
from automotive_cosim.formats.layout import PICTURES, TRACES
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.job_row import R
from automotive_cosim.run.plan import Plan
from automotive_cosim.run.rows import DriveTrialRow, EpisodeRow
from automotive_cosim.run.store import Store, opened, read_rows, replan
from automotive_cosim.run.trial import HUMAN, Limits
from automotive_cosim.tasking.sets import ALL_SUITES

FOLDER, DRIVES = "people", "people-drives"
"""Folders of the played episodes and drives, in the first of the folders shown."""
MOST_S, MOST_STEPS = 120.0, 1000
"""Simulated seconds, and acts, after which a played episode ends."""
LONGEST_NAME = 40
CONDITIONS = Conditions(clock=Clock.MODEL)
"""A person's seconds pass on the road."""


def people_plan(
    tasks: Sequence[str], people: Sequence[str], seeds: Sequence[int], repeats: int = 1, scenario: str | None = None
) -> Plan:
    """The plan in which everyone plays every task with every seed. A person's seconds pass on the road."""
    limits = Limits(steps=MOST_STEPS, hard_steps=MOST_STEPS, sim_s=MOST_S)
    return with_conditions(
        Plan(
            agents=(HUMAN,),
            models=tuple(people),
            tasks=tuple(tasks),
            suite=ALL_SUITES,
            scenarios=() if scenario is None else (scenario,),
            seeds=tuple(seeds),
            repeats=repeats,
            limits=limits,
        ),
        CONDITIONS,
    )


def check_code_name(name: str) -> None:
    """Refuses names that cannot be used for a person in reports and file names.

    Raises UserError: it is empty, too long, or has characters other than letters, digits, spaces, - and _."""
    is_plain = all(letter.isalnum() or letter in " -_" for letter in name)
    if not name.strip() or len(name) > LONGEST_NAME or not is_plain:
        raise UserError(
            f"{name[:LONGEST_NAME]!r} is not a code name; enter 1 to {LONGEST_NAME} letters, digits, spaces, - or _"
        )


class _PlayedRows(ABC, Generic[R]):
    """An evaluation that grows with whatever is played. Any method may be called from any thread."""

    kind: type[R]
    parts: tuple[str, ...] = (TRACES, PICTURES)

    def __init__(self, folder: Path) -> None:
        """Nothing is written before the first job.

        Args:
            folder: the evaluation's."""
        self.folder = folder
        self._lock = threading.Lock()
        self._ends = ExitStack()
        self._store: Store[R] | None = None

    @abstractmethod
    def plan_of(self, rows: Sequence[R]) -> Json:
        """The smallest plan that has these rows, which are all that were meant to be run."""

    def close(self) -> None:
        with self._lock:
            self._ends.close()
            self._store = None

    def keep(self, row: R) -> None:
        """Adds a row. Raises UserError: it cannot be written."""
        with self._lock:
            store = self._opened()
            store.append(row)
            replan(self.folder, self.plan_of(list(store.rows.values())), len(store.rows))

    def _first(self, ids: Callable[[int], str]) -> int:
        """The first repeat that nobody has played: its id has no row."""
        with self._lock:
            rows = self._opened().rows
            return next(repeat for repeat in count() if ids(repeat) not in rows)

    def _opened(self) -> Store[R]:
        if self._store is None:
            rows = list(read_rows(self.folder, self.kind).values())
            begun = opened(self.folder, self.plan_of(rows), self.kind, self.parts, planned=len(rows), grows=True)
            self._store = self._ends.enter_context(begun)
        return self._store


class PlayedEpisodes(_PlayedRows[EpisodeRow]):
    """Episodes of tasks that a person played."""

    kind = EpisodeRow

    def __init__(self, folder: Path, scenario: str | None = None) -> None:
        """Nothing is written before the first job.

        Args:
            folder: the evaluation's.
            scenario: instead of the tasks' own."""
        super().__init__(folder)
        self._scenario = scenario

    def job(self, task: str, half: str, seed: int, name: str) -> EpisodeSetup:
        """The next episode of a person.

        Raises UserError: there is no such task or half, or another process writes here."""
        jobs = people_plan((task,), (name,), (seed,), scenario=self._scenario).episodes()
        found = next((job for job in jobs if isinstance(job, EpisodeSetup) and job.half == half), None)
        if found is None:
            raise UserError(f"task {task!r} has no half {half!r} that runs in {self._scenario or 'any scenario'}")
        return replace(found, repeat=self._first(lambda repeat: replace(found, repeat=repeat).id))

    def plan_of(self, rows: Sequence[EpisodeRow]) -> Json:
        return people_plan(
            sorted({row.task for row in rows}),
            sorted({row.model for row in rows}),
            sorted({row.seed for row in rows}),
            1 + max((row.repeat for row in rows), default=0),
            self._scenario,
        ).as_json()


class PlayedDrives(_PlayedRows[DriveTrialRow]):
    """Drives that a person played."""

    kind = DriveTrialRow

    def drive(self, family: str, seed: int, name: str) -> DriveSetup:
        """The next drive of a person. Raises UserError: another process writes here."""

        def at(repeat: int) -> DriveSetup:
            return DriveSetup(family, seed, CONDITIONS, agent=HUMAN, model=name, repeat=repeat)

        return at(self._first(lambda repeat: at(repeat).id))

    def plan_of(self, rows: Sequence[DriveTrialRow]) -> Json:
        plan = Plan(
            drives=tuple(sorted({row.family for row in rows})),
            agents=(HUMAN,),
            models=tuple(sorted({row.model for row in rows})),
            seeds=tuple(sorted({row.seed for row in rows})),
            repeats=1 + max((row.repeat for row in rows), default=0),
        )
        return with_conditions(plan, CONDITIONS).as_json()
