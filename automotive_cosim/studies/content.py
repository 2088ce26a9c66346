"""What every study's folder holds: a manifest with its plan, and a row for each job."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Generic, Self, TypeVar

from automotive_cosim.contracts import Json
from automotive_cosim.run.row import JobRow
from automotive_cosim.run.store import read_manifest, read_rows
from automotive_cosim.studies.plan import plan_of

PlanT = TypeVar("PlanT")
StudyRowT = TypeVar("StudyRowT", bound=JobRow)


@dataclass(frozen=True)
class StudyContent(Generic[PlanT, StudyRowT]):
    """The content of a study's folder."""

    folder: Path
    manifest: Json
    plan: PlanT
    rows: tuple[StudyRowT, ...]
    """One row per job, in the order of the plan."""

    plan_type: ClassVar[type[Any]]
    row_type: ClassVar[type[Any]]

    @property
    def errors(self) -> tuple[StudyRowT, ...]:
        """Rows of jobs that ended in an infrastructure error."""
        return tuple(row for row in self.rows if row.error is not None)

    @classmethod
    def read(cls, folder: Path) -> Self:
        """Reads a folder, even of a running study.

        Raises:
            UserError: it is not such a study's folder, or is damaged.
        """
        manifest = read_manifest(folder)
        plan = plan_of(cls.plan_type, manifest["plan"])
        rows = read_rows(folder, cls.row_type)
        return cls(folder, manifest, plan, tuple(rows[job.id] for job in plan.jobs() if job.id in rows))
