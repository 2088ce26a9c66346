"""Water, green and buildings of a map, as polygons that SUMO reads: for pictures, nothing else uses them.

An extract has far more of them than a picture shows. Those of a kind that touch are merged (a block of terraced
houses is one), made coarse, cut to the network's surroundings, and the smallest are left out.
"""

from __future__ import annotations

import gzip
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely
from pyproj import Proj
from shapely import Polygon

from automotive_cosim.contracts import GroundArea, GroundKind, RoadNetwork
from automotive_cosim.formats.writing import write_whole

TAGS: Mapping[GroundKind, Mapping[str, frozenset[str]]] = {
    GroundKind.WATER: {
        "natural": frozenset(("water", "bay", "strait")),
        "waterway": frozenset(("riverbank", "dock")),
        "landuse": frozenset(("reservoir", "basin")),
    },
    GroundKind.GREEN: {
        "natural": frozenset(("wood", "scrub", "grassland", "heath")),
        "leisure": frozenset(("park", "garden", "golf_course", "pitch", "common")),
        "landuse": frozenset(
            ("forest", "grass", "meadow", "recreation_ground", "village_green", "cemetery", "orchard", "vineyard",
             "allotments")
        ),
    },
}  # fmt: skip
"""Tags of the areas; every ``building`` but ``no`` is one too."""

KEYS = ("natural", "waterway", "landuse", "leisure", "building")

MARGIN_M = 300.0
"""So far beyond the network, areas are kept."""


Ring = Sequence[tuple[float, float]]
"""Longitude and latitude of corners, the first again at the end."""


@dataclass(frozen=True, slots=True)
class Coarseness:
    """How the areas of a kind are made simpler, and how many are kept."""

    gap_m: float
    """Areas that are this close are merged."""
    bend_m: float
    """Corners that deviate less are removed."""
    least_m2: float
    """Smaller areas, and smaller holes in them, are left out."""
    most: int
    """Of more areas the largest are kept."""


COARSE: Mapping[GroundKind, Coarseness] = {
    GroundKind.WATER: Coarseness(0.0, 2.0, 200.0, 1000),
    GroundKind.GREEN: Coarseness(1.0, 2.5, 300.0, 2000),
    GroundKind.BUILDING: Coarseness(1.0, 1.5, 60.0, 6000),
}

COLOURS = {GroundKind.WATER: "165,208,236", GroundKind.GREEN: "201,228,197", GroundKind.BUILDING: "218,223,230"}
"""In sumo-gui."""
LAYERS = {GroundKind.GREEN: -5, GroundKind.WATER: -4, GroundKind.BUILDING: -3}


@dataclass(frozen=True, slots=True)
class MappedArea:
    """An area of the map."""

    kind: GroundKind
    shape: Polygon
    """Longitude and latitude."""

    @classmethod
    def of(cls, kind: GroundKind, outer: Ring, holes: Iterable[Ring] = ()) -> MappedArea:
        """From its rings, wherever and which way round they begin."""
        shape = Polygon(outer, list(holes)).normalize()
        assert isinstance(shape, Polygon)
        return cls(kind, shape)


def in_order(areas: Iterable[MappedArea]) -> tuple[MappedArea, ...]:
    """Always in the same order, however a file has them."""
    return tuple(sorted(areas, key=lambda area: (area.kind, area.shape.wkb)))


def kind_of(tags: Mapping[str, str]) -> GroundKind | None:
    """What an area with such tags is; None if no picture shows it, as a covered reservoir."""
    if tags.get("tunnel", "no") != "no" or tags.get("location") == "underground":
        return None
    if tags.get("building", "no") != "no":
        return GroundKind.BUILDING
    return next(
        (kind for kind, keys in TAGS.items() if any(tags.get(key) in values for key, values in keys.items())), None
    )


@dataclass(frozen=True, slots=True)
class DrawnGround:
    """The ground of a network."""

    areas: tuple[GroundArea, ...]
    too_many: int = 0
    """Areas beyond the largest that are kept."""

    def count(self, kind: GroundKind) -> int:
        return sum(area.kind is kind for area in self.areas)


def draw(areas: Sequence[MappedArea], network: RoadNetwork) -> DrawnGround:
    """The ground around a network, in its metres; nothing if it has no projection."""
    if network.projection is None or not areas:
        return DrawnGround(())
    proj, offset_m = Proj(network.projection), np.array(network.offset_m)

    def to_metres(lon_lat: np.ndarray) -> np.ndarray:
        return np.asarray(np.stack(proj(lon_lat[:, 0], lon_lat[:, 1]), axis=1) + offset_m)

    x_min, y_min, x_max, y_max = network.bounds_m
    bounds_m = (x_min - MARGIN_M, y_min - MARGIN_M, x_max + MARGIN_M, y_max + MARGIN_M)
    found: list[GroundArea] = []
    too_many = 0
    for kind in GroundKind:
        shapes = np.array([area.shape for area in areas if area.kind is kind], dtype=object)
        merged = _coarse(shapely.transform(shapes, to_metres), bounds_m, COARSE[kind])
        too_many += max(0, len(merged) - COARSE[kind].most)
        for shape in merged[: COARSE[kind].most]:
            outline = np.round(shapely.get_coordinates(shape.exterior)[:-1], 1).tolist()
            found.append(GroundArea(kind, tuple((x_m, y_m) for x_m, y_m in outline)))
    return DrawnGround(tuple(found), too_many)


def write(areas: Iterable[GroundArea], target: Path) -> None:
    """Writes them as an additional file of SUMO's, gzipped; the same areas give the same bytes."""
    rows = (
        f'    <poly id="{area.kind}{number}" type="{area.kind}" color="{COLOURS[area.kind]}" fill="true"'
        f' layer="{LAYERS[area.kind]}" shape="{_shape(area)}"/>\n'
        for number, area in enumerate(areas)
    )
    write_whole(target, gzip.compress(f"<additional>\n{''.join(rows)}</additional>\n".encode(), mtime=0))


def _shape(area: GroundArea) -> str:
    return " ".join(f"{x_m:.1f},{y_m:.1f}" for x_m, y_m in area.outline_m)


def _coarse(shapes: np.ndarray, bounds_m: tuple[float, float, float, float], coarse: Coarseness) -> list[Polygon]:
    """The shapes merged and simplified, without holes, the largest first."""
    clipped = shapely.clip_by_rect(shapely.make_valid(shapes), *bounds_m)
    near = shapely.buffer(clipped, coarse.gap_m, join_style="mitre") if coarse.gap_m else clipped
    merged = shapely.buffer(shapely.union_all(near), -coarse.gap_m, join_style="mitre")
    simple = shapely.buffer(shapely.simplify(merged, coarse.bend_m), 0.0)
    solid = [
        part for shape in _polygons(simple, coarse.least_m2) for part in _without_holes(shape, coarse.least_m2)
    ]
    return sorted(solid, key=lambda shape: (-round(shape.area, 1), shape.bounds))


def _polygons(shape: shapely.Geometry, least_m2: float) -> Iterator[Polygon]:
    for part in shapely.get_parts(shape):
        if isinstance(part, Polygon) and part.area >= least_m2:
            yield part


def _without_holes(shape: Polygon, least_m2: float) -> Iterator[Polygon]:
    """The polygon cut up so that no part has a hole: SUMO's polygons have none. Small holes are filled."""
    holes = [hole for hole in shape.interiors if Polygon(hole).area >= least_m2]
    if not holes:
        yield Polygon(shape.exterior)
        return
    x_min, y_min, x_max, y_max = shape.bounds
    x_m = holes[0].centroid.x
    rest = Polygon(shape.exterior, holes)
    for box in ((x_min, y_min, x_m, y_max), (x_m, y_min, x_max, y_max)):
        for part in _polygons(shapely.clip_by_rect(rest, *box), 0.0):
            yield from _without_holes(part, least_m2)
