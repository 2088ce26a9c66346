"""Hourly counts: what is read, and what is refused in one line."""

import gzip
import zipfile
from collections.abc import Callable, Sequence
from datetime import datetime, timedelta
from pathlib import Path
from zoneinfo import ZoneInfo

import pytest

from automotive_cosim.errors import UserError
from automotive_cosim.studies.calibration.counts import (
    ARC,
    FLOW,
    TIME,
    SitePlace,
    geh,
    read_counts,
    read_travel_times,
)

PARIS = ZoneInfo("Europe/Paris")
HEADER = f"{TIME};{ARC};Libelle;{FLOW};Taux d'occupation"
PLAIN = "site,hour,vehicles_per_hour,edge"


def _file(folder: Path, lines: Sequence[str], name: str = "counts.csv") -> Path:
    path = folder / name
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")
    return path


def _paris(first_utc: str, days: int, arc: str = "4264") -> list[str]:
    """Rows of every hour, whose flow is 100 x the local hour on working days and 9999 at weekends."""
    rows = []
    for hour in range(24 * days):
        stamp = datetime.fromisoformat(first_utc) + timedelta(hours=hour)
        local = stamp.astimezone(PARIS)
        flow = 9999 if local.weekday() >= 5 else 100 * local.hour
        rows.append(f"{stamp.isoformat(sep=' ')};{arc};Avenue;{flow}.0;{local.hour}.5")
    return rows


@pytest.mark.parametrize("first", ["2023-11-06 00:00:00+00:00", "2023-07-03 00:00:00+00:00"])
def test_paris_counts_are_medians_over_working_days_by_the_roads_own_clock(tmp_path: Path, first: str) -> None:
    """In November the clock is an hour ahead of UTC, in July two."""
    counts = read_counts(_file(tmp_path, [HEADER, *_paris(first, 14)]), PARIS)
    assert counts.flows_per_h == {("4264", hour): 100.0 * hour for hour in range(24)}
    assert counts.places == {}


def test_a_median_leaves_out_empty_cells_and_bears_an_outlier(tmp_path: Path) -> None:
    rows = _paris("2023-11-06 00:00:00+00:00", 5)
    rows[7] = rows[7].replace(";800.0;", ";;")
    rows[31] = rows[31].replace(";800.0;", ";31.0;")
    assert read_counts(_file(tmp_path, [HEADER, *rows]), PARIS).flows_per_h["4264", 8] == 800


def test_many_detectors_get_their_places_from_a_file_of_sites(tmp_path: Path) -> None:
    both = [HEADER, *_paris("2023-11-06 00:00:00+00:00", 5), *_paris("2023-11-06 00:00:00+00:00", 5, "7")]
    sites = _file(tmp_path, ["site,edge,lon,lat,bearing", "7,,2.3,48.8,90", "4264,street,,,"], "sites.csv")
    counts = read_counts(_file(tmp_path, both), PARIS, sites)
    assert counts.sites == ("4264", "7")
    assert counts.places == {"7": SitePlace("", (2.3, 48.8), 90.0), "4264": SitePlace("street")}


def test_plain_counts_are_read_also_gzipped_and_rows_of_several_days_have_a_median(tmp_path: Path) -> None:
    path = tmp_path / "counts.csv.gz"
    path.write_bytes(gzip.compress(f"{PLAIN}\na,8,10,e1\na,8,30,e1\na,8,20,\nb,9,5,e2\na,9,,\n".encode()))
    counts = read_counts(path, PARIS)
    assert counts.flows_per_h == {("a", 8): 20.0, ("b", 9): 5.0}
    assert counts.places == {"a": SitePlace("e1"), "b": SitePlace("e2")}
    assert counts.hours == (8, 9)


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ([], "lacks the column 'site'"),
        (["site,hour,flow", "a,0,1"], "lacks the column 'vehicles_per_hour'"),
        ([HEADER.replace(FLOW, "Debit")], f"lacks the column '{FLOW}'"),
        ([HEADER], "has no count above zero"),
        ([PLAIN, "a,3,0,e"], "has no count above zero"),
        ([HEADER, "yesterday;1;Avenue;1;1"], "line 2: 'yesterday' is not a date and time"),
        ([HEADER, "2023-11-06 00:00:00+00:00;1;Avenue;many;1"], "line 2: Débit horaire is 'many'"),
        ([HEADER, "0001-01-01 00:00:00+23:59;1;A;1;1"], "line 2: '0001-01-01 00:00:00+23:59' is not a date"),
        ([PLAIN, f'a,3,"{"9" * 200_000},e'], "field larger than field limit"),
        ([PLAIN, "a,24,9,e"], "line 2: hour '24' is not a whole number from 0 to 23"),
        ([PLAIN, "a,3,-1,e"], "line 2: vehicles_per_hour is '-1'"),
        ([PLAIN, "a,3,nan,e"], "line 2: vehicles_per_hour is 'nan'"),
        ([PLAIN, "a,3,5,e", "a,4,5,f"], "line 3: site 'a' has a different position than before"),
        ([PLAIN, ",3,5,e"], "line 2 has no site"),
        ([PLAIN.replace("edge", "lon,lat"), "a,3,5,200,1"], "line 2: lon is '200'"),
    ],
)
def test_what_cannot_be_used_is_said_in_one_line(tmp_path: Path, lines: list[str], words: str) -> None:
    with pytest.raises(UserError) as raised:
        read_counts(_file(tmp_path, lines), PARIS)
    assert words in str(raised.value)
    assert "\n" not in str(raised.value)


def test_no_file_a_picture_and_a_cut_off_archive_are_refused(tmp_path: Path) -> None:
    (tmp_path / "picture").write_bytes(b"\x89PNG\r\n\x1a\n")
    (tmp_path / "cut.gz").write_bytes(gzip.compress(b"site,hour,vehicles_per_hour\n" * 100)[:-12])
    for name in ("nowhere", "picture", "cut.gz"):
        with pytest.raises(UserError, match=r"give a table of counts|save it as CSV UTF-8"):
            read_counts(tmp_path / name, PARIS)


@pytest.mark.parametrize(
    "text",
    [
        "site\thour\tvehicles_per_hour\nloop\t8\t515\n",
        "site, hour, vehicles_per_hour\nloop, 8, 515\n",
        "Site,Hour,Vehicles per hour\nloop,8,515\n",
        "site;hour;vehicles_per_hour\nloop;8;515,0\n",
        "site,hour,vehicles_per_hour\nloop,8,515\n,,\n\n",
        "\ufeffsite;hour;vehicles_per_hour\r\nloop;8;515\r\n",
        '"site","hour","vehicles_per_hour"\n"loop","8","515"\n',
        "Comptages;;\nRue de l\u2019Étoile, été;;\n\nsite;hour;vehicles_per_hour\nloop;08:00-09:00;515\n",
        "sep=;\nsite;hour;vehicles per hour\nloop;8h;515\n;8;\n;08:00;515,0\n",
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "cp1252"])
def test_counts_are_read_as_spreadsheets_save_them(tmp_path: Path, text: str, encoding: str) -> None:
    file = tmp_path / "counts.csv"
    file.write_bytes((text if encoding == "utf-8" else text.removeprefix("\ufeff")).encode(encoding))
    assert dict(read_counts(file, PARIS).flows_per_h) == {("loop", 8): 515.0}


def test_decimal_commas_and_spaces_of_thousands(tmp_path: Path) -> None:
    file = _file(tmp_path, ["site;hour;vehicles_per_hour", "a;8;1 234,5", "b;8;1\u00a0234"])
    assert dict(read_counts(file, PARIS).flows_per_h) == {("a", 8): 1234.5, ("b", 8): 1234.0}


CELLS = """<row r="1"><c r="A1" t="inlineStr"><is><t>Counts of spring</t></is></c></row>
<row r="3"><c r="B3" t="inlineStr"><is><t>Site</t></is></c><c r="C3" t="inlineStr"><is><t>Hour</t></is></c>
<c r="D3" t="inlineStr"><is><t>Vehicles per hour</t></is></c></row>
<row r="4"><c r="B4" t="inlineStr"><is><t>loop</t></is></c><c r="C4"><v>8</v></c><c r="D4"><v>515.5</v></c></row>
<row r="5"><c r="B5"/><c r="C5"><v>9</v></c><c r="D5"><v>600</v></c></row>"""


def test_a_workbook_is_read_with_its_merged_cells_and_the_lines_above(tmp_path: Path) -> None:
    """The smallest that Excel opens: one sheet whose table begins at B3, with B4 and B5 merged."""
    pytest.importorskip("python_calamine")
    main, office = (
        f"http://schemas.openxmlformats.org/{each}" for each in ("spreadsheetml/2006/main", "package/2006")
    )
    types = "application/vnd.openxmlformats-officedocument.spreadsheetml"
    documents = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{office}/content-types"><Default Extension="xml" '
        'ContentType="application/xml"/><Default Extension="rels" '
        'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        f'<Override PartName="/xl/workbook.xml" ContentType="{types}.sheet.main+xml"/>'
        f'<Override PartName="/xl/worksheets/sheet1.xml" ContentType="{types}.worksheet+xml"/></Types>',
        "_rels/.rels": f'<Relationships xmlns="{office}/relationships"><Relationship Id="r1" '
        f'Type="{documents}/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{main}" xmlns:r="{documents}"><sheets><sheet name="Counts" '
        'sheetId="1" r:id="r1"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{office}/relationships"><Relationship Id="r1" '
        f'Type="{documents}/worksheet" Target="worksheets/sheet1.xml"/></Relationships>',
        "xl/worksheets/sheet1.xml": f'<worksheet xmlns="{main}"><sheetData>{CELLS}</sheetData>'
        '<mergeCells count="1"><mergeCell ref="B4:B5"/></mergeCells></worksheet>',
    }
    with zipfile.ZipFile(tmp_path / "counts.xlsx", "w") as book:
        for name, text in parts.items():
            book.writestr(name, text)
    counts = read_counts(tmp_path / "counts.xlsx", PARIS)
    assert dict(counts.flows_per_h) == {("loop", 8): 515.5, ("loop", 9): 600.0}
    (tmp_path / "cut.xlsx").write_bytes((tmp_path / "counts.xlsx").read_bytes()[:400])
    with pytest.raises(UserError, match="not a workbook that can be read"):
        read_counts(tmp_path / "cut.xlsx", PARIS)


def test_travel_times_are_read(tmp_path: Path) -> None:
    (found,) = read_travel_times(_file(tmp_path, ["from_edge,to_edge,hour,seconds", "a,b,8,61.5", "a,c,8,"]))
    assert (found.from_edge, found.to_edge, found.hour, found.seconds) == ("a", "b", 8, 61.5)
    with pytest.raises(UserError, match="lacks the column 'seconds'"):
        read_travel_times(_file(tmp_path, ["from_edge,to_edge,hour", "a,b,8"]))


def test_geh_is_that_of_the_handbook() -> None:
    """sqrt(2 x 100^2 / 2100) by hand; it is symmetric, and grows with the flow at the same relative error."""
    assert geh(1100, 1000) == pytest.approx(3.0861, abs=1e-4)
    assert geh(1000, 1100) == geh(1100, 1000)
    assert geh(0, 0) == geh(7, 7) == 0
    assert geh(110, 100) < geh(1100, 1000)
    assert geh(0, 50) == pytest.approx(10)


def test_the_champs_elysees(data_of_others: Callable[[str], Path]) -> None:
    counts = read_counts(data_of_others("paris_counts/champs_elysees_arc4264_filtered.csv.gz"), PARIS)
    assert len(counts.flows_per_h) == 24
    (site,) = counts.sites
    assert counts.flows_per_h[site, 8] == pytest.approx(994, abs=1)
    assert counts.flows_per_h[site, 18] == 1090


EDGE_DATA = """<meandata><interval begin="25200" end="30600" id="peak">
<edge id="north" entered="880" departed="20" sampledSeconds="12"/><edge id="south" entered="0"/>
<edge id="quiet" sampledSeconds="0"/>
</interval></meandata>"""
LOOPS = """<additional><e1Detector id="a" lane="north_0" pos="10" file="out.xml"/>
<e1Detector id="b" lane="north_1" pos="10" file="out.xml"/>
<inductionLoop id="behind" lane="north_1" pos="90" file="out.xml"/>
</additional>"""
LOOPED = """<detector>
<interval begin="0.00" end="1800.00" id="a" nVehContrib="100"/>
<interval begin="1800.00" end="3600.00" id="a" nVehContrib="200"/>
<interval begin="0.00" end="1800.00" id="b" nVehContrib="10"/>
<interval begin="1800.00" end="3600.00" id="b" nVehContrib="20"/>
<interval begin="0.00" end="1800.00" id="behind" nVehContrib="10"/>
<interval begin="86400.00" end="88200.00" id="a" nVehContrib="100"/>
<interval begin="86400.00" end="88200.00" id="b" nVehContrib="5"/>
</detector>"""


@pytest.mark.parametrize("packed", [False, True])
def test_edge_data_of_sumo_is_counts_per_hour_of_each_edge(tmp_path: Path, packed: bool) -> None:
    path = tmp_path / "edges.xml"
    path.write_bytes(gzip.compress(EDGE_DATA.encode()) if packed else EDGE_DATA.encode())
    counts = read_counts(path, PARIS)
    # 900 vehicles from 7:00 to 8:30: hour 8 was counted for half of it, which is enough
    assert counts.flows_per_h == {("north", 7): 600, ("north", 8): 600, ("south", 7): 0, ("south", 8): 0}
    assert counts.places["north"] == SitePlace("north")


@pytest.mark.parametrize("meso", [True, False])
def test_arrivals_that_a_mesoscopic_simulation_counts_twice_are_doubtful(tmp_path: Path, meso: bool) -> None:
    told = f'<!-- <mesosim value="{str(meso).lower()}"/> -->'
    data = EDGE_DATA.replace("<interval", f"{told}<interval").replace('entered="880"', 'entered="880" left="900"')
    assert not read_counts(_file(tmp_path, [data], "right.xml"), PARIS).doubts
    twice = data.replace('left="900"', 'left="500" arrived="200"')
    doubts = read_counts(_file(tmp_path, [twice], "twice.xml"), PARIS).doubts
    assert [("on 1 edge, such as north, more" in each) for each in doubts] == [True] * meso


def test_loops_are_added_up_over_the_lanes_of_an_edge_and_have_a_median_over_days(tmp_path: Path) -> None:
    counted, loops = _file(tmp_path, [LOOPED], "out.xml"), _file(tmp_path, [LOOPS], "loops.add.xml")
    counts = read_counts(counted, PARIS, loops)
    assert counts.flows_per_h == {("north", 0): (330 + 210) / 2}
    with pytest.raises(UserError, match="--sites"):
        read_counts(counted, PARIS)


def test_a_table_of_dfrouter_counts_cars_and_lorries_of_its_periods(tmp_path: Path) -> None:
    rows = [
        "Detector;Time;qPKW;qLKW;vPKW;vLKW",
        "a;480;50;10;0;0",
        "b;480;5;0;0;0",
        "a;495;70;;0;0",
        "a;510;60;0;0;0",
    ]
    loops = _file(tmp_path, [LOOPS], "loops.add.xml")
    counts = read_counts(_file(tmp_path, rows), PARIS, loops)
    assert counts.flows_per_h == {("north", 8): pytest.approx(190 * 3600 / 2700)}
    with pytest.raises(UserError, match="detector 'c' was counted"):
        read_counts(_file(tmp_path, [*rows, *(row.replace("a;", "c;") for row in rows[1:])]), PARIS, loops)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("<meandata><interval", "is not XML"),
        ("<routes><vehicle/></routes>", "no counts: neither edge data"),
        (EDGE_DATA.replace('"880"', '"many"'), "'many'; it must be a number from 0"),
        (EDGE_DATA.replace('"880"', '"-9"'), "'-9'; it must be a number from 0"),
        (EDGE_DATA.replace('"30600"', '"25200"'), "its end must be later"),
    ],
)
def test_xml_that_cannot_be_used_is_said_in_one_line(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(UserError, match=words) as caught:
        read_counts(_file(tmp_path, [text], "edges.xml"), PARIS)
    assert "\n" not in str(caught.value)
