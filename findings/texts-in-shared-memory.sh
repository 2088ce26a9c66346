#!/bin/bash
# Seen with gymnasium 1.4.0: AsyncVectorEnv loses every text of an observation. Its default, shared_memory=True, takes
# Text spaces, alone and inside Dict and Tuple, and gives back the first character of the space's alphabet, as often
# as the space is long, whatever the environment says: an agent that is told its task that way reads zeros. Numbers
# beside it are right, nothing is said; SyncVectorEnv and shared_memory=False give the texts. One would expect them,
# or a refusal.
# Seen (what the environments say is "left" and 7):
#   SyncVectorEnv: ('left', 'left') [7 7]
#   AsyncVectorEnv: ('000000', '000000') [7 7]
#   AsyncVectorEnv, shared_memory=False: ('left', 'left') [7 7]
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q gymnasium==1.4.0
cat > seen.py << 'P'
import gymnasium
from gymnasium import spaces
from gymnasium.vector import AsyncVectorEnv, SyncVectorEnv

class Told(gymnasium.Env):
    observation_space = spaces.Dict({"number": spaces.Discrete(9), "task": spaces.Text(6)})
    action_space = spaces.Discrete(2)

    def reset(self, *, seed=None, options=None):
        return {"number": 7, "task": "left"}, {}

if __name__ == "__main__":
    for name, made, options in (
        ("SyncVectorEnv", SyncVectorEnv, {}),
        ("AsyncVectorEnv", AsyncVectorEnv, {}),
        ("AsyncVectorEnv, shared_memory=False", AsyncVectorEnv, {"shared_memory": False}),
    ):
        envs = made([Told, Told], **options)
        seen, _ = envs.reset()
        print(f"{name}:", seen["task"], seen["number"])
        envs.close()
P
v/bin/python seen.py | tee seen.txt
diff - seen.txt << END
SyncVectorEnv: ('left', 'left') [7 7]
AsyncVectorEnv: ('000000', '000000') [7 7]
AsyncVectorEnv, shared_memory=False: ('left', 'left') [7 7]
END
