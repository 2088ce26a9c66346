"""Where netconvert gave a road more lanes than its tags do, for cars that leave it or join it.

netconvert (``--ramps.guess``) makes a fast one-way road as wide as the two roads together that begin at its end,
or that end at its start, for 100 m at most. One such lane is right as a rule: fast roads have lanes for leaving and
joining, which mappers count only where they split the way for them, and there netconvert adds none. More than one
is coarse, since the road widens step by step; the numbers are told, so that somebody can look.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from operator import attrgetter
from typing import NamedTuple

from automotive_cosim.osm.doubts import SHOWN
from automotive_cosim.osm.roads import MappedRoad, way_of
from automotive_cosim.traffic.network import Edge


class Widened(NamedTuple):
    """An edge beside a ramp."""

    edge_id: str
    mapped: int
    """Lanes that the tags give it."""
    built: int


def widened(edges: Sequence[Edge], roads: Mapping[int, MappedRoad]) -> Iterator[Widened]:
    """The edges with as many lanes as two roads together that part at their end or join at their start, and more
    than their tags give them."""
    starting: defaultdict[str, list[Edge]] = defaultdict(list)
    ending: defaultdict[str, list[Edge]] = defaultdict(list)
    for edge in edges:
        starting[edge.from_node].append(edge)
        ending[edge.to_node].append(edge)
    for edge in edges:
        mapped, built = roads[way_of(edge.edge_id)].lanes(edge.edge_id), len(edge.lane_ids)
        if mapped is None or built <= mapped:
            continue
        parted = _lanes_beyond(edge, attrgetter("to_node"), starting)
        joined = _lanes_beyond(edge, attrgetter("from_node"), ending)
        if built in (parted, joined):
            yield Widened(edge.edge_id, mapped, built)


def in_words(found: Sequence[Widened]) -> str:
    """``"way 12: 2 as 3 lanes"``, of each way the widest edge."""
    by_way: dict[int, Widened] = {}
    for each in sorted(found, key=lambda each: each.built - each.mapped):
        by_way[way_of(each.edge_id)] = each
    most = sorted(by_way.items(), key=lambda item: (item[1].mapped - item[1].built, item[0]))
    shown = ", ".join(f"way {way}: {each.mapped} as {each.built}" for way, each in most[:SHOWN])
    return f"{shown}{f' and {len(most) - SHOWN} more ways' if len(most) > SHOWN else ''}"


def _lanes_beyond(edge: Edge, node: Callable[[Edge], str], there: Mapping[str, Sequence[Edge]]) -> int:
    """Lanes of the two roads that an edge parts into, or is joined from, at once or beyond straight pieces; 0
    without such roads.

    Args:
        node: the end of an edge to go on from.
    """
    seen: set[str] = set()
    while edge.edge_id not in seen:
        seen.add(edge.edge_id)
        beyond = there.get(node(edge), ())
        if len(beyond) != 1:
            return _lanes(beyond)
        edge = beyond[0]
    return 0


def _lanes(edges: Sequence[Edge]) -> int:
    """Those of two roads; netconvert widens for no more and no fewer."""
    return sum(len(edge.lane_ids) for edge in edges) if len(edges) == 2 else 0
