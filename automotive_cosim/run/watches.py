"""Evaluations of drives: families x agents x models x seeds, run in workers and resumable like those of tasks."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Hashable, Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import asdict, dataclass, field, fields, replace
from fnmatch import fnmatchcase
from functools import partial
from itertools import product
from pathlib import Path
from typing import Annotated, Any

from annotated_types import Ge, Gt, Le, MinLen

from automotive_cosim.agents import MODELLED, AgentSettings, make_agent
from automotive_cosim.contracts import Json
from automotive_cosim.drives.elsewhere import elsewhere
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.episode.conditions import ConditionLists, combined
from automotive_cosim.episode.specification import SessionSetup
from automotive_cosim.errors import CosimError, UnknownNameError, UserError
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.toml import dotted
from automotive_cosim.interface.controls import GeoInput
from automotive_cosim.run.batch import Progress, run_jobs, spent_before
from automotive_cosim.run.executor import Executor, Runner
from automotive_cosim.run.former import plan_values
from automotive_cosim.run.meter import Budget, MeterHandle
from automotive_cosim.run.nursery import Nursery
from automotive_cosim.run.outside import check_agent
from automotive_cosim.run.plan import HUMAN, NO_MODEL, Limits, digest
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.store import opened, write_trace
from automotive_cosim.run.watch import WatchRecord, WatchSetup, planned_row, run_watch
from automotive_cosim.run.watch_row import WatchRow
from automotive_cosim.run.worker import WARM, agent_for
from automotive_cosim.traffic.fork import Simulations

TIMELINES = "timelines"
"""Folder of an evaluation with a timeline for each drive."""
DRIVE_LIMITS = Limits(steps=100_000, sim_s=1800.0, wall_s=7200.0, agent_s=7200.0, tokens=20_000_000)
"""Limits of one drive, several times those of a task's episode."""


@dataclass(frozen=True, slots=True)
class WatchPlan(ConditionLists):
    """What an evaluation of drives runs; every list is combined with every other."""

    drives: Annotated[tuple[str, ...], MinLen(1)]
    """Families of drives, patterns such as ``grid_*``, scenarios, seasons, or ``all``."""
    scenarios: tuple[str, ...] = ()
    """Scenarios, or paths of scenarios and networks, to drive on instead of each family's own."""
    agents: tuple[str, ...] = ()
    """Agents; ``package.module:Class`` is one of your own."""
    models: Annotated[tuple[str, ...], MinLen(1)] = ("rules",)
    """Models for the agents that use one."""
    seeds: Annotated[tuple[Annotated[int, Ge(0), Le(2**31 - 1)], ...], MinLen(1)] = (0,)
    """Seeds; each draws its own drive."""
    repeats: Annotated[int, Ge(1), Le(1000)] = 1
    """Runs of each drive, for models that do not answer the same twice."""
    wall_s: Annotated[float, Gt(0)] = DRIVE_LIMITS.wall_s
    """Wall seconds of one drive; exceeding them is an infrastructure error."""

    def as_json(self) -> Json:
        """The plan as a JSON object, for the manifest."""
        return {name: list(value) if isinstance(value, tuple) else value for name, value in asdict(self).items()}

    def check(self) -> None:
        """Checks every name before anything runs.

        Raises:
            UserError: a family, scenario, agent or model does not exist, its roads allow no endless drive, or an
                agent needs a person.
        """
        for scenario in self.scenarios:
            elsewhere(FAMILIES[families_named(self.drives)[0]].draw(0), scenario)
        for agent, model, conditions in {(job.setup.agent, job.model, job.setup.conditions) for job in self.jobs()}:
            if agent == HUMAN:
                raise UserError("agent 'human' needs a person; use `automotive-cosim serve --play`")
            if ":" in agent:
                check_agent(agent)
            else:
                made = make_agent(agent, model, AgentSettings(conditions))
                SessionSetup(frozenset(made.channels), conditions)

    def jobs(self) -> tuple[WatchJob, ...]:
        """Every drive, grouped by warm simulation.

        Raises:
            UnknownNameError: a word selects no family.
        """
        limits = replace(DRIVE_LIMITS, wall_s=self.wall_s)
        found = {
            job.id: job
            for family, scenario, agent, model, seed, conditions, repeat in product(
                families_named(self.drives),
                self.scenarios or ("",),
                self.agents,
                self.models,
                self.seeds,
                combined(self),
                range(self.repeats),
            )
            for job in [
                WatchJob(
                    WatchSetup(
                        family,
                        seed,
                        agent,
                        model if agent in MODELLED or agent == HUMAN else NO_MODEL,
                        conditions,
                        repeat,
                        scenario,
                    ),
                    limits,
                )
            ]
        }
        return tuple(sorted(found.values(), key=lambda job: (digest(job.simulation), digest(job.id))))


@dataclass(frozen=True, slots=True)
class WatchJob:
    """One drive of a plan."""

    setup: WatchSetup
    limits: Limits = field(default=DRIVE_LIMITS)

    @property
    def model(self) -> str:
        """The model, as given to ``make_agent``."""
        return "rules" if self.setup.model == NO_MODEL else self.setup.model

    @property
    def simulation(self) -> tuple[str, int]:
        """The warm simulation that it starts from: scenario and seed."""
        return self.setup.scenario or FAMILIES[self.setup.family].scenario, self.setup.seed

    @property
    def situation(self) -> Hashable:
        """A drive always begins."""
        return self.id

    @property
    def kind(self) -> Hashable:
        """Agent and model, which determine how long it takes."""
        return self.setup.agent, self.setup.model

    @property
    def wall_s(self) -> float:
        """Limit of its wall time."""
        return self.limits.wall_s

    @property
    def id(self) -> str:
        """Its id, which can be a file name."""
        setup = self.setup
        exactly = (
            setup.family, setup.agent, setup.model, setup.conditions.geo, f"s{setup.seed}", f"r{setup.repeat}",
            *([setup.scenario] if setup.scenario else []),
            *replace(setup.conditions, geo=GeoInput.FULL).tags,
        )  # fmt: skip
        words = "-".join(re.sub(r"[^A-Za-z0-9_.]+", "_", Path(word).name) for word in exactly)
        return f"{words[:150]}-{digest(exactly)[:8]}"


def families_named(asked: tuple[str, ...]) -> tuple[str, ...]:
    """Ids of the families that any of the words selects, in their order.

    Raises:
        UnknownNameError: a word selects none.
    """
    chosen: set[str] = set()
    for word in asked:
        named = {
            family.id
            for family in FAMILIES.values()
            if word in ("all", family.scenario, family.season) or fnmatchcase(family.id, word)
        }
        if not named:
            raise UnknownNameError("family of drives", word, FAMILIES, "automotive-cosim drive --list")
        chosen |= named
    return tuple(family for family in FAMILIES if family in chosen)


def make_watch_plan(values: Mapping[str, Any]) -> WatchPlan:
    """A plan from plain values, as from options or the manifest.

    Raises:
        UserError: a field is unknown, missing, empty or of the wrong type.
    """
    plan = checked(WatchPlan, plan_values(values, "the plan"), lambda steps: ("the plan", dotted(steps)))
    if not plan.agents:
        raise UserError("the plan has no agent; give --agents asurada, or --agents rule-perfect")
    given = {entry.name: getattr(plan, entry.name) for entry in fields(plan)}
    once: dict[str, Any] = {name: tuple(dict.fromkeys(of)) for name, of in given.items() if isinstance(of, tuple)}
    return replace(plan, **once)


def run_watch_plan(
    plan: WatchPlan,
    folder: Path,
    *,
    executor: Executor = Processes(),  # noqa: B008, frozen
    retries: int = 2,
    budget: Budget = Budget(),  # noqa: B008, frozen
    tell: Callable[[Progress[WatchRow]], None] = lambda progress: None,
) -> Progress[WatchRow]:
    """Runs the remaining drives of a plan and retries those that ended in an error.

    Args:
        plan: what to run.
        folder: results folder, new or to be resumed.
        executor: where to run it; the results do not depend on it.
        retries: how many times a drive is retried after an infrastructure error.
        budget: what it may spend on its models, with all earlier starts.
        tell: called at the start and after every drive.

    Raises:
        as ``batch.run_plan``.
    """
    plan.check()
    jobs = plan.jobs()
    with (
        opened(folder, plan.as_json(), WatchRow, parts=("traces", TIMELINES), planned=len(jobs)) as store,
        executor.metered(budget, spent_before(store)) as meter,
    ):
        opener, limit = partial(watches, meter), meter if budget.is_limited else None
        return run_jobs(
            jobs, store, opener, failed_watch, executor=executor, retries=retries, limit=limit, tell=tell
        )


@contextmanager
def watches(meter: MeterHandle | None = None) -> Iterator[Runner[WatchJob, WatchRow]]:
    """Makes the runner of the drives in a worker; ``meter`` is what all workers share."""
    with closing(Simulations(count_limit=WARM)) as simulations, closing(Nursery()) as nursery:
        yield lambda job, folder: run_watch_job(job, folder, simulations, nursery, meter)


def run_watch_job(
    job: WatchJob, folder: Path, simulations: Simulations, nursery: Nursery, meter: MeterHandle | None = None
) -> WatchRow:
    """Runs one drive, writes its steps and timeline, and returns its row; an error becomes a row too.

    Raises:
        OSError: steps or timeline cannot be written.
    """
    setup = job.setup
    try:
        settings = AgentSettings(setup.conditions, seed=setup.seed)
        with agent_for(setup.agent, job.model, settings, job.limits, nursery, meter) as agent:
            record = run_watch(job.id, setup, agent, simulations=simulations)
    except CosimError as error:
        return failed_watch(job, type(error).__name__, str(error))
    except Exception as error:
        # A fault in this package must not end the evaluation; it is counted and listed.
        return failed_watch(job, type(error).__name__, f"{type(error).__name__}: {error}")
    keep_watch(record, folder, job.id)
    return record.row


def failed_watch(job: WatchJob, kind: str, why: str) -> WatchRow:
    """The row of a drive that ended in an infrastructure error."""
    return replace(planned_row(job.id, job.setup), error=why, error_kind=kind)


def keep_watch(record: WatchRecord, folder: Path, name: str) -> None:
    """Writes the steps and the timeline of a drive into an evaluation's folder.

    Raises:
        OSError: they cannot be written.
    """
    (folder / TIMELINES).mkdir(exist_ok=True)  # on a node of a cluster, each job has a folder of its own
    (folder / TIMELINES / f"{name}.json").write_text(json.dumps(record.timeline), "utf-8")
    write_trace(folder, name, record.steps)
