#!/bin/bash
# Seen with supersuit 3.11.0: behind black_death_v3, which is needed to make a vector environment of agents that end at different
# times (pettingzoo_env_to_vec_env_v1), nobody learns of an end when it comes. An agent that is out goes on, seeing zeros and
# earning 0, and when the last one is out there is one step more, at which all are terminated and truncated at once. So an agent
# that lasts two steps has an episode of five here, and its values are learned over steps that it never made. Nothing is
# said. One would expect each agent's end with its last step, once.
# Seen (agent a ends with its second step, b with its fourth; steps, and at which of them each is terminated, truncated):
#   environment: 4 steps; a 2 -, b 4 -
#   vector: 5 steps; a 5 5, b 5 5
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q supersuit==3.11.0 pettingzoo==1.27.0 gymnasium==1.4.0
cat > seen.py << 'P'
import gymnasium
import numpy as np
import supersuit
from pettingzoo import ParallelEnv

LAST = {"a": 2, "b": 4}

class Two(ParallelEnv):
    metadata = {"name": "two", "render_modes": []}
    possible_agents = ["a", "b"]
    render_mode = None

    def observation_space(self, agent):
        return gymnasium.spaces.Box(0, 9, (1,), np.float32)

    def action_space(self, agent):
        return gymnasium.spaces.Discrete(2)

    def reset(self, seed=None, options=None):
        self.agents, self.steps = ["a", "b"], 0
        return {each: np.ones(1, np.float32) for each in self.agents}, {each: {} for each in self.agents}

    def step(self, actions):
        self.steps += 1
        here = self.agents
        over = {each: self.steps == LAST[each] for each in here}
        self.agents = [each for each in here if not over[each]]
        seen = {each: np.ones(1, np.float32) for each in here}
        return seen, dict.fromkeys(here, 1.0), over, dict.fromkeys(here, False), {each: {} for each in here}

def told(name, step):
    ends = {each: ["-", "-"] for each in LAST}
    for number in range(1, 20):
        _, _, terminated, truncated, _ = step()
        for each, *flags in zip(LAST, terminated, truncated):
            ends[each] = [number if flag else end for flag, end in zip(flags, ends[each])]
        if all("-" not in end[:1] for end in ends.values()):
            break
    print(f"{name}: {number} steps; {', '.join(f'{each} {end[0]} {end[1]}' for each, end in ends.items())}")

alone = Two()
alone.reset()

def single():
    *_, terminated, truncated, _ = alone.step(dict.fromkeys(alone.agents, 0))
    return None, None, *([flags.get(each, False) for each in LAST] for flags in (terminated, truncated)), None

told("environment", single)
vector = supersuit.pettingzoo_env_to_vec_env_v1(supersuit.black_death_v3(Two()))
vector.reset()
told("vector", lambda: vector.step(np.zeros(2, int)))
P
v/bin/python -W ignore seen.py 2> said.txt | tee seen.txt
diff - seen.txt << END
environment: 4 steps; a 2 -, b 4 -
vector: 5 steps; a 5 5, b 5 5
END
