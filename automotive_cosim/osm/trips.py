"""Ego trips for an imported scenario, picked from the routes of its traffic."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from itertools import chain, count

import numpy as np

from automotive_cosim.osm.demand import DrawnRoute
from automotive_cosim.scenarios import Trip

TRIPS = 4
LONG_SHARE = 0.2
"""Trips are picked from this share of the routes, the longest ones."""

MIN_END_M = 20.0
"""Preferred minimum length of a trip's first and last edge: room to start and to stop."""


def pick(routes: Sequence[DrawnRoute], rng: np.random.Generator) -> tuple[Trip, ...]:
    """Up to four long routes that share as few roads as possible, one of them through a tunnel if possible."""
    different = list(dict.fromkeys(routes))
    roomy = [route for route in different if min(route.way[end].length_m for end in (0, -1)) >= MIN_END_M]
    by_length = sorted(roomy or different, key=lambda route: -route.length_m)
    long = by_length[: max(TRIPS, round(LONG_SHARE * len(by_length)))]
    order = [long[index] for index in rng.permutation(len(long))]
    tunnels = [route for route in order if any(edge.in_tunnel for edge in route.way)]
    chosen = (tunnels or order)[:1]
    while len(chosen) < min(TRIPS, len(order)):
        used = {edge.edge_id for route in chosen for edge in route.way}
        rest = [route for route in order if route not in chosen]
        chosen.append(min(rest, key=lambda route: _shared(route, used)))
    trips: list[Trip] = []
    for route in chosen:
        trips.append(_trip(route, [trip.name for trip in trips]))
    return tuple(trips)


def _shared(route: DrawnRoute, used: set[str]) -> float:
    return sum(edge.length_m for edge in route.way if edge.edge_id in used) / route.length_m


def slug(text: str) -> str:
    """Lower case, words joined by hyphens; letters of every script stay as they are."""
    return re.sub(r"[\W_]+", "-", unicodedata.normalize("NFKC", text).lower()).strip("-")


def _trip(route: DrawnRoute, taken: Sequence[str]) -> Trip:
    names = [edge.name for edge in route.way if edge.name] or ["unnamed road"]
    ends = slug(names[0]) or "start", slug(names[-1]) or "goal"
    plain = f"along-{ends[0]}" if ends[0] == ends[1] else "-to-".join(ends)
    others = (f"{plain}-{number}" for number in count(2))
    name = next(name for name in chain([plain], others) if name not in taken)
    about = f"{route.length_m / 1000:.1f} km from {names[0]} to {names[-1]}"
    tunnel_m = sum(edge.length_m for edge in route.way if edge.in_tunnel)
    if tunnel_m:
        about += f", {tunnel_m:.0f} m of it in tunnels"
    return Trip(name, route.way[0].edge_id, route.way[-1].edge_id, about=about)
