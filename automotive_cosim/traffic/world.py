"""A scenario in SUMO: loaded, warmed up, and with the ego in it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from contextlib import chdir, suppress
from dataclasses import dataclass, replace
from difflib import get_close_matches
from itertools import pairwise
from pathlib import Path

from automotive_cosim.contracts import KMH_PER_MPS, EgoEnd, RoadIncident, RoadShapes, RoadSnapshot, RouteOption
from automotive_cosim.errors import NoRoomError, ScenarioError, TrafficError
from automotive_cosim.formats.incidents import Incident
from automotive_cosim.formats.scenario import Scenario, Trip, WeatherAt, weather_since
from automotive_cosim.traffic.additional import placed, read_mapped
from automotive_cosim.traffic.base import EgoPlan, Event, WarmUpProgress
from automotive_cosim.traffic.conflicts import LOOK_S, Conflicts
from automotive_cosim.traffic.congestion import MEMORY_S, SAMPLE_PERIOD_S, WINDOW_S, Congestion, Free
from automotive_cosim.traffic.detours import Detours
from automotive_cosim.traffic.ego import FASTEST_MPS, FOR_GOOD_S, Driver
from automotive_cosim.traffic.ego_loop import EgoLoop
from automotive_cosim.traffic.incident_tools import TEMPLATE_TYPE, IncidentTools
from automotive_cosim.traffic.incidents import Incidents
from automotive_cosim.traffic.instant import Instant, KnownInstant
from automotive_cosim.traffic.lookout import Lookout, read_shapes
from automotive_cosim.traffic.network import KnownNetwork, Network, NetworkReader
from automotive_cosim.traffic.options import (
    Setup,
    command_line,
    copied,
    read_configuration,
    run_options,
    takes_any_route,
)
from automotive_cosim.traffic.profiles import DriverProfile, profile
from automotive_cosim.traffic.road_weather import G_MPS2, Forecast, Surface
from automotive_cosim.traffic.rounds import ONWARD_M, Planner, Round
from automotive_cosim.traffic.router import Router
from automotive_cosim.traffic.sensing import Sensor
from automotive_cosim.traffic.signs import inner_lanes, variable_edges
from automotive_cosim.traffic.steering import PARKING, SumoPedals
from automotive_cosim.traffic.sumo import (
    AVERAGED,
    AWARENESS,
    BLUE_LIGHT,
    EGO,
    EGO_TYPE,
    LIMITS,
    NOW,
    PERCEPTION_ERROR,
    SPEED_GAIN,
    DesiredSpeed,
    LibSumo,
    load_library,
    start,
)
from automotive_cosim.traffic.vocabulary import DEVICES

NOT_LIKE_CARS = frozenset(("bicycle", "scooter", "moped", "wheelchair", "bus", "tram", "rail_urban"))
"""SUMO's classes of vehicles whose speed tells nothing of the cars': slower ones that are passed, and those that go
by a timetable."""

SEARCHING_TYPE = "automotive_cosim.search"
"""A vehicle type that no vehicle has. It neither deviates in speed nor carries a device, so that no search for it
draws a random number."""

FREE_S = 1e9
"""For this time, after all of the router's, times of free roads are written where SUMO has others."""

INSERTION_LIMIT_S = 300.0
"""Limit of the simulated time that the ego waits for a gap to enter the traffic."""

PROGRESS_PERIOD_S = 5.0
"""Simulated time between two reports of the warm-up."""


class World:
    """SUMO with one scenario's traffic. ``depart`` may be called once."""

    def __init__(self, setup: Setup, scratch: Path, known: KnownNetwork | None = None) -> None:
        """Loads the scenario.

        Args:
            scratch: an empty folder, which is not needed afterwards.
            known: its network, if it has been read.

        Raises:
            ScenarioError: SUMO cannot run its files, or the network has no projection.
            SetupError: libsumo is missing or unsuitable.
        """
        scenario = setup.scenario
        configuration = read_configuration(scenario.config)
        reader = NetworkReader(configuration.net, known)
        self._configuration = copied(configuration, scratch, reader)
        self._scenario = scenario
        self.step_s = scenario.sumo.step_length_s
        self.writes = setup.outputs is not None
        """Whether SUMO writes outputs, which are completed on closing."""
        self._sumo = load_library()
        with self._configuration.named_as_given():
            read = reader.network()
            self._roads = read_mapped(self._configuration, read)
            self.network = self._placed(setup)
            self.is_known = reader.known is not None and self.network is read
            """Whether the other process has the same network."""
            self.planner = Planner(self.network.open_at_all_hours())
            """Plans with the ways only that are open at any hour."""
            options = run_options(self._configuration, setup, self.network)
            with chdir(scratch):
                start(self._sumo, command_line(options))
        self._steps = 0
        self.vehicle_count = 0
        """Number of vehicles, kept here because SUMO counts them one by one, which costs more than all the rest."""
        self._emergency: set[str] = set()
        """Vehicles with their blue lights on."""
        self._not_like_cars: set[str] = set()
        self._wants: dict[str, DesiredSpeed] = {}
        self._stopping: dict[str, float] = {}
        self._sumo.copy_type("DEFAULT_VEHTYPE", TEMPLATE_TYPE)
        self._sumo.copy_type(TEMPLATE_TYPE, SEARCHING_TYPE)
        self._sumo.type.setVehicleClass(SEARCHING_TYPE, "passenger")
        self._sumo.type.setSpeedDeviation(SEARCHING_TYPE, 0.0)
        for device in sorted(DEVICES):
            self._sumo.type.setParameter(SEARCHING_TYPE, f"has.{device}.device", "false")
        drawn = self._configuration.distributions
        self._surface = Surface(self._sumo, self.network, (EGO_TYPE, TEMPLATE_TYPE), drawn)
        self._forecast = Forecast(scenario.weather[:1], scenario.sumo.warm_up_s)
        self._weather: tuple[tuple[WeatherAt, ...], float] = (), 0.0
        """The timeline of the first equipped car, and when it departed."""
        variable = variable_edges(self._sumo, self.network)
        self.congestion = Congestion(
            self.network,
            lambda: self._sumo.on_lanes(self._not_like_cars, self._wants, self._stopping),
            self._free(),
        )
        self._router = Router(self._sumo, self.network, self.congestion, SEARCHING_TYPE)
        travel_time = self._sumo.edge.getTraveltime
        self._otherwise = [
            edge_id
            for edge_id, edge in self.network.edges.items()
            if abs(travel_time(edge_id) * edge.speed_mps / edge.length_m - 1) > 0.01
        ]
        """Edges on which SUMO's free flow is none of cars: it is lane 0's, be that for bicycles."""
        self._incidents = Incidents(IncidentTools(self._sumo, self.network, self._surface, EGO, variable), scenario)
        self._has_incidents = self._incidents.are_left
        self._takes_any_route = takes_any_route(self._configuration, self.network)
        self._second_steps = max(1, round(1.0 / self.step_s))
        self.happened: tuple[Event, ...] = ()
        """The incidents of the last step."""
        self.arrived: Sequence[str] = ()
        """Vehicles that left in the last step."""
        self._sample_steps = max(1, round(SAMPLE_PERIOD_S / self.step_s))
        self._looks_around = True
        self.roads: dict[str, EgoRoad] = {}
        """The roads of the equipped cars that have departed, by vehicle."""
        self._coming: dict[str, _Coming] = {}
        """Cars that wait for a gap to enter the traffic."""

    def _placed(self, setup: Setup) -> Network:
        """The network on its side of the road and at the scenario's place."""
        scenario = setup.scenario
        network = placed(self._roads, scenario)
        if network.unplaced and scenario.has_place and not setup.allow_unprojected:
            raise ScenarioError(
                f"{self._configuration.given['net-file'][0].name} {network.unplaced}, so it has no position on "
                "earth; build it with `netconvert --proj.utm`, place it with --origin LON,LAT, or run without GPS "
                "(--no-gps)"
            )
        return network

    def _free(self) -> Free:
        """What a drive is like on these roads without traffic."""
        lanes = [(edge.edge_id, lane) for edge in self.network.edges.values() for lane in edge.lane_ids]
        inner = ((edge_id, each) for edge_id, lane in lanes for each in inner_lanes(self._sumo, lane))
        return Free(FASTEST_MPS, {lane: (edge_id, self._sumo.lane_speed(lane)) for edge_id, lane in inner})

    def warm_up(self, progress: WarmUpProgress | None) -> None:
        """Lets the traffic run before the ego departs.

        Raises:
            ScenarioError: SUMO stops at an error in the scenario's demand.
        """
        total_s = self._scenario.sumo.warm_up_s
        steps, period = round(total_s / self.step_s), max(1, round(PROGRESS_PERIOD_S / self.step_s))
        for step in range(steps):
            if progress is not None and step % period == 0:
                progress(step * self.step_s, total_s)
            try:
                self._sumo.step()
            except self._sumo.refusals as error:
                with self._configuration.named_as_given():
                    raise ScenarioError(f"SUMO stopped at {self._sumo.time():g} s: {error}") from error
            self._notice(sampling=(steps - step) * self.step_s <= max(3 * MEMORY_S, WINDOW_S))
        if progress is not None:
            progress(total_s, total_s)

    def move(self, scenario: Scenario) -> None:
        """Moves the traffic to where another scenario has it, before the ego departs.

        What was made so far goes by edges and metres, which stay, as do the limits in force.

        Args:
            scenario: one with the same warm traffic (``Setup.traffic``).
        """
        self._scenario = scenario
        there, edges = placed(self._roads, scenario), self.network.edges
        for edge_id, edge in edges.items():
            edges[edge_id] = replace(edge, name=there.edges[edge_id].name)
        self.network = replace(there, edges=edges)
        self.planner = Planner(self.network.open_at_all_hours())
        self._incidents.move(scenario.start)

    def prepare_copies(self) -> None:
        """Makes SUMO build its routers' tables of all edges, which copies of this process then share, and begin to
        average the speeds by which its rerouting devices choose, whether or not a vehicle has one."""
        edge = next(iter(self.network.edges))
        for mode in (LIMITS, AVERAGED):
            self._sumo.find_route(edge, edge, SEARCHING_TYPE, NOW, mode)

    def depart(self, plan: EgoPlan, beat: Callable[[], None] | None = None) -> EgoLoop:
        """Inserts the ego and runs until it is on the road; ``beat`` is called after every step.

        Raises:
            ScenarioError: its trip has no route, or its edges are not in the network.
            NoRoomError: no gap opened for it.
            TrafficError: SUMO failed.
        """
        profile(plan.driver)
        plan = replace(plan, weather=plan.weather or self._scenario.weather)
        self._incidents.expect(plan, self._sumo.time())
        for _ in range(round(plan.wait_s / self.step_s)):
            self.step()
            if beat is not None:
                beat()
        self.send(EGO, plan)
        for _ in range(round(INSERTION_LIMIT_S / self.step_s)):
            self.step()
            if beat is not None:
                beat()
            if EGO in self._sumo.departed():
                break
        else:
            raise NoRoomError(
                f"the ego found no gap on {plan.trip.from_edge!r} in {INSERTION_LIMIT_S:.0f} s of simulated time"
            )
        return self._entered(EGO)

    def send(self, car: str, plan: EgoPlan) -> None:
        """Sends an equipped car to the beginning of its trip, where it enters the traffic as soon as there is a
        gap; ``entered`` tells when. The hour and the weather stay those of the first.

        Raises:
            ScenarioError: its trip has no route, its edges are not in the network, or there is such a vehicle.
        """
        sumo = self._sumo
        if car in sumo.vehicle.getLoadedIDList():
            raise ScenarioError(f"the traffic has a vehicle {car!r} already")
        round_ = self.planner.planned(plan.trip, plan.onward, sumo.time()) if plan.onward else None
        edges = round_.first if round_ else self._trip_edges(plan.trip)
        self._add_car(car, edges, profile(plan.driver), plan.trip, parked=plan.parked, attention=plan.attention)
        if plan.emission_class:
            try:
                sumo.vehicle.setEmissionClass(car, plan.emission_class)
            except sumo.refusals as error:
                raise ScenarioError(f"SUMO has no emission class {plan.emission_class!r}: {error}") from error
        self._coming[car] = _Coming(plan, edges, round_)

    @property
    def are_coming(self) -> bool:
        """Whether an equipped car waits for a gap."""
        return bool(self._coming)

    def entered(self) -> dict[str, EgoLoop]:
        """The drives of the cars that have entered the traffic in the last step."""
        now = frozenset(self._sumo.departed()) if self._coming else frozenset()
        return {car: self._entered(car) for car in list(self._coming) if car in now}

    def equip(self, car: str, plan: EgoPlan) -> EgoLoop:
        """Puts a cockpit into a vehicle that drives anyway. SUMO goes on driving it as it does, until something is
        asked for; then its driver reacts as the plan's does, and drives on as this one did.

        Raises:
            ScenarioError: there is no such vehicle on a road for cars.
        """
        sumo, edges = self._sumo, self.network.edges
        if plan.attention:
            raise ScenarioError(
                f"vehicle {car!r} drives already, and SUMO gives a driver's state only to cars that set out; take "
                "--attention off"
            )
        if car in self.roads or car not in sumo.vehicle_ids() or sumo.edge_of(car) not in edges:
            raise ScenarioError(f"vehicle {car!r} is on no road for cars, or has a cockpit already")
        drives, base = sumo.vehicle, profile(plan.driver)
        own = replace(
            base,
            speed_ratio=drives.getSpeedFactor(car),
            over_limit_max_kmh=math.inf,
            top_speed_kmh=drives.getMaxSpeed(car) * KMH_PER_MPS,
            headway_s=drives.getTau(car),
            imperfection=drives.getImperfection(car),
            overtaking=float(drives.getParameter(car, SPEED_GAIN)),
            caution=0.0,  # what the weather makes of it is in it
        )
        sensor = self._sensor(car)
        pedals = SumoPedals(sumo, car, self.network, sensor, self._router, hands_off=True)
        road = self.roads[car] = EgoRoad(self, sumo, car, sensor, pedals)
        return EgoLoop(road, Driver(plan, pedals, self.step_s, own), road.now, take=pedals.take)

    def set_out(self) -> list[str]:
        """The cars without a cockpit that have set out in the last step, on roads that the network has for cars."""
        sumo, edges = self._sumo, self.network.edges
        cars = (each for each in sumo.departed() if sumo.vehicle_class(each) == "passenger")
        return [car for car in cars if car not in self.roads and sumo.edge_of(car) in edges]

    def forget(self, car: str) -> None:
        """The cockpit of a car is no longer used; the car drives on."""
        self.roads.pop(car, None)
        self._coming.pop(car, None)

    def _entered(self, car: str) -> EgoLoop:
        """The drive of a car that has just entered the traffic."""
        coming = self._coming.pop(car)
        plan, edges, sumo = coming.plan, coming.edges, self._sumo
        if plan.attention and not _heeds(sumo, car):
            raise ScenarioError(
                f"the ego of scenario {self._scenario.name!r} has a car-following model that does not heed SUMO's "
                "driver state, so --attention on would change nothing; give its DEFAULT_VEHTYPE the carFollowModel "
                "Krauss or IDM, or take --attention off"
            )
        if sumo.route(car)[-1] != edges[-1]:  # a rerouter stands where it departs
            sumo.set_route(car, edges)
        now_s, is_first = sumo.time(), not self.roads
        if is_first:
            self._weather = plan.weather, now_s
            self._forecast = Forecast(plan.weather, now_s, plan.settles_s)
            self._surface.put(self._forecast.read(now_s))  # its first look is on the road of its weather
        else:
            weather, since_s = self._weather
            plan = replace(plan, weather=weather_since(weather, now_s - since_s))
        sumo.set_parameter(car, SPEED_GAIN, f"{profile(plan.driver).overtaking:g}")
        sensor = self._sensor(car)
        if is_first:
            self._incidents.set_off(plan, sensor, now_s)
        else:
            self._incidents.join(plan, car, sensor, now_s)
        self._has_incidents = self._has_incidents or bool(plan.incidents)
        if self._incidents.take_changes():
            sensor.refresh()
        stops = plan.trip.via if plan.keeps_stops else ()
        if stops:
            sumo.vehicle.setVia(car, stops)
        pedals = SumoPedals(sumo, car, self.network, sensor, self._router, stops)
        road = self.roads[car] = EgoRoad(self, sumo, car, sensor, pedals, coming.round)
        return EgoLoop(road, Driver(plan, pedals, self.step_s), road.now)

    def _sensor(self, car: str) -> Sensor:
        return Sensor(self._sumo, car, self.network, self.congestion, self._reported, self._emergency, self.step_s)

    @property
    def detours(self) -> Detours:
        """The other vehicles' ways round what is closed."""
        return self._incidents.detours

    def step(self) -> bool:
        """One step of the traffic; true if the road ahead of the ego has to be read again.

        Raises:
            TrafficError: SUMO stopped at an error.
            ScenarioError: a vehicle sets out on a route that its class cannot drive.
        """
        try:
            self._sumo.step()
        except self._sumo.refusals as error:
            raise TrafficError(f"SUMO stopped at {self._sumo.time():g} s: {error}") from error
        return self._notice(sampling=True)

    def look_away(self) -> None:
        """From here on nobody asks what is around the ego or how dense the traffic is: only the drive counts."""
        self._looks_around = False
        for road in self.roads.values():
            road.sensor.looks_around = False

    def stage(self, incident: Incident) -> None:
        """Stages one more incident, whose times count like those of the others.

        Raises:
            ScenarioError: it does not fit the network, such as an edge that is not for cars.
        """
        self._incidents.add(incident)
        self._has_incidents = True

    def closed(self) -> tuple[str, ...]:
        return self._incidents.closed

    def slowed(self) -> dict[str, float]:
        """Edges with another limit than the scenario has there now, and that limit as a share of it."""
        return self._incidents.slowed

    def close(self) -> None:
        """Ends the simulation."""
        self._sumo.close()

    def _reported(self) -> tuple[RoadIncident, ...]:
        return self._incidents.reported(dict(self.congestion.slow_edges())) if self._has_incidents else ()

    def _notice(self, *, sampling: bool) -> bool:
        sumo = self._sumo
        departed = sumo.departed() if sumo.departed_count() else ()
        arrived = self.arrived = sumo.arrived() if sumo.arrived_count() else ()
        self.vehicle_count += len(departed) - len(arrived)
        for vehicle in departed:
            if sumo.vehicle_class(vehicle) in NOT_LIKE_CARS:
                self._not_like_cars.add(vehicle)
            elif sumo.has_device(vehicle, BLUE_LIGHT):
                self._emergency.add(vehicle)
            if vehicle not in self._coming:
                self._wants[vehicle] = self._surface.wanted(vehicle)
                if sumo.vehicle.getStops(vehicle, 1):
                    self._stopping[vehicle] = 0.0
                self._surface.departed(vehicle)
                self._check_route(vehicle)
        if self.detours.are_needed:
            self.detours.after_step()
        self._not_like_cars.difference_update(arrived)
        for vehicle in arrived:
            self._surface.arrived(vehicle)
            self._wants.pop(vehicle, None)
            self._stopping.pop(vehicle, None)
        now_s = sumo.time()
        has_changed = now_s >= self._forecast.until_s
        if has_changed:
            self._surface.put(self._forecast.read(now_s))
        if self._emergency:
            self._emergency.difference_update(arrived, sumo.teleporting())
        self._steps += 1
        is_due = sampling and self._steps % self._sample_steps == 0
        if is_due and self._looks_around:
            self.congestion.sample()
        if self._has_incidents and self._steps % self._second_steps == 0:
            self.happened = self._incidents.tick(now_s)
            return self._incidents.take_changes() or is_due or has_changed
        self.happened = ()
        return is_due or has_changed

    def _check_route(self, vehicle: str) -> None:
        """Sends a vehicle round that sets out on a route that is closed. SUMO itself would stop at it, and is told
        not to (``options.run_options``), so a route that is broken anyway is refused here."""
        if self.detours.are_needed:
            self.detours.check(vehicle)
        elif not self._takes_any_route and not self._sumo.vehicle.isRouteValid(vehicle):
            raise ScenarioError(
                f"vehicle {vehicle!r} sets out at {self._sumo.time():g} s, but its class cannot drive its route "
                f"{' '.join(self._sumo.route(vehicle))[:200]!r}; mend the routes, as with duarouter --repair, or "
                "set ignore-route-errors in the .sumocfg"
            )

    def _add_car(
        self, car: str, edges: tuple[str, ...], driver: DriverProfile, trip: Trip, *, parked: bool, attention: bool
    ) -> None:
        sumo = self._sumo
        of_its = EGO_TYPE if car == EGO else f"{EGO_TYPE}.{car}"
        sumo.copy_type(TEMPLATE_TYPE, of_its)
        kind = sumo.type
        kind.setVehicleClass(of_its, "passenger")
        kind.setLength(of_its, 4.5)
        kind.setMinGap(of_its, driver.min_gap_m)
        kind.setAccel(of_its, driver.acceleration_mps2)
        kind.setDecel(of_its, driver.deceleration_mps2)
        kind.setEmergencyDecel(of_its, G_MPS2)
        kind.setImperfection(of_its, driver.imperfection)
        kind.setTau(of_its, max(driver.headway_s, self.step_s))
        kind.setSpeedFactor(of_its, 1.0)
        kind.setSpeedDeviation(of_its, 0.0)
        kind.setActionStepLength(of_its, self.step_s)
        kind.setParameter(of_its, "has.rerouting.device", "false")
        if attention:
            kind.setParameter(of_its, "has.driverstate.device", "true")
        sumo.add_route(of_its, edges)
        if not parked and trip.from_m is not None:
            edge = self.network.edges[edges[0]]
            if trip.from_m > edge.length_m or trip.from_lane >= len(edge.lane_ids):
                raise ScenarioError(
                    f"trip {trip.name!r} of scenario {self._scenario.name!r}: from_m and from_lane are not on edge "
                    f"{edge.edge_id!r}, which has {len(edge.lane_ids)} lanes of {edge.length_m:.0f} m for cars"
                )
            lane = edge.lane_ids[trip.from_lane]
            mps = min(trip.from_kmh / KMH_PER_MPS, sumo.lane_speed(lane))
            number, from_m = lane.rpartition("_")[2], f"{trip.from_m:.2f}"
            sumo.add_vehicle(
                car, of_its, typeID=of_its, departLane=number, departPos=from_m, departSpeed=f"{mps:.2f}"
            )
            return
        if not parked:
            sumo.add_vehicle(car, of_its, typeID=of_its, departLane="best", departSpeed="max")
            return
        edge = self.network.edges[edges[0]]
        lane, at_m = edge.lane_ids[0].rpartition("_")[2], round(edge.length_m / 2, 2)
        sumo.add_vehicle(car, of_its, typeID=of_its, departLane=lane, departPos=f"{at_m:.2f}", departSpeed="0")
        sumo.set_stop(car, edge.edge_id, at_m, int(lane), FOR_GOOD_S, PARKING)

    def _trip_edges(self, trip: Trip) -> tuple[str, ...]:
        """The quickest route at free flow, through the trip's intermediate edges."""
        stops = (trip.from_edge, *trip.via, trip.to_edge)
        for edge_id in stops:
            if edge_id not in self.network.edges:
                raise ScenarioError(
                    f"trip {trip.name!r} of scenario {self._scenario.name!r}: the network has no edge {edge_id!r} "
                    f"that cars may use{_similar(edge_id, self.network.edges)}"
                )
        for edge_id in self._otherwise:
            edge = self.network.edges[edge_id]
            self._sumo.adapt_travel_time(edge_id, edge.length_m / edge.speed_mps, FREE_S, 2 * FREE_S)
        edges: list[str] = [trip.from_edge]
        for origin, goal in pairwise(stops):
            try:
                found, why = self._sumo.find_route(origin, goal, SEARCHING_TYPE, FREE_S).edges, ""
            except self._sumo.refusals as error:  # no car may set out there now
                found, why = (), f" ({error})"
            if not found:
                raise ScenarioError(
                    f"trip {trip.name!r} of scenario {self._scenario.name!r} has no route: "
                    f"no route for a car leads from {origin!r} to {goal!r}{why}"
                )
            edges += found[1:]
        return tuple(edges)


@dataclass(frozen=True, slots=True)
class _Coming:
    """A car that waits for a gap."""

    plan: EgoPlan
    edges: tuple[str, ...]
    round: Round | None


class EgoRoad:
    """The road of an equipped car: steps the world, unless several share the step, and reads the car's state."""

    def __init__(
        self,
        world: World,
        sumo: LibSumo,
        car: str,
        sensor: Sensor,
        pedals: SumoPedals,
        round_: Round | None = None,
    ) -> None:
        """Takes over once the car is on the road; with a round, it drives on at each destination."""
        self._world = world
        self._sumo = sumo
        self._car = car
        self.sensor = sensor
        self._pedals = pedals
        self.step_s = world.step_s
        self._conflicts = Conflicts(sumo, car)
        self._lookout = Lookout(sumo, car)
        self._look_steps = max(1, round(LOOK_S / self.step_s))
        self._steps = 0
        self._round = round_
        self._leg = 0
        """The next leg of the round."""
        self._goal, self._beyond = "", 0
        """The present destination, and how many edges before it there is no way on."""
        self.now: Instant = KnownInstant(sensor.read(hazard_lights=False, vehicle_count=world.vehicle_count).state)
        """The newest instant."""

    def step(self, *, hazard_lights: bool) -> tuple[Instant, tuple[Event, ...]]:
        self.apply()
        return self.read(self._world.step(), hazard_lights=hazard_lights)

    def apply(self) -> None:
        """Sets the pedals for the next step of the world."""
        self._pedals.apply()

    def read(self, sampled: bool, *, hazard_lights: bool) -> tuple[Instant, tuple[Event, ...]]:
        """The instant after a step of the world, and its events.

        Args:
            sampled: whether the road ahead has to be read again.
            hazard_lights: whether the car's are on.
        """
        if self._pedals.are_taken:
            with suppress(*self._sumo.refusals):
                self._keep_goal()
        end, events = self._mishaps()
        events += self._world.happened
        self._steps += 1
        if end is None:
            try:
                if self._round is not None and self._steps % self._look_steps == 0:
                    goes_on = self._go_on(self._round)
                    events += goes_on
                    sampled = bool(goes_on) or sampled
                if sampled:
                    self.sensor.refresh()
                now = self.sensor.read(hazard_lights=hazard_lights, vehicle_count=self._world.vehicle_count)
            except self._sumo.refusals:
                end = EgoEnd.REMOVED
            else:
                self.now = now
                if self.sensor.looks_around and self._steps % self._look_steps == 0:
                    events += self._conflicts.look(now)
                return now, events
        self.now = KnownInstant(replace(self.now.state, time_s=self._sumo.time(), end=end))
        return self.now, events

    def alternatives(self, age_s: float) -> tuple[RouteOption, ...]:
        return self._pedals.alternatives(age_s)

    def look(self) -> RoadSnapshot:
        """See ``Traffic.look``; in each car's own, the car itself is called ``ego``."""
        seen, swapped = self._lookout.look(), {self._car: EGO, EGO: self._car}
        if self._car != EGO:
            named = (
                replace(each, vehicle_id=swapped.get(each.vehicle_id, each.vehicle_id)) for each in seen.vehicles
            )
            seen = replace(seen, vehicles=tuple(named))
        return replace(seen, closed=self._world.closed())

    def shapes(self) -> RoadShapes:
        return replace(read_shapes(self._sumo), ground=self._world.network.map.ground)

    def _keep_goal(self) -> None:
        """Goes on to the destination where a rerouter of the scenario's has given the ego another one."""
        planned, now = self.sensor.route.edge_ids, self._sumo.route(self._car)
        here = now[self._sumo.route_index(self._car)]
        if now[-1] != planned[-1] and here in planned:
            self._sumo.set_route(self._car, planned[planned.index(here) :])

    def _go_on(self, round_: Round) -> tuple[Event, ...]:
        """Sets the next destination near the present one, if there is a way to it, and says so. From a place
        without a way back, to which the driver was guided on request, it is set where one can last turn off."""
        sumo, route = self._sumo, self.sensor.route
        if sumo.edge_of(self._car).startswith(":"):
            return ()
        if route.edge_ids[-1] != self._goal:
            self._goal, self._beyond = route.edge_ids[-1], self._edges_beyond(round_)
        last = len(route.edge_ids) - 1 - self._beyond
        here = sumo.route_index(self._car)
        end_m = route.position_m(last, self._world.network.edges[route.edge_ids[last]].length_m)
        if last < here or end_m - self.sensor.position_m > ONWARD_M:
            return ()
        way = round_.following(self._world.planner.network, route.edge_ids[last], self._leg)
        self._leg += 1
        if not way:
            return ()
        sumo.set_route(self._car, (*route.edge_ids[here:last], *way))
        edges = self._world.network.edges
        goal = edges[way[-1]].name or "the next destination"
        told = f"driver goes on to {goal}"
        if self._beyond:  # asked for by name or edge: a drive's places lie where one can drive on
            told += f", because no way leads on from {edges[self._goal].name or 'the destination'}"
        return (Event(sumo.time(), "driver_goes_on", told),)

    def _edges_beyond(self, round_: Round) -> int:
        """How many edges at the end of the route are beyond the last from which a way leads on."""
        for beyond, edge_id in enumerate(reversed(self.sensor.route.edge_ids)):
            if self._world.planner.leads_on(edge_id, round_):
                return beyond
        return 0

    def _mishaps(self) -> tuple[EgoEnd | None, tuple[Event, ...]]:
        """Why the ego's drive ended in this step, if it did, and events of other vehicles."""
        sumo = self._sumo
        if not (sumo.colliding_count() or sumo.teleporting_count() or self._world.arrived):
            return None, ()
        end: EgoEnd | None = None
        events: list[Event] = []
        new = sumo.colliding() if sumo.colliding_count() else ()
        for collision in sumo.collisions():  # those that go on too, where nobody is taken off the road
            if collision.collider not in new:
                continue
            text = f"{collision.collider} hits {collision.victim}"
            events.append(Event(sumo.time(), "collision", text))
            if self._car in (collision.collider, collision.victim):
                if end is None and self._car not in self._world.arrived and self._pedals.are_taken:
                    sumo.vehicle.remove(self._car)  # where a collision takes nobody off the road for good
                end = EgoEnd.COLLIDED
        for vehicle in sumo.teleporting():
            events.append(Event(sumo.time(), "teleport", f"{vehicle} stood too long and is teleported"))
            if vehicle == self._car and end is None:
                end = EgoEnd.TELEPORTED
        if end is None and self._car in self._world.arrived:
            end = EgoEnd.ARRIVED
        return end, tuple(events)


def _heeds(sumo: LibSumo, car: str) -> bool:
    """Whether a car's model heeds its driver's state, that is follows otherwise with an error of perception."""
    speeds: list[float] = []
    for error in ("1", "0"):
        sumo.set_parameter(car, AWARENESS, "1" if error == "0" else "0.5")
        sumo.set_parameter(car, PERCEPTION_ERROR, error)
        speeds.append(sumo.vehicle.getFollowSpeed(car, 20.0, 30.0, 10.0, 4.5))
    return speeds[0] != speeds[1]


def _similar(edge_id: str, known: Iterable[str]) -> str:
    close = get_close_matches(edge_id, known, n=1)
    return f" (did you mean {close[0]!r}?)" if close else ""
