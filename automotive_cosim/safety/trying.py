"""Runs points as trials of an evaluation whose plan grows; whatever reads an evaluation reads a search's folder."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from automotive_cosim.errors import UserError
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.toml import dotted
from automotive_cosim.run import worker
from automotive_cosim.run.batch import FINAL_KINDS, run_jobs
from automotive_cosim.run.collect import Pictures
from automotive_cosim.run.executor import Executor, Runner
from automotive_cosim.run.jobs import TrialJob, failed
from automotive_cosim.run.plan import Plan, PlannedTrial
from automotive_cosim.run.rows import kind_of
from automotive_cosim.run.store import Store, opened, replan
from automotive_cosim.run.trial_row import TrialRow
from automotive_cosim.safety.objective import TriedOutcome, outcome_of
from automotive_cosim.safety.space import CONDITIONS, SETTINGS, FactorChoices, SearchPoint, Space
from automotive_cosim.scenery import open_scenario
from automotive_cosim.tasks import CATALOGUE


def trial_of(point: SearchPoint, repeat: int = 0) -> PlannedTrial:
    """The trial at a point.

    Raises:
        UserError: a value does not exist.
    """
    values: dict[str, Any] = {"repeat": repeat, "conditions": {}, "settings": {}}
    for name, value in point.items():
        if name in CONDITIONS:
            values["conditions"][name] = value
        elif name in SETTINGS:
            values["settings"][name] = value
        else:
            values[name] = int(value) if name == "seed" else value
    return checked(PlannedTrial, values, lambda steps: ("the space", dotted(steps)))


def check_space(space: Space, plan: Plan) -> None:
    """Tries every value, each with all other factors at nominal.

    Raises:
        UserError: a value does not exist.
    """
    for factor in space.factors:
        ends = factor.values if isinstance(factor, FactorChoices) else (factor.least, factor.most)
        for value in ends:
            trial_of({**space.nominal, factor.name: value})
            if factor.name == "scenario" and value:
                open_scenario(str(value))
    job_of(plan, trial_of(space.nominal))


def job_of(plan: Plan, trial: PlannedTrial) -> TrialJob:
    """The job of a trial for the plan's agent.

    Raises:
        UserError: it cannot be run.
    """
    if trial.task and trial.scenario and trial.scenario not in CATALOGUE[trial.task].runs_in:
        raise UserError(f"{trial.task} cannot run in {trial.scenario}")
    return trial.job(plan.agents[0], plan.models[0], 0, plan.limits, plan.spare_traffic)


@dataclass(slots=True)
class Trying:
    """Runs points into an open folder; what it already holds is not run again."""

    plan: Plan
    store: Store[TrialRow]
    runner: Runner[TrialJob, TrialRow]
    space: Space
    ran: int = 0
    """Trials since this start."""
    tell: Callable[[TrialRow], None] = lambda row: None

    def __call__(self, point: SearchPoint, repeat: int) -> TriedOutcome:
        """What comes of a point."""
        trial = trial_of(point, repeat)
        try:
            job = job_of(self.plan, trial)
        except UserError as error:
            return TriedOutcome(None, False, error=f"cannot be run: {error}")
        row = self.store.rows.get(job.id)
        if row is None or (row.error is not None and row.error_kind not in FINAL_KINDS):
            self._add(trial)
            row = self.runner(job, self.store.folder)
            if row.error is not None and row.error_kind not in FINAL_KINDS:
                row = replace(self.runner(job, self.store.folder), attempts=2)
            self.store.append(row)
            self.ran += 1
            self.tell(row)
        elif trial not in self.plan.trials:
            self._add(trial)
        return outcome_of(row, self.space.rule)

    def ahead(self, points: Iterable[SearchPoint], executor: Executor) -> None:
        """Runs points at the same time that will be asked for one by one; those that cannot be run are left out.

        Raises:
            as ``run.batch.run_jobs``.
        """
        jobs = {}
        for point in points:
            with suppress(UserError):
                trial = trial_of(point)
                job = job_of(self.plan, trial)
                jobs[job.id] = job
                self._add(trial)
        with executor:
            run_jobs(
                list(jobs.values()),
                self.store,
                partial(worker.trials, Pictures.NONE),
                failed,
                executor=executor,
                tell=lambda progress: None if progress.ended is None else self.tell(progress.ended),
            )

    def _add(self, trial: PlannedTrial) -> None:
        if trial not in self.plan.trials:
            self.plan = replace(self.plan, trials=(*self.plan.trials, trial))
            replan(self.store.folder, self.plan.as_json(), len(self.plan.trials))


@contextmanager
def trying(
    space: Space, plan: Plan, folder: Path, runner: Runner[TrialJob, TrialRow] | None = None
) -> Iterator[Trying]:
    """Opens a folder, new or to be resumed.

    Args:
        space: what is searched.
        plan: the agent, its model and limits.
        folder: where the trials are kept.
        runner: runs a trial; None runs it with the agent of its name.

    Raises:
        UserError: it cannot be written, or holds something else.
    """
    with ExitStack() as ends:
        store = ends.enter_context(opened(folder, plan.as_json(), kind_of, planned=0, grows=True))
        own = runner or ends.enter_context(worker.trials(Pictures.NONE))
        yield Trying(plan, store, own, space)
