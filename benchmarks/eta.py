"""How good are the predicted travel times? Every way offered is driven in a branch of its own.

    python benchmarks/eta.py                     # all shipped scenarios
    python benchmarks/eta.py grid paris_centre --seeds 1 2 --at 5 90

For each scenario: every trip by different seeds; at some instants of each the alternatives are asked for, and each
of them is driven to the goal in a branch. The ratio is predicted over driven time; neither depends on how busy the
machine is.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from statistics import mean, median

from automotive_cosim.contracts import EgoEnd, Reroute
from automotive_cosim.scenarios import load, shipped
from automotive_cosim.traffic.base import EgoPlan, Traffic
from automotive_cosim.traffic.fork import Forked

GIVE_UP_S = 3600.0


def ratios(name: str, seeds: Sequence[int], at_s: Sequence[float], step_s: float | None) -> Iterator[float]:
    scenario = load(name)
    if step_s is not None:
        scenario = replace(scenario, sumo=replace(scenario.sumo, step_length_s=step_s))
    for seed in seeds:
        with closing(Forked(scenario, seed, allow_unprojected=True)) as simulation:
            for trip in scenario.ego.trips:
                with closing(simulation.depart(EgoPlan(trip, "average", seed))) as traffic:
                    for instant_s, before_s in zip(at_s, (0.0, *at_s), strict=False):
                        traffic.advance(instant_s - before_s)
                        if traffic.state.end is None:
                            yield from driven(traffic)


def driven(traffic: Traffic) -> Iterator[float]:
    for option in traffic.alternatives():
        with closing(traffic.branch()) as branch:
            began_s = branch.state.time_s
            if branch.request(Reroute(edges=option.edges)).accepted:
                branch.advance(GIVE_UP_S)
                if branch.state.end is EgoEnd.ARRIVED:
                    yield option.eta_s / (branch.state.time_s - began_s)


def main() -> None:
    parser = argparse.ArgumentParser(description="Predicted over driven times.")
    parser.add_argument("scenarios", nargs="*", default=shipped())
    parser.add_argument("--seeds", nargs="+", type=int, default=[1, 2], help="of traffic and driver")
    parser.add_argument("--at", nargs="+", type=float, default=[5.0, 90.0], help="seconds after departure")
    parser.add_argument("--step", type=float, help="SUMO's step instead of the scenario's own; 1 s is quick")
    asked = parser.parse_args()
    at_s = sorted(asked.at)
    print(f"{'scenario':16}{'drives':>8}{'median ratio':>14}{'mean error':>12}")
    for name in asked.scenarios:
        found = list(ratios(name, asked.seeds, at_s, asked.step))
        error = mean(abs(ratio - 1) for ratio in found)
        print(f"{name:16}{len(found):8}{median(found):14.2f}{error:12.0%}", flush=True)


if __name__ == "__main__":
    main()
