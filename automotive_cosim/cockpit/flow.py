"""Flow: what stands on a screen in the order in which it is read, each part as high as it is by nature.

    card(title(Icon.VOLUME, say("Volume")), 20, slider(MEDIA.VOLUME, state), REST, switch(MEDIA.MUTED, state))

Widgets are made without their boxes; ``fill`` gives a box to each. Between them, a number is a gap, and ``REST``
one that takes what the others leave. ``(92, part)`` is a part with another height than its own, or in a ``line``
its width, and ``(REST, part)`` one that takes what is left.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any

from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, LayoutPart, column, panes, row
from automotive_cosim.cockpit.theme import Type
from automotive_cosim.cockpit.widgets import Button, Card, Label, Slider, Tile, Widget

HEIGHTS = {Tile: 60, Slider: 84, Button: 72}
"""Natural heights in logical pixels; a label in ``Type.LABEL`` is as high as ``LINE``, others take what is left."""
LINE, NARROWER = 28, 0.9
PADDING = 28, 24
"""Between the edge of a large card and what is in it."""


@dataclass(slots=True)
class Block:
    """Parts, and how a box is divided among them; they need not have a box of their own in the tree."""

    parts: tuple[BlockPart | None, ...]
    """None where a box stays empty."""
    divide: Callable[[Rect], Iterable[Rect]]
    height: LayoutPart = REST
    """Its natural height; ``REST`` if it takes what is left."""
    frame: Card | None = None
    """The card around them, which has the whole box."""


BlockPart = Widget | Block | Callable[[Rect], Widget]
"""A widget without its box, several of them, or what makes one for its box."""
BlockItem = BlockPart | int | None | tuple[LayoutPart, BlockPart]
"""A part, a gap, or a part with a size."""


def fill(rect: Rect, *parts: BlockPart | None) -> tuple[Widget, ...]:
    """The widgets of the parts, each of which has the whole box."""
    found: list[Widget] = []
    for part in parts:
        _place(part, rect, found)
    return tuple(found)


def _place(part: BlockPart | None, rect: Rect, found: list[Widget]) -> None:
    """Adds the widgets of a part; one list for all and no generators, for speed."""
    if isinstance(part, Widget):
        _set(part, "rect", rect)
        found.append(part)
    elif isinstance(part, Block):
        frame = part.frame
        inner = found if frame is None else []
        for one, box in zip(part.parts, part.divide(rect), strict=False):
            if one is not None:
                _place(one, box, inner)
        if frame is not None:
            _set(frame, "rect", rect)
            _set(frame, "children", tuple(inner))
            found.append(frame)
    elif part is not None:
        found.append(part(rect))


_set = object.__setattr__
"""Widgets are frozen for all others."""


def natural(part: BlockPart | None) -> LayoutPart:
    """The height of a part that is not told another."""
    if isinstance(part, Block):
        return part.height
    if isinstance(part, Label):
        return LINE if part.style is Type.LABEL and part.lines == 1 else REST
    return HEIGHTS.get(type(part)) if isinstance(part, Widget) else REST


def stack(*items: BlockItem) -> Block:
    """One above the other."""
    parts, sizes = _sized(items, upright=True)
    height = REST if REST in sizes else sum(size or 0 for size in sizes)
    return Block(parts, lambda rect: column(rect, *sizes), height)


def line(*items: BlockItem) -> Block:
    """Side by side; as high as the highest. In a box that is too narrow, sizes are up to a tenth less."""
    parts, sizes = _sized(items, upright=False)
    fixed = sum(size or 0 for size in sizes)

    def divide(rect: Rect) -> tuple[Rect, ...]:
        if rect.width < fixed <= rect.width / NARROWER:
            return row(rect, *(size and int(size * rect.width / fixed) for size in sizes))
        return row(rect, *sizes)

    return Block(parts, divide, _highest(parts))


def panels(*items: BlockItem) -> Block:
    """Side by side, a gap apart; one above the other where the box is taller than wide (``layout.panes``)."""
    parts, sizes = _sized(items, upright=False)
    return Block(parts, lambda rect: panes(rect, *sizes))


def grid(columns: int, gap: int | tuple[int, int], *parts: BlockPart | None) -> Block:
    """Cells of one size, line by line; ``gap`` is between them, or across and down."""
    across, down = gap if isinstance(gap, tuple) else (gap, gap)
    lines = -(-len(parts) // columns)
    highest = _highest(parts)
    return Block(
        parts,
        lambda rect: _cells(rect, lines, columns, across, down),
        highest if highest is None else lines * (highest + down) - down,
    )


@lru_cache(maxsize=2048)
def _cells(rect: Rect, lines: int, columns: int, across: int, down: int) -> tuple[Rect, ...]:
    return tuple(cell for one in rect.rows(lines, down) for cell in one.columns(columns, across))


def at(shape: Callable[[Rect], Rect], *parts: BlockPart) -> Block:
    """Parts in a box that is derived from theirs: ``at(lambda box: box.middle(88, 64), button)``."""
    return Block(parts, lambda rect: [shape(rect)] * len(parts))


def card(*items: BlockItem, padding: tuple[int, int] = PADDING, height: LayoutPart = REST, **options: Any) -> Block:
    """A stack on a card; ``options`` are fields of ``Card``."""
    inner = stack(*items)
    return framed(inner, padding, height, **options)


def framed(inner: BlockPart, padding: tuple[int, int] = (0, 0), height: LayoutPart = REST, **options: Any) -> Block:
    """A card around a part."""
    across, down = padding
    return Block((inner,), partial(_inset, across, down), height, Card(**options))


def _inset(across: int, down: int, rect: Rect) -> tuple[Rect]:
    return (rect.inset(across, down),)


def _highest(parts: Iterable[BlockPart | None]) -> LayoutPart:
    highest = 0
    for part in parts:
        if part is not None:
            height = natural(part)
            if height is None:
                return REST
            highest = max(highest, height)
    return highest or REST


def _sized(
    items: Iterable[BlockItem], upright: bool
) -> tuple[tuple[BlockPart | None, ...], tuple[LayoutPart, ...]]:
    """The parts, None for a gap, and their sizes: down if ``upright``, else across."""
    parts, sizes = list[BlockPart | None](), list[LayoutPart]()
    for item in items:
        if item is None or isinstance(item, int):
            parts.append(None)
            sizes.append(item)
        elif isinstance(item, tuple):
            sizes.append(item[0])
            parts.append(item[1])
        else:
            parts.append(item)
            sizes.append(natural(item) if upright else REST)
    return tuple(parts), tuple(sizes)
