"""The two-route network of RouteRL and URB, beside RouteRL itself: the same game, its figures, and time for a day.

    python benchmarks/route_choice.py runs/route_choice --cars 22 --days 10

The network is drawn anew from what RouteRL publishes of it (E0 leads to a straight way and a way round, where the
straight one gives way at their end; everywhere 13.89 m/s); RouteRL runs with its own, in an environment that this
makes with pip. Departures are those that RouteRL draws. Each car chooses one of two ways as it sets out: all the
first, all the second, or by turns. RouteRL's times are two seconds longer than SUMO's (`findings/`).
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
import venv
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from statistics import fmean, median

from automotive_cosim.contracts import Reroute
from automotive_cosim.studies.adoption.adoption import AdoptionPlan
from automotive_cosim.studies.calls.chosen import day, prepare
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.fork import Forked

PACKAGES = ("routerl==2.0.0", "eclipse-sumo==1.28.0"), ("--no-deps", "libsumo==1.28.0")
"""What each installation gets: libsumo names a traci that RouteRL does not allow, and needs none."""
LONGER_S = 2.0
"""What RouteRL adds to SUMO's duration and departure delay."""
WARM_UP_S = 10
"""Ours warms up, so its departures are that much later."""
FIRST, SECOND = ("E0", "E1", "E7", "E2"), ("E0", "E3", "E4", "E5", "E2")
NODES = {"J0": (0.0, 100.0), "J1": (100.0, 100.0), "J6": (173.97, 100.0), "J2": (200.0, 100.0)}
NODES |= {"J3": (300.0, 100.0), "J4": (100.0, 87.5), "J5": (200.0, 87.5)}
EDGES = {"E0": "J0 J1", "E1": "J1 J6", "E7": "J6 J2", "E2": "J2 J3", "E3": "J1 J4", "E4": "J4 J5", "E5": "J5 J2"}
CHOICES: Mapping[str, Callable[[int], int]] = {
    "all the first": lambda number: 0,
    "all the second": lambda number: 1,
    "by turns": lambda number: number % 2,
}
THEIRS = """
import json, sys, time
import numpy as np
from routerl import TrafficEnvironment
cars, days, libsumo = map(int, sys.argv[1:])
env = TrafficEnvironment(
    seed=42,
    agent_parameters={"num_agents": cars, "new_machines_after_mutation": cars,
                      "machine_parameters": {"observation_type": "previous_agents_plus_start_time"}},
    simulator_parameters={"network_name": "two_route_yield", "simulation_timesteps": 180,
                          "use_libsumo": libsumo == 1},
    path_generation_parameters={"number_of_paths": 2, "visualize_paths": False},
    plotter_parameters={"plot_choices": "none"},
)
env.start()
env.mutation(mutation_start_percentile=-1)
env.reset()
starts = {str(agent.id): agent.start_time for agent in env.all_agents}
order = sorted(starts, key=lambda car: (starts[car], int(car)))
found = {}
for number, choose in enumerate((lambda n: 0, lambda n: 1, lambda n: n % 2)):
    took, means = [], []
    for _ in range(days):
        begun = time.perf_counter()
        for agent in env.agent_iter():
            env.step(None if any(env.last()[2:4]) else choose(order.index(agent)))
        means.append(60 * float(np.mean([each["travel_time"] for each in env.last_episode_travel_times])))
        env.reset()
        took.append(time.perf_counter() - begun)
    found[number] = np.mean(means), np.median(took)
env.stop_simulation()
json.dump({"starts": [starts[car] for car in order], "found": list(found.values())}, open("theirs.json", "w"))
"""


def ours(folder: Path, starts: Sequence[int], days: int) -> list[tuple[float, float]]:
    """Mean travel time and the median wall time of a day, in seconds, for each rule."""
    nodes = "".join(f'<node id="{name}" x="{x}" y="{y}"/>' for name, (x, y) in NODES.items())
    form = '<edge id="{}" from="{}" to="{}" speed="13.89" priority="-1"/>'
    edges = "".join(form.format(name, *ends.split()) for name, ends in EDGES.items())
    form = (
        '<vehicle id="{}" depart="{}" type="AV" route="first" departSpeed="0" departLane="first"/>'  # as TraCI adds
    )
    cars = "".join(form.format(number, start_s + WARM_UP_S) for number, start_s in enumerate(starts))
    (folder / "two.nod.xml").write_text(f"<nodes>{nodes}</nodes>")
    (folder / "two.edg.xml").write_text(f"<edges>{edges}</edges>")
    (folder / "two.rou.xml").write_text(
        f'<routes><vType id="AV"/><route id="first" edges="{" ".join(FIRST)}"/>{cars}</routes>'
    )
    (folder / "two.sumocfg").write_text(
        '<configuration><input><net-file value="two.net.xml"/><route-files value="two.rou.xml"/></input>'
        "</configuration>"
    )
    made = ["-n", "two.nod.xml", "-e", "two.edg.xml", "-o", "two.net.xml", "--no-turnarounds", "true"]
    made += ["--junctions.limit-turn-speed", "5.5"]
    is_made, printed = sumo_programs.run("netconvert", made, folder)
    if not is_made:
        sys.exit(printed)
    plan = AdoptionPlan(str(folder / "two.sumocfg"), warm_up_s=WARM_UP_S)
    found = []
    with closing(Forked(plan.scene(), 42, allow_unprojected=True)) as warm:
        warm.call(prepare)
        for choose in CHOICES.values():
            took_s, means = [], []
            for _ in range(days):
                begun_s = time.perf_counter()
                asked = {str(car): Reroute(edges=SECOND) for car in range(len(starts)) if choose(car)}
                trips = day(warm, asked, max(starts) + 120.0).values()
                means.append(fmean(trip.until_s - trip.planned_s for trip in trips))
                took_s.append(time.perf_counter() - begun_s)
            found.append((fmean(means), median(took_s)))
    return found


def main() -> None:
    """Runs both and prints a table of Markdown."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--cars", type=int, default=22, help="cars a day")
    parser.add_argument("--days", type=int, default=10, help="days of each rule")
    parser.add_argument("--libsumo", action="store_true", help="RouteRL over libsumo instead of TraCI")
    told = parser.parse_args()
    folder = told.folder.resolve()
    home = folder / "routerl"
    if not home.exists():
        folder.mkdir(parents=True, exist_ok=True)
        venv.create(home, with_pip=True)
        for packages in PACKAGES:
            subprocess.run([home / "bin/pip", "install", "-q", *packages], check=True)
    sumo = next(home.glob("lib/*/site-packages/sumo"))
    around = os.environ | {"SUMO_HOME": str(sumo), "PATH": f"{sumo / 'bin'}:{os.environ['PATH']}"}
    command = [home / "bin/python", "-c", THEIRS, str(told.cars), str(told.days), str(int(told.libsumo))]
    subprocess.run(command, cwd=folder, env=around, check=True, stdout=subprocess.DEVNULL)
    theirs = json.loads((folder / "theirs.json").read_text())
    mine = ours(folder, theirs["starts"], told.days)
    print("| cars choose | RouteRL, s | ours, s | RouteRL, s a day | ours, s a day | ratio |")
    print("|---|--:|--:|--:|--:|--:|")
    for name, (their_s, their_day_s), (own_s, own_day_s) in zip(CHOICES, theirs["found"], mine, strict=True):
        print(
            f"| {name} | {their_s - LONGER_S:.1f} | {own_s:.1f} | {their_day_s:.3f} | {own_day_s:.3f} | "
            f"{own_day_s / their_day_s:.2f} |"
        )


if __name__ == "__main__":
    main()
