"""Where an OpenSCENARIO file's positions are on the lanes of a network, and what leads from one to another."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

from shapely import LineString, Point, STRtree

from automotive_cosim.exchange.roads import OpenDriveRoad, read_roads
from automotive_cosim.exchange.storyboard import ScriptEntity, route_goals
from automotive_cosim.exchange.tree import XmlElement

NEAR_M = 10.0
"""A destination farther from every lane for cars is beside the road."""
BESIDE_M = 0.3
"""So far beyond the border of its lane a place is still on it: netconvert's lanes are that exact."""
GAP_M = 9.0
"""How far before or behind a lane, in its direction, a place may be: netconvert makes room for junctions."""
ALONG_RAD = math.radians(60)
"""A vehicle whose heading differs by less from a lane's drives along it."""
ONWARD_M = 3000.0
"""How far a vehicle without a route goes straight on."""
LIKE_LANE_M = 0.2
"""Points of a lane's line that are so near have no direction."""


@dataclass(frozen=True, slots=True)
class RoadSpot:
    """A position."""

    element: XmlElement
    x_m: float
    y_m: float
    heading_rad: float | None
    """Counter-clockwise from east; None is along the lane."""
    road: OpenDriveRoad | None = None
    s_m: float = 0.0
    t_m: float = 0.0
    lane: int = 0


class RoadPositions:
    """A network's lanes for cars, and the roads of the OpenDRIVE file that it is of."""

    def __init__(self, net: Any, road: Path | None, *, keeps_left: bool = False) -> None:
        self.net, self.keeps_left = net, keeps_left
        every = [lane for edge in net.getEdges() for lane in edge.getLanes()]
        self._lanes = [lane for lane in every if lane.allows("passenger")]
        self._lines = [LineString(lane.getShape()) for lane in self._lanes]
        self._tree = STRtree(self._lines)
        self._file = road if road is not None and road.suffix == ".xodr" and road.is_file() else None
        self._read: Mapping[str, OpenDriveRoad] | None = None

    # --- positions ----------------------------------------------------------------------------------------------

    def spot(self, position: XmlElement, entities: Mapping[str, ScriptEntity]) -> RoadSpot:
        """Where a position is.

        Raises ScenarioError: it is not on the road, or counts from something that has no place at the start."""
        place = position.one(*_SPOTS)
        return _SPOTS[place.tag](self, place, entities)

    def _world(self, place: XmlElement, entities: Mapping[str, ScriptEntity]) -> RoadSpot:
        heading = place.number("h") if "h" in place.attributes else None
        return RoadSpot(place, place.number("x"), place.number("y"), heading)

    def _on_lane(self, place: XmlElement, entities: Mapping[str, ScriptEntity]) -> RoadSpot:
        road = self._road(place, place.text("roadId"))
        offset_m = place.number("offset", 0.0)
        return self._laid(place, road, place.number("s"), _lane_id(place, place.text("laneId")), offset_m)

    def _on_road(self, place: XmlElement, entities: Mapping[str, ScriptEntity]) -> RoadSpot:
        road = self._road(place, place.text("roadId"))
        return _beside(place, road, place.number("s"), place.number("t"))

    def _beside_other(self, place: XmlElement, entities: Mapping[str, ScriptEntity]) -> RoadSpot:
        """``RelativeRoadPosition``."""
        other = self._other(place, entities)
        if other.road is None:
            raise place.refused("counts along the road from a vehicle whose own place is no place on a road")
        return _beside(place, other.road, other.s_m + place.number("ds"), other.t_m + place.number("dt"))

    def _lanes_from_other(self, place: XmlElement, entities: Mapping[str, ScriptEntity]) -> RoadSpot:
        """``RelativeLanePosition``."""
        other = self._other(place, entities)
        if other.road is None or not other.lane:
            raise place.refused("counts lanes from a vehicle whose own place is on no lane of a road")
        forward = 1 if _is_along(other.road, other.lane) else -1
        ds_m = place.number("ds") if "ds" in place.attributes else forward * place.number("dsLane")
        lane, lanes = other.lane, round(place.number("dLane")) * forward
        for _ in range(abs(lanes)):  # there is no lane 0
            lane += int(math.copysign(1, lanes))
            lane = lane or int(math.copysign(1, lanes))
        return self._laid(place, other.road, other.s_m + ds_m, lane, place.number("offset", 0.0))

    def _from_other(self, place: XmlElement, entities: Mapping[str, ScriptEntity]) -> RoadSpot:
        """``RelativeObjectPosition`` and ``RelativeWorldPosition``."""
        other = self._other(place, entities)
        dx_m, dy_m, turned = place.number("dx"), place.number("dy", 0.0), 0.0
        heading = None
        if place.tag == "RelativeObjectPosition":
            turned = self.heading(other)
            heading = turned
        x_m = other.x_m + dx_m * math.cos(turned) - dy_m * math.sin(turned)
        y_m = other.y_m + dx_m * math.sin(turned) + dy_m * math.cos(turned)
        return RoadSpot(place, x_m, y_m, _oriented(place, heading, self.heading(other)))

    def _on_route(self, place: XmlElement, entities: Mapping[str, ScriptEntity]) -> RoadSpot:
        """``RoutePosition``."""
        wanted = place.part("InRoutePosition").part("FromLaneCoordinates")
        goals = [self.spot(each, entities) for each in route_goals(place.part("RouteRef").one("Route"))]
        lane, at_m = self.lane_at(goals[0], is_goal=True)
        left_m, lane_id = at_m + wanted.number("pathS"), f"_{_lane_id(wanted, wanted.text('laneId'))}"
        way = self.way("the route", lane.getEdge(), goals[1:]) if goals[1:] else [lane.getEdge()]
        ends = [(each.getShape()[0], each.getShape()[-1]) for each in way]
        for edge, gap_m in zip(way, [*(math.dist(a[1], b[0]) for a, b in pairwise(ends)), 0.0], strict=True):
            if left_m <= edge.getLength() + gap_m:
                for each, line in zip(self._lanes, self._lines, strict=True):
                    names = each.getParam("origId", "").split()
                    if each.getEdge() is edge and any(name.endswith(lane_id) for name in names):
                        here = line.interpolate(min(1.0, left_m / edge.getLength()), normalized=True)
                        spot = RoadSpot(place, here.x, here.y, None)
                        return replace(spot, heading_rad=_oriented(place, None, self.heading(spot)))
                raise place.refused(f"is on lane {lane_id[1:]}, which the route does not have there")
            left_m -= edge.getLength() + gap_m
        raise place.refused(f"is {left_m:.0f} m beyond the end of its route")

    def _other(self, place: XmlElement, entities: Mapping[str, ScriptEntity]) -> RoadSpot:
        name = place.text("entityRef")
        found = entities.get(name)
        if found is None or found.place is None:
            raise place.refused(f"counts from {name!r}, which has no place at the start")
        return self.spot(found.place, dict(entities) | {name: replace(found, place=None)})

    def _road(self, place: XmlElement, name: str) -> OpenDriveRoad:
        if self._read is None:
            self._read = read_roads(self._file) if self._file is not None else {}
        if self._file is None:
            raise place.refused("is on a road of an OpenDRIVE file, and there is none; give a WorldPosition")
        if name not in self._read:
            raise place.refused(f"is on road {name!r}, which {self._file} does not have")
        return self._read[name]

    def _laid(self, place: XmlElement, road: OpenDriveRoad, s_m: float, lane: int, offset_m: float) -> RoadSpot:
        _check_s(place, road, s_m)
        if not lane:  # the line between both directions
            return _beside(place, road, s_m, road.middle_at(s_m) + offset_m)
        lanes = road.lanes_at(s_m)
        if lane not in lanes:
            raise place.refused(f"is on lane {lane} of road {road.name}, which has none at s = {s_m:g}")
        t_m = lanes[lane][0] + offset_m
        x_m, y_m, along = road.pose(s_m, t_m)
        is_along = _is_along(road, lane)
        lane_heading = along if is_along else along + math.pi
        return RoadSpot(place, x_m, y_m, _oriented(place, lane_heading, lane_heading), road, s_m, t_m, lane)

    # --- lanes --------------------------------------------------------------------------------------------------

    def lane_at(self, spot: RoadSpot, ahead_m: float = 0.0, *, is_goal: bool = False) -> tuple[Any, float]:
        """A lane for cars, and how far along it a point ``ahead_m`` ahead of a position is.

        Raises ScenarioError: the position is not on the road, or heads against it."""
        number = self._nearest(spot, spot.x_m, spot.y_m, spot.heading_rad, is_goal=is_goal)
        if ahead_m:
            heading = self._heading(number, spot.x_m, spot.y_m)
            x_m, y_m = spot.x_m + ahead_m * math.cos(heading), spot.y_m + ahead_m * math.sin(heading)
            spot = replace(spot, x_m=x_m, y_m=y_m)
            beyond = [each for each in self._around(x_m, y_m) if self._is_on(each, x_m, y_m)]
            beyond = [each for each in beyond if abs(_turn(self._heading(each, x_m, y_m), heading)) < ALONG_RAD]
            if number not in beyond and beyond:
                number = beyond[0]
        lane, line = self._lanes[number], self._lines[number]
        share = float(line.project(Point(spot.x_m, spot.y_m))) / max(line.length, 1e-9)
        return lane, share * lane.getLength()

    def heading(self, spot: RoadSpot) -> float:
        """Which way a vehicle there heads, counter-clockwise from east.

        Raises ScenarioError: the position is not on the road."""
        if spot.heading_rad is not None:
            return spot.heading_rad
        return self._heading(self._nearest(spot, spot.x_m, spot.y_m, None), spot.x_m, spot.y_m)

    def front(self, spot: RoadSpot, front_m: float) -> tuple[float, float]:
        """Where the front bumper of a vehicle is whose reference point is there."""
        heading = self.heading(spot)
        return spot.x_m + front_m * math.cos(heading), spot.y_m + front_m * math.sin(heading)

    def _nearest(
        self, spot: RoadSpot, x_m: float, y_m: float, heading: float | None, *, is_goal: bool = False
    ) -> int:
        around = self._around(x_m, y_m)
        if not around:
            raise spot.element.refused("is on a network without lanes for cars")
        on = [each for each in around if self._is_on(each, x_m, y_m)]
        along = [
            each for each in on if heading is None or abs(_turn(self._heading(each, x_m, y_m), heading)) < ALONG_RAD
        ]
        if along:
            return along[0]
        away_m = float(self._lines[around[0]].distance(Point(x_m, y_m)))
        if on and not is_goal:
            raise spot.element.refused("heads against or across the lane that it is on, which is not imported")
        if not (is_goal and away_m <= NEAR_M):
            raise spot.element.refused(
                f"is {away_m:.1f} m from the middle of the nearest lane for cars, beside the road"
            )
        return around[0]

    def _around(self, x_m: float, y_m: float) -> Sequence[int]:
        """The lanes near a point, the nearest first."""
        here = Point(x_m, y_m)
        found = self._tree.query(here.buffer(GAP_M), predicate="intersects").tolist()
        found = found or self._tree.query_nearest(here, all_matches=False).tolist()
        return sorted(
            found, key=lambda each: (round(self._lines[each].distance(here), 3), self._lanes[each].getID())
        )

    def _is_on(self, number: int, x_m: float, y_m: float) -> bool:
        """Whether a point is on a lane, or just before or behind it."""
        half_m = self._lanes[number].getWidth() / 2 + BESIDE_M
        line, here = self._lines[number], Point(x_m, y_m)
        away_m = float(line.distance(here))
        if away_m <= half_m:
            return True
        nearest = line.interpolate(line.project(here))
        heading = self._heading(number, x_m, y_m)
        dx_m, dy_m = x_m - nearest.x, y_m - nearest.y
        is_end = (
            min(Point(line.coords[0]).distance(nearest), Point(line.coords[-1]).distance(nearest)) < LIKE_LANE_M
        )
        return is_end and away_m <= GAP_M and abs(dy_m * math.cos(heading) - dx_m * math.sin(heading)) <= half_m

    def _heading(self, number: int, x_m: float, y_m: float) -> float:
        """A lane's heading beside a point."""
        line = self._lines[number]
        at_m = min(max(float(line.project(Point(x_m, y_m))), LIKE_LANE_M), line.length - LIKE_LANE_M)
        before, behind = line.interpolate(at_m - LIKE_LANE_M), line.interpolate(at_m + LIKE_LANE_M)
        return math.atan2(behind.y - before.y, behind.x - before.x)

    # --- ways ---------------------------------------------------------------------------------------------------

    def way(self, name: str, first: Any, goals: Sequence[RoadSpot]) -> list[Any]:
        """The edges from the first over the goals; without any, straight on.

        Raises ScenarioError: no road leads to one of them."""
        edges = [first]
        for goal in goals:
            target = self.lane_at(goal, is_goal=True)[0].getEdge()
            found, _ = self.net.getFastestPath(edges[-1], target, vClass="passenger")
            if found is None:
                raise goal.element.refused(f"cannot be reached by {name} from edge {edges[-1].getID()}")
            edges += found[1:]
        return edges if goals else edges + list(self._onward(first))

    def _onward(self, edge: Any) -> Iterator[Any]:
        left_m, seen = ONWARD_M, {edge}
        while left_m > 0:
            ways = [
                (connection.getDirection() != "s", there.getID(), there)
                for there, connections in edge.getOutgoing().items()
                for connection in connections
                if there.allows("passenger") and there not in seen and connection.getDirection() != "t"
            ]
            if not ways:
                return
            edge = min(ways)[2]
            seen.add(edge)
            left_m -= edge.getLength()
            yield edge

    def lane_of(self, edges: Sequence[Any], road: str, lane: int) -> int | None:
        """Where a lane of OpenDRIVE is among the lanes for cars of each of these edges that has it; None if that
        differs, or none has it."""
        found: set[int] = set()
        for edge in edges:
            cars = [each for each in edge.getLanes() if each.allows("passenger")]
            names = [each.getParam("origId", "").split() for each in cars]
            found |= {number for number, own in enumerate(names) if f"{road}_{lane}" in own}
        return found.pop() if len(found) == 1 else None


_SPOTS = {
    "LanePosition": RoadPositions._on_lane,
    "RelativeLanePosition": RoadPositions._lanes_from_other,
    "RelativeObjectPosition": RoadPositions._from_other,
    "RelativeRoadPosition": RoadPositions._beside_other,
    "RelativeWorldPosition": RoadPositions._from_other,
    "RoadPosition": RoadPositions._on_road,
    "RoutePosition": RoadPositions._on_route,
    "WorldPosition": RoadPositions._world,
}


def _turn(to: float, of: float) -> float:
    return (to - of + math.pi) % (2 * math.pi) - math.pi


def _is_along(road: OpenDriveRoad, lane: int) -> bool:
    """Whether a lane is driven in the direction of s."""
    return (lane < 0) != road.keeps_left


def _lane_id(place: XmlElement, text: str) -> int:
    try:
        return int(text)
    except ValueError as error:
        raise place.refused(f"has laneId = {text!r}, which is no number") from error


def _check_s(place: XmlElement, road: OpenDriveRoad, s_m: float) -> None:
    if not 0 <= s_m <= road.length_m:
        raise place.refused(f"is at s = {s_m:g} m of road {road.name}, which is {road.length_m:g} m long")


def _beside(place: XmlElement, road: OpenDriveRoad, s_m: float, t_m: float) -> RoadSpot:
    _check_s(place, road, s_m)
    x_m, y_m, heading = road.pose(s_m, t_m)
    return RoadSpot(place, x_m, y_m, _oriented(place, heading, heading), road, s_m, t_m)


def _oriented(place: XmlElement, usual: float | None, relative_to: float) -> float | None:
    """The heading that a position states; the usual one if it states none."""
    stated = place.find("Orientation")
    if stated is None:
        return usual
    h = stated.number("h", 0.0)
    return h + relative_to if stated.word("type", "relative", "absolute", otherwise="absolute") == "relative" else h
