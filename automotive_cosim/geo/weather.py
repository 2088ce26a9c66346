"""Weather on the road: a scenario's timeline, and weather codes in the words of traffic law."""

from __future__ import annotations

from bisect import bisect_right
from enum import StrEnum
from functools import cache, lru_cache

from automotive_cosim.contracts import Weather
from automotive_cosim.errors import UserError

WMO_WORDS = {
    0: "clear sky",
    1: "mainly clear",
    2: "partly cloudy",
    3: "overcast",
    7: "blowing dust",
    31: "dust storm",
    45: "fog",
    48: "fog with rime",
    51: "light drizzle",
    53: "drizzle",
    55: "dense drizzle",
    56: "light freezing drizzle",
    57: "freezing drizzle",
    61: "light rain",
    63: "rain",
    65: "heavy rain",
    66: "light freezing rain",
    67: "freezing rain",
    71: "light snow",
    73: "snow",
    75: "heavy snow",
    77: "snow grains",
    80: "light rain showers",
    81: "rain showers",
    82: "heavy rain showers",
    85: "snow showers",
    86: "heavy snow showers",
    95: "thunderstorm",
    96: "thunderstorm with hail",
    99: "thunderstorm with heavy hail",
}
"""The subset of WMO code table 4677 that Open-Meteo reports, and dust, which it does not."""

FOG_BELOW_M = 1000.0
"""WMO: fog is visibility under one kilometre."""

HEAVY_RAIN_FROM_MM_PER_H = 7.6
"""American Meteorological Society, Glossary of Meteorology, "rain": heavy above 0.30 inch per hour."""

PHENOMENA = frozenset(
    (
        "drizzle",
        "dust",
        "fog",
        "freezing",
        "hail",
        "heavy_rain",
        "heavy_snow",
        "precipitation",
        "rain",
        "snow",
        "thunderstorm",
    )
)
"""The words a rule may use for weather; ``rain`` includes ``heavy_rain``, ``precipitation`` anything that falls."""

_PHENOMENA_OF_CODE: dict[frozenset[int], tuple[str, ...]] = {
    frozenset((7, 31)): ("dust",),
    frozenset((45, 48)): ("fog",),
    frozenset((51, 53, 55, 56, 57)): ("drizzle", "precipitation"),
    frozenset((56, 57, 66, 67)): ("freezing",),
    frozenset((61, 63, 65, 66, 67, 80, 81, 82, 95, 96, 99)): ("rain", "precipitation"),
    frozenset((65, 67, 82, 99)): ("heavy_rain",),
    frozenset((71, 73, 75, 77, 85, 86)): ("snow", "precipitation"),
    frozenset((75, 86)): ("heavy_snow",),
    frozenset((95, 96, 99)): ("thunderstorm",),
    frozenset((96, 99)): ("hail",),
}


class VisibilityClass(StrEnum):
    """Classes of visibility. The boundaries at 200, 100 and 50 m are those in traffic laws."""

    GOOD = "good"
    REDUCED = "reduced"
    """Under 1000 m: fog."""
    POOR = "poor"
    """Under 200 m: what drivers call thick fog."""
    VERY_POOR = "very_poor"
    """Under 100 m."""
    DENSE = "dense"
    """Under 50 m."""


_CLASS_STEPS_M = (50.0, 100.0, 200.0, FOG_BELOW_M)
_CLASSES = (
    VisibilityClass.DENSE,
    VisibilityClass.VERY_POOR,
    VisibilityClass.POOR,
    VisibilityClass.REDUCED,
    VisibilityClass.GOOD,
)


def visibility_class(visibility_m: float) -> VisibilityClass:
    """The class of a visibility in metres; a boundary belongs to the class above it."""
    return _CLASSES[bisect_right(_CLASS_STEPS_M, visibility_m)]


_TYPICAL_MM_PER_H = {
    51: 0.3, 53: 0.7, 55: 1.2, 56: 0.3, 57: 1.2, 61: 1.5, 63: 4.0, 65: 10.0, 66: 1.5, 67: 10.0, 71: 0.5,
    73: 1.0, 75: 3.0, 77: 0.2, 80: 1.5, 81: 4.0, 82: 10.0, 85: 0.5, 86: 3.0, 95: 8.0, 96: 10.0, 99: 20.0,
}  # fmt: skip
_TYPICAL_VISIBILITY_M = {
    7: 3000.0, 31: 600.0, 45: 400.0, 48: 400.0, 55: 4000.0, 63: 6000.0, 65: 2500.0, 67: 2500.0, 82: 2500.0,
    71: 3000.0, 73: 1500.0, 75: 600.0, 85: 1500.0, 86: 600.0, 95: 3000.0, 96: 2500.0, 99: 2000.0,
}  # fmt: skip
_CLEAR_VISIBILITY_M = 20_000.0
_TYPICAL_CLOUD_PCT = {0: 0.0, 1: 20.0, 2: 50.0}


def typical_weather(code: int, temperature_c: float = 15.0, humidity_pct: float = 70.0) -> Weather:
    """Typical weather of a code if nothing else is known: medium values of its class, our choice.

    Raises UserError: a code outside the table."""
    if code not in WMO_WORDS:
        known = ", ".join(map(str, WMO_WORDS))
        raise UserError(f"weather code {code} is not one of {known} (WMO 4677, as Open-Meteo uses it)")
    return Weather(
        temperature_2m=temperature_c,
        relative_humidity_2m=humidity_pct,
        precipitation=_TYPICAL_MM_PER_H.get(code, 0.0),
        weather_code=code,
        cloud_cover=_TYPICAL_CLOUD_PCT.get(code, 100.0),
        visibility=_TYPICAL_VISIBILITY_M.get(code, _CLEAR_VISIBILITY_M),
        wind_speed_10m=10.0,
    )


def words(code: int) -> str:
    """A weather code in words; a code outside the table by its number."""
    return WMO_WORDS.get(code, f"weather code {code}")


@cache
def _of_code(code: int) -> frozenset[str]:
    return frozenset(word for codes, names in _PHENOMENA_OF_CODE.items() if code in codes for word in names)


@lru_cache(maxsize=256)
def phenomena(weather: Weather) -> frozenset[str]:
    """The weather in the words of ``PHENOMENA``.

    A code and the measured values may each imply a phenomenon: visibility under one kilometre without precipitation
    or dust is fog, and 7.6 mm of rain per hour is heavy rain, whatever the code says."""
    found = set(_of_code(weather.weather_code))
    if weather.visibility < FOG_BELOW_M and found.isdisjoint(("precipitation", "dust")):
        found.add("fog")
    if "rain" in found and weather.precipitation >= HEAVY_RAIN_FROM_MM_PER_H:
        found.add("heavy_rain")
    return frozenset(found)
