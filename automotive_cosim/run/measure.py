"""The cost of the coupling: the same scenario in bare SUMO, in a plain libsumo loop and in the environment.

A step is one of SUMO's, as long as the scenario says (0.1 s in the safety scenarios); the environment's own step of
one simulated second is ten of SUMO's in one message. All figures are medians over repeats in one run.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import asdict, dataclass
from importlib.util import find_spec
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

from automotive_cosim.contracts import Action, ActionType, Json
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.errors import SetupError, TrafficError
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.run.peers import NAMES, WAYS, PeerFigures
from automotive_cosim.scenarios import Scenario, open_scenario
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.confinement import confined
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.traffic.options import Setup, command_line, copied, read_configuration, run_options

TASK = "hvac_fan_max"
"""A task whose trigger holds anywhere: the car is driving."""
SECOND = Action(ActionType.WAIT, seconds=1)
REPEATS = 3
RESETS = 9
PEER_S = 600
"""Most simulated seconds over which peers are compared."""


@dataclass(frozen=True, slots=True)
class Figures:
    """One benchmark. Seconds are wall seconds; None marks what could not be measured here."""

    scenario: str
    vehicles: int
    """Vehicles in the simulation when the ego departs."""
    step_length_s: float
    steps: int
    """SUMO steps measured, after the warm-up."""
    bare_sumo_s_per_step: float | None
    libsumo_s_per_step: float
    in_process_s_per_step: float
    """One process, the whole driving state of every step."""
    in_process_ratio: float
    """Its ratio to bare steps of the same process, block by block."""
    forked_s_per_step: float
    """A simulation in a separate process, every state, ten steps per message."""
    forked_single_s_per_step: float
    """The same with one step per message."""
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
    rss_mb: float | None
    """One environment during an episode: all its processes, with shared pages counted once."""
    rss_per_extra_env_mb: float | None
    """What each additional environment on the same scenario adds."""
    bare_sumo_missing: str | None
    """Why there is no figure for bare SUMO."""
    peers: tuple[PeerFigures, ...] = ()
    """A libsumo loop, the driving states and sumo-rl in steps of a second, if they were asked for."""

    def as_json(self) -> Json:
        """The figures as a JSON object."""
        return asdict(self)


def measure(scenario: str, steps: int, say: Callable[[str], None], *, peers: bool = False) -> Figures:
    """Measures everything, one after the other.

    Args:
        scenario: a name or a folder.
        steps: SUMO steps to measure.
        say: called with what is being measured.
        peers: also compares with sumo-rl, over as many seconds as there are steps, at most ``PEER_S``.

    Raises:
        UserError: the scenario is missing or invalid, or sumo-rl is asked for and not installed.
        InfrastructureError: it does not run.
    """
    loaded = open_scenario(scenario)
    compared: tuple[PeerFigures, ...] = ()
    if peers:
        say("sumo-rl, and the same in steps of a second")
        compared = _peers(scenario, min(steps, PEER_S))
    say("bare sumo")
    bare, missing = _bare(loaded, steps)
    say("plain libsumo loop")
    plain = _plain(loaded, steps)
    say("driving states in one process")
    inside, ratio = _inside(scenario, steps)
    say("reset by reload and warm-up")
    reload_s = median(_seconds_of_reload(loaded) for _ in range(REPEATS))
    with closing(Simulations()) as simulations:
        say("reset by fork")
        fork_s = median(_seconds_of_fork(loaded, simulations))
        with closing(simulations.warm(loaded).depart(_plan(loaded))) as traffic:
            vehicles = traffic.state.vehicle_count
        say("driving states from a separate process")
        forked, single = (
            median(_forked(loaded, steps, at_once, simulations) for _ in range(REPEATS)) for at_once in (10, 1)
        )
        say("environment")
        unrendered = median(_env(scenario, steps, ALL - {Channel.SCREENSHOT}, simulations) for _ in range(REPEATS))
        say("environment with rendering")
        rendered = median(_env(scenario, steps, ALL, simulations) for _ in range(REPEATS))
    say("memory")
    one_mb, extra_mb = _in_own_process("footprint", scenario)
    return Figures(
        scenario=loaded.name,
        vehicles=vehicles,
        step_length_s=loaded.sumo.step_length_s,
        steps=steps,
        bare_sumo_s_per_step=None if bare is None else round(bare, 7),
        libsumo_s_per_step=round(plain, 7),
        in_process_s_per_step=round(inside, 7),
        in_process_ratio=round(ratio, 3),
        forked_s_per_step=round(forked, 7),
        forked_single_s_per_step=round(single, 7),
        env_s_per_step=round(unrendered, 7),
        env_rendered_s_per_step=round(rendered, 7),
        warm_up_s=loaded.sumo.warm_up_s,
        reset_reload_s=round(reload_s, 4),
        reset_fork_s=round(fork_s, 4),
        rss_mb=one_mb,
        rss_per_extra_env_mb=extra_mb,
        bare_sumo_missing=missing,
        peers=compared,
    )


def _bare(scenario: Scenario, steps: int) -> tuple[float | None, str | None]:
    """The ``sumo`` program, continued from the state that it saved after the warm-up."""
    try:
        program = sumo_programs.program("sumo")
    except SetupError as error:
        return None, str(error)
    begin_s = read_configuration(scenario.config).begin_s
    warm_s = begin_s + scenario.sumo.warm_up_s
    end_s = warm_s + steps * scenario.sumo.step_length_s
    with _options(scenario) as (own, scratch):
        options = own | {"duration-log.disable": "false"}
        state = "warm.xml.gz"
        saving = {"save-state.times": f"{warm_s:g}", "save-state.files": state, "save-state.rng": "true"}
        _seconds_of_program(program, options | saving | {"end": f"{warm_s + 1:g}"}, warm_s, scratch)
        going_on = options | {"load-state": state, "begin": f"{warm_s:g}", "end": f"{end_s:g}"}
        found = [_seconds_of_program(program, going_on, end_s - warm_s, scratch) for _ in range(REPEATS)]
    return median(found) / steps, None


def _seconds_of_program(program: Path, options: Mapping[str, str], simulated_s: float, scratch: Path) -> float:
    """The time that SUMO reports, without loading; its real time factor has more digits than its duration."""
    command = confined(scratch, [str(program), "--verbose", *command_line(options)[1:]])
    environment = sumo_programs.environment()
    done = subprocess.run(command, cwd=scratch, env=environment, capture_output=True, text=True, check=False)
    factor = re.search(r"Real time factor: ([\d.]+)", done.stdout)
    if done.returncode != 0 or factor is None:
        raise TrafficError("sumo failed: " + sumo_programs.first_error(done.stderr + done.stdout))
    return simulated_s / float(factor.group(1))


def _plain(scenario: Scenario, steps: int) -> float:
    """Seconds per step of a loop over libsumo."""
    with _options(scenario) as (options, scratch):
        warm_up_steps = round(scenario.sumo.warm_up_s / scenario.sumo.step_length_s)
        command = command_line(options)
        job = json.dumps(
            {"command": command, "folder": str(scratch), "warm_up_steps": warm_up_steps, "steps": steps}
        )
        return float(median(_in_own_process("plain", job) for _ in range(REPEATS))) / steps


def _in_own_process(module: str, *arguments: str, environment: Mapping[str, str] | None = None) -> Any:
    """What a module of this package prints, as JSON."""
    command = [sys.executable, "-m", f"{__package__}.{module}", *arguments]
    done = subprocess.run(command, capture_output=True, check=False, env=environment)
    if done.returncode != 0:
        raise TrafficError(f"the part {module!r} failed: " + done.stderr.decode("utf-8", "replace")[-300:])
    return json.loads(done.stdout.splitlines()[-1])


def _peers(scenario: str, seconds: int) -> tuple[PeerFigures, ...]:
    """The ways in turn, so that a busy machine slows all of them down; of each the fastest."""
    if find_spec("sumo_rl") is None:
        raise SetupError("this compares with sumo-rl, which is not installed: pip install sumo-rl eclipse-sumo")
    environment = {**sumo_programs.environment(), "LIBSUMO_AS_TRACI": "1"}
    found: dict[str, list[PeerFigures]] = {way: [] for way in WAYS}
    for _ in range(REPEATS):
        for way, figures in found.items():
            told = _in_own_process("peers", way, scenario, str(seconds), environment=environment)
            figures.append(PeerFigures(NAMES[way], **told))
    return tuple(
        PeerFigures(
            NAMES[way],
            round(min(each.s_per_second for each in figures), 7),
            min((round(each.reset_s, 4) for each in figures if each.reset_s is not None), default=None),
        )
        for way, figures in found.items()
    )


@contextmanager
def _options(scenario: Scenario) -> Iterator[tuple[dict[str, str], Path]]:
    """SUMO's options, the same as in the environment's simulation, and the folder to run in."""
    with tempfile.TemporaryDirectory(prefix="automotive-cosim-bench-") as name:
        scratch = Path(name)
        yield run_options(copied(read_configuration(scenario.config), scratch), Setup(scenario)), scratch


def _plan(scenario: Scenario) -> EgoPlan:
    return EgoPlan(scenario.ego.trips[0], scenario.ego.driver)


def _inside(scenario: str, steps: int) -> tuple[float, float]:
    """Seconds per step in one process, and the ratio to bare steps measured with it."""
    found = [_in_own_process("inside", scenario, str(steps)) for _ in range(REPEATS)]
    return median(each["full"] for each in found), median(each["full"] / each["bare"] for each in found)


def _forked(scenario: Scenario, steps: int, at_once: int, simulations: Simulations) -> float:
    """Seconds per step of a drive in a separate process."""
    simulation, step_s = simulations.warm(scenario), scenario.sumo.step_length_s
    seconds, done = 0.0, 0
    while done < steps:
        with closing(simulation.depart(_plan(scenario))) as traffic:
            while done < steps and traffic.state.end is None:
                began_s = perf_counter()
                count = len(traffic.advance(at_once * step_s).states)
                seconds += perf_counter() - began_s
                done += count
    return seconds / done


def _seconds_of_reload(scenario: Scenario) -> float:
    began_s = perf_counter()
    with (
        closing(Simulations()) as simulations,
        closing(simulations.warm(scenario).depart(_plan(scenario))),
    ):
        return perf_counter() - began_s


def _seconds_of_fork(scenario: Scenario, simulations: Simulations) -> list[float]:
    simulation = simulations.warm(scenario)
    seconds = []
    for _ in range(RESETS):
        began_s = perf_counter()
        with closing(simulation.depart(_plan(scenario))):
            seconds.append(perf_counter() - began_s)
    return seconds


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
