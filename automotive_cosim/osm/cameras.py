"""Speed cameras: the edges whose traffic each of them watches (OSM wiki, "Tag:highway=speed_camera",
"Relation:enforcement")."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import islice

import shapely

from automotive_cosim.osm.access import ENDS
from automotive_cosim.osm.extract import Extract, MappedCamera
from automotive_cosim.osm.facing import ALONG_DEG, bearing_deg, facing, turned_deg
from automotive_cosim.traffic.georeference import GeoReference
from automotive_cosim.traffic.network import Edge, Network

WITHIN_M = 30.0
"""A camera farther from every road is at one that was not imported."""

ON_ROAD_M = 1.0
"""A camera nearer than this is a node of the road."""


@dataclass(slots=True)
class Cameras:
    """The cameras of a network."""

    beside: dict[str, str] = field(default_factory=dict)
    """By edge, their distances from its start in metres, parted by spaces."""
    count: int = 0
    """How many they are."""
    told: dict[str, list[int]] = field(default_factory=dict)
    """Nodes of cameras about which something is to be told, by what."""

    def tell(self, what: str, camera: MappedCamera) -> None:
        self.told.setdefault(what, []).append(camera.node)


def cameras_of(network: Network, extract: Extract) -> Cameras:
    """Places the cameras of a map on the edges of its network."""
    found = Cameras()
    if not extract.cameras or network.map.projection is None:
        return found
    edges = list(network.edges.values())
    lines = [shapely.LineString(edge.shape_m) for edge in edges]
    tree, to_metres = shapely.STRtree(lines), GeoReference(network.map)
    joints = _joints(extract)
    places_m: dict[str, list[float]] = {}
    for camera in extract.cameras:
        point = shapely.Point(to_metres.x_y(*camera.position))
        near = sorted(tree.query(point, "dwithin", WITHIN_M), key=lambda at: (lines[at].distance(point), at))
        if not near:
            found.tell("at no road of the network, left out", camera)
            continue
        there = [(edges[at], lines[at]) for at in near]
        watched = _watched(camera, there, point, network, found, is_joint=camera.node in joints)
        found.count += bool(watched)
        for edge, line in watched:
            share = line.project(point, normalized=True)
            places_m.setdefault(edge.edge_id, []).append(round(share * edge.length_m, 1))
    found.beside = {edge: " ".join(f"{place:g}" for place in sorted(places)) for edge, places in places_m.items()}
    return found


def _joints(extract: Extract) -> set[int]:
    """Nodes at which two ways begin, or two end: which direction ``forward`` is there, nothing says."""
    firsts, lasts, joints = set[int](), set[int](), set[int]()
    for way in extract.ways:
        joints |= {way.nodes[0]} & firsts | {way.nodes[-1]} & lasts
        firsts.add(way.nodes[0])
        lasts.add(way.nodes[-1])
    return joints


_Near = Sequence[tuple[Edge, shapely.LineString]]


def _watched(
    camera: MappedCamera, near: _Near, point: shapely.Point, network: Network, found: Cameras, *, is_joint: bool
) -> _Near:
    """The edges whose traffic a camera watches, of those near it, the nearest first."""
    nearest = near[0][0]
    pair = {nearest.edge_id, network.opposite.get(nearest.edge_id, "")}
    both = [each for each in near if each[0].edge_id in pair]
    if near[0][1].distance(point) < ON_ROAD_M:
        near = both
    told = facing(camera.tags, "camera")
    courses = [bearing_deg(*course) for course in camera.courses]
    if courses or told.front_deg is not None:
        chosen: dict[str, tuple[Edge, shapely.LineString]] = {}
        for heading in courses or [(told.front_deg or 0.0) + 180]:
            along = (each for each in near if turned_deg(heading, _heading(each[1], point)) < ALONG_DEG)
            chosen |= {first[0].edge_id: first for first in islice(along, 1)}
        if chosen:
            return list(chosen.values())
        if len(both) == 1 and not courses:
            return both  # from behind, as on a one-way road
    elif told.ends is not None and not is_joint:
        ended = [each for each in both if ENDS[each[0].edge_id.startswith("-")] in told.ends]
        if not ended:
            found.tell("for a direction in which nobody drives, left out", camera)
        return ended
    if len(both) > 1 and told.ends != ENDS:
        found.tell("of which the map does not say whom they watch, both directions taken", camera)
    return both


def _heading(line: shapely.LineString, point: shapely.Point) -> float:
    """Where a line leads beside a point, clockwise from north."""
    at = line.project(point)
    start, goal = line.interpolate(max(0.0, at - 5.0)), line.interpolate(min(line.length, at + 5.0))
    return math.degrees(math.atan2(goal.x - start.x, goal.y - start.y)) % 360
