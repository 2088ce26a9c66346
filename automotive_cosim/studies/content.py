"""What every study's folder holds: a manifest with its plan, and a row for each job."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, Protocol, Self, TypeVar

from automotive_cosim.contracts import Json
from automotive_cosim.run.executor import Job
from automotive_cosim.run.row import JobRow
from automotive_cosim.run.store import read_manifest, read_rows


class JobsPlan(Protocol):
    """A plan of jobs."""

    def jobs(self) -> Iterable[Job]:
        """All of them, in order."""
        ...


PlanT = TypeVar("PlanT", bound=JobsPlan)
StudyRowT = TypeVar("StudyRowT", bound=JobRow)


@dataclass(frozen=True)
class StudyContent(Generic[PlanT, StudyRowT]):
    """The content of a study's folder."""

    folder: Path
    manifest: Json
    plan: PlanT
    rows: tuple[StudyRowT, ...]
    """One row per job, in the order of the plan."""

    @property
    def errors(self) -> tuple[StudyRowT, ...]:
        """Rows of jobs that ended in an infrastructure error."""
        return tuple(row for row in self.rows if row.error is not None)

    @classmethod
    def read(cls, folder: Path, plan_of: Callable[[Mapping[str, Any]], PlanT], kind: type[StudyRowT]) -> Self:
        """Reads a folder, even of a running study.

        Args:
            folder: the study's.
            plan_of: reads its plan.
            kind: of its rows.

        Raises:
            UserError: it is not such a study's folder, or is damaged.
        """
        manifest = read_manifest(folder)
        plan = plan_of(manifest["plan"])
        rows = read_rows(folder, kind)
        return cls(folder, manifest, plan, tuple(rows[job.id] for job in plan.jobs() if job.id in rows))
