"""Decisions of ``study reroute`` on large networks, and how their number grows with workers and machines.

    python benchmarks/scale.py --streets 50 112              # grids of 9,800 and 49,728 edges, made by netgenerate
    python benchmarks/scale.py --workers 1 2 --ray-nodes 2   # throughput here, and a model for 100 workers

A decision on a grid has a fork, a branch and its share of the kept route's future; some hundred vehicles are on
the road, whatever the size, so rows differ by the network. Times but those of forks are processor time.

The model has three measured parts: the processor time of a decision in a worker, that of a seed's warm-up, which
each worker with a drive of that seed spends, and that of the program that hands out drives and writes rows. Workers
share nothing else: throughput grows with them until seeds or that program are the limit.
"""

from __future__ import annotations

import argparse
import functools
import os
import statistics
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

from automotive_cosim.run.job_row import steady
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.store import read_rows
from automotive_cosim.studies.calls.ledger import run_on
from automotive_cosim.studies.reroute.batch import REROUTE, drives
from automotive_cosim.studies.reroute.plan import StudyPlan
from automotive_cosim.studies.reroute.rows import TripRow
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Forked, RemoteTraffic
from automotive_cosim.traffic.remote import RemoteProcess

BLOCK_M = 150
VEHICLES_OF = 1_000
"""The drawn traffic is scaled by this divided by the number of edges."""

JAM = "jam edges=c1c2,c2c3 length_m=200 hold_s=15"
MANY = 100
"""Workers of the model."""


class Children:
    """Processor time of the simulations' processes, past and present."""

    def __init__(self) -> None:
        self._ended_s = 0.0
        self._running: dict[int, RemoteProcess] = {}
        self._since_s: Counter[int] = Counter()

    @contextmanager
    def counted(self) -> Iterator[Children]:
        """Counts every process that is started or forked in the meantime."""
        first_call, close = RemoteProcess.receive, RemoteProcess.close

        @functools.wraps(first_call)
        def receive(process: RemoteProcess, *arguments: Any, **options: Any) -> Any:
            if process.pid and process.pid not in self._running:
                self._running[process.pid] = process
            return first_call(process, *arguments, **options)

        @functools.wraps(close)
        def closed(process: RemoteProcess) -> None:
            if self._running.pop(process.pid, None) is not None:
                self._ended_s += spent_s(process.pid)
            close(process)

        RemoteProcess.receive, RemoteProcess.close = receive, closed  # type: ignore[method-assign]
        try:
            yield self
        finally:
            RemoteProcess.receive, RemoteProcess.close = first_call, close  # type: ignore[method-assign]

    @property
    def spent_s(self) -> float:
        """Seconds spent by all of them so far."""
        return self._ended_s + sum(map(spent_s, self._running))


def spent_s(pid: int) -> float:
    """A process's own clock (clock_getcpuclockid(3)); Linux."""
    try:
        return time.clock_gettime(((~pid) << 3) | 2)
    except OSError:  # it has ended
        return 0.0


def decisions(plan: StudyPlan) -> int:
    """Runs all drives of a study; the number of their decisions."""
    count = 0
    with drives() as run:
        for job in plan.jobs():
            row = run(job, Path())
            assert not row.error, row.error
            count += len(row.decisions)
    return count


@dataclass(slots=True)
class Clock:
    """What is noted while drives run."""

    forks_s: list[float] = field(default_factory=list)
    """Wall time of each fork, up to the copy's first answer."""
    warm_s: float = 0.0
    """Processor time up to the first departure."""
    vehicles: int = 0
    """On the road at the first departure."""

    @contextmanager
    def running(self, spent_s: Callable[[], float]) -> Iterator[None]:
        """Times forks in the meantime, and notes when the first ego departs."""
        branch, depart = RemoteTraffic.branch, Forked.depart

        def timed(traffic: RemoteTraffic) -> RemoteTraffic:
            begun_s = time.perf_counter()
            copy = branch(traffic)
            self.forks_s.append(time.perf_counter() - begun_s)
            return copy

        def noted(simulation: Forked, plan: EgoPlan) -> RemoteTraffic:
            if not self.warm_s:
                self.vehicles = simulation.call(run_on, 1.0).running
                self.warm_s = spent_s()
            return depart(simulation, plan)

        RemoteTraffic.branch, Forked.depart = timed, noted  # type: ignore[method-assign]
        try:
            yield
        finally:
            RemoteTraffic.branch, Forked.depart = branch, depart  # type: ignore[method-assign]


def grid(streets: int, folder: Path) -> Path:
    """A grid of so many streets each way."""
    net = folder / "town.net.xml"
    words = ("--grid", "--grid.number", str(streets), "--grid.length", str(BLOCK_M), "--tls.guess", "true")
    ok, printed = sumo_programs.run("netgenerate", [*words, "-o", net.name, "--no-warnings"], folder)
    if not ok:
        sys.exit(sumo_programs.first_error(printed))
    return net


def on_network(streets: int, trips: int) -> str:
    """Cells of a row: what decisions cost on a grid."""
    with tempfile.TemporaryDirectory() as folder:
        edges = 4 * streets * (streets - 1)
        plan = StudyPlan(
            str(grid(streets, Path(folder))),
            departures_s=(0.0,),
            seeds=(0,),
            policies=("never", "always"),
            least_delay_s=0.0,
            per_drive=2,
            placebo_every=0,
            scale=min(1.0, VEHICLES_OF / edges),
            warm_up_s=300.0,
        )
        plan = replace(plan, trips=tuple(trip.name for trip in plan.opened.ego.trips[:trips]))
        clock = Clock()
        with Children().counted() as children:
            begun_s = time.process_time()

            def now_s() -> float:
                return time.process_time() - begun_s + children.spent_s

            with clock.running(now_s):
                count = decisions(plan)
            all_s = now_s()
    if not count:
        sys.exit("no decision; give more --trips")
    decision_s = (all_s - clock.warm_s) / count
    return (
        f"{edges:,} | {clock.vehicles} | {clock.warm_s:.1f} s | {1000 * statistics.median(clock.forks_s):.0f} ms | "
        f"{count} | {decision_s:.2f} s"
    )


def throughput(plan: StudyPlan, workers: list[int], nodes: int, kills: int) -> None:
    """Prints a row for each number of workers, and the model."""
    print("| where | decisions | wall time | decisions a minute | rows |\n|---|---:|---:|---:|---|")
    with tempfile.TemporaryDirectory() as folder:
        expected: Any = None
        handed_s: list[float] = []
        for count in workers:
            found, row = measured(plan, Path(folder) / str(count), Processes(count), f"{count} here", handed_s)
            expected = expected or found
            print(row + ("equal |" if found == expected else "DIFFER |"), flush=True)
        if nodes:
            killed = f", {kills} killed" if kills else ""
            with on_ray(nodes) as (executor, replace_node):
                name = f"Ray, {nodes} nodes of a CPU{killed}"
                at = {len(plan.jobs()) * (kill + 1) // (kills + 1) for kill in range(kills)}
                found, row = measured(plan, Path(folder) / "ray", executor, name, handed_s, at, replace_node)
            expected = expected or found
            print(row + ("equal |" if found == expected else "DIFFER |"), flush=True)
    hands_out_s = statistics.median(handed_s)
    warm_s, drive_s, per_drive = parts(plan)
    seeds = len(plan.seeds)
    print(
        f"\nof one core: warm-up of a seed {warm_s:.2f} s, a drive {drive_s:.2f} s with {per_drive:.1f} decisions, "
        f"handing out a drive and writing its row {1000 * hands_out_s:.1f} ms"
    )
    most = 1 / hands_out_s * per_drive * 60
    for departures in (len(plan.departures_s), 10):
        seed_s = warm_s + drive_s * departures * len(plan.trips or (1,))
        rate = departures * len(plan.trips or (1,)) * per_drive / seed_s * 60
        print(
            f"model, {departures} departures a seed: {rate:,.0f} decisions a minute and worker, so "
            f"{min(MANY * rate, most):,.0f} with {MANY} workers and as many seeds or more; the program that hands "
            f"them out could serve {most / rate:,.0f} such workers ({seeds} seeds were run here)"
        )


def measured(
    plan: StudyPlan,
    folder: Path,
    executor: Any,
    name: str,
    handed_s: list[float],
    interrupted_at: Collection[int] = (),
    interrupt: Callable[[], None] = lambda: None,
) -> tuple[dict[str, Any], str]:
    """The rows of a study, and the cells of the table.

    Args:
        plan: the study.
        folder: its folder.
        executor: where it runs.
        name: the first cell.
        handed_s: gets the processor time of this program from each row to the next.
        interrupted_at: numbers of rows.
        interrupt: called once there are as many."""
    clock_s: list[float] = []

    def tell(_progress: object) -> None:
        clock_s.append(time.process_time())
        if len(clock_s) in interrupted_at:
            interrupt()

    begun_s = time.perf_counter()
    with executor:
        REROUTE.run(plan, folder, executor=executor, tell=tell)
    took_s = time.perf_counter() - begun_s
    handed_s += [after - before for before, after in pairwise(clock_s[1:])]
    rows = read_rows(folder, TripRow)
    count = sum(len(row.decisions) for row in rows.values())
    lost = sum(len(row.failed_attempts) for row in rows.values())
    if interrupted_at:
        name += f" ({len(rows)} rows, {lost} attempts lost)"
    cells = f"| {name} | {count} | {took_s:.1f} s | {count / took_s * 60:.1f} | "
    return {key: steady(row) for key, row in rows.items()}, cells


def parts(plan: StudyPlan) -> tuple[float, float, float]:
    """Processor seconds of a seed's warm-up and of a drive, and the decisions of a drive."""
    jobs = plan.jobs()
    with Children().counted() as children, drives() as run:
        spent_s = []
        count = 0
        for job in [jobs[0], *jobs[: len(jobs) // len(plan.seeds)]]:  # the first drive twice: once with the warm-up
            begun_s = time.process_time() + children.spent_s
            count += len(run(job, Path()).decisions)
            spent_s.append(time.process_time() + children.spent_s - begun_s)
    drive_s = statistics.mean(spent_s[1:])
    return max(0.0, spent_s[0] - spent_s[1]), drive_s, count / len(spent_s)


@contextmanager
def on_ray(nodes: int) -> Iterator[tuple[Any, Callable[[], None]]]:
    """A cluster of nodes with one CPU each, all on this machine, and what kills one and adds another."""
    from ray.cluster_utils import Cluster

    from automotive_cosim.run.on_ray import OnRay

    node: dict[str, Any] = {"num_cpus": 1, "object_store_memory": 80 * 1024**2}
    cluster = Cluster(initialize_head=True, head_node_args=node | {"include_dashboard": False})
    try:
        for _ in range(nodes - 1):
            cluster.add_node(**node)

        def replace_node() -> None:
            cluster.remove_node(next(iter(cluster.worker_nodes)), allow_graceful=False)
            cluster.add_node(**node)

        yield OnRay(str(cluster.address), nodes), replace_node
    finally:
        cluster.shutdown()


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--streets", type=int, nargs="*", default=[], help="sizes of grids; none leaves them out")
    parser.add_argument("--trips", type=int, default=2, help="drives on each grid")
    parser.add_argument("--workers", type=int, nargs="*", default=[], help="numbers of processes")
    parser.add_argument("--ray-nodes", type=int, default=0, help="0 leaves Ray out")
    parser.add_argument("--kills", type=int, default=0, help="how often a Ray node is killed and another added")
    parser.add_argument("--seeds", type=int, default=4)
    given = parser.parse_args()
    print(f"load {os.getloadavg()[0]:.1f}")
    if given.streets:
        columns = ["edges", "vehicles", "warm-up", "fork", "decisions", "a decision"]
        print(f"| {' | '.join(columns)} |\n|{'---:|' * len(columns)}")
        for streets in given.streets:
            print(f"| {on_network(streets, given.trips)} |", flush=True)
    if given.workers or given.ray_nodes:
        plan = StudyPlan(
            "grid",
            departures_s=(300.0,),
            trips=("avenue",),
            seeds=tuple(range(given.seeds)),
            policies=("never", "always"),
            per_drive=2,
            placebo_every=0,
            incidents=(JAM,),
        )
        throughput(plan, given.workers, given.ray_nodes, given.kills)


if __name__ == "__main__":
    main()
