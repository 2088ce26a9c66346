"""Routes to a destination with realistic times: SUMO's router over the traffic of the last five minutes.

An edge's time is its length divided by the vehicle-weighted mean speed, so queueing counts and empty intervals do
not. If too few vehicles were seen, it is free flow plus, at a signal, the mean wait for a random arrival.

The times that SUMO's router uses persist and apply to every vehicle, so they are written for a time that no
simulation reaches, and the router is queried for a departure then. The query uses the ego's type: its speed does
not deviate, so no random number is drawn either.
"""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Any

from automotive_cosim.contracts import RouteOption
from automotive_cosim.traffic.congestion import Congestion
from automotive_cosim.traffic.network import Crossing, Network
from automotive_cosim.traffic.sumo import LibSumo

NEVER_S = 1e8
"""Three years of simulated time; the edges' times are written for as long from there on."""

MOST = 3
"""Maximum number of alternatives."""

SAME_AT_MOST = 0.75
"""Share of an alternative's length that another route may have in common with it."""

PENALTY = 1.5
"""Factor on the time of an edge that is already in a route, so that the router looks elsewhere."""

TRIES = 12

LONGEST = 2.0
"""Routes that take more than this times the quickest are not offered."""

SIGNAL_WAIT_S = 13.6
"""Wait at a signal without a queue: 0.5 C (1 - g/C)^2, the uniform delay of the Highway Capacity Manual, for a
cycle of 90 s that is green for 45 % of it."""

SLOWEST_MPS = 0.5


class Router:
    """Finds routes for the ego without side effects."""

    def __init__(self, sumo: LibSumo, network: Network, congestion: Congestion, type_id: str) -> None:
        """Uses a running simulation.

        Args:
            sumo: the simulation.
            network: its roads.
            congestion: the speeds of the traffic.
            type_id: vehicle type without speed deviation or rerouting device.
        """
        self._sumo = sumo
        self._network = network
        self._congestion = congestion
        self._type = type_id
        signalled = {
            edge for edge, ways in network.crossings.items() if any(way.has_signal for way in ways.values())
        }
        self._free_s = {
            edge.edge_id: edge.length_m / edge.speed_mps + (SIGNAL_WAIT_S if edge.edge_id in signalled else 0.0)
            for edge in network.edges.values()
        }
        self._changed: tuple[str, ...] = ()
        """Edges whose weight differs from free roads."""
        self._write(self._free_s)

    def quickest(self, start: str, goals: Iterable[str]) -> tuple[str, ...]:
        """The quickest route now from an edge to the destination that is reached first; empty if none can be."""
        self._put(self._seen_s(0.0))
        routes = [self._route(start, goal) for goal in goals]
        found = min((route for route in routes if route.edges), key=lambda route: route.travelTime, default=None)
        return () if found is None else tuple(found.edges)

    def is_quicker(self, way: Sequence[str], other: Sequence[str], driven_m: float) -> bool:
        """Whether one route is quicker now than another from the same edge, of which ``driven_m`` are driven."""
        seen_s = self._seen_s(0.0)
        return self._option(way, seen_s, driven_m).eta_s < self._option(other, seen_s, driven_m).eta_s

    def alternatives(
        self, route: Sequence[str], fixed: int, driven_m: float, age_s: float = 0.0
    ) -> tuple[RouteOption, ...]:
        """The present route and up to ``MOST`` others, the quickest first.

        Args:
            route: edges of the ego's route from the present one.
            fixed: how many of them can no longer be changed.
            driven_m: distance driven on the first edge.
            age_s: age of the news, at most ``congestion.OLDEST_NEWS_S``.
        """
        seen_s = self._seen_s(age_s)
        network, weights = self._network, dict(seen_s)
        found = tuple(route)
        taken = [found]
        for _ in range(TRIES):
            for edge_id in found:
                weights[edge_id] = PENALTY * weights.get(edge_id, self._free_s[edge_id])
            self._put(weights)
            way = self._route(route[fixed - 1], route[-1]).edges
            if not way or len(taken) > MOST:
                break
            found = (*route[: fixed - 1], *way)
            if all(_shared(found, other, network) <= SAME_AT_MOST for other in taken):
                taken.append(found)
        options = [self._option(edges, seen_s, driven_m) for edges in taken]
        quick_s = LONGEST * min(option.eta_s for option in options)
        others = sorted((each for each in options[1:] if each.eta_s <= quick_s), key=lambda option: option.eta_s)
        return (options[0], *others)

    def _seen_s(self, age_s: float) -> dict[str, float]:
        """Travel times of the edges with enough vehicles."""
        return {
            edge_id: edge.length_m / max(SLOWEST_MPS, min(edge.speed_mps, speed_mps))
            for edge_id, speed_mps in self._congestion.window_speeds_mps(age_s).items()
            for edge in (self._network.edges[edge_id],)
        }

    def _option(self, edges: Sequence[str], seen_s: dict[str, float], driven_m: float) -> RouteOption:
        """A route without the driven part of its first edge."""
        network, edges_s = self._network, ChainMap(seen_s, self._free_s)
        first = network.edges[edges[0]]
        left = max(0.0, 1.0 - driven_m / first.length_m)
        length_m, time_s = first.length_m * left, edges_s[edges[0]] * left
        free_s = length_m / first.speed_mps
        for here, there in pairwise(edges):
            edge = network.edges[there]
            way = network.crossings.get(here, {}).get(there, Crossing(0.0, edge.speed_mps))
            way_s = way.length_m / max(SLOWEST_MPS, way.speed_mps)
            length_m += way.length_m + edge.length_m
            time_s += way_s + edges_s[there]
            free_s += way_s + edge.length_m / edge.speed_mps
        return RouteOption(tuple(edges), length_m, time_s, max(0.0, time_s - free_s))

    def _put(self, edges_s: Mapping[str, float]) -> None:
        """Sets the weights of these edges; all others are those of free roads."""
        self._write({edge_id: self._free_s[edge_id] for edge_id in self._changed if edge_id not in edges_s})
        self._write(edges_s)
        self._changed = tuple(edges_s)

    def _write(self, edges_s: Mapping[str, float]) -> None:
        for edge_id, seconds in edges_s.items():
            self._sumo.adapt_travel_time(edge_id, seconds, NEVER_S, 2 * NEVER_S)

    def _route(self, start: str, goal: str) -> Any:
        return self._sumo.find_route(start, goal, self._type, NEVER_S)


def _shared(way: Sequence[str], other: Sequence[str], network: Network) -> float:
    """Share of a route's length that is also part of another."""
    on_other = frozenset(other)
    length_m = sum(network.edges[edge].length_m for edge in way)
    return sum(network.edges[edge].length_m for edge in way if edge in on_other) / length_m
