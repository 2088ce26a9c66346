"""Replays a stored trial's recorded actions and compares everything that follows from them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path

from automotive_cosim.agents import AgentSettings, make_agent
from automotive_cosim.contracts import ActionType, Json
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.interface.trace import SAID
from automotive_cosim.publish.episodes import FROM_MOMENTS
from automotive_cosim.publish.problems import ROWS, Problem, differences
from automotive_cosim.run.drive import JudgedDrive
from automotive_cosim.run.drive_row import DriveTrialRow
from automotive_cosim.run.moments import Judged, judged_file, read_judged
from automotive_cosim.run.record import Recorder
from automotive_cosim.run.rerun import compare, played
from automotive_cosim.run.row import as_json, steady
from automotive_cosim.run.store import read_trace, trace_file
from automotive_cosim.run.trial import TrialSetup
from automotive_cosim.run.trial_row import TrialRow
from automotive_cosim.traffic.fork import Simulations

OF_THE_AGENT = frozenset({"prompt_tokens", "calls", "tokens_in", "tokens_out", "cost_usd", "end"})
"""Fields of a row that the actions do not determine."""
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


def replay(folder: Path, job: TrialSetup, row: TrialRow, simulations: Simulations) -> tuple[Problem, ...]:
    """What differs, bit for bit, when the actions of a stored trial are replayed.

    Raises:
        CosimError: it cannot be replayed.
    """
    *steps, last = read_trace(folder, row.id)
    found: tuple[Problem, ...] = ()
    for channels in [frozenset(row.channels)] if isinstance(row, DriveTrialRow) else _channels(job, steps):
        again = played(job, steps, channels, row.agent_error, simulations=simulations)
        found = tuple(_differences(folder, row, steps, last, *again))
        if not found:
            break
    return found


def _channels(job: TrialSetup, steps: Sequence[Json]) -> list[frozenset[Channel]]:
    """The channels that its agent may have had; no foreign agent is loaded to find out."""
    if ":" not in job.agent:
        settings = AgentSettings(job.conditions, seed=job.seed)
        return [frozenset(make_agent(job.agent, "rules", settings).channels)]  # whatever its model
    asks = any(step["action"] and step["action"]["action_type"] == ActionType.QUERY for step in steps)
    return [ALL, ALL - {Channel.GPS}, ALL - {Channel.CONTEXT}] if asks else [ALL]


def _differences(
    folder: Path, row: TrialRow, steps: Sequence[Json], last: Json, new_row: TrialRow, again: Recorder
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
    yield from differences(file, "result", last["result"], new_last["result"], names, "its replay")
    names = [name for name in steady(row) if name not in OF_THE_AGENT]
    yield from differences(ROWS, row.id, as_json(row), as_json(new_row), names, "its replay")
    path, kind = judged_file(folder, row.id), JudgedDrive if isinstance(row, DriveTrialRow) else Judged
    if read_judged(folder, row.id, kind) != again.judged:
        yield Problem(path.relative_to(folder).as_posix(), "", "differs from its replay")
