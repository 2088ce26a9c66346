"""Checks one stored drive: its row against the plan, its trace, and the judgement of its stored events and acts."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path

from automotive_cosim.contracts import ActionType, Json
from automotive_cosim.drives.harm import distraction_s
from automotive_cosim.episode.specification import End
from automotive_cosim.publish.problems import ROWS, Problem, attempt_problems, differences
from automotive_cosim.run.drive import JudgedDrive
from automotive_cosim.run.drive_row import DriveTrialRow
from automotive_cosim.run.jobs import DriveJob
from automotive_cosim.run.moments import judged_file, read_value
from automotive_cosim.run.rerun import compare_drives, driven
from automotive_cosim.run.row import as_json, steady
from automotive_cosim.run.store import read_trace, trace_file
from automotive_cosim.run.trial_row import LATER
from automotive_cosim.traffic.fork import Simulations

PLANNED = ("family", "season", "scenario", "settings", "agent", "model", "conditions", "seed", "repeat", "split")
"""Fields of a row that the plan determines."""
UNJUDGED = ("score", "value", "harm", "baseline_harm", "events", "acts", "trace_sha256")
"""Fields of a row that a drive without a judgement leaves at their defaults."""
OF_THE_AGENT = frozenset({"calls", "tokens_in", "tokens_out", "cost_usd", "end"})
"""Fields of a row that the actions do not determine."""
ENDS = frozenset({End.DRIVE_ENDED, End.WATCH_OVER, End.OUT_OF_BUDGET, End.AGENT_FAILED})


def drive_problems(folder: Path, job: DriveJob, row: DriveTrialRow) -> Iterator[Problem]:
    """Everything that is wrong with a drive.

    Args:
        folder: an evaluation's or an unpacked bundle's.
        job: the drive in the plan.
        row: its row.
    """
    told, planned = as_json(row), as_json(job.planned())
    yield from differences(ROWS, row.id, told, planned, PLANNED, "the plan")
    yield from attempt_problems(row)
    if row.score is None:
        yield from differences(ROWS, row.id, told, planned, UNJUDGED, "its error")
        if row.error is None or row.error_kind is None or row.end is not End.ERROR:
            yield Problem(ROWS, row.id, "has neither a judgement nor an error")
        return
    *steps, last = read_trace(folder, row.id)
    file = trace_file(folder, row.id).relative_to(folder).as_posix()
    if [step["step"] for step in steps] != list(range(len(steps))) or "result" not in last:
        yield Problem(file, "", "lacks a step, or its result")
    stored = read_value(judged_file(folder, row.id), JudgedDrive)
    events, acts, score = stored.judgement()
    actions = [step["action"] for step in steps if step["action"] is not None]
    texts = [str(action["text"]) for action in actions if action.get("text")]
    expected: Json = {
        **{
            name: json.loads(json.dumps([as_json(each) for each in found])) for name, found in _listed(events, acts)
        },
        "score": json.loads(json.dumps(as_json(score))),
        "value": score.value,
        "steps": len(steps) - 1,
        "waits": sum(action["action_type"] == ActionType.WAIT for action in actions),
        "thought_s": round(sum(step["thought_s"] for step in steps), 3),
        "distraction_s": distraction_s(stored.acts, texts),
        "error": None,
        "error_kind": None,
    }
    told = json.loads(json.dumps(told))
    yield from differences(ROWS, row.id, told, expected, expected, "its trace and the judgement of its events")
    if row.end not in ENDS or (row.end is End.AGENT_FAILED) != (row.agent_error is not None):
        yield Problem(ROWS, f"{row.id} end", f"is {row.end}, which no drive with this agent_error has")


def drive_differences(
    folder: Path, job: DriveJob, row: DriveTrialRow, simulations: Simulations
) -> Iterator[Problem]:
    """What differs, bit for bit, when the actions of a stored drive are replayed.

    Raises:
        CosimError: it cannot be replayed.
    """
    *steps, last = read_trace(folder, row.id)
    again = driven(job, row, steps, simulations)
    file = trace_file(folder, row.id).relative_to(folder).as_posix()
    for step in compare_drives(steps, json.loads(json.dumps(again.steps))):
        for name in step.differs:
            yield Problem(file, f"step {step.number} {name}", "differs from its replay")
    result = json.loads(json.dumps(again.lines[-1]["result"]))
    yield from differences(file, "result", last["result"], result, result, "its replay")
    unknown = OF_THE_AGENT | (LATER if row.malformed is None else frozenset())
    names = [name for name in steady(row) if name not in unknown]
    yield from differences(ROWS, row.id, as_json(row), as_json(again.row), names, "its replay")
    path = judged_file(folder, row.id)
    if read_value(path, JudgedDrive) != again.judged:
        yield Problem(path.relative_to(folder).as_posix(), "", "differs from its replay")


def _listed(events: Sequence[object], acts: Sequence[object]) -> tuple[tuple[str, Sequence[object]], ...]:
    return ("events", events), ("acts", acts)
