"""``study adoption``: one hour of a town again and again, each time with an assistant in more of its cars.

All shares of a seed are copies of one warm traffic, so they differ by what the assistants do and nothing else. An
equipped car is driven by SUMO, as it would be anyway, until its assistant asks for something.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass, field, replace
from datetime import timedelta
from functools import partial
from pathlib import Path
from statistics import fmean

import numpy as np

from automotive_cosim.agents import Agent, AgentSettings, make_agent, model_of
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import ActionType, Json, Reroute
from automotive_cosim.cosim.simulation import couple
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.episode.fleet import Fleet
from automotive_cosim.episode.session import TakesTime
from automotive_cosim.episode.specification import SCREEN, SessionSetup
from automotive_cosim.errors import ActionError, AgentError, OutOfBudgetError, UserError
from automotive_cosim.run.batch import BatchKind
from automotive_cosim.run.executor import alone
from automotive_cosim.run.row import JobRow, columns
from automotive_cosim.run.stage import doing, warming_up
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

SAME_HAZARD_S = 60.0
"""Warnings of one kind on one road within this time are of the same hazard: our choice."""
BY_NEWS = frozenset((PolicyRule.NEVER, PolicyRule.ALWAYS, PolicyRule.DELAY, PolicyRule.WORTHWHILE))
"""Rules that need nothing but the news."""


@dataclass(frozen=True, slots=True)
class AdoptionPlan(AdoptionSettings):
    """What is run."""

    def check(self) -> None:
        """Checks every name and number before anything runs.

        Raises:
            UserError: one does not exist or is out of range.
        """
        check_values(self)
        profile(self.driver)
        rule = self.policy
        if rule.rule is PolicyRule.AGENT:
            make_agent(*named(rule.agent))
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


@dataclass(frozen=True, slots=True, kw_only=True)
class AdoptionRow(JobRow):
    """All shares of one seed."""

    scenario: str
    seed: int
    shares: tuple[ShareOutcome, ...] = ()


@dataclass(slots=True)
class _Said:
    """What the assistants of a share have done."""

    reroutes: int = 0
    warned: list[tuple[str, str, float]] = field(default_factory=list)
    """Kind of the alert, edge and time."""
    failed: int = 0

    @property
    def hazards(self) -> int:
        last_s: dict[tuple[str, str], float] = {}
        count = 0
        for kind, edge, at_s in sorted(self.warned, key=lambda each: each[2]):
            count += at_s - last_s.get((kind, edge), -SAME_HAZARD_S) >= SAME_HAZARD_S
            last_s[kind, edge] = at_s
        return count


def run_seed(job: AdoptionJob, folder: Path) -> AdoptionRow:
    """Runs all shares of a seed; nothing but its row is kept."""
    plan, scenario = job.plan, job.plan.scene()
    with closing(Forked(scenario, job.seed, warming_up, allow_unprojected=True)) as warm:
        warm.call(town.follow_town)
        shares = dict.fromkeys((0.0, *(percent / 100 for percent in plan.shares)))
        driven = {}
        for number, share in enumerate(shares):
            doing(f"driving with {share:.0%} equipped", share=number / len(shares))
            with closing(warm.road()) as road:
                driven[share] = (_Drive(job, scenario, road).go(share), road.call(town.trips_of))
    before = driven[0.0][1]
    return replace(
        job.planned(),
        shares=tuple(_outcome(job, share, said, trips, before) for share, (said, trips) in driven.items()),
    )


class _Drive:
    """One share: its equipped cars, each with an assistant."""

    def __init__(self, job: AdoptionJob, scenario: Scenario, road: RemoteRoad) -> None:
        self._job, self._plan, self._scenario, self._road = job, job.plan, scenario, road
        self._policy = job.plan.policy
        self._said = _Said()
        self._model = model_of(*named(self._policy.agent))

    def go(self, share: float) -> _Said:
        """Drives for the plan's time; what the assistants did."""
        road, fleet = self._road, Fleet[None](self._road.step_s)
        road.call(town.equip, share, self._job.seed, self._plan.driver)
        end_s = road.time_s + 60 * self._plan.minutes
        while road.time_s < end_s - road.step_s / 2:
            fleet.begin("", self._clock(), lambda: road.time_s)
            for car in road.entered():
                assistant = self._agent(car) if self._policy.rule is PolicyRule.AGENT else self._rule(car)
                fleet.begin(car.car, assistant, partial(_now_s, car))
            while "" in fleet.busy:
                for name in fleet.run():
                    if name and name not in fleet.busy:
                        road.leave(name)
        return self._said

    def _clock(self) -> TakesTime[None]:
        """A second of the road, whoever drives in it."""
        until_s = self._road.time_s + 1.0
        yield 1.0
        self._road.reach(until_s)

    def _rule(self, car: RemoteTraffic) -> TakesTime[None]:
        """Advises by the news, every so often; the driver follows as his profile does."""
        rng = np.random.default_rng((self._job.seed, *car.car.encode()))
        follows = profile(self._plan.driver).compliance
        while car.state.end is None:
            for _ in range(round(self._plan.every_s)):
                yield 1.0
                car.advance(1.0)
            if car.state.end is not None or self._policy.rule is PolicyRule.NEVER:
                continue
            ways = car.alternatives()
            stay, others = ways[:1], ways[1:]
            if not others:
                continue
            quickest = min(others, key=lambda way: way.eta_s)
            if self._policy.leaves(stay[0].eta_s, stay[0].delay_s, quickest.eta_s) and rng.random() < follows:
                self._said.reroutes += car.request(Reroute(edges=quickest.edges)).accepted

    def _agent(self, car: RemoteTraffic) -> TakesTime[None]:
        """Lets an agent act in the cockpit of a car until the drive ends or the agent fails."""
        settings = AgentSettings(seed=self._job.seed)
        agent = make_agent(*named(self._policy.agent), settings, self._model)
        session = self._session(car, agent)
        agent.reset(session.goal)
        before = car.state.ahead.route_edges
        while session.end is None:
            try:
                action = agent.act(session.observation)
            except ActionError as error:
                yield from session.refusing(str(error))
                continue
            except (AgentError, OutOfBudgetError):
                self._said.failed += 1
                return
            if action.action_type is ActionType.SHOW_ALERT:
                self._said.warned.append((str(action.kind), car.state.road.edge_id, car.state.time_s))
            yield from session.stepping(action)
            now = car.state.ahead.route_edges
            self._said.reroutes += bool(now) and now != before[len(before) - len(now) :]
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
            weather=scenario.weather,
            departure=departure,
        )
        setup = SessionSetup(agent.channels, lean=not agent.channels & SCREEN)
        return DriveSession.depart_with(world, setup, judged=False)


def _now_s(car: RemoteTraffic) -> float:
    return car.state.time_s


def _outcome(
    job: AdoptionJob, share: float, said: _Said, trips: Mapping[str, CarTrip], before: Mapping[str, CarTrip]
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
        reroutes=said.reroutes,
        warnings=len(said.warned),
        hazards=said.hazards,
        failed=said.failed,
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
    line_is = "seed, share and group of cars"

    def lines(self) -> Iterator[Json]:
        """Equipped cars, others and all of every share."""
        for row in self.rows:
            for each in row.shares:
                about = {"scenario": row.scenario, "seed": row.seed, "share": each.share}
                for group in ("equipped", "others", "all"):
                    cohort: Cohort | None = getattr(each, group)
                    if cohort is not None:
                        yield about | {"cars_of": group, **columns(cohort)}

    def of(self, share: float) -> Iterator[tuple[int, ShareOutcome]]:
        """The outcomes of a share, with their seeds."""
        for row in self.rows:
            yield from ((row.seed, each) for each in row.shares if each.share == share)

    @property
    def shares(self) -> tuple[float, ...]:
        """The shares that were run."""
        return tuple(sorted({each.share for row in self.rows for each in row.shares}))


ADOPTION: BatchKind[AdoptionPlan, AdoptionJob, AdoptionRow] = BatchKind(AdoptionRow, partial(alone, run_seed))
"""How it is run and stored."""
