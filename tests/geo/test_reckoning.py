"""Dead reckoning on a map, against where SUMO has the car."""

import math
from contextlib import closing
from dataclasses import dataclass, replace

import numpy as np
import pytest

from automotive_cosim.contracts import DrivingState, GpsFix
from automotive_cosim.geo.earth import METRES_PER_DEGREE, metres_per_degree_east
from automotive_cosim.geo.gps import Gps
from automotive_cosim.geo.reckoning import Roads, reckon
from automotive_cosim.scenarios import load
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked

pytestmark = pytest.mark.sumo


@dataclass(frozen=True, slots=True)
class Instant:
    time_s: float
    driving: DrivingState
    gps: GpsFix | None


def off_m(truth: DrivingState, lon_deg: float, lat_deg: float) -> float:
    assert truth.lon_deg is not None
    assert truth.lat_deg is not None
    east_m = (lon_deg - truth.lon_deg) * metres_per_degree_east(truth.lat_deg)
    return math.hypot(east_m, (lat_deg - truth.lat_deg) * METRES_PER_DEGREE)


def test_the_map_holds_what_compass_and_odometer_lose() -> None:
    """Through the tunnel with an odometer 1 % off and a compass that drifts by 1 degree a second."""
    grid = load("grid")
    plan = EgoPlan(grid.trip("tunnel"), "average", 1)
    with closing(Forked(grid, seed=1)) as simulation, closing(simulation.depart(plan)) as traffic:
        roads, gps = Roads(traffic.network), Gps(np.random.default_rng(3))
        seen: list[Instant] = []
        errors: dict[str, list[float]] = {"last": [], "compass": [], "map": [], "back": []}
        out_s = 0
        while traffic.state.end is None:
            truth = traffic.state
            fix = gps.read(truth, 1.0)
            assert fix is not None
            out_s = 0 if fix.has_fix else out_s + 1
            heading_deg = (truth.heading_deg + 1.0 * out_s) % 360.0
            sensed = replace(truth, speed_mps=1.01 * truth.speed_mps, heading_deg=heading_deg)
            seen.append(Instant(truth.time_s, sensed, fix))
            by_compass, on_map = reckon(seen), reckon(seen, roads)
            assert by_compass is not None
            assert on_map is not None
            if out_s:
                errors["last"].append(off_m(truth, fix.lon_deg, fix.lat_deg))
                errors["compass"].append(off_m(truth, by_compass.lon_deg, by_compass.lat_deg))
                errors["map"].append(off_m(truth, on_map.lon_deg, on_map.lat_deg))
                assert errors["map"][-1] <= 2 * on_map.accuracy_m
            elif errors["map"]:
                assert (on_map.lon_deg, on_map.lat_deg) == (fix.lon_deg, fix.lat_deg), "realigned at once"
                errors["back"].append(off_m(truth, on_map.lon_deg, on_map.lat_deg))
            traffic.advance(1.0)
    assert len(errors["map"]) > 15
    assert errors["last"][-1] > 150.0
    assert errors["compass"][-1] > 15.0
    assert errors["map"][-1] < 15.0
    assert errors["map"][-1] < errors["compass"][-1] < errors["last"][-1]
    assert max(errors["back"][:5]) < 25.0
