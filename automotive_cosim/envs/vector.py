"""Many environments in one process, over one warm simulation, whose simulations' processes run at the same time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from functools import partial
from typing import Any, cast

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from gymnasium.vector.utils import iterate

from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.envs.flat import FlatEnv


class ConcurrentVectorEnv(SyncVectorEnv):
    """gymnasium's ``SyncVectorEnv``, except that the environments step at the same time, each on a thread.

    Threads of one process share the cockpit's side, which Python does one after the other, while each environment's
    SUMO runs in a process of its own: two processors are busy, not one.

    Seeds: ``reset(seed=s)`` warms the traffic of seed ``s``, once and for all environments, and draws everything else
    of environment ``i`` from ``s + i``; alone, that is ``env.reset(seed=s + i, options={"traffic_seed": s})``. A list
    of seeds gives each environment traffic of its own. Without a seed each keeps its traffic.
    """

    def __init__(
        self,
        makers: Sequence[Callable[[], gym.Env[Any, Any]]],
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
    ) -> None:
        """Makes the environments.

        Args:
            makers: make one each.
            autoreset_mode: as in gymnasium.
        """
        super().__init__([partial(_ahead, make) for make in makers], autoreset_mode=autoreset_mode)
        self._threads = ThreadPoolExecutor(len(makers), thread_name_prefix="env")

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """As in ``SyncVectorEnv``; see the class for seeds."""
        if isinstance(seed, int | np.integer):
            options = {"traffic_seed": int(seed)} | (options or {})
        return super().reset(seed=seed, options=options)

    def step(self, actions: Any) -> Any:
        """As in ``SyncVectorEnv``."""
        envs = cast("list[_Ahead]", self.envs)
        resets = self._autoreset_envs & (self.autoreset_mode is AutoresetMode.NEXT_STEP)
        begun = [
            env.begin(self._threads, "reset") if is_over else env.begin(self._threads, "step", action)
            for env, is_over, action in zip(envs, resets, iterate(self.action_space, actions), strict=True)
        ]
        wait(begun)
        try:
            return super().step(actions)
        finally:
            for env in envs:  # if one failed, those after it have not been asked
                env.forget()

    def close_extras(self, **kwargs: Any) -> None:
        """Ends all drives."""
        super().close_extras(**kwargs)
        self._threads.shutdown()


class _Ahead(gym.Wrapper[Any, Any, Any, Any]):
    """An environment whose next call may have been made already, by a thread."""

    _begun: Future[Any] | None = None

    def begin(self, threads: ThreadPoolExecutor, name: str, *arguments: object) -> Future[Any]:
        """Has a thread make the call that comes next."""
        self._begun = threads.submit(getattr(self.env, name), *arguments)
        return self._begun

    def forget(self) -> None:
        """What was begun is not asked for any more."""
        self._begun = None

    def step(self, action: Any) -> Any:
        """As begun, or made now."""
        return self._taken() or self.env.step(action)

    def reset(self, **options: Any) -> Any:
        """As begun, or made now."""
        return self._taken() or self.env.reset(**options)

    def _taken(self) -> Any:
        begun, self._begun = self._begun, None
        return None if begun is None else begun.result()


def _ahead(make: Callable[[], gym.Env[Any, Any]]) -> _Ahead:
    return _Ahead(make())


def cockpits(num_envs: int = 1, **options: Any) -> ConcurrentVectorEnv:
    """What ``gym.make_vec("AutomotiveCosim/Cockpit-v0", num_envs)`` makes; ``options`` as ``CockpitEnv`` takes them."""
    return _made(CockpitEnv, num_envs, options)


def flats(num_envs: int = 1, **options: Any) -> ConcurrentVectorEnv:
    """What ``gym.make_vec("AutomotiveCosim/Flat-v0", num_envs)`` makes; ``options`` as ``FlatEnv`` takes them."""
    return _made(FlatEnv, num_envs, options)


def _made(kind: Callable[..., gym.Env[Any, Any]], count: int, options: dict[str, Any]) -> ConcurrentVectorEnv:
    mode = options.pop("autoreset_mode", AutoresetMode.NEXT_STEP)
    return ConcurrentVectorEnv([partial(kind, **options)] * count, mode)
