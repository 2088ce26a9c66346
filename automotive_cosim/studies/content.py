"""What every study's folder holds: a manifest with its plan, and a row for each job; and its report."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Self, TypeVar

from automotive_cosim.contracts import Json
from automotive_cosim.errors import SetupError, UserError, install_hint
from automotive_cosim.formats.writing import drafted, write_whole
from automotive_cosim.report.charts import Chart
from automotive_cosim.report.files import write_files
from automotive_cosim.report.tables import Table
from automotive_cosim.report.templates import render
from automotive_cosim.run.job_row import JobRow
from automotive_cosim.run.store import cannot_write, read_manifest, read_rows
from automotive_cosim.studies.plan import plan_of
from automotive_cosim.studies.settings import HOME, NETWORKS, RerouteSettings

if TYPE_CHECKING:
    import pandas as pd

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
    line_is: ClassVar[str]
    """What a line of its data frame is about, in words."""

    def lines(self) -> Iterator[Json]:
        """The lines of its data frame, each with its seed."""
        raise NotImplementedError

    @property
    def errors(self) -> tuple[StudyRowT, ...]:
        """Rows of jobs that ended in an infrastructure error."""
        return tuple(row for row in self.rows if row.error is not None)

    @classmethod
    def read(cls, folder: Path) -> Self:
        """Reads a folder, even of a running study.

        Raises UserError: it is not such a study's folder, or is damaged."""
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
    picture: str = ""
    """HTML below the plots."""
    pages: Mapping[str, str] = field(default_factory=dict)
    """Pages beside it, by their file names."""


REROUTE = "reroute.results:Study"
"""What reads a rerouting study."""


def load_study(folder: Path | str) -> pd.DataFrame:
    """A study of any kind as a data frame, every line with its seed; of several networks, with the network first.

    A line is a choice of a policy at a decision, with news of an age, at a compliance (``reroute``); the traffic
    without an intervention or with one (``congestion``); cars at a share (``adoption``); or a day of a share of
    advised drivers (``days``).

    Raises:
        UserError: it is not a study's folder, or is damaged.
        SetupError: pandas is not installed."""
    try:
        import pandas as pd
    except ImportError as error:
        raise SetupError(f"load_study requires pandas: {install_hint('reports')}") from error
    home = Path(folder)
    parts = [] if (home / "manifest.json").is_file() else sorted(home.glob("[0-9][0-9]_*/manifest.json"))
    lines = [{"network": part.parent.name[3:]} | line for part in parts for line in _lines(part.parent)]
    return pd.DataFrame(lines if parts else _lines(home))


def _lines(folder: Path) -> list[Json]:
    kind = read_manifest(folder)["plan"].get("study")
    if kind not in (RerouteSettings.kind, *NETWORKS):
        raise UserError(f"{folder} is no study; automotive_cosim.load_results reads evaluations")
    return list(read_study(folder, kind).lines())


def read_study(folder: Path, kind: str) -> StudyContent[Any, Any]:
    """The content of a folder of a kind, even of a running study.

    Raises UserError: it is not such a study's folder, or is damaged."""
    content: type[StudyContent[Any, Any]] = resolve_name(
        f"{HOME}.{NETWORKS[kind][0] if kind in NETWORKS else REROUTE}"
    )
    return content.read(folder)


def shown_of(study: StudyContent[Any, Any]) -> ShownStudy:
    """What the report of a study of a whole network shows."""
    shown: ShownStudy = resolve_name(f"{HOME}.{NETWORKS[study.plan.kind][1]}")(study)
    return shown


def write_report(folder: Path) -> Path:
    """Writes the report of a study of a whole network into its folder; returns ``report.html``.

    Raises:
        UserError: the folder is damaged, or cannot be written.
        SetupError: the extra ``reports`` is not installed."""
    study = read_study(folder, read_manifest(folder)["plan"]["study"])
    return write_shown(study, shown_of(study))


def write_shown(study: StudyContent[Any, Any], shown: ShownStudy) -> Path:
    """Writes ``report.html``, ``tables/`` and ``plots/`` into a study's folder; returns the page.

    Raises UserError: they cannot be written."""
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
            picture=shown.picture,
            errors=len(study.errors),
            missing=len(plan.jobs()) - len(study.rows),
            plan=plan.as_json(),
            of=study.line_is,
            starts=study.manifest["starts"],
        )
        with drafted(folder / "report.html") as file:
            write_files(folder, shown.tables, shown.plots.values())
            for name, page in shown.pages.items():
                write_whole(folder / name, page)
            file.write(text.encode())
    except OSError as error:
        raise cannot_write(folder, error) from error
    return folder / "report.html"
