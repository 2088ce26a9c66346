"""``episode.webp``: the episode as an animation, cockpit, road, and speed against the limit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import chain, pairwise
from pathlib import Path

from PIL import Image, ImageDraw

from automotive_cosim.cockpit.drawing import Canvas, fit
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.theme import NIGHT, Colour, Type, Weight, font
from automotive_cosim.formats.layout import FILM
from automotive_cosim.formats.layout import ROAD as ROAD_FILE
from automotive_cosim.geo.text import amount_of_speed
from automotive_cosim.report.filmroad import RoadPainter, draw_road_sign
from automotive_cosim.report.frames import LAST_MS, SAME_TIME_S, FilmFrame, Frames, save_animation
from automotive_cosim.report.plot import SpeedAxis
from automotive_cosim.run.episode import EpisodeResult
from automotive_cosim.run.road import EMPTY, read_record
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.timeline import Sample, is_over

FINE = 2
LEFT, RIGHT, TOP, BOTTOM = 48, 18, 36, 32
"""Margins around the axes, logical pixels."""


def speed_plot(path: Sequence[Sample], shown: int, width: int, height: int, scale: float) -> Image.Image:
    """The plot as a picture.

    Args:
        path: the whole drive, which sets the axes.
        shown: number of samples driven so far.
        width: in pixels.
        height: in pixels.
        scale: pixels per logical pixel."""
    plot = _Plot([path], width * FINE, height * FINE, scale * FINE)
    plot.axes()
    plot.limits()
    plot.speed(path[:shown], above=NIGHT.warning, below=NIGHT.good)
    return plot.image.reduce(FINE)


def speeds_plot(
    paths: Mapping[Colour, Sequence[Sample]], until_s: float, width: int, height: int, scale: float
) -> Image.Image:
    """The plot of several drives over the same time, each in its colour.

    Args:
        paths: the drives, which set the axes.
        until_s: how far each is drawn, seconds since the hand-over.
        width: in pixels.
        height: in pixels.
        scale: pixels per logical pixel."""
    plot = _Plot(list(paths.values()), width * FINE, height * FINE, scale * FINE)
    plot.axes()
    plot.limits()
    for colour, path in reversed(list(paths.items())):  # the first on top
        plot.speed([sample for sample in path if sample.at_s <= until_s], above=colour, below=colour)
    return plot.image.reduce(FINE)


class _Plot:
    def __init__(self, paths: Sequence[Sequence[Sample]], width: int, height: int, scale: float) -> None:
        self._paths = paths
        self._scale = scale
        self.image = Image.new("RGB", (width, height), NIGHT.surface)
        self._brush = ImageDraw.Draw(self.image)
        self._left, self._right = LEFT * scale, width - RIGHT * scale
        self._top, self._bottom = TOP * scale, height - BOTTOM * scale
        self._begin = min(path[0].at_s for path in paths)
        self._end = max(self._begin + 1, *(path[-1].at_s for path in paths))
        self._speeds = SpeedAxis.of([sample for path in paths for sample in path])

    def axes(self) -> None:
        for speed, speed_kmh in self._speeds.lines:
            y = self._y(speed_kmh)
            self._brush.line((self._left, y, self._right, y), NIGHT.pressed, round(self._scale))
            self._write(self._left - 8 * self._scale, y, f"{speed}", "rm")
        self._write(self._left, self._top - 16 * self._scale, f"speed and limit, {self._speeds.unit}", "lm")
        every = 10 if self._end - self._begin <= 90 else 30
        first = round(self._begin // every + 1) * every
        for at_s in range(first, round(self._end) + 1, every):
            self._write(
                self._x(at_s),
                self._bottom + 15 * self._scale,
                f"{at_s} s".replace("-", "−") if at_s else "hand-over",
                "mm",
            )
        x = self._x(0)
        self._brush.line((x, self._top, x, self._bottom), NIGHT.muted, round(self._scale))

    def limits(self) -> None:
        for before, after in chain.from_iterable(map(pairwise, self._paths)):
            if before.limit_kmh is None:
                continue
            x, y, until = self._x(before.at_s), self._y(before.limit_kmh), self._x(after.at_s)
            self._stroke(x, y, until, y, NIGHT.critical, 2)
            if after.limit_kmh is not None:
                self._stroke(until, y, until, self._y(after.limit_kmh), NIGHT.critical, 2)

    def speed(self, driven: Sequence[Sample], *, above: Colour, below: Colour) -> None:
        """The speed so far, in one colour above the limit and in one below it."""
        for before, after in pairwise(driven):
            over = is_over(after.speed_kmh, after.limit_kmh)
            self._stroke(
                self._x(before.at_s),
                self._y(before.speed_kmh),
                self._x(after.at_s),
                self._y(after.speed_kmh),
                above if over else below,
                3,
            )
        if driven:
            x, y, r = self._x(driven[-1].at_s), self._y(driven[-1].speed_kmh), 6 * self._scale
            self._brush.ellipse((x - r, y - r, x + r, y + r), NIGHT.text)

    def _stroke(self, x0: float, y0: float, x1: float, y1: float, colour: Colour, width: int) -> None:
        wide = round(width * self._scale)
        self._brush.line((x0, y0, x1, y1), colour, wide)
        r = wide / 2 - 0.5
        self._brush.ellipse((x1 - r, y1 - r, x1 + r, y1 + r), colour)

    def _write(self, x: float, y: float, text: str, anchor: str) -> None:
        self._brush.text((x, y), text, NIGHT.muted, font(Weight.REGULAR, round(15 * self._scale)), anchor)

    def _x(self, at_s: float) -> float:
        return self._left + (at_s - self._begin) / (self._end - self._begin) * (self._right - self._left)

    def _y(self, speed_kmh: float) -> float:
        return self._bottom - speed_kmh / self._speeds.top_kmh * (self._bottom - self._top)


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
            folder: the record's; if its road has been recorded by then, the film shows the other vehicles."""
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
    title = Rect(inner.x, inner.y + 60, inner.width, 34)
    words = inner.below(96)
    is_last = frame.milliseconds == LAST_MS
    if is_last and fit(frame.words, Type.CAPTION, words.width, 3, words.height)[2]:
        title, words = inner.top(34), inner.below(36)  # a long reason takes the place of the speed
    else:
        speed, unit = amount_of_speed(here.speed_kmh, here.speed_unit).split()
        canvas.text(inner.top(52).left(84), speed, Type.DISPLAY, colour)
        canvas.text(Rect(inner.x + 88, inner.y + 16, 80, 36), unit, Type.LABEL, NIGHT.muted)
        clock = f"{'−' if frame.at_s < -SAME_TIME_S else '+'}{abs(frame.at_s):.0f} s"
        canvas.text(inner.top(52).right_part(120), clock, Type.TITLE, NIGHT.muted, "right")
    canvas.text(title, frame.title, Type.STRONG, NIGHT.text)
    canvas.text(words, frame.words, Type.CAPTION, NIGHT.muted, lines=3)
