"""Reads ``scenario.toml``, field by field."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, fields
from datetime import datetime
from importlib.resources import files
from itertools import pairwise
from math import isfinite
from pathlib import Path
from typing import Any, TypeVar
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

from automotive_cosim.contracts import Weather
from automotive_cosim.errors import ScenarioError, UnknownNameError
from automotive_cosim.scenarios.incidents import KINDS, Incident
from automotive_cosim.scenarios.model import DRAWN, LINKS, Ego, LinkAt, Scenario, Street, Sumo, Trip, WeatherAt


def shipped() -> tuple[str, ...]:
    """Names of the scenarios that come with the package."""
    root = Path(str(files("automotive_cosim").joinpath("sumo_scenarios")))
    return tuple(sorted(path.parent.name for path in root.glob("*/scenario.toml")))


def load(name_or_folder: str | Path) -> Scenario:
    """Reads a shipped scenario by name, or any folder that holds a ``scenario.toml``.

    Raises:
        UnknownNameError: neither a shipped name nor a folder.
        ScenarioError: the file is missing, is no TOML, or has a wrong, surplus or missing field.
    """
    folder = Path(name_or_folder)
    if not (folder / "scenario.toml").is_file():
        if folder.is_dir():
            raise ScenarioError(f"{folder} has no scenario.toml; make one with `automotive-cosim scenarios import`")
        names = shipped()
        if str(name_or_folder) not in names:
            raise UnknownNameError("scenario", str(name_or_folder), names, "automotive-cosim scenarios list")
        folder = Path(str(files("automotive_cosim").joinpath("sumo_scenarios"))) / str(name_or_folder)
    path = folder / "scenario.toml"
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ScenarioError(f"{path} is not TOML: {error}") from error
    return _scenario(table, folder.resolve(), path)


def _scenario(table: dict[str, Any], folder: Path, path: Path) -> Scenario:
    try:
        ego = dict(table.pop("ego"))
        trips = tuple(_read(Trip, trip, f"{path} [[ego.trips]]") for trip in ego.pop("trips"))
        sumo = _read(Sumo, table.pop("sumo"), f"{path} [sumo]")
        zone = ZoneInfo(table.pop("time_zone"))
        start = datetime.fromisoformat(str(table.pop("start")))
        rows = table.pop("weather")
        if isinstance(rows, str) and rows != DRAWN:
            raise ScenarioError(f'{path}: weather = {rows!r}; write [[weather]] entries, or weather = "{DRAWN}"')
        weather = () if rows == DRAWN else tuple(_weather_at(row, path) for row in rows)
        incidents = tuple(_incident(row, path) for row in table.pop("incidents", ()))
        links = tuple(_read(LinkAt, row, f"{path} [[connectivity]]") for row in table.pop("connectivity", ()))
        streets = tuple(_read(Street, row, f"{path} [[streets]]") for row in table.pop("streets", ()))
        scenario = _read(
            Scenario,
            table
            | {
                "folder": folder,
                "start": start.replace(tzinfo=start.tzinfo or zone),
                "sumo": sumo,
                "ego": _read(Ego, ego | {"trips": trips}, f"{path} [ego]"),
                "weather": weather,
                "incidents": incidents,
                "connectivity": links,
                "streets": streets,
            },
            str(path),
        )
    except ZoneInfoNotFoundError as error:
        raise ScenarioError(f"{path}: {error.args[0]}; time_zone is a name such as Europe/Paris") from error
    except KeyError as error:
        raise ScenarioError(f"{path} lacks {error.args[0]!r}") from error
    except (TypeError, ValueError) as error:
        raise ScenarioError(f"{path}: {error}") from error
    for incident in scenario.incidents:
        if incident.trip:
            scenario.trip(incident.trip)
    _check_links(scenario.connectivity, f"{path} [[connectivity]]")
    _check_ranges(scenario.sumo, f"{path} [sumo]")
    if not scenario.ego.trips:
        raise ScenarioError(f"{path} has no [[ego.trips]]; add one with name, from_edge and to_edge")
    if rows != DRAWN and (not weather or weather[0].at_s != 0):
        raise ScenarioError(f'{path}: the first [[weather]] must have at_s = 0, or say weather = "{DRAWN}"')
    if not scenario.config.is_file():
        raise ScenarioError(f"{path}: {scenario.sumo.config} is not in {folder}")
    return scenario


def _weather_at(row: dict[str, Any], path: Path) -> WeatherAt:
    row = dict(row)
    return WeatherAt(float(row.pop("at_s")), _read(Weather, row, f"{path} [[weather]]"))


def _incident(row: dict[str, Any], path: Path) -> Incident:
    row = dict(row)
    kind = row.pop("kind")
    if kind not in KINDS:
        raise ScenarioError(f"{path} [[incidents]]: {UnknownNameError('kind', str(kind), KINDS)}")
    return _read(KINDS[kind], row, f"{path} [[incidents]] of kind {kind!r}")


def _check_links(links: Sequence[LinkAt], where: str) -> None:
    for link in links:
        if link.best not in LINKS:
            raise ScenarioError(f"{where}: {UnknownNameError('best', link.best, LINKS)}")
    if any(later.at_s <= earlier.at_s for earlier, later in pairwise(links)):
        raise ScenarioError(f"{where}: the entries must stand in the order of their at_s")


def _check_ranges(sumo: Sumo, where: str) -> None:
    ranges = {
        "step_length_s": (0.01, 10.0),
        "action_step_length_s": (0.01, 10.0),
        "warm_up_s": (0.0, 86_400.0),
        "scale": (0.0, 100.0),
        "background_rerouting": (0.0, 1.0),
    }
    for name, (low, high) in ranges.items():
        value = getattr(sumo, name)
        if not low <= value <= high:
            raise ScenarioError(f"{where}: {name} is {value:g}; it goes from {low:g} to {high:g}")


T = TypeVar("T")


def _read(kind: type[T], table: Mapping[str, Any], where: str) -> T:
    known = {field.name: field for field in fields(kind)}  # type: ignore[arg-type]
    for name in table:
        if name not in known:
            raise ScenarioError(f"{where}: {UnknownNameError('field', name, known)}")
    for name, field in known.items():
        if name not in table and field.default is MISSING and field.default_factory is MISSING:
            raise ScenarioError(f"{where} lacks {name!r}")
    values = {name: tuple(value) if isinstance(value, list) else value for name, value in table.items()}
    for name, value in values.items():
        _check_type(str(known[name].type), value, f"{where}: {name}")
    return kind(**values)


_SIMPLE: dict[str, tuple[type, ...]] = {"str": (str,), "int": (int,), "float": (int, float), "bool": (bool,)}


def _check_type(annotation: str, value: Any, what: str) -> None:
    """Plain fields only; what is nested has been read by a class of its own."""
    wanted = annotation.removesuffix(" | None")
    if wanted == "tuple[float, float]":
        right = isinstance(value, tuple) and len(value) == 2 and all(type(part) in (int, float) for part in value)
    elif wanted == "tuple[str, ...]":
        right = isinstance(value, tuple) and all(isinstance(entry, str) for entry in value)
    elif wanted in _SIMPLE and value is not None:
        right = isinstance(value, _SIMPLE[wanted]) and isinstance(value, bool) == (wanted == "bool")
    else:
        return
    if not right or (isinstance(value, float) and not isfinite(value)):
        raise ScenarioError(f"{what} is {value!r}; it must be {_WORDS.get(wanted, wanted)}")


_WORDS = {
    "str": "a text",
    "int": "a whole number",
    "float": "a number",
    "bool": "true or false",
    "tuple[str, ...]": "a list of texts",
    "tuple[float, float]": "a list of two numbers",
}
