"""Stable-Baselines3: PPO on two environments, then a few steps of what it learned."""

import gymnasium as gym
from stable_baselines3 import PPO

import automotive_cosim

env = gym.make("AutomotiveCosim/Flat-v0", tasks=("hvac_fan_max",), scenario="grid", goal_bonus=0.5)
model = PPO("MlpPolicy", env, n_steps=32, batch_size=32, seed=0)
model.learn(64)
seen, _ = env.reset(seed=1)
action, _ = model.predict(seen, deterministic=True)
env.close()
print(f"{automotive_cosim.__version__}: {model.num_timesteps} steps, then action {int(action)}")
