"""The ego's pedals and its route in SUMO."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from automotive_cosim.contracts import DrivingState, Reroute, RouteOption, lon_lat
from automotive_cosim.contracts.text import Quantity, say
from automotive_cosim.traffic.chance import renew
from automotive_cosim.traffic.georeference import GeoReference
from automotive_cosim.traffic.network import Network
from automotive_cosim.traffic.pedals import RefusedError
from automotive_cosim.traffic.road_weather import G_MPS2
from automotive_cosim.traffic.router import Router
from automotive_cosim.traffic.sensing import Sensor
from automotive_cosim.traffic.sumo import AWARENESS, HAZARD_SIGNAL, SPEED_GAIN, STRATEGIC, LibSumo

PARKING = 1
"""SUMO's stop flag: off the lane, so that other vehicles can pass."""

FASTEST_MPS = 100.0

STOPPING_MPS2 = 2.0
"""Deceleration for planning a stop at the side."""

STOPPING_RESERVE_M = 30.0

TURN_TIME_S = 4.0
TURN_RESERVE_M = 30.0
"""Minimum time and distance before a turn to reach its lane; a later one is missed."""

CORNERING_MPS2 = 2.0
"""Deceleration before a bend that the speed factor would otherwise take too fast."""

BEND_RESERVE_M = 15.0
"""Distance before a bend's end at which its speed is reached, about where a junction begins."""

BENDS_WITHIN_M = 500.0

STREET_CANDIDATES = 8
"""How many edges of a street to try as destination, nearest first."""
WALK_M = 400.0
"""Acceptable walk from the car: five minutes at 1.35 m/s."""

KEEPS_ROUTE = say("this is the quickest route")
"""Answer to a request for the quickest route which changes nothing, not even in SUMO."""


class SumoPedals:
    """Implements ``pedals.Pedals``."""

    def __init__(
        self,
        sumo: LibSumo,
        ego_id: str,
        network: Network,
        sensor: Sensor,
        router: Router,
        stops: Sequence[str] = (),
        *,
        hands_off: bool = False,
    ) -> None:
        """Takes the ego over; ``stops`` are edges that every route to the present destination passes. With
        ``hands_off`` nothing is done to it before ``take``."""
        self._sumo = sumo
        self._ego = ego_id
        self._network = network
        self._sensor = sensor
        self._router = router
        self._stops = tuple(stops)
        self._service_mps2: float = sumo.vehicle.getDecel(ego_id)
        self._own_mps2: float = sumo.vehicle.getAccel(ego_id)
        self._alignment = "center"
        self._strategic: str = sumo.vehicle.getParameter(ego_id, STRATEGIC)
        self._made_way = False
        """Whether there was a vehicle with its blue lights on a step ago."""
        self._expected_mps2 = self._service_mps2
        """How hard those behind expect the driver to brake: as hard as he can, however gently he means to."""
        self._factor = 1.0
        self._top_mps = self._set_mps = FASTEST_MPS
        self.are_taken = False
        """Whether the driver has them."""
        if not hands_off:
            self.take()

    def take(self) -> None:
        """Takes the ego over. The first change gives it a type of its own and redraws its speed factor, so it comes
        before the driver's."""
        self.are_taken = True
        self._sumo.set_max_speed(self._ego, FASTEST_MPS)

    def renew(self, seed: int) -> None:
        renew(self._sumo, seed)

    def set_speed_factor(self, factor: float) -> None:
        self._factor = factor
        self._sumo.set_speed_factor(self._ego, factor)

    def set_top_speed(self, speed_mps: float) -> None:
        """See ``pedals.Pedals``; a bend ahead may require less."""
        self._top_mps = speed_mps

    def set_headway(self, headway_s: float) -> None:
        self._sumo.set_headway(self._ego, headway_s)

    def set_imperfection(self, imperfection: float) -> None:
        self._sumo.set_imperfection(self._ego, imperfection)

    def set_awareness(self, awareness: float) -> None:
        """See ``pedals.Pedals``; SUMO has its driver misjudge gaps and closing speeds accordingly."""
        self._sumo.set_parameter(self._ego, AWARENESS, f"{awareness:g}")

    def set_overtaking(self, readiness: float) -> None:
        self._sumo.set_parameter(self._ego, SPEED_GAIN, f"{readiness:g}")

    def set_grip(self, friction: float) -> None:
        hardest_mps2 = friction * G_MPS2
        service_mps2 = min(self._service_mps2, hardest_mps2)
        vehicle = self._sumo.vehicle
        vehicle.setDecel(self._ego, service_mps2)
        vehicle.setApparentDecel(self._ego, min(self._expected_mps2, hardest_mps2))
        vehicle.setEmergencyDecel(self._ego, hardest_mps2)

    def set_traction(self, friction: float) -> None:
        self._sumo.vehicle.setAccel(self._ego, min(self._own_mps2, friction * G_MPS2 / 2))

    def set_braking(self, deceleration_mps2: float) -> None:
        """See ``pedals.Pedals``; it counts from the next ``set_grip``."""
        self._service_mps2 = deceleration_mps2

    def set_hazards(self, on: bool) -> None:
        self._sumo.set_signals(self._ego, HAZARD_SIGNAL if on else -1)

    def apply(self) -> None:
        """Sets the upper bound for the next step: the driver's, reduced before a bend.

        SUMO applies the speed factor in bends too, but drivers who speed on straights do not corner as fast."""
        if not self.are_taken:
            return
        is_near = self._sensor.knows_emergency
        if (is_near or self._made_way) and not self._sensor.makes_way:
            self._sumo.give_back(self._ego, (self._factor, self._alignment, self._strategic))
        self._made_way = is_near
        top_mps = self._top_mps
        if self._factor > 1.0:
            position_m = self._sensor.position_m
            for end_m, allowed_mps in self._sensor.route.bends:
                if end_m > position_m:
                    before_m = max(0.0, end_m - position_m - BEND_RESERVE_M)
                    top_mps = min(top_mps, math.sqrt(allowed_mps**2 + 2 * CORNERING_MPS2 * before_m))
                    if before_m > BENDS_WITHIN_M:
                        break
        if top_mps != self._set_mps:
            self._set_mps = top_mps
            self._sumo.set_max_speed(self._ego, top_mps)

    def pull_over(self, state: DrivingState, for_s: float, within_m: float = math.inf) -> str:
        """Stops beside the lane on the first edge of the route that is long enough and not in a tunnel."""
        needed_m = state.speed_mps**2 / (2 * STOPPING_MPS2) + STOPPING_RESERVE_M
        route = self._sensor.route
        for index in range(self._sumo.route_index(self._ego), len(route.edge_ids)):
            edge = self._network.edges[route.edge_ids[index]]
            earliest_m = self._sensor.position_m + needed_m - route.position_m(index, 0.0)
            stop_m = max(earliest_m, min(15.0, edge.length_m / 2))
            if stop_m <= edge.length_m - 5.0 and not edge.in_tunnel:
                away_m = route.position_m(index, stop_m) - self._sensor.position_m
                if away_m > within_m:
                    raise RefusedError(say("there is no place to stop within the next metres"))
                lane_index = int(edge.lane_ids[0].rpartition("_")[2])
                try:
                    self._sumo.set_stop(self._ego, edge.edge_id, stop_m, lane_index, for_s, PARKING)
                except self._sumo.refusals as error:
                    raise RefusedError(str(error)) from error
                return f"in {away_m:.0f} m" + (f" on {edge.name}" if edge.name else "")
        raise RefusedError(say("there is no place to stop on the rest of the route"))

    def is_parked(self) -> bool:
        return bool(self._sumo.vehicle.isStoppedParking(self._ego))

    def change_lane(self, lanes_from_kerb: int, for_s: float) -> bool:
        """See ``pedals.Pedals``; SUMO changes as soon as there is a gap."""
        lane = self._sumo.lane_of(self._ego)
        edge_id = self._rest()[0]
        lanes = self._network.edges[edge_id].lane_ids
        if lane not in lanes or not 0 <= lanes.index(lane) + lanes_from_kerb < len(lanes):
            return False
        target = lanes[lanes.index(lane) + lanes_from_kerb]
        self._sumo.vehicle.changeLane(self._ego, int(target.rpartition("_")[2]), for_s)
        return True

    def standing_ahead_m(self) -> float | None:
        return self._sensor.route.standing_ahead_m(self._sensor.position_m)

    def leave_corridor(self, leave: bool) -> str:
        """See ``pedals.Pedals``; without sublanes, SUMO knows no positions in a lane: the car stays where it is.

        The corridor opens between the lane farthest from the kerb and the next (StVO section 11 (2))."""
        lane = self._sumo.lane_of(self._ego)
        edge = self._network.edges.get(self._sumo.edge_of(self._ego))
        is_innermost = edge is not None and len(edge.lane_ids) > 1 and lane == edge.lane_ids[-1]
        side = "left" if is_innermost != self._network.map.left_hand else "right"
        self._alignment = side if leave else "center"
        self._sumo.vehicle.setLateralAlignment(self._ego, self._alignment)
        return f"keeps to the {side}" if leave else "drives in the middle of the lane"

    # --- routes -------------------------------------------------------------------------------------------

    def reroute(self, request: Reroute, state: DrivingState) -> str:
        """Takes another route; the next turn stays if it is too near to change."""
        if state.road.edge_id.startswith(":"):
            raise RefusedError(say("inside a junction the route is fixed; ask again after it"))
        edges = self._given(request.edges) if request.edges else self._found(request.destination, state)
        if request == Reroute() and edges == self._rest():
            return KEEPS_ROUTE
        try:
            self._sumo.set_route(self._ego, edges)
        except self._sumo.refusals as error:
            raise RefusedError(say("no such route: {error}", error=str(error))) from error
        self._sensor.refresh()
        length_km = (self._sensor.route.length_m - self._sensor.position_m) / 1000
        name = self._network.edges[edges[-1]].name
        return (
            say("New route of {length} km to {place}", length=Quantity(f"{length_km:.1f}"), place=name)
            if name
            else say("New route of {length} km", length=Quantity(f"{length_km:.1f}"))
        )

    def _given(self, edge_ids: tuple[str, ...]) -> tuple[str, ...]:
        here, planned = self._fixed()
        if here in edge_ids:
            edge_ids = edge_ids[edge_ids.index(here) :]
        for edge_id in edge_ids:
            if edge_id not in self._network.edges:
                raise RefusedError(say("there is no edge {edge}", edge=repr(edge_id)))
        if edge_ids[0] != here:
            raise RefusedError(
                say(
                    "the route must begin where the car is, on edge {here}, not on {edge}",
                    here=repr(here),
                    edge=repr(edge_ids[0]),
                )
            )
        if edge_ids[: len(planned)] != planned:
            raise RefusedError(say("the next junction is too near for another turn"))
        for edge_id, following in pairwise(edge_ids):
            if following not in self._network.crossings.get(edge_id, {}):
                raise RefusedError(
                    say("there is no route from {start} to {end}", start=repr(edge_id), end=repr(following))
                )
        return edge_ids

    def _found(self, destination: str, state: DrivingState) -> tuple[str, ...]:
        """The quickest route now to the destination, or to an edge within a short walk of it."""
        _, planned = self._fixed()
        for goals in (self._goals(destination, state), self._beside(destination)):
            if way := self._router.quickest(planned[-1], goals, () if destination else self._stops_left()):
                found, rest = (*planned[:-1], *way), self._rest()
                is_better = bool(destination) or self._router.is_quicker(found, rest, self._driven_m())
                return found if is_better else rest
        raise RefusedError(
            say("there is no route to {place} from here", place=destination)
            if destination
            else say("there is no route to the destination from here")
        )

    def _beside(self, edge_id: str) -> tuple[str, ...]:
        """The edges that end near the end of that edge; empty without such an edge."""
        if edge_id not in self._network.edges:
            return ()
        end = self._network.edges[edge_id].shape_m[-1]
        away_m = {other: math.dist(edge.shape_m[-1], end) for other, edge in self._network.edges.items()}
        near = sorted((other for other in away_m if away_m[other] <= WALK_M), key=away_m.__getitem__)
        return tuple(near[: STREET_CANDIDATES + 1])

    def alternatives(self, age_s: float) -> tuple[RouteOption, ...]:
        """Empty inside a junction."""
        if self._sumo.edge_of(self._ego).startswith(":"):
            return ()
        fixed = len(self._fixed()[1])
        return self._router.alternatives(self._rest(), fixed, self._driven_m(), age_s, self._stops_left())

    def _stops_left(self) -> tuple[str, ...]:
        """The stops on the rest of the route, after what can no longer be changed."""
        rest = self._rest()[len(self._fixed()[1]) :]
        return tuple(stop for stop in self._stops if stop in rest)

    def _rest(self) -> tuple[str, ...]:
        """The route from the present edge."""
        return self._sensor.route.edge_ids[self._sumo.route_index(self._ego) :]

    def _driven_m(self) -> float:
        """Distance driven on the present edge."""
        return self._sensor.on_edge_m

    def _fixed(self) -> tuple[str, tuple[str, ...]]:
        """The car's edge, and the edges that can no longer be changed."""
        route, index = self._sensor.route, self._sumo.route_index(self._ego)
        here = route.edge_ids[index]
        left_m = self._network.edges[here].length_m - self._sensor.on_edge_m
        needed_m = TURN_TIME_S * self._sumo.speed(self._ego) + TURN_RESERVE_M
        return here, route.edge_ids[index : index + (2 if left_m < needed_m else 1)]

    def _goals(self, destination: str, state: DrivingState) -> tuple[str, ...]:
        """Edges that a destination may refer to."""
        edges = self._network.edges
        if not destination:
            return (self._sensor.route.edge_ids[-1],)
        if destination in edges:
            return (destination,)
        try:
            position = lon_lat(destination)
        except ValueError as error:
            raise RefusedError(str(error)) from error
        if position is not None:
            if state.lon_deg is None:
                raise RefusedError(say("this network has no place on earth"))
            if self._network.moved:
                x_m, y_m = GeoReference(self._network.map).x_y(*position)
                return (self._sumo.find_road(x_m, y_m, False, "passenger")[0],)
            return (self._sumo.find_road(*position, True, "passenger")[0],)
        named = [edge for edge in edges.values() if edge.name.casefold() == destination.casefold()]
        if not named:
            raise RefusedError(say("there is no street or edge named {name}", name=repr(destination)))
        named.sort(key=lambda edge: math.dist(edge.shape_m[0], (state.x_m, state.y_m)))
        return tuple(edge.edge_id for edge in named[:STREET_CANDIDATES])
