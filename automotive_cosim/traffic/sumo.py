"""The boundary to SUMO: the only module that imports libsumo.

``Sumo`` is libsumo with types: each attribute is the library's own function, so a call costs nothing extra. libsumo
holds one simulation per process; ``InProcess`` is that one, ``fork.Forked`` keeps each in a process of its own.
"""

from __future__ import annotations

import os
import re
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

from automotive_cosim.errors import ScenarioError, SetupError, TrafficError
from automotive_cosim.scenarios import Scenario
from automotive_cosim.traffic.base import EgoPlan, Progress
from automotive_cosim.traffic.options import Setup

if TYPE_CHECKING:
    from automotive_cosim.contracts import Answer, DrivingState, RoadNetwork, RoadRequest, RouteOption
    from automotive_cosim.traffic.base import Drive, Traffic, Until
    from automotive_cosim.traffic.drive import Call, EgoDrive
    from automotive_cosim.traffic.world import World

VERSION = "1.28"
"""SUMO's version that networks, scenarios and results belong to."""

DEBIAN_PACKAGES = "libgl1 libx11-6 libxext6 libxrender1 libatomic1 libexpat1"
"""System libraries that libsumo wants and slim images lack."""

SUMO_VARIABLES = ("SUMO_HOME", "PROJ_DATA", "PROJ_LIB")
"""Variables that would point libsumo to another installation's data; importing it sets the first two itself."""

EGO = "ego"
EGO_TYPE = "automotive_cosim.ego"


class Sumo:
    """libsumo's functions that are used here, typed. Lengths in m, speeds in m/s, times in s."""

    def __init__(self, library: Any) -> None:
        vehicle, lane, edge, simulation = library.vehicle, library.lane, library.edge, library.simulation
        self.refusals: tuple[type[Exception], ...] = (library.TraCIException, library.FatalTraCIError)
        self.start: Callable[[list[str]], tuple[int, str]] = library.start
        self.close: Callable[[], None] = library.close
        # the same without the library's list of listeners, which nobody uses here
        self.step: Callable[[], object] = getattr(library, "_libsumo_step", library.simulationStep)
        self.time: Callable[[], float] = _direct(simulation.getTime)
        self.arrived: Callable[[], Sequence[str]] = _direct(simulation.getArrivedIDList)
        self.arrived_count: Callable[[], int] = _direct(simulation.getArrivedNumber)
        self.departed: Callable[[], Sequence[str]] = _direct(simulation.getDepartedIDList)
        self.departed_count: Callable[[], int] = _direct(simulation.getDepartedNumber)
        self.teleporting: Callable[[], Sequence[str]] = _direct(simulation.getStartingTeleportIDList)
        self.teleporting_count: Callable[[], int] = _direct(simulation.getStartingTeleportNumber)
        self.colliding_count: Callable[[], int] = _direct(simulation.getCollidingVehiclesNumber)
        self.collisions: Callable[[], Sequence[Any]] = _direct(simulation.getCollisions)
        self.to_lon_lat: Callable[[float, float], tuple[float, float]] = _direct(simulation.convertGeo)
        self.find_road: Callable[[float, float, bool, str], tuple[str, float, int]] = simulation.convertRoad
        self.find_route: Callable[..., Any] = simulation.findRoute
        self.position: Callable[[str], tuple[float, float]] = _direct(vehicle.getPosition)
        self.angle: Callable[[str], float] = _direct(vehicle.getAngle)
        self.speed: Callable[[str], float] = _direct(vehicle.getSpeed)
        self.acceleration: Callable[[str], float] = _direct(vehicle.getAcceleration)
        self.edge_of: Callable[[str], str] = _direct(vehicle.getRoadID)
        self.lane_of: Callable[[str], str] = _direct(vehicle.getLaneID)
        self.lane_index: Callable[[str], int] = _direct(vehicle.getLaneIndex)
        self.lane_position: Callable[[str], float] = _direct(vehicle.getLanePosition)
        self.driven: Callable[[str], float] = _direct(vehicle.getDistance)
        self.route: Callable[[str], Sequence[str]] = vehicle.getRoute
        self.route_index: Callable[[str], int] = _direct(vehicle.getRouteIndex)
        self.next_lights: Callable[[str], Sequence[tuple[str, int, float, str]]] = vehicle.getNextTLS
        self.leader: Callable[[str, float], tuple[str, float] | None] = vehicle.getLeader
        self.follower: Callable[[str, float], tuple[str, float]] = _direct(vehicle.getFollower)
        self.min_gap: Callable[[str], float] = vehicle.getMinGap
        self.length: Callable[[str], float] = vehicle.getLength
        self.vehicle_class: Callable[[str], str] = vehicle.getVehicleClass
        self.set_parameter: Callable[[str, str, str], None] = vehicle.setParameter
        self.add_vehicle: Callable[..., None] = vehicle.add
        self.set_speed_factor: Callable[[str, float], None] = vehicle.setSpeedFactor
        self.set_max_speed: Callable[[str, float], None] = vehicle.setMaxSpeed
        self.set_headway: Callable[[str, float], None] = vehicle.setTau
        self.set_imperfection: Callable[[str, float], None] = vehicle.setImperfection
        self.set_signals: Callable[[str, int], None] = vehicle.setSignals
        self.set_route: Callable[[str, Sequence[str]], None] = vehicle.setRoute
        self.set_stop: Callable[..., None] = vehicle.setStop
        self.add_route: Callable[[str, Sequence[str]], None] = library.route.add
        self.copy_type: Callable[[str, str], None] = library.vehicletype.copy
        self.type_of: Callable[[str], str] = vehicle.getTypeID
        self.type: Any = library.vehicletype
        self.vehicle: Any = vehicle
        self.lane: Any = lane
        self.person: Any = library.person
        self.simulation: Any = simulation
        self.light_state: Callable[[str], str] = _direct(library.trafficlight.getRedYellowGreenState)
        self.friction: Callable[[str], float] = lane.getFriction
        self.lane_speed: Callable[[str], float] = lane.getMaxSpeed
        self.adapt_travel_time: Callable[[str, float, float, float], None] = edge.adaptTraveltime
        self.edge_ids: Callable[[], Sequence[str]] = edge.getIDList
        self.edge_vehicles: Callable[[str], Sequence[str]] = edge.getLastStepVehicleIDs
        self.vehicle_ids: Callable[[], Sequence[str]] = vehicle.getIDList

    def on_edges(self) -> Iterator[tuple[str, float]]:
        """The edge and speed of every vehicle in a lane; those parked or off the road are in none."""
        lane_of, speed = self.lane_of, self.speed
        for vehicle in self.vehicle_ids():
            if lane := lane_of(vehicle):
                yield lane.rpartition("_")[0], speed(vehicle)


Function = TypeVar("Function", bound=Callable[..., Any])


def _direct(function: Function) -> Function:
    """The C function behind a Python function of the library that does nothing but call it: that saves a call."""
    names = function.__code__.co_names
    if len(names) == 2 and names[0] == "_libsumo":
        direct: Function = getattr(function.__globals__["_libsumo"], names[1])
        return direct
    return function


def load_library() -> Sumo:
    """Imports libsumo with its own data, whatever the environment says, and leaves the environment as it was.

    Raises:
        SetupError: it is not installed, lacks a system library, or has another version.
    """
    kept = {name: os.environ.pop(name, None) for name in SUMO_VARIABLES}
    try:
        import libsumo
    except ImportError as error:
        raise SetupError(_mend(error)) from error
    finally:
        own = {name: os.environ[name] for name in SUMO_VARIABLES if name in os.environ}
        if own or not _OWN_DATA:  # where somebody had imported it before us, the environment already is its own
            _OWN_DATA.update(own or {name: value for name, value in kept.items() if value})
        _set_environment(kept)
    if libsumo.__version__.split(".")[:2] != VERSION.split("."):
        raise SetupError(
            f"libsumo {libsumo.__version__} is installed, {VERSION}.x is needed: pip install 'libsumo=={VERSION}.0'"
        )
    return Sumo(libsumo)


_OWN_DATA: dict[str, str] = {}
"""Where libsumo found its data when it was first imported."""


def start(sumo: Sumo, command: list[str]) -> None:
    """Starts a simulation; what SUMO prints meanwhile goes into the error.

    Raises:
        ScenarioError: SUMO refuses the files; the text is SUMO's.
    """
    kept = {name: os.environ.get(name) for name in SUMO_VARIABLES}
    _set_environment({name: _OWN_DATA.get(name) for name in SUMO_VARIABLES})
    printed: list[str] = []
    try:
        with _standard_error(printed):
            sumo.start(command)
    except sumo.refusals as error:
        raise ScenarioError(f"SUMO cannot load the scenario: {_cause(str(error), printed)}") from error
    finally:
        _set_environment(kept)


def _mend(error: ImportError) -> str:
    if isinstance(error, ModuleNotFoundError) and error.name == "libsumo":
        return f"libsumo is not installed: pip install 'libsumo=={VERSION}.0'"
    return f"libsumo cannot be loaded ({error}); on Debian or Ubuntu: apt-get install {DEBIAN_PACKAGES}"


def _set_environment(values: dict[str, str | None]) -> None:
    for name, value in values.items():
        if value is None:
            os.environ.pop(name, None)
        else:
            os.environ[name] = value


@contextmanager
def _standard_error(printed: list[str]) -> Iterator[None]:
    """Collects what the library writes to the standard error, line by line."""
    sys.stderr.flush()
    with tempfile.TemporaryFile() as file:
        kept = os.dup(2)
        os.dup2(file.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(kept, 2)
            os.close(kept)
            file.seek(0)
            printed += file.read().decode("utf-8", "replace").splitlines()


def _cause(text: str, printed: Sequence[str]) -> str:
    """SUMO's own words on one line: those of the exception, or the first error printed if it has none."""
    if text == "Process Error" or text.startswith("Could not parse"):
        errors = [index for index, line in enumerate(printed) if line.startswith("Error:")]
        if errors:
            text = " ".join(printed[errors[0] : errors[0] + 3])
    return re.sub(r"\s+", " ", text).strip().removeprefix("Error: ")


class InProcess:
    """A simulation in this process: nothing to send, but no second one beside it.

    A second ``depart`` loads and warms up again; ``branch`` replays the drive in a process of its own.
    """

    _current: InProcess | None = None

    def __init__(
        self,
        scenario: Scenario,
        seed: int = 0,
        progress: Progress | None = None,
        *,
        allow_unprojected: bool = False,
    ) -> None:
        """Loads the scenario and warms its traffic up.

        Args:
            scenario: what to run.
            seed: of SUMO's random numbers.
            progress: told how far the warm-up is.
            allow_unprojected: take a network without projection, with lon and lat None.

        Raises:
            ScenarioError: the scenario cannot be loaded.
            SetupError: libsumo is missing or unfit.
            TrafficError: this process holds another simulation.
        """
        if InProcess._current is not None:
            raise TrafficError("this process already holds a simulation; close it first, or use fork.Forked")
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
        """Puts the ego on its way; ends the drive before it.

        Raises:
            ScenarioError: its trip has no route, or its edges are not in the network.
            TrafficError: it could not be inserted, or the simulation is closed.
        """
        if self.world is None:
            raise TrafficError("the simulation is closed")
        if not self._fresh:
            self.world.close()
            self.world = self._warm()
        self._fresh = False
        return InProcessTraffic(self, self.world, self.world.depart(plan), plan)

    def close(self) -> None:
        """Ends the simulation; harmless when called again."""
        if self.world is not None:
            self.world.close()
            self.world = None
        if InProcess._current is self:
            InProcess._current = None

    def _warm(self) -> World:
        from automotive_cosim.traffic.world import World

        world = World(self.setup)
        world.warm_up(self._progress)
        return world


class InProcessTraffic:
    """One drive in this process's simulation, until the next one departs."""

    def __init__(self, owner: InProcess, world: World, drive: EgoDrive, plan: EgoPlan) -> None:
        self._owner: InProcess | None = owner
        self._world = world
        self._drive = drive
        self._plan = plan
        self._log: list[Call] = []

    @property
    def network(self) -> RoadNetwork:
        """The roads, as a map draws them."""
        return self._world.network.map

    @property
    def state(self) -> DrivingState:
        """The newest state."""
        return self._drive.state

    def start(self, duration_s: float) -> None:
        """As ``Traffic.start``: nothing to do."""

    def advance(self, duration_s: float, until: Until | None = None) -> Drive:
        """As ``Traffic.advance``."""
        self._check()
        drive = self._drive.advance(duration_s, until)
        self._log.append(len(drive.states))
        return drive

    def bare_step(self) -> None:
        """One step of SUMO that nobody looks at, for benchmarks; a branch or replay does not know of it."""
        self._world.bare_step()

    def request(self, request: RoadRequest) -> Answer:
        """As ``Traffic.request``."""
        self._check()
        self._log.append(request)
        return self._drive.request(request)

    def alternatives(self, age_s: float = 0.0) -> tuple[RouteOption, ...]:
        """As ``Traffic.alternatives``."""
        self._check()
        return self._drive.alternatives(age_s)

    def branch(self) -> Traffic:
        """A copy in a process of its own, which replays the drive so far."""
        from automotive_cosim.traffic.fork import replayed

        return replayed(self._check().setup, self._plan, self._log)

    def close(self) -> None:
        """As ``Traffic.close``."""
        self._owner = None

    def _check(self) -> InProcess:
        if self._owner is None or self._owner.world is not self._world:
            raise TrafficError("this drive is over: it was closed, or another one departed in its process")
        return self._owner
