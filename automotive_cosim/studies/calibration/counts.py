"""Reads hourly counts of many sites, and where they stand.

SUMO's own formats are read (``sumo_counts``), and two kinds of tables, as workbooks or text (``sheets``). All may
be gzipped. The tables:

* One row per site and hour: ``site,hour,vehicles_per_hour``; ``hour`` is local, 0 to 23, also written as 8:00 or
  08:00-09:00. An empty site is that of the row above, as merged cells are saved. Several rows of one site and hour
  are several days, and their median counts. The site's place is in the same row or in a file of
  sites: ``edge`` (an edge, or the number of its OpenStreetMap way), or ``lon,lat`` in degrees and, if known,
  ``bearing`` (the direction of travel, degrees clockwise from north).
* Open Data Paris, "Comptage routier - Données trafic issues des capteurs permanents", as it is downloaded:
  semicolons, one row per hour and detector, ``Date et heure de comptage`` with its offset from UTC, ``Débit
  horaire`` in vehicles per hour, ``Identifiant arc``, which is the site. For each hour of local time, the median
  over Mondays to Fridays counts. Rows without a figure are skipped; holidays are included, since the median
  tolerates them.
"""

from __future__ import annotations

import math
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, tzinfo
from pathlib import Path
from statistics import median

from automotive_cosim.errors import UserError
from automotive_cosim.studies.calibration.sheets import Sheet, SheetRow, read_sheet
from automotive_cosim.studies.calibration.sumo_counts import (
    CARS,
    DETECTOR,
    LORRIES,
    MINUTES,
    Flows,
    doubts_of,
    is_xml,
    read_dfrouter_counts,
    read_xml_counts,
)

HOURS = 24
SATURDAY = 5

TIME, FLOW, ARC = "Date et heure de comptage", "Débit horaire", "Identifiant arc"
"""Columns of Open Data Paris."""

PLAIN = ("site", "hour", "vehicles_per_hour")
DFROUTER = (DETECTOR, MINUTES, CARS)
TRAVEL = ("from_edge", "to_edge", "hour", "seconds")

FIGURES = frozenset({"vehicles_per_hour", "seconds", "lon", "lat", "bearing", FLOW, MINUTES, CARS, LORRIES})
KNOWN = frozenset({*PLAIN, *TRAVEL, "edge", "lon", "lat", "bearing"})
HOUR = re.compile(r"0?(\d{1,2})(?:[:h]00(?::00)?|h)?(?: *(?:-|–|to) *\d{1,2}(?:[:h]00(?::00)?|h)?)?")
"""An hour of the clock, or the two that it lies between."""

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
    doubts: tuple[str, ...] = ()
    """In words, about their source."""

    @property
    def sites(self) -> tuple[str, ...]:
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
        zone: time zone of the counted roads.
        sites: a file that says where the sites stand; for counts of SUMO's detectors, theirs.

    Raises UserError: one cannot be read, lacks a column or has an impossible figure, or has only zeros."""
    places: dict[str, SitePlace] = {}
    about = path.name
    sheet = None if is_xml(path) else _table(path)
    if sheet is None or DETECTOR in sheet.columns:
        flows = _sumo_counts(path, sheet, sites)
        places |= {edge: SitePlace(edge) for edge, _ in flows}
    else:
        if TIME in sheet.columns:
            about = f"{path.name}: medians over Mondays to Fridays, local time"
        else:
            _need(path, sheet, PLAIN)
            places |= _places(path, sheet)
        flows = _table_counts(path, sheet, zone)
        if sites is not None:
            sheet = _table(sites)
            _need(sites, sheet, ("site",))
            places |= _places(sites, sheet)
    if not any(any(each) for each in flows.values()):
        raise UserError(f"{path} has no count above zero; give counts of working detectors")
    doubts = doubts_of(path) if is_xml(path) else ()
    return Counts({key: median(each) for key, each in sorted(flows.items())}, places, about, doubts)


def _sumo_counts(path: Path, sheet: Sheet | None, detectors: Path | None) -> Flows:
    if sheet is None:
        return read_xml_counts(path, detectors)
    _need(path, sheet, DFROUTER)
    return read_dfrouter_counts(path, sheet, detectors)


def _table_counts(path: Path, sheet: Sheet, zone: tzinfo) -> Flows:
    is_paris = TIME in sheet.columns
    if is_paris:
        _need(path, sheet, (TIME, FLOW, ARC))
    flows: Flows = defaultdict(list)
    for row, name in _by_site(path, sheet, ARC if is_paris else "site"):
        hour = _paris_hour(path, row, zone) if is_paris else _hour(path, row)
        flow = _figure(path, row, FLOW if is_paris else "vehicles_per_hour", MOST)
        if hour is not None and flow is not None:
            flows[name, hour].append(flow)
    return flows


def read_travel_times(path: Path) -> tuple[TravelTime, ...]:
    """Reads measured times: ``from_edge,to_edge,hour,seconds``.

    Raises UserError: it cannot be read, lacks a column or has an impossible figure."""
    sheet = _table(path)
    _need(path, sheet, TRAVEL)
    found = []
    for row in sheet.rows:
        seconds = _figure(path, row, "seconds", MOST)
        if seconds is not None:
            found.append(TravelTime(row.cells["from_edge"], row.cells["to_edge"], _hour(path, row), seconds))
    return tuple(found)


def _table(path: Path) -> Sheet:
    wanted = ((TIME, FLOW, ARC), PLAIN, DFROUTER, TRAVEL, ("site", "edge"), ("site", "lon", "lat"))
    return read_sheet(path, wanted, KNOWN, FIGURES)


def _need(path: Path, sheet: Sheet, wanted: Sequence[str]) -> None:
    missing = [name for name in wanted if name not in sheet.columns]
    if missing:
        raise UserError(f"{path} lacks the column {missing[0]!r}; give a table with {','.join(wanted)}")


def _by_site(path: Path, sheet: Sheet, column: str) -> Iterator[tuple[SheetRow, str]]:
    site = ""
    for row in sheet.rows:
        site = row.cells[column] or site
        if not site:
            raise UserError(f"{path} line {row.line} has no site; give each row a site")
        yield row, site


def _places(path: Path, sheet: Sheet) -> dict[str, SitePlace]:
    """The place of every site whose row has one."""
    found: dict[str, SitePlace] = {}
    for row, name in _by_site(path, sheet, "site"):
        edge = row.cells.get("edge", "")
        lon, lat = (_figure(path, row, column, 180.0, -180.0) for column in ("lon", "lat"))
        bearing = _figure(path, row, "bearing", 360.0)
        if edge:
            place = SitePlace(edge)
        elif lon is not None and lat is not None:
            place = SitePlace(position=(lon, lat), bearing_deg=bearing)
        else:
            continue
        if found.setdefault(name, place) != place:
            raise UserError(
                f"{path} line {row.line}: site {name!r} has a different position than before; give it only one"
            )
    return found


def _paris_hour(path: Path, row: SheetRow, zone: tzinfo) -> int | None:
    """Hour of a row of Open Data Paris; None for weekends."""
    text = row.cells[TIME]
    try:
        stamp = datetime.fromisoformat(text)
        local = (stamp if stamp.tzinfo else stamp.replace(tzinfo=UTC)).astimezone(zone)
    except (ValueError, OverflowError) as error:
        raise UserError(f"{path} line {row.line}: {text!r} is not a date and time") from error
    return None if local.weekday() >= SATURDAY else local.hour


def _hour(path: Path, row: SheetRow) -> int:
    text = row.cells["hour"]
    found = HOUR.fullmatch(text)
    if found is None or int(found[1]) >= HOURS:
        raise UserError(f"{path} line {row.line}: hour {text!r} is not a whole number from 0 to 23")
    return int(found[1])


def _figure(path: Path, row: SheetRow, name: str, most: float, least: float = 0.0) -> float | None:
    """None where the cell is empty."""
    text = row.cells.get(name, "")
    if not text:
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not least <= value <= most:
        raise UserError(f"{path} line {row.line}: {name} is {text!r}; it must be a number from {least:g}")
    return value
