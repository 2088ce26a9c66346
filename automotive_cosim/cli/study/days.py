"""``automotive-cosim study days``: advice from day to day until traffic settles."""

from __future__ import annotations

from typing import Annotated

import typer

from automotive_cosim.cli.batches import (
    ExecutorName,
    ProgressView,
    RayAddress,
    RaySend,
    Workers,
    executor_of,
    seeds_in,
)
from automotive_cosim.cli.options import AsJson, whole_number
from automotive_cosim.cli.study.shared import (
    DemandScale,
    StudyFolder,
    StudySeeds,
    errors_so_far,
    folder_of,
    numbers,
    raise_errors,
    resumable,
    show,
    tell_reading,
)


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

    tell_reading(scenario)
    plan = DaysPlan(
        scenario,
        shares=tuple(numbers("shares", shares)),
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
    folder = out or folder_of(plan)
    where = executor_of(executor, workers, ray_address, ray_send)
    console = Console(stderr=as_json, highlight=False)
    with (
        where,
        ProgressView(console, "shares and seeds", errors_so_far) as view,
        resumable("shares", folder),
    ):
        run_days(plan, folder, executor=where, tell=view.tell)
    study = read_days(folder)
    if len(study.errors) < len(study.rows):
        show(console, write_days(folder), answer(study), warnings(study), tables(study)[:1], as_json=as_json)
    raise_errors(study.errors, len(study.rows), "run")
