"""Finds a task's situation: drives until its trigger holds, and hands over."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from itertools import product
from typing import Any

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.language import Language
from automotive_cosim.cockpit.restrictions import Motion, motion
from automotive_cosim.cockpit.signals import DRIVE, HMI, MOTION
from automotive_cosim.cockpit.tree import make_named
from automotive_cosim.contracts import RoadNetwork
from automotive_cosim.contracts.given import CarMake, Hearing
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.cosim.simulation import TICK_S, CoSimulation, couple
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.specification import EpisodeSpec, Seeds
from automotive_cosim.errors import NoRoomError, TriggerNotReachedError, UserError
from automotive_cosim.geo.forecast import drawn_weather
from automotive_cosim.scenarios import Scenario, Trip, WeatherAt, open_scenario
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.tasking.binding import POSTED_LIMIT, UnmetNeedError, bound, needs, never_here
from automotive_cosim.tasking.draws import Draws, Purpose
from automotive_cosim.tasking.instance import Instance, draw, speech
from automotive_cosim.tasking.task import Half, Task
from automotive_cosim.tasking.ways import units_in
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.base import EgoPlan, Simulation, Traffic, WarmSimulations
from automotive_cosim.voice.table import check

WAITS_S = (0.0, 41.0, 113.0, 197.0, 307.0, 431.0)
"""Delays of further departures, tried one by one until the situation arises; out of step with the usual cycles of
traffic lights."""
PARKED: Mapping[str, Any] = {MOTION.GEAR.path: "P", DRIVE.PARKING_BRAKE.path: True}
"""Signals of a car that is parked."""


@dataclass(frozen=True, slots=True)
class HandOver:
    """A situation that has arisen: from here on an agent acts."""

    instance: Instance
    world: CoSimulation
    """The running co-simulation; whoever takes it over must close it."""
    drive: tuple[Moment, ...]
    """Moments from departure to the hand-over, one per simulated second."""
    scenario: Scenario
    traffic_seed: int
    """Seed of the traffic in which the situation has arisen."""


class SituationFinder:
    """Finds one task's situation, repeatedly with different seeds."""

    def __init__(
        self,
        spec: EpisodeSpec,
        simulations: WarmSimulations,
        *,
        task: Task | None = None,
        observer: Observer | None = None,
    ) -> None:
        """Reads the scenario; nothing runs before ``find``.

        Args:
            spec: the situation to find; its ``seed`` and ``conditions`` are ignored.
            simulations: warm traffic, shared with others.
            task: used instead of the catalogue's task of that name.
            observer: notified of progress.

        Raises:
            UnknownNameError: no such task, half or scenario.
            ScenarioError: the scenario cannot be read, or has no such way.
            UserError: a value is out of its range, the driver has no words for the task in that language, or the
                screen is not seen as it needs.
        """
        spec.check()
        self.task = CATALOGUE[spec.task] if task is None else task
        if hidden := spec.conditions.hides(self.task.tags):
            raise UserError(f"{self.task.id} needs {hidden}")
        half = self.task.half(spec.half)
        start = half.start
        if spec.conditions.language is not Language.ENGLISH:
            speech(self.task, spec.conditions.language)
        self.scenario: Scenario = open_scenario(
            spec.scenario or start.scenario,
            origin=start.origin if spec.origin is None and spec.scenario is None else spec.origin,
            gps=spec.gps,
            from_place=spec.from_place,
            to_place=spec.to_place,
        )
        self._spec = spec
        self._is_elsewhere = bool(spec.from_place or spec.to_place) or self.scenario.name != start.scenario
        self._has_own_law = not self._is_elsewhere and spec.origin in (None, start.origin)
        self._missing = ""
        """What the place lacked when the situation last arose."""
        self._has_signs = False
        """Whether a limit was posted anywhere on the way."""
        self._simulations = simulations
        self._observer = observer or Observer()

    def find(self, seeds: Seeds) -> HandOver:
        """Drives until the trigger holds, if necessary with later departures into the same traffic.

        In a scenario that is not the task's own, any of its trips is tried.

        Raises:
            TriggerNotReachedError: the situation did not arise within its time limit.
            InfrastructureError: what is said can neither be looked up nor recognised (``voice.table``).
            TrafficError: the traffic simulation failed.
        """
        draws = Draws(self.task.id, seeds.instance, self._spec.redrawn)
        instance = self._draw(draws)
        half = instance.half
        if self._spec.conditions.hear is Hearing.CABIN:  # what is drawn from the cockpit is known at the hand-over
            check(text for text in instance.spoken if "<" not in text)
        self._observer.loading(self.scenario)
        trips, waits_s = self._trips(half, draws), WAITS_S[:1] if half.start.parked else WAITS_S
        with self._simulations.held(self.scenario, seeds.traffic, self._warming) as simulation:
            full: dict[Trip, NoRoomError] = {}
            for trip, wait_s in product(trips, waits_s):
                if trip in full:
                    continue
                try:
                    plan, traffic = self._depart(simulation, half, trip, draws, wait_s)
                except NoRoomError as error:
                    full[trip] = error
                    continue
                try:
                    self._refuse_impossible(half, traffic.network)
                    drive = self._drive_up(_Drive.begun(self._couple(traffic, half, plan, draws)), half)
                    if drive is not None:
                        return self._handed_over(draws, half, drive, seeds.traffic)
                except BaseException:
                    traffic.close()
                    raise
                traffic.close()
        if len(full) == len(trips):
            raise full[trips[0]]
        trigger = half.trigger
        raise TriggerNotReachedError(
            f"task {self.task.id!r}: {trigger.condition} did not hold for {trigger.for_s:g} s within "
            f"{trigger.within_s:g} s of {len(waits_s)} departures on any of the trips "
            f"{', '.join(trip.name for trip in trips)} of scenario {self.scenario.name!r} (traffic seed "
            f"{seeds.traffic}){self._lacking()}; try another seed, trip or scenario"
        )

    def _refuse_impossible(self, half: Half, network: RoadNetwork) -> None:
        """Refuses another place than the task's own in which no road is as the situation needs it: drives on every
        trip would take a minute to find out."""
        never = never_here(half, network.roads) if self._is_elsewhere and not self.scenario.incidents else ""
        if never and not any(edge.timed_limits for edge in network_of(self.scenario).edges.values()):
            raise TriggerNotReachedError(
                f"task {self.task.id!r}: {never} can nowhere hold in scenario {self.scenario.name!r}: none of its "
                "roads is like that; try another task or scenario"
            )

    def _lacking(self) -> str:
        needed = needs(self.task.half(self._spec.half))
        if POSTED_LIMIT in needed and not self._has_signs:
            return "; no limit is posted anywhere on these trips, and the task needs one"
        if not self._missing:
            return ""
        return f" where it has what the task needs ({', '.join(needed)}): {self._missing}"

    def _draw(self, draws: Draws, content: Mapping[str, tuple[str, ...]] | None = None) -> Instance:
        return draw(
            self.task,
            self._spec.half,
            draws.number,
            content,
            held_out=self._spec.held_out,
            language=self._spec.conditions.language,
            make=self._make(draws),
            redrawn=self._spec.redrawn,
        )

    def _make(self, draws: Draws) -> CarMake:
        return self._spec.conditions.make.at(draws.number)

    def _trips(self, half: Half, draws: Draws) -> tuple[Trip, ...]:
        ego = self.scenario.ego
        trips = ego.trips if self._is_elsewhere else (self.scenario.trip(half.start.trip),)
        if not ego.any_trip:
            return trips
        return tuple(trips[index] for index in draws.rng(Purpose.TRIPS).permutation(len(trips)))

    def _depart(
        self, simulation: Simulation, half: Half, trip: Trip, draws: Draws, wait_s: float
    ) -> tuple[EgoPlan, Traffic]:
        start = half.start
        departure = self.scenario.start
        if start.start is not None:
            departure = datetime.fromisoformat(start.start).replace(tzinfo=departure.tzinfo)
        weather = self.scenario.weather if start.weather is None else (WeatherAt(0.0, start.weather),)
        driver = start.driver or self.scenario.ego.driver
        reactions = draws.seed(Purpose.DRIVER)
        is_limited = self._spec.conditions.attention.is_limited
        plan = EgoPlan(
            trip, driver, reactions, weather, departure, parked=start.parked, wait_s=wait_s, attention=is_limited
        )
        traffic = simulation.depart(plan)
        if plan.weather:
            return plan, traffic
        # The climate of the place where it departs.
        plan = replace(plan, weather=drawn_weather(traffic.state, departure, draws.seed(Purpose.SKY)))
        traffic.close()
        return plan, simulation.depart(plan)

    def _couple(self, traffic: Traffic, half: Half, plan: EgoPlan, draws: Draws) -> CoSimulation:
        start = half.start
        signals = start.signals
        if self._spec.conditions.language is not Language.ENGLISH:
            signals = {HMI.LANGUAGE.path: str(self._spec.conditions.language), **signals}
        make = make_named(self._make(draws))
        signals = {**units_in(make, self.task), **signals}
        cockpit = Cockpit(
            traffic.network,
            rng=draws.rng(Purpose.CONTENT),
            aboard=start.aboard,
            cabin=start.cabin,
            signals={**PARKED, **signals} if start.parked else signals,
            arrivals=start.arrivals,
            belongings=start.belongings,
            sign_camera=start.sign_camera,
            lacks=start.lacks,
            sensors=start.sensors,
            size=self._spec.conditions.screen,
            make=make,
        )
        world = couple(
            traffic,
            cockpit,
            self.scenario,
            gps_rng=draws.rng(Purpose.RECEIVER),
            weather=plan.weather,
            departure=plan.start or self.scenario.start,
            links=self.scenario.connectivity,
            trailer=start.trailer,
            attention=plan.attention,
        )
        if self._observer.looks:
            world.on_look = self._observer.looked
        return world

    def _drive_up(self, begun: _Drive, half: Half) -> _Drive | None:
        """The drive up to the trigger; None if that does not hold within its time limit."""
        trigger, world = half.trigger, begun.world
        moments = [world.moment]
        departed_s, since_s = world.moment.time_s, None
        while (now := world.moment).time_s - departed_s < trigger.within_s and now.driving.end is None:
            self._has_signs = self._has_signs or now.driving.road.limit.is_posted
            holds = now.time_s - departed_s >= trigger.after_s and self._holds(half, now)
            since_s = (now.time_s if since_s is None else since_s) if holds else None
            if since_s is not None and now.time_s - since_s >= trigger.for_s:
                return replace(begun, moments=tuple(moments))
            moments += self._advanced(world)
        return None

    def _holds(self, half: Half, moment: Moment) -> bool:
        is_so = _motion(moment) in half.start.motions and half.trigger.condition(moment)
        return is_so and self._rests(half, moment)

    def _freshness(self, half: Half, drive: _Drive) -> bool | None:
        """Whether the situation still holds in the car as it departed: with its air (true), or without, if that is
        what the trigger waits for (false); None if it waits for battery or clock."""
        for with_air in (True, False):
            if self._holds(half, drive.world.freshened(drive.departed, with_air=with_air).moment):
                return with_air
        return None

    def _rests(self, half: Half, moment: Moment) -> bool:
        """Whether a sign or law is in force here on which the half can rest."""
        if self._has_own_law:
            return True
        try:
            bound(half, moment.context)
        except UnmetNeedError as missing:
            self._missing = str(missing)
            return False
        return True

    def _handed_over(self, draws: Draws, half: Half, drive: _Drive, traffic_seed: int) -> HandOver:
        freshness = self._freshness(half, drive)
        rule = "" if self._has_own_law else bound(half, drive.moments[-1].context)
        if freshness is not None:
            drive = drive.freshened(freshness)
        drive.world.cockpit.expect(half.start.interruptions)
        instance = replace(self._draw(draws, drive.world.cockpit.content), rule=rule)
        if self._spec.conditions.hear is Hearing.CABIN:
            check(instance.spoken)
        return HandOver(instance, drive.world, drive.moments, self.scenario, traffic_seed)

    def _advanced(self, world: CoSimulation) -> tuple[Moment, ...]:
        moments = world.advance(TICK_S)
        for moment in moments:
            self._observer.moved(moment, world.cockpit)
        return moments

    def _warming(self, done_s: float, total_s: float) -> None:
        self._observer.warming(self.scenario.title, done_s, total_s)


@dataclass(frozen=True, slots=True)
class _Drive:
    """A running drive, and its moments from departure to now."""

    world: CoSimulation
    departed: Cockpit
    """The cockpit at departure."""
    moments: tuple[Moment, ...]

    @classmethod
    def begun(cls, world: CoSimulation) -> _Drive:
        return cls(world, world.cockpit.copy(), (world.moment,))

    def freshened(self, with_air: bool) -> _Drive:
        """The same with the car as if it had just departed where it is now; the way there has the earlier clock."""
        way = timedelta(seconds=self.moments[-1].time_s - self.moments[0].time_s)
        world = self.world.freshened(self.departed, with_air=with_air)
        before = (moment.earlier(way) for moment in self.moments[:-1])
        return replace(self, world=world, moments=(*before, world.moment))


def _motion(moment: Moment) -> Motion:
    return motion(moment.signals[MOTION.GEAR.path], moment.signals[MOTION.SPEED.path])
