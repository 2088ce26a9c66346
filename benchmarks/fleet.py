"""Cars of one traffic beside as many copies of the environment: decisions a second, and memory.

    python benchmarks/fleet.py --cars 1 8 32 --copies 32
    python benchmarks/fleet.py --cars 8 128 --scenario town.sumocfg

Every car only looks on (`FlatDrive-v0`, lean, waits of two seconds), so the judges' do-nothing drives, which are
simulations of their own from the first alert on, are not in the figures. Memory is that of all processes (PSS).
"""

from __future__ import annotations

import argparse
import os
import time
from functools import partial

import numpy as np

from automotive_cosim.envs.flat_drive import FlatDriveEnv
from automotive_cosim.envs.fleet import FleetVectorEnv
from automotive_cosim.envs.vector import ConcurrentVectorEnv
from automotive_cosim.run.measure import pss_mb

FAMILY = "paris_july"
"""Its drives are in paris_centre."""
ENTER_STEPS = 20
"""In these all cars enter; nothing is timed."""


def measured(kind: str, cars: int, scenario: str, steps: int) -> str:
    """A row of Markdown."""
    make = partial(FlatDriveEnv, FAMILY, scenario=scenario, lean=True)
    before_mb = pss_mb()
    if kind == "fleet":
        envs = FleetVectorEnv(cars, families=FAMILY, scenario=scenario, lean=True)
    else:
        envs = ConcurrentVectorEnv([make] * cars)
    envs.reset(seed=1)
    waits = np.ones(cars, np.int64)
    for _ in range(ENTER_STEPS):
        envs.step(waits)
    decisions, begun_s = 0, time.perf_counter()
    for _ in range(steps):
        info = envs.step(waits)[4]
        decisions += int(info["acted"].sum()) if kind == "fleet" else cars
    took_s, memory_mb = time.perf_counter() - begun_s, pss_mb() - before_mb
    envs.close()
    return (
        f"| {kind} | {cars} | {decisions / steps:.0f} | {decisions / took_s:.1f} | "
        f"{1000 * took_s / decisions:.2f} | {memory_mb:.0f} |"
    )


def main() -> None:
    """Measures what the command line says."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cars", type=int, nargs="*", default=[1, 8, 32], help="cars of a fleet")
    parser.add_argument("--copies", type=int, nargs="*", default=[], help="copies of the environment")
    parser.add_argument("--scenario", default="", help="a scenario or network; paris_centre if left out")
    parser.add_argument("--steps", type=int, default=30, help="steps to time")
    told = parser.parse_args()
    print("| | cars | in the traffic | decisions a second | ms a decision | MB in all |\n|---|--:|--:|--:|--:|--:|")
    for kind, counts in (("fleet", told.cars), ("copies", told.copies)):
        for count in counts:
            print(measured(kind, count, told.scenario, told.steps), flush=True)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main()
