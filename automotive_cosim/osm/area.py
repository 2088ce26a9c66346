"""An area between two meridians and two parallels."""

from __future__ import annotations

import math
from typing import NamedTuple

from automotive_cosim.errors import UserError

KM_PER_DEG = 111.2
"""Metres per degree of latitude, on a sphere as large as the earth."""


class Area(NamedTuple):
    """Degrees, in the order that GeoJSON and osmium use."""

    west_deg: float
    south_deg: float
    east_deg: float
    north_deg: float

    @staticmethod
    def parse(text: str) -> Area:
        """Reads ``WEST,SOUTH,EAST,NORTH``. Raises UserError: it is not such an area, or is empty."""
        try:
            west_deg, south_deg, east_deg, north_deg = (float(part) for part in text.split(","))
        except ValueError:
            west_deg = south_deg = east_deg = north_deg = math.nan
        if -180 <= east_deg < west_deg <= 180:
            raise UserError(
                f"--bbox {text!r} reaches over the 180th meridian, which no SUMO network can; give one side: "
                f"{west_deg:g},{south_deg:g},180,{north_deg:g} or -180,{south_deg:g},{east_deg:g},{north_deg:g}"
            )
        if not (-180 <= west_deg < east_deg <= 180 and -90 <= south_deg < north_deg <= 90):
            raise UserError(
                f"--bbox {text!r} is not an area on earth; give WEST,SOUTH,EAST,NORTH in degrees, such as "
                "2.28,48.86,2.31,48.88"
            )
        return Area(west_deg, south_deg, east_deg, north_deg)

    def holds(self, lon_deg: float, lat_deg: float) -> bool:
        """Whether a position lies within."""
        return self.west_deg <= lon_deg <= self.east_deg and self.south_deg <= lat_deg <= self.north_deg

    @property
    def size_km2(self) -> float:
        """Its approximate surface."""
        wide = math.cos(math.radians((self.south_deg + self.north_deg) / 2))
        return (self.north_deg - self.south_deg) * (self.east_deg - self.west_deg) * wide * KM_PER_DEG * KM_PER_DEG
