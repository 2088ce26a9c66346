"""Trips driven one after another, over and over, for drives that last longer than any trip."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.scenario import Trip
from automotive_cosim.traffic.network import JunctionLengths, Network
from automotive_cosim.traffic.ways import way_through

_Graph: TypeAlias = tuple[Mapping[str, Sequence[str]], Mapping[str, Sequence[str]]]
"""The edges after each edge, and those before it."""

ONWARD_M = 300.0
"""Distance to the destination at which the driver enters the next one: some twenty seconds in a town, so that there
is time to reach the lane of the next turn."""


@dataclass(frozen=True, slots=True)
class Round:
    """Where to drive next. A trip that ends where there is no way back, as at the rim of a network, is driven up to
    the last edge from which one can return; what lies before such edges likewise only the first time."""

    first: tuple[str, ...]
    """Edges of the first trip."""
    legs: tuple[tuple[str, ...], ...]
    """Edges of the trips after it, in their order; a route leads from the end of each to the start of each."""

    def following(self, network: Network, here: str, leg: int) -> tuple[str, ...]:
        """The edges from the present destination to the end of a leg; empty if no way leads there."""
        edges = self.legs[leg % len(self.legs)]
        way = (here,) if here == edges[0] else way_through(network, (here, edges[0]))
        return (*way, *edges[1:]) if way else ()


def planned(network: Network, first: Trip, onward: Sequence[Trip]) -> Round:
    """The round of some trips on a network.

    Raises ScenarioError: one of them has no route, or no route leads from it to the others."""
    ways = [_way(network, trip) for trip in (first, *onward)]
    core = _core(_graph(JunctionLengths(network.crossings)), ways[0], [])
    parts = [_within(way, core) for way in ways]
    for trip, part in zip((first, *onward), parts, strict=True):
        if not part:
            raise ScenarioError(
                f"no route leads from trip {trip.name!r} to the others and back; leave it out of the round"
            )
    begun = ways[0][: ways[0].index(parts[0][-1]) + 1]
    return Round(begun, tuple(parts[1:]))


def in_turn(network: Network, trips: Sequence[Trip]) -> tuple[Trip, ...]:
    """The largest set of trips that can be driven one after another, from one of them on, as ``planned`` has it;
    empty if none leads back to its start."""
    ways = {trip: way_through(network, (trip.from_edge, *trip.via, trip.to_edge)) for trip in trips}
    best: tuple[Trip, ...] = ()
    graph, parts = _graph(JunctionLengths(network.crossings)), list[frozenset[str]]()
    for first, way in ways.items():
        core = _core(graph, way, parts)
        if _within(way, core):
            others = (trip for trip in trips if trip is not first and _within(ways[trip], core))
            best = max(best, (first, *others), key=len)
    return best


def loop_with(junctions: Iterable[tuple[str, str]], edge: str) -> frozenset[str]:
    """The edges that can be reached from one and from which it can be reached again.

    Args:
        junctions: the edges before and after each way through a junction."""
    ahead, back = _graph(junctions)
    return frozenset(_reached(ahead, edge) & _reached(back, edge))


def _graph(junctions: Iterable[tuple[str, str]]) -> _Graph:
    ahead: dict[str, list[str]] = {}
    back: dict[str, list[str]] = {}
    for here, there in junctions:
        ahead.setdefault(here, []).append(there)
        back.setdefault(there, []).append(here)
    return ahead, back


def _way(network: Network, trip: Trip) -> tuple[str, ...]:
    way = way_through(network, (trip.from_edge, *trip.via, trip.to_edge))
    if not way:
        raise ScenarioError(f"trip {trip.name!r} has no route for a car")
    return way


def _within(way: Sequence[str], core: frozenset[str]) -> tuple[str, ...]:
    """The part of a way from its first to its last edge in the core."""
    places = [index for index, edge in enumerate(way) if edge in core]
    return tuple(way[places[0] : places[-1] + 1]) if places else ()


def _core(graph: _Graph, way: Iterable[str], parts: list[frozenset[str]]) -> frozenset[str]:
    """The largest set of edges that can all be reached from one another and has part in a way.

    Args:
        parts: such sets that have been found, and are not searched again."""
    best: frozenset[str] = frozenset()
    for edge in way:
        part = next((part for part in parts if edge in part), None)
        if part is None:
            ahead, back = graph
            parts.append(part := frozenset(_reached(ahead, edge) & _reached(back, edge)))
        best = max(best, part, key=len)
    return best if len(best) > 1 else frozenset()


def _reached(ways: Mapping[str, Iterable[str]], start: str) -> set[str]:
    reached, new = {start}, {start}
    while new:
        new = set[str]().union(*(ways.get(edge, ()) for edge in new)) - reached
        reached |= new
    return reached
