"""Records a trial while it runs: what an evaluation keeps of it, and its folder (``formats.layout``).

The folder is created when the agent takes over; an earlier failure leaves none.
"""

from __future__ import annotations

import gzip
import json
import platform
from contextlib import suppress
from dataclasses import asdict
from datetime import datetime
from io import FileIO
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

from automotive_cosim.cockpit.actions import action_in_words
from automotive_cosim.contracts import KMH_PER_MPS, Json
from automotive_cosim.episode.session import JudgedSession
from automotive_cosim.errors import UserError
from automotive_cosim.formats.layout import (
    OF_A_TRIAL,
    PACKED_STEPS,
    SCREENSHOTS,
    STEPS,
    TRIAL,
    road_view,
    screenshot,
)
from automotive_cosim.formats.writing import (
    add_line,
    check_writable,
    drafted,
    growing,
    make_folder,
    remove,
    write_whole,
)
from automotive_cosim.interface.trace import STATES, digests
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.moments import JudgeInput, write_judged
from automotive_cosim.run.rows import TrialRow
from automotive_cosim.run.store import write_trace
from automotive_cosim.run.trial import Shot, TrialObserver, TrialSetup
from automotive_cosim.run.trial_folder import target
from automotive_cosim.run.versions import STAMPED, installed

VIEW_QUALITY = 80
PICTURE_QUALITY = 85
LARGE = frozenset({*STATES, "weather", "gps", "connectivity", "events"})
"""What a line of a step has only if the whole state is written."""


def default_folder(setup: EpisodeSetup, ending: str = "") -> Path:
    """``runs/<timestamp>-<task>-<half>-<agent>-seed<seed><ending>``."""
    return stamped_folder(f"{setup.task}-{setup.half}-{setup.agent}-seed{setup.seed}{ending}")


def stamped_folder(name: str) -> Path:
    """``runs/<timestamp>-<name>``; a second one in the same second gets a number."""
    folder = Path("runs") / f"{datetime.now():%Y%m%d-%H%M%S}-{name.replace('/', '_')}"
    number = 2
    while folder.exists():
        folder = folder.with_name(f"{folder.name.removesuffix(f'-{number - 1}')}-{number}")
        number += 1
    return folder


def check_folder(folder: Path, *, force: bool) -> None:
    """Refuses a folder that cannot take a record, before anything runs.

    Raises UserError: it is a file, cannot be written, or is not empty and ``force`` is not given."""
    if folder.exists() and not folder.is_dir():
        raise UserError(f"{folder} is a file; give --out a folder that is empty or does not exist yet")
    if folder.is_dir() and any(folder.iterdir()) and not force:
        raise UserError(f"{folder} is not empty; give --out another folder, or --force to replace the record in it")
    parent = next(parent for parent in (folder, *folder.absolute().parents) if parent.exists())
    try:
        check_writable(parent)
    except OSError as error:
        raise UserError(
            f"cannot write to {parent}: {error.strerror}; give --out a folder that you can write to"
        ) from error


class Recorder(TrialObserver):
    """Keeps the trace of a trial and, if it has a folder, writes it down step by step."""

    def __init__(
        self, trial: TrialSetup, folder: Path | None, arguments: Json | None = None, *, whole: bool = False
    ) -> None:
        """Nothing is written before the agent takes over.

        Args:
            folder: the trial's, which may not exist yet; None keeps no folder.
            arguments: the command's, of a trial that it runs alone; None in an evaluation, whose manifest has what
                is the same for all its trials.
            whole: write the whole state after each step."""
        self.folder = folder
        self.lines: list[Json] = []
        """The trace, once the trial is over: the steps, then the result; nothing if there is nothing to judge."""
        self.goal = ""
        """What the driver says at first, once the agent takes over."""
        self.judged: JudgeInput | None = None
        """The judge's input, once the trial is over; None without a judgement."""
        self._trial = trial
        self._session: JudgedSession | None = None
        self._thoughts: list[Json] = []
        self._arguments = arguments
        self._whole = whole
        self._lines: FileIO | None = None
        self._begun_s = self._last_s = 0.0
        self._pictured: tuple[int, npt.NDArray[np.uint8]] | None = None
        """The last picture, and the number of its step."""
        self._started = datetime.now().astimezone()

    @property
    def has_begun(self) -> bool:
        return self._lines is not None

    def begun(self, session: JudgedSession, shot: Shot) -> None:
        """Creates the folder and writes step 0."""
        self._begun_s, self._session, self.goal = shot.step.moment.time_s, session, session.goal
        if self.folder is not None:
            self._lines = _fresh(self.folder)
            self._write({"manifest": self._manifest()})
        self.stepped(shot)

    def stepped(self, shot: Shot) -> None:
        self._thoughts.append({"thought": shot.thought, "stages": [stage.as_json() for stage in shot.stages]})
        self._add(shot)

    def finished(self, row: TrialRow, told: Any) -> None:
        """Makes the trace, and completes the folder."""
        if self._session is None or told is None:
            return
        self.lines = self._trial.lines(self._session, row, told, self._thoughts)
        self.judged = self._trial.judged(self._session)
        self.close()
        if self.folder is not None and self._session.observation.on_watch:
            steps = self.folder / STEPS
            write_whole(self.folder / PACKED_STEPS, gzip.compress(steps.read_bytes(), mtime=0))
            remove(steps)
        if self.has_begun:
            self._write({"row": as_json(row), **self.lines[-1], "manifest": self._manifest()})

    def keep_in(self, evaluation: Path) -> None:
        """Writes the trace and the judge's input into the folder of an evaluation.

        Raises OSError: they cannot be written."""
        if self.lines:
            write_trace(evaluation, self._trial.id, self.lines)
        if self.judged is not None:
            write_judged(evaluation, self._trial.id, self.judged)

    def close(self) -> None:
        """Closes the files, also of a trial that was broken off; may be called again."""
        if self._lines is not None:
            self._lines.close()

    def discard(self) -> None:
        self.close()
        if self.folder is not None:
            with suppress(OSError):
                remove(self.folder)

    def _add(self, shot: Shot) -> None:
        """Saves the pictures of screen and road, then appends a line, so that every line has them."""
        if self.folder is None or self._lines is None:
            return
        step = shot.step
        if self._pictured is None or shot.screenshot is not self._pictured[1]:
            with drafted(screenshot(self.folder, step.number)) as file:
                Image.fromarray(shot.screenshot).save(file, "JPEG", quality=PICTURE_QUALITY, subsampling=0)
            self._pictured = step.number, shot.screenshot
        seen = shot.session.observation
        if not seen.on_watch or seen.camera is not None:  # a drive has hundreds of steps
            camera = shot.session.world.view() if seen.camera is None else seen.camera
            with drafted(road_view(self.folder, step.number)) as file:
                Image.fromarray(camera).save(file, "JPEG", quality=VIEW_QUALITY)
        told, begins, waited_s = step.as_json(), "hand-over", None
        if shot.session.observation.on_watch:
            told["context"], begins = shot.session.observation.context or "", "departure"  # as the agent was told
            waited_s = step.moment.time_s - self._last_s  # until something changed
        self._last_s = step.moment.time_s
        line = told | {
            "at_s": round(step.moment.time_s - self._begun_s, 2),
            "words": action_in_words(step.action, shot.seen, waited_s) if step.number else begins,
            "target": target(step.action.index if step.action else None, shot.seen),
            "speed_kmh": round(step.moment.driving.speed_mps * KMH_PER_MPS, 1),
            "picture": self._pictured[0],
            **self._thoughts[-1],
            "sha256": digests(told),
        }
        kept = line if self._whole else {name: value for name, value in line.items() if name not in LARGE}
        add_line(self._lines, json.dumps(kept, ensure_ascii=False))

    def _write(self, told: Json) -> None:
        assert self.folder is not None
        write_whole(self.folder / TRIAL, json.dumps(told, indent=1) + "\n")

    def _manifest(self) -> Json:
        setup = self._trial
        if self._arguments is None:
            return {"setup": asdict(setup)}
        return {
            "versions": installed(STAMPED) | {"python": platform.python_version()},
            "platform": platform.platform(),
            "setup": asdict(setup),
            "arguments": self._arguments,
            "seeds": {"episode": setup.seed, "traffic": setup.seed},
            "started": self._started.isoformat(timespec="seconds"),
            "wall_seconds": round((datetime.now().astimezone() - self._started).total_seconds(), 1),
        }


def _fresh(folder: Path) -> FileIO:
    """Begins a record, without what an earlier one left in its folder.

    Returns:
        The file of its steps, open.

    Raises UserError: another record begins there at this instant."""
    lines = growing(make_folder(folder) / STEPS, anew=True)
    for name in set(OF_A_TRIAL) - {STEPS}:
        remove(folder / name)
    make_folder(folder, SCREENSHOTS)
    return lines
