"""The countries within two kilometres of a position, by the polygons of the time zones that ``tzfpy`` looks up.

Polygons are read only where a border is near: a cell of five kilometres is searched once in steps of 400 m, which
finds every enclave worth its name (Baarle), and remembered.
"""

from __future__ import annotations

import json
import math
from functools import cache, lru_cache
from importlib.resources import files

import shapely
import tzfpy

from automotive_cosim.geo.earth import METRES_PER_DEGREE, metres_per_degree_east

NEAR_BORDER_M = 2000.0
"""Within this distance of another country or region, position or polygons may be wrong; our choice."""

CELL_DEG = 0.05
"""Side of the cells."""

STEP_M = 400.0
"""Distance between the points of a search."""

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


def _around(column: int, row: int) -> shapely.Polygon:
    """The cell and two kilometres on each side."""
    south, west = row * CELL_DEG, column * CELL_DEG
    north_deg = NEAR_BORDER_M / METRES_PER_DEGREE
    east_deg = NEAR_BORDER_M / metres_per_degree_east(max(abs(south), abs(south + CELL_DEG)) + north_deg)
    return shapely.box(west - east_deg, south - north_deg, west + CELL_DEG + east_deg, south + CELL_DEG + north_deg)


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
