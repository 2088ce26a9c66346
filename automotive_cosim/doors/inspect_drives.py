"""The drives for Inspect (``inspect eval automotive_cosim/drives``): one sample per family and seed.

A sample's scores are the figures of its drive; over all samples they are those of the report, drives added up, with
the same intervals from resampling whole drives.
"""

# pyright: reportMissingImports=false
from __future__ import annotations

import math
from collections.abc import Sequence

from inspect_ai import Task, task
from inspect_ai.dataset import MemoryDataset, Sample
from inspect_ai.scorer import Metric, SampleScore, Score, Scorer, Target, metric, scorer
from inspect_ai.solver import Generate, Solver, TaskState, solver

from automotive_cosim.contracts import Json
from automotive_cosim.doors.inspect_play import outcome_of, played, seeds_of, words
from automotive_cosim.doors.shared import conditions_of, takes_conditions
from automotive_cosim.drives.result import DriveOutcome
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.report.drives import FIGURES, WITH_INTERVAL, interval
from automotive_cosim.run.row import from_json
from automotive_cosim.run.watch import WatchSetup, judged_row, planned_row
from automotive_cosim.run.watch_row import WatchRow
from automotive_cosim.run.watches import families_named

INSTRUCTIONS = """\
You operate the touch screen and the safety functions of a car for its driver, while it drives through live traffic.
Act with the tool `act`, one action at a time; every action takes time while the car drives on. Do only what serves
the driver; touch nothing else. Nothing ends the drive but its time: go on acting, with `wait` where nothing has to
be done, until `end` is not null."""
SCORES = {
    name.lower().replace(" %", "_percent").replace("/", "_per_").replace(" ", "_"): figure
    for name, figure, _ in FIGURES[:WITH_INTERVAL]
}
"""The figures of the report that have intervals."""


@takes_conditions
def _drives(
    families: str | list[str] = "all",
    seeds: int | str | list[int] = 0,
    pictures: bool = True,
    **conditions: str,
) -> Task:
    """Drives of ten to thirty minutes, on which the model keeps watch.

    Args:
        families: of drives, patterns, scenarios, seasons or ``all``, separated by commas.
        seeds: one, or several separated by commas; each draws its own drive.
        pictures: whether it sees the screen.
        conditions: ``geo``, ``see`` and so on, as in ``automotive-cosim run``.
    """
    conditions_of(conditions)
    samples = [
        Sample(
            id=f"{family}-seed{seed}",
            input="The driver speaks at departure.",
            metadata={"family": family, "seed": seed, "conditions": conditions},
        )
        for family in families_named(tuple(words(families)))
        for seed in seeds_of(seeds)
    ]
    return Task(dataset=MemoryDataset(samples), solver=watcher(pictures), scorer=watched())


def _watcher(pictures: bool = True) -> Solver:
    """Plays a sample's drive. A model that stops acting, or meets a limit, leaves the rest of it to itself."""

    async def solve(state: TaskState, generate: Generate) -> TaskState:
        return await played(state, generate, _spec(state.metadata), INSTRUCTIONS, pictures)

    return solve


def _spec(named: Json) -> DriveSpec:
    return DriveSpec(named["family"], named["seed"], conditions_of(named["conditions"]))


def _figure(name: str) -> Metric:
    """A figure of all drives together, and its interval if there are enough of them."""

    def computed(scores: Sequence[SampleScore]) -> dict[str, str | int | float | bool]:
        rows = [_row(score.score.metadata or {}) for score in scores]
        value = SCORES[name](rows) if rows else None
        bounds = interval(rows, SCORES[name])
        found: dict[str, str | int | float | bool] = {"value": math.nan if value is None else value}
        return found if bounds is None else found | {"low": bounds.low, "high": bounds.high}

    return computed


figure = metric(name="figure", scores="unreduced")(_figure)


def _watched() -> Scorer:
    """The figures of one drive: score, recall, precision, false alarms and nuisances."""

    async def score(state: TaskState, target: Target) -> Score:
        stored = outcome_of(state)
        row = _row(stored)
        values = {name: of([row]) for name, of in SCORES.items()}
        return Score(
            value={name: math.nan if value is None else value for name, value in values.items()},
            explanation="\n".join(f"{event.outcome}: {event.words}" for event in row.events),
            metadata=stored,
        )

    return score


def _row(stored: Json) -> WatchRow:
    """A sample's drive as a row of an evaluation."""
    outcome = from_json(DriveOutcome, stored)
    planned = planned_row(outcome.episode_id, WatchSetup(outcome.family, outcome.seed))
    return judged_row(planned, outcome.end, (), outcome.result)


watched = scorer(metrics={name: [figure(name)] for name in SCORES}, name="watched")(_watched)
watcher = solver(name="watcher")(_watcher)
drives = task(name="drives")(_drives)
