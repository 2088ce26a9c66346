"""What a town costs by its size: first reset, reset by fork, a simulated second, and memory.

    python benchmarks/towns.py [STREETS]... [--write docs/images/towns.json]
    python benchmarks/towns.py --plot docs/images/towns.json       # towns.svg beside it

Makes a grid of so many streets each way with netgenerate (4, 16, 50 and 112 by default: 48, 960, 9,800 and 49,728
edges) and opens it as any network is opened, with the light traffic that is drawn for it. Times are of the
processor, of all processes, so a busy machine does not change them much. Memory is that of all processes while an
episode runs, shared pages counted once. Bare SUMO is libsumo in a process of its own that loads the same network
and no traffic.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path

from decisions import Children

from automotive_cosim import CockpitEnv
from automotive_cosim.run.memory import rss_mb
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Simulations

STREETS = (4, 16, 50, 112)
BLOCK_M = 150
RESETS, SECONDS = 5, 30

Row = dict[str, float]

COLUMNS = {
    "edges": "edges",
    "first_s": "first reset, s",
    "bare_load_s": "of it bare SUMO's load, s",
    "fork_ms": "fork reset, ms",
    "second_ms": "a simulated second, ms",
    "bare_second_ms": "bare SUMO's, ms",
    "memory_mb": "memory, MB",
    "bare_memory_mb": "bare SUMO's, MB",
}

BARE = "import sys, libsumo; libsumo.simulation.start(['sumo', '-n', sys.argv[1], '--no-warnings'])"


def main() -> None:
    """Measures and prints, or draws."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("streets", type=int, nargs="*", default=STREETS)
    parser.add_argument("--write", type=Path, help="also write the rows as JSON")
    parser.add_argument("--bare", action="store_true", help="only bare SUMO's load and its memory")
    parser.add_argument("--plot", type=Path, help="only draw the rows of this file")
    given = parser.parse_args()
    if given.plot:
        draw(json.loads(given.plot.read_text(encoding="utf-8")), given.plot.with_suffix(".svg"))
        return
    print(f"| {' | '.join(COLUMNS.values())} |\n|{'---:|' * len(COLUMNS)}", flush=True)
    rows: list[Row] = []
    for streets in given.streets:
        with tempfile.TemporaryDirectory() as folder:
            net = Path(folder) / "town.net.xml"
            grid = ("--grid", "--grid.number", str(streets), "--grid.length", str(BLOCK_M), "--tls.guess", "true")
            ok, printed = sumo_programs.run("netgenerate", [*grid, "-o", net.name, "--no-warnings"], net.parent)
            if not ok:
                sys.exit(sumo_programs.first_error(printed))
            ours = {} if given.bare else measured(net)
            rows.append({"edges": 4 * streets * (streets - 1), **ours, **bare(net)})
        print(f"| {' | '.join(f'{rows[-1].get(name, math.nan):,.6g}' for name in COLUMNS)} |", flush=True)
        if given.write:
            given.write.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


def measured(net: Path) -> Row:
    """The first reset and the median of later ones, a simulated second with the whole driving state and SUMO's own,
    in turns; and the memory of all processes during an episode."""
    resets_s, whole_s, bare_s = list[float](), list[float](), list[float]()
    pool = Simulations()
    with Children().counted() as children:

        def spent_s() -> float:
            return time.process_time() + children.spent_s

        began_s = spent_s()
        with closing(pool), closing(CockpitEnv("hvac_fan_max", scenario=str(net), simulations=pool)) as env:
            for _ in range(1 + RESETS):
                env.reset(seed=0)
                resets_s.append(spent_s() - began_s)
                began_s = spent_s()
            memory_mb = rss_mb() or 0.0
            scenario = env.scenario
            plan = EgoPlan(scenario.ego.trips[0], scenario.ego.driver)
            with closing(pool.warm(scenario).depart(plan)) as traffic:
                for _ in range(SECONDS):
                    began_s = spent_s()
                    traffic.advance(1.0)
                    whole_s.append(spent_s() - began_s)
                    began_s = spent_s()
                    traffic.bare_steps(round(1 / scenario.sumo.step_length_s))
                    bare_s.append(spent_s() - began_s)
    return {
        "first_s": round(resets_s[0], 1),
        "fork_ms": round(1000 * statistics.median(resets_s[1:])),
        "second_ms": round(1000 * statistics.mean(whole_s), 1),
        "bare_second_ms": round(1000 * statistics.mean(bare_s), 1),
        "memory_mb": round(memory_mb),
    }


def bare(net: Path) -> Row:
    """What bare SUMO spends on loading the network, and its memory."""
    process = subprocess.Popen([sys.executable, "-c", BARE, str(net)], stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    if status:
        sys.exit("bare SUMO does not load the network")
    return {
        "bare_load_s": round(used.ru_utime + used.ru_stime, 1),
        "bare_memory_mb": round(used.ru_maxrss / 1024),
    }


def draw(rows: Sequence[Row], target: Path) -> None:
    """Time and memory over edges, ours and bare SUMO's."""
    import matplotlib as mpl

    mpl.use("Agg")
    mpl.rcParams["svg.hashsalt"] = "towns"
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, 3, figsize=(11, 3.6), layout="constrained")
    for axis, title, unit, whole, alone in (
        (axes[0], "First reset", "seconds of a processor", "first_s", "bare_load_s"),
        (axes[1], "A simulated second", "ms of a processor", "second_ms", "bare_second_ms"),
        (axes[2], "Memory", "MB", "memory_mb", "bare_memory_mb"),
    ):
        for name, line, color, label in (
            (whole, "o-", "#1b5e9b", "with the cockpit"),
            (alone, "s--", "#b4582a", "bare SUMO"),
        ):
            points = [(row["edges"] / 1000, row[name]) for row in rows if name in row]
            axis.plot(*zip(*points, strict=True), line, color=color, label=label)
        axis.set(title=title, xlabel="thousand edges", ylabel=unit, xlim=(0, None), ylim=(0, None))
        axis.grid(alpha=0.3)
    axes[0].legend(frameon=False)
    figure.savefig(target, metadata={"Date": None})


if __name__ == "__main__":
    main()
