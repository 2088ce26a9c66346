"""Coordinates: those in which a model answers, and the screen's pixels."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, floor, prod, sqrt
from typing import Protocol


class Grid(Protocol):
    """The coordinates of a format."""

    @property
    def told(self) -> str:
        """What they are, in words."""
        ...

    def span(self, width: int, height: int) -> tuple[int, int]:
        """The coordinates of the lower right corner of a picture of that size."""
        ...


@dataclass(frozen=True, slots=True)
class Pixels:
    """Pixels of the picture as it is sent."""

    told = "pixels"

    def span(self, width: int, height: int) -> tuple[int, int]:
        return width, height


@dataclass(frozen=True, slots=True)
class Share:
    """A share of width and of height, whatever their ratio."""

    whole: int
    """999 or 1000."""

    @property
    def told(self) -> str:
        return f"0 to {self.whole}"

    def span(self, width: int, height: int) -> tuple[int, int]:
        return self.whole, self.whole


@dataclass(frozen=True, slots=True)
class Resized:
    """Pixels of the picture after the model's own processor has resized it.

    Both sides become multiples of ``factor``, and the area is kept between two bounds ("smart resize", which
    Qwen2-VL's image processor introduced)."""

    factor: int
    least_px: int
    most_px: int

    @property
    def told(self) -> str:
        return f"pixels, resized to multiples of {self.factor}"

    def span(self, width: int, height: int) -> tuple[int, int]:

        def multiples(scale: float, rounded: Callable[[float], int]) -> tuple[int, int]:
            across, down = (self.factor * max(1, rounded(side / scale / self.factor)) for side in (width, height))
            return across, down

        area = prod(multiples(1.0, round))
        if area > self.most_px:
            return multiples(sqrt(width * height / self.most_px), floor)
        if area < self.least_px:
            return multiples(sqrt(width * height / self.least_px), ceil)
        return multiples(1.0, round)


@dataclass(frozen=True, slots=True)
class GuiScreen:
    """A screen's size in pixels, and the coordinates in which it is spoken of."""

    width: int
    height: int
    grid: Grid

    def pixel(self, x: float, y: float) -> tuple[int, int]:
        """The pixel at these coordinates; those beyond an edge are on it."""
        across, down = self.grid.span(self.width, self.height)
        return _near(x / across * self.width, self.width), _near(y / down * self.height, self.height)

    def point(self, x: int, y: int) -> tuple[int, int]:
        """The coordinates of a pixel."""
        across, down = self.grid.span(self.width, self.height)
        return round(x * across / self.width), round(y * down / self.height)


def _near(value: float, side: int) -> int:
    return min(side - 1, max(0, round(value)))
