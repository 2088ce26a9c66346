"""What cannot be in a world: weather that its place and date do not have, and a car that no driver drives in it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from datetime import datetime, timedelta

from automotive_cosim.cockpit.signals import HVAC, LIGHTS
from automotive_cosim.contracts import KMH_PER_MPS, Weather
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
LIFTS_BELOW_M, FOG_BELOW_SUN_DEG = 300.0, 25.0
"""Fog of less sight than that has lifted under a higher sun, except over water: our choice. Radiation fog goes
within hours of sunrise (WMO-No. 407), and a sun that stands higher has shone for that long."""
REACTION_S, BRAKING_MPS2 = 1.0, 5.0
SIGHTS_TO_STOP = 2.0
"""Stopping distances of more than twice the sight are driven by nobody: our choice. Drivers in fog outdrive their
sight, by up to about that much (White and Jeffery 1980, TRRL LR 838)."""
COLD_C, COLDER_THAN_OUTSIDE_C = 18.0, 5.0
"""Without air conditioning no cabin is cold, and colder than the air around it by more; our choice."""


def implausible(moment: Moment) -> Iterator[str]:
    """What is out of this world at a moment, in words: its weather, how it is driven in, what the car shows."""
    yield from out_of_season(moment)
    yield from _driven(moment)


def out_of_season(moment: Moment) -> Iterator[str]:
    """What the weather of a moment contradicts, in words: itself, or the climate of its place, month and hour.

    A place without a station within 250 km is only held against itself.
    """
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


def _driven(moment: Moment) -> Iterator[str]:
    weather, speed_mps = moment.weather, moment.driving.speed_mps
    sun_deg = moment.surroundings.sun_elevation_deg
    is_foggy = "fog" in phenomena(weather) and weather.visibility < LIFTS_BELOW_M
    if is_foggy and sun_deg is not None and sun_deg > FOG_BELOW_SUN_DEG:
        yield f"{weather.visibility:.0f} m of sight in fog with the sun at {sun_deg:.0f} degrees"
    stop_m = speed_mps * REACTION_S + speed_mps**2 / (2 * BRAKING_MPS2)
    if stop_m > SIGHTS_TO_STOP * weather.visibility:
        yield f"{speed_mps * KMH_PER_MPS:.0f} km/h at {weather.visibility:.0f} m of sight"
    if "snow" in phenomena(weather) and speed_mps > 0 and not moment.signals[LIGHTS.LOW_BEAM.path]:
        yield "driving in falling snow without dipped beam"
    cabin_c, is_cooled = moment.signals[HVAC.CABIN_TEMPERATURE.path], moment.signals[HVAC.AIR_CONDITIONING.path]
    if not is_cooled and cabin_c < min(COLD_C, weather.temperature_2m - COLDER_THAN_OUTSIDE_C):
        yield f"{cabin_c:.0f} degrees in the cabin, {weather.temperature_2m:.0f} outside and no cooling"


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
