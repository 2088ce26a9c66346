"""The present content of the moving map: camera, routes, and marks of what is ahead."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from automotive_cosim.cockpit.apps.map.state import Viewpoint
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.map import ZOOMS_M_PER_PX, Camera, RoadMap, View, camera_of
from automotive_cosim.cockpit.mapdraw import MapScene
from automotive_cosim.cockpit.state import State
from automotive_cosim.contracts import IncidentKind, Road

EgoPose = tuple[float, float, float]
"""x and y in metres, heading in degrees."""
FARTHEST = 24
"""Steps that a mark moves along its road at most, so as not to cover the car."""


@dataclass(frozen=True, slots=True)
class Spot:
    """A spot on the road that has a mark on the map."""

    roads: tuple[Road, ...]
    """The road that it is on, and those of the route that follow."""
    at_m: float
    """From the start of the first."""

    @property
    def road(self) -> Road:
        """The road that it is on."""
        return self.roads[0]

    def points(self, step_m: float) -> Iterator[tuple[float, float]]:
        """Its point, then others of its road, step by step onward and back."""
        steps = (way * number for number in range(1, FARTHEST + 1) for way in (1, -1))
        for step in (0, *steps):
            point = _along(self.roads, self.at_m + step * step_m)
            if point is not None:
                yield point


def ego(state: State) -> EgoPose | None:
    """The car's position; None before the first ``sense``."""
    if state.outside is None:
        return None
    driving = state.outside.driving
    return round(driving.x_m, 1), round(driving.y_m, 1), round(driving.heading_deg, 1)


def map_camera(state: State) -> Camera:
    """Camera of the map app: over the car, or where the driver has moved it, then north up."""
    view = state.of(Viewpoint)
    metres_per_pixel = ZOOMS_M_PER_PX[view.zoom]
    if view.panned is not None:
        return Camera(round(view.panned[0], 1), round(view.panned[1], 1), 0.0, metres_per_pixel, 0.5)
    return camera_of(state.roads, ego(state), metres_per_pixel, view.north_up)


def panned(state: State, right: float, down: float) -> tuple[float, float]:
    """The map's point after a move by a number of logical pixels, at most to the network's edge."""
    camera = map_camera(state)
    x_m, y_m = View(camera, 1 / camera.metres_per_pixel, 0.0, 0.0).metres(right, down)
    x_min, y_min, x_max, y_max = state.roads.network.bounds_m
    return min(max(x_m, x_min), x_max), min(max(y_m, y_min), y_max)


def scene(state: State, camera: Camera) -> MapScene:
    """Everything drawn in addition to the roads; traffic is the last that was received."""
    if state.outside is None:
        return MapScene(camera)
    ahead = state.outside.driving.ahead
    others = tuple(other.edges for other in ahead.alternatives)
    slow = () if state.heard is None else state.heard.driving.ahead.slow_edges
    return MapScene(camera, ego(state), ahead.route_edges, others, slow)


def jam(state: State) -> Spot | None:
    """Where the next jam on the route begins, as last received."""
    if state.heard is None:
        return None
    road, ahead = state.heard.driving.road, state.heard.driving.ahead
    if ahead.jam_distance_m is None:
        return None
    at_m = road.lane_position_m + ahead.jam_distance_m
    for number, edge in enumerate(ahead.route_edges):
        there = state.roads.find(edge)
        if there is not None and at_m < there.length_m:
            return Spot(_ways(state.roads, ahead.route_edges[number:]), at_m)
        at_m -= 0.0 if there is None else there.length_m
    return None


def incidents(state: State, *, besides_jam: bool = False) -> tuple[tuple[IncidentKind, Spot], ...]:
    """Incidents last reported by live traffic: kind, and where a driver meets them.

    Args:
        besides_jam: whether to omit jams on the route, of which the next has a mark of its own."""
    if state.heard is None:
        return ()
    ahead = state.heard.driving.ahead
    marked = frozenset(ahead.route_edges) if besides_jam else frozenset()
    told = (one for one in ahead.incidents if one.kind is not IncidentKind.JAM or one.edge_id not in marked)
    route = ahead.route_edges
    known = (
        (one, _ways(state.roads, route[route.index(one.edge_id) :] if one.edge_id in route else (one.edge_id,)))
        for one in told
    )
    return tuple((one.kind, Spot(ways, min(one.position_m, ways[0].length_m))) for one, ways in known if ways)


def goal(state: State) -> Spot | None:
    """Where the route ends."""
    route = () if state.outside is None else state.outside.driving.ahead.route_edges
    last = state.roads.find(route[-1]) if route else None
    return None if last is None else Spot((last,), last.length_m)


def box_of(camera: Camera, area: Rect, point_m: tuple[float, float], side: int) -> Rect:
    """A box around a point of the network on a map that fills ``area``."""
    view = View(camera, 1 / camera.metres_per_pixel, area.width / 2, area.height * camera.down)
    x, y = view.pixel(*point_m)
    return Rect(area.x + round(x) - side // 2, area.y + round(y) - side // 2, side, side)


def _ways(roads: RoadMap, edges: tuple[str, ...]) -> tuple[Road, ...]:
    """The roads of the first edges, as far as a mark may move; none unless the map has the first."""
    found = [roads.find(edge) for edge in edges[:FARTHEST]]
    return tuple(road for road in found if road is not None) if found and found[0] is not None else ()


def _along(roads: tuple[Road, ...], at_m: float) -> tuple[float, float] | None:
    """The point of roads at a distance from their start; None beyond them."""
    for road in roads:
        if at_m <= road.length_m:
            return _point(road, at_m) if at_m >= 0 else None
        at_m -= road.length_m
    return None


def _point(road: Road, at_m: float) -> tuple[float, float]:
    """The point of a road at a distance from its start; its shape may be longer or shorter than its length."""
    steps_m = [math.dist(here, there) for here, there in pairwise(road.shape_m)]
    left_m = min(1.0, at_m / road.length_m) * sum(steps_m)
    for (x_m, y_m), (to_x_m, to_y_m), step_m in zip(road.shape_m, road.shape_m[1:], steps_m, strict=False):
        if left_m <= step_m > 0:
            share = left_m / step_m
            return x_m + share * (to_x_m - x_m), y_m + share * (to_y_m - y_m)
        left_m -= step_m
    return road.shape_m[-1]
