"""Tables as comma-separated values."""

from __future__ import annotations

import csv
import gzip
from collections.abc import Iterable, Iterator
from io import StringIO, TextIOWrapper
from pathlib import Path

from automotive_cosim.formats import bounds
from automotive_cosim.formats.files import opened
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

    Raises OSError: it cannot be written."""
    make_folder(path.parent)
    write_whole(path, gzip.compress(csv_text(columns, rows).encode(), mtime=0))


def read_packed_csv(path: Path) -> Iterator[dict[str, str]]:
    """The rows of what ``write_packed_csv`` wrote, by the names of their columns; none if the file is not there.

    Raises:
        OSError: it cannot be read.
        ValueError: it is no such table, or has too many cells.
        LookupError: a row lacks a column, once that is asked for."""
    if not path.is_file():
        return
    left = bounds.CELLS
    with opened(path) as file, TextIOWrapper(file, encoding="utf-8", newline="") as text:
        lines = csv.reader(text)
        try:
            columns = next(lines, [])
            for line in lines:
                left -= len(line)
                if left < 0:
                    raise ValueError(f"it has over {bounds.CELLS:,} cells")
                yield dict(zip(columns, line, strict=False))
        except csv.Error as error:
            raise ValueError(str(error)) from error
