"""Writes the folder of one drive.

    row.json        the row, with events and acts
    timeline.json   speed, limit and the do-nothing drive's speed, once a second
    steps.jsonl     each action with hashes of what followed, for a replay
    shown.jsonl     one line per step as a page shows it, written step by step
    screenshots/    step_000.jpg, ...: the cockpit after each step that changed it
    road.jsonl.gz   the road with every vehicle (``run.road_recorder`` writes it)

Row, timeline and steps are written when the drive is over.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import IO

import numpy as np
import numpy.typing as npt
from PIL import Image

from automotive_cosim.cockpit.actions import to_json
from automotive_cosim.contracts import KMH_PER_MPS, Element
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.formats.files import write_whole
from automotive_cosim.interface.trace import plain
from automotive_cosim.run.collect import PICTURE_QUALITY
from automotive_cosim.run.drive import DriveObserver, DriveRecord
from automotive_cosim.run.observer import Shot
from automotive_cosim.run.record import fresh
from automotive_cosim.run.road import NAME
from automotive_cosim.run.row import as_json
from automotive_cosim.run.words import action_in_words

SHOWN = "shown.jsonl"
OURS = ("row.json", "timeline.json", "steps.jsonl", SHOWN, "screenshots", NAME)
"""What an earlier drive left in the folder."""


class DriveRecorder(DriveObserver):
    """Records a drive while it runs."""

    def __init__(self, folder: Path) -> None:
        """Nothing is written before the departure.

        Args:
            folder: the drive's, which may not exist yet.
        """
        self.folder = folder
        self._lines: IO[str] | None = None
        self._pictured: tuple[int, npt.NDArray[np.uint8]] | None = None
        """The last picture, and the number of its step."""

    def begun(self, session: DriveSession, shot: Shot) -> None:
        """Creates the folder and begins its files."""
        self._lines = fresh(self.folder, OURS, SHOWN)
        self.stepped(shot)

    def stepped(self, shot: Shot) -> None:
        """Writes a step."""
        assert self._lines is not None
        step, session, picture = shot.step, shot.session, shot.screenshot
        if self._pictured is None or picture is not self._pictured[1]:
            path = self.folder / "screenshots" / f"step_{step.number:03d}.jpg"
            Image.fromarray(picture).save(path, quality=PICTURE_QUALITY, subsampling=0)
            self._pictured = step.number, picture
        line = {
            "number": step.number,
            "picture": self._pictured[0],
            "at_s": round(step.moment.time_s - session.moments[0].time_s, 2),
            "local_time": step.moment.local_time.isoformat(timespec="seconds"),
            "words": action_in_words(step.action, shot.seen) if step.number else "departure",
            "action": None if step.action is None else to_json(step.action),
            "target": _target(step.action.index if step.action else None, shot.seen),
            "feedback": plain(step.feedback),
            "thought": "",
            "stages": [stage.as_json() for stage in shot.stages],
            "context": session.observation.context or "",
            "speed_kmh": round(step.moment.driving.speed_mps * KMH_PER_MPS, 1),
        }
        self._lines.write(json.dumps(line, ensure_ascii=False) + "\n")
        self._lines.flush()

    def finished(self, result: DriveRecord) -> None:
        """Writes the row, the steps and the timeline."""
        steps = "".join(json.dumps(step) + "\n" for step in result.steps)
        write_whole(self.folder / "timeline.json", json.dumps(result.timeline) + "\n")
        write_whole(self.folder / "steps.jsonl", steps)
        write_whole(self.folder / "row.json", json.dumps(as_json(result.row), indent=1) + "\n")

    def close(self) -> None:
        """Completes the files, even after a drive that was broken off; may be called again."""
        if self._lines is not None:
            self._lines.close()


def _target(index: int | None, seen: Sequence[Element]) -> list[int] | None:
    """The box of the element that an action points at: left, top, right, bottom."""
    if index is None or not 0 <= index < len(seen):
        return None
    box = seen[index].bbox_pixels
    return [box.x_min, box.y_min, box.x_max, box.y_max]
