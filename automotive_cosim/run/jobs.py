"""The jobs of a plan: one trial each, on a task's half or on a drive."""

from __future__ import annotations

import hashlib
import re
from abc import ABC, abstractmethod
from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, Generic, TypeVar

from annotated_types import Ge, Gt, Le

from automotive_cosim.contracts.given import GeoInput
from automotive_cosim.drives.families import family_named
from automotive_cosim.drives.specification import MOST_STEPS
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.interface.trace import canonical
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.drive_row import DriveTrialRow
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.episode_row import EpisodeRow
from automotive_cosim.run.outside import EPISODE_S, STEP_S
from automotive_cosim.tasking.sets import Split, Suite
from automotive_cosim.tasking.split import split_of, split_of_seed
from automotive_cosim.tasking.task import Task
from automotive_cosim.tasks import CATALOGUE

NO_MODEL = "none"
WARM_UPS_S: Mapping[str, float] = {
    "alpine_pass": 3.6, "autobahn": 4.2, "beauce": 2.2, "border": 2.0, "grid": 1.6, "gulf": 4.5, "london": 4.3,
    "new_york": 3.8, "nordic": 2.9, "paris_centre": 7.4, "peripherique": 7.5, "sydney": 3.4, "tokyo": 7.2,
}  # fmt: skip
"""Processor seconds of loading and warming up each shipped scenario, with the process that does (November 2026)."""
WARM_UP_S = 10.0
"""The same of another scenario: an import of a town has more roads than most of these."""
HUMAN = "human"
"""The agent that is a person; a code name replaces the model."""


def warm_up_s(scenario: str) -> float:
    """Seconds of one worker on an idle machine for loading and warming up a scenario."""
    return WARM_UPS_S.get(scenario, WARM_UP_S)


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of one episode."""

    steps: Annotated[int, Ge(1), Le(100_000)] = Suite.STANDARD.max_steps
    """Number of actions, including unreadable ones."""
    hard_steps: Annotated[int, Ge(1), Le(100_000)] = Suite.HARD.max_steps
    """The same for the tasks of the hard suite."""
    sim_s: Annotated[float, Gt(0)] = 600.0
    """Simulated seconds from the hand-over, after which the episode is judged as it is."""
    wall_s: Annotated[float, Gt(0)] = 900.0
    """Wall seconds of all but the agent and its model, warm-up included; exceeding them is an infrastructure
    error."""
    agent_s: Annotated[float, Gt(0)] = EPISODE_S
    """Wall seconds that the agent's process may take; exceeding them is a failure of the agent."""
    agent_step_s: Annotated[float, Gt(0)] = STEP_S
    """The same for one step."""
    model_s: Annotated[float, Gt(0)] = 1800.0
    """Wall seconds to wait for the model in all, after which the episode is judged as it is."""
    tokens: Annotated[int, Ge(1)] = 2_000_000
    """Tokens to and from the model, after which the episode is judged as it is."""
    drive_steps: Annotated[int, Ge(1), Le(MOST_STEPS)] = MOST_STEPS
    """``steps`` of a drive, waits among them."""
    drive_wall_s: Annotated[float, Gt(0)] = 7200.0
    """``wall_s`` of a drive, which lasts ten to thirty simulated minutes."""
    drive_agent_s: Annotated[float, Gt(0)] = 7200.0
    """``agent_s`` of a drive."""
    drive_model_s: Annotated[float, Gt(0)] = 14_400.0
    """``model_s`` of a drive: a slow model is asked hundreds of times, for up to a minute each."""
    drive_tokens: Annotated[int, Ge(1)] = 20_000_000
    """``tokens`` of a drive."""

    @property
    def of_drives(self) -> Limits:
        """The limits of a drive, which goes on unwatched when one of them is reached; its time ends with it."""
        return replace(
            self,
            steps=self.drive_steps,
            wall_s=self.drive_wall_s,
            agent_s=self.drive_agent_s,
            model_s=self.drive_model_s,
            tokens=self.drive_tokens,
        )

    def within(self, tokens: int | None = None, model_s: float | None = None) -> Limits:
        """The same with another budget for the model; None keeps what there is."""
        return replace(
            self,
            tokens=self.tokens if tokens is None else tokens,
            model_s=self.model_s if model_s is None else float(model_s),
        )

    @property
    def longest_s(self) -> float:
        """Wall seconds of everything."""
        return self.wall_s + self.agent_s + self.model_s


SetupT = TypeVar("SetupT", EpisodeSetup, DriveSetup)


@dataclass(frozen=True, slots=True)
class PlannedJob(ABC, Generic[SetupT]):
    """One trial of a plan, of either kind."""

    setup: SetupT
    repeat: int = 0
    limits: Limits = field(default_factory=Limits)

    @property
    def model(self) -> str:
        """The model, as given to ``make_agent``."""
        return "rules" if self.setup.model == NO_MODEL else self.setup.model

    @property
    def simulation(self) -> tuple[str, int]:
        """The warm simulation that it starts from: scenario and seed."""
        return self.scenario, self.setup.seed

    @property
    def warm_up_weight(self) -> float:
        return warm_up_s(self.scenario) / WARM_UP_S

    @property
    def wall_s(self) -> float:
        """Limit of its wall time."""
        return self.limits.longest_s

    @property
    @abstractmethod
    def split(self) -> Split:
        """The public set that it belongs to."""

    @property
    def _told(self) -> dict[str, Any]:
        """What its row says of it before it runs, whatever its kind."""
        setup = self.setup
        return {
            "id": self.id,
            "scenario": self.scenario,
            "agent": setup.agent,
            "model": setup.model,
            "conditions": setup.conditions,
            "seed": setup.seed,
            "repeat": self.repeat,
            "split": self.split,
        }

    @property
    @abstractmethod
    def scenario(self) -> str:
        """Name or folder of its scenario."""

    @property
    @abstractmethod
    def id(self) -> str:
        """Its id, which can be a file name."""

    def named(self, *what: str, rest: Iterable[str]) -> str:
        """A file name from what is run, by whom and how: readable words, then a digest of everything.

        Args:
            what: what is run, which comes first.
            rest: what distinguishes it besides agent, model, seed, repeat and conditions.
        """
        setup = self.setup
        conditions: Conditions = setup.conditions
        return file_name(
            (
                *what, setup.agent, setup.model, conditions.geo, f"s{setup.seed}", f"r{self.repeat}", *rest,
                *replace(conditions, geo=GeoInput.FULL).tags,
            )
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class EpisodeJob(PlannedJob[EpisodeSetup]):
    """One episode of a plan."""

    @property
    def scenario(self) -> str:
        """Name or folder of its scenario."""
        return self.setup.scenario or self.task.half(self.setup.half).start.scenario

    @property
    def task(self) -> Task:
        """The catalogue's entry."""
        return CATALOGUE[self.setup.task]

    @property
    def split(self) -> Split:
        """The set that it belongs to, by its seed and its phrasing."""
        return split_of(self.task, self.setup.seed, held_out=self.setup.held_out, redrawn=self.setup.redrawn)

    @property
    def kind(self) -> Hashable:
        """The agent and its model, which determine how long it takes."""
        return self.setup.agent, self.setup.model

    @property
    def situation(self) -> Hashable:
        """The drive up to the hand-over, on which no agent acts."""
        return replace(
            self.setup,
            agent="",
            model="",
            without=(),
            conditions=Conditions(language=self.setup.conditions.language),
        )

    @property
    def instance(self) -> Hashable:
        """What an instance is identified by; the same for every contestant."""
        return self.setup.task, self.setup.half, self.scenario, self.setup.seed, self.repeat

    @property
    def id(self) -> str:
        """Its id, which can be a file name."""
        return self._named(self.setup.half)

    @property
    def pair(self) -> str:
        """Name that both halves of a pair share; empty for a task with one half."""
        return self._named("pair") if self.task.second else ""

    def planned(self) -> EpisodeRow:
        """What is known about it before it runs."""
        setup, task = self.setup, self.task
        half = task.half(setup.half)
        return EpisodeRow(
            **self._told,
            task=task.id,
            half=setup.half,
            pair=self.pair,
            dimension=task.dimension,
            module=task.module,
            basis=half.basis,
            suite=task.suite,
            tags=tuple(sorted(task.tags)),
            skills=tuple(sorted(task.skills)),
            ability=task.ability,
            declines=not half.moves,
            held_out=setup.held_out,
        )

    def _named(self, half: str) -> str:
        setup = self.setup
        held_out = ["held_out"] if setup.held_out else []
        redrawn = [f"redrawn{setup.redrawn}"] if setup.redrawn else []
        return self.named(setup.task, half, rest=(setup.scenario or "own", *held_out, *redrawn))


@dataclass(frozen=True, slots=True)
class DriveJob(PlannedJob[DriveSetup]):
    """One drive of a plan."""

    limits: Limits = field(default_factory=lambda: Limits().of_drives)

    @property
    def scenario(self) -> str:
        """Name or folder of its scenario."""
        return self.setup.scenario or family_named(self.setup.family).scenario

    @property
    def split(self) -> Split:
        """The set that it belongs to, by its seed."""
        return split_of_seed(self.setup.seed)

    @property
    def situation(self) -> Hashable:
        """A drive always begins."""
        return self.id

    @property
    def kind(self) -> Hashable:
        """Agent and model, which determine how long it takes; of agents without a model, the drive itself does."""
        return "drive", self.setup.model, "" if self.setup.model == NO_MODEL else self.setup.agent

    @property
    def instance(self) -> Hashable:
        """What an instance is identified by; the same for every contestant."""
        return self.setup.family, self.scenario, self.setup.settings, self.setup.seed, self.repeat

    @property
    def id(self) -> str:
        """Its id, which can be a file name."""
        setup = self.setup
        scenario = [setup.scenario] if setup.scenario else []
        return self.named(setup.family, rest=(*scenario, *setup.settings.tags))

    def planned(self) -> DriveTrialRow:
        """What is known about it before it runs."""
        setup = self.setup
        return DriveTrialRow(
            **self._told,
            family=setup.family,
            season=family_named(setup.family).season,
            settings=setup.settings,
        )


TrialJob = EpisodeJob | DriveJob
"""One trial of a plan."""


def file_name(exactly: Iterable[str]) -> str:
    """Readable words, then a digest of everything."""
    exactly = tuple(exactly)
    return f"{'-'.join(map(_readable, exactly))[:150]}-{digest(exactly)[:8]}"


@lru_cache(4096)
def _readable(word: str) -> str:
    return re.sub(r"[^A-Za-z0-9_.]+", "_", Path(word).name)


def digest(value: object) -> str:
    """A digest of plain values."""
    return hashlib.sha256(canonical(value)).hexdigest()
