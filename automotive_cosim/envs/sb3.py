"""Copies that share one warm simulation as Stable-Baselines3 wants them: behind its ``VecEnv``."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, cast

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode

from automotive_cosim.envs.vector import ConcurrentVectorEnv
from automotive_cosim.errors import SetupError, install_hint

try:
    from stable_baselines3.common.vec_env import VecEnv  # pyright: ignore[reportMissingImports]
except ImportError as error:
    raise SetupError(f"automotive_cosim.envs.sb3 needs Stable-Baselines3: {install_hint('rl')}") from error


def vec_env(name: str = "AutomotiveCosim/Flat-v0", num_envs: int = 8, **options: Any) -> VecEnv:
    """What ``gym.make_vec(name, num_envs, **options)`` makes, as ``PPO(...)`` takes it.

    ``seed(s)`` and the ``reset`` after it take the traffic of seed ``s`` for all copies, and draw all else of copy
    ``i`` from ``s + i``.
    """
    made = gym.make_vec(name, num_envs, autoreset_mode=AutoresetMode.SAME_STEP, **options)
    return _Shared(cast("ConcurrentVectorEnv", made))


class _Shared(VecEnv):
    def __init__(self, envs: ConcurrentVectorEnv) -> None:
        self._shared = envs
        super().__init__(envs.num_envs, envs.single_observation_space, envs.single_action_space)

    def reset(self) -> Any:
        seen, told = self._shared.reset(seed=self._seeds[0])
        self.reset_infos = [_of(told, number) for number in range(self.num_envs)]
        self._reset_seeds()
        return seen

    def step_async(self, actions: Any) -> None:
        self._actions = actions

    def step_wait(self) -> Any:
        seen, rewards, ended, cut, told = self._shared.step(self._actions)
        infos = []
        for number in range(self.num_envs):
            info = _of(told, number)
            if "final_obs" in info:
                info = {**info["final_info"], "terminal_observation": info["final_obs"]}
            infos.append({**info, "TimeLimit.truncated": bool(cut[number] and not ended[number])})
        return seen, rewards.astype(np.float32), ended | cut, infos

    def close(self) -> None:
        self._shared.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        return [env.get_wrapper_attr(attr_name) for env in self._chosen(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        for env in self._chosen(indices):
            env.set_wrapper_attr(attr_name, value)

    def env_method(self, method_name: str, *method_args: Any, indices: Any = None, **named: Any) -> list[Any]:
        return [each(*method_args, **named) for each in self.get_attr(method_name, indices)]

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        return [False for _ in self._chosen(indices)]

    def _chosen(self, indices: int | Iterable[int] | None) -> Sequence[Any]:
        return [self._shared.envs[number] for number in self._get_indices(indices)]


def _of(told: dict[str, Any], number: int) -> dict[str, Any]:
    """What one environment told, of what gymnasium made of all of them: an array by name, and where it is set."""
    return {
        name: _of(values, number) if isinstance(values, dict) else values[number]
        for name, values in told.items()
        if not name.startswith("_") and told.get(f"_{name}", np.ones(number + 1))[number]
    }
