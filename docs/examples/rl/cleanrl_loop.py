"""Policy gradient in one file, as CleanRL's: four environments over one warm simulation, invalid actions masked."""

import gymnasium as gym
import numpy as np
import torch
from torch.distributions import Categorical

import automotive_cosim

ROUNDS, STEPS, COUNT = 2, 16, 4
TASK = {"tasks": ("hvac_fan_max",), "scenario": "grid", "goal_bonus": 0.5}

envs = gym.make_vec("AutomotiveCosim/Flat-v0", num_envs=COUNT, **TASK)
inputs, actions = envs.single_observation_space.shape[0], int(envs.single_action_space.n)
net = torch.nn.Sequential(torch.nn.Linear(inputs, 64), torch.nn.Tanh(), torch.nn.Linear(64, actions))
optimizer = torch.optim.Adam(net.parameters(), 1e-3)
seen, info = envs.reset(seed=0)
for number in range(ROUNDS):
    told, rewards = [], []
    for _ in range(STEPS):
        allowed = torch.as_tensor(np.stack(info["action_mask"]))
        policy = Categorical(logits=net(torch.as_tensor(seen)).masked_fill(~allowed, -1e9))
        chosen = policy.sample()
        seen, reward, _, _, info = envs.step(chosen.numpy())
        told.append(policy.log_prob(chosen))
        rewards.append(torch.as_tensor(reward, dtype=torch.float32))
    returns = torch.stack(rewards).flip(0).cumsum(0).flip(0)
    loss = -(torch.stack(told) * (returns - returns.mean())).mean()
    optimizer.zero_grad()
    loss.backward()
    optimizer.step()
    print(f"round {number}: reward {torch.stack(rewards).sum().item():+.2f}, loss {loss.item():+.3f}")
envs.close()
print(f"{automotive_cosim.__version__}: {ROUNDS * STEPS * COUNT} steps")
