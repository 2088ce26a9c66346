"""Replays a stored trial and compares everything that follows.

An agent of this package that asks a model runs again, and gets the answers on record in place of the model's: so
its questions, and what it made of the answers, are compared too. Of other agents the recorded actions are replayed.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from automotive_cosim.agents import MODELLED, Agent, AgentSettings, make_agent
from automotive_cosim.agents.base import Stage, Thinker
from automotive_cosim.contracts import Action, ActionType, Json, Observation
from automotive_cosim.contracts.given import Hearing
from automotive_cosim.episode.specification import End
from automotive_cosim.errors import ModelError, OutOfBudgetError, UserError
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.interface.trace import SAID
from automotive_cosim.models.base import ChatMessage, ModelReply, digest
from automotive_cosim.models.replay import Replay
from automotive_cosim.publish.episodes import FROM_MOMENTS
from automotive_cosim.publish.problems import ROWS, Problem, differences
from automotive_cosim.run.drive import DriveSetup, JudgedDrive
from automotive_cosim.run.job_row import as_json, steady
from automotive_cosim.run.moments import Judged, in_its_fields, judged_file, read_judged
from automotive_cosim.run.record import Recorder
from automotive_cosim.run.rerun import Player, Recorded, compare, of_drive, played, played_together
from automotive_cosim.run.rows import DriveTrialRow, TrialRow
from automotive_cosim.run.store import read_trace, trace_file
from automotive_cosim.run.trial import TrialRun, TrialSetup
from automotive_cosim.traffic.fork import Simulations

OF_THE_AGENT = frozenset({"prompt_tokens", "calls", "tokens_in", "tokens_out", "cost_usd", "end"})
"""Fields of a row that the actions do not determine; the answers do, unless the last turn was cut off."""
OF_THE_CATALOGUE = "half_digest"
"""A field that rows of 0.2.0 lack, and that is compared with the catalogue."""
OF_ITS_THOUGHTS = ("thought", "stages")
"""Fields of a step that the answers determine."""
RESULT = (
    "goal",
    "traffic_seed",
    "verdict",
    "timeline",
    "path",
    "violations",
    "estimates",
    "notes",
    "load",
    "drive",
    "baseline_drive",
)
"""Fields of the result at the end of a trace that the actions determine."""
STEP = ("time_s", *FROM_MOMENTS, "elements", "action", "feedback", "thought_s", SAID, "heard")


class Replayed(NamedTuple):
    """What came of a replay."""

    problems: tuple[Problem, ...]
    has_asked: bool | None
    """Whether its agent put the recorded questions again; False if this version asks otherwise, None if it has no
    questions on record."""


def replay(folder: Path, job: TrialSetup, row: TrialRow, simulations: Simulations) -> Replayed:
    """What differs, bit for bit, when a stored trial is replayed. Raises CosimError: it cannot be replayed."""
    *steps, last = read_trace(folder, row.id)
    agent = _answered(job, row, steps)
    if agent is not None:
        again = played(Recorded(job, steps, agent.channels), simulations=simulations, player=agent)
        if not agent.asks_otherwise:
            return Replayed(tuple(_differences(folder, row, steps, last, *again, OF_ITS_THOUGHTS)), True)
    found: tuple[Problem, ...] = ()
    for channels in [frozenset(row.channels)] if isinstance(row, DriveTrialRow) else _channels(job, steps):
        again = played(Recorded(job, steps, channels, row.agent_error), simulations=simulations)
        found = tuple(_differences(folder, row, steps, last, *again))
        if not found:
            break
    return Replayed(found, None if agent is None else False)


def replay_fleet(
    folder: Path, cars: Sequence[DriveSetup], rows: Mapping[str, TrialRow], simulations: Simulations
) -> Replayed:
    """The same of a fleet, all of whose cars drive again.

    Args:
        cars: all of the fleet.

    Raises CosimError: it cannot be replayed."""
    recorders = [Recorder(car, None) for car in cars]
    stored = [of_drive(folder, car, rows.get(car.id)) for car in cars]
    runs = [TrialRun(car.job, car.player, (each,)) for car, each in zip(stored, recorders, strict=True)]
    found = []
    for new_row, again in zip(played_together(runs, simulations), recorders, strict=True):
        row = rows[new_row.id]
        if row.error_kind != new_row.error_kind:
            why = f"its drive ends with {new_row.error_kind} instead of {row.error_kind} when its fleet is replayed"
            found.append(Problem(ROWS, row.id, why))
        elif row.error is None:
            *steps, last = read_trace(folder, row.id)
            found += _differences(folder, row, steps, last, new_row, again)
    return Replayed(tuple(found), None)


class _Answered(Player):
    """The agent itself, which gets the recorded answers."""

    def __init__(self, agent: Agent, steps: Sequence[Json], failure: str | None) -> None:
        super().__init__(steps[1:], frozenset(agent.channels), failure)
        self._agent = agent
        self.asks_otherwise = False
        """Whether a question differs from the recorded one, at which the trial ends."""

    @property
    def stages(self) -> Sequence[Stage]:
        """Those of the agent's last turn."""
        return self._agent.stages if isinstance(self._agent, Thinker) else ()

    def reset(self, goal: str) -> None:
        self._agent.reset(goal)

    def act(self, observation: Observation) -> Action:
        """The agent's answer, for as long as there are recorded turns."""
        self.turn()
        try:
            return self._agent.act(observation)
        except ModelError as error:
            self.asks_otherwise = True
            raise OutOfBudgetError(str(error)) from error


def _answered(job: TrialSetup, row: TrialRow, steps: Sequence[Json]) -> _Answered | None:
    """The agent of a trial with its recorded answers; None if it has no model, is not of this package, or was given
    what is not on record: sound, or instructions from a file.

    Raises UserError: the answers cannot be read."""
    if job.agent not in MODELLED or job.conditions.hear is Hearing.AUDIO or job.conditions.prompt.file:
        return None
    try:
        asked = [stage for step in steps for stage in step.get("stages", ()) if stage["reply"]]
        answers = [("" if each["pictures"] else each["asked"], ModelReply(**each["reply"])) for each in asked]
    except (LookupError, TypeError, ValueError, AttributeError) as error:
        raise UserError(f"its model's answers cannot be read: {type(error).__name__}: {error}") from error
    if not answers:
        return None
    limits = job.limits
    settings = AgentSettings(job.conditions, most_tokens=limits.tokens, most_seconds=limits.model_s)
    model = Replay(answers, any(each["pictures"] for each in asked), _digest)
    return _Answered(make_agent(job.agent, job.asked_model, settings, model), steps, row.agent_error)


def _digest(messages: Sequence[ChatMessage]) -> str:
    """A question's digest; none if it has pictures, which may differ by a pixel from one machine to another."""
    return "" if any(message.pictures for message in messages) else digest(messages)


def _thoughts(step: Json) -> Json:
    """A step whose questions with pictures have no digest."""
    stages = [stage | ({"asked": ""} if stage["pictures"] else {}) for stage in step["stages"]]
    return step | {"stages": stages}


def _channels(job: TrialSetup, steps: Sequence[Json]) -> list[frozenset[Channel]]:
    """The channels that its agent may have had; no foreign agent is loaded to find out."""
    if ":" not in job.agent:
        settings = AgentSettings(job.conditions, seed=job.seed)
        return [frozenset(make_agent(job.agent, "rules", settings).channels)]  # whatever its model
    asks = any(step["action"] and step["action"]["action_type"] == ActionType.QUERY for step in steps)
    return [ALL, ALL - {Channel.GPS}, ALL - {Channel.CONTEXT}] if asks else [ALL]


def _differences(
    folder: Path,
    row: TrialRow,
    steps: Sequence[Json],
    last: Json,
    new_row: TrialRow,
    again: Recorder,
    thoughts: Sequence[str] = (),
) -> Iterator[Problem]:
    *new_steps, new_last = json.loads(json.dumps(again.lines))
    file = trace_file(folder, row.id).relative_to(folder).as_posix()
    if isinstance(row, DriveTrialRow):
        names = list(new_last["result"])
        for compared in compare(steps, new_steps):
            for name in compared.differs:
                yield Problem(file, f"step {compared.number} {name}", "differs from its replay")
    else:
        names = [name for name in RESULT if name in last["result"]]
        if len(steps) != len(new_steps):
            yield Problem(file, "", f"has {len(steps)} steps, but {len(new_steps)} when replayed")
        for number, (step, new) in enumerate(zip(steps, new_steps, strict=False)):
            yield from differences(file, f"step {number}", step, new, STEP, "its replay")
            if thoughts:
                told = _thoughts(step), _thoughts(new)
                yield from differences(file, f"step {number}", *told, thoughts, "its replay")
    yield from differences(file, "result", last["result"], new_last["result"], names, "its replay")
    cut_off = row.end in (End.OUT_OF_BUDGET, End.AGENT_FAILED)
    of_the_agent = frozenset() if thoughts and not cut_off else OF_THE_AGENT
    names = [name for name in steady(row) if name not in {OF_THE_CATALOGUE, *of_the_agent}]
    yield from differences(ROWS, row.id, as_json(row), as_json(new_row), names, "its replay")
    path, kind = judged_file(folder, row.id), JudgedDrive if isinstance(row, DriveTrialRow) else Judged
    written, judged = read_judged(folder, row.id, kind), again.judged
    if judged is None or written != in_its_fields(folder, row.id, judged):
        yield Problem(path.relative_to(folder).as_posix(), "", "differs from its replay")
