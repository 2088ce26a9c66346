"""Barriers on roads: where cars cannot pass, a road ends on both sides (OSM wiki, "Key:barrier").

An access key on the barrier decides (``access``), else the kind of barrier. netconvert knows no barriers, so a way
is cut there: each side ends at a node of its own. Where one direction only is closed, cars may not go straight on.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from automotive_cosim.osm.access import ENDS, KEYS, access, small
from automotive_cosim.osm.extract import Extract, OsmWay, Position
from automotive_cosim.osm.facing import away_m
from automotive_cosim.osm.oneway import BOTH, VALUES

PASSABLE = frozenset(
    ("no", "entrance", "border_control", "toll_booth", "checkpoint", "cattle_grid", "sally_port", "kerb", "coupure",
     "height_restrictor", "width_restrictor", "bump_gate", "rumble_strip", "arch", "traffic_island", "gate_removed")
)  # fmt: skip
"""Barriers that cars pass."""

GATES = frozenset(
    ("gate", "lift_gate", "swing_gate", "sliding_gate", "sliding_beam", "hampshire_gate", "gates", "retractable",
     "wire_gate", "door", "tube_gate")
)  # fmt: skip
"""Barriers that open: passable if nothing else is said, and told, because the map does not say for whom."""

STOPPING = frozenset(
    ("block", "bollard", "rising_bollard", "bar", "barrier_board", "bus_trap", "chain", "city_wall",
     "cycle_barrier", "debris", "ditch", "fence", "full-height_turnstile", "guard_rail", "hedge", "horse_stile",
     "jersey_barrier", "kissing_gate", "log", "motorcycle_barrier", "planter", "retaining_wall", "rock", "rope",
     "spikes", "stile",
     "step", "sump_buster", "tank_trap", "turnstile", "wall", "wicket_gate", "wedge", "boulder", "bollards")
)  # fmt: skip
"""Barriers that stop cars."""


GAP_M = 1.0
"""Between the ends of a road on both sides of a barrier."""


class Barrier(NamedTuple):
    """A barrier on a road."""

    node: int
    tag: str
    """What says whether cars pass: ``"barrier=bollard"``, ``"access=private"``."""


@dataclass(frozen=True, slots=True)
class Piece:
    """A way, or what a barrier leaves of it on one side."""

    way: OsmWay
    part: int
    """1 for the way or its first piece, 2 for the next, ..."""
    nodes: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Cut:
    """The roads of a map, cut at the barriers."""

    pieces: tuple[Piece, ...]
    ends: Mapping[int, Position]
    """The nodes made where a road ends at a barrier, and their places."""
    stopping: tuple[Barrier, ...]
    """Barriers that stop cars."""
    gates: tuple[Barrier, ...] = ()
    """Gates of which the map does not say for whom they open."""
    unplaced: tuple[Barrier, ...] = ()
    """Barriers on junctions, of which it does not say which road they stop: passed."""
    one_way: tuple[tuple[int, int, int], ...] = ()
    """Where a barrier stops cars in one direction only: the piece that they come from, the node, and the piece into
    which they may not drive on."""


def stops(tags: Mapping[str, str]) -> str | None:
    """The tag by which a node stops cars in both directions; None if it does not."""
    forward, backward = (_stops(tags, end) for end in ENDS)
    return forward if backward else None


def closed_end(tags: Mapping[str, str]) -> str:
    """The direction of ``ENDS`` in which a node stops cars, if it lets them pass in the other; empty if not."""
    closed = [end for end in ENDS if _stops(tags, end)]
    return closed[0] if len(closed) == 1 else ""


def _stops(tags: Mapping[str, str], end: str) -> str | None:
    barrier = tags.get("barrier", "").lower()
    if not barrier or barrier == "no":
        return None
    if not VALUES.get(tags.get("oneway", ""), BOTH).open(end):
        return f"barrier={barrier}, oneway={tags['oneway']}"
    if any(tags.get(name) for key in KEYS for name in (key, f"{key}:{end}")):
        found = access(tags, end)
        return None if found.is_open else f"barrier={barrier}, {found.tag}"
    return None if barrier in PASSABLE | GATES else f"barrier={barrier}"


def is_unclear_gate(tags: Mapping[str, str]) -> bool:
    """Whether a node is a gate without a word about who passes."""
    return tags.get("barrier", "").lower() in GATES and not any(tags.get(key) for key in KEYS)


def doubts(tags: Mapping[str, str]) -> Iterator[str]:
    """The tags of a barrier that a network cannot follow: conditions, and limits of size."""
    yield from (f"{key}={value}" for key, value in tags.items() if _TIMED.match(key))
    yield from small(tags)


_TIMED = re.compile(rf"({'|'.join(KEYS)}|oneway).*:conditional$")


def cut(extract: Extract) -> Cut:
    """Cuts the roads at the barriers that stop cars."""
    arms = _arms(extract.ways)
    stopping: list[Barrier] = []
    gates: list[Barrier] = []
    unplaced: list[Barrier] = []
    halves: dict[int, str] = {}
    ends_of_ways = {ref for way in extract.ways for ref in (way.nodes[0], way.nodes[-1])}
    for ref, node in extract.nodes.items():
        if "barrier" not in node.tags or arms[ref] < 2:
            continue
        tag = stops(node.tags)
        if closed := closed_end(node.tags):
            if arms[ref] == 2 and ref not in ends_of_ways:
                halves[ref] = closed
            else:
                unplaced.append(Barrier(ref, f"{_stops(node.tags, closed)} for one direction"))
        elif tag is not None:
            (stopping if arms[ref] == 2 else unplaced).append(Barrier(ref, tag))
        elif is_unclear_gate(node.tags):
            gates.append(Barrier(ref, f"barrier={node.tags['barrier']}"))
    shut = {barrier.node for barrier in stopping}
    free = max((abs(ref) for ref in extract.nodes), default=0)
    made: dict[int, Position] = {}
    pieces: list[Piece] = []
    one_way: list[tuple[int, int, int]] = []
    seen: set[int] = set()
    for way in extract.ways:
        for part, nodes in enumerate(_split(way.nodes, shut | halves.keys()), start=1):
            ends = list(nodes)
            for index in (0, -1):
                ref = ends[index]
                if ref in shut and ref in seen:
                    free += 1
                    made[free] = _before(ref, nodes[1 if index == 0 else -2], extract)
                    ends[index] = free
                elif ref in shut:
                    seen.add(ref)
            if ends[0] in halves and part > 1:
                here = (len(pieces) - 1, len(pieces))
                before, after = here if halves[ends[0]] == "forward" else here[::-1]
                one_way.append((before, ends[0], after))
            pieces.append(Piece(way, part, tuple(ends)))
    return Cut(tuple(pieces), made, tuple(stopping), tuple(gates), tuple(unplaced), tuple(one_way))


def _before(ref: int, neighbour: int, extract: Extract) -> Position:
    """A place a little before a barrier: netconvert takes two nodes at one place for one."""
    (lon, lat), (lon_on, lat_on) = extract.nodes[ref].position, extract.nodes[neighbour].position
    length_m = away_m((lon, lat), (lon_on, lat_on))
    share = min(0.5, GAP_M / max(length_m, GAP_M))
    return Position(lon + share * (lon_on - lon), lat + share * (lat_on - lat))


def _arms(ways: Sequence[OsmWay]) -> Counter[int]:
    """Pieces of road that leave each node."""
    arms: Counter[int] = Counter()
    for way in ways:
        arms.update(way.nodes)
        arms.update(way.nodes[1:-1])
    return arms


def _split(nodes: Sequence[int], at: set[int]) -> Iterator[Sequence[int]]:
    first = 0
    for index in range(1, len(nodes) - 1):
        if nodes[index] in at:
            yield nodes[first : index + 1]
            first = index
    yield nodes[first:]
