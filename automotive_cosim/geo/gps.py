"""A GPS receiver: accurate to a few metres, and without a fix in tunnels."""

from __future__ import annotations

import math
from copy import deepcopy
from dataclasses import replace

import numpy as np

from automotive_cosim.contracts import STANDING_BELOW_MPS, DrivingState, GpsFix
from automotive_cosim.geo.earth import METRES_PER_DEGREE, metres_per_degree_east

OPEN_SKY_SIGMA_M = 2.0
"""Error per axis: 95 % of positions within 4.9 m, the radius GPS.gov gives for phones under open sky (van Diggelen
and Enge, ION GNSS+ 2015)."""
BUILT_UP_SIGMA_M = 4.0
"""Error between buildings, where reflected signals about double it; our choice."""
CANYON_SIGMA_M = 8.0
"""Error in built-up streets with one lane per direction, where houses hide most of the sky; our choice, at the
lower end of what is reported from narrow streets (Groves, "Shadow Matching", Journal of Navigation 64, 2011)."""
CORRELATION_S = 30.0
"""Time constant of the error, a first-order Gauss-Markov process; our choice, the order of multipath."""
REACQUIRE_S = 2.0
"""Sky needed after a tunnel before there is a fix again (receivers' data sheets give 1 to 2 s)."""
CROSS_SPEED_SIGMA_MPS = 0.05
"""Lateral error of the Doppler velocity, which causes that of the heading (receivers' data sheets)."""
HEADING_FROM_MPS = 1.0
"""Slower than this the receiver keeps its last heading."""
UNDERGROUND_SIGMA_M = 50.0
"""Accuracy claimed for a drive that begins in a tunnel: remembered from before, not measured."""


class Gps:
    """One receiver on one drive, read in chronological order; the same generator state gives the same fixes.

    Args:
        rng: source of its noise; three normal draws per reading, with or without a fix.
        is_steady: whether its error stays the same while the car stands, as that of receivers with a static hold,
            and comes over ``CORRELATION_S`` to that of other surroundings. Otherwise a parked car seems to move."""

    def __init__(self, rng: np.random.Generator, *, is_steady: bool = False) -> None:
        self._rng = rng
        self._is_steady = is_steady
        self._sigma_m: float | None = None
        self._error_east, self._error_north = (float(error) for error in rng.standard_normal(2))
        self._last: GpsFix | None = None
        self._sky_s = REACQUIRE_S

    def read(self, driving: DrivingState, dt_s: float) -> GpsFix | None:
        """The position as the receiver reports it.

        Args:
            driving: the true position of the car.
            dt_s: seconds since the previous reading.

        Returns:
            None in a network without projection. Without a fix the last position, ``dt_s`` older."""
        if driving.lon_deg is None or driving.lat_deg is None:
            return None
        stands = driving.speed_mps < STANDING_BELOW_MPS
        heading_error = self._wander(0.0 if self._is_steady and stands else dt_s)
        self._sky_s = 0.0 if driving.road.in_tunnel else self._sky_s + dt_s
        if self._sky_s >= REACQUIRE_S:
            self._last = self._fix(driving, driving.lon_deg, driving.lat_deg, heading_error, dt_s)
        elif self._last is None:
            self._last = GpsFix(
                False, driving.lon_deg, driving.lat_deg, UNDERGROUND_SIGMA_M, 0.0, driving.heading_deg
            )
        else:
            self._last = replace(self._last, has_fix=False, age_s=self._last.age_s + dt_s)
        return self._last

    def copy(self) -> Gps:
        """A receiver that continues exactly as this one would."""
        return deepcopy(self)

    def _wander(self, dt_s: float) -> float:
        """Advances the unit-variance error, and returns a new unit draw for the heading."""
        kept = math.exp(-dt_s / CORRELATION_S)
        fresh = math.sqrt(1.0 - kept * kept)
        east, north, heading = (float(draw) for draw in self._rng.standard_normal(3))
        self._error_east = kept * self._error_east + fresh * east
        self._error_north = kept * self._error_north + fresh * north
        return heading

    def _fix(
        self, driving: DrivingState, lon_deg: float, lat_deg: float, heading_error: float, dt_s: float
    ) -> GpsFix:
        sigma_m = OPEN_SKY_SIGMA_M
        if driving.road.built_up:
            sigma_m = CANYON_SIGMA_M if driving.road.lane_count == 1 else BUILT_UP_SIGMA_M
        if self._is_steady and self._sigma_m is not None:
            sigma_m += (self._sigma_m - sigma_m) * math.exp(-dt_s / CORRELATION_S)
        self._sigma_m = sigma_m
        lon = lon_deg + self._error_east * sigma_m / metres_per_degree_east(lat_deg)
        lat = lat_deg + self._error_north * sigma_m / METRES_PER_DEGREE
        return GpsFix(
            has_fix=True,
            lon_deg=(lon + 180.0) % 360.0 - 180.0,
            lat_deg=max(-90.0, min(90.0, lat)),
            accuracy_m=sigma_m * math.sqrt(2.0),
            age_s=0.0,
            heading_deg=self._heading(driving, heading_error),
        )

    def _heading(self, driving: DrivingState, heading_error: float) -> float:
        if driving.speed_mps < HEADING_FROM_MPS:
            return self._last.heading_deg if self._last else driving.heading_deg
        off_deg = math.degrees(math.atan2(heading_error * CROSS_SPEED_SIGMA_MPS, driving.speed_mps))
        return (driving.heading_deg + off_deg) % 360.0
