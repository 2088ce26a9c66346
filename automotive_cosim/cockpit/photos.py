"""Photos that people send. What one shows is in the picture alone: the list of elements says that it is a photo."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache
from typing import Any

from PIL import Image, ImageDraw

from automotive_cosim.cockpit.theme import Colour, Weight, face

_FINE = 2
"""Oversampling."""
WIDE, HIGH = 480, 300
"""The plane that a photo is drawn on."""
WALL: Colour = (206, 200, 190)
INK: Colour = (32, 34, 38)
WHITE: Colour = (250, 250, 250)
BLUE: Colour = (20, 78, 160)
RED: Colour = (204, 24, 34)
GREEN: Colour = (24, 150, 72)
GREY: Colour = (120, 124, 130)
CUSHION: Colour = (86, 92, 104)


class Shows(StrEnum):
    """The subject of a photo."""

    ZONE = "zone"
    """A parking sign with the letter of its zone; ``struck`` where the zone ends."""
    CLOCK = "clock"
    """A dial with hands, at a time such as ``"16:45"``."""
    SEAT = "seat"
    """The car's seats from above, front on top, with a tick on one, or with ``struck`` a cross: ``"rear left"``."""
    WARMTH = "warmth"
    """A round thermostat in ``unit`` C or F."""
    PRESSURE = "pressure"
    """A round gauge in ``unit`` bar or psi."""
    LIMIT = "limit"
    """A limit sign: round with a red rim, or with ``unit`` mph the rectangular one of the United States."""
    BENCH = "bench"
    """A grown-up and a child side by side, the child in the picture's ``"left"`` or ``"right"`` half;
    with ``struck`` seen from behind, over the backrest."""
    LAMPS = "lamps"
    """A router's networks, each with a lamp: green by the one that is named and red by the others, or with
    ``struck`` the other way round."""


@dataclass(frozen=True, slots=True)
class Photo:
    """What can be seen on it."""

    shows: Shows
    value: Any
    unit: str = ""
    struck: bool = False


Scale = Mapping[str, tuple[float, float, float, int]]
"""First and last figure of a dial, the step between figures, and the parts of a step, by unit."""
_WARMTH: Scale = {"C": (14.0, 30.0, 2.0, 4), "F": (55.0, 85.0, 5.0, 5)}
_PRESSURE: Scale = {"bar": (1.0, 4.0, 0.5, 5), "psi": (10.0, 60.0, 10.0, 5)}
_SEATS = {"driver": (190, 92), "passenger": (290, 92), "rear left": (190, 196), "rear right": (290, 196)}
_NAMES = ("Home-5G", "CityFree", "Garage", "Coffee-Guest")


@lru_cache(maxsize=16)
def photo(shown: Photo, width: int, height: int) -> Image.Image:
    """The picture of that size in pixels."""
    fine = max(1, math.ceil(_FINE * width / WIDE))
    picture = Image.new("RGB", (WIDE * fine, HIGH * fine), WALL)
    _DRAWN[shown.shows](_Brush(ImageDraw.Draw(picture), fine), shown)
    return picture.resize((width, height), Image.Resampling.LANCZOS)


@dataclass(frozen=True, slots=True)
class _Brush:
    """Draws on the plane."""

    pen: ImageDraw.ImageDraw
    fine: int

    def box(self, x: float, y: float, wide: float, high: float, fill: Colour, round_: float = 0) -> None:
        """A box around a point."""
        edges = (x - wide / 2, y - high / 2, x + wide / 2, y + high / 2)
        self.pen.rounded_rectangle([edge * self.fine for edge in edges], round_ * self.fine, fill)

    def disc(self, x: float, y: float, radius: float, fill: Colour) -> None:
        """A disc around a point."""
        edges = (x - radius, y - radius, x + radius, y + radius)
        self.pen.ellipse([edge * self.fine for edge in edges], fill)

    def line(self, ends: tuple[tuple[float, float], ...], fill: Colour, wide: float) -> None:
        """A line through points."""
        self.pen.line([(x * self.fine, y * self.fine) for x, y in ends], fill, round(wide * self.fine), "curve")

    def hand(self, x: float, y: float, turn: float, length: float, fill: Colour, wide: float) -> None:
        """A hand from a point; ``turn`` is its share of a full turn from the top, clockwise."""
        self.line(((x, y), _around(x, y, turn, length)), fill, wide)

    def text(self, x: float, y: float, text: str, size: int, fill: Colour, anchor: str = "mm") -> None:
        self.pen.text(
            (x * self.fine, y * self.fine), text, fill, face(text, Weight.BOLD, size * self.fine), anchor=anchor
        )


def _around(x: float, y: float, turn: float, radius: float) -> tuple[float, float]:
    angle = 2 * math.pi * turn
    return x + radius * math.sin(angle), y - radius * math.cos(angle)


def _zone(brush: _Brush, shown: Photo) -> None:
    brush.box(240, 170, 14, 260, GREY)
    brush.box(240, 140, 180, 220, WHITE, 14)
    brush.box(240, 140, 168, 208, BLUE, 10)
    brush.text(240, 90, "P", 88, WHITE)
    brush.box(240, 190, 130, 84, WHITE, 8)
    brush.text(240, 190, str(shown.value), 72, INK)
    if shown.struck:
        brush.line(((160, 240), (320, 40)), RED, 18)


def _clock(brush: _Brush, shown: Photo) -> None:
    hour, minute = map(int, str(shown.value).split(":"))
    brush.disc(240, 150, 136, INK)
    brush.disc(240, 150, 126, WHITE)
    for mark in range(60):
        outer, inner = _around(240, 150, mark / 60, 120), _around(240, 150, mark / 60, 112 if mark % 5 else 100)
        brush.line((outer, inner), INK, 2 if mark % 5 else 6)
    brush.hand(240, 150, (hour % 12 + minute / 60) / 12, 66, INK, 12)
    brush.hand(240, 150, minute / 60, 100, INK, 7)
    brush.disc(240, 150, 10, INK)


def _seat(brush: _Brush, shown: Photo) -> None:
    brush.box(240, 150, 224, 284, GREY, 60)
    brush.box(240, 150, 210, 270, WHITE, 54)
    brush.line(((160, 52), (240, 36), (320, 52)), GREY, 10)
    for x, y in _SEATS.values():
        brush.box(x, y, 76, 72, CUSHION, 14)
        brush.box(x, y + 36, 76, 20, INK, 10)
    brush.disc(190, 58, 16, INK)  # the steering wheel, so that front and left can be told
    brush.disc(190, 58, 11, WHITE)
    x, y = _SEATS[shown.value]
    if shown.struck:
        brush.line(((x - 24, y - 24), (x + 24, y + 24)), RED, 12)
        brush.line(((x - 24, y + 24), (x + 24, y - 24)), RED, 12)
    else:
        brush.line(((x - 26, y), (x - 8, y + 22), (x + 28, y - 24)), GREEN, 12)


def _dial(brush: _Brush, shown: Photo, scales: Scale, name: str) -> None:
    low, high, step, parts = scales[shown.unit]
    brush.disc(240, 150, 138, INK)
    brush.disc(240, 150, 128, WHITE)

    def turn(value: float) -> float:
        return -0.375 + 0.75 * (value - low) / (high - low)

    for mark in range(round(parts * (high - low) / step) + 1):
        value = low + mark * step / parts
        at, is_figure = turn(value), mark % parts == 0
        brush.line((_around(240, 150, at, 124), _around(240, 150, at, 104 if is_figure else 114)), INK, 3)
        if is_figure:
            brush.text(*_around(240, 150, at, 84), f"{value:g}", 24, INK)
    brush.text(240, 212, name, 30, GREY)
    brush.hand(240, 150, turn(float(shown.value)), 118, RED, 4)
    brush.disc(240, 150, 14, INK)


def _warmth(brush: _Brush, shown: Photo) -> None:
    _dial(brush, shown, _WARMTH, f"°{shown.unit}")


def _pressure(brush: _Brush, shown: Photo) -> None:
    _dial(brush, shown, _PRESSURE, shown.unit)


def _limit(brush: _Brush, shown: Photo) -> None:
    if shown.unit == "mph":
        brush.box(240, 150, 190, 260, INK, 14)
        brush.box(240, 150, 182, 252, WHITE, 12)
        brush.text(240, 66, "SPEED", 40, INK)
        brush.text(240, 108, "LIMIT", 40, INK)
        brush.text(240, 200, str(shown.value), 104, INK)
        return
    brush.disc(240, 150, 132, WHITE)
    brush.disc(240, 150, 126, RED)
    brush.disc(240, 150, 98, WHITE)
    brush.text(240, 150, str(shown.value), 100, INK)


def _bench(brush: _Brush, shown: Photo) -> None:
    if not shown.struck:
        brush.box(240, 236, 420, 120, CUSHION, 30)
    sides = {"left": 130, "right": 350}
    for side, x in sides.items():
        grown = 0.55 if side == shown.value else 1.0
        brush.box(x, 236 - 20 * grown, 120 * grown, 150 * grown, BLUE if grown == 1.0 else RED, 40 * grown)
        brush.disc(x, 236 - 140 * grown, 44 * (0.5 + grown / 2), (226, 186, 152))
    if shown.struck:
        brush.box(240, 236, 420, 120, CUSHION, 30)


def _lamps(brush: _Brush, shown: Photo) -> None:
    brush.box(240, 150, 400, 260, INK, 24)
    for line, name in enumerate(_NAMES):
        y = 60 + 60 * line
        brush.disc(90, y, 16, RED if (name == shown.value) is shown.struck else GREEN)
        brush.text(130, y, name, 32, WHITE, "lm")


_DRAWN: Mapping[Shows, Callable[[_Brush, Photo], None]] = {
    Shows.ZONE: _zone,
    Shows.CLOCK: _clock,
    Shows.SEAT: _seat,
    Shows.WARMTH: _warmth,
    Shows.PRESSURE: _pressure,
    Shows.LIMIT: _limit,
    Shows.BENCH: _bench,
    Shows.LAMPS: _lamps,
}
"""The drawing of each."""
