"""Ego trips for an imported scenario, picked from the traffic's own journeys, which are known to be drivable."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from itertools import chain, count

import numpy as np

from automotive_cosim.osm.demand import Journey
from automotive_cosim.scenarios import Trip

TRIPS = 4
LONG_SHARE = 0.2
"""Trips are picked from this share of the journeys, the longest ones."""

MIN_END_M = 20.0
"""Preferred minimum length of a trip's first and last edge: room to start and to stop."""


def pick(journeys: Sequence[Journey], rng: np.random.Generator) -> tuple[Trip, ...]:
    """Up to four long journeys that share as few roads as possible, one of them through a tunnel if possible."""
    roomy = [journey for journey in journeys if min(journey.way[end].length_m for end in (0, -1)) >= MIN_END_M]
    by_length = sorted(roomy or journeys, key=lambda journey: -journey.length_m)
    long = by_length[: max(TRIPS, round(LONG_SHARE * len(by_length)))]
    order = [long[index] for index in rng.permutation(len(long))]
    tunnels = [journey for journey in order if any(edge.in_tunnel for edge in journey.way)]
    chosen = (tunnels or order)[:1]
    while len(chosen) < min(TRIPS, len(order)):
        used = {edge.edge_id for journey in chosen for edge in journey.way}
        rest = [journey for journey in order if journey not in chosen]
        chosen.append(min(rest, key=lambda journey: _shared(journey, used)))
    trips: list[Trip] = []
    for journey in chosen:
        trips.append(_trip(journey, [trip.name for trip in trips]))
    return tuple(trips)


def _shared(journey: Journey, used: set[str]) -> float:
    return sum(edge.length_m for edge in journey.way if edge.edge_id in used) / journey.length_m


def slug(text: str) -> str:
    """Lower case, words joined by hyphens: in ASCII, or in the script of a name that has no Latin letters."""
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode().lower()
    latin = re.sub(r"[^a-z0-9]+", "-", plain).strip("-")
    if re.search("[a-z]", latin) or not re.search(r"[^\W\d_]", text):
        return latin
    return re.sub(r"[\W_]+", "-", unicodedata.normalize("NFKC", text).lower()).strip("-")


def _trip(journey: Journey, taken: Sequence[str]) -> Trip:
    names = [edge.name for edge in journey.way if edge.name] or ["unnamed road"]
    ends = slug(names[0]) or "start", slug(names[-1]) or "goal"
    plain = f"along-{ends[0]}" if ends[0] == ends[1] else "-to-".join(ends)
    others = (f"{plain}-{number}" for number in count(2))
    name = next(name for name in chain([plain], others) if name not in taken)
    about = f"{journey.length_m / 1000:.1f} km from {names[0]} to {names[-1]}"
    tunnel_m = sum(edge.length_m for edge in journey.way if edge.in_tunnel)
    if tunnel_m:
        about += f", {tunnel_m:.0f} m of it in tunnels"
    return Trip(name, journey.way[0].edge_id, journey.way[-1].edge_id, about=about)
