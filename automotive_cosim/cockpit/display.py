"""The picture and the list of the display, drawn anew only where something changed."""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from automotive_cosim.cockpit import accessibility
from automotive_cosim.cockpit.drawing import pixels_of
from automotive_cosim.cockpit.render import render, repaint
from automotive_cosim.cockpit.widgets import Screen
from automotive_cosim.contracts import Element


@dataclass(frozen=True, slots=True)
class _Frame:
    """A widget tree and its picture, which is never modified; the drawing library's own would take more than it."""

    screen: Screen
    pixels: npt.NDArray[np.uint8]


class Display:
    """Keeps the last picture and the last list."""

    def __init__(self, scale: float) -> None:
        """Nothing is drawn yet; the picture has ``scale`` pixels per logical pixel."""
        self._scale = scale
        self._frame: _Frame | None = None
        self._listed: tuple[Screen, tuple[Element, ...]] | None = None

    @property
    def scale(self) -> float:
        """Pixels of the picture per logical pixel."""
        return self._scale

    def elements(self, screen: Screen) -> tuple[Element, ...]:
        if self._listed is None or self._listed[0] is not screen:
            self._listed = screen, accessibility.elements(screen, self.scale)
        return self._listed[1]

    def screenshot(self, screen: Screen) -> npt.NDArray[np.uint8]:
        """The picture, (height, width, 3), RGB, read-only; the same array as long as nothing changes."""
        if self._frame is None or self._frame.screen is not screen:
            if self._frame is not None and self._frame.screen == screen:
                self._frame = replace(self._frame, screen=screen)
            else:
                self._frame = self._drawn(screen)
        return self._frame.pixels

    def _drawn(self, screen: Screen) -> _Frame:
        """Draws the frame, or only where it differs from the last one."""
        if self._frame is None:
            picture = render(screen, self._scale).image
            return _Frame(screen, pixels_of(picture))
        picture, boxes = repaint(self._frame.screen, self._frame.pixels, screen)
        pixels = self._frame.pixels.copy()
        for box in boxes:
            edges = box.edges(self.scale)
            left, top, right, bottom = edges
            pixels[top:bottom, left:right] = pixels_of(picture.crop(edges))
        pixels.flags.writeable = False
        return _Frame(screen, pixels)
