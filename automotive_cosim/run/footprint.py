"""The memory of one environment and of each additional one, in a process that has done nothing else.

    python -m automotive_cosim.run.footprint grid

prints both in megabytes as JSON; null except on Linux.
"""

from __future__ import annotations

import json
import sys
from contextlib import closing

from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.run.measure import SECOND, TASK
from automotive_cosim.run.memory import rss_mb
from automotive_cosim.traffic.fork import Simulations

EXTRA_ENVS = 3
SECONDS = 10
"""Driven before memory is read."""


def footprint(scenario: str) -> tuple[float | None, float | None]:
    """Megabytes of one environment during an episode, and what each additional one adds."""
    with closing(Simulations()) as simulations:
        envs = [CockpitEnv(TASK, scenario=scenario, simulations=simulations) for _ in range(1 + EXTRA_ENVS)]
        try:
            _drive(envs[0])
            one_mb = rss_mb()
            for env in envs[1:]:
                _drive(env)
            all_mb = rss_mb()
        finally:
            for env in envs:
                env.close()
    if one_mb is None or all_mb is None:
        return None, None
    return round(one_mb, 1), round((all_mb - one_mb) / EXTRA_ENVS, 1)


def _drive(env: CockpitEnv) -> None:
    env.reset(seed=0)
    for _ in range(SECONDS):
        env.step(SECOND)


if __name__ == "__main__":
    print(json.dumps(footprint(sys.argv[1])))
