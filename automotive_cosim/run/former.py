"""What earlier versions wrote, in the present form; nothing else reads theirs.

0.1    had modes: ``prompted``, which every episode is now, and ``monitoring``, now drives
0.2    had each condition as a field of rows, setups and results; in plans ``latency`` for ``latency_s``, and one
       clock; plans of drives apart from those of tasks, with their own ``wall_s``; files for timelines; drives
       whose ``watch_over``; questions after so many ``deeds``; in the folder of a run ``episode.json`` and PNG, in
       that of a drive ``row.json``, ``timeline.json`` and ``shown.jsonl``, in an evaluation the screenshots of an
       episode alone
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import FeedbackDetail
from automotive_cosim.episode.conditions import TABLE
from automotive_cosim.episode.specification import End
from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import read_json, read_whole_lines

INSTEAD = "drives have replaced monitoring: `automotive-cosim drive`, and `automotive-cosim eval --drives all`"
NAMES = frozenset(each.name for each in TABLE)
END = "watch_over"
"""How a drive ended whose time was over."""
MOVED = {"automotive_cosim.cosim:Moment": "automotive_cosim.cosim.moment:Moment"}
"""Present places of classes in a judge's input."""
FIELDS = {"idle": "baseline"}
"""Present names of their fields."""
KEYS = {"deeds": "commands"}
"""Present names of keys in what they hold."""
EPISODE, ROW, TIMELINE, SHOWN = FILES = ("episode.json", "row.json", "timeline.json", "shown.jsonl")
"""Files of a trial's folder in place of ``trial.json``, and of a drive's beside ``steps.jsonl``."""


def plan_values(values: Mapping[str, Any], where: str) -> dict[str, Any]:
    """A plan's values; a condition with one value may be given without brackets.

    Args:
        values: its fields.
        where: what they were read from.

    Raises:
        UserError: it has another mode than ``prompted``.
    """
    made = _without_mode(values, where)
    if "latency" in made:
        made.setdefault("latency_s", made.pop("latency"))
    if "wall_s" in made:  # a plan of drives
        made["limits"] = made.get("limits", {}) | {"drive_wall_s": made.pop("wall_s")}
    return {
        name: [value] if name in NAMES and isinstance(value, str | int | float) else value
        for name, value in made.items()
    }


def setup_values(values: Mapping[str, Any], where: str) -> dict[str, Any]:
    """An episode's setup.

    Raises:
        UserError: it has another mode than ``prompted``.
    """
    return trial_values(_without_mode(values, where))


def trial_values(values: Mapping[str, Any]) -> dict[str, Any]:
    """A row, setup or result with its end by its present name, and its conditions in a table of their own.

    Before there was a choice of feedback, it was verbose.
    """
    made = {**values, "end": str(End.MINUTES_OVER)} if values.get("end") == END else dict(values)
    if "conditions" in made or not NAMES & made.keys():
        return made
    found = {"feedback": str(FeedbackDetail.VERBOSE)} | {name: made[name] for name in NAMES & made.keys()}
    return {name: value for name, value in made.items() if name not in NAMES} | {"conditions": found}


def former_timeline(folder: Path, drive: str) -> Json | None:
    """The timeline of a drive of 0.2, which had a file of its own; None if there is none."""
    path = folder / "timelines" / f"{drive}.json"
    return json.loads(path.read_text("utf-8")) if path.is_file() else None


def former_trial(folder: Path) -> Json | None:
    """What ``trial.json`` says of a trial, from the files of 0.2; None if it has none of them.

    Raises:
        OSError, ValueError: they cannot be read.
    """
    if (folder / EPISODE).is_file():
        result = read_json(folder / EPISODE)
        return {"result": result, "manifest": result.get("manifest", {})}
    if not (folder / SHOWN).is_file():
        return None
    row = read_json(folder / ROW) if (folder / ROW).is_file() else {}
    timeline = read_json(folder / TIMELINE) if (folder / TIMELINE).is_file() else None
    names = ("family", "seed", "scenario", "settings", "agent", "model")
    setup = {name: row[name] for name in names if name in row} | {"conditions": trial_values(row).get("conditions")}
    return {"row": row, "result": {"timeline": timeline}, "manifest": {"setup": {"family": "", **setup}}}


def former_steps(folder: Path, lines: Sequence[Json]) -> list[Json] | None:
    """The lines of a drive's steps, of which a page showed others than a replay compared; None of another trial.

    Args:
        folder: the trial's.
        lines: of its ``steps.jsonl``.

    Raises:
        OSError, ValueError: they cannot be read.
    """
    path = folder / SHOWN
    if not path.is_file():
        return None
    compared = {line["step"]: line for line in lines}
    return [line | compared.get(line["number"], {}) | {"step": line["number"]} for line in read_whole_lines(path)]


def former_screenshots(path: Path) -> tuple[Path, ...]:
    """Where the screenshot with this path may be instead."""
    return path.with_suffix(".png"), path.parent.parent / path.name


def present(line: bytes) -> bytes:
    """A trial's line in the present form; one that is no JSON object, as it is."""
    if b'"conditions":' in line and END.encode() not in line:
        return line
    try:
        values = json.loads(line)
    except ValueError:
        return line
    return json.dumps(trial_values(values)).encode() if isinstance(values, dict) else line


def _without_mode(values: Mapping[str, Any], where: str) -> Json:
    for name in ("mode", "modes"):
        if name in values and values[name] not in ("prompted", ["prompted"]):
            raise UserError(f"{where} has an older format: its {name} is {values[name]!r}; {INSTEAD}")
    return {name: value for name, value in values.items() if name not in ("mode", "modes")}
