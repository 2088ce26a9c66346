"""Light traffic for a network without any: flows between random edges, by seed.

Their routes are written out: SUMO would search the whole network again for every vehicle.
"""

from __future__ import annotations

from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from automotive_cosim.formats.writing import write_whole
from automotive_cosim.traffic.network import Network
from automotive_cosim.traffic.ways import NEAREST, ways_from

STARTS, GOALS = 24, 5
"""Number of start edges of flows, and of end edges for each."""

MOST_PER_HOUR = 3600.0
"""Limit of vehicles per hour, however large the network is."""


def vehicles_per_hour(network: Network, per_km_h: float) -> float:
    """Number of departures per hour."""
    lane_km = sum(edge.length_m * len(edge.lane_ids) for edge in network.edges.values()) / 1000
    return min(MOST_PER_HOUR, per_km_h * lane_km)


def write(path: Path, network: Network, per_km_h: float, seed: int) -> None:
    """Writes the flows as a SUMO additional file, which is empty if no edges are connected.

    Args:
        per_km_h: departures per hour and kilometre of lane.
        seed: seed of their starts and ends."""
    rng = np.random.default_rng(seed)
    edges = list(network.edges.values())
    weights = np.array([edge.length_m * len(edge.lane_ids) for edge in edges])
    routes: list[tuple[str, ...]] = []
    for index in rng.choice(len(edges), STARTS, p=weights / weights.sum()):
        start = edges[int(index)].edge_id
        ways = ways_from(network, start, NEAREST)
        reached = list(ways.before)
        if reached:
            routes += [ways.to(reached[int(goal)]) for goal in rng.integers(len(reached), size=GOALS)]
    each_per_s = vehicles_per_hour(network, per_km_h) / 3600 / max(1, len(routes))
    rows = (
        f'    <flow id="random.{number}" begin="0" end="604800" period="exp({each_per_s:.9f})" departLane="best" '
        f'departSpeed="max"><route edges={quoteattr(" ".join(route))}/></flow>'
        for number, route in enumerate(routes)
    )
    write_whole(path, "\n".join(("<additional>", *rows, "</additional>", "")))
