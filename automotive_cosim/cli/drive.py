"""``automotive-cosim drive``: one drive with many events, watched by an agent."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from automotive_cosim.cli.conditions import given, takes_conditions
from automotive_cosim.cli.options import AsJson, number, print_json, whole_number
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import UserError

if TYPE_CHECKING:
    from automotive_cosim.cli.console import Console
    from automotive_cosim.run.drive_row import DriveTrialRow


@takes_conditions()
def drive(
    name: Annotated[str, typer.Argument(help="Family of drives; --list lists them.")] = "",
    seed: Annotated[
        int,
        typer.Option(
            help="Seed; the same seed gives the same drive.", metavar="N", parser=whole_number(0, 2**31 - 1)
        ),
    ] = 0,
    scenario: Annotated[
        str,
        typer.Option(
            help="Drive here instead: a shipped scenario, or the path of a scenario, .sumocfg or .net.xml.",
            show_default=False,
        ),
    ] = "",
    minutes: Annotated[
        float | None,
        typer.Option(
            help="End it after this many simulated minutes.",
            parser=number(0.1, 60),
            metavar="X",
            show_default=False,
        ),
    ] = None,
    agent: Annotated[str, typer.Option(help="Agent; `agents` lists them.")] = "rule-perfect",
    model: Annotated[str, typer.Option(help="Model for the agent.")] = "rules",
    out: Annotated[
        Path | None,
        typer.Option(
            help="Folder for the row, the steps, the screens and the road, which `serve` shows.",
            show_default="runs/<time>-<family>-<agent>-seed<seed>",
        ),
    ] = None,
    list_them: Annotated[bool, typer.Option("--list", help="List the families of drives and exit.")] = False,
    as_json: AsJson = False,
    **conditions: str | None,
) -> None:
    """Run one drive of ten to thirty minutes, in which an agent keeps watch."""
    from automotive_cosim.agents import AgentSettings, make_agent
    from automotive_cosim.cli.console import Console
    from automotive_cosim.drives.families import FAMILIES
    from automotive_cosim.drives.settings import DriveSettings
    from automotive_cosim.run.drive import DriveSetup, run_drive
    from automotive_cosim.run.drive_recorder import DriveRecorder
    from automotive_cosim.run.jobs import DriveJob
    from automotive_cosim.run.record import stamped_folder
    from automotive_cosim.run.row import as_json as row_json

    console = Console(highlight=False)
    if list_them:
        listed = [{"id": family.id, "season": family.season, "about": family.about} for family in FAMILIES.values()]
        if as_json:
            print_json(listed)
        else:
            for family in listed:
                console.print(f"{family['id']:24} {family['season']:7} {family['about']}", soft_wrap=True)
        return
    if not name:
        raise UserError(f"drive needs the name of a family, such as {next(iter(FAMILIES))}; --list lists them")
    if out is not None and (out / "row.json").exists():
        raise UserError(f"{out} holds the results of a drive; give --out another folder")
    under = Conditions.named(given(conditions))
    player = make_agent(agent, model, AgentSettings(under, seed=seed))
    setup = DriveSetup(
        name,
        seed,
        player.name,
        player.model,
        under,
        scenario=scenario,
        settings=DriveSettings(minutes=minutes),
    )
    folder = out or stamped_folder(f"{name}-{player.name}-seed{seed}")
    with closing(DriveRecorder(folder, setup, player)) as recorder:
        record = run_drive(DriveJob(setup).planned(), setup, player, observers=[recorder])
    if as_json:
        print_json({**row_json(record.row), "out": str(folder)})
    else:
        _tell(console, record.row)
        console.print(f"Recorded in {folder}; watch it with `automotive-cosim serve {folder}`", soft_wrap=True)


def _tell(console: Console, row: DriveTrialRow) -> None:
    """The drive's events and acts in chronological order, and its score."""
    from automotive_cosim.drives.judge import Worth

    lines = [
        (
            event.observable_s,
            f"{'look-alike' if event.lookalike else 'event'}  {event.kind}: {event.words}",
            event.outcome.value,
        )
        for event in row.events
    ]
    lines += [
        (act.time_s, f"  act  {act.words}", f"{act.worth}: {act.reason}" if act.reason else str(act.worth))
        for act in row.acts
        if act.worth is not Worth.NEUTRAL
    ]
    for time_s, words, became in sorted(lines):
        console.print(
            f"{int(time_s) // 60:3}:{int(time_s) % 60:02}  {words}  [{became}]", markup=False, soft_wrap=True
        )
    found = row.score
    assert found is not None
    recall = "no events" if found.recall is None else f"{found.met} of {found.events} events met"
    console.print(
        f"{row.family}, seed {row.seed}, {row.agent} ({row.model}): score {found.value:.0f}; {recall}, "
        f"{found.false_alarms_per_h:.1f} false alarms and {found.nuisances_per_h:.1f} nuisances an hour, "
        f"{row.steps} steps in {found.driven_s / 60:.0f} min",
        soft_wrap=True,
    )
    if row.unwatched_from_s is not None:
        minutes, seconds = divmod(int(row.unwatched_from_s), 60)
        console.print(
            f"Nobody watched from {minutes}:{seconds:02d} on: {row.agent_error or row.end}", soft_wrap=True
        )
