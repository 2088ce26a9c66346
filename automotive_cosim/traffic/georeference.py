"""The position of a network on earth: checks its location tag, or moves it elsewhere.

A ``<location>`` tag may name a projection that does not fit the network, because SUMO's tools write one without
checking. It is believed if the network's original coordinates (``origBoundary``) lie where the projection puts the
network and, for UTM, if that is inside the grid at all.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from pyproj import Proj
from pyproj.exceptions import CRSError

from automotive_cosim.contracts import RoadNetwork

UTM_EASTINGS_M = (100_000.0, 900_000.0)
"""A zone, six degrees wide, spans 166 to 834 km at the equator; SUMO lets networks reach into the next."""

MARGIN_DEG, MARGIN_M = 0.1, 10_000.0
"""Edited networks may reach beyond their ``origBoundary``."""


class GeoReference:
    """Converts between a network's metres and WGS 84."""

    def __init__(self, network: RoadNetwork) -> None:
        """Uses the projection of a network that has one."""
        assert network.projection is not None
        self._proj = Proj(network.projection)
        self._offset_x_m, self._offset_y_m = network.offset_m

    def lon_lat(self, x_m: float, y_m: float) -> tuple[float, float]:
        """Longitude and latitude in degrees."""
        lon_deg, lat_deg = self._proj(x_m - self._offset_x_m, y_m - self._offset_y_m, inverse=True)
        return float(lon_deg), float(lat_deg)

    def x_y(self, lon_deg: float, lat_deg: float) -> tuple[float, float]:
        """Metres in the network's coordinates."""
        x_m, y_m = self._proj(lon_deg, lat_deg)
        return float(x_m) + self._offset_x_m, float(y_m) + self._offset_y_m


def moved(network: RoadNetwork, origin: tuple[float, float]) -> RoadNetwork:
    """The same metres with the network's middle at ``origin`` (longitude, latitude), by a Mercator across it."""
    x_min, y_min, x_max, y_max = network.bounds_m
    lon_deg, lat_deg = origin
    projection = f"+proj=tmerc +lat_0={lat_deg!r} +lon_0={lon_deg!r} +k=1 +ellps=WGS84 +units=m +no_defs"
    return replace(network, projection=projection, offset_m=((x_min + x_max) / 2, (y_min + y_max) / 2))


def middle(network: RoadNetwork) -> tuple[float, float]:
    """Longitude and latitude of the middle of a network that has a projection."""
    x_min, y_min, x_max, y_max = network.bounds_m
    return GeoReference(network).lon_lat((x_min + x_max) / 2, (y_min + y_max) / 2)


def doubt(network: RoadNetwork, location: Mapping[str, str]) -> str:
    """Why the projection of a network is not believed; empty if it is.

    Args:
        network: the network as in its file.
        location: the attributes of its ``<location>``.

    Raises:
        ValueError: its original coordinates are no numbers.
    """
    if network.projection is None:
        return "has no projection"
    try:
        lon_deg, lat_deg = middle(network)
    except CRSError:
        return f"has an invalid projection ({network.projection!r})"
    x_min, y_min, x_max, y_max = network.bounds_m
    east_m = (x_min + x_max) / 2 - network.offset_m[0]
    north_m = (y_min + y_max) / 2 - network.offset_m[1]
    if not (math.isfinite(lon_deg) and math.isfinite(lat_deg)):
        return "has a projection that puts it outside the earth"
    if "+proj=utm" in network.projection and not UTM_EASTINGS_M[0] <= east_m <= UTM_EASTINGS_M[1]:
        return f"has a projection that puts it at an easting of {east_m:.0f} m, outside every UTM zone"
    try:
        made_from = tuple(float(number) for number in location.get("origBoundary", "").split(",") if number)
    except ValueError as error:
        raise ValueError("its origBoundary contains something other than numbers") from error
    if len(made_from) != 4 or made_from[0] > made_from[2]:
        return ""
    west, south, east, north = made_from
    if west >= -180 and east <= 180 and south >= -90 and north <= 90:
        fits = _within(lon_deg, lat_deg, made_from, MARGIN_DEG)
    else:
        fits = _within(east_m, north_m, made_from, MARGIN_M)
    if fits:
        return ""
    return (
        f"has a projection that contradicts its coordinates (it says {lon_deg:.4f},{lat_deg:.4f}, but was made "
        f"from {west:g},{south:g} to {east:g},{north:g})"
    )


def _within(x: float, y: float, bounds: tuple[float, ...], margin: float) -> bool:
    west, south, east, north = bounds
    return west - margin <= x <= east + margin and south - margin <= y <= north + margin
