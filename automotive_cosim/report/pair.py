"""The same drive twice: an agent that knows where it is beside the same agent that does not.

``pair.webp`` shows both screens from the hand-over on, both cars on the road, and their speeds; ``pair.html`` is
the page with both verdicts; ``pair.json`` says the result in a sentence, with both traces' hashes. Both episodes
begin at the same instant of the same traffic, so what differs is due to the agent.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from PIL import Image, ImageOps

from automotive_cosim.cockpit.drawing import Canvas, fit
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.theme import NIGHT, Colour, Type
from automotive_cosim.formats.files import read_bytes
from automotive_cosim.formats.layout import ROAD as ROAD_FILE
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.geo.text import amount_of_speed
from automotive_cosim.report.film import speeds_plot
from automotive_cosim.report.filmroad import RoadPainter, draw_road_sign
from automotive_cosim.report.frames import (
    AFTER,
    AFTER_MS,
    LAST_MS,
    SAID,
    SAME_TIME_S,
    STEP_MS,
    FilmFrame,
    Frames,
    outcome,
    save_animation,
)
from automotive_cosim.report.page import PARTS, embedded
from automotive_cosim.report.templates import render
from automotive_cosim.run.episode import EpisodeResult
from automotive_cosim.run.road import EMPTY, read_record
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.timeline import Sample

WIDTH, HEIGHT = 1280, 1192
SCALE = 0.75
"""Pixels per unit of the layout: the film has 960 x 894."""
MARGIN, GAP = 20, 24
WORDS = Rect(MARGIN, 14, WIDTH - 2 * MARGIN, 52)
SIDES = Rect(MARGIN, 76, WIDTH - 2 * MARGIN, 724).columns(2, GAP)
HEAD, VIEW, NOTES = 44, 212, 108
"""Heights of a side's title, of the view through the windshield, and of the words."""
ROAD = Rect(MARGIN, 814, WIDTH - 2 * MARGIN, 180)
SIGN = Rect(ROAD.x + 12, ROAD.y + 12, 320, 52)
PLOT = Rect(MARGIN, 1010, WIDTH - 2 * MARGIN, 166)
COLOURS: tuple[Colour, Colour] = ((86, 180, 233), (230, 159, 0))
"""Okabe and Ito's sky blue and orange, which most people can distinguish."""
BEFORE_S = 20.0
"""The plot begins this long before the hand-over."""
FILM, PAGE, FIGURES = "pair.webp", "pair.html", "pair.json"


@dataclass(frozen=True, slots=True)
class PairSide:
    """One of the two episodes."""

    title: str
    """What this agent has, in a few words."""
    folder: Path
    """Its record."""
    frames: Frames

    @property
    def row(self) -> EpisodeRow:
        return self._came[0]

    @property
    def result(self) -> EpisodeResult:
        """What its trace tells besides."""
        return self._came[1]

    @property
    def _came(self) -> tuple[EpisodeRow, EpisodeResult]:
        assert self.frames.came is not None, "it is over"
        return self.frames.came


def screen_size() -> tuple[int, int]:
    """Width and height of each screen in the film, in pixels."""
    left, top, right, bottom = _screen(SIDES[0]).edges(SCALE)
    return right - left, bottom - top


def write_pair(folder: Path, sides: Sequence[PairSide]) -> Path:
    """Writes the film and the page into a folder that contains both records; returns the page."""
    frames = [_from_hand_over(side) for side in sides]
    film = folder / FILM
    if all(frames):
        until_s = min(each[-1].at_s for each in frames)
        paths = [
            [sample for sample in side.result.path if -BEFORE_S <= sample.at_s <= until_s + SAME_TIME_S]
            for side in sides
        ]
        times = sorted({round(frame.at_s, 1) for each in frames for frame in each if frame.at_s <= until_s})
        painter = _painter(sides[0])
        pictures = [_compose(at_s, sides, frames, paths, painter, over=at_s == times[-1]) for at_s in times]
        acted = {round(step.at_s, 1) for each in frames for step in each if step.milliseconds == STEP_MS}
        shown_ms = [STEP_MS if at_s in acted else AFTER_MS for at_s in times]
        save_animation(film, pictures, [*shown_ms[:-1], LAST_MS])
    traces = [side.row.trace_sha256 for side in sides]
    write_whole(folder / FIGURES, json.dumps({"sentence": sentence(sides), "traces": traces}, indent=1) + "\n")
    page = folder / PAGE
    text = render(
        "report/pair.html",
        sentence=sentence(sides),
        sides=sides,
        outcomes=[outcome(side.row) for side in sides],
        parts=PARTS,
        film=embedded(read_bytes(film), "image/webp") if film.is_file() else None,
        records=[side.folder.relative_to(folder).as_posix() for side in sides],
    )
    write_whole(page, text)
    return page


def sentence(sides: Sequence[PairSide]) -> str:
    """What the two runs show, with the figures of their last moments."""
    return " ".join(f"{side.title}: {outcome(side.row).lower()}{_ends_at(side.result.path)}." for side in sides)


def _from_hand_over(side: PairSide) -> list[FilmFrame]:
    """The frames without the approach; after the last step its words stay, and the last frame says the outcome.

    The driver's words are above both screens, so the first frame goes without."""
    frames: list[FilmFrame] = []
    for frame in side.frames.all():
        if frame.title == SAID:
            frame = replace(frame, title="Hand-over", words="")
        if frame.title == AFTER:
            frame = replace(frame, title=frames[-1].title, words=frames[-1].words)
        if frame.at_s >= -SAME_TIME_S:
            frames.append(frame)
    if frames and side.result.verdict is not None:
        failed = next((part.why for part in side.result.verdict.parts.values() if not part.ok), None)
        frames[-1] = replace(frames[-1], words=failed or frames[-1].words)
    return frames


def _painter(side: PairSide) -> RoadPainter:
    road = side.folder / ROAD_FILE
    assert side.frames.map is not None  # there was a hand-over
    return RoadPainter(read_record(road) if road.is_file() else EMPTY, side.frames.map)


def _ends_at(path: Sequence[Sample]) -> str:
    if not path:
        return ""
    last = path[-1]
    limit = "" if last.limit_kmh is None else f" (limit {amount_of_speed(last.limit_kmh, last.speed_unit)})"
    return f", the car ends at {amount_of_speed(last.speed_kmh, last.speed_unit)}{limit}"


def _screen(side: Rect) -> Rect:
    return Rect(side.x, side.y + HEAD + VIEW + 12, side.width, side.height - HEAD - VIEW - 12 - NOTES)


def _compose(
    at_s: float,
    sides: Sequence[PairSide],
    frames: Sequence[Sequence[FilmFrame]],
    paths: Sequence[Sequence[Sample]],
    painter: RoadPainter,
    *,
    over: bool,
) -> Image.Image:
    canvas = Canvas.plain(round(WIDTH * SCALE), round(HEIGHT * SCALE), SCALE, NIGHT.background)
    canvas.text(WORDS, f"The driver: “{sides[0].result.goal}”", Type.TITLE, NIGHT.text)
    cars: dict[Colour, Sample] = {}
    for box, side, each, path, colour in zip(SIDES, sides, frames, paths, COLOURS, strict=True):
        shown = [frame for frame in each if frame.at_s <= at_s + SAME_TIME_S][-1]
        here = cars[colour] = [sample for sample in path if sample.at_s <= at_s + SAME_TIME_S][-1]
        _draw_side(canvas, box, side, each[-1] if over else shown, here, colour)
    painter.draw_lengthwise(canvas, ROAD, cars)
    draw_road_sign(canvas, SIGN, cars[COLOURS[0]])
    canvas.picture(
        PLOT,
        speeds_plot(
            dict(zip(COLOURS, paths, strict=True)),
            at_s + SAME_TIME_S,
            round(PLOT.right * SCALE) - round(PLOT.x * SCALE),
            round(PLOT.bottom * SCALE) - round(PLOT.y * SCALE),
            SCALE,
        ),
        14,
    )
    return canvas.image


def _draw_side(canvas: Canvas, box: Rect, side: PairSide, frame: FilmFrame, here: Sample, colour: Colour) -> None:
    head = box.top(HEAD - 6)
    canvas.disc(Rect(head.x, head.y + 9, 20, 20), colour)
    canvas.text(Rect(head.x + 32, head.y, head.width - 200, head.height), side.title, Type.STRONG, NIGHT.text)
    canvas.text(
        head.right_part(160), amount_of_speed(here.speed_kmh, here.speed_unit), Type.STRONG, colour, "right"
    )
    canvas.picture(_screen(box), frame.cockpit, 14)
    notes = box.bottom_part(NOTES - 12)
    is_last = frame.title == outcome(side.row)
    window, room = Rect(box.x, box.y + HEAD, box.width, VIEW), notes.below(38).top(2 * Type.LABEL.pitch)
    if is_last and fit(frame.words, Type.LABEL, room.width, 2, room.height)[2]:
        room = window  # a long reason takes the place of the view
    elif frame.view is not None:
        left, top, right, bottom = window.edges(SCALE)
        size = right - left, bottom - top
        canvas.picture(window, ImageOps.fit(frame.view, size, Image.Resampling.LANCZOS, centering=(0.5, 0.55)), 14)
    good = bool(side.row.success)
    title_colour = NIGHT.text if not is_last else NIGHT.good if good else NIGHT.jam
    canvas.text(notes.top(38), frame.title, Type.TITLE if is_last else Type.STRONG, title_colour)
    most = room.height // Type.LABEL.pitch
    canvas.text(room, frame.words, Type.LABEL, NIGHT.muted, lines=most)
