"""TorchRL: the flat environment as a ``GymEnv``, rolled out and collected."""

import torch
from torchrl.envs import GymEnv, StepCounter, TransformedEnv

import automotive_cosim

env = TransformedEnv(GymEnv("AutomotiveCosim/Flat-v0", tasks=("hvac_fan_max",), scenario="grid"), StepCounter())
torch.manual_seed(0)
env.set_seed(0)
rollout = env.rollout(8)
env.close()
reward = rollout["next", "reward"].sum().item()
print(f"{automotive_cosim.__version__}: {tuple(rollout['observation'].shape)}, reward {reward:.1f}")
