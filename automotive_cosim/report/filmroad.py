"""The road from above: ground, lanes, traffic lights, vehicles, and one car or several that set out as one."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from PIL import Image, ImageDraw
from shapely import LineString, Polygon, STRtree

from automotive_cosim.cockpit.drawing import Canvas
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.groundmap import GroundMap
from automotive_cosim.cockpit.map import EGO_DOWN, Camera, RoadMap, View
from automotive_cosim.cockpit.theme import NIGHT, Colour, Type
from automotive_cosim.contracts import GroundKind, SeenVehicle, SumoSignal
from automotive_cosim.geo.sun import SUNSET_DEG
from automotive_cosim.geo.text import amount_of_speed
from automotive_cosim.run.road import RoadRecord, Second
from automotive_cosim.run.timeline import Sample, is_over

METRES_PER_PIXEL = 0.3
RADIUS = 14
FINE = 3
"""Oversampling factor."""
TRAIL_M = 0.7
GAP_M = 0.25
"""Widths of the trail, and of the line between two lanes."""
LEAST_PX = 5.0
"""No vehicle is drawn shorter than this."""
WIDE_PX, WIDE_M = 132, 1100.0
"""Side of the inset that shows the streets around, in pixels of the layout and in metres."""
LENGTHWISE = (0.36, 0.5)
"""Where the first car is in a picture of the road lengthwise, as shares of its width and height."""
EGO = "ego"


@dataclass(frozen=True, slots=True)
class Colours:
    """The colours of a road by day or by night."""

    land: Colour
    line: Colour
    road: Colour
    bus: Colour
    path: Colour
    """Lanes for bicycles and people on foot, and rails."""
    vehicle: Colour
    heavy: Colour
    edge: Colour
    """Outline of a vehicle."""
    ground: Mapping[GroundKind, Colour]


NIGHTLY = Colours(
    (16, 21, 28),
    (88, 99, 115),
    (43, 51, 63),
    (62, 50, 54),
    (32, 40, 48),
    (176, 188, 203),
    (214, 189, 128),
    (10, 13, 18),
    {GroundKind.GREEN: (19, 36, 28), GroundKind.WATER: (17, 42, 66), GroundKind.BUILDING: (28, 34, 43)},
)
DAILY = Colours(
    (214, 221, 214),
    (240, 243, 246),
    (128, 137, 148),
    (148, 118, 118),
    (176, 182, 180),
    (44, 54, 68),
    (122, 82, 26),
    (240, 243, 246),
    {GroundKind.GREEN: (184, 212, 176), GroundKind.WATER: (158, 198, 226), GroundKind.BUILDING: (196, 202, 200)},
)
LIGHTS: dict[str, Colour] = {"G": (46, 204, 113), "g": (46, 204, 113), "y": (255, 180, 46), "r": (229, 72, 77)}
BRAKE: Colour = (255, 40, 48)
INDICATOR: Colour = (255, 170, 30)
BLUE: Colour = (60, 120, 255)
HEAVY = frozenset({"bus", "coach", "truck", "trailer", "delivery", "tram", "rail", "rail_urban"})


class RoadPainter:
    """Draws a recorded road at any instant."""

    def __init__(self, record: RoadRecord, road_map: RoadMap) -> None:
        """Indexes the lanes; ``road_map`` has the names of the streets."""
        self._record = record
        self._map = road_map
        shapes = record.shapes
        self._lanes = STRtree([LineString(lane.line_m) for lane in shapes.lanes])
        self._junctions = STRtree([Polygon(outline) for outline in shapes.junctions])
        self._grounds = GroundMap(shapes.ground)

    def draw(self, canvas: Canvas, area: Rect, past: Sequence[Sample], avoid: tuple[Rect, ...]) -> None:
        """Draws the road around the last sample.

        Args:
            past: the drive so far, oldest first; the trail is red where it was above the limit.
            avoid: boxes without street names."""
        here = past[-1]
        second = self._record.at(here.at_s)
        camera = Camera(here.x_m, here.y_m, here.heading_deg, METRES_PER_PIXEL)
        picture, pen = self._scene(canvas.scale, area, camera, (0.5, EGO_DOWN), second)
        pen.trail(past)
        self._traffic(pen, second)
        if second is None or not second.vehicles:
            pen.vehicle(_car(here), NIGHT.accent)
        canvas.picture(area, picture.reduce(FINE), RADIUS)
        inset = Rect(area.x + 10, area.bottom - WIDE_PX - 10, WIDE_PX, WIDE_PX)
        if self._inset(canvas, inset, camera, second, pen.colours):
            avoid = (*avoid, inset)
        for name in self._map.names_in_sight(area, camera, avoid):
            if name.text != here.road:
                canvas.box(name.rect, NIGHT.land, 8)
                canvas.text(name.rect, name.text, Type.SMALL, NIGHT.text, "centre")

    def draw_lengthwise(self, canvas: Canvas, area: Rect, cars: Mapping[Colour, Sample]) -> None:
        """Draws the road with the drive going to the right, and on it several cars that set out as one.

        Args:
            cars: where each is, by its colour; the first is the recorded one, among whose traffic all are shown."""
        here = next(iter(cars.values()))
        second = self._record.at(here.at_s)
        camera = Camera(here.x_m, here.y_m, here.heading_deg - 90, METRES_PER_PIXEL)
        picture, pen = self._scene(canvas.scale, area, camera, LENGTHWISE, second)
        self._traffic(pen, second, but=EGO)
        for colour, sample in [*cars.items()][::-1]:
            pen.vehicle(_car(sample), colour)
        canvas.picture(area, picture.reduce(FINE), RADIUS)
        side = area.height - 20
        self._inset(canvas, Rect(area.right - side - 10, area.y + 10, side, side), camera, second, pen.colours)
        for number, (colour, sample) in enumerate(cars.items()):
            x, y = (round(value / (FINE * canvas.scale)) for value in pen.view.pixel(sample.x_m, sample.y_m))
            label = Rect(area.x + min(x, area.width - side - 80) - 66, area.y + y + (18, -50)[number % 2], 116, 32)
            canvas.box(label, NIGHT.background, 8)
            canvas.text(label, amount_of_speed(sample.speed_kmh, sample.speed_unit), Type.STRONG, colour, "centre")

    def _scene(
        self, scale: float, area: Rect, camera: Camera, place: tuple[float, float], second: Second | None
    ) -> tuple[Image.Image, _Pen]:
        """Ground and lanes, by day or night; the camera's point is at that share of the width and height."""
        dark = second is None or second.sun_deg is None or second.sun_deg < SUNSET_DEG
        colours = NIGHTLY if dark else DAILY
        width, height = _pixels(area, scale)
        picture = Image.new("RGB", (width, height), colours.land)
        view = View(camera, scale * FINE / METRES_PER_PIXEL, width * place[0], height * place[1])
        pen = _Pen(ImageDraw.Draw(picture), view, colours, FINE * scale)
        self._grounds.paint(pen.brush, view, (width, height), colours.ground, FINE)
        self._ground(pen, view.sight(width, height), second)
        return picture, pen

    def _traffic(self, pen: _Pen, second: Second | None, but: str = "") -> None:
        """Incidents and vehicles, the car under test on top."""
        if second is None:
            return
        for kind, x_m, y_m in second.incidents:
            pen.incident(kind, x_m, y_m)
        for vehicle in sorted(second.vehicles, key=lambda vehicle: vehicle.vehicle_id == EGO):
            if vehicle.vehicle_id != but:
                pen.vehicle(vehicle)

    def _inset(self, canvas: Canvas, inset: Rect, camera: Camera, second: Second | None, colours: Colours) -> bool:
        """The streets around, a dot for each vehicle, turned like the picture; false where nothing was recorded."""
        if second is None:
            return False
        size = _pixels(inset, canvas.scale)
        picture = Image.new("RGB", size, colours.land)
        view = View(camera, size[0] / WIDE_M, size[0] / 2, size[1] / 2)
        pen = _Pen(ImageDraw.Draw(picture), view, colours, FINE * canvas.scale)
        self._grounds.paint(pen.brush, view, size, colours.ground, FINE)
        for lane in self._record.shapes.lanes:
            pen.band(lane.line_m, 9.0, colours.road)
        for vehicle in sorted(second.vehicles, key=lambda vehicle: vehicle.vehicle_id == EGO):
            pen.dot(vehicle)
        canvas.box(inset.inset(-2), NIGHT.pressed, RADIUS - 2)
        canvas.picture(inset, picture.reduce(FINE), RADIUS - 4)
        return True

    def _ground(self, pen: _Pen, sight: Polygon, second: Second | None) -> None:
        shapes = self._record.shapes
        lanes = [shapes.lanes[number] for number in np.sort(self._lanes.query(sight.buffer(10.0))).tolist()]
        junctions = [shapes.junctions[number] for number in np.sort(self._junctions.query(sight)).tolist()]
        colours = pen.colours
        for lane in lanes:
            pen.band(lane.line_m, lane.width_m + GAP_M, colours.line)
        for outline in junctions:
            pen.area(outline, colours.road)
        for lane in lanes:
            of_kind = {"road": colours.road, "bus": colours.bus}.get(lane.kind, colours.path)
            pen.band(lane.line_m, lane.width_m - GAP_M, of_kind)
        if second is not None:
            for lane in lanes:
                states = [second.lights[light][place] for light, place in lane.links if light in second.lights]
                if states:
                    pen.stop_line(lane.line_m, lane.width_m, _brightest(states))


def draw_road_sign(canvas: Canvas, box: Rect, here: Sample) -> None:
    """The road's name and its limit."""
    name = here.road or "an unnamed road"
    canvas.box(box, NIGHT.surface, 12)
    canvas.text(Rect(box.x + 14, box.y, box.width - 82, box.height), name, Type.STRONG, NIGHT.text)
    if here.limit_kmh is not None:
        _limit_sign(canvas, Rect(box.right - 54, box.y + 2, 48, 48), here.limit_kmh, here.speed_unit)


def _limit_sign(canvas: Canvas, rect: Rect, limit_kmh: float, unit: str) -> None:
    white: Colour = (255, 255, 255)
    canvas.disc(rect, white)
    canvas.disc(rect.inset(2), (200, 22, 30))
    canvas.disc(rect.inset(8), white)
    canvas.text(rect, amount_of_speed(limit_kmh, unit).split()[0], Type.STRONG, (10, 10, 10), "centre")


def _pixels(area: Rect, scale: float) -> tuple[int, int]:
    """Fine pixels of a picture that fills the area."""
    left, top, right, bottom = area.edges(scale)
    return (right - left) * FINE, (bottom - top) * FINE


def _car(here: Sample) -> SeenVehicle:
    """The car under test where it was then."""
    return SeenVehicle(EGO, "passenger", 4.5, 1.8, here.x_m, here.y_m, here.heading_deg, 0.0, 0)


def _brightest(states: Iterable[str]) -> str:
    """The letter that decides what a lane's stop line shows: it is green as soon as one way is open."""
    found = set(states)
    return next((letter for letter in "Ggy" if letter in found), "r" if found & set("ru") else "o")


@dataclass(frozen=True, slots=True)
class _Pen:
    brush: ImageDraw.ImageDraw
    view: View
    colours: Colours
    unit: float
    """Fine pixels per pixel of the layout."""

    def band(self, line_m: Sequence[tuple[float, float]], width_m: float, colour: Colour) -> None:
        points = self._points(line_m)
        self.brush.line(points, colour, max(1, round(width_m * self.view.per_metre)), joint="curve")

    def area(self, outline_m: Sequence[tuple[float, float]], colour: Colour) -> None:
        self.brush.polygon(self._points(outline_m), colour)

    def stop_line(self, line_m: Sequence[tuple[float, float]], width_m: float, letter: str) -> None:
        """Across the end of a lane."""
        (x0, y0), (x1, y1) = line_m[-2:]
        length_m = math.hypot(x1 - x0, y1 - y0) or 1.0
        along, half = ((x1 - x0) / length_m, (y1 - y0) / length_m), width_m / 2 - GAP_M
        ends = [(x1 - side * along[1] * half, y1 + side * along[0] * half) for side in (-1, 1)]
        self.brush.line(self._points(ends), LIGHTS.get(letter, self.colours.line), max(1, round(4 * self.unit)))

    def trail(self, past: Sequence[Sample]) -> None:
        width = max(1, round(TRAIL_M * self.view.per_metre))
        for before, after in pairwise(past):
            colour = NIGHT.critical if is_over(after.speed_kmh, after.limit_kmh) else NIGHT.good
            self.brush.line(self._points([(before.x_m, before.y_m), (after.x_m, after.y_m)]), colour, width)

    def incident(self, kind: str, x_m: float, y_m: float) -> None:
        """A warning triangle."""
        x, y = self.view.pixel(x_m, y_m)
        size = 11 * self.unit
        self.brush.polygon([(x, y - size), (x + size, y + 0.8 * size), (x - size, y + 0.8 * size)], NIGHT.warning)
        self.brush.line((x, y - 0.4 * size, x, y + 0.2 * size), NIGHT.background, max(1, round(2.5 * self.unit)))

    def dot(self, vehicle: SeenVehicle) -> None:
        is_ego = vehicle.vehicle_id == EGO
        x, y = self.view.pixel(vehicle.x_m, vehicle.y_m)
        r = (4.0 if is_ego else 2.4) * self.unit
        if is_ego:
            self.brush.ellipse((x - 1.5 * r, y - 1.5 * r, x + 1.5 * r, y + 1.5 * r), (255, 255, 255))
        self.brush.ellipse((x - r, y - r, x + r, y + r), NIGHT.accent if is_ego else self.colours.vehicle)

    def vehicle(self, vehicle: SeenVehicle, ego: Colour = NIGHT.accent) -> None:
        """Its outline from above with its lights, nose forward; the car under test in a colour of its own."""
        is_ego = vehicle.vehicle_id == EGO
        fill = ego if is_ego else self.colours.heavy if vehicle.kind in HEAVY else self.colours.vehicle
        if vehicle.kind == "emergency":
            fill = BLUE if vehicle.signals & SumoSignal.BLUE else (235, 235, 240)
        least_m = LEAST_PX * self.unit / self.view.per_metre
        body = _Body(vehicle, max(vehicle.length_m, least_m), max(vehicle.width_m, least_m / 2))
        margin_m = (1.8 if is_ego else 1.0) * self.unit / self.view.per_metre
        self.brush.polygon(self._points(body.outline(margin_m)), (255, 255, 255) if is_ego else self.colours.edge)
        self.brush.polygon(self._points(body.outline(0.0)), fill)
        signals = vehicle.signals
        if signals & SumoSignal.BRAKE:
            self._lamps(body, ((-1.0, -0.62), (-1.0, 0.62)), BRAKE)
        for bits, side in (
            (SumoSignal.LEFT | SumoSignal.HAZARD, -0.9),
            (SumoSignal.RIGHT | SumoSignal.HAZARD, 0.9),
        ):
            if signals & bits:
                self._lamps(body, ((-0.94, side), (-0.06, side)), INDICATOR)

    def _lamps(self, body: _Body, places: Iterable[tuple[float, float]], colour: Colour) -> None:
        r = max(1.2 * self.unit, 0.33 * self.view.per_metre)
        for x, y in self._points([body.at(*place) for place in places]):
            self.brush.ellipse((x - r, y - r, x + r, y + r), colour)

    def _points(self, points_m: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
        return [self.view.pixel(x_m, y_m) for x_m, y_m in points_m]


@dataclass(frozen=True, slots=True)
class _Body:
    vehicle: SeenVehicle
    length_m: float
    width_m: float

    def at(self, ahead: float, right: float, margin_m: float = 0.0) -> tuple[float, float]:
        """A point of the body: 0 to -1 from the front bumper to the rear, -1 to 1 from left to right."""
        turn = math.radians(self.vehicle.heading_deg)
        forth = ahead * (self.length_m + 2 * margin_m) + margin_m
        across = right * (self.width_m / 2 + margin_m)
        east, north = math.sin(turn), math.cos(turn)
        return self.vehicle.x_m + forth * east + across * north, self.vehicle.y_m + forth * north - across * east

    def outline(self, margin_m: float) -> list[tuple[float, float]]:
        corners = ((0.0, -0.5), (0.0, 0.5), (-0.16, 1.0), (-1.0, 1.0), (-1.0, -1.0), (-0.16, -1.0))
        return [self.at(ahead, right, margin_m) for ahead, right in corners]
