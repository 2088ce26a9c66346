"""Runs points as trials of an evaluation whose plan grows; whatever reads an evaluation reads a search's folder."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import ExitStack, contextmanager, nullcontext, suppress
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from automotive_cosim.errors import BudgetSpentError, UserError
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.toml import dotted
from automotive_cosim.run import worker
from automotive_cosim.run.batch import Progress, is_open, run_jobs, spent_before
from automotive_cosim.run.executor import Executor, Opener, Runner
from automotive_cosim.run.plan import Plan, PlannedTrial
from automotive_cosim.run.processes import Here, Processes
from automotive_cosim.run.rows import TrialRow, kind_of
from automotive_cosim.run.settings import Budget, Pictures
from automotive_cosim.run.store import Store, opened, replan
from automotive_cosim.run.trial import TrialSetup
from automotive_cosim.safety.budget import SearchBudget, SearchLimit
from automotive_cosim.safety.objective import TriedOutcome, outcome_of
from automotive_cosim.safety.space import CONDITIONS, SETTINGS, FactorChoices, SearchPoint, Space
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations


def trial_of(point: SearchPoint, repeat: int = 0) -> PlannedTrial:
    """The trial at a point. Raises UserError: a value does not exist."""
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
    """Tries every value, each with all other factors at nominal. Raises UserError: a value does not exist."""
    for factor in space.factors:
        ends = factor.values if isinstance(factor, FactorChoices) else (factor.least, factor.most)
        for value in ends:
            trial_of({**space.nominal, factor.name: value})
            if factor.name == "scenario" and value:
                open_scenario(str(value))
    job_of(plan, trial_of(space.nominal))


def job_of(plan: Plan, trial: PlannedTrial) -> TrialSetup:
    """The job of a trial for the plan's agent. Raises UserError: it cannot be run."""
    if trial.task and trial.scenario and trial.scenario not in CATALOGUE[trial.task].runs_in:
        raise UserError(f"{trial.task} cannot run in {trial.scenario}")
    return trial.job(plan.agents[0], plan.models[0], 0, plan.limits, plan.spare_traffic)


@dataclass(slots=True)
class Trying:
    """Runs points into an open folder; what it already holds is not run again."""

    plan: Plan
    store: Store[TrialRow]
    runner: Runner[TrialSetup, TrialRow]
    space: Space
    limit: SearchLimit
    executor: Executor
    ran: int = 0
    """Trials since this start."""
    stop: str = ""
    """Why nothing more is run, although the budget lasts; empty while it may be."""
    tell: Callable[[TrialRow], None] = lambda row: None

    def __call__(self, point: SearchPoint, repeat: int) -> TriedOutcome:
        """What comes of a point.

        Raises BudgetSpentError: nothing more may be run, or its model asked; it counts as not run."""
        trial = trial_of(point, repeat)
        try:
            job = job_of(self.plan, trial)
        except UserError as error:
            return TriedOutcome(None, False, error=f"cannot be run: {error}")
        if is_open(self.store.rows.get(job.id)):
            if self.stop:
                raise BudgetSpentError(self.stop)
            ended = self._run([(job, trial)], Here(), lambda: nullcontext(self.runner))
            if ended.stopped:
                raise BudgetSpentError(ended.stopped)
        self._add(trial)
        return outcome_of(self.store.rows[job.id], self.space.rule)

    def ahead(self, points: Iterable[SearchPoint]) -> None:
        """Runs points at the same time that will be asked for one by one; those that cannot be run are left out.

        Raises:
            as ``run.batch.run_jobs``.
        """
        tries: dict[str, tuple[TrialSetup, PlannedTrial]] = {}
        for point in points:
            with suppress(UserError):
                trial = trial_of(point)
                job = job_of(self.plan, trial)
                tries[job.id] = job, trial
        self._run(tries.values(), self.executor, partial(worker.trials, Pictures.NONE, self.limit.meter))

    def _run(
        self,
        tries: Collection[tuple[TrialSetup, PlannedTrial]],
        executor: Executor,
        opener: Opener[TrialSetup, TrialRow],
    ) -> Progress[TrialRow]:
        trials = {job.id: trial for job, trial in tries}

        def ended(progress: Progress[TrialRow]) -> None:
            if progress.ended is not None:
                self._add(trials[progress.ended.id])
                self.ran += 1
                self.tell(progress.ended)

        jobs = [job for job, _ in tries]
        return run_jobs(jobs, self.store, opener, executor=executor, retries=1, limit=self.limit, tell=ended)

    def _add(self, trial: PlannedTrial) -> None:
        if trial not in self.plan.trials:
            self.plan = replace(self.plan, trials=(*self.plan.trials, trial))
            replan(self.store.folder, self.plan.as_json(), len(self.plan.trials))


@contextmanager
def trying(
    space: Space,
    plan: Plan,
    folder: Path,
    runner: Runner[TrialSetup, TrialRow] | None = None,
    *,
    executor: Executor = Processes(),  # noqa: B008, frozen
    budget: SearchBudget = SearchBudget(),  # noqa: B008, frozen
    used_s: float = 0.0,
    simulations: Simulations | None = None,
) -> Iterator[Trying]:
    """Opens a folder, new or to be resumed.

    Args:
        plan: the agent, its model and limits.
        runner: runs a trial; None runs it with the agent of its name.
        executor: where trials run that do not depend on each other; it has been entered.
        budget: what may be used, with earlier starts.
        used_s: wall time of earlier starts.
        simulations: warm traffic, shared with others; None for its own.

    Raises UserError: it cannot be written, or holds something else."""
    with ExitStack() as ends:
        store = ends.enter_context(opened(folder, plan.as_json(), kind_of, planned=0, grows=True))
        meter = ends.enter_context(executor.metered(Budget(usd=budget.usd), spent_before(store)))
        began_s = time.monotonic()
        limit = SearchLimit(budget, meter, lambda: used_s + time.monotonic() - began_s)
        own = runner or ends.enter_context(worker.trials(Pictures.NONE, meter, simulations))
        yield Trying(plan, store, own, space, limit, executor)
