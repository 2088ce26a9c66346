"""Post-encroachment times: how closely the ego and others cross or join each other's path inside junctions.

The post-encroachment time (PET) is the time between one vehicle leaving the point where two paths meet and the
other reaching it (Allen, Shin and Cooper, 1978). Paths are SUMO's lanes inside junctions, points where their centre
lines meet. Paths with the same lane before the junction only part there: who follows on them keeps a headway and
crosses nobody. Paths that lead to the same lane merge, others cross. Vehicles are sampled twice per second and
their passage is computed from position and speed, to about 0.1 s.

Beside the PET at the point stands the one by swept area, as SUMO's SSM device has it: between the first vehicle's
rear leaving the other's path, half a width further, and the second's front reaching the first's path, half a width
before.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from shapely import LineString, Point

from automotive_cosim.measures.encounters import CREEPING_MPS, LONGEST_PET_S
from automotive_cosim.measures.formulas import swept_pet_s
from automotive_cosim.traffic.base import Event
from automotive_cosim.traffic.instant import Seen
from automotive_cosim.traffic.sumo import LibSumo

LOOK_S = 0.5

NEAR_M = 30.0
"""Distance from which the junction ahead is watched, or ``LONGEST_PET_S`` before it."""


@dataclass(frozen=True, slots=True)
class _Crossing:
    """A point where the ego's path and another meet."""

    foe_lane: str
    ego_m: float
    """From the start of the ego's lane."""
    foe_m: float
    merges: bool
    """Whether both lead to the same lane."""


@dataclass(frozen=True, slots=True)
class _Ends:
    """The lanes before and after a junction that a lane inside it connects."""

    origin: str
    target: str


@dataclass(slots=True)
class _Sight:
    """A vehicle on a lane as last seen."""

    time_s: float
    position_m: float
    speed_mps: float
    length_m: float
    width_m: float

    def passage(self, point_m: float) -> tuple[float, float]:
        """When its front reached or will reach a point, and when its rear leaves it."""
        reached_s = self.time_s + (point_m - self.position_m) / self.moving_mps
        return reached_s, reached_s + self.length_m / self.moving_mps

    @property
    def moving_mps(self) -> float:
        """Its speed, and at least a creep."""
        return max(CREEPING_MPS, self.speed_mps)


@dataclass(slots=True)
class _Way:
    """One of the ego's lanes through a junction, with the vehicles that cross it."""

    crossings: tuple[_Crossing, ...]
    foes: dict[tuple[str, str], _Sight] = field(default_factory=dict)
    """Vehicles by lane and id."""
    ego: _Sight | None = None
    told: set[str] = field(default_factory=set)


class Conflicts:
    """Watches the junctions that the ego comes to."""

    def __init__(self, sumo: LibSumo, ego_id: str) -> None:
        """Starts with nothing in sight."""
        self._sumo = sumo
        self._ego = ego_id
        self._length_m = sumo.length(ego_id)
        self._width_m = sumo.vehicle.getWidth(ego_id)
        self._ends: dict[str, dict[str, _Ends]] = {}
        """By junction, the lanes before and after each lane in it."""
        self._crossings: dict[str, tuple[_Crossing, ...]] = {}
        self._ways: dict[str, _Way] = {}
        self._coming: tuple[str, tuple[str, ...], str] = ("", (), "")
        """Lane, this edge and the next of the route, and the lane through the junction between them."""

    def look(self, now: Seen) -> tuple[Event, ...]:
        """Called every ``LOOK_S``; returns the conflicts that are certain by now."""
        inside = now.lane_id if now.edge_id.startswith(":") else ""
        if not inside and not self._ways and not self._is_near(now):
            return ()
        coming = inside or self._next_lane(now)
        if coming and coming not in self._ways and self._crossings_of(coming):
            self._ways[coming] = _Way(self._crossings_of(coming))
        events: list[Event] = []
        for lane, way in list(self._ways.items()):
            self._see(way, now)
            if lane == inside:
                way.ego = _Sight(now.time_s, now.lane_position_m, now.speed_mps, self._length_m, self._width_m)
            elif way.ego is not None:
                events += self._told(way, now.time_s)
            is_past = way.ego is not None and now.time_s > way.ego.time_s + 2 * LONGEST_PET_S
            if is_past or (way.ego is None and lane != coming):
                del self._ways[lane]
        return tuple(events)

    def _is_near(self, now: Seen) -> bool:
        lane_m: float = self._sumo.lane.getLength(now.lane_id)
        return lane_m - now.lane_position_m < max(NEAR_M, LONGEST_PET_S * now.speed_mps)

    def _next_lane(self, now: Seen) -> str:
        """The lane that the ego will take through the next junction."""
        if not self._is_near(now):
            return ""
        lane, edges = now.lane_id, now.route.edge_ids[now.index : now.index + 2]
        if self._coming[:2] != (lane, edges):
            links = self._sumo.vehicle.getNextLinks(self._ego)
            self._coming = (lane, edges, links[0][4] if links else "")
        return self._coming[2]

    def _see(self, way: _Way, now: Seen) -> None:
        sumo = self._sumo
        for crossing in way.crossings:
            for vehicle in sumo.lane.getLastStepVehicleIDs(crossing.foe_lane):
                if vehicle != self._ego:
                    way.foes[crossing.foe_lane, vehicle] = _Sight(
                        now.time_s,
                        sumo.lane_position(vehicle),
                        sumo.speed(vehicle),
                        sumo.length(vehicle),
                        sumo.vehicle.getWidth(vehicle),
                    )

    def _told(self, way: _Way, now_s: float) -> list[Event]:
        """Conflicts with vehicles that have passed, once the ego is through."""
        assert way.ego is not None
        events = []
        for crossing in way.crossings:
            ego_in_s, ego_out_s = way.ego.passage(crossing.ego_m)
            for (lane, vehicle), sight in way.foes.items():
                if lane != crossing.foe_lane or vehicle in way.told or sight.time_s == now_s:
                    continue
                foe_in_s, foe_out_s = sight.passage(crossing.foe_m)
                pet_s, order = max((ego_in_s - foe_out_s, "after"), (foe_in_s - ego_out_s, "before"))
                if 0.0 <= pet_s <= LONGEST_PET_S:
                    way.told.add(vehicle)
                    first, second = (sight, way.ego) if order == "after" else (way.ego, sight)
                    swept_s = swept_pet_s(pet_s, first.moving_mps, first.width_m, second.moving_mps, second.width_m)
                    does = "merges" if crossing.merges else "crosses"
                    words = (
                        f"the ego {does} {pet_s:.2f} s {order} vehicle {vehicle} ({swept_s:.2f} s by swept area)"
                    )
                    events.append(Event(now_s, "pet", words))
        return events

    def _crossings_of(self, lane: str) -> tuple[_Crossing, ...]:
        if lane not in self._crossings:
            sumo, ends = self._sumo, self._ends_in(lane[1:].rpartition("_")[0].rpartition("_")[0])
            self._crossings[lane] = _meetings(lane, ends, sumo.lane.getShape, sumo.lane.getInternalFoes)
        return self._crossings[lane]

    def _ends_in(self, junction: str) -> dict[str, _Ends]:
        """Where each lane of a junction comes from and leads to, through the lanes in which one waits inside."""
        if junction in self._ends:
            return self._ends[junction]
        sumo = self._sumo
        ends: dict[str, _Ends] = {}
        edges = (edge for edge in sumo.junction.getIncomingEdges(junction) if not edge.startswith(":"))
        lanes = (f"{edge}_{index}" for edge in edges for index in range(sumo.edge.getLaneNumber(edge)))
        for origin in lanes:
            for link in sumo.lane.getLinks(origin):
                inner, chain = link[4], []
                while inner.startswith(":"):
                    chain.append(inner)
                    onward = sumo.lane.getLinks(inner)
                    inner = (onward[0][4] or onward[0][0]) if onward else ""
                ends |= {each: _Ends(origin, link[0]) for each in chain}
        self._ends[junction] = ends
        return ends


def _meetings(
    lane: str,
    ends: Mapping[str, _Ends],
    shape: Callable[[str], tuple[tuple[float, float], ...]],
    foes: Callable[[str], tuple[str, ...]],
) -> tuple[_Crossing, ...]:
    """Where other lanes of the junction cross a lane or join it."""
    own, from_to = LineString(shape(lane)), ends.get(lane, _Ends("", ""))
    found = []
    for foe in sorted(set(foes(lane))):
        foe_from_to = ends.get(foe, _Ends("?", "?"))
        if foe_from_to.origin == from_to.origin:
            continue
        other = LineString(shape(foe))
        common = own.intersection(other)
        if not common.is_empty:
            point = Point(common.representative_point())
            merges = foe_from_to.target == from_to.target
            found.append(_Crossing(foe, own.project(point), other.project(point), merges))
    return tuple(found)
