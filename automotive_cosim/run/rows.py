"""The rows of an evaluation, of tasks and drives alike."""

from __future__ import annotations

from pathlib import Path

from automotive_cosim.run.drive_row import DriveTrialRow
from automotive_cosim.run.episode_row import EpisodeRow
from automotive_cosim.run.store import read_rows
from automotive_cosim.run.trial_row import TrialRow


def kind_of(line: bytes) -> type[TrialRow]:
    """The kind of row in a line: only a drive has a family."""
    return DriveTrialRow if b'"family":' in line else EpisodeRow


def read_trials(folder: Path) -> dict[str, TrialRow]:
    """The newest row of each trial by its id, as ``store.read_rows``. Raises UserError: a line cannot be read."""
    return read_rows(folder, kind_of)
