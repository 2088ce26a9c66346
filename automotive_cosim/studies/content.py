"""What every study's folder holds: a manifest with its plan, and a row for each job; and its report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Generic, Self, TypeVar

from automotive_cosim.contracts import Json
from automotive_cosim.formats.writing import drafted
from automotive_cosim.report.charts import Chart
from automotive_cosim.report.files import write_files
from automotive_cosim.report.tables import Table
from automotive_cosim.report.templates import render
from automotive_cosim.run.row import JobRow
from automotive_cosim.run.store import cannot_write, read_manifest, read_rows
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


@dataclass(frozen=True, slots=True)
class ShownStudy:
    """What a report shows."""

    title: str
    """What kind of study it is."""
    about: str
    """What was run, in a few words."""
    answer: str
    """The result in one sentence."""
    warnings: Sequence[str]
    tables: Sequence[Table]
    plots: Mapping[str, Chart]
    """By name."""


def write_shown(study: StudyContent[Any, Any], shown: ShownStudy) -> Path:
    """Writes ``report.html``, ``tables/`` and ``plots/`` into a study's folder; returns the page.

    Raises:
        UserError: they cannot be written.
    """
    plan, folder = study.plan, study.folder
    try:
        text = render(
            "studies/network.html",
            title=shown.title,
            about=shown.about,
            answer=shown.answer,
            warnings=shown.warnings,
            tables=shown.tables,
            plots=shown.plots,
            errors=len(study.errors),
            missing=len(plan.jobs()) - len(study.rows),
            plan=plan.as_json(),
            starts=study.manifest["starts"],
        )
        with drafted(folder / "report.html") as file:
            write_files(folder, shown.tables, shown.plots.values())
            file.write(text.encode())
    except OSError as error:
        raise cannot_write(folder, error) from error
    return folder / "report.html"
