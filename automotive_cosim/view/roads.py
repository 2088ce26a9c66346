"""The surface of the roads as a driver sees it: lanes, markings, kerbs and stop lines, as areas in the network."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from itertools import pairwise

import numpy as np
import shapely
from shapely import LineString, MultiPoint, Polygon, STRtree

from automotive_cosim.contracts import GroundKind, LaneShape, LimitSource, Road, RoadNetwork, RoadShapes
from automotive_cosim.view.lens import XY, Corners

XYs = tuple[XY, ...]
LINE_M, KERB_M, STOP_LINE_M, RAIL_M = 0.14, 0.16, 0.4, 0.72
"""Width of a marking, of a kerb and of a stop line, and from the middle of a track to a rail."""
ZEBRA_M = (0.5, 1.0)
"""Width of a stripe, and from one to the next (Germany, R-FGÜ 2001; others are like it)."""
MOTORWAYS = ("motorway", "trunk")
SEAM_M = 0.06
"""How far areas beside each other overlap."""
GAP_M = 0.9
"""Up to this much of what is between two directions is road, too."""
ACROSS_M = 60.0
"""Signals across a junction stand no farther away than this."""


class Paving(IntEnum):
    """What an area of the road is covered with, in the order of drawing."""

    GREEN = 0
    WATER = 1
    CROSSING = 2
    FOOT = 3
    ROAD = 4
    BUS = 5
    BICYCLE = 6
    RAIL = 7
    KERB = 8
    STEEL = 9
    WHITE = 10
    YELLOW = 11


_OF_KIND = {"foot": Paving.FOOT, "bus": Paving.BUS, "bicycle": Paving.BICYCLE, "rail": Paving.RAIL}


@dataclass(frozen=True, slots=True)
class Stand:
    """A spot beside or above a road, for who drives in a direction."""

    x_m: float
    y_m: float
    heading_deg: float
    """Of who drives there, clockwise from north."""


@dataclass(frozen=True, slots=True)
class Areas:
    """Areas on the ground."""

    covers: tuple[int, ...]
    """What each is covered with."""
    counts: tuple[int, ...]
    """How many corners each has."""
    corners_m: Corners
    """Those of all, one after another."""

    @classmethod
    def of(cls, areas: Sequence[tuple[int, Corners]]) -> Areas:
        corners = np.concatenate([each for _, each in areas]) if areas else np.empty((0, 2))
        return cls(tuple(cover for cover, _ in areas), tuple(len(each) for _, each in areas), corners)


@dataclass(frozen=True, slots=True)
class EdgeView:
    """One edge."""

    edge_id: str
    areas: Areas
    """Its surface and what is painted on it."""
    begin: Stand
    """Beside its kerb, where it begins."""
    stop: Stand
    """Beside its kerb, where it ends."""
    sides: tuple[XYs, XYs]
    """Its left and its right border."""
    beyond: tuple[str, str]
    """The edge of the other direction right beyond each of them; empty if there is none."""
    lanes: tuple[tuple[str, XYs, float], ...]
    """Id, centre line and width of each lane for vehicles."""
    signals: tuple[tuple[Stand, Stand, tuple[tuple[str, int], ...]], ...]
    """Of each lane with a signal: the place over its stop line, the one across the junction, and its links."""


def shifted(line: Sequence[XY], right_m: float) -> XYs:
    """A line so far to the right of another."""
    found = []
    for at, (x, y) in enumerate(line):
        before, after = line[max(0, at - 1)], line[min(len(line) - 1, at + 1)]
        dx, dy = after[0] - before[0], after[1] - before[1]
        length = math.hypot(dx, dy) or 1.0
        found.append((x + right_m * dy / length, y - right_m * dx / length))
    return tuple(found)


def along(line: Sequence[XY], at_m: float) -> Stand:
    """A place at a distance from the beginning of a line, at most at its end."""
    before, here = line[0], line[-1]
    for before, here in pairwise(line):
        length = math.dist(before, here)
        if at_m <= length and length > 0:
            share = max(0.0, at_m) / length
            x, y = before[0] + share * (here[0] - before[0]), before[1] + share * (here[1] - before[1])
            return Stand(x, y, _heading(before, here))
        at_m -= length
    return Stand(here[0], here[1], _heading(before, here))


def _heading(before: XY, after: XY) -> float:
    return math.degrees(math.atan2(after[0] - before[0], after[1] - before[1])) % 360


def length_of(line: Sequence[XY]) -> float:
    """The length of a line, metres."""
    return sum(math.dist(before, after) for before, after in pairwise(line))


def _band(line: Sequence[XY], left_m: float, right_m: float) -> Corners:
    """The area between two distances to the right of a line."""
    return np.array((*shifted(line, left_m), *reversed(shifted(line, right_m))), dtype=np.float64)


def _pieces(line: Sequence[XY], from_m: float, to_m: float) -> list[XY]:
    """The part of a line between two distances from its beginning."""
    first, last = along(line, from_m), along(line, to_m)
    inside, passed_m = [(first.x_m, first.y_m)], 0.0
    for before, after in pairwise(line):
        passed_m += math.dist(before, after)
        if from_m < passed_m < to_m:
            inside.append(after)
    return [*inside, (last.x_m, last.y_m)]


def painted(line: Sequence[XY], dash_m: tuple[float, float] | None, width_m: float = LINE_M) -> Iterator[Corners]:
    """A marking along a line: solid, or with dashes of that length, so far from one to the next."""
    half_m = width_m / 2
    if dash_m is None:
        yield _band(line, -half_m, half_m)
        return
    length_m, at_m = length_of(line), 0.0
    while at_m + dash_m[0] <= length_m:
        yield _band(_pieces(line, at_m, at_m + dash_m[0]), -half_m, half_m)
        at_m += dash_m[1]


def _inner_line(
    border: XYs, inward: float, edge_id: str, beyond: str, dash_m: tuple[float, float] | None
) -> Iterator[tuple[Paving, Corners]]:
    """Between the two directions of a road, or beside the median; solid on motorways, which have no ``dash_m``."""
    if beyond:
        if edge_id < beyond:  # one line between the two
            yield from ((Paving.YELLOW, each) for each in painted(border, dash_m))
    elif dash_m is None:
        yield from ((Paving.WHITE, each) for each in painted(shifted(border, -inward * 0.25), None))
    else:
        yield from ((Paving.KERB, each) for each in painted(border, None, KERB_M))


class StreetMap:
    """All streets of a network by place; each is drawn out when it is first seen."""

    def __init__(self, shapes: RoadShapes, network: RoadNetwork) -> None:
        self.left_hand = network.left_hand
        self.roads: Mapping[str, Road] = {road.edge_id: road for road in network.roads}
        self.lengths_m = network.junctions_m
        self.before: dict[str, list[str]] = {}
        for here, after in network.junctions_m:
            self.before.setdefault(after, []).append(here)
        lanes: dict[str, list[LaneShape]] = {}
        for lane in shapes.lanes:
            if len(lane.line_m) > 1:
                lanes.setdefault(lane.lane_id.rpartition("_")[0], []).append(lane)
        for own in lanes.values():
            own.sort(key=lambda lane: int(lane.lane_id.rpartition("_")[2]))
        self._lanes, self._edges = lanes, list(lanes)
        self._streets: dict[str, EdgeView] = {}
        boxes = [MultiPoint([point for lane in own for point in lane.line_m]).envelope for own in lanes.values()]
        self._tree = STRtree(boxes)
        self._junctions = [Polygon(outline).buffer(0.0) for outline in shapes.junctions]
        self._outlines = [np.array(outline, dtype=np.float64) for outline in shapes.junctions]
        self._crossings = STRtree(self._junctions)
        self._ground = [(area, np.array(area.outline_m, dtype=np.float64)) for area in shapes.ground]
        self._zebras = [[*painted(each.line_m, ZEBRA_M, each.width_m)] for each in shapes.crossings]
        self._stripes = STRtree([LineString(each.line_m) for each in shapes.crossings])
        self._areas = STRtree([MultiPoint(area.outline_m).envelope for area in shapes.ground])

    def streets(self, x_m: float, y_m: float, radius_m: float) -> list[EdgeView]:
        """Those within a distance, in the order of the network."""
        return [self.street(self._edges[at]) for at in self._near(self._tree, x_m, y_m, radius_m)]

    def ground(self, x_m: float, y_m: float, radius_m: float) -> Areas:
        """Green, water, and the junctions and zebra crossings within a distance."""
        near = [self._ground[at] for at in self._near(self._areas, x_m, y_m, radius_m)]
        flat: list[tuple[int, Corners]] = [
            (Paving.GREEN if area.kind is GroundKind.GREEN else Paving.WATER, outline)
            for area, outline in near
            if area.kind is not GroundKind.BUILDING
        ]
        crossings = self._near(self._crossings, x_m, y_m, radius_m)
        flat += ((Paving.CROSSING, self._outlines[at]) for at in crossings)
        zebras = self._near(self._stripes, x_m, y_m, radius_m)
        return Areas.of([*flat, *((Paving.WHITE, stripe) for at in zebras for stripe in self._zebras[at])])

    def buildings(self, x_m: float, y_m: float, radius_m: float) -> list[Corners]:
        """Outlines of the buildings within a distance."""
        near = (self._ground[at] for at in self._near(self._areas, x_m, y_m, radius_m))
        return [outline for area, outline in near if area.kind is GroundKind.BUILDING]

    def street(self, edge_id: str) -> EdgeView:
        """One edge of the network. Raises KeyError: there is none."""
        if edge_id not in self._streets:
            self._streets[edge_id] = self._drawn(edge_id, self._lanes[edge_id])
        return self._streets[edge_id]

    def has(self, edge_id: str) -> bool:
        """Whether it has lanes outside junctions."""
        return edge_id in self._lanes

    def in_tunnel(self, edge_id: str) -> bool:
        """Whether it runs in a tunnel."""
        road = self.roads.get(edge_id)
        return road is not None and road.in_tunnel

    def posts(self, edge_id: str) -> bool:
        """Whether a limit is posted where it begins: it has one, and one before it has not the same."""
        road = self.roads.get(edge_id)
        if road is None or road.limit_source is not LimitSource.POSTED:
            return False
        before = [self.roads[each] for each in self.before.get(edge_id, ()) if each in self.roads]
        return any((each.limit_source, each.limit_mps) != (road.limit_source, road.limit_mps) for each in before)

    @staticmethod
    def _near(tree: STRtree, x_m: float, y_m: float, radius_m: float) -> list[int]:
        found = tree.query(shapely.points(x_m, y_m), predicate="dwithin", distance=radius_m)
        return sorted(int(each) for each in found)

    def _drawn(self, edge_id: str, lanes: list[LaneShape]) -> EdgeView:
        inward = 1.0 if self.left_hand else -1.0
        """The sign of what is to the right of a line, towards the middle of the road."""
        areas: list[tuple[Paving, Corners]] = []
        road = self.roads.get(edge_id)
        is_fast = road is not None and road.road_class.removesuffix("_link") in MOTORWAYS
        dash_m = (6.0, 18.0) if is_fast else (3.0, 9.0)
        driven = [lane for lane in lanes if lane.kind != "foot"]
        beyond = ""
        for at, lane in enumerate(lanes):
            half_m, cover = lane.width_m / 2, _OF_KIND.get(lane.kind, Paving.ROAD)
            areas.append((cover, _band(lane.line_m, -half_m - SEAM_M, half_m + SEAM_M)))
            if cover is Paving.RAIL:
                for side in (-1, 1):
                    rail = shifted(lane.line_m, side * RAIL_M)
                    areas += ((Paving.STEEL, each) for each in painted(rail, None, 0.08))
            inner = lanes[at + 1] if at + 1 < len(lanes) else None
            border = shifted(lane.line_m, inward * half_m)
            kinds = {lane.kind, inner.kind if inner else ""}
            if "foot" in kinds and inner is not None:
                areas += ((Paving.KERB, each) for each in painted(border, None, KERB_M))
            elif inner is not None and "rail" not in kinds:
                solid = kinds & {"bus", "bicycle"}
                areas += ((Paving.WHITE, each) for each in painted(border, None if solid else dash_m))
            elif inner is None and lane.kind == "road":
                beyond = self._other_way(border)
                areas += _inner_line(border, inward, edge_id, beyond, dash_m if not is_fast else None)
                if beyond:
                    areas.insert(0, (Paving.ROAD, _band(border, -GAP_M, GAP_M)))
        outer = driven[0] if driven else lanes[0]
        edge = shifted(outer.line_m, -inward * outer.width_m / 2)
        if driven and outer.kind != "rail" and outer is lanes[0]:
            where = shifted(edge, inward * 0.25) if is_fast else edge
            cover, width_m = (Paving.WHITE, LINE_M) if is_fast else (Paving.KERB, KERB_M)
            areas += ((cover, each) for each in painted(where, None, width_m))
        for lane in driven:
            if lane.links and lane.kind != "rail":
                length_m = length_of(lane.line_m)
                piece = _pieces(lane.line_m, max(0.0, length_m - STOP_LINE_M), length_m)
                areas.append((Paving.WHITE, _band(piece, -lane.width_m / 2 + 0.1, lane.width_m / 2 - 0.1)))
        last = driven[-1] if driven else lanes[-1]
        inner_edge = shifted(last.line_m, inward * last.width_m / 2)
        beside = shifted(lanes[0].line_m, -inward * (lanes[0].width_m / 2 + 0.7))
        return EdgeView(
            edge_id,
            Areas.of(areas),
            along(beside, 0.0),
            along(beside, math.inf),
            (edge, inner_edge) if self.left_hand else (inner_edge, edge),
            ("", beyond) if self.left_hand else (beyond, ""),
            tuple((lane.lane_id, lane.line_m, lane.width_m) for lane in driven),
            tuple(
                (along(lane.line_m, math.inf), self._across(lane.line_m), lane.links)
                for lane in driven
                if lane.links and lane.kind != "rail"
            ),
        )

    def _other_way(self, border: XYs) -> str:
        """The edge of the other direction right beside an inner border; empty if there is none."""
        middle = along(border, length_of(border) / 2)
        for at in self._near(self._tree, middle.x_m, middle.y_m, 2.5):
            if any(
                lane.kind in ("road", "bus") and self._meets(lane, middle) for lane in self._lanes[self._edges[at]]
            ):
                return self._edges[at]
        return ""

    @staticmethod
    def _meets(lane: LaneShape, place: Stand) -> bool:
        """Whether a lane leads the other way right beside a place."""
        line = LineString(lane.line_m)
        point = shapely.points(place.x_m, place.y_m)
        if line.distance(point) > lane.width_m / 2 + 0.8:
            return False
        here = along(lane.line_m, float(line.project(point)))
        return abs((here.heading_deg - place.heading_deg + 360) % 360 - 180) < 30

    def _across(self, line: XYs) -> Stand:
        """Straight on at the far side of the junction at the end of a lane."""
        end = along(line, math.inf)
        angle = math.radians(end.heading_deg)
        east, north = math.sin(angle), math.cos(angle)
        ray = LineString([(end.x_m, end.y_m), (end.x_m + ACROSS_M * east, end.y_m + ACROSS_M * north)])
        far_m = 0.0
        for at in self._near(self._crossings, end.x_m + east, end.y_m + north, 0.5):
            inside = ray.intersection(self._junctions[at])
            far_m = max(far_m, 0.0 if inside.is_empty else _reach(inside, end))
        return Stand(end.x_m + (far_m + 1.0) * east, end.y_m + (far_m + 1.0) * north, end.heading_deg)


def _reach(shape: shapely.Geometry, place: Stand) -> float:
    """How far the farthest point of a shape is."""
    return max(math.dist((place.x_m, place.y_m), point) for point in shapely.get_coordinates(shape).tolist())
