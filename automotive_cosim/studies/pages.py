"""The report of any study's folder, whatever kind of study it is."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from automotive_cosim.run.store import read_manifest
from automotive_cosim.studies.congestion.page import write_congestion
from automotive_cosim.studies.days_page import write_days
from automotive_cosim.studies.page import write_study
from automotive_cosim.studies.settings import CongestionSettings, DaysSettings

WRITERS: dict[object, Callable[[Path], Path]] = {
    CongestionSettings.kind: write_congestion,
    DaysSettings.kind: write_days,
}
"""By kind of study; all others are studies of rerouting."""


def write_page(folder: Path) -> Path:
    """Writes all of a study's pages, data, tables and plots into its folder; returns ``report.html``.

    Raises:
        UserError: the folder is not a study's, has no results, or cannot be written.
        SetupError: the extra ``report`` is not installed.
    """
    return WRITERS.get(read_manifest(folder)["plan"].get("study"), write_study)(folder)
