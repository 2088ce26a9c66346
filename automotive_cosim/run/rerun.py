"""Repeats a stored trial's actions and compares the traces."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Collection, Sequence
from contextlib import closing
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import cast

from automotive_cosim.agents import PROFILES, AgentSettings, NativeAgent, make_agent
from automotive_cosim.agents.a2a import CHANNELS, is_remote
from automotive_cosim.agents.settings import parts
from automotive_cosim.cockpit.actions import parse
from automotive_cosim.contracts import Action, Json, Observation
from automotive_cosim.contracts.plain import counted
from automotive_cosim.drives.families import family_named
from automotive_cosim.errors import (
    ActionError,
    AgentError,
    InfrastructureError,
    OutOfBudgetError,
    UserError,
)
from automotive_cosim.formats import files
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.interface.trace import HASHED, canonical
from automotive_cosim.run.collect import Collector
from automotive_cosim.run.coverage import unit_of
from automotive_cosim.run.drive import DriveRecord, DriveSetup, run_drive
from automotive_cosim.run.drive_row import DriveTrialRow
from automotive_cosim.run.episode import EpisodeResult, EpisodeSetup, read_setup, run_episode
from automotive_cosim.run.episode_row import EpisodeRow
from automotive_cosim.run.fork_server import ForkServer
from automotive_cosim.run.jobs import DriveJob, EpisodeJob
from automotive_cosim.run.moments import Judged
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.row import from_json
from automotive_cosim.run.rows import read_trials
from automotive_cosim.run.script import ScriptedAgent
from automotive_cosim.run.settings import Pictures
from automotive_cosim.run.store import read_evaluation, read_trace
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
    """The parts of the step that differ, from ``trace.HASHED``, or ``"length"`` if one run has no such step."""


def rerun(folder: Path, trial: str = "") -> list[Compared]:
    """Plays the actions of a stored trial in the same setup and compares step by step.

    Args:
        folder: an evaluation's, or that of a single run or drive.
        trial: an id of the evaluation, or its unique beginning; a single run has none.

    Raises:
        UserError: no such trial, several of them, or its trace cannot be read.
        InfrastructureError: the simulation failed.
    """
    if (folder / "episode.json").is_file():
        return _single(folder, trial)
    if (folder / "row.json").is_file():
        return _single_drive(folder, trial)
    manifest = read_evaluation(folder)
    rows = read_trials(folder)
    name = the_one(rows, trial, folder, unit_of(manifest["plan"]))
    plan = make_plan(manifest["plan"])
    job = next((job for job in plan.jobs() if job.id == name), None)
    row = rows[name]
    if job is None:
        raise UserError(
            f"the plan in {folder / 'manifest.json'} has no {unit_of(manifest['plan'])} {name}; the plan was "
            "changed after it ran"
        )
    if row.error is not None:
        raise UserError(f"{name} ended in an error and has no trace: {row.error}")
    stored = [line for line in read_trace(folder, job.id) if "step" in line]
    if isinstance(job, DriveJob):
        return _drive_again(cast("DriveTrialRow", row), job, stored)
    with closing(ForkServer()) as fork_server, agent_of(job, fork_server) as agent:
        channels = frozenset(agent.channels)
    again = played(job, stored, channels, row.agent_error)
    return compare(stored, [line for line in again.lines if "step" in line])


def the_one(ids: Collection[str], asked: str, folder: Path, what: str) -> str:
    """The one id that equals or begins with the given text.

    Raises:
        UserError: there is none, or several.
    """
    matching = [name for name in ids if name == asked] or [name for name in ids if name.startswith(asked)]
    some = ", ".join(sorted(matching or ids)[:SHOWN]) or "none yet"
    if not matching:
        raise UserError(
            f"no {what} in {folder} begins with {asked!r}; its {counted(len(ids), what)}: {some}, ... "
            "(episodes.jsonl has the ids)"
        )
    if len(matching) > 1:
        raise UserError(
            f"{len(matching)} {what}s in {folder} begin with {asked!r}, such as {some}; give more of the id"
        )
    return matching[0]


def _single(folder: Path, episode: str) -> list[Compared]:
    """The same for the record of a single run."""
    if episode:
        raise UserError(f"{folder} holds a single run; omit {episode!r}")
    record = files.read_json(folder / "episode.json")
    steps = [files.parse_json(line) for line in (folder / "steps.jsonl").read_bytes().splitlines()]
    setup = read_setup(record["manifest"]["setup"], str(folder / "episode.json"))
    collector, _ = _again(setup, steps, _channels(setup), record["agent_error"])
    return compare(steps, collector.steps)


def _single_drive(folder: Path, drive: str) -> list[Compared]:
    """The same for the record of a single drive."""
    if drive:
        raise UserError(f"{folder} holds a single drive; omit {drive!r}")
    try:
        row = from_json(DriveTrialRow, files.read_json(folder / "row.json"))
        steps = [files.parse_json(line) for line in (folder / "steps.jsonl").read_bytes().splitlines()]
    except (OSError, ValueError) as error:
        raise UserError(f"cannot read the drive in {folder}: {error}") from error
    own = family_named(row.family).scenario
    scenario = "" if row.scenario == own else row.scenario
    setup = DriveSetup(
        row.family, row.seed, row.conditions, scenario, row.settings, agent=row.agent, model=row.model
    )
    return _drive_again(row, DriveJob(setup, row.repeat), steps)


def _drive_again(row: DriveTrialRow, job: DriveJob, steps: Sequence[Json]) -> list[Compared]:
    if not all("sha256" in step for step in steps):
        raise UserError(
            f"the trace of drive {row.id} has no hashes: it was stored by an earlier version; rerun the drive"
        )
    return compare_drives(steps, driven(job, row, steps).steps)


def _channels(setup: EpisodeSetup) -> frozenset[Channel]:
    """The channels that its agent was given; no model is needed."""
    if setup.agent in PROFILES:
        settings = AgentSettings(setup.conditions, parts(setup.without))
        return PROFILES[setup.agent].under(settings).channels
    if setup.agent == ScriptedAgent.name:
        return ALL
    if setup.agent == NativeAgent.name:
        return frozenset(NativeAgent.channels)
    if is_remote(setup.agent):
        return CHANNELS
    return frozenset(make_agent(setup.agent, settings=AgentSettings(setup.conditions)).channels)


def _again(
    setup: EpisodeSetup,
    stored: Sequence[Json],
    channels: frozenset[Channel],
    failure: str | None,
    simulations: Simulations | None = None,
) -> tuple[Collector, EpisodeResult]:
    collector = Collector(Pictures.NONE)
    result = run_episode(setup, Player(stored[1:], channels, failure), (collector,), simulations=simulations)
    if result.error is not None:
        raise InfrastructureError(result.error)
    return collector, result


@dataclass(frozen=True, slots=True)
class PlayedAgain:
    """What an evaluation would have kept of the replayed episode."""

    lines: list[Json]
    """Its trace, with the result as its last line."""
    row: EpisodeRow
    judged: Judged | None


def played(
    job: EpisodeJob,
    stored: Sequence[Json],
    channels: frozenset[Channel],
    failure: str | None = None,
    *,
    simulations: Simulations | None = None,
) -> PlayedAgain:
    """Plays the actions of a stored episode in the same setup.

    Args:
        job: the episode.
        stored: the steps of its trace.
        channels: those of its agent, on which the answers to queries depend.
        failure: how the agent's side failed after them, if it did.
        simulations: warm simulations to use; by default its own.

    Raises:
        UserError: something in the setup does not exist.
        InfrastructureError: the simulation failed.
    """
    collector, result = _again(job.setup, stored, channels, failure, simulations)
    return PlayedAgain(collector.trace(result), collector.row(job, result), collector.judged())


def driven(
    job: DriveJob, row: DriveTrialRow, stored: Sequence[Json], simulations: Simulations | None = None
) -> DriveRecord:
    """Plays the actions of a stored drive in the same setup.

    Args:
        job: the drive.
        row: its row, which says what its agent was given and how its side failed.
        stored: the steps of its trace.
        simulations: warm simulations to use; by default its own.

    Raises:
        UserError: something in the setup does not exist.
        InfrastructureError: the simulation failed.
    """
    player = Player(stored[1:], frozenset(row.channels), row.agent_error)
    return run_drive(job.planned(), job.setup, player, simulations=simulations)


def compare(stored: Sequence[Json], again: Sequence[Json]) -> list[Compared]:
    """Two traces of episodes, step by step."""

    def differs(before: Json, now: Json) -> tuple[str, ...]:
        return tuple(name for name in HASHED if canonical(before[name]) != canonical(now[name]))

    return _side_by_side(stored, again, differs, lambda step: {name: step[name] for name in HASHED})


def compare_drives(stored: Sequence[Json], again: Sequence[Json]) -> list[Compared]:
    """Two traces of drives, which hold hashes of the states, step by step."""

    def differs(before: Json, now: Json) -> tuple[str, ...]:
        states = tuple(name for name, digest in before["sha256"].items() if now["sha256"][name] != digest)
        return (*states, *(name for name in ("action", "feedback") if before[name] != now[name]))

    return _side_by_side(stored, again, differs, lambda step: [step["sha256"], step["action"]])


def _side_by_side(
    stored: Sequence[Json],
    again: Sequence[Json],
    differs: Callable[[Json, Json], tuple[str, ...]],
    hashed: Callable[[Json], object],
) -> list[Compared]:
    compared = []
    for number, (before, now) in enumerate(zip_longest(stored, again, fillvalue=MISSING)):
        digest = hashlib.sha256(canonical(hashed(now or before))).hexdigest()
        compared.append(Compared(number, digest, differs(before, now) if before and now else ("length",)))
    return compared


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
        """The next recorded action."""
        step = next(self._steps, None)
        if step is None and self._failure is not None:
            raise AgentError(self._failure)
        if step is None:
            raise OutOfBudgetError("the recording ends here")
        self.thought_s = step.get("thought_s", 0.0)
        if step["action"] is None:
            raise ActionError(step["feedback"]["text"])
        return parse(step["action"])
