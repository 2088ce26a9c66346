"""How good are the predicted travel times? Every way offered is driven in a branch of its own.

    python benchmarks/eta.py                     # all shipped scenarios
    python benchmarks/eta.py grid paris_centre --seeds 1 2 --at 5 90
    python benchmarks/eta.py town/run.sumocfg    # a network of others, with its own demand

For each scenario: every trip by different seeds; at some instants of each the alternatives are asked for, and each
of them is driven to the goal in a branch. The ratio is predicted over driven time; neither depends on how busy the
machine is. The last two columns are for the time that the driving state gives on the route taken (``ahead.eta_s``),
which knows the traffic of the last signal cycle but not the signals that nobody waits at.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from statistics import mean, median
from typing import NamedTuple

from automotive_cosim.contracts import EgoEnd, Reroute
from automotive_cosim.scenarios import shipped
from automotive_cosim.scenery import open_scenario
from automotive_cosim.traffic.base import EgoPlan, Traffic
from automotive_cosim.traffic.fork import Forked

GIVE_UP_S = 3600.0


class Ratios(NamedTuple):
    """Predicted over driven time of one drive."""

    option: float
    """By the alternatives that the map offers."""
    state: float | None
    """By the driving state; None on another route than the one taken."""


def ratios(name: str, seeds: Sequence[int], at_s: Sequence[float], step_s: float | None) -> Iterator[Ratios]:
    scenario = open_scenario(name)
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


def driven(traffic: Traffic) -> Iterator[Ratios]:
    present = traffic.state.ahead
    for option in traffic.alternatives():
        with closing(traffic.branch()) as branch:
            began_s = branch.state.time_s
            if branch.request(Reroute(edges=option.edges)).accepted:
                branch.advance(GIVE_UP_S)
                if branch.state.end is EgoEnd.ARRIVED:
                    driven_s = branch.state.time_s - began_s
                    is_taken = option.edges == present.route_edges
                    yield Ratios(option.eta_s / driven_s, present.eta_s / driven_s if is_taken else None)


def main() -> None:
    parser = argparse.ArgumentParser(description="Predicted over driven times.")
    parser.add_argument("scenarios", nargs="*", default=shipped())
    parser.add_argument("--seeds", nargs="+", type=int, default=[1, 2], help="of traffic and driver")
    parser.add_argument("--at", nargs="+", type=float, default=[5.0, 90.0], help="seconds after departure")
    parser.add_argument("--step", type=float, help="SUMO's step instead of the scenario's own; 1 s is quick")
    asked = parser.parse_args()
    at_s = sorted(asked.at)
    print(f"{'scenario':16}{'drives':>8}{'median ratio':>14}{'mean error':>12}{'state: ratio':>14}{'error':>8}")
    for name in asked.scenarios:
        found = list(ratios(name, asked.seeds, at_s, asked.step))
        offered = [each.option for each in found]
        told = [each.state for each in found if each.state is not None]
        columns = f"{len(found):8}{_median(offered):>14}{_error(offered):>12}{_median(told):>14}{_error(told):>8}"
        print(f"{Path(name).stem:16}{columns}", flush=True)


def _median(found: Sequence[float]) -> str:
    return f"{median(found):.2f}" if found else "-"


def _error(found: Sequence[float]) -> str:
    return f"{mean(abs(ratio - 1) for ratio in found):.0%}" if found else "-"


if __name__ == "__main__":
    main()
