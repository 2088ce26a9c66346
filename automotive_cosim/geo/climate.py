"""The usual weather at a place: monthly normals of the nearest station."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

NEAR_KM = 60.0
"""A station farther away says nothing about this place; our choice."""

EARTH_RADIUS_KM = 6371.0


@dataclass(frozen=True, slots=True)
class ClimateNorm:
    """Normals of one month at one station, 1991-2020, from general knowledge: accurate to about 1 degree Celsius,
    15 % of the rain and 5 points of humidity, the daily range to about 2 degrees."""

    station: str
    month: int
    temperature_c: float
    """Mean temperature of day and night."""
    usual_low_c: float
    """Mean of the daily minima, as far below the mean as that of the maxima, ``usual_high_c``, is above."""
    usual_high_c: float
    precipitation_mm: float
    """Total of the month."""
    humidity_pct: float
    status: str


@dataclass(frozen=True, slots=True)
class _Station:
    name: str
    lon_deg: float
    lat_deg: float
    months: dict[str, tuple[float, ...]]
    status: str


def climate_norm(lon_deg: float, lat_deg: float, month: int, within_km: float = NEAR_KM) -> ClimateNorm | None:
    """The nearest station's normals for a month (1 to 12), None if it is farther away than ``within_km``."""
    band_deg = 1.001 * math.degrees(within_km / EARTH_RADIUS_KM)  # the latitude alone rules most of them out
    near = [
        (_distance_km(station, lon_deg, lat_deg), station)
        for station in _stations()
        if abs(station.lat_deg - lat_deg) <= band_deg
    ]
    distance_km, station = min(near, key=lambda pair: pair[0], default=(math.inf, None))
    if station is None or distance_km > within_km:
        return None
    mean_c, swing_c = station.months["t_mean_c"][month - 1], station.months["t_swing_c"][month - 1]
    return ClimateNorm(
        station=station.name,
        month=month,
        temperature_c=mean_c,
        usual_low_c=mean_c - swing_c / 2,
        usual_high_c=mean_c + swing_c / 2,
        precipitation_mm=station.months["precip_mm"][month - 1],
        humidity_pct=station.months["rh_pct"][month - 1],
        status=station.status,
    )


@cache
def _stations() -> tuple[_Station, ...]:
    text = files("automotive_cosim.geo.data").joinpath("climate.csv").read_text(encoding="utf-8")
    return tuple(_read_stations(csv.DictReader(text.splitlines())))


def _read_stations(rows: Iterable[dict[str, str]]) -> list[_Station]:
    stations: dict[str, _Station] = {}
    for row in rows:
        name = row["station"]
        station = stations.setdefault(name, _Station(name, float(row["lon"]), float(row["lat"]), {}, row["status"]))
        station.months[row["variable"]] = tuple(float(row[month]) for month in _MONTHS)
    return list(stations.values())


_MONTHS = ("jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec")


def _distance_km(station: _Station, lon_deg: float, lat_deg: float) -> float:
    lat_a, lat_b = math.radians(station.lat_deg), math.radians(lat_deg)
    half_lon = math.radians(lon_deg - station.lon_deg) / 2
    chord = math.sin((lat_b - lat_a) / 2) ** 2 + math.cos(lat_a) * math.cos(lat_b) * math.sin(half_lon) ** 2
    return 2 * EARTH_RADIUS_KM * math.asin(min(1.0, math.sqrt(chord)))
