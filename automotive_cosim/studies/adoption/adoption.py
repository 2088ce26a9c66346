"""``study adoption``: one hour of a town again and again, each time with an assistant in more of its cars.

All shares of a seed are copies of one warm traffic, so they differ by what the assistants do and nothing else. An
equipped car is driven by SUMO, as it would be anyway, until its assistant asks for something.
"""

from __future__ import annotations

import math
import threading
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from datetime import timedelta
from functools import partial
from pathlib import Path
from statistics import fmean
from typing import Protocol, TypeVar

import numpy as np

from automotive_cosim.agents import Agent, AgentSettings, is_remote, make_agent, model_of
from automotive_cosim.agents.guest import FAULTS, aside, own_class, told
from automotive_cosim.cockpit.actions import action_in_words
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import ActionType, DrivingState, FeedbackCode, Json, Reroute, RouteOption, SlowDown
from automotive_cosim.cosim.simulation import couple
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.episode.fleet import Fleet
from automotive_cosim.episode.session import TakesTime
from automotive_cosim.episode.specification import SCREEN, SessionSetup
from automotive_cosim.errors import ActionError, AgentError, CosimError, OutOfBudgetError, UserError
from automotive_cosim.formats.layout import LIVE
from automotive_cosim.geo.forecast import drawn_weather
from automotive_cosim.models import ChatModel
from automotive_cosim.run.batch import BatchKind
from automotive_cosim.run.executor import alone, doing, warming_up
from automotive_cosim.run.fleet_record import FAILS, FleetRecord
from automotive_cosim.run.job_row import JobRow, columns
from automotive_cosim.run.script import read_script
from automotive_cosim.scenarios import Scenario
from automotive_cosim.scenarios.wording import KINDS, read_line
from automotive_cosim.studies.calls import town
from automotive_cosim.studies.calls.town import CarTrip
from automotive_cosim.studies.content import StudyContent
from automotive_cosim.studies.plan import SeedJob, check_edges, check_values, driven_at, opened
from automotive_cosim.studies.reroute.plan import named
from automotive_cosim.studies.reroute.policies import AGENT, Policy, PolicyRule, parse_policy
from automotive_cosim.studies.settings import AdoptionSettings
from automotive_cosim.traffic.fork import Forked, RemoteRoad, RemoteTraffic
from automotive_cosim.traffic.profiles import profile
from automotive_cosim.traffic.wire import pack_state

SCRIPT = ".jsonl"
"""How the name of a file of actions ends, one a line (``run.script``)."""
SAME_HAZARD_S = 60.0
"""Warnings of one kind on one road within this time are of the same hazard: our choice."""
T = TypeVar("T")
HANGS_S = 120.0
"""Wall time after which a class of the user's is taken to hang, and its car drives on without it."""
BY_NEWS = frozenset((PolicyRule.NEVER, PolicyRule.ALWAYS, PolicyRule.DELAY, PolicyRule.WORTHWHILE, PolicyRule.SUMO))
"""Rules that need nothing but what a car can know."""


class Assistant(Protocol):
    """Advises all equipped cars; one is made for every share and seed, with the seed as its only argument."""

    def advise(
        self, car: str, state: DrivingState, ways: Callable[[], Sequence[RouteOption]]
    ) -> Reroute | SlowDown | None:
        """What to ask the driver of a car for, as it sets out and then every so often; None for nothing.

        Args:
            car: SUMO's id of it.
            state: what it knows of itself and the road.
            ways: gives its route, then others by the news, the quickest first."""
        ...


@dataclass(frozen=True, slots=True)
class AdoptionPlan(AdoptionSettings):
    """What is run."""

    def check(self) -> None:
        """Checks every name and number before anything runs.

        Raises UserError: one does not exist or is out of range."""
        check_values(self)
        profile(self.driver)
        rule = self.policy
        if rule.rule is PolicyRule.AGENT:
            _ = own_assistant(rule.agent, self.seeds[0]) or agent_of(rule.agent)
        elif rule.rule not in BY_NEWS:
            raise UserError(f"--agent {self.agent} is no assistant: it knows what no car does; name another")
        for incident in self.scene().incidents[len(self.opened.incidents) :]:
            check_edges(incident, "--incident", self.opened)

    @property
    def policy(self) -> Policy:
        """The rule or the agent."""
        is_rule = self.agent.partition(":")[0] in set(PolicyRule)
        return parse_policy(self.agent if is_rule else AGENT + self.agent)

    @property
    def opened(self) -> Scenario:
        """The scenario as it is."""
        return opened(self.scenario)

    def scene(self) -> Scenario:
        """The scenario as it is driven."""
        return driven_at(
            self.opened,
            step_s=self.driven_step_s(self.opened),
            share=None,
            scale=self.scale,
            warm_up_s=self.warm_up_s,
            redraw=self.redraw,
            incidents=[read_line(each, KINDS, "--incident") for each in self.incidents],
        )

    def jobs(self) -> tuple[AdoptionJob, ...]:
        """One for every seed, with all shares."""
        limit_s = 3_600.0 + 240 * self.minutes * len(self.shares)
        return tuple(SeedJob(self, seed, AdoptionRow, limit_s) for seed in self.seeds)


AdoptionJob = SeedJob[AdoptionPlan, "AdoptionRow"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Cohort:
    """Cars of one share that set out both in it and at share 0; means per car unless stated."""

    cars: int
    arrived: int
    time_s: float
    """From when each wanted to set out to its arrival, or to the end."""
    before_s: float
    """The same of the same cars at share 0."""
    lost_s: float
    """SUMO's ``timeLoss``."""
    side: float
    """Share of the way in side streets."""
    near_s_h: float
    """Seconds an hour with a low time to collision to the car ahead (``CarTrip.near_s``)."""
    energy_wh_km: float


@dataclass(frozen=True, slots=True, kw_only=True)
class EquippedCar:
    """One equipped car of a share."""

    car: str
    """SUMO's id."""
    departs_s: float
    """When it wants to set out, in seconds after the warm-up."""
    time_s: float
    """From then to its arrival, or to the end."""
    arrived: bool
    before_s: float | None
    """The same time at share 0; None if it does not set out there."""
    lost_s: float
    """SUMO's ``timeLoss``."""
    driven_m: float
    reroutes: int
    warnings: int
    refused: int = 0
    """Answers of its agent that were no action; each cost a step."""
    error: str = ""
    """Why it lost its assistant; empty if it did not."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ShareOutcome:
    """What a share comes to."""

    share: float
    equipped: Cohort | None
    """None if there are none."""
    others: Cohort | None
    all: Cohort
    reroutes: int
    """Routes that were changed on an assistant's advice."""
    warnings: int
    hazards: int
    """How many different ones the warnings are of (``SAME_HAZARD_S``)."""
    failed: int
    """Cars whose agent failed; they drove on without it."""
    cars: tuple[EquippedCar, ...] = ()
    """Each that was equipped, as it set out."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AdoptionRow(JobRow):
    """All shares of one seed."""

    scenario: str
    seed: int
    shares: tuple[ShareOutcome, ...] = ()


@dataclass(slots=True)
class ShareLog:
    """What the assistants of a share have done."""

    rerouted: Counter[str] = field(default_factory=Counter)
    """How many routes of each car were changed on an assistant's advice."""
    warned: list[tuple[str, str, float, str]] = field(default_factory=list)
    """Kind of the alert, edge, time and car."""
    refused: Counter[str] = field(default_factory=Counter)
    """How many answers of each car's agent were no action."""
    errors: dict[str, str] = field(default_factory=dict)
    """By car, why it lost its assistant."""

    @property
    def hazards(self) -> int:
        last_s: dict[tuple[str, str], float] = {}
        count = 0
        for kind, edge, at_s, _ in sorted(self.warned, key=lambda each: each[2]):
            count += at_s - last_s.get((kind, edge), -SAME_HAZARD_S) >= SAME_HAZARD_S
            last_s[kind, edge] = at_s
        return count


def percent(share: float) -> str:
    """A share as it was asked for: ``2.5%``."""
    return f"{100 * share:.6g}%"


def fleet_id(seed: int, share: float) -> str:
    """The name of a share's folder below ``live``."""
    return f"seed{seed}-{100 * share:g}"


def run_seed(job: AdoptionJob, folder: Path) -> AdoptionRow:
    """Runs all shares of a seed; its row is kept, and where the equipped cars of each share drove."""
    shares = dict.fromkeys((0.0, *(percent / 100 for percent in job.plan.shares)))
    driven = {}
    with closing(warmed_up(job)) as warm:
        for number, share in enumerate(shares):
            doing(f"driving with {percent(share)} equipped", share=number / len(shares))
            driven[share] = drive(job, warm, share, keeps=folder)
    before = driven[0.0][1]
    return replace(
        job.planned(),
        shares=tuple(_outcome(job, share, said, trips, before) for share, (said, trips) in driven.items()),
    )


def warmed_up(job: AdoptionJob) -> Forked:
    """The traffic of a seed at the end of its warm-up, to drive shares of; it has to be closed."""
    warm = Forked(job.plan.scene(), job.seed, warming_up, allow_unprojected=True)
    warm.call(town.follow_town)
    return warm


def drive(
    job: AdoptionJob, warm: Forked, share: float, assistant: Assistant | None = None, *, keeps: Path | None = None
) -> tuple[ShareLog, Mapping[str, CarTrip]]:
    """Drives a share: what its assistants did, and every car's trip by its id.

    Args:
        share: 0 to 1.
        assistant: that of the plan if left out.
        keeps: the study's folder, to which the drives of equipped cars are written while they last."""
    with closing(warm.road()) as road:
        if not (keeps and share):
            return _Drive(job, road, assistant).go(share), road.call(town.trips_of)
        about = {"scenario": job.plan.scenario, "agent": job.plan.agent, "seed": job.seed, "share": share}
        shapes, look = road.call(town.network_of), partial(road.call, town.seen)
        with closing(FleetRecord(keeps, fleet_id(job.seed, share), road, shapes, look, about)) as record:
            return _Drive(job, road, assistant, record).go(share), road.call(town.trips_of)


def own_assistant(agent: str, seed: int) -> Assistant | None:
    """An assistant of a class of the user's, ``package.module:Class``; None if it is an agent of drives.

    Raises UserError: there is no such class, or it raised."""
    if ":" not in agent or is_remote(agent):
        return None
    made = own_class(agent, "agent")
    if hasattr(made, "act") or not callable(getattr(made, "advise", None)):
        return None
    try:
        with aside():
            assistant: Assistant = made(seed)
    except FAULTS as error:
        raise UserError(f"agent {agent!r}: {made.__name__}(seed) raised {told(error)}") from error
    return assistant


def agent_of(name: str, settings: AgentSettings = AgentSettings(), model: ChatModel | None = None) -> Agent:  # noqa: B008, frozen
    """An agent of drives by name, or one that plays the actions of a file.

    Raises UserError: there is no such agent, or the file cannot be read."""
    return read_script(Path(name)) if name.endswith(SCRIPT) else make_agent(*named(name), settings, model)


def within(seconds: float, call: Callable[[], T]) -> T:
    """The answer of an agent, which may be a class of the user's.

    Raises:
        UserError: it raised, or has not answered within this wall time; then it is left to itself.
        CosimError: it raised that."""
    answers: list[T] = []
    errors: list[BaseException] = []

    def answer() -> None:
        try:
            answers.append(call())
        except FAULTS as error:
            errors.append(error)

    thread = threading.Thread(target=answer, daemon=True)
    thread.start()
    thread.join(seconds)
    if errors:
        raise errors[0] if isinstance(errors[0], CosimError) else UserError(told(errors[0]))
    if not answers:
        raise UserError(f"it has not answered within {seconds:g} s")
    return answers[0]


class _Drive:
    """One share: its equipped cars, each with an assistant."""

    def __init__(
        self, job: AdoptionJob, road: RemoteRoad, assistant: Assistant | None, record: FleetRecord | None = None
    ) -> None:
        self._record = record
        self._job, self._plan, self._scenario, self._road = job, job.plan, job.plan.scene(), road
        self._policy = job.plan.policy
        self._said = ShareLog()
        self._end_s = 0.0
        self._own = assistant or own_assistant(self._policy.agent, job.seed)
        is_read = self._own is not None or self._policy.agent.endswith(SCRIPT)
        self._model = None if is_read else model_of(*named(self._policy.agent))

    def go(self, share: float) -> ShareLog:
        """Drives for the plan's time; what the assistants did."""
        road, fleet = self._road, Fleet[None](self._road.step_s)
        road.call(town.equip, share, self._job.seed, self._plan.driver)
        self._end_s = road.time_s + 60 * self._plan.minutes
        while road.time_s < self._end_s - road.step_s / 2:
            for car in road.entered():
                if self._policy.rule is PolicyRule.AGENT and self._own is None:
                    fleet.begin(car.car, self._agent(car), partial(_now_s, car))
                else:
                    fleet.begin(car.car, self._advised(car), lambda: road.time_s)
            left_s = self._end_s - road.time_s
            for_s = min(1.0, left_s) if fleet.busy or self._record else left_s
            fleet.begin("", self._clock(for_s), lambda: road.time_s)
            while "" in fleet.busy:
                for name in fleet.run():
                    if name and name not in fleet.busy:
                        road.leave(name)
            if self._record:
                self._record.look()
        return self._said

    def _note(self, car: str, words: str) -> None:
        if self._record:
            self._record.note(f"{car}: {words}")

    def _fails(self, car: str, error: CosimError) -> None:
        """A car loses its assistant."""
        self._said.errors[car] = str(error)
        self._note(car, f"{FAILS} {error}")

    def _clock(self, for_s: float) -> TakesTime[None]:
        """So long of the road, whoever drives in it; until a car gets a cockpit if no other has one."""
        until_s = self._road.time_s + for_s
        yield for_s
        if (left_s := until_s - self._road.time_s) > self._road.step_s / 2:
            self._road.run(left_s)

    def _advised(self, car: RemoteTraffic) -> TakesTime[None]:
        """Advises every so often; the driver follows as his profile does.

        Between two looks a car has no cockpit, as reading it at every step costs more than all the rest; once its
        driver was asked to slow down, it keeps it."""
        name, road, every_s = car.car, self._road, self._plan.every_s
        rng = np.random.default_rng((self._job.seed, *name.encode()))
        follows = profile(self._plan.driver).compliance
        is_due, is_steered = self._own is not None, False
        while (self._own or self._policy.rule is not PolicyRule.NEVER) and car.state.end is None:
            if not is_due and is_steered:
                for _ in range(round(every_s)):
                    yield 1.0
                    car.advance(1.0)
            elif not is_due:
                road.leave(name)
                if road.time_s + every_s >= self._end_s:
                    return
                is_there, state, wait_s = True, None, every_s
                while is_there and state is None:
                    until_s = road.time_s + wait_s
                    yield wait_s
                    while road.time_s < until_s - road.step_s / 2:  # it stops where another car sets out
                        road.reach(until_s)
                    is_there, state = road.call(town.woken, name, self._job.seed, self._plan.driver)
                    wait_s = 1.0  # out of the junction
                if state is None:
                    return
                car = road.take(name, pack_state(state))
            is_due = False
            if car.state.end is not None:
                return
            try:
                request = self._advice(car)
            except UserError as error:
                self._fails(name, error)
                return
            if request is not None:
                is_done = rng.random() < follows and car.request(request).accepted
                self._said.rerouted[name] += is_done and isinstance(request, Reroute)
                asked = "another way" if isinstance(request, Reroute) else f"{request.speed_kmh:g} km/h at most"
                self._note(name, f"{asked}, which the driver {'takes' if is_done else 'does not take'}")
                is_steered = is_steered or isinstance(request, SlowDown)

    def _advice(self, car: RemoteTraffic) -> Reroute | SlowDown | None:
        """What a rule or the user's assistant asks for."""
        if self._own is None and self._policy.rule is PolicyRule.SUMO:
            edges = self._road.call(town.way_of_device, car.car)
            return Reroute(edges=edges) if edges else None
        if (own := self._own) is not None:
            late = threading.Event()

            def ways() -> Sequence[RouteOption]:
                if late.is_set():
                    raise UserError("its car has gone on without it")
                return car.alternatives()

            try:
                with aside():
                    request = within(HANGS_S, lambda: own.advise(car.car, car.state, ways))
            finally:
                late.set()
            if request is None or isinstance(request, Reroute):
                return request
            if isinstance(request, SlowDown) and isinstance(request.speed_kmh, int | float):
                if 0 <= request.speed_kmh < math.inf:
                    return request
                raise UserError(f"advise returned a SlowDown to {request.speed_kmh} km/h; it has to be 0 or more")
            raise UserError(f"advise returned {request!r}; it has to return a Reroute, a SlowDown or None")
        known = car.alternatives()
        if len(known) < 2:
            return None
        stay, quickest = known[0], min(known[1:], key=lambda way: way.eta_s)
        leaves = self._policy.leaves(stay.eta_s, stay.delay_s, quickest.eta_s)
        return Reroute(edges=quickest.edges) if leaves else None

    def _agent(self, car: RemoteTraffic) -> TakesTime[None]:
        """Lets an agent act in the cockpit of a car until the drive ends or the agent fails."""
        settings = AgentSettings(seed=self._job.seed)
        try:
            agent = within(HANGS_S, lambda: agent_of(self._policy.agent, settings, self._model))
            session = self._session(car, agent)
            within(HANGS_S, lambda: agent.reset(session.goal))
        except UserError as error:
            self._fails(car.car, error)
            return
        before = car.state.ahead.route_edges
        while session.end is None:
            try:
                action = within(HANGS_S, lambda: agent.act(session.observation))
            except ActionError as error:
                self._said.refused[car.car] += 1
                self._note(car.car, f"an answer that is no action: {error}")
                yield from session.refusing(str(error))
                continue
            except (AgentError, OutOfBudgetError, UserError) as error:
                self._fails(car.car, error)
                return
            at = car.state.road.edge_id, car.state.time_s, car.car
            if action.action_type is not ActionType.WAIT:
                self._note(car.car, action_in_words(action, session.observation.elements or ()))
            yield from session.stepping(action)
            is_done = session.steps[-1].feedback.code is FeedbackCode.OK
            if action.action_type is ActionType.SHOW_ALERT and is_done:
                self._said.warned.append((str(action.kind), *at))
            now = car.state.ahead.route_edges
            self._said.rerouted[car.car] += bool(now) and now != before[len(before) - len(now) :]
            before = now or before

    def _session(self, car: RemoteTraffic, agent: Agent) -> DriveSession:
        scenario, state = self._scenario, car.state
        departure = scenario.start + timedelta(seconds=state.time_s - scenario.sumo.warm_up_s)
        contents, receiver = (np.random.default_rng((self._job.seed, n, *car.car.encode())) for n in (2, 3))
        world = couple(
            car,
            Cockpit(car.network, rng=contents, lookout=True),
            scenario,
            gps_rng=receiver,
            weather=scenario.weather or drawn_weather(state, scenario.start, self._job.seed),
            departure=departure,
        )
        setup = SessionSetup(agent.channels, lean=not agent.channels & SCREEN)
        return DriveSession.depart_with(world, setup, judged=False)


def _now_s(car: RemoteTraffic) -> float:
    return car.state.time_s


def _outcome(
    job: AdoptionJob, share: float, said: ShareLog, trips: Mapping[str, CarTrip], before: Mapping[str, CarTrip]
) -> ShareOutcome:
    both = sorted(trips.keys() & before.keys())
    equipped = [car for car in both if town.drawn(job.seed, car) < share]
    others = [car for car in both if town.drawn(job.seed, car) >= share]
    if not both:
        raise UserError("no car sets out in this time; give more --minutes or another --scenario")
    return ShareOutcome(
        share=share,
        equipped=_cohort(equipped, trips, before),
        others=_cohort(others, trips, before),
        all=_mean(both, trips, before),
        reroutes=said.rerouted.total(),
        warnings=len(said.warned),
        hazards=said.hazards,
        failed=len(said.errors),
        cars=tuple(_cars(job, share, said, trips, before)),
    )


def _cars(
    job: AdoptionJob, share: float, said: ShareLog, trips: Mapping[str, CarTrip], before: Mapping[str, CarTrip]
) -> Iterator[EquippedCar]:
    begun_s, warned = job.plan.scene().sumo.warm_up_s, Counter(car for *_, car in said.warned)
    for car, trip in sorted(trips.items(), key=lambda each: (each[1].planned_s, each[0])):
        if town.drawn(job.seed, car) < share:
            yield _car(car, trip, begun_s, before.get(car), said, warned[car])


def _car(
    car: str, trip: CarTrip, begun_s: float, before: CarTrip | None, said: ShareLog, warnings: int
) -> EquippedCar:
    return EquippedCar(
        car=car,
        departs_s=round(trip.planned_s - begun_s, 1),
        time_s=round(trip.until_s - trip.planned_s, 1),
        arrived=trip.has_left,
        before_s=None if before is None else round(before.until_s - before.planned_s, 1),
        lost_s=round(trip.lost_s, 1),
        driven_m=round(trip.driven_m),
        reroutes=said.rerouted[car],
        warnings=warnings,
        refused=said.refused[car],
        error=said.errors.get(car, ""),
    )


def _cohort(cars: list[str], trips: Mapping[str, CarTrip], before: Mapping[str, CarTrip]) -> Cohort | None:
    return _mean(cars, trips, before) if cars else None


def _mean(cars: list[str], trips: Mapping[str, CarTrip], before: Mapping[str, CarTrip]) -> Cohort:
    mine = [trips[car] for car in cars]
    driven_m, driving_s = sum(trip.driven_m for trip in mine), sum(trip.until_s - trip.planned_s for trip in mine)
    return Cohort(
        cars=len(cars),
        arrived=sum(trip.has_left for trip in mine),
        time_s=driving_s / len(mine),
        before_s=fmean(before[car].until_s - before[car].planned_s for car in cars),
        lost_s=fmean(trip.lost_s for trip in mine),
        side=sum(trip.side_m for trip in mine) / max(driven_m, 1.0),
        near_s_h=3_600 * sum(trip.near_s for trip in mine) / max(driving_s, 1.0),
        energy_wh_km=1_000 * sum(trip.energy_wh for trip in mine) / max(driven_m, 1.0),
    )


@dataclass(frozen=True)
class AdoptionStudy(StudyContent[AdoptionPlan, AdoptionRow]):
    """The content of a folder."""

    plan_type = AdoptionPlan
    row_type = AdoptionRow
    line_is = "seed, share and group of cars, and per equipped car"

    def lines(self) -> Iterator[Json]:
        """Equipped cars, others and all of every share, and each equipped car."""
        for row in self.rows:
            for each in row.shares:
                about = {"scenario": row.scenario, "seed": row.seed, "share": each.share}
                for group in ("equipped", "others", "all"):
                    cohort: Cohort | None = getattr(each, group)
                    if cohort is not None:
                        yield about | {"cars_of": group, **columns(cohort)}
                for car in each.cars:
                    yield about | {"cars_of": "one", **columns(car)}

    def of(self, share: float) -> Iterator[tuple[int, ShareOutcome]]:
        """The outcomes of a share, with their seeds."""
        for row in self.rows:
            yield from ((row.seed, each) for each in row.shares if each.share == share)

    @property
    def shares(self) -> tuple[float, ...]:
        """The shares that were run."""
        return tuple(sorted({each.share for row in self.rows for each in row.shares}))


ADOPTION: BatchKind[AdoptionPlan, AdoptionJob, AdoptionRow] = BatchKind(
    AdoptionRow, partial(alone, run_seed), (LIVE,)
)
"""How it is run and stored."""
