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
from automotive_cosim.errors import ActionError
from automotive_cosim.tasking.draws import SEED_LIMIT


class ConcurrentVectorEnv(SyncVectorEnv):
    """gymnasium's ``SyncVectorEnv``, except that the environments step at the same time, each on a thread.

    Python runs their cockpits one after the other, but each environment's SUMO has a process of its own.

    Seeds: ``reset(seed=s)`` warms the traffic of seed ``s``, once for all environments, and draws everything else
    of environment ``i`` from ``s + i``; alone, that is ``env.reset(seed=s + i, options={"traffic_seed": s})``. A
    list of seeds gives each environment traffic of its own. Without a seed each keeps its traffic; the first time
    they share one that is drawn.
    """

    def __init__(
        self,
        makers: Sequence[Callable[[], gym.Env[Any, Any]]],
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
    ) -> None:
        """Makes the environments.

        Args:
            autoreset_mode: as in gymnasium.
        """
        super().__init__([partial(_ahead, make) for make in makers], autoreset_mode=autoreset_mode)
        self._threads = ThreadPoolExecutor(len(makers), thread_name_prefix="env")
        self._is_warm = False

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """As in ``SyncVectorEnv``; see the class for seeds."""
        if seed is None and not self._is_warm:
            seed = int(np.random.default_rng().integers(SEED_LIMIT))
        if isinstance(seed, int):
            options = {"traffic_seed": seed} | (options or {})
        self._is_warm = True
        return super().reset(seed=seed, options=options)

    def step(self, actions: Any) -> Any:
        """As in ``SyncVectorEnv``.

        Raises:
            ActionError: there is not one action for each environment, or one is not in the action space; nothing
                has happened in any of them if it is the number of actions that is wrong.
        """
        envs = cast("list[_Ahead]", self.envs)
        if (count := _count(actions)) != len(envs):
            raise ActionError(f"{count} actions for {len(envs)} environments; give one for each")
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
        """Ends the drives of all environments."""
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
        """Drops a step or reset that was begun."""
        self._begun = None

    def step(self, action: Any) -> Any:
        """The result of what was begun, or of a new call."""
        return self._taken() or self.env.step(action)

    def reset(self, **options: Any) -> Any:
        """The result of what was begun, or of a new call."""
        return self._taken() or self.env.reset(**options)

    def _taken(self) -> Any:
        begun, self._begun = self._begun, None
        return None if begun is None else begun.result()


def _count(actions: Any) -> int:
    """For how many environments these are the actions; a mapping has arrays with one entry for each."""
    if isinstance(actions, dict):
        actions = next(iter(actions.values()), ())
        return _count(actions) if isinstance(actions, dict) else len(actions)
    return len(actions) if hasattr(actions, "__len__") and np.ndim(actions) else 1


def _ahead(make: Callable[[], gym.Env[Any, Any]]) -> _Ahead:
    return _Ahead(make())


def cockpits(num_envs: int = 1, **options: Any) -> ConcurrentVectorEnv:
    """What ``gym.make_vec("AutomotiveCosim/Cockpit-v0", num_envs)`` makes, with the options of ``CockpitEnv``."""
    return _made(CockpitEnv, num_envs, options)


def flats(num_envs: int = 1, **options: Any) -> ConcurrentVectorEnv:
    """What ``gym.make_vec("AutomotiveCosim/Flat-v0", num_envs)`` makes, with the options of ``FlatEnv``."""
    return _made(FlatEnv, num_envs, options)


def _made(kind: Callable[..., gym.Env[Any, Any]], count: int, options: dict[str, Any]) -> ConcurrentVectorEnv:
    mode = options.pop("autoreset_mode", AutoresetMode.NEXT_STEP)
    return ConcurrentVectorEnv([partial(kind, **options)] * count, mode)
