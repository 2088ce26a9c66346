#!/bin/bash
# Seen with gymnasium 1.2.3: behind vector environments with AutoresetMode.SAME_STEP, the vector wrapper
# RecordEpisodeStatistics leaves the first step out of every episode but the first, in return and in length. With
# episodes of three steps, that is a third. 1.4.0 counts all. One would expect the same figures in every mode.
# Seen (lengths of the first three episodes of one environment):
#   1.2.3 NEXT_STEP 3 3 3
#   1.2.3 SAME_STEP 3 2 2
#   1.4.0 NEXT_STEP 3 3 3
#   1.4.0 SAME_STEP 3 3 3
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
cat > seen.py << 'P'
import gymnasium
import numpy

class Three(gymnasium.Env):
    observation_space = action_space = gymnasium.spaces.Discrete(4)

    def reset(self, *, seed=None, options=None):
        self.at = 0
        return 0, {}

    def step(self, action):
        self.at += 1
        return self.at, 1.0, self.at == 3, False, {}

for mode in gymnasium.vector.AutoresetMode.NEXT_STEP, gymnasium.vector.AutoresetMode.SAME_STEP:
    made = gymnasium.vector.SyncVectorEnv([Three], autoreset_mode=mode)
    counted = gymnasium.wrappers.vector.RecordEpisodeStatistics(made)
    counted.reset()
    while counted.episode_count < 3:
        counted.step(numpy.array([0]))
    assert list(counted.return_queue) == list(counted.length_queue)
    print(gymnasium.__version__, mode.name, *map(int, counted.length_queue))
P
for n in 1.2.3 1.4.0; do
  python3 -m venv $n && $n/bin/pip install -q gymnasium==$n && $n/bin/python seen.py
done | tee seen.txt
printf '%s_STEP 3 %s\n' '1.2.3 NEXT' '3 3' '1.2.3 SAME' '2 2' '1.4.0 NEXT' '3 3' '1.4.0 SAME' '3 3' | diff - seen.txt
