"""Reads SUMO's state of the ego and its road, once per step."""

from __future__ import annotations

import math
from collections.abc import Callable

from automotive_cosim.contracts import STANDING_BELOW_MPS, Limit, LimitSource, RoadIncident, SumoSignal
from automotive_cosim.traffic.congestion import Congestion, Route
from automotive_cosim.traffic.georeference import GeoReference
from automotive_cosim.traffic.instant import Lane, Leader, Light, Other, Seen
from automotive_cosim.traffic.network import NO_LIMIT_FROM_MPS, Edge, Network
from automotive_cosim.traffic.sumo import LibSumo

LEADER_RANGE_M = 200.0
SIGHT_M = 300.0
"""Distance within which to look for oncoming and emergency vehicles."""

LOOK_S = 1.0
"""Interval of searching for the next signal and the nearest oncoming vehicle, which are tracked each step."""

NO_GAP_M = 1e6
"""A larger gap means that SUMO found none (near junctions it may report about -1.8e308)."""

INVALID_M = -1e6
"""SUMO puts the coordinates of a vehicle that is on no road below this (INVALID_DOUBLE_VALUE)."""


class Sensor:
    """Reads the ego's state. It stores what SUMO does not: stationary time, the route's sums, the last edge."""

    def __init__(
        self,
        sumo: LibSumo,
        ego_id: str,
        network: Network,
        congestion: Congestion,
        incidents: Callable[[], tuple[RoadIncident, ...]],
        emergency: set[str],
        step_s: float,
    ) -> None:
        """Starts with the ego just inserted.

        Args:
            sumo: the running simulation.
            ego_id: the ego's vehicle.
            congestion: smoothed speeds.
            incidents: gives those that live traffic reports now.
            emergency: vehicles with blue lights, updated by the owner.
        """
        self._sumo = sumo
        self._ego = ego_id
        self._network = network
        self._congestion = congestion
        self._incidents = incidents
        self._emergency = emergency
        self._step_s = step_s
        self._lon_lat = _converter(sumo, network)
        self._standing_s = 0.0
        self._odometer_m = 0.0
        self.position_m = 0.0
        """Along the route, from its start."""
        self.on_edge_m = 0.0
        """On the edge of the route, or on the lane across a junction."""
        self._edge: Edge = network.edges[sumo.edge_of(ego_id)]
        self.makes_way = False
        """Whether a vehicle with its blue lights on is behind."""
        self._is_opposite = False
        """Whether it overtakes in the opposite lane."""
        self._min_gap_m = sumo.min_gap(ego_id)
        self.looks_around = True
        """Whether to look for signals, other vehicles and the traffic ahead; without it, only the drive is read."""
        self._look_steps = max(1, round(LOOK_S / step_s))
        self._steps = 0
        self._lanes: dict[str, Lane] = {}
        self._light: tuple[str, int, float] | None = None
        """The next signal: id, index of the ego's link, and position of its stop line on the route."""
        self._oncoming_id = ""
        self._follower_id = ""
        self._follower_min_gap_m = 0.0
        self.route: Route
        self.refresh()

    @property
    def knows_emergency(self) -> bool:
        """Whether a vehicle with its blue lights on is anywhere on the road."""
        return bool(self._emergency)

    def refresh(self) -> None:
        """Updates the route, or congestion and incidents."""
        self._lanes.clear()
        edges = self._sumo.route(self._ego)
        if self.looks_around or tuple(edges) != self.route.edge_ids:
            self.route = Route(edges, self._network, self._congestion, self._incidents())
        self._steps = 0

    def read(self, *, hazard_lights: bool, vehicle_count: int) -> Seen:
        sumo, ego = self._sumo, self._ego
        x_m, y_m = sumo.position(ego)
        heading_deg, speed_mps = sumo.angle(ego), sumo.speed(ego)
        self._standing_s = self._standing_s + self._step_s if speed_mps < STANDING_BELOW_MPS else 0.0
        odometer_m = sumo.driven(ego)
        index = sumo.route_index(ego)
        edge_id = sumo.edge_of(ego)
        lane_position_m = sumo.lane_position(ego)
        lane_id = sumo.lane_of(ego)
        if edge_id.startswith(":"):
            if self._is_opposite:
                odometer_m = self._odometer_m + speed_mps * self._step_s
            self.position_m += odometer_m - self._odometer_m
        else:
            self._is_opposite = False
            if (edge_id,) != self.route.edge_ids[index : index + 1]:
                edges = sumo.route(ego)
                if tuple(edges) != self.route.edge_ids:
                    self.refresh()  # a rerouter of the scenario's has sent it another way
                self._is_opposite = edge_id != edges[index]
                if self._is_opposite:
                    odometer_m -= lane_position_m
                    edge_id, lane_id, lane_position_m = self._own_side(edges[index], lane_position_m)
                    odometer_m += lane_position_m
            self._edge = self._network.edges[edge_id]
            self.position_m = self.route.position_m(index, lane_position_m)
        self._odometer_m, self.on_edge_m = odometer_m, lane_position_m
        lane_id = lane_id or self._edge.lane_ids[0]  # parked beside the kerb it is on none
        lane = self._lanes.get(lane_id)
        if lane is None:
            lane = self._lanes[lane_id] = self._read_lane(lane_id)
        is_looking = self._steps % self._look_steps == 0
        self._steps += 1
        light = leader = follower = oncoming = None
        emergency = self._emergency_behind(x_m, y_m, heading_deg, speed_mps) if self._emergency else None
        self.makes_way = emergency is not None
        if self.looks_around:
            if is_looking or (self._light and self._light[2] <= self.position_m):
                self._look_for_light()
            if is_looking:
                self._oncoming_id = self._look_for_oncoming(index)
            light, follower = self._next_light(), self._follower(speed_mps)
            leader = self._overtaken(index) if self._is_opposite else self._leader(speed_mps)
            if self._oncoming_id:
                oncoming = self._oncoming(index, x_m, y_m, heading_deg, speed_mps)
        return Seen(
            sumo.time(),
            speed_mps,
            x_m,
            y_m,
            heading_deg,
            sumo.acceleration(ego),
            self._standing_s,
            odometer_m,
            edge_id,
            lane_id,
            lane_position_m,
            self._edge,
            lane,
            self.route,
            index,
            self.position_m,
            light,
            leader,
            follower,
            oncoming,
            emergency if self.looks_around else None,
            hazard_lights,
            vehicle_count,
            self._lon_lat,
        )

    def _read_lane(self, lane_id: str) -> Lane:
        """The part that does not change on a lane, except with weather and signs, which cause a refresh."""
        sumo, edge = self._sumo, self._edge
        friction = sumo.friction(lane_id)
        if lane_id in edge.lane_ids:
            index = edge.lane_ids.index(lane_id)
            lane_mps = edge.lane_mps[index]
            signed = edge.signed_lanes | edge.variable_lanes
            has_none = edge.limit_mps is None and (not signed or lane_mps >= NO_LIMIT_FROM_MPS)
            source = LimitSource.POSTED if lane_id in edge.signed_lanes else edge.limit_source
            source = LimitSource.VARIABLE if lane_id in edge.variable_lanes else source
            own = Limit(None if has_none else lane_mps, source)
            alone = source is LimitSource.VARIABLE and len({*edge.lane_mps}) > 1
            return Lane(index, own, friction, edge.limit_hours, alone or None)
        return Lane(sumo.lane_index(self._ego), edge.limit, friction, edge.limit_hours)

    def _look_for_light(self) -> None:
        lights = self._sumo.next_lights(self._ego)
        self._light = (lights[0][0], lights[0][1], self.position_m + lights[0][2]) if lights else None

    def _next_light(self) -> Light | None:
        if self._light is None:
            return None
        tls_id, link, stop_line_m = self._light
        return tls_id, self._sumo.light_state(tls_id)[link], max(0.0, stop_line_m - self.position_m)

    def _leader(self, speed_mps: float) -> Leader | None:
        """Gap from the ego's bumper; SUMO's excludes the minimum gap."""
        found = self._sumo.leader(self._ego, LEADER_RANGE_M)
        if found is None or not found[0] or abs(found[1]) > NO_GAP_M:
            return None
        other_mps = self._sumo.speed(found[0])
        return found[0], found[1] + self._min_gap_m, other_mps, speed_mps - other_mps, *self._looks(found[0])

    def _looks(self, vehicle: str) -> tuple[str, bool]:
        """Class of a vehicle in front, and whether its brake lamps are lit."""
        sumo = self._sumo
        return sumo.vehicle_class(vehicle), bool(sumo.vehicle.getSignals(vehicle) & SumoSignal.BRAKE)

    def _own_side(self, edge_id: str, opposite_m: float) -> tuple[str, str, float]:
        """Edge, lane and position on the car's own side of the road while it overtakes in the opposite lane, whose
        edge, lane and position SUMO gives then: the lane beside that one, as far from the other end."""
        edge = self._network.edges[edge_id]
        return edge_id, edge.lane_ids[-1], max(0.0, edge.length_m - opposite_m)

    def _overtaken(self, index: int) -> Leader | None:
        """The next vehicle on the own side, which SUMO does not tell while the car is on the other. It is not in
        the car's way, so they do not close in."""
        sumo, ego_m = self._sumo, self.position_m
        for leg in range(index, len(self.route.edge_ids)):
            start_m = self.route.position_m(leg, 0.0)
            if start_m - ego_m > LEADER_RANGE_M:
                break
            ahead = (
                (start_m + sumo.lane_position(vehicle) - ego_m, vehicle)
                for vehicle in sumo.edge_vehicles(self.route.edge_ids[leg])
            )
            front_m, nearest = min((each for each in ahead if each[0] > 0), default=(math.inf, ""))
            if nearest:
                gap_m = front_m - sumo.length(nearest)
                told = (nearest, gap_m, sumo.speed(nearest), 0.0, *self._looks(nearest))
                return told if gap_m <= LEADER_RANGE_M else None
        return None

    def _follower(self, speed_mps: float) -> Other | None:
        found_id, gap_m = self._sumo.follower(self._ego, LEADER_RANGE_M)
        if not found_id or abs(gap_m) > NO_GAP_M:
            return None
        if found_id != self._follower_id:
            self._follower_id, self._follower_min_gap_m = found_id, self._sumo.min_gap(found_id)
        other_mps = self._sumo.speed(found_id)
        return found_id, gap_m + self._follower_min_gap_m, other_mps, other_mps - speed_mps

    def _look_for_oncoming(self, index: int) -> str:
        """The nearest vehicle on the opposite edges of the route's next edges that is still ahead."""
        sumo, edges = self._sumo, self._network.edges
        for leg in range(index, len(self.route.edge_ids)):
            edge_id = self.route.edge_ids[leg]
            start_m = self.route.position_m(leg, 0.0) - self.position_m
            opposite = self._network.opposite.get(edge_id)
            if start_m > SIGHT_M or opposite is None or edges[edge_id].name != self._edge.name:
                return ""
            length_m = edges[opposite].length_m
            distances = (
                (start_m + length_m - sumo.lane_position(vehicle), vehicle)
                for vehicle in sumo.edge_vehicles(opposite)
                if vehicle != self._ego
            )
            beyond_m, nearest = min((each for each in distances if each[0] > 0), default=(math.inf, ""))
            if beyond_m <= SIGHT_M:
                return nearest
        return ""

    def _oncoming(self, index: int, x_m: float, y_m: float, heading_deg: float, speed_mps: float) -> Other | None:
        """The oncoming vehicle found, as long as it is on the road and ahead; then the next."""
        sumo = self._sumo
        heading = math.radians(heading_deg)
        for _ in range(2):
            try:
                other_x_m, other_y_m = sumo.position(self._oncoming_id)
            except sumo.refusals:  # it has left
                other_x_m = other_y_m = INVALID_M
            dx_m, dy_m = other_x_m - x_m, other_y_m - y_m
            if other_x_m > INVALID_M and dx_m * math.sin(heading) + dy_m * math.cos(heading) > 0:
                other_mps = sumo.speed(self._oncoming_id)
                return self._oncoming_id, math.hypot(dx_m, dy_m), other_mps, speed_mps + other_mps
            self._oncoming_id = self._look_for_oncoming(index)
            if not self._oncoming_id:
                break
        return None

    def _emergency_behind(self, x_m: float, y_m: float, heading_deg: float, speed_mps: float) -> Other | None:
        """The nearest emergency vehicle behind with blue lights, in roughly the same direction."""
        sumo = self._sumo
        east, north = math.sin(math.radians(heading_deg)), math.cos(math.radians(heading_deg))
        nearest: tuple[float, str] | None = None
        for vehicle in sorted(self._emergency):
            other_x_m, other_y_m = sumo.position(vehicle)
            dx_m, dy_m = other_x_m - x_m, other_y_m - y_m
            distance_m = math.hypot(dx_m, dy_m)
            turned_deg = abs((sumo.angle(vehicle) - heading_deg + 180) % 360 - 180)
            is_behind = dx_m * east + dy_m * north < 0 and turned_deg < 60
            if distance_m <= SIGHT_M and is_behind and (nearest is None or distance_m < nearest[0]):
                nearest = (distance_m, vehicle)
        if nearest is None:
            return None
        other_mps = sumo.speed(nearest[1])
        gap_m = nearest[0] - sumo.length(self._ego)
        return nearest[1], gap_m, other_mps, other_mps - speed_mps


def _converter(sumo: LibSumo, network: Network) -> Callable[[float, float], tuple[float | None, float | None]]:
    """Converts metres to longitude and latitude, by SUMO unless the network was moved."""
    if network.map.projection is None:
        return lambda x_m, y_m: (None, None)
    return GeoReference(network.map).lon_lat if network.moved else sumo.to_lon_lat
