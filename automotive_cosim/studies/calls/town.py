"""What every car comes to that sets out from now on, and which of them get a cockpit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from zlib import crc32

import numpy as np

from automotive_cosim.contracts import DrivingState, RoadShapes, RoadSnapshot
from automotive_cosim.measures.thresholds import DEFAULT_THRESHOLDS
from automotive_cosim.scenarios import Trip
from automotive_cosim.traffic import running as in_traffic
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.lookout import read_shapes
from automotive_cosim.traffic.running import Running
from automotive_cosim.traffic.sumo import LibSumo

SIDE_STREETS = frozenset(("residential", "living_street", "service", "unclassified"))
"""OpenStreetMap's classes of roads that are not meant for through traffic."""
PETROL_WH_PER_MG = 43.2 / 3600
"""What SUMO's milligrams of fuel hold: 43.2 MJ/kg, petrol in EN 16258."""
NOWHERE = Trip("", "", "")
"""The trip of a driver who has one already."""


@dataclass(frozen=True, slots=True)
class CarTrip:
    """One car's trip up to now, or to its end."""

    planned_s: float
    """Simulation time at which it wanted to set out."""
    until_s: float
    """Simulation time at which it arrived, or now."""
    has_left: bool = False
    """Whether it is off the road."""
    lost_s: float = 0.0
    """SUMO's ``timeLoss``."""
    driven_m: float = 0.0
    side_m: float = 0.0
    """Of that, in side streets."""
    near_s: float = 0.0
    """Time with a time to collision to the car ahead below the customary threshold (``measures.thresholds``)."""
    energy_wh: float = 0.0


class Town:
    """Follows every car that sets out."""

    def __init__(self, sumo: LibSumo, step_s: float, side: frozenset[str]) -> None:
        """Begins now; ``side`` are the edges of side streets."""
        self._sumo, self._step_s, self._side = sumo, step_s, side
        self.trips: dict[str, CarTrip] = {}
        self.driving: dict[str, float] = {}
        """Who is on the road, and the gap that each keeps when standing."""
        self.equipped: list[str] = []
        """Who has got a cockpit."""

    def after_step(self) -> None:
        """Records the step that has just been made."""
        sumo, now_s = self._sumo, self._sumo.time()
        for car in sumo.departed() if sumo.departed_count() else ():
            if sumo.vehicle_class(car) == "passenger":
                self.trips[car] = CarTrip(now_s - sumo.vehicle.getDepartDelay(car), now_s)
                self.driving[car] = sumo.min_gap(car)
        for car in sumo.arrived() if sumo.arrived_count() else ():
            if self.driving.pop(car, None) is not None:
                self.trips[car] = replace(self.trips[car], until_s=now_s, has_left=True)
        for car, min_gap_m in self.driving.items():
            self.trips[car] = self._after(self.trips[car], car, min_gap_m, now_s)

    def _after(self, trip: CarTrip, car: str, min_gap_m: float, now_s: float) -> CarTrip:
        sumo, step_s = self._sumo, self._step_s
        mps = sumo.speed(car)
        metres = mps * step_s
        leader = sumo.leader(car, DEFAULT_THRESHOLDS.range_m)
        is_near = False
        if leader is not None and leader[0] and (closing_mps := mps - sumo.speed(leader[0])) > 0:
            gap_m = max(0.0, leader[1] + min_gap_m)
            is_near = gap_m / closing_mps < DEFAULT_THRESHOLDS.ttc_s
        of = sumo.vehicle
        wh = of.getFuelConsumption(car) * PETROL_WH_PER_MG + of.getElectricityConsumption(car)
        return CarTrip(
            trip.planned_s,
            now_s,
            False,
            sumo.time_loss(car),
            trip.driven_m + metres,
            trip.side_m + (metres if sumo.edge_of(car) in self._side else 0.0),
            trip.near_s + step_s * is_near,
            trip.energy_wh + wh * step_s,
        )


def follow_town(running: Running) -> bool:
    """Follows every car that sets out from now on, in all copies made later too; returns whether the network has
    side streets."""
    edges = running.world.network.edges.values()
    side = frozenset(edge.edge_id for edge in edges if edge.road_class in SIDE_STREETS)
    running.watchers.append(Town(running.sumo, running.world.step_s, side))
    return bool(side)


def equip(running: Running, share: float, seed: int, driver: str) -> None:
    """Puts a cockpit into a share of the cars that set out from now on; a greater share has all cars of a smaller.

    Args:
        share: 0 to 1.
        seed: of the draw, and of the drivers' reactions.
        driver: name of the profile by which they react; else they drive as they would."""
    running.convoy.chooses = partial(_plan, running.watcher(Town), share, seed, driver)


def drawn(seed: int, car: str) -> float:
    """Below the share if a car gets a cockpit."""
    return float(np.random.default_rng((seed, crc32(car.encode()))).random())


def driving(running: Running) -> list[str]:
    """The cars that are on roads for cars now."""
    sumo, edges = running.sumo, running.world.network.edges
    cars = (car for car in sumo.vehicle_ids() if sumo.vehicle_class(car) == "passenger")
    return [car for car in cars if sumo.edge_of(car) in edges]


def woken(running: Running, car: str, seed: int, driver: str) -> tuple[bool, DrivingState | None]:
    """Puts a cockpit into a car that had none for a while: whether the car is still in the traffic, and its state;
    None in a junction, where nothing can be asked for."""
    is_there = car in running.watcher(Town).driving
    if not is_there or running.sumo.edge_of(car) not in running.world.network.edges:
        return is_there, None
    return True, running.convoy.equip(car, EgoPlan(NOWHERE, driver, seed ^ crc32(car.encode()))).state


def network_of(running: Running) -> RoadShapes:
    """The whole network as a picture shows it."""
    return replace(read_shapes(running.sumo), ground=running.world.network.map.ground)


def seen(running: Running) -> RoadSnapshot:
    """The equipped cars on the road now."""
    return in_traffic.seen(running, running.watcher(Town).equipped)


def trips_of(running: Running) -> Mapping[str, CarTrip]:
    """What every car has come to."""
    return running.watcher(Town).trips


def way_of_device(running: Running, car: str) -> tuple[str, ...]:
    """The edges on which SUMO's rerouting device would send a car now; empty if it keeps its own or is in a
    junction."""
    sumo = running.sumo
    if sumo.edge_of(car).startswith(":"):
        return ()
    own = sumo.vehicle.getRoute(car)[sumo.vehicle.getRouteIndex(car) :]
    try:
        sumo.reroute(car)
    except sumo.refusals:
        return ()
    way = sumo.vehicle.getRoute(car)[sumo.vehicle.getRouteIndex(car) :]
    sumo.set_route(car, own)
    return () if way == own else tuple(way)


def _plan(town: Town, share: float, seed: int, driver: str, car: str) -> EgoPlan | None:
    if drawn(seed, car) >= share:
        return None
    town.equipped.append(car)
    return EgoPlan(NOWHERE, driver, seed ^ crc32(car.encode()))
