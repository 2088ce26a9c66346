"""A canvas in logical pixels on a Pillow image of any resolution: soft corners, text, icons, pictures.

Shapes are drawn from cached antialiased masks, so that a frame costs milliseconds. Every text is recorded in
``inks`` with the box that it may fill, for the tests of legibility.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw

from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.theme import (
    CAP_HEIGHT,
    EAST_ASIAN_FROM,
    HOME_STYLE,
    SMALLER,
    Colour,
    Icon,
    Style,
    Type,
    Weight,
    face,
)

_NOT_FIRST = "、。：？！」』）％ーぁぃぅぇぉっゃゅょァィゥェォッャュョ"
"""Characters that must not begin a line in Japanese."""
_PIECE = re.compile(f"(?:[{EAST_ASIAN_FROM}-\U0010ffff]|[^{EAST_ASIAN_FROM}-\U0010ffff]+)[{_NOT_FIRST}]*")
_BLANKS = re.compile(r"[ \t\n]+")
"""Where a line may break; no-break spaces stay."""
_FINE = 4
"""Oversampling of shapes."""


@dataclass(frozen=True, slots=True)
class Ink:
    """A drawn text, in logical pixels."""

    text: str
    rect: Rect
    box: Rect
    """The box that it may fill."""
    colour: Colour
    cut: bool
    """Whether it did not fit and ends in an ellipsis."""


class Canvas:
    """Draws the widgets of one frame."""

    def __init__(self, image: Image.Image, scale: float, style: Style = HOME_STYLE, *, night: bool = False) -> None:
        """Draws on an image; ``scale`` is pixels per logical pixel."""
        self.image = image
        self.style = style
        self.night = night
        self.scale = scale
        self.inks: list[Ink] = []
        self._draw = ImageDraw.Draw(self.image)

    @classmethod
    def plain(
        cls,
        width: int,
        height: int,
        scale: float,
        colour: Colour,
        style: Style = HOME_STYLE,
        *,
        night: bool = False,
    ) -> Canvas:
        """A canvas of that size in pixels, filled with one colour."""
        return cls(Image.new("RGB", (width, height), colour), scale, style, night=night)

    def pixels(self) -> npt.NDArray[np.uint8]:
        """The frame so far, (height, width, 3); read-only."""
        return pixels_of(self.image)

    def box(self, rect: Rect, fill: Colour, radius: int = 0, outline: Colour | None = None) -> None:
        """A filled box with soft corners, and a border within it if ``outline`` is given."""
        if outline is not None:
            self.box(rect, outline, radius)
            self.box(rect.inset(2), fill, max(0, radius - 2))
            return
        left, top, right, bottom = rect.edges(self.scale)
        r = min(round(radius * self.scale), (right - left) // 2, (bottom - top) // 2)
        if r <= 0:
            self._draw.rectangle((left, top, right - 1, bottom - 1), fill)
            return
        for across in ((left + r, top, right - r, bottom), (left, top + r, right, bottom - r)):
            if across[0] < across[2] and across[1] < across[3]:
                self._draw.rectangle((across[0], across[1], across[2] - 1, across[3] - 1), fill)
        for corner, mask in zip(
            ((left, top), (right - r, top), (right - r, bottom - r), (left, bottom - r)), _corners(r), strict=True
        ):
            self.image.paste(fill, corner, mask)

    def text(
        self,
        box: Rect,
        text: str,
        style: Type,
        colour: Colour,
        align: str = "left",
        lines: int = 1,
        *,
        keeps_end: bool = False,
    ) -> None:
        """Text in a box, in the middle of its height; smaller if too long, over several lines if allowed.

        A text that would be very small is first wrapped to as many lines as the box has room for.

        Args:
            style: a style of the type scale; smaller ones are used as needed.
            align: ``left``, ``centre`` or ``right``.
            lines: maximum number of lines.
            keeps_end: whether it loses its beginning where it is too long."""
        if not text:
            return
        style, rows, cut = fit(text, style, box.width, lines, box.height, keeps_end=keeps_end)
        pitch = style.pitch
        top = box.y + (box.height - pitch * len(rows)) / 2
        for row, words in enumerate(rows):
            line = Rect(box.x, round(top + row * pitch), box.width, pitch)
            self._line(line, box, words, style, colour, align, cut)

    def icon(self, centre: tuple[int, int], icon: Icon, size: int, colour: Colour) -> None:
        """An icon around a point."""
        x, y = centre
        pixels = round(size * self.scale)
        mask, left, top, _ = _mask(str(self.style.icons.get(icon, icon)), Weight.ICON, pixels)
        base = round(y * self.scale - pixels / 2 + pixels * 0.875)
        self.image.paste(colour, (round(x * self.scale - pixels / 2) + left, base + top), mask)

    def disc(self, rect: Rect, colour: Colour) -> None:
        """A filled circle in a square box."""
        self.box(rect, colour, rect.width)

    def picture(self, rect: Rect, picture: Image.Image, radius: int = 0) -> None:
        """A picture of the box's size in pixels, its corners cut round."""
        left, top, right, bottom = rect.edges(self.scale)
        mask = _plate(right - left, bottom - top, round(radius * self.scale)) if radius else None
        self.image.paste(picture, (left, top), mask)

    def pixels_across(self, rect: Rect) -> int:
        """Width of a box in pixels."""
        left, _, right, _ = rect.edges(self.scale)
        return right - left

    def stencil(self, rect: Rect, mask: Image.Image, fill: Colour | Image.Image) -> None:
        """A colour, or a picture, at the box's corner through a mask of the same size in pixels."""
        left, top, _, _ = rect.edges(self.scale)
        self.image.paste(fill, (left, top), mask)

    def _line(self, line: Rect, box: Rect, text: str, style: Type, colour: Colour, align: str, cut: bool) -> None:
        size = int(style.size * self.scale)  # never wider than measured
        mask, left, top, wide = _mask(text, style.weight, size)
        x = line.x * self.scale
        if align == "centre":
            x += (line.width * self.scale - wide) / 2
        elif align == "right":
            x += line.width * self.scale - wide
        base = (line.y + line.height / 2) * self.scale + size * CAP_HEIGHT / 2
        at = (round(x) + left, round(base) + top)
        self.image.paste(colour, at, mask)
        rect = Rect(
            round(at[0] / self.scale),
            round(at[1] / self.scale),
            round(mask.width / self.scale),
            round(mask.height / self.scale),
        )
        self.inks.append(Ink(text, rect, box, colour, cut))


def pixels_of(image: Image.Image) -> npt.NDArray[np.uint8]:
    """An RGB image as (height, width, 3); read-only. Four times as fast as ``numpy.asarray``."""
    return np.frombuffer(image.tobytes(), dtype=np.uint8).reshape(image.height, image.width, 3)


def text_width(text: str, style: Type) -> float:
    """Advance width in logical pixels."""
    return face(text, style.weight, style.size).getlength(text)


@lru_cache(maxsize=4096)
def fit(
    text: str, style: Type, width: int, lines: int, height: int = 0, *, keeps_end: bool = False
) -> tuple[Type, tuple[str, ...], bool]:
    """The largest style in which the text fits, its lines, and whether it had to be cut.

    Args:
        lines: maximum number of lines, as long as the text fits on them in some style.
        height: height of the box; more lines are used before the smallest style if it has room for them.
        keeps_end: whether it loses its beginning where it has to be cut."""
    text = _BLANKS.sub(" ", text).strip(" ")
    styles = [style]
    while styles[-1] in SMALLER:
        styles.append(SMALLER[styles[-1]])
    tries: list[tuple[Type, int]] = [(one, lines) for one in styles if one is not Type.FINE]
    tries += [(one, height // one.pitch) for one in styles]
    tries += [(styles[-1], lines)]
    rows: list[str] = []
    for one, most in tries:
        rows = _wrap(text, one, width) if most > 1 else [text]
        if len(rows) <= most and all(text_width(row, one) <= width for row in rows):
            return one, tuple(rows), False
    kept = [*rows[: lines - 1], " ".join(rows[lines - 1 :])]
    return styles[-1], tuple(_cut(row, styles[-1], width, keeps_end) for row in kept), True


def fits(text: str, style: Type, width: int) -> bool:
    """Whether the text fits on one line in that style or a smaller one."""
    return not fit(text, style, width, 1)[2]


def _wrap(text: str, style: Type, width: int) -> list[str]:
    rows = [""]
    for glue, piece in _pieces(text):
        longer = f"{rows[-1]}{glue}{piece}" if rows[-1] else piece
        if not rows[-1] or text_width(longer, style) <= width:
            rows[-1] = longer
        else:
            rows.append(piece)
    return rows


def _pieces(text: str) -> Iterator[tuple[str, str]]:
    """Pieces between which a line may break, with their joints: words, East Asian letters."""
    for word in text.split(" "):
        for at, piece in enumerate(_PIECE.findall(word)):
            yield "" if at else " ", piece


def _cut(text: str, style: Type, width: int, keeps_end: bool = False) -> str:
    if text_width(text, style) <= width:
        return text
    while text and text_width(text + "…", style) > width:
        text = text[1:] if keeps_end else text[:-1]
    return "…" + text.lstrip() if keeps_end else text.rstrip() + "…"


@lru_cache(maxsize=4096)
def _mask(text: str, weight: Weight, size: int) -> tuple[Image.Image, int, int, float]:
    """The text as a mask, its offset from the pen's start on the base line, and the pen's advance."""
    letters = face(text, weight, size)
    left, top, right, bottom = letters.getbbox(text, anchor="ls")
    left, top = int(left), int(top)
    mask = Image.new("L", (max(1, int(right) - left), max(1, int(bottom) - top)))
    ImageDraw.Draw(mask).text((-left, -top), text, 255, letters, anchor="ls")
    return mask, left, top, letters.getlength(text)


@lru_cache(maxsize=64)
def _corners(radius: int) -> tuple[Image.Image, ...]:
    """Quarter discs: top left, top right, bottom right, bottom left."""
    disc = Image.new("L", (2 * radius * _FINE, 2 * radius * _FINE))
    ImageDraw.Draw(disc).ellipse((0, 0, 2 * radius * _FINE - 1, 2 * radius * _FINE - 1), 255)
    disc = disc.reduce(_FINE)
    boxes = ((0, 0), (radius, 0), (radius, radius), (0, radius))
    return tuple(disc.crop((x, y, x + radius, y + radius)) for x, y in boxes)


@lru_cache(maxsize=32)
def _plate(width: int, height: int, radius: int) -> Image.Image:
    mask = Image.new("L", (width, height), 255)
    places = ((0, 0), (width - radius, 0), (width - radius, height - radius), (0, height - radius))
    for place, corner in zip(places, _corners(radius), strict=True):
        mask.paste(corner, place)
    return mask
