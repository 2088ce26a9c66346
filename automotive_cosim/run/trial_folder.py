"""Reads the folder of a trial (``formats.layout``), of one that runs or was killed too."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from automotive_cosim.cockpit.actions import action_in_words, parse
from automotive_cosim.contracts import KMH_PER_MPS, Element, Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import read_json, read_whole_lines
from automotive_cosim.formats.layout import PACKED_STEPS, PICTURES, ROAD, SCREENSHOTS, STEPS, TRIAL, steps_in
from automotive_cosim.interface.trace import element
from automotive_cosim.run.store import read_trace, trace_file

FORMER = ("episode.json", "shown.jsonl")
"""Files in place of ``trial.json`` in what version 0.2 and earlier ones recorded, which this one does not read."""
READ = (TRIAL, STEPS, PACKED_STEPS, ROAD, *FORMER)
"""Every file of a trial's folder that is read, except its screenshots."""


def is_trial(folder: Path) -> bool:
    """Whether the steps of a trial are recorded in a folder."""
    return steps_in(folder).is_file()


def trace_of(folder: Path) -> Path | None:
    """The trace of a trial of an evaluation, which has all its steps; None of another, and if there is none."""
    path = trace_file(folder.parent.parent, folder.name)
    return path if folder.parent.name == PICTURES and path.is_file() else None


def read_trial(folder: Path) -> Json:
    """``manifest``, ``row`` and ``result`` of a trial; of one of an evaluation without pictures, the result.

    What is not known yet is left out.

    Raises UserError: it cannot be read, or version 0.2 or an earlier one wrote it."""
    path = folder / TRIAL
    if not path.is_file() and (found := next((name for name in FORMER if (folder / name).is_file()), None)):
        raise UserError(
            f"{folder} has {found} in place of {TRIAL}: version 0.2 or an earlier one recorded it; read it with "
            "that version, or record the run again"
        )
    try:
        told = read_json(path) if path.is_file() else None
    except (OSError, ValueError, LookupError, TypeError, AttributeError) as error:
        raise UserError(f"cannot read the run in {folder}: {error}") from error
    if told is None and (trace := trace_of(folder)):
        told = {"result": read_trace(trace.parent.parent, folder.name)[-1].get("result")}
    told = {} if told is None else told
    if not isinstance(told, dict) or not all(isinstance(part, dict | None) for part in told.values()):
        raise UserError(f"{path} is not a record of a run")
    return told


def read_steps(folder: Path) -> list[Json]:
    """The lines of a trial's steps so far, in the form of ``steps.jsonl``; none of a folder without any.

    Raises UserError: they cannot be read."""
    path = steps_in(folder)
    try:
        lines = read_whole_lines(path) if path.is_file() else []
        if not lines and (trace := trace_of(folder)):
            lines = read_trace(trace.parent.parent, folder.name)[:-1]
        return lines if not lines or "words" in lines[0] else shown(lines)
    except (OSError, ValueError, LookupError, TypeError, AttributeError) as error:
        raise UserError(f"cannot read the steps in {folder}: {type(error).__name__}: {error}") from error


def pictures(folder: Path) -> list[Path]:
    """The screenshots of a trial in order."""
    return sorted((folder / SCREENSHOTS).glob("step_*"))


def shown(lines: Sequence[Json]) -> list[Json]:
    """A trace's lines with what a page shows of each step; an action refers to the elements of the step before."""
    told = []
    seen: tuple[Element, ...] = ()
    for line in lines:
        action = None if line["action"] is None else parse(line["action"])
        about = {
            "at_s": round(line["time_s"] - lines[0]["time_s"], 2),
            "words": action_in_words(action, seen) if line["step"] else "hand-over",
            "target": target(action.index if action else None, seen),
            "speed_kmh": round(line["traffic"]["speed_mps"] * KMH_PER_MPS, 1),
            "picture": line["step"],
        }
        told.append(line | about)
        seen = tuple(map(element, line["elements"]))
    return told


def target(index: int | None, seen: Sequence[Element]) -> list[int] | None:
    """The box of the element that an action points at: left, top, right, bottom."""
    if index is None or not 0 <= index < len(seen):
        return None
    box = seen[index].bbox_pixels
    return [box.x_min, box.y_min, box.x_max, box.y_max]
