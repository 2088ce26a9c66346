"""Tools for staging incidents: signs, lanes and vehicles in SUMO."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from copy import copy
from datetime import datetime
from itertools import count

from automotive_cosim.errors import ScenarioError
from automotive_cosim.traffic.closures import Closures
from automotive_cosim.traffic.detours import Detours
from automotive_cosim.traffic.network import Edge, Network
from automotive_cosim.traffic.road_weather import Surface
from automotive_cosim.traffic.script import VehicleScript
from automotive_cosim.traffic.sensing import Sensor
from automotive_cosim.traffic.signs import Signs
from automotive_cosim.traffic.sumo import LibSumo, Manner

TEMPLATE_TYPE = "automotive_cosim.template"
"""SUMO's default passenger car, unaffected by weather."""

CAR_TYPE = "automotive_cosim.car"
"""The same, affected by weather."""


class IncidentTools:
    """What stages incidents on the roads around one equipped car."""

    def __init__(
        self, sumo: LibSumo, network: Network, surface: Surface, ego_id: str, variable: Iterable[str]
    ) -> None:
        self.sumo = sumo
        self.network = network
        """Its edges change: limits by time or an incident, names as the traffic is moved (``World.move``)."""
        self._surface = surface
        self.ego_id = ego_id
        self.sensor: Sensor | None = None
        """The ego's pedals, once it is on the road."""
        self.signs = Signs(sumo, network, variable)
        self.detours = Detours(sumo, network)
        self.closures = Closures(sumo, network, self.detours)
        self.route_changed = False
        """Whether the ego's route has changed since this was last set to False."""
        self.script = VehicleScript(sumo, ego_id)
        self.drivers: dict[str, Manner] = {}
        """How others drove before they made way for the first of those with blue lights on."""
        self._names = count(1)
        sumo.copy_type(TEMPLATE_TYPE, CAR_TYPE)

    def around(self, ego_id: str, sensor: Sensor) -> IncidentTools:
        """The same around another equipped car in the same traffic; signs, detours and closures are the same."""
        other = copy(self)
        other.ego_id, other.sensor = ego_id, sensor
        other.script = VehicleScript(self.sumo, ego_id)
        return other

    @property
    def is_there(self) -> bool:
        """Whether the car is on the road; to read SUMO's list of all vehicles takes much longer."""
        with suppress(*self.sumo.refusals):
            return bool(self.sumo.edge_of(self.ego_id))
        return False

    @property
    def weather(self) -> str:
        """The weather on the road, as signs know it: ``"wet"``, ``"snow"`` or neither."""
        return self._surface.condition.weather

    @property
    def follows_the_clock(self) -> bool:
        """Whether any limit, road or turn depends on the hour."""
        return self.signs.follow_the_clock or self.closures.follow_the_clock

    def follow(self, local_time: datetime) -> None:
        """Applies what the signs say at this time: limits, closed roads and turns."""
        self.signs.follow(local_time, self.weather)
        if self.closures.follow(local_time, self.weather):
            self.route_changed = True

    def edge(self, edge_id: str) -> Edge:
        """An edge of the network. Raises ScenarioError: there is no such edge for cars."""
        if edge_id not in self.network.edges:
            raise ScenarioError(f"[[incidents]]: the network has no edge {edge_id!r} that cars may use")
        return self.network.edges[edge_id]

    def lane(self, edge_id: str, lane: int) -> str:
        """A lane of an edge, counted from the kerb. Raises ScenarioError: the edge has fewer lanes."""
        lanes = self.edge(edge_id).lane_ids
        if not 0 <= lane < len(lanes):
            raise ScenarioError(
                f"[[incidents]]: edge {edge_id!r} has {len(lanes)} lanes for cars, so no lane {lane}"
            )
        return lanes[lane]

    def name(self, what: str) -> str:
        """A new id."""
        return f"automotive_cosim.{what}.{next(self._names)}"

    def car(
        self,
        what: str,
        route: Sequence[str],
        lane: str,
        position_m: float,
        speed: str,
        vehicle_type: str = CAR_TYPE,
    ) -> str:
        """Puts a vehicle on the road as soon as there is room; returns its id."""
        vehicle = self.name(what)
        self._surface.adopt(vehicle_type)
        self.sumo.add_route(vehicle, route)
        self.sumo.add_vehicle(
            vehicle,
            vehicle,
            typeID=vehicle_type,
            departLane=lane.rpartition("_")[2] if lane else "best",
            departPos=f"{position_m:.2f}",
            departSpeed=speed,
        )
        return vehicle

    def kind(self, what: str) -> str:
        """Creates a vehicle type of its own, which nothing else changes."""
        name = self.name(f"type.{what}")
        self.sumo.copy_type(TEMPLATE_TYPE, name)
        return name
