"""A recorded episode, step by step: each action, its result, and the screen after it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from PIL import Image

from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.layout import STEPS, screenshot
from automotive_cosim.formats.writing import drafted
from automotive_cosim.run.trial_folder import read_steps

LAST_MS = 3000
"""How long an animation shows its last picture."""


@dataclass(frozen=True, slots=True)
class Frame:
    """One step."""

    number: int
    since_s: float
    """Seconds after the hand-over."""
    speed_kmh: float
    action: Json | None
    """None at the hand-over."""
    said: str
    """The cockpit's feedback."""
    picture: Path

    @property
    def words(self) -> str:
        """The step on one line."""
        done = "hand-over" if self.action is None else _in_words(self.action)
        return f"{self.number:3d}  {self.since_s:+7.1f} s  {self.speed_kmh:3.0f} km/h  {done}" + (
            f": {self.said}" if self.said and self.action is not None else ""
        )


def frames(folder: Path) -> Iterator[Frame]:
    """The steps of a record, up to the first incomplete line.

    Raises:
        UserError: the folder has no record.
    """
    steps = read_steps(folder)
    if not steps:
        raise UserError(f"{folder} has no {STEPS}; give a results folder of `automotive-cosim run` or `drive`")
    for step in steps:
        yield Frame(
            step["step"],
            step["at_s"],
            step["speed_kmh"],
            step["action"],
            step["feedback"]["text"],
            screenshot(folder, step["picture"]),
        )


def write_film(shown: list[Frame], path: Path, speed: float) -> None:
    """An animation of the screens at their recorded durations, ``speed`` times as fast.

    Raises:
        UserError: a picture is missing, or there is no step.
    """
    if not shown:
        raise UserError("the record has no steps; there is nothing to show")
    missing = next((frame.picture for frame in shown if not frame.picture.is_file()), None)
    if missing is not None:
        raise UserError(f"{missing} is missing; the record is incomplete")
    pictures = [open_picture(frame.picture).convert("RGB") for frame in shown]
    stood_ms = [round(1000 * (after.since_s - before.since_s) / speed) for before, after in pairwise(shown)]
    durations_ms = [*stood_ms, LAST_MS]
    with drafted(path) as file:
        pictures[0].save(
            file,
            path.suffix[1:],
            save_all=True,
            append_images=pictures[1:],
            duration=durations_ms,
            loop=0,
            quality=80,
        )


def open_picture(path: Path) -> Image.Image:
    """A picture whose pixels are not read yet.

    Raises:
        UserError: it cannot be read, or says that it has more than ``bounds.PIXELS``.
    """
    try:
        picture = Image.open(path if path.is_file() else "")
    except (OSError, Image.DecompressionBombError) as error:
        raise UserError(f"{path} is no picture that can be read; record the run again") from error
    if picture.width * picture.height > bounds.PIXELS:
        picture.close()
        raise UserError(f"{path} has over {bounds.PIXELS:,} pixels; a screen has not")
    return picture


def _in_words(action: Json) -> str:
    given = ", ".join(f"{name} {value}" for name, value in action.items() if name != "action_type")
    return f"{action['action_type']} {given}".strip()
