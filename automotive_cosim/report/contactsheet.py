"""Screens of a cockpit on one sheet: all of them by day and by night, or those of an episode."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

from PIL import Image

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.drawing import Canvas
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.registry import pages
from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.cockpit.theme import DAY, Type

COLUMNS, CAPTION_HEIGHT, GAP = 6, 22, 10

SheetTile = tuple[str, Image.Image | None]
"""A caption and a screen; None leaves the tile empty."""


def contact_sheet(cockpit: Cockpit, width: int = 400) -> Image.Image:
    """The sheet, six screens per row, each by day and next to it by night.

    Args:
        width: of each screen in pixels."""
    return sheet(tuple(pictures(cockpit)), COLUMNS, width)


def sheet(tiles: Sequence[SheetTile], columns: int, width: int = 400) -> Image.Image:
    """Screens with a caption above each, row by row.

    Args:
        columns: tiles per row.
        width: of each screen in pixels."""
    shown = [picture.size for _, picture in tiles if picture is not None] or [(16, 9)]
    size = width, round(width * shown[0][1] / shown[0][0])
    step_x, step_y = width + GAP, size[1] + CAPTION_HEIGHT + GAP
    lines = -(-len(tiles) // columns)
    canvas = Canvas.plain(columns * step_x + GAP, lines * step_y + GAP, 1.0, DAY.background)
    for at, (name, picture) in enumerate(tiles):
        left, top = GAP + at % columns * step_x, GAP + at // columns * step_y
        canvas.text(Rect(left, top, width, CAPTION_HEIGHT), name, Type.SMALL, DAY.text)
        if picture is not None:
            canvas.image.paste(picture.resize(size, Image.Resampling.LANCZOS), (left, top + CAPTION_HEIGHT))
    return canvas.image


def pictures(cockpit: Cockpit) -> Iterator[tuple[str, Image.Image]]:
    """Name and picture at full size of every screen, each first by day and then by night."""
    for screen, light in product(dict.fromkeys((*pages(), *cockpit.state.make.screens)), HMI.DAY_NIGHT.allowed):
        shown = cockpit.copy()
        shown.inject(HMI.DAY_NIGHT.path, light)
        shown.visit(screen)
        yield f"{screen}, {light.lower()}", Image.fromarray(shown.screenshot())
