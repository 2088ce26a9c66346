"""The position of a network on earth: checks its location tag, or moves it elsewhere.

A ``<location>`` tag may name a projection that does not fit the network, because SUMO's tools write one without
checking. It is believed if the network's original coordinates (``origBoundary``) lie where the projection puts the
network and, for UTM, if that is inside the grid at all.

A projection may also be a code (``EPSG:2154``), which `sumo` looks up and libsumo 1.28 cannot (its wheel names a
database of another version). ``in_full`` writes it out, for both.
"""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Mapping
from dataclasses import replace

from pyproj import CRS, Proj, Transformer
from pyproj.exceptions import CRSError, ProjError
from pyproj.transformer import TransformerGroup

from automotive_cosim.contracts import RoadNetwork

UTM_EASTINGS_M = (100_000.0, 900_000.0)
"""A zone, six degrees wide, spans 166 to 834 km at the equator; SUMO lets networks reach into the next."""

STRETCHED = 0.05
"""Share by which no projection for a region changes a length; Mercator's of the whole earth does from 18° on."""

MARGIN_DEG, MARGIN_M = 0.1, 10_000.0
"""Edited networks may reach beyond their ``origBoundary``."""


TURNED = "+axis=neu"
"""PROJ's word for northings before eastings."""

OTHER_AXES = re.compile(r"\+axis=(?!en)")
"""PROJ's words for all but eastings before northings."""

HELMERT = re.compile(r"step (inv )?proj=helmert (.*?)(?= step|$)")
"""The change of datum in a pipeline of PROJ's."""

GEOCENTRIC = Transformer.from_pipeline(
    "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad +step +proj=cart +ellps=WGS84"
)
"""From degrees and height on WGS 84 to metres from the middle of the earth."""


def in_full(location: Mapping[str, str]) -> str:
    """The ``projParameter`` of a ``<location>`` as PROJ's string, with its change of datum; "!" if there is none.

    For codes that count northings first, netconvert 1.28 writes northings as x, which makes the network its own
    mirror image: the string then says so (``TURNED``), as PROJ's does of southings, and ``doubt`` tells.

    Raises ValueError: an attribute contains something other than numbers."""
    given = location.get("projParameter", "!")
    if given in ("!", "-") or given.startswith(("+", "proj=")):
        return given
    try:
        crs = CRS.from_user_input(given)
    except CRSError:
        return given
    if not crs.is_projected:
        return "!"
    with warnings.catch_warnings(action="ignore"):  # that names are lost
        text = crs.to_proj4().replace("+type=crs", "").strip()
    if OTHER_AXES.search(text):
        return text
    east_m, north_m = _middle_m(location)
    turned = crs.axis_info[0].direction == "north" and not _lies(crs, location, east_m, north_m)
    if turned:
        east_m, north_m = north_m, east_m
    return " ".join(filter(None, (text, _datum(crs, text, east_m, north_m), TURNED if turned else "")))


def _middle_m(location: Mapping[str, str]) -> tuple[float, float]:
    """The middle of a network in its projection."""
    x_min, y_min, x_max, y_max = map(float, location.get("convBoundary", "0,0,0,0").split(","))
    offset_x_m, offset_y_m = map(float, location.get("netOffset", "0,0").split(","))
    return (x_min + x_max) / 2 - offset_x_m, (y_min + y_max) / 2 - offset_y_m


def _lies(crs: CRS, location: Mapping[str, str], east_m: float, north_m: float) -> bool:
    """Whether the network can be there: where it was made from, or at least where the code is used."""
    made_from = _made_from(location)
    if not (made_from and _in_degrees(made_from)):
        made_from = (-180.0, -90.0, 180.0, 90.0) if crs.area_of_use is None else crs.area_of_use.bounds
    lon_deg, lat_deg = Proj(crs)(east_m, north_m, inverse=True)
    return _within(lon_deg, lat_deg, made_from, MARGIN_DEG)


def _made_from(location: Mapping[str, str]) -> tuple[float, ...]:
    """The original coordinates: west, south, east, north, in degrees or metres; empty without any."""
    try:
        numbers = tuple(float(number) for number in location.get("origBoundary", "").split(",") if number)
    except ValueError as error:
        raise ValueError("its origBoundary contains something other than numbers") from error
    return numbers if len(numbers) == 4 and numbers[0] <= numbers[2] else ()


def _in_degrees(bounds: tuple[float, ...]) -> bool:
    west, south, east, north = bounds
    return west >= -180 and east <= 180 and south >= -90 and north <= 90


def _datum(crs: CRS, text: str, east_m: float, north_m: float) -> str:
    """PROJ's ``+towgs84`` for the change of datum that ``sumo`` takes there itself; empty without one."""
    change = Transformer.from_crs(crs, "EPSG:4326", always_xy=True)
    try:
        lon_deg, lat_deg = change.transform(east_m, north_m, errcheck=True)
        taken = change.get_last_used_operation()
    except ProjError:
        return ""
    with warnings.catch_warnings(action="ignore"):  # that grids are missing
        known = TransformerGroup(crs, "EPSG:4326", always_xy=True).transformers
    # Of changes that are as good, PROJ takes that of the smaller area and the last by name; the PROJ 6.3 in
    # SUMO 1.28, that of the larger and the first.
    alike = [each for each in known if each.accuracy == taken.accuracy and _is_for(each, lon_deg, lat_deg)]
    taken = min(alike or [taken], key=lambda each: (-_size(each), each.description))
    found = HELMERT.search(taken.definition)
    if found is None:
        return ""
    values = dict(part.split("=", 1) for part in found[2].split() if "=" in part)
    moves = [float(values.get(key, 0)) for key in ("x", "y", "z", "rx", "ry", "rz", "s")]
    if values.get("convention") == "coordinate_frame":
        moves[3:6] = (-turn for turn in moves[3:6])
    if found[1]:
        moves = [-move for move in moves]

    def towgs84() -> str:
        return "+towgs84=" + ",".join(f"{move:.12g}" for move in moves)

    # A registry's change turns by small angles, +towgs84 exactly: 2 mm apart for 5514. Moved until both meet.
    there = GEOCENTRIC.transform(*taken.transform(east_m, north_m), 0.0)
    here = GEOCENTRIC.transform(*Proj(f"{text} {towgs84()}")(east_m, north_m, inverse=True), 0.0)
    moves[:3] = (move + to_m - from_m for move, to_m, from_m in zip(moves, there, here, strict=False))
    return towgs84()


def _is_for(change: Transformer, lon_deg: float, lat_deg: float) -> bool:
    """Whether a change of datum is meant for a place."""
    return change.area_of_use is not None and _within(lon_deg, lat_deg, change.area_of_use.bounds, 0.0)


def _size(change: Transformer) -> float:
    """Of its area, in square degrees."""
    west, south, east, north = (0.0,) * 4 if change.area_of_use is None else change.area_of_use.bounds
    return (east - west) * (north - south)


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
        ValueError: its original coordinates are no numbers."""
    if network.projection is None:
        return "has no projection"
    if OTHER_AXES.search(network.projection):
        return (
            f"has its axes the other way round (it is made with {location.get('projParameter')}, which does not "
            "count eastings first, and netconvert took what it counts for x: north is not up in it, or left is "
            "right; build it again with --proj.utm)"
        )
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
    there = Proj(network.projection).get_factors(lon_deg, lat_deg)
    metre_m = max(there.meridional_scale, there.parallel_scale, key=lambda scale: abs(math.log(scale)))
    if abs(metre_m - 1) > STRETCHED:
        return f"has a projection in which a metre is {metre_m:.2f} m long there (build it again with --proj.utm)"
    made_from = _made_from(location)
    if not made_from:
        return ""
    west, south, east, north = made_from
    if _in_degrees(made_from):
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
