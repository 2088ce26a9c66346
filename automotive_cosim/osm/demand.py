"""Traffic for a network without counts: random trips, weighted by the capacity of the roads.

SUMO's randomTrips is similar; this one draws from a numpy generator, lets half of the traffic come from outside the
map, as on a crop of a city, and knows which limits were only assumed.
"""

from __future__ import annotations

import gzip
import math
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree
from xml.sax.saxutils import quoteattr

import numpy as np
import numpy.typing as npt

from automotive_cosim.errors import UserError
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.osm.network import Built, entries, exits
from automotive_cosim.traffic.network import Edge, Network
from automotive_cosim.traffic.sumo_programs import first_error, run

OUTSIDE_SHARE = 0.5
"""Share of trips that begin beyond the map's edge, and share of those that end there."""

MIN_TRIP_M = 500.0
"""Straight distance that a trip should cover; a fifth of the diagonal on a small map."""

CAR = '<vType id="car" vClass="passenger" lcStrategic="50"/>'
"""The vehicles. They choose their lane far earlier than SUMO's default; otherwise the short lanes of large
roundabouts fill up with cars side by side that each need the other's lane."""

ROUNDS = 20
"""How often to redraw trips that are too short."""

PARTS = 100
"""So many edges are asked for the part of the network around them, at most; most are in the largest."""

SAMPLES = 500
"""Number of trips that suffices to estimate the mean travel time, and among which the ego's are picked."""


@dataclass(frozen=True, slots=True)
class Journey:
    """A trip that can be driven; SUMO finds its route when it departs."""

    depart_s: float
    start: Edge
    goal: Edge


@dataclass(frozen=True, slots=True)
class DrawnRoute:
    """The fastest route of a trip on empty roads."""

    way: tuple[Edge, ...]

    @property
    def length_m(self) -> float:
        return sum(edge.length_m for edge in self.way)


@dataclass(frozen=True, slots=True)
class Demand:
    """Traffic for a network."""

    journeys: tuple[Journey, ...]
    """In order of departure."""
    routes: tuple[DrawnRoute, ...]
    """Those of a sample of such trips."""


def draw(
    built: Built,
    net_file: Path,
    *,
    scratch: Path,
    density_per_km: float,
    duration_s: float,
    rng: np.random.Generator,
) -> Demand:
    """Draws trips between roads of which each can be reached from the other.

    Args:
        density_per_km: vehicles per kilometre of lane at a time if all drove freely. Unlike the number of
            departures, this measures how full a network is, whatever its size.
        duration_s: departures are spread evenly over this.

    Raises UserError: the requested traffic is less than one vehicle, or no trip can be driven."""
    ends = _Ends(built)
    sample = [(built.edges[start], built.edges[goal]) for start, goal in ends.pairs(SAMPLES, rng).tolist()]
    routes = tuple(DrawnRoute(way) for way in fastest_ways(sample, built.network, net_file, scratch) if way)
    if not routes:
        raise UserError("no two roads of this map are connected; give a larger extract")
    travel_time_s = float(np.mean([sum(edge.length_m / edge.speed_mps for edge in route.way) for route in routes]))
    lane_km = sum(edge.length_m * len(edge.lane_ids) for edge in built.edges) / 1000
    count = round(density_per_km * lane_km * duration_s / travel_time_s)
    if not count:
        raise UserError(
            f"{density_per_km:g} vehicles per km on {lane_km:.1f} km make less than one; raise --density"
        )
    pairs = ends.pairs(count, rng).tolist()
    departs = np.sort(rng.uniform(0.0, duration_s, len(pairs))).tolist()
    journeys = tuple(
        Journey(depart_s, built.edges[start], built.edges[goal])
        for depart_s, (start, goal) in zip(departs, pairs, strict=True)
    )
    return Demand(journeys, routes)


def write(journeys: Sequence[Journey], target: Path) -> None:
    """Writes the traffic as SUMO trips (gzip); SUMO routes each by the travel times when it departs."""
    rows = (
        f'    <trip id="{number}" type="car" depart="{journey.depart_s:.2f}" departLane="best" departSpeed="max"'
        f" {_ends(journey.start, journey.goal)}/>"
        for number, journey in enumerate(journeys)
    )
    text = "\n".join(("<routes>", f"    {CAR}", *rows, "</routes>", ""))
    write_whole(target, gzip.compress(text.encode(), compresslevel=9, mtime=0))


def _ends(start: Edge, goal: Edge) -> str:
    return f"from={quoteattr(start.edge_id)} to={quoteattr(goal.edge_id)}"


class _Ends:
    """The edges on which trips start and end, with their weights."""

    def __init__(self, built: Built) -> None:
        edges = built.edges
        from_here, to_here = connected(built)
        self._count = len(edges)
        self._starts = _weights(edges, entries(edges), to_here)
        self._goals = _weights(edges, exits(edges), from_here)
        self._middles = np.array([edge.shape_m[len(edge.shape_m) // 2] for edge in edges])
        self._least_m = min(MIN_TRIP_M, 0.2 * float(np.hypot(*np.ptp(self._middles, axis=0))))

    def pairs(self, count: int, rng: np.random.Generator) -> npt.NDArray[np.int64]:
        """Start and goal of each trip as indices of edges, (n, 2); n is less than count on a map too small."""
        found = np.empty((0, 2), dtype=np.int64)
        for _ in range(ROUNDS):
            short = count - len(found)
            starts = rng.choice(self._count, short, p=self._starts)
            goals = rng.choice(self._count, short, p=self._goals)
            far = np.hypot(*(self._middles[goals] - self._middles[starts]).T) >= self._least_m
            found = np.concatenate((found, np.column_stack((starts, goals))[far & (starts != goals)]))
            if len(found) == count:
                break
        return found


def connected(built: Built) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """The edges that can be reached from the largest part of the network within which every edge reaches every
    other, and those from which that part can be reached. So each of the latter reaches each of the former."""
    index = {edge.edge_id: number for number, edge in enumerate(built.edges)}
    ahead: list[list[int]] = [[] for _ in built.edges]
    behind: list[list[int]] = [[] for _ in built.edges]
    for edge_id, onward in built.network.open_at_all_hours().crossings.items():
        for to_edge in onward:
            ahead[index[edge_id]].append(index[to_edge])
            behind[index[to_edge]].append(index[edge_id])
    left = np.ones(len(built.edges), dtype=np.bool_)
    best = left, left
    size = 0
    for middle in range(0, len(left), math.ceil(len(left) / PARTS)):
        if size >= left.sum():
            break
        if not left[middle]:
            continue
        found = _reached(middle, ahead), _reached(middle, behind)
        part = found[0] & found[1]
        if part.sum() > size:
            best, size = found, int(part.sum())
        left = left & ~part
    return best


def _reached(start: int, onward: Sequence[Sequence[int]]) -> npt.NDArray[np.bool_]:
    seen = np.zeros(len(onward), dtype=np.bool_)
    seen[start] = True
    waiting = [start]
    while waiting:
        for following in onward[waiting.pop()]:
            if not seen[following]:
                seen[following] = True
                waiting.append(following)
    return seen


def _weights(
    edges: Sequence[Edge], fringe: frozenset[str], usable: npt.NDArray[np.bool_]
) -> npt.NDArray[np.float64]:
    """Probability of each edge to be one end of a trip: inside the map by length and lanes, at its edge by the
    capacity of the road, taken as lanes times the square of the speed."""
    inside = np.array([edge.length_m * len(edge.lane_ids) for edge in edges]) * usable
    outside = (
        np.array([len(edge.lane_ids) * edge.speed_mps**2 * (edge.edge_id in fringe) for edge in edges]) * usable
    )
    weights = inside / inside.sum()
    if outside.any():
        weights = (1 - OUTSIDE_SHARE) * weights + OUTSIDE_SHARE * outside / outside.sum()
    return np.asarray(weights, dtype=np.float64)


def fastest_ways(
    ends: Sequence[tuple[Edge, Edge]], network: Network, net_file: Path, scratch: Path
) -> list[tuple[Edge, ...]]:
    """The fastest route on empty roads for each start and end, by SUMO's duarouter; empty if there is none.

    Args:
        ends: first and last edge of each route.

    Raises UserError: duarouter refuses the network."""
    asked, routed = scratch / "asked.trips.xml", scratch / "routed.rou.xml"
    rows = (f'<trip id="{number}" depart="0" {_ends(*pair)}/>' for number, pair in enumerate(ends))
    write_whole(asked, "\n".join(("<routes>", *rows, "</routes>")))
    ok, printed = run(
        "duarouter",
        (
            f"--net-file={os.path.relpath(net_file, scratch)}",
            f"--route-files={asked.name}",
            f"--output-file={routed.name}",
            "--ignore-errors",
            "--no-warnings",
            "--no-step-log",
            "--routing-algorithm=astar",
        ),
        folder=scratch,
    )
    if not ok:
        raise UserError(f"SUMO's duarouter cannot route on this map: {first_error(printed)}")
    found = dict(_read_ways(routed, network))
    return [found.get(number, ()) for number in range(len(ends))]


def _read_ways(file: Path, network: Network) -> Iterator[tuple[int, tuple[Edge, ...]]]:
    for _, element in ElementTree.iterparse(file):
        if element.tag == "vehicle":
            route = element.find("route")
            if route is not None:
                yield (
                    int(element.get("id", "")),
                    tuple(network.edges[edge] for edge in route.get("edges", "").split()),
                )
            element.clear()
