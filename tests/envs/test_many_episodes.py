"""Two hundred episodes in a row leave nothing behind: no memory, no process, no open file."""

import json
import subprocess
import sys

import pytest

GROWTH_MB = 3.0
"""Over 120 episodes: far under what one more episode kept alive would add (a simulation has tens of megabytes to
itself)."""

PROGRAM = """
import gc, json, os
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.agents.cleanup import tree
from automotive_cosim.traffic.fork import Simulations

EPISODES = 200
SETTLED_AFTER = 80  # caches (fonts, pictures, places, laws) have filled by then
EVERY = 40

def own_mb():
    # Without pages of files: what of those is resident, or shared with others, is not up to us.
    return sum(map(anonymous_kb, tree(os.getpid()))) / 1024

def anonymous_kb(process):
    with open(f"/proc/{process}/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("RssAnon:"))

def seen():
    gc.collect()
    return own_mb(), len(tree(os.getpid())), len(os.listdir("/proc/self/fd"))

simulations = Simulations()
env = CockpitEnv("hvac_fan_max", scenario="grid", render_mode="rgb_array", simulations=simulations)
env.reset(seed=1)
figures = []
for number in range(EPISODES):
    env.reset()
    env.step({"action_type": "open_app", "app_name": "climate"})
    env.render()
    if number % 2:
        env.step({"action_type": "status", "goal_status": "complete"})
    if number + 1 >= SETTLED_AFTER and number % EVERY == EVERY - 1:
        figures.append(seen())
env.close()
simulations.close()
print(json.dumps({"figures": figures, "left": len(tree(os.getpid())) - 1}))
"""
"""In a process of its own: what else a test run keeps alive would show in the figures."""


@pytest.mark.proof
@pytest.mark.sumo
def test_two_hundred_episodes_leave_nothing() -> None:
    ran = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True)
    found = json.loads(ran.stdout)
    megabytes, processes, files = zip(*found["figures"], strict=True)
    assert len(megabytes) == 4
    assert len(set(processes)) == len(set(files)) == 1, found
    assert megabytes[-1] - megabytes[0] < GROWTH_MB, found
    assert found["left"] == 0
