"""Replays drives: a stored drive's actions once more, compared with what was stored step by step."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from itertools import zip_longest
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.drives.families import family_named
from automotive_cosim.errors import UserError
from automotive_cosim.formats import files
from automotive_cosim.interface.trace import canonical
from automotive_cosim.run.rerun import MISSING, Compared, Player, the_one
from automotive_cosim.run.row import from_json
from automotive_cosim.run.store import read_manifest, read_rows, read_trace
from automotive_cosim.run.watch import WatchRecord, WatchSetup, run_watch
from automotive_cosim.run.watch_row import WatchRow
from automotive_cosim.traffic.fork import Simulations


def holds_drives(folder: Path) -> bool:
    """Whether a folder holds a single drive, or an evaluation of drives.

    Raises:
        UserError: it holds no results.
    """
    if (folder / "episode.json").is_file():
        return False
    return (folder / "row.json").is_file() or "drives" in read_manifest(folder)["plan"]


def rewatch(folder: Path, drive: str = "") -> list[Compared]:
    """Plays the actions of a stored drive in the same setup and compares step by step.

    Args:
        folder: an evaluation's, or that of a single drive.
        drive: an id of the evaluation, or its unique beginning; a single drive has none.

    Raises:
        UserError: no such drive, several of them, or what is stored cannot be read.
        InfrastructureError: the simulation failed.
    """
    row, steps = _single(folder, drive) if (folder / "row.json").is_file() else _stored(folder, drive)
    if row.error is not None:
        raise UserError(f"drive {row.id} ended in an error and has no trace: {row.error}")
    if not all("sha256" in step for step in steps):
        raise UserError(
            f"the trace of drive {row.id} has no hashes: it was stored by an earlier version; rerun the drive"
        )
    return compare(steps, watched(row, steps).steps)


def watched(row: WatchRow, steps: Sequence[Json], simulations: Simulations | None = None) -> WatchRecord:
    """Plays the actions of a stored drive in the same setup.

    Args:
        row: its row.
        steps: those of its trace.
        simulations: warm simulations to use; by default its own.

    Raises:
        UserError: something in the setup does not exist.
        InfrastructureError: the simulation failed.
    """
    setup = WatchSetup(
        row.family,
        row.seed,
        row.agent,
        row.model,
        row.conditions,
        row.repeat,
        "" if row.scenario == family_named(row.family).scenario else row.scenario,
    )
    player = Player(steps[1:], frozenset(row.channels), row.agent_error)
    return run_watch(row.id, setup, player, simulations=simulations)


def compare(stored: Sequence[Json], again: Sequence[Json]) -> list[Compared]:
    """Two recordings of a drive, step by step."""
    compared = []
    for number, (before, now) in enumerate(zip_longest(stored, again, fillvalue=MISSING)):
        found = hashlib.sha256(canonical([(now or before)["sha256"], (now or before)["action"]])).hexdigest()
        compared.append(Compared(number, found, _differs(before, now) if before and now else ("length",)))
    return compared


def _differs(before: Json, now: Json) -> tuple[str, ...]:
    states = tuple(name for name, digest in before["sha256"].items() if now["sha256"][name] != digest)
    return (*states, *(name for name in ("action", "feedback") if before[name] != now[name]))


def _single(folder: Path, drive: str) -> tuple[WatchRow, list[Json]]:
    if drive:
        raise UserError(f"{folder} holds a single drive; omit {drive!r}")
    try:
        row = from_json(WatchRow, files.read_json(folder / "row.json"))
        lines = (folder / "steps.jsonl").read_bytes().splitlines()
        return row, [files.parse_json(line) for line in lines]
    except (OSError, ValueError) as error:
        raise UserError(f"cannot read the drive in {folder}: {error}") from error


def _stored(folder: Path, drive: str) -> tuple[WatchRow, list[Json]]:
    rows = read_rows(folder, WatchRow)
    row = rows[the_one(rows, drive, folder, "drive")]
    if row.error is not None:
        return row, []
    return row, read_trace(folder, row.id)
