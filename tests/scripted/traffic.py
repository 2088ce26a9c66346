"""A road without SUMO: a straight line of given stretches, driven by the same driver with simple kinematics.

Only the driver's reactions are random.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence

from automotive_cosim.contracts import (
    KMH_PER_MPS,
    Answer,
    DrivingState,
    RoadNetwork,
    RoadRequest,
    RoadShapes,
    RoadSnapshot,
    RouteOption,
)
from automotive_cosim.errors import ScenarioError, TrafficError
from automotive_cosim.traffic.base import Advance, EgoPlan
from automotive_cosim.traffic.ego import Driver
from automotive_cosim.traffic.ego_loop import EgoLoop
from automotive_cosim.traffic.profiles import profile
from tests.scripted.car import ScriptedCar
from tests.scripted.stretches import Layout, Leader, LonLat, Stretch

__all__ = ["Leader", "Scripted", "ScriptedTraffic", "Stretch"]


class Scripted:
    """A ``Simulation`` of a scripted road."""

    def __init__(
        self,
        stretches: Sequence[Stretch],
        *,
        origin: LonLat | None = (2.2950, 48.8738),
        heading_deg: float = 90.0,
        step_length_s: float = 0.1,
        start_s: float = 0.0,
        start_speed_kmh: float = 0.0,
    ) -> None:
        """Lays out the road.

        Args:
            stretches: in driving order.
            origin: (lon, lat) of the start, WGS 84; without it, the road has no position on earth.
            heading_deg: direction of the road, clockwise from north.
            step_length_s: step of the kinematics.
            start_s: time of the first state.
            start_speed_kmh: speed in it.

        Raises:
            ScenarioError: there is no stretch, or one has no length."""
        if not stretches or any(stretch.length_m <= 0 for stretch in stretches):
            raise ScenarioError("a scripted road requires at least one stretch, each longer than 0 m")
        self._layout = Layout(tuple(stretches), origin, math.radians(heading_deg))
        self._step_s = step_length_s
        self._start_s = start_s
        self._start_mps = start_speed_kmh / KMH_PER_MPS

    @property
    def network(self) -> RoadNetwork:
        """The road network for maps."""
        return self._layout.network.map

    def depart(self, plan: EgoPlan) -> ScriptedTraffic:
        """Starts a drive from the beginning of the road, whatever the plan's trip.

        Raises UnknownNameError: no such driver."""
        start_mps = 0.0 if plan.parked else self._start_mps
        car = ScriptedCar(
            self._layout, profile(plan.driver), self._step_s, self._start_s, start_mps, parked=plan.parked
        )
        return ScriptedTraffic(EgoLoop(car, Driver(plan, car, self._step_s), car.now), self.network)

    def close(self) -> None:
        """Does nothing."""


class ScriptedTraffic:
    """One drive on a scripted road."""

    def __init__(self, drive: EgoLoop, network: RoadNetwork) -> None:
        self._drive = drive
        self._network = network
        self._is_closed = False

    @property
    def network(self) -> RoadNetwork:
        """The road network for maps."""
        return self._network

    @property
    def state(self) -> DrivingState:
        """The newest state."""
        return self._drive.state

    def start(self, duration_s: float) -> None:
        """See ``Traffic.start``; does nothing."""

    def advance(self, duration_s: float) -> Advance:
        return self._open().advance(duration_s)

    def request(self, request: RoadRequest) -> Answer:
        return self._open().request(request)

    def alternatives(self, age_s: float = 0.0) -> tuple[RouteOption, ...]:
        return self._open().alternatives(age_s)

    def look(self) -> RoadSnapshot:
        return self._open().look()

    def shapes(self) -> RoadShapes:
        return self._open().shapes()

    def branch(self) -> ScriptedTraffic:
        return ScriptedTraffic(copy.deepcopy(self._open()), self._network)

    def close(self) -> None:
        self._is_closed = True

    def _open(self) -> EgoLoop:
        if self._is_closed:
            raise TrafficError("the drive is closed")
        return self._drive
