"""The cost of a second of traffic here and in sumo-rl, on the same network with the same demand.

    pip install sumo-rl eclipse-sumo
    python benchmarks/peers.py                                   # paris_centre
    python benchmarks/peers.py /path/to/any.sumocfg --seconds 1200

Every figure comes from a separate process, at SUMO steps of one second, after the scenario's warm-up. sumo-rl
keeps the signals' programs and reads their lanes every five seconds; here the whole state of one car is read
every second, in a separate process, ten in a message. These are different questions: the ratio tells what each
adds to SUMO.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from time import perf_counter

from automotive_cosim.scenarios import Scenario, open_scenario
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.traffic.options import Setup, command_line, copied, read_configuration, run_options

SUMO_RL_S = 5
"""Seconds between two actions of sumo-rl, by default."""


def plain(scenario: Scenario, seconds: int) -> float:
    import libsumo

    with tempfile.TemporaryDirectory() as scratch:
        copies = copied(read_configuration(scenario.config), Path(scratch))
        os.chdir(scratch)
        libsumo.start(command_line(run_options(copies, Setup(scenario))))
        for _ in range(round(scenario.sumo.warm_up_s)):
            libsumo.simulationStep()
        began_s = perf_counter()
        for _ in range(seconds):
            libsumo.simulationStep()
        taken_s = perf_counter() - began_s
        libsumo.close()
        os.chdir(scenario.config.parent)
    return taken_s


def sumo_rl(scenario: Scenario, seconds: int) -> float:
    from sumo_rl import SumoEnvironment

    configuration = read_configuration(scenario.config)
    env = SumoEnvironment(
        str(configuration.net),
        ",".join(map(str, configuration.files["route-files"])),
        num_seconds=10**6,
        delta_time=SUMO_RL_S,
        fixed_ts=True,  # with its own signals libsumo 1.28 hangs in a step on some of the networks
        sumo_seed=0,
        sumo_warnings=False,
        additional_sumo_cmd=f"-c {scenario.config} --step-length 1 --no-step-log",
    )
    env.reset()

    def act(count: int) -> None:
        for _ in range(count // SUMO_RL_S):
            env.step({})

    act(round(scenario.sumo.warm_up_s))
    began_s = perf_counter()
    act(seconds)
    taken_s = perf_counter() - began_s
    env.close()
    return taken_s


def driving_states(scenario: Scenario, seconds: int) -> float:
    taken_s, done = 0.0, 0
    with closing(Simulations()) as simulations:
        while done < seconds:
            plan = EgoPlan(scenario.ego.trips[0], scenario.ego.driver, done)
            with closing(simulations.warm(scenario, allow_unprojected=True).depart(plan)) as traffic:
                while done < seconds and traffic.state.end is None:
                    began_s = perf_counter()
                    done += len(traffic.advance(10.0).states)
                    taken_s += perf_counter() - began_s
    return taken_s


WAYS: dict[str, tuple[Callable[[Scenario, int], float], dict[str, str]]] = {
    "libsumo loop": (plain, {}),
    "driving states, forked": (driving_states, {}),
    "sumo-rl, libsumo": (sumo_rl, {"LIBSUMO_AS_TRACI": "1"}),
    "sumo-rl, traci": (sumo_rl, {}),
}
"""How to measure each, and the environment variables that it needs."""


def opened(name: str) -> Scenario:
    scenario = open_scenario(name)
    sumo = replace(scenario.sumo, step_length_s=1.0, action_step_length_s=1.0)
    return replace(scenario, sumo=sumo)


def main() -> None:
    parser = argparse.ArgumentParser(description="The cost of a second of traffic, here and in sumo-rl.")
    parser.add_argument("scenario", nargs="?", default="paris_centre", help="name, folder, .sumocfg or .net.xml")
    parser.add_argument("--seconds", type=int, default=600, help="of traffic to measure, after the warm-up")
    parser.add_argument("--repeats", type=int, default=3, help="of each; the fastest counts")
    parser.add_argument("--measure", choices=WAYS, help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.measure:
        print("took", WAYS[asked.measure][0](opened(asked.scenario), asked.seconds))
        return
    reference_ms: float | None = None
    print(f"{'':24}{'ms per second':>14}{'of the loop':>14}")
    for name, (_, needed) in WAYS.items():
        command = [sys.executable, __file__, asked.scenario, f"--seconds={asked.seconds}", f"--measure={name}"]
        environment = {**os.environ, **sumo_programs.environment(), **needed}
        seconds = []
        for _ in range(asked.repeats):
            done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
            took = [line.split()[1] for line in done.stdout.splitlines() if line.startswith("took")]
            if not took:
                print(f"{name:24}{'-':>14}  {done.stderr.strip().splitlines()[-1:]}")
                break
            seconds.append(float(took[0]))
        else:
            ms = 1000 * min(seconds) / asked.seconds
            reference_ms = reference_ms or ms
            print(f"{name:24}{ms:14.3f}{ms / reference_ms:14.2f}", flush=True)


if __name__ == "__main__":
    main()
