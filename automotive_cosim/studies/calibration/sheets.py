"""Reads a table that somebody saved from a spreadsheet: a workbook, or text with separated cells.

Workbooks (.xlsx, .xls, .ods) are read by calamine, from the first visible sheet that has the columns; every cell of
a merged range has the range's value. Text may be separated by commas, semicolons or tabs, be UTF-8, UTF-16
("Unicode text") or Windows' Western European (cp1252), and have decimal commas where cells are not separated by
commas. Lines above the names of the columns are skipped.
"""

from __future__ import annotations

import codecs
import csv
import io
import re
import zipfile
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime, time
from importlib.util import find_spec
from pathlib import Path

from automotive_cosim.errors import SetupError, UserError, install_hint
from automotive_cosim.formats import bounds
from automotive_cosim.formats.files import opened
from automotive_cosim.formats.limited import read_limited

WORKBOOKS = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")
"""How .xlsx and .ods begin, which are archives, and .xls."""

MOST_ABOVE = 50
"""Lines above the names of the columns."""

DELIMITERS = (",", ";", "\t")
DECIMAL_COMMA = re.compile(r"^(-?\d+),(\d+)$")
THOUSANDS = re.compile(r"(?<=\d)[ \u00a0\u202f](?=\d{3}(?!\d))")
"""Spaces in a number, also those that do not break."""

CONTROL = re.compile(r"[\x00-\x08\x0e-\x1f]")
"""What no text has."""

Cells = Sequence[Sequence[str]]


@dataclass(frozen=True, slots=True)
class SheetRow:
    """A row below the names of the columns."""

    line: int
    """Its number in the file, from 1."""
    cells: dict[str, str]
    """Column -> text; empty if there is none."""


@dataclass(frozen=True, slots=True)
class Sheet:
    """A table."""

    columns: tuple[str, ...]
    rows: tuple[SheetRow, ...]


def read_sheet(
    path: Path, wanted: Sequence[Collection[str]], known: Collection[str], figures: Collection[str]
) -> Sheet:
    """Reads a table; if no line has the wanted columns, its first one names them.

    Args:
        known: columns whose case and spaces do not matter.

    Raises:
        UserError: it cannot be read.
        SetupError: it is a workbook, and calamine is not installed."""
    widest: Cells = ()
    for cells, has_commas in _tables(path):
        for number, line in enumerate(cells[:MOST_ABOVE]):
            names = [_column(name, known) for name in line]
            if any(set(columns) <= set(names) for columns in wanted):
                return _sheet(names, cells, number, figures if has_commas else ())
        if cells and len(cells[0]) > (len(widest[0]) if widest else 0):
            widest = cells
    return _sheet([_column(name, known) for name in widest[0]] if widest else [], widest, 0, ())


def _tables(path: Path) -> Iterator[tuple[Cells, bool]]:
    """What the file may mean, and whether its decimals may have commas."""
    data = _data(path)
    if data.startswith(WORKBOOKS):
        if find_spec("python_calamine") is None:
            hint = install_hint("maps")
            raise SetupError(f"{path} is a workbook, which requires python-calamine: {hint}, or save it as CSV")
        yield from ((cells, False) for cells in read_limited(_workbook, path, bounds.WORKBOOK, UserError))
    else:
        text = _text(path, data)
        for delimiter in DELIMITERS:
            yield _separated(path, text, delimiter), delimiter != ","


def _sheet(names: Sequence[str], cells: Cells, head: int, figures: Collection[str]) -> Sheet:
    def value(name: str, text: str) -> str:
        return DECIMAL_COMMA.sub(r"\1.\2", THOUSANDS.sub("", text)) if name in figures else text

    blank = dict.fromkeys(names, "")
    rows = (
        SheetRow(number, blank | {name: value(name, text) for name, text in zip(names, line, strict=False)})
        for number, line in enumerate(cells[head + 1 :], start=head + 2)
    )
    return Sheet(tuple(names), tuple(row for row in rows if any(row.cells.values())))


def _column(name: str, known: Collection[str]) -> str:
    """The name of a column, whatever its case."""
    plain = name.casefold().replace(" ", "_")
    return plain if plain in known else name


def _data(path: Path) -> bytes:
    try:
        with opened(path) as file:
            data = file.read(bounds.TABLE_BYTES + 1)
    except OSError as error:
        reason = getattr(error, "strerror", None) or error
        raise UserError(f"{path} cannot be read ({reason}); give a table of counts") from error
    if len(data) > bounds.TABLE_BYTES:
        raise _too_large(path, f"is larger than {bounds.TABLE_BYTES / 2**20:g} MB")
    return data


def _text(path: Path, data: bytes) -> str:
    wide = data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    text = None
    for encoding in ("utf-16",) if wide else ("utf-8-sig", "cp1252"):
        try:
            text = data.decode(encoding)
            break
        except UnicodeDecodeError:
            continue
    if text is None or CONTROL.search(text):
        raise UserError(f"{path} is neither text nor a workbook; in a spreadsheet, save it as CSV UTF-8 or .xlsx")
    return text


def _separated(path: Path, text: str, delimiter: str) -> Cells:
    """The lines of a text; a row whose cell has a line break counts as one."""
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, skipinitialspace=True)
    left, cells = bounds.CELLS, []
    try:
        for line in reader:
            left -= len(line)
            if left < 0:
                raise _too_large(path, f"has over {bounds.CELLS:,} cells")
            cells.append([cell.strip() for cell in line])
        return cells
    except csv.Error as error:
        raise UserError(f"{path} line {reader.line_num}: {error}; give a table of counts") from error


def _too_large(path: Path, why: str) -> UserError:
    return UserError(f"{path} {why}; give the rows of fewer detectors")


def _workbook(path: Path) -> list[Cells]:
    """The visible sheets; runs in a process with limits, since only its library knows what it unpacks to."""
    from python_calamine import CalamineError, CalamineWorkbook, SheetVisibleEnum, ZipError

    _refuse_bomb(path)
    sheets: list[Cells] = []
    left = bounds.CELLS, bounds.CELL_BYTES
    try:
        book = CalamineWorkbook.from_filelike(io.BytesIO(_data(path)))
        for about in book.sheets_metadata:
            if about.visible != SheetVisibleEnum.Visible:
                continue
            sheet = book.get_sheet_by_name(about.name)
            bottom, right = sheet.end or (-1, -1)
            left = left[0] - (bottom + 1) * (right + 1), left[1]
            if left[0] < 0:
                raise _too_large(path, f"has over {bounds.CELLS:,} cells")
            cells: list[list[str]] = []
            for found in sheet.to_python(skip_empty_area=False):
                cells.append([_told(cell) for cell in found])
                left = left[0], left[1] - sum(map(len, cells[-1]))
                if left[1] < 0:
                    raise _too_large(path, f"has over {bounds.CELL_BYTES / 2**20:g} MB of text in its cells")
            for (top, left_), (bottom, right) in sheet.merged_cell_ranges or ():
                for line in cells[top : bottom + 1]:
                    line[left_ : right + 1] = [cells[top][left_]] * len(line[left_ : right + 1])
            sheets.append([line if any(line) else () for line in cells])
    except (CalamineError, ZipError) as error:
        raise UserError(f"{path} is not a workbook that can be read ({error}); save it as .xlsx or CSV") from error
    return sheets


def _refuse_bomb(path: Path) -> None:
    """
    Raises UserError: what the workbook declares to hold is far more than it is."""
    try:
        with opened(path) as file, zipfile.ZipFile(io.BytesIO(file.read())) as parts:
            declared = sum(part.file_size for part in parts.infolist())
    except (zipfile.BadZipFile, NotImplementedError, ValueError):
        return  # .xls, which packs nothing; or damaged, which calamine says
    most = max(bounds.FREELY_UNPACKED_BYTES, bounds.BOOK_TIMES * path.stat().st_size)
    if declared > most:
        raise _too_large(path, f"unpacks to over {most / 1e6:.0f} MB")


def _told(cell: object) -> str:
    """A cell as text; a number without decimals is a whole one."""
    if isinstance(cell, float) and cell.is_integer():
        return str(int(cell))
    if isinstance(cell, datetime | time):
        return cell.isoformat()
    return str(cell).strip()
