"""``automotive-cosim search``: searches a space for failures of an agent; rerun the command to resume."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from automotive_cosim.cli.options import AgentName, AsJson, ModelName, TasksFrom, number, whole_number
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import UserError

if TYPE_CHECKING:
    from automotive_cosim.contracts import Json
    from automotive_cosim.safety.hunt import Hunt

SETTINGS = "search.json"
"""File of a search's folder with what it was started with."""


def search(
    space_name: Annotated[
        str,
        typer.Option(
            "--space",
            help="TOML file with the factors and their values, or a space of the library, such as cut-in.",
            show_default=False,
        ),
    ],
    agent: AgentName,
    budget: Annotated[
        int,
        typer.Option(
            help="Points to sample, with those of earlier starts. A failure that is made small takes some thirty "
            "more runs.",
            metavar="N",
            parser=whole_number(1, 1_000_000),
        ),
    ],
    model: ModelName = "rules",
    sampler: Annotated[
        str, typer.Option(help="How points are chosen: climb, random, sobol, lhs, cma or bayes.")
    ] = "climb",
    seed: Annotated[
        int, typer.Option(help="Seed of the sampler.", metavar="N", parser=whole_number(0, 2**31 - 1))
    ] = 0,
    hours: Annotated[
        float | None,
        typer.Option(
            help="Sample no further point after this many hours; rerun to continue.",
            metavar="X",
            parser=number(0.0001, 10_000),
            show_default=False,
        ),
    ] = None,
    failures: Annotated[
        int, typer.Option(help="How many failures are made small.", metavar="N", parser=whole_number(0, 1000))
    ] = 5,
    workers: Annotated[
        int,
        typer.Option(
            help="How many of the points that are spread evenly run in parallel; what is learnt from them runs one "
            "by one.",
            metavar="N",
            parser=whole_number(1, 4096),
        ),
    ] = 1,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder; an existing one is resumed.", show_default="runs/search-<space>-<agent>"),
    ] = None,
    save: Annotated[
        Path | None,
        typer.Option(
            help="File for a plan with every minimal failure and its passing neighbour, for `eval --plan`.",
            show_default=False,
        ),
    ] = None,
    tasks_from: TasksFrom = None,
    as_json: AsJson = False,
) -> None:
    """Search a space of situations and conditions for failures of an agent. Rerun the command to resume."""
    from automotive_cosim.cli.console import Console
    from automotive_cosim.run.plan import make_plan
    from automotive_cosim.run.processes import Processes
    from automotive_cosim.run.record import write_whole
    from automotive_cosim.safety.findings import as_json as findings_json
    from automotive_cosim.safety.findings import sentence
    from automotive_cosim.safety.hunt import hunt
    from automotive_cosim.safety.page import suite, write_findings
    from automotive_cosim.safety.samplers import even_points, make_sampler
    from automotive_cosim.safety.space import read_space, space_file
    from automotive_cosim.safety.trying import check_space, trial_of, trying

    file = space_file(space_name)
    if workers > 1 and hours is not None:
        raise UserError("--hours ends a search between two points, which run one by one; omit it, or --workers")
    space = read_space(file)
    plan = make_plan({"agents": [agent], "models": [model], "trials": [_plain(trial_of(space.nominal))]})
    plan.check()
    check_space(space, plan)
    folder = out or Path("runs") / f"search-{file.stem}-{agent.replace(':', '.')}"
    console = Console(stderr=as_json, highlight=False)
    about: Json = {
        "space": file.read_text(encoding="utf-8"),
        "agent": agent,
        "model": model,
        "sampler": sampler,
        "seed": seed,
        "failures": failures,
    }
    laid = _laid(folder, about, budget)
    chooses = make_sampler(sampler, space, laid, seed)
    ends_s = None if hours is None else time.monotonic() + 3600 * hours

    def tell(found: Hunt) -> None:
        last = found.samples[-1]
        if last.outcome.is_unrunnable:
            return
        margin = "not judged" if last.outcome.margin is None else f"margin {last.outcome.margin:+.2f}"
        console.print(
            f"{found.run} of {budget}; {margin}; {counted(len(found.minimal), 'minimal failure')}",
            soft_wrap=True,
        )

    with trying(space, plan, folder) as run:
        write_whole(folder / SETTINGS, json.dumps(about | {"budget": laid}, indent=1))
        if workers > 1 and run(space.nominal, 0).passed:
            run.ahead(even_points(make_sampler(sampler, space, laid, seed), budget), Processes(workers))
        found = hunt(
            space,
            run,
            chooses,
            budget,
            most_failures=failures,
            goes_on=lambda: ends_s is None or time.monotonic() < ends_s,
            tell=tell,
        )
        page = write_findings(folder, found, agent, model, about)
    if save is not None:
        write_whole(save, suite(found, agent, model))
    if as_json:
        typer.echo(json.dumps(findings_json(found) | {"out": str(folder)}))
        return
    console.print(sentence(found, agent), soft_wrap=True)
    for count, each in enumerate(found.minimal, 1):
        near = "" if each.neighbour is None else f"; passes with {each.differs} {each.neighbour[each.differs]}"
        console.print(f"{count}. fails with {each.words(space)}{near} [{each.why}]", markup=False, soft_wrap=True)
    console.print(f"Report: {page}", soft_wrap=True)


def _laid(folder: Path, about: Json, budget: int) -> int:
    """The budget that the sampler was first laid out for.

    Raises:
        UserError: the folder's search was started with something else.
    """
    from automotive_cosim.formats.files import read_json

    path = folder / SETTINGS
    if not path.is_file():
        return budget
    try:
        before: Json = dict(read_json(path))
        laid = int(before.pop("budget"))
    except (LookupError, TypeError, ValueError) as error:
        raise UserError(f"cannot read {path}: {error}; give --out another folder") from error
    changed = sorted(name for name in about if before.get(name) != about[name])
    if changed:
        raise UserError(f"{folder} was started with a different {', '.join(changed)}; give --out another folder")
    return laid


def _plain(trial: object) -> Json:
    from automotive_cosim.run.row import as_json

    return as_json(trial)
