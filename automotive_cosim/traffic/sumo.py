"""The boundary to SUMO: the only module that imports libsumo.

``LibSumo`` is libsumo with types: each attribute is the library's own function, so a call costs nothing extra.
libsumo holds one simulation per process.
"""

from __future__ import annotations

import io
import math
import os
import re
import sys
import tempfile
from collections.abc import Callable, Collection, Iterator, Mapping, MutableMapping, Sequence
from contextlib import contextmanager, redirect_stdout
from typing import Any, TypeAlias

from automotive_cosim.errors import ScenarioError, SetupError

VERSION = "1.28"
"""SUMO's version for networks, scenarios and results."""

DEBIAN_PACKAGES = "libgl1 libx11-6 libxext6 libxrender1 libatomic1 libexpat1"
"""System libraries that libsumo requires and slim images lack."""

SUMO_VARIABLES = ("SUMO_HOME", "PROJ_DATA", "PROJ_LIB")
"""Variables that would point libsumo to another installation's data; importing it sets the first two itself."""

EGO = "ego"
EGO_TYPE = "automotive_cosim.ego"

BLUE_LIGHT, REROUTING = "bluelight", "rerouting"
"""SUMO's devices of vehicles with their blue lights on, and of those that choose their way again and again."""

ANY_LANE_CHANGE, WAYMAKING = 1621, 1605
"""SUMO's lane change modes: its default, and what the blue-light device sets."""

STRATEGIC = "laneChangeModel.lcStrategic"
"""How readily a driver takes the lane of the next turn; the device makes who reacts take none."""

SPEED_GAIN = "laneChangeModel.lcSpeedGain"
"""How readily a driver changes lanes to go faster."""

AWARENESS, PERCEPTION_ERROR = "device.driverstate.awareness", "device.driverstate.errorState"
"""Of a driver whose type has the device ``driverstate``, which no running vehicle can be given."""

Manner: TypeAlias = tuple[float, str, str]
"""A driver's speed factor, place in the lane, and ``STRATEGIC``."""

HAZARD_SIGNAL = 4
"""SUMO's bit for the hazard lights (VEH_SIGNAL_BLINKER_EMERGENCY)."""


DesiredSpeed: TypeAlias = tuple[float, float]
"""How fast a driver wants to drive: a factor on the limit, and a top speed in m/s."""

THE_LIMIT: DesiredSpeed = (1.0, math.inf)

UNHINDERED_S = 1.0
"""Who loses less between two looks at the traffic goes as he likes."""

NOW = -1.0
"""SUMO's departure time of a route that is looked for at once."""

LIMITS, AVERAGED = 0, 1
"""SUMO's routing modes: times at the limits unless weights are given, and times averaged over the adaptation of its
rerouting devices, which begins with the speeds of the moment if no vehicle has one."""


class LibSumo:
    """libsumo's functions that are used here, typed. Lengths in m, speeds in m/s, times in s."""

    def __init__(self, library: Any) -> None:
        vehicle, lane, edge, simulation = library.vehicle, library.lane, library.edge, library.simulation
        compiled = _compiled(library)
        self.refusals: tuple[type[Exception], ...] = (library.TraCIException, library.FatalTraCIError)
        self.library_file: str = _compiled_file(library)
        self.option: Callable[[str], str] = simulation.getOption
        self.start: Callable[[list[str]], tuple[int, str]] = library.start
        self.close: Callable[[], None] = library.close
        # without the library's list of observers, which is unused here
        self.step: Callable[[], object] = compiled("simulation_step")
        self.time: Callable[[], float] = compiled("simulation_getTime")
        self.arrived: Callable[[], Sequence[str]] = compiled("simulation_getArrivedIDList")
        self.arrived_count: Callable[[], int] = compiled("simulation_getArrivedNumber")
        self.departed: Callable[[], Sequence[str]] = compiled("simulation_getDepartedIDList")
        self.departed_count: Callable[[], int] = compiled("simulation_getDepartedNumber")
        self.teleporting: Callable[[], Sequence[str]] = compiled("simulation_getStartingTeleportIDList")
        self.teleporting_count: Callable[[], int] = compiled("simulation_getStartingTeleportNumber")
        self.colliding_count: Callable[[], int] = compiled("simulation_getCollidingVehiclesNumber")
        self.colliding: Callable[[], Sequence[str]] = compiled("simulation_getCollidingVehiclesIDList")
        self.collisions: Callable[[], Sequence[Any]] = compiled("simulation_getCollisions")
        self.to_lon_lat: Callable[[float, float], tuple[float, float]] = compiled("simulation_convertGeo")
        self.find_road: Callable[[float, float, bool, str], tuple[str, float, int]] = simulation.convertRoad
        self.find_route: Callable[..., Any] = simulation.findRoute
        self.position: Callable[[str], tuple[float, float]] = compiled("vehicle_getPosition")
        self.angle: Callable[[str], float] = compiled("vehicle_getAngle")
        self.speed: Callable[[str], float] = compiled("vehicle_getSpeed")
        self.acceleration: Callable[[str], float] = compiled("vehicle_getAcceleration")
        self.edge_of: Callable[[str], str] = compiled("vehicle_getRoadID")
        self.lane_of: Callable[[str], str] = compiled("vehicle_getLaneID")
        self.lane_index: Callable[[str], int] = compiled("vehicle_getLaneIndex")
        self.lane_position: Callable[[str], float] = compiled("vehicle_getLanePosition")
        self.time_loss: Callable[[str], float] = compiled("vehicle_getTimeLoss")
        self.driven: Callable[[str], float] = compiled("vehicle_getDistance")
        self.route: Callable[[str], Sequence[str]] = vehicle.getRoute
        self.route_index: Callable[[str], int] = compiled("vehicle_getRouteIndex")
        self.next_lights: Callable[[str], Sequence[tuple[str, int, float, str]]] = vehicle.getNextTLS
        self.leader: Callable[[str, float], tuple[str, float] | None] = vehicle.getLeader
        self.follower: Callable[[str, float], tuple[str, float]] = compiled("vehicle_getFollower")
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
        self.edge: Any = edge
        self.junction: Any = library.junction
        self.person: Any = library.person
        self.simulation: Any = simulation
        self.lights: Any = library.trafficlight
        self.variable_signs: Any = library.variablespeedsign
        self.calibrators: Any = library.calibrator
        self.light_ids: Callable[[], Sequence[str]] = library.trafficlight.getIDList
        self.controlled_links: Callable[[str], Sequence[Sequence[tuple[str, str, str]]]] = (
            library.trafficlight.getControlledLinks
        )
        self._around = library.CMD_GET_VEHICLE_VARIABLE
        self._looks = (
            library.VAR_TYPE,
            library.VAR_POSITION,
            library.VAR_ANGLE,
            library.VAR_SPEED,
            library.VAR_SIGNALS,
        )
        self.light_state: Callable[[str], str] = compiled("trafficlight_getRedYellowGreenState")
        self.friction: Callable[[str], float] = lane.getFriction
        self.lane_speed: Callable[[str], float] = lane.getMaxSpeed
        self.adapt_travel_time: Callable[[str, float, float, float], None] = edge.adaptTraveltime
        self.edge_ids: Callable[[], Sequence[str]] = edge.getIDList
        self.edge_vehicles: Callable[[str], Sequence[str]] = edge.getLastStepVehicleIDs
        self.vehicle_ids: Callable[[], Sequence[str]] = vehicle.getIDList

    def on_lanes(
        self, without: Collection[str], wants: Mapping[str, DesiredSpeed], stopping: MutableMapping[str, float]
    ) -> Iterator[tuple[str, float, DesiredSpeed]]:
        """The lane, speed and wanted speed of every other vehicle in one; who has parked or is off the road is not.

        Args:
            without: vehicles to leave out, as is who stands at a stop.
            wants: how fast those want to drive of whom it is known.
            stopping: those with planned stops, and the time that each had lost when last seen, by SUMO, for which
                braking for a stop and setting off again are none; who loses none has no speed below the wanted one.
        """
        lane_of, speed, time_loss, stops = (
            self.lane_of,
            self.speed,
            self.vehicle.getTimeLoss,
            self.vehicle.isStopped,
        )
        for vehicle in self.vehicle_ids():
            if vehicle in without or not (lane := lane_of(vehicle)):
                continue
            speed_mps = speed(vehicle)
            if not speed_mps and stops(vehicle):
                stopping[vehicle] = time_loss(vehicle)
                continue
            if vehicle in stopping:
                before_s, stopping[vehicle] = stopping[vehicle], time_loss(vehicle)
                if stopping[vehicle] - before_s < UNHINDERED_S:
                    speed_mps = math.inf
            yield lane, speed_mps, wants.get(vehicle, THE_LIMIT)

    def has_device(self, vehicle: str, device: str) -> bool:
        return bool(self.vehicle.getParameter(vehicle, f"has.{device}.device") == "true")

    def reroute(self, vehicle: str) -> None:
        """Gives a vehicle the quickest way by averaged times. ``rerouteTraveltime`` alone goes by the limits.

        Raises:
            one of ``refusals``: there is no way."""
        self.vehicle.setRoutingMode(vehicle, AVERAGED)
        try:
            self.vehicle.rerouteTraveltime(vehicle, False)
        finally:
            self.vehicle.setRoutingMode(vehicle, LIMITS)

    def keep_to(self, vehicle: str, route: Sequence[str]) -> None:
        """Gives a vehicle a route that its own rerouting device, if it has one, does not change again.

        Raises:
            one of ``refusals``: it cannot drive it."""
        self.set_route(vehicle, route)
        if self.has_device(vehicle, REROUTING):
            self.set_parameter(vehicle, "device.rerouting.period", "0")

    def manner(self, vehicle: str) -> Manner:
        """How a driver drives, as far as the blue-light device changes it."""
        of = self.vehicle
        return of.getSpeedFactor(vehicle), of.getLateralAlignment(vehicle), of.getParameter(vehicle, STRATEGIC)

    def give_back(self, vehicle: str, manner: Manner) -> None:
        """Gives a driver back what the blue-light device of a vehicle that has passed leaves changed for good, or
        for as long as that is ahead on the same road: the readiness to overtake, the manner of driving."""
        each, (speed_factor, alignment, strategic) = self.vehicle, manner
        if each.getLaneChangeMode(vehicle) == WAYMAKING:
            each.setLaneChangeMode(vehicle, ANY_LANE_CHANGE)
        if each.getParameter(vehicle, STRATEGIC) != strategic:
            self.set_parameter(vehicle, STRATEGIC, strategic)
        if each.getLateralAlignment(vehicle) != alignment:
            each.setLateralAlignment(vehicle, alignment)
        if each.getSpeedFactor(vehicle) != speed_factor:  # last: other changes may draw it anew
            self.set_speed_factor(vehicle, speed_factor)

    def vehicles_around(
        self, vehicle: str, radius_m: float
    ) -> Sequence[tuple[str, str, tuple[float, float], float, float, int]]:
        """The vehicles in and beside lanes within a radius of one, which is among them, sorted by id: id, type,
        position, angle, speed, signals.

        Raises:
            one of ``refusals``: it is not on the road."""
        self.vehicle.subscribeContext(vehicle, self._around, radius_m, self._looks)
        found = self.vehicle.getContextSubscriptionResults(vehicle)
        self.vehicle.unsubscribeContext(vehicle, self._around, radius_m)
        return [(each, *(values[look] for look in self._looks)) for each, values in sorted(found.items())]


def _compiled(library: Any) -> Callable[[str], Any]:
    """Finds the library's C functions by name. Its Python functions only pass their arguments on, at the cost of a
    second call."""
    functions = getattr(library, "_libsumo", None)

    def find(name: str) -> Any:
        function = getattr(functions, name, None)
        if function is None:
            raise SetupError(
                f"libsumo {library.__version__} has no function _libsumo.{name}; reinstall it: "
                f"pip install --force-reinstall 'libsumo=={VERSION}.0'"
            )
        return function

    return find


def _compiled_file(library: Any) -> str:
    """The shared library that contains SUMO; empty if it cannot be told."""
    functions = getattr(library, "_libsumo", None)
    return str(
        getattr(functions, "__file__", None) or getattr(getattr(functions, "_libsumo", None), "__file__", "")
    )


def load_library() -> LibSumo:
    """Imports libsumo with its own data, whatever the environment says, and leaves the environment as it was.

    Raises SetupError: it is not installed, lacks a system library or a function, or has another version."""
    kept = {name: os.environ.pop(name, None) for name in SUMO_VARIABLES}
    try:
        # It prints a warning if pyarrow is not of the version that its own Parquet output was built with, which
        # nothing here asks for. The variable that silences it would make traci another module in this process.
        with redirect_stdout(io.StringIO()):
            import libsumo
    except ImportError as error:
        raise SetupError(_mend(error)) from error
    finally:
        own = {name: os.environ[name] for name in SUMO_VARIABLES if name in os.environ}
        if own or not _OWN_DATA:  # if it was imported before, the environment is already its own
            _OWN_DATA.update(own or {name: value for name, value in kept.items() if value})
        _set_environment(kept)
    if libsumo.__version__.split(".")[:2] != VERSION.split("."):
        raise SetupError(
            f"libsumo {libsumo.__version__} is installed, {VERSION}.x is needed: pip install 'libsumo=={VERSION}.0'"
        )
    return LibSumo(libsumo)


_OWN_DATA: dict[str, str] = {}
"""Where libsumo found its data when it was first imported."""


def start(sumo: LibSumo, command: list[str]) -> None:
    """Starts a simulation in the current folder; SUMO's output goes into the error.

    Raises ScenarioError: SUMO refuses the files; the message is SUMO's."""
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
    with tempfile.TemporaryFile(dir=os.curdir) as file:
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
    """SUMO's own message on one line: the first printed error, which tells more than the exception."""
    errors = [index for index, line in enumerate(printed) if line.startswith("Error:")]
    if errors:
        text = " ".join(printed[errors[0] : errors[0] + 3])
    return re.sub(r"\s+", " ", text).strip().removeprefix("Error: ")
