"""Whether anything of others' maps is lost: of each sign, arrow, camera and border, the network's own evidence that
it is followed, or its number in the import's list.

``AUTOMOTIVE_COSIM_TEST_DATA=FOLDER python -m tests.osm.lost`` writes the table of ``docs/reference/scenarios.md``.
"""

import os
import re
import tempfile
from collections.abc import Iterator, Mapping
from itertools import combinations
from math import dist
from pathlib import Path
from typing import NamedTuple

from automotive_cosim.geo.place import shipped
from automotive_cosim.osm import extract, network
from automotive_cosim.osm.doubts import doubts
from automotive_cosim.osm.extract import Extract
from automotive_cosim.osm.network import Built
from automotive_cosim.osm.roads import describe, on_one_side, way_of
from automotive_cosim.traffic.georeference import GeoReference

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "scenarios.md"
HEAD = "| extract | signs | turn arrows | cameras | borders |"
KINDS = ("signs", "turn arrows", "cameras", "borders")
SIGNS = ("stop", "give_way", "mini_roundabout")
SMALL = ("london",)
"""Extracts that are read in a few seconds."""


class _Count(NamedTuple):
    """Of one kind in one extract."""

    followed: int = 0
    listed: int = 0
    lost: tuple[int, ...] = ()
    """OSM numbers of what is neither."""

    def __str__(self) -> str:
        return f"{self.followed}, {self.listed}, {len(self.lost)}"


def extracts() -> dict[str, Path]:
    """Others' maps that are there, by name."""
    data = Path(os.environ.get("AUTOMOTIVE_COSIM_TEST_DATA") or "/nowhere")
    return {path.parent.name: path for path in sorted(data.glob("*/*.osm*"))}


def counts(source: Path) -> dict[str, _Count]:
    """What an import of a map does with each kind."""
    mapped, atlas = extract.read(source), shipped()
    country = atlas.place(*mapped.centre).country
    whole = mapped
    mapped = on_one_side(mapped, atlas, country)
    roads = describe(mapped, atlas, country)
    with tempfile.TemporaryDirectory() as scratch:
        built = network.convert(mapped, roads, Path(scratch) / "town.net.xml.gz", country, Path(scratch))
    lines = list(doubts(mapped, roads, built, country))
    seen = {
        "signs": _signs(whole, built),
        "turn arrows": _arrows(whole, built),
        "cameras": _cameras(whole, built),
        "borders": _borders(whole, country),
    }
    words = {"signs": "sign", "turn arrows": "turn", "cameras": "camera", "borders": "roads in"}
    return {kind: _count(found, [line for line in lines if words[kind] in line]) for kind, found in seen.items()}


def _count(found: Mapping[int, bool], lines: list[str]) -> _Count:
    listed = {int(number) for line in lines for number in re.findall(r"(?<=[ ,])-?\d+(?=,|$)", line)}
    by_list = [number for number in found if number in listed]
    followed = [number for number, there in found.items() if there and number not in listed]
    lost = tuple(number for number, there in found.items() if not there and number not in listed)
    return _Count(len(followed), len(by_list), lost)


def _signs(mapped: Extract, built: Built) -> dict[int, bool]:
    """By node: whether an edge with such a sign ends near it, or a junction that is an all-way stop or a circle."""
    to_metres, edges = GeoReference(built.network.map), built.edges
    ends = [(edge.shape_m[-1], edge.sign) for edge in edges if edge.sign]
    ends += [
        (edge.shape_m[-1], {"allway_stop": "stop", "left_before_right": "mini_roundabout"}[kind])
        for edge in edges
        if (kind := built.links.types.get(edge.to_node, "")) in ("allway_stop", "left_before_right")
    ]
    found: dict[int, bool] = dict.fromkeys(mapped.beside, False)
    for ref, node in mapped.nodes.items():
        kind = node.tags.get("highway", "")
        if kind in SIGNS:
            here = to_metres.x_y(*node.position)
            found[ref] = any(sign == kind and dist(here, end) < 130 for end, sign in ends)
    return found


def _arrows(mapped: Extract, built: Built) -> dict[int, bool]:
    """By way with lanes for cars: whether the last ones without an arrow in common lead to different roads."""
    edges: dict[int, list[str]] = {}
    for edge in built.edges:
        edges.setdefault(way_of(edge.edge_id), []).append(edge.edge_id)
    found: dict[int, bool] = {}
    for way in mapped.ways:
        for key in ("turn:lanes", "turn:lanes:forward", "turn:lanes:backward"):
            lanes = [frozenset(lane.split(";")) - {"", "none"} for lane in way.tags.get(key, "").split("|")]
            if any(lanes):
                back = key.endswith("backward") or way.tags.get("oneway") == "-1"
                there = [edge for edge in edges.get(way.way_id, ()) if edge.startswith("-") is back]
                last = max(
                    there, key=lambda edge: int(edge.partition("#")[2] or 0) * (-1 if back else 1), default=""
                )
                if last:
                    found[way.way_id] = found.get(way.way_id, True) and _lead_apart(lanes, last, built)
    return found


def _lead_apart(lanes: list[frozenset[str]], edge: str, built: Built) -> bool:
    links = [link for link in built.links.of.get(edge, ()) if link.direction != "t"]
    if len({link.to_edge for link in links}) < 2:
        return True  # no choice here: the road ends, or goes on, and its arrows are repeated
    count = max((link.lane for link in links), default=-1) + 1
    goals = [{link.to_edge for link in links if link.lane == lane} for lane in range(count)]
    if not built.network.map.left_hand:
        goals.reverse()
    if count < len(lanes):
        return False
    pairs = [each for each in zip(lanes, goals, strict=False) if each[0] and "merge" not in "".join(each[0])]
    return all(one & other or not here & there for (one, here), (other, there) in combinations(pairs, 2))


def _cameras(mapped: Extract, built: Built) -> dict[int, bool]:
    """By node: whether a camera is on an edge beside it."""
    to_metres = GeoReference(built.network.map)
    places = [
        along for edge in built.edges for place_m in edge.cameras_m for along in edge.shape_m
        if dist(along, edge.shape_m[0]) <= place_m + 200
    ]  # fmt: skip
    return {
        camera.node: any(dist(to_metres.x_y(*camera.position), place) < 300 for place in places)
        for camera in mapped.cameras
    }


def _borders(mapped: Extract, country: str) -> dict[int, bool]:
    """The ways that lie in another land, by their middle node: all are to be listed."""
    atlas = shipped()
    places = {way.way_id: mapped.nodes[way.nodes[len(way.nodes) // 2]].position for way in mapped.ways}
    return {way: False for way, place in places.items() if atlas.country_at(*place) not in ("", country)}


def table() -> Iterator[str]:
    """The lines of the page's table."""
    yield HEAD
    yield "|---|" + "---:|" * len(KINDS)
    for name, source in extracts().items():
        found = counts(source)
        yield f"| {name} | {' | '.join(str(found[kind]) for kind in KINDS)} |"


def shown() -> dict[str, list[str]]:
    """The page's rows, by extract."""
    rows = re.findall(r"^\| (\w+) \| ((?:\d+, \d+, \d+(?: \| | \|$)){4})", PAGE.read_text("utf-8"), re.MULTILINE)
    return {name: [cell.strip() for cell in cells.strip("| ").split("|")] for name, cells in rows}


if __name__ == "__main__":
    before, _, after = PAGE.read_text(encoding="utf-8").partition(HEAD)
    rest = after.lstrip().split("\n\n", 1)[1]
    PAGE.write_text(before + "\n".join(table()) + "\n\n" + rest, encoding="utf-8")
