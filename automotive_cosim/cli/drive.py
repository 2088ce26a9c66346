"""``automotive-cosim run --drive``: one drive with many events, watched by an agent."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import closing
from dataclasses import replace
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from automotive_cosim.cli.conditions import given
from automotive_cosim.cli.derived import settings_in
from automotive_cosim.cli.options import DriveChanges, LimitSettings, print_json
from automotive_cosim.contracts import Json
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import InfrastructureError, UserError

if TYPE_CHECKING:
    from automotive_cosim.cli.console import Console
    from automotive_cosim.run.plan import PlannedTrial
    from automotive_cosim.run.rows import DriveTrialRow


def run_drive(
    family: str,
    agent: str,
    model: str,
    seed: int,
    out: Path | None,
    limited: LimitSettings,
    settings: Mapping[str, Any],
    *,
    force: bool,
    as_json: bool,
) -> None:
    """Runs, records and tells one drive under the options of ``run``."""
    from automotive_cosim.agents import AgentSettings, make_agent
    from automotive_cosim.cli.console import Console
    from automotive_cosim.drives.elsewhere import name_of
    from automotive_cosim.drives.settings import DriveSettings
    from automotive_cosim.episode.own_prompt import instructions
    from automotive_cosim.report.hearing import with_sounds
    from automotive_cosim.run.drive import DriveSetup
    from automotive_cosim.run.job_row import as_json as row_json
    from automotive_cosim.run.plan import PlannedTrial
    from automotive_cosim.run.record import Recorder, check_folder, stamped_folder
    from automotive_cosim.run.road_recorder import RoadRecorder
    from automotive_cosim.run.rows import DriveTrialRow
    from automotive_cosim.run.trial import Limits, run_trial
    from automotive_cosim.run.trial_folder import read_steps

    changes = DriveSettings(**settings_in(DriveChanges, settings))
    if changes.cars:
        planned = PlannedTrial(drive=family, scenario=settings["scenario"] or "", seed=seed, settings=changes)
        planned = replace(planned, conditions=Conditions.named(given(settings)))
        _run_fleet(planned, agent, model, out, limited, force=force, as_json=as_json)
        return
    under = Conditions.named(given(settings)).at(seed)
    limits = Limits().of_drives.within(limited.tokens, limited.seconds)
    told = instructions(under.prompt)
    budget = AgentSettings(
        under, seed=seed, most_tokens=limits.tokens, most_seconds=limits.model_s, instructions=told
    )
    player = make_agent(agent, model, budget)
    setup = DriveSetup(
        family,
        seed,
        under,
        settings["scenario"] or "",
        changes,
        limited.steps or limits.steps,
        agent=player.name,
        model=player.model,
    )
    folder = out or stamped_folder(f"{name_of(family, setup.in_scenario)}-{player.name}-seed{seed}")
    check_folder(folder, force=force)
    recorder, road = Recorder(setup, folder, {"out": str(folder)}), RoadRecorder(folder, setup.about)
    with closing(recorder), closing(road):
        row = run_trial(setup, player, (recorder, road), wall_s=limited.wall_s)
    if row.error is not None:
        raise InfrastructureError(row.error)
    assert isinstance(row, DriveTrialRow)
    if as_json:
        print_json({**row_json(row), "out": str(folder)})
        return
    console = Console(highlight=False)
    _tell(console, row, recorder.lines[-1]["result"]["timeline"])
    _, silent = with_sounds(folder, read_steps(folder), recorder.goal)
    if silent:
        console.print(silent, soft_wrap=True)
    console.print(f"Recorded in {folder}; watch it with `automotive-cosim serve {folder}`", soft_wrap=True)


def _run_fleet(
    drive: PlannedTrial,
    agent: str,
    model: str,
    out: Path | None,
    limited: LimitSettings,
    *,
    force: bool,
    as_json: bool,
) -> None:
    """Runs a fleet as an evaluation of one drive, and tells of each car."""
    from automotive_cosim.cli.console import Console
    from automotive_cosim.cli.evaluate import limits_told
    from automotive_cosim.run.batch import run_plan
    from automotive_cosim.run.job_row import as_json as row_json
    from automotive_cosim.run.plan import make_plan
    from automotive_cosim.run.record import stamped_folder
    from automotive_cosim.run.rows import DriveTrialRow
    from automotive_cosim.run.settings import Pictures
    from automotive_cosim.run.store import read_rows, read_trace

    lists = {"agents": [agent], "models": [model], "drives": [drive.drive], "limits": limits_told(limited)}
    plan = replace(make_plan(lists), drives=(), trials=(drive,))
    folder = out or stamped_folder(f"{drive.drive}-{agent}-seed{drive.seed}-{drive.settings.cars}cars")
    if force:
        raise UserError("a fleet's folder is resumed, never replaced; give --out another folder, and no --force")
    run_plan(plan, folder, pictures=Pictures.ALL, retries=0)
    rows = sorted(read_rows(folder, DriveTrialRow).values(), key=attrgetter("car"))
    if as_json:
        print_json({"cars": [row_json(row) for row in rows], "out": str(folder)})
    console = Console(highlight=False)
    for row in () if as_json else rows:
        console.print(f"Car {row.car}:", style="bold")
        if row.error is None:
            _tell(console, row, read_trace(folder, row.id)[-1]["result"]["timeline"])
        else:
            console.print(f"{row.error_kind}: {row.error}", markup=False, soft_wrap=True)
    if failed := [row.error for row in rows if row.error is not None]:
        raise InfrastructureError(f"{len(failed)} of {len(rows)} cars ended in an error; the first: {failed[0]}")
    if not as_json:
        console.print(f"Recorded in {folder}; watch it with `automotive-cosim serve {folder}`", soft_wrap=True)


def _tell(console: Console, row: DriveTrialRow, timeline: Json) -> None:
    """The drive's events and acts in chronological order with what became of them, what went wrong and why, and its
    score."""
    from automotive_cosim.contracts.plain import clock, model_and_options
    from automotive_cosim.drives.faults import became, faults, key_of
    from automotive_cosim.drives.followed import told

    lines = [
        (
            event.observable_s,
            f"{'look-alike' if event.lookalike else 'event'}  {event.kind}: {event.words}",
            became(event, row.acts),
        )
        for event in row.events
    ]
    lines += [
        (act.time_s, f"  act  {act.words}", came)
        for act, came in zip(row.acts, told(row.acts, row.events, timeline), strict=True)
    ]
    if key := key_of(row.events):
        console.print(f"In brackets: {key}", markup=False, soft_wrap=True)
    for time_s, words, came in sorted(lines):
        console.print(
            f"{int(time_s) // 60:3}:{int(time_s) % 60:02}  {words}  [{came}]", markup=False, soft_wrap=True
        )
    if wrong := faults(row.events, row.acts):
        console.print("Missed, late and needless:", soft_wrap=True)
    for fault in wrong:
        console.print(f"  {fault.line}", markup=False, soft_wrap=True)
    found = row.score
    assert found is not None
    recall = "no events" if found.recall is None else f"{found.met} of {found.events} events met"
    model = "" if row.model == "none" else f" ({model_and_options(row.model)[0]})"
    console.print(
        f"{row.name}, seed {row.seed}, {row.agent}{model}: score {found.value:.0f}; {recall}, "
        f"{found.false_alarms_per_h:.1f} false alarms and {found.nuisances_per_h:.1f} nuisances an hour, "
        f"{row.steps} steps in {found.driven_s / 60:.0f} min",
        soft_wrap=True,
    )
    if row.harm is not None and row.baseline_harm is not None:
        near_s, baseline_s = row.harm.short_ttc_s, row.baseline_harm.short_ttc_s
        console.print(
            f"Near-collision time with the vehicle ahead {near_s:.0f} s; without the agent {baseline_s:.0f} s",
            soft_wrap=True,
        )
        lost_s, without_s = row.harm.unaware_s, row.baseline_harm.unaware_s
        if lost_s:
            console.print(f"Driver's attention lost {lost_s:.0f} s; without the agent {without_s:.0f} s")
    if row.unwatched_from_s is not None:
        console.print(
            f"Nobody watched from {clock(row.unwatched_from_s)} on: {row.agent_error or row.end}", soft_wrap=True
        )
