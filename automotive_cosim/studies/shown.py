"""Writes the report of a study of a whole network: one page, its tables and plots as files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.formats.writing import drafted
from automotive_cosim.report.charts import Chart
from automotive_cosim.report.files import write_files
from automotive_cosim.report.tables import Table
from automotive_cosim.report.templates import render
from automotive_cosim.run.store import cannot_write


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


def write_shown(folder: Path, shown: ShownStudy, plan: Json, manifest: Json, errors: int, missing: int) -> Path:
    """Writes ``report.html``, ``tables/`` and ``plots/`` into a study's folder; returns the page.

    Args:
        folder: the study's.
        shown: what to show.
        plan: the study's plan.
        manifest: with its starts.
        errors: number of infrastructure errors.
        missing: number of jobs of the plan that have not run yet.

    Raises:
        UserError: they cannot be written.
    """
    try:
        text = render(
            "studies/network.html",
            title=shown.title,
            about=shown.about,
            answer=shown.answer,
            warnings=shown.warnings,
            tables=shown.tables,
            plots=shown.plots,
            errors=errors,
            missing=missing,
            plan=plan,
            starts=manifest["starts"],
        )
        with drafted(folder / "report.html") as file:
            write_files(folder, shown.tables, shown.plots.values())
            file.write(text.encode())
    except OSError as error:
        raise cannot_write(folder, error) from error
    return folder / "report.html"
