"""Covers of what plays, made from its name: the same name has the same cover on every machine."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from hashlib import blake2b
from math import pi, sin

from PIL import Image, ImageDraw

from automotive_cosim.cockpit.theme import Colour

_FINE = 2
_INKS: tuple[tuple[Colour, Colour, Colour], ...] = (
    ((18, 52, 86), (240, 200, 8), (221, 28, 26)),
    ((44, 24, 66), (238, 97, 131), (255, 209, 102)),
    ((9, 60, 60), (129, 199, 132), (250, 243, 221)),
    ((120, 30, 44), (255, 178, 102), (252, 236, 212)),
    ((24, 28, 36), (79, 168, 255), (214, 233, 255)),
    ((70, 58, 38), (226, 192, 128), (146, 172, 96)),
    ((0, 84, 110), (72, 202, 228), (255, 255, 255)),
    ((60, 60, 70), (255, 107, 53), (247, 197, 159)),
)
"""Ground, and two colours on it."""


@lru_cache(maxsize=32)
def cover(name: str, side: int) -> Image.Image:
    """The cover of that name, a square of that side in pixels."""
    dice = blake2b(name.encode(), digest_size=8).digest()
    inks, motif, shift = _INKS[dice[0] % len(_INKS)], _MOTIFS[dice[1] % len(_MOTIFS)], dice[2] / 255
    picture = Image.new("RGB", (side * _FINE, side * _FINE), inks[0])
    motif(ImageDraw.Draw(picture), side * _FINE, inks, shift)
    return picture.reduce(_FINE)


Inks = tuple[Colour, Colour, Colour]


def _sun(draw: ImageDraw.ImageDraw, side: int, inks: Inks, shift: float) -> None:
    radius, x, y = side * (0.2 + 0.1 * shift), side * (0.3 + 0.4 * shift), side * 0.42
    draw.ellipse((x - radius, y - radius, x + radius, y + radius), inks[1])
    for line in range(5):
        top = side * (0.62 + 0.08 * line)
        draw.rectangle((0, top, side, top + side * (0.05 - 0.008 * line)), inks[2])


def _rings(draw: ImageDraw.ImageDraw, side: int, inks: Inks, shift: float) -> None:
    x, y = side * (0.25 + 0.5 * shift), side * (0.75 - 0.5 * shift)
    for ring in range(6, 0, -1):
        radius = side * 0.13 * ring
        draw.ellipse((x - radius, y - radius, x + radius, y + radius), inks[ring % 3])


def _hills(draw: ImageDraw.ImageDraw, side: int, inks: Inks, shift: float) -> None:
    draw.ellipse((side * 0.62, side * 0.12, side * 0.84, side * 0.34), inks[2])
    peak = side * (0.25 + 0.3 * shift)
    draw.polygon(((0, side), (peak, side * 0.35), (side * 0.95, side)), inks[1])
    draw.polygon(((side * 0.3, side), (side * 0.75, side * 0.55), (side * 1.2, side)), inks[2])


def _stripes(draw: ImageDraw.ImageDraw, side: int, inks: Inks, shift: float) -> None:
    wide = side * (0.08 + 0.06 * shift)
    for stripe in range(-2, 8):
        x = stripe * 2.4 * wide
        draw.polygon(((x, side), (x + side * 0.5, 0), (x + side * 0.5 + wide, 0), (x + wide, side)), inks[1])
    draw.ellipse((side * 0.3, side * 0.3, side * 0.7, side * 0.7), inks[2])


def _waves(draw: ImageDraw.ImageDraw, side: int, inks: Inks, shift: float) -> None:
    for wave in range(5):
        points = [
            (x, side * (0.3 + 0.14 * wave) + side * 0.06 * sin(2 * pi * (x / side * 1.5 + shift + 0.13 * wave)))
            for x in range(0, side + 8, 8)
        ]
        draw.polygon((*points, (side, side), (0, side)), inks[wave % 3])


def _tiles(draw: ImageDraw.ImageDraw, side: int, inks: Inks, shift: float) -> None:
    cell = side / 4
    for at in range(16):
        x, y, turn = at % 4 * cell, at // 4 * cell, round(at * (3 + 4 * shift)) % 4
        draw.pieslice((x - cell, y - cell, x + cell, y + cell) if turn < 2 else (x, y, x + 2 * cell, y + 2 * cell),
                      0 if turn < 2 else 180, 90 if turn < 2 else 270, inks[1 + at % 2])  # fmt: skip


_MOTIFS: tuple[Callable[[ImageDraw.ImageDraw, int, Inks, float], None], ...] = (
    _sun,
    _rings,
    _hills,
    _stripes,
    _waves,
    _tiles,
)
