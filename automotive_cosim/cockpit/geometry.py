"""Rectangles on the screen, in logical pixels: as many as the display's size says (``size``), at any resolution."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple


class Rect(NamedTuple):
    """A box; ``right`` and ``bottom`` are exclusive. A tuple: a step makes and compares hundreds."""

    x: int
    y: int
    width: int
    height: int

    @property
    def right(self) -> int:
        """First column beyond it."""
        return self.x + self.width

    @property
    def bottom(self) -> int:
        """First row beyond it."""
        return self.y + self.height

    @property
    def centre(self) -> tuple[int, int]:
        """Its middle pixel, (x, y)."""
        return self.x + self.width // 2, self.y + self.height // 2

    def contains(self, x: float, y: float) -> bool:
        """Whether the point lies in it."""
        return self.x <= x < self.right and self.y <= y < self.bottom

    def encloses(self, other: Rect) -> bool:
        """Whether it contains the other completely."""
        return self.x <= other.x and self.y <= other.y and other.right <= self.right and other.bottom <= self.bottom

    def overlaps(self, other: Rect) -> bool:
        """Whether the two share a pixel."""
        return self.x < other.right and other.x < self.right and self.y < other.bottom and other.y < self.bottom

    def edges(self, scale: float) -> tuple[int, int, int, int]:
        """Left, top, right and bottom in pixels, with ``scale`` pixels per logical pixel."""
        return round(self.x * scale), round(self.y * scale), round(self.right * scale), round(self.bottom * scale)

    def within(self, other: Rect) -> Rect:
        """The intersection with the other; empty if there is none."""
        x, y = max(self.x, other.x), max(self.y, other.y)
        return Rect(x, y, max(0, min(self.right, other.right) - x), max(0, min(self.bottom, other.bottom) - y))

    def inset(self, across: int, down: int | None = None) -> Rect:
        """Smaller by that much on each side; ``down`` is the same as ``across`` if not given."""
        down = across if down is None else down
        return Rect(self.x + across, self.y + down, self.width - 2 * across, self.height - 2 * down)

    def left(self, width: int) -> Rect:
        """Its leftmost part."""
        return Rect(self.x, self.y, width, self.height)

    def right_part(self, width: int) -> Rect:
        return Rect(self.right - width, self.y, width, self.height)

    def top(self, height: int) -> Rect:
        """Its uppermost part."""
        return Rect(self.x, self.y, self.width, height)

    def bottom_part(self, height: int) -> Rect:
        return Rect(self.x, self.bottom - height, self.width, height)

    def below(self, height: int) -> Rect:
        """The rest below its uppermost ``height`` rows."""
        return Rect(self.x, self.y + height, self.width, self.height - height)

    def middle(self, width: int, height: int) -> Rect:
        """A box of that size around its centre."""
        return Rect(self.x + (self.width - width) // 2, self.y + (self.height - height) // 2, width, height)

    def moved(self, across: int, down: int) -> Rect:
        """The same box elsewhere."""
        return Rect(self.x + across, self.y + down, self.width, self.height)

    def columns(self, count: int, gap: int) -> tuple[Rect, ...]:
        """``count`` boxes side by side that fill it to the last pixel."""
        edges = [self.x + round(i * (self.width + gap) / count) for i in range(count + 1)]
        return tuple(Rect(a, self.y, b - gap - a, self.height) for a, b in pairwise(edges))

    def rows(self, count: int, gap: int) -> tuple[Rect, ...]:
        """``count`` boxes one above the other that fill it to the last pixel."""
        edges = [self.y + round(i * (self.height + gap) / count) for i in range(count + 1)]
        return tuple(Rect(self.x, a, self.width, b - gap - a) for a, b in pairwise(edges))
