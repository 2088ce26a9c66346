"""The frames of an episode's films: what the screen showed and what was done, before they are composed."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageOps

from automotive_cosim.cockpit.actions import action_in_words
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.map import RoadMap
from automotive_cosim.cockpit.theme import NIGHT
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.episode import Episode
from automotive_cosim.formats.writing import drafted
from automotive_cosim.run.episode import EpisodeResult
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.trial import Shot, TrialObserver

BEFORE_FRAMES, BEFORE_EVERY_S = 8, 2.0
AFTER_EVERY_S = 1.0
BEFORE_MS, STEP_MS, AFTER_MS, LAST_MS = 350, 1500, 350, 4000
QUALITY = 72
DIMMED, WAITING = 0.6, "no agent acts yet; the screen is dimmed, as it is at the hand-over"
SAID = "The driver says"
"""Title of the frame at the hand-over."""
AFTER = "After the end"
"""Title of the frames after the last step."""
SAME_TIME_S = 0.05
"""Times closer than this are the same."""


@dataclass(frozen=True, slots=True)
class FilmFrame:
    """The content of one frame before it is composed."""

    at_s: float
    """Seconds since the hand-over; negative before it."""
    cockpit: Image.Image
    title: str
    words: str
    milliseconds: int
    view: Image.Image | None = None
    """The view through the windshield; None before the hand-over."""


class Frames(TrialObserver):
    """Collects the frames while an episode runs."""

    def __init__(self, size: tuple[int, int]) -> None:
        """Nothing is collected yet.

        Args:
            size: width and height of the screen in the film, in pixels."""
        self.map: RoadMap | None = None
        """The roads; None before the hand-over."""
        self.came: tuple[EpisodeRow, EpisodeResult] | None = None
        """What came of the episode; None before its end, and without a hand-over."""
        self._size = size
        self._before_s: deque[float] = deque(maxlen=BEFORE_FRAMES)
        """Simulation times before the hand-over that have a frame."""
        self._steps: list[FilmFrame] = []
        self._after: list[FilmFrame] = []
        self._hand_over_s = 0.0
        self._session: Episode | None = None
        self._fitted: tuple[npt.NDArray[np.uint8], Image.Image] | None = None

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        """Takes a picture now and then after a step, in case it is the last; notes times before the hand-over."""
        at_s = moment.time_s - self._hand_over_s
        if self.map is None:
            if not self._before_s or at_s - self._before_s[-1] >= BEFORE_EVERY_S:
                self._before_s.append(at_s)
        elif not self._after or at_s - self._after[-1].at_s >= AFTER_EVERY_S:
            self._after.append(self._frame(at_s, cockpit.screenshot(), AFTER, "the drive continues", AFTER_MS))

    def begun(self, session: Episode, shot: Shot) -> None:
        """The first frame of the episode, with the driver's words."""
        self.map = RoadMap(session.network)
        self._session = session
        self._hand_over_s = shot.step.moment.time_s
        words = f"“{session.instance.goal}”"
        self._steps.append(self._frame(0.0, shot.screenshot, SAID, words, STEP_MS))

    def stepped(self, shot: Shot) -> None:
        self._after.clear()
        step = shot.step
        title = f"{step.number}  {action_in_words(step.action, shot.seen)}"
        words = " ".join(f"“{text}”" for text in step.said) or shot.thought or step.feedback.text
        at_s = step.moment.time_s - self._hand_over_s
        self._steps.append(self._frame(at_s, shot.screenshot, title, words, STEP_MS))

    def finished(self, row: EpisodeRow, told: EpisodeResult | None) -> None:
        """Keeps what came of it."""
        self.came = None if told is None else (row, told)

    def all(self) -> list[FilmFrame]:
        """The frames of the drive to a finished episode and of the episode; the last says how it ended."""
        if self.came is None or not self.came[1].path:
            return []
        row, result = self.came
        # An earlier departure, on which the situation did not arise, is no part of the drive.
        begin_s = result.path[0].at_s - SAME_TIME_S
        frames = [frame for frame in (*self._approach(), *self._steps, *self._after) if frame.at_s >= begin_s]
        frames[-1:] = [
            replace(frame, milliseconds=LAST_MS, title=outcome(row), words=why(row, result))
            for frame in frames[-1:]
        ]
        return frames

    def _approach(self) -> Iterator[FilmFrame]:
        """The drive to the hand-over. The screen is that of the hand-over, dimmed: the car's state and clock begin
        there, and before it nobody acts."""
        first = self._steps[0].cockpit
        dimmed = Image.blend(first, Image.new("RGB", first.size, NIGHT.background), DIMMED)
        for time_s in self._before_s:
            at_s = time_s - self._hand_over_s
            yield FilmFrame(at_s, dimmed, "The drive up to the hand-over", WAITING, BEFORE_MS)

    def _frame(
        self, at_s: float, screenshot: npt.NDArray[np.uint8], title: str, words: str, milliseconds: int
    ) -> FilmFrame:
        """A frame; a screen that has not changed is one array (``Cockpit.screenshot``) and is fitted once."""
        if self._fitted is None or self._fitted[0] is not screenshot:
            self._fitted = screenshot, self._fit(screenshot)
        view = None if self._session is None else Image.fromarray(self._session.world.view())
        return FilmFrame(at_s, self._fitted[1], title, words, milliseconds, view)

    def _fit(self, screenshot: npt.NDArray[np.uint8]) -> Image.Image:
        """The picture of the screen as large as fits, whatever the screen's size."""
        picture = Image.new("RGB", self._size, NIGHT.background)
        shown = ImageOps.contain(Image.fromarray(screenshot), self._size, Image.Resampling.LANCZOS)
        picture.paste(shown, ((self._size[0] - shown.width) // 2, (self._size[1] - shown.height) // 2))
        return picture


def outcome(row: EpisodeRow) -> str:
    """How an episode ended, in a word or two."""
    if row.success is None:
        return f"No verdict: {row.end}"
    return "Success" if row.success else "Not solved"


def why(row: EpisodeRow, result: EpisodeResult) -> str:
    """Why it ended so: the parts of the verdict that failed."""
    if result.verdict is None:
        return row.error or "the episode was interrupted"
    parts = result.verdict.parts
    failed = [f"{name.replace('_', ' ')}: {part.why}" for name, part in parts.items() if not part.ok]
    return "; ".join(failed) or "goal reached, clean, safe, in time, declared"


def save_animation(path: Path, pictures: Sequence[Image.Image], milliseconds: Sequence[int]) -> None:
    """Writes an animated WebP completely or not at all."""
    with drafted(path) as file:
        pictures[0].save(
            file,
            format="WEBP",
            save_all=True,
            append_images=list(pictures[1:]),
            duration=list(milliseconds),
            loop=0,
            quality=QUALITY,
            method=3,
        )
