"""Pieces of road laid end to end as a network, for scripted drives."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias

from automotive_cosim.contracts import KMH_PER_MPS, IncidentKind, LimitSource, RoadIncident, RoadNetwork
from automotive_cosim.traffic.congestion import SLOW_BELOW, Route
from automotive_cosim.traffic.network import Edge, Network, road_of

EARTH_RADIUS_M = 6_371_008.8
"""Mean radius of the earth (IUGG)."""

UNLIMITED_MPS = 142 / KMH_PER_MPS
"""Speed in SUMO's networks of a road without a limit."""

LonLat: TypeAlias = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Leader:
    """A vehicle that drives ahead on a stretch, at a steady speed, and leaves at its end."""

    gap_m: float
    """Bumper to bumper as the ego enters the stretch."""
    speed_kmh: float


@dataclass(frozen=True, slots=True)
class Stretch:
    """A piece of road, straight on from the previous one."""

    name: str = ""
    length_m: float = 500.0
    limit_kmh: float | None = 50.0
    limit_source: LimitSource = LimitSource.POSTED
    road_class: str = "secondary"
    lane_count: int = 1
    in_tunnel: bool = False
    lit: bool | None = None
    built_up: bool | None = True
    centre_line: bool | None = None
    friction: float = 1.0
    relative_speed: float = 1.0
    """Relative speed of the traffic; the ego cannot go faster if this is under 1."""
    leader: Leader | None = None
    oncoming_gap_m: float | None = None
    """Distance of a vehicle that comes towards the ego, throughout the stretch."""
    incident: IncidentKind | None = None
    """Incident that live traffic reports at the start of the stretch."""

    @property
    def free_mps(self) -> float:
        """Speed on it at free flow."""
        return UNLIMITED_MPS if self.limit_kmh is None else self.limit_kmh / KMH_PER_MPS


class Layout:
    """Stretches as a network, with their positions and the sums of a route. Shared by all drives."""

    def __init__(self, stretches: tuple[Stretch, ...], origin: LonLat | None, heading: float) -> None:
        self.stretches = stretches
        self.heading_deg = math.degrees(heading)
        self._origin = origin
        self._east, self._north = math.sin(heading), math.cos(heading)
        starts_m = [0.0]
        for stretch in stretches:
            starts_m.append(starts_m[-1] + stretch.length_m)
        self.starts_m = tuple(starts_m)
        edges = {f"stretch{index}": self._edge(index) for index in range(len(stretches))}
        self.network = Network(edges, {}, {}, self._map(edges.values()))
        incidents = (
            RoadIncident(stretch.incident, f"stretch{index}", 0.0)
            for index, stretch in enumerate(stretches)
            if stretch.incident is not None
        )
        self.route = Route(tuple(edges), self.network, self, tuple(incidents))

    def __deepcopy__(self, memo: object) -> Layout:
        return self

    def speed_mps(self, edge_id: str) -> float:
        """Speed of the traffic."""
        index = int(edge_id.removeprefix("stretch"))
        return self.stretches[index].relative_speed * self.stretches[index].free_mps

    def free_mps(self, edge_id: str) -> float:
        """Its speed without traffic."""
        return self.network.edges[edge_id].speed_mps

    def slow_edges(self) -> tuple[tuple[str, float], ...]:
        """Stretches where the traffic is slow."""
        shares = ((f"stretch{index}", stretch.relative_speed) for index, stretch in enumerate(self.stretches))
        return tuple((edge_id, share) for edge_id, share in shares if share < SLOW_BELOW)

    def position(self, along_m: float) -> tuple[float, float]:
        """(x, y) in metres, the start being the origin."""
        return along_m * self._east, along_m * self._north

    def lon_lat(self, along_m: float) -> LonLat | None:
        """WGS 84, by the projection that the map names."""
        if self._origin is None:
            return None
        x_m, y_m = self.position(along_m)
        lon_deg, lat_deg = self._origin
        east_m_per_rad = EARTH_RADIUS_M * math.cos(math.radians(lat_deg))
        return lon_deg + math.degrees(x_m / east_m_per_rad), lat_deg + math.degrees(y_m / EARTH_RADIUS_M)

    def index_at(self, along_m: float) -> int:
        """The stretch at a distance from the start."""
        return max(0, min(bisect_right(self.starts_m, along_m), len(self.stretches)) - 1)

    def _edge(self, index: int) -> Edge:
        stretch = self.stretches[index]
        edge_id = f"stretch{index}"
        return Edge(
            edge_id=edge_id,
            from_node=f"node{index}",
            to_node=f"node{index + 1}",
            name=stretch.name,
            road_class=stretch.road_class,
            lane_ids=tuple(f"{edge_id}_{lane}" for lane in range(stretch.lane_count)),
            length_m=stretch.length_m,
            speed_mps=stretch.free_mps,
            lane_mps=(stretch.free_mps,) * stretch.lane_count,
            limit_mps=None if stretch.limit_kmh is None else stretch.limit_kmh / KMH_PER_MPS,
            limit_source=stretch.limit_source,
            in_tunnel=stretch.in_tunnel,
            lit=stretch.lit,
            built_up=stretch.built_up,
            centre_line=stretch.centre_line,
            shape_m=(self.position(self.starts_m[index]), self.position(self.starts_m[index + 1])),
        )

    def _map(self, edges: Iterable[Edge]) -> RoadNetwork:
        end_x_m, end_y_m = self.position(self.starts_m[-1])
        projection = None
        if self._origin is not None:
            lon_deg, lat_deg = self._origin
            projection = (
                f"+proj=eqc +lat_ts={lat_deg} +lat_0={lat_deg} +lon_0={lon_deg} +R={EARTH_RADIUS_M} +no_defs"
            )
        return RoadNetwork(
            roads=tuple(road_of(edge) for edge in edges),
            bounds_m=(min(0.0, end_x_m), min(0.0, end_y_m), max(0.0, end_x_m), max(0.0, end_y_m)),
            projection=projection,
            offset_m=(0.0, 0.0),
            left_hand=False,
        )
