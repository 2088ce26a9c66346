"""How long and how far a drive went on which roads, in which weather, light and band of speed."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

BANDS_KMH = (0, 30, 50, 80, 100)
"""Lower bounds of the bands of speed; the last one is open."""


@dataclass(frozen=True, slots=True)
class DriveStretch:
    """A piece of a drive in unchanged conditions."""

    seconds: float
    metres: float
    speed_kmh: float
    road_class: str
    """OSM highway value; empty if unknown."""
    weather: str
    light: str


@dataclass(frozen=True, slots=True)
class ExposureCell:
    """Hours and kilometres in one combination of conditions."""

    road_class: str
    weather: str
    light: str
    speed_band: str
    """In km/h, as in ``30 to 50``."""
    hours: float
    kilometres: float


def exposure(stretches: Iterable[DriveStretch]) -> tuple[ExposureCell, ...]:
    """The sums by condition, the longest first; together they are the whole drive."""
    sums: dict[tuple[str, str, str, str], list[float]] = {}
    for each in stretches:
        cell = sums.setdefault((each.road_class, each.weather, each.light, _band(each.speed_kmh)), [0.0, 0.0])
        cell[0] += each.seconds
        cell[1] += each.metres
    cells = (ExposureCell(*key, round(s / 3600, 6), round(m / 1000, 6)) for key, (s, m) in sums.items())
    return tuple(sorted(cells, key=lambda cell: (-cell.hours, -cell.kilometres, cell.road_class, cell.speed_band)))


def summed(cells: Iterable[ExposureCell]) -> tuple[ExposureCell, ...]:
    """The cells of several drives as one exposure."""
    sums: dict[tuple[str, str, str, str], list[float]] = {}
    for each in cells:
        cell = sums.setdefault((each.road_class, each.weather, each.light, each.speed_band), [0.0, 0.0])
        cell[0] += each.hours
        cell[1] += each.kilometres
    made = (ExposureCell(*key, round(hours, 6), round(km, 6)) for key, (hours, km) in sums.items())
    return tuple(sorted(made, key=lambda cell: (-cell.hours, cell.road_class, cell.speed_band)))


def _band(kmh: float) -> str:
    return band_named(max(least for number, least in enumerate(BANDS_KMH) if kmh >= least or number == 0))


def band_named(least_kmh: int) -> str:
    """The name of the band that begins there: ``30 to 50``."""
    index = BANDS_KMH.index(least_kmh)
    if index + 1 == len(BANDS_KMH):
        return f"from {least_kmh}"
    return f"{least_kmh} to {BANDS_KMH[index + 1]}"
