"""Departs on a drive: a script becomes a running co-simulation."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from datetime import datetime, timedelta

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cosim.simulation import CoSimulation, couple
from automotive_cosim.drives.script import DriveScript
from automotive_cosim.episode.observer import Observer
from automotive_cosim.errors import NoRoomError, UserError
from automotive_cosim.formats.scenario import weather_since
from automotive_cosim.scenarios import Scenario, open_scenario
from automotive_cosim.tasking.draws import SEED_LIMIT, Draws, Purpose
from automotive_cosim.traffic.base import EgoPlan, Simulation, Traffic
from automotive_cosim.traffic.fork import RemoteTraffic, Simulations
from automotive_cosim.traffic.rounds import loop_with
from automotive_cosim.traffic.sumo import EGO

ADVICE_S = 120.0
"""How long a driver keeps to advice, and stops when asked to: our choice; a reason that lasts is told again."""

SETTLES_S = 60.0
"""Over how long the road takes on the grip of other weather: our choice; snow and rain need minutes to cover it."""


def depart(
    script: DriveScript,
    simulations: Simulations,
    observer: Observer | None = None,
    traffic: Traffic | None = None,
) -> CoSimulation:
    """The drive at its first instant; whoever takes it over must close it. If the first trip's road is so full that
    the car finds no gap, the drive begins with the next of its trips.

    Args:
        simulations: warm traffic, shared with others.
        observer: notified of progress.
        traffic: a drive by the script that has departed; None lets one depart.

    Raises:
        UnknownNameError: no such scenario, trip or driver.
        ScenarioError: the scenario cannot be read, its trips cannot be driven in turn, or an incident does not fit.
        SignalError: a signal's value is illegal.
        NoRoomError: no gap opened for the car on any of its trips.
        TrafficError: the traffic simulation failed.
    """
    observer = observer or Observer()
    scenario = scenario_of(script)
    draws = Draws(script.family, script.seed)
    ego = ego_plan(script, scenario)
    observer.loading(scenario)

    def warming(done_s: float, total_s: float) -> None:
        observer.warming(scenario.title, done_s, total_s)

    if traffic is None:
        with simulations.held(scenario, script.seed % SEED_LIMIT, warming) as simulation:
            ego, traffic = departed_on_a_free_road(simulation, ego)
    try:
        cockpit = Cockpit(
            traffic.network,
            rng=draws.rng(Purpose.CONTENT),
            aboard=script.aboard,
            signals=script.signals,
            arrivals=script.arrivals,
            changes=script.changes,
            lookout=True,
            driven_s=script.driven_s,
            places_on=loop_with(traffic.network.junctions_m, traffic.state.ahead.route_edges[-1]),
        )
        world = couple(
            traffic,
            cockpit,
            scenario,
            gps_rng=draws.rng(Purpose.RECEIVER),
            gps_is_steady=True,
            weather=script.weather,
            departure=ego.start or scenario.start,
            links=scenario.connectivity,
            errands=script.errands,
            trailer=script.trailer,
            attention=script.attention,
        )
    except BaseException:
        traffic.close()
        raise
    if observer.looks:
        world.on_look = observer.looked
    return world


def departed_on_a_free_road(simulation: Simulation, ego: EgoPlan) -> tuple[EgoPlan, Traffic]:
    """The plan that begins with the first of its trips, in their order, on whose road is a gap; and its drive.

    Raises:
        NoRoomError: there is none on any; the error is that of the first.
    """
    full: NoRoomError | None = None
    for _ in ego.onward:
        try:
            return ego, simulation.depart(ego)
        except NoRoomError as error:
            full = full or error
            ego = replace(ego, trip=ego.onward[0], onward=(*ego.onward[1:], ego.onward[0]))
    assert full is not None
    raise full


def scenario_of(script: DriveScript) -> Scenario:
    """The scenario of a script, with the traffic and the steps that the script asks for.

    Raises:
        UnknownNameError: there is no such scenario.
        ScenarioError: it cannot be read.
    """
    scenario = open_scenario(script.scenario, origin=script.origin)
    sumo = scenario.sumo
    if script.density != 1.0:
        sumo = replace(sumo, scale=sumo.scale * script.density)
    if script.coarse:
        sumo = sumo.stepping(1.0)
    return replace(scenario, sumo=sumo)


def beside(script: DriveScript, first: DriveScript, later_s: float) -> DriveScript:
    """The script of a car that departs so many seconds after another in the same traffic: roads, hour and weather
    are the other's.

    Raises:
        UserError: it is a drive on other roads.
    """
    if script.scenario != first.scenario:
        raise UserError(
            f"the cars of a fleet share a road, but drive {script.seed} of {script.family} is on "
            f"{script.scenario!r} and not on {first.scenario!r}; choose one place with scenario="
        )
    start = datetime.fromisoformat(first.start) + timedelta(seconds=later_s)
    return replace(
        script,
        start=start.isoformat(),
        weather=weather_since(first.weather, later_s),
        origin=first.origin,
        density=first.density,
        coarse=first.coarse,
    )


def car_named(number: int) -> str:
    """SUMO's id of a car of a fleet."""
    return f"{EGO}.{number}" if number else EGO


class Departures:
    """The cars of a fleet, as each enters the traffic."""

    def __init__(self, scripts: Sequence[DriveScript], first: CoSimulation) -> None:
        """Sends all but the first to where their trips begin.

        Args:
            scripts: the drives of all cars by their numbers.
            first: that of the first, which has departed; its roads, hour and weather are the others', too.

        Raises:
            UserError: they are on different roads.
            TrafficError: the traffic simulation failed.
        """
        self._scripts, self._begun_s = scripts, first.moment.time_s
        self.road = drive_of(first).road
        """The traffic of all."""
        self.coming = {car_named(number): number for number in range(1, len(scripts))}
        """Those that have not entered, by SUMO's id."""
        for car, number in self.coming.items():
            own = beside(scripts[number], scripts[0], 0.0)
            self.road.send(car, ego_plan(own, scenario_of(own)))

    def entered(self) -> Iterator[tuple[int, DriveScript, RemoteTraffic]]:
        """The numbers of those that have entered since this was last called, what each drives, and its traffic."""
        for traffic in self.road.entered():
            number, later_s = self.coming.pop(traffic.car), traffic.state.time_s - self._begun_s
            yield number, beside(self._scripts[number], self._scripts[0], later_s), traffic


def drive_of(world: CoSimulation) -> RemoteTraffic:
    """The drive of a car in a process that it may share."""
    traffic = world.traffic.wrapped
    assert isinstance(traffic, RemoteTraffic)
    return traffic


def ego_plan(script: DriveScript, scenario: Scenario) -> EgoPlan:
    """How the car of a script drives."""
    draws = Draws(script.family, script.seed)
    first, *others = (scenario.trip(name) for name in script.trips)
    return EgoPlan(
        first,
        script.driver,
        draws.seed(Purpose.DRIVER),
        script.weather,
        datetime.fromisoformat(script.start).replace(tzinfo=scenario.start.tzinfo),
        onward=(*others, first),
        moods=script.moods,
        at_schools=script.at_schools,
        halts=script.halts,
        incidents=script.incidents,
        advice_s=ADVICE_S,
        attention=script.attention,
        settles_s=SETTLES_S,
        brakes_early=True,
    )
