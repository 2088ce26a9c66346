"""libsumo in the process of the tests, where they reach the ``World``; ``fork.Forked`` must drive the same."""

from __future__ import annotations

import tempfile
from pathlib import Path

from automotive_cosim.contracts import (
    Answer,
    DrivingState,
    RoadNetwork,
    RoadRequest,
    RoadShapes,
    RoadSnapshot,
    RouteOption,
)
from automotive_cosim.errors import TrafficError
from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.traffic.base import Advance, EgoPlan, WarmUpProgress
from automotive_cosim.traffic.ego_loop import EgoLoop
from automotive_cosim.traffic.options import SCRATCH, Setup
from automotive_cosim.traffic.world import World


class InProcess:
    """A simulation in this process: without messages, but only one at a time.

    A second ``depart`` loads and warms up again."""

    _current: InProcess | None = None

    def __init__(
        self,
        scenario: Scenario,
        seed: int = 0,
        progress: WarmUpProgress | None = None,
        *,
        allow_unprojected: bool = False,
    ) -> None:
        """Loads the scenario and warms up its traffic.

        Args:
            scenario: the scenario to run.
            seed: seed of SUMO's random numbers.
            progress: called with the progress of the warm-up.
            allow_unprojected: accept a network without projection, with lon and lat None.

        Raises:
            ScenarioError: the scenario cannot be loaded.
            SetupError: libsumo is missing or unsuitable.
            TrafficError: this process already has a simulation."""
        if InProcess._current is not None:
            raise TrafficError("this process already has a simulation; close it first, or use fork.Forked")
        self.setup = Setup(scenario, seed, allow_unprojected)
        self.world: World | None = None
        self._progress = progress
        InProcess._current = self
        try:
            self.world = self._warm()
        except BaseException:
            self.close()
            raise
        self._fresh = True

    def depart(self, plan: EgoPlan) -> InProcessTraffic:
        """Starts the ego; ends the previous drive.

        Raises:
            ScenarioError: its trip has no route, or its edges are not in the network.
            NoRoomError: no gap opened for it.
            TrafficError: SUMO failed, or the simulation is closed."""
        if self.world is None:
            raise TrafficError("the simulation is closed")
        if not self._fresh:
            self.world.close()
            self.world = self._warm()
        self._fresh = False
        return InProcessTraffic(self, self.world, self.world.depart(plan))

    def close(self) -> None:
        """Ends the simulation; may be called again."""
        if self.world is not None:
            self.world.close()
            self.world = None
        if InProcess._current is self:
            InProcess._current = None

    def _warm(self) -> World:
        with tempfile.TemporaryDirectory(prefix=SCRATCH) as scratch:
            world = World(self.setup, Path(scratch))
        world.warm_up(self._progress)
        return world


class InProcessTraffic:
    """One drive in this process's simulation, until the next one departs."""

    def __init__(self, owner: InProcess, world: World, drive: EgoLoop) -> None:
        self._owner: InProcess | None = owner
        self._world = world
        self._drive = drive

    @property
    def network(self) -> RoadNetwork:
        """The road network for maps."""
        return self._world.network.map

    @property
    def state(self) -> DrivingState:
        """The newest state."""
        return self._drive.state

    def start(self, duration_s: float) -> None:
        """See ``Traffic.start``; does nothing."""

    def advance(self, duration_s: float) -> Advance:
        self._check()
        return self._drive.advance(duration_s)

    def request(self, request: RoadRequest) -> Answer:
        self._check()
        return self._drive.request(request)

    def alternatives(self, age_s: float = 0.0) -> tuple[RouteOption, ...]:
        self._check()
        return self._drive.alternatives(age_s)

    def look(self) -> RoadSnapshot:
        self._check()
        return self._drive.look()

    def shapes(self) -> RoadShapes:
        self._check()
        return self._drive.shapes()

    def close(self) -> None:
        self._owner = None

    def _check(self) -> InProcess:
        if self._owner is None or self._owner.world is not self._world:
            raise TrafficError("this drive is over: it was closed, or another one departed in its process")
        return self._owner
