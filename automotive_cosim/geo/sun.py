"""The position of the sun, how dark it is, and whether it dazzles the driver."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum
from functools import lru_cache

from astral import Observer
from astral.sun import elevation, zenith_and_azimuth

SUNSET_DEG = -0.833
"""Elevation of the sun's centre at sunrise and sunset: refraction and radius (US Naval Observatory)."""

LOW_SUN_BELOW_DEG = 20.0
AHEAD_WITHIN_DEG = 30.0
"""The sun dazzles below the first elevation and within the second angle of the direction of travel: our choice,
roughly the field between sun visor and dashboard."""


class Darkness(StrEnum):
    """Darkness by the sun's elevation; the twilights end at 6, 12 and 18 degrees below the horizon."""

    DAY = "day"
    CIVIL_TWILIGHT = "civil twilight"
    NAUTICAL_TWILIGHT = "nautical twilight"
    ASTRONOMICAL_TWILIGHT = "astronomical twilight"
    NIGHT = "night"

    @classmethod
    def at(cls, elevation_deg: float) -> Darkness:
        """How dark the sky is with the sun's centre at an elevation."""
        for from_deg, darkness in _DARKNESS_FROM_DEG:  # a generator takes twice as long
            if elevation_deg > from_deg:
                return darkness
        return cls.NIGHT


_DARKNESS_FROM_DEG = (
    (0.0, Darkness.DAY),
    (-6.0, Darkness.CIVIL_TWILIGHT),
    (-12.0, Darkness.NAUTICAL_TWILIGHT),
    (-18.0, Darkness.ASTRONOMICAL_TWILIGHT),
)


@dataclass(frozen=True, slots=True)
class Sun:
    """The sun over one place at one instant."""

    elevation_deg: float
    """Elevation of its centre above the horizon, without refraction."""
    azimuth_deg: float
    """Azimuth, clockwise from north."""

    @property
    def darkness(self) -> Darkness:
        """How dark the sky is."""
        return Darkness.at(self.elevation_deg)

    @property
    def is_set(self) -> bool:
        """Whether it is between sunset and sunrise."""
        return self.elevation_deg < SUNSET_DEG

    def off_heading_deg(self, heading_deg: float) -> float:
        """Angle from the direction of travel to the sun, -180 to 180, positive to the right."""
        return (self.azimuth_deg - heading_deg + 180.0) % 360.0 - 180.0

    def glares(self, heading_deg: float) -> bool:
        """Whether it is low and ahead; clouds are ignored."""
        low = not self.is_set and self.elevation_deg < LOW_SUN_BELOW_DEG
        return low and abs(self.off_heading_deg(heading_deg)) <= AHEAD_WITHIN_DEG


@lru_cache(maxsize=256)
def elevation_deg(lat_deg: float, lon_deg: float, time: datetime) -> float:
    """Elevation of the sun's centre above the horizon without refraction; ``time`` is zone-aware."""
    return float(elevation(Observer(lat_deg, lon_deg), time, with_refraction=False))


def sun_at(lon_deg: float, lat_deg: float, time: datetime) -> Sun:
    """The sun over a place.

    Works at the poles and through polar night, where there is no sunrise to compute.

    Args:
        lon_deg: WGS 84.
        lat_deg: WGS 84.
        time: zone-aware."""
    zenith_deg, azimuth_deg = zenith_and_azimuth(Observer(lat_deg, lon_deg), time, with_refraction=False)
    return Sun(float(90.0 - zenith_deg), float(azimuth_deg))
