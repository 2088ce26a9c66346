"""``automotive-cosim search``: searches a space for failures of an agent; rerun the command to resume."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from contextlib import closing
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from automotive_cosim.cli.batches import (
    EXECUTORS,
    ExecutorSettings,
    check_prices,
    forecast_in_words,
    minutes_in_words,
)
from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import AgentName, ModelName, print_json, tells_json
from automotive_cosim.contracts.plain import clock, counted
from automotive_cosim.errors import UserError
from automotive_cosim.safety.settings import SearchOrder, SearchSettings

if TYPE_CHECKING:
    from automotive_cosim.cli.console import Console as Output
    from automotive_cosim.contracts import Json
    from automotive_cosim.run.plan import Plan
    from automotive_cosim.run.rows import TrialRow
    from automotive_cosim.safety.budget import SearchBudget
    from automotive_cosim.safety.hunt import Hunt, MinimalFailure
    from automotive_cosim.safety.space import Space
    from automotive_cosim.traffic.fork import Simulations

TELL_S = 60.0
"""Wall time without a new point after which the runs are told: a failure is repeated and reduced meanwhile."""
CAREFUL = ("rule-perfect", "oracle")
"""The references on drives and on tasks."""
CAREFUL_FOLDER = "careful"
"""Of a search's folder: its evaluation of the reference at the minimal failures."""
SETTINGS = "search.json"
"""File of a search's folder with what it was started with."""


@tells_json
@takes(SearchOrder)
@takes(SearchSettings)
@takes(ExecutorSettings)
def search(agent: AgentName, model: ModelName = "rules", as_json: bool = False, **settings: Any) -> None:
    """Search a space of situations and conditions for failures of an agent. Rerun the command to resume.

    Combinations that are spread evenly run in parallel, or on a cluster; what is learnt from them runs here, one
    by one. After Ctrl-C the page has what was found by then."""
    from automotive_cosim.cli.console import Console
    from automotive_cosim.formats.writing import write_whole
    from automotive_cosim.report.stats import distributions
    from automotive_cosim.run.plan import make_plan
    from automotive_cosim.run.settings import Budget
    from automotive_cosim.run.worker import WARM
    from automotive_cosim.safety.budget import LAID, SearchBudget, progress_in_words
    from automotive_cosim.safety.due import DueScreen, with_times
    from automotive_cosim.safety.findings import as_json as findings_json
    from automotive_cosim.safety.hunt import blame, hunt, try_carefully
    from automotive_cosim.safety.page import regression_plan, write_findings
    from automotive_cosim.safety.samplers import even_points, make_sampler
    from automotive_cosim.safety.space import read_space, space_file
    from automotive_cosim.safety.trying import check_space, trial_of, trying
    from automotive_cosim.traffic.fork import Simulations

    order, how = filled(SearchOrder, settings), filled(SearchSettings, settings)
    choice = filled(ExecutorSettings, settings)
    file, may_use = space_file(order.space), SearchBudget.read(order.budget)
    if how.sampler in ("lhs", "grid") and may_use.points is None:
        raise UserError(
            f"the sampler {how.sampler} is laid out for a number of combinations; give one, as in --budget 64,2h"
        )
    check_prices((model,), Budget(usd=may_use.usd))
    if may_use.points is may_use.hours is None and model.startswith(("rules", "replay/")):
        raise UserError(
            f"{model} costs nothing, so that {order.budget} never ends; give combinations or hours, as in "
            f"64,{order.budget}"
        )
    distributions()  # without which the findings cannot be told, after all runs
    space = with_times(read_space(file))
    plan = make_plan({"agents": [agent], "models": [model], "trials": [_plain(trial_of(space.nominal))]})
    plan.check()
    check_space(space, plan)
    folder = order.out or Path("runs") / f"search-{file.stem}-{agent.replace(':', '.')}"
    console = Console(highlight=False)
    about: Json = {"space": file.read_text(encoding="utf-8"), "agent": agent, "model": model, **asdict(how)}
    laid, used_s = _before(folder, about, may_use.points or LAID)
    make_sampler(how.sampler, space, laid, how.seed)  # which may need what is not installed
    where = choice.opened()
    is_parallel = choice.executor != EXECUTORS[0] or choice.processes > 1
    for line in _told_before(space, plan, may_use, how.failures, choice.processes if is_parallel else 1, folder):
        console.print(line, soft_wrap=True)
    if order.dry_run:
        with closing(Simulations(count_limit=WARM)) as simulations:
            for line in DueScreen(space, plan, simulations, folder).check():
                console.print(line, markup=False, soft_wrap=True)
        console.print("no agent was asked")
        if as_json:
            print_json({"out": str(folder), "dry_run": True})
        return

    said_s = time.monotonic()

    def tell(found: Hunt) -> None:
        nonlocal said_s
        said_s = time.monotonic()
        last = found.samples[-1].outcome
        if last.is_unrunnable:
            return
        margin = "nothing was due" if last.nothing_due else "not judged"
        margin = margin if last.margin is None else f"margin {last.margin:+.2f}"
        now_s = run.limit.used_s()
        each_s = (now_s - used_s) / run.ran if run.ran else 0.0
        told = progress_in_words(may_use, found.run, now_s, each_s)
        console.print(f"{told}; {margin}; {counted(len(found.minimal), 'minimal failure')}", soft_wrap=True)

    with (
        closing(Simulations(count_limit=WARM)) as simulations,
        where,
        trying(space, plan, folder, executor=where, budget=may_use, used_s=used_s, simulations=simulations) as run,
    ):

        def note(row: TrialRow | None = None) -> None:
            nonlocal said_s
            if row is not None and time.monotonic() - said_s >= TELL_S:
                said_s, used = time.monotonic(), clock(run.limit.used_s())
                console.print(f"{counted(run.ran, 'run')} in {used}; still at the same combination", soft_wrap=True)
            noted = about | {"budget": laid, "used_s": round(run.limit.used_s(), 1)}
            write_whole(folder / SETTINGS, json.dumps(noted, indent=1))

        note()
        run.tell = note
        screen = DueScreen(space, plan, simulations, folder)
        for line in screen.check():
            console.print(line, markup=False, soft_wrap=True)
        run.space = space = screen.space
        chooses = make_sampler(how.sampler, space, laid, how.seed)
        if is_parallel and not run(space.nominal, 0).error:
            try:
                ahead = even_points(
                    make_sampler(how.sampler, space, laid, how.seed), min(laid, may_use.most_points)
                )
                run.ahead(filter(None, map(screen.placed, ahead)))
            except KeyboardInterrupt:
                run.stop = "interrupted"
        most = may_use.most_points
        found = hunt(space, run, chooses, most, most_failures=how.failures, place=screen.placed, tell=tell)
        found.interrupted |= bool(run.stop)
        if found.minimal and agent not in CAREFUL and not found.interrupted:
            careful = make_plan({"agents": [CAREFUL["task" in space.nominal]], "trials": plan.as_json()["trials"]})
            try:
                with trying(space, careful, folder / CAREFUL_FOLDER, simulations=simulations) as watcher:
                    try_carefully(found, watcher)
            except KeyboardInterrupt:
                found.interrupted = True
        try:
            if not found.interrupted:
                blame(found, lambda failure: _act(folder, failure, space, simulations))
        except KeyboardInterrupt:
            found.interrupted = True
        note()
        page = write_findings(folder, found, agent, model, about)
    if order.save is not None and (found.minimal or found.not_reduced):
        write_whole(order.save, regression_plan(found, agent, model))
    elif order.save is not None:
        typer.echo(f"no failure was found, so nothing is saved in {order.save}", err=True)
    if as_json:
        print_json(findings_json(found) | {"out": str(folder)})
    else:
        _tell_found(console, found, agent, page)
    if found.interrupted:
        raise KeyboardInterrupt
    if order.at_most is not None and (many := too_many(found, order.at_most)):
        typer.echo(many, err=True)
        raise typer.Exit(1)


def _act(folder: Path, failure: MinimalFailure, space: Space, simulations: Simulations) -> str:
    """The act, or the missing act, that made a failure."""
    from automotive_cosim.errors import CosimError
    from automotive_cosim.run.attribution import attribute, culprit, path_of, read_effects

    try:
        known = read_effects(path_of(folder, failure.trial))
        return culprit(known or attribute(folder, failure.trial, simulations=simulations), space.rule.events)
    except CosimError as error:
        return f"not known: {error}"


def too_many(found: Hunt, at_most: int) -> str:
    """Why a search is not passed if so many samples may fail; empty if it is."""
    from automotive_cosim.safety.findings import judged

    samples = judged(found.samples)
    failed = sum(each.outcome.failed for each in samples)
    if any(not each.changed for each in found.minimal):
        return "it fails with everything nominal"
    if not samples:
        return "nothing was due in any run, so that nothing is known"
    return (
        f"{failed} of {counted(len(samples), 'run')} in which something was due failed, more than {at_most}"
        if failed > at_most
        else ""
    )


def _tell_found(console: Output, found: Hunt, agent: str, page: Path) -> None:
    from automotive_cosim.safety.findings import sentence

    console.print(sentence(found, agent), soft_wrap=True)
    if found.interrupted:
        console.print("Interrupted; rerun the command to go on.", soft_wrap=True)
    elif found.stopped:
        console.print(f"Stopped: {found.stopped}; rerun with a larger --budget to go on.", soft_wrap=True)
    for count, each in enumerate(found.minimal, 1):
        near = f"; {each.beside}" if each.beside else ""
        told = f"{count}. fails with {each.words(found.space)}{near} [{each.why}]"
        console.print(f"{told}: {each.act}" if each.act else told, markup=False, soft_wrap=True)
    console.print(f"Report: {page}", soft_wrap=True)


def _told_before(
    space: Space, plan: Plan, may_use: SearchBudget, failures: int, workers: int, folder: Path
) -> Iterator[str]:
    """What the search will take, as far as it is known before it starts."""
    from automotive_cosim.report.charts import NEEDS, is_installed
    from automotive_cosim.run.rows import read_trials
    from automotive_cosim.safety.forecast import RUNS_A_FAILURE, of_a_failure, search_forecast

    if may_use.hours is not None:
        minutes = counted(round(60 * may_use.hours), "minute")
        yield f"{minutes} at most, with earlier starts: no run begins after that"
    if may_use.points is None:
        yield f"as many combinations as the budget allows; results in {folder}"
    else:
        known = len(read_trials(folder)) if (folder / "manifest.json").is_file() else 0
        needs = search_forecast(space, plan, max(0, may_use.points - known), workers)
        yield f"{counted(may_use.points, 'combination')} to try; results in {folder}" + (
            f", where {counted(known, 'run')} are" if known else ""
        )
        yield from forecast_in_words(needs, workers)
        if failures:
            yield (
                f"in addition, for each of up to {counted(failures, 'failure')}: some {RUNS_A_FAILURE} runs, "
                f"{minutes_in_words(of_a_failure(needs))}; --failures 0 leaves them as they are"
            )
    if not is_installed():
        yield f"the page will have no response curves: {NEEDS}"


def _before(folder: Path, about: Json, points: int) -> tuple[int, float]:
    """The number of points that the sampler was first laid out for, and the seconds that earlier starts took.

    Raises UserError: the folder's search was started with something else."""
    from automotive_cosim.formats.files import read_json

    path = folder / SETTINGS
    if not path.is_file():
        return points, 0.0
    try:
        before: Json = dict(read_json(path))
        laid, used_s = int(before.pop("budget")), float(before.pop("used_s", 0.0))
    except (LookupError, TypeError, ValueError) as error:
        raise UserError(f"cannot read {path}: {error}; give --out another folder") from error
    changed = sorted(name for name in about if before.get(name) != about[name])
    if changed:
        raise UserError(f"{folder} was started with a different {', '.join(changed)}; give --out another folder")
    return laid, used_s


def _plain(trial: object) -> Json:
    from automotive_cosim.run.job_row import as_json

    return as_json(trial)
