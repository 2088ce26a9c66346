"""Vehicles that do by a script what they are told, at a time or once something holds."""

from __future__ import annotations

import math
from collections import deque
from datetime import datetime
from itertools import pairwise

from automotive_cosim.contracts import KMH_PER_MPS
from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.incidents import ScriptedVehicle, VehicleAction, VehicleCondition
from automotive_cosim.traffic.incident_tools import CAR_TYPE, IncidentTools
from automotive_cosim.traffic.manoeuvres import CUT_OUT_S, NO_LANE_CHANGE
from automotive_cosim.traffic.script import VehicleScript
from automotive_cosim.traffic.staged import StagedIncident
from automotive_cosim.traffic.sumo import ANY_LANE_CHANGE

FOR_ITS_ROUTE = 1
"""SUMO's lane change mode: as commanded, and where its route asks for another lane."""
STANDS_MPS = 0.1
"""Who is slower stands."""
ABOVE_LIMITS = 5.0
"""A factor on limits that bind nobody: told a speed above the limit, SUMO 1.28's cars swing around it."""
EQUAL = 0.01
"""Values that differ by no more are equal."""
CLOSES_S = 4.0
"""A vehicle that keeps a distance makes up what is missing in about this time: some reactions of a driver."""
APART_M = 0.5
"""A distance is come to when no more is missing."""
NEAREST_S = 0.5
"""Seconds are counted from the ego's departure to the nearest whole one of the simulation."""


class _Watch:
    """A condition over time."""

    def __init__(self, condition: VehicleCondition, tools: IncidentTools, script: VehicleScript) -> None:
        self._condition, self._tools, self._script = condition, tools, script
        self._was: bool | None = False if condition.what == "time" else None
        self._past: deque[bool] = deque(maxlen=round(condition.delay_s) + 1)
        self._at: tuple[float, float] | None = None
        self._stood_s, self._left_s = -1.0, 0.0

    def tick(self, now_s: float) -> bool:
        """Whether it holds; called once a second."""
        is_true = self._is_true(now_s)
        edge, was, self._was = self._condition.edge, self._was, is_true
        has_risen, has_fallen = is_true and was is False, not is_true and was is True
        self._past.append(
            is_true if edge == "none" else (has_risen and edge != "falling") or (has_fallen and edge != "rising")
        )
        return len(self._past) == self._past.maxlen and self._past[0]

    def _is_true(self, now_s: float) -> bool:
        condition, script = self._condition, self._script
        if condition.what in ("begun", "ended"):
            known = condition.of in script.begun if condition.what == "begun" else script.has_ended(condition.of)
            return known != condition.below
        car = script.car(condition.of)
        if condition.what == "left":
            self._left_s = 0.0 if car or not script.has_been(condition.of) else self._left_s + 1.0
            return self._left_s > condition.value
        value = now_s if condition.what == "time" else self._value(car) if car else None
        if value is None:
            return False
        if condition.equal:
            return abs(value - condition.value) <= EQUAL
        return value < condition.value if condition.below else value > condition.value

    def _value(self, car: str) -> float | None:
        sumo, condition = self._tools.sumo, self._condition
        if condition.what == "speed":
            return sumo.speed(car)
        if condition.what == "acceleration":
            return sumo.acceleration(car)
        if condition.what == "travelled":
            return sumo.driven(car)
        if condition.what == "stands":
            self._stood_s = self._stood_s + 1.0 if sumo.speed(car) < STANDS_MPS else -1.0
            return self._stood_s
        if condition.what == "place":
            before, self._at = self._at, sumo.position(car)
            return _passed_m(before or self._at, self._at, (condition.x_m, condition.y_m))
        other = self._script.car(condition.to)
        if not other:
            return None
        if condition.what == "faster":
            return sumo.speed(car) - sumo.speed(other)
        ahead_m = self._script.ahead_m(car, other)
        if condition.straight:
            ahead_m = math.copysign(math.dist(sumo.position(car), sumo.position(other)), ahead_m)
        gap_m = abs(ahead_m)
        if condition.bumper:
            gap_m = max(0.0, gap_m - sumo.length(other if ahead_m > 0 else car))
        if condition.what == "distance":
            return gap_m
        mps = sumo.speed(car)
        if condition.what == "headway":
            return gap_m / mps if ahead_m > 0 and mps > STANDS_MPS else None
        closing_mps = mps - sumo.speed(other) if ahead_m > 0 else sumo.speed(other) - mps
        return gap_m / closing_mps if closing_mps > 0 else None


def _passed_m(begin: tuple[float, float], end: tuple[float, float], place: tuple[float, float]) -> float:
    """How near a way comes to a place."""
    way = end[0] - begin[0], end[1] - begin[1]
    length2 = way[0] ** 2 + way[1] ** 2
    share = 0.0 if not length2 else ((place[0] - begin[0]) * way[0] + (place[1] - begin[1]) * way[1]) / length2
    share = min(1.0, max(0.0, share))
    return math.dist((begin[0] + share * way[0], begin[1] + share * way[1]), place)


class _Task:
    """An action that waits or goes on."""

    def __init__(self, action: VehicleAction, tools: IncidentTools, script: VehicleScript) -> None:
        self.action = action
        self.ends_s, self.times = math.inf, action.times
        self._watches = [(each.group, _Watch(each, tools, script)) for each in action.when]

    def is_due(self, now_s: float) -> bool:
        """Whether it begins; called once a second."""
        held: dict[int, bool] = {}
        for group, watch in self._watches:
            held[group] = watch.tick(now_s) & held.get(group, True)
        return self.action.at_s <= now_s + NEAREST_S and (not held or any(held.values()))


class StagedVehicle(StagedIncident):
    """A vehicle that does what it is told."""

    def __init__(self, tools: IncidentTools, incident: ScriptedVehicle) -> None:
        self._tools, self._incident = tools, incident
        self._lane = tools.lane(incident.route[0], incident.lane)
        for here, there in pairwise(incident.route):
            tools.edge(there)
            if there not in tools.network.crossings.get(here, {}):
                raise ScenarioError(f"[[incidents]]: no road leads from edge {here!r} to {there!r}")
        tools.script.expect(incident)
        self._waiting = [_Task(action, tools, tools.script) for action in incident.actions]
        self._going_on: list[_Task] = []
        self._kept: tuple[float, VehicleAction] | None = None
        """From when on a speed is kept, and whose."""
        self._adapts: _Task | None = None
        """What it adapts its speed for."""
        self._moves: VehicleAction | None = None
        """The change of lane that it is about to make."""

    def begin(self) -> str:
        incident, sumo = self._incident, self._tools.sumo
        mps = incident.speed_kmh / KMH_PER_MPS
        kind = CAR_TYPE
        if incident.length_m != sumo.type.getLength(CAR_TYPE):
            kind = self._tools.kind("scripted")
            sumo.type.setLength(kind, incident.length_m)
        self._car = self._tools.car("scripted", incident.route, self._lane, incident.position_m, f"{mps:.2f}", kind)
        self._tools.script.enter(incident.name or self._car, self._car)
        self._begun_s = sumo.time() - incident.from_s
        sumo.vehicle.setSpeed(self._car, mps)
        if incident.keeps_lane:
            sumo.set_speed_factor(self._car, ABOVE_LIMITS)
            sumo.vehicle.setLaneChangeMode(self._car, FOR_ITS_ROUTE)
        elif self._waiting:  # until it has done all, it changes the lane only when told
            sumo.vehicle.setLaneChangeMode(self._car, NO_LANE_CHANGE)
        return ""

    def tick(self, local_time: datetime) -> str:
        sumo = self._tools.sumo
        now_s = sumo.time() - self._begun_s
        is_there = self._car in sumo.vehicle_ids()
        for task in [task for task in self._waiting if task.is_due(now_s) and task not in self._going_on]:
            task.times -= 1
            if not task.times:
                self._waiting.remove(task)
            self._tools.script.begun.add(task.action.name)
            if is_there:
                self._act(task, now_s)
            self._going_on.append(task)
            if not self._waiting and not self._incident.keeps_lane and is_there:
                sumo.vehicle.setLaneChangeMode(self._car, ANY_LANE_CHANGE)
        if is_there and self._adapts is not None and self._has_adapted(self._adapts.action):
            self._adapts.ends_s, self._adapts = now_s, None
        for task in [task for task in self._going_on if task.ends_s <= now_s + NEAREST_S or not is_there]:
            self._going_on.remove(task)
            if not task.times:
                self._tools.script.end(task.action)
        if is_there and self._moves is not None and self._move_over(self._moves):
            self._moves = None
        if is_there and self._kept is not None and self._kept[0] <= now_s + NEAREST_S:
            sumo.vehicle.setSpeed(self._car, self._mps(self._kept[1]))
            if not self._kept[1].keeps:
                self._kept = None
        return ""

    def _mps(self, action: VehicleAction) -> float:
        """The speed that an action asks for."""
        if action.speed_kmh is not None:
            return action.speed_kmh / KMH_PER_MPS
        sumo = self._tools.sumo
        other = self._tools.script.car(action.of) or self._car
        return max(0.0, (action.speed_share or 0.0) * sumo.speed(other) + action.faster_kmh / KMH_PER_MPS)

    def _act(self, task: _Task, now_s: float) -> None:
        sumo, car, action = self._tools.sumo, self._car, task.action
        task.ends_s = now_s + action.over_s
        if action.alone and self._going_on:
            for other in self._going_on:
                other.ends_s = now_s
            self._adapts = None
            if self._kept is not None and self._kept[0] > now_s:
                sumo.vehicle.setSpeed(car, sumo.speed(car))
                self._kept = None
        adapts = action.meets_edge or action.gap_m is not None or action.gap_s is not None
        if self._adapts is not None and (adapts or action.speed_kmh is not None or action.speed_share is not None):
            self._adapts.ends_s, self._adapts = now_s, None
        if adapts:
            task.ends_s, self._adapts, self._kept = math.inf, task, None
            return
        if action.speed_kmh is not None or action.speed_share is not None:
            mps, from_mps = self._mps(action), sumo.speed(car)
            over_s = action.over_s
            if action.rate:
                over_s = abs(mps - from_mps) / action.rate
            elif action.over_m:
                over_s = 2 * action.over_m / max(mps + from_mps, STANDS_MPS)
            task.ends_s = now_s + over_s
            self._kept = task.ends_s, action
            if over_s > 0:
                sumo.vehicle.slowDown(car, mps, over_s)
        if action.lanes or action.lane is not None or (action.of and action.speed_share is None):
            self._moves = action

    def _has_adapted(self, action: VehicleAction) -> bool:
        """Whether it has come to a distance, or one of two to its place; until then, adapts the speed."""
        if not action.meets_edge:
            return self._is_apart(action) and not action.keeps
        sumo, script = self._tools.sumo, self._tools.script
        other = script.car(action.of)
        left_m = script.left_m(self._car, action.meets_edge, action.meets_m)
        other_m = script.left_m(other, action.of_meets_edge, action.of_meets_m) if other else 0.0
        left_s = other_m / max(sumo.speed(other), STANDS_MPS) if other_m > 0 else 0.0
        if left_m <= 0 or left_s <= 1.0:
            if action.speed_kmh is not None or action.speed_share is not None:
                sumo.vehicle.setSpeed(self._car, self._mps(action))
            return True
        mps = left_m / left_s
        if action.speed_kmh is not None or action.speed_share is not None:  # it changes steadily to the last one
            mps = 2 * mps - self._mps(action)
        sumo.vehicle.setSpeed(self._car, max(0.0, mps))
        return False

    def _is_apart(self, action: VehicleAction) -> bool:
        """Whether it is at its distance from another; adapts its speed to that."""
        sumo, script, car = self._tools.sumo, self._tools.script, self._car
        other = script.car(action.of)
        if not other:
            return True
        ahead_m, mps = script.ahead_m(car, other), sumo.speed(car)
        side = 1.0 if action.trails else math.copysign(1.0, ahead_m)
        wanted_m = (action.gap_m or 0.0) + (action.gap_s or 0.0) * mps
        wanted_m += sumo.length(other if side > 0 else car) if action.bumper else 0.0
        more_m = ahead_m - side * wanted_m
        sumo.vehicle.setSpeed(car, max(0.0, sumo.speed(other) + more_m / CLOSES_S))
        return abs(more_m) <= APART_M

    def _move_over(self, action: VehicleAction) -> bool:
        """Whether it can change into the lane that an action asks for: not within a junction."""
        tools, lane = self._tools, self._tools.sumo.lane_of(self._car)
        lanes = beside = self._beside(lane)
        place = action.lane
        if place is None:
            lane = tools.sumo.lane_of(tools.script.car(action.of) or self._car)
            beside = self._beside(lane)
            from_kerb = -action.lanes if tools.network.map.left_hand else action.lanes
            from_kerb += len(lanes) - len(beside)  # lanes open and end there
            place = beside.index(lane) + from_kerb if beside else -1
        if not lanes or not beside:
            return False
        target = lanes[min(max(0, place), len(lanes) - 1)]
        tools.sumo.vehicle.changeLane(self._car, int(target.rpartition("_")[2]), CUT_OUT_S)
        return True

    def _beside(self, lane: str) -> tuple[str, ...]:
        """The lanes for cars of a lane's edge; none unless it is one."""
        edge = self._tools.network.edges.get(lane.rpartition("_")[0])
        return edge.lane_ids if edge is not None and lane in edge.lane_ids else ()
