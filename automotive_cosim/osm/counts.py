"""Reads the hourly counts of a road on a working day.

Two kinds of files are read, each also gzipped:

* Open Data Paris, "Comptage routier - Données trafic issues des capteurs permanents", as it is downloaded:
  semicolons, one row per hour and detector, ``Date et heure de comptage`` with its offset from UTC, ``Débit
  horaire`` in vehicles per hour, ``Taux d'occupation`` in per cent, ``Identifiant arc``. For each hour of local
  time, the median over Mondays to Fridays is used. Rows without a figure are skipped; holidays are included, since
  the median tolerates them.
* Plain CSV: ``hour,vehicles_per_hour`` and, if known, ``occupancy`` (per cent); ``hour`` is local, 0 to 23.
"""

from __future__ import annotations

import csv
import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from statistics import median
from typing import NamedTuple
from zoneinfo import ZoneInfo

from automotive_cosim.errors import CountsError
from automotive_cosim.formats.files import opened

HOURS = 24
SATURDAY = 5

TIME, FLOW, OCCUPANCY, ARC = "Date et heure de comptage", "Débit horaire", "Taux d'occupation", "Identifiant arc"
"""Columns of Open Data Paris."""

MOST_BYTES = 2**28
"""A year of one of Paris' detectors has a megabyte."""

MOST = 1e6
"""No road carries more vehicles in an hour."""

GOOD_GEH = 5.0
"""An hour with a smaller GEH counts as met, as in the British guidance that GEH comes from (DMRB 12.2.1)."""


def geh(modelled: float, counted: float) -> float:
    """Geoffrey E. Havers' distance of two flows in vehicles per hour; 0 if both are zero."""
    total = modelled + counted
    return math.sqrt(2 * (modelled - counted) ** 2 / total) if total else 0.0


@dataclass(frozen=True, slots=True)
class Counts:
    """The counts of one road on a day, by local hour from 0 to 23."""

    flow_per_h: tuple[float, ...]
    """Vehicles per hour, 24 of them; at least one is above zero."""
    occupancy: tuple[float, ...] | None
    """Share of the time that a vehicle covers the detector, 0 to 1; None if the file does not say."""
    about: str
    """A description of their source."""


class _Row(NamedTuple):
    """One line of a file: the figures of one hour."""

    hour: int
    flow_per_h: float | None
    occupancy_percent: float | None


def read_counts(path: Path, zone: ZoneInfo, arc: str = "") -> Counts:
    """Reads a file of counts.

    Args:
        path: of either kind, also gzipped.
        zone: time zone of the counted road.
        arc: which detector to use, in a file of several.

    Raises:
        CountsError: it cannot be read, lacks a column or an hour, has an impossible figure, only zeros, or several
            detectors of which none is named.
    """
    lines = _text(path).splitlines()
    delimiter = ";" if lines and ";" in lines[0] else ","
    reader = csv.DictReader(lines, delimiter=delimiter, restval="")
    try:
        columns = tuple(reader.fieldnames or ())
        rows = list(reader)
    except csv.Error as error:
        raise CountsError(f"{path} line {reader.line_num}: {error}; give a CSV file of counts") from error
    if TIME in columns or delimiter == ";":
        _need(path, columns, (TIME, FLOW, OCCUPANCY, ARC))
        chosen, arc = _of_arc(path, rows, arc)
        found = [row for number, each in chosen if (row := _paris_row(path, number, each, zone)) is not None]
        about = f"{path.name}, detector {arc}: medians over Mondays to Fridays, local time"
    else:
        _need(path, columns, ("hour", "vehicles_per_hour"))
        if arc:
            raise CountsError(f"{path} has no detectors to choose {arc!r} from; omit --arc")
        found = [_plain_row(path, number, each) for number, each in enumerate(rows, start=2)]
        about = path.name
    return _by_hour(path, found, about)


def _text(path: Path) -> str:
    try:
        with opened(path) as file:
            data = file.read(MOST_BYTES + 1)
        if len(data) > MOST_BYTES:
            raise CountsError(f"{path} is larger than {MOST_BYTES // 2**20} MB; give the rows of one detector")
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise CountsError(f"{path} is not UTF-8 text; give a CSV file of counts") from error
    except OSError as error:
        reason = getattr(error, "strerror", None) or error
        raise CountsError(f"{path} cannot be read ({reason}); give a CSV file of counts") from error


def _need(path: Path, columns: Sequence[str], wanted: Sequence[str]) -> None:
    missing = [name for name in wanted if name not in columns]
    if missing:
        raise CountsError(
            f"{path} lacks the column {missing[0]!r}; give Open Data Paris' file as it is, or a CSV with"
            " hour,vehicles_per_hour[,occupancy]"
        )


Numbered = list[tuple[int, Mapping[str, str]]]
"""The rows of a file with their line numbers."""


def _of_arc(path: Path, rows: Sequence[Mapping[str, str]], arc: str) -> tuple[Numbered, str]:
    arcs = sorted({row[ARC] for row in rows})
    if not arc and len(arcs) > 1:
        shown = ", ".join(arcs[:5]) + (", …" if len(arcs) > 5 else "")
        raise CountsError(f"{path} has {len(arcs)} detectors ({shown}); name one with --arc")
    arc = arc or next(iter(arcs), "")
    chosen = [(number, row) for number, row in enumerate(rows, start=2) if row[ARC] == arc]
    if not chosen:
        raise CountsError(
            f"{path} has no counts of detector {arc!r}; it has {', '.join(arcs[:5]) or 'none at all'}"
        )
    return chosen, arc


def _paris_row(path: Path, number: int, row: Mapping[str, str], zone: ZoneInfo) -> _Row | None:
    """None at weekends."""
    try:
        stamp = datetime.fromisoformat(row[TIME])
        local = (stamp if stamp.tzinfo else stamp.replace(tzinfo=UTC)).astimezone(zone)
    except (ValueError, OverflowError) as error:
        raise CountsError(f"{path} line {number}: {row[TIME]!r} is not a date and time") from error
    if local.weekday() >= SATURDAY:
        return None
    flow, occupancy = (_figure(path, number, name, row[name]) for name in (FLOW, OCCUPANCY))
    return _Row(local.hour, flow, occupancy)


def _plain_row(path: Path, number: int, row: Mapping[str, str]) -> _Row:
    text = row["hour"].strip()
    if text not in map(str, range(HOURS)):
        raise CountsError(f"{path} line {number}: hour {text!r} is not a whole number from 0 to 23")
    flow = _figure(path, number, "vehicles_per_hour", row["vehicles_per_hour"])
    return _Row(int(text), flow, _figure(path, number, "occupancy", row.get("occupancy", "")))


def _figure(path: Path, number: int, name: str, text: str) -> float | None:
    """None where the cell is empty."""
    if not text.strip():
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 <= value <= MOST:
        raise CountsError(f"{path} line {number}: {name} is {text!r}; it must be a number from 0")
    return value


def _by_hour(path: Path, rows: Sequence[_Row], about: str) -> Counts:
    flows: dict[int, list[float]] = defaultdict(list)
    occupancies: dict[int, list[float]] = defaultdict(list)
    for row in rows:
        if row.flow_per_h is not None:
            flows[row.hour].append(row.flow_per_h)
        if row.occupancy_percent is not None:
            occupancies[row.hour].append(row.occupancy_percent / 100)
    missing = [str(hour) for hour in range(HOURS) if not flows[hour]]
    if missing:
        raise CountsError(
            f"{path} has no count for hour {', '.join(missing)} of a working day; all 24 are required"
        )
    counted = tuple(median(flows[hour]) for hour in range(HOURS))
    if not any(counted):
        raise CountsError(f"{path} has only zeros; choose a detector that works")
    is_known = all(occupancies[hour] for hour in range(HOURS))
    return Counts(counted, tuple(median(occupancies[hour]) for hour in range(HOURS)) if is_known else None, about)
