"""The cost of watching the road during a simulation, in processor time per simulated second.

    python benchmarks/looking.py [SCENARIO] [SECONDS]

Drives the first trip in this process and takes a snapshot of every vehicle around the car after each second, as the
recorded road of a run does. Prints the medians of both.
"""

from __future__ import annotations

import statistics
import sys
from contextlib import closing
from time import process_time

from automotive_cosim.scenarios import load
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.in_process import InProcess


def main() -> None:
    scenario = load(sys.argv[1] if len(sys.argv) > 1 else "paris_centre")
    seconds = int(sys.argv[2]) if len(sys.argv) > 2 else 120
    advancing, looking, vehicles = list[float](), list[float](), list[int]()
    with closing(InProcess(scenario, allow_unprojected=True)) as simulation:
        traffic = simulation.depart(EgoPlan(scenario.ego.trips[0], scenario.ego.driver))
        traffic.look()  # SUMO builds its index of lanes at the first look
        while len(looking) < seconds and traffic.state.end is None:
            began_s = process_time()
            traffic.advance(1.0)
            advanced_s = process_time()
            snapshot = traffic.look()
            looking.append(process_time() - advanced_s)
            advancing.append(advanced_s - began_s)
            vehicles.append(len(snapshot.vehicles))
    traffic_ms, look_ms = (1000 * statistics.median(each) for each in (advancing, looking))
    seen = statistics.median(vehicles)
    print(f"{scenario.name}, {len(looking)} s: a second of traffic {traffic_ms:.2f} ms, a look {look_ms:.2f} ms")
    print(f"{seen:.0f} vehicles in sight")


if __name__ == "__main__":
    main()
