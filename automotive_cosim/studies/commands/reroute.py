"""``automotive-cosim study reroute``: futures forked at every decision to reroute;
``study compare``: two runs of one study."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from automotive_cosim.cli.batches import ExecutorSettings, numbers_in, tell_notes, words
from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import print_json, reads_results, tells_json
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import UserError
from automotive_cosim.studies.commands.shared import StudyFolder, driven, folder_of, raise_errors, tell_reading
from automotive_cosim.studies.settings import RerouteSettings


@tells_json
@reads_results
def compare(
    first: Annotated[Path, typer.Argument(help="Results folder of a study.", show_default=False)],
    second: Annotated[Path, typer.Argument(help="The same of another run.", show_default=False)],
    as_json: bool = False,
) -> None:
    """Compare two runs of one study, as of two versions; exit code 1 if their rows differ."""
    from automotive_cosim.cli.console import Console
    from automotive_cosim.studies.versions import answer, compared, pairs

    found = pairs(first, second)
    table = compared(found)
    changed = {pair.name: list(pair.changed) for pair in found if pair.changed}
    if as_json:
        print_json({"same": all(pair.is_same for pair in found), "changed": changed, "figures": table.records()})
    else:
        console = Console(highlight=False)
        console.print(answer(found), soft_wrap=True)
        for name, what in changed.items():
            console.print(f"{name} was run with another {'; '.join(what)}", soft_wrap=True)
        console.print(table.markdown(), soft_wrap=True)
    raise typer.Exit(not all(pair.is_same for pair in found))


if TYPE_CHECKING:
    from automotive_cosim.cli.console import Console
    from automotive_cosim.run.batch import Progress
    from automotive_cosim.run.executor import Executor
    from automotive_cosim.studies.reroute.plan import StudyPlan
    from automotive_cosim.studies.reroute.results import Study
    from automotive_cosim.studies.reroute.rows import TripRow


IN_PYTHON = ("redraw", "limit_s", "agent_steps", "every_s", "placebo_every", "arrived", "via", "ego_class")
"""What only a ``StudyPlan`` of one's own sets."""


@tells_json
@takes(RerouteSettings, but=("scenario", "warm_up_s", *IN_PYTHON))
@takes(ExecutorSettings)
def reroute(
    scenario: Annotated[
        str,
        typer.Option(
            metavar="LIST",
            help="A scenario's name or folder, or any .sumocfg or .net.xml. Each of several is studied, and one "
            "table has them all; shipped stands for all shipped ones.",
        ),
    ] = "paris_centre",
    warm_up: Annotated[
        str | None,
        typer.Option(
            metavar="LIST",
            help="Seconds of traffic before anything counts; each of several is studied.",
            show_default="scenario's",
        ),
    ] = None,
    out: StudyFolder = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Show the plan and exit.")] = False,
    as_json: bool = False,
    **settings: Any,
) -> None:
    """Fork the running traffic at every decision to reroute and drive both routes.

    Rerun the command to resume a stopped study."""
    from automotive_cosim.cli.console import Console
    from automotive_cosim.scenarios import shipped
    from automotive_cosim.studies.reroute.networks import folder_name
    from automotive_cosim.studies.reroute.plan import StudyPlan
    from automotive_cosim.studies.reroute.results import Study

    departures = settings.pop("departures_s")
    common = filled(StudyPlan, settings)
    plans = []
    names = [(word,) if word != "shipped" else shipped() for word in words("scenario", scenario)]
    for name in (each for some in names for each in some):
        tell_reading(name)
        leaves_s = common.departures_s if departures is None else _departures(name, departures)
        for warm_up_s in numbers_in("warm-up", warm_up) if warm_up is not None else [None]:
            plans.append(replace(common, scenario=name, warm_up_s=warm_up_s, departures_s=leaves_s))
            plans[-1].check()
        tell_notes([plans[-1].opened])
    folders = [out or folder_of(plans[0])]
    if len(plans) > 1:
        folders = [folders[0] / folder_name(number, plan.scenario) for number, plan in enumerate(plans, start=1)]
    where = filled(ExecutorSettings, settings).opened()
    console = Console(stderr=as_json, highlight=False)
    for plan, folder in zip(plans, folders, strict=True):
        _announce(console, plan, folder)
    if dry_run:
        return
    with where:
        for plan, folder in zip(plans, folders, strict=True):
            _run(console, plan, folder, where)
    if len(plans) == 1:
        _tell(console, Study.read(folders[0]), as_json=as_json)
    else:
        _tell_all(console, [Study.read(folder) for folder in folders], as_json=as_json)


def _run(console: Console, plan: StudyPlan, folder: Path, where: Executor) -> None:
    """Runs what is left of a study, and writes its report."""
    from automotive_cosim.run.store import read_rows
    from automotive_cosim.studies.reroute.batch import REROUTE
    from automotive_cosim.studies.reroute.demand import measure_demand
    from automotive_cosim.studies.reroute.page import write_study
    from automotive_cosim.studies.reroute.rows import TripRow

    def said(progress: Progress[TripRow]) -> str:
        count = sum(len(row.decisions) for row in read_rows(folder, TripRow).values())
        errors = f", {counted(progress.errors, 'error')}" if progress.errors else ""
        return f"{counted(count, 'decision')}{errors}"

    with driven(console, "drives", folder, said) as tell:
        REROUTE.run(plan, folder, executor=where, tell=tell)
    for each in measure_demand(plan, folder):
        console.print(f"demand, {each.share:.0%} reroute: {each.gap or each.why_not}", soft_wrap=True)
    write_study(folder)


def _tell_all(console: Console, studies: Sequence[Study], *, as_json: bool) -> None:
    """Prints the table of several studies; raises if drives ended in an error."""
    from automotive_cosim.studies.reroute.networks import networks, sentence, write_networks

    table, out = networks(studies), studies[0].folder.parent
    told = sentence(studies)
    page = write_networks(table, out, told)
    console.print(told, soft_wrap=True)
    console.print(table.markdown(), soft_wrap=True)
    console.print(f"{page} written; every study has its own report beside it", soft_wrap=True)
    if as_json:
        print_json({"networks": table.records(), "out": str(out)})
    raise_errors([error for study in studies for error in study.errors], sum(len(s.rows) for s in studies), "drive")


def _tell(console: Console, study: Study, *, as_json: bool) -> None:
    """Prints the result; raises if there is none."""
    from automotive_cosim.studies.reroute.page import answer, cost_s
    from automotive_cosim.studies.reroute.tables import excluded, parts, policies
    from automotive_cosim.studies.reroute.warnings import warnings

    count, errors = len(study.decisions), study.errors
    kept_out = {f"{what}: {reason}": number for (what, reason), number in sorted(study.excluded.items())}
    if as_json:
        told: Json = {"answer": answer(study), "warnings": warnings(study)}
        told |= {"drives": len(study.rows), "decisions": count, "excluded": kept_out, "errors": len(errors)}
        told |= {"seconds_a_decision": cost_s(study), "out": str(study.folder)}
        print_json(told)
    else:
        for table in (policies(study), parts(study), excluded(study)):
            if table.rows:
                console.print(table.markdown(), soft_wrap=True)
        for warning in warnings(study):
            console.print(warning, soft_wrap=True)
        console.print(answer(study), soft_wrap=True)
        page = study.folder / "report.html"
        console.print(f"{counted(count, 'decision')} counted; report written to {page}", soft_wrap=True)
    raise_errors(errors, len(study.rows), "drive")
    if not count:
        told_why = ", ".join(f"{number} {name}" for name, number in kept_out.items())
        raise UserError(
            f"no decision counted ({told_why}): choose other trips or departures, lower --delay, or change --scale"
        )


def _announce(console: Console, plan: StudyPlan, folder: Path) -> None:
    from rich.table import Table

    jobs = plan.jobs()
    table = Table.grid(padding=(0, 2))
    table.add_row("scenario", plan.scenario)
    table.add_row("trips", ", ".join(dict.fromkeys(job.trip.name for job in jobs)))
    table.add_row("departures", ", ".join(f"{each:g}" for each in plan.departures_s) + " s after the warm-up")
    table.add_row("seeds", f"{len(plan.seeds)}")
    table.add_row("policies", ", ".join(plan.policies))
    table.add_row("replicates", str(plan.replicates))
    table.add_row("steps", f"{plan.driven_step_s(plan.opened):g} s")
    for incident in plan.incidents:
        table.add_row("incident", incident)
    if plan.close:
        table.add_row("closed", plan.close)
    table.add_row("demand", plan.demand())
    table.add_row(
        "drives", f"{len(jobs):,} from {counted(len({job.simulation for job in jobs}), 'warm simulation')}"
    )
    table.add_row("folder", str(folder))
    console.print(table)


def _departures(scenario: str, text: str) -> tuple[float, ...]:
    """Departures in seconds after the warm-up; clock times are relative to the scenario's start."""
    from automotive_cosim.scenarios import open_scenario

    found = []
    for word in words("departures", text):
        hours, colon, minutes = word.partition(":")
        if not colon:
            found += numbers_in("departures", word)
        elif hours.isdigit() and minutes.isdigit() and int(hours) < 24 and int(minutes) < 60:
            start = open_scenario(scenario).start
            at = start.replace(hour=int(hours), minute=int(minutes), second=0)
            found.append((at - start).total_seconds())
        else:
            raise UserError(f"--departures has {word!r}; give seconds such as 300, or clock times such as 8:20")
    return tuple(found)
