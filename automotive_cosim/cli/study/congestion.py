"""``automotive-cosim study congestion``: a whole network's delay before and after a measure."""

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
    tell_notes,
)
from automotive_cosim.cli.options import AsJson
from automotive_cosim.cli.study.shared import (
    DemandScale,
    RedrawTrips,
    StepLength,
    StudyFolder,
    StudySeeds,
    WithEmissions,
    errors_so_far,
    folder_of,
    numbers,
    raise_errors,
    resumable,
    show,
    tell_reading,
)
from automotive_cosim.contracts.plain import counted


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

    tell_reading(scenario)
    plan = CongestionPlan(
        scenario,
        measures=tuple(measure or ()),
        seeds=tuple(seeds_in(seeds)),
        minutes=minutes,
        demand=tuple(numbers("demand", demand)),
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
    folder = out or folder_of(plan)
    where = executor_of(executor, workers, ray_address, ray_send)
    console = Console(stderr=as_json, highlight=False)
    measures, over = counted(len(plan.measures), "measure"), counted(len(plan.seeds), "seed")
    console.print(
        f"{measures} and none, {over}, in steps of {plan.step_s:g} s, into {folder}",
        soft_wrap=True,
    )
    with where, ProgressView(console, "seeds", errors_so_far) as view, resumable("seeds", folder):
        run_congestion(plan, folder, executor=where, tell=view.tell)
    study = read_congestion(folder)
    if len(study.errors) < len(study.rows):
        show(console, write_congestion(folder), answer(study), warnings(study), [whole(study)], as_json=as_json)
    raise_errors(study.errors, len(study.rows), "run")
