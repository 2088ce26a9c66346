"""Town and country by the density of the streets, for roads whose tags do not tell."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping

from automotive_cosim.osm.extract import Extract, Node, OsmWay, Position

CELL_DEG = 0.0025
"""Side of the cells in which town streets are counted, in degrees of latitude (about 280 m)."""

TOWN_NODES = 12
"""Minimum number of nodes of town streets in a cell and its eight neighbours for a built-up area."""

TOWN_STREETS = frozenset(("residential", "living_street"))


def _cell(position: Position) -> tuple[int, int]:
    across = CELL_DEG / max(0.01, math.cos(math.radians(round(position.lat_deg))))
    return math.floor(position.lon_deg / across), math.floor(position.lat_deg / CELL_DEG)


def town_cells(extract: Extract) -> frozenset[tuple[int, int]]:
    """The cells around which town streets are dense, as columns and rows of a grid."""
    streets = Counter(
        _cell(extract.nodes[ref].position)
        for way in extract.ways
        if way.road_class in TOWN_STREETS
        for ref in way.nodes
    )
    about = Counter[tuple[int, int]]()
    for (column, row), count in streets.items():
        for step in range(9):
            about[column + step % 3 - 1, row + step // 3 - 1] += count
    return frozenset(cell for cell, count in about.items() if count >= TOWN_NODES)


def is_dense(way: OsmWay, nodes: Mapping[int, Node], towns: frozenset[tuple[int, int]]) -> bool:
    """Whether a road is a town street or runs among them, as in a built-up area."""
    if way.road_class in TOWN_STREETS:
        return True
    inside = sum(_cell(nodes[ref].position) in towns for ref in way.nodes)
    return 2 * inside > len(way.nodes)
