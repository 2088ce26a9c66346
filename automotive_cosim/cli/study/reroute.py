"""``automotive-cosim study reroute``: futures forked at every decision to reroute."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from automotive_cosim.cli.batches import (
    ExecutorName,
    ProgressView,
    RayAddress,
    RaySend,
    Workers,
    executor_of,
    seeds_in,
    tell_notes,
    words,
)
from automotive_cosim.cli.options import AsJson, whole_number
from automotive_cosim.cli.study.shared import (
    DemandScale,
    LeastDelay,
    PerDrive,
    RedrawTrips,
    StepLength,
    StudyFolder,
    StudySeeds,
    ViaStops,
    WithEmissions,
    folder_of,
    numbers,
    raise_errors,
    replicates_of,
    resumable,
    tell_reading,
)
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import UserError

if TYPE_CHECKING:
    from automotive_cosim.cli.console import Console
    from automotive_cosim.run.batch import Progress
    from automotive_cosim.studies.plan import StudyPlan
    from automotive_cosim.studies.results import Study
    from automotive_cosim.studies.rows import DriveRow


def reroute(
    scenario: Annotated[
        str, typer.Option(help="A scenario's name or folder, or any .sumocfg or .net.xml.")
    ] = "paris_centre",
    departures: Annotated[
        str | None,
        typer.Option(
            help="When the ego departs: seconds after the warm-up or clock times, separated by commas.",
            show_default="0,300,600,900",
        ),
    ] = None,
    trips: Annotated[
        str | None,
        typer.Option(
            help="Ego trips of the scenario, separated by commas: names, the beginnings of names, or numbers as in "
            "`scenarios show`.",
            show_default="all",
        ),
    ] = None,
    from_place: Annotated[
        str, typer.Option("--from", help="Where the ego's route begins: an edge, a street or LON,LAT.")
    ] = "",
    to_place: Annotated[
        str, typer.Option("--to", help="Where it ends; if only --from or --to is given, the other is drawn.")
    ] = "",
    seeds: StudySeeds = "0-9",
    shares: Annotated[
        str | None,
        typer.Option(
            help="Shares of the other cars that reroute, 0 to 1, separated by commas.", show_default="scenario's"
        ),
    ] = None,
    ages: Annotated[str, typer.Option(help="Ages of the traffic news in seconds, separated by commas.")] = "0",
    compliance: Annotated[
        str, typer.Option(help="Probabilities that the driver follows the advice, 0 to 1, separated by commas.")
    ] = "1",
    policies: Annotated[
        str,
        typer.Option(
            help="Policies, separated by commas: never, always, delay:SECONDS, sumo, best, agent:NAME, "
            "agent:NAME/MODEL."
        ),
    ] = "never,always,delay:60,sumo,best",
    driver: Annotated[str, typer.Option(help="Driver profile of the ego.", show_default="scenario's")] = "",
    delay: LeastDelay = 30.0,
    every: Annotated[float, typer.Option(help="Seconds between two decisions of a drive.")] = 60.0,
    per_drive: PerDrive = 5,
    placebo_every: Annotated[
        int,
        typer.Option(
            help="One placebo in this many drives; 0 for none.", metavar="N", parser=whole_number(0, 10**6)
        ),
    ] = 1,
    replicates: Annotated[
        str,
        typer.Option(
            help="How many times each future is driven, with fresh random numbers; auto: more times where the "
            "sign of the mean gain is unclear."
        ),
    ] = "1",
    whole_drives: Annotated[
        bool,
        typer.Option(
            "--whole-drives",
            help="Also drive every policy from departure to destination.",
        ),
    ] = False,
    together: Annotated[
        str | None,
        typer.Option(
            help="Shares, 0 to 1, of the eligible cars that take the other route with the ego.",
            show_default="none",
        ),
    ] = None,
    close: Annotated[
        str,
        typer.Option(
            help="Also close a road at the first decision of each drive: an edge, or `ahead` for one on the route.",
            show_default="none",
        ),
    ] = "",
    via: ViaStops = "stops",
    incident: Annotated[
        list[str] | None,
        typer.Option(
            help="An incident in every future, with the fields of scenario.toml, as in 'breakdown edge=c1c2 "
            "position_m=120'; may be given several times.",
            show_default="none",
        ),
    ] = None,
    emissions: WithEmissions = False,
    trajectories: Annotated[
        bool, typer.Option("--trajectories", help="Store the ego's position in every future, step by step.")
    ] = False,
    ego_class: Annotated[
        str,
        typer.Option(
            help="SUMO's emission class of the ego, as Energy/default for an electric one.",
            show_default="SUMO's for cars",
        ),
    ] = "",
    redraw: RedrawTrips = False,
    arrived: Annotated[
        float,
        typer.Option(help="Share of the vehicles present at a decision that must arrive before its futures end."),
    ] = 0.95,
    scale: DemandScale = None,
    warm_up: Annotated[
        float | None,
        typer.Option(help="Seconds of traffic before the first departure.", show_default="scenario's"),
    ] = None,
    step: StepLength = 1.0,
    equilibrium_gap: Annotated[
        float | None,
        typer.Option(
            help="Declare that the demand comes from duaIterate with this relative gap.", show_default=False
        ),
    ] = None,
    measure_gap: Annotated[
        bool, typer.Option(help="Measure how far the demand's routes are from an equilibrium.")
    ] = True,
    until: Annotated[
        float | None,
        typer.Option(
            help="Add seeds until the mean gain is known to within this many seconds.", show_default=False
        ),
    ] = None,
    workers: Workers = None,
    executor: ExecutorName = "processes",
    ray_address: RayAddress = None,
    ray_send: RaySend = None,
    out: StudyFolder = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Show the plan and exit.")] = False,
    as_json: AsJson = False,
) -> None:
    """Fork the running traffic at every decision to reroute and drive both futures.

    Rerun the command to resume a stopped study.
    """
    from automotive_cosim.cli.console import Console
    from automotive_cosim.run.store import read_rows
    from automotive_cosim.studies.batch import run_study
    from automotive_cosim.studies.demand import measure_demand
    from automotive_cosim.studies.page import write_study
    from automotive_cosim.studies.plan import StudyPlan
    from automotive_cosim.studies.results import read_study
    from automotive_cosim.studies.rows import DriveRow

    tell_reading(scenario)
    values: dict[str, Any] = {
        "via": via,
        "seeds": tuple(seeds_in(seeds)),
        "ages_s": tuple(numbers("ages", ages)),
        "compliance": tuple(numbers("compliance", compliance)),
        "policies": tuple(words("policies", policies)),
        "per_drive": per_drive,
        "placebo_every": placebo_every,
        "replicates": replicates_of(replicates),
    }
    values |= {"departures_s": _departures(scenario, departures)} if departures is not None else {}
    values |= {"trips": tuple(words("trips", trips))} if trips is not None else {}
    values |= {"shares": tuple(numbers("shares", shares))} if shares is not None else {}
    values |= {"together": tuple(numbers("together", together))} if together is not None else {}
    plan = StudyPlan(
        scenario,
        from_place=from_place,
        to_place=to_place,
        driver=driver,
        least_delay_s=delay,
        every_s=every,
        arrived=arrived,
        whole_drives=whole_drives,
        close=close,
        incidents=tuple(incident or ()),
        redraw=redraw,
        emissions=emissions,
        trajectories=trajectories,
        ego_class=ego_class,
        scale=scale,
        warm_up_s=warm_up,
        step_s=step,
        equilibrium_gap=equilibrium_gap,
        half_width_s=until,
        **values,
    )
    plan.check()
    tell_notes([plan.opened])
    folder = out or folder_of(plan)
    where = executor_of(executor, workers, ray_address, ray_send)
    console = Console(stderr=as_json, highlight=False)
    _announce(console, plan, folder)
    if dry_run:
        return

    def said(progress: Progress[DriveRow]) -> str:
        count = sum(len(row.decisions) for row in read_rows(folder, DriveRow).values())
        errors = f", {counted(progress.errors, 'error')}" if progress.errors else ""
        return f"{counted(count, 'decision')}{errors}"

    with where, ProgressView(console, "drives", said) as view, resumable("drives", folder):
        run_study(plan, folder, executor=where, tell=view.tell)
    if measure_gap:
        for each in measure_demand(plan, folder):
            console.print(f"demand, {each.share:.0%} reroute: {each.gap or each.why_not}", soft_wrap=True)
    page = write_study(folder)
    _tell(console, read_study(folder), page, as_json=as_json)


def _tell(console: Console, study: Study, page: Path, *, as_json: bool) -> None:
    """Prints the result; raises if there is none."""
    from automotive_cosim.studies.page import answer, cost_s
    from automotive_cosim.studies.tables import excluded, parts, policies
    from automotive_cosim.studies.warnings import warnings

    count, errors = len(study.decisions), study.errors
    kept_out = {f"{what}: {reason}": number for (what, reason), number in sorted(study.excluded.items())}
    if as_json:
        told: Json = {"answer": answer(study), "warnings": warnings(study)}
        told |= {"drives": len(study.rows), "decisions": count, "excluded": kept_out, "errors": len(errors)}
        told |= {"seconds_a_decision": cost_s(study), "out": str(study.folder)}
        typer.echo(json.dumps(told, ensure_ascii=False))
    else:
        for table in (policies(study), parts(study), excluded(study)):
            if table.rows:
                console.print(table.markdown(), soft_wrap=True)
        for warning in warnings(study):
            console.print(warning, soft_wrap=True)
        console.print(answer(study), soft_wrap=True)
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
    table.add_row("steps", f"{plan.step_s:g} s")
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
    from automotive_cosim.scenery import open_scenario

    found = []
    for word in words("departures", text):
        hours, colon, minutes = word.partition(":")
        if not colon:
            found += numbers("departures", word)
        elif hours.isdigit() and minutes.isdigit() and int(hours) < 24 and int(minutes) < 60:
            start = open_scenario(scenario).start
            at = start.replace(hour=int(hours), minute=int(minutes), second=0)
            found.append((at - start).total_seconds())
        else:
            raise UserError(f"--departures has {word!r}; give seconds such as 300, or clock times such as 8:20")
    return tuple(found)
