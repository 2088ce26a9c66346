"""Compares every edge of a built network with the OSM way that it comes from."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from automotive_cosim.contracts import KMH_PER_MPS, LimitSource
from automotive_cosim.osm.limits import kmh_of
from automotive_cosim.osm.roads import MappedRoad, way_of
from automotive_cosim.traffic.network import Edge, class_of

ROUNDING_KMH = 0.05
"""netconvert writes speeds with two digits of a metre per second."""

RAMP = "-Added"
"""In the id of an edge that netconvert cut off a road to widen it by the lane of a ramp."""


@dataclass(frozen=True, slots=True)
class Difference:
    """One property in which an edge differs from its way."""

    way: int
    edge_id: str
    what: str
    """``"limit"``, ``"name"``, ``"class"``, ``"tunnel"`` or ``"lanes"``."""
    mapped: str
    built: str

    def __str__(self) -> str:
        mapped, built = (value or "unnamed" for value in (self.mapped, self.built))
        return f"way {self.way}: {self.what} {mapped} is {built} on edge {self.edge_id}"


def differences(edges: Iterable[Edge], roads: Mapping[int, MappedRoad]) -> Iterator[Difference]:
    """Every property of every edge that differs from its way's tags. Fewer lanes for cars than the way has are no
    difference: the others are closed to them."""
    for edge in edges:
        way = way_of(edge.edge_id)
        road = roads[way]
        limit_kmh, source = _mapped_limit(road, edge.edge_id)
        built_kmh = math.inf if edge.limit_mps is None else edge.limit_mps * KMH_PER_MPS
        if source is not edge.limit_source or not math.isclose(limit_kmh, built_kmh, abs_tol=ROUNDING_KMH):
            built = _limit(built_kmh, edge.limit_source)
            yield Difference(way, edge.edge_id, "limit", _limit(limit_kmh, source), built)
        for what, mapped, built in (
            ("name", road.name, edge.name),
            ("class", class_of(road.tags["highway"], road.tags), edge.road_class),
            ("tunnel", _yes(road.tags.get("tunnel", "no") != "no"), _yes(edge.in_tunnel)),
        ):
            if mapped != built:
                yield Difference(way, edge.edge_id, what, mapped, built)
        lanes = road.lanes(edge.edge_id)
        if lanes is not None and len(edge.lane_ids) > lanes + (RAMP in edge.edge_id):
            yield Difference(way, edge.edge_id, "lanes", str(lanes), str(len(edge.lane_ids)))


def _mapped_limit(road: MappedRoad, edge_id: str) -> tuple[float, LimitSource]:
    source = LimitSource.ASSUMED if road.stated.of(edge_id) is None else LimitSource.POSTED
    return kmh_of(road.limit(edge_id)), source


def _limit(kmh: float, source: LimitSource) -> str:
    return f"{'none' if math.isinf(kmh) else f'{kmh:.0f} km/h'} ({source})"


def _yes(is_so: bool) -> str:
    return "yes" if is_so else "no"
