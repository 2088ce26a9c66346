"""Rivers, lakes and the sea where an extract cuts them: their shores cross it and no outline closes.

The shores part the extract's box into faces, which are water and land in turn. The roads tell which is which: they
are on land, but for bridges. What parts nothing, as a lake of which a piece of the shore is missing, is closed by
straight lines.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
from shapely import (
    LineString,
    MultiLineString,
    Polygon,
    box,
    get_num_geometries,
    get_parts,
    line_merge,
    make_valid,
    polygonize,
    union_all,
)
from shapely.geometry.base import BaseGeometry

BRIDGES_SHARE = 0.1
"""At most this share of the roads is over water; otherwise it is not clear which side is water."""

MARGINS = (0.0, 0.01, 0.03, 0.06)
"""Shares of the nodes that the box may leave out on each side: roads reach farther than shores are known."""

RIM_DEG = 1e-9

Shore = Sequence[tuple[float, float]]
"""Longitude and latitude."""


def cut_water(shores: Iterable[Shore], roads: Sequence[Shore]) -> list[Polygon]:
    """The water between shores that leave the map; nothing where they do not tell.

    Args:
        shores: the pieces that are known of the shores of one water, islands included.
    """
    known = union_all([LineString(line) for line in shores if len(line) > 1])
    if known.is_empty or not roads:
        return []
    ways = MultiLineString([LineString(line) for line in roads])
    nodes = np.array([point for line in roads for point in line])
    for margin in MARGINS:
        west, south = np.quantile(nodes, margin, axis=0).tolist()
        east, north = np.quantile(nodes, 1 - margin, axis=0).tolist()
        water = _water(known, ways, box(west, south, east, north))
        if water:
            return water
    return []


def _water(shores: BaseGeometry, roads: MultiLineString, frame: Polygon) -> list[Polygon]:
    lines = union_all([shores.intersection(frame), frame.exterior])
    faces = [face for face in polygonize([lines]).geoms if isinstance(face, Polygon)]
    if len(faces) < 2:
        return []
    banks = union_all([face.boundary for face in faces]).difference(frame.exterior.buffer(RIM_DEG))
    here = faces[0].representative_point()
    sides: tuple[list[Polygon], list[Polygon]] = ([], [])
    for face in faces:
        crossed = LineString([here, face.representative_point()]).intersection(banks)
        sides[get_num_geometries(crossed) % 2 if not crossed.is_empty else 0].append(face)
    roads_on = [roads.intersection(union_all(side)).length for side in sides]
    wet = int(np.argmin(roads_on))
    return sides[wet] if roads_on[wet] <= BRIDGES_SHARE * sum(roads_on) else []


def closed_water(outer: Iterable[Shore], inner: Iterable[Shore], roads: Sequence[Shore]) -> list[Polygon]:
    """The water within shores of which pieces are missing: each stretch that is known is closed by a straight line;
    nothing where more road would lie on it than a bridge.
    """
    ways = MultiLineString([LineString(line) for line in roads])
    islands = union_all(_filled(inner))
    filled = [shape for shape in _filled(outer) if ways.intersection(shape).length <= math.sqrt(shape.area)]
    parts = [get_parts(shape.difference(islands)) for shape in filled]
    return [part for each in parts for part in each if isinstance(part, Polygon)]


def _filled(shores: Iterable[Shore]) -> list[BaseGeometry]:
    lines = line_merge(MultiLineString([LineString(line) for line in shores if len(line) > 1]))
    stretches = [part.coords for part in get_parts(lines) if isinstance(part, LineString)]
    return [make_valid(Polygon(stretch)) for stretch in stretches if len(stretch) > 2]
