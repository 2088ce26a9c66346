"""Street names along their streets and limit signs beside them, without overlaps."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw
from shapely import Polygon, box

from automotive_cosim.cockpit.theme import DAY, Colour, Weight, can_set, face, font
from automotive_cosim.contracts import KMH_PER_MPS, MPH_PER_MPS, LimitSource
from automotive_cosim.geo.place import Atlas
from automotive_cosim.traffic.georeference import GeoReference
from automotive_cosim.traffic.network import Edge, Network

NAME_SIZE, SIGN_SIZE = 14, 11
SIGN_RADIUS = 11.0
RED: Colour = (200, 30, 40)
GREY: Colour = (140, 150, 162)
NAMES_AT_MOST, SIGNS_AT_MOST = 90, 60
SIGNS_PER_STREET = 2
SHAPE_STEP = 6.0
"""Pixels between the positions that are tried along a street."""
SHORTEST, STRAIGHT = 0.75, 0.97
"""A name fits on a stretch of this share of the name's length whose chord is this share of the stretch."""

Points = npt.NDArray[np.float64]


@dataclass(slots=True)
class Labels:
    """The labels placed on a map so far."""

    picture: Image.Image
    pixels: Callable[[Sequence[tuple[float, float]]], Points]
    """Network metres to pixels, (n, 2)."""
    taken: list[Polygon] = field(default_factory=list)
    unwritten: list[str] = field(default_factory=list)
    """Names in a script that no font has."""

    def is_free(self, outline: Polygon) -> bool:
        """Whether it lies within the picture and overlaps no earlier label."""
        inside = box(4, 4, self.picture.width - 4, self.picture.height - 4).contains(outline)
        return bool(inside) and not any(outline.intersects(other) for other in self.taken)


def place_labels(labels: Labels, network: Network) -> None:
    """Draws limits and names, the most important and longest streets first."""
    streets: dict[str, list[Edge]] = {}
    for edge in network.edges.values():
        streets.setdefault(edge.name, []).append(edge)
    order = sorted(streets, key=lambda name: (-_weight(streets[name]), name))
    for name in [name for name in order if name][:NAMES_AT_MOST]:
        _write_name(labels, name, streets[name])
    unit_of = _units(network)
    count = 0
    for name in order:
        for edges in _by_limit(streets[name]):
            if count < SIGNS_AT_MOST and _put_sign(labels, edges, unit_of):
                count += 1


def _weight(edges: Sequence[Edge]) -> float:
    """Length weighted by speed."""
    return sum(edge.length_m * edge.speed_mps * math.sqrt(len(edge.lane_ids)) for edge in edges)


def _by_limit(edges: Sequence[Edge]) -> list[list[Edge]]:
    """A street's edges by limit, the longest stretch first, at most as many limits as are drawn."""
    groups: dict[tuple[float | None, LimitSource], list[Edge]] = {}
    for edge in edges:
        groups.setdefault((edge.limit_mps, edge.limit_source), []).append(edge)
    ordered = sorted(groups.values(), key=lambda group: -sum(edge.length_m for edge in group))
    return ordered[:SIGNS_PER_STREET]


# --- names ------------------------------------------------------------------------------------------------


def _write_name(labels: Labels, name: str, edges: Sequence[Edge]) -> None:
    if not can_set(name, Weight.MEDIUM, NAME_SIZE):
        labels.unwritten.append(name)
        return
    width = face(name, Weight.MEDIUM, NAME_SIZE).getlength(name)
    for x, y, angle in _places(labels, edges, width):
        outline = _turned(x, y, width + 6, NAME_SIZE + 4, angle)
        if labels.is_free(outline):
            labels.taken.append(outline)
            _write(labels.picture, name, (x, y), angle)
            return


def _places(labels: Labels, edges: Sequence[Edge], width: float) -> Iterator[tuple[float, float, float]]:
    """Middles of stretches that are straight for long enough, and their angles on the picture, in radians."""
    lines = [np.concatenate([labels.pixels(edge.shape_m) for edge in run]) for run in _runs(edges)]
    for line, along in sorted(((line, _along(line)) for line in lines), key=lambda pair: -pair[1][-1]):
        if along[-1] < SHORTEST * width:
            return
        half = min(width, along[-1]) / 2
        middles = np.arange(half, along[-1] - half + 1e-6, SHAPE_STEP)
        for middle in sorted(middles, key=lambda at: abs(at - along[-1] / 2)):
            xs, ys = (np.interp((middle - half, middle + half), along, line[:, axis]) for axis in (0, 1))
            if math.hypot(xs[1] - xs[0], ys[1] - ys[0]) < STRAIGHT * 2 * half:
                continue
            angle = math.atan2(ys[1] - ys[0], xs[1] - xs[0])
            if abs(angle) > math.pi / 2:
                angle -= math.copysign(math.pi, angle)
            yield float(xs.mean()), float(ys.mean()), angle


def _runs(edges: Sequence[Edge]) -> list[list[Edge]]:
    """A street's edges, chained as far as they connect."""
    left = {edge.edge_id: edge for edge in sorted(edges, key=lambda edge: -edge.length_m)}
    runs: list[list[Edge]] = []
    while left:
        run = [left.pop(next(iter(left)))]
        nodes = {run[0].from_node, run[0].to_node}
        while after := _next(left.values(), nodes, run[-1].to_node, "from_node", "to_node"):
            run.append(left.pop(after.edge_id))
            nodes.add(after.to_node)
        while before := _next(left.values(), nodes, run[0].from_node, "to_node", "from_node"):
            run.insert(0, left.pop(before.edge_id))
            nodes.add(before.from_node)
        runs.append(run)
    return runs


def _next(edges: Iterable[Edge], nodes: set[str], node: str, near: str, far: str) -> Edge | None:
    """An edge whose near end is at ``node`` and whose far end is not in ``nodes``."""
    return next((edge for edge in edges if getattr(edge, near) == node and getattr(edge, far) not in nodes), None)


def _along(line: Points) -> Points:
    """Distance of each point from the start."""
    return np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))


def _write(picture: Image.Image, text: str, at: tuple[float, float], angle: float) -> None:
    """Dark letters with a light rim, turned."""
    letters = face(text, Weight.MEDIUM, NAME_SIZE * 3)
    wide, high = round(letters.getlength(text)) + 24, NAME_SIZE * 3 + 24
    for stroke, colour in ((7, DAY.halo), (0, DAY.text)):
        mask = Image.new("L", (wide, high))
        ImageDraw.Draw(mask).text((wide / 2, high / 2), text, 255, letters, "mm", stroke_width=stroke)
        mask = mask.rotate(-math.degrees(angle), Image.Resampling.BICUBIC, expand=True).reduce(3)
        picture.paste(colour, (round(at[0] - mask.width / 2), round(at[1] - mask.height / 2)), mask)


def _turned(x: float, y: float, width: float, height: float, angle: float) -> Polygon:
    cos, sin = math.cos(angle), math.sin(angle)
    corners = ((-width, -height), (width, -height), (width, height), (-width, height))
    return Polygon([(x + (dx * cos - dy * sin) / 2, y + (dx * sin + dy * cos) / 2) for dx, dy in corners])


# --- signs ------------------------------------------------------------------------------------------------


def _units(network: Network) -> Callable[[Edge], str]:
    """The unit of an edge's signs; km/h if the place is unknown."""
    if network.map.projection is None:
        return lambda edge: "km/h"
    atlas, reference = Atlas(), GeoReference(network.map)

    def unit_of(edge: Edge) -> str:
        law = atlas.place(*reference.lon_lat(*edge.shape_m[0])).law
        return law.speed_unit if law and law.speed_unit else "km/h"

    return unit_of


def _put_sign(labels: Labels, edges: Sequence[Edge], unit_of: Callable[[Edge], str]) -> bool:
    """Draws a sign on the street or beside it, where there is room."""
    for edge in sorted(edges, key=lambda edge: -edge.length_m)[:6]:
        line = labels.pixels(edge.shape_m)
        along = _along(line)
        if along[-1] < 2 * SIGN_RADIUS:
            return False
        for share in (0.5, 0.35, 0.65, 0.2, 0.8):
            x, y = (float(np.interp(share * along[-1], along, line[:, axis])) for axis in (0, 1))
            outline = box(x - SIGN_RADIUS, y - SIGN_RADIUS, x + SIGN_RADIUS, y + SIGN_RADIUS)
            if labels.is_free(outline):
                labels.taken.append(outline)
                _draw_sign(labels.picture, x, y, edge, unit_of(edge))
                return True
    return False


def _draw_sign(picture: Image.Image, x: float, y: float, edge: Edge, unit: str) -> None:
    """A red ring for a posted limit, a grey one for an assumed limit; struck through without a limit."""
    fine = 4
    size = round(2 * (SIGN_RADIUS + 1) * fine)
    sign = Image.new("RGBA", (size, size))
    brush = ImageDraw.Draw(sign)
    middle, r = size / 2, SIGN_RADIUS * fine
    posted = edge.limit_source is LimitSource.POSTED
    colour = DAY.muted if edge.limit_mps is None else RED if posted else GREY
    brush.ellipse((middle - r, middle - r, middle + r, middle + r), (255, 255, 255, 255), colour, 2 * fine)
    if edge.limit_mps is None:
        for shift in (-3, 0, 3):
            at = shift * fine
            low, high = middle - r / 2 + at, middle + r / 2 + at
            brush.line((low, high, high, low), colour, fine)
    else:
        value = edge.limit_mps * (MPH_PER_MPS if unit == "mph" else KMH_PER_MPS)
        text = f"{value:.0f}"
        points = SIGN_SIZE if len(text) < 3 else SIGN_SIZE - 2
        ink = DAY.text if posted else GREY
        brush.text((middle, middle + fine / 2), text, ink, font(Weight.BOLD, points * fine), "mm")
    sign = sign.reduce(fine)
    picture.paste(sign, (round(x - sign.width / 2), round(y - sign.height / 2)), sign)
