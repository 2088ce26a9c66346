"""A loop in one file, as CleanRL's, that trains one linear policy for all cars of a fleet by REINFORCE."""

import gymnasium as gym
import numpy as np

import automotive_cosim

envs = gym.make_vec("AutomotiveCosim/Fleet-v0", num_envs=3, minutes=0.2, lean=True)
rng = np.random.default_rng(0)
seen, _ = envs.reset(seed=0)
count = int(envs.single_action_space.n)
weights = np.zeros((seen.shape[1], count))
steps = 0
for _ in range(20):
    scores = seen @ weights
    odds = np.exp(scores - scores.max(axis=1, keepdims=True))
    odds /= odds.sum(axis=1, keepdims=True)
    actions = np.array([rng.choice(count, p=each) for each in odds])
    after, rewards, terminated, truncated, info = envs.step(actions)
    for car in np.flatnonzero(info["acted"]):  # who is not in the traffic, or still busy, has learned nothing
        weights += 0.1 * rewards[car] * np.outer(seen[car], np.eye(count)[actions[car]] - odds[car])
        steps += 1
    seen = after
envs.close()
print(f"{automotive_cosim.__version__}: {steps} steps of 3 cars")
