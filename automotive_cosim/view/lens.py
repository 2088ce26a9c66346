"""The camera: from metres in the network to pixels of the picture, and from a pixel of the road back to metres.

Everything on the way is addition, multiplication and division of single numbers, and pixels are rounded, so that
the picture is the same on every machine.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

WIDTH, HEIGHT = 640, 360
"""Pixels of the picture."""
FINE = 2
"""How many times as large the picture is painted."""
NEAR_M = 0.4
"""What is nearer to the lens is cut off."""

XY = tuple[float, float]
FromLens = tuple[float, float, float]
"""Metres to the right of the lens, ahead of it, and above the road."""
Corners = npt.NDArray[np.float64]


@lru_cache(maxsize=16)
def _turn(heading_deg: float) -> tuple[float, float]:
    angle = math.radians(heading_deg)
    return math.sin(angle), math.cos(angle)


@dataclass(frozen=True, slots=True)
class Lens:
    """A camera over a flat road, looking straight ahead and level."""

    x_m: float
    y_m: float
    """Network coordinates."""
    heading_deg: float
    """Clockwise from north."""
    up_m: float
    """Height above the road."""
    focal: float
    """Focal length in widths of the picture: what is as wide as it is far away takes this share of the width."""
    horizon: float
    """Height of the horizon, as a share of the picture's from its upper edge."""
    mirrored: bool = False
    """Whether left and right change places, as behind a car."""

    def sees(self, x_m: float, y_m: float, up_m: float = 0.0) -> FromLens:
        """Where a point of the network is from here."""
        east, north = _turn(self.heading_deg)
        dx, dy = x_m - self.x_m, y_m - self.y_m
        right = dx * north - dy * east
        return (-right if self.mirrored else right), dx * east + dy * north, up_m

    def all(self, points_m: Corners) -> tuple[Corners, Corners]:
        """The same of many points on the road: to the right, and ahead."""
        east, north = _turn(self.heading_deg)
        dx, dy = points_m[:, 0] - self.x_m, points_m[:, 1] - self.y_m
        right = dx * north - dy * east
        return (-right if self.mirrored else right), dx * east + dy * north

    def pixel(self, seen: FromLens, fine: int = 1) -> tuple[int, int]:
        """The pixel of a point that is ahead.

        Args:
            seen: metres, at least ``NEAR_M`` ahead.
            fine: how many times as large the picture is."""
        right, ahead, up = seen
        scale = self.focal * WIDTH * fine / ahead
        across = WIDTH * fine / 2 + right * scale
        down = self.horizon * HEIGHT * fine + (self.up_m - up) * scale
        return round(across), round(down)

    def pixels(self, right: Corners, ahead: Corners) -> list[tuple[int, int]]:
        """The pixels of many points on the road in the picture as it is painted; those not ahead anywhere."""
        scale = self.focal * WIDTH * FINE / np.maximum(ahead, NEAR_M)
        across = np.rint(WIDTH * FINE / 2 + right * scale).astype(np.int64)
        down = np.rint(self.horizon * HEIGHT * FINE + self.up_m * scale).astype(np.int64)
        return list(zip(across.tolist(), down.tolist(), strict=True))

    def shape(self, corners: Iterable[FromLens], fine: int = 1) -> list[tuple[int, int]]:
        """The pixels of a plane face, without what is too near; empty if nothing is left of it."""
        kept = clipped(list(corners))
        return [self.pixel(corner, fine) for corner in kept]

    def on_road(self, across_px: float, down_px: float) -> XY:
        """The point of the road, in the network, that a pixel below the horizon shows."""
        scale = (down_px - self.horizon * HEIGHT) / self.up_m
        ahead, right = self.focal * WIDTH / scale, (across_px - WIDTH / 2) / scale
        right = -right if self.mirrored else right
        east, north = _turn(self.heading_deg)
        return self.x_m + ahead * east + right * north, self.y_m + ahead * north - right * east


def clipped(corners: Sequence[FromLens]) -> list[FromLens]:
    """A polygon without what is nearer than ``NEAR_M``."""
    if all(corner[1] >= NEAR_M for corner in corners):
        return list(corners)
    kept: list[FromLens] = []
    for at, here in enumerate(corners):
        before = corners[at - 1]
        if (here[1] >= NEAR_M) != (before[1] >= NEAR_M):
            share = (NEAR_M - before[1]) / (here[1] - before[1])
            kept.append(
                (before[0] + share * (here[0] - before[0]), NEAR_M, before[2] + share * (here[2] - before[2]))
            )
        if here[1] >= NEAR_M:
            kept.append(here)
    return kept
