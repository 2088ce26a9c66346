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
from automotive_cosim.scenery import open_scenario
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked

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
            first_s, fork_s, memory_mb = resets(net)
            second_s, bare_s = seconds(net)
            print(
                f"| {edges:,} | {first_s:.2f} s | {1000 * fork_s:.0f} ms | {1000 * second_s:.1f} ms | "
                f"{1000 * bare_s:.1f} ms | {memory_mb or 0:,.0f} MB |",
                flush=True,
            )


def resets(net: Path) -> tuple[float, float, float | None]:
    """Wall seconds of the first reset, of another one, and memory in MB."""
    took_s = []
    began_s = perf_counter()
    with closing(CockpitEnv("hvac_fan_max", scenario=str(net))) as env:
        for _ in range(1 + RESETS):
            env.reset(seed=0)
            took_s.append(perf_counter() - began_s)
            memory_mb = rss_mb()
            began_s = perf_counter()
    return took_s[0], statistics.median(took_s[1:]), memory_mb


def seconds(net: Path) -> tuple[float, float]:
    """Wall seconds of a simulated second with the whole driving state, and of SUMO alone, in turns."""
    scenario = open_scenario(net)
    whole, bare = list[float](), list[float]()
    with (
        closing(Forked(scenario)) as simulation,
        closing(simulation.depart(EgoPlan(scenario.ego.trips[0], scenario.ego.driver))) as traffic,
    ):
        steps = round(1 / scenario.sumo.step_length_s)
        for _ in range(SECONDS):
            began_s = perf_counter()
            traffic.advance(1.0)
            whole.append(perf_counter() - began_s)
            began_s = perf_counter()
            traffic.bare_steps(steps)
            bare.append(perf_counter() - began_s)
    return statistics.mean(whole), statistics.mean(bare)


if __name__ == "__main__":
    main()
