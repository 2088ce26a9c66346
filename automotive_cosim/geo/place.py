"""The country, region, city and time zone of a position, and their rules."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import shapely
import tzfpy

from automotive_cosim.errors import UserError
from automotive_cosim.geo.basics import basics_of
from automotive_cosim.geo.earth import METRES_PER_DEGREE, metres_per_degree_east
from automotive_cosim.geo.rulefile import read_jurisdiction
from automotive_cosim.geo.rules import Jurisdiction

NEAR_BORDER_M = 2000.0
"""Within this distance of another country or region, position or polygons may be wrong; our choice."""

CELL_DEG = 0.05
"""Side of the cells."""

SMALL_DEG = 0.01
"""Side of the cells that are looked up for the parts of a country."""

MOST_CELLS = 4096
"""Of these that are kept."""

STEP_M = 400.0
"""Distance between the points of a search."""

_zone_at = lru_cache(maxsize=256)(tzfpy.get_tz)
"""The time zone of a position, which is asked for a dozen times a second."""

NORTH_VIETNAM = shapely.box(102.0, 17.0, 110.0, 24.0) - shapely.box(102.0, 17.0, 104.95, 18.6)
"""Where the time zone of Bangkok, which the north of Vietnam shares, is not Thailand: it begins where Laos ends."""


def countries_near(lon_deg: float, lat_deg: float) -> frozenset[str]:
    """The ISO 3166-1 codes of the countries within two kilometres, whichever it lies in itself."""
    cell = math.floor(lon_deg / CELL_DEG), math.floor(lat_deg / CELL_DEG)
    return frozenset(code for code, area in _areas(*cell) if is_near(area, lon_deg, lat_deg))


def is_near(area: shapely.Geometry, lon_deg: float, lat_deg: float) -> bool:
    """Whether an area in degrees lies within two kilometres."""
    east, north = metres_per_degree_east(lat_deg), METRES_PER_DEGREE
    box = shapely.box(
        lon_deg - NEAR_BORDER_M / east,
        lat_deg - NEAR_BORDER_M / north,
        lon_deg + NEAR_BORDER_M / east,
        lat_deg + NEAR_BORDER_M / north,
    )
    around = shapely.intersection(area, box)
    if around.is_empty:
        return False
    in_metres = shapely.transform(around, lambda points: (points - (lon_deg, lat_deg)) * (east, north))
    return bool(in_metres.distance(shapely.Point(0, 0)) <= NEAR_BORDER_M)


def country_at(zone: str, lon_deg: float, lat_deg: float) -> str:
    """The ISO 3166-1 code of the country of a position, by its time zone; empty at sea."""
    if zone == "Asia/Bangkok" and shapely.contains_xy(NORTH_VIETNAM, lon_deg, lat_deg):
        return "VN"
    return _country_of_zone().get(zone, "")


@cache
def _country_of_zone() -> dict[str, str]:
    """Time zone -> ISO country code, from the time zone database's ``zone.tab``."""
    text = (files("tzdata") / "zoneinfo" / "zone.tab").read_text(encoding="utf-8")
    rows = (line.split("\t") for line in text.splitlines() if line and not line.startswith("#"))
    return {zone: country for country, _, zone, *_ in rows}


@lru_cache(maxsize=4096)
def _areas(column: int, row: int) -> tuple[tuple[str, shapely.Geometry], ...]:
    """The countries in a cell and its surroundings with their parts there; none where there is only one."""
    found = _zones(column, row)
    if len({code for _, code in found}) < 2:
        return ()
    cell = _around(column, row)
    return tuple((code, shapely.intersection(_polygon(zone), cell)) for zone, code in sorted(found))


def _around(column: int, row: int, side_deg: float = CELL_DEG) -> shapely.Polygon:
    """The cell and two kilometres on each side."""
    south, west = row * side_deg, column * side_deg
    north_deg = NEAR_BORDER_M / METRES_PER_DEGREE
    east_deg = NEAR_BORDER_M / metres_per_degree_east(max(abs(south), abs(south + side_deg)) + north_deg)
    return shapely.box(west - east_deg, south - north_deg, west + side_deg + east_deg, south + side_deg + north_deg)


def _zones(column: int, row: int) -> set[tuple[str, str]]:
    """The time zones on land, each with its country. Two countries that share one are nowhere in one cell."""
    west, south, east, north = _around(column, row).bounds
    lats = _steps(max(-90.0, south), min(90.0, north), METRES_PER_DEGREE)
    lons = _steps(west, east, metres_per_degree_east(south))
    east_of_line = [(lon + 180) % 360 - 180 for lon in lons]
    found = {(zone := tzfpy.get_tz(lon, lat), country_at(zone, lon, lat)) for lat in lats for lon in east_of_line}
    return {(zone, code) for zone, code in found if code}


def _steps(first_deg: float, last_deg: float, metres_per_degree: float) -> list[float]:
    count = max(1, math.ceil((last_deg - first_deg) * metres_per_degree / STEP_M))
    return [first_deg + (last_deg - first_deg) * step / count for step in range(count + 1)]


@lru_cache(maxsize=16)
def _polygon(zone: str) -> shapely.Geometry:
    read = json.loads(tzfpy.get_tz_polygon_geojson(zone))
    parts = [shapely.from_geojson(json.dumps(feature["geometry"])) for feature in read["features"]]
    return shapely.make_valid(shapely.union_all([shapely.make_valid(part) for part in parts]))


LAW_OF = {"GF": "FR", "GP": "FR", "MQ": "FR", "PM": "FR", "RE": "FR", "YT": "FR"}
"""Parts of a country with an ISO code of their own in which its traffic code applies: overseas France (art. 73 of
the constitution), and Saint Pierre and Miquelon (CGCT art. LO 6413-1). Territories whose traffic law is their own,
as those of the United States and New Caledonia, are not among them."""


@dataclass(frozen=True, slots=True)
class Place:
    """The place of a position. An empty text means unknown."""

    country: str = ""
    """ISO 3166-1 code; empty at sea."""
    country_name: str = ""
    region: str = ""
    city: str = ""
    time_zone: str = ""
    """IANA name; at sea one of the ``Etc/GMT`` zones."""
    near_border_to: tuple[str, ...] = ()
    """Codes of other countries and regions within two kilometres."""
    layers: tuple[Jurisdiction, ...] = ()
    """Whose rules apply, city before region before country; empty if no rules are known."""

    @property
    def law(self) -> Jurisdiction | None:
        """The country's own entry; None if no rules are known."""
        return self.layers[-1] if self.layers else None


NOWHERE = Place()
"""The place of an unknown position."""


class Atlas:
    """Places and their rules, read country by country when first needed.

    Args:
        folders: the user's own folders of rule files, the most important first; a file there replaces the
            shipped one with the same code."""

    def __init__(self, folders: Sequence[Path] = ()) -> None:
        self._folders = tuple(folders)
        self._files: dict[str, Path] = {}
        for folder in (*folders, Path(str(files("automotive_cosim.geo.data")))):
            if not folder.is_dir():
                raise UserError(f"{folder} is not a folder; give one with rule files such as FR.toml")
            for name in sorted(path.name for path in folder.iterdir() if path.suffix == ".toml"):
                self._files.setdefault(name.removesuffix(".toml"), folder / name)
        self._countries: dict[str, tuple[Jurisdiction, ...]] = {}
        self._cells: dict[tuple[str, int, int], tuple[Jurisdiction, ...] | None] = {}
        """By country and cell, the layers that apply all over it; None if a border of one of them is near."""
        self._last = NOWHERE

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled by its folders only: whoever unpickles it reads the files again."""
        return (Atlas, (self._folders,)) if self._folders else (shipped, ())

    def codes(self) -> tuple[str, ...]:
        """Every country, region and city that has a file."""
        return tuple(sorted(self._files))

    def place(self, lon_deg: float, lat_deg: float) -> Place:
        """The place of a position.

        Raises:
            UserError: not a position on earth.
            UserError: a rule file of the country is invalid."""
        check_position(lon_deg, lat_deg)
        lon_deg = (lon_deg + 180.0) % 360.0 - 180.0
        zone = _zone_at(lon_deg, lat_deg)
        country = country_at(zone, lon_deg, lat_deg)
        code = LAW_OF.get(country, country)
        layers = self._layers_of_cell(code, math.floor(lon_deg / SMALL_DEG), math.floor(lat_deg / SMALL_DEG))
        regions = set[str]()
        if layers is None:
            layers = tuple(self._layers(code, lon_deg, lat_deg))
            regions = set(self._regions_near(country, lon_deg, lat_deg))
        own = {country, "", *(layer.code for layer in layers)}
        near = tuple(sorted((countries_near(lon_deg, lat_deg) | regions) - own))
        last = self._last
        if (zone, country, layers, near) == (last.time_zone, last.country, last.layers, last.near_border_to):
            return last  # drives keep their places, and nearly all are the same
        inner = {layer.kind: layer.name for layer in layers if country not in LAW_OF}
        self._last = Place(
            country=country,
            country_name=inner.get("country", _country_names().get(country, "")),
            region=inner.get("region", ""),
            city=inner.get("city", ""),
            time_zone=zone,
            near_border_to=near,
            layers=layers,
        )
        return self._last

    def country_at(self, lon_deg: float, lat_deg: float) -> str:
        """ISO 3166-1 code of the country of a position; empty at sea. Much faster than its whole place."""
        return country_at(_zone_at(lon_deg, lat_deg), lon_deg, lat_deg)

    def country(self, code: str) -> tuple[Jurisdiction, ...]:
        """A country's law with those of its cities and regions, cities first and itself last; empty without any.

        Without a file of its own it has its ``basics``, which also complete a file.

        Raises UserError: one of the files is invalid, or a region's country has none."""
        if code not in self._countries:
            codes = [name for name in self._files if name == code or name.startswith(f"{code}-")]
            found = [self._read(name) for name in codes]
            row = basics_of(code)
            if code in codes:
                found = [row.completing(entry) if row and entry.code == code else entry for entry in found]
            elif row is not None and row.is_whole:
                found.append(row.country)
            elif found:
                raise UserError(f"{self._files[codes[0]]}: there is no {code}.toml for its country")
            order = ("city", "region", "country")
            self._countries[code] = tuple(sorted(found, key=lambda entry: order.index(entry.kind)))
        return self._countries[code]

    def _read(self, code: str) -> Jurisdiction:
        path = self._files[code]
        entry = read_jurisdiction(path)
        if entry.code != code:
            raise UserError(f"{path} [jurisdiction]: code {entry.code!r} is not the name of the file")
        return entry

    def _layers(self, country: str, lon_deg: float, lat_deg: float) -> Iterator[Jurisdiction]:
        for entry in self.country(country):
            if entry.area is None or shapely.contains_xy(entry.area, lon_deg, lat_deg):
                yield entry

    def _layers_of_cell(self, country: str, column: int, row: int) -> tuple[Jurisdiction, ...] | None:
        """See ``_cells``: a drive asks every second, and shapely takes as long as a whole place otherwise."""
        key = country, column, row
        if key not in self._cells:
            if len(self._cells) >= MOST_CELLS:
                self._cells.clear()
            west, south = column * SMALL_DEG, row * SMALL_DEG
            cell = shapely.box(west, south, west + SMALL_DEG, south + SMALL_DEG)
            around = _around(column, row, SMALL_DEG)
            entries = self.country(country)
            within = [(each, each.area, around if each.kind == "region" else cell) for each in entries]
            inner = tuple(each for each, area, box in within if area is None or area.contains_properly(box))
            outer = [each for each, area, box in within if area is not None and area.disjoint(box)]
            self._cells[key] = inner if len(inner) + len(outer) == len(entries) else None
        return self._cells[key]

    def _regions_near(self, country: str, lon_deg: float, lat_deg: float) -> Iterator[str]:
        for entry in self.country(country):
            if entry.kind == "region" and entry.area is not None and is_near(entry.area, lon_deg, lat_deg):
                yield entry.code


@cache
def shipped() -> Atlas:
    """The atlas of the shipped rules only, one per process."""
    return Atlas()


def check_position(lon_deg: float, lat_deg: float) -> None:
    """Refuses what is not a position on earth.

    Raises UserError: latitude beyond 90 or longitude beyond 180 degrees, or not a number."""
    if not -90.0 <= lat_deg <= 90.0:
        raise UserError(f"latitude {lat_deg:g} is not on earth; give -90 (south) to 90 (north)")
    if not -180.0 <= lon_deg <= 180.0:
        raise UserError(f"longitude {lon_deg:g} is not on earth; give -180 (west) to 180 (east)")


@cache
def _country_names() -> dict[str, str]:
    """ISO country code -> English name, from the time zone database's ``iso3166.tab``."""
    return {code: name for code, name, *_ in _table("iso3166.tab")}


def _table(name: str) -> list[list[str]]:
    text = (files("tzdata") / "zoneinfo" / name).read_text(encoding="utf-8")
    return [line.split("\t") for line in text.splitlines() if line and not line.startswith("#")]
