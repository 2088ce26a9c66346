"""The accuracy of predicted travel times: every offered route is driven in a branch of its own.

    python benchmarks/eta.py                     # all shipped scenarios
    python benchmarks/eta.py grid paris_centre --seeds 1 2 --at 5 90
    python benchmarks/eta.py town/run.sumocfg    # any other network, with its own demand

For each scenario: every trip by different seeds; at some instants of each the alternatives are requested, and each
of them is driven to the goal in a branch. The ratio is predicted over driven time; neither depends on how busy the
machine is. The columns ``state`` are for the time that the driving state gives on the way taken (``ahead.eta_s``),
which knows the traffic of the last signal cycle but not the signals that nobody waits at.

With ``--later 15 30 45`` each trip also departs that many seconds later, into other phases of the same signals. The
last column is then the error of a forecast with hindsight, the mean of a route's driven times: no forecast by mean
times does better, because to it the state of the lights is chance.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from itertools import product
from pathlib import Path
from statistics import mean, median
from typing import NamedTuple

from automotive_cosim.contracts import EgoEnd, Reroute
from automotive_cosim.scenarios import open_scenario, shipped
from automotive_cosim.traffic.base import EgoPlan, Traffic
from automotive_cosim.traffic.fork import Forked

GIVE_UP_S = 3600.0


class Drive(NamedTuple):
    """One route, predicted and driven."""

    asked: tuple[object, ...]
    """Seed, instant and route: what drives share that differ only in their departure."""
    driven_s: float
    option_s: float
    """Predicted by the alternatives that the map offers."""
    state_s: float | None
    """Predicted by the driving state; None on routes other than the one taken."""


def drives(
    name: str, seeds: Sequence[int], at_s: Sequence[float], later_s: Sequence[float], step_s: float | None
) -> Iterator[Drive]:
    scenario = open_scenario(name)
    if step_s is not None:
        scenario = replace(scenario, sumo=replace(scenario.sumo, step_length_s=step_s))
    for seed in seeds:
        with closing(Forked(scenario, seed, allow_unprojected=True)) as simulation:
            for trip, wait_s in product(scenario.ego.trips, (0.0, *later_s)):
                with closing(simulation.depart(EgoPlan(trip, "average", seed, wait_s=wait_s))) as traffic:
                    for instant_s, before_s in zip(at_s, (0.0, *at_s), strict=False):
                        traffic.advance(instant_s - before_s)
                        if traffic.state.end is None:
                            yield from driven(traffic, (seed, instant_s))


def driven(traffic: Traffic, asked: tuple[object, ...]) -> Iterator[Drive]:
    present = traffic.state.ahead
    for option in traffic.alternatives():
        with closing(traffic.branch()) as branch:
            began_s = branch.state.time_s
            if branch.request(Reroute(edges=option.edges)).accepted:
                branch.advance(GIVE_UP_S)
                if branch.state.end is EgoEnd.ARRIVED:
                    driven_s = branch.state.time_s - began_s
                    state_s = present.eta_s if option.edges == present.route_edges else None
                    yield Drive((*asked, option.edges), driven_s, option.eta_s, state_s)


def hindsight(found: Sequence[Drive]) -> Iterator[float]:
    """Mean over driven time of routes that were driven from several departures."""
    together: dict[tuple[object, ...], list[float]] = {}
    for each in found:
        together.setdefault(each.asked, []).append(each.driven_s)
    for times_s in together.values():
        if len(times_s) > 1:
            yield from (mean(times_s) / time_s for time_s in times_s)


def main() -> None:
    parser = argparse.ArgumentParser(description="Predicted over driven times.")
    parser.add_argument("scenarios", nargs="*", default=shipped())
    parser.add_argument("--seeds", nargs="+", type=int, default=[1, 2], help="of traffic and driver")
    parser.add_argument("--at", nargs="+", type=float, default=[5.0, 90.0], help="seconds after departure")
    parser.add_argument("--later", nargs="+", type=float, default=[], help="also depart this many seconds later")
    parser.add_argument("--step", type=float, help="SUMO's step instead of the scenario's own; 1 s is quick")
    asked = parser.parse_args()
    at_s = sorted(asked.at)
    heads = f"{'drives':>8}{'median ratio':>14}{'mean error':>12}{'state: ratio':>14}{'error':>8}{'hindsight':>11}"
    print(f"{'scenario':16}{heads}")
    for name in asked.scenarios:
        found = list(drives(name, asked.seeds, at_s, asked.later, asked.step))
        offered = [each.option_s / each.driven_s for each in found]
        told = [each.state_s / each.driven_s for each in found if each.state_s is not None]
        columns = f"{len(found):8}{_median(offered):>14}{_error(offered):>12}{_median(told):>14}{_error(told):>8}"
        print(f"{Path(name).stem:16}{columns}{_error(list(hindsight(found))):>11}", flush=True)


def _median(found: Sequence[float]) -> str:
    return f"{median(found):.2f}" if found else "-"


def _error(found: Sequence[float]) -> str:
    return f"{mean(abs(ratio - 1) for ratio in found):.0%}" if found else "-"


if __name__ == "__main__":
    main()
