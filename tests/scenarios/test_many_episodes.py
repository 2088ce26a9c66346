"""Two hundred episodes in a row leave nothing behind: no memory, no process, no open file."""

from __future__ import annotations

import gc
import os
import sys
from contextlib import closing
from pathlib import Path

import pytest

from automotive_cosim.env import CockpitEnv
from automotive_cosim.run import memory
from automotive_cosim.traffic.fork import Simulations

EPISODES = 200
SETTLED_AFTER = 40
"""Caches (fonts, pictures, places, laws) have filled by then."""

GROWTH_MB = 8.0
"""Over 160 episodes: far under what one more episode kept alive would add (a simulation has tens of megabytes to
itself), above the noise of an allocator."""


def open_files() -> int:
    return sum(1 for _ in Path("/proc/self/fd").iterdir())


def seen() -> tuple[float, int, int]:
    """Megabytes, processes and files."""
    gc.collect()
    megabytes = memory.rss_mb()
    assert megabytes is not None
    return megabytes, len(memory.tree()), open_files()


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="looks at processes through /proc")
def test_two_hundred_episodes_leave_nothing() -> None:
    before = len(memory.tree())
    with closing(Simulations()) as simulations:
        env = CockpitEnv("hvac_fan_max", scenario="grid", render_mode="rgb_array", simulations=simulations)
        env.reset(seed=1)
        figures = []
        for number in range(EPISODES):
            env.reset()
            env.step({"action_type": "open_app", "app_name": "climate"})
            env.render()
            if number % 2:
                env.step({"action_type": "status", "goal_status": "complete"})
            if number >= SETTLED_AFTER and number % SETTLED_AFTER == SETTLED_AFTER - 1:
                figures.append(seen())
        env.close()
        assert len({(processes, files) for _, processes, files in figures}) == 1, figures
        megabytes = [each for each, _, _ in figures]
        assert megabytes[-1] - megabytes[0] < GROWTH_MB, figures
    assert len(memory.tree()) == before
    assert os.getpid() in memory.tree()
