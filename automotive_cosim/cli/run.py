"""``automotive-cosim run``: runs, shows, judges and records one episode."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from automotive_cosim.cli.conditions import given, takes_conditions
from automotive_cosim.cli.options import AsJson, NoMode, TasksFrom, lon_lat, whole_number
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import InfrastructureError, UserError

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


DEFAULT_TASK = "road_speed_80_in_50"
ANYWHERE = "hvac_fan_max"
"""The default task in other places than its own: it comes about wherever a car drives, the other one only where the
right limit is posted."""


@takes_conditions()
def run(
    task: Annotated[
        str | None,
        typer.Option(
            help="Id of the task; `tasks list` lists them.", show_default=f"{DEFAULT_TASK}, elsewhere {ANYWHERE}"
        ),
    ] = None,
    half: Annotated[str, typer.Option(help="Half of a pair: first or second.")] = "first",
    agent: Annotated[
        str, typer.Option(help="Agent; `agents` lists them; package.module:Class is one of your own.")
    ] = "asurada",
    model: Annotated[
        str,
        typer.Option(help="Model for the agent: rules, replay/FOLDER, replay/NAME, openai/NAME, PROVIDER/NAME."),
    ] = "rules",
    tasks_from: TasksFrom = None,
    mode: NoMode = None,
    without: Annotated[
        str,
        typer.Option(
            help="Parts of the agent to switch off, separated by commas: "
            "gps, context, queries, screen, brevity, reflection, memory."
        ),
    ] = "",
    memory: Annotated[
        Path | None,
        typer.Option(help="File in which ASURADA remembers what worked, for later runs.", show_default=False),
    ] = None,
    most_tokens: Annotated[
        int, typer.Option(help="Budget of tokens for the model.", metavar="N", parser=whole_number(1, 10**9))
    ] = 2_000_000,
    most_seconds: Annotated[
        int,
        typer.Option(
            help="Total time to wait for the model, in seconds.", metavar="N", parser=whole_number(1, 10**6)
        ),
    ] = 1800,
    scenario: Annotated[
        str | None,
        typer.Option(
            help="A scenario's name or folder, or any .sumocfg or .net.xml(.gz), instead of the task's own.",
            show_default=False,
        ),
    ] = None,
    from_place: Annotated[
        str,
        typer.Option("--from", help="Where the car's route begins: a street, an edge or LON,LAT.", metavar="PLACE"),
    ] = "",
    to_place: Annotated[
        str, typer.Option("--to", help="Where the car's route ends: a street, an edge or LON,LAT.", metavar="PLACE")
    ] = "",
    origin: Annotated[
        str,
        typer.Option(
            help="Move the centre of the network to this place, with its law, clock and climate.",
            metavar="LON,LAT",
            show_default=False,
        ),
    ] = "",
    no_gps: Annotated[
        bool, typer.Option("--no-gps", help="No GPS: the place is unknown, and the network needs no projection.")
    ] = False,
    seed: Annotated[
        int,
        typer.Option(
            help="Seed; the same seed gives the same trace.", metavar="N", parser=whole_number(0, 2**31 - 1)
        ),
    ] = 0,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for the results.", show_default="runs/<time>-<task>-<half>-<agent>-seed<seed>"),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the results in --out.")] = False,
    as_json: AsJson = False,
    actions: Annotated[
        Path | None,
        typer.Option(
            help="Play a file of actions, one JSON object per line, instead of an agent.", show_default=False
        ),
    ] = None,
    **conditions: str | None,
) -> None:
    """Run one episode: a task, an agent, a seed.

    Without options, a car in Paris drives at 80 km/h where 50 is posted, and the agent is to warn the driver.
    """
    from automotive_cosim.agents import AgentSettings, make_agent
    from automotive_cosim.agents.settings import parts
    from automotive_cosim.cli.console import Console
    from automotive_cosim.cli.live import Live, Notes
    from automotive_cosim.report.film import Film
    from automotive_cosim.report.page import write_page
    from automotive_cosim.run.episode import EpisodeSetup, run_episode
    from automotive_cosim.run.record import Recorder, check_folder, default_folder
    from automotive_cosim.run.road_recorder import RoadRecorder
    from automotive_cosim.run.script import read_script

    if scenario == "":
        raise UserError("--scenario is empty; name a scenario, or omit the option to use the task's own")
    off = parts(name.strip() for name in without.split(",") if name.strip())
    under = Conditions.named(given(conditions))
    settings = AgentSettings(under, off, memory, seed, most_tokens, float(most_seconds))
    player = read_script(actions) if actions else make_agent(agent, model, settings)
    setup = EpisodeSetup(
        task or _default_task(half, scenario, bool(from_place or to_place)),
        half,
        scenario,
        origin=lon_lat(origin) if origin else None,
        gps=not no_gps,
        from_place=from_place,
        to_place=to_place,
        seed=seed,
        conditions=under,
        agent=player.name,
        model=player.model,
        without=tuple(sorted(off)),
    )
    setup.session(frozenset(player.channels))
    folder = out or default_folder(setup)
    check_folder(folder, force=force)
    recorder = Recorder(folder, setup, {"actions": str(actions) if actions else None, "out": str(folder)})
    # A panel that redraws itself would interfere with a person who types.
    view = Live(Console(force_terminal=False, highlight=False)) if player.name == "human" else Live()
    watchers = [recorder, RoadRecorder(folder, setup), Film(folder), Notes() if as_json else view]
    try:
        result = run_episode(setup, player, watchers)
    except KeyboardInterrupt:
        if recorder.begun:
            write_page(folder)
            typer.echo(f"recorded so far: {folder}", err=True)
        raise
    if recorder.begun:
        write_page(folder)
    if as_json:
        whole = result.as_json()
        told = {name: whole[name] for name in HEADLINE} | under.as_json()
        typer.echo(json.dumps(told | {"out": str(folder)}))
    elif recorder.begun:
        typer.echo(f"Recorded in {folder}; open {folder / 'summary.html'}")
    if result.error is not None:
        raise InfrastructureError(result.error)


def _default_task(half: str, scenario: str | None, on_another_way: bool) -> str:
    """The task without ``--task``; it is said if it is not the usual one."""
    from automotive_cosim.tasks import CATALOGUE

    own = CATALOGUE[DEFAULT_TASK].half(half).start.scenario
    if half != "first" or (scenario in (None, own) and not on_another_way):
        return DEFAULT_TASK
    typer.echo(f"no --task is given: {ANYWHERE}, which comes about on any road", err=True)
    return ANYWHERE
