"""Deals a study's episodes to people: who plays what, and in what order.

Everyone plays every half of every task with every seed, in two rounds; a pair has one half in each. In a round,
the order is a row of a Williams design: over n people for n tasks (2n if n is odd), every task takes every position
equally often, and follows every other task equally often. ``order_seed`` shuffles the tasks, and the people
who meet the first half of a pair first. Nobody gets both halves of a pair in a row.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
from annotated_types import Ge, Le, MinLen

from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats.toml import read_toml
from automotive_cosim.run.choosing import choose
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.plan import Plan
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.serve.played import check_code_name, people_plan

MOST_PEOPLE = 100


@dataclass(frozen=True, slots=True)
class PeoplePlan:
    """The content of a study's TOML file."""

    people: Annotated[tuple[str, ...], MinLen(1)]
    """Code names of the people who take part."""
    tasks: Annotated[tuple[str, ...], MinLen(1)]
    """Ids, patterns, tags and so on of tasks, as in ``plan.toml``."""
    seeds: Annotated[tuple[Annotated[int, Ge(0), Le(2**31 - 1)], ...], MinLen(1)] = (0,)
    """Seeds; everyone plays every task with each seed."""
    order_seed: Annotated[int, Ge(0), Le(2**31 - 1)] = 0
    """Seed of the orders."""
    scenario: str | None = None
    """Scenario to use instead of the tasks' own."""
    detection: bool = False
    """Whether people also answer a red dot every few seconds (``serve.detection``)."""

    def check(self) -> None:
        """Checks what is to be dealt.

        Raises UserError: a code name is invalid or given twice, there is no such task, or there is too little to
        deal."""
        for name in self.people:
            check_code_name(name)
        if len(set(self.people)) < len(self.people) or len(self.people) > MOST_PEOPLE:
            raise UserError(f"people must be up to {MOST_PEOPLE} different code names")
        if self.scenario is not None:
            open_scenario(self.scenario)
        jobs = self.jobs()
        units = {_unit(job) for job in jobs}
        if len(units) < 2 and any(job.entry.second for job in jobs):
            raise UserError("a single pair would be dealt with both halves in a row; add another task or seed")
        if not units:
            raise UserError(f"none of these tasks runs in {self.scenario}; choose other tasks or another scenario")

    @property
    def plan(self) -> Plan:
        """The same as an evaluation of the agent ``human``."""
        return people_plan(choose(self.tasks), self.people, sorted(set(self.seeds)), scenario=self.scenario)

    def as_json(self) -> Json:
        """As every report reads it."""
        return self.plan.as_json()

    def jobs(self) -> Sequence[EpisodeSetup]:
        """Every episode of everybody."""
        return self.plan.episodes()

    def orders(self) -> Mapping[str, tuple[EpisodeSetup, ...]]:
        """What each person plays, in order."""
        return deal(self.jobs(), self.people, self.order_seed)


def read_study(path: Path) -> PeoplePlan:
    """A study's plan from its file. Raises UserError: it cannot be read, or does not fit."""
    return read_toml(path).read(PeoplePlan)


def deal(
    jobs: Sequence[EpisodeSetup], people: Sequence[str], order_seed: int
) -> Mapping[str, tuple[EpisodeSetup, ...]]:
    """What each person plays, in order.

    Args:
        jobs: of a plan for these people.
        order_seed: the same seed deals the same."""
    halves: dict[tuple[str, str, int], list[str]] = {}
    found = {}
    for job in jobs:
        found[job.model, _unit(job), job.half] = job
        if job.half not in halves.setdefault(_unit(job), []):
            halves[_unit(job)].append(job.half)
    units = sorted(halves)
    np.random.default_rng([order_seed, 0]).shuffle(units)
    turned = {unit: _half_of_them(len(people), order_seed, number) for number, unit in enumerate(units, 1)}
    dealt = {}
    for number, name in enumerate(people):
        row = [units[each] for each in williams(len(units), number)]
        rounds: tuple[list[tuple[str, str, int]], ...] = ([], [])
        for place, unit in enumerate(row):
            if len(halves[unit]) == 2:
                rounds[0].append(unit)
                rounds[1].append(unit)
            else:
                rounds[(place + number) % 2].append(unit)
        first, second = _parted(*rounds)
        dealt[name] = tuple(
            found[name, unit, sorted(halves[unit])[(turn + turned[unit][number]) % len(halves[unit])]]
            for turn, units_of_round in enumerate((first, second))
            for unit in units_of_round
        )
    return dealt


def williams(count: int, row: int) -> tuple[int, ...]:
    """A row of a Williams design: an order of the numbers below ``count``."""
    zigzag = [(place + 1) // 2 if place % 2 else (count - place // 2) % count for place in range(count)]
    order = tuple((each + row) % count for each in zigzag)
    return order[::-1] if count % 2 and (row // count) % 2 else order


def _parted(
    first: list[tuple[str, str, int]], second: list[tuple[str, str, int]]
) -> tuple[list[tuple[str, str, int]], ...]:
    """Both rounds, changed if the second would begin with what the first ends with."""
    if first and second and first[-1] == second[0]:
        if len(second) > 1:
            second = [*second[1:], second[0]]
        else:
            first = [first[-1], *first[:-1]]
    return first, second


def _half_of_them(people: int, order_seed: int, unit: int) -> list[int]:
    """0 or 1 for each person, in equal numbers or differing by one."""
    drawn = [number % 2 for number in range(people)]
    np.random.default_rng([order_seed, unit]).shuffle(drawn)
    return drawn


def _unit(job: EpisodeSetup) -> tuple[str, str, int]:
    """What both halves of a pair share."""
    return job.task, job.scenario or "", job.seed
