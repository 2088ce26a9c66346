"""Writes the report of a study of a whole network: one page, its tables and plots as files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from automotive_cosim.formats.writing import drafted
from automotive_cosim.report.charts import Chart
from automotive_cosim.report.files import write_files
from automotive_cosim.report.tables import Table
from automotive_cosim.report.templates import render
from automotive_cosim.run.store import cannot_write
from automotive_cosim.studies.content import StudyContent


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
