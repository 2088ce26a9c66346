"""One instance that shows the effect of place: an agent's episode with geo-context and one without."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.formats.files import read_bytes
from automotive_cosim.formats.layout import PICTURES
from automotive_cosim.report.findings import PLACE
from automotive_cosim.report.page import embedded
from automotive_cosim.report.plot import Plot
from automotive_cosim.report.results import Results
from automotive_cosim.run.episode import EpisodeResult
from automotive_cosim.run.episode_row import EpisodeRow
from automotive_cosim.run.row import from_json
from automotive_cosim.run.store import read_trace, trace_file
from automotive_cosim.run.trial_folder import pictures, shown

CONTROLS = ("none", "irrelevant", "wrong", "gps", "context")
"""Geo controls to compare with full geo-context, the clearest contrast first."""


@dataclass(frozen=True, slots=True)
class Side:
    """One of the two episodes, ready to be shown."""

    row: EpisodeRow
    result: EpisodeResult
    wide: Plot
    narrow: Plot
    steps: tuple[tuple[str, str, str], ...]
    """Seconds since the hand-over, the action, and the thought behind it."""
    picture: str
    """The cockpit at the end, as a data URL; empty if no pictures were kept."""


def contrast(results: Results) -> tuple[Side, Side] | None:
    """An instance that the same agent solved with geo-context and not without; None if there is none.

    Pairs that depend on place come first, then other safety tasks, each in the order of their ids.
    """
    rows = [row for row in results.rows if row.success is not None and _has_trace(results, row)]
    solved = {_key(row): row for row in rows if row.conditions.geo == "full" and row.success}
    found = [
        (PLACE not in row.tags, not row.pair, CONTROLS.index(row.conditions.geo), row.id, row)
        for row in rows
        if row.conditions.geo in CONTROLS and not row.success and _key(row) in solved
    ]
    if not found:
        return None
    *_, without = min(found, key=lambda each: each[:-1])
    return _side(results.folder, solved[_key(without)]), _side(results.folder, without)


def _key(row: EpisodeRow) -> tuple[object, ...]:
    return row.agent, row.model, *row.instance


def _has_trace(results: Results, row: EpisodeRow) -> bool:
    return trace_file(results.folder, row.id).is_file()


def _side(folder: Path, row: EpisodeRow) -> Side:
    *steps, last = read_trace(folder, row.id)
    result = from_json(EpisodeResult, last["result"])
    screens = pictures(folder / PICTURES / row.id)
    return Side(
        row,
        result,
        Plot(result.path, result.timeline, 480, 260),
        Plot(result.path, result.timeline, 360, 240),
        tuple(_told(steps)),
        embedded(read_bytes(screens[-1]), "jpeg") if screens else "",
    )


def _told(steps: Sequence[Json]) -> list[tuple[str, str, str]]:
    return [(f"{before['at_s']:+.1f} s", step["words"], step["thought"]) for before, step in pairwise(shown(steps))]
