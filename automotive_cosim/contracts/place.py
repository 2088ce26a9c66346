"""The car's surroundings: weather, position fix, link."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import Annotated

from annotated_types import Ge, Le

from automotive_cosim.contracts.driving import DrivingState


@dataclass(frozen=True, slots=True)
class Weather:
    """The weather at the car, in Open-Meteo's field names and units."""

    temperature_2m: Annotated[float, Ge(-100), Le(70)]
    """Degrees Celsius."""
    relative_humidity_2m: Annotated[float, Ge(0), Le(100)]
    """Per cent."""
    precipitation: Annotated[float, Ge(0)]
    """Millimetres per hour."""
    weather_code: Annotated[int, Ge(0), Le(99)]
    """WMO 4677."""
    cloud_cover: Annotated[float, Ge(0), Le(100)]
    """Per cent."""
    visibility: Annotated[float, Ge(0)]
    """Metres."""
    wind_speed_10m: Annotated[float, Ge(0)]
    """Kilometres per hour."""


@dataclass(frozen=True, slots=True)
class GpsFix:
    """What the receiver reports. Without a fix it repeats the last one, ageing."""

    has_fix: bool
    lon_deg: float
    lat_deg: float
    accuracy_m: float
    """One standard deviation of the horizontal error."""
    age_s: float
    """Seconds since the fix was taken."""
    heading_deg: float


@dataclass(frozen=True, slots=True)
class Connectivity:
    """The car's link to the outside world."""

    online: bool
    kind: str
    """``"none"``, ``"4g"`` or ``"5g"``."""
    signal_bars: int
    """0 to 4."""


@dataclass(frozen=True, slots=True)
class Surroundings:
    """Everything outside the cockpit at one instant, as the input of its sensors."""

    driving: DrivingState
    weather: Weather
    local_time: datetime
    """Zone-aware."""
    sun_elevation_deg: float | None
    """None if the position is unknown."""
    gps: GpsFix | None
    """None in a network without projection."""
    connectivity: Connectivity
    parked: bool = False
    """Whether the driver has parked on the way, as planned; False for a car that never sets off."""
    sign_unit: str = "km/h"
    """Unit of the speeds on the signs here: ``"km/h"`` or ``"mph"``."""
    sign_country: str = ""
    """ISO 3166-1 code of the country whose signs stand here; empty if unknown."""
