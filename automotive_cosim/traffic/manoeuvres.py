"""Incidents that single vehicles make: behind the ego, ahead of it and beside it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from datetime import datetime
from typing import NamedTuple

from automotive_cosim.contracts import KMH_PER_MPS, IncidentKind, RoadIncident
from automotive_cosim.formats import incidents
from automotive_cosim.traffic.incident_tools import CAR_TYPE, IncidentTools
from automotive_cosim.traffic.network import Edge
from automotive_cosim.traffic.sensing import Sensor
from automotive_cosim.traffic.staged import CAR_SPACE_M, StagedIncident
from automotive_cosim.traffic.sumo import ANY_LANE_CHANGE, HAZARD_SIGNAL, WAYMAKING

GENTLE_MPS2 = 3.0
"""A leader that brakes less than this only slows down."""

SWERVES_AFTER_S = 3.0
"""A driver changes the lane no earlier after a surprise: 1.1 s of reaction and a look over the shoulder."""

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

NO_LANE_CHANGE, WHEN_ASKED = 0, 512
"""SUMO's lane change modes: only for safety, and only as commanded."""

PASSED_M = 50.0
"""A vehicle with its blue lights on has passed whoever is so far away: twice the reach of SUMO's device."""

CUT_OUT_S = 10.0
"""How long a vehicle that has cut out keeps its new lane."""


class StagedEmergency(StagedIncident):
    """An ambulance, or a van, on the route behind the ego."""

    def __init__(self, tools: IncidentTools, incident: incidents.EmergencyVehicle) -> None:
        self._tools, self._incident = tools, incident
        self._car = ""
        self._was_there = False
        self._made_way: set[str] = set()

    def tick(self, local_time: datetime) -> str:
        """Waits until the ego has come far enough; then lets drivers be who they were once it has passed them."""
        sensor = self._tools.sensor
        if not self._car:
            if sensor is not None and sensor.position_m >= self._incident.behind_m:
                self._appear(sensor)
        elif self._incident.blue_light:
            self._give_back()
        return ""

    def _appear(self, sensor: Sensor) -> None:
        tools = self._tools
        index, on_edge_m = sensor.route.edge_at(sensor.position_m - self._incident.behind_m)
        what = "ambulance" if self._incident.blue_light else "van"
        kind = self._shaped(what)
        if not sensor.knows_emergency:
            tools.drivers.clear()
        self._car = tools.car(what, sensor.route.edge_ids[index:], "", on_edge_m, "max", kind)

    def _shaped(self, what: str) -> str:
        """The vehicle type of that name, as SUMO is to know it."""
        kind, types = self._tools.kind(what), self._tools.sumo.type
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
        return kind

    def _give_back(self) -> None:
        sumo, drivers = self._tools.sumo, self._tools.drivers
        running = sumo.vehicle_ids()
        is_there = self._car in running
        if self._was_there and not is_there and not self._made_way:
            return
        self._was_there = self._was_there or is_there
        for each in running:
            if each == self._tools.ego_id or each == self._car:
                continue
            if each not in drivers:
                drivers[each] = sumo.manner(each)
            if sumo.vehicle.getLaneChangeMode(each) == WAYMAKING:
                self._made_way.add(each)
        for each in sorted(self._made_way.intersection(running)):
            if is_there and math.dist(sumo.position(each), sumo.position(self._car)) <= PASSED_M:
                continue
            sumo.give_back(each, drivers[each])
            if not is_there or sumo.edge_of(each) != sumo.edge_of(self._car):
                self._made_way.remove(each)


class StagedBraking(StagedIncident):
    """The vehicle ahead brakes."""

    def __init__(self, tools: IncidentTools, incident: incidents.BrakingLeader) -> None:
        self._tools, self._incident = tools, incident
        self._has_called = False
        self._braking = ""
        self._own: tuple[float, float] | None = None
        """How hard the driver brakes, and how fast he drives, when nothing is staged."""
        self._left_s = 0.0

    def tick(self, local_time: datetime) -> str:
        if self._left_s < 0:
            return ""
        if self._braking:
            self._left_s -= 1.0
            if self._left_s <= 0:
                self._release()
            return ""
        tools, incident = self._tools, self._incident
        if tools.sumo.speed(tools.ego_id) < incident.from_kmh / KMH_PER_MPS:
            return ""
        found = tools.sumo.leader(tools.ego_id, incident.within_m)
        if found and found[0] and found[1] <= incident.within_m:
            return self._brake(found[0]) if found[1] >= incident.beyond_m else ""
        if not self._has_called:
            self._has_called = True
            _call(tools, incident.ahead_m)
        return ""

    def _brake(self, vehicle: str) -> str:
        sumo, incident = self._tools.sumo, self._incident
        to_mps = incident.to_kmh / KMH_PER_MPS
        self._braking = vehicle
        if incident.keeps_lane:
            sumo.vehicle.setLaneChangeMode(vehicle, NO_LANE_CHANGE)
        self._left_s = max(0.0, sumo.speed(vehicle) - to_mps) / incident.deceleration_mps2 + incident.hold_s
        if incident.deceleration_mps2 < GENTLE_MPS2:  # it can brake as hard as ever if it must
            slower_s = self._left_s - incident.hold_s
            sumo.vehicle.slowDown(vehicle, min(to_mps, sumo.speed(vehicle)), max(slower_s, 1.0))
            return "the vehicle ahead slows down"
        self._own = sumo.vehicle.getDecel(vehicle), sumo.vehicle.getSpeedFactor(vehicle)
        sumo.vehicle.setDecel(vehicle, incident.deceleration_mps2)
        sumo.vehicle.setSpeed(vehicle, to_mps)
        return "the vehicle ahead brakes"

    def end(self) -> str:
        if self._braking:
            self._release()
        return ""

    def _release(self) -> None:
        with suppress(*self._tools.sumo.refusals):  # it may have left
            self._tools.sumo.vehicle.setSpeed(self._braking, -1.0)
            if self._own is not None:
                self._tools.sumo.vehicle.setDecel(self._braking, self._own[0])
                self._tools.sumo.set_speed_factor(self._braking, self._own[1])
            if self._incident.keeps_lane:
                self._tools.sumo.vehicle.setLaneChangeMode(self._braking, ANY_LANE_CHANGE)
        self._braking, self._left_s = "", -1.0


def _call(tools: IncidentTools, ahead_m: float) -> None:
    """A car pulls out in front of the ego, as fast as the ego."""
    sensor, ego = tools.sensor, tools.ego_id
    assert sensor is not None
    here, _ = sensor.route.edge_at(sensor.position_m)
    index, on_edge_m = sensor.route.edge_at(sensor.position_m + ahead_m + CAR_SPACE_M)
    lane = tools.sumo.lane_of(ego) if index == here else ""
    fastest_mps = tools.sumo.type.getMaxSpeed(CAR_TYPE)  # less in fog, which the ego may take no notice of
    speed = f"{min(tools.sumo.speed(ego), fastest_mps):.2f}"
    tools.car("leader", sensor.route.edge_ids[index:], lane, on_edge_m, speed)


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


def _beside(tools: IncidentTools, ahead_m: float) -> _Beside | None:
    """Where the ego is; None beside no other lane, or with less than that way left on the edge."""
    sensor, lane = tools.sensor, tools.sumo.lane_of(tools.ego_id)
    assert sensor is not None
    index, on_edge_m = sensor.route.edge_at(sensor.position_m)
    way = sensor.route.edge_ids[index:]
    edge = tools.network.edges.get(way[0])
    if edge is None or lane not in edge.lane_ids or on_edge_m + ahead_m > edge.length_m:
        return None
    place = edge.lane_ids.index(lane)
    others = tuple(edge.lane_ids[other] for other in (place - 1, place + 1) if 0 <= other < len(edge.lane_ids))
    return _Beside(edge, way, on_edge_m, lane, others) if others else None


def _ahead_m(tools: IncidentTools, vehicle: str, here: _Beside) -> float:
    """How far a vehicle's front is ahead of the ego's; far away if it is on another edge."""
    if tools.sumo.edge_of(vehicle) != here.edge.edge_id:
        return here.edge.length_m
    return float(tools.sumo.vehicle.getLanePosition(vehicle)) - here.at_m


def _move_over(tools: IncidentTools, vehicle: str, lane: str, for_s: float) -> None:
    """A vehicle changes its lane at once, whoever is there."""
    tools.sumo.vehicle.setLaneChangeMode(vehicle, NO_LANE_CHANGE)
    tools.sumo.vehicle.changeLane(vehicle, int(lane.rpartition("_")[2]), for_s)


class _KeptInLane:
    """Keeps a driver in a lane for a while, as the ego: SUMO's drivers swerve within a step, where people look
    first."""

    def __init__(self, tools: IncidentTools, for_s: float, vehicle: str = "", mode: int = WHEN_ASKED) -> None:
        self._tools, self._left_s, self._vehicle = tools, for_s, vehicle or tools.ego_id
        tools.sumo.vehicle.setLaneChangeMode(self._vehicle, mode)

    def tick(self) -> None:
        """A second has passed."""
        if self._left_s > 1.0:
            self._left_s -= 1.0
        else:
            self.release()

    def release(self) -> None:
        """Lets them change lanes again; may be called again."""
        if self._left_s > 0:
            self._left_s = 0.0
            with suppress(*self._tools.sumo.refusals):  # they may have left
                self._tools.sumo.vehicle.setLaneChangeMode(self._vehicle, ANY_LANE_CHANGE)


class StagedCutIn(StagedIncident):
    """A vehicle beside the ego, which keeps its distance until it moves over."""

    def __init__(self, tools: IncidentTools, incident: incidents.CutIn) -> None:
        self._tools, self._incident = tools, incident
        self._car = ""
        self._left_s: float | None = None
        self._kept: _KeptInLane | None = None

    def tick(self, local_time: datetime) -> str:
        if self._left_s is not None:
            self._hold(self._left_s)
            return ""
        tools, incident = self._tools, self._incident
        mps = tools.sumo.speed(tools.ego_id)
        found = _beside(tools, incident.gap_m + CUT_ROOM_M)
        if found is None or mps < incident.from_kmh / KMH_PER_MPS:
            return ""
        if not self._car:
            place_m = found.at_m + incident.gap_m + CAR_SPACE_M
            self._car = tools.car("cut_in", found.way, found.beside, place_m, f"{mps:.2f}")
            return ""
        if self._car not in tools.sumo.vehicle_ids():
            return ""
        gap_m = _ahead_m(tools, self._car, found) - CAR_M
        is_beside = tools.sumo.lane_of(self._car) in found.all_beside
        if not is_beside or not 0 < gap_m <= incident.gap_m + mps * NEARLY_S:
            with suppress(*tools.sumo.refusals):
                tools.sumo.vehicle.setSpeed(self._car, max(CREEP_MPS, mps + (incident.gap_m - gap_m) * NEARS_PER_S))
            return ""
        self._cut_in(found.lane, mps - incident.slower_kmh / KMH_PER_MPS)
        return "a vehicle cuts in ahead"

    def _cut_in(self, lane: str, to_mps: float) -> None:
        tools, hold_s = self._tools, self._incident.hold_s
        with suppress(*tools.sumo.refusals):  # the lane may have ended by then
            tools.sumo.vehicle.setSpeed(self._car, max(to_mps, CREEP_MPS))
            _move_over(tools, self._car, lane, hold_s)
        self._left_s = hold_s
        self._kept = _KeptInLane(tools, SWERVES_AFTER_S)

    def _hold(self, left_s: float) -> None:
        """A second has passed since it cut in."""
        if left_s > 1.0:
            self._left_s = left_s - 1.0
        elif left_s > 0:
            self._release()
        if self._kept is not None:
            self._kept.tick()

    def end(self) -> str:
        if self._car and (self._left_s is None or self._left_s > 0):
            self._release()
        if self._kept is not None:
            self._kept.release()
        return ""

    def _release(self) -> None:
        with suppress(*self._tools.sumo.refusals):  # it may have left
            self._tools.sumo.vehicle.setSpeed(self._car, -1.0)
            self._tools.sumo.vehicle.setLaneChangeMode(self._car, ANY_LANE_CHANGE)
        self._left_s = 0.0


class StagedCutOut(StagedIncident):
    """The vehicle ahead drives at one that stands, and moves over at last."""

    def __init__(self, tools: IncidentTools, incident: incidents.CutOut) -> None:
        self._tools, self._incident = tools, incident
        self._called_s, self._is_over = 0.0, False
        self._car, self._leader, self._beside = "", "", ""
        self._standing: RoadIncident | None = None
        self._kept: tuple[_KeptInLane, ...] = ()

    def tick(self, local_time: datetime) -> str:
        if self._is_over:
            for each in self._kept:
                each.tick()
            return ""
        return self._approach() if self._standing else self._place()

    def _place(self) -> str:
        """Finds the vehicle ahead, and puts one that stands so far ahead of it that SUMO lets it."""
        tools, incident, sumo = self._tools, self._incident, self._tools.sumo
        mps = sumo.speed(tools.ego_id)
        away_m = max(incident.reveal_m, mps**2 / (2 * USUAL_MPS2) + 3 * mps)
        found = _beside(tools, incident.ahead_m + 3 * CAR_SPACE_M + away_m)
        if found is None or mps < incident.from_kmh / KMH_PER_MPS:
            return ""
        leader = sumo.leader(tools.ego_id, incident.within_m)
        if not leader or not leader[0] or leader[1] > incident.within_m:
            self._called_s -= 1.0
            if self._called_s < 0:
                self._called_s = CUT_OUT_S
                _call(tools, max(incident.ahead_m, FOLLOWS_S * mps))
            return ""
        if sumo.lane_of(leader[0]) != found.lane:
            return ""
        mps = sumo.speed(leader[0])
        place_m = round(_ahead_m(tools, leader[0], found) + found.at_m + away_m, 1)
        if place_m > found.edge.length_m - CAR_SPACE_M:
            return ""
        car = tools.car("breakdown", (found.edge.edge_id,), found.lane, place_m, "0")
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
        sumo, standing = self._tools.sumo, self._standing
        assert standing is not None
        try:
            left_m = standing.position_m - CAR_M - float(sumo.vehicle.getLanePosition(self._leader))
            soon_m = self._incident.reveal_m + sumo.speed(self._leader)
            is_before = sumo.edge_of(self._leader) == standing.edge_id and left_m > 0
            if is_before and (left_m > soon_m or self._car not in sumo.vehicle_ids()):
                return ""
            _move_over(self._tools, self._leader, self._beside, CUT_OUT_S)
            leader = _KeptInLane(self._tools, CUT_OUT_S, self._leader, NO_LANE_CHANGE)
            self._kept = leader, _KeptInLane(self._tools, SWERVES_AFTER_S)
            self._release()
        except sumo.refusals:  # it has left
            is_before = False
        if not is_before:  # it passed before SUMO had found room for the standing car: once more
            with suppress(*sumo.refusals):
                sumo.vehicle.remove(self._car)
            self._standing = None
            self._let_change()
            return ""
        self._is_over = True
        return "the vehicle ahead cuts out before a standing car"

    def end(self) -> str:
        if self._standing and not self._is_over:
            with suppress(*self._tools.sumo.refusals):  # it may have left
                self._release()
                self._tools.sumo.vehicle.setLaneChangeMode(self._leader, ANY_LANE_CHANGE)
        self._let_change()
        return ""

    def _let_change(self) -> None:
        for each in self._kept:
            each.release()

    def _release(self) -> None:
        """The vehicle ahead heeds others again."""
        self._tools.sumo.vehicle.setSpeedMode(self._leader, HEEDFUL)
        self._tools.sumo.vehicle.setSpeed(self._leader, -1.0)

    def reported(self, slow: Mapping[str, float]) -> RoadIncident | None:
        return self._standing if self._is_over else None
