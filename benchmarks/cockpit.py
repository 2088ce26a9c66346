"""How long the cockpit takes to draw: run ``python benchmarks/cockpit.py [--frames N] [NETWORK ...]``.

Each network is a SUMO ``.net.xml(.gz)``; without one, that of ``paris_centre`` is used. A car drives through its
middle at 50 km/h, one simulated second per frame, turning slowly. Processor time, medians, milliseconds.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
from datetime import UTC, datetime
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.contracts import (
    Around,
    Connectivity,
    DrivingState,
    Limit,
    LimitSource,
    Road,
    RoadAhead,
    RoadHere,
    RoadNetwork,
    Surroundings,
    Weather,
)
from automotive_cosim.traffic.network import read_network

SPEED_MPS = 50 / 3.6
SCREENS = ("home", "map", "climate", "media", "vehicle", "settings")


def outside(network: RoadNetwork, route: tuple[Road, ...], second: int) -> Surroundings:
    """A drive along a wide bend through the middle of the network."""
    x_min, y_min, x_max, y_max = network.bounds_m
    turned, driven_m = 0.002 * second, SPEED_MPS * second
    here = RoadHere(
        route[0].edge_id, f"{route[0].edge_id}_0", 0, 1, 0.0, "Road", "primary",
        Limit(SPEED_MPS, LimitSource.POSTED), False, None, None, None, 1.0,
    )  # fmt: skip
    edges = tuple(road.edge_id for road in route)
    ahead = RoadAhead(2000.0, 200.0, 30.0, 0.7, None, 0.0, None, None, None, None, None, edges)
    driving = DrivingState(
        900.0 + second,
        (x_min + x_max) / 2 + driven_m * math.sin(turned),
        (y_min + y_max) / 2 + driven_m * math.cos(turned),
        None, None, math.degrees(turned), SPEED_MPS + 0.3 * (second % 3), 0.0, 0.0, driven_m, here, ahead,
        Around(None, None, None, None, 1.0), False, 100,
    )  # fmt: skip
    weather = Weather(14.0, 55.0, 0.0, 1, 20.0, 20_000.0, 8.0)
    now = datetime(2026, 5, 12, 14, second // 60, second % 60, tzinfo=UTC)
    return Surroundings(driving, weather, now, 40.0, None, Connectivity(True, "5g", 3))


def measure(network: RoadNetwork, size: ScreenSize, frames: int) -> dict[str, dict[str, float]]:
    """Milliseconds by screen: the tree, its elements, a changed, an unchanged and a redrawn frame."""
    x_min, y_min, x_max, y_max = network.bounds_m
    middle = ((x_min + x_max) / 2, (y_min + y_max) / 2)
    route = tuple(sorted(network.roads, key=lambda road: math.dist(road.shape_m[0], middle))[:25])
    figures = {}
    for screen in SCREENS:
        cockpit = Cockpit(network, rng=np.random.default_rng(1), size=size)
        names = ("tree", "elements", "changed", "unchanged", "redrawn")
        times: dict[str, list[float]] = {name: [] for name in names}
        for second in range(frames):
            cockpit.sense(outside(network, route, second), 1.0)
            cockpit.open_app("apps")
            cockpit.screenshot()
            cockpit.open_app(screen)
            _timed(times["redrawn"], cockpit.screenshot)
            cockpit.sense(outside(network, route, second + 1), 1.0)
            _timed(times["tree"], lambda: cockpit.tree)  # noqa: B023
            _timed(times["elements"], cockpit.elements)
            _timed(times["changed"], cockpit.screenshot)
            _timed(times["unchanged"], cockpit.screenshot)
        figures[screen] = {name: round(1000 * statistics.median(taken), 3) for name, taken in times.items()}
    return figures


def _timed(into: list[float], call: Any) -> None:
    before = process_time()
    call()
    into.append(process_time() - before)


def main() -> None:
    """Measures each network and prints a JSON object for each size of screen."""
    default = Path(__file__).parents[1] / "sumo_scenarios" / "paris_centre" / "paris_centre.net.xml.gz"
    parser = argparse.ArgumentParser(description="How long the cockpit takes to draw.")
    parser.add_argument("networks", nargs="*", type=Path, default=[default], help="SUMO's .net.xml or .net.xml.gz")
    parser.add_argument("--frames", type=int, default=60, help="of each screen")
    asked = parser.parse_args()
    for path in asked.networks:
        network = read_network(path).map
        for size in ScreenSize:
            figures = {"network": path.name, "roads": len(network.roads), "size": size}
            print(json.dumps(figures | {"screens": measure(network, size, asked.frames)}, indent=1))


if __name__ == "__main__":
    main()
