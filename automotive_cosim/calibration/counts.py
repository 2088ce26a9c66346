"""Reads hourly counts of many sites, and where they stand.

Two kinds of files are read, each also gzipped, with commas, semicolons or tabs between the cells, as spreadsheets
save them (UTF-8 or "Unicode text", decimal commas where the cells are not separated by commas):

* Plain CSV, one row per site and hour: ``site,hour,vehicles_per_hour``; ``hour`` is local, 0 to 23. Several rows of
  one site and hour are several days, and their median counts. The site's place is in the same row or in a file of
  sites: ``edge`` (an edge, or the number of its OpenStreetMap way), or ``lon,lat`` in degrees and, if known,
  ``bearing`` (the direction of travel, degrees clockwise from north).
* Open Data Paris, "Comptage routier - Données trafic issues des capteurs permanents", as it is downloaded:
  semicolons, one row per hour and detector, ``Date et heure de comptage`` with its offset from UTC, ``Débit
  horaire`` in vehicles per hour, ``Identifiant arc``, which is the site. For each hour of local time, the median
  over Mondays to Fridays counts. Rows without a figure are skipped; holidays are included, since the median
  tolerates them.
"""

from __future__ import annotations

import codecs
import csv
import math
import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, tzinfo
from pathlib import Path
from statistics import median

from automotive_cosim.errors import CountsError
from automotive_cosim.formats.files import opened

HOURS = 24
SATURDAY = 5

TIME, FLOW, ARC = "Date et heure de comptage", "Débit horaire", "Identifiant arc"
"""Columns of Open Data Paris."""

PLAIN = ("site", "hour", "vehicles_per_hour")
TRAVEL = ("from_edge", "to_edge", "hour", "seconds")

FIGURES = frozenset({"vehicles_per_hour", "seconds", "lon", "lat", "bearing", FLOW})
KNOWN = frozenset({*PLAIN, *TRAVEL, "edge", "lon", "lat", "bearing"})
DELIMITERS = (",", ";", "\t")
DECIMAL_COMMA = re.compile(r"^(-?\d+),(\d+)$")

MOST_BYTES = 2**28
"""A year of one of Paris' detectors has a megabyte."""

MOST = 1e6
"""No road carries more vehicles in an hour."""

GOOD_GEH = 5.0
"""A flow with a smaller GEH counts as met, as in the British guidance that GEH comes from (DMRB 12.2.1)."""


def geh(modelled: float, counted: float) -> float:
    """Geoffrey E. Havers' distance of two flows in vehicles per hour; 0 if both are zero."""
    total = modelled + counted
    return math.sqrt(2 * (modelled - counted) ** 2 / total) if total else 0.0


@dataclass(frozen=True, slots=True)
class SitePlace:
    """Where a site stands."""

    edge: str = ""
    """An edge, or the number of its OpenStreetMap way; empty if the position is given."""
    position: tuple[float, float] | None = None
    """Longitude and latitude in degrees."""
    bearing_deg: float | None = None
    """Direction of travel, clockwise from north."""


@dataclass(frozen=True, slots=True)
class Counts:
    """What was counted on a day."""

    flows_per_h: Mapping[tuple[str, int], float]
    """Site and local hour (0 to 23) -> vehicles per hour."""
    places: Mapping[str, SitePlace]
    """Where the sites stand, as far as the files say."""
    about: str
    """A description of their source."""

    @property
    def sites(self) -> tuple[str, ...]:
        """All sites, by name."""
        return tuple(sorted({site for site, _ in self.flows_per_h}))

    @property
    def hours(self) -> tuple[int, ...]:
        """The hours that any site was counted in."""
        return tuple(sorted({hour for _, hour in self.flows_per_h}))


@dataclass(frozen=True, slots=True)
class TravelTime:
    """A time that drivers were measured to take."""

    from_edge: str
    to_edge: str
    hour: int
    seconds: float
    """From the end of the one edge to that of the other."""


def read_counts(path: Path, zone: tzinfo, sites: Path | None = None) -> Counts:
    """Reads a file of counts.

    Args:
        path: of either kind, also gzipped.
        zone: time zone of the counted roads.
        sites: a file that says where the sites stand.

    Raises:
        CountsError: one cannot be read, lacks a column or has an impossible figure, or has only zeros.
    """
    rows, columns = _table(path)
    flows: dict[tuple[str, int], list[float]] = defaultdict(list)
    places: dict[str, SitePlace] = {}
    if TIME in columns:
        _need(path, columns, (TIME, FLOW, ARC))
        about = f"{path.name}: medians over Mondays to Fridays, local time"
    else:
        _need(path, columns, PLAIN)
        about = path.name
        places |= _places(path, rows)
    for number, row in enumerate(rows, start=2):
        if not any(row.values()):
            continue
        if TIME in columns:
            hour, name, column = _paris_hour(path, number, row, zone), row[ARC].strip(), FLOW
        else:
            hour, name, column = _hour(path, number, row), row["site"].strip(), "vehicles_per_hour"
        flow = _figure(path, number, column, row[column], MOST)
        if not name:
            raise CountsError(f"{path} line {number} has no site; give each row a site")
        if hour is not None and flow is not None:
            flows[name, hour].append(flow)
    if not any(any(each) for each in flows.values()):
        raise CountsError(f"{path} has no count above zero; give counts of working detectors")
    if sites is not None:
        rows, columns = _table(sites)
        _need(sites, columns, ("site",))
        places |= _places(sites, rows)
    return Counts({key: median(each) for key, each in sorted(flows.items())}, places, about)


def read_travel_times(path: Path) -> tuple[TravelTime, ...]:
    """Reads measured times: ``from_edge,to_edge,hour,seconds``.

    Raises:
        CountsError: it cannot be read, lacks a column or has an impossible figure.
    """
    rows, columns = _table(path)
    _need(path, columns, TRAVEL)
    found = []
    for number, row in enumerate(rows, start=2):
        if not any(row.values()):
            continue
        seconds = _figure(path, number, "seconds", row["seconds"], MOST)
        if seconds is not None:
            ends = row["from_edge"].strip(), row["to_edge"].strip()
            found.append(TravelTime(*ends, _hour(path, number, row), seconds))
    return tuple(found)


CsvRows = list[dict[str, str]]


def _table(path: Path) -> tuple[CsvRows, tuple[str, ...]]:
    """The rows of a CSV file, and its columns."""
    lines = _text(path).splitlines()
    head = lines[0] if lines else ""
    delimiter = max(DELIMITERS, key=head.count)
    reader = csv.DictReader(lines, delimiter=delimiter, restval="", restkey="", skipinitialspace=True)
    try:
        names = [_column(name) for name in reader.fieldnames or ()]
        reader.fieldnames = names
        rows = [{name: cell.strip() for name, cell in row.items() if isinstance(cell, str)} for row in reader]
    except csv.Error as error:
        raise CountsError(f"{path} line {reader.line_num}: {error}; give a CSV file of counts") from error
    if delimiter != ",":
        rows = [
            {name: DECIMAL_COMMA.sub(r"\1.\2", cell) if name in FIGURES else cell for name, cell in row.items()}
            for row in rows
        ]
    return rows, tuple(names)


def _column(name: str) -> str:
    """The name of a column, whatever its case."""
    plain = name.strip().casefold().replace(" ", "_")
    return plain if plain in KNOWN else name.strip()


def _text(path: Path) -> str:
    try:
        with opened(path) as file:
            data = file.read(MOST_BYTES + 1)
        if len(data) > MOST_BYTES:
            raise CountsError(f"{path} is larger than {MOST_BYTES // 2**20} MB; give the rows of fewer detectors")
        wide = data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
        return data.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError as error:
        raise CountsError(f"{path} is not UTF-8 text; in a spreadsheet, save it as CSV UTF-8") from error
    except OSError as error:
        reason = getattr(error, "strerror", None) or error
        raise CountsError(f"{path} cannot be read ({reason}); give a CSV file of counts") from error


def _need(path: Path, columns: Sequence[str], wanted: Sequence[str]) -> None:
    missing = [name for name in wanted if name not in columns]
    if missing:
        raise CountsError(f"{path} lacks the column {missing[0]!r}; give a CSV with {','.join(wanted)}")


def _places(path: Path, rows: Sequence[Mapping[str, str]]) -> dict[str, SitePlace]:
    """The place of every site whose row has one."""
    found: dict[str, SitePlace] = {}
    for number, row in enumerate(rows, start=2):
        edge = row.get("edge", "").strip()
        lon, lat = (_figure(path, number, name, row.get(name, ""), 180.0, -180.0) for name in ("lon", "lat"))
        bearing = _figure(path, number, "bearing", row.get("bearing", ""), 360.0)
        if edge:
            place = SitePlace(edge)
        elif lon is not None and lat is not None:
            place = SitePlace(position=(lon, lat), bearing_deg=bearing)
        else:
            continue
        name = row["site"].strip()
        if found.setdefault(name, place) != place:
            raise CountsError(
                f"{path} line {number}: site {name!r} has a different position than before; give it only one"
            )
    return found


def _paris_hour(path: Path, number: int, row: Mapping[str, str], zone: tzinfo) -> int | None:
    """Hour of a row of Open Data Paris; None for weekends."""
    try:
        stamp = datetime.fromisoformat(row[TIME])
        local = (stamp if stamp.tzinfo else stamp.replace(tzinfo=UTC)).astimezone(zone)
    except (ValueError, OverflowError) as error:
        raise CountsError(f"{path} line {number}: {row[TIME]!r} is not a date and time") from error
    return None if local.weekday() >= SATURDAY else local.hour


def _hour(path: Path, number: int, row: Mapping[str, str]) -> int:
    text = row["hour"].strip()
    if text not in map(str, range(HOURS)):
        raise CountsError(f"{path} line {number}: hour {text!r} is not a whole number from 0 to 23")
    return int(text)


def _figure(path: Path, number: int, name: str, text: str, most: float, least: float = 0.0) -> float | None:
    """None where the cell is empty."""
    if not text.strip():
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not least <= value <= most:
        raise CountsError(f"{path} line {number}: {name} is {text!r}; it must be a number from {least:g}")
    return value
