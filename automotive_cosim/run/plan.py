"""What an evaluation runs: agents x models x tasks x scenarios x seeds x geo controls, as a list of episodes."""

from __future__ import annotations

import hashlib
import re
import tomllib
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from fnmatch import fnmatchcase
from itertools import product
from pathlib import Path
from typing import Any

from automotive_cosim import scenarios
from automotive_cosim.agents import PROFILES, make_agent
from automotive_cosim.agents.settings import geo_input
from automotive_cosim.contracts import Json
from automotive_cosim.episode.specification import MAX_STEPS, mode_of
from automotive_cosim.errors import UnknownNameError, UserError
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

    steps: int = MAX_STEPS
    sim_s: float = 600.0
    """Simulated seconds from the hand-over; when they are over the episode is judged as it stands."""
    wall_s: float = 900.0
    """Wall seconds in all, warm-up included; what takes longer is an error of the machinery."""
    tokens: int = 2_000_000
    """To and from the model; when they are spent the episode is judged as it stands."""


@dataclass(frozen=True, slots=True)
class Plan:
    """The table ``plan.toml`` holds; every list is multiplied with every other."""

    agents: tuple[str, ...]
    tasks: tuple[str, ...] = ("all",)
    """Ids, patterns such as ``hvac_*``, tags, modules, dimensions, ``general``, ``safety`` or ``all``."""
    models: tuple[str, ...] = ("rules",)
    """For the agents that have one."""
    scenarios: tuple[str, ...] = ()
    """In place of the tasks' own, for those that can run there (``Task.runs_whole_in``); one that is not shipped is
    for all. None leaves each where it belongs."""
    everywhere: bool = False
    """Takes tasks to the scenarios that they do not name too; the situation may not come about there."""
    seeds: tuple[int, ...] = (0,)
    geo: tuple[str, ...] = ("full",)
    modes: tuple[str, ...] = (str(Mode.PROMPTED),)
    """When the agent is called (``tasking.task.Mode``); what is asked for outright is never monitored."""
    repeats: int = 1
    """Of each episode, for models that do not answer the same twice."""
    held_out: bool = False
    """Only the phrasing of each task that is held out from the rule model; else any is drawn."""
    limits: Limits = field(default_factory=Limits)

    def as_json(self) -> Json:
        """The plan as a JSON object, for the manifest."""
        return {name: list(value) if isinstance(value, tuple) else value for name, value in asdict(self).items()}

    def check(self) -> None:
        """Tries every name before anything runs.

        Raises:
            UserError: a name that does not exist, a model that cannot be used, an agent that needs a person, or
                nothing to run.
        """
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
        UserError: it cannot be read, or is no TOML.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise UserError(f"cannot read the plan in {path}: {error}") from error


def make_plan(values: Mapping[str, Any]) -> Plan:
    """A plan from plain values, as TOML or the manifest hold them.

    Raises:
        UserError: a field is not known, missing, empty or of the wrong kind.
    """
    known = {entry.name: entry for entry in fields(Plan)}
    _only(values, known, "plan")
    _only(values.get("limits", {}), {entry.name for entry in fields(Limits)}, "limits of a plan")
    made: dict[str, Any] = {name: _list(name, values[name]) for name in _LISTS if name in values}
    if not made.get("agents"):
        raise UserError('the plan names no agent; give agents = ["asurada"] in the file, or --agents asurada')
    for name in made.keys() - {"scenarios"}:
        if not made[name]:
            raise UserError(f"{name} of the plan is empty; leave it out to take the default")
    if "repeats" in values:
        made["repeats"] = int(_positive("repeats", values["repeats"], whole=True))
    for name in ("everywhere", "held_out"):
        made[name] = values.get(name, False)
        if not isinstance(made[name], bool):
            raise UserError(f"{name} of the plan is {made[name]!r}; give true or false")
    limits = {
        name: _positive(name, value, whole=name in ("steps", "tokens"))
        for name, value in values.get("limits", {}).items()
    }
    return Plan(**made, limits=Limits(**limits))


_LISTS = {
    "agents": str, "tasks": str, "models": str, "scenarios": str, "seeds": int, "geo": str, "modes": str,
}  # fmt: skip


def _list(name: str, value: object) -> tuple[Any, ...]:
    kind = _LISTS[name]
    if not isinstance(value, Sequence) or isinstance(value, str) or not all(type(entry) is kind for entry in value):
        raise UserError(f"{name} of the plan is {value!r}; give a list of {'names' if kind is str else 'numbers'}")
    if kind is int and not all(0 <= seed < 2**31 for seed in value):
        raise UserError(f"{name} of the plan is {value!r}; a seed is a whole number from 0 to {2**31 - 1}")
    return tuple(dict.fromkeys(value))


def _positive(name: str, value: object, *, whole: bool) -> Any:
    if isinstance(value, bool) or not isinstance(value, int if whole else int | float) or value <= 0:
        raise UserError(f"{name} of the plan is {value!r}; give a {'whole ' if whole else ''}number above 0")
    return value if whole else float(value)


def _only(values: object, known: Iterable[str], where: str) -> None:
    if not isinstance(values, Mapping):
        raise UserError(f"the {where} is {values!r}; give a table")
    for name in values:
        if name not in known:
            raise UnknownNameError(f"field of the {where}", name, known)
