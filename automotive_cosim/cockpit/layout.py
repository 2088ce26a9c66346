"""Containers: how a box is divided among what is in it, from its start to its end.

    head, _, body = column(card, 40, GAP, REST)     one above the other
    name, value = row(head, 130, REST)              side by side
    menu, page = panes(content, 264, REST)          side by side; where it is taller than wide, stacked

A part is its size in logical pixels, or ``REST``: what the others leave, in equal shares. Parts follow each other
without a gap; a gap is a part of its own.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import accumulate, pairwise
from typing import Final

from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.theme import GAP

REST: Final = None
"""A part that takes what the others leave."""

LayoutPart = int | None
FULL = 1232
"""Width of a screen for which the sizes of its parts are given."""


@lru_cache(maxsize=2048)
def column(rect: Rect, *parts: LayoutPart) -> tuple[Rect, ...]:
    """The boxes of the parts, one above the other. Raises ValueError: they are higher than the box."""
    return tuple(Rect(rect.x, rect.y + top, rect.width, end - top) for top, end in _edges(rect.height, parts))


@lru_cache(maxsize=2048)
def row(rect: Rect, *parts: LayoutPart) -> tuple[Rect, ...]:
    """The boxes of the parts, side by side. Raises ValueError: they are wider than the box."""
    return tuple(Rect(rect.x + left, rect.y, end - left, rect.height) for left, end in _edges(rect.width, parts))


def panes(rect: Rect, *parts: LayoutPart) -> tuple[Rect, ...]:
    """The parts of a screen, a gap apart: side by side, in a narrow box narrower, or in a box taller than wide one
    above the other, as high as each other.

    Raises ValueError: they are wider than the box."""
    if rect.height > rect.width:
        return rect.rows(len(parts), GAP)
    if rect.width < FULL:
        parts = tuple(part and part * rect.width // FULL for part in parts)
    spaced = [part for each in parts for part in (GAP, each)][1:]
    return row(rect, *spaced)[::2]


def _edges(length: int, parts: tuple[LayoutPart, ...]) -> tuple[tuple[int, int], ...]:
    """Beginning and end of each part."""
    left, shares = length - sum(part or 0 for part in parts), sum(part is REST for part in parts)
    if left < 0:
        raise ValueError(f"parts of {length - left} pixels do not fit into {length}")
    whole, surplus = divmod(left, shares or 1)
    sizes = []
    for part in parts:
        if part is REST:
            sizes.append(whole + (surplus > 0))
            surplus -= 1
        else:
            sizes.append(part)
    return tuple(pairwise(accumulate(sizes, initial=0)))
