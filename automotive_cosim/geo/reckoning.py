"""Dead reckoning: the position while GPS is out, from the last fix, speed, compass and the map's roads."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from pyproj import Transformer
from shapely import LineString, Point, STRtree

from automotive_cosim.contracts import DrivingState, GpsFix, RoadNetwork
from automotive_cosim.geo.earth import METRES_PER_DEGREE, metres_per_degree_east

DRIFT = 0.05
"""Error without a map, as a share of the distance driven; our choice."""

DRIFT_ON_ROADS = 0.02
"""With a map, the odometer's error along the road remains."""

SEARCH_M = 40.0
"""How far from the computed position to look for roads."""

TURNED_DEG = 40.0
"""A road that deviates more from the compass is not the car's."""


class Reckonable(Protocol):
    """One instant as dead reckoning needs it; ``cosim.Moment`` is one."""

    @property
    def time_s(self) -> float: ...

    @property
    def driving(self) -> DrivingState:
        """Source of compass and speedometer, of the road ahead and of whether the car is in a tunnel."""
        ...

    @property
    def gps(self) -> GpsFix | None:
        """The receiver's last report."""
        ...


@dataclass(frozen=True, slots=True)
class Estimate:
    """A position by dead reckoning."""

    lon_deg: float
    lat_deg: float
    accuracy_m: float
    driven_m: float
    """Seconds since the last fix."""
    age_s: float


class Roads:
    """The map's roads, to which a computed position is moved."""

    def __init__(self, network: RoadNetwork) -> None:
        """Takes a network that has a projection."""
        assert network.projection is not None
        self._offset_m = network.offset_m
        self._onto_map = Transformer.from_crs("EPSG:4326", network.projection, always_xy=True)
        self._lines = {
            in_tunnel: [LineString(road.shape_m) for road in network.roads if road.in_tunnel == in_tunnel]
            for in_tunnel in (False, True)
        }
        self._trees = {in_tunnel: STRtree(lines) for in_tunnel, lines in self._lines.items()}

    def nearest(
        self, lon_deg: float, lat_deg: float, heading_deg: float, *, in_tunnel: bool
    ) -> tuple[float, float]:
        """The position moved sideways onto the nearest road in the car's direction, if there is one."""
        x, y = self._onto_map.transform(lon_deg, lat_deg)
        here = Point(x + self._offset_m[0], y + self._offset_m[1])
        found: tuple[float, Point] | None = None
        for index in self._trees[in_tunnel].query(here.buffer(SEARCH_M)):
            line = self._lines[in_tunnel][index]
            along_m = line.project(here)
            foot = line.interpolate(along_m)
            off_m = foot.distance(here)
            on_line = 0.0 < along_m < line.length
            turned = abs((_heading_deg(line, along_m) - heading_deg + 180.0) % 360.0 - 180.0)
            if on_line and turned <= TURNED_DEG and off_m <= SEARCH_M and (found is None or off_m < found[0]):
                found = (off_m, foot)
        if found is None:
            return lon_deg, lat_deg
        foot = found[1]
        lon, lat = self._onto_map.transform(
            foot.x - self._offset_m[0], foot.y - self._offset_m[1], direction="INVERSE"
        )
        return float(lon), float(lat)


def reckon(drive: Sequence[Reckonable], roads: Roads | None = None) -> Estimate | None:
    """The position computed from the last fix, compass and speed. None without a receiver.

    A drive without any fix starts from the position that the receiver remembers at its first instant. With a fix,
    the position is the fix, and the accumulated error is gone at once.

    Args:
        drive: the drive in chronological order, back to the last fix; at least one instant.
        roads: the map; with it, the position is kept on roads in the car's direction."""
    if drive[-1].gps is None:
        return None
    start = next((index for index in reversed(range(len(drive))) if _has_fix(drive[index])), 0)
    fix = drive[start].gps
    assert fix is not None
    lon_deg, lat_deg, driven_m = fix.lon_deg, fix.lat_deg, 0.0
    for before, after in zip(drive[start:], drive[start + 1 :], strict=False):
        way_m = (before.driving.speed_mps + after.driving.speed_mps) / 2 * (after.time_s - before.time_s)
        heading_deg = _between(before.driving.heading_deg, after.driving.heading_deg)
        lon_deg += way_m * math.sin(math.radians(heading_deg)) / metres_per_degree_east(fix.lat_deg)
        lat_deg += way_m * math.cos(math.radians(heading_deg)) / METRES_PER_DEGREE
        driven_m += way_m
        if roads is not None and way_m > 0.0:
            in_tunnel = after.driving.road.in_tunnel
            lon_deg, lat_deg = roads.nearest(lon_deg, lat_deg, heading_deg, in_tunnel=in_tunnel)
    return Estimate(
        lon_deg=(lon_deg + 180.0) % 360.0 - 180.0,
        lat_deg=max(-90.0, min(90.0, lat_deg)),
        accuracy_m=fix.accuracy_m + (DRIFT if roads is None else DRIFT_ON_ROADS) * driven_m,
        driven_m=driven_m,
        age_s=drive[-1].time_s - drive[start].time_s + fix.age_s,
    )


def _heading_deg(line: LineString, along_m: float) -> float:
    """Direction of a line at a distance from its start, clockwise from north."""
    before, after = line.interpolate(max(0.0, along_m - 1.0)), line.interpolate(min(line.length, along_m + 1.0))
    return float(np.degrees(np.arctan2(after.x - before.x, after.y - before.y)))


def _has_fix(known: Reckonable) -> bool:
    return known.gps is not None and known.gps.has_fix


def _between(first_deg: float, second_deg: float) -> float:
    """The middle of two headings, by the shorter way round."""
    return first_deg + ((second_deg - first_deg + 180.0) % 360.0 - 180.0) / 2
