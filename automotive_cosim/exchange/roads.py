"""Where places on the roads of an OpenDRIVE file are: reference lines, lane sections, and widths of lanes."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from automotive_cosim.contracts import KMH_PER_MPS, MPH_PER_MPS
from automotive_cosim.exchange.opendrive import Pose
from automotive_cosim.exchange.tree import XmlElement, read_tree
from automotive_cosim.traffic.network import DERESTRICTED_MPS

KEPT = frozenset((
    "road", "planView", "geometry", "line", "arc", "spiral", "poly3", "paramPoly3", "lanes", "laneOffset",
    "laneSection", "left", "right", "lane", "width", "border", "type", "speed",
))  # fmt: skip
"""The elements that say where lanes are, and how fast one may drive."""
_PER_MPS = {"m/s": 1.0, "km/h": KMH_PER_MPS, "mph": MPH_PER_MPS}
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(48)
_CUBIC = "a", "b", "c", "d"
MIRRORED: Mapping[str, tuple[str, ...]] = {
    "geometry": ("y", "hdg"),
    "arc": ("curvature",),
    "spiral": ("curvStart", "curvEnd"),
    "poly3": _CUBIC,
    "paramPoly3": ("aV", "bV", "cV", "dV"),
    "laneOffset": _CUBIC,
    "lane": ("id",),
    "predecessor": ("id",),
    "successor": ("id",),
    "laneLink": ("from", "to"),
    "validity": ("fromLane", "toLane"),
    "signal": ("t", "hOffset"),
    "signalReference": ("t",),
    "object": ("t", "hdg"),
}
"""The attributes of OpenDRIVE that change their signs in a mirror which lies along the x axis."""
TURNS = str.maketrans("lLrR", "rRlL")
SAMPLES = 2000
"""Of a cubic whose length along the curve is sought."""


def _at(pieces: Sequence[XmlElement], key: str, at_m: float) -> tuple[XmlElement, float] | None:
    """The piece that holds at a place, and how far behind its start that is."""
    number = bisect_right([piece.number(key) for piece in pieces], at_m) - 1
    return (pieces[number], at_m - pieces[number].number(key)) if number >= 0 else None


def _cubic(of: XmlElement, at: float, axis: str = "") -> tuple[float, float]:
    """A polynomial's value and slope."""
    a, b, c, d = (of.number(f"{power}{axis}") for power in "abcd")
    return a + at * (b + at * (c + at * d)), b + at * (2 * c + at * 3 * d)


class OpenDriveRoad:
    """A road."""

    def __init__(self, element: XmlElement) -> None:
        self.element = element
        self.name = element.text("id")
        self.length_m = element.number("length")
        self.keeps_left = element.attributes.get("rule") == "LHT"
        lanes = element.part("lanes")
        self._geometries = element.part("planView").all("geometry")
        self._offsets = lanes.all("laneOffset")
        self._sections = lanes.all("laneSection")

    def limits(self) -> Iterator[tuple[float, float]]:
        """The limits of its types, each with the s from which on it holds, in m/s; a type without one changes
        nothing. Raises ScenarioError: one is no speed."""
        for kind in self.element.all("type"):
            speed = kind.find("speed")
            if speed is None or speed.text("max") == "undefined":
                continue
            free = speed.text("max") == "no limit"
            unit = speed.word("unit", *_PER_MPS, otherwise="m/s")
            yield kind.number("s"), DERESTRICTED_MPS if free else speed.number("max") / _PER_MPS[unit]

    def pose(self, s_m: float, t_m: float) -> Pose:
        """A point beside the reference line, and the line's heading there.

        Raises ScenarioError: the file has a curve that is not read."""
        found = _at(self._geometries, "s", s_m) or (self._geometries[0], 0.0)
        geometry, along_m = found
        u_m, v_m, turned = _curve(geometry, min(along_m, geometry.number("length")))
        heading = geometry.number("hdg")
        cos, sin = math.cos(heading), math.sin(heading)
        heading += turned
        return (
            geometry.number("x") + u_m * cos - v_m * sin - t_m * math.sin(heading),
            geometry.number("y") + u_m * sin + v_m * cos + t_m * math.cos(heading),
            heading,
        )

    def middle_at(self, s_m: float) -> float:
        """t of lane 0."""
        offset = _at(self._offsets, "s", s_m)
        return _cubic(offset[0], offset[1])[0] if offset else 0.0

    def lanes_at(self, s_m: float) -> Mapping[int, tuple[float, float]]:
        """The lanes at a place: t of each one's middle, and its width.

        Raises ScenarioError: a lane is given by its border."""
        middle_m = self.middle_at(s_m)
        found: dict[int, tuple[float, float]] = {}
        section = _at(self._sections, "s", s_m)
        if section is None:
            return found
        for side, sign in (("left", 1), ("right", -1)):
            edge_m = middle_m
            lanes = [lane for part in section[0].all(side) for lane in part.all("lane")]
            for lane in sorted(lanes, key=lambda each: abs(int(each.text("id")))):
                if lane.find("border") is not None and not lane.all("width"):
                    raise lane.refused("is given by its border; widths are read")
                width = _at(lane.all("width"), "sOffset", section[1])
                width_m = max(0.0, _cubic(width[0], width[1])[0]) if width else 0.0
                found[int(lane.text("id"))] = edge_m + sign * width_m / 2, width_m
                edge_m += sign * width_m
        return found


def _curve(geometry: XmlElement, along_m: float) -> Pose:
    """A point of a piece of a reference line, from its start: ahead, to the left, and how far it has turned."""
    curve = geometry.one("line", "arc", "spiral", "poly3", "paramPoly3")
    if curve.tag in ("poly3", "paramPoly3"):
        at = along_m
        if curve.tag == "poly3":
            us = np.linspace(0.0, along_m, SAMPLES)
            vs = np.array([_cubic(curve, float(u))[0] for u in us])
            lengths = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(us), np.diff(vs)))))
            at = float(np.interp(along_m, lengths, us))
            (u_m, du), (v_m, dv) = (at, 1.0), _cubic(curve, at)
        else:
            if curve.attributes.get("pRange", "normalized") == "normalized":
                at /= geometry.number("length")
            (u_m, du), (v_m, dv) = _cubic(curve, at, "U"), _cubic(curve, at, "V")
        return u_m, v_m, math.atan2(dv, du)
    begins = curve.number("curvature", curve.number("curvStart", 0.0))
    ends = curve.number("curvEnd", begins)
    steeper = (ends - begins) / max(geometry.number("length"), 1e-9)
    at_m = (_NODES + 1) / 2 * along_m
    turned = begins * at_m + steeper * at_m**2 / 2
    u_m, v_m = (float(_WEIGHTS @ of(turned)) * along_m / 2 for of in (np.cos, np.sin))
    return u_m, v_m, begins * along_m + steeper * along_m**2 / 2


def read_roads(path: Path) -> Mapping[str, OpenDriveRoad]:
    """The roads of an OpenDRIVE file by their ids. Raises ScenarioError: it cannot be read."""
    root = read_tree(path, KEPT)
    return {road.name: road for road in map(OpenDriveRoad, root.all("road"))}


def mirror(root: ET.Element) -> None:
    """Mirrors the roads of OpenDRIVE, or a network of SUMO's, along the x axis: left becomes right."""
    mirrored = MIRRORED if root.tag == "OpenDRIVE" else {"junction": ("y",)}
    for element in root.iter():
        for name in mirrored.get(element.tag, ()):
            element.set(name, _turned(element.get(name, "0")))
        for name in ("shape", "customShape"):
            if points := element.get(name):
                element.set(name, " ".join(map(_mirrored, points.split())))
    for section in root.iter("laneSection"):
        for side in section:
            side.tag = {"left": "right", "right": "left"}.get(side.tag, side.tag)
            side[:] = reversed(side)  # from left to right
        section[:] = sorted(section, key=lambda each: ("left", "center", "right").index(each.tag))
    for connection in root.iter("connection"):
        if way := connection.get("dir"):
            connection.set("dir", way.translate(TURNS))
    for lane in root.iterfind("edge/lane/param[@key='origId']"):
        lanes = (name.rpartition("_") for name in lane.get("value", "").split())
        lane.set("value", " ".join(f"{road}_{_turned(number)}" for road, _, number in lanes))


def _turned(number: str) -> str:
    if not number.strip("0.-"):
        return number
    return number[1:] if number.startswith("-") else f"-{number}"


def _mirrored(point: str) -> str:
    x, y, *z = point.split(",")
    return ",".join((x, _turned(y), *z))
