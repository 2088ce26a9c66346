"""The car's sensors of sky, air and surface: light, glare, visibility, fine dust and grip."""

from __future__ import annotations

import math
from datetime import UTC, datetime

from automotive_cosim.cockpit.signals import ADAS, OUTSIDE, Signals
from automotive_cosim.contracts import Surroundings, Weather
from automotive_cosim.contracts.text import say

LOW_SUN_DEG = 25.0
"""Elevation below which the sun shines through the windshield of a car that drives towards it."""
DUST_CODES = frozenset({6, 7, 8, 9, *range(30, 36)})
"""WMO 4677: dust in suspension or raised, dust and sand storms."""
ICE_CODES = frozenset({48, 56, 57, 66, 67})
SNOW_CODES = frozenset({71, 73, 75, 77, 85, 86})
GRIP_ICE, GRIP_SNOW, GRIP_WET = 0.15, 0.3, 0.7
"""Grip relative to a dry road: rough means of published friction coefficients (0.1, 0.2 to 0.3 and 0.5 to 0.6
against 0.8)."""
STREET_DUST, JAM_DUST, TUNNEL_DUST = 8.0, 15.0, 60.0
"""Fine dust in ug/m3: clean city air, what a jam adds and what a tunnel adds. Plausible assumptions."""
FINE_SHARE = 0.15
"""Share of particles under 2.5 micrometres in a dust storm: an assumption."""
GRADES = (
    (5.0, say("Good")),
    (15.0, say("Fair")),
    (50.0, say("Moderate")),
    (90.0, say("Poor")),
    (140.0, say("Very poor")),
)
"""Upper bounds of fine dust in ug/m3 (European Air Quality Index, EEA, since 2024); above is extremely poor."""


def feel(signals: Signals, surroundings: Surroundings, measures_grip: bool = False) -> None:
    """Writes the sensors' readings of the surroundings.

    Args:
        measures_grip: whether the car measures the road's grip, and does not also infer it from the weather."""
    driving, weather = surroundings.driving, surroundings.weather
    tunnel = driving.road.in_tunnel
    signals[OUTSIDE.VISIBILITY] = weather.visibility
    signals[OUTSIDE.WIND] = weather.wind_speed_10m
    signals[OUTSIDE.LIGHT] = 2.0 if tunnel else _light_pct(surroundings.sun_elevation_deg, weather)
    signals[OUTSIDE.GLARE] = 0.0 if tunnel else _glare_pct(surroundings)
    signals[OUTSIDE.FINE_DUST] = _fine_dust(weather, tunnel, driving.around.relative_speed)
    inferred = 1.0 if tunnel or measures_grip else _grip(weather)
    signals[ADAS.ROAD_FRICTION] = 100 * min(max(driving.road.friction, 0.0), 1.0, inferred)


def air_grade(fine_dust: float) -> str:
    """The index's class."""
    return next((word for bound, word in GRADES if fine_dust <= bound), say("Extremely poor"))


def is_dusty(weather: Weather) -> bool:
    """Whether dust is in the air."""
    return weather.weather_code in DUST_CODES


def _light_pct(sun_elevation_deg: float | None, weather: Weather) -> float:
    """Daylight: full at 30 degrees under a clear sky; clouds reduce it by up to two thirds."""
    if sun_elevation_deg is None:
        return 100.0
    height = math.sin(math.radians(sun_elevation_deg)) / math.sin(math.radians(30))
    return 100 * min(1.0, max(0.0, height)) * (1 - 0.65 * weather.cloud_cover / 100)


def _glare_pct(surroundings: Surroundings) -> float:
    """Glare of a low sun from ahead."""
    elevation, driving = surroundings.sun_elevation_deg, surroundings.driving
    if elevation is None or not 0 < elevation < LOW_SUN_DEG or driving.lat_deg is None or driving.lon_deg is None:
        return 0.0
    azimuth = sun_azimuth_deg(driving.lat_deg, driving.lon_deg, surroundings.local_time)
    ahead = math.cos(math.radians(azimuth - driving.heading_deg))
    return 100 * max(0.0, ahead) * (1 - elevation / LOW_SUN_DEG) * (1 - surroundings.weather.cloud_cover / 100)


def sun_azimuth_deg(lat_deg: float, lon_deg: float, time: datetime) -> float:
    """Azimuth, clockwise from north, to a few degrees: mean sun, and a cosine for the declination."""
    utc = time.astimezone(UTC)
    hours = utc.hour + utc.minute / 60 + utc.second / 3600
    hour_angle = math.radians(15 * (hours - 12) + lon_deg)
    declination = math.radians(-23.44 * math.cos(math.tau * (utc.timetuple().tm_yday + 10) / 365))
    lat = math.radians(lat_deg)
    east = -math.sin(hour_angle) * math.cos(declination)
    north = math.cos(lat) * math.sin(declination) - math.sin(lat) * math.cos(declination) * math.cos(hour_angle)
    return math.degrees(math.atan2(east, north)) % 360


def _fine_dust(weather: Weather, tunnel: bool, relative_speed: float) -> float:
    """Fine dust; in a dust storm from the visibility (Shao and others 2003: 3802 times the kilometres to the
    -0.84)."""
    dust = STREET_DUST + (TUNNEL_DUST if tunnel else 0.0) + (JAM_DUST if relative_speed < 0.4 else 0.0)
    if is_dusty(weather) and not tunnel:
        dust += FINE_SHARE * 3802.0 * max(weather.visibility / 1000, 0.05) ** -0.84
    return min(dust, 2000.0)


def _grip(weather: Weather) -> float:
    """Grip relative to a dry road. Water freezes on the road at and below 0 degrees."""
    wet = weather.precipitation > 0.1
    if weather.weather_code in ICE_CODES and weather.temperature_2m <= 1:
        return GRIP_ICE
    if weather.weather_code in SNOW_CODES:
        return GRIP_SNOW
    if weather.temperature_2m <= 0 and (wet or weather.relative_humidity_2m >= 95):
        return GRIP_ICE
    return GRIP_WET if wet else 1.0
