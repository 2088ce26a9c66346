"""Finds the edge that each counted site stands on, and lists what is doubtful about the counts."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from shapely import LineString, Point, STRtree

from automotive_cosim.studies.calibration.capacity import Capacity
from automotive_cosim.studies.calibration.counts import GOOD_GEH, Counts, SitePlace, geh
from automotive_cosim.traffic.georeference import GeoReference
from automotive_cosim.traffic.network import Edge, Network

NEAR_M = 30.0
"""How far from the middle of its road a position may be."""

CLOSE_M = 5.0
"""An edge that is farther than another by less may as well be meant."""

ACROSS_DEG = 45.0
"""How far the direction of a road may be from the bearing."""


@dataclass(frozen=True, slots=True)
class Mapped:
    """Sites on the network."""

    edges: Mapping[str, str]
    """Site -> edge; one site for an edge."""
    unmapped: Mapping[str, str]
    """Site that is left out -> reason."""
    doubts: tuple[str, ...] = field(default=())
    """In words, about sites that are used."""


def map_sites(counts: Counts, network: Network, capacity: Capacity) -> Mapped:
    """Finds each site's edge, and checks the counts against the roads and each other."""
    edges: dict[str, str] = {}
    unmapped: dict[str, str] = {}
    doubts = [*counts.doubts]
    nearby = _Nearby(network)
    taken: dict[str, str] = {}
    for site in counts.sites:
        place = counts.places.get(site)
        if place is None:
            unmapped[site] = "its place is not given"
            continue
        found = _named(place.edge, network) if place.edge else nearby.find(place)
        if isinstance(found, str):
            unmapped[site] = found
        elif found[0].edge_id in taken:
            unmapped[site] = f"it stands on the edge of {taken[found[0].edge_id]}"
        else:
            edges[site] = found[0].edge_id
            taken[found[0].edge_id] = site
            if len(found) > 1:
                doubts.append(f"{site}: taken as {found[0].edge_id}, but {found[1].edge_id} is about as near")
    doubts += _over_capacity(counts, edges, capacity)
    doubts += _contradictions(counts, edges, network)
    return Mapped(edges, unmapped, tuple(doubts))


def _named(wanted: str, network: Network) -> list[Edge] | str:
    """The edge of that name, or the longest of that OpenStreetMap way."""
    if wanted in network.edges:
        return [network.edges[wanted]]
    way = [edge for name, edge in network.edges.items() if name.startswith(f"{wanted}#")]
    return [max(way, key=lambda edge: edge.length_m)] if way else f"the network has no edge for cars {wanted!r}"


class _Nearby:
    """Looks for edges by position."""

    def __init__(self, network: Network) -> None:
        self._edges = list(network.edges.values())
        self._lines = [LineString(edge.shape_m) for edge in self._edges]
        self._tree = STRtree(self._lines)
        self._reference = GeoReference(network.map) if network.map.projection else None

    def find(self, place: SitePlace) -> list[Edge] | str:
        """The edge, and others that are about as near; or why there is none."""
        assert place.position is not None
        if self._reference is None:
            return "it is given by position, but the network has none on earth; give its edge"
        point = Point(self._reference.x_y(*place.position))
        near = []
        for index in self._tree.query(point, predicate="dwithin", distance=NEAR_M).tolist():
            line = self._lines[index]
            bearing_deg = _bearing_deg(line, line.project(point))
            if place.bearing_deg is None or _apart_deg(bearing_deg, place.bearing_deg) <= ACROSS_DEG:
                near.append((line.distance(point), self._edges[index].edge_id, self._edges[index]))
        near.sort(key=lambda each: each[:2])
        if not near:
            return f"no road for cars in its direction within {NEAR_M:g} m"
        return [edge for distance_m, _, edge in near if distance_m <= near[0][0] + CLOSE_M]


def _bearing_deg(line: LineString, at_m: float) -> float:
    start = line.interpolate(max(0.0, at_m - 5.0))
    end = line.interpolate(min(line.length, at_m + 5.0))
    return math.degrees(math.atan2(end.x - start.x, end.y - start.y)) % 360


def _apart_deg(first: float, second: float) -> float:
    return abs((first - second + 180) % 360 - 180)


def _over_capacity(counts: Counts, edges: Mapping[str, str], capacity: Capacity) -> Iterator[str]:
    for (site, hour), flow in counts.flows_per_h.items():
        most = capacity.edges.get(edges.get(site, ""), math.inf)
        if flow > most:
            yield f"{site}: {flow:.0f} vehicles at {hour} h, but {edges[site]} carries about {most:.0f}"


def _contradictions(counts: Counts, edges: Mapping[str, str], network: Network) -> Iterator[str]:
    """Sites one after the other with nothing between them where traffic could join or leave."""
    before: dict[str, list[str]] = {}
    for edge, followers in network.crossings.items():
        for follower in followers:
            if follower != network.opposite.get(edge):
                before.setdefault(follower, []).append(edge)
    site_of = {edge: site for site, edge in edges.items()}
    for site, edge in edges.items():
        follower = edge
        for _ in range(len(network.edges)):
            after = [edge for edge in network.crossings.get(follower, {}) if edge != network.opposite.get(follower)]
            if len(after) != 1 or before.get(after[0], []) != [follower]:
                break
            follower = after[0]
            if follower in site_of:
                yield from _differences(counts, site, site_of[follower])
                break


def _differences(counts: Counts, first: str, second: str) -> Iterator[str]:
    for hour in counts.hours:
        flows = counts.flows_per_h.get((first, hour)), counts.flows_per_h.get((second, hour))
        if flows[0] is not None and flows[1] is not None and geh(flows[0], flows[1]) >= GOOD_GEH:
            yield (
                f"{first} and {second}: {flows[0]:.0f} and {flows[1]:.0f} vehicles at {hour} h, though no road"
                " joins or leaves between them"
            )
