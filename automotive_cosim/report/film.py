"""``episode.webp``: the episode as an animation, cockpit and road side by side."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageOps

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.drawing import Canvas
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.map import RoadMap
from automotive_cosim.cockpit.theme import NIGHT, Colour, Type
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.episode import Episode
from automotive_cosim.geo.text import amount_of_speed
from automotive_cosim.report.filmplot import speed_plot
from automotive_cosim.report.filmroad import RoadPainter
from automotive_cosim.run.episode import EpisodeObserver, EpisodeResult, Shot
from automotive_cosim.run.road import EMPTY, NAME, read_record
from automotive_cosim.run.timeline import Sample
from automotive_cosim.run.words import action_in_words, is_over

WIDTH, HEIGHT = 1280, 720
SCALE = 0.75
"""Pixels per unit of the layout: the film has 960 x 540."""
COCKPIT = Rect(20, 20, 848, 477)
ROAD = Rect(884, 20, 376, 477)
SIGN = Rect(ROAD.x + 12, ROAD.y + 12, ROAD.width - 24, 52)
PLOT = Rect(20, 513, 848, 187)
INFO = Rect(884, 513, 376, 187)
BEFORE_FRAMES, BEFORE_EVERY_S = 8, 2.0
AFTER_EVERY_S = 1.0
BEFORE_MS, STEP_MS, AFTER_MS, LAST_MS = 350, 1500, 350, 4000
QUALITY = 72
SAME_TIME_S = 0.05
"""Times closer than this are the same."""


@dataclass(frozen=True, slots=True)
class FilmFrame:
    """The content of one frame before it is composed."""

    time_s: float
    cockpit: Image.Image
    title: str
    words: str
    milliseconds: int


class Film(EpisodeObserver):
    """Collects frames while an episode runs and writes the film when it is over."""

    def __init__(self, folder: Path) -> None:
        """Nothing is written before the end.

        Args:
            folder: the record's; if its road has been recorded by then, the film shows the other vehicles.
        """
        self._path = folder / "episode.webp"
        self._before: deque[FilmFrame] = deque(maxlen=BEFORE_FRAMES)
        self._steps: list[FilmFrame] = []
        self._after: list[FilmFrame] = []
        self._map: RoadMap | None = None
        self._hand_over_s = 0.0
        self._fitted: tuple[npt.NDArray[np.uint8], Image.Image] | None = None

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        """Takes a picture now and then: before the hand-over, and after each step in case it is the last."""
        if self._map is None:
            if not self._before or moment.time_s - self._before[-1].time_s >= BEFORE_EVERY_S:
                title = "The drive up to the hand-over"
                words = "no agent acts yet; the hand-over resets the car and its clock to their state at departure"
                self._before.append(self._frame(moment.time_s, cockpit.screenshot(), title, words, BEFORE_MS))
        elif not self._after or moment.time_s - self._after[-1].time_s >= AFTER_EVERY_S:
            title, words = "After the end", "the drive continues"
            self._after.append(self._frame(moment.time_s, cockpit.screenshot(), title, words, AFTER_MS))

    def handed_over(self, episode: Episode, shot: Shot) -> None:
        """The first frame of the episode, with the driver's words."""
        self._map = RoadMap(episode.network)
        self._hand_over_s = shot.step.moment.time_s
        words = f"“{episode.instance.goal}”"
        self._steps.append(self._frame(self._hand_over_s, shot.screenshot, "The driver says", words, STEP_MS))

    def stepped(self, shot: Shot) -> None:
        """Adds one frame per step."""
        self._after.clear()
        step = shot.step
        title = f"{step.number}  {action_in_words(step.action, shot.seen)}"
        words = " ".join(f"“{text}”" for text in step.said) or shot.thought or step.feedback.text
        self._steps.append(self._frame(step.moment.time_s, shot.screenshot, title, words, STEP_MS))

    def finished(self, result: EpisodeResult) -> None:
        """Composes and writes the film, if there was a hand-over and a drive to it."""
        if self._map is None or not result.path:
            return
        # An earlier departure, on which the situation did not arise, is no part of the drive.
        begin_s = self._hand_over_s + result.path[0].at_s - SAME_TIME_S
        frames = [frame for frame in (*self._before, *self._steps, *self._after) if frame.time_s >= begin_s]
        if not frames:
            return
        frames[-1] = replace(frames[-1], milliseconds=LAST_MS, title=_outcome(result), words=_why(result))
        road = self._path.with_name(NAME)
        painter = RoadPainter(read_record(road) if road.is_file() else EMPTY, self._map)
        pictures = [self._compose(frame, result, painter) for frame in frames]
        draft = self._path.with_name(f".{self._path.name}.part")
        pictures[0].save(
            draft,
            format="WEBP",
            save_all=True,
            append_images=pictures[1:],
            duration=[frame.milliseconds for frame in frames],
            loop=0,
            quality=QUALITY,
            method=3,
        )
        draft.replace(self._path)

    def _frame(
        self, time_s: float, screenshot: npt.NDArray[np.uint8], title: str, words: str, milliseconds: int
    ) -> FilmFrame:
        """A frame; a screen that has not changed is one array (``Cockpit.screenshot``) and is fitted once."""
        if self._fitted is None or self._fitted[0] is not screenshot:
            self._fitted = screenshot, _fitted(screenshot)
        return FilmFrame(time_s, self._fitted[1], title, words, milliseconds)

    def _compose(self, frame: FilmFrame, result: EpisodeResult, painter: RoadPainter) -> Image.Image:
        at_s = frame.time_s - self._hand_over_s
        past = [sample for sample in result.path if sample.at_s <= at_s + SAME_TIME_S]
        here = past[-1]
        canvas = Canvas.plain(round(WIDTH * SCALE), round(HEIGHT * SCALE), SCALE, NIGHT.background)
        canvas.box(COCKPIT.inset(-3), NIGHT.pressed, 17)
        canvas.picture(COCKPIT, frame.cockpit, 14)
        painter.draw(canvas, ROAD, past, (SIGN,))
        _road_sign(canvas, here)
        canvas.picture(PLOT, speed_plot(result.path, len(past), *_pixels(PLOT), SCALE), 14)
        _info(canvas, frame, here, at_s)
        return canvas.image


def _fitted(screenshot: npt.NDArray[np.uint8]) -> Image.Image:
    """The picture of the screen as large as fits, whatever the screen's size."""
    box = _pixels(COCKPIT)
    picture = Image.new("RGB", box, NIGHT.background)
    shown = ImageOps.contain(Image.fromarray(screenshot), box, Image.Resampling.LANCZOS)
    picture.paste(shown, ((box[0] - shown.width) // 2, (box[1] - shown.height) // 2))
    return picture


def _pixels(rect: Rect) -> tuple[int, int]:
    return round(rect.right * SCALE) - round(rect.x * SCALE), round(rect.bottom * SCALE) - round(rect.y * SCALE)


def _outcome(result: EpisodeResult) -> str:
    if result.success is None:
        return f"No verdict: {result.end}"
    return "Success" if result.success else "Not solved"


def _why(result: EpisodeResult) -> str:
    if result.verdict is None:
        return result.error or "the episode was interrupted"
    parts = result.verdict.parts
    failed = [f"{name.replace('_', ' ')}: {part.why}" for name, part in parts.items() if not part.ok]
    return "; ".join(failed) or "goal reached, clean, safe, in time, declared"


def _road_sign(canvas: Canvas, here: Sample) -> None:
    """The road's name and its limit, on the map."""
    name = here.road or "an unnamed road"
    canvas.box(SIGN, NIGHT.surface, 12)
    canvas.text(Rect(SIGN.x + 14, SIGN.y, SIGN.width - 82, SIGN.height), name, Type.STRONG, NIGHT.text)
    if here.limit_kmh is not None:
        _limit_sign(canvas, Rect(SIGN.right - 54, SIGN.y + 2, 48, 48), here.limit_kmh, here.speed_unit)


def _limit_sign(canvas: Canvas, rect: Rect, limit_kmh: float, unit: str) -> None:
    white: Colour = (255, 255, 255)
    canvas.disc(rect, white)
    canvas.disc(rect.inset(2), (200, 22, 30))
    canvas.disc(rect.inset(8), white)
    canvas.text(rect, amount_of_speed(limit_kmh, unit).split()[0], Type.STRONG, (10, 10, 10), "centre")


def _info(canvas: Canvas, frame: FilmFrame, here: Sample, at_s: float) -> None:
    """Clock, speed, the current action and its reason."""
    canvas.box(INFO, NIGHT.surface, 14)
    inner = INFO.inset(18, 12)
    over = is_over(here.speed_kmh, here.limit_kmh)
    colour = NIGHT.warning if over else NIGHT.text
    speed, unit = amount_of_speed(here.speed_kmh, here.speed_unit).split()
    canvas.text(inner.top(52).left(84), speed, Type.DISPLAY, colour)
    canvas.text(Rect(inner.x + 88, inner.y + 16, 80, 36), unit, Type.LABEL, NIGHT.muted)
    clock = f"{'−' if at_s < -0.05 else '+'}{abs(at_s):.0f} s"
    canvas.text(inner.top(52).right_part(120), clock, Type.TITLE, NIGHT.muted, "right")
    canvas.text(Rect(inner.x, inner.y + 60, inner.width, 34), frame.title, Type.STRONG, NIGHT.text)
    words = Rect(inner.x, inner.y + 96, inner.width, inner.bottom - inner.y - 96)
    canvas.text(words, frame.words, Type.CAPTION, NIGHT.muted, lines=3)
