"""Degrees in metres, on a sphere as large as the earth."""

from __future__ import annotations

import math

METRES_PER_DEGREE = 111_320.0
"""Metres per degree of latitude, and of longitude at the equator."""


def metres_per_degree_east(lat_deg: float) -> float:
    """Metres per degree of longitude at a latitude; never quite zero, so division works at the poles."""
    return METRES_PER_DEGREE * max(math.cos(math.radians(lat_deg)), 1e-3)
