"""The road from above, heading up, with a trail of the route driven so far."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from PIL import Image, ImageDraw

from automotive_cosim.cockpit.drawing import Canvas
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.map import EGO_DOWN, Camera, RoadMap
from automotive_cosim.cockpit.mapdraw import MapScene, draw
from automotive_cosim.cockpit.theme import NIGHT, Type
from automotive_cosim.run.timeline import Sample
from automotive_cosim.run.words import is_over

METRES_PER_PIXEL = 1.1
RADIUS = 14
FINE = 2
"""Oversampling of the trail."""
TRAIL, ARROW = 6, 20
"""Width of the trail, and how short of the ego's middle it stops: pixels of the film's layout."""


def draw_road(
    canvas: Canvas, area: Rect, road_map: RoadMap, past: Sequence[Sample], avoid: tuple[Rect, ...]
) -> None:
    """Draws the roads around the last sample.

    Args:
        canvas: the frame.
        area: where to draw on it.
        road_map: the network.
        past: the drive so far, oldest first; red where it was above the limit.
        avoid: boxes without street names.
    """
    here = past[-1]
    camera = Camera(here.x_m, here.y_m, here.heading_deg, METRES_PER_PIXEL)
    width, height = round(area.width * canvas.scale), round(area.height * canvas.scale)
    scene = MapScene(camera, (here.x_m, here.y_m, here.heading_deg))
    picture = draw(road_map, scene, width, height, canvas.scale, night=True)
    trail = _Trail(camera, area, canvas.scale * FINE)
    trail.drive(past)
    picture.paste(NIGHT.good, (0, 0), trail.within.resize(picture.size, Image.Resampling.BOX))
    picture.paste(NIGHT.critical, (0, 0), trail.above.resize(picture.size, Image.Resampling.BOX))
    canvas.picture(area, picture, RADIUS)
    for name in road_map.names_in_sight(area, camera, avoid):
        if name.text == here.road:
            continue
        canvas.box(name.rect, NIGHT.land, 8)
        canvas.text(name.rect, name.text, Type.SMALL, NIGHT.text, "centre")


class _Trail:
    """Masks of the trail, within the limit and above it."""

    def __init__(self, camera: Camera, area: Rect, scale: float) -> None:
        self._camera = camera
        self._area = area
        self._scale = scale
        size = round(area.width * scale), round(area.height * scale)
        self.within, self.above = Image.new("L", size), Image.new("L", size)
        self._ego = (area.width / 2, area.height * EGO_DOWN)

    def drive(self, past: Sequence[Sample]) -> None:
        for before, after in pairwise(past):
            start, end = self._point(before), self._point(after)
            if math.dist(end, self._ego) < ARROW:
                end = self._short_of_ego(start)
            mask = self.above if is_over(after.speed_kmh, after.limit_kmh) else self.within
            brush = ImageDraw.Draw(mask)
            fine = [(x * self._scale, y * self._scale) for x, y in (start, end)]
            brush.line(fine, 255, round(TRAIL * self._scale))
            r = TRAIL * self._scale / 2 - 0.5
            for x, y in fine:
                brush.ellipse((x - r, y - r, x + r, y + r), 255)

    def _point(self, sample: Sample) -> tuple[float, float]:
        """Position of a sample in the area, in pixels of the layout."""
        camera = self._camera
        turn = math.radians(camera.heading_deg)
        dx = (sample.x_m - camera.x_m) / camera.metres_per_pixel
        dy = (sample.y_m - camera.y_m) / camera.metres_per_pixel
        right = dx * math.cos(turn) - dy * math.sin(turn)
        ahead = dx * math.sin(turn) + dy * math.cos(turn)
        return self._ego[0] + right, self._ego[1] - ahead

    def _short_of_ego(self, start: tuple[float, float]) -> tuple[float, float]:
        away = math.dist(start, self._ego)
        share = max(0.0, 1 - ARROW / away) if away else 0.0
        return start[0] + share * (self._ego[0] - start[0]), start[1] + share * (self._ego[1] - start[1])
