"""The files beside a page: its tables and its plots, in the forms that papers and slides take."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from automotive_cosim.formats.writing import make_folder, write_whole
from automotive_cosim.report.charts import Chart
from automotive_cosim.report.tables import Table


def write_files(folder: Path, tables: Iterable[Table], plots: Iterable[Chart]) -> None:
    """Writes ``tables/`` as Markdown, CSV and LaTeX, and ``plots/`` as SVG, PDF and PNG.

    Raises:
        OSError: they cannot be written.
        SetupError: matplotlib is not installed."""
    for table in tables:
        for suffix, text in (("md", table.markdown()), ("csv", table.csv()), ("tex", table.latex())):
            write_whole(make_folder(folder, "tables") / f"{table.name}.{suffix}", text)
    for plot in plots:
        for suffix, content in plot.files():
            write_whole(make_folder(folder, "plots") / f"{plot.name}.{suffix}", content)
