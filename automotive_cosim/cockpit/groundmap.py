"""Water, green and buildings as pictures show them, under everything else."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import shapely
from PIL import ImageDraw
from shapely import STRtree

from automotive_cosim.cockpit.map import View
from automotive_cosim.cockpit.theme import Colour
from automotive_cosim.contracts import GroundArea, GroundKind

LEAST_PX = 3.0
"""Areas that are smaller both ways are left out."""


class GroundMap:
    """The areas around the roads, indexed for drawing."""

    def __init__(self, areas: Sequence[GroundArea]) -> None:
        """Indexes them by their boxes: 20 ms for ten thousand."""
        shapes = [np.asarray(area.outline_m, dtype=np.float64) for area in areas]
        self._kinds = [area.kind for area in areas]
        self._points = np.concatenate(shapes) if shapes else np.empty((0, 2))
        self._starts = np.cumsum([0, *(len(shape) for shape in shapes)])
        lows = np.array([shape.min(axis=0) for shape in shapes]).reshape(-1, 2)
        highs = np.array([shape.max(axis=0) for shape in shapes]).reshape(-1, 2)
        self._sizes_m = (highs - lows).max(axis=1, initial=0.0)
        self._tree = STRtree(shapely.box(lows[:, 0], lows[:, 1], highs[:, 0], highs[:, 1]))

    def paint(
        self,
        brush: ImageDraw.ImageDraw,
        view: View,
        size: tuple[float, float],
        colours: Mapping[GroundKind, Colour],
        pixel: float = 1.0,
    ) -> None:
        """Draws what is in sight, in the order in which the areas came.

        Args:
            view: from metres to its pixels.
            size: width and height of the picture.
            pixel: pixels of the picture per pixel that is seen, if it is made smaller afterwards."""
        found = self._tree.query(view.bounds(*size))
        found = np.sort(found[self._sizes_m[found] * view.per_metre >= LEAST_PX * pixel])
        for at in found.tolist():
            colour = colours.get(self._kinds[at])
            if colour is not None:
                points = view.pixels(self._points[self._starts[at] : self._starts[at + 1]])
                brush.polygon(points.ravel().tolist(), colour)
