"""A flat view of the environment for reinforcement learning: ``Discrete`` actions, a ``Box`` of numbers.

| action | meaning |
|---|---|
| first ``len(apps)`` | opens an app |
| then ``len(controls)`` | taps that control; a second passes if it is not visible |
| then 3 | declares ``complete``, ``infeasible`` or ``not_needed`` |

| observation, float32 in [-1, 1] | number |
|---|---|
| what the driver said: its words, hashed into slots | ``GOAL_SLOTS`` |
| per control: visible, on, usable | 3 ``len(controls)`` |
| the car's numbers, scaled by ``spaces.BOUNDS`` | ``len(NUMBERS)`` |
| share of the steps already used | 1 |

It has less than ``CockpitEnv``: no screenshot, no place, and only the given controls.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from automotive_cosim.contracts import Action, ActionType, GoalStatus, Observation
from automotive_cosim.contracts.ids import resource_id
from automotive_cosim.envs.base import SessionEnv, Stepped
from automotive_cosim.envs.cockpit import outcome, traffic_seed
from automotive_cosim.envs.numbers import hashed, number_of
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.session import TakesTime
from automotive_cosim.episode.situation import SituationFinder
from automotive_cosim.episode.specification import EpisodeSpec, SeedSource, SessionSetup
from automotive_cosim.errors import UserError
from automotive_cosim.interface.observe import Channel
from automotive_cosim.interface.spaces import APPS, BOUNDS, OPTIONAL
from automotive_cosim.tasking.draws import SEED_LIMIT
from automotive_cosim.traffic.fork import Simulations

GOAL_SLOTS = 48
NUMBERS = tuple(name for name in BOUNDS if name not in OPTIONAL)
CONTROLS = (
    "hvac.driver_temperature.decrease",
    "hvac.driver_temperature.increase",
    "hvac.driver_seat_heating",
    "hvac.steering_wheel_heating",
    "hvac.passenger_seat_heating",
    "hvac.sync",
    "hvac.fan.max",
    "hvac.air.up",
    "hvac.air.middle",
    "hvac.air.down",
    "hvac.air_conditioning",
    "hvac.auto",
    "hvac.recirculation",
    "hvac.front_defroster",
    "hvac.rear_defroster",
    "lights.high_beam",
    "lights.front_fog",
    "lights.rear_fog",
    "wiper.front.slow",
    "wiper.rear.slow",
)
"""The switches of the climate screen, and some of the vehicle's."""
ENDS = tuple(GoalStatus)


class FlatEnv(SessionEnv[npt.NDArray[np.float32], np.int64, Episode]):
    """Episodes of several tasks, one drawn at each reset.

    The reward is that of ``CockpitEnv``: 1 at the end of a successful episode. ``goal_bonus`` adds a potential for
    training: it is paid when the goal starts to hold and taken back when it no longer does. It sums to zero over an
    episode that ends as it began, and does not change the verdict: ``info["is_success"]`` is the verdict's.
    """

    def __init__(
        self,
        tasks: str | Sequence[str],
        controls: Sequence[str] = CONTROLS,
        apps: Sequence[str] = APPS,
        *,
        scenario: str | None = None,
        max_steps: int = 8,
        goal_bonus: float = 0.0,
        render_mode: str | None = None,
        simulations: Simulations | None = None,
    ) -> None:
        """Reads the tasks' scenarios; nothing runs before ``reset``.

        Args:
            tasks: ids of tasks, or one id; their first halves are used.
            controls: resource ids that can be tapped.
            apps: names of the apps that can be opened.
            scenario: runs all tasks in this scenario instead of their own.
            max_steps: actions after which an episode is cut off.
            goal_bonus: potential of a state in which the goal holds; 0 except for training.
            render_mode: ``"rgb_array"`` or None.
            simulations: warm simulations; by default those that the environments of this process share.

        Raises:
            UnknownNameError: no such task or scenario.
            UserError: no task or no control is given, or there is no such render mode.
        """
        tasks = (tasks,) if isinstance(tasks, str) else tasks
        if not tasks or not controls:
            raise UserError("a flat environment requires at least one task and one control")
        super().__init__(simulations, render_mode)
        self._finders = [SituationFinder(EpisodeSpec(task, scenario=scenario), self._simulations) for task in tasks]
        self._seeds: list[SeedSource] = []
        """One per task, so that what is drawn for one does not depend on the others."""
        self._max_steps = max_steps
        self._setup = SessionSetup(frozenset({Channel.ELEMENTS, Channel.VEHICLE}), max_steps=max_steps)
        self._controls = tuple(controls)
        self._apps = tuple(apps)
        self._goal_bonus = goal_bonus
        self._held = False
        size = GOAL_SLOTS + 3 * len(self._controls) + len(NUMBERS) + 1
        self.observation_space = gym.spaces.Box(-1.0, 1.0, (size,), np.float32)
        self._count = len(self._apps) + len(self._controls) + len(ENDS)
        self.action_space = gym.spaces.Discrete(self._count)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[npt.NDArray[np.float32], dict[str, Any]]:
        """Draws a task, a phrasing and a drive. Seeds are those of ``CockpitEnv``.

        Raises:
            TriggerNotReachedError: the situation did not arise.
            TrafficError: the traffic simulation failed.
        """
        super().reset(seed=seed)
        self._end()
        if seed is not None or not self._seeds:
            own = int(self.np_random.integers(SEED_LIMIT)) if seed is None else seed
            self._seeds = [SeedSource(own) for _ in self._finders]
        for source in self._seeds:
            source.traffic = traffic_seed(options, source.traffic)
        number = int(self.np_random.integers(len(self._finders)))
        hand_over = self._finders[number].find(self._seeds[number].next())
        self._episode = Episode.take_over(hand_over, self._setup)
        self._held = self._holds()
        return self._numbers(), {"action_mask": self.action_masks()}

    def stepping(self, action: np.int64) -> TakesTime[Stepped[npt.NDArray[np.float32]]]:
        """Performs one action of the table; ``info`` holds ``action_mask`` and, at the end, ``is_success``."""
        episode = self._running()
        yield from episode.stepping(self._action(number_of(action, self._count)))
        reward, terminated, truncated = outcome(episode)
        held = self._holds()
        reward += self._goal_bonus * (held - self._held)
        self._held = held
        verdict = episode.verdict
        info: dict[str, Any] = {"action_mask": self.action_masks()}
        if verdict is not None:
            info["is_success"] = verdict.success
        return self._numbers(), reward, terminated, truncated, info

    def action_masks(self) -> npt.NDArray[np.bool_]:
        """Which actions do something now, (actions,): every app and declaration, and the controls that are in sight
        and can be used. sb3-contrib's ``MaskablePPO`` asks by this name."""
        usable = {element.resource_id for element in self.episode.observation.elements or () if element.is_enabled}
        controls = [resource_id(control) in usable for control in self._controls]
        return np.array([True] * len(self._apps) + controls + [True] * len(ENDS))

    def number(self, action: Action) -> int | None:
        """The number of an action on the present screen; None if this view has none for it."""
        first = len(self._apps)
        if action.action_type is ActionType.OPEN_APP and action.app_name in self._apps:
            return self._apps.index(action.app_name)
        if action.action_type is ActionType.STATUS and action.goal_status is not None:
            return first + len(self._controls) + ENDS.index(action.goal_status)
        if action.action_type is ActionType.CLICK and action.index is not None:
            tapped = self.episode.elements[action.index].resource_id
            return next((first + at for at, name in enumerate(self._controls) if resource_id(name) == tapped), None)
        return None

    def _action(self, number: int) -> Action:
        if number < len(self._apps):
            return Action(ActionType.OPEN_APP, app_name=self._apps[number])
        number -= len(self._apps)
        if number >= len(self._controls):
            return Action(ActionType.STATUS, goal_status=ENDS[number - len(self._controls)])
        wanted = resource_id(self._controls[number])
        for index, element in enumerate(self.episode.elements):
            if element.resource_id == wanted:
                return Action(ActionType.CLICK, index=index)
        return Action(ActionType.WAIT, seconds=1)

    def _holds(self) -> bool:
        moments = self.episode.moments
        return self.episode.instance.half.goal.holds(moments[0], moments[-1], moments)

    def _numbers(self) -> npt.NDArray[np.float32]:
        seen = self.episode.observation
        spent = (len(self.episode.steps) - 1) / self._max_steps
        words = hashed((seen.goal, *seen.said), GOAL_SLOTS)
        parts = [*words, *self._switches(seen), *_car(seen), spent]
        return np.clip(np.array(parts, np.float32), -1.0, 1.0)

    def _switches(self, seen: Observation) -> list[float]:
        in_sight = {element.resource_id: element for element in seen.elements or ()}
        numbers = []
        for control in self._controls:
            element = in_sight.get(resource_id(control))
            on = element is not None and (element.is_checked or element.is_selected)
            numbers += [float(element is not None), float(on), float(element is not None and element.is_enabled)]
        return numbers


def _car(seen: Observation) -> list[float]:
    numbers = []
    for name in NUMBERS:
        low, high = BOUNDS[name]
        numbers.append((float(getattr(seen.vehicle, name)) - low) / (high - low))
    return numbers
