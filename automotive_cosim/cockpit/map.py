"""The network for the moving map: what a camera sees, and which names fit."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt
from shapely import Polygon, STRtree, box, linestrings, points

from automotive_cosim.cockpit.drawing import text_width
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.theme import Type
from automotive_cosim.contracts import Road, RoadNetwork

MOTORWAYS = frozenset({"motorway", "trunk", "motorway_link", "trunk_link"})
AVENUES = frozenset({"primary", "secondary", "primary_link", "secondary_link"})
QUIET = frozenset({"service", "living_street", "track", "footway", "pedestrian"})
ZOOMS_M_PER_PX = (0.5, 0.9, 1.6, 2.8, 5.0)
NAMES_AT_MOST = 9
SHARP_RAD = 0.2
EGO_DOWN = 0.68
"""The ego's position from the top of the map, to show more of what is ahead."""


@dataclass(frozen=True, slots=True)
class Camera:
    """The camera of the map."""

    x_m: float
    y_m: float
    heading_deg: float
    """Heading that is up."""
    metres_per_pixel: float
    down: float = EGO_DOWN
    """Position of its point from the top, as a share of the height."""


def whole_heading_deg(heading_deg: float) -> float:
    """Upward heading of a map that turns with the car, in steps of two degrees to keep it steady."""
    return round(heading_deg / 2) * 2.0 % 360


def camera_of(
    roads: RoadMap, ego: tuple[float, float, float] | None, metres_per_pixel: float, north_up: bool = False
) -> Camera:
    """Over the car (x, y and heading), or over the middle of the network while the position is unknown."""
    x_min, y_min, x_max, y_max = roads.network.bounds_m
    x_m, y_m, heading_deg = ego or ((x_min + x_max) / 2, (y_min + y_max) / 2, 0.0)
    if north_up:
        return Camera(round(x_m, 1), round(y_m, 1), 0.0, metres_per_pixel, 0.5)
    return Camera(round(x_m, 1), round(y_m, 1), whole_heading_deg(heading_deg), metres_per_pixel)


@dataclass(frozen=True, slots=True)
class StreetName:
    """A name on the map and its position on the screen."""

    text: str
    rect: Rect


class RoadMap:
    """The network, indexed for drawing. Built once; shared by all copies of a cockpit."""

    def __init__(self, network: RoadNetwork) -> None:
        """Indexes the roads; a tenth of a second for ten thousand."""
        self.network = network
        self.roads = tuple(road for road in network.roads if len(road.shape_m) > 1)
        shapes = [np.asarray(road.shape_m, dtype=np.float64) for road in self.roads]
        counts = [len(shape) for shape in shapes]
        self._points = np.concatenate(shapes) if shapes else np.empty((0, 2))
        self._starts = np.cumsum([0, *counts])
        lines = linestrings(self._points, indices=np.repeat(np.arange(len(counts)), counts))
        self._tree = STRtree(np.asarray(lines))
        self._rounded = _bends(self._points, self._starts)
        self._ranks = np.array([_rank(road) for road in self.roads], dtype=np.int64)
        lengths = np.array([road.length_m for road in self.roads])
        named = [at for at in np.lexsort((-lengths, -self._ranks)).tolist() if self.roads[at].name]
        self._named = [self.roads[at].name for at in named]
        """Names of roads, as often as there are such: of major roads first, then of long ones."""
        self._middles = np.array([_middle(shapes[at]) for at in named]).reshape(-1, 2)
        self._named_tree = STRtree(np.asarray(points(self._middles)))
        in_tunnel = np.array([road.in_tunnel for road in self.roads], dtype=bool)
        self._depths = np.where(in_tunnel, -1, self._ranks)
        self._index = {road.edge_id: i for i, road in enumerate(self.roads)}

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Street names, sorted."""
        return tuple(sorted({road.name for road in self.roads if road.name}))

    def find(self, edge_id: str) -> Road | None:
        at = self._index.get(edge_id)
        return None if at is None else self.roads[at]

    def knows(self, name: str) -> bool:
        """Whether it is a street, whatever its capitals, or an edge."""
        return name in self._index or name.casefold() in self._folded

    @cached_property
    def _folded(self) -> frozenset[str]:
        return frozenset(name.casefold() for name in self.names)

    def in_sight(self, view: View, width: float, height: float) -> list[Stroke]:
        """The roads in a picture of that size, the uppermost last: tunnels, then minor roads, then major roads.

        From further away, quiet roads are omitted, then side streets."""
        found = self._tree.query(view.sight(width, height), predicate="intersects")
        found = found[self._ranks[found] >= _least_rank(view.camera.metres_per_pixel)]
        return self._strokes(found[np.lexsort((found, self._depths[found]))], view)

    def strokes(self, edges: Iterable[str], view: View) -> list[Stroke]:
        """The roads of existing edges, in order, whether visible or not."""
        found = [self._index[edge] for edge in edges if edge in self._index]
        return self._strokes(np.array(found, dtype=np.int64), view)

    def names_in_sight(self, area: Rect, camera: Camera, avoid: tuple[Rect, ...]) -> tuple[StreetName, ...]:
        """Street names for a map that fills ``area``: major roads first, without overlaps.

        Args:
            area: the map's area on the screen."""
        view = View(camera, 1 / camera.metres_per_pixel, area.width / 2, area.height * camera.down)
        found = np.sort(self._named_tree.query(view.bounds(area.width, area.height)))
        middles = view.pixels(self._middles[found]) + np.array((area.x, area.y))
        ego = Rect(area.x + area.width // 2, area.y + round(area.height * camera.down), 0, 0).inset(-34)
        taken = [(box.x - 6, box.y - 6, box.right + 6, box.bottom + 6) for box in (*avoid, ego)]
        names, room = dict[str, StreetName](), area.inset(4)
        for at, (x, y) in zip(found.tolist(), middles.astype(int).tolist(), strict=True):
            text = self._named[at]
            if text in names:
                continue
            wide = _plate_width(text)
            left, top = x + -wide // 2, y - 12
            right, bottom = left + wide, top + 24
            if left < room.x or top < room.y or right > room.right or bottom > room.bottom:
                continue
            if not any(left < t[2] and t[0] < right and top < t[3] and t[1] < bottom for t in taken):
                taken.append((left - 6, top - 6, right + 6, bottom + 6))
                names[text] = StreetName(text, Rect(left, top, wide, 24))
            if len(names) == NAMES_AT_MOST:
                break
        return tuple(names.values())

    def _strokes(self, found: npt.NDArray[np.int64], view: View) -> list[Stroke]:
        starts, ends = self._starts[found], self._starts[found + 1]
        picked = np.concatenate([np.arange(a, b) for a, b in zip(starts, ends, strict=True)] or [np.empty(0, int)])
        flat = view.pixels(self._points[picked]).ravel().tolist()
        rounded = self._rounded[picked].tolist()
        strokes, at = [], 0
        for i, count in zip(found.tolist(), (ends - starts).tolist(), strict=True):
            line = flat[2 * at : 2 * (at + count)]
            joints = [(line[2 * k], line[2 * k + 1]) for k in range(count) if rounded[at + k]]
            strokes.append(Stroke(self.roads[i], int(self._ranks[i]), line, joints))
            at += count
        return strokes


_recent: list[RoadMap] = []


def road_map(network: RoadNetwork) -> RoadMap:
    """The network's index, cached: every episode in a scenario has the same one."""
    for known in _recent:
        if known.network is network:
            return known
    _recent.insert(0, RoadMap(network))
    del _recent[4:]
    return _recent[0]


@dataclass(frozen=True, slots=True)
class View:
    """Converts metres of the network to pixels of a picture."""

    camera: Camera
    per_metre: float
    x: float
    """The camera's point in pixels."""
    y: float

    def pixels(self, points_m: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """From metres of the network to pixels, the heading upwards."""
        cos, sin = self._turn
        dx, dy = points_m[:, 0] - self.camera.x_m, points_m[:, 1] - self.camera.y_m
        pixels = np.empty_like(points_m)
        pixels[:, 0] = self.x + self.per_metre * (dx * cos - dy * sin)
        pixels[:, 1] = self.y - self.per_metre * (dx * sin + dy * cos)
        return pixels

    def pixel(self, x_m: float, y_m: float) -> tuple[float, float]:
        """The same for one point."""
        cos, sin = self._turn
        dx, dy = x_m - self.camera.x_m, y_m - self.camera.y_m
        return self.x + self.per_metre * (dx * cos - dy * sin), self.y - self.per_metre * (dx * sin + dy * cos)

    def metres(self, x: float, y: float) -> tuple[float, float]:
        """Back from pixels of the picture to metres."""
        cos, sin = self._turn
        across, up = (x - self.x) / self.per_metre, (self.y - y) / self.per_metre
        return self.camera.x_m + across * cos + up * sin, self.camera.y_m - across * sin + up * cos

    def sight(self, width: float, height: float) -> Polygon:
        """The area of a picture of that size, in metres of the network."""
        return Polygon(self._corners(width, height))

    def bounds(self, width: float, height: float) -> Polygon:
        """The box around that along the network's axes."""
        across, up = zip(*self._corners(width, height), strict=True)
        around: Polygon = box(min(across), min(up), max(across), max(up))
        return around

    def _corners(self, width: float, height: float) -> list[tuple[float, float]]:
        return [self.metres(x, y) for x, y in ((0, 0), (width, 0), (width, height), (0, height))]

    @property
    def _turn(self) -> tuple[float, float]:
        angle = math.radians(self.camera.heading_deg)
        return math.cos(angle), math.sin(angle)


@dataclass(frozen=True, slots=True)
class Stroke:
    """One road in pixels."""

    road: Road
    rank: int
    """0 quiet to 4 motorway."""
    line: list[float]
    """x, y, x, y, …"""
    joints: list[tuple[float, float]]
    """Ends and sharp bends, which are drawn round."""


@lru_cache(maxsize=4096)
def _plate_width(text: str) -> int:
    return round(text_width(text, Type.SMALL)) + 16


def _bends(points: npt.NDArray[np.float64], starts: npt.NDArray[np.int64]) -> npt.NDArray[np.bool_]:
    """Which points of lines, one after another, need a round joint: their ends, and where they turn by more than
    that."""
    steps = np.diff(points, axis=0)
    turned = np.abs(np.diff(np.arctan2(steps[:, 1], steps[:, 0])))
    rounded = np.ones(len(points), dtype=bool)
    rounded[1:-1] = np.minimum(turned, 2 * np.pi - turned) > SHARP_RAD
    rounded[starts[:-1]] = rounded[starts[1:] - 1] = True
    return rounded


def _middle(shape: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return np.asarray((shape[(len(shape) - 1) // 2] + shape[len(shape) // 2]) / 2)


def _rank(road: Road) -> int:
    """Rank of a road: the higher, the further up, and from the further away, it is drawn."""
    if road.road_class in MOTORWAYS:
        return 4
    if road.road_class in AVENUES:
        return 3
    return 1 if road.road_class in QUIET else 2


def _least_rank(metres_per_pixel: float) -> int:
    if metres_per_pixel < 1.5:
        return 0
    return 2 if metres_per_pixel < 4 else 3
