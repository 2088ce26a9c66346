"""Stages each kind of incident in SUMO. ``incidents`` decides when."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from datetime import datetime
from itertools import takewhile
from typing import Any

from automotive_cosim.contracts import KMH_PER_MPS, IncidentKind, RoadIncident
from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats import incidents
from automotive_cosim.traffic.congestion import JAM_BELOW
from automotive_cosim.traffic.incident_tools import CAR_TYPE, IncidentTools
from automotive_cosim.traffic.lookout import CROSSING
from automotive_cosim.traffic.manoeuvres import StagedBraking, StagedCutIn, StagedCutOut, StagedEmergency
from automotive_cosim.traffic.network import Edge
from automotive_cosim.traffic.posted_limits import Hours, TimedLimit, timed_limits
from automotive_cosim.traffic.scripted import StagedVehicle
from automotive_cosim.traffic.staged import CAR_SPACE_M, StagedIncident
from automotive_cosim.traffic.steering import PARKING
from automotive_cosim.traffic.sumo import HAZARD_SIGNAL

AUTHORITY = ("authority",)
"""Vehicle classes that may use a closed lane."""

SCHOOL_DAYS = frozenset(range(1, 6))

NARROW_PLACE_M = 10.0
"""Distance from the head of a jam to the end of its last edge."""

SHORTEST_M = 40.0
"""An incident ahead of the ego is staged on no shorter road."""

NEAR_M = 50.0
"""How near its intended place it must be: more than the car drives in a second."""

SIGN_WAY_M = 600.0
"""On how much of the route a sign holds that was staged ahead of the ego."""

TRACTOR_WAY_M = 1000.0
"""How far a tractor drives that was staged ahead of the ego."""


class _Breakdown(StagedIncident):
    """A stopped car."""

    def __init__(self, tools: IncidentTools, incident: incidents.Breakdown) -> None:
        self._tools, self._incident = tools, incident
        self._lane = tools.lane(incident.edge, incident.lane)
        length_m = tools.edge(incident.edge).length_m
        if not 5.0 <= incident.position_m <= length_m:
            raise ScenarioError(
                f"[[incidents]]: edge {incident.edge!r} is {length_m:.0f} m long, so a car cannot stand at "
                f"position_m = {incident.position_m:g}; give 5 to {length_m:.0f}"
            )

    def begin(self) -> str:
        tools, incident = self._tools, self._incident
        position_m = incident.position_m
        self._car = tools.car("breakdown", (incident.edge,), self._lane, position_m, "0")
        lane = int(self._lane.rpartition("_")[2])
        flags = PARKING if incident.aside else 0
        tools.sumo.set_stop(self._car, incident.edge, position_m, lane, incident.to_s - incident.from_s, flags)
        tools.sumo.set_signals(self._car, HAZARD_SIGNAL)
        return f"a car has broken down{_on(tools.edge(incident.edge))}"

    def reported(self, slow: Mapping[str, float]) -> RoadIncident:
        return RoadIncident(IncidentKind.BREAKDOWN, self._incident.edge, self._incident.position_m)


class _Roadworks(StagedIncident):
    """A lower limit and closed lanes, or the sign that is left of them."""

    def __init__(self, tools: IncidentTools, incident: incidents.Roadworks) -> None:
        self._tools, self._incident = tools, incident
        self.closed = tuple(tools.lane(incident.edge, lane) for lane in incident.closed_lanes)
        tools.signs.refuse_if_fixed(incident.edge)
        if len(set(self.closed)) >= len(tools.edge(incident.edge).lane_ids):
            raise ScenarioError(
                f"[[incidents]]: roadworks on {incident.edge!r} leave no lane; use kind = 'closure'"
            )

    def begin(self) -> str:
        tools = self._tools
        tools.signs.put_up(self._incident.edge, self._incident.limit_kmh / KMH_PER_MPS)
        self._allowed = {lane: tools.sumo.lane.getAllowed(lane) for lane in self.closed}
        for lane in self.closed:
            tools.sumo.lane.setAllowed(lane, AUTHORITY)
        if self.closed:
            tools.detours.close(self._incident.edge, lanes_only=True)
            for vehicle in tools.sumo.vehicle_ids():
                if vehicle != tools.ego_id:
                    tools.detours.check(vehicle)
        what = f"a sign of {self._incident.limit_kmh:g} km/h still stands after" if self._incident.over else ""
        return f"{what} roadworks{_on(tools.edge(self._incident.edge))}".strip()

    def end(self) -> str:
        self._tools.signs.take_down(self._incident.edge, self._incident.limit_kmh / KMH_PER_MPS)
        for lane, allowed in self._allowed.items():
            self._tools.sumo.lane.setAllowed(lane, allowed)
        if self.closed:
            self._tools.detours.open(self._incident.edge, lanes_only=True)
        return ""

    def reported(self, slow: Mapping[str, float]) -> RoadIncident | None:
        return None if self._incident.over else RoadIncident(IncidentKind.ROADWORKS, self._incident.edge, 0.0)


class _Sign(StagedIncident):
    """A sign with a plate, or a variable one."""

    def __init__(self, tools: IncidentTools, incident: incidents.SpeedSign) -> None:
        self._tools, self._incident = tools, incident
        self._by_lane = incident.shows == "by lane"
        for edge in incident.edges:
            tools.lane(edge, int(self._by_lane))
            tools.signs.refuse_if_fixed(edge)
        self._limits, unread = timed_limits(f"{incident.limit_kmh:g} @ ({incident.plate})" * bool(incident.plate))
        if unread:
            raise ScenarioError(
                f'[[incidents]]: plate = "{incident.plate}" is not understood; write "wet", "snow" or hours, as in '
                '"Mo-Fr 07:00-17:00"'
            )

    def begin(self) -> str:
        signs, incident = self._tools.signs, self._incident
        for limit in self._limits:
            signs.put_up_timed(incident.edges, limit, school=False)
        if not self._limits:
            signs.light(incident.edges, incident.limit_kmh / KMH_PER_MPS, by_lane=self._by_lane)
        return ""

    def end(self) -> str:
        signs, edges = self._tools.signs, self._incident.edges
        for limit in self._limits:
            signs.take_down_timed(edges, limit)
        if not self._limits:
            signs.light(edges, None, by_lane=self._by_lane)
        return ""


class _Jam(StagedIncident):
    """A queue, and a bottleneck that lets one vehicle per lane pass at a time."""

    def __init__(self, tools: IncidentTools, incident: incidents.Jam) -> None:
        self._tools, self._incident = tools, incident
        self._edges = [tools.edge(edge) for edge in incident.edges]
        for here, there in zip(incident.edges, incident.edges[1:], strict=False):
            if there not in tools.network.crossings.get(here, {}):
                raise ScenarioError(f"[[incidents]]: jam: no route leads from edge {here!r} to {there!r}")
        room_m = sum(edge.length_m for edge in self._edges) - NARROW_PLACE_M
        if incident.length_m > room_m:
            raise ScenarioError(f"[[incidents]]: a jam of {incident.length_m:g} m does not fit on {room_m:.0f} m")
        self._head_m = self._edges[-1].length_m - NARROW_PLACE_M
        self._held: set[str] = set()

    def begin(self) -> str:
        left_m = self._incident.length_m
        for index in range(len(self._edges) - 1, -1, -1):
            edge = self._edges[index]
            position_m = self._head_m if index == len(self._edges) - 1 else edge.length_m - 1.0
            route = [ahead.edge_id for ahead in self._edges[index:]]
            while position_m > CAR_SPACE_M and left_m > 0:
                for lane in edge.lane_ids:
                    self._tools.car("jam", route, lane, position_m, "0")
                position_m -= CAR_SPACE_M
                left_m -= CAR_SPACE_M
        return f"a jam of {self._incident.length_m:.0f} m{_on(self._tools.edge(self._edges[-1].edge_id))}"

    def tick(self, local_time: datetime) -> str:
        tools, last = self._tools, self._edges[-1]
        for vehicle in tools.sumo.edge_vehicles(last.edge_id):
            if vehicle not in self._held and vehicle != tools.ego_id:
                self._held.add(vehicle)
                with suppress(*tools.sumo.refusals):  # too near to stop: it slips through
                    lane = tools.sumo.lane_index(vehicle)
                    tools.sumo.set_stop(vehicle, last.edge_id, self._head_m, lane, self._incident.hold_s, 0)
        return ""

    def end(self) -> str:
        for vehicle in self._tools.sumo.edge_vehicles(self._edges[-1].edge_id):
            if self._tools.sumo.vehicle.isStopped(vehicle) and vehicle != self._tools.ego_id:
                self._tools.sumo.vehicle.resume(vehicle)
        return ""

    def reported(self, slow: Mapping[str, float]) -> RoadIncident | None:
        """Reported by its speed, from the first of its edges that is jammed."""
        jammed = (edge for edge in self._incident.edges if slow.get(edge, 1.0) < JAM_BELOW)
        return next((RoadIncident(IncidentKind.JAM, edge, 0.0) for edge in jammed), None)


class _Closure(StagedIncident):
    """A road that all except the authorities go round."""

    def __init__(self, tools: IncidentTools, incident: incidents.Closure) -> None:
        self._tools = tools
        self._edge = tools.edge(incident.edge)
        self.closed = tuple(self._edge.lane_ids)

    @property
    def _called(self) -> str:
        return self._tools.edge(self._edge.edge_id).name or self._edge.edge_id

    def begin(self) -> str:
        sumo, edge = self._tools.sumo, self._edge
        self._allowed = {lane: sumo.lane.getAllowed(lane) for lane in edge.lane_ids}
        for lane in edge.lane_ids:
            sumo.lane.setAllowed(lane, AUTHORITY)
        self._tools.detours.close(edge.edge_id)
        for vehicle in sumo.vehicle_ids():
            ahead = sumo.route(vehicle)[sumo.route_index(vehicle) :]
            if vehicle != self._tools.ego_id and edge.edge_id in ahead:  # the ego has a driver of its own
                self._tools.detours.send_round(vehicle)
        return f"{self._called} is closed"

    def tick(self, local_time: datetime) -> str:
        return self._turn_off()

    def end(self) -> str:
        self._tools.detours.open(self._edge.edge_id)
        for lane, allowed in self._allowed.items():
            self._tools.sumo.lane.setAllowed(lane, allowed)
        return f"{self._called} is open again"

    def _turn_off(self) -> str:
        """The ego's driver sees the sign on the previous edge and follows the detour to the destination."""
        sumo, ego, sensor = self._tools.sumo, self._tools.ego_id, self._tools.sensor
        if sensor is None:
            return ""
        try:
            index = sumo.route_index(ego)
        except sumo.refusals:  # it has arrived, and the others' traffic goes on
            return ""
        edges = sensor.route.edge_ids[index:]
        if self._edge.edge_id not in edges[1:3] or sumo.edge_of(ego) != edges[0]:
            return ""
        way = sumo.find_route(edges[0], edges[-1], CAR_TYPE).edges
        if not way or self._edge.edge_id in way:
            return ""
        sumo.set_route(ego, way)
        self._tools.route_changed = True
        return f"driver goes round {self._called}, which is closed"

    def reported(self, slow: Mapping[str, float]) -> RoadIncident:
        return RoadIncident(IncidentKind.CLOSURE, self._edge.edge_id, 0.0)


class _SchoolZone(StagedIncident):
    """A limit by the clock."""

    def __init__(self, tools: IncidentTools, incident: incidents.SchoolZone) -> None:
        self._tools, self._edges = tools, incident.edges
        for edge in incident.edges:
            tools.edge(edge)
            tools.signs.refuse_if_fixed(edge)
        opens, closes = incident.opens, incident.closes
        hours = Hours(
            SCHOOL_DAYS,
            ((opens.hour * 60 + opens.minute, closes.hour * 60 + closes.minute),),
            f"Mo-Fr {opens:%H:%M}-{closes:%H:%M}",
        )
        self._limit = TimedLimit(
            incident.limit_kmh / KMH_PER_MPS, hours, f"{incident.limit_kmh:g} km/h {hours.text}"
        )

    def begin(self) -> str:
        self._tools.signs.put_up_timed(self._edges, self._limit, school=True)
        return ""

    def end(self) -> str:
        self._tools.signs.take_down_timed(self._edges, self._limit)
        return ""

    def reported(self, slow: Mapping[str, float]) -> RoadIncident:
        """Reported at all hours, like its signs; the time determines whether its limit is in force."""
        return RoadIncident(IncidentKind.SCHOOL_ZONE, self._edges[0], 0.0)


class _RushHour(StagedIncident):
    """More demand."""

    def __init__(self, tools: IncidentTools, incident: incidents.RushHour) -> None:
        self._tools, self._incident = tools, incident

    def begin(self) -> str:
        simulation = self._tools.sumo.simulation
        self._before = simulation.getScale()
        simulation.setScale(self._before * self._incident.scale)
        return ""

    def end(self) -> str:
        self._tools.sumo.simulation.setScale(self._before)
        return ""


class _Tractor(StagedIncident):
    """A slow vehicle."""

    def __init__(self, tools: IncidentTools, incident: incidents.Tractor) -> None:
        self._tools, self._incident = tools, incident
        tools.edge(incident.from_edge)
        tools.edge(incident.to_edge)

    def begin(self) -> str:
        tools, incident = self._tools, self._incident
        kind = tools.kind("tractor")
        types = tools.sumo.type
        types.setShapeClass(kind, "truck")
        types.setLength(kind, incident.length_m)
        types.setMaxSpeed(kind, incident.speed_kmh / KMH_PER_MPS)
        types.setAccel(kind, 1.0)
        types.setParameter(kind, "has.rerouting.device", "false")
        way = tools.sumo.find_route(incident.from_edge, incident.to_edge, kind).edges
        if not way:
            raise ScenarioError(
                f"[[incidents]]: tractor: no route leads from {incident.from_edge!r} to {incident.to_edge!r}"
            )
        tools.car("tractor", way, tools.lane(incident.from_edge, 0), incident.length_m, "max", kind)
        return f"a tractor{_on(tools.edge(incident.from_edge))}"


class _Pedestrians(StagedIncident):
    """Groups that cross."""

    def __init__(self, tools: IncidentTools, incident: incidents.Pedestrians) -> None:
        self._tools, self._incident = tools, incident
        try:
            self._walk = tools.sumo.simulation.findIntermodalRoute(incident.from_edge, incident.to_edge)
        except tools.sumo.refusals as error:
            raise ScenarioError(f"[[incidents]]: pedestrians: {error}") from error
        if not self._walk or not any(CROSSING.fullmatch(edge) for edge in tools.sumo.edge_ids()):
            raise ScenarioError(
                f"[[incidents]]: pedestrians cannot walk from {incident.from_edge!r} to {incident.to_edge!r}; the "
                "network requires sidewalks and crossings (netconvert --sidewalks.guess --crossings.guess)"
            )
        self._next_s = 0

    def begin(self) -> str:
        return "people cross the road"

    def tick(self, local_time: datetime) -> str:
        if self._next_s <= 0:
            self._next_s = round(self._incident.every_s)
            for _ in range(self._incident.group):
                self._send()
        self._next_s -= 1
        return ""

    def _send(self) -> None:
        person = self._tools.sumo.person
        name = self._tools.name("person")
        edge = self._walk[0].edges[0]
        length_m = self._tools.edge(edge).length_m
        person.add(name, edge, max(0.0, length_m - 5.0))
        person.appendWalkingStage(name, self._walk[0].edges, 5.0)


class _Ahead(StagedIncident):
    """Another incident, on a road that is chosen when the time has come."""

    def __init__(self, tools: IncidentTools, incident: incidents.AheadIncident) -> None:
        self._tools, self._incident = tools, incident
        self._staged: StagedIncident | None = None
        self._tail: RoadIncident | None = None

    def tick(self, local_time: datetime) -> str:
        if self._staged is not None:
            return self._staged.tick(local_time)
        chosen = self._chosen()
        if chosen is None:
            return ""
        self._staged = staged(self._tools, chosen)
        self.closed = self._staged.closed
        return self._staged.begin()

    def end(self) -> str:
        return "" if self._staged is None else self._staged.end()

    def reported(self, slow: Mapping[str, float]) -> RoadIncident | None:
        """A queue is reported where its tail was at first, however slow the whole road is."""
        return self._tail or (None if self._staged is None else self._staged.reported(slow))

    def _chosen(self) -> incidents.Incident | None:
        """The incident on its road; None as long as there is no room for it."""
        sensor, network, incident = self._tools.sensor, self._tools.network, self._incident
        assert sensor is not None
        place_m = sensor.position_m + incident.ahead_m
        if place_m > sensor.route.length_m:
            return None
        index, on_edge_m = sensor.route.edge_at(place_m)
        way = sensor.route.edge_ids[index:]
        if incident.other_way:
            back = network.opposite.get(way[0])
            if back is None:
                return None
            way, on_edge_m = (back,), 0.0
        edges = [network.edges[edge] for edge in way]
        if edges[0].length_m < SHORTEST_M or edges[0].in_tunnel:
            return None
        from_s, to_s = incident.from_s, incident.to_s
        if incident.what == "breakdown":
            at_m = round(min(max(on_edge_m, SHORTEST_M / 2), edges[0].length_m - 5.0), 1)
            aside = len(edges[0].lane_ids) == 1
            return incidents.Breakdown(edge=way[0], position_m=at_m, aside=aside, from_s=from_s, to_s=to_s)
        if incident.what == "jam":
            return self._jam(way, edges, on_edge_m)
        if on_edge_m > NEAR_M:  # they begin where their road does
            return None
        limit_kmh = max(20.0, 10.0 * round(0.06 * edges[0].speed_mps * KMH_PER_MPS))
        if incident.what in ("roadworks", "left_sign"):
            if edges[0].cars_mps is not None:
                return None
            over = incident.what == "left_sign"
            return incidents.Roadworks(edge=way[0], limit_kmh=limit_kmh, over=over, from_s=from_s, to_s=to_s)
        if incident.what == "sign":
            signed = self._signed(edges[: _covering(edges, SIGN_WAY_M) or None], limit_kmh)
            return signed and replace(signed, from_s=from_s, to_s=to_s)
        count = _covering(edges, TRACTOR_WAY_M) or len(way)
        return incidents.Tractor(from_edge=way[0], to_edge=way[count - 1], from_s=from_s, to_s=to_s)

    def _signed(self, edges: Sequence[Edge], limit_kmh: float) -> incidents.SpeedSign | None:
        """A sign at the beginning of some roads, as far as it is a lower limit there."""
        incident, by_lane = self._incident, self._incident.shows == "by lane"
        fit = tuple(
            edge.edge_id
            for edge in takewhile(lambda edge: edge.speed_mps * KMH_PER_MPS > limit_kmh, edges)
            if edge.cars_mps is None
            and len(edge.lane_ids) > by_lane
            and not self._tools.signs.has_variable(edge.edge_id)
        )
        if edges[0].edge_id not in fit:
            return None
        return incidents.SpeedSign(edges=fit, limit_kmh=limit_kmh, plate=incident.plate, shows=incident.shows)

    def _jam(self, way: Sequence[str], edges: Sequence[Edge], tail_m: float) -> incidents.Jam | None:
        """A queue whose tail is about there."""
        incident, length_m = self._incident, self._incident.length_m
        count = _covering(edges, tail_m + length_m + NARROW_PLACE_M)
        room_m = sum(edge.length_m for edge in edges[:count]) - NARROW_PLACE_M - length_m
        if not count or (not incident.other_way and room_m - tail_m > NEAR_M):
            return None
        self._tail = RoadIncident(IncidentKind.JAM, way[0], room_m)
        jammed = tuple(way[:count])
        return incidents.Jam(edges=jammed, length_m=length_m, from_s=incident.from_s, to_s=incident.to_s)


def _covering(edges: Sequence[Edge], length_m: float) -> int:
    """How many of the edges, from the first, have that length together; 0 if all of them have less."""
    left_m = length_m
    for count, edge in enumerate(edges, start=1):
        left_m -= edge.length_m
        if left_m <= 0:
            return count
    return 0


STAGED: Mapping[type[incidents.Incident], Callable[[IncidentTools, Any], StagedIncident]] = {
    incidents.Breakdown: _Breakdown,
    incidents.Roadworks: _Roadworks,
    incidents.SpeedSign: _Sign,
    incidents.Jam: _Jam,
    incidents.Closure: _Closure,
    incidents.SchoolZone: _SchoolZone,
    incidents.RushHour: _RushHour,
    incidents.Tractor: _Tractor,
    incidents.Pedestrians: _Pedestrians,
    incidents.ScriptedVehicle: StagedVehicle,
    incidents.EmergencyVehicle: StagedEmergency,
    incidents.BrakingLeader: StagedBraking,
    incidents.CutIn: StagedCutIn,
    incidents.CutOut: StagedCutOut,
    incidents.AheadIncident: _Ahead,
}
"""What stages each kind of incident."""


def staged(tools: IncidentTools, incident: incidents.Incident) -> StagedIncident:
    """What stages an incident. Raises ScenarioError: it does not fit the network."""
    return STAGED[type(incident)](tools, incident)


def _on(edge: Edge) -> str:
    return f" on {edge.name}" if edge.name else ""
