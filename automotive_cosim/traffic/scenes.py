"""Stages each kind of incident in SUMO. ``situations`` decides when."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from datetime import datetime
from itertools import pairwise
from typing import Any, NamedTuple, Protocol

from automotive_cosim.contracts import KMH_PER_MPS, IncidentKind, RoadIncident
from automotive_cosim.errors import ScenarioError
from automotive_cosim.scenarios import incidents
from automotive_cosim.traffic.congestion import JAM_BELOW
from automotive_cosim.traffic.network import Edge
from automotive_cosim.traffic.posted import TimedLimit
from automotive_cosim.traffic.stage import CAR_TYPE, IncidentStage
from automotive_cosim.traffic.steering import PARKING
from automotive_cosim.traffic.sumo import HAZARD_SIGNAL

AUTHORITY = ("authority",)
"""Vehicle classes that may use a closed lane."""

CAR_SPACE_M = 7.5
"""Length of a stationary car with its gap: SUMO's defaults."""

GENTLE_MPS2 = 3.0
"""A leader that brakes less than this only slows down."""

NO_LANE_CHANGE, ANY_LANE_CHANGE, WHEN_ASKED = 0, 1621, 512
"""SUMO's lane change modes: only for safety, its default, and only as commanded."""

SWERVES_AFTER_S = 3.0
"""A driver changes the lane no earlier after a surprise: 1.1 s of reaction and a look over the shoulder."""

SCHOOL_DAYS = frozenset(range(1, 6))

NARROW_PLACE_M = 10.0
"""Distance from the head of a jam to the end of its last edge."""

SHORTEST_M = 40.0
"""An incident ahead of the ego is staged on no shorter road."""

NEAR_M = 50.0
"""How near its intended place it must be: more than the car drives in a second."""

TRACTOR_WAY_M = 1000.0
"""How far a tractor drives that was staged ahead of the ego."""

CUT_ROOM_M = 60.0
"""Length of road that is left beyond the place of a cut-in or a cut-out."""

USUAL_MPS2 = 4.5
"""What a car brakes with if it must: SUMO's default."""

CAR_M = 5.0
"""Length of a car: SUMO's default."""

NEARLY_S, NEARS_PER_S = 0.3, 0.3
"""A vehicle that is to cut in does so this much before its place, and nears it by this share in a second."""

HEEDLESS, HEEDFUL = 0, 31
"""SUMO's speed modes: as commanded, and its default."""

CREEP_MPS = 3.0
"""No vehicle cuts in more slowly than this."""

FOLLOWS_S = 1.4
"""A car that pulls out is at least so far ahead, or SUMO finds no room for it."""

CUT_OUT_S = 10.0
"""How long a vehicle that has cut out keeps its new lane."""

_CROSSING = re.compile(r":.+_c\d+")
"""Netconvert's ids of pedestrian crossings."""


class Scene(Protocol):
    """One staged incident."""

    def begin(self) -> str:
        """Starts it; returns a description of what happened, or an empty text."""
        ...

    def tick(self, local_time: datetime) -> str:
        """Called once per second while it lasts; returns a description of what happened."""
        ...

    def end(self) -> str:
        """Reverts it; returns a description of what happened."""
        ...

    def reported(self, slow: Mapping[str, float]) -> RoadIncident | None:
        """What live traffic reports while it lasts, for ``Situations.reported``; None if it cannot know."""
        ...


class _Scene:
    """Defaults: most scenes do nothing while they last, and need no reverting."""

    def begin(self) -> str:
        return ""

    def tick(self, local_time: datetime) -> str:
        return ""

    def end(self) -> str:
        return ""

    def reported(self, slow: Mapping[str, float]) -> RoadIncident | None:
        return None


class _Breakdown(_Scene):
    """A stopped car."""

    def __init__(self, stage: IncidentStage, incident: incidents.Breakdown) -> None:
        self._stage, self._incident = stage, incident
        self._lane = stage.lane(incident.edge, incident.lane)
        length_m = stage.edge(incident.edge).length_m
        if not 5.0 <= incident.position_m <= length_m:
            raise ScenarioError(
                f"[[incidents]]: edge {incident.edge!r} is {length_m:.0f} m long, so a car cannot stand at "
                f"position_m = {incident.position_m:g}; give 5 to {length_m:.0f}"
            )

    def begin(self) -> str:
        stage, incident = self._stage, self._incident
        position_m = incident.position_m
        self._car = stage.car("breakdown", (incident.edge,), self._lane, position_m, "0")
        lane = int(self._lane.rpartition("_")[2])
        flags = PARKING if incident.aside else 0
        stage.sumo.set_stop(self._car, incident.edge, position_m, lane, incident.to_s - incident.from_s, flags)
        stage.sumo.set_signals(self._car, HAZARD_SIGNAL)
        return f"a car has broken down{_on(stage.edge(incident.edge))}"

    def reported(self, slow: Mapping[str, float]) -> RoadIncident:
        return RoadIncident(IncidentKind.BREAKDOWN, self._incident.edge, self._incident.position_m)


class _Roadworks(_Scene):
    """A lower limit and closed lanes."""

    def __init__(self, stage: IncidentStage, incident: incidents.Roadworks) -> None:
        self._stage, self._incident = stage, incident
        self._closed = tuple(stage.lane(incident.edge, lane) for lane in incident.closed_lanes)
        if len(set(self._closed)) >= len(stage.edge(incident.edge).lane_ids):
            raise ScenarioError(
                f"[[incidents]]: roadworks on {incident.edge!r} leave no lane; use kind = 'closure'"
            )

    def begin(self) -> str:
        stage = self._stage
        stage.signs.put_up(self._incident.edge, self._incident.limit_kmh / KMH_PER_MPS)
        self._allowed = {lane: stage.sumo.lane.getAllowed(lane) for lane in self._closed}
        for lane in self._closed:
            stage.sumo.lane.setAllowed(lane, AUTHORITY)
        return f"roadworks{_on(stage.edge(self._incident.edge))}"

    def end(self) -> str:
        self._stage.signs.take_down(self._incident.edge, self._incident.limit_kmh / KMH_PER_MPS)
        for lane, allowed in self._allowed.items():
            self._stage.sumo.lane.setAllowed(lane, allowed)
        return ""

    def reported(self, slow: Mapping[str, float]) -> RoadIncident:
        return RoadIncident(IncidentKind.ROADWORKS, self._incident.edge, 0.0)


class _Jam(_Scene):
    """A queue, and a bottleneck that lets one vehicle per lane pass at a time."""

    def __init__(self, stage: IncidentStage, incident: incidents.Jam) -> None:
        self._stage, self._incident = stage, incident
        self._edges = [stage.edge(edge) for edge in incident.edges]
        for here, there in zip(incident.edges, incident.edges[1:], strict=False):
            if there not in stage.network.crossings.get(here, {}):
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
                    self._stage.car("jam", route, lane, position_m, "0")
                position_m -= CAR_SPACE_M
                left_m -= CAR_SPACE_M
        return f"a jam of {self._incident.length_m:.0f} m{_on(self._edges[-1])}"

    def tick(self, local_time: datetime) -> str:
        stage, last = self._stage, self._edges[-1]
        for vehicle in stage.sumo.edge_vehicles(last.edge_id):
            if vehicle not in self._held and vehicle != stage.ego_id:
                self._held.add(vehicle)
                with suppress(*stage.sumo.refusals):  # too near to stop: it slips through
                    lane = stage.sumo.lane_index(vehicle)
                    stage.sumo.set_stop(vehicle, last.edge_id, self._head_m, lane, self._incident.hold_s, 0)
        return ""

    def end(self) -> str:
        for vehicle in self._stage.sumo.edge_vehicles(self._edges[-1].edge_id):
            if self._stage.sumo.vehicle.isStopped(vehicle) and vehicle != self._stage.ego_id:
                self._stage.sumo.vehicle.resume(vehicle)
        return ""

    def reported(self, slow: Mapping[str, float]) -> RoadIncident | None:
        """Reported by its speed, from the first of its edges that is jammed."""
        jammed = (edge for edge in self._incident.edges if slow.get(edge, 1.0) < JAM_BELOW)
        return next((RoadIncident(IncidentKind.JAM, edge, 0.0) for edge in jammed), None)


class _Closure(_Scene):
    """A road that all except the authorities go round."""

    def __init__(self, stage: IncidentStage, incident: incidents.Closure) -> None:
        self._stage = stage
        self._edge = stage.edge(incident.edge)
        self._seen: set[str] = set()

    def begin(self) -> str:
        lanes = self._stage.sumo.lane
        self._allowed = {lane: lanes.getAllowed(lane) for lane in self._edge.lane_ids}
        for lane in self._edge.lane_ids:
            lanes.setAllowed(lane, AUTHORITY)
        for vehicle in self._stage.sumo.vehicle.getIDList():
            self._send_round(vehicle)
        return f"{self._edge.name or self._edge.edge_id} is closed"

    def tick(self, local_time: datetime) -> str:
        for vehicle in self._stage.sumo.vehicle.getIDList():
            if vehicle not in self._seen:
                self._send_round(vehicle)
        return self._turn_off()

    def end(self) -> str:
        for lane, allowed in self._allowed.items():
            self._stage.sumo.lane.setAllowed(lane, allowed)
        return f"{self._edge.name or self._edge.edge_id} is open again"

    def _send_round(self, vehicle: str) -> None:
        """The ego has a driver of its own."""
        sumo = self._stage.sumo
        self._seen.add(vehicle)
        if vehicle != self._stage.ego_id and self._edge.edge_id in sumo.route(vehicle)[sumo.route_index(vehicle) :]:
            with suppress(*sumo.refusals):  # without another route it waits
                sumo.vehicle.rerouteTraveltime(vehicle, False)

    def _turn_off(self) -> str:
        """The ego's driver sees the sign on the previous edge and follows the detour to the destination."""
        sumo, ego, sensor = self._stage.sumo, self._stage.ego_id, self._stage.sensor
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
        self._stage.route_changed = True
        return f"driver goes round {self._edge.name or self._edge.edge_id}, which is closed"

    def reported(self, slow: Mapping[str, float]) -> RoadIncident:
        return RoadIncident(IncidentKind.CLOSURE, self._edge.edge_id, 0.0)


class _SchoolZone(_Scene):
    """A limit by the clock."""

    def __init__(self, stage: IncidentStage, incident: incidents.SchoolZone) -> None:
        self._stage, self._edges = stage, incident.edges
        for edge in incident.edges:
            stage.edge(edge)
        opens, closes = incident.opens, incident.closes
        self._limit = TimedLimit(
            incident.limit_kmh / KMH_PER_MPS,
            SCHOOL_DAYS,
            ((opens.hour * 60 + opens.minute, closes.hour * 60 + closes.minute),),
            f"{incident.limit_kmh:g} km/h Mo-Fr {opens:%H:%M}-{closes:%H:%M}",
        )

    def begin(self) -> str:
        self._stage.signs.put_up_zone(self._edges, self._limit)
        return ""

    def end(self) -> str:
        self._stage.signs.take_down_zone(self._edges, self._limit)
        return ""

    def reported(self, slow: Mapping[str, float]) -> RoadIncident:
        """Reported at all hours, like its signs; the time determines whether its limit is in force."""
        return RoadIncident(IncidentKind.SCHOOL_ZONE, self._edges[0], 0.0)


class _RushHour(_Scene):
    """More demand."""

    def __init__(self, stage: IncidentStage, incident: incidents.RushHour) -> None:
        self._stage, self._incident = stage, incident

    def begin(self) -> str:
        simulation = self._stage.sumo.simulation
        self._before = simulation.getScale()
        simulation.setScale(self._before * self._incident.scale)
        return ""

    def end(self) -> str:
        self._stage.sumo.simulation.setScale(self._before)
        return ""


class _Tractor(_Scene):
    """A slow vehicle."""

    def __init__(self, stage: IncidentStage, incident: incidents.Tractor) -> None:
        self._stage, self._incident = stage, incident
        stage.edge(incident.from_edge)
        stage.edge(incident.to_edge)

    def begin(self) -> str:
        stage, incident = self._stage, self._incident
        kind = stage.kind("tractor")
        types = stage.sumo.type
        types.setShapeClass(kind, "truck")
        types.setLength(kind, incident.length_m)
        types.setMaxSpeed(kind, incident.speed_kmh / KMH_PER_MPS)
        types.setAccel(kind, 1.0)
        types.setParameter(kind, "has.rerouting.device", "false")
        way = stage.sumo.find_route(incident.from_edge, incident.to_edge, kind).edges
        if not way:
            raise ScenarioError(
                f"[[incidents]]: tractor: no route leads from {incident.from_edge!r} to {incident.to_edge!r}"
            )
        stage.car("tractor", way, stage.lane(incident.from_edge, 0), incident.length_m, "max", kind)
        return f"a tractor{_on(stage.edge(incident.from_edge))}"


class _Pedestrians(_Scene):
    """Groups that cross."""

    def __init__(self, stage: IncidentStage, incident: incidents.Pedestrians) -> None:
        self._stage, self._incident = stage, incident
        try:
            self._walk = stage.sumo.simulation.findIntermodalRoute(incident.from_edge, incident.to_edge)
        except stage.sumo.refusals as error:
            raise ScenarioError(f"[[incidents]]: pedestrians: {error}") from error
        if not self._walk or not any(_CROSSING.fullmatch(edge) for edge in stage.sumo.edge_ids()):
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
        person = self._stage.sumo.person
        name = self._stage.name("person")
        edge = self._walk[0].edges[0]
        length_m = self._stage.edge(edge).length_m
        person.add(name, edge, max(0.0, length_m - 5.0))
        person.appendWalkingStage(name, self._walk[0].edges, 5.0)


class _ScriptedVehicle(_Scene):
    """A vehicle that does at given times what it is told."""

    def __init__(self, stage: IncidentStage, incident: incidents.ScriptedVehicle) -> None:
        self._stage, self._incident = stage, incident
        self._lane = stage.lane(incident.route[0], incident.lane)
        for here, there in pairwise(incident.route):
            stage.edge(there)
            if there not in stage.network.crossings.get(here, {}):
                raise ScenarioError(f"[[incidents]]: no road leads from edge {here!r} to {there!r}")
        self._left = list(incident.actions)
        self._since_s = incident.from_s

    def begin(self) -> str:
        incident = self._incident
        speed = f"{incident.speed_kmh / KMH_PER_MPS:.2f}"
        self._car = self._stage.car("scripted", incident.route, self._lane, incident.position_m, speed)
        self._stage.sumo.vehicle.setSpeed(self._car, incident.speed_kmh / KMH_PER_MPS)
        if self._left:  # until it has done all, it changes the lane only when told
            self._stage.sumo.vehicle.setLaneChangeMode(self._car, NO_LANE_CHANGE)
        return ""

    def tick(self, local_time: datetime) -> str:
        sumo = self._stage.sumo
        if self._car in sumo.vehicle_ids():
            while self._left and self._left[0].at_s <= self._since_s:
                self._act(self._left.pop(0))
                if not self._left:
                    sumo.vehicle.setLaneChangeMode(self._car, ANY_LANE_CHANGE)
        self._since_s += 1.0
        return ""

    def _act(self, action: incidents.VehicleAction) -> None:
        sumo, car = self._stage.sumo, self._car
        if action.speed_kmh is not None:
            sumo.vehicle.setSpeed(car, action.speed_kmh / KMH_PER_MPS)
        edge = self._stage.network.edges.get(sumo.edge_of(car))
        lanes = edge.lane_ids if edge is not None else ()
        if action.lanes and sumo.lane_of(car) in lanes:
            from_kerb = -action.lanes if self._stage.network.map.left_hand else action.lanes
            place = min(max(0, lanes.index(sumo.lane_of(car)) + from_kerb), len(lanes) - 1)
            sumo.vehicle.changeLane(car, int(lanes[place].rpartition("_")[2]), CUT_OUT_S)


class _EmergencyVehicle(_Scene):
    """An ambulance, or a van, on the route behind the ego."""

    def __init__(self, stage: IncidentStage, incident: incidents.EmergencyVehicle) -> None:
        self._stage, self._incident = stage, incident
        self._sent = False

    def tick(self, local_time: datetime) -> str:
        """Waits until the ego has come far enough."""
        stage, sensor = self._stage, self._stage.sensor
        if self._sent or sensor is None or sensor.position_m < self._incident.behind_m:
            return ""
        self._sent = True
        index, on_edge_m = sensor.route.edge_at(sensor.position_m - self._incident.behind_m)
        what = "ambulance" if self._incident.blue_light else "van"
        kind = stage.kind(what)
        types = stage.sumo.type
        if self._incident.blue_light:
            types.setVehicleClass(kind, "emergency")
            types.setShapeClass(kind, "emergency")
            types.setParameter(kind, "has.bluelight.device", "true")
        else:
            types.setShapeClass(kind, "delivery")
        types.setLength(kind, 6.5)
        types.setSpeedFactor(kind, self._incident.speed_ratio)
        types.setSpeedDeviation(kind, 0.0)
        types.setParameter(kind, "has.rerouting.device", "false")
        stage.car(what, sensor.route.edge_ids[index:], "", on_edge_m, "max", kind)
        return ""


class _BrakingLeader(_Scene):
    """The vehicle ahead brakes."""

    def __init__(self, stage: IncidentStage, incident: incidents.BrakingLeader) -> None:
        self._stage, self._incident = stage, incident
        self._has_called = False
        self._braking = ""
        self._left_s = 0.0

    def tick(self, local_time: datetime) -> str:
        if self._left_s < 0:
            return ""
        if self._braking:
            self._left_s -= 1.0
            if self._left_s <= 0:
                self._release()
            return ""
        stage, incident = self._stage, self._incident
        if stage.sumo.speed(stage.ego_id) < incident.from_kmh / KMH_PER_MPS:
            return ""
        found = stage.sumo.leader(stage.ego_id, incident.within_m)
        if found and found[0] and found[1] <= incident.within_m:
            return self._brake(found[0]) if found[1] >= incident.beyond_m else ""
        if not self._has_called:
            self._has_called = True
            _call(stage, incident.ahead_m)
        return ""

    def _brake(self, vehicle: str) -> str:
        sumo, incident = self._stage.sumo, self._incident
        to_mps = incident.to_kmh / KMH_PER_MPS
        self._braking = vehicle
        if incident.keeps_lane:
            sumo.vehicle.setLaneChangeMode(vehicle, NO_LANE_CHANGE)
        self._left_s = max(0.0, sumo.speed(vehicle) - to_mps) / incident.deceleration_mps2 + incident.hold_s
        if incident.deceleration_mps2 < GENTLE_MPS2:  # it can brake as hard as ever if it must
            slower_s = self._left_s - incident.hold_s
            sumo.vehicle.slowDown(vehicle, min(to_mps, sumo.speed(vehicle)), max(slower_s, 1.0))
            return "the vehicle ahead slows down"
        sumo.vehicle.setDecel(vehicle, incident.deceleration_mps2)
        sumo.vehicle.setSpeed(vehicle, to_mps)
        return "the vehicle ahead brakes"

    def end(self) -> str:
        if self._braking:
            self._release()
        return ""

    def _release(self) -> None:
        with suppress(*self._stage.sumo.refusals):  # it may have left
            self._stage.sumo.vehicle.setSpeed(self._braking, -1.0)
            if self._incident.keeps_lane:
                self._stage.sumo.vehicle.setLaneChangeMode(self._braking, ANY_LANE_CHANGE)
        self._braking, self._left_s = "", -1.0


def _call(stage: IncidentStage, ahead_m: float) -> None:
    """A car pulls out in front of the ego, as fast as the ego."""
    sensor, ego = stage.sensor, stage.ego_id
    assert sensor is not None
    here, _ = sensor.route.edge_at(sensor.position_m)
    index, on_edge_m = sensor.route.edge_at(sensor.position_m + ahead_m + CAR_SPACE_M)
    lane = stage.sumo.lane_of(ego) if index == here else ""
    fastest_mps = stage.sumo.type.getMaxSpeed(CAR_TYPE)  # less in fog, which the ego may take no notice of
    speed = f"{min(stage.sumo.speed(ego), fastest_mps):.2f}"
    stage.car("leader", sensor.route.edge_ids[index:], lane, on_edge_m, speed)


class _Beside(NamedTuple):
    """The ego on an edge with more than one lane for cars."""

    edge: Edge
    way: Sequence[str]
    """The rest of the ego's route, with that edge."""
    at_m: float
    """Where on it the ego's front is."""
    lane: str
    all_beside: tuple[str, ...]

    @property
    def beside(self) -> str:
        """The lane next to the ego's, on the kerb's side if there is one."""
        return self.all_beside[0]


def _beside(stage: IncidentStage, ahead_m: float) -> _Beside | None:
    """Where the ego is; None beside no other lane, or with less than that way left on the edge."""
    sensor, lane = stage.sensor, stage.sumo.lane_of(stage.ego_id)
    assert sensor is not None
    index, on_edge_m = sensor.route.edge_at(sensor.position_m)
    way = sensor.route.edge_ids[index:]
    edge = stage.network.edges.get(way[0])
    if edge is None or lane not in edge.lane_ids or on_edge_m + ahead_m > edge.length_m:
        return None
    place = edge.lane_ids.index(lane)
    others = tuple(edge.lane_ids[other] for other in (place - 1, place + 1) if 0 <= other < len(edge.lane_ids))
    return _Beside(edge, way, on_edge_m, lane, others) if others else None


def _ahead_m(stage: IncidentStage, vehicle: str, here: _Beside) -> float:
    """How far a vehicle's front is ahead of the ego's; far away if it is on another edge."""
    if stage.sumo.edge_of(vehicle) != here.edge.edge_id:
        return here.edge.length_m
    return float(stage.sumo.vehicle.getLanePosition(vehicle)) - here.at_m


def _move_over(stage: IncidentStage, vehicle: str, lane: str, for_s: float) -> None:
    """A vehicle changes its lane at once, whoever is there."""
    stage.sumo.vehicle.setLaneChangeMode(vehicle, NO_LANE_CHANGE)
    stage.sumo.vehicle.changeLane(vehicle, int(lane.rpartition("_")[2]), for_s)


class _KeptInLane:
    """Keeps the ego in its lane for a while: SUMO's drivers swerve within a step, where people look first."""

    def __init__(self, stage: IncidentStage, for_s: float) -> None:
        self._stage, self._left_s = stage, for_s
        self._mode = int(stage.sumo.vehicle.getLaneChangeMode(stage.ego_id))
        stage.sumo.vehicle.setLaneChangeMode(stage.ego_id, WHEN_ASKED)

    def tick(self) -> None:
        """A second has passed."""
        self._left_s -= 1.0
        if self._left_s == 0:
            self._stage.sumo.vehicle.setLaneChangeMode(self._stage.ego_id, self._mode)


class _CutIn(_Scene):
    """A vehicle beside the ego, which keeps its distance until it moves over."""

    def __init__(self, stage: IncidentStage, incident: incidents.CutIn) -> None:
        self._stage, self._incident = stage, incident
        self._car = ""
        self._left_s: float | None = None
        self._kept: _KeptInLane | None = None

    def tick(self, local_time: datetime) -> str:
        stage, incident = self._stage, self._incident
        if self._left_s is not None:
            self._left_s -= 1.0
            if self._left_s == 0:
                self._release()
            if self._kept is not None:
                self._kept.tick()
            return ""
        mps, slower_mps = stage.sumo.speed(stage.ego_id), incident.slower_kmh / KMH_PER_MPS
        found = _beside(stage, incident.gap_m + CUT_ROOM_M)
        if found is None or mps < incident.from_kmh / KMH_PER_MPS:
            return ""
        if not self._car:
            place_m = found.at_m + incident.gap_m + CAR_SPACE_M
            self._car = stage.car("cut_in", found.way, found.beside, place_m, f"{mps:.2f}")
            return ""
        if self._car not in stage.sumo.vehicle_ids():
            return ""
        gap_m = _ahead_m(stage, self._car, found) - CAR_M
        is_beside = stage.sumo.lane_of(self._car) in found.all_beside
        if not is_beside or not 0 < gap_m <= incident.gap_m + mps * NEARLY_S:
            with suppress(*stage.sumo.refusals):
                stage.sumo.vehicle.setSpeed(self._car, max(CREEP_MPS, mps + (incident.gap_m - gap_m) * NEARS_PER_S))
            return ""
        with suppress(*stage.sumo.refusals):  # the lane may have ended by then
            stage.sumo.vehicle.setSpeed(self._car, max(mps - slower_mps, CREEP_MPS))
            _move_over(stage, self._car, found.lane, incident.hold_s)
        self._left_s = incident.hold_s
        self._kept = _KeptInLane(stage, SWERVES_AFTER_S)
        return "a vehicle cuts in ahead"

    def end(self) -> str:
        if self._car and (self._left_s is None or self._left_s > 0):
            self._release()
        return ""

    def _release(self) -> None:
        with suppress(*self._stage.sumo.refusals):  # it may have left
            self._stage.sumo.vehicle.setSpeed(self._car, -1.0)
            self._stage.sumo.vehicle.setLaneChangeMode(self._car, ANY_LANE_CHANGE)
        self._left_s = 0.0


class _CutOut(_Scene):
    """The vehicle ahead drives at one that stands, and moves over at last."""

    def __init__(self, stage: IncidentStage, incident: incidents.CutOut) -> None:
        self._stage, self._incident = stage, incident
        self._called_s, self._is_over = 0.0, False
        self._car, self._leader, self._beside = "", "", ""
        self._standing: RoadIncident | None = None
        self._kept: _KeptInLane | None = None

    def tick(self, local_time: datetime) -> str:
        if self._is_over:
            if self._kept is not None:
                self._kept.tick()
            return ""
        return self._approach() if self._standing else self._place()

    def _place(self) -> str:
        """Finds the vehicle ahead, and puts one that stands so far ahead of it that SUMO lets it."""
        stage, incident, sumo = self._stage, self._incident, self._stage.sumo
        mps = sumo.speed(stage.ego_id)
        away_m = max(incident.reveal_m, mps**2 / (2 * USUAL_MPS2) + 3 * mps)
        found = _beside(stage, incident.ahead_m + 3 * CAR_SPACE_M + away_m)
        if found is None or mps < incident.from_kmh / KMH_PER_MPS:
            return ""
        leader = sumo.leader(stage.ego_id, incident.within_m)
        if not leader or not leader[0] or leader[1] > incident.within_m:
            self._called_s -= 1.0
            if self._called_s < 0:
                self._called_s = CUT_OUT_S
                _call(stage, max(incident.ahead_m, FOLLOWS_S * mps))
            return ""
        if sumo.lane_of(leader[0]) != found.lane:
            return ""
        mps = sumo.speed(leader[0])
        place_m = round(_ahead_m(stage, leader[0], found) + found.at_m + away_m, 1)
        if place_m > found.edge.length_m - CAR_SPACE_M:
            return ""
        car = stage.car("breakdown", (found.edge.edge_id,), found.lane, place_m, "0")
        for_s = incident.to_s - incident.from_s
        sumo.set_stop(car, found.edge.edge_id, place_m, int(found.lane.rpartition("_")[2]), for_s, 0)
        sumo.set_signals(car, HAZARD_SIGNAL)
        sumo.vehicle.setLaneChangeMode(leader[0], NO_LANE_CHANGE)
        sumo.vehicle.setSpeedMode(leader[0], HEEDLESS)
        sumo.vehicle.setSpeed(leader[0], mps)
        self._car, self._leader, self._beside = car, leader[0], found.beside
        self._standing = RoadIncident(IncidentKind.BREAKDOWN, found.edge.edge_id, place_m)
        return ""

    def _approach(self) -> str:
        sumo, standing = self._stage.sumo, self._standing
        assert standing is not None
        try:
            left_m = standing.position_m - CAR_M - float(sumo.vehicle.getLanePosition(self._leader))
            soon_m = self._incident.reveal_m + sumo.speed(self._leader)
            is_before = sumo.edge_of(self._leader) == standing.edge_id and left_m > 0
            if is_before and (left_m > soon_m or self._car not in sumo.vehicle_ids()):
                return ""
            _move_over(self._stage, self._leader, self._beside, CUT_OUT_S)
            sumo.vehicle.setSpeedMode(self._leader, HEEDFUL)
            sumo.vehicle.setSpeed(self._leader, -1.0)
        except sumo.refusals:  # it has left
            is_before = False
        if not is_before:  # it passed before SUMO had found room for the standing car: once more
            with suppress(*sumo.refusals):
                sumo.vehicle.remove(self._car)
            self._standing = None
            return ""
        self._is_over = True
        self._kept = _KeptInLane(self._stage, SWERVES_AFTER_S)
        return "the vehicle ahead cuts out before a standing car"

    def reported(self, slow: Mapping[str, float]) -> RoadIncident | None:
        return self._standing if self._is_over else None


class _Ahead(_Scene):
    """Another scene, on a road that is chosen when the time has come."""

    def __init__(self, stage: IncidentStage, incident: incidents.AheadIncident) -> None:
        self._stage, self._incident = stage, incident
        self._scene: Scene | None = None
        self._tail: RoadIncident | None = None

    def tick(self, local_time: datetime) -> str:
        if self._scene is not None:
            return self._scene.tick(local_time)
        chosen = self._chosen()
        if chosen is None:
            return ""
        self._scene = scene_of(self._stage, chosen)
        return self._scene.begin()

    def end(self) -> str:
        return "" if self._scene is None else self._scene.end()

    def reported(self, slow: Mapping[str, float]) -> RoadIncident | None:
        """A queue is reported where its tail was at first, however slow the whole road is."""
        return self._tail or (None if self._scene is None else self._scene.reported(slow))

    def _chosen(self) -> incidents.Incident | None:
        """The incident on its road; None as long as there is no room for it."""
        sensor, network, incident = self._stage.sensor, self._stage.network, self._incident
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
        if incident.what == "roadworks":
            limit_kmh = max(20.0, 10.0 * round(0.06 * edges[0].speed_mps * KMH_PER_MPS))
            return incidents.Roadworks(edge=way[0], limit_kmh=limit_kmh, from_s=from_s, to_s=to_s)
        count = _covering(edges, TRACTOR_WAY_M) or len(way)
        return incidents.Tractor(from_edge=way[0], to_edge=way[count - 1], from_s=from_s, to_s=to_s)

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


SCENES: Mapping[type[incidents.Incident], Callable[[IncidentStage, Any], Scene]] = {
    incidents.Breakdown: _Breakdown,
    incidents.Roadworks: _Roadworks,
    incidents.Jam: _Jam,
    incidents.Closure: _Closure,
    incidents.SchoolZone: _SchoolZone,
    incidents.RushHour: _RushHour,
    incidents.Tractor: _Tractor,
    incidents.Pedestrians: _Pedestrians,
    incidents.ScriptedVehicle: _ScriptedVehicle,
    incidents.EmergencyVehicle: _EmergencyVehicle,
    incidents.BrakingLeader: _BrakingLeader,
    incidents.CutIn: _CutIn,
    incidents.CutOut: _CutOut,
    incidents.AheadIncident: _Ahead,
}
"""The scene of each kind of incident."""


def scene_of(stage: IncidentStage, incident: incidents.Incident) -> Scene:
    """The scene of an incident.

    Raises:
        ScenarioError: it does not fit the network.
    """
    return SCENES[type(incident)](stage, incident)


def _on(edge: Edge) -> str:
    return f" on {edge.name}" if edge.name else ""
