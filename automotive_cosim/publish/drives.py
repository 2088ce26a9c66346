"""Checks one stored drive: its row, its trace, and the judgement of its stored events and acts."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path

from automotive_cosim.contracts import ActionType, Json
from automotive_cosim.drives.harm import distraction_s
from automotive_cosim.episode.specification import End
from automotive_cosim.publish.problems import ROWS, Problem, differences
from automotive_cosim.run.drive import JudgedDrive
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.moments import read_judged
from automotive_cosim.run.rows import DriveTrialRow
from automotive_cosim.run.store import read_trace, trace_file

PLANNED = ("family", "season", "scenario", "settings", "agent", "model", "conditions", "seed", "repeat", "split")
"""Fields of a row that the plan determines."""
UNJUDGED = ("score", "value", "harm", "baseline_harm", "events", "acts", "trace_sha256")
"""Fields of a row that a drive without a judgement leaves at their defaults."""
ENDS = frozenset({End.DRIVE_ENDED, End.MINUTES_OVER, End.OUT_OF_STEPS, End.OUT_OF_BUDGET, End.AGENT_FAILED})


def drive_problems(folder: Path, row: DriveTrialRow, told: Json) -> Iterator[Problem]:
    """Everything that is wrong with a judged drive.

    Args:
        folder: an evaluation's or an unpacked bundle's."""
    *steps, last = read_trace(folder, row.id)
    file = trace_file(folder, row.id).relative_to(folder).as_posix()
    if [step["step"] for step in steps] != list(range(len(steps))) or "result" not in last:
        yield Problem(file, "", "lacks a step, or its result")
    stored = read_judged(folder, row.id, JudgedDrive)
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


def _listed(events: Sequence[object], acts: Sequence[object]) -> tuple[tuple[str, Sequence[object]], ...]:
    return ("events", events), ("acts", acts)
