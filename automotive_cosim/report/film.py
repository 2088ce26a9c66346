"""``episode.webp``: the episode as an animation, cockpit and road side by side."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PIL import Image

from automotive_cosim.cockpit.drawing import Canvas
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.theme import NIGHT, Type
from automotive_cosim.formats.layout import FILM
from automotive_cosim.formats.layout import ROAD as ROAD_FILE
from automotive_cosim.geo.text import amount_of_speed
from automotive_cosim.report.filmplot import speed_plot
from automotive_cosim.report.filmroad import RoadPainter, draw_road_sign
from automotive_cosim.report.frames import SAME_TIME_S, FilmFrame, Frames, save_animation
from automotive_cosim.run.episode import EpisodeResult
from automotive_cosim.run.road import EMPTY, read_record
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.timeline import Sample
from automotive_cosim.run.words import is_over

WIDTH, HEIGHT = 1280, 720
SCALE = 0.75
"""Pixels per unit of the layout: the film has 960 x 540."""
COCKPIT = Rect(20, 20, 848, 477)
ROAD = Rect(884, 20, 376, 477)
VIEW = ROAD.top(212)
"""The view through the windshield; the road from above is below it then."""
PLOT = Rect(20, 513, 848, 187)
INFO = Rect(884, 513, 376, 187)


class Film(Frames):
    """Collects frames while an episode runs and writes the film when it is over."""

    def __init__(self, folder: Path) -> None:
        """Nothing is written before the end.

        Args:
            folder: the record's; if its road has been recorded by then, the film shows the other vehicles.
        """
        super().__init__(_pixels(COCKPIT))
        self._path = folder / FILM

    def finished(self, row: EpisodeRow, told: EpisodeResult | None) -> None:
        """Composes and writes the film, if there was a hand-over and a drive to it."""
        super().finished(row, told)
        frames = self.all()
        if self.map is None or told is None or not frames:
            return
        road = self._path.with_name(ROAD_FILE)
        painter = RoadPainter(read_record(road) if road.is_file() else EMPTY, self.map)
        pictures = [self._compose(frame, told.path, painter) for frame in frames]
        save_animation(self._path, pictures, [frame.milliseconds for frame in frames])

    def _compose(self, frame: FilmFrame, path: Sequence[Sample], painter: RoadPainter) -> Image.Image:
        past = [sample for sample in path if sample.at_s <= frame.at_s + SAME_TIME_S]
        here = past[-1]
        canvas = Canvas.plain(round(WIDTH * SCALE), round(HEIGHT * SCALE), SCALE, NIGHT.background)
        canvas.box(COCKPIT.inset(-3), NIGHT.pressed, 17)
        canvas.picture(COCKPIT, frame.cockpit, 14)
        road = ROAD if frame.view is None else ROAD.bottom_part(ROAD.height - VIEW.height - 12)
        if frame.view is not None:
            canvas.picture(VIEW, frame.view.resize(_pixels(VIEW), Image.Resampling.LANCZOS), 14)
        sign = road.inset(12).top(52)
        painter.draw(canvas, road, past, (sign,))
        draw_road_sign(canvas, sign, here)
        canvas.picture(PLOT, speed_plot(path, len(past), *_pixels(PLOT), SCALE), 14)
        _info(canvas, frame, here)
        return canvas.image


def _pixels(rect: Rect) -> tuple[int, int]:
    return round(rect.right * SCALE) - round(rect.x * SCALE), round(rect.bottom * SCALE) - round(rect.y * SCALE)


def _info(canvas: Canvas, frame: FilmFrame, here: Sample) -> None:
    """Clock, speed, the current action and its reason."""
    canvas.box(INFO, NIGHT.surface, 14)
    inner = INFO.inset(18, 12)
    over = is_over(here.speed_kmh, here.limit_kmh)
    colour = NIGHT.warning if over else NIGHT.text
    speed, unit = amount_of_speed(here.speed_kmh, here.speed_unit).split()
    canvas.text(inner.top(52).left(84), speed, Type.DISPLAY, colour)
    canvas.text(Rect(inner.x + 88, inner.y + 16, 80, 36), unit, Type.LABEL, NIGHT.muted)
    clock = f"{'−' if frame.at_s < -SAME_TIME_S else '+'}{abs(frame.at_s):.0f} s"
    canvas.text(inner.top(52).right_part(120), clock, Type.TITLE, NIGHT.muted, "right")
    canvas.text(Rect(inner.x, inner.y + 60, inner.width, 34), frame.title, Type.STRONG, NIGHT.text)
    words = Rect(inner.x, inner.y + 96, inner.width, inner.bottom - inner.y - 96)
    canvas.text(words, frame.words, Type.CAPTION, NIGHT.muted, lines=3)
