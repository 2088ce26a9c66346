"""``automotive-cosim eval --drives``: runs drives in parallel; rerun the command to resume."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from automotive_cosim.cli.batches import ProgressView, check_prices, tell_stopped, time_left
from automotive_cosim.contracts.plain import counted
from automotive_cosim.episode.conditions import TABLE, lists_of
from automotive_cosim.errors import InfrastructureError, UserError

if TYPE_CHECKING:
    from automotive_cosim.cli.console import Console
    from automotive_cosim.run.batch import Progress
    from automotive_cosim.run.executor import Executor
    from automotive_cosim.run.meter import Budget
    from automotive_cosim.run.watch_row import WatchRow
    from automotive_cosim.run.watches import WatchPlan

TASKS_ONLY = ("tasks", "suite", "split", "everywhere", "held_out", "limits", "spare_traffic")
"""Options of a plan that drives do not have."""


def watch(
    values: Mapping[str, Any],
    out: Path | None,
    executor: Executor,
    retries: int,
    budget: Budget,
    *,
    dry_run: bool,
    as_json: bool,
) -> None:
    """Runs the drives of a plan, and prints the results."""
    from automotive_cosim.cli.console import Console
    from automotive_cosim.report.drives import standings
    from automotive_cosim.run.store import read_rows
    from automotive_cosim.run.watch_row import WatchRow
    from automotive_cosim.run.watches import make_watch_plan, run_watch_plan

    if surplus := [name for name in TASKS_ONLY if name in values]:
        raise UserError(f"drives do not take {' or '.join(surplus)}; omit what belongs to tasks, or omit --drives")
    plan = make_watch_plan(values)
    folder = out or _folder(plan)
    console = Console(stderr=as_json, highlight=False)
    plan.check()
    check_prices(plan.models, budget)
    _announce(console, plan, folder)
    if dry_run:
        return
    with executor, ProgressView(console, "drives", _said) as view:
        try:
            end = run_watch_plan(plan, folder, executor=executor, retries=retries, budget=budget, tell=view.tell)
        except KeyboardInterrupt:
            typer.echo(f"finished drives are in {folder}; rerun the command to resume", err=True)
            raise
    rows = list(read_rows(folder, WatchRow).values())
    if as_json:
        told = {"planned": end.planned, "judged": end.judged, "errors": end.errors, "ran": end.ran}
        typer.echo(json.dumps(told | {"out": str(folder)}))
    else:
        for line in standings(rows):
            console.print(f"  {line}", soft_wrap=True)
        for row in rows:
            if row.error is not None:
                console.print(f"  error in {row.id}: {row.error_kind}: {row.error}", soft_wrap=True, markup=False)
        console.print(
            f"Results in {folder}; write report.html with `automotive-cosim report {folder}`", soft_wrap=True
        )
    tell_stopped(end)
    if end.errors:
        raise InfrastructureError(
            f"{end.errors} of {counted(end.planned, 'drive')} ended in an infrastructure error and do not count; "
            "rerun the command to retry them"
        )


def _said(progress: Progress[WatchRow]) -> str:
    errors = f"{counted(progress.errors, 'error')}" if progress.errors else "no errors"
    return errors + time_left(progress)


def _announce(console: Console, plan: WatchPlan, folder: Path) -> None:
    from rich.table import Table

    jobs = plan.jobs()
    table = Table.grid(padding=(0, 2))
    table.add_row("agents", ", ".join(sorted({f"{job.setup.agent} ({job.setup.model})" for job in jobs})))
    table.add_row("drives", counted(len({job.setup.family for job in jobs}), "family", "families"))
    if plan.scenarios:
        table.add_row("scenarios", ", ".join(plan.scenarios))
    table.add_row("seeds", ", ".join(map(str, plan.seeds)))
    for each in TABLE:
        table.add_row(each.words.heading.lower(), ", ".join(map(each.told, lists_of(plan)[each.name])))
    table.add_row("repeats", str(plan.repeats))
    table.add_row("runs", f"{len(jobs):,} from {counted(len({job.simulation for job in jobs}), 'warm simulation')}")
    table.add_row("folder", str(folder))
    console.print(table)
    if any(job.setup.model == "rules" for job in jobs):
        console.print("rules is a deterministic stand-in: its results say nothing about a language model.")


def _folder(plan: WatchPlan) -> Path:
    from automotive_cosim.interface.trace import canonical

    return Path("runs") / f"drives-{hashlib.sha256(canonical(plan.as_json())).hexdigest()[:8]}"
