"""Drives of several cars in one traffic, as PettingZoo's ``ParallelEnv``: ``AutomotiveCosim/Fleet-v0``.

Every car is an environment of drives (``DriveEnv`` or ``FlatDriveEnv``) with its cockpit, its driver and its judge;
what they share is the road. A fleet of one is that environment, step by step.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, cast

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from automotive_cosim.contracts import Action
from automotive_cosim.drives.departure import Departures, car_named
from automotive_cosim.drives.script import DriveScript
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.envs.base import Stepped, action_of
from automotive_cosim.envs.crew import Crews
from automotive_cosim.envs.drive import DriveEnv, DrivesEnv
from automotive_cosim.envs.flat_drive import ACTIONS, FlatDriveEnv
from automotive_cosim.envs.numbers import number_of
from automotive_cosim.errors import ActionError, UserError
from automotive_cosim.formats.words import shown
from automotive_cosim.tasking.draws import SEED_LIMIT
from automotive_cosim.traffic.fork import RemoteTraffic

if TYPE_CHECKING:
    from pettingzoo import ParallelEnv, register
else:
    try:
        from pettingzoo import ParallelEnv, register
    except ImportError:  # the vector environment needs none of it
        ParallelEnv, register = object, None

Parts = tuple[dict[str, Any], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]]


class FleetEnv(ParallelEnv):
    """Several cars, each on a drive of its own, in one traffic.

    The first car departs at ``reset``; its seed's drive gives the traffic, the hour and the weather. The others are
    sent at the same time and enter as soon as each finds a gap: from then on they are in ``agents``. A car whose
    drive is over leaves ``agents`` for good and goes on in the traffic without a cockpit. Observations, actions,
    rewards and what ``infos`` holds are those of the car's environment.

    A step ends as soon as a car has done its action. A car whose action takes longer is marked in its info as
    ``busy``, has its last observation and reward 0, and what is given for it is not looked at until it is free.

    Seeds: ``reset(seed=s)`` lets car ``i`` drive what its environment alone drives with seed ``s + i``.
    """

    metadata = {  # noqa: RUF012, PettingZoo's own form
        "name": "AutomotiveCosim/Fleet-v0",
        "render_modes": ["rgb_array"],
        "is_parallelizable": True,
    }

    def __init__(
        self, cars: int = 2, *, flat: bool = False, render_mode: str | None = None, **options: Any
    ) -> None:
        """Makes the environments of the cars; nothing runs before ``reset``.

        Args:
            cars: how many, at least one.
            flat: whether each is a ``FlatDriveEnv``, with numbers for learning, instead of a ``DriveEnv``.
            render_mode: ``"rgb_array"`` or None.
            options: of these environments.

        Raises:
            UserError: there is no car, or something else than a number of them, or an option is wrong.
        """
        if not isinstance(cars, int) or cars < 1:
            raise UserError(f"a fleet of {shown(cars)} cars was asked for; give a whole number from 1 on")
        kind: type[DrivesEnv[Any, Any]] = FlatDriveEnv if flat else DriveEnv
        self.render_mode = render_mode
        self.possible_agents = [f"car_{number}" for number in range(cars)]
        self.agents: list[str] = []
        self.envs = {car: kind(render_mode=render_mode, **options) for car in self.possible_agents}
        self.observation_spaces = {car: env.observation_space for car, env in self.envs.items()}
        self.action_spaces = {car: env.action_space for car, env in self.envs.items()}
        self._is_flat = flat
        self._specs: dict[str, DriveSpec] = {}
        self._departures: Departures | None = None
        self._crews: Crews | None = None
        self.away: frozenset[str] = frozenset()
        """Cars that a copy of this process drives after the next ``reset``; their ``envs`` here have no episode."""
        self._seen: dict[str, Any] = {}

    def observation_space(self, agent: str) -> gym.spaces.Space[Any]:
        """What a car observes."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> gym.spaces.Space[Any]:
        """What a car can do."""
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
        """Lets the first car depart and sends the others; ``options`` are not used.

        Raises:
            UserError: the drives of the cars are on different roads.
            InfrastructureError: no gap opened for the first car, or the traffic simulation failed.
        """
        self._end()
        self._specs = {
            car: env.draw(None if seed is None else seed + number)
            for number, (car, env) in enumerate(self.envs.items())
        }
        first, scripts = self.possible_agents[0], [spec.script for spec in self._specs.values()]
        seen, info = self.envs[first].depart(self._specs[first], scripts[0])
        self._departures = Departures(scripts, self.envs[first].episode.world)
        self._crews = Crews(self.envs, self.away, self._departures.road)
        self.agents = [first]
        self._seen = {first: seen}
        return {first: seen}, {first: info}

    def step(self, actions: Mapping[str, Any]) -> Parts:
        """Lets every free car act, and the road run until one is free again.

        Raises:
            ActionError: an action is malformed; nothing has happened in any car.
            ResetNeeded: no car is in the traffic.
            TrafficError: the traffic simulation failed.
        """
        if not self.agents or self._departures is None or self._crews is None:
            raise gym.error.ResetNeeded("no car is in the traffic; call reset()")
        free = [car for car in self.agents if car not in self._crews.busy]
        if missing := [car for car in free if car not in actions]:
            raise ActionError(f"no action is given for {', '.join(missing)}; give one for every car in agents")
        chosen = {car: self._checked(actions[car]) for car in free}
        done = self._crews.run(chosen)
        told = {car: done.get(car, (self._seen[car], 0.0, False, False, {"busy": True})) for car in self.agents}
        told |= dict(map(self._entered, self._departures.entered()))
        self._seen = {car: each[0] for car, each in told.items()}
        self.agents = [car for car in self.possible_agents if car in told and not (told[car][2] or told[car][3])]
        for car in told.keys() - set(self.agents) if self.agents else ():
            self._departures.road.leave(car_named(self.possible_agents.index(car)))
        return cast(Parts, tuple({car: each[part] for car, each in told.items()} for part in range(5)))

    def render(self) -> npt.NDArray[np.uint8] | None:
        """The screens of the cars in the traffic side by side, (height, width, 3), or None without a render mode; a
        screen is drawn only when looked at."""
        if not self.render_mode or not self.agents:
            return None
        return np.concatenate([self.envs[car].episode.screenshot() for car in self.agents], axis=1)

    def close(self) -> None:
        """Ends the drives and, if nobody else shares them, the warm simulations."""
        self.agents = []
        self._end()
        for env in self.envs.values():
            env.close()

    def _end(self) -> None:
        if self._crews is not None:
            self._crews.close()

    def _checked(self, action: Any) -> Any:
        """An action that has been tried against its form."""
        if self._is_flat:
            return np.int64(number_of(action, len(ACTIONS)))
        return action if isinstance(action, Action) else action_of(action)

    def _entered(self, new: tuple[int, DriveScript, RemoteTraffic]) -> tuple[str, Stepped[Any]]:
        """A car that has entered the traffic, and what its agent sees first."""
        number, script, traffic = new
        car = self.possible_agents[number]
        assert self._crews is not None
        seen, info = self._crews.enter(car, self._specs[car], script, traffic)
        return car, (seen, 0.0, False, False, info)


if register is not None:
    register("parallel", FleetEnv.metadata["name"], f"{__name__}:FleetEnv")


class FleetVectorEnv(gym.vector.VectorEnv[npt.NDArray[np.float32], npt.NDArray[np.int64], npt.NDArray[Any]]):
    """The cars of a flat fleet as gymnasium's vector environment, to train one policy for all of them.

    ``infos["acted"]`` says of which cars the action counted: those in the traffic that were free. The others have
    reward 0, and cars that are not in the traffic zeros to see. Once no car is left, the fleet departs anew in the
    same step, on drives of another seed.

    Where nothing is rendered and there is a second core, a copy of this process has the cockpits and judges of half
    of the cars (``FleetEnv.away``); what is told is the same.
    """

    metadata = {"autoreset_mode": AutoresetMode.SAME_STEP, "render_modes": ["rgb_array"]}  # noqa: RUF012

    def __init__(self, num_envs: int = 2, **options: Any) -> None:
        """Makes the fleet; ``options`` are those of ``FlatDriveEnv``."""
        self.fleet = FleetEnv(num_envs, flat=True, **options)
        if self.fleet.render_mode is None and len(os.sched_getaffinity(0)) > 1:
            self.fleet.away = frozenset(self.fleet.possible_agents[(num_envs + 1) // 2 :])
        self.render_mode = self.fleet.render_mode
        self.num_envs = num_envs
        first = self.fleet.possible_agents[0]
        self.single_observation_space = self.fleet.observation_space(first)
        self.single_action_space = self.fleet.action_space(first)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[npt.NDArray[np.float32], dict[str, Any]]:
        """Departs; ``seed`` is that of ``FleetEnv.reset``, and of all that follow."""
        if not isinstance(seed, int | None):
            raise UserError("the cars of a fleet share a road; give one seed, from which each car's is counted")
        super().reset(seed=seed)
        seen, _ = self.fleet.reset(seed)
        return self._seen(seen), {}

    def step(
        self, actions: npt.NDArray[np.int64]
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[Any], npt.NDArray[Any], npt.NDArray[Any], dict[str, Any]]:
        """As ``FleetEnv.step``, with an entry for every car."""
        cars, before = self.fleet.possible_agents, frozenset(self.fleet.agents)
        chosen = {car: action for car, action in zip(cars, actions, strict=True) if car in before}
        seen, paid, over, cut_off, infos = self.fleet.step(chosen)
        rewards = np.array([paid.get(car, 0.0) for car in cars])
        terminated, truncated = (np.array([each.get(car, False) for car in cars]) for each in (over, cut_off))
        acted = np.array([car in before and not infos[car].get("busy") for car in cars])
        info: dict[str, Any] = {"acted": acted}
        made = self._seen(seen)
        if not self.fleet.agents:
            info["final_obs"] = made
            made = self._seen(self.fleet.reset(int(self.np_random.integers(SEED_LIMIT)))[0])
        return made, rewards, terminated, truncated, info

    def render(self) -> Any:
        """See ``FleetEnv.render``."""
        return self.fleet.render()

    def close_extras(self, **kwargs: Any) -> None:
        """See ``FleetEnv.close``."""
        self.fleet.close()

    def _seen(self, seen: Mapping[str, npt.NDArray[np.float32]]) -> npt.NDArray[np.float32]:
        empty = np.zeros(self.single_observation_space.shape or (), np.float32)
        return np.stack([seen.get(car, empty) for car in self.fleet.possible_agents])
