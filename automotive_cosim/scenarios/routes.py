"""The ego's route: between places that the user names, or drawn by seed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from difflib import get_close_matches
from itertools import pairwise

import numpy as np

from automotive_cosim.contracts import lon_lat
from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.scenario import Trip
from automotive_cosim.traffic.georeference import GeoReference
from automotive_cosim.traffic.network import Network
from automotive_cosim.traffic.ways import NEAREST, ways_from

TRIPS = 6
"""How many routes are drawn, so that a task's situation arises on one of them."""

STARTS = 16
"""How many start edges to draw routes from."""

LONG_M = 3000.0
"""A drawn route is at least this long, or at least half as long as the longest one found."""

ROOM_M = 20.0
"""Preferred minimum length of a route's first and last edge: room to start and to stop."""

NEAR_M = 300.0
"""A position farther than this from every road is refused."""

STREET_EDGES = 12
"""How many edges of a street to try; long streets have hundreds."""


def chosen_trips(network: Network, from_place: str, to_place: str) -> tuple[Trip, ...]:
    """The route between two places; several drawn ones if only one place is given.

    Args:
        from_place: an edge, a street or ``LON,LAT``; empty for any.
        to_place: an edge, a street or ``LON,LAT``; empty for any.

    Raises ScenarioError: a place is not on this network, or no route leads from the one to the other."""
    starts = edges_at(network, from_place) if from_place else ()
    goals = edges_at(network, to_place) if to_place else ()
    if not (starts and goals):
        return drawn_trips(network.open_at_all_hours(), starts, goals)
    found = [(start, ways_from(network, start).length_m) for start in starts]
    ways = [
        (way_m[goal], start, goal) for start, way_m in found for goal in goals if goal in way_m and goal != start
    ]
    if not ways:
        raise ScenarioError(
            f"no route for a car leads from {from_place!r} to {to_place!r}; name other streets or edges"
        )
    return (_trip(network, "chosen", *min(ways)),)


def drawn_trips(network: Network, starts: Sequence[str] = (), goals: Sequence[str] = ()) -> tuple[Trip, ...]:
    """Routes that are long for this network, from different edges to different edges.

    Args:
        starts: edges to begin on; any if empty.
        goals: edges to end on; any if empty.

    Raises ScenarioError: no two edges are connected."""
    rng = np.random.default_rng(0)
    roomy = [edge.edge_id for edge in network.edges.values() if edge.length_m >= ROOM_M] or list(network.edges)
    begins = list(starts) or [roomy[int(index)] for index in rng.permutation(len(roomy))[:STARTS]]
    ends = frozenset(goals or roomy)
    found: list[tuple[float, str, str]] = []
    for begin in begins:
        ways = sorted(
            (way_m, begin, goal)
            for goal, way_m in ways_from(network, begin, None if goals else NEAREST).length_m.items()
            if goal in ends and goal != begin
        )
        long = [way for way in ways if way[0] >= min(LONG_M, 0.5 * ways[-1][0])]
        found += [long[int(index)] for index in rng.permutation(len(long))[:TRIPS]]
    if not found:
        raise ScenarioError("no route for a car leads from one road of this network to another; name other roads")
    least_m = min(LONG_M, 0.5 * max(found)[0])
    order = [found[int(index)] for index in rng.permutation(len(found)) if found[int(index)][0] >= least_m]
    return tuple(_trip(network, f"drawn-{number}", *way) for number, way in enumerate(_spread(order), 1))


def _spread(ways: Sequence[tuple[float, str, str]]) -> list[tuple[float, str, str]]:
    """The first routes, preferring those with different starts."""
    first = {way[1]: way for way in reversed(ways)}
    return sorted(ways, key=lambda way: first[way[1]] is not way)[:TRIPS]


def _trip(network: Network, name: str, way_m: float, start: str, goal: str) -> Trip:
    about = f"{way_m / 1000:.1f} km from {_named(network, start)} to {_named(network, goal)}"
    return Trip(name, start, goal, about=about)


def edges_at(network: Network, place: str) -> tuple[str, ...]:
    """The edges that a text may mean: an edge's id, a street's name, or ``LON,LAT``.

    Raises ScenarioError: it is none of them, or a position that is not on this network."""
    if place in network.edges:
        return (place,)
    try:
        position = lon_lat(place)
    except ValueError as error:
        raise ScenarioError(str(error)) from error
    if position is not None:
        return (_nearest(network, position),)
    named = [edge for edge in network.edges.values() if edge.name.casefold() == place.casefold()]
    if not named:
        raise ScenarioError(_unknown(network, place))
    step = max(1, len(named) // STREET_EDGES)
    return tuple(edge.edge_id for edge in named[::step])


def _nearest(network: Network, position: tuple[float, float]) -> str:
    if network.map.projection is None:
        raise ScenarioError(
            f"this network {network.unplaced}, so {position[0]:g},{position[1]:g} has no place in it; "
            "name an edge or a street"
        )
    here = GeoReference(network.map).x_y(*position)
    away_m, nearest = min((_distance_m(here, edge.shape_m), edge.edge_id) for edge in network.edges.values())
    if not away_m <= NEAR_M:
        raise ScenarioError(
            f"{position[0]:g},{position[1]:g} (longitude, latitude) is {away_m / 1000:.1f} km from the nearest "
            "road of this network; give a place on one"
        )
    return nearest


def _distance_m(point: tuple[float, float], shape_m: Sequence[tuple[float, float]]) -> float:
    best = math.inf
    for (ax, ay), (bx, by) in pairwise(shape_m):
        along = (bx - ax) ** 2 + (by - ay) ** 2
        share = ((point[0] - ax) * (bx - ax) + (point[1] - ay) * (by - ay)) / along if along else 0.0
        share = max(0.0, min(1.0, share))
        best = min(best, math.dist(point, (ax + share * (bx - ax), ay + share * (by - ay))))
    return best


def _unknown(network: Network, place: str) -> str:
    known = {edge.name.casefold(): edge.name for edge in network.edges.values() if edge.name}
    known |= {edge_id.casefold(): edge_id for edge_id in network.edges}
    close = get_close_matches(place.casefold(), known, n=1, cutoff=0.5)
    fix = f"did you mean {known[close[0]]!r}?" if close else "give a street's name, an edge's id or LON,LAT"
    return f"this network has no street or edge {place!r} that cars may use: {fix}"


def _named(network: Network, edge_id: str) -> str:
    return network.edges[edge_id].name or f"edge {edge_id}"
