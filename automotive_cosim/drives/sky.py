"""Weather that sets in: plausible from the weather before it, at the same temperature."""

from __future__ import annotations

from collections.abc import Iterator
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


def fog_bank(before: Weather, visibility_m: float) -> Iterator[tuple[float, Weather]]:
    """Fog that comes and goes: seconds since the first of it, and the weather from then on. Sight falls by the same
    share with each step and rises faster again."""
    share = (visibility_m / before.visibility) ** (1 / FALLING)
    for step in range(1, FALLING + 1):
        yield (step - 1) * STEP_S, fog(before, round(before.visibility * share**step, 1))
    for step in range(1, RISING):
        seen_m = visibility_m * (before.visibility / visibility_m) ** (step / RISING)
        yield DENSE_UNTIL_S + (step - 1) * STEP_S, fog(before, round(seen_m, 1))


FALLING, RISING, STEP_S = 10, 4, 12.0
DENSE_FROM_S, DENSE_UNTIL_S = (FALLING - 1) * STEP_S, FALLING * STEP_S + 100.0
FOG_S = DENSE_UNTIL_S + (RISING - 1) * STEP_S
"""Two minutes until a bank is as dense as it becomes, then almost two, and half a minute until it has gone."""


def shower(before: Weather, full: Weather) -> Iterator[tuple[float, Weather]]:
    """Rain or snow that sets in and passes: seconds since its first drops, and the weather from then on."""
    codes = SETS_IN[full.weather_code]
    parts = [_part(before, full, code, step / len(codes)) for step, code in enumerate(codes, 1)]
    yield from ((step * SHOWER_STEP_S, part) for step, part in enumerate(parts))
    yield SHOWER_UNTIL_S, parts[0]


def _part(before: Weather, full: Weather, code: int, share: float) -> Weather:
    seen_m = before.visibility * (full.visibility / before.visibility) ** share
    falls_mm_h = round(full.precipitation * share, 2)
    return replace(full, weather_code=code, precipitation=falls_mm_h, visibility=round(seen_m, 1))


SETS_IN = {
    51: (51, 51, 51),
    63: (61, 61, 63),
    65: (61, 63, 65),
    66: (56, 56, 66),
    73: (71, 71, 73),
    75: (71, 73, 75),
    77: (77, 77, 77),
}
"""Codes of the weather as it sets in, by the code of what it becomes."""
SHOWER_STEP_S = 15.0
SHOWER_UNTIL_S = 2 * SHOWER_STEP_S + 120.0
SHOWER_S = SHOWER_UNTIL_S + SHOWER_STEP_S
"""Half a minute until it falls as hard as it will, then two, and a quarter until it is over."""


def rain(before: Weather) -> Weather:
    """A heavy shower; snow in the cold."""
    if before.temperature_2m <= FREEZING_C:
        return _falls(before, 73, 1.5, 1500.0)
    return _falls(before, 63, 5.0, 4000.0)


def snow(before: Weather) -> Weather:
    """Snow, at freezing point where it was warmer."""
    return _falls(replace(before, temperature_2m=min(before.temperature_2m, 0.0)), 73, 1.5, 1500.0)


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


def together(one: Weather, other: Weather) -> Weather:
    """The weather of two that come at a time: what falls harder, and the shorter sight."""
    worse = max(one, other, key=lambda weather: (weather.precipitation, -weather.visibility))
    return replace(
        worse,
        visibility=min(one.visibility, other.visibility),
        relative_humidity_2m=max(one.relative_humidity_2m, other.relative_humidity_2m),
    )
