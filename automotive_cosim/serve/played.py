"""What people play for the record: an evaluation of the agent ``human``, which every report reads.

The model of a row is the person's code name. Somebody who plays an instance again gets a further repeat, so that a
first try is never replaced.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from automotive_cosim.episode.specification import Clock
from automotive_cosim.errors import UserError
from automotive_cosim.run.episode_row import EpisodeRow
from automotive_cosim.run.plan import ALL_SUITES, HUMAN, EpisodeJob, Limits, Plan
from automotive_cosim.run.store import Store, opened, read_rows, replan

FOLDER = "people"
"""Folder of the played episodes, in the first of the folders shown."""
MOST_S, MOST_STEPS = 120.0, 1000
"""Simulated seconds, and acts, after which a played episode ends."""
LONGEST_NAME = 40


def people_plan(
    tasks: Sequence[str],
    people: Sequence[str],
    seeds: Sequence[int],
    repeats: int = 1,
    scenario: str | None = None,
) -> Plan:
    """The plan in which everybody plays every task with every seed. A person's seconds pass on the road."""
    return Plan(
        agents=(HUMAN,),
        models=tuple(people),
        tasks=tuple(tasks),
        suite=ALL_SUITES,
        scenarios=() if scenario is None else (scenario,),
        seeds=tuple(seeds),
        repeats=repeats,
        clock=str(Clock.MODEL),
        limits=Limits(steps=MOST_STEPS, hard_steps=MOST_STEPS, sim_s=MOST_S),
    )


def check_code_name(name: str) -> None:
    """Refuses what cannot stand for a person in reports and file names.

    Raises:
        UserError: it is empty, too long, or has other signs than letters, digits, spaces, - and _.
    """
    is_plain = all(letter.isalnum() or letter in " -_" for letter in name)
    if not name.strip() or len(name) > LONGEST_NAME or not is_plain:
        raise UserError(
            f"{name[:LONGEST_NAME]!r} is not a code name; give up to {LONGEST_NAME} letters, digits, spaces, - or _"
        )


class PlayedRows:
    """An evaluation that grows with whatever is played. Any method may be called from any thread."""

    def __init__(self, folder: Path, scenario: str | None = None) -> None:
        """Nothing is written before the first job.

        Args:
            folder: the evaluation's.
            scenario: instead of the tasks' own.
        """
        self.folder = folder
        self._scenario = scenario
        self._lock = threading.Lock()
        self._ends = ExitStack()
        self._store: Store[EpisodeRow] | None = None

    def job(self, task: str, half: str, seed: int, name: str) -> EpisodeJob:
        """The next episode of a person.

        Raises:
            UserError: there is no such task or half, or another process writes here.
        """
        jobs = people_plan((task,), (name,), (seed,), scenario=self._scenario).jobs()
        found = next((job for job in jobs if job.setup.half == half), None)
        if found is None:
            raise UserError(f"task {task!r} has no half {half!r} that runs in {self._scenario or 'any scenario'}")
        with self._lock:
            rows = self._opened().rows
            repeat = 0
            while replace(found, repeat=repeat).id in rows:
                repeat += 1
            return replace(found, repeat=repeat)

    def keep(self, row: EpisodeRow) -> None:
        """Adds a row.

        Raises:
            UserError: it cannot be written.
        """
        with self._lock:
            store = self._opened()
            store.append(row)
            replan(self.folder, self._plan_of(store.rows.values()).as_json(), len(store.rows))

    def close(self) -> None:
        """Lets another process write."""
        with self._lock:
            self._ends.close()
            self._store = None

    def _opened(self) -> Store[EpisodeRow]:
        if self._store is None:
            rows = read_rows(self.folder, EpisodeRow)
            plan = self._plan_of(rows.values()).as_json()
            self._store = self._ends.enter_context(
                opened(self.folder, plan, EpisodeRow, planned=len(rows), grows=True)
            )
        return self._store

    def _plan_of(self, rows: Iterable[EpisodeRow]) -> Plan:
        """The smallest plan that has these rows, which are all of it that was meant to be run."""
        played = list(rows)
        return people_plan(
            sorted({row.task for row in played}),
            sorted({row.model for row in played}),
            sorted({row.seed for row in played}),
            1 + max((row.repeat for row in played), default=0),
            self._scenario,
        )
