"""From day to day: a share of the drivers is advised by what was learned on earlier days, until traffic settles.

Every day drives all trips in SUMO. Overnight, the times of the roads go into a memory (exponential smoothing, as in
J. L. Horowitz, The Stability of Stochastic Equilibrium in a Two-Link Transportation Network, Transportation
Research B 18, 1984), and every advised driver for whom another route would have been quicker by that memory takes
it the next day, if the driver follows the advice. All others keep their routes. Beside it runs the user equilibrium
of the same trips (``equilibrium.equilibrium``): everybody looks for the quickest route of the day before, fewer and
fewer each day.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from statistics import fmean
from typing import Protocol
from zlib import crc32

import numpy as np

from automotive_cosim.agents.guest import FAULTS, aside, own_class, told
from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats.writing import make_folder
from automotive_cosim.run.batch import BatchKind
from automotive_cosim.run.executor import Job, alone, doing
from automotive_cosim.run.job_row import JobRow, columns
from automotive_cosim.scenarios import Scenario, variant
from automotive_cosim.studies.content import StudyContent
from automotive_cosim.studies.equilibrium.equilibrium import ROUTES, Assigned, rerouted
from automotive_cosim.studies.equilibrium.gap import (
    NOTICED_S,
    TAIL_S,
    DrivenTrip,
    EdgeTimes,
    against_best,
    quickest,
    run,
    vehicle_types,
)
from automotive_cosim.studies.equilibrium.optimum import POWER
from automotive_cosim.studies.plan import check_values, driven_at, opened
from automotive_cosim.studies.settings import DaysSettings
from automotive_cosim.traffic.network import Network, read_network
from automotive_cosim.traffic.options import Configuration, copied, read_configuration

Routes = Mapping[str, Sequence[str]]
"""Trip -> edges from its first to its last."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AdvisedDay:
    """What an adviser knows when a day is over."""

    number: int
    """0 for the day on which everybody drives as on an empty road."""
    trips: tuple[DrivenTrip, ...]
    """The trips of advised drivers that arrived: their edges, and when they left each."""
    memory: EdgeTimes
    """Times of edges as they are remembered, by the study's ``memory`` and ``lag``."""
    quickest: Mapping[str, tuple[str, ...]]
    """The route of each trip that is quickest by the memory; without those that have no other route."""


class _Adviser(Protocol):
    """Chooses routes; one is made for every share and seed, with the seed as its only argument."""

    def advise(self, day: AdvisedDay) -> Routes:
        """Routes for the next day; a trip without one keeps its own. Not every driver follows (``compliance``)."""
        ...


class _Quickest:
    """Advises the route that is quickest by the memory, if that is noticed."""

    def advise(self, day: AdvisedDay) -> Routes:
        known = day.memory
        return {
            trip.id: way
            for trip in day.trips
            if (way := day.quickest.get(trip.id))
            and known.of(trip.edges, trip.exits_s[0]) - known.of(way, trip.exits_s[0]) >= NOTICED_S
        }


class _OwnAdviser:
    """A class of the user's behind this protocol; its faults are reported in a line."""

    def __init__(self, spec: str, seed: int, network: Network) -> None:
        """Makes it.

        Args:
            spec: ``package.module:Class``.
            network: on which its routes have to lead from edge to edge.

        Raises UserError: there is no such class, it lacks ``advise(day)``, or it raised."""
        self._spec, self._network = spec, network
        made = own_class(spec, "adviser")
        if not callable(getattr(made, "advise", None)):
            raise UserError(f"adviser {spec!r} lacks advise(day); an adviser is a class with it")
        try:
            with aside():
                self._adviser: _Adviser = made(seed)
        except FAULTS as error:
            raise UserError(f"adviser {spec!r}: {made.__name__}(seed) raised {told(error)}") from error

    def advise(self, day: AdvisedDay) -> dict[str, tuple[str, ...]]:
        """The routes that it chose, without those that the trips have already.

        Raises UserError: it raised, or a route is not one."""
        try:
            with aside():
                advised = self._adviser.advise(day)
            chosen = {str(name): tuple(map(str, way)) for name, way in advised.items()}
        except FAULTS as error:
            raise UserError(f"adviser {self._spec!r} raised {told(error)} in advise") from error
        trips = {trip.id: trip.edges for trip in day.trips}
        for name, way in chosen.items():
            if name not in trips:
                raise UserError(f"adviser {self._spec!r} gave a route to {name!r}, which is no trip of day.trips")
            self._check(name, trips[name], way)
        return {name: way for name, way in chosen.items() if way != trips[name]}

    def _check(self, name: str, own: Sequence[str], way: Sequence[str]) -> None:
        wrong = ""
        if not way or (way[0], way[-1]) != (own[0], own[-1]):
            wrong = f"does not lead from {own[0]!r} to {own[-1]!r}"
        for here, there in pairwise(way):
            if there not in self._network.crossings.get(here, {}):
                wrong = f"has no way from {here!r} to {there!r}"
        if wrong:
            raise UserError(f"adviser {self._spec!r}: the route of trip {name!r} {wrong}")


EQUILIBRIUM, OPTIMUM = "user equilibrium", "system optimum"
"""States of the same trips that are searched for beside the shares."""

Drivers = float | str
"""The share of the drivers who are advised, or one of these states."""

WEEK = 5
"""Days whose mean is compared with that of as many days before."""
NEAR = 0.02
"""Relative gap up to which the routes count as near a user equilibrium, as in ``EquilibriumSettings``."""
SETTLED = 0.01
"""Traffic has settled when the two differ by less than this share."""


@dataclass(frozen=True, slots=True)
class DaysPlan(DaysSettings):
    """What is run."""

    def check(self) -> None:
        """Checks every name and number before anything runs.

        Raises UserError: one does not exist or is out of range, or the demand has stops or persons."""
        check_values(self)
        configuration = read_configuration(self.scene().config)
        variant.check_demand(configuration)
        if self.adviser:
            _OwnAdviser(self.adviser, self.seeds[0], read_network(configuration.net))

    def scene(self) -> Scenario:
        """The scenario as it is driven on the first day: everybody keeps the route that they set out on."""
        return driven_at(
            opened(self.scenario),
            step_s=1.0,
            share=0.0,
            scale=self.scale,
            warm_up_s=self.warm_up_s,
            redraw=False,
            incidents=(),
        )

    def jobs(self) -> tuple[DaysJob, ...]:
        """For every seed, all shares, the user equilibrium and the system optimum."""
        return tuple(
            job
            for seed in self.seeds
            for job in (
                *(DaysJob(self, share, seed) for share in self.shares),
                DaysJob(self, None, seed),
                DaysJob(self, None, seed, optimum=True),
            )
        )


@dataclass(frozen=True, slots=True)
class DaysJob(Job):
    """All days of one share and seed."""

    plan: DaysPlan
    share: float | None
    """None for the user equilibrium and the system optimum."""
    seed: int
    optimum: bool = False

    @property
    def id(self) -> str:
        """Its id, which can be a file name."""
        state = "optimum" if self.optimum else "equilibrium"
        return f"{state if self.share is None else f'share{self.share:g}'}-seed{self.seed}"

    @property
    def simulation(self) -> tuple[str, int]:
        """Every day warms up anew."""
        return self.id, self.seed

    @property
    def wall_s(self) -> float:
        """Limit of its wall time."""
        return 3_600.0 + self.plan.days * 30 * self.plan.minutes

    def planned(self) -> DaysRow:
        """Its row before it runs."""
        return DaysRow(
            id=self.id, scenario=self.plan.scenario, share=self.share, seed=self.seed, optimum=self.optimum
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyDay:
    """One day; times are from the planned departure to the arrival, or to the end of the day."""

    mean_s: float
    """Of all trips that count."""
    advised_s: float | None
    """Of those of advised drivers; None if there are none."""
    others_s: float | None
    relative_gap: float
    """What all lost against the quickest routes of the day, as a share of these (``equilibrium.gap``)."""
    changed: int
    """Drivers who take another route the next day."""
    unfinished: int
    teleports: int


@dataclass(frozen=True, slots=True, kw_only=True)
class DaysRow(JobRow):
    """All days of one share and seed."""

    scenario: str
    share: float | None
    seed: int
    days: tuple[StudyDay, ...] = ()
    optimum: bool = False

    @property
    def drivers(self) -> Drivers:
        if self.share is not None:
            return self.share
        return OPTIMUM if self.optimum else EQUILIBRIUM

    @property
    def settled(self) -> int | None:
        """The day on which the traffic had settled; None if it had not."""
        means_s = [day.mean_s for day in self.days]
        is_over = (has_settled(means_s[: day + 1]) or not self.days[day].changed for day in range(len(means_s)))
        return next((day for day, found in enumerate(is_over) if found), None)

    def last(self, of: Callable[[StudyDay], float | None]) -> float | None:
        """The mean of a figure over the last ``WEEK`` days; None if it is not known.

        Of the user equilibrium, that of the day with the smallest gap, and of the system optimum, that of the day
        with the least mean time, as the searches do not approach them evenly."""
        days = self.days[-WEEK:]
        if self.share is None and self.days:
            days = (min(self.days, key=lambda day: day.mean_s if self.optimum else day.relative_gap),)
        values = [of(day) for day in days]
        known = [value for value in values if value is not None]
        return fmean(known) if known else None


def has_settled(means_s: Sequence[float]) -> bool:
    """Whether the last ``WEEK`` days took as long as those before; without changes, they do anyway."""
    if len(means_s) < 2 * WEEK:
        return False
    before_s, now_s = fmean(means_s[-2 * WEEK : -WEEK]), fmean(means_s[-WEEK:])
    return abs(now_s - before_s) < SETTLED * before_s


def run_chain(job: DaysJob, folder: Path) -> DaysRow:
    """Runs all days of a job; nothing but its row is kept."""
    return replace(job.planned(), days=tuple(_days(job)))


def _days(job: DaysJob) -> Iterator[StudyDay]:
    """Day by day, until the traffic has settled or the days are over."""
    plan, scenario = job.plan, job.plan.scene()
    configuration = read_configuration(scenario.config)
    network = read_network(configuration.net)
    free_s = network.free_s
    observe_s = plan.minutes * 60
    first_s = configuration.begin_s + scenario.sumo.warm_up_s
    rng = np.random.default_rng((job.seed, 7))
    with tempfile.TemporaryDirectory(prefix="automotive-cosim-days-") as folder:
        scratch = Path(folder)
        types = vehicle_types(copied(configuration, make_folder(scratch / "types")), ["route-files"])
        now = _first(configuration, scenario, types, observe_s, job.seed, scratch)
        advised = {trip.id for trip in now.trips if job.share is None or _draw(job.seed, trip.id) < job.share}
        is_own = bool(plan.adviser) and job.share is not None
        adviser: _Adviser = _OwnAdviser(plan.adviser, job.seed, network) if is_own else _Quickest()
        memories: list[EdgeTimes] = []
        calm_s: dict[str, float] = {}
        means_s: list[float] = []
        for number in range(plan.days + 1):
            doing(f"day {number} of at most {plan.days}", share=number / (plan.days + 1))
            today = make_folder(scratch / f"day{number}")
            ran = run(now.written(scratch / ROUTES), now.scenario, observe_s, job.seed, today)
            times = EdgeTimes(free_s, ran.trips)
            memory = 0.0 if job.share is None else plan.memory
            memories.append(memories[-1].blended(times, memory) if memories else times)
            known = memories[max(0, number - (0 if job.share is None else plan.lag))]
            if job.optimum:  # by what one more vehicle costs all, as in ``equilibrium.optimum``
                calm_s |= {edge: min(least_s, calm_s.get(edge, least_s)) for edge, least_s in times.least_s.items()}
                known = times.raised(calm_s, POWER)
            counted = [trip for trip in ran.trips if first_s <= trip.departed_s < first_s + observe_s]
            home = [trip for trip in counted if trip.has_arrived and len(trip.edges) > 1]
            own_s, least_s = (sum(each.values()) for each in against_best(home, times, ran, today)[:2])
            chance = 1 / (number + 2) if job.share is None else plan.compliance
            mine = tuple(trip for trip in home if trip.id in advised)
            ways = quickest(mine, known, ran.net, ran.types, today)
            routes = adviser.advise(AdvisedDay(number=number, trips=mine, memory=known, quickest=ways))
            taken = {name: tuple(way) for name, way in routes.items() if rng.random() < chance}
            day = _day(now, ran.trips, first_s, first_s + observe_s + TAIL_S, advised)
            means_s.append(day.mean_s)
            gap = (own_s - least_s) / least_s if least_s else 0.0
            yield replace(day, relative_gap=gap, changed=len(taken), teleports=ran.teleports)
            learns = is_own and bool(mine)  # one of the user's own may try something else tomorrow
            if has_settled(means_s) or not (taken or learns):  # with nobody on another route, tomorrow is as today
                return
            now = rerouted(now, taken)


def _first(
    configuration: Configuration, scenario: Scenario, types: str, observe_s: float, seed: int, scratch: Path
) -> Assigned:
    """The trips of the demand on the routes that they set out on, departing when they first entered the network."""
    ran = run(configuration, scenario, observe_s, seed, make_folder(scratch / "first"))
    last_s = configuration.begin_s + scenario.sumo.warm_up_s + observe_s
    trips = tuple(trip for trip in ran.trips if trip.departed_s < last_s)
    return Assigned(variant.with_fixed_routes(scenario), configuration, types, trips)


def _day(
    planned: Assigned, trips: Sequence[DrivenTrip], first_s: float, end_s: float, advised: set[str]
) -> StudyDay:
    """The times of a day; gap, changes and teleports are filled in by the caller."""
    arrived_s = {trip.id: trip.exits_s[-1] for trip in trips if trip.has_arrived}
    counted = [trip for trip in planned.trips if trip.departed_s >= first_s]
    taken_s = {trip.id: arrived_s.get(trip.id, end_s) - trip.departed_s for trip in counted}
    groups = [[taken_s[name] for name in taken_s if (name in advised) is which] for which in (True, False)]
    advised_s, others_s = (fmean(each) if each else None for each in groups)
    return StudyDay(
        mean_s=fmean(taken_s.values()) if taken_s else 0.0,
        advised_s=advised_s,
        others_s=others_s,
        relative_gap=0.0,
        changed=0,
        unfinished=sum(name not in arrived_s for name in taken_s),
        teleports=0,
    )


def _draw(seed: int, name: str) -> float:
    """Below the share if the driver of a trip is advised."""
    return float(np.random.default_rng((seed, crc32(name.encode()))).random())


@dataclass(frozen=True)
class DaysStudy(StudyContent[DaysPlan, DaysRow]):
    """The content of a folder."""

    plan_type = DaysPlan
    row_type = DaysRow
    line_is = "seed, share of advised drivers and day"

    def lines(self) -> Iterator[Json]:
        """Every day of every share, of the user equilibrium and of the system optimum."""
        for row in self.rows:
            about = {"scenario": row.scenario, "seed": row.seed, "drivers": row.drivers, "share": row.share}
            yield from (about | {"day": day, **columns(each)} for day, each in enumerate(row.days))

    def of(self, drivers: Drivers) -> tuple[DaysRow, ...]:
        """The rows of a share or state."""
        return tuple(row for row in self.rows if row.drivers == drivers and row.days)


DAYS: BatchKind[DaysPlan, DaysJob, DaysRow] = BatchKind(DaysRow, partial(alone, run_chain))
