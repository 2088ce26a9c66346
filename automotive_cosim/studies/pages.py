"""The report of any study's folder, whatever kind of study it is."""

from __future__ import annotations

from pathlib import Path

from automotive_cosim.run.store import read_manifest
from automotive_cosim.studies.congestion.page import write_congestion
from automotive_cosim.studies.congestion.plan import KIND
from automotive_cosim.studies.page import write_study


def write_page(folder: Path) -> Path:
    """Writes all of a study's pages, data, tables and plots into its folder; returns ``report.html``.

    Raises:
        UserError: the folder is not a study's, has no results, or cannot be written.
        SetupError: the extra ``report`` is not installed.
    """
    return write_congestion(folder) if read_manifest(folder)["plan"].get("study") == KIND else write_study(folder)
