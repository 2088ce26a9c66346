"""Every reader of somebody else's file has a bound of cost, and refuses in one line what is just over it."""

import ast
import gzip
import re
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

import automotive_cosim
from automotive_cosim.episode.own_prompt import MOST_CHARACTERS, resolved
from automotive_cosim.errors import UserError
from automotive_cosim.exchange.tree import read_tree
from automotive_cosim.formats import bounds, files
from automotive_cosim.formats.bounds import READERS
from automotive_cosim.formats.csvs import read_packed_csv, write_packed_csv
from automotive_cosim.formats.limited import LimitedProcesses
from automotive_cosim.formats.toml import read_toml
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.formats.xml import scan
from automotive_cosim.osm import extract
from automotive_cosim.publish import archive
from automotive_cosim.report.page import open_picture
from automotive_cosim.run.plan import make_plan, read_plan
from automotive_cosim.run.road import read_road
from automotive_cosim.tasking.catalogue import Catalogue

PACKAGE = Path(automotive_cosim.__file__).parent

DEAR = bounds.Cost(free_bytes=-(2**28), times=0, free_s=5, s_per_mb=0)
"""Less than the program itself has, so that nothing more can be taken."""
OSM_JSON = '{"elements":[],"more":[' + "0," * 12_000_000 + "0]}"


def workbook(path: Path, cells: str, padding: int = 0) -> None:
    """The least that is a workbook with a sheet of those cells."""
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    package = "http://schemas.openxmlformats.org/package/2006"
    sheet = "application/vnd.openxmlformats-officedocument.spreadsheetml"
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{package}/content-types"><Default Extension="rels" '
        'ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Override '
        f'PartName="/xl/workbook.xml" ContentType="{sheet}.sheet.main+xml"/><Override '
        f'PartName="/xl/worksheets/sheet1.xml" ContentType="{sheet}.worksheet+xml"/></Types>',
        "_rels/.rels": f'<Relationships xmlns="{package}/relationships"><Relationship Id="r1" '
        f'Type="{office}/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{main}" xmlns:r="{office}"><sheets><sheet name="Counts" sheetId="1" '
        'r:id="r1"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{package}/relationships"><Relationship Id="r1" '
        f'Type="{office}/worksheet" Target="worksheets/sheet1.xml"/></Relationships>',
        "xl/worksheets/sheet1.xml": f'<worksheet xmlns="{main}"><sheetData>{cells}</sheetData></worksheet>',
        "notes.xml": "<a/>" + " " * padding,
    }
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as book:
        for name, text in parts.items():
            book.writestr(name, text)


def book_of(rows: int, columns: int, text: str = "x", padding: int = 0) -> Callable[[Path], None]:
    def write(path: Path) -> None:
        cells = "".join(
            f'<row r="{row}">'
            + "".join(f'<c r="{chr(65 + n)}{row}" t="inlineStr"><is><t>{text}</t></is></c>' for n in range(columns))
            + "</row>"
            for row in range(1, rows + 1)
        )
        workbook(path, cells, padding)

    return write


def text_of(content: str) -> Callable[[Path], None]:
    return lambda path: write_whole(path, content) and None


def packed(content: str) -> Callable[[Path], None]:
    return lambda path: write_whole(path, gzip.compress(content.encode())) and None


def picture(path: Path) -> None:
    Image.new("RGB", (11, 10)).save(path, "PNG")


def table(path: Path) -> None:
    write_packed_csv(path, ("a", "b"), [(1, 2)] * 6)


def zipped(path: Path) -> None:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as bundle:
        bundle.writestr("bundle.json", "{}" + " " * 1000)


def drained(read: Callable[[Path], Any]) -> Callable[[Path], None]:
    return lambda path: list(read(path)) and None


def counts(path: Path) -> None:
    from automotive_cosim.studies.calibration.sheets import read_sheet

    read_sheet(path, [("a",)], ("a",), ())


def prompt(path: Path) -> None:
    resolved(str(path))


def own_tasks(path: Path) -> None:
    Catalogue().add_folder(path.parent)


def planned(path: Path) -> None:
    make_plan(read_plan(path)).jobs()


def scanned(path: Path) -> None:
    scan(path, lambda name, attributes: None, error=UserError)


def sumo_counts(path: Path) -> None:
    from automotive_cosim.studies.calibration.sumo_counts import read_xml_counts

    read_xml_counts(path, None)


def unpack(path: Path) -> None:
    folder = path.with_suffix(".folder")
    folder.mkdir()
    with LimitedProcesses(path) as processes:
        processes.call(archive.unpack, path, folder)


@dataclass(frozen=True)
class Over:
    """A file just over a bound, once the bound is lowered."""

    reader: str
    name: str
    lowered: tuple[str, Any] | None
    """A bound of ``bounds``, and what it is for the test; None for a file over the bound as it is."""
    write: Callable[[Path], None]
    read: Callable[[Path], object]
    told: str


SHEET, COUNTS, ROAD = "a workbook", "a table of counts as text", "a recorded road"
TASKS = "tasks in TOML"
LINES, SUMO = "lines of JSON", "SUMO's XML"
MANY, DEAR_TOLD = "too many", "more memory or processor time"
HEAD = '{"format":1}\n'
BAD = (
    Over("TOML", "p.toml", ("TEXT_BYTES", 10), text_of("a = 'xxxxxx'\n"), read_toml, "larger than"),
    Over(
        "patterns",
        "p.toml",
        ("PATTERN", 5),
        text_of("agents = ['oracle']\ntasks = ['hvac_*']"),
        planned,
        "no task, pattern",
    ),
    Over(
        TASKS,
        "p.toml",
        ("TASK_TEXT", 10),
        text_of(f"t.goal = '{'x' * 11}'"),
        own_tasks,
        "longer than 10 characters",
    ),
    Over(
        TASKS,
        "p.toml",
        ("TASK_COST", 7),
        text_of("[default]\ntells = [1,1,1,1,1,1]\n[t]"),
        own_tasks,
        "of this file",
    ),
    Over("a prompt", "p.md", None, text_of("x" * (MOST_CHARACTERS + 1)), prompt, "characters"),
    Over("JSON", "a.json", ("VALUES", 10), text_of("[" + "1," * 11 + "1]"), files.read_json, MANY),
    Over("JSON", "a.gz", ("FREELY_UNPACKED_BYTES", 9000), packed(" " * 9999), files.read_json, "unpacks to"),
    Over(LINES, "a.jsonl", ("VALUES", 10), text_of("[1,1]\n" * 6), files.read_json_lines, MANY),
    Over(LINES, "a.jsonl", ("LINE_BYTES", 9), text_of('"12345678"\n'), files.read_whole_lines, "longer"),
    Over(ROAD, "road", ("ROAD_VALUES", 10), packed(HEAD + "[1,1]\n" * 6), drained(read_road), MANY),
    Over(ROAD, "road", ("LINE_BYTES", 99), packed(HEAD + "1" * 100), drained(read_road), "longer"),
    Over(SUMO, "a.xml", ("ELEMENTS", 1), text_of("<net><edge/></net>"), scanned, MANY),
    Over(SUMO, "a.xml", ("TAG_BYTES", 10), text_of(f"<net><!--{'x' * 3 * 2**16}--></net>"), scanned, "longer"),
    Over("OpenSCENARIO", "a.xosc.gz", ("KEPT_ELEMENTS", 2), packed("<a><b/><b/></a>"), read_tree, MANY),
    Over("counts in SUMO", "a.xml", ("KEPT_ELEMENTS", 2), text_of("<a><b/><b/></a>"), sumo_counts, MANY),
    Over("OSM", "a.json.gz", ("MAP", DEAR), packed(OSM_JSON), extract.read, DEAR_TOLD),
    Over(SHEET, "a.xlsx", ("CELLS", 99), book_of(10, 10), counts, "over 99 cells"),
    Over(SHEET, "a.xlsx", ("CELL_BYTES", 99), book_of(2, 1, "x" * 50), counts, "of text in its cells"),
    Over(SHEET, "a.xlsx", ("FREELY_UNPACKED_BYTES", 99), book_of(1, 1, padding=2**20), counts, "unpacks to"),
    Over(SHEET, "a.xlsx", ("WORKBOOK", DEAR), book_of(20_000, 9), counts, DEAR_TOLD),
    Over(COUNTS, "a.csv", ("CELLS", 9), text_of("a,b\n" * 5), counts, "over 9 cells"),
    Over(COUNTS, "a.csv", ("TABLE_BYTES", 9), text_of("a,b\n" * 5), counts, "larger than"),
    Over("a table that a study packed", "a.gz", ("CELLS", 9), table, drained(read_packed_csv), "over 9 cells"),
    Over("a picture", "a.png", ("PIXELS", 109), picture, open_picture, "over 109 pixels"),
    Over("a bundle", "a.bundle", None, zipped, unpack, "compressed"),
)


@pytest.mark.parametrize("over", BAD, ids=lambda over: f"{over.reader}-{over.lowered and over.lowered[0]}")
def test_a_file_just_over_a_bound_is_refused_in_a_line(
    over: Over, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if over.name.endswith(".xlsx"):
        pytest.importorskip("python_calamine")
    path = tmp_path / over.name
    over.write(path)
    if over.lowered is not None:
        monkeypatch.setattr(bounds, *over.lowered)
    with pytest.raises((UserError, OSError, ValueError), match=over.told) as refused:
        over.read(path)
    assert "\n" not in str(refused.value)


def test_every_reader_has_such_a_file() -> None:
    told = {reader.what: [over for over in BAD if reader.what.startswith(over.reader)] for reader in READERS}
    assert all(told.values()), "a reader without a file over its bound"
    assert sum(map(len, told.values())) == len(BAD), "a file of no reader, or of two"
    for reader in READERS:
        assert (PACKAGE / Path(*reader.where.split("."))).with_suffix(".py").is_file()


RAW = re.compile(
    r"\b(?:gzip|bz2|lzma)\.open\(|(?:GzipFile|BZ2File|LZMAFile|decompress|decompressobj)\(|zipfile\.ZipFile\(|tarfile"
    r"|\bET\.(?:parse|iterparse|fromstring|XML)\(|ElementTree\.(?:parse|iterparse)\(|Image\.open\(|CalamineWorkbook\."
    r"|FileProcessor\(|csv\.(?:reader|DictReader)\(|read_parquet|read_csv|read_excel|ParserCreate|pickle\.loads?\("
)
"""What unpacks or parses without a bound."""
KEPT_IN = {
    "formats/files.py": "the bounds themselves",
    "formats/compiled.py": "what this package made of its own files, where Python keeps bytecode",
    "formats/xml.py": "the same",
    "formats/csvs.py": "the same",
    "exchange/incoming.py": "roads that were read within bounds before, and netconvert's",
    "studies/calibration/sheets.py": "a process with limits",
    "osm/extract.py": "a process with limits",
    "osm/overpass_json.py": "sixty-four bytes, to tell a format",
    "publish/archive.py": "a process with limits; packs",
    "report/page.py": "the pixels are counted first",
    "run/road_recorder.py": "writes",
    "models/remote.py": "a body, up to its bound",
    "geo/basics.py": "a table of this package",
    "geo/climate.py": "a table of this package",
    "osm/demand.py": "what duarouter wrote of trips of ours",
    "studies/equilibrium/gap.py": "what SUMO wrote in a scratch folder",
    "studies/congestion/outputs.py": "the same",
    "traffic/channel.py": "what a process of this package sends",
    "traffic/network.py": "the same",
    "envs/crew.py": "the same",
    "traffic/keeper.py": "the same, by a socket that nobody else can open",
}
"""Where such a call stands, and why it may."""


def test_nothing_else_reads_without_a_bound() -> None:
    found = {
        path.relative_to(PACKAGE).as_posix()
        for path in PACKAGE.rglob("*.py")
        if RAW.search(ast.unparse(ast.parse(path.read_text(encoding="utf-8"))))
    }
    assert not found - KEPT_IN.keys(), "read with formats.files, formats.xml or formats.limited"
    assert not KEPT_IN.keys() - found, "these read no more"


class _PanicError(BaseException):
    """As Rust's, which is no ``Exception``."""


def panics() -> None:
    raise _PanicError("index out of bounds")


def test_a_library_that_panics_is_a_refusal(tmp_path: Path) -> None:
    with LimitedProcesses(tmp_path) as processes, pytest.raises(UserError, match=r"malformed.*index out"):
        processes.call(panics)


def test_a_workbook_within_its_bounds_is_read(tmp_path: Path) -> None:
    pytest.importorskip("python_calamine")
    pytest.importorskip("automotive_cosim.studies")
    from automotive_cosim.studies.calibration.sheets import read_sheet

    book_of(3, 2)(tmp_path / "a.xlsx")
    assert len(read_sheet(tmp_path / "a.xlsx", [("x",)], ("x",), ()).rows) == 2
