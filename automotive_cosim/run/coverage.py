"""How much of its plan an evaluation has run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import UserError
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.rows import DriveTrialRow, EpisodeRow, TrialRow
from automotive_cosim.run.trial import TrialSetup
from automotive_cosim.tasking.fingerprint import fingerprint
from automotive_cosim.tasks import CATALOGUE


@dataclass(frozen=True, slots=True)
class Coverage:
    """How many of the planned episodes were judged, ended in an error or were not run."""

    judged: int
    errors: int
    not_run: tuple[TrialRow, ...] = ()
    """The planned episodes without a row, with what is known about an episode before it runs."""
    shared: frozenset[str] = frozenset()
    """Ids of the episodes on whose instance no contestant's episode is still to be run."""
    shared_instances: int | None = None
    """Their instances; None if nothing is still to be run."""
    unit: str = "episode"
    """What is counted: ``episode``, ``drive``, or ``run`` for both."""
    problem: str = ""
    """Why it is not known what was planned; then ``not_run`` is empty."""
    nothing_due: int = 0
    """Judged drives in which nothing required an act: they say nothing about an agent."""
    outdated: frozenset[str] = frozenset()
    """Ids of the episodes on halves of tasks that have changed since: what was won there may be lost today."""

    @property
    def planned(self) -> int:
        """The number of planned episodes, or, if that is not known, of those that have a row."""
        return self.judged + self.errors + len(self.not_run)

    @property
    def is_complete(self) -> bool:
        """Whether every planned episode has a row."""
        return not self.not_run and not self.problem

    def __str__(self) -> str:
        errors = f", {counted(self.errors, 'error')}" if self.errors else ""
        errors = (f", nothing was due in {self.nothing_due:,} of them" if self.nothing_due else "") + errors
        errors += f", {len(self.outdated):,} on tasks that have changed since" if self.outdated else ""
        if self.problem:
            known = f"{counted(self.judged, self.unit)} judged{errors}"
            return f"{known}; the rest of the plan is not known: {self.problem}"
        rest = f", {len(self.not_run):,} not run" if self.not_run else ""
        return f"{self.judged:,} of {counted(self.planned, f'planned {self.unit}')} judged{errors}{rest}"


def coverage(manifest: Json, rows: Mapping[str, TrialRow]) -> Coverage:
    """Compares an evaluation's rows with its plan, expanded by the installed catalogue.

    Args:
        rows: its rows by id."""
    judged = sum(row.outcome is not None for row in rows.values())
    errors, unit = len(rows) - judged, unit_of(manifest["plan"])
    idle = sum(isinstance(row, DriveTrialRow) and row.has_nothing_due for row in rows.values())
    outdated = frozenset(row.id for row in rows.values() if isinstance(row, EpisodeRow) and is_outdated(row))
    found = Coverage(judged, errors, shared=frozenset(rows), unit=unit, nothing_due=idle, outdated=outdated)
    if manifest.get("episodes") == len(rows):  # even if the catalogue has changed since
        return found
    jobs: dict[str, TrialSetup] = {}
    try:
        jobs |= make_plan(manifest["plan"]).trials_by_id()
        problem = _drift(manifest, rows, jobs)
    except UserError as error:
        problem = " ".join(str(error).split())
    if problem:
        return replace(found, problem=problem)
    not_run = [job for job in jobs.values() if job.id not in rows]
    waiting = {job.instance for job in not_run}
    shared = [job for job in jobs.values() if job.instance not in waiting]
    return replace(
        found,
        not_run=tuple(job.planned() for job in not_run),
        shared=frozenset(job.id for job in shared),
        shared_instances=len({job.instance for job in shared}) if not_run else None,
    )


def is_outdated(row: EpisodeRow) -> bool:
    """Whether the half of the task has changed since, or is gone; rows of 0.2.0 do not tell."""
    if not row.half_digest:
        return False
    if row.task not in CATALOGUE:
        return True
    task = CATALOGUE[row.task]
    return row.half not in task.halves or fingerprint(task, row.half) != row.half_digest


def unit_of(plan: Json) -> str:
    """What a plan's trials are called."""
    single = plan.get("trials", ())
    drives = bool(plan.get("drives")) or any(each.get("drive") for each in single)
    tasks = bool(plan.get("tasks")) or any(each.get("task") for each in single)
    if not drives:
        return "episode"
    return "run" if tasks else "drive"


def _drift(manifest: Json, rows: Mapping[str, TrialRow], jobs: Mapping[str, TrialSetup]) -> str:
    """How the plan's episodes differ from those of the version that ran it; empty if they do not."""
    count = manifest.get("episodes", len(jobs))
    if count != len(jobs):
        return f"the plan had {count} {unit_of(manifest['plan'])}s and has {len(jobs)} with the installed tasks"
    surplus = [name for name in rows if name not in jobs]
    return (
        f"{counted(len(surplus), unit_of(manifest['plan']))} not in the plan, such as {surplus[0]}"
        if surplus
        else ""
    )
