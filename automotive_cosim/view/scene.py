"""What is in sight, as plain data: nothing that the simulation does not hold, and nothing of what judges know."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import pairwise
from typing import Protocol

from automotive_cosim.contracts import (
    KMH_PER_MPS,
    MPH_PER_MPS,
    DrivingState,
    IncidentKind,
    Limit,
    RoadNetwork,
    RoadShapes,
    RoadSnapshot,
    SeenVehicle,
    Weather,
)
from automotive_cosim.view.lens import Corners, Lens
from automotive_cosim.view.roads import Areas, EdgeView, Stand, StreetMap, along

SIGHT_M, SIGNS_M, BUILDINGS_M = 200.0, 120.0, 260.0
"""How far roads and vehicles, signs and signals, and buildings are drawn."""
EYE_M, BEHIND_BUMPER_M, REAR_EYE_M = 1.35, 1.7, 1.0
"""Height of the lens at the windshield and how far it is behind the front bumper, and height of the rear one."""
EGO = "ego"


class Board(StrEnum):
    """What stands beside or on the road."""

    LIMIT = "limit"
    END_OF_LIMIT = "end_of_limit"
    SCHOOL = "school"
    STOP = "stop"
    GIVE_WAY = "give_way"
    ROADWORKS = "roadworks"
    CLOSED = "closed"
    CONE = "cone"
    BARRIER = "barrier"


@dataclass(frozen=True, slots=True)
class Posted:
    """A sign, or something that closes a lane."""

    board: Board
    place: Stand
    figure: str = ""
    """On a limit, in the unit of the country."""
    width_m: float = 0.0
    """Of a barrier."""
    above: int = 0
    """How many others stand at the same post, below it."""


@dataclass(frozen=True, slots=True)
class Head:
    """The head of a signal."""

    place: Stand
    state: str
    """One of SUMO's letters."""
    up_m: float
    """Height of its middle."""
    aside_m: float = 0.0
    """How far to the right of its place it hangs."""


@dataclass(frozen=True, slots=True)
class Outside:
    """Light and air."""

    weather: Weather
    sun_deg: float | None
    """Elevation of the sun; None without a place on earth, where it is day. The same of the next."""
    sun_azimuth_deg: float | None
    in_tunnel: bool
    lit: bool
    """Whether there are street lamps."""
    country: str
    """Whose signs stand here, ISO 3166-1; empty if unknown."""
    unit: str = "km/h"
    """Of the speeds on them."""


@dataclass(frozen=True, slots=True)
class OwnCar:
    """What of the own car changes the view."""

    low_beam: bool = False
    high_beam: bool = False
    windshield_fog: float = 0.0
    """Share of the glass that is fogged inside, and that is wet outside."""
    windshield_film: float = 0.0
    reverse: bool = False


@dataclass(frozen=True, slots=True)
class Scene:
    """Everything that a picture shows."""

    lens: Lens
    time_s: float
    streets: tuple[EdgeView, ...]
    tunnels: tuple[EdgeView, ...]
    """Those of the streets that have walls and a roof."""
    ground: Areas
    """Green, water, junctions and zebra crossings."""
    buildings: tuple[Corners, ...]
    """Their outlines."""
    vehicles: tuple[SeenVehicle, ...]
    people: tuple[SeenVehicle, ...]
    posted: tuple[Posted, ...]
    heads: tuple[Head, ...]
    outside: Outside
    car: OwnCar


class Signed(Protocol):
    """Says what signs show."""

    def shown(self, limit: Limit) -> Limit: ...


class Sights:
    """Makes scenes of one network."""

    def __init__(self, shapes: RoadShapes, network: RoadNetwork, signed: Signed | None = None) -> None:
        """Indexes it: 20 ms for three thousand lanes.

        Args:
            signed: what a sign shows in a network that was moved to another country; None as it is."""
        self.of = shapes, network, signed
        self._map = StreetMap(shapes, network)
        self._signed = signed

    def scene(
        self, snapshot: RoadSnapshot, driving: DrivingState, outside: Outside, car: OwnCar, length_m: float = 5.0
    ) -> Scene:
        """What is in sight now.

        Args:
            snapshot: the vehicles and signals of this instant.
            driving: the own car on its road.
            car: the own car's lamps and glass.
            length_m: length of a car that is not on the road any more."""
        own = next((each for each in snapshot.vehicles if each.vehicle_id == EGO), None)
        lens = _lens(driving, car, own.length_m if own else length_m)
        x_m, y_m = lens.x_m, lens.y_m
        route = [each for each in driving.ahead.route_edges[:12] if self._map.has(each)]
        below = outside.in_tunnel
        near = self._map.streets(x_m, y_m, SIGHT_M)
        reached = set(_reached(route, SIGHT_M, self._map))
        reached |= {each for edge in reached for each in self._map.street(edge).beyond}
        hidden = {each.edge_id for each in near if self._map.in_tunnel(each.edge_id) != below} - reached
        streets = tuple(each for each in near if each.edge_id not in hidden)
        there = [each for each in near if each.edge_id in hidden]
        lights = dict(snapshot.lights)
        return Scene(
            lens,
            snapshot.time_s,
            streets,
            tuple(each for each in streets if self._map.in_tunnel(each.edge_id)),
            self._map.ground(x_m, y_m, SIGHT_M),
            () if below else tuple(self._map.buildings(x_m, y_m, BUILDINGS_M)),
            tuple(
                each
                for each in snapshot.vehicles
                if each is not own and _is_near(each, lens) and not (there and _is_on(each, there, streets))
            ),
            tuple(each for each in snapshot.people if _is_near(each, lens) and not below),
            _stacked(self._posted(streets, snapshot, driving, outside, route)),
            tuple(head for street in streets for head in _heads(street, lights, lens)),
            outside,
            car,
        )

    def _posted(
        self,
        streets: tuple[EdgeView, ...],
        snapshot: RoadSnapshot,
        driving: DrivingState,
        outside: Outside,
        route: list[str],
    ) -> Iterator[Posted]:
        ahead, ids = driving.ahead, {each.edge_id for each in streets}
        begins_m, ends_m = self._distances(route, driving)
        told = _nearest(begins_m, ahead.next_limit_distance_m)
        known = set(begins_m) if told is None else set(list(begins_m)[: list(begins_m).index(told) + 1])
        if told in ids and ahead.next_limit is not None and ahead.next_limit.is_posted:
            yield _limit(ahead.next_limit, self._map.street(told or "").begin, outside)
        for street in streets:
            road = self._map.roads.get(street.edge_id)
            if road is None:
                continue
            if street.edge_id not in known and self._map.posts(street.edge_id):
                limit = Limit(road.limit_mps, road.limit_source)
                yield _limit(self._signed.shown(limit) if self._signed else limit, street.begin, outside)
            before = self._map.before.get(street.edge_id, ())
            if road.school_zone and not all(
                self._map.roads[each].school_zone for each in before if each in self._map.roads
            ):
                yield Posted(Board.SCHOOL, street.begin)
        stop = _nearest(ends_m, ahead.sign_distance_m)
        if stop in ids and ahead.next_sign in ("stop", "give_way"):
            yield Posted(Board(ahead.next_sign), self._map.street(stop or "").stop)
        works = {each.edge_id for each in ahead.incidents if each.kind is IncidentKind.ROADWORKS}
        schools = {each.edge_id for each in ahead.incidents if each.kind is IncidentKind.SCHOOL_ZONE}
        for street in streets:
            lanes = [lane for lane in street.lanes if lane[0] in snapshot.closed]
            if street.edge_id in schools:
                yield Posted(Board.SCHOOL, street.begin)
            if lanes and len(lanes) == len(street.lanes):
                yield Posted(Board.CLOSED, street.begin)
            elif lanes or street.edge_id in works:
                yield Posted(Board.ROADWORKS, street.begin)
            for _, line, width_m in lanes:
                yield Posted(Board.BARRIER, along(line, 2.0), width_m=width_m)
                if len(lanes) < len(street.lanes):
                    for at in range(12):
                        yield Posted(Board.CONE, along(line, 6.0 + 8.0 * at))

    def _distances(self, route: list[str], driving: DrivingState) -> tuple[dict[str, float], dict[str, float]]:
        """How far it is to where each edge of the route begins and ends."""
        begins: dict[str, float] = {}
        ends: dict[str, float] = {}
        at_m = -driving.road.lane_position_m if route[:1] == [driving.road.edge_id] else 0.0
        for before, edge in zip([None, *route], route, strict=False):
            at_m += 0.0 if before is None else self._map.lengths_m.get((before, edge), 0.0)
            begins[edge] = at_m
            at_m += self._map.roads[edge].length_m
            ends[edge] = at_m
        return begins, ends


def _nearest(places: Mapping[str, float], distance_m: float | None) -> str | None:
    """The edge whose place is at a distance, as far as one is seen."""
    if distance_m is None or distance_m > SIGHT_M or not places:
        return None
    found = min(places, key=lambda each: abs(places[each] - distance_m))
    return found if abs(places[found] - distance_m) < 30.0 else None


def _lens(driving: DrivingState, car: OwnCar, length_m: float) -> Lens:
    angle = math.radians(driving.heading_deg)
    east, north = math.sin(angle), math.cos(angle)
    back_m = length_m if car.reverse else BEHIND_BUMPER_M
    x_m, y_m = driving.x_m - back_m * east, driving.y_m - back_m * north
    if car.reverse:
        return Lens(x_m, y_m, (driving.heading_deg + 180) % 360, REAR_EYE_M, 0.55, 0.36, mirrored=True)
    return Lens(x_m, y_m, driving.heading_deg, EYE_M, 0.8, 0.46)


def _reached(route: list[str], within_m: float, roads: StreetMap) -> Iterator[str]:
    """The edges of the route that begin within a distance of the present one's end."""
    left_m = within_m
    for at, edge in enumerate(route):
        if left_m < 0:
            return
        yield edge
        left_m -= roads.roads[edge].length_m if at else 0.0


def _is_near(vehicle: SeenVehicle, lens: Lens) -> bool:
    _, ahead, _ = lens.sees(vehicle.x_m, vehicle.y_m)
    return -5.0 < ahead < SIGHT_M + 20.0


def _is_on(vehicle: SeenVehicle, hidden: list[EdgeView], streets: tuple[EdgeView, ...]) -> bool:
    """Whether a vehicle is nearer to a street on another level than to one in sight."""

    def away(group: list[EdgeView] | tuple[EdgeView, ...]) -> float:
        lines = (line for street in group for _, line, _ in street.lanes)
        return min((_distance(line, vehicle) for line in lines), default=math.inf)

    return away(hidden) + 0.5 < away(streets)


def _distance(line: tuple[tuple[float, float], ...], vehicle: SeenVehicle) -> float:
    best = math.inf
    for (ax, ay), (bx, by) in pairwise(line):
        dx, dy = bx - ax, by - ay
        share = ((vehicle.x_m - ax) * dx + (vehicle.y_m - ay) * dy) / ((dx * dx + dy * dy) or 1.0)
        share = min(1.0, max(0.0, share))
        best = min(best, math.hypot(vehicle.x_m - ax - share * dx, vehicle.y_m - ay - share * dy))
    return best


def _stacked(posted: Iterable[Posted]) -> tuple[Posted, ...]:
    """Signs at the same post above each other, each once."""
    at: dict[Stand, int] = {}
    found = []
    for each in dict.fromkeys(posted):
        found.append(replace(each, above=at.get(each.place, 0)))
        at[each.place] = at.get(each.place, 0) + 1
    return tuple(found)


def _limit(limit: Limit, place: Stand, outside: Outside) -> Posted:
    if limit.mps is None:
        return Posted(Board.END_OF_LIMIT, place)
    figure = limit.mps * (MPH_PER_MPS if outside.unit == "mph" else KMH_PER_MPS)
    return Posted(Board.LIMIT, place, f"{figure:.0f}")


def _heads(street: EdgeView, lights: Mapping[str, str], lens: Lens) -> Iterator[Head]:
    """At the kerb before the junction for the lane there, and across it over each lane; two beside each other where
    a lane's ways have different lights."""
    kerb = True
    for near, across, links in street.signals:
        _, ahead, _ = lens.sees(near.x_m, near.y_m)
        states = [lights[light][at] for light, at in links if at < len(lights.get(light, ""))]
        if not states or not -80.0 < ahead < SIGNS_M:
            continue
        shown = list({state.lower(): state for state in states}.values())[:2]
        for at, state in enumerate(shown):
            aside_m = 0.5 * (at - (len(shown) - 1) / 2)
            yield Head(across, state, 5.2, aside_m)
            if kerb:
                yield Head(street.stop, state, 3.0, aside_m)
        kerb = False


def without(scene: Scene, vehicle_id: str) -> Scene:
    """The same without one vehicle or person."""
    return replace(
        scene,
        vehicles=tuple(each for each in scene.vehicles if each.vehicle_id != vehicle_id),
        people=tuple(each for each in scene.people if each.vehicle_id != vehicle_id),
    )


_last: list[Sights] = []


def sight_of(shapes: RoadShapes, network: RoadNetwork, signed: Signed | None) -> Sights:
    """The index of a network; the last one is kept, as all drives of a scenario have the same."""
    kept = _last[-1] if _last else None
    if kept is None or kept.of[0] is not shapes or kept.of[2] != signed:
        kept = Sights(shapes, network, signed)
        _last[:] = [kept]
    return kept
