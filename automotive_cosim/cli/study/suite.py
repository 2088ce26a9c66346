"""``automotive-cosim study suite``: one study of rerouting on several networks."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from automotive_cosim.cli.batches import ExecutorSettings
from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import AsJson, print_json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import InfrastructureError
from automotive_cosim.studies.settings import SuiteSettings


@takes(SuiteSettings, but=("scenario", "warm_up_s"))
@takes(ExecutorSettings)
def suite(
    out: Annotated[Path, typer.Option(help="Folder for all studies; existing ones are resumed.")] = Path(
        "runs/suite"
    ),
    as_json: AsJson = False,
    **settings: Any,
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

    told = filled(SuiteSettings, settings)
    plans = [
        StudyPlan(name, warm_up_s=warm_up_s, **told.of_each())
        for name in _all_of(told.scenarios)
        for warm_up_s in told.warm_ups_s or (None,)
    ]
    for plan in plans:
        plan.check()
    where = filled(ExecutorSettings, settings).opened()
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
        print_json({"networks": rows, "out": str(out)})
    errors = [row for study in found for row in study.errors]
    if errors:
        from automotive_cosim.run.row import remedy

        raise InfrastructureError(f"{counted(len(errors), 'drive')} ended in an error; {remedy(errors)}")


def _all_of(names: Sequence[str]) -> list[str]:
    """Names of scenarios, with all shipped ones in the place of ``shipped``."""
    from automotive_cosim.scenarios import shipped

    return [name for word in names for name in (shipped() if word == "shipped" else (word,))]
