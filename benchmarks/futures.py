"""The cost of a decision of ``study reroute``, and that of SUMO's own steps.

    python benchmarks/futures.py                                       # paris_centre, the trip into the jam
    python benchmarks/futures.py --scenario my/network.sumocfg --share 0 --delay 15 --replicates 1 3

Runs a study in this process and prints processor seconds per decision, which depend less on a busy machine than
wall time: of this process, which compares, and of all simulations, warm-up, forks and proofs included. Then every
future is driven once more with bare steps of libsumo that read nothing, in a fork of the same instant and for as
many steps: the least that those futures can cost.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from decisions import Children, spent_s

from automotive_cosim.studies.batch import drives
from automotive_cosim.studies.plan import StudyPlan
from automotive_cosim.traffic.fork import RemoteTraffic

POLICIES = ("never", "always", "delay:60", "best")


@dataclass(slots=True)
class Tally:
    """Processor seconds of the futures of a study."""

    futures: int = 0
    steps: int = 0
    ours_s: float = 0.0
    bare_s: float = 0.0


@contextmanager
def counted(tally: Tally) -> Iterator[None]:
    """Counts every future that is driven to its end; also drives it with bare steps."""
    begin, end = RemoteTraffic.begin_settling, RemoteTraffic.settled
    begun: dict[RemoteTraffic, tuple[float, float, RemoteTraffic]] = {}

    def begin_both(traffic: RemoteTraffic, *arguments: Any) -> None:
        begun[traffic] = spent_s(traffic.pid), traffic.state.time_s, traffic.branch()
        begin(traffic, *arguments)

    def end_both(traffic: RemoteTraffic, *arguments: Any) -> Any:
        settled = end(traffic, *arguments)
        before_s, from_s, copy = begun.pop(traffic)
        tally.ours_s += spent_s(traffic.pid) - before_s
        tally.futures += 1
        steps = round(settled.time_s - from_s)
        tally.steps += steps
        with closing(copy):
            before_s = spent_s(copy.pid)
            copy.bare_steps(steps)
            tally.bare_s += spent_s(copy.pid) - before_s
        return settled

    RemoteTraffic.begin_settling, RemoteTraffic.settled = begin_both, end_both  # type: ignore[assignment,method-assign]
    try:
        yield
    finally:
        RemoteTraffic.begin_settling, RemoteTraffic.settled = begin, end  # type: ignore[method-assign]


def decisions(plan: StudyPlan) -> int:
    """Runs all drives of a study; the number of their decisions."""
    count = 0
    with drives() as run:
        for job in plan.jobs():
            row = run(job, Path())
            assert not row.error, row.error
            count += len(row.decisions)
    return count


def show(plan: StudyPlan, *, bare: bool) -> None:
    """Measures one plan and prints a line."""
    with Children().counted() as children:
        begun_s, clock_s, spent = time.process_time(), time.perf_counter(), children.spent_s
        count = decisions(plan)
        ours_s, sumo_s = time.process_time() - begun_s, children.spent_s - spent
        wall_s = time.perf_counter() - clock_s
    if not count:
        raise SystemExit("these drives meet no decision; choose another trip, or a lower --delay")
    print(
        f"| {plan.replicates} | {count} | {(ours_s + sumo_s) / count:.2f} | {ours_s / count:.2f} "
        f"| {wall_s / count:.2f} |",
        end="" if bare else "\n",
        flush=True,
    )
    if bare:
        tally = Tally()
        with counted(tally):
            decisions(plan)
        print(
            f" {tally.futures / count:.1f} | {tally.steps / tally.futures:.0f} | {tally.ours_s / count:.2f} "
            f"| {tally.bare_s / count:.2f} |",
            flush=True,
        )


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenario", default="paris_centre")
    parser.add_argument("--trips", nargs="*", default=["jam"])
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--departures", type=float, nargs="*", default=[0.0, 600.0])
    parser.add_argument("--share", type=float, default=None)
    parser.add_argument("--delay", type=float, default=30.0)
    parser.add_argument("--every", type=float, default=60.0)
    parser.add_argument("--per-drive", type=int, default=5)
    parser.add_argument("--ages", type=float, nargs="*", default=[0.0])
    parser.add_argument("--policies", nargs="*", default=list(POLICIES))
    parser.add_argument("--placebo-every", type=int, default=3)
    parser.add_argument("--arrived", type=float, default=0.95, help="0.5: futures end about when the ego arrives")
    parser.add_argument("--no-bare", action="store_true", help="leave out the bare steps, which double the time")
    parser.add_argument("--replicates", type=int, nargs="*", default=[1, 2, 4])
    given = parser.parse_args()
    print(f"load {os.getloadavg()[0]:.1f}; seconds of one processor per decision")
    columns = ["draws", "decisions", "all", "of this process", "wall time"]
    columns += [] if given.no_bare else ["futures", "steps of each", "futures, s", "bare SUMO, s"]
    print(f"| {' | '.join(columns)} |\n|{'---:|' * len(columns)}")
    for draws in given.replicates:
        show(
            StudyPlan(
                given.scenario,
                departures_s=tuple(given.departures),
                trips=tuple(given.trips),
                seeds=tuple(range(given.seeds)),
                shares=() if given.share is None else (given.share,),
                least_delay_s=given.delay,
                every_s=given.every,
                per_drive=given.per_drive,
                ages_s=tuple(given.ages),
                policies=tuple(given.policies),
                placebo_every=given.placebo_every,
                arrived=given.arrived,
                replicates=draws,
            ),
            bare=not given.no_bare,
        )


if __name__ == "__main__":
    main()
