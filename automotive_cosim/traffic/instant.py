"""One instant of the drive: what the driver needs on every step, and the whole state on demand.

A step of SUMO evicts everything else from the processor's caches, so whatever runs between two steps is slow.
Therefore only SUMO's plain answers are kept then (``Seen``). The states of a message are computed from them
afterwards, in a row, which takes a third of the time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from automotive_cosim.contracts import DrivingState, EgoEnd, Limit
from automotive_cosim.measures.formulas import drac_mps2, time_to_collision_s
from automotive_cosim.traffic.congestion import Route
from automotive_cosim.traffic.network import Edge
from automotive_cosim.traffic.wire import Packed, pack_limit, pack_state, unpack_state

TOUCHING_M = 0.1
"""Minimum gap in the DRAC, so that it stays finite."""


class Instant(Protocol):
    """One instant of a drive."""

    @property
    def time_s(self) -> float:
        """SUMO's simulation time."""
        ...

    @property
    def speed_mps(self) -> float: ...

    @property
    def limit_mps(self) -> float | None:
        """Speed of ``RoadHere.limit``."""
        ...

    @property
    def end(self) -> EgoEnd | None: ...

    @property
    def state(self) -> DrivingState: ...

    @property
    def packed(self) -> Packed:
        """The state as ``wire.pack_state`` gives it."""
        ...


@dataclass(frozen=True, slots=True)
class KnownInstant:
    """An instant whose state has been made already."""

    state: DrivingState

    @property
    def time_s(self) -> float:
        return self.state.time_s

    @property
    def speed_mps(self) -> float:
        return self.state.speed_mps

    @property
    def limit_mps(self) -> float | None:
        """Speed of the lane's limit."""
        return self.state.road.limit.mps

    @property
    def end(self) -> EgoEnd | None:
        """Why the drive ended, if it did."""
        return self.state.end

    @property
    def packed(self) -> Packed:
        return pack_state(self.state)


@dataclass(frozen=True, slots=True)
class Lane:
    """The part of the state that depends on a lane; it changes only with weather and signs."""

    index: int
    """Among the edge's lanes for cars."""
    limit: Limit
    friction: float
    limit_hours: str
    alone: bool | None = None
    """True where a variable sign shows that limit over this lane, and another or none over other lanes."""


Light = tuple[str, str, float]
"""Id, SUMO's letter for the ego's link, and the distance to the stop line."""

Other = tuple[str, float, float, float]
"""Id, gap, speed and closing speed of another vehicle."""
Leader = tuple[str, float, float, float, str, bool]
"""The same of the one in front, with its class and whether its brake lamps are lit."""


@dataclass(slots=True)
class Seen:
    """An instant from SUMO's answers. Everything in it is its own or immutable."""

    time_s: float
    speed_mps: float
    x_m: float
    y_m: float
    heading_deg: float
    acceleration_mps2: float
    standing_s: float
    distance_m: float
    edge_id: str
    lane_id: str
    lane_position_m: float
    edge: Edge
    """Index of the ego's edge; in a junction, of the one it comes from."""
    lane: Lane
    route: Route
    index: int
    """Index of that edge on the route."""
    position_m: float
    """Along the route."""
    light: Light | None
    leader: Leader | None
    follower: Other | None
    oncoming: Other | None
    emergency_behind: Other | None
    hazard_lights: bool
    vehicle_count: int
    lon_lat: Callable[[float, float], tuple[float | None, float | None]]
    made: DrivingState | None = None

    end = None

    @property
    def limit_mps(self) -> float | None:
        return self.lane.limit.mps

    @property
    def state(self) -> DrivingState:
        if self.made is None:
            self.made = unpack_state(self.packed)
        return self.made

    @property
    def packed(self) -> Packed:
        """See ``Instant.packed``: to make the state first would take as long again."""
        edge, lane, route = self.edge, self.lane, self.route
        lon_deg, lat_deg = self.lon_lat(self.x_m, self.y_m)
        return (
            self.time_s,
            self.x_m,
            self.y_m,
            lon_deg,
            lat_deg,
            self.heading_deg,
            self.speed_mps,
            self.acceleration_mps2,
            self.standing_s,
            self.distance_m,
            (
                self.edge_id,
                self.lane_id,
                lane.index,
                len(edge.lane_ids),
                self.lane_position_m,
                edge.name,
                edge.road_class,
                pack_limit(lane.limit),
                edge.in_tunnel,
                edge.lit,
                edge.built_up,
                edge.centre_line,
                lane.friction,
                edge.school_zone,
                lane.limit_hours,
                edge.timed_limit is not None and edge.limit_mps == edge.timed_limit.limit_mps,
                edge.bus_lane,
                lane.alone,
            ),
            route.packed_ahead(self.index, self.position_m, self.light),
            (
                self.leader and packed_other(*self.leader),
                self.follower and packed_other(*self.follower),
                self.oncoming and packed_other(*self.oncoming),
                self.emergency_behind and packed_other(*self.emergency_behind),
                route.relative_speed(self.index),
            ),
            self.hazard_lights,
            self.vehicle_count,
            None,
            None,
        )


def packed_other(
    vehicle_id: str, gap_m: float, speed_mps: float, closing_mps: float, kind: str = "", is_braking: bool = False
) -> Packed:
    """Adds time to collision and DRAC; ``closing_mps`` is positive while the gap shrinks."""
    gap_m = max(0.0, gap_m)
    ttc_s = needed_mps2 = None
    if closing_mps > 1e-3:
        ttc_s = time_to_collision_s(gap_m, closing_mps)
        needed_mps2 = drac_mps2(max(TOUCHING_M, gap_m), closing_mps)
    return vehicle_id, gap_m, speed_mps, ttc_s, needed_mps2, kind, is_braking
