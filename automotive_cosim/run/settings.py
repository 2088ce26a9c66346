"""What can be set about an evaluation. Each field is a value of ``plan.toml`` and an option of ``eval``. And about
``run``."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated

from annotated_types import Ge, Le, MinLen

from automotive_cosim.episode.conditions import ConditionLists
from automotive_cosim.errors import UserError
from automotive_cosim.formats.annotations import OneOf, Option
from automotive_cosim.tasking.sets import SUITES, Split, Suite

BOTH, HIDDEN = "both", "hidden"
SPLITS = (*Split, BOTH, HIDDEN)


@dataclass(frozen=True, slots=True)
class EvaluationSettings(ConditionLists):
    """What an evaluation runs; every list is combined with every other, the conditions' too."""

    agents: tuple[str, ...] = ()
    """At least one; `package.module:Class` is one of your own, `a2a:http://HOST:PORT` one that speaks A2A."""
    models: Annotated[tuple[str, ...], MinLen(1)] = ("rules",)
    """Models for the agents that use one."""
    tasks: Annotated[tuple[str, ...], Option(default="all")] = ()
    """Ids, patterns such as `hvac_*`, tags, modules, dimensions, subsets, abilities, `core`, `general`, `safety` or
    `all`; none beside drives and `[[trials]]` unless given."""
    suite: Annotated[str, OneOf(SUITES, "suite")] = str(Suite.STANDARD)
    """The suite they are chosen from: `standard`, `hard`, `limits`, `clarify`, `speed`, `voice`, `people` or
    `all`; `camera`, by `--see camera` unless it says otherwise; or `live`, the pairs of all suites in which road
    or people do not wait, by `--clock model` unless it says otherwise. An id selects a task in any suite, and
    `core` sixty."""
    drives: tuple[str, ...] = ()
    """Drives, instead of tasks or beside those that are named: families, patterns such as `grid_*`, scenarios,
    seasons or `all`."""
    scenarios: tuple[str, ...] = ()
    """Scenarios instead of the tasks' own, for tasks that can run there, and instead of the drives' own roads; one
    that is not shipped takes all tasks."""
    everywhere: bool = False
    """Also run tasks in scenarios that they do not list, where their situation may never arise."""
    seeds: Annotated[tuple[Annotated[int, Ge(0), Le(2**31 - 1)], ...], MinLen(1)] = (0,)
    """Seeds, as in 0-4 or 0,3,7; each draws its own traffic, weather and phrasing."""
    repeats: Annotated[int, Ge(1), Le(1000)] = 1
    """Runs of each task and drive, for models that do not answer the same twice."""
    rephrase: bool = False
    """Say each repeat of a task in another phrasing, with other people, places and music in the car; all else
    stays."""
    held_out: bool = False
    """Use only each task's held-out phrasing, which `rules` is not built from; otherwise any phrasing is drawn."""
    split: Annotated[str, OneOf(SPLITS, "split")] = BOTH
    """Only the episodes of one public split, by seed and phrasing: `dev` or `test`; `both` for all; `hidden` for
    those that a key draws (`--key`)."""


class Pictures(StrEnum):
    """The episodes whose screenshots are kept."""

    NONE = "none"
    FAILURES = "failures"
    ALL = "all"


PICTURED = 50
"""Evaluations of up to this many runs keep all pictures by default: few enough to look at each."""


@dataclass(frozen=True, slots=True)
class RunSettings:
    """Which plan is evaluated, how and where to; however it is run, the same rows come out."""

    plan: Path | None = None
    """TOML file with the plan, or `board` for the leaderboard's; options override it."""
    key: Path | None = None
    """File with the key that draws seeds and places of the hidden split; its hash, and that of what it draws,
    are printed before anything runs."""
    out: Annotated[Path | None, Option(default="runs/eval-<digest of the plan>")] = None
    """Results folder; an existing one is resumed."""
    dry_run: bool = False
    """Show the plan and exit."""
    retries: Annotated[int, Ge(0), Le(100)] = 2
    """Further attempts after an infrastructure error."""
    pictures: Annotated[
        Pictures | None,
        OneOf(Pictures, "choice of pictures"),
        Option(default=f"all of up to {PICTURED} runs, none of more"),
    ] = None
    """Keep the screenshots, and the road with its vehicles, of: none, failures or all."""
    at_least: Annotated[float, Ge(0), Le(1)] = 0.0
    """End with 1 if any agent succeeds in a smaller share of its planned episodes, or its drives score a smaller
    share of 100 points; 0 to 1, as in 0.8."""

    def kept(self, runs: int) -> Pictures:
        """The pictures that so many runs keep."""
        return self.pictures or (Pictures.ALL if runs <= PICTURED else Pictures.NONE)


@dataclass(frozen=True, slots=True)
class Budget:
    """What an evaluation may spend on its models in total; None means no limit."""

    tokens: Annotated[int | None, Ge(1), Le(10**15), Option("budget-tokens")] = None
    """Stop after this many tokens to and from the models in total; rerun with more to continue."""
    usd: Annotated[float | None, Ge(0.000001), Le(10**9), Option("budget-usd")] = None
    """Stop after this many US dollars, at the prices in the models' names."""

    def __post_init__(self) -> None:
        if (self.tokens is not None and self.tokens <= 0) or (self.usd is not None and not self.usd > 0):
            raise UserError(f"the budget is {self.tokens} tokens and {self.usd} dollars; give either above 0")

    @property
    def is_limited(self) -> bool:
        return self.tokens is not None or self.usd is not None


@dataclass(frozen=True, slots=True)
class SingleSettings:
    """How one trial is run, and where to."""

    drive: Annotated[str, Option(form="FAMILY")] = ""
    """Run this drive of ten to thirty minutes instead of a task; `show drives` lists them."""
    without: tuple[str, ...] = ()
    """Parts of the agent to switch off, separated by commas: gps, context, queries, screen, reflection, memory."""
    memory: Path | None = None
    """File in which ASURADA remembers what worked, for later runs."""
    out: Annotated[Path | None, Option(default="runs/<time>-<task or drive>-<agent>-seed<seed>")] = None
    """Folder for the results."""
    pair: bool = False
    """Run the agent twice from the same instant, with its place and without, side by side."""
    actions: Path | None = None
    """Play a file of actions, one JSON object per line, instead of an agent."""
