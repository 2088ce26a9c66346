"""Hourly counts: what is read, and what is refused in one line."""

from __future__ import annotations

import gzip
from collections.abc import Callable, Sequence
from datetime import datetime, timedelta
from pathlib import Path
from zoneinfo import ZoneInfo

import pytest

from automotive_cosim.errors import CountsError
from automotive_cosim.osm.counts import ARC, FLOW, OCCUPANCY, TIME, geh, read_counts

PARIS = ZoneInfo("Europe/Paris")
HEADER = f"{TIME};{ARC};Libelle;{FLOW};{OCCUPANCY}"


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
    assert counts.flow_per_h == tuple(100.0 * hour for hour in range(24))
    assert counts.occupancy == pytest.approx([(hour + 0.5) / 100 for hour in range(24)])
    assert "4264" in counts.about


def test_a_median_leaves_out_empty_cells_and_bears_an_outlier(tmp_path: Path) -> None:
    rows = _paris("2023-11-06 00:00:00+00:00", 5)
    rows[7] = rows[7].replace(";800.0;", ";;")
    rows[31] = rows[31].replace(";800.0;", ";31.0;")
    assert read_counts(_file(tmp_path, [HEADER, *rows]), PARIS).flow_per_h[8] == 800


def test_of_several_detectors_one_is_named(tmp_path: Path) -> None:
    both = [HEADER, *_paris("2023-11-06 00:00:00+00:00", 5), *_paris("2023-11-06 00:00:00+00:00", 5, "7")]
    path = _file(tmp_path, [line.replace(";7;Avenue;900", ";7;Avenue;1") for line in both])
    assert read_counts(path, PARIS, "7").flow_per_h[9] == 1
    assert read_counts(path, PARIS, "4264").flow_per_h[9] == 900
    with pytest.raises(CountsError, match=r"2 detectors \(4264, 7\); name one with --arc"):
        read_counts(path, PARIS)
    with pytest.raises(CountsError, match="no counts of detector '8'; it has 4264, 7"):
        read_counts(path, PARIS, "8")


def _plain(hours: Sequence[int] = range(24)) -> list[str]:
    return ["hour,vehicles_per_hour", *(f"{hour},{50 + hour}" for hour in hours)]


def test_plain_csv_is_read_also_gzipped_and_without_occupancy(tmp_path: Path) -> None:
    path = tmp_path / "counts.csv.gz"
    path.write_bytes(gzip.compress("\n".join(_plain()).encode()))
    counts = read_counts(path, PARIS)
    assert counts.flow_per_h == tuple(50.0 + hour for hour in range(24))
    assert counts.occupancy is None
    rows = ["hour,vehicles_per_hour,occupancy", *(f"{hour},60,{hour}" for hour in range(24))]
    assert read_counts(_file(tmp_path, rows), PARIS).occupancy == pytest.approx([h / 100 for h in range(24)])


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ([], "lacks the column 'hour'"),
        (["hour,flow", "0,1"], "lacks the column 'vehicles_per_hour'"),
        ([HEADER.replace(FLOW, "Debit")], f"lacks the column '{FLOW}'"),
        ([HEADER], "no counts of detector ''; it has none at all"),
        ([HEADER, "yesterday;1;Avenue;1;1"], "line 2: 'yesterday' is not a date and time"),
        ([HEADER, "2023-11-06 00:00:00+00:00;1;Avenue;many;1"], "line 2: Débit horaire is 'many'"),
        (_plain(range(2, 24)), "no count for hour 0, 1 of a working day"),
        (
            [HEADER, "0001-01-01 00:00:00+23:59;1;Avenue;1;1"],
            "line 2: '0001-01-01 00:00:00+23:59' is not a date",
        ),
        ([*_plain(), f'3,"{"9" * 200_000}'], "field larger than field limit"),
        ([*_plain(), "24,9"], "line 26: hour '24' is not a whole number from 0 to 23"),
        ([*_plain(), "3,-1"], "line 26: vehicles_per_hour is '-1'"),
        ([*_plain(), "3,nan"], "line 26: vehicles_per_hour is 'nan'"),
        ([*_plain(), "3"], None),
        (["hour,vehicles_per_hour", *(f"{hour},0" for hour in range(24))], "only zeros"),
    ],
)
def test_what_cannot_be_used_is_said_in_one_line(tmp_path: Path, lines: list[str], words: str | None) -> None:
    path = _file(tmp_path, lines)
    if words is None:  # an empty cell counts as not counted, and there is another row of that hour
        assert read_counts(path, PARIS).flow_per_h[3] == 53
        return
    with pytest.raises(CountsError) as raised:
        read_counts(path, PARIS)
    assert words in str(raised.value)
    assert "\n" not in str(raised.value)


def test_no_file_a_picture_and_a_cut_off_archive_are_refused(tmp_path: Path) -> None:
    (tmp_path / "picture").write_bytes(b"\x89PNG\xff\xfe")
    (tmp_path / "cut.gz").write_bytes(gzip.compress(b"hour,vehicles_per_hour\n" * 100)[:-12])
    for name in ("nowhere", "picture", "cut.gz"):
        with pytest.raises(CountsError, match="give a CSV file of counts"):
            read_counts(tmp_path / name, PARIS)


def test_plain_csv_has_no_detectors(tmp_path: Path) -> None:
    with pytest.raises(CountsError, match="omit --arc"):
        read_counts(_file(tmp_path, _plain()), PARIS, "4264")


def test_geh_is_that_of_the_handbook() -> None:
    """sqrt(2 x 100^2 / 2100) by hand; it is symmetric, and grows with the flow at the same relative error."""
    assert geh(1100, 1000) == pytest.approx(3.0861, abs=1e-4)
    assert geh(1000, 1100) == geh(1100, 1000)
    assert geh(0, 0) == geh(7, 7) == 0
    assert geh(110, 100) < geh(1100, 1000)
    assert geh(0, 50) == pytest.approx(10)


def test_the_champs_elysees(data_of_others: Callable[[str], Path]) -> None:
    counts = read_counts(data_of_others("paris_counts/champs_elysees_arc4264_filtered.csv.gz"), PARIS)
    assert counts.flow_per_h[8] == pytest.approx(994, abs=1)
    assert counts.flow_per_h[18] == 1090
    assert counts.occupancy is not None
    assert counts.occupancy[8] == pytest.approx(0.108, abs=0.001)
    assert counts.occupancy[18] == pytest.approx(0.243, abs=0.001)
