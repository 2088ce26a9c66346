"""The quickest routes over a network on empty roads, without SUMO."""

from __future__ import annotations

import heapq
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from automotive_cosim.traffic.network import Network

NEAREST = 4_000
"""How many edges a search for any route reaches at most: some 25 km² of a town, however large the city is."""


@dataclass(frozen=True, slots=True)
class Ways:
    """The quickest routes from one edge to all that can be reached from it."""

    before: Mapping[str, str]
    """Each reachable edge -> its predecessor, without the start."""
    length_m: Mapping[str, float]
    """Travel time to each, over whole edges and junctions."""

    def to(self, goal: str) -> tuple[str, ...]:
        """The edges of the route, start and end included; empty if there is none."""
        if goal not in self.before:
            return ()
        edges = [goal]
        while edges[-1] in self.before:
            edges.append(self.before[edges[-1]])
        return tuple(reversed(edges))


def ways_from(network: Network, start: str, most: int | None = None, goal: str = "") -> Ways:
    """Searches the network from the end of an edge; ties go to the edge found first.

    Args:
        start: where the routes begin.
        most: how many of the nearest edges to reach; None for all.
        goal: an edge at which to stop: the route to it is the same as that of a search of all."""
    before: dict[str, str] = {}
    best_s: dict[str, float] = {start: 0.0}
    length_m: dict[str, float] = {start: network.edges[start].length_m}
    queue: list[tuple[float, int, str]] = [(0.0, 0, start)]
    done: set[str] = set()
    count = 0
    while queue and (most is None or len(done) < most):
        time_s, _, here = heapq.heappop(queue)
        if here in done:
            continue
        if here == goal:
            break
        done.add(here)
        for following, crossing in network.crossings.get(here, {}).items():
            if following in done:
                continue
            edge = network.edges[following]
            at_s = time_s + edge.length_m / edge.speed_mps
            if crossing.length_m:
                at_s += crossing.length_m / crossing.speed_mps
            if at_s < best_s.get(following, float("inf")):
                best_s[following], before[following] = at_s, here
                length_m[following] = length_m[here] + crossing.length_m + edge.length_m
                count += 1
                heapq.heappush(queue, (at_s, count, following))
    return Ways(before, length_m)


def way_through(network: Network, stops: Sequence[str]) -> tuple[str, ...]:
    """The edges of the quickest route through all stops; empty if one does not exist or cannot be reached."""
    if not network.edges.keys() >= set(stops):
        return ()
    edges: list[str] = [stops[0]]
    for start, goal in pairwise(stops):
        leg = ways_from(network, start, goal=goal).to(goal)
        if not leg:
            return ()
        edges += leg[1:]
    return tuple(edges)
