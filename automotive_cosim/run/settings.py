"""What can be set about an evaluation. Each field is a value of ``plan.toml`` and an option of ``eval``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge, Le, MinLen

from automotive_cosim.episode.conditions import ConditionLists
from automotive_cosim.formats.annotations import OneOf, Option
from automotive_cosim.tasking.sets import Split, Suite

ALL_SUITES, BOTH = "all", "both"
SUITES = (*Suite, ALL_SUITES)
SPLITS = (*Split, BOTH)


@dataclass(frozen=True, slots=True)
class EvaluationSettings(ConditionLists):
    """What an evaluation runs; every list is combined with every other, the conditions' too."""

    agents: tuple[str, ...] = ()
    """At least one; `package.module:Class` is one of your own, `a2a:http://HOST:PORT` one that speaks A2A."""
    models: Annotated[tuple[str, ...], MinLen(1)] = ("rules",)
    """Models for the agents that use one."""
    tasks: Annotated[tuple[str, ...], Option(default="all")] = ()
    """Ids, patterns such as `hvac_*`, tags, modules, dimensions, subsets, abilities, `general`, `safety` or `all`;
    none beside drives and trials unless given."""
    suite: Annotated[str, OneOf(SUITES, "suite")] = str(Suite.STANDARD)
    """The suite they are chosen from: `standard`, `hard`, `limits`, `clarify` or `all`. An id selects a task in any
    suite."""
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
    """Say each repeat of a task in another phrasing, with other people, places and music in the car; the rest of
    the instance stays."""
    held_out: bool = False
    """Use only each task's held-out phrasing, which `rules` is not built from; otherwise any phrasing is drawn."""
    split: Annotated[str, OneOf(SPLITS, "split")] = BOTH
    """Only the episodes of one public split, by seed and phrasing: `dev` or `test`; `both` for all."""
