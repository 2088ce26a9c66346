"""What a town costs by its size: first reset, reset by fork, a simulated second, and memory.

    python benchmarks/towns.py [STREETS]...

Makes a grid of so many streets each way with netgenerate (4, 16, 50 and 112 by default: 48, 960, 9,800 and 49,728
edges) and opens it as any network is opened, with the light traffic that is drawn for it. Memory is that of all
processes while an episode runs, shared pages counted once.
"""

from __future__ import annotations

import statistics
import sys
import tempfile
from contextlib import closing
from pathlib import Path
from time import perf_counter

from automotive_cosim import CockpitEnv
from automotive_cosim.run.memory import rss_mb
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Simulations

STREETS = (4, 16, 50, 112)
BLOCK_M = 150
RESETS, SECONDS = 5, 30


def main() -> None:
    print("| edges | first reset | fork reset | a simulated second | bare SUMO's | memory |")
    print("|---|---|---|---|---|---|")
    for streets in [int(each) for each in sys.argv[1:]] or STREETS:
        with tempfile.TemporaryDirectory() as folder:
            net = Path(folder) / "town.net.xml"
            grid = ("--grid", "--grid.number", str(streets), "--grid.length", str(BLOCK_M), "--tls.guess", "true")
            ok, printed = sumo_programs.run("netgenerate", [*grid, "-o", net.name, "--no-warnings"], net.parent)
            if not ok:
                sys.exit(sumo_programs.first_error(printed))
            edges = 4 * streets * (streets - 1)
            print(f"| {edges:,} | {measured(net)} |", flush=True)


def measured(net: Path) -> str:
    """Wall seconds of the first reset and of later ones, of a simulated second with the whole driving state and of
    SUMO's own, in turns; and the memory of all processes during an episode."""
    resets_s, whole_s, bare_s = list[float](), list[float](), list[float]()
    pool = Simulations()
    began_s = perf_counter()
    with closing(pool), closing(CockpitEnv("hvac_fan_max", scenario=str(net), simulations=pool)) as env:
        for _ in range(1 + RESETS):
            env.reset(seed=0)
            resets_s.append(perf_counter() - began_s)
            began_s = perf_counter()
        memory_mb = rss_mb() or 0.0
        scenario = env.scenario
        plan = EgoPlan(scenario.ego.trips[0], scenario.ego.driver)
        with closing(pool.warm(scenario).depart(plan)) as traffic:
            for _ in range(SECONDS):
                began_s = perf_counter()
                traffic.advance(1.0)
                whole_s.append(perf_counter() - began_s)
                began_s = perf_counter()
                traffic.bare_steps(round(1 / scenario.sumo.step_length_s))
                bare_s.append(perf_counter() - began_s)
    first_s, fork_ms = resets_s[0], 1000 * statistics.median(resets_s[1:])
    whole_ms, bare_ms = (1000 * statistics.mean(each) for each in (whole_s, bare_s))
    return f"{first_s:.2f} s | {fork_ms:.0f} ms | {whole_ms:.1f} ms | {bare_ms:.1f} ms | {memory_mb:,.0f} MB"


if __name__ == "__main__":
    main()
