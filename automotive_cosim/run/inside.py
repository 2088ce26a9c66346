"""The cost of reading the whole driving state in one process, compared with bare steps of the same traffic.

    python -m automotive_cosim.run.inside grid 2000

prints the processor seconds per step of both as JSON. One thread that never waits, so on an idle machine they equal
the wall time. Blocks of ten steps alternate, bare and with every state, so that a busy machine slows both down
equally; which comes first alternates too, so that what SUMO does every other second affects both.
"""

from __future__ import annotations

import json
import sys
from contextlib import closing
from time import process_time

from automotive_cosim.scenarios import load
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.in_process import InProcess, InProcessTraffic

BLOCK = 10


def measure(traffic: InProcessTraffic, steps: int, step_s: float) -> tuple[float, float, int]:
    """Bare and full seconds, and the steps of each, until the ego's drive ends."""

    def bare() -> float:
        began_s = process_time()
        for _ in range(BLOCK):
            traffic.bare_step()
        return process_time() - began_s

    def full() -> float:
        began_s = process_time()
        traffic.advance(BLOCK * step_s)
        return process_time() - began_s

    seconds = {bare: 0.0, full: 0.0}
    done = 0
    order = (bare, full)
    while done < steps:
        found = [(kind, kind()) for kind in order]
        if traffic.state.end is not None:
            break
        for kind, took_s in found:
            seconds[kind] += took_s
        order = order[::-1]
        done += BLOCK
    return seconds[bare], seconds[full], done


def main() -> None:
    """Measures the scenario of the first argument over the number of steps of the second."""
    scenario, steps = load(sys.argv[1]), int(sys.argv[2])
    bare_s = full_s = 0.0
    done = 0
    with closing(InProcess(scenario, allow_unprojected=True)) as simulation:
        while done < steps:
            traffic = simulation.depart(EgoPlan(scenario.ego.trips[0], scenario.ego.driver))
            bare, full, count = measure(traffic, steps - done, scenario.sumo.step_length_s)
            bare_s, full_s, done = bare_s + bare, full_s + full, done + count
    print(json.dumps({"bare": bare_s / done, "full": full_s / done}))


if __name__ == "__main__":
    main()
