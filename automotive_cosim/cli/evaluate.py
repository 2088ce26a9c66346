"""``automotive-cosim eval``: runs a plan of episodes in parallel; rerun the command to resume."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from automotive_cosim.cli.batches import (
    ExecutorSettings,
    ProgressView,
    check_prices,
    forecast_in_words,
    tell_notes,
    tell_stopped,
)
from automotive_cosim.cli.conditions import takes_conditions, values_of
from automotive_cosim.cli.derived import filled, settings_in, takes
from automotive_cosim.cli.options import DriveChanges, LimitSettings, Most, TasksFrom, print_json, tells_json
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted, megabytes_in_words, model_and_options
from automotive_cosim.episode.conditions import TABLE, lists_of
from automotive_cosim.errors import InfrastructureError, UserError, install_hint
from automotive_cosim.run.settings import HIDDEN, Budget, EvaluationSettings, RunSettings

if TYPE_CHECKING:
    from automotive_cosim.cli.console import Console
    from automotive_cosim.report.results import Results
    from automotive_cosim.run.batch import Progress
    from automotive_cosim.run.plan import Plan
    from automotive_cosim.run.rows import TrialRow


@tells_json
@takes_conditions(lists=True)
@takes(EvaluationSettings, but=[each.name for each in TABLE])
@takes(ExecutorSettings)
@takes(RunSettings)
@takes(Budget)
@takes(DriveChanges)
def evaluate(most: Most = None, tasks_from: TasksFrom = None, as_json: bool = False, **settings: Any) -> None:
    """Run agents over tasks, scenarios and seeds, or over drives.

    Rerun the command to resume."""
    from automotive_cosim.cli.console import Console
    from automotive_cosim.report.answer import agents_as_json, answer
    from automotive_cosim.report.charts import is_installed
    from automotive_cosim.report.drives import standings as drive_standings
    from automotive_cosim.report.results import read_results, standings
    from automotive_cosim.run.batch import run_plan
    from automotive_cosim.run.coverage import unit_of
    from automotive_cosim.run.forecast import forecast
    from automotive_cosim.run.hidden import COMMITTED, commitment, drawn, read_key
    from automotive_cosim.run.model_check import misfits
    from automotive_cosim.run.plan import make_plan, read_plan
    from automotive_cosim.run.rows import read_trials
    from automotive_cosim.run.store import megabytes
    from automotive_cosim.scenarios import open_scenario

    running = filled(RunSettings, settings)
    values: dict[str, Any] = read_plan(running.plan) if running.plan else {}
    values |= settings_in(EvaluationSettings, settings) | values_of(settings)
    told = settings_in(DriveChanges, settings)
    values |= {"settings": {**values.get("settings", {}), **told}} if told else {}
    own = limits_told(most or LimitSettings())
    values |= {"limits": {**values.get("limits", {}), **own}} if own else {}
    budget = filled(Budget, settings)
    plan = make_plan(values)
    committed: Json = {}
    if running.key is not None:
        key = read_key(running.key)
        plan = drawn(plan, key)
        committed = dict(zip(COMMITTED, commitment(key, plan), strict=True))
    elif plan.split == HIDDEN:
        raise UserError(f"--split {HIDDEN} is drawn from a key; give --key FILE")
    folder = running.out or _folder(plan)
    choice = filled(ExecutorSettings, settings)
    where = choice.opened()
    console = Console(highlight=False)
    lacks, unit = plan.check(dry=running.dry_run), unit_of(plan.as_json())
    check_prices(plan.models, budget)
    tell_notes(map(open_scenario, plan.scenarios))
    _announce(console, plan, folder)
    for name, digest in committed.items():
        console.print(f"{name} {digest}", soft_wrap=True, highlight=False)
    known = read_trials(folder) if (folder / "manifest.json").is_file() else {}
    needs = forecast(plan.jobs(), choice.processes, known.values())
    if running.dry_run:
        lacks = (*lacks, *filter(None, [needs.beyond(budget)]))
        for line in (*forecast_in_words(needs, choice.processes), "nothing was run"):
            console.print(line, soft_wrap=True)
        for lack in lacks:
            console.print(f"to fix before it can run: {lack}", soft_wrap=True, markup=False)
        if as_json:
            print_json({**needs.as_json(), **committed, "to_fix": lacks, "out": str(folder)})
        return
    left = [job for job in plan.jobs() if job.id not in known or known[job.id].error is not None]
    if unfit := tuple(misfits(left)):
        raise UserError("; ".join(unfit))
    for line in forecast_in_words(needs, choice.processes, budget) if left else ():
        console.print(line, soft_wrap=True)
    with where, ProgressView(console, f"{unit}s", _said, needs.wall_s) as view:
        try:
            end = run_plan(
                plan,
                folder,
                executor=where,
                retries=running.retries,
                pictures=running.kept(len(plan.jobs())),
                budget=budget,
                tell=view.tell,
            )
        except KeyboardInterrupt:
            reached = f" ({read_results(folder).coverage})" if (folder / "manifest.json").is_file() else ""
            typer.echo(f"finished {unit}s are in {folder}{reached}; rerun the command to resume", err=True)
            raise
    found = read_results(folder)
    errors = [row for row in (*found.rows, *found.drives) if row.error is not None]
    size_mb = megabytes(folder)
    if as_json:
        counts = {"planned": end.planned, "judged": end.judged, "successes": end.successes, "errors": end.errors}
        made = {"ran": end.ran, "megabytes": round(size_mb, 1), "out": str(folder)}
        broken = {"agent_failures": list(_failures((*found.rows, *found.drives)))}
        print_json(
            {**counts, **committed, **made, "answer": answer(found), "agents": agents_as_json(found), **broken}
        )
    else:
        console.print(answer(found), soft_wrap=True, style="bold")
        console.print(f"{end.successes:,} succeeded; {found.coverage}")
        for line in (*standings(found), *drive_standings(found.drives)):
            console.print(f"  {line}", soft_wrap=True)
        for line in _failures((*found.rows, *found.drives)):
            console.print(f"  {line}", soft_wrap=True, markup=False)
        for row in errors:
            console.print(f"  error in {row.id}: {row.error_kind}: {row.error}", soft_wrap=True)
        extra = "" if is_installed() else f", which needs {install_hint('reports')}"
        console.print(
            f"Results in {folder} ({megabytes_in_words(size_mb)}); "
            f"write report.html with `automotive-cosim report {folder}`{extra}",
            soft_wrap=True,
        )
    tell_stopped(end)
    if errors:
        raise InfrastructureError(
            f"{len(errors)} of {counted(end.planned, unit)} ended in an infrastructure error, which no rate "
            "counts as a success; rerun the command to retry them"
        )
    if running.at_least and (short := _short(found, running.at_least)):
        typer.echo("; ".join(short), err=True)
        raise typer.Exit(1)


def _short(found: Results, at_least: float) -> list[str]:
    """What is below a share, agent by agent: of the episodes that were run, or of the score of drives; and what was
    not run, as everything must have been."""
    from automotive_cosim.report.drives import grouped, whole

    told = []
    for each in found.contestants:
        ran = found.of(each)
        won = sum(row.has_succeeded for row in ran)
        if won < at_least * len(ran):
            of = f"{won:,} of {counted(len(ran), 'episode')}"
            told.append(f"{each.label}: {of} succeeded, a smaller share than {at_least:g}")
    for each, rows in grouped(found.drives).items():
        points = whole(rows).value
        if points < 100 * at_least:
            score = f"{points:.0f}".replace("-", "−")
            told.append(f"{each.label}: score {score}, less than {100 * at_least:g} of 100 points")
    for unit, left in (("episode", found.not_run), ("drive", found.drives_not_run)):
        if left:
            told.append(f"{counted(len(left), unit)} not run")
    return told


def _named(tasks: Sequence[str]) -> str:
    """The tasks by name, or their number and the first of them."""
    few = ", ".join(tasks[:3])
    return few if len(tasks) <= 3 else f"{len(tasks)} tasks, such as {few}"


def limits_told(told: LimitSettings) -> Json:
    """The limits of a plan that options set, of tasks and of drives."""
    if told.wall is not None:
        raise UserError("--most wall is a limit of `run`; in a plan, agent_s of [limits] is one")
    named = {
        ("steps", "hard_steps", "drive_steps"): told.steps,
        ("tokens", "drive_tokens"): told.tokens,
        ("model_s", "drive_model_s"): told.seconds,
    }
    return {name: value for names, value in named.items() if value is not None for name in names}


def _failures(rows: Sequence[TrialRow]) -> Iterator[str]:
    """A line for each agent that failed, and for each whose answers were no actions."""
    for agent in dict.fromkeys(row.agent for row in rows):
        mine = [row for row in rows if row.agent == agent]
        failed = [row for row in mine if row.agent_error is not None]
        for row in failed[:1]:
            yield f"agent {agent} failed in {counted(len(failed), 'run')}, e.g. {row.id}: {row.agent_error}"
        lost = [row for row in mine if row.malformed]
        steps = sum(row.malformed or 0 for row in lost)
        for row in lost[:1]:
            yield (
                f"agent {agent} gave no action in {counted(steps, 'step')} of {counted(len(lost), 'run')}, e.g. "
                f"{row.id}: {row.malformed_why}"
            )


def _said(progress: Progress[TrialRow]) -> str:
    lost = progress.judged - progress.successes
    errors = f", {counted(progress.errors, 'error')}" if progress.errors else ""
    return f"{progress.successes:,} succeeded, {lost:,} failed{errors}"


def _announce(console: Console, plan: Plan, folder: Path) -> None:
    from rich.table import Table

    from automotive_cosim.run.drive import DriveSetup
    from automotive_cosim.run.episode import EpisodeSetup
    from automotive_cosim.run.plan import languages_in_words

    jobs = plan.jobs()
    table = Table.grid(padding=(0, 2))
    agents = {f"{job.agent} ({model_and_options(job.model)[0]})".removesuffix(" (none)") for job in jobs}
    table.add_row("agents", ", ".join(sorted(agents)))
    episodes = [job for job in jobs if isinstance(job, EpisodeSetup)]
    if episodes:
        table.add_row("tasks", f"{len({job.task for job in episodes})} (pairs in both halves)")
    if len(episodes) < len(jobs):
        families = {job.family for job in jobs if isinstance(job, DriveSetup)}
        table.add_row("drives", counted(len(families), "family", "families"))
    table.add_row("scenarios", ", ".join(sorted({job.in_scenario for job in jobs})))
    if left_out := plan.left_out():
        table.add_row("left out", f"{_named(left_out)}: not made for these scenarios; --everywhere includes them")
    if beyond := plan.beyond_the_list():
        table.add_row("left out", f"{_named(beyond)}: only a picture that --see withholds shows what they need")
    if unspoken := plan.unspoken():
        table.add_row("left out", f"{_named(unspoken)}: no phrasings in {languages_in_words(plan.languages)}")
    if unheard := plan.unheard():
        table.add_row(
            "not heard",
            f"{unheard} of {counted(len(jobs), 'run')}: the table lacks what is said; {install_hint('voice')}",
        )
    table.add_row("seeds", ", ".join(map(str, plan.seeds)))
    for each in TABLE:
        table.add_row(each.words.heading.lower(), ", ".join(map(each.told, lists_of(plan)[each.name])))
    table.add_row("repeats", f"{plan.repeats}{', each in another phrasing' if plan.rephrase else ''}")
    table.add_row("phrasings", "held out" if plan.held_out else "any")
    table.add_row("split", "development and test" if plan.split == "both" else plan.split)
    limits = plan.limits
    table.add_row(
        "limits",
        f"{counted(limits.steps, 'step')} ({limits.hard_steps} in the suites hard and people), "
        f"{limits.sim_s:g} s simulated, {limits.wall_s:g} s real and "
        f"{limits.agent_s:g} s in the agent's process, {limits.model_s:g} s of the model, {limits.tokens:,} tokens",
    )
    if len(episodes) < len(jobs):
        own = limits.of_drives
        table.add_row(
            "of a drive",
            f"{counted(own.steps, 'step')}, {own.wall_s:g} s real and {own.agent_s:g} s in the agent's process, "
            f"{own.model_s:g} s of the model, {own.tokens:,} tokens; beyond them nobody watches",
        )
    table.add_row("runs", f"{len(jobs):,} from {counted(len({job.simulation for job in jobs}), 'warm simulation')}")
    table.add_row("folder", str(folder))
    console.print(table)
    if any(job.model == "rules" for job in jobs):
        console.print("rules is a deterministic stand-in: its results say nothing about a language model.")


def _folder(plan: Plan) -> Path:
    from automotive_cosim.interface.trace import canonical

    return Path("runs") / f"eval-{hashlib.sha256(canonical(plan.as_json())).hexdigest()[:8]}"
