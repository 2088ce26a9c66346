"""Reads ``scenario.toml``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from datetime import datetime
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Literal
from zoneinfo import ZoneInfo

from annotated_types import MinLen

from automotive_cosim.contracts import Weather
from automotive_cosim.errors import ScenarioError, UnknownNameError, UserError
from automotive_cosim.formats.annotations import Called, Form
from automotive_cosim.formats.files import is_file
from automotive_cosim.formats.scenario import Described, LinkAt, Scenario, WeatherAt
from automotive_cosim.formats.toml import Document, read_toml
from automotive_cosim.scenarios.listing import HOME, shipped

YEARS = 1970, 2199
"""Those that sun, clocks and calendars are computed for."""


def load(name_or_folder: str | Path) -> Scenario:
    """Reads a shipped scenario by name, or any folder with a ``scenario.toml``.

    Raises:
        UnknownNameError: neither a shipped name nor a folder.
        ScenarioError: the file is missing, is not TOML, or has a wrong, extra or missing field."""
    folder = Path(name_or_folder)
    if not (folder / "scenario.toml").is_file():
        names = shipped()
        if str(name_or_folder) in names:  # also beside a folder of results of that name
            folder = HOME / str(name_or_folder)
        elif folder.is_dir():
            raise ScenarioError(f"{folder} has no scenario.toml; make one with `automotive-cosim scenarios import`")
        elif is_file(folder):
            raise ScenarioError(f"{folder} is not a scenario's folder, which this needs: it has no scenario.toml")
        else:
            raise UnknownNameError("scenario", str(name_or_folder), names, "automotive-cosim scenarios list")
    document = read_toml(folder / "scenario.toml", ScenarioError)
    file = document.read(ScenarioFile)
    if problems := tuple(str(problem) for problem in _contradictions(file, document)):
        raise ScenarioError(*problems)
    return Scenario(
        **{field.name: getattr(file, field.name) for field in fields(Described)},
        folder=folder.resolve(),
        start=file.start.replace(tzinfo=file.time_zone),
        weather=() if isinstance(file.weather, str) else tuple(entry.timed for entry in file.weather),
    )


def _zone(name: str) -> ZoneInfo:
    try:
        return ZoneInfo(name)
    except (KeyError, ValueError, OSError) as error:
        raise ValueError("there is no such time zone; give an IANA name such as Europe/Paris") from error


def _local(text: str) -> datetime:
    time = datetime.fromisoformat(text)
    if not YEARS[0] <= time.year <= YEARS[1]:
        raise ValueError(f"the year must be from {YEARS[0]} to {YEARS[1]}")
    return time


@dataclass(frozen=True, slots=True, kw_only=True)
class WeatherEntry(Weather):
    """``[[weather]]``: the weather from ``at_s`` on, held until the next."""

    at_s: float
    """Seconds after the ego's departure; 0 in the first entry."""

    @property
    def timed(self) -> WeatherAt:
        """The entry as a ``WeatherAt``."""
        return WeatherAt(self.at_s, Weather(*(getattr(self, field.name) for field in fields(Weather))))


@dataclass(frozen=True, slots=True, kw_only=True)
class ScenarioFile(Described):
    """``scenario.toml``: what SUMO's own files have no word for."""

    start: Annotated[
        datetime, Form(r"^\d{4}-\d\d-\d\d([T ]\d\d:\d\d(:\d\d(\.\d+)?)?)?$", "2026-03-10T08:30:00", _local)
    ]
    """Local date and time at which the ego departs, after the warm-up."""
    time_zone: Annotated[ZoneInfo, Form(r"^[A-Za-z][A-Za-z0-9_+/-]*$", "Europe/Paris", _zone)]
    """Whose clock ``start`` is read from."""
    weather: (
        Annotated[tuple[WeatherEntry, ...], MinLen(1), Called("a list of [[weather]] entries")] | Literal["climate"]
    )
    """``"climate"`` draws it by seed from the normals of place and month."""


def _contradictions(file: ScenarioFile, document: Document) -> Iterator[UserError]:
    """What no field alone is to blame for."""
    trips = [trip.name for trip in file.ego.trips]
    for index, incident in enumerate(file.incidents):
        if incident.trip and incident.trip not in trips:
            unknown = UnknownNameError(f"trip of scenario {file.name!r}", incident.trip, trips)
            yield document.refused(("incidents", index, "trip"), f"is {incident.trip!r}: {unknown}")
    if not isinstance(file.weather, str):
        if file.weather[0].at_s != 0:
            yield document.refused(("weather", 0, "at_s"), f"is {file.weather[0].at_s:g}; the first entry's is 0")
        yield from _disorder("weather", file.weather, document)
    yield from _disorder("connectivity", file.connectivity, document)
    if not is_file(document.path.parent / file.sumo.config):
        yield document.refused(
            ("sumo", "config"), f"is {file.sumo.config!r}; {document.path.parent} has no such file"
        )


def _disorder(name: str, entries: Sequence[WeatherEntry | LinkAt], document: Document) -> Iterator[UserError]:
    for index, (earlier_s, later_s) in enumerate(pairwise(entry.at_s for entry in entries), start=1):
        if later_s <= earlier_s:
            why = f"is {later_s:g} after {earlier_s:g}; the entries must stand in the order of their at_s"
            yield document.refused((name, index, "at_s"), why)
