"""Tell-tales in the shapes and colours of ISO 2575, and the road signs that the camera read, drawn by lines."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache
from math import cos, pi, sin

from PIL import Image, ImageDraw

from automotive_cosim.cockpit.theme import Colour, Weight, font

_FINE = 4
"""Oversampling."""
_UNITS = 24
"""Side of a symbol's grid."""
BLUE, GREEN, AMBER, RED = ((11, 99, 206), (14, 122, 69), (176, 98, 0), (198, 38, 46))
_BY_NIGHT = {BLUE: (79, 168, 255), GREEN: (69, 209, 138), AMBER: (255, 180, 46), RED: (255, 92, 96)}
WHITE, BLACK, SIGN_RED, SIGN_BLUE = (255, 255, 255), (12, 14, 18), (200, 20, 32), (0, 84, 166)


class Telltale(StrEnum):
    """A symbol that lights up; the more urgent first."""

    WARNING = "warning"
    BELT = "belt"
    DOOR = "door"
    BATTERY = "battery"
    HAZARD = "hazard"
    TYRE = "tyre"
    STABILITY = "stability"
    FROST = "frost"
    CABLE = "cable"
    HIGH_BEAM = "high_beam"
    LOW_BEAM = "low_beam"
    POSITION = "position"
    FRONT_FOG = "front_fog"
    REAR_FOG = "rear_fog"


class SignKind(StrEnum):
    """A road sign."""

    LIMIT = "limit"
    END_OF_LIMIT = "end_of_limit"
    SCHOOL = "school"
    TUNNEL = "tunnel"


@dataclass(frozen=True, slots=True)
class RoadSign:
    """A sign that the camera read."""

    kind: SignKind
    limit_kmh: float | None = None
    """On a limit sign."""
    unit: str = "km/h"
    """What the figure on it counts: ``"km/h"`` or ``"mph"``."""
    country: str = ""
    """ISO 3166-1 code of the country that put it up; empty if unknown."""


class _SymbolPen:
    """Draws on the grid of a symbol, oversampled."""

    def __init__(self, picture: Image.Image) -> None:
        self._draw = ImageDraw.Draw(picture)
        self._unit = picture.width / _UNITS

    def _at(self, points: tuple[tuple[float, float], ...]) -> list[tuple[float, float]]:
        return [(x * self._unit, y * self._unit) for x, y in points]

    def _box(self, left: float, top: float, right: float, bottom: float) -> tuple[float, float, float, float]:
        return left * self._unit, top * self._unit, right * self._unit, bottom * self._unit

    def line(self, *points: tuple[float, float], width: float = 1.8, fill: Colour | int = 255) -> None:
        """A line with round corners."""
        self._draw.line(self._at(points), fill, round(width * self._unit), joint="curve")

    def area(self, *points: tuple[float, float], fill: Colour | int = 255) -> None:
        self._draw.polygon(self._at(points), fill)

    def disc(self, x: float, y: float, radius: float, fill: Colour | int = 255) -> None:
        self._draw.ellipse(self._box(x - radius, y - radius, x + radius, y + radius), fill)

    def arc(self, left: float, top: float, right: float, bottom: float, begin: float, end: float) -> None:
        """A part of an ellipse, in degrees clockwise from the right."""
        self._draw.arc(self._box(left, top, right, bottom), begin, end, 255, round(1.8 * self._unit))

    def wave(self, x: float, top: float, bottom: float) -> None:
        """A wavy line downwards."""
        steps = 24
        self.line(
            *((x + 1.3 * sin(3 * pi * at / steps), top + (bottom - top) * at / steps) for at in range(steps + 1)),
            width=1.5,
        )

    def figure(self, figure: str) -> None:
        """A figure in the middle of a round sign."""
        self.text(figure, 12, 10.5 if len(figure) < 3 else 8.0)

    def text(self, text: str, y: float, size: float) -> None:
        """A text in the middle of a sign's width."""
        letters = font(Weight.BOLD, round(size * self._unit))
        self._draw.text((12 * self._unit, y * self._unit), text, BLACK, letters, anchor="mm")

    def exclamation(self, top: float, bottom: float) -> None:
        """An exclamation mark in the middle."""
        self.line((12, top), (12, bottom - 3.5), width=2.2)
        self.disc(12, bottom - 0.9, 1.2)


def _lamp(pen: _SymbolPen) -> None:
    pen.line((12.5, 6), (12.5, 18))
    pen.arc(5, 6, 20.5, 18, -90, 90)


def _high_beam(pen: _SymbolPen) -> None:
    _lamp(pen)
    for y in (7.0, 10.3, 13.7, 17.0):
        pen.line((2, y), (10, y))


def _low_beam(pen: _SymbolPen) -> None:
    _lamp(pen)
    for y in (6.5, 9.8, 13.1, 16.4):
        pen.line((2, y + 3), (10, y))


def _position(pen: _SymbolPen) -> None:
    """Two lamps back to back, as those at the corners shine."""
    for lamp, ends in ((9.5, (1.5, 5.0)), (14.5, (22.5, 19.0))):
        pen.line((lamp, 8), (lamp, 16))
        for y in (8.0, 12.0, 16.0):
            pen.line((ends[0], y + (y - 12) / 2), (ends[1], y), width=1.5)
    pen.arc(5.5, 8, 13.5, 16, 90, 270)
    pen.arc(10.5, 8, 18.5, 16, -90, 90)


def _front_fog(pen: _SymbolPen) -> None:
    _lamp(pen)
    for y in (7.0, 11.0, 15.0):
        pen.line((1.5, y + 3), (10.5, y))
    pen.wave(6, 5, 20)


def _rear_fog(pen: _SymbolPen) -> None:
    pen.line((11.5, 6), (11.5, 18))
    pen.arc(3.5, 6, 19, 18, 90, 270)
    for y in (8.0, 12.0, 16.0):
        pen.line((13.5, y), (22.5, y))
    pen.wave(18, 5, 19)


def _hazard(pen: _SymbolPen) -> None:
    pen.line((12, 3), (22, 20), (2, 20), (12, 3), (22, 20))
    pen.line((12, 9.5), (16.5, 17), (7.5, 17), (12, 9.5), (16.5, 17))


def _belt(pen: _SymbolPen) -> None:
    pen.disc(12, 4.5, 2.8)
    pen.line((6.5, 21), (7, 14), (12, 9.5), (17, 14), (17.5, 21), (6.5, 21))
    pen.line((16.5, 10.5), (7, 20))


def _tyre(pen: _SymbolPen) -> None:
    pen.line((7, 3), (4, 9), (4, 14), (7, 18), (17, 18), (20, 14), (20, 9), (17, 3))
    for x in (8.0, 10.7, 13.3, 16.0):
        pen.line((x, 18), (x, 21.5), width=1.5)
    pen.exclamation(5, 15.5)


def _door(pen: _SymbolPen) -> None:
    pen.line((9, 5), (10.5, 2.5), (13.5, 2.5), (15, 5), (15, 20), (13.5, 22), (10.5, 22), (9, 20), (9, 5))
    for x, out in ((9, -6), (15, 6)):
        pen.line((x, 8), (x + out, 12))
        pen.line((x, 14), (x + out, 18))


def _frost(pen: _SymbolPen) -> None:
    for turn in range(6):
        across, down = cos(pi * turn / 3), sin(pi * turn / 3)
        pen.line((12, 12), (12 + 10 * across, 12 + 10 * down), width=1.6)
        for side in (-1, 1):
            branch = pi * turn / 3 + side * pi / 4
            start = (12 + 6 * across, 12 + 6 * down)
            pen.line(start, (start[0] + 3 * cos(branch), start[1] + 3 * sin(branch)), width=1.4)


def _stability(pen: _SymbolPen) -> None:
    pen.line((8.5, 2.5), (15.5, 2.5), (17.5, 7), (17.5, 11), (6.5, 11), (6.5, 7), (8.5, 2.5), (15.5, 2.5))
    pen.line((6.5, 7), (17.5, 7), width=1.4)
    for x in (8.0, 16.0):
        pen.wave(x, 13, 22.5)


def _cable(pen: _SymbolPen) -> None:
    for x in (9.0, 15.0):
        pen.line((x, 2), (x, 7))
    pen.line((5.5, 7), (18.5, 7), (18.5, 11), (15.5, 15), (8.5, 15), (5.5, 11), (5.5, 7), (18.5, 7))
    pen.line((12, 15), (12, 19), (9, 22), (4, 22))


def _battery(pen: _SymbolPen) -> None:
    pen.line((3, 8), (21, 8), (21, 19), (3, 19), (3, 8), (21, 8))
    for x in (7.5, 16.5):
        pen.line((x - 2, 5.8), (x + 2, 5.8), width=2.6)
        pen.line((x - 2, 13.5), (x + 2, 13.5), width=1.6)
    pen.line((16.5, 11.5), (16.5, 15.5), width=1.6)


def _warning(pen: _SymbolPen) -> None:
    pen.line((12, 3), (22, 20.5), (2, 20.5), (12, 3), (22, 20.5))
    pen.exclamation(9, 18.5)


_DRAWN: dict[Telltale, tuple[Colour, Callable[[_SymbolPen], None]]] = {
    Telltale.WARNING: (AMBER, _warning),
    Telltale.BELT: (RED, _belt),
    Telltale.DOOR: (RED, _door),
    Telltale.BATTERY: (RED, _battery),
    Telltale.HAZARD: (RED, _hazard),
    Telltale.TYRE: (AMBER, _tyre),
    Telltale.STABILITY: (AMBER, _stability),
    Telltale.FROST: (AMBER, _frost),
    Telltale.CABLE: (AMBER, _cable),
    Telltale.HIGH_BEAM: (BLUE, _high_beam),
    Telltale.LOW_BEAM: (GREEN, _low_beam),
    Telltale.POSITION: (GREEN, _position),
    Telltale.FRONT_FOG: (GREEN, _front_fog),
    Telltale.REAR_FOG: (AMBER, _rear_fog),
}


def colour(telltale: Telltale, *, night: bool) -> Colour:
    """Its colour by ISO 2575: red for danger, amber for caution, green and blue for what is on."""
    by_day = _DRAWN[telltale][0]
    return _BY_NIGHT[by_day] if night else by_day


@lru_cache(maxsize=64)
def symbol(telltale: Telltale, side: int) -> Image.Image:
    """The mask of a tell-tale, a square of that side in pixels."""
    picture = Image.new("L", (side * _FINE, side * _FINE), 0)
    _DRAWN[telltale][1](_SymbolPen(picture))
    return picture.reduce(_FINE)


PLATES = {"US": ("SPEED", "LIMIT"), "CA": ("MAXIMUM",)}
"""The words above the figure on limit signs that are rectangular plates, by country (MUTCD R2-1; MUTCD of Canada
RB-1)."""


@lru_cache(maxsize=16)
def sign_picture(kind: SignKind, figure: str, side: int, country: str = "") -> Image.Image:
    """A sign of the Vienna Convention: C,14 with its figure, C,17a, A,13 or E,11a; RGBA, of that side in pixels. A
    limit has the form of its country."""
    picture = Image.new("RGBA", (side * _FINE, side * _FINE), (0, 0, 0, 0))
    pen = _SymbolPen(picture)
    match kind:
        case SignKind.LIMIT if country in PLATES:
            for edge, fill in ((0.0, WHITE), (0.7, BLACK), (1.7, WHITE)):
                left, top, right, bottom = 2.5 + edge, edge, 21.5 - edge, 24 - edge
                pen.area((left, top), (right, top), (right, bottom), (left, bottom), fill=fill)
            words = PLATES[country]
            for at, word in enumerate(words):
                pen.text(word, (5.2 if len(words) > 1 else 6.0) + 4.6 * at, 4.8 if len(word) < 6 else 3.4)
            pen.text(figure, 17.0, 10.5 if len(figure) < 3 else 8.5)
        case SignKind.LIMIT:
            pen.disc(12, 12, 11.8, SIGN_RED)
            pen.disc(12, 12, 9.2, WHITE)
            pen.figure(figure)
        case SignKind.END_OF_LIMIT:
            pen.disc(12, 12, 11.8, BLACK)
            pen.disc(12, 12, 11.0, WHITE)
            for shift in (-3.0, -1.0, 1.0, 3.0):
                pen.line((5 + shift, 19 + shift / 3), (19 + shift / 3, 5 + shift), width=0.9, fill=BLACK)
        case SignKind.SCHOOL:
            pen.area((12, 1), (23.6, 21.5), (0.4, 21.5), fill=SIGN_RED)
            pen.area((12, 5.2), (20, 19.4), (4, 19.4), fill=WHITE)
            for x, y in ((10.0, 11.0), (14.0, 12.4)):
                pen.disc(x, y, 1.2, BLACK)
                pen.line((x, y + 1), (x, y + 4), width=1.5, fill=BLACK)
                pen.line((x - 1.3, y + 6.2), (x, y + 3.6), (x + 1.3, y + 6.2), width=1.0, fill=BLACK)
        case SignKind.TUNNEL:
            pen.area((1, 1), (23, 1), (23, 23), (1, 23), fill=SIGN_BLUE)
            pen.disc(12, 12, 8.2, WHITE)
            pen.area((3.8, 12), (20.2, 12), (20.2, 20.5), (3.8, 20.5), fill=WHITE)
            pen.disc(12, 13.5, 6.0, BLACK)
            pen.area((6, 13.5), (18, 13.5), (18, 20.5), (6, 20.5), fill=BLACK)
            pen.area((11, 14), (13, 14), (14.5, 20.5), (9.5, 20.5), fill=WHITE)
    return picture.reduce(_FINE)
