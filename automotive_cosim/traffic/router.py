"""Routes to a destination with realistic times: SUMO's router over the traffic of the last five minutes.

An edge's time is its length divided by the vehicle-weighted mean speed, so queueing counts and empty intervals do
not. If too few vehicles were seen, it is free flow plus, at a signal, the mean wait for a random arrival. The times
of the routes offered are those of the quickest lane that leads on: a queue to turn left does not delay the others.

The times that SUMO's router uses persist and apply to every vehicle, so they are written for a time that no
simulation reaches, and the router is queried for a departure then.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from automotive_cosim.contracts import RouteOption
from automotive_cosim.traffic.congestion import NOTHING, SEEN_AT_LEAST, Congestion, Tally
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


class _Traffic(NamedTuple):
    """The traffic of the last minutes."""

    lanes: Mapping[str, Tally]
    edges_s: Mapping[str, float]
    """Travel times of the edges with enough vehicles."""


class Router:
    """Finds routes for the ego without side effects."""

    def __init__(self, sumo: LibSumo, network: Network, congestion: Congestion, type_id: str) -> None:
        """Uses a running simulation.

        Args:
            congestion: the speeds of the traffic.
            type_id: vehicle type without speed deviation or rerouting device."""
        self._sumo = sumo
        self._network = network
        self._congestion = congestion
        self._type = type_id
        self._signalled = {
            edge for edge, ways in network.crossings.items() if any(way.has_signal for way in ways.values())
        }
        self._limits_mps: dict[str, float] = {}
        self._free_s: dict[str, float] = {}
        """Travel times at these limits, those in force when the traffic was last looked at."""
        self._heard_s: Mapping[str, float] = {}
        """Travel times of the news that was listened to last."""
        self._changed: tuple[str, ...] = ()
        """Edges whose weight differs from free roads."""
        self._written_s: dict[str, float] = {}
        """The weights that SUMO has."""
        self._follow_limits()

    def quickest(self, start: str, goals: Iterable[str], via: Sequence[str] = ()) -> tuple[str, ...]:
        """The quickest route now from an edge, through others, to the destination that is reached first; empty if
        none can be."""
        self._put(self._traffic(0.0).edges_s)
        routes = [self._route(start, goal, via) for goal in goals]
        _, found = min((route for route in routes if route[1]), key=lambda route: route[0], default=(0.0, ()))
        return found

    def listen(self, age_s: float) -> None:
        """Takes in news of that age, for the offers that follow."""
        self._heard_s = self._traffic(age_s).edges_s
        self._put(self._heard_s)

    def offer(self, route: Sequence[str]) -> tuple[float, tuple[str, ...]]:
        """What the quickest way to the end of a route saves, in seconds, and that way, by the news listened to."""
        _, way = self._route(route[0], route[-1], ())
        own_s, other_s = (
            sum(self._heard_s.get(edge, self._free_s.get(edge, 0.0)) for edge in each) for each in (route, way)
        )
        return own_s - other_s, way

    def is_quicker(self, way: Sequence[str], other: Sequence[str], driven_m: float) -> bool:
        """Whether one route is quicker now than another from the same edge, of which ``driven_m`` are driven."""
        traffic = self._traffic(0.0)
        return self._option(way, traffic, driven_m).eta_s < self._option(other, traffic, driven_m).eta_s

    def alternatives(
        self, route: Sequence[str], fixed: int, driven_m: float, age_s: float = 0.0, via: Sequence[str] = ()
    ) -> tuple[RouteOption, ...]:
        """The present route and up to ``MOST`` others, the quickest first.

        Args:
            route: edges of the ego's route from the present one.
            fixed: how many of them can no longer be changed.
            driven_m: distance driven on the first edge.
            age_s: age of the news, at most ``contracts.OLDEST_NEWS_S``.
            via: edges that every other route passes too, in their order."""
        traffic = self._traffic(age_s)
        network, weights = self._network, dict(traffic.edges_s)
        found = tuple(route)
        taken = [found]
        for _ in range(TRIES):
            for edge_id in found:
                weights[edge_id] = PENALTY * weights.get(edge_id, self._free_s[edge_id])
            self._put(weights)
            _, way = self._route(route[fixed - 1], route[-1], via)
            if not way or len(taken) > MOST:
                break
            found = (*route[: fixed - 1], *way)
            if all(_shared(found, other, network) <= SAME_AT_MOST for other in taken):
                taken.append(found)
        options = [self._option(edges, traffic, driven_m) for edges in taken]
        quick_s = LONGEST * min(option.eta_s for option in options)
        others = sorted((each for each in options[1:] if each.eta_s <= quick_s), key=lambda option: option.eta_s)
        return (options[0], *others)

    def _follow_limits(self) -> None:
        for edge_id, edge in self._network.edges.items():
            if edge.speed_mps != self._limits_mps.get(edge_id):
                self._limits_mps[edge_id] = edge.speed_mps
                wait_s = SIGNAL_WAIT_S if edge_id in self._signalled else 0.0
                self._free_s[edge_id] = edge.length_m / edge.speed_mps + wait_s
                self._write({edge_id: self._free_s[edge_id]})

    def _traffic(self, age_s: float) -> _Traffic:
        self._follow_limits()
        lanes = self._congestion.window(age_s)
        edges: dict[str, Tally] = {}
        for lane_id, seen in lanes.items():
            edge_id = lane_id.rpartition("_")[0]
            edges[edge_id] = _sum((edges.get(edge_id, NOTHING), seen))
        seen_s = {edge_id: self._seen_s(edge_id, seen) for edge_id, seen in edges.items()}
        return _Traffic(lanes, {edge_id: time_s for edge_id, time_s in seen_s.items() if time_s is not None})

    def _seen_s(self, edge_id: str, seen: Tally) -> float | None:
        """Travel time of an edge by what was seen on it; None if that was too little."""
        count, total_mps = seen
        if count < SEEN_AT_LEAST:
            return None
        edge = self._network.edges[edge_id]
        return edge.length_m / max(SLOWEST_MPS, min(edge.speed_mps, total_mps / count))

    def _edge_s(self, edge_id: str, lanes: Iterable[str], traffic: _Traffic) -> float:
        """Travel time of an edge on the quickest of these lanes of it."""
        times_s = (self._seen_s(edge_id, traffic.lanes.get(lane_id, NOTHING)) for lane_id in lanes)
        return min(self._free_s[edge_id] if time_s is None else time_s for time_s in times_s)

    def _lanes(self, edges: Sequence[str]) -> list[Collection[str]]:
        """The lanes of each edge of a route that lead on along it, as far as can be without a change of lanes."""
        found: list[Collection[str]] = [self._network.edges[edges[-1]].lane_ids]
        for here, there in reversed(tuple(pairwise(edges))):
            way = self._network.crossings.get(here, {}).get(there)
            links = way.between(here, there) if way else []
            onward = {lane_id for lane_id, to_lane_id in links if to_lane_id in found[-1]}
            found.append(onward or {lane_id for lane_id, _ in links} or self._network.edges[here].lane_ids)
        return found[::-1]

    def _option(self, edges: Sequence[str], traffic: _Traffic, driven_m: float) -> RouteOption:
        """A route without the driven part of its first edge."""
        network = self._network
        edges_s = {
            edge_id: self._edge_s(edge_id, lanes, traffic)
            for edge_id, lanes in zip(edges, self._lanes(edges), strict=True)
        }
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
        written_s = self._written_s
        for edge_id, seconds in edges_s.items():
            if written_s.get(edge_id) != seconds:
                written_s[edge_id] = seconds
                self._sumo.adapt_travel_time(edge_id, seconds, NEVER_S, 2 * NEVER_S)

    def _route(self, start: str, goal: str, via: Sequence[str]) -> tuple[float, tuple[str, ...]]:
        """Travel time and edges of the quickest route by the weights; no edges if there is none."""
        time_s, edges = 0.0, (start,)
        for here, there in pairwise((start, *via, goal)):
            try:
                found = self._sumo.find_route(here, there, self._type, NEVER_S)
            except self._sumo.refusals:  # a rerouter of the scenario's keeps cars out of that road now
                return 0.0, ()
            if not found.edges:
                return 0.0, ()
            time_s, edges = time_s + found.travelTime, (*edges, *found.edges[1:])
        return time_s, edges


def _sum(seen: Iterable[Tally]) -> Tally:
    rows = tuple(seen)
    return sum(count for count, _ in rows), sum(total_mps for _, total_mps in rows)


def _shared(way: Sequence[str], other: Sequence[str], network: Network) -> float:
    """Share of a route's length that is also part of another."""
    on_other = frozenset(other)
    length_m = sum(network.edges[edge].length_m for edge in way)
    return sum(network.edges[edge].length_m for edge in way if edge in on_other) / length_m
