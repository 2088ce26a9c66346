"""What the scripted vehicles of a simulation know of each other: who is where, and which actions are over."""

from __future__ import annotations

import math
from collections import Counter

from automotive_cosim.formats.incidents import ScriptedVehicle, VehicleAction
from automotive_cosim.traffic.sumo import LibSumo

EGO = "ego"
"""What scripts call the ego."""


class VehicleScript:
    """What the scripted vehicles of a simulation know of each other."""

    def __init__(self, sumo: LibSumo, ego_id: str) -> None:
        self._sumo = sumo
        self._cars = {EGO: ego_id}
        self._been: set[str] = set()
        self.begun: set[str] = set()
        """The actions that have begun."""
        self._left: Counter[str] = Counter()
        """How many of each name have not ended."""

    def expect(self, vehicle: ScriptedVehicle) -> None:
        """Takes note of a vehicle that may come."""
        self._left.update(action.name for action in vehicle.actions)

    def enter(self, name: str, car: str) -> None:
        """Takes note of a vehicle that is there."""
        self._cars[name] = car

    def left_m(self, car: str, edge: str, at_m: float) -> float:
        """How far a vehicle on the road has yet to drive to a place; negative if its way leads there no more."""
        if self._sumo.edge_of(car) == edge:
            return at_m - self._sumo.lane_position(car)
        return float(self._sumo.vehicle.getDrivingDistance(car, edge, at_m, 0))

    def end(self, action: VehicleAction) -> None:
        self._left[action.name] -= 1

    def has_ended(self, name: str) -> bool:
        """Whether all actions of a name are over."""
        return name in self._left and self._left[name] <= 0

    def car(self, name: str) -> str:
        """SUMO's id of a vehicle that is on the road; empty if it is not."""
        car = self._cars.get(name, "")
        if car not in self._sumo.vehicle_ids():
            return ""
        self._been.add(name)
        return car

    def has_been(self, name: str) -> bool:
        """Whether it has been seen on the road."""
        return name in self._been

    def ahead_m(self, car: str, other: str) -> float:
        """How far the front of another is ahead along the road, negative if behind."""
        sumo = self._sumo
        here, there = ((sumo.edge_of(each), sumo.lane_position(each)) for each in (car, other))
        if here[0] == there[0]:
            return there[1] - here[1]
        (x_m, y_m), (other_x_m, other_y_m) = sumo.position(car), sumo.position(other)
        heading = math.radians(90 - sumo.angle(car))
        straight_m = (other_x_m - x_m) * math.cos(heading) + (other_y_m - y_m) * math.sin(heading)
        ways = (
            [(1.0, car, there), (-1.0, other, here)] if straight_m > 0 else [(-1.0, other, here), (1.0, car, there)]
        )
        for sign, from_, (edge, at_m) in ways:
            if not edge.startswith(":"):
                along_m = float(sumo.vehicle.getDrivingDistance(from_, edge, at_m, 0))
                if along_m >= 0:
                    return sign * along_m
        return straight_m
