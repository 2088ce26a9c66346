"""Traffic flow: smoothed speed per edge, and the resulting figures of the route ahead.

Speeds are weighted by vehicles and smoothed over about a signal cycle: a red light is not a jam, and an empty edge
is free. They count as a share of the limit in force, lane by lane: a lower limit is no jam, and traffic that was
held back by a lower limit is not slow once that has ended. Who wants to drive slower than the limit, or cannot go
as fast, counts as a share of that speed where there is a lane to pass. The route's sums are recomputed with each
sample; evaluating them at a position costs a few additions.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, pairwise
from types import MappingProxyType
from typing import Protocol, TypeAlias

from automotive_cosim.contracts import OLDEST_NEWS_S, IncidentKind, Limit, RoadAhead, RoadIncident
from automotive_cosim.traffic.network import Crossing, Edge, Network
from automotive_cosim.traffic.sumo import THE_LIMIT, DesiredSpeed
from automotive_cosim.traffic.wire import Packed, pack_limit, unpack_ahead

SAMPLE_PERIOD_S = 10.0
"""Time between samples of all edges."""

MEMORY_S = 90.0
"""Time constant of the smoothing: a fixed-time signal's cycle lasts 60 to 120 s (HCM, chapter on signals)."""

WINDOW_S = 300.0
SEEN_AT_LEAST = 3
"""Travel times for route choice are means over this time, if at least this many vehicles were seen."""

FREE_WEIGHT = 0.1
"""Weight of free flow, in vehicles, in an edge's mean speed, so that an empty one is free."""

FORGOTTEN = 1e-6
"""Smoothed number of vehicles below which an edge is empty."""

JAM_BELOW = 0.25
"""Relative speed below which an edge is jammed."""

SLOW_BELOW = 0.75
"""Relative speed below which an edge is reported to a map."""

SLOWEST_MPS = 0.5
"""Minimum speed, so that travel times stay finite."""

STANDS = frozenset({IncidentKind.BREAKDOWN, IncidentKind.ROADWORKS})
"""Incidents that drivers pass slowly."""

MOTORWAY_CLASSES = frozenset({"motorway", "trunk"})
"""Road classes with exits."""


Tally: TypeAlias = tuple[int, float]
"""Number of vehicles in all samples, and the sum of their speeds in m/s."""

NOTHING: Tally = (0, 0.0)


@dataclass(frozen=True, slots=True)
class Free:
    """What a drive without traffic is like."""

    top_mps: float
    """How fast the ego drives at most."""
    across: Mapping[str, tuple[str, float]]
    """The edge before each lane through a junction, and the speed of that lane in m/s."""


NO_JUNCTIONS = Free(math.inf, MappingProxyType({}))


class Flow(Protocol):
    """Gives the speeds of the traffic."""

    def speed_mps(self, edge_id: str) -> float:
        """Mean speed on an edge, never 0."""
        ...

    def free_mps(self, edge_id: str) -> float:
        """The speed on an edge without traffic."""
        ...

    def slow_edges(self) -> tuple[tuple[str, float], ...]:
        """Edges with traffic slower than ``SLOW_BELOW`` of their limit, and their relative speed."""
        ...


class Congestion:
    """Smoothed speed of every edge."""

    def __init__(
        self,
        network: Network,
        vehicles: Callable[[], Iterable[tuple[str, float, DesiredSpeed]]],
        free: Free = NO_JUNCTIONS,
    ) -> None:
        """Starts at free flow.

        Args:
            vehicles: the lane, inside a junction or not, the speed in m/s and the wanted speed of each vehicle that
                drives as cars do; those on lanes that are closed to cars are left out here.
            free: what a drive without traffic is like."""
        self._edges = network.edges
        self._order = {edge_id: number for number, edge_id in enumerate(network.edges)}
        self._driving = vehicles
        self._free = free
        self._vehicles: dict[str, float] = {}
        """Smoothed number of vehicles and sum of speeds, for each edge with recent traffic."""
        self._flow: dict[str, float] = {}
        self._free_mps: dict[str, float] = {}
        """The speed without traffic to which that refers."""
        self._keep = math.exp(-SAMPLE_PERIOD_S / MEMORY_S)
        self._slow: tuple[tuple[str, float], ...] = ()
        self._samples: deque[dict[str, Tally]] = deque(maxlen=round((WINDOW_S + OLDEST_NEWS_S) / SAMPLE_PERIOD_S))

    def sample(self) -> None:
        """Takes the present speeds into account; called every ``SAMPLE_PERIOD_S``."""
        keep, vehicles, flow, edges = self._keep, self._vehicles, self._flow, self._edges
        lanes: dict[str, Tally] = {}
        seen: dict[str, Tally] = {}
        across = self._free.across
        for lane_id, speed_mps, wanted in self._driving():
            edge_id = lane_id.rpartition("_")[0]
            edge = edges.get(edge_id)
            if edge is not None and lane_id in edge.lane_ids:
                speed_mps = self._rated_mps(edge_id, speed_mps, edge.lane_mps[edge.lane_ids.index(lane_id)], wanted)
                count, total_mps = lanes.get(lane_id, NOTHING)
                lanes[lane_id] = (count + 1, total_mps + speed_mps)
            elif lane_id in across:
                edge_id, limit_mps = across[lane_id]
                speed_mps = self._rated_mps(edge_id, speed_mps, limit_mps, wanted)
            else:
                continue
            count, total_mps = seen.get(edge_id, NOTHING)
            seen[edge_id] = (count + 1, total_mps + speed_mps)
        slow: list[tuple[str, float]] = []
        for edge_id in {**vehicles, **seen}:
            count, total_mps = seen.get(edge_id, NOTHING)
            free_mps = self.free_mps(edge_id)
            if free_mps != self._free_mps.setdefault(edge_id, free_mps):
                self._take_limit(edge_id, free_mps)
            weight = vehicles[edge_id] = vehicles.get(edge_id, 0.0) * keep + count * (1 - keep)
            flow[edge_id] = flow.get(edge_id, 0.0) * keep + total_mps * (1 - keep)
            if flow[edge_id] + FREE_WEIGHT * free_mps < SLOW_BELOW * (weight + FREE_WEIGHT) * free_mps:
                slow.append((edge_id, round(self.relative_speed(edge_id), 2)))
            if weight < FORGOTTEN:
                del vehicles[edge_id], flow[edge_id]
        self._samples.append(lanes)
        self._slow = tuple(sorted(slow, key=lambda row: self._order[row[0]]))

    def _rated_mps(self, edge_id: str, speed_mps: float, limit_mps: float, wanted: DesiredSpeed) -> float:
        """What a speed on a lane is on the edge's fastest lane, for somebody who wants to drive at the limit."""
        can_pass = len(self._edges[edge_id].lane_ids) > 1
        factor, top_mps = wanted if can_pass else THE_LIMIT
        share = speed_mps / min(factor * limit_mps, top_mps, self._free.top_mps)
        return min(1.0, share) * self.free_mps(edge_id)

    def _take_limit(self, edge_id: str, limit_mps: float) -> None:
        """Rates what was driven on an edge by a higher limit, as if it had been in force."""
        ratio = limit_mps / self._free_mps[edge_id]
        self._free_mps[edge_id] = limit_mps
        if ratio < 1:  # who drove faster than the new limit was free
            return
        self._flow[edge_id] = self._flow.get(edge_id, 0.0) * ratio
        for rows in self._samples:
            for lane_id in self._edges[edge_id].lane_ids:
                if lane_id in rows:
                    count, total_mps = rows[lane_id]
                    rows[lane_id] = count, total_mps * ratio

    def window(self, age_s: float = 0.0) -> dict[str, Tally]:
        """What was seen in ``WINDOW_S`` on each lane with any traffic.

        Args:
            age_s: how long ago that time ended, at most ``OLDEST_NEWS_S``."""
        sums: dict[str, Tally] = {}
        newest, count = round(age_s / SAMPLE_PERIOD_S), round(WINDOW_S / SAMPLE_PERIOD_S)
        for lanes in islice(reversed(self._samples), newest, newest + count):
            for lane_id, (vehicles, total_mps) in lanes.items():
                before = sums.get(lane_id, NOTHING)
                sums[lane_id] = (before[0] + vehicles, before[1] + total_mps)
        return sums

    def free_mps(self, edge_id: str) -> float:
        """The speed on an edge without traffic."""
        return min(self._free.top_mps, self._edges[edge_id].speed_mps)

    def speed_mps(self, edge_id: str) -> float:
        """Mean speed on an edge."""
        now_mps = self.free_mps(edge_id)
        free_mps = min(now_mps, self._free_mps.get(edge_id, now_mps))
        vehicles, flow_mps = self._vehicles.get(edge_id, 0.0), self._flow.get(edge_id, 0.0)
        driven_mps = min(free_mps, (flow_mps + FREE_WEIGHT * free_mps) / (vehicles + FREE_WEIGHT))
        return max(SLOWEST_MPS, driven_mps if free_mps == now_mps else driven_mps * now_mps / free_mps)

    def relative_speed(self, edge_id: str) -> float:
        """Mean speed divided by the edge's limit; 1 is free flow."""
        return self.speed_mps(edge_id) / self.free_mps(edge_id)

    def slow_edges(self) -> tuple[tuple[str, float], ...]:
        """See ``Flow``; to a hundredth, in the network's order, as of the last sample."""
        return self._slow


@dataclass(frozen=True, slots=True)
class _Leg:
    """One edge of the route, with sums over the rest of the route."""

    edge: Edge
    start_m: float
    """From the start of the route."""
    speed_mps: float
    free_mps: float
    relative_speed: float
    time_after_s: float
    """Travel time from its end to the destination at present speeds; the next is at the limits."""
    free_after_s: float
    next_limit: tuple[Limit, float] | None
    """The next different limit and its position."""
    tunnel_m: float | None
    """Where the next tunnel starts after this edge."""
    jam: tuple[float, float] | None
    """Where the next jam starts and ends, from this edge on."""
    exit_m: float | None
    """Position of the next exit of its motorway."""


class Route:
    """A route, with the sums that ``RoadAhead`` needs."""

    def __init__(
        self, edge_ids: Sequence[str], network: Network, flow: Flow, incidents: tuple[RoadIncident, ...] = ()
    ) -> None:
        """Prepares the sums from the present flow; the incidents are passed on."""
        self.edge_ids = tuple(edge_ids)
        edges = [network.edges[edge_id] for edge_id in edge_ids]
        ways = [
            network.crossings.get(here.edge_id, {}).get(there.edge_id, Crossing(0.0, here.speed_mps))
            for here, there in pairwise(edges)
        ]
        starts_m = [0.0]
        for edge, way in zip(edges, ways, strict=False):
            starts_m.append(starts_m[-1] + edge.length_m + way.length_m)
        self.length_m = starts_m[-1] + edges[-1].length_m
        self.bends = tuple(
            (start_m, way.speed_mps) for start_m, way in zip(starts_m[1:], ways, strict=True) if not way.is_straight
        )
        """The end of each turn, and the speed that it allows."""
        self._cameras_m = sorted(
            start_m + place_m for start_m, edge in zip(starts_m, edges, strict=True) for place_m in edge.cameras_m
        )
        self._signs = [
            (start_m + edge.length_m, edge.sign) for start_m, edge in zip(starts_m, edges, strict=True) if edge.sign
        ]
        self._rest: dict[int, tuple[str, ...]] = {}
        """The edges from one on, the same ones as long as the car is on it."""
        self._slow = flow.slow_edges()
        self._incidents = incidents
        self._standing_m = sorted(
            start_m + incident.position_m
            for incident in incidents
            if incident.kind in STANDS
            for start_m, edge_id in zip(starts_m, self.edge_ids, strict=True)
            if edge_id == incident.edge_id
        )
        self._legs = _legs(edges, ways, starts_m, network, flow)

    def position_m(self, index: int, on_edge_m: float) -> float:
        """Distance from the start of the route."""
        return self._legs[index].start_m + on_edge_m

    def relative_speed(self, index: int) -> float:
        """Mean speed divided by the limit on an edge of the route; 1 is free flow."""
        return self._legs[index].relative_speed

    def standing_ahead_m(self, position_m: float) -> float | None:
        """Distance from a position on the route to the next breakdown or roadworks; None without one."""
        return _next_m(self._standing_m, position_m)

    def edge_at(self, position_m: float) -> tuple[int, float]:
        """Index of the edge at a distance from the start of the route, and the distance on that edge."""
        index = max(0, bisect_right(self._legs, position_m, key=lambda leg: leg.start_m) - 1)
        leg = self._legs[index]
        return index, max(0.0, min(position_m - leg.start_m, leg.edge.length_m))

    def ahead(self, index: int, position_m: float) -> RoadAhead:
        """The figures of the road ahead, without a light; see ``packed_ahead``."""
        return unpack_ahead(self.packed_ahead(index, position_m, None))

    def packed_ahead(self, index: int, position_m: float, next_light: Packed | None) -> Packed:
        """The figures of the road ahead, as ``wire.pack_state`` has them.

        Args:
            index: the edge of the route, or the last one before the junction that the car is in.
            position_m: from the start of the route.
            next_light: the fields of a ``TrafficLight``.
        """
        leg = self._legs[index]
        if index not in self._rest:
            self._rest[index] = self.edge_ids[index:]
        left_m = max(0.0, self.length_m - position_m)
        on_edge_m = max(0.0, leg.start_m + leg.edge.length_m - position_m)
        eta_s = on_edge_m / leg.speed_mps + leg.time_after_s
        free_s = on_edge_m / leg.free_mps + leg.free_after_s
        next_sign = bisect_right(self._signs, position_m, key=lambda each: each[0])
        sign_m, sign = self._signs[next_sign] if next_sign < len(self._signs) else (None, None)
        return (
            left_m,
            eta_s,
            max(0.0, eta_s - free_s),
            min(1.0, free_s / eta_s) if eta_s > 0 else leg.relative_speed,
            max(0.0, leg.jam[0] - position_m) if leg.jam else None,
            leg.jam[1] - max(leg.jam[0], position_m) if leg.jam else 0.0,
            next_light,
            pack_limit(leg.next_limit[0]) if leg.next_limit else None,
            max(0.0, leg.next_limit[1] - position_m) if leg.next_limit else None,
            0.0 if leg.edge.in_tunnel else None if leg.tunnel_m is None else max(0.0, leg.tunnel_m - position_m),
            None if leg.exit_m is None else max(0.0, leg.exit_m - position_m),
            self._rest[index],
            (),
            _next_m(self._cameras_m, position_m),
            self._slow,
            self._incidents,
            sign,
            None if sign_m is None else sign_m - position_m,
        )


def _next_m(places_m: Sequence[float], position_m: float) -> float | None:
    """Distance to the next of some places on the route, in order; None after the last."""
    index = bisect_right(places_m, position_m)
    return places_m[index] - position_m if index < len(places_m) else None


def _legs(
    edges: Sequence[Edge], ways: Sequence[Crossing], starts_m: Sequence[float], network: Network, flow: Flow
) -> tuple[_Leg, ...]:
    """Sums from the destination back to the start."""
    legs: list[_Leg] = []
    for index in range(len(edges) - 1, -1, -1):
        edge = edges[index]
        after = legs[-1] if legs else None
        way = ways[index] if after else Crossing(0.0, edge.speed_mps)
        way_s = way.length_m / max(SLOWEST_MPS, way.speed_mps)
        speed_mps, free_mps = flow.speed_mps(edge.edge_id), flow.free_mps(edge.edge_id)
        across_s = way_s / (speed_mps / free_mps)  # traffic is as slow across the junction at its end
        legs.append(
            _Leg(
                edge=edge,
                start_m=starts_m[index],
                speed_mps=speed_mps,
                free_mps=free_mps,
                relative_speed=speed_mps / free_mps,
                time_after_s=across_s + after.time_after_s + after.edge.length_m / after.speed_mps
                if after
                else 0.0,
                free_after_s=way_s + after.free_after_s + after.edge.length_m / after.free_mps if after else 0.0,
                next_limit=_next_limit(edge, after),
                tunnel_m=None if after is None else after.start_m if after.edge.in_tunnel else after.tunnel_m,
                jam=_jam(edge, starts_m[index], speed_mps / free_mps, after),
                exit_m=_exit(edge, starts_m[index], after, network),
            )
        )
    return tuple(reversed(legs))


def _next_limit(edge: Edge, after: _Leg | None) -> tuple[Limit, float] | None:
    if after is None:
        return None
    return (after.edge.limit, after.start_m) if after.edge.limit_mps != edge.limit_mps else after.next_limit


def _jam(edge: Edge, start_m: float, relative_speed: float, after: _Leg | None) -> tuple[float, float] | None:
    following = after.jam if after else None
    if relative_speed >= JAM_BELOW:
        return following
    goes_on = after is not None and following is not None and following[0] == after.start_m
    return (start_m, following[1] if goes_on and following else start_m + edge.length_m)


def _exit(edge: Edge, start_m: float, after: _Leg | None, network: Network) -> float | None:
    if edge.road_class not in MOTORWAY_CLASSES:
        return None
    leaves = after is None or after.edge.road_class not in MOTORWAY_CLASSES
    if leaves or len(network.crossings.get(edge.edge_id, {})) > 1:
        return start_m + edge.length_m
    return after.exit_m if after else None
