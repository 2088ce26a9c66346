"""Error of the car's own position estimate while GPS is out, compared with SUMO's true position.

    python benchmarks/dead_reckoning.py [SCENARIO TRIP]

Drives trips with a tunnel, several seeds each, and gives the median error in metres by the seconds since the last
fix: of the last fix itself, of dead reckoning, and of dead reckoning that keeps to the map's roads; then of the
receiver once it has a fix again. The odometer reads 1 % too much and the compass drifts by 0.05 degrees a second,
as worn tyres and a plain MEMS gyroscope do.
"""

from __future__ import annotations

import math
import sys
from collections import defaultdict
from contextlib import closing
from dataclasses import dataclass, replace
from statistics import median

import numpy as np

from automotive_cosim.contracts import DrivingState, GpsFix
from automotive_cosim.geo.earth import METRES_PER_DEGREE, metres_per_degree_east
from automotive_cosim.geo.gps import Gps
from automotive_cosim.geo.reckoning import Roads, reckon
from automotive_cosim.scenarios import load
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked

TRIPS = (("paris_centre", "tunnel"), ("peripherique", "north"), ("tokyo", "yamate_tunnel"), ("grid", "tunnel"))
SEEDS = (1, 2, 3)
ODOMETER = 1.01
COMPASS_DEG_PER_S = 0.05
AGES_S = (10, 20, 40, 60, 90, 120)


@dataclass(frozen=True, slots=True)
class Instant:
    """What the car measures."""

    time_s: float
    driving: DrivingState
    gps: GpsFix | None


def off_m(truth: DrivingState, lon_deg: float, lat_deg: float) -> float:
    assert truth.lon_deg is not None
    assert truth.lat_deg is not None
    east_m = (lon_deg - truth.lon_deg) * metres_per_degree_east(truth.lat_deg)
    return math.hypot(east_m, (lat_deg - truth.lat_deg) * METRES_PER_DEGREE)


def sensed(truth: DrivingState, out_s: float) -> DrivingState:
    """Measurements with the errors of odometer and compass."""
    heading_deg = (truth.heading_deg + COMPASS_DEG_PER_S * out_s) % 360.0
    return replace(truth, speed_mps=truth.speed_mps * ODOMETER, heading_deg=heading_deg)


Errors = dict[str, dict[int, list[float]]]


def drive(scenario: str, trip: str, seed: int, errors: Errors) -> None:
    loaded = load(scenario)
    plan = EgoPlan(loaded.trip(trip), "average", seed)
    with closing(Forked(loaded, seed)) as simulation, closing(simulation.depart(plan)) as traffic:
        roads = Roads(traffic.network)
        gps = Gps(np.random.default_rng(seed))
        seen: list[Instant] = []
        out_s, back_s = 0, math.inf
        while traffic.state.end is None and len(seen) < 1800:
            state = traffic.state
            fix = gps.read(state, 1.0)
            assert fix is not None
            if fix.has_fix:
                if out_s > 10:
                    back_s = 0
                out_s = 0
                seen.clear()
            else:
                out_s += 1
            seen.append(Instant(state.time_s, sensed(state, out_s), fix))
            if out_s in AGES_S:
                for name, map_roads in (("reckoned", None), ("on roads", roads)):
                    estimate = reckon(seen, map_roads)
                    assert estimate is not None
                    errors[name][out_s].append(off_m(state, estimate.lon_deg, estimate.lat_deg))
                errors["last fix"][out_s].append(off_m(state, fix.lon_deg, fix.lat_deg))
            if fix.has_fix and back_s <= 5:
                errors["realigned"][int(back_s)].append(off_m(state, fix.lon_deg, fix.lat_deg))
                back_s += 1
            traffic.advance(1.0)


def main() -> None:
    print(f"{'trip':28}{'':12}" + "".join(f"{age:>7} s" for age in AGES_S))
    for scenario, trip in [sys.argv[1:]] if len(sys.argv) > 1 else TRIPS:
        errors: Errors = defaultdict(lambda: defaultdict(list))
        for seed in SEEDS:
            drive(scenario, trip, seed, errors)
        for name in ("last fix", "reckoned", "on roads"):
            row = (f"{median(errors[name][age]):9.1f}" if errors[name][age] else f"{'':9}" for age in AGES_S)
            print(f"{scenario + ' ' + trip:28}{name:12}" + "".join(row), flush=True)
        back = [error for found in errors["realigned"].values() for error in found]
        print(
            f"{'':28}after the fix: median {median(back):.1f} m" if back else f"{'':28}no fix afterwards",
            flush=True,
        )


if __name__ == "__main__":
    main()
