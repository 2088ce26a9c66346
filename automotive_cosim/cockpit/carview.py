"""The car from above: body, glass with its fog, the light of its lamps, and an arrow where it heads."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from PIL import Image, ImageChops, ImageDraw, ImageFilter

from automotive_cosim.cockpit.theme import Colour, Palette

_FINE = 3
Lamps = tuple[bool, bool, bool, bool, bool, bool]
"""Position, low beam, high beam, front fog, rear fog, hazard."""
Outline = list[tuple[float, float]]

HALF_LENGTH, HALF_WIDTH = 150.0, 66.0
"""Size of the car, in units of which the picture is 300 wide."""
SHIFT_DOWN = 42.0
"""Position of the car, below the middle to leave room for its beams."""

WARM: Colour = (255, 226, 170)
COOL: Colour = (206, 228, 255)
YELLOW: Colour = (255, 206, 96)
RED: Colour = (255, 40, 44)
AMBER: Colour = (255, 156, 24)


@lru_cache(maxsize=16)
def car(
    width: int, height: int, lamps: Lamps, windshield: int, rear_window: int, palette: Palette, *, night: bool
) -> Image.Image:
    """The picture of that size in pixels.

    Args:
        width: pixels.
        height: pixels.
        windshield: its opacity in tenths.
        rear_window: its opacity in tenths.
        palette: the colours of what is around it."""
    unit = width / 300
    x, y = width / 2, height / 2 + SHIFT_DOWN * unit
    light = _light(width, height, lamps, palette)
    fine = light.resize((width * _FINE, height * _FINE), Image.Resampling.NEAREST)

    def place(points: Outline) -> Outline:
        return [((x + dx * unit) * _FINE, (y + dy * unit) * _FINE) for dx, dy in points]

    _body(ImageDraw.Draw(fine), place, round(unit * _FINE), (windshield, rear_window), night)
    _lamps(ImageDraw.Draw(fine), place, lamps, night)
    ahead = place([(-16, -HALF_LENGTH - 14), (0, -HALF_LENGTH - 28), (16, -HALF_LENGTH - 14)])
    ImageDraw.Draw(fine).line(ahead, palette.muted, round(5 * unit * _FINE), joint="curve")
    return fine.reduce(_FINE)


@lru_cache(maxsize=16)
def _light(width: int, height: int, lamps: Lamps, palette: Palette) -> Image.Image:
    """The light of the lamps on the road, fading with distance."""
    picture = Image.new("RGB", (width, height), palette.surface)
    unit = width / 300
    x, y = width / 2, height / 2 + SHIFT_DOWN * unit
    position, low, high, front_fog, rear_fog, hazard = lamps
    front, rear = y - (HALF_LENGTH - 8) * unit, y + (HALF_LENGTH - 8) * unit
    for side in (-1, 1):
        lamp = x + side * 44 * unit
        if high:
            _cone(picture, lamp, front, 128 * unit, 30 * unit, 96 * unit, COOL)
        elif low:
            _cone(picture, lamp, front, 92 * unit, 30 * unit, 86 * unit, WARM)
        if front_fog:
            _cone(picture, lamp, front, 52 * unit, 40 * unit, 120 * unit, YELLOW)
        if position:
            _cone(picture, lamp, rear, -34 * unit, 30 * unit, 52 * unit, RED)
        if hazard:
            for end in (front + 14 * unit, rear - 14 * unit):
                _halo(picture, x + side * 62 * unit, end, 26 * unit, AMBER)
    if rear_fog:
        _cone(picture, x - 22 * unit, rear, -70 * unit, 30 * unit, 110 * unit, RED)
    return picture


def _cone(picture: Image.Image, x: float, y: float, reach: float, near: float, far: float, colour: Colour) -> None:
    """Light from a lamp, ``reach`` pixels up the picture (down if negative), ``far`` wide at its end."""
    mask = Image.new("L", picture.size)
    corners = [(x - near / 2, y), (x + near / 2, y), (x + far / 2, y - reach), (x - far / 2, y - reach)]
    ImageDraw.Draw(mask).polygon(corners, 255)
    soft = mask.filter(ImageFilter.GaussianBlur(near / 3.5))
    rows = np.arange(picture.height, dtype=np.float64)[:, None]
    fade = np.clip(1 - (y - rows) / reach, 0, 1) ** 1.4 * 210
    ramp = Image.fromarray(np.broadcast_to(fade, (picture.height, picture.width)).astype(np.uint8))
    picture.paste(colour, (0, 0), ImageChops.multiply(soft, ramp))


def _halo(picture: Image.Image, x: float, y: float, radius: float, colour: Colour) -> None:
    mask = Image.new("L", picture.size)
    ImageDraw.Draw(mask).ellipse((x - radius, y - radius, x + radius, y + radius), 200)
    picture.paste(colour, (0, 0), mask.filter(ImageFilter.GaussianBlur(radius / 2)))


def _body(
    brush: ImageDraw.ImageDraw, place: Callable[[Outline], Outline], pen: int, opaque: tuple[int, int], night: bool
) -> None:
    paint: Colour = (84, 99, 121) if night else (176, 188, 203)
    light: Colour = (104, 121, 146) if night else (198, 208, 220)
    edge: Colour = (124, 142, 169) if night else (128, 142, 160)
    line: Colour = (66, 79, 98) if night else (152, 165, 182)
    roof: Colour = (46, 56, 71) if night else (92, 106, 124)
    glass: Colour = (13, 18, 25) if night else (40, 52, 68)
    fogged: Colour = (208, 216, 224) if night else (236, 241, 246)
    tyre: Colour = (24, 29, 37) if night else (70, 80, 94)
    for side in (-1, 1):
        for dy in (-94, 92):
            brush.polygon(place(_oval(side * 60, dy, 11, 27, 4)), tyre)
        brush.polygon(place([(side * 58, -50), (side * 84, -46), (side * 86, -36), (side * 60, -38)]), edge)
    brush.polygon(place(_oval(0, 0, HALF_WIDTH, HALF_LENGTH, 4.2)), edge)
    brush.polygon(place(_oval(0, 0, HALF_WIDTH - 2.5, HALF_LENGTH - 2.5, 4.2)), paint)
    brush.polygon(place([(-34, -138), (34, -138), (40, -86), (-40, -86)]), light)
    brush.polygon(place([(-42, 116), (42, 116), (38, 134), (-38, 134)]), light)
    for side in (-1, 1):
        brush.line(place([(side * 38, -140), (side * 50, -78)]), line, pen)
        brush.line(place([(side * 47, 112), (side * 42, 138)]), line, pen)
    brush.polygon(place(_oval(0, 12, 56, 98, 5)), roof)
    front = [(-52, -62), (-40, -80), (0, -86), (40, -80), (52, -62), (43, -30), (0, -35), (-43, -30)]
    back = [(-43, 72), (0, 76), (43, 72), (50, 98), (36, 107), (0, 110), (-36, 107), (-50, 98)]
    brush.polygon(place([(float(a), float(b)) for a, b in front]), _blend(glass, fogged, opaque[0]))
    brush.polygon(place([(float(a), float(b)) for a, b in back]), _blend(glass, fogged, opaque[1]))
    for side in (-1, 1):
        brush.polygon(place([(side * 55, -54), (side * 47, -26), (side * 47, 66), (side * 53, 88)]), glass)
        brush.line(place([(side * 47, 20), (side * 56, 20)]), roof, 3 * pen)


def _lamps(brush: ImageDraw.ImageDraw, place: Callable[[Outline], Outline], lamps: Lamps, night: bool) -> None:
    position, low, high, front_fog, rear_fog, hazard = lamps
    dull: Colour = (150, 164, 184) if night else (226, 232, 239)
    for side in (-1, 1):
        head: Colour = (255, 255, 250) if low or high else WARM if position else dull
        brush.polygon(
            place([(side * 32, -142), (side * 50, -133), (side * 57, -118), (side * 50, -122), (side * 34, -134)]),
            head,
        )
        if front_fog:
            brush.polygon(place(_oval(side * 24, -144, 7, 4, 2)), YELLOW)
        tail: Colour = (255, 66, 66) if position else (134, 44, 50)
        brush.polygon(
            place([(side * 28, 145), (side * 50, 136), (side * 57, 122), (side * 48, 130), (side * 28, 138)]), tail
        )
        if hazard:
            for dy in (-122, 126):
                brush.polygon(place(_oval(side * 58, dy, 6, 8, 2)), AMBER)
    if rear_fog:
        brush.polygon(place(_oval(-20, 143, 9, 4.5, 2)), RED)


def _oval(x: float, y: float, across: float, down: float, power: float) -> Outline:
    turn = np.linspace(0, 2 * np.pi, 96, endpoint=False)
    cos, sin = np.cos(turn), np.sin(turn)
    xs = x + across * np.sign(cos) * np.abs(cos) ** (2 / power)
    ys = y + down * np.sign(sin) * np.abs(sin) ** (2 / power)
    return [(float(a), float(b)) for a, b in zip(xs, ys, strict=True)]


def _blend(clear: Colour, fogged: Colour, tenths: int) -> Colour:
    share = min(10, max(0, tenths)) / 10
    red, green, blue = (round(a + (b - a) * share) for a, b in zip(clear, fogged, strict=True))
    return red, green, blue
