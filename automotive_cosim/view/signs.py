"""Faces of signs, as pictures of any size."""

from __future__ import annotations

from functools import lru_cache

from PIL import Image, ImageDraw

from automotive_cosim.cockpit.telltales import SIGN_RED, SignKind, sign_picture
from automotive_cosim.cockpit.theme import Weight, font
from automotive_cosim.view.scene import Board

_FINE = 4
_STOP_WORDS = {"JP": "止まれ"}
_KINDS = {Board.LIMIT: SignKind.LIMIT, Board.END_OF_LIMIT: SignKind.END_OF_LIMIT, Board.SCHOOL: SignKind.SCHOOL}
_DIAMONDS = ("US", "CA", "AU", "NZ", "IE", "JP", "MX")
"""Countries whose warning signs are yellow diamonds, and which warn of roadworks on orange or yellow ones."""
_BLACK, _WHITE, _YELLOW = (16, 18, 20), (250, 250, 250), (250, 200, 40)


@lru_cache(maxsize=128)
def board(kind: Board, figure: str, side: int, country: str) -> Image.Image:
    """A sign as its country has it; RGBA, a square of that side in pixels.

    Args:
        side: pixels.
        country: ISO 3166-1; empty for the Vienna Convention's form."""
    diamond = kind in (Board.SCHOOL, Board.ROADWORKS) and country in _DIAMONDS
    if kind in _KINDS and not diamond:
        return sign_picture(_KINDS[kind], figure, side, country)
    picture = Image.new("RGBA", (side * _FINE, side * _FINE), (0, 0, 0, 0))
    draw, unit = ImageDraw.Draw(picture), side * _FINE / 24

    def area(*points: tuple[float, float], fill: tuple[int, int, int]) -> None:
        draw.polygon([(round(x * unit), round(y * unit)) for x, y in points], fill)

    if diamond:
        area((12, 0), (24, 12), (12, 24), (0, 12), fill=_BLACK)
        area((12, 0.8), (23.2, 12), (12, 23.2), (0.8, 12), fill=_YELLOW if kind is Board.SCHOOL else (246, 128, 30))
        _worker(draw, unit) if kind is Board.ROADWORKS else _children(draw, unit)
    elif kind is Board.STOP and country != "JP":
        for inset, fill in ((0.0, _WHITE), (0.8, SIGN_RED)):
            a, b, c, d = 0.0 + inset, 7.0 + inset * 0.4, 17.0 - inset * 0.4, 24.0 - inset
            area((b, a), (c, a), (d, b), (d, c), (c, d), (b, d), (a, c), (a, b), fill=fill)
        draw.text((12 * unit, 12 * unit), "STOP", _WHITE, font(Weight.BOLD, round(8.2 * unit)), anchor="mm")
    elif kind in (Board.STOP, Board.GIVE_WAY):
        area((0, 1.5), (24, 1.5), (12, 22.5), fill=SIGN_RED)
        if kind is Board.STOP:
            letters = font(Weight.EAST_ASIAN, round(5.0 * unit))
            draw.text((12 * unit, 8 * unit), _STOP_WORDS[country], _WHITE, letters, anchor="mm")
        else:
            area((5, 4.4), (19, 4.4), (12, 16.8), fill=_WHITE)
    elif kind is Board.CLOSED:
        for radius, fill in ((11.8, SIGN_RED), (9.0, _WHITE)):
            box = [round((12 + sign * radius) * unit) for sign in (-1, -1, 1, 1)]
            draw.ellipse(box, fill)
    else:
        area((12, 1), (23.6, 21.5), (0.4, 21.5), fill=SIGN_RED)
        area((12, 5.2), (20, 19.4), (4, 19.4), fill=_WHITE)
        _worker(draw, unit)
    return picture.reduce(_FINE)


def _worker(draw: ImageDraw.ImageDraw, unit: float) -> None:
    """Somebody with a shovel at a heap."""
    width = max(1, round(1.5 * unit))

    def line(*points: tuple[float, float]) -> None:
        draw.line([(round(x * unit), round(y * unit)) for x, y in points], _BLACK, width)

    draw.ellipse([round(part * unit) for part in (11.0, 8.2, 13.0, 10.2)], _BLACK)
    line((11.4, 10.6), (10.2, 14.0), (11.2, 18.4))
    line((10.2, 14.0), (8.4, 18.4))
    line((11.4, 11.4), (14.6, 14.4))
    line((12.6, 12.0), (15.6, 17.6))
    draw.polygon(
        [(round(x * unit), round(y * unit)) for x, y in ((14.4, 18.6), (16.6, 16.2), (18.8, 18.6))], _BLACK
    )


def _children(draw: ImageDraw.ImageDraw, unit: float) -> None:
    """Two people who cross."""
    width = max(1, round(1.3 * unit))
    for x, y in ((10.0, 7.5), (14.4, 9.0)):
        draw.ellipse([round(part * unit) for part in (x - 1.1, y - 1.1, x + 1.1, y + 1.1)], _BLACK)
        for points in (
            ((x, y + 1.4), (x, y + 5.2)),
            ((x - 1.6, y + 8.2), (x, y + 5.0), (x + 1.6, y + 8.2)),
            ((x - 1.8, y + 3.4), (x, y + 2.2), (x + 1.8, y + 3.4)),
        ):
            draw.line([(round(a * unit), round(b * unit)) for a, b in points], _BLACK, width)
