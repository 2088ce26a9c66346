"""Finds the lanes of a built network in which cars are trapped, and opens a way out.

A lane for buses or taxis between two lanes for cars parts them: SUMO lets no car cross it. On the short edges of
mapped junctions, a car then enters on one side, needs the other, and stands there for good with all behind it.
Where that happens, the lane between is opened to cars, as drivers cross it there in reality; the import lists it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from automotive_cosim.osm.links import Link, Links
from automotive_cosim.traffic.network import open_to

SHORT_M = 50.0
"""On a shorter edge there is no room to sort oneself into lanes, so it is never parted."""

Blocks = tuple[frozenset[int], ...]
"""The lanes for cars of an edge, by index: those between which cars may change are together."""


@dataclass(slots=True)
class _Lanes:
    """The lanes and connections of a network."""

    open: dict[str, list[bool]] = field(default_factory=dict)
    """By edge, for each lane from the kerb: whether cars may use it."""
    length_m: dict[str, float] = field(default_factory=dict)
    links: Mapping[str, Sequence[Link]] = field(default_factory=dict)
    """By the edge they leave."""
    origins: dict[str, set[str]] = field(default_factory=dict)
    """The edges from which links lead onto an edge."""


def open_traps(text: str, links: Links) -> tuple[str, tuple[str, ...]]:
    """Opens the lanes between lanes for cars that trap cars.

    Returns:
        The network, and the edges on which lanes were opened.
    """
    lanes = _read(text, links)
    opened: set[str] = set()
    while trapped := {edge for edge in lanes.open.keys() - opened if _traps(edge, lanes)}:
        for edge in trapped:
            cars = [index for index, is_open in enumerate(lanes.open[edge]) if is_open]
            lanes.open[edge][cars[0] : cars[-1] + 1] = [True] * (cars[-1] + 1 - cars[0])
        opened |= trapped
    return (_with_open(text, lanes, opened) if opened else text), tuple(sorted(opened))


def _traps(edge: str, lanes: _Lanes) -> bool:
    """Whether cars may come in on a side from which an edge ahead cannot be reached that can be from another."""
    blocks = _blocks(lanes.open[edge])
    if len(blocks) < 2:
        return False
    if lanes.length_m[edge] < SHORT_M:
        return True
    ahead = [_targets(edge, block, lanes) for block in blocks]
    everywhere = frozenset[str]().union(*ahead)
    for origin in sorted(lanes.origins.get(edge, ())):
        links = lanes.links[origin]
        for start in _blocks(lanes.open.get(origin, [])):
            sides = [
                targets
                for block, targets in zip(blocks, ahead, strict=True)
                if any(link.lane in start and link.to_edge == edge and link.to_lane in block for link in links)
            ]
            if sides and frozenset[str]().union(*sides) != everywhere:
                return True
    return False


def _targets(edge: str, block: frozenset[int], lanes: _Lanes) -> frozenset[str]:
    links = lanes.links.get(edge, ())
    return frozenset(link.to_edge for link in links if link.lane in block and _open_link(edge, link, lanes))


def _open_link(origin: str, link: Link, lanes: _Lanes) -> bool:
    start, end = lanes.open.get(origin, []), lanes.open.get(link.to_edge, [])
    return link.lane < len(start) and link.to_lane < len(end) and start[link.lane] and end[link.to_lane]


def _blocks(is_open: Sequence[bool]) -> Blocks:
    blocks: list[set[int]] = []
    for index, lane in enumerate(is_open):
        if lane and index and is_open[index - 1]:
            blocks[-1].add(index)
        elif lane:
            blocks.append({index})
    return tuple(map(frozenset, blocks))


def _read(text: str, links: Links) -> _Lanes:
    lanes = _Lanes(links=links.of)
    for edge, inner in _EDGE.findall(text):
        of_edge = [dict(_ATTRIBUTE.findall(lane)) for lane in _LANES.findall(inner)]
        lanes.open[edge] = [open_to(lane) for lane in of_edge]
        lanes.length_m[edge] = float(of_edge[0]["length"])
    for edge, onward in lanes.links.items():
        for link in onward:
            lanes.origins.setdefault(link.to_edge, set()).add(edge)
    return lanes


_EDGE = re.compile(r'<edge id="([^":][^"]*)"[^>]*>(.*?)</edge>', re.DOTALL)
_LANES = re.compile(r"<lane ([^>]*)>")
_ATTRIBUTE = re.compile(r'\b(allow|disallow|length)="([^"]*)"')


_LANE = re.compile(r'<lane id="([^"]*)"[^>]*>')
_ALLOW = re.compile(r' allow="([^"]*)"')


def _with_open(text: str, lanes: _Lanes, opened: set[str]) -> str:
    """The text with the lanes of these edges opened, and the ways through junctions from and to them."""
    ids = {f"{edge}_{index}" for edge in opened for index, is_open in enumerate(lanes.open[edge]) if is_open}
    ids |= set(_ways_through(lanes, opened))

    def let_in(lane: re.Match[str]) -> str:
        if lane[1] not in ids:
            return lane[0]
        return _ALLOW.sub(lambda allow: f' allow="{_with_cars(allow[1])}"', lane[0])

    return _LANE.sub(let_in, text)


def _with_cars(allowed: str) -> str:
    kinds = allowed.split()
    return allowed if {"passenger", "all"} & set(kinds) else " ".join((*kinds, "passenger"))


def _ways_through(lanes: _Lanes, opened: set[str]) -> Iterator[str]:
    """The inner lanes of open connections from or to these edges; some wait in the middle of the junction, so they
    are two."""
    onward: Mapping[str, str] = {
        f"{edge}_{link.lane}": link.via
        for edge, links in lanes.links.items()
        if edge.startswith(":")
        for link in links
    }
    for edge, links in lanes.links.items():
        for link in links:
            if (edge in opened or link.to_edge in opened) and _open_link(edge, link, lanes):
                via = link.via
                while via:
                    yield via
                    via = onward.get(via, "")
