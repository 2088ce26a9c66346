"""``automotive-cosim run``: runs, shows, judges and records one trial."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from automotive_cosim.cli.conditions import given, takes_conditions
from automotive_cosim.cli.derived import filled, settings_in, takes
from automotive_cosim.cli.options import (
    AGENT_HELP,
    DriveChanges,
    Force,
    LimitSettings,
    ModelName,
    Most,
    Seed,
    TasksFrom,
    print_json,
    tell_opening,
    tells_json,
)
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import PLACE, GeoInput
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.settings import ANYWHERE, DEFAULT_TASK, EpisodeSettings
from automotive_cosim.errors import InfrastructureError, UserError
from automotive_cosim.formats.annotations import option
from automotive_cosim.run.settings import SingleSettings

if TYPE_CHECKING:
    from automotive_cosim.agents import Agent
    from automotive_cosim.run.episode import EpisodeSetup
    from automotive_cosim.run.rows import TrialRow
    from automotive_cosim.run.trial import TrialObserver
    from automotive_cosim.traffic.fork import Simulations

HEADLINE = (
    "task",
    "half",
    "scenario",
    "agent",
    "model",
    "seed",
    "success",
    "reward",
    "steps",
    "sim_seconds",
    "trace_sha256",
    "end",
    "error",
    "tokens_in",
    "tokens_out",
    "cost_usd",
)


PAIR_TITLES = ("Knows where it is", "The same agent, place withheld")


@tells_json
@takes_conditions()
@takes(EpisodeSettings, but=["seed"])
@takes(SingleSettings)
@takes(DriveChanges)
def run(
    agent: Annotated[str, typer.Option(help=AGENT_HELP, show_default="asurada; rule-perfect on a drive")] = "",
    model: ModelName = "rules",
    tasks_from: TasksFrom = None,
    most: Most = None,
    seed: Seed = 0,
    force: Force = False,
    as_json: bool = False,
    **settings: Any,
) -> None:
    """Run one episode or drive: a task or a family of drives, an agent, a seed.

    Without options, a car in Paris drives at 80 km/h where 50 is posted, and the agent is to warn the driver.
    """
    chosen, limited = settings_in(EpisodeSettings, settings), most or LimitSettings()
    how = filled(SingleSettings, settings)
    scenario = chosen.get("scenario")
    tell_opening(*filter(None, [scenario]))
    _check_subject(settings)
    if how.drive:
        from automotive_cosim.cli.drive import run_drive

        run_drive(
            how.drive,
            agent or "rule-perfect",
            model,
            seed,
            how.out,
            limited,
            settings,
            force=force,
            as_json=as_json,
        )
        return
    agent = agent or "asurada"
    from automotive_cosim.agents import AgentSettings, make_agent
    from automotive_cosim.agents.settings import parts
    from automotive_cosim.episode.own_prompt import instructions
    from automotive_cosim.formats.layout import PAGE
    from automotive_cosim.run.episode import EpisodeSetup
    from automotive_cosim.run.record import check_folder, default_folder
    from automotive_cosim.run.script import read_script
    from automotive_cosim.run.trial import Limits
    from automotive_cosim.traffic.fork import Simulations

    if scenario == "":
        raise UserError("--scenario is empty; name a scenario, or omit the option to use the task's own")
    limits = Limits().within(limited.tokens, limited.seconds)
    off = parts(how.without)
    under = Conditions.named(given(settings)).at(seed)

    def player_under(each: Conditions) -> Agent:
        settings = AgentSettings(
            each, off, how.memory, seed, limits.tokens, limits.model_s, instructions=instructions(each.prompt)
        )
        return read_script(how.actions) if how.actions else make_agent(agent, model, settings)

    player = player_under(under)
    if how.pair:
        _check_pair(player, under)
    setup = EpisodeSetup(
        **{"task": _default_task(chosen), **chosen},
        seed=seed,
        max_steps=limited.steps,
        conditions=under,
        agent=player.name,
        model=player.model,
        without=tuple(sorted(off)),
    )
    setup.session(frozenset(player.channels))
    folder = how.out or default_folder(setup, "-pair" if how.pair else "")
    check_folder(folder, force=force)
    arguments = {"actions": str(how.actions) if how.actions else None}
    with closing(Simulations()) as simulations:
        if how.pair:
            blind = replace(under, geo=GeoInput.NONE)
            both = ((setup, player), (replace(setup, conditions=blind), player_under(blind)))
            rows, page, conclusion = _recorded_pair(
                folder, both, simulations, wall_s=limited.wall_s, as_json=as_json
            )
        else:
            conclusion = ""
            rows = [
                _recorded(folder, setup, player, arguments, simulations, wall_s=limited.wall_s, as_json=as_json)
            ]
            page = folder / PAGE
    has_begun = rows[0].trace_sha256 is not None
    if has_begun and "task" not in chosen and setup.task == ANYWHERE:
        typer.echo(f"no --task was given: this was {ANYWHERE}, which comes about on any road", err=True)
    if as_json:
        told = [{**_headline(row), "out": str(folder)} for row in rows]
        print_json({"pair": told, "out": str(folder)} if how.pair else told[0])
    elif has_begun:
        typer.echo(f"Recorded in {folder}; open {page}")
        if conclusion:
            typer.echo(f"\n{conclusion}")
    for row in rows:
        if row.error is not None:
            raise InfrastructureError(row.error)


def _check_subject(settings: Mapping[str, Any]) -> None:
    """Refuses options of tasks beside ``--drive``, and those of drives without it."""
    is_drive = bool(settings["drive"])
    kinds = (EpisodeSettings, SingleSettings) if is_drive else (DriveChanges,)
    fits = {"scenario", "drive", "out"}
    given = [(kind, name) for kind in kinds for name in settings_in(kind, settings)]
    wrong = [option(kind, name).replace("--gps", "--no-gps") for kind, name in given if name not in fits]
    if wrong:
        other = "a task; omit it with" if is_drive else "a drive; give"
        raise UserError(f"{wrong[0]} is about {other} --drive")


def _check_pair(player: Agent, under: Conditions) -> None:
    if player.name in ("human", "script"):
        raise UserError(f"--pair runs an agent twice; omit it with {player.name}")
    if under.geo is not GeoInput.FULL:
        raise UserError(f"--pair compares --geo full with --geo none; omit --geo {under.geo}")
    if not PLACE & set(player.channels):
        raise UserError(f"--pair withholds the place, of which {player.name} is never told; use another --agent")


def _recorded(
    folder: Path,
    setup: EpisodeSetup,
    player: Agent,
    arguments: Json,
    simulations: Simulations,
    more: Sequence[TrialObserver] = (),
    *,
    wall_s: float,
    as_json: bool,
) -> TrialRow:
    from automotive_cosim.cli.console import Console
    from automotive_cosim.cli.live import Live, Notes
    from automotive_cosim.report.film import Film
    from automotive_cosim.run.record import Recorder
    from automotive_cosim.run.road_recorder import RoadRecorder
    from automotive_cosim.run.trial import run_trial

    recorder = Recorder(setup, folder, {**arguments, "out": str(folder)}, whole=True)
    # A panel that redraws itself would interfere with a person who types.
    by_hand = player.name == "human"
    console = Console(force_terminal=False, highlight=False) if by_hand else None
    view = Live(console, by_hand=by_hand, brief=bool(more))
    observers = [recorder, RoadRecorder(folder, setup.about), Film(folder), Notes() if as_json else view, *more]
    try:
        return run_trial(setup, player, observers, simulations=simulations, wall_s=wall_s)
    except KeyboardInterrupt:
        if recorder.has_begun:
            typer.echo(f"recorded so far: {folder}", err=True)
        raise
    finally:
        if recorder.has_begun:
            from automotive_cosim.report.page import write_page

            write_page(folder)


def _recorded_pair(
    folder: Path,
    both: Sequence[tuple[EpisodeSetup, Agent]],
    simulations: Simulations,
    *,
    wall_s: float,
    as_json: bool,
) -> tuple[list[TrialRow], Path, str]:
    """Runs two episodes from the same instant and records both, with the film and the page that show them, and what
    they show in a sentence."""
    from automotive_cosim.formats.layout import PAIR
    from automotive_cosim.report.frames import Frames
    from automotive_cosim.report.pair import PairSide, screen_size, sentence, write_pair

    sides: list[PairSide] = []
    rows: list[TrialRow] = []
    for title, name, (setup, player) in zip(PAIR_TITLES, PAIR, both, strict=True):
        if not as_json:
            typer.echo(f"{title}:")
        frames = Frames(screen_size())
        row = _recorded(
            folder / name, setup, player, {"pair": name}, simulations, [frames], wall_s=wall_s, as_json=as_json
        )
        if row.trace_sha256 is None:
            return [row], folder, ""
        sides.append(PairSide(title, folder / name, frames))
        rows.append(row)
    return rows, write_pair(folder, sides), sentence(sides)


def _headline(row: TrialRow) -> Json:
    from automotive_cosim.run.job_row import as_json

    whole = as_json(row)
    return {name: whole[name] for name in HEADLINE} | row.conditions.as_json()


def _default_task(chosen: Mapping[str, Any]) -> str:
    """The task without ``--task``."""
    from automotive_cosim.tasks import CATALOGUE

    own = CATALOGUE[DEFAULT_TASK].half("first").start.scenario
    is_there = chosen.get("scenario", own) == own and not {"from_place", "to_place"} & {*chosen}
    return DEFAULT_TASK if is_there or chosen.get("half", "first") != "first" else ANYWHERE
