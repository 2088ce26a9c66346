#!/bin/bash
# Seen with pettingzoo 1.27.0: behind MultiEpisodeParallelEnv, which runs so many episodes "before truncating", an agent that
# ends before the others goes without a word, in the last episode too: its last step says neither terminated nor truncated,
# and it is gone from the next. Who waits for its end, or keeps its transitions until then, waits for ever. One would expect
# each agent to be truncated or terminated once, as the API of parallel environments has it.
# Seen (one episode; agent a ends with its second step, b with its third, both terminated):
#   without: a at 2 terminated, b at 3 terminated
#   MultiEpisodeParallelEnv: b at 3 truncated
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q pettingzoo==1.27.0
cat > seen.py << 'P'
import gymnasium
import pettingzoo
from pettingzoo.utils.wrappers import MultiEpisodeParallelEnv

ENDS = {"a": 2, "b": 3}

class Two(pettingzoo.ParallelEnv):
    metadata = {"name": "two", "render_modes": []}
    possible_agents = [*ENDS]

    def observation_space(self, agent):
        return gymnasium.spaces.Discrete(9)

    action_space = observation_space

    def reset(self, seed=None, options=None):
        self.at, self.agents = 0, [*ENDS]
        return dict.fromkeys(self.agents, 0), {agent: {} for agent in self.agents}

    def step(self, actions):
        self.at += 1
        acted, self.agents = self.agents, [agent for agent in self.agents if self.at < ENDS[agent]]
        told = dict.fromkeys(acted, self.at), dict.fromkeys(acted, 1.0)
        ended = {agent: agent not in self.agents for agent in acted}
        return *told, ended, dict.fromkeys(acted, False), {agent: {} for agent in acted}

for name, env in ("without", Two()), ("MultiEpisodeParallelEnv", MultiEpisodeParallelEnv(Two(), 1)):
    env.reset()
    told, at = [], 0
    while env.agents:
        at += 1
        _, _, *ends, _ = env.step(dict.fromkeys(env.agents, 0))
        for word, ended in zip(("terminated", "truncated"), ends):
            told += [f"{agent} at {at} {word}" for agent, has in ended.items() if has]
    print(f"{name}: {', '.join(told)}")
P
v/bin/python seen.py | tee seen.txt
diff - seen.txt << END
without: a at 2 terminated, b at 3 terminated
MultiEpisodeParallelEnv: b at 3 truncated
END
