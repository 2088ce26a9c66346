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
from contextlib import suppress
from functools import partial
from pathlib import Path

import numpy as np

from automotive_cosim.agents.cleanup import tree
from automotive_cosim.envs.flat_drive import FlatDriveEnv
from automotive_cosim.envs.fleet import FleetVectorEnv
from automotive_cosim.envs.vector import ConcurrentVectorEnv
from automotive_cosim.run.measure import pss_mb

FAMILY = "paris_july"
"""Its drives are in paris_centre."""
ENTER_STEPS = 600
"""In these at most, all cars enter, each where its trip begins as soon as there is a gap; nothing is timed."""
COLUMNS = ("", "cars", "in traffic", "act in a step", "decisions a second", "ms a decision", "of a processor")
COLUMNS += ("MB", "MB a car")
LEAST_STEPS = 20
"""The same at least."""


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
    entered: set[str] = set()
    for number in range(ENTER_STEPS):
        entered |= set(envs.fleet.agents) if isinstance(envs, FleetVectorEnv) else {str(car) for car in range(cars)}
        if number >= LEAST_STEPS and len(entered) == cars:
            break
        envs.step(waits)
    driving = len(envs.fleet.agents) if isinstance(envs, FleetVectorEnv) else cars
    decisions, begun_s, worked_s = 0, time.perf_counter(), processor_s()
    for _ in range(steps):
        info = envs.step(waits)[4]
        decisions += int(info["acted"].sum()) if kind == "fleet" else cars
    took_s, memory_mb = time.perf_counter() - begun_s, pss_mb() - before_mb
    worked_s = processor_s() - worked_s
    envs.close()
    found = (
        kind,
        cars,
        driving,
        round(decisions / steps),
        f"{decisions / took_s:.1f}",
        f"{1000 * took_s / decisions:.2f}",
        f"{1000 * worked_s / decisions:.2f}",
        round(memory_mb),
        f"{memory_mb / driving:.1f}",
    )
    return f"| {' | '.join(map(str, found))} |"


def processor_s() -> float:
    """Processor time of this process and of all that it started and that still run."""
    total = 0.0
    for pid in tree(os.getpid()):
        with suppress(OSError):
            fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
            total += (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return total


def main() -> None:
    """Measures what the command line says."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cars", type=int, nargs="*", default=[1, 8, 32], help="cars of a fleet")
    parser.add_argument("--copies", type=int, nargs="*", default=[], help="copies of the environment")
    parser.add_argument("--scenario", default="", help="a scenario or network; paris_centre if left out")
    parser.add_argument("--steps", type=int, default=30, help="steps to time")
    told = parser.parse_args()
    print(f"| {' | '.join(COLUMNS)} |\n|---{(len(COLUMNS) - 1) * '|--:'}|")
    for kind, counts in (("fleet", told.cars), ("copies", told.copies)):
        for count in counts:
            print(measured(kind, count, told.scenario, told.steps), flush=True)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main()
