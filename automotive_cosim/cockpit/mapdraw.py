"""The moving map as a picture: ground, roads, how the traffic flows on them, the route, its alternatives, the car.

Roads are drawn on sheets a little larger than the picture that are kept: as long as the car drives straight on, a
new picture is cut out of the last sheet. Which sheet and where follows from the camera alone, so that a picture
never depends on what was drawn before.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

from PIL import Image, ImageDraw

from automotive_cosim.cockpit.groundmap import GroundMap
from automotive_cosim.cockpit.map import AVENUES, MOTORWAYS, Camera, RoadMap, Stroke, View
from automotive_cosim.cockpit.theme import Colour, Palette
from automotive_cosim.contracts import GroundKind

_FINE = 2
"""Oversampling."""
SHEET_STEP = 96
"""Pixels from one sheet to the next, and what a sheet is larger than the picture."""
DENSE_BELOW, JAM_BELOW = 0.6, 0.25
"""Relative speeds below which traffic is drawn as dense, and as jammed."""
LEAST_WIDTH = (3.0, 4.0, 5.0, 7.0, 8.0)
"""Width in logical pixels, by rank."""
LANE_M = 3.2
BUILDINGS_M_PER_PX = 1.2
"""From further away, buildings are left out: they would be specks."""


@dataclass(frozen=True, slots=True)
class MapScene:
    """What a map shows in addition to the roads."""

    camera: Camera
    ego: tuple[float, float, float] | None = None
    """The car: x and y in metres, heading in degrees."""
    route: tuple[str, ...] = ()
    """Edges of the route ahead."""
    alternatives: tuple[tuple[str, ...], ...] = ()
    """Edges of alternative routes."""
    slow: tuple[tuple[str, float], ...] = ()
    """Edges with slow traffic, and its relative speed."""


def draw(roads: RoadMap, scene: MapScene, width: int, height: int, scale: float, palette: Palette) -> Image.Image:
    """The picture of that size in pixels, without names; ``scale`` is pixels per logical pixel."""
    camera = scene.camera
    view = View(camera, scale / camera.metres_per_pixel, width / 2, height * camera.down)
    left, top = _corner(camera, view)
    step = max(1, round(SHEET_STEP * scale))
    sheet = _sheet(
        roads,
        camera.heading_deg,
        camera.metres_per_pixel,
        (left // step, top // step, step),
        (width + step, height + step),
        scale,
        scene.route,
        scene.alternatives,
        scene.slow,
        palette,
    )
    across, down = left % step, top % step
    picture = sheet.crop((across, down, across + width, down + height))
    if scene.ego is not None:
        x_m, y_m, heading_deg = scene.ego
        x, y = view.pixel(x_m, y_m)
        arrow = _arrow(round(52 * scale), round(heading_deg - camera.heading_deg) % 360, palette)
        picture.paste(arrow, (round(x - arrow.width / 2), round(y - arrow.height / 2)), arrow)
    return picture


def _corner(camera: Camera, view: View) -> tuple[int, int]:
    """The picture's upper left corner in whole pixels of a plane that turns with the heading."""
    world = View(Camera(0.0, 0.0, camera.heading_deg, camera.metres_per_pixel), view.per_metre, 0.0, 0.0)
    x, y = world.pixel(camera.x_m, camera.y_m)
    return round(x - view.x), round(y - view.y)


@lru_cache(maxsize=8)
def _sheet(
    roads: RoadMap,
    heading_deg: float,
    metres_per_pixel: float,
    place: tuple[int, int, int],
    size: tuple[int, int],
    scale: float,
    route: tuple[str, ...],
    alternatives: tuple[tuple[str, ...], ...],
    slow: tuple[tuple[str, float], ...],
    palette: Palette,
) -> Image.Image:
    """The roads and routes on one sheet.

    Args:
        metres_per_pixel: metres per logical pixel.
        place: column and row of the sheet, and pixels from one to the next.
        size: size of the sheet in pixels.
        scale: pixels per logical pixel.
        route: edges of the route ahead.
        slow: edges and the relative speed of their traffic."""
    column, row, step = place
    camera = Camera(0.0, 0.0, heading_deg, metres_per_pixel)
    wide, high = size[0] * _FINE, size[1] * _FINE
    per_metre = scale * _FINE / metres_per_pixel
    view = View(camera, per_metre, -column * step * _FINE, -row * step * _FINE)
    picture = Image.new("RGB", (wide, high), palette.land)
    pen = _Pen(ImageDraw.Draw(picture), per_metre, _FINE * scale)
    colours = {GroundKind.GREEN: palette.green, GroundKind.WATER: palette.water}
    if metres_per_pixel < BUILDINGS_M_PER_PX:
        colours[GroundKind.BUILDING] = palette.building
    _ground(roads).paint(pen.brush, view, (wide, high), colours, _FINE)
    found = roads.in_sight(view, wide, high)
    for stroke in found:
        pen.stroke(stroke, pen.width(stroke) + 2 * _FINE, palette.casing)
    for stroke in found:
        pen.stroke(stroke, pen.width(stroke), _colour(stroke, palette))
    seen = {stroke.road.edge_id for stroke in found}
    for edges in alternatives:
        pen.way(roads.strokes(_among(edges, seen), view), palette.alternative)
    pen.way(roads.strokes(_among(route, seen), view), palette.route)
    by_edge = {stroke.road.edge_id: stroke for stroke in found}
    for edge, relative_speed in slow:
        if edge in by_edge and relative_speed < DENSE_BELOW:
            stroke = by_edge[edge]
            colour = palette.jam if relative_speed < JAM_BELOW else palette.dense
            pen.stroke(stroke, max(4.0 * pen.unit, 0.4 * pen.width(stroke)), colour)
    return picture.reduce(_FINE)


@lru_cache(maxsize=4)
def _ground(roads: RoadMap) -> GroundMap:
    return GroundMap(roads.network.ground)


def _among(edges: Iterable[str], seen: set[str]) -> tuple[str, ...]:
    return tuple(edge for edge in edges if edge in seen)


@dataclass(frozen=True, slots=True)
class _Pen:
    brush: ImageDraw.ImageDraw
    per_metre: float
    unit: float
    """Fine pixels per logical pixel."""

    def width(self, stroke: Stroke) -> float:
        return max(LEAST_WIDTH[stroke.rank] * _FINE, stroke.road.lane_count * LANE_M * self.per_metre)

    def way(self, strokes: list[Stroke], colour: Colour) -> None:
        """Draws a route over its roads."""
        for stroke in strokes:
            self.stroke(stroke, max(7.0 * self.unit, 0.8 * self.width(stroke)), colour)

    def stroke(self, stroke: Stroke, width: float, colour: Colour) -> None:
        """Draws one road, with round ends and sharp bends."""
        self.brush.line(stroke.line, colour, max(1, round(width)))
        half = width / 2 - 0.5
        for x, y in stroke.joints:
            self.brush.ellipse((x - half, y - half, x + half, y + half), colour)


def _colour(stroke: Stroke, palette: Palette) -> Colour:
    if stroke.road.in_tunnel:
        return palette.tunnel
    if stroke.road.road_class in MOTORWAYS:
        return palette.motorway
    return palette.avenue if stroke.road.road_class in AVENUES else palette.street


@lru_cache(maxsize=512)
def _arrow(size: int, turn_deg: int, palette: Palette) -> Image.Image:
    """The car from above, its nose turned clockwise by that much."""
    fine = 4 * size
    picture = Image.new("RGBA", (fine, fine), (*palette.halo, 0))
    brush = ImageDraw.Draw(picture)
    cos, sin = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
    for share, colour in ((1.0, palette.halo), (0.78, palette.accent)):
        reach = fine / 2 * share
        corners = ((0.0, -1.0), (0.72, 0.8), (0.0, 0.42), (-0.72, 0.8))
        brush.polygon(
            [(fine / 2 + reach * (x * cos - y * sin), fine / 2 + reach * (x * sin + y * cos)) for x, y in corners],
            (*colour, 255),
        )
    return picture.reduce(4)
