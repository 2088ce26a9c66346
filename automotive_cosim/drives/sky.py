"""Weather that sets in: plausible from the weather before it, at the same temperature."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.contracts import Weather

FREEZING_C = 0.5
"""At and below, what falls is snow (``geo.forecast.SNOW_BELOW_C``)."""
ICY_UP_TO_C = 3.0
"""Rain freezes on a cold road up to here."""


def fog(before: Weather, visibility_m: float) -> Weather:
    """Fog, or mist from a kilometre of visibility on."""
    rime = before.temperature_2m <= 0
    code = (48 if rime else 45) if visibility_m < 1000 else 3
    return replace(
        before,
        relative_humidity_2m=99.0,
        precipitation=0.0,
        weather_code=code,
        cloud_cover=100.0,
        visibility=visibility_m,
        wind_speed_10m=3.0,
    )


def rain(before: Weather) -> Weather:
    """A heavy shower; snow in the cold."""
    if before.temperature_2m <= FREEZING_C:
        return _falls(before, 73, 1.5, 1500.0)
    return _falls(before, 63, 5.0, 4000.0)


def drizzle(before: Weather) -> Weather:
    """A trace that hardly wets the road; grains of snow in the cold."""
    return _falls(before, 77 if before.temperature_2m <= FREEZING_C else 51, 0.1, 12_000.0)


def sleet(before: Weather) -> Weather:
    """What makes a road slippery: heavy snow, freezing rain in the cold, a cloudburst in the warm."""
    if before.temperature_2m <= FREEZING_C:
        return _falls(before, 75, 3.0, 600.0)
    if before.temperature_2m <= ICY_UP_TO_C:
        return _falls(before, 66, 1.5, 4000.0)
    return _falls(before, 65, 12.0, 2500.0)


def _falls(before: Weather, code: int, rate_mm_h: float, visibility_m: float) -> Weather:
    return replace(
        before,
        relative_humidity_2m=max(before.relative_humidity_2m, 92.0),
        precipitation=rate_mm_h,
        weather_code=code,
        cloud_cover=100.0,
        visibility=visibility_m,
    )
