"""Sources of weather that a scenario does not state: drawn from the climate, or from Open-Meteo.

    Climate(seed).report(lon, lat, time)                 # offline: the month's normals and a seed
    OpenMeteo(Climate(seed)).report(lon, lat, time)      # online; if that fails, the climate, and it says so

Nothing here goes online unless an ``OpenMeteo`` is made. Its data are Open-Meteo's (CC BY 4.0; free for
non-commercial use, https://open-meteo.com/en/terms).
"""

from __future__ import annotations

import calendar
import http.client
import json
import math
import urllib.error
import urllib.parse
import urllib.request
from dataclasses import dataclass, fields
from datetime import UTC, datetime, timedelta
from typing import Any, Protocol

import numpy as np

from automotive_cosim.contracts import DrivingState, Weather
from automotive_cosim.errors import ScenarioError, UserError
from automotive_cosim.formats.scenario import WeatherAt
from automotive_cosim.geo.climate import NEAR_KM, ClimateNorm, climate_norm
from automotive_cosim.geo.weather import FOG_BELOW_M, HEAVY_RAIN_FROM_MM_PER_H, WMO_WORDS, typical_weather

OPEN_METEO_URL = "https://api.open-meteo.com/v1/forecast"
TIMEOUT_S = 5.0
ANSWER_LIMIT_BYTES = 1_000_000


@dataclass(frozen=True, slots=True)
class Report:
    """The weather and its source."""

    weather: Weather
    source: str
    note: str = ""
    """Why it does not come from the requested source; empty if it does."""


class _WeatherSource(Protocol):
    """Gives the weather at a place and time."""

    def report(self, lon_deg: float, lat_deg: float, local_time: datetime) -> Report:
        """The weather there and then; ``local_time`` is zone-aware.

        Raises UserError: nothing is known about the place."""
        ...


# --- drawn from the climate -------------------------------------------------------------------------------

DAY_TO_DAY_SIGMA_C = 3.0
"""Deviation of a day's temperature from the month's mean; a usual figure of the temperate zone."""
RAIN_RATE_MM_PER_H = ((10.0, 0.8), (25.0, 2.5))
"""Mean rate of rain while it falls, from steady rain in the cold to showers in the heat; our choice."""
WET_AT_MOST = 0.5
"""Maximum share of hours with precipitation."""
RATE_STEPS = ((0.5, 51), (1.0, 53), (1.3, 55), (2.5, 61), (HEAVY_RAIN_FROM_MM_PER_H, 63), (math.inf, 65))
"""(mm/h below, code), as Open-Meteo derives codes from rates."""
SNOW_STEPS = ((0.2, 71), (0.8, 73), (math.inf, 75))
"""The same in cm/h of snow."""
CLOUD_STEPS = ((20.0, 0), (50.0, 1), (80.0, 2), (math.inf, 3))
"""(per cent below, code)."""
SNOW_CM_PER_MM = 0.7
SNOW_BELOW_C = 0.5
THUNDER_FROM_C = 18.0
FOG_FROM_PCT, FOG_WIND_BELOW_KMH = 93.0, 8.0
"""Fog forms in damp and calm air; our choice."""


class Climate:
    """Draws weather from the month's normals of the nearest station. Each seed has one weather per hour.

    Over many seeds, temperature, rain and humidity average to the normals."""

    def __init__(self, seed: int, within_km: float = NEAR_KM) -> None:
        """Draws by ``seed``; a station farther away than ``within_km`` does not count."""
        self._seed = seed
        self._within_km = within_km

    def report(self, lon_deg: float, lat_deg: float, local_time: datetime) -> Report:
        hour = local_time.astimezone(UTC).replace(minute=0, second=0, microsecond=0)
        solar_time = hour + timedelta(hours=lon_deg / 15)
        norm = climate_norm(lon_deg, lat_deg, solar_time.month, self._within_km)
        if norm is None:
            raise UserError(
                f"no climate is known within {self._within_km:g} km of {lat_deg:g}, {lon_deg:g} to draw weather "
                "from; state the weather instead"
            )
        rng = np.random.default_rng([self._seed, hour.year, hour.month, hour.day, hour.hour])
        return Report(draw(norm, solar_time, rng), f"drawn from the climate of {norm.station} (seed {self._seed})")


def drawn_weather(driving: DrivingState, departure: datetime, seed: int) -> tuple[WeatherAt, ...]:
    """A timeline for a scenario that leaves its weather to the climate: one weather for the whole drive.

    Every place on earth has one: the nearest station, however far, is used for an unlisted climate.

    Args:
        departure: when it begins, zone-aware.

    Raises ScenarioError: the network has no projection."""
    if driving.lon_deg is None or driving.lat_deg is None:
        raise ScenarioError('weather = "climate" requires a network with a projection; state [[weather]] instead')
    return (WeatherAt(0.0, Climate(seed, math.inf).report(driving.lon_deg, driving.lat_deg, departure).weather),)


def draw(norm: ClimateNorm, solar_time: datetime, rng: np.random.Generator) -> Weather:
    """One hour's weather of a month with these normals; warmest and driest at three in the afternoon."""
    warmth = math.cos(2 * math.pi * (solar_time.hour + solar_time.minute / 60 - 15) / 24)
    temperature_c = norm.temperature_c + (norm.usual_high_c - norm.temperature_c) * warmth
    temperature_c += rng.normal(0.0, DAY_TO_DAY_SIGMA_C)
    humidity_pct = norm.humidity_pct - 10.0 * warmth + rng.normal(0.0, 6.0)
    wind_kmh = 12.0 * float(rng.weibull(2.0))
    rate = _rate(norm, solar_time, rng)
    haze, cloud = float(rng.uniform()), float(rng.normal(norm.humidity_pct - 15.0, 30.0))
    if rate > 0:
        code = _code_of_rate(rate, temperature_c)
        humidity_pct, cloud = max(humidity_pct, 88.0), 100.0
        visibility_m = typical_weather(code).visibility * (0.7 + 0.6 * haze)
    elif humidity_pct > FOG_FROM_PCT and wind_kmh < FOG_WIND_BELOW_KMH:
        code, cloud = 45 if temperature_c > 0 else 48, 100.0
        visibility_m = 30.0 * (0.9 * FOG_BELOW_M / 30.0) ** haze
    else:
        code = _step(CLOUD_STEPS, cloud)
        visibility_m = 8_000.0 + 16_000.0 * haze
    return Weather(
        temperature_2m=round(temperature_c, 1),
        relative_humidity_2m=round(min(max(humidity_pct, 10.0), 100.0)),
        precipitation=round(rate, 1 if rate >= 0.1 else 2),
        weather_code=code,
        cloud_cover=round(min(max(cloud, 0.0), 100.0)),
        visibility=round(visibility_m, -1),
        wind_speed_10m=round(wind_kmh, 1),
    )


def _rate(norm: ClimateNorm, time: datetime, rng: np.random.Generator) -> float:
    """Millimetres an hour; 0 in most hours, such that the month's total is the norm's on the average."""
    hours = 24 * calendar.monthrange(time.year, time.month)[1]
    temperatures, rates = zip(*RAIN_RATE_MM_PER_H, strict=True)
    mean_rate = float(np.interp(norm.temperature_c, temperatures, rates))
    share = min(norm.precipitation_mm / (hours * mean_rate), WET_AT_MOST)
    falls, amount = float(rng.uniform()) < share, float(rng.exponential())
    # A trace that would be rounded away still falls.
    return max(0.01, amount * norm.precipitation_mm / (hours * share)) if falls else 0.0


def _code_of_rate(rate: float, temperature_c: float) -> int:
    if temperature_c < SNOW_BELOW_C:
        return _step(SNOW_STEPS, rate * SNOW_CM_PER_MM)
    code = _step(RATE_STEPS, rate)
    return 95 if code == 65 and temperature_c >= THUNDER_FROM_C else code


def _step(steps: tuple[tuple[float, int], ...], value: float) -> int:
    return next(code for below, code in steps if value < below)


# --- asked of Open-Meteo ----------------------------------------------------------------------------------

FIELDS = tuple(field.name for field in fields(Weather))
_RANGES = {"relative_humidity_2m": (0.0, 100.0), "cloud_cover": (0.0, 100.0), "temperature_2m": (-100.0, 70.0)}


class OpenMeteo:
    """Asks Open-Meteo's forecast; whatever goes wrong, the fallback answers and the note says why.

    Args:
        fallback: answers instead.
        url: of the service.
        timeout_s: how long to wait for it, wall time."""

    def __init__(self, fallback: _WeatherSource, url: str = OPEN_METEO_URL, timeout_s: float = TIMEOUT_S) -> None:
        self._fallback = fallback
        self._url = url
        self._timeout_s = timeout_s

    def report(self, lon_deg: float, lat_deg: float, local_time: datetime) -> Report:
        hour = local_time.astimezone(UTC).replace(minute=0, second=0, microsecond=0, tzinfo=None)
        try:
            return Report(_weather(self._fetch(lon_deg, lat_deg, hour), hour), "Open-Meteo")
        except _UnusableError as error:
            instead = self._fallback.report(lon_deg, lat_deg, local_time)
            return Report(instead.weather, instead.source, f"Open-Meteo {error}; {instead.source} instead")

    def _fetch(self, lon_deg: float, lat_deg: float, hour: datetime) -> Any:
        day = hour.date().isoformat()
        query = urllib.parse.urlencode(
            {
                "latitude": f"{lat_deg:.4f}",
                "longitude": f"{lon_deg:.4f}",
                "hourly": ",".join(FIELDS),
                "wind_speed_unit": "kmh",
                "timezone": "UTC",
                "start_date": day,
                "end_date": day,
            }
        )
        try:
            with urllib.request.urlopen(f"{self._url}?{query}", timeout=self._timeout_s) as answer:
                return json.loads(answer.read(ANSWER_LIMIT_BYTES))
        except urllib.error.HTTPError as error:
            error.close()
            why = "its rate limit is reached" if error.code == 429 else error.reason
            raise _UnusableError(f"answers {error.code} ({why})") from error
        except TimeoutError as error:
            raise _UnusableError(f"does not answer within {self._timeout_s:g} s") from error
        except urllib.error.URLError as error:
            late = isinstance(error.reason, TimeoutError)
            why = f"does not answer within {self._timeout_s:g} s" if late else f"cannot be reached ({error.reason})"
            raise _UnusableError(why) from error
        except (OSError, http.client.HTTPException) as error:
            raise _UnusableError(f"breaks off ({error})") from error
        except (ValueError, RecursionError) as error:
            raise _UnusableError("answers with something that is not JSON") from error


class _UnusableError(Exception):
    """Why an answer cannot be used."""


def _weather(answer: Any, hour: datetime) -> Weather:
    hourly = answer.get("hourly") if isinstance(answer, dict) else None
    times = hourly.get("time") if isinstance(hourly, dict) else None
    wanted = hour.isoformat(timespec="minutes")
    if not isinstance(hourly, dict) or not isinstance(times, list) or wanted not in times:
        raise _UnusableError(f"has no hour {wanted}Z")
    index = times.index(wanted)
    values = {name: _value(hourly, name, index) for name in FIELDS}
    code = int(values.pop("weather_code"))
    if code not in WMO_WORDS:
        raise _UnusableError(f"has the unknown weather code {code}")
    return Weather(weather_code=code, **values)


def _value(hourly: dict[str, Any], name: str, index: int) -> float:
    column = hourly.get(name)
    value = column[index] if isinstance(column, list) and index < len(column) else None
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise _UnusableError(f"lacks {name}")
    low, high = _RANGES.get(name, (0.0, math.inf))
    if not low <= value <= high or math.isinf(value):
        raise _UnusableError(f"has {name} = {value}")
    return float(value)
