"""Trips driven one after another, over and over, for drives that last longer than any trip."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.scenario import Trip
from automotive_cosim.traffic.network import JunctionLengths, Network
from automotive_cosim.traffic.ways import way_through

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


class Planner:
    """Plans rounds on a network. What several cars of a fleet ask for is searched once."""

    def __init__(self, network: Network) -> None:
        self.network = network
        """The roads on which it plans, with the present limits."""
        self._loops = _Loops(JunctionLengths(network.crossings))
        self._rounds: dict[tuple[Trip, ...], Round] = {}
        """Those of an instant, as limits change."""
        self._at_s = 0.0

    def planned(self, first: Trip, onward: Sequence[Trip], now_s: float) -> Round:
        """See ``planned``, at a simulation time."""
        if now_s != self._at_s:
            self._rounds, self._at_s = {}, now_s
        trips = (first, *onward)
        if trips not in self._rounds:
            self._rounds[trips] = planned(self.network, first, onward, self._loops)
        return self._rounds[trips]

    def leads_on(self, here: str, round_: Round) -> bool:
        """Whether a way leads from an edge into a round."""
        goal = round_.legs[0][0]
        return goal in self._loops.known(here) or bool(round_.following(self.network, here, 0))


class _Loops:
    """Which edges of a network can be reached from one another."""

    def __init__(self, junctions: Iterable[tuple[str, str]]) -> None:
        """Takes the edges before and after each way through a junction; nothing is searched yet."""
        self.junctions = junctions
        self._found: list[frozenset[str]] = []

    def known(self, edge: str) -> frozenset[str]:
        """All that are known to be reached from an edge and to reach it; empty if nothing is known of it."""
        return next((found for found in self._found if edge in found), frozenset())

    def largest(self, edges: Iterable[str]) -> frozenset[str]:
        """The largest set, if only of one, of edges that can be reached from one another and has part in some."""
        best: frozenset[str] = frozenset()
        ahead: dict[str, list[str]] = {}
        back: dict[str, list[str]] = {}
        for edge in edges:
            if not (loop := self.known(edge)):
                if not ahead:
                    for here, there in self.junctions:
                        ahead.setdefault(here, []).append(there)
                        back.setdefault(there, []).append(here)
                self._found.append(loop := frozenset(_reached(ahead, edge) & _reached(back, edge)))
            best = max(best, loop, key=len)
        return best


def planned(network: Network, first: Trip, onward: Sequence[Trip], loops: _Loops | None = None) -> Round:
    """The round of some trips on a network.

    Args:
        loops: those of the network, if some are known; searched if left out.

    Raises ScenarioError: one of them has no route, or no route leads from it to the others."""
    ways = [_way(network, trip) for trip in (first, *onward)]
    core = _core(loops or _Loops(JunctionLengths(network.crossings)), ways[0])
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
    loops = _Loops(JunctionLengths(network.crossings))
    for first, way in ways.items():
        core = _core(loops, way)
        if _within(way, core):
            others = (trip for trip in trips if trip is not first and _within(ways[trip], core))
            best = max(best, (first, *others), key=len)
    return best


_LOOPS = [_Loops(())]
"""Those of the network that was asked for last, as every car of a fleet asks."""


def loop_with(junctions: Iterable[tuple[str, str]], edge: str) -> frozenset[str]:
    """The edges that can be reached from one and from which it can be reached again.

    Args:
        junctions: the edges before and after each way through a junction."""
    if _LOOPS[0].junctions is not junctions:
        _LOOPS[0] = _Loops(junctions)
    return _LOOPS[0].largest((edge,))


def _way(network: Network, trip: Trip) -> tuple[str, ...]:
    way = way_through(network, (trip.from_edge, *trip.via, trip.to_edge))
    if not way:
        raise ScenarioError(f"trip {trip.name!r} has no route for a car")
    return way


def _within(way: Sequence[str], core: frozenset[str]) -> tuple[str, ...]:
    """The part of a way from its first to its last edge in the core."""
    places = [index for index, edge in enumerate(way) if edge in core]
    return tuple(way[places[0] : places[-1] + 1]) if places else ()


def _core(loops: _Loops, way: Iterable[str]) -> frozenset[str]:
    """The largest set of edges that can all be reached from one another and has part in a way; empty if none can be
    left and reached again."""
    best = loops.largest(way)
    return best if len(best) > 1 else frozenset()


def _reached(ways: Mapping[str, Iterable[str]], start: str) -> set[str]:
    reached, new = {start}, {start}
    while new:
        new = set[str]().union(*(ways.get(edge, ()) for edge in new)) - reached
        reached |= new
    return reached
