"""Stable-Baselines3: PPO trains one policy for all cars of a fleet."""

import gymnasium as gym
import numpy as np
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import VecEnv

import automotive_cosim


class Cars(VecEnv):
    """Gymnasium's vector environment with Stable-Baselines3's methods."""

    def __init__(self, envs):
        self.envs = envs
        self.render_mode = None
        super().__init__(envs.num_envs, envs.single_observation_space, envs.single_action_space)

    def reset(self):
        return self.envs.reset(seed=0)[0]

    def step_async(self, actions):
        self.actions = actions

    def step_wait(self):
        seen, rewards, terminated, truncated, info = self.envs.step(self.actions)
        last = info.get("final_obs", seen)
        infos = [{"terminal_observation": last[car], "acted": info["acted"][car]} for car in range(self.num_envs)]
        return seen, rewards, terminated | truncated, infos

    def close(self):
        self.envs.close()

    def get_attr(self, name, indices=None):
        return [getattr(self, name)] * self.num_envs

    def set_attr(self, name, value, indices=None):
        setattr(self, name, value)

    def env_method(self, name, *given, indices=None, **named):
        return [getattr(self.envs, name)(*given, **named)]

    def env_is_wrapped(self, kind, indices=None):
        return [False] * self.num_envs


cars = Cars(gym.make_vec("AutomotiveCosim/Fleet-v0", num_envs=3, minutes=0.2, lean=True))
model = PPO("MlpPolicy", cars, n_steps=16, batch_size=48, seed=0)
model.learn(48)
seen = cars.reset()
actions, _ = model.predict(seen, deterministic=True)
cars.close()
print(f"{automotive_cosim.__version__}: {model.num_timesteps} steps, then actions {np.array(actions).tolist()}")
