"""Repeats a stored trial's actions and compares the traces."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass, replace
from itertools import zip_longest
from pathlib import Path
from typing import cast

from automotive_cosim.agents import PROFILES, AgentSettings, NativeAgent, is_remote, make_agent
from automotive_cosim.agents.a2a import CHANNELS
from automotive_cosim.agents.settings import parts
from automotive_cosim.cockpit.actions import parse
from automotive_cosim.contracts import Action, Json, Observation
from automotive_cosim.contracts.plain import counted
from automotive_cosim.drives.families import family_named
from automotive_cosim.errors import (
    ActionError,
    AgentError,
    InfrastructureError,
    NoRoomError,
    OutOfBudgetError,
    UserError,
)
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.layout import TRIAL
from automotive_cosim.formats.toml import dotted
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.interface.trace import canonical, digests
from automotive_cosim.run.coverage import unit_of
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.episode import EpisodeSetup, read_setup
from automotive_cosim.run.fleet import run_fleet
from automotive_cosim.run.fork_server import ForkServer
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.record import Recorder
from automotive_cosim.run.rows import DriveTrialRow, TrialRow, read_trials
from automotive_cosim.run.script import ScriptedAgent
from automotive_cosim.run.store import read_evaluation, read_trace
from automotive_cosim.run.trial import TrialObserver, TrialRun, TrialSetup, run_trial
from automotive_cosim.run.trial_folder import is_trial, read_steps, read_trial
from automotive_cosim.run.worker import agent_of
from automotive_cosim.traffic.fork import Simulations

SHOWN = 3
"""How many ids are shown if several match."""
MISSING: Json = {}
"""Placeholder for a step that one of the two runs does not have."""


@dataclass(frozen=True, slots=True)
class Compared:
    """One step of both runs."""

    number: int
    sha256: str
    """Hash of the new step, or of the stored one if the new run has none."""
    differs: tuple[str, ...]
    """The parts that differ: of the step's state, its action, its feedback; ``"length"`` if one run has no such
    step."""


@dataclass(frozen=True, slots=True)
class Recorded:
    """A stored trial."""

    job: TrialSetup
    """What was run."""
    steps: Sequence[Json]
    """Of its trace."""
    channels: frozenset[Channel]
    """Those of its agent, on which the answers to queries depend."""
    failure: str | None = None
    """How the agent's side failed after these steps, if it did."""
    beside: Sequence[Recorded] = ()
    """The other cars of its fleet."""

    @property
    def player(self) -> Player:
        """Who acts as recorded."""
        return Player(self.steps[1:], self.channels, self.failure)


def _nobody(job: TrialSetup) -> Sequence[TrialObserver]:
    return ()


def rerun(
    folder: Path, trial: str = "", observers: Callable[[TrialSetup], Sequence[TrialObserver]] = _nobody
) -> list[Compared]:
    """Plays the actions of a stored trial in the same setup and compares step by step; folder, trial and errors are
    those of ``recorded``.

    Args:
        observers: makes those that are notified of everything as it happens.

    Raises InfrastructureError: the simulation failed."""
    stored = recorded(folder, trial)
    _, again = played(stored, observers=observers(stored.job))
    return compare(stored.steps, [line for line in again.lines if "step" in line])


def recorded(folder: Path, trial: str = "") -> Recorded:
    """A stored trial.

    Args:
        folder: an evaluation's, or that of a single trial.
        trial: an id of the evaluation, or its unique beginning; a single trial needs none.

    Raises UserError: no such trial, several of them, or its trace cannot be read."""
    if is_trial(folder):
        return _single(folder, trial)
    manifest = read_evaluation(folder)
    rows = read_trials(folder)
    name = the_one(rows, trial, folder, unit_of(manifest["plan"]))
    plan = make_plan(manifest["plan"])
    job = plan.trials_by_id().get(name)
    row = rows[name]
    if job is None:
        raise UserError(
            f"the plan in {folder / 'manifest.json'} has no {unit_of(manifest['plan'])} {name}; the plan was "
            "changed after it ran"
        )
    if row.error is not None:
        raise UserError(f"{name} ended in an error and has no trace: {row.error}")
    if isinstance(row, DriveTrialRow):
        fleet = job.fleet if isinstance(job, DriveSetup) else ()
        beside = [of_drive(folder, car, rows.get(car.id)) for car in fleet if car.id != name]
        return replace(of_drive(folder, job, row), beside=beside)
    stored = [line for line in read_trace(folder, job.id) if "step" in line]
    with closing(ForkServer()) as fork_server, agent_of(job, fork_server) as agent:
        channels = frozenset(agent.channels)
    return Recorded(job, stored, channels, row.agent_error)


def of_drive(folder: Path, job: TrialSetup, row: TrialRow | None) -> Recorded:
    """A stored drive; of a car that found no gap, there is nothing to play.

    Raises UserError: it has no trace otherwise, or that cannot be read."""
    if isinstance(row, DriveTrialRow) and row.error_kind == NoRoomError.__name__:
        return Recorded(job, (), frozenset())
    if not isinstance(row, DriveTrialRow) or row.error is not None:
        why = "it has not ended" if row is None else row.error
        raise UserError(f"{job.id}, which drove in the same traffic, has no trace: {why}")
    stored = [line for line in read_trace(folder, job.id) if "step" in line]
    return Recorded(job, stored, frozenset(row.channels), row.agent_error)


def the_one(ids: Collection[str], asked: str, folder: Path, what: str) -> str:
    """The one id that equals or begins with the given text. Raises UserError: there is none, or several."""
    matching = [name for name in ids if name == asked] or [name for name in ids if name.startswith(asked)]
    some = ", ".join(sorted(matching or ids)[:SHOWN]) or "none yet"
    if not matching:
        raise UserError(
            f"no {what} in {folder} begins with {asked!r}; its {counted(len(ids), what)}: {some}, ... "
            "(episodes.jsonl has the ids)"
        )
    if len(matching) > 1:
        raise UserError(
            f"{len(matching)} {what}s in {folder}{f' begin with {asked!r}' if asked else ''}, such as {some}; give "
            f"{'more of the' if asked else 'an'} id"
        )
    return matching[0]


def _single(folder: Path, trial: str) -> Recorded:
    if trial:
        raise UserError(f"{folder} holds a single run; omit {trial!r}")
    told, stored = read_trial(folder), read_steps(folder)
    job, row = _job(folder, told), (told.get("result") or {}) | (told.get("row") or {})
    if isinstance(job, DriveSetup) and job.settings.cars:
        raise UserError(f"{job.id} drove among others; give the folder of their evaluation, and this id")
    channels = frozenset(map(Channel, row["channels"])) if "channels" in row else _channels(job)
    return Recorded(job, stored, channels, row.get("agent_error"))


def _job(folder: Path, told: Json) -> TrialSetup:
    values = (told.get("manifest") or {}).get("setup")
    if values is None:
        raise UserError(f"{folder} does not say what was run; record the run again")
    where = str(folder / TRIAL)
    if "family" not in values:
        return read_setup(values, where)
    setup = checked(DriveSetup, values, lambda steps: (where, dotted(steps)))
    if (folder / TRIAL).is_file() or setup.scenario != family_named(setup.family).scenario:
        return setup
    return replace(setup, scenario="")  # earlier records named a family's own scenario too


def _channels(setup: TrialSetup) -> frozenset[Channel]:
    """The channels that its agent was given; no model is needed."""
    if setup.agent in PROFILES:
        without = setup.without if isinstance(setup, EpisodeSetup) else ()
        settings = AgentSettings(setup.conditions, parts(without))
        return PROFILES[setup.agent].under(settings).channels
    if setup.agent == ScriptedAgent.name:
        return ALL
    if setup.agent == NativeAgent.name:
        return frozenset(NativeAgent.channels)
    if is_remote(setup.agent):
        return CHANNELS
    return frozenset(make_agent(setup.agent, settings=AgentSettings(setup.conditions)).channels)


def played(
    stored: Recorded,
    *,
    simulations: Simulations | None = None,
    observers: Sequence[TrialObserver] = (),
    player: Player | None = None,
) -> tuple[TrialRow, Recorder]:
    """Plays the actions of a stored trial in the same setup, beside those of the other cars of its fleet; its row,
    and what an evaluation would keep of it.

    Args:
        simulations: warm simulations to use; by default its own.
        observers: notified of everything as it happens.
        player: used instead of a player of its steps.

    Raises:
        UserError: something in the setup does not exist.
        InfrastructureError: the simulation failed."""
    recorder = Recorder(stored.job, None)
    run = TrialRun(stored.job, player or stored.player, (recorder, *observers))
    if isinstance(stored.job, DriveSetup) and stored.job.settings.cars:
        others = [TrialRun(each.job, each.player) for each in stored.beside]
        row = played_together([run, *others], simulations)[stored.job.car]
    else:
        row = run_trial(run.trial, run.agent, (recorder, *observers), simulations=simulations)
    if row.error is not None:
        raise InfrastructureError(row.error)
    return row, recorder


def played_together(runs: Iterable[TrialRun], simulations: Simulations | None = None) -> Sequence[TrialRow]:
    """Plays the drives of all cars of a fleet; their rows, by the numbers of the cars."""
    cars = {trial.car: (trial, run) for run in runs if isinstance(trial := run.trial, DriveSetup)}
    drives, by_car = zip(*(cars[number] for number in sorted(cars)), strict=True)
    with ExitStack() as ends:
        return run_fleet(drives, by_car, simulations or ends.enter_context(closing(Simulations())))


def compare(stored: Sequence[Json], again: Sequence[Json]) -> list[Compared]:
    """Two traces, step by step; a step has its state, or its hashes alone."""
    compared = []
    for number, (before, now) in enumerate(zip_longest(stored, again, fillvalue=MISSING)):
        digest = hashlib.sha256(canonical([_digests(now or before), (now or before)["action"]])).hexdigest()
        compared.append(Compared(number, digest, tuple(_differs(before, now)) if before and now else ("length",)))
    return compared


def _differs(before: Json, now: Json) -> Iterator[str]:
    found = _digests(now)
    yield from (name for name, digest in _digests(before).items() if found[name] != digest)
    beside = ("action",) if "elements" in before else ("action", "feedback")  # where the screen itself is not kept
    yield from (name for name in beside if before[name] != now[name])


def _digests(step: Json) -> Json:
    return cast("Json", step["sha256"]) if "sha256" in step else digests(step)


class Player:
    """Plays the recorded actions, including answers that could not be read."""

    name, model = "replay", "none"

    def __init__(self, steps: Sequence[Json], channels: frozenset[Channel], failure: str | None) -> None:
        self.channels = channels
        self._failure = failure
        self._steps = iter(steps)
        self.thought_s = 0.0

    def reset(self, goal: str) -> None:
        """Does nothing."""

    def act(self, observation: Observation) -> Action:
        step = self.turn()
        if step["action"] is None:
            raise ActionError(step["feedback"]["text"])
        return parse(step["action"])

    def turn(self) -> Json:
        """The next recorded step.

        Raises:
            AgentError: the agent failed here.
            OutOfBudgetError: the recording ends here."""
        step = next(self._steps, None)
        if step is None and self._failure is not None:
            raise AgentError(self._failure)
        if step is None:
            raise OutOfBudgetError("the recording ends here")
        self.thought_s = step.get("thought_s", 0.0)
        return step
