#!/bin/sh
# pettingzoo 1.27.0: parallel_seed_test compares two copies of a parallel environment over num_cycles steps, 500 by
# default. It stops after the first: its loop ends on any(terminations), and any() of a dict looks at the agents' names,
# not at their values. A pair that differs from the second step on passes.
# Seen: passed after 1 step of 500, though the copies differ from step 2 on
set -e
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q pettingzoo==1.27.0
cat > seen.py <<'X'
import gymnasium
import pettingzoo
from pettingzoo.test import parallel_seed_test

made = []


class Env(pettingzoo.ParallelEnv):
    metadata = {"name": "two_steps_v0"}
    possible_agents = ["a"]

    def __init__(self):
        self.space, self.copy = gymnasium.spaces.Discrete(2), len(made)
        made.append(self)

    def observation_space(self, agent):
        return self.space

    action_space = observation_space

    def reset(self, seed=None, options=None):
        self.agents, self.steps = ["a"], 0
        return {"a": 0}, {"a": {}}

    def step(self, actions):
        self.steps += 1
        seen = self.copy if self.steps > 1 else 0
        return {"a": seen}, {"a": 0.0}, {"a": False}, {"a": False}, {"a": {}}


parallel_seed_test(Env, num_cycles=500)
print(f"passed after {made[0].steps} step of 500, though the copies differ from step 2 on")
X
v/bin/python seen.py | tee seen.txt
echo "passed after 1 step of 500, though the copies differ from step 2 on" | diff - seen.txt
