"""What reading a file of somebody else may cost: every bound, and which reader has which.

A bound is one of cost, not of bytes: a small file can declare, repeat or unpack to far more than it is. Values of
JSON, elements of XML and cells of a table are counted before they are kept; what a library of others reads, it
reads in a process with limits of memory and processor time (``limited``).
"""

from __future__ import annotations

from dataclasses import dataclass

CHUNK_BYTES = 2**16
"""Read at once."""
TEXT_BYTES = 2**20
"""Of a text written by hand: nobody writes more, and a wrong path may be a device that never ends."""
WHOLE_BYTES = 2**28
"""Of a film, a picture or a page that is passed on as it is."""
UNPACKED_BYTES = 2**30
FREELY_UNPACKED_BYTES = 2**26
TIMES_UNPACKED = 100
"""An archive may unpack to 64 MB, or to a hundred times its size, at most to 1 GB. SUMO's and OpenStreetMap's XML
packs ten to thirty times; a bomb, a thousand times."""
VALUES = 5_000_000
"""Of JSON, which take at most half a gigabyte: 60 MB of empty lists would take thirty times their size. Half an
hour of a drive has a million."""
ROAD_VALUES = 50_000_000
"""Of a recorded road: two hours with a thousand vehicles."""
LINE_BYTES = 2**26
"""Of one line of JSON."""
ELEMENTS = 30_000_000
"""Of XML that is read one after the other: the largest network of a city has some millions."""
KEPT_ELEMENTS = 5_000_000
"""Of XML that is kept as a tree, half a kilobyte each."""
TAG_BYTES = 2**24
"""Of one tag of XML, which its parser keeps whole; the longest shapes and routes have a hundredth."""
TABLE_BYTES = 2**28
"""Of a table of counts, unpacked; a year of one of Paris' detectors has a megabyte."""
CELLS = 20_000_000
"""Of a table, those included that a workbook only declares."""
CELL_BYTES = 2**29
"""Of all texts of a table together: one text of a workbook may stand in every cell."""
BOOK_TIMES = 100
"""What a workbook says that it unpacks to, compared with its size, beyond ``FREELY_UNPACKED_BYTES``."""
PATTERN = 200
"""Characters of a pattern of names: to prepare a longer one takes longer than reading the file."""
TASK_TEXT = 10_000
"""Characters of one text of a task; a long one has a thousand."""
TASK_COST = 5_000_000
"""Values and characters that are made of a file of tasks: a name, column or default counts wherever it is used."""
PIXELS = 2**24
"""Of a picture: 16 megapixels; a screen has one."""


@dataclass(frozen=True, slots=True)
class Cost:
    """What a process that reads a file may take: a fixed amount and a multiple of the file's size."""

    free_bytes: int = 2**30
    """Memory beyond what the program itself has."""
    times: int = 16
    """Further memory, as a multiple of the file."""
    free_s: int = 60
    """Processor seconds."""
    s_per_mb: int = 4
    """Further processor seconds for each megabyte of the file."""


BUNDLE = Cost()
WORKBOOK = Cost()
MAP = Cost(2**31, 64, 60, 20)
"""An extract of a city, packed in PBF, becomes thirty times its size as Python keeps it."""


@dataclass(frozen=True, slots=True)
class _BoundedReader:
    """A kind of file of somebody else, and what keeps its reading in bounds."""

    what: str
    where: str
    """The module that reads it."""
    bound: str
    """In words."""


def _mb(size: int) -> str:
    return f"{size >> 20} MB"


def _process(cost: Cost) -> str:
    return (
        f"a process with {_mb(cost.free_bytes)} and {cost.times} times the file in memory, {cost.free_s} s and "
        f"{cost.s_per_mb} s per MB of processor time"
    )


_PACKED = f"unpacked {_mb(FREELY_UNPACKED_BYTES)} or {TIMES_UNPACKED} times its size, at most {_mb(UNPACKED_BYTES)}"
_XML = f"{_PACKED}; {ELEMENTS:,} elements, {_mb(TAG_BYTES)} a tag, no document type"
_TREE = f"{_PACKED}; {KEPT_ELEMENTS:,} elements, {_mb(TAG_BYTES)} a tag, no document type"

READERS = (
    _BoundedReader(
        "TOML (scenario, plan, rules, space, make) and scripts of actions", "formats.files", _mb(TEXT_BYTES)
    ),
    _BoundedReader("patterns in them, of tasks and streets", "formats.words", f"{PATTERN} characters"),
    _BoundedReader(
        "tasks in TOML",
        "tasking.reading",
        f"{_mb(TEXT_BYTES)}, {TASK_TEXT:,} characters a text; {TASK_COST:,} values and characters made of it",
    ),
    _BoundedReader("a prompt of your own", "episode.own_prompt", "16,000 characters"),
    _BoundedReader("JSON (results, setups, calibrations)", "formats.files", f"{_PACKED}; {VALUES:,} values"),
    _BoundedReader(
        "lines of JSON (rows, traces, steps)",
        "formats.files",
        f"{_PACKED}; {VALUES:,} values, {_mb(LINE_BYTES)} a line",
    ),
    _BoundedReader("a recorded road", "run.road", f"{_PACKED}; {ROAD_VALUES:,} values, {_mb(LINE_BYTES)} a line"),
    _BoundedReader("SUMO's XML (networks, routes, additionals)", "formats.xml", _XML),
    _BoundedReader("OpenSCENARIO and OpenDRIVE, also packed", "exchange.tree", _TREE),
    _BoundedReader("counts in SUMO's XML", "studies.calibration.sumo_counts", _TREE),
    _BoundedReader("OSM as XML, packed XML, PBF or Overpass JSON", "osm.extract", _process(MAP)),
    _BoundedReader(
        "a workbook (.xlsx, .xls, .ods) of counts",
        "studies.calibration.sheets",
        f"declared to unpack to {_mb(FREELY_UNPACKED_BYTES)} or {BOOK_TIMES} times its size; {CELLS:,} cells with "
        f"{_mb(CELL_BYTES)} of text; {_process(WORKBOOK)}",
    ),
    _BoundedReader(
        "a table of counts as text", "studies.calibration.sheets", f"{_mb(TABLE_BYTES)}, {CELLS:,} cells"
    ),
    _BoundedReader("a table that a study packed", "formats.csvs", f"{_PACKED}; {CELLS:,} cells"),
    _BoundedReader("a picture of a run", "report.page", f"{PIXELS:,} pixels"),
    _BoundedReader("a bundle", "publish.archive", f"1,000 times its size, at most 8 GB; {_process(BUNDLE)}"),
)
"""GeoJSON, Parquet and OSI are written and never read."""
