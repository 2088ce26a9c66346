"""The present content of the moving map: camera, routes, and marks of what is ahead."""

from __future__ import annotations

import math
from itertools import pairwise

from automotive_cosim.cockpit.apps.map.state import Viewpoint
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.map import ZOOMS_M_PER_PX, Camera, RoadMap, View, camera_of
from automotive_cosim.cockpit.mapdraw import MapScene
from automotive_cosim.cockpit.state import State
from automotive_cosim.contracts import IncidentKind, Road

EgoPose = tuple[float, float, float]
"""x and y in metres, heading in degrees."""


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


def jam(state: State) -> tuple[float, float] | None:
    """Where the next jam on the route begins, as last received."""
    if state.heard is None:
        return None
    road, ahead = state.heard.driving.road, state.heard.driving.ahead
    if ahead.jam_distance_m is None:
        return None
    return _along(state.roads, ahead.route_edges, road.lane_position_m + ahead.jam_distance_m)


def incidents(
    state: State, *, besides_jam: bool = False
) -> tuple[tuple[IncidentKind, Road, tuple[float, float]], ...]:
    """Incidents last reported by live traffic: kind, road, and the point where a driver meets them.

    Args:
        state: the cockpit's state.
        besides_jam: whether to omit jams on the route, of which the next has a mark of its own.
    """
    if state.heard is None:
        return ()
    ahead = state.heard.driving.ahead
    marked = frozenset(ahead.route_edges) if besides_jam else frozenset()
    told = (one for one in ahead.incidents if one.kind is not IncidentKind.JAM or one.edge_id not in marked)
    known = ((one, state.roads.find(one.edge_id)) for one in told)
    return tuple((one.kind, road, _point(road, one.position_m)) for one, road in known if road is not None)


def goal(state: State) -> tuple[float, float] | None:
    """Where the route ends."""
    route = () if state.outside is None else state.outside.driving.ahead.route_edges
    last = state.roads.find(route[-1]) if route else None
    return None if last is None else last.shape_m[-1]


def box_of(camera: Camera, area: Rect, point_m: tuple[float, float], side: int) -> Rect:
    """A box around a point of the network on a map that fills ``area``."""
    view = View(camera, 1 / camera.metres_per_pixel, area.width / 2, area.height * camera.down)
    x, y = view.pixel(*point_m)
    return Rect(area.x + round(x) - side // 2, area.y + round(y) - side // 2, side, side)


def _along(roads: RoadMap, route: tuple[str, ...], driven_m: float) -> tuple[float, float] | None:
    """The point of a route at a distance from its start."""
    for road in map(roads.find, route):
        if road is None:
            continue
        if driven_m < road.length_m:
            return _point(road, driven_m)
        driven_m -= road.length_m
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
