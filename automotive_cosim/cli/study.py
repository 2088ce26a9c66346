"""``automotive-cosim study``: how much rerouting gains, from futures forked from identical traffic."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
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
    time_left,
    words,
)
from automotive_cosim.cli.options import AsJson, print_json, reads_results, whole_number
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import InfrastructureError, UserError

if TYPE_CHECKING:
    from automotive_cosim.cli.console import Console
    from automotive_cosim.report.tables import Table
    from automotive_cosim.run.batch import Progress
    from automotive_cosim.run.row import JobRow
    from automotive_cosim.studies.congestion.plan import CongestionPlan
    from automotive_cosim.studies.days import DaysPlan
    from automotive_cosim.studies.plan import StudyPlan
    from automotive_cosim.studies.results import Study
    from automotive_cosim.studies.rows import DriveRow

StudySeeds = Annotated[
    str, typer.Option(help="Seeds of the traffic, as in 0-9; at least 10 for an interval, 30 to publish.")
]
DemandScale = Annotated[float | None, typer.Option(help="Factor on the demand.", show_default="scenario's")]
StepLength = Annotated[float, typer.Option(help="SUMO's step length in seconds.")]
RedrawTrips = Annotated[
    bool, typer.Option("--redraw", help="Redraw the trips of the demand for every seed, as on another day.")
]
WithEmissions = Annotated[
    bool, typer.Option("--emissions", help="Measure what every vehicle emits and consumes, by emission class.")
]
LeastDelay = Annotated[float, typer.Option(help="Expected delay, in seconds, from which a decision is due.")]
PerDrive = Annotated[
    int, typer.Option(help="Maximum number of decisions per drive.", metavar="N", parser=whole_number(1, 50))
]
ViaStops = Annotated[
    str,
    typer.Option(
        help="What a trip's via edges are: stops, which every route passes, or route, which other routes may leave."
    ),
]
StudyFolder = Annotated[
    Path | None,
    typer.Option(
        help="Results folder; an existing one is resumed.", show_default="runs/study-<digest of the plan>"
    ),
]

app = typer.Typer(help="Measure what rerouting saves and what a measure does to congestion.", no_args_is_help=True)


@app.command()
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
        str | None, typer.Option(help="Ego trips of the scenario, separated by commas.", show_default="all")
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

    values: dict[str, Any] = {
        "via": via,
        "seeds": tuple(seeds_in(seeds)),
        "ages_s": tuple(_numbers("ages", ages)),
        "compliance": tuple(_numbers("compliance", compliance)),
        "policies": tuple(words("policies", policies)),
        "per_drive": per_drive,
        "placebo_every": placebo_every,
        "replicates": _replicates(replicates),
    }
    values |= {"departures_s": _departures(scenario, departures)} if departures is not None else {}
    values |= {"trips": tuple(words("trips", trips))} if trips is not None else {}
    values |= {"shares": tuple(_numbers("shares", shares))} if shares is not None else {}
    values |= {"together": tuple(_numbers("together", together))} if together is not None else {}
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
    folder = out or _folder(plan)
    where = executor_of(executor, workers, ray_address, ray_send)
    console = Console(stderr=as_json, highlight=False)
    _announce(console, plan, folder)
    if dry_run:
        return

    def said(progress: Progress[DriveRow]) -> str:
        count = sum(len(row.decisions) for row in read_rows(folder, DriveRow).values())
        errors = f", {counted(progress.errors, 'error')}" if progress.errors else ""
        return f"{counted(count, 'decision')}{errors}{time_left(progress)}"

    with where, ProgressView(console, "drives", said) as view, _resumable("drives", folder):
        run_study(plan, folder, executor=where, tell=view.tell)
    if measure_gap:
        for each in measure_demand(plan, folder):
            console.print(f"demand, {each.share:.0%} reroute: {each.gap or each.why_not}", soft_wrap=True)
    page = write_study(folder)
    _tell(console, read_study(folder), page, as_json=as_json)


@app.command()
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
        "departures_s": tuple(_numbers("departures", departures)),
        "seeds": tuple(seeds_in(seeds)),
        "policies": tuple(words("policies", policies)),
        "replicates": _replicates(replicates),
        "via": via,
    }
    plans = [
        StudyPlan(name, least_delay_s=delay, per_drive=per_drive, warm_up_s=warm_up_s, **values)
        for name in _scenarios(scenarios)
        for warm_up_s in (_numbers("warm-ups", warm_ups) if warm_ups is not None else (None,))
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


@app.command()
def congestion(
    scenario: Annotated[
        str, typer.Option(help="A scenario's name or folder, or any .sumocfg or .net.xml.")
    ] = "paris_centre",
    measure: Annotated[
        list[str] | None,
        typer.Option(
            help="A measure to compare with none: an incident with the fields of scenario.toml (as 'closure "
            "edge=c2c3'), 'advice share=0.5 compliance=0.8 age_s=300' or 'signals control=static'; may be given "
            "several times.",
            show_default="none",
        ),
    ] = None,
    seeds: StudySeeds = "0-9",
    minutes: Annotated[float, typer.Option(help="How long to measure after the warm-up.")] = 60.0,
    demand: Annotated[
        str,
        typer.Option(help="Factors on the demand in periods of equal length, as in 0.6,1,0.6 for a peak."),
    ] = "1",
    incident: Annotated[
        list[str] | None,
        typer.Option(help="An incident with and without the measures; may be repeated.", show_default="none"),
    ] = None,
    share: Annotated[
        float | None,
        typer.Option(help="Share of the cars with SUMO's rerouting device.", show_default="scenario's"),
    ] = None,
    corridor: Annotated[
        str, typer.Option(help="Trip along which the time-space diagrams go.", show_default="the first")
    ] = "",
    emissions: WithEmissions = False,
    redraw: RedrawTrips = False,
    scale: DemandScale = None,
    warm_up: Annotated[
        float | None, typer.Option(help="Seconds of traffic before the measure.", show_default="scenario's")
    ] = None,
    step: StepLength = 1.0,
    workers: Workers = None,
    executor: ExecutorName = "processes",
    ray_address: RayAddress = None,
    ray_send: RaySend = None,
    out: StudyFolder = None,
    as_json: AsJson = False,
) -> None:
    """Measure the delay of a whole network before and after a measure, in copies of the same traffic.

    Rerun the command to resume a stopped study.
    """
    from automotive_cosim.cli.console import Console
    from automotive_cosim.studies.congestion.drive import run_congestion
    from automotive_cosim.studies.congestion.page import answer, warnings, write_congestion
    from automotive_cosim.studies.congestion.plan import CongestionPlan
    from automotive_cosim.studies.congestion.results import read_congestion
    from automotive_cosim.studies.congestion.tables import whole

    plan = CongestionPlan(
        scenario,
        measures=tuple(measure or ()),
        seeds=tuple(seeds_in(seeds)),
        minutes=minutes,
        demand=tuple(_numbers("demand", demand)),
        incidents=tuple(incident or ()),
        share=share,
        corridor=corridor,
        step_s=step,
        scale=scale,
        warm_up_s=warm_up,
        redraw=redraw,
        emissions=emissions,
    )
    plan.check()
    tell_notes([plan.opened])
    folder = out or _folder(plan)
    where = executor_of(executor, workers, ray_address, ray_send)
    console = Console(stderr=as_json, highlight=False)
    with where, ProgressView(console, "seeds", _errors) as view, _resumable("seeds", folder):
        run_congestion(plan, folder, executor=where, tell=view.tell)
    study = read_congestion(folder)
    if len(study.errors) < len(study.rows):
        _show(console, write_congestion(folder), answer(study), warnings(study), [whole(study)], as_json=as_json)
    _raise_errors(study.errors, len(study.rows), "run")


@app.command()
def days(
    scenario: Annotated[
        str, typer.Option(help="A scenario's name or folder, or any .sumocfg with its demand in route files.")
    ] = "paris_centre",
    shares: Annotated[str, typer.Option(help="Shares of the drivers who are advised.")] = "0,0.25,0.5,0.75,1",
    compliance: Annotated[float, typer.Option(help="Probability that a driver follows a day's advice.")] = 0.5,
    memory: Annotated[float, typer.Option(help="Weight of all earlier days in what is remembered.")] = 0.7,
    lag: Annotated[int, typer.Option(help="Age of the news in days.", metavar="N", parser=whole_number(0, 30))] = 0,
    most: Annotated[
        int, typer.Option("--days", help="Most days to drive.", metavar="N", parser=whole_number(2, 365))
    ] = 30,
    minutes: Annotated[float, typer.Option(help="How long after the warm-up departures count.")] = 60.0,
    seeds: StudySeeds = "0-2",
    scale: DemandScale = None,
    warm_up: Annotated[
        float | None, typer.Option(help="Seconds of traffic before it counts.", show_default="scenario's")
    ] = None,
    workers: Workers = None,
    executor: ExecutorName = "processes",
    ray_address: RayAddress = None,
    ray_send: RaySend = None,
    out: StudyFolder = None,
    as_json: AsJson = False,
) -> None:
    """Advise a share of the drivers day after day until traffic settles, beside the user equilibrium.

    Rerun the command to resume a stopped study.
    """
    from automotive_cosim.cli.console import Console
    from automotive_cosim.studies.days import DaysPlan, read_days, run_days
    from automotive_cosim.studies.days_page import answer, tables, warnings, write_days

    plan = DaysPlan(
        scenario,
        shares=tuple(_numbers("shares", shares)),
        compliance=compliance,
        memory=memory,
        lag=lag,
        days=most,
        minutes=minutes,
        seeds=tuple(seeds_in(seeds)),
        scale=scale,
        warm_up_s=warm_up,
    )
    plan.check()
    folder = out or _folder(plan)
    where = executor_of(executor, workers, ray_address, ray_send)
    console = Console(stderr=as_json, highlight=False)
    with where, ProgressView(console, "shares and seeds", _errors) as view, _resumable("shares", folder):
        run_days(plan, folder, executor=where, tell=view.tell)
    study = read_days(folder)
    if len(study.errors) < len(study.rows):
        _show(console, write_days(folder), answer(study), warnings(study), tables(study)[:1], as_json=as_json)
    _raise_errors(study.errors, len(study.rows), "run")


@app.command()
@reads_results
def compare(
    first: Annotated[Path, typer.Argument(help="Results folder of a study, or of a suite.", show_default=False)],
    second: Annotated[Path, typer.Argument(help="The same of another run.", show_default=False)],
    as_json: AsJson = False,
) -> None:
    """Compare two runs of one study or suite, as of two versions; exit code 1 if their rows differ."""
    from automotive_cosim.cli.console import Console
    from automotive_cosim.studies.versions import answer, compared, pairs

    found = pairs(first, second)
    table = compared(found)
    changed = {pair.name: list(pair.changed) for pair in found if pair.changed}
    if as_json:
        rows = [dict(zip(table.columns, map(str, row), strict=True)) for row in table.rows]
        print_json({"same": all(pair.is_same for pair in found), "changed": changed, "figures": rows})
    else:
        console = Console(highlight=False)
        console.print(answer(found), soft_wrap=True)
        for name, what in changed.items():
            console.print(f"{name} was run with another {'; '.join(what)}", soft_wrap=True)
        console.print(table.markdown(), soft_wrap=True)
    raise typer.Exit(not all(pair.is_same for pair in found))


def _errors(progress: Progress[Any]) -> str:
    errors = counted(progress.errors, "error") if progress.errors else ""
    return f"{errors}{time_left(progress)}"


@contextmanager
def _resumable(units: str, folder: Path) -> Iterator[None]:
    """Says at Ctrl-C where the study is."""
    try:
        yield
    except KeyboardInterrupt:
        typer.echo(f"finished {units} are in {folder}; rerun the command to resume", err=True)
        raise


def _show(
    console: Console,
    page: Path,
    answer: str,
    warnings: Sequence[str],
    tables: Sequence[Table],
    *,
    as_json: bool,
) -> None:
    """Prints the result of a study of a whole network."""
    if as_json:
        told: Json = {"answer": answer, "warnings": list(warnings), "out": str(page.parent)}
        for table in tables:
            told[table.name] = [dict(zip(table.columns, map(str, row), strict=True)) for row in table.rows]
        print_json(told)
        return
    for table in tables:
        console.print(table.markdown(), soft_wrap=True)
    for text in (*warnings, answer, f"report written to {page}"):
        console.print(text, soft_wrap=True)


def _raise_errors(errors: Sequence[JobRow], count: int, unit: str) -> None:
    if errors:
        first = errors[0]
        raise InfrastructureError(
            f"{len(errors)} of {counted(count, unit)} ended in an error, the first one {first.id}: "
            f"{first.error_kind}: {first.error}; rerun the command to retry them"
        )


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
    _raise_errors(errors, len(study.rows), "drive")
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
            found += _numbers("departures", word)
        elif hours.isdigit() and minutes.isdigit() and int(hours) < 24 and int(minutes) < 60:
            start = open_scenario(scenario).start
            at = start.replace(hour=int(hours), minute=int(minutes), second=0)
            found.append((at - start).total_seconds())
        else:
            raise UserError(f"--departures has {word!r}; give seconds such as 300, or clock times such as 8:20")
    return tuple(found)


def _scenarios(text: str) -> list[str]:
    """Names of scenarios, with all shipped ones in the place of ``shipped``."""
    from automotive_cosim.scenarios import shipped

    return [name for word in words("scenarios", text) for name in (shipped() if word == "shipped" else (word,))]


def _replicates(text: str) -> int | str:
    """A number, or a word that the plan checks."""
    return int(text) if text.isdecimal() else text


def _numbers(name: str, text: str) -> list[float]:
    found = []
    for word in words(name, text):
        try:
            found.append(float(word))
        except ValueError:
            raise UserError(f"--{name} has {word!r}; give numbers separated by commas") from None
    return found


def _folder(plan: StudyPlan | CongestionPlan | DaysPlan) -> Path:
    from automotive_cosim.interface.trace import canonical

    return Path("runs") / f"study-{hashlib.sha256(canonical(plan.as_json())).hexdigest()[:8]}"
