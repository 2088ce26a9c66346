"""What an evaluation runs: agents x models x tasks x scenarios x seeds x geo controls, as a list of episodes."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from itertools import product
from math import prod
from pathlib import Path
from typing import Annotated, Any

from annotated_types import Ge, Le

from automotive_cosim import scenarios
from automotive_cosim.agents import MODELLED, Agent, AgentSettings, is_remote, make_agent
from automotive_cosim.cockpit import own_make
from automotive_cosim.cockpit.language import Language
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import Clock, Hearing, See
from automotive_cosim.drives.elsewhere import elsewhere
from automotive_cosim.drives.families import FAMILIES, family_named
from automotive_cosim.drives.settings import AS_SCRIPTED, DriveSettings
from automotive_cosim.episode.conditions import Conditions, combined, lists_of
from automotive_cosim.episode.own_prompt import resolved
from automotive_cosim.episode.specification import SessionSetup
from automotive_cosim.errors import SetupError, UnknownNameError, UserError
from automotive_cosim.formats.annotations import OneOf
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.toml import dotted, read_toml
from automotive_cosim.formats.words import matches
from automotive_cosim.interface.trace import plain
from automotive_cosim.run.choosing import choose
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.outside import check_agent
from automotive_cosim.run.settings import BOTH, HIDDEN, EvaluationSettings
from automotive_cosim.run.trial import HUMAN, NO_MODEL, Limits, TrialSetup, digest
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.sets import LIVE, Suite
from automotive_cosim.tasking.task import Task
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.voice.table import lacking

BOARD = Path(__file__).with_name("board.toml")
"""The plan of the leaderboard's first table."""
MOST_RUNS = 10_000_000
"""At a second each, four months."""
SPARE_TRAFFIC = (1_000_001, 1_000_002)
"""Far from the seeds that people choose."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedTrial:
    """One ``[[trials]]`` of a plan, run by every agent and model of it: a half of a task, or a drive."""

    task: str = ""
    """Id of the task; empty for a drive."""
    half: Annotated[str, OneOf(("first", "second"), "half")] = "first"
    drive: str = ""
    """Family of drives; empty for a task."""
    scenario: str = ""
    """Where to run it instead of in the task's or the drive's own scenario."""
    seed: Annotated[int, Ge(0), Le(2**31 - 1)] = 0
    """Seed of the traffic, and of everything that is drawn."""
    repeat: Annotated[int, Ge(0), Le(1000)] = 0
    """Which run of the same it is; the plan's repeats count from here."""
    held_out: bool = False
    """Whether the driver says the task's held-out phrasing."""
    conditions: Conditions = Conditions()  # noqa: RUF009, frozen
    """What the agent is given, and at what speed."""
    settings: DriveSettings = AS_SCRIPTED
    """What is set otherwise than the drive's script has it."""

    def job(self, agent: str, model: str, repeat: int, limits: Limits, spare: tuple[int, ...]) -> TrialSetup:
        """The trial of one agent.

        Raises UserError: it names no task and no drive, or both, or something that does not exist or cannot be
        set."""
        if bool(self.task) == bool(self.drive):
            raise UserError("an entry of [[trials]] names a task or a drive; give one of the two")
        named: dict[str, Any] = {
            "agent": agent,
            "model": model if agent in MODELLED or agent == HUMAN else NO_MODEL,
            "seed": self.seed,
            "conditions": self.conditions.at(self.seed),
            "repeat": self.repeat + repeat,
        }
        if self.drive:
            family_named(self.drive)
            most = limits.of_drives
            return DriveSetup(
                self.drive,
                scenario=self.scenario,
                settings=self.settings,
                max_steps=most.steps,
                limits=most,
                **named,
            )
        if self.settings != AS_SCRIPTED:
            raise UserError(f"{self.task}: {self.settings.words} can be set for drives alone; omit it")
        if self.task not in CATALOGUE:
            raise UnknownNameError("task", self.task, CATALOGUE, "automotive-cosim tasks list")
        task = CATALOGUE[self.task]
        half = task.half(self.half)
        if self.conditions.language not in task.languages:
            raise UserError(f"{self.task} has no phrasings in {languages_in_words([self.conditions.language])}")
        scenario = None if self.scenario in ("", half.start.scenario) else self.scenario  # a half may move it
        return EpisodeSetup(
            task.id,
            self.half,
            scenario,
            max_steps=limits.hard_steps if task.suite.is_long else limits.steps,
            max_sim_s=limits.sim_s,
            held_out=self.held_out,
            spare_traffic=spare if scenario is None or scenario in task.runs_in else (),
            limits=limits,
            **named,
        )


@dataclass(frozen=True, slots=True)
class Plan(EvaluationSettings):
    """The content of a ``plan.toml``."""

    spare_traffic: tuple[Annotated[int, Ge(0), Le(2**31 - 1)], ...] = SPARE_TRAFFIC
    """Seeds of traffic that replace a seed's own, in turn, if the situation does not occur in it although the task
    lists the scenario. Every agent gets the same; the row says which."""
    settings: DriveSettings = AS_SCRIPTED
    """What is set otherwise than their scripts have it, of all ``drives``."""
    trials: tuple[PlannedTrial, ...] = ()
    """Single tasks and drives beside those combined from the lists."""
    limits: Limits = field(default_factory=Limits)
    """Limits of each episode."""

    def as_json(self) -> Json:
        """The plan as a JSON object, for the manifest."""
        made: Json = json.loads(json.dumps(asdict(self)))  # words in place of enumerations
        for name in ("trials", "settings"):  # as in plans from before there were any
            if getattr(self, name) in ((), AS_SCRIPTED):
                del made[name]
        return made

    def check(self, *, dry: bool = False) -> tuple[str, ...]:
        """Checks every value and name before anything runs.

        Args:
            dry: nothing will run, so that no key, address or package of a model is needed.

        Returns:
            What this machine lacks to run it, which is an error unless ``dry``.

        Raises UserError: a name does not exist, a model cannot be used, an agent needs a person, or there is
        nothing to run."""
        lacks: list[str] = []
        make_plan(self.as_json())
        for name in self.scenarios:
            open_scenario(name)
            for family in families_named(self.drives)[:1]:
                elsewhere(family_named(family).draw(0), name)
        for name in dict.fromkeys(trial.scenario for trial in self.trials if trial.scenario):
            open_scenario(name)
        if not self.jobs():
            raise UserError(f"the plan has nothing to run: {self._nowhere()}")
        remote: dict[str, Agent] = {}
        for agent, model, conditions in {(job.agent, job.asked_model, job.conditions) for job in self.jobs()}:
            if agent == HUMAN:
                raise UserError(
                    "agent 'human' needs a person; use `automotive-cosim serve --play`, or `run --agent human`"
                )
            if ":" in agent and not is_remote(agent):
                check_agent(agent)
            else:
                try:
                    made = remote.get(agent) or make_agent(agent, model, AgentSettings(conditions))
                    if is_remote(agent):
                        remote[agent] = made  # its card is the same under all conditions, and may take seconds
                    SessionSetup(frozenset(made.channels), conditions)
                except SetupError as error:
                    if not dry:
                        raise
                    lacks.append(str(error))
        return tuple(dict.fromkeys(sorted(lacks)))

    def jobs(self) -> tuple[TrialSetup, ...]:
        """Every trial, grouped by warm simulation, then by instance, whose contestants stand next to each other:
        wherever a run stops, they can be compared on all that is complete.

        Simulations, instances and contestants are ordered by hash, from which an agent learns nothing: first halves
        do not come before second ones.

        Raises UserError: there are more than can ever be run."""
        if (most := self.most_runs()) > MOST_RUNS:
            raise UserError(f"the plan has {most:,} runs; give fewer seeds or repeats, at most {MOST_RUNS:,}")
        who = product(self.agents, self.models, (*self.unfolded(), *self.trials), range(self.repeats))
        every = (self._job(agent, model, trial, repeat) for agent, model, trial, repeat in who)
        jobs = {job.id: job for job in every if self.split in (BOTH, HIDDEN, job.split)}
        return tuple(sorted(jobs.values(), key=_place))

    def trials_by_id(self) -> dict[str, TrialSetup]:
        """Every trial, each car of a fleet by itself."""
        return {car.id: car for job in self.jobs() for car in job.cars}

    def most_runs(self) -> int:
        """How many runs it has at most, those of ``trials`` left out, without unfolding it."""
        lists = (self.agents, self.models, [*self._placed(), *self._driven()], self.seeds, *lists_of(self).values())
        return prod(map(len, lists)) * self.repeats

    def episodes(self) -> tuple[EpisodeSetup, ...]:
        """Those of the jobs that are episodes on tasks."""
        return tuple(job for job in self.jobs() if isinstance(job, EpisodeSetup))

    @property
    def languages(self) -> tuple[Language, ...]:
        """What the drivers speak."""
        return tuple(lists_of(self)["language"])

    def left_out(self) -> tuple[str, ...]:
        """Ids of the chosen tasks that cannot run in any of the scenarios."""
        placed = {task.id for task, _ in self._placed()}
        return tuple(task.id for task in self.spoken() if task.id not in placed)

    def unspoken(self) -> tuple[str, ...]:
        """Ids of the chosen tasks that have no phrasings in one of the languages."""
        spoken = {task.id for task in self.spoken()}
        return tuple(task_id for task_id in self._chosen() if task_id not in spoken)

    def beyond_the_list(self) -> tuple[str, ...]:
        """Ids of the chosen tasks that some conditions leave out: something needed is only in the picture."""
        under = tuple(combined(self))
        return tuple(
            task_id for task_id in self._chosen() if any(each.hides(CATALOGUE[task_id].tags) for each in under)
        )

    def unheard(self) -> int:
        """How many episodes would end at once because what is said can neither be looked up nor recognised."""
        heard = (job for job in self.episodes() if job.conditions.hear is Hearing.CABIN)
        drawn = (
            draw(job.entry, job.half, job.seed, held_out=job.held_out, redrawn=job.redrawn).spoken for job in heard
        )
        return sum(bool(lacking(text for text in spoken if "<" not in text)) for spoken in drawn)

    def _nowhere(self) -> str:
        if not self._chosen():
            return f"no drive with these seeds is in the split {self.split!r}; give other seeds"
        hidden = [each.hides(task.tags) for task, _ in self._placed() for each in combined(self)]
        if hidden and all(hidden):
            return f"these tasks need {hidden[0]}"
        if not self.spoken():
            return (
                f"none of the tasks has phrasings in {languages_in_words(self.languages)}; those of the "
                "hard suite do (--suite hard)"
            )
        if self._placed():
            held_out = " in held-out phrasings, which are all in test" if self.held_out else ""
            return f"no episode of these tasks and seeds is in the split {self.split!r}{held_out}; give other seeds"
        return (
            f"none of the tasks can run in {', '.join(self.scenarios)}; `automotive-cosim tasks show` says where "
            "each can, and --everywhere runs them there anyway"
        )

    def _placed(self) -> list[tuple[Task, str | None]]:
        """Each task with each scenario that it runs in; None for its own."""
        chosen = self.spoken()
        if not self.scenarios:
            return [(task, None) for task in chosen]
        shipped = scenarios.shipped()
        return [
            (task, name)
            for task, name in product(chosen, self.scenarios)
            if self.everywhere or name not in shipped or task.runs_whole_in(name)
        ]

    def spoken(self) -> list[Task]:
        """The chosen tasks that have phrasings in every language."""
        chosen = [CATALOGUE[task_id] for task_id in self._chosen()]
        return [task for task in chosen if set(self.languages) <= set(task.languages)]

    def _chosen(self) -> tuple[str, ...]:
        """Ids of the chosen tasks."""
        return choose(self.tasks or (() if self.drives or self.trials else ("all",)), self.suite)

    def _driven(self) -> list[tuple[str, str]]:
        """Each family of drives with each scenario that it runs in; empty for its own."""
        return list(product(families_named(self.drives), self.scenarios or ("",)))

    def unfolded(self) -> Iterator[PlannedTrial]:
        """The trials that the lists stand for."""
        for (task, place), seed, conditions in product(self._placed(), self.seeds, combined(self)):
            for half in () if conditions.hides(task.tags) else task.halves:
                yield PlannedTrial(
                    task=task.id,
                    half=half,
                    scenario=place or "",
                    seed=seed,
                    held_out=self.held_out,
                    conditions=conditions,
                )
        for (family, place), seed, conditions in product(self._driven(), self.seeds, combined(self)):
            yield PlannedTrial(
                drive=family, scenario=place, seed=seed, conditions=conditions, settings=self.settings
            )

    def _job(self, agent: str, model: str, trial: PlannedTrial, repeat: int) -> TrialSetup:
        job = trial.job(agent, model, repeat, self.limits, self.spare_traffic)
        return replace(job, redrawn=repeat) if self.rephrase and isinstance(job, EpisodeSetup) else job


def _place(job: TrialSetup) -> tuple[str, str, str]:
    return digest(job.simulation), digest(plain(job.instance)), digest(job.id)


def languages_in_words(codes: Iterable[str]) -> str:
    """For example ``French and German``; English, which every task has, is left out if there are others."""
    *others, last = [Language(code).words for code in codes if code != Language.ENGLISH] or ["English"]
    return f"{', '.join(others)} and {last}" if others else last


def families_named(asked: Iterable[str]) -> tuple[str, ...]:
    """Ids of the families of drives that any of the words selects, in their order.

    Raises UnknownNameError: a word selects none."""
    chosen: set[str] = set()
    for word in asked:
        named = {
            family.id
            for family in FAMILIES.values()
            if word in ("all", family.scenario, family.season) or matches(family.id, word)
        }
        if not named:
            raise UnknownNameError("family of drives", word, FAMILIES, "automotive-cosim show drives")
        chosen |= named
    return tuple(family for family in FAMILIES if family in chosen)


def read_plan(path: Path) -> dict[str, Any]:
    """The values of a ``plan.toml``, for ``make_plan``; ``board`` is the leaderboard's, which the package has.

    Raises UserError: it cannot be read, is not TOML, or has a wrong or surplus field."""
    document = read_toml(BOARD if str(path) == BOARD.stem and not path.exists() else path)
    document = replace(document, table=with_files(document.table))
    document.read(Plan)
    return document.table


def with_files(values: dict[str, Any]) -> dict[str, Any]:
    """The values with each file of instructions, or with a make, named by its SHA-256 too; its path is from the
    working folder.

    Raises UserError: such a file cannot be used."""
    named = {}
    for name, read in (("prompt", resolved), ("make", own_make.resolved)):
        if isinstance(given := values.get(name), list):
            named[name] = [read(each) if isinstance(each, str) else each for each in given]
    return values | named


def make_plan(values: Mapping[str, Any]) -> Plan:
    """A plan from plain values, as in TOML or the manifest.

    Raises UserError: a field is unknown, missing, empty or of the wrong type."""
    if values.get("suite") == LIVE:  # there, what a model needs to think passes on the road
        values = {"clock": [str(Clock.MODEL)], **values}
    if values.get("suite") == Suite.CAMERA:
        values = {"see": [str(See.CAMERA)], **values}
    plan = checked(Plan, values, lambda steps: ("the plan", dotted(steps)))
    if not plan.agents:
        raise UserError('the plan has no agent; give agents = ["asurada"] in the file, or --agents asurada')
    given = {entry.name: getattr(plan, entry.name) for entry in fields(plan)}
    once: dict[str, Any] = {name: tuple(dict.fromkeys(of)) for name, of in given.items() if isinstance(of, tuple)}
    return replace(plan, **once)
