"""``automotive-cosim study suite``: one study of rerouting on several networks."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from automotive_cosim.cli.batches import Workers, executor_of, seeds_in, words
from automotive_cosim.cli.options import AsJson
from automotive_cosim.cli.study.shared import LeastDelay, PerDrive, ViaStops, numbers, replicates_of
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import InfrastructureError


def suite(
    scenarios: Annotated[
        str,
        typer.Option(
            help="Names or folders of scenarios, .sumocfg or .net.xml, separated by commas; shipped stands for all "
            "shipped ones."
        ),
    ] = "grid,paris_centre",
    departures: Annotated[str, typer.Option(help="When the ego departs, in seconds after the warm-up.")] = "0,300",
    seeds: Annotated[str, typer.Option(help="Seeds of the traffic.")] = "0-9",
    policies: Annotated[
        str, typer.Option(help="Policies; the table shows always and best.")
    ] = "never,always,delay:60,best",
    delay: LeastDelay = 30.0,
    per_drive: PerDrive = 2,
    replicates: Annotated[str, typer.Option(help="How many times each future is driven, or auto.")] = "2",
    via: ViaStops = "stops",
    warm_ups: Annotated[
        str | None,
        typer.Option(
            help="Seconds of traffic before the first departure; each is a separate study.",
            show_default="scenario's",
        ),
    ] = None,
    workers: Workers = None,
    out: Annotated[Path, typer.Option(help="Folder for all studies; existing ones are resumed.")] = Path(
        "runs/suite"
    ),
    as_json: AsJson = False,
) -> None:
    """Run the same study on several networks, or after several warm-ups, and put them into one table.

    Rerun the command to resume a stopped suite.
    """
    from automotive_cosim.cli.console import Console
    from automotive_cosim.studies.batch import run_study
    from automotive_cosim.studies.demand import measure_demand
    from automotive_cosim.studies.page import write_study
    from automotive_cosim.studies.plan import StudyPlan
    from automotive_cosim.studies.results import read_study
    from automotive_cosim.studies.suite import folder_name, networks, write_networks

    values: dict[str, Any] = {
        "departures_s": tuple(numbers("departures", departures)),
        "seeds": tuple(seeds_in(seeds)),
        "policies": tuple(words("policies", policies)),
        "replicates": replicates_of(replicates),
        "via": via,
    }
    plans = [
        StudyPlan(name, least_delay_s=delay, per_drive=per_drive, warm_up_s=warm_up_s, **values)
        for name in _scenarios(scenarios)
        for warm_up_s in (numbers("warm-ups", warm_ups) if warm_ups is not None else (None,))
    ]
    for plan in plans:
        plan.check()
    where = executor_of("processes", workers, None, None)
    console = Console(stderr=as_json, highlight=False)
    found = []
    with where:
        for number, plan in enumerate(plans, start=1):
            folder = out / folder_name(number, plan.scenario)
            console.print(f"{plan.scenario}: {counted(len(plan.jobs()), 'drive')}", soft_wrap=True)
            run_study(plan, folder, executor=where)
            measure_demand(plan, folder)
            write_study(folder)
            found.append(read_study(folder))
    table = networks(found)
    page = write_networks(table, out)
    console.print(table.markdown(), soft_wrap=True)
    console.print(f"{page} written; every study has its own report beside it", soft_wrap=True)
    if as_json:
        rows = [dict(zip(table.columns, map(str, row), strict=True)) for row in table.rows]
        typer.echo(json.dumps({"networks": rows, "out": str(out)}, ensure_ascii=False))
    errors = sum(len(study.errors) for study in found)
    if errors:
        raise InfrastructureError(f"{counted(errors, 'drive')} ended in an error; rerun the command to retry them")


def _scenarios(text: str) -> list[str]:
    """Names of scenarios, with all shipped ones in the place of ``shipped``."""
    from automotive_cosim.scenarios import shipped

    return [name for word in words("scenarios", text) for name in (shipped() if word == "shipped" else (word,))]
