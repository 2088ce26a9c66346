"""Compares a built network with the map: every edge with its way, every turn and barrier with what the map says."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from automotive_cosim.contracts import KMH_PER_MPS, LimitSource
from automotive_cosim.osm.country import country_codes
from automotive_cosim.osm.expected import expect, expect_stop, expect_turn
from automotive_cosim.osm.extract import Extract
from automotive_cosim.osm.network import Built
from automotive_cosim.osm.oneway import directions
from automotive_cosim.osm.ramps import widened
from automotive_cosim.osm.roads import MappedRoad, way_of
from automotive_cosim.osm.speed_limits import MPH_COUNTRIES, kmh_of
from automotive_cosim.traffic.network import Edge, class_of

ROUNDING_KMH = 0.05
"""netconvert writes speeds with two digits of a metre per second."""

MILES = MPH_COUNTRIES | {"UK"}


@dataclass(frozen=True, slots=True)
class Difference:
    """One property in which the network differs from the map."""

    what: str
    """``"limit"``, ``"name"``, ``"class"``, ``"tunnel"``, ``"lanes"``, ``"access"``, ``"turn"``, ``"barrier"``."""
    mapped: str
    built: str
    edge_id: str = ""
    """The edge; empty if there is none."""
    way: int | None = None
    node: int | None = None
    relation: int | None = None

    def __str__(self) -> str:
        mapped, built = (value or "unnamed" for value in (self.mapped, self.built))
        numbers = (("relation", self.relation), ("node", self.node), ("way", self.way))
        where = ", ".join(f"{kind} {number}" for kind, number in numbers if number is not None)
        built_where = f"edge {self.edge_id}" if self.edge_id else "the network"
        return f"{where}: {self.what}: {mapped} in the map, {built} in {built_where}"


def differences(
    extract: Extract, built: Built, roads: Mapping[int, MappedRoad], country: str
) -> Iterator[Difference]:
    """Everything in which the network differs from the map: what the import itself read from the tags
    (``of_edges``), and what a second reading of them expects (``expected``) of access, direction, posted limits,
    barriers and turns. Lanes for leaving and joining are no difference (``ramps``)."""
    beside_ramps = {each.edge_id for each in widened(built.edges, roads)}
    for found in of_edges(built.edges, roads):
        if found.what != "lanes" or found.edge_id not in beside_ramps:
            yield found
    yield from _of_access_and_limits(extract, built, roads, country)
    yield from _of_barriers(extract, built)
    yield from _of_turns(extract, built)


def of_edges(edges: Iterable[Edge], roads: Mapping[int, MappedRoad]) -> Iterator[Difference]:
    """Every property of every edge that differs from its way's tags. Fewer lanes for cars than the way has are no
    difference: the others are closed to them."""
    for edge in edges:
        way = way_of(edge.edge_id)
        road = roads[way]
        limit_kmh, source = _mapped_limit(road, edge.edge_id)
        built_kmh = _built_kmh(edge)
        if source is not edge.limit_source or not math.isclose(limit_kmh, built_kmh, abs_tol=ROUNDING_KMH):
            shown = _limit(built_kmh, edge.limit_source)
            yield Difference("limit", _limit(limit_kmh, source), shown, edge.edge_id, way)
        for what, mapped, found in (
            ("name", road.name, edge.name),
            ("class", class_of(road.tags["highway"], road.tags), edge.road_class),
            ("tunnel", _yes(road.tags.get("tunnel", "no") != "no"), _yes(edge.in_tunnel)),
        ):
            if mapped != found:
                yield Difference(what, mapped, found, edge.edge_id, way)
        lanes = road.lanes(edge.edge_id)
        if lanes is not None and len(edge.lane_ids) > lanes:
            yield Difference("lanes", str(lanes), str(len(edge.lane_ids)), edge.edge_id, way)


def _of_access_and_limits(
    extract: Extract, built: Built, roads: Mapping[int, MappedRoad], country: str
) -> Iterator[Difference]:
    of_way: dict[int, list[Edge]] = {}
    for edge in built.edges:
        of_way.setdefault(way_of(edge.edge_id), []).append(edge)
    for way in (*extract.ways, *extract.closed):
        land = roads[way.way_id].country if way.way_id in roads else country
        expected = expect(way.tags, land, miles=MILES, metric=country_codes())
        edges = of_way.get(way.way_id, ())
        against = [edge.edge_id.startswith("-") for edge in edges]
        found = (not all(against), any(against))
        wanted = (expected.forward, expected.backward)
        if found != wanted and (edges or not any(directions(way.tags)) or not any(wanted)):
            yield Difference("access", DIRECTIONS[wanted], DIRECTIONS[found], way=way.way_id)
        for edge in edges:
            limit_kmh = expected.limit_kmh(edge.edge_id)
            built_kmh = _built_kmh(edge) if edge.limit_source is LimitSource.POSTED else None
            if (limit_kmh is None) != (built_kmh is None) or (
                limit_kmh is not None
                and built_kmh is not None
                and not math.isclose(limit_kmh, built_kmh, abs_tol=ROUNDING_KMH)
            ):
                shown = (_posted(limit_kmh), _posted(built_kmh))
                yield Difference("limit", *shown, edge.edge_id, way.way_id)


DIRECTIONS = {
    (True, True): "both directions",
    (True, False): "with its nodes only",
    (False, True): "against its nodes only",
    (False, False): "closed to cars",
}


def _of_barriers(extract: Extract, built: Built) -> Iterator[Difference]:
    stopped = {barrier.node for barrier in built.cut.stopping}
    told = stopped | {barrier.node for barrier in built.cut.unplaced}
    passing: dict[int, str] = {}
    for edge_id, onward in built.network.crossings.items():
        junction = built.network.edges[edge_id].to_node
        if (
            junction.isdecimal()
            and int(junction) in stopped
            and set(onward) - {built.network.opposite.get(edge_id)}
        ):
            passing[int(junction)] = edge_id
    met = Counter(ref for way in extract.ways for ref in (*way.nodes, *way.nodes[1:-1]))
    for ref, node in extract.nodes.items():
        stops = expect_stop(node.tags) and met[ref] > 1
        if stops and ref not in told:
            yield Difference("barrier", "closed to cars", "passed", node=ref)
        elif ref in passing:
            yield Difference("barrier", "closed to cars", "passed", passing[ref], node=ref)
        elif ref in stopped and not stops:
            yield Difference("barrier", "open to cars", "closed", node=ref)


_NUMBERS = re.compile(r"\d+")


def _of_turns(extract: Extract, built: Built) -> Iterator[Difference]:
    """Turns that are possible although a relation bars them. A road that passes the node is left out: the relation
    does not say from which side of it."""
    network = built.network
    ending: dict[tuple[int, int], list[Edge]] = {}
    for edge in built.edges:
        for number in _NUMBERS.findall(edge.to_node):
            ending.setdefault((way_of(edge.edge_id), int(number)), []).append(edge)
    for relation in extract.restrictions:
        turn = expect_turn(relation.tags, relation.members)
        if turn is None or (turn.is_only and not turn.to_ways):
            continue
        for from_way in turn.from_ways:
            edges = ending.get((from_way, turn.via_node), ())
            for edge in edges if len(edges) == 1 else ():
                onward = sorted({way_of(to_edge) for to_edge in network.crossings.get(edge.edge_id, ())})
                if turn.is_only and not turn.to_ways & set(onward):
                    continue
                for to_way in onward:
                    if (to_way in turn.to_ways) is not turn.is_only:
                        shown = f"into way {to_way} barred", "open"
                        yield Difference("turn", *shown, edge.edge_id, from_way, relation=relation.relation_id)


def _built_kmh(edge: Edge) -> float:
    return math.inf if edge.limit_mps is None else edge.limit_mps * KMH_PER_MPS


def _posted(kmh: float | None) -> str:
    return "not posted" if kmh is None else _limit(kmh, LimitSource.POSTED)


def _mapped_limit(road: MappedRoad, edge_id: str) -> tuple[float, LimitSource]:
    source = LimitSource.ASSUMED if road.stated.of(edge_id) is None else LimitSource.POSTED
    return kmh_of(road.limit(edge_id)), source


def _limit(kmh: float, source: LimitSource) -> str:
    return f"{'none' if math.isinf(kmh) else f'{kmh:.0f} km/h'} ({source})"


def _yes(is_so: bool) -> str:
    return "yes" if is_so else "no"
