"""The cost of the coupling: the same traffic in a libsumo loop, in a forked simulation and in the environment.

A step is one of SUMO's, as long as the scenario says (0.1 s in the safety scenarios); the environment's own step of
one simulated second is ten of SUMO's in one message. All times are medians over repeats. Run as a module, with
``loop`` or ``memory`` and a scenario, it measures that part alone, in a process that has done nothing else.
"""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from contextlib import closing
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

from automotive_cosim.agents.cleanup import tree
from automotive_cosim.contracts import Action, ActionType, Json
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.errors import TrafficError
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.scenarios import Scenario, open_scenario
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.confinement import confine
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.traffic.options import Setup, command_line, copied, read_configuration, run_options
from automotive_cosim.traffic.sumo import load_library

TASK = "hvac_fan_max"
"""A task whose trigger holds anywhere: the car is driving."""
SECOND = Action(ActionType.WAIT, seconds=1)
REPEATS, RESETS, AT_ONCE = 3, 9, 10
EXTRA_ENVS = 3
SECONDS = 10
"""Driven before memory is read."""


@dataclass(frozen=True, slots=True)
class Figures:
    """One benchmark. Seconds are wall seconds."""

    scenario: str
    vehicles: int
    """Vehicles in the simulation when the ego departs."""
    step_length_s: float
    steps: int
    """SUMO steps measured, after the warm-up."""
    libsumo_s_per_step: float
    forked_s_per_step: float
    """A simulation in a separate process, every state, ten steps per message."""
    env_s_per_step: float
    """With every channel except the screenshot."""
    env_rendered_s_per_step: float
    """With a screenshot of the cockpit per simulated second."""
    warm_up_s: float
    """Simulated seconds of traffic before the ego departs."""
    reset_reload_s: float
    """Loading, warming up and departing."""
    reset_fork_s: float
    """Departing from the warm simulation."""
    rss_mb: float
    """One environment during an episode: all its processes, with shared pages counted once."""
    rss_per_extra_env_mb: float
    """What each additional environment on the same scenario adds."""

    def as_json(self) -> Json:
        return asdict(self)


def measure(scenario: str, steps: int, say: Callable[[str], None]) -> Figures:
    """Measures everything, one after the other.

    Args:
        scenario: a name or a folder.
        say: called with what is being measured.

    Raises:
        UserError: the scenario is missing or invalid.
        InfrastructureError: it does not run."""
    loaded = open_scenario(scenario)
    say("plain libsumo loop")
    with tempfile.TemporaryDirectory(prefix="automotive-cosim-bench-") as folder:
        loop_s = median(_in_own_process("loop", scenario, str(steps), folder) for _ in range(REPEATS))
    say("reset by reload and warm-up")
    reload_s = median(_seconds_of_reload(loaded) for _ in range(REPEATS))
    with closing(Simulations()) as simulations:
        say("reset by fork")
        fork_s = median(_seconds_of_fork(loaded, simulations) for _ in range(RESETS))
        with closing(simulations.warm(loaded).depart(_plan(loaded))) as traffic:
            vehicles = traffic.state.vehicle_count
        say("driving states from a separate process")
        forked_s = median(_forked(loaded, steps, simulations) for _ in range(REPEATS))
        say("environment")
        plain_s = median(_env(scenario, steps, ALL - {Channel.SCREENSHOT}, simulations) for _ in range(REPEATS))
        say("environment with rendering")
        rendered_s = median(_env(scenario, steps, ALL, simulations) for _ in range(REPEATS))
    say("memory")
    one_mb, extra_mb = _in_own_process("memory", scenario)
    return Figures(
        loaded.name, vehicles, loaded.sumo.step_length_s, steps,
        round(loop_s, 7), round(forked_s, 7), round(plain_s, 7), round(rendered_s, 7),
        loaded.sumo.warm_up_s, round(reload_s, 4), round(fork_s, 4), one_mb, extra_mb,
    )  # fmt: skip


def _in_own_process(*arguments: str) -> Any:
    """What a part of this module prints, as JSON."""
    done = subprocess.run([sys.executable, "-m", __name__, *arguments], capture_output=True, check=False)
    if done.returncode != 0:
        raise TrafficError(f"the part {arguments[0]!r} failed: " + done.stderr.decode("utf-8", "replace")[-300:])
    return json.loads(done.stdout.splitlines()[-1])


def _loop(scenario: Scenario, steps: int, folder: Path) -> float:
    """Seconds per step of a loop over libsumo, with the options of the environment's simulation."""
    options = run_options(copied(read_configuration(scenario.config), folder), Setup(scenario))
    sumo = load_library()
    os.chdir(folder)
    confine([folder])
    sumo.start(command_line(options))
    for _ in range(round(scenario.sumo.warm_up_s / scenario.sumo.step_length_s)):
        sumo.step()
    began_s = perf_counter()
    for _ in range(steps):
        sumo.step()
    seconds = perf_counter() - began_s
    sumo.close()
    return seconds / steps


def _memory(scenario: str) -> tuple[float, float]:
    """Megabytes of one environment during an episode, and what each additional one adds."""
    with closing(Simulations()) as simulations:
        envs = [CockpitEnv(TASK, scenario=scenario, simulations=simulations) for _ in range(1 + EXTRA_ENVS)]
        read_mb = []
        for env in envs:
            env.reset(seed=0)
            for _ in range(SECONDS):
                env.step(SECOND)
            read_mb.append(pss_mb())
        for env in envs:
            env.close()
    return round(read_mb[0], 1), round((read_mb[-1] - read_mb[0]) / EXTRA_ENVS, 1)


def pss_mb() -> float:
    """Megabytes of this process and all below it, with the pages that several share counted once."""
    return sum(map(_pss_kb, tree(os.getpid()))) / 1024


def _pss_kb(pid: int) -> int:
    try:
        text = Path(f"/proc/{pid}/smaps_rollup").read_text()
    except OSError:  # it has ended
        return 0
    return next((int(line.split()[1]) for line in text.splitlines() if line.startswith("Pss:")), 0)


def _plan(scenario: Scenario) -> EgoPlan:
    return EgoPlan(scenario.ego.trips[0], scenario.ego.driver)


def _forked(scenario: Scenario, steps: int, simulations: Simulations) -> float:
    """Seconds per step of a drive in a separate process."""
    simulation, step_s = simulations.warm(scenario), scenario.sumo.step_length_s
    seconds, done = 0.0, 0
    while done < steps:
        with closing(simulation.depart(_plan(scenario))) as traffic:
            while done < steps and traffic.state.end is None:
                began_s = perf_counter()
                count = len(traffic.advance(AT_ONCE * step_s).states)
                seconds += perf_counter() - began_s
                done += count
    return seconds / done


def _seconds_of_reload(scenario: Scenario) -> float:
    with closing(Simulations()) as simulations:
        return _seconds_of_fork(scenario, simulations)


def _seconds_of_fork(scenario: Scenario, simulations: Simulations) -> float:
    began_s = perf_counter()
    with closing(simulations.warm(scenario).depart(_plan(scenario))):
        return perf_counter() - began_s


def _env(scenario: str, steps: int, channels: frozenset[Channel], simulations: Simulations) -> float:
    """Seconds per SUMO step of an environment whose agent waits, without resets and judging."""
    env = CockpitEnv(TASK, scenario=scenario, channels=channels, max_steps=steps + 1, simulations=simulations)
    with closing(env):
        per_second = round(1 / env.scenario.sumo.step_length_s)
        env.reset(seed=0)
        seconds, done = 0.0, 0
        while done < steps:
            began_s = perf_counter()
            _, _, terminated, _, _ = env.step(SECOND)
            if terminated:
                env.reset()
                continue
            seconds += perf_counter() - began_s
            done += per_second
        return seconds / done


if __name__ == "__main__":
    part, name, *rest = sys.argv[1:]
    print(
        json.dumps(_memory(name) if part == "memory" else _loop(open_scenario(name), int(rest[0]), Path(rest[1])))
    )
