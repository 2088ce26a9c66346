"""The cost of a decision: run ``python benchmarks/decisions.py [--profile] [--check]``.

Plays random actions, drawn from a seed, on ``grid`` and prints processor time, which depends less on a busy
machine than wall time: that of this process, with cockpit, place and judge, and that of the simulations' processes.

| figure | what |
|---|---|
| ``decision_ms`` | of this process, per decision, resets and verdicts included |
| ``sumo_ms`` | of the simulations' processes, likewise |
| ``step_ms``, ``reset_ms`` | of this process, ``step`` and ``reset`` alone; medians |
| ``reset_sumo_ms``, ``reset_wall_ms`` | of the simulations' processes, and wall time, for a reset on warm traffic |
| ``per_s`` | decisions per second of wall time, meaningful only on an idle machine |

``drives`` and ``drives_lean`` are vectors of ``FlatDrive-v0``, a process for each core, with waits of two seconds;
``simulated_s_per_s`` is simulated time per wall time, over all of them.

``--profile`` adds where this process spends its time, by part of the project; libraries count for their callers.
``--check`` compares the traces of every environment of a vector with those of the same environment alone.
"""

from __future__ import annotations

import argparse
import cProfile
import functools
import json
import os
import pstats
import re
import statistics
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import closing, contextmanager
from typing import Any

import gymnasium as gym
import numpy as np

import automotive_cosim
from automotive_cosim.envs.flat_drive import SOON, SOON_S
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.traffic.remote import RemoteProcess

TASKS = ("hvac_fan_max", "hvac_driver_seat_heater")
SCENARIO = "grid"
FAMILY, MINUTES = "grid_june", 10.0
SEED = 0
CORES = os.cpu_count() or 1


class Children:
    """Processor time of the simulations' processes, past and present."""

    def __init__(self) -> None:
        self._ended_s = 0.0
        self._running: dict[int, RemoteProcess] = {}
        self._since_s: Counter[int] = Counter()

    @contextmanager
    def counted(self) -> Iterator[Children]:
        """Counts every process that is started or forked in the meantime."""
        first_call, close = RemoteProcess.receive, RemoteProcess.close

        @functools.wraps(first_call)
        def receive(process: RemoteProcess, *arguments: Any, **options: Any) -> Any:
            if process.pid and process.pid not in self._running:
                self._running[process.pid] = process
            return first_call(process, *arguments, **options)

        @functools.wraps(close)
        def closed(process: RemoteProcess) -> None:
            if self._running.pop(process.pid, None) is not None:
                self._ended_s += spent_s(process.pid)
            close(process)

        RemoteProcess.receive, RemoteProcess.close = receive, closed  # type: ignore[method-assign]
        try:
            yield self
        finally:
            RemoteProcess.receive, RemoteProcess.close = first_call, close  # type: ignore[method-assign]

    @property
    def spent_s(self) -> float:
        """Seconds spent by all of them so far."""
        return self._ended_s + sum(map(spent_s, self._running))


def spent_s(pid: int) -> float:
    """A process's own clock (clock_getcpuclockid(3)); Linux."""
    try:
        return time.clock_gettime(((~pid) << 3) | 2)
    except OSError:  # it has ended
        return 0.0


class Clock:
    """Milliseconds since the last reading: of this process, its children and the wall clock."""

    def __init__(self, children: Children) -> None:
        self._children = children
        self._last = self._now()

    def _now(self) -> tuple[float, float, float]:
        return time.process_time(), self._children.spent_s, time.perf_counter()

    def lap(self) -> tuple[float, ...]:
        """All three readings."""
        before, self._last = self._last, self._now()
        return tuple(1000 * (now - then) for now, then in zip(self._last, before, strict=True))


def played(env: gym.Env[Any, Any], decisions: int, children: Children) -> dict[str, float]:
    """Random actions on warm traffic."""
    rng = np.random.default_rng(SEED)
    env.reset(seed=SEED)
    steps, resets = [], []
    whole, clock = Clock(children), Clock(children)
    over = False
    for _ in range(decisions):
        if over:
            clock.lap()
            env.reset()
            resets.append(clock.lap())
        clock.lap()
        *_, terminated, truncated, _ = env.step(action(env, rng))
        steps.append(clock.lap())
        over = terminated or truncated
    ours, sumo, wall = whole.lap()
    return {
        "decisions": decisions,
        "resets": len(resets),
        "decision_ms": ours / decisions,
        "sumo_ms": sumo / decisions,
        "per_s": 1000 * decisions / wall,
        "step_ms": statistics.median(step[0] for step in steps),
        "reset_ms": statistics.median(reset[0] for reset in resets),
        "reset_sumo_ms": statistics.median(reset[1] for reset in resets),
        "reset_wall_ms": statistics.median(reset[2] for reset in resets),
    }


def action(env: gym.Env[Any, Any], rng: np.random.Generator) -> Any:
    """For a flat environment, any action; for the other, a tap on a clickable element or, rarely, a declaration."""
    if isinstance(env.action_space, gym.spaces.Discrete):
        return rng.integers(env.action_space.n)
    elements = env.unwrapped.episode.elements  # type: ignore[attr-defined]
    can = [index for index, element in enumerate(elements) if element.is_clickable and element.is_enabled]
    if rng.random() < 0.15:
        return {"action_type": "status", "goal_status": "complete"}
    return {"action_type": "click", "index": int(rng.choice(can))}


def vector(mode: str | None, count: int, rounds: int, children: Children, *, check: bool) -> dict[str, Any]:
    """A vector of environments on one warm simulation, and whether each behaves as it does alone."""
    actions = np.random.default_rng(SEED).integers(100, size=(rounds, count))
    with closing(Simulations()) as pool:
        options: dict[str, Any] = {"tasks": TASKS, "scenario": SCENARIO, "simulations": pool}
        envs = gym.make_vec("AutomotiveCosim/Flat-v0", num_envs=count, vectorization_mode=mode, **options)
        actions %= envs.single_action_space.n
        shared = {"traffic_seed": SEED}
        envs.reset(seed=SEED, options=shared)
        ended: list[list[Any]] = [[] for _ in range(count)]
        clock = Clock(children)
        for row in actions:
            _, _, terminated, truncated, _ = envs.step(row)
            for index in np.flatnonzero(terminated | truncated):
                ended[index].append(envs.envs[index].unwrapped.episode)
        ours, sumo, wall = clock.lap()
        envs.close()
        traces = [[episode.trace_sha256 for episode in episodes] for episodes in ended]
        alone = [_alone(options, actions[:, i], SEED + i, shared) for i in range(count if check else 0)]
    decisions = count * rounds
    return {
        "envs": count,
        "decisions": decisions,
        "decision_ms": ours / decisions,
        "sumo_ms": sumo / decisions,
        "per_s": 1000 * decisions / wall,
        "episodes": sum(map(len, traces)),
        "same_as_alone": alone == traces if check else None,
    }


def drives(count: int, rounds: int, *, lean: bool) -> dict[str, Any]:
    """Drives for training, each in a process of its own, whose agents look every two seconds."""
    envs = gym.make_vec(
        "AutomotiveCosim/FlatDrive-v0", num_envs=count, vectorization_mode="async",
        families=FAMILY, minutes=MINUTES, lean=lean,
    )  # fmt: skip
    with closing(envs):
        envs.reset(seed=SEED)
        looks = np.full(count, SOON)
        began_s = time.perf_counter()
        for _ in range(rounds):
            envs.step(looks)
        per_s = count * rounds / (time.perf_counter() - began_s)
    return {"envs": count, "decisions": count * rounds, "per_s": per_s, "simulated_s_per_s": SOON_S * per_s}


def _alone(options: dict[str, Any], actions: Any, seed: int, shared: dict[str, int]) -> list[str]:
    """The traces of one environment by itself; the step after an episode's end resets, as in a vector."""
    with closing(gym.make("AutomotiveCosim/Flat-v0", **options)) as env:
        env.reset(seed=seed, options=shared)
        traces, over = [], False
        for number in actions:
            if over:
                env.reset()
                over = False
                continue
            *_, terminated, truncated, _ = env.step(number)
            over = terminated or truncated
            if over:
                traces.append(env.unwrapped.episode.trace_sha256)  # type: ignore[attr-defined]
    return traces


def shares(profile: cProfile.Profile) -> dict[str, float]:
    """Per cent of the profiled time by module of the project; the time of libraries counts for their callers."""
    stats = pstats.Stats(profile).stats  # type: ignore[attr-defined]
    own: Counter[str] = Counter()
    for function, (_, _, seconds, _, callers) in stats.items():
        for name, share in _owners(stats, function, callers, depth=12):
            own[name] += seconds * share
    total = sum(own.values())
    return {name: round(100 * seconds / total, 1) for name, seconds in own.most_common(24)}


def _owners(stats: Any, function: Any, callers: Any, depth: int) -> Iterator[tuple[str, float]]:
    found = re.search(r"automotive_cosim/(.*)\.py$", function[0])
    if found:
        yield found[1], 1.0
    elif not depth or not callers:
        yield "other", 1.0
    else:
        total = sum(caller[2] for caller in callers.values()) or 1.0
        for caller, (_, _, seconds, _) in callers.items():
            if seconds > 0 and caller in stats:
                for name, share in _owners(stats, caller, stats[caller][4], depth - 1):
                    yield name, share * seconds / total


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description="The cost of a decision.")
    parser.add_argument("--decisions", type=int, default=300)
    parser.add_argument("--envs", type=int, default=8)
    parser.add_argument("--only", choices=("flat", "cockpit", "vector", "drives"))
    parser.add_argument("--profile", action="store_true")
    parser.add_argument("--check", action="store_true", help="compare each trace of the vector with the env alone")
    chosen = parser.parse_args()
    make = {
        "flat": lambda: gym.make("AutomotiveCosim/Flat-v0", tasks=TASKS, scenario=SCENARIO),
        "cockpit": lambda: gym.make("AutomotiveCosim/Cockpit-v0", task=TASKS[0], scenario=SCENARIO),
    }
    figures: dict[str, Any] = {"of": automotive_cosim.__file__, "load": os.getloadavg()[0]}
    with Children().counted() as children:
        for name, maker in make.items():
            if chosen.only not in (None, name):
                continue
            with closing(maker()) as env:
                figures[name] = played(env, chosen.decisions, children)
                if chosen.profile:
                    with cProfile.Profile(time.process_time) as profile:
                        played(env, chosen.decisions, children)
                    figures[name]["parts"] = shares(profile)
        if chosen.only in (None, "vector"):
            rounds = max(1, chosen.decisions // chosen.envs)
            for name, mode in (("vector", None), ("vector_sync", "sync")):
                figures[name] = vector(mode, chosen.envs, rounds, children, check=chosen.check)
    if chosen.only in (None, "drives"):
        for name, lean in (("drives", False), ("drives_lean", True)):
            figures[name] = drives(CORES, max(1, chosen.decisions // CORES), lean=lean)
    print(json.dumps(_rounded(figures), indent=1))


def _rounded(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _rounded(entry) for name, entry in value.items()}
    return round(value, 2) if isinstance(value, float) else value


if __name__ == "__main__":
    main()
