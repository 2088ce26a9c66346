"""The cost of a second of traffic and of a new episode, here and in sumo-rl, in the same network and demand.

    pip install sumo-rl eclipse-sumo
    automotive-cosim bench --peers
    python -m automotive_cosim.run.peers sumo_rl grid 600              # one of them, in this process

SUMO runs in steps of one second. sumo-rl keeps the signals' programs and reads their lanes every five seconds; here
the whole state of one car is read every second, in a separate process, ten in a message. These are different
questions: the ratios tell what each adds to SUMO. A new episode begins after the scenario's warm-up.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter

from automotive_cosim.scenarios import Scenario, open_scenario
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.traffic.in_process import InProcess
from automotive_cosim.traffic.options import Setup, command_line, copied, read_configuration, run_options
from automotive_cosim.traffic.sumo import load_library

SUMO_RL_S = 5
"""Seconds between two actions of sumo-rl, by default."""
EPISODE_S = 300.0
"""Length of an episode over which a reset is spread."""


@dataclass(frozen=True, slots=True)
class PeerFigures:
    """What one way of running the traffic costs."""

    name: str
    s_per_second: float
    """Wall seconds per simulated second, the fastest of the repeats."""
    reset_s: float | None = None
    """Wall seconds until a second episode is under way; None for a loop without episodes."""

    @property
    def s_per_second_of_episodes(self) -> float | None:
        """The same in episodes of ``EPISODE_S``, resets included."""
        return None if self.reset_s is None else self.s_per_second + self.reset_s / EPISODE_S


def libsumo_loop(scenario: Scenario, seconds: int) -> tuple[float, float | None]:
    """A loop over ``simulationStep`` that reads nothing."""
    sumo = load_library()
    with tempfile.TemporaryDirectory() as scratch:
        copies = copied(read_configuration(scenario.config), Path(scratch))
        os.chdir(scratch)
        sumo.start(command_line(run_options(copies, Setup(scenario))))
        for _ in range(round(scenario.sumo.warm_up_s)):
            sumo.step()
        began_s = perf_counter()
        for _ in range(seconds):
            sumo.step()
        taken_s = perf_counter() - began_s
        sumo.close()
        os.chdir(scenario.config.parent)
    return taken_s, None


def states_in_one_process(scenario: Scenario, seconds: int) -> tuple[float, float | None]:
    """Every state of one car, one drive after another in the same traffic."""
    plan = EgoPlan(scenario.ego.trips[0], scenario.ego.driver)
    taken_s, done = 0.0, 0
    with closing(InProcess(scenario, allow_unprojected=True)) as simulation:
        while done < seconds:
            traffic = simulation.depart(plan)
            began_s = perf_counter()
            while done < seconds and traffic.state.end is None:
                done += len(traffic.advance(10.0).states)
            taken_s += perf_counter() - began_s
    return taken_s, None


def states_forked(scenario: Scenario, seconds: int) -> tuple[float, float | None]:
    """Every state of one car, from a simulation in a process of its own."""
    plan = EgoPlan(scenario.ego.trips[0], scenario.ego.driver)
    taken_s, resets_s, done = 0.0, list[float](), 0
    with closing(Simulations()) as simulations:
        warm = simulations.warm(scenario, allow_unprojected=True)
        while done < seconds:
            began_s = perf_counter()
            with closing(warm.depart(plan)) as traffic:
                resets_s.append(perf_counter() - began_s)
                began_s = perf_counter()
                while done < seconds and traffic.state.end is None:
                    done += len(traffic.advance(10.0).states)
                taken_s += perf_counter() - began_s
    return taken_s, min(resets_s)


def sumo_rl(scenario: Scenario, seconds: int) -> tuple[float, float | None]:
    """sumo-rl's environment, which restarts SUMO for a new episode."""
    from sumo_rl import SumoEnvironment  # pyright: ignore[reportMissingImports]

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

    def act(count: int) -> float:
        began_s = perf_counter()
        for _ in range(count // SUMO_RL_S):
            env.step({})
        return perf_counter() - began_s

    env.reset()
    act(round(scenario.sumo.warm_up_s))
    taken_s = act(seconds)
    began_s = perf_counter()
    env.reset()
    act(round(scenario.sumo.warm_up_s))
    reset_s = perf_counter() - began_s
    env.close()
    return taken_s, reset_s


WAYS: dict[str, Callable[[Scenario, int], tuple[float, float | None]]] = {
    way.__name__: way for way in (libsumo_loop, states_in_one_process, states_forked, sumo_rl)
}
NAMES = {
    "libsumo_loop": "libsumo loop",
    "states_in_one_process": "driving states, one process",
    "states_forked": "driving states, forked",
    "sumo_rl": "sumo-rl over libsumo",
}
"""What each is called in tables."""


def main() -> None:
    """Measures the way of the first argument in the scenario of the second over the seconds of the third."""
    scenario = open_scenario(sys.argv[2])
    taken_s, reset_s = WAYS[sys.argv[1]](replace(scenario, sumo=scenario.sumo.stepping(1.0)), int(sys.argv[3]))
    print(json.dumps({"s_per_second": taken_s / int(sys.argv[3]), "reset_s": reset_s}))


if __name__ == "__main__":
    main()
