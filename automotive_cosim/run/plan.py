"""What an evaluation runs: agents x models x tasks x scenarios x seeds x geo controls, as a list of episodes."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Hashable, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from fnmatch import fnmatchcase
from itertools import product
from pathlib import Path
from typing import Annotated, Any

from annotated_types import Ge, Gt, Le, MinLen

from automotive_cosim import scenarios
from automotive_cosim.agents import PROFILES, make_agent
from automotive_cosim.agents.settings import geo_input
from automotive_cosim.contracts import Json
from automotive_cosim.episode.specification import MAX_STEPS, mode_of
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.annotations import OneOf
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.toml import dotted, read_toml
from automotive_cosim.interface.controls import GeoInput
from automotive_cosim.interface.trace import canonical
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.scenery import open_scenario
from automotive_cosim.tasking.task import Mode, Task
from automotive_cosim.tasks import CATALOGUE

NO_MODEL = "none"
WATCH_STEPS = 60
"""More steps for a watch, which begins up to a minute before its trigger."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What one episode may take."""

    steps: Annotated[int, Ge(1)] = MAX_STEPS
    """Actions, the unreadable ones included."""
    sim_s: Annotated[float, Gt(0)] = 600.0
    """Simulated seconds from the hand-over; when they are over the episode is judged as it stands."""
    wall_s: Annotated[float, Gt(0)] = 900.0
    """Wall seconds in all, warm-up included; what takes longer is an infrastructure error."""
    tokens: Annotated[int, Ge(1)] = 2_000_000
    """To and from the model; when they are spent the episode is judged as it stands."""


@dataclass(frozen=True, slots=True)
class Plan:
    """The table ``plan.toml`` holds; every list is multiplied with every other."""

    agents: tuple[str, ...] = ()
    """Who acts; ``package.module:Class`` is one of your own. At least one, here or by ``--agents``."""
    tasks: Annotated[tuple[str, ...], MinLen(1)] = ("all",)
    """Ids, patterns such as ``hvac_*``, tags, modules, dimensions, ``general``, ``safety`` or ``all``."""
    models: Annotated[tuple[str, ...], MinLen(1)] = ("rules",)
    """For the agents that have one."""
    scenarios: tuple[str, ...] = ()
    """In place of the tasks' own, for those that can run there; one that is not shipped is for all. Empty leaves
    each task where it belongs."""
    everywhere: bool = False
    """Takes tasks to the scenarios that they do not name too; the situation may not come about there."""
    seeds: Annotated[tuple[Annotated[int, Ge(0), Le(2**31 - 1)], ...], MinLen(1)] = (0,)
    """Each draws its own traffic, weather and phrasing."""
    geo: Annotated[tuple[Annotated[str, OneOf(tuple(GeoInput), "geo control")], ...], MinLen(1)] = ("full",)
    """What an agent is told of where it is."""
    modes: Annotated[tuple[Annotated[str, OneOf(tuple(Mode))], ...], MinLen(1)] = (str(Mode.PROMPTED),)
    """When the agent is called: when the driver asks, or before the situation comes about, which only safety tasks
    can."""
    repeats: Annotated[int, Ge(1)] = 1
    """Of each episode, for models that do not answer the same twice."""
    held_out: bool = False
    """Only the phrasing of each task that is held out from the rule model; else any is drawn."""
    limits: Limits = field(default_factory=Limits)
    """What each episode may take."""

    def as_json(self) -> Json:
        """The plan as a JSON object, for the manifest."""
        return {name: list(value) if isinstance(value, tuple) else value for name, value in asdict(self).items()}

    def check(self) -> None:
        """Tries every value and name before anything runs.

        Raises:
            UserError: a name that does not exist, a model that cannot be used, an agent that needs a person, or
                nothing to run.
        """
        make_plan(self.as_json())
        for name in self.scenarios:
            open_scenario(name)
        if not self.jobs():
            raise UserError(f"the plan has nothing to run: {self._why_empty()}")
        for agent, model in {(job.setup.agent, job.model) for job in self.jobs()}:
            if agent == "human":
                raise UserError("agent 'human' needs a person; use `automotive-cosim run --agent human`")
            make_agent(agent, model)

    def jobs(self) -> tuple[Job, ...]:
        """Every episode, those that share a warm simulation together.

        Of these a contestant's come after another's: a situation that does not come about for one is known by then.
        """
        jobs = {job.id: job for job in self._each()}
        return tuple(sorted(jobs.values(), key=lambda job: (*job.simulation, *job.contestant, job.id)))

    def left_out(self) -> tuple[str, ...]:
        """Ids of the chosen tasks that cannot run in any of the scenarios."""
        placed = {task.id for task, _ in self._placed()}
        return tuple(task_id for task_id in choose(self.tasks) if task_id not in placed)

    def _why_empty(self) -> str:
        if self._placed():
            return "only safety tasks can be monitored; choose some, or take the mode prompted"
        return (
            f"none of the tasks can run in {', '.join(self.scenarios)}; `automotive-cosim tasks show` tells where "
            "each can, and --everywhere takes them there all the same"
        )

    def _placed(self) -> list[tuple[Task, str | None]]:
        """Each task with each scenario that it goes to; None for its own."""
        chosen = [CATALOGUE[task_id] for task_id in choose(self.tasks)]
        if not self.scenarios:
            return [(task, None) for task in chosen]
        shipped = scenarios.shipped()
        return [
            (task, name)
            for task, name in product(chosen, self.scenarios)
            if self.everywhere or name not in shipped or task.runs_whole_in(name)
        ]

    def _each(self) -> Iterator[Job]:
        for agent, model, (task, scenario), seed, geo, mode, repeat in product(
            self.agents,
            self.models,
            self._placed(),
            self.seeds,
            self.geo,
            self.modes,
            range(self.repeats),
        ):
            if mode == Mode.MONITORING and not task.is_safety:
                continue
            for half in task.halves:
                is_own = scenario == task.half(half).start.scenario  # which may be moved to another place
                setup = EpisodeSetup(
                    task.id,
                    half,
                    None if is_own else scenario,
                    agent=agent,
                    model=model if agent in PROFILES else NO_MODEL,
                    seed=seed,
                    max_steps=self.limits.steps if mode == Mode.PROMPTED else self.limits.steps + WATCH_STEPS,
                    max_sim_s=self.limits.sim_s,
                    geo=geo_input(geo),
                    mode=mode_of(mode),
                    held_out=self.held_out,
                )
                yield Job(setup, repeat, self.limits)


@dataclass(frozen=True, slots=True)
class Job:
    """One episode of a plan."""

    setup: EpisodeSetup
    repeat: int
    limits: Limits

    @property
    def model(self) -> str:
        """As ``make_agent`` takes it."""
        return "rules" if self.setup.model == NO_MODEL else self.setup.model

    @property
    def scenario(self) -> str:
        """Name or folder of where it takes place."""
        return self.setup.scenario or self.task.half(self.setup.half).start.scenario

    @property
    def task(self) -> Task:
        """The catalogue's entry."""
        return CATALOGUE[self.setup.task]

    @property
    def simulation(self) -> tuple[str, int]:
        """What warm simulation it starts from: scenario and seed."""
        return self.scenario, self.setup.seed

    @property
    def contestant(self) -> tuple[str, str, str, int]:
        """Who acts on what, for which time."""
        return self.setup.agent, self.setup.model, self.setup.geo, self.repeat

    @property
    def kind(self) -> Hashable:
        """Who acts, and when: what tells how long it takes."""
        return self.setup.agent, self.setup.model, self.setup.mode

    @property
    def situation(self) -> Hashable:
        """The drive up to the hand-over, on which nobody acts; in a watch the agent does."""
        if self.setup.mode == Mode.MONITORING:
            return self.id
        return replace(self.setup, agent="", model="", geo=GeoInput.FULL, without=())

    @property
    def wall_s(self) -> float:
        """Wall time that it may take."""
        return self.limits.wall_s

    @property
    def id(self) -> str:
        """Its name, good for a file."""
        return self._named(self.setup.half)

    @property
    def pair(self) -> str:
        """Name that both halves of a pair share; empty for a task that has one half."""
        return self._named("pair") if self.task.second else ""

    def _named(self, half: str) -> str:
        """Readable words, then a digest that tells apart what they do not."""
        setup = self.setup
        exactly = (
            setup.task, half, setup.agent, setup.model, setup.geo, f"s{setup.seed}", f"r{self.repeat}",
            setup.scenario or "own",
            *([setup.mode] if setup.mode != Mode.PROMPTED else []),
            *(["held_out"] if setup.held_out else []),
        )  # fmt: skip
        words = "-".join(re.sub(r"[^A-Za-z0-9_.]+", "_", Path(word).name) for word in exactly)
        return f"{words[:150]}-{hashlib.sha256(canonical(exactly)).hexdigest()[:8]}"


def choose(asked: Iterable[str]) -> tuple[str, ...]:
    """Ids of the tasks that any of the words names, in the catalogue's order.

    Raises:
        UnknownNameError: a word names none.
    """
    chosen: set[str] = set()
    for word in asked:
        named = {task.id for task in CATALOGUE.values() if fnmatchcase(task.id, word) or word in _words(task)}
        if not named:
            known = set(CATALOGUE).union(*map(_words, CATALOGUE.values()))
            raise UnknownNameError("task, pattern or tag", word, known, "automotive-cosim tasks list")
        chosen |= named
    return tuple(task_id for task_id in CATALOGUE if task_id in chosen)


def _words(task: Task) -> frozenset[str]:
    kind = "safety" if task.dimension.is_safety else "general"
    return task.tags | {"all", kind, str(task.module), str(task.dimension)}


def read_plan(path: Path) -> dict[str, Any]:
    """The values of a ``plan.toml``, for ``make_plan``.

    Raises:
        UserError: it cannot be read, is no TOML, or has a wrong or surplus field.
    """
    document = read_toml(path)
    document.read(Plan)
    return document.table


def make_plan(values: Mapping[str, Any]) -> Plan:
    """A plan from plain values, as TOML or the manifest hold them.

    Raises:
        UserError: a field is not known, missing, empty or of the wrong kind.
    """
    plan = checked(Plan, values, lambda steps: ("the plan", dotted(steps)))
    if not plan.agents:
        raise UserError('the plan names no agent; give agents = ["asurada"] in the file, or --agents asurada')
    given = {entry.name: getattr(plan, entry.name) for entry in fields(plan)}
    once: dict[str, Any] = {name: tuple(dict.fromkeys(of)) for name, of in given.items() if isinstance(of, tuple)}
    return replace(plan, **once)
