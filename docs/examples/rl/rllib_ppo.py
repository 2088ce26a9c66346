"""RLlib: one round of PPO on the flat environment."""

import gymnasium as gym
from ray.rllib.algorithms.ppo import PPOConfig
from ray.tune.registry import register_env

import automotive_cosim

register_env("flat", lambda config: gym.make("AutomotiveCosim/Flat-v0", **config))
config = (
    PPOConfig()
    .environment("flat", env_config={"tasks": ("hvac_fan_max",), "scenario": "grid"})
    .env_runners(num_env_runners=0)
    .training(train_batch_size_per_learner=64, minibatch_size=32, num_epochs=1)
)
algorithm = config.build_algo()
result = algorithm.train()
algorithm.stop()
print(f"{automotive_cosim.__version__}: {result['num_env_steps_sampled_lifetime']:.0f} steps")
