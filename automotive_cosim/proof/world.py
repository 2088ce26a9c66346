"""What cannot be in a world: weather that its place and date do not have."""

from __future__ import annotations

import math
from collections.abc import Iterator
from datetime import datetime, timedelta

from automotive_cosim.contracts import Weather
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.geo.climate import ClimateNorm, climate_norm
from automotive_cosim.geo.forecast import DAY_TO_DAY_SIGMA_C
from automotive_cosim.geo.weather import phenomena

STATION_WITHIN_KM = 250.0
"""A station farther away does not tell the climate of the place."""
SIGMAS = 5.0
"""How many standard deviations a day may be from its hour's normal: rarer than any record."""
SNOW_UP_TO_C = 3.0
FOG_FROM_HUMIDITY_PCT = 95.0
"""Fog is saturated air; gauges read a little less."""


def implausible(moment: Moment) -> Iterator[str]:
    """What the weather of a moment contradicts, in words: itself, or the climate of its place, month and hour.

    A place without a station within 250 km is only held against itself."""
    weather, driving = moment.weather, moment.driving
    yield from _contradictions(weather)
    if driving.lon_deg is None or driving.lat_deg is None:
        return
    norm = climate_norm(driving.lon_deg, driving.lat_deg, moment.local_time.month, STATION_WITHIN_KM)
    if norm is None:
        return
    usual_c = normal_c(norm, driving.lon_deg, moment.local_time)
    if abs(weather.temperature_2m - usual_c) > SIGMAS * DAY_TO_DAY_SIGMA_C:
        yield (
            f"{weather.temperature_2m:.0f} degrees at {moment.local_time:%H:%M} on {moment.local_time:%d %B} near "
            f"{norm.station}, where {usual_c:.0f} are usual"
        )


def normal_c(norm: ClimateNorm, lon_deg: float, time: datetime) -> float:
    """The month's normal at that hour: the swing of the day is a cosine, warmest at three in the afternoon."""
    offset = time.utcoffset() or timedelta()
    solar = time - offset + timedelta(hours=lon_deg / 15)
    warmth = math.cos(2 * math.pi * (solar.hour + solar.minute / 60 - 15) / 24)
    return norm.temperature_c + (norm.usual_high_c - norm.temperature_c) * warmth


def _contradictions(weather: Weather) -> Iterator[str]:
    found = phenomena(weather)
    if "snow" in found and weather.temperature_2m > SNOW_UP_TO_C:
        yield f"snow at {weather.temperature_2m:.0f} degrees"
    if "fog" in found and weather.relative_humidity_2m < FOG_FROM_HUMIDITY_PCT:
        yield f"fog in air of {weather.relative_humidity_2m:.0f} % humidity"
    if "precipitation" in found and weather.precipitation <= 0:
        yield "weather that falls, but nothing falls"
    if weather.precipitation > 0 and "precipitation" not in found:
        yield f"{weather.precipitation:g} mm/h fall from a sky that is dry by its code"
