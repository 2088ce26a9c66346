"""Tables as comma-separated values."""

from __future__ import annotations

import csv
import gzip
from collections.abc import Iterable
from io import StringIO
from pathlib import Path

from automotive_cosim.formats.writing import make_folder, write_whole


def csv_text(columns: Iterable[object], rows: Iterable[Iterable[object]]) -> str:
    """A table, the columns' names first; what is None is empty."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(rows)
    return text.getvalue()


def write_packed_csv(path: Path, columns: Iterable[object], rows: Iterable[Iterable[object]]) -> None:
    """Writes a table as gzipped CSV, whole or not at all; its folder is created.

    Raises:
        OSError: it cannot be written.
    """
    make_folder(path.parent)
    write_whole(path, gzip.compress(csv_text(columns, rows).encode(), mtime=0))
