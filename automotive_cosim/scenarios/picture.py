"""Draws a scenario, north up: water and green, roads by class, tunnels, names, limits and the ego's trips."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw
from shapely import LineString, Polygon, box

from automotive_cosim.cockpit.groundmap import GroundMap
from automotive_cosim.cockpit.map import AVENUES, MOTORWAYS, QUIET, Camera, View
from automotive_cosim.cockpit.theme import DAY, Colour, Weight, face, font
from automotive_cosim.contracts import GroundKind
from automotive_cosim.errors import ScenarioError, UserError
from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.formats.writing import drafted, make_folder
from automotive_cosim.geo.place import Atlas
from automotive_cosim.scenarios.labels import GREY, RED, Labels, Points, place_labels
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.traffic.georeference import GeoReference
from automotive_cosim.traffic.network import Edge, Network
from automotive_cosim.traffic.ways import way_through

FINE = 2
"""Oversampling of the roads."""

MAP_PIXELS = 1_100_000
"""Pixels of the map, whatever its shape."""

ASPECTS = (0.62, 1.9)
"""Minimum and maximum ratio of the map's width to its height."""

MARGIN, HEAD, ROW = 36, 84, 30
"""Around the map's roads, the height of the title and that of a line of the legend, pixels."""

TRIP_COLOURS: tuple[Colour, ...] = (
    (31, 120, 230),
    (200, 40, 120),
    (14, 140, 90),
    (125, 70, 200),
    (210, 95, 0),
    (0, 140, 160),
    (140, 90, 40),
)
TRIP_WIDTH = 4.0
TUNNEL: Colour = (128, 140, 156)
DASH = 8.0
"""Minimum length of a tunnel's dashes."""
ATTRIBUTED = "OpenStreetMap"
"""Scenarios made from its data say so in ``about``; so must their pictures."""
CLASSES = (("motorway, trunk", "motorway"), ("primary, secondary", "primary"), ("other streets", "residential"))
"""The legend: texts, each with a road class drawn that way."""

ENDINGS = (".webp", ".png")
QUALITY = 75
"""Quality of WebP, which is lossy."""


@dataclass(frozen=True, slots=True)
class Viewport:
    """Maps the network's metres to the picture's pixels."""

    left_m: float
    top_m: float
    pixels_per_m: float
    width: int
    height: int

    @classmethod
    def around(cls, edges: Iterable[Edge]) -> Viewport:
        """A frame of the usual size that contains all roads."""
        points = np.array([point for edge in edges for point in edge.shape_m])
        (x_min, y_min), (x_max, y_max) = points.min(axis=0), points.max(axis=0)
        wide_m, high_m = max(x_max - x_min, 1.0), max(y_max - y_min, 1.0)
        aspect = min(max(wide_m / high_m, ASPECTS[0]), ASPECTS[1])
        height = round(math.sqrt(MAP_PIXELS / aspect))
        width = round(height * aspect)
        scale = min((width - 2 * MARGIN) / wide_m, (height - 2 * MARGIN) / high_m)
        left_m = (x_min + x_max) / 2 - width / 2 / scale
        top_m = (y_min + y_max) / 2 + height / 2 / scale
        return cls(float(left_m), float(top_m), float(scale), width, height)

    def view(self, fine: int) -> View:
        """The same for a picture with that many times the pixels."""
        camera = Camera(self.left_m, self.top_m, 0.0, 1 / self.pixels_per_m)
        return View(camera, self.pixels_per_m * fine, 0.0, 0.0)

    def pixels(self, shape_m: Sequence[tuple[float, float]]) -> Points:
        """Points in pixels of the map, (n, 2)."""
        points = np.asarray(shape_m, dtype=np.float64)
        return np.stack((points[:, 0] - self.left_m, self.top_m - points[:, 1]), axis=1) * self.pixels_per_m


def draw_scenario(scenario: Scenario) -> tuple[Image.Image, tuple[str, ...]]:
    """The scenario's picture, RGB, and the street names that it lacks because no font has their script.

    Raises ScenarioError: its network cannot be read, or a trip has no route through it."""
    network = network_of(scenario)
    edges = tuple(network.edges.values())
    frame = Viewport.around(edges)
    roads = _roads(frame, edges, GroundMap(network.map.ground))
    _trips(roads, frame, network, scenario)
    picture = roads.reduce(FINE)
    labels = Labels(picture, frame.pixels)
    labels.taken.append(_scale_bar(picture, frame, edges))
    labels.taken += _ends(picture, frame, network, scenario)
    place_labels(labels, network)
    return _framed(picture, scenario, _where(scenario, network)), tuple(labels.unwritten)


def save_picture(scenario: Scenario, path: Path) -> tuple[str, ...]:
    """Draws the scenario into a file whose suffix is one of ``ENDINGS``, completely or not at all.

    Returns:
        The street names that it lacks because no font has their script.

    Raises:
        ScenarioError: see ``draw_scenario``.
        UserError: the file cannot be written."""
    picture, unwritten = draw_scenario(scenario)
    try:
        make_folder(path.parent)
        with drafted(path) as file:
            picture.save(file, path.suffix[1:].upper(), quality=QUALITY, method=6)
    except OSError as error:
        raise UserError(
            f"cannot write {path} ({error.strerror}); give --out a folder that you can write to"
        ) from error
    return unwritten


def _roads(frame: Viewport, edges: Sequence[Edge], ground: GroundMap) -> Image.Image:
    picture = Image.new("RGB", (frame.width * FINE, frame.height * FINE), DAY.land)
    brush = ImageDraw.Draw(picture)
    colours = {GroundKind.GREEN: DAY.green, GroundKind.WATER: DAY.water, GroundKind.BUILDING: DAY.building}
    ground.paint(brush, frame.view(FINE), picture.size, colours, FINE)
    order = sorted(edges, key=lambda edge: (not edge.in_tunnel, rank(edge.road_class)))
    lines = [(edge, frame.pixels(edge.shape_m) * FINE) for edge in order]
    for edge, line in lines:
        _stroke(brush, line, _width(edge, frame) + 2 * FINE, TUNNEL if edge.in_tunnel else DAY.casing)
    for edge, line in lines:
        if edge.in_tunnel:
            _dashed(brush, line, _width(edge, frame), _colour(edge.road_class))
        else:
            _stroke(brush, line, _width(edge, frame), _colour(edge.road_class))
    return picture


def _trips(picture: Image.Image, frame: Viewport, network: Network, scenario: Scenario) -> None:
    """Draws the trips side by side where they share a road."""
    brush = ImageDraw.Draw(picture)
    count = len(scenario.ego.trips)
    for number, trip in enumerate(scenario.ego.trips):
        way = way_through(network, (trip.from_edge, *trip.via, trip.to_edge))
        if not way:
            raise ScenarioError(
                f"trip {trip.name!r} of scenario {scenario.name!r} has no route through the network"
            )
        line = np.concatenate([frame.pixels(network.edges[edge].shape_m) for edge in way])
        aside = (number - (count - 1) / 2) * (TRIP_WIDTH + 0.5)
        _stroke(brush, _shifted(line, aside) * FINE, TRIP_WIDTH * FINE, trip_colour(number))


def _ends(picture: Image.Image, frame: Viewport, network: Network, scenario: Scenario) -> list[Polygon]:
    """Draws a disc with the trip's number where it begins and a ring where it ends; returns what they cover."""
    brush = ImageDraw.Draw(picture)
    digits = font(Weight.BOLD, 15)
    taken: list[tuple[float, float]] = []
    for number, trip in enumerate(scenario.ego.trips):
        for edge, at, is_start in ((trip.from_edge, 0, True), (trip.to_edge, -1, False)):
            x, y = (float(value) for value in frame.pixels(network.edges[edge].shape_m)[at])
            while any(math.dist((x, y), other) < 20 for other in taken):
                x += 20
            taken.append((x, y))
            fill, ink = (trip_colour(number), DAY.halo) if is_start else (DAY.halo, trip_colour(number))
            brush.ellipse((x - 11, y - 11, x + 11, y + 11), fill, trip_colour(number), 3)
            brush.text((x, y + 0.5), str(number + 1), ink, digits, "mm")
    return [box(x - 12, y - 12, x + 12, y + 12) for x, y in taken]


def _scale_bar(picture: Image.Image, frame: Viewport, edges: Iterable[Edge]) -> Polygon:
    brush = ImageDraw.Draw(picture)
    longest_m = 0.22 * frame.width / frame.pixels_per_m
    power = 10 ** math.floor(math.log10(longest_m))
    length_m = max(step * power for step in (1, 2, 5) if step * power <= longest_m)
    wide = length_m * frame.pixels_per_m + 24
    area = _emptiest(frame, wide, 46.0, edges)
    left, top, right, bottom = area.bounds
    text = f"{length_m / 1000:g} km" if length_m >= 1000 else f"{length_m:g} m"
    brush.rectangle(area.bounds, DAY.halo)
    x_1, x_2, y = left + 12, right - 12, bottom - 12
    brush.line((x_1, y - 7, x_1, y, x_2, y, x_2, y - 7), DAY.muted, 2)
    brush.text(((left + right) / 2, top + 16), text, DAY.text, font(Weight.MEDIUM, 15), "mm")
    return area


def _emptiest(frame: Viewport, width: float, height: float, edges: Iterable[Edge]) -> Polygon:
    """The corner of the map with the fewest roads, the lower right one in a tie."""
    roads = [LineString(frame.pixels(edge.shape_m)) for edge in edges]
    right, bottom = frame.width - 12 - width, frame.height - 12 - height
    corners = ((right, bottom), (12, bottom), (right, 12), (12, 12))
    areas = [box(x, y, x + width, y + height) for x, y in corners]
    return min(areas, key=lambda area: sum(area.intersects(road) for road in roads))


def _where(scenario: Scenario, network: Network) -> str:
    """The countries in which the trips begin and end."""
    if network.map.projection is None:
        return "no place on earth"
    atlas, reference = Atlas(), GeoReference(network.map)
    ends = [edge for trip in scenario.ego.trips for edge in (trip.from_edge, trip.to_edge)]
    places = [atlas.place(*reference.lon_lat(*network.edges[edge].shape_m[0])) for edge in ends]
    return " and ".join(dict.fromkeys(place.country_name or "the sea" for place in places))


def _framed(picture: Image.Image, scenario: Scenario, where: str) -> Image.Image:
    """The title above, the legend below."""
    trips = scenario.ego.trips
    height = HEAD + picture.height + ROW * (len(trips) + 2) + 30
    whole = Image.new("RGB", (picture.width, height), DAY.surface)
    whole.paste(picture, (0, HEAD))
    brush = ImageDraw.Draw(whole)
    title = cut(scenario.title, Weight.MEDIUM, 26, whole.width - 48)
    brush.text((24, 30), title, DAY.text, face(title, Weight.MEDIUM, 26), "lm")
    facts = f"{where} · {scenario.start:%A} {scenario.start.day} {scenario.start:%B %Y, %H:%M}"
    if ATTRIBUTED in scenario.about:
        facts += f" · map data © {ATTRIBUTED} contributors"
    brush.text((24, 62), facts, DAY.muted, font(Weight.REGULAR, 17), "lm")
    y = HEAD + picture.height + 26
    _classes(brush, y)
    y += ROW
    _signs(brush, y)
    for number, trip in enumerate(trips):
        y += ROW
        brush.ellipse((24, y - 11, 46, y + 11), trip_colour(number))
        brush.text((35, y + 0.5), str(number + 1), DAY.halo, font(Weight.BOLD, 15), "mm")
        brush.text((58, y), trip.name, DAY.text, face(trip.name, Weight.MEDIUM, 17), "lm")
        left = 58 + face(trip.name, Weight.MEDIUM, 17).getlength(trip.name) + 14
        about = cut(trip.about, Weight.REGULAR, 17, whole.width - 24 - left)
        brush.text((left, y), about, DAY.muted, face(about, Weight.REGULAR, 17), "lm")
    return whole


def _classes(brush: ImageDraw.ImageDraw, y: float) -> None:
    x = 24.0
    letters = font(Weight.REGULAR, 16)
    for words, road_class in CLASSES:
        brush.line((x, y, x + 34, y), DAY.casing, 11)
        brush.line((x + 1, y, x + 33, y), _colour(road_class), 8)
        brush.text((x + 44, y), words, DAY.muted, letters, "lm")
        x += 44 + letters.getlength(words) + 26
    brush.line((x, y, x + 34, y), TUNNEL, 11)
    _dashed(brush, np.array(((x + 1, y), (x + 33, y))), 8, _colour("primary"))
    brush.text((x + 44, y), "tunnel", DAY.muted, letters, "lm")


def _signs(brush: ImageDraw.ImageDraw, y: float) -> None:
    """What discs, rings and the colours of limits stand for."""
    x = 35.0
    letters = font(Weight.REGULAR, 16)
    colour = trip_colour(0)
    for words, fill, ring in (
        ("a trip begins", colour, colour),
        ("it ends", DAY.halo, colour),
        ("posted limit", DAY.halo, RED),
        ("assumed limit", DAY.halo, GREY),
    ):
        brush.ellipse((x - 11, y - 11, x + 11, y + 11), fill, ring, 3)
        brush.text((x + 19, y), words, DAY.muted, letters, "lm")
        x += 19 + letters.getlength(words) + 37


def cut(text: str, weight: Weight, size: int, width: float) -> str:
    """The text, shortened until it fits."""
    letters = face(text, weight, size)
    if letters.getlength(text) <= width:
        return text
    while text and letters.getlength(text + "…") > width:
        text = text[:-1]
    return text.rstrip() + "…"


def trip_colour(number: int) -> Colour:
    """Colour of the n-th trip, from 0."""
    return TRIP_COLOURS[number % len(TRIP_COLOURS)]


def rank(road_class: str) -> int:
    """Drawing order: larger roads above smaller ones."""
    if road_class in MOTORWAYS:
        return 3
    return 2 if road_class in AVENUES else 0 if road_class in QUIET else 1


def _colour(road_class: str) -> Colour:
    return (DAY.street, DAY.street, DAY.avenue, DAY.motorway)[rank(road_class)]


def _width(edge: Edge, frame: Viewport) -> float:
    least = (2.5, 3.5, 5.0, 6.5)[rank(edge.road_class)]
    return FINE * max(least, len(edge.lane_ids) * 3.2 * frame.pixels_per_m)


def _stroke(brush: ImageDraw.ImageDraw, line: Points, width: float, colour: Colour) -> None:
    brush.line([(float(x), float(y)) for x, y in line], colour, max(1, round(width)), joint="curve")
    r = width / 2 - 0.5
    for x, y in (line[0], line[-1]):
        brush.ellipse((x - r, y - r, x + r, y + r), colour)


def _dashed(brush: ImageDraw.ImageDraw, line: Points, width: float, colour: Colour) -> None:
    """Short dashes of the colour on the casing."""
    along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
    dash = max(width, DASH)
    for start in np.arange(0.0, along[-1], 2 * dash):
        ends = np.array((start, min(start + dash, along[-1])))
        xs, ys = np.interp(ends, along, line[:, 0]), np.interp(ends, along, line[:, 1])
        brush.line((xs[0], ys[0], xs[1], ys[1]), colour, max(1, round(width)))


def _shifted(line: Points, aside: float) -> Points:
    """The line, moved to its right by a number of pixels."""
    kept = np.concatenate(([True], np.any(np.diff(line, axis=0) != 0, axis=1)))
    line = line[kept]
    if len(line) < 2:
        return line
    ahead = np.gradient(line, axis=0)
    ahead /= np.maximum(np.hypot(ahead[:, 0], ahead[:, 1]), 1e-9)[:, None]
    return line + aside * np.stack((-ahead[:, 1], ahead[:, 0]), axis=1)
