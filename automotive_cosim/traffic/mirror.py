"""The mirror image of a network, whose traffic keeps the other side.

Every length, speed, right of way and signal stays; y runs the other way within the same bounds, and what lies to
the right lies to the left. SUMO numbers lanes from the kerb on either side, so vehicles drive in the image as they
do in the original. netconvert can build plain XML for the other side (``--lefthand --flip-y-axis``), but its
junctions get other connections and rights of way than those of the original.
"""

from __future__ import annotations

from codecs import getwriter
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from xml.sax.saxutils import quoteattr

from automotive_cosim.contracts import RoadNetwork
from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.writing import drafted
from automotive_cosim.formats.xml import scan
from automotive_cosim.traffic.network import Network, Shape

SHAPES = frozenset(("shape", "customShape", "outlineShape"))
"""Attributes with positions: "x,y" or "x,y,z", separated by spaces."""
OTHER_SIDE = {
    ("connection", "dir"): {"l": "r", "r": "l", "L": "R", "R": "L"},
    ("junction", "type"): {"right_before_left": "left_before_right", "left_before_right": "right_before_left"},
}
"""Values of attributes that name a side, by element and attribute."""


def mirrored(network: Network) -> Network:
    """The image of a network, with all that is around its roads."""
    sum_m = _sum_m(network.map)
    edges = {
        edge_id: replace(edge, shape_m=_flipped(edge.shape_m, sum_m)) for edge_id, edge in network.edges.items()
    }
    roads = tuple(replace(road, shape_m=_flipped(road.shape_m, sum_m)) for road in network.map.roads)
    ground = tuple(replace(area, outline_m=_flipped(area.outline_m, sum_m)) for area in network.map.ground)
    image = replace(network.map, roads=roads, ground=ground, left_hand=not network.map.left_hand)
    return replace(network, edges=edges, map=image)


def write_mirrored(net: Path, target: Path, image: RoadNetwork) -> None:
    """Writes the image of a network's file, for SUMO.

    Args:
        image: the image as ``mirrored`` has it.

    Raises:
        ScenarioError: the file is not XML."""
    sum_m, lefthand = _sum_m(image), "true" if image.left_hand else "false"
    with drafted(target) as written:
        file = getwriter("utf-8")(written)

        def start(name: str, attributes: dict[str, str]) -> None:
            changed = {key: _changed(name, key, value, sum_m) for key, value in attributes.items()}
            if name == "net":
                changed["lefthand"] = lefthand
            file.write(f"<{name}{''.join(f' {key}={quoteattr(value)}' for key, value in changed.items())}>\n")

        def end(name: str) -> None:
            file.write(f"</{name}>\n")

        scan(net, start, end, error=ScenarioError, what="a SUMO network")


def _changed(element: str, key: str, value: str, sum_m: float) -> str:
    """An attribute's value in the image."""
    if key in SHAPES:
        points = (point.split(",") for point in value.split())
        return " ".join(",".join((x, _y(y, sum_m), *z)) for x, y, *z in points)
    if element == "junction" and key == "y":
        return _y(value, sum_m)
    return OTHER_SIDE.get((element, key), _NOTHING).get(value, value)


def _y(value: str, sum_m: float) -> str:
    return f"{sum_m - float(value):.2f}"


_NOTHING: Mapping[str, str] = {}


def _sum_m(roads: RoadNetwork) -> float:
    """The sum of y of a point and its image."""
    return roads.bounds_m[1] + roads.bounds_m[3]


def _flipped(shape: Shape, sum_m: float) -> Shape:
    return tuple((x_m, round(sum_m - y_m, 3)) for x_m, y_m in shape)
