#!/bin/bash
# Seen with gymnasium 1.4.0: NormalizeReward puts what the last step of an episode earns at the start of the next one. Where
# only the end is rewarded, as success of a task is, the discounted returns that it learns from are then nearly the same at
# all times, their deviation is almost none, and the reward comes out ten times as large as behind a vector environment
# with AutoresetMode.SAME_STEP, whose returns are reset. One would expect the same scale of the same rewards everywhere.
# Seen (500 episodes of five steps, 1 at the end; mean and deviation of the returns, the last reward as it comes out):
#   NormalizeReward: 0.98, 0.04; 24.1
#   vector, NEXT_STEP: 0.98, 0.04; 24.1
#   vector, SAME_STEP: 0.20, 0.40; 2.5
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q gymnasium==1.4.0
cat > seen.py << 'P'
import gymnasium
import numpy
from gymnasium.vector import AutoresetMode, SyncVectorEnv

class Won(gymnasium.Env):
    observation_space = action_space = gymnasium.spaces.Discrete(9)

    def reset(self, *, seed=None, options=None):
        self.at = 0
        return 0, {}

    def step(self, action):
        self.at += 1
        return self.at, float(self.at == 5), self.at == 5, False, {}

def told(name, of, last):
    print(f"{name}: {of.return_rms.mean:.2f}, {of.return_rms.var ** 0.5:.2f}; {last:.1f}")

alone = gymnasium.wrappers.NormalizeReward(Won())
for _ in range(500):
    alone.reset()
    rewards = [alone.step(0)[1] for _ in range(5)]
told("NormalizeReward", alone, rewards[-1])
for mode, steps in (AutoresetMode.NEXT_STEP, 6), (AutoresetMode.SAME_STEP, 5):
    many = gymnasium.wrappers.vector.NormalizeReward(SyncVectorEnv([Won], autoreset_mode=mode))
    many.reset()
    rewards = [many.step(numpy.array([0]))[1][0] for _ in range(500 * steps)]
    told(f"vector, {mode.name}", many, max(rewards[-6:]))
P
v/bin/python seen.py | tee seen.txt
diff - seen.txt << END
NormalizeReward: 0.98, 0.04; 24.1
vector, NEXT_STEP: 0.98, 0.04; 24.1
vector, SAME_STEP: 0.20, 0.40; 2.5
END
