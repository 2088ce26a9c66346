"""The environment: a task in a car in traffic, as a gymnasium ``Env``."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from automotive_cosim.contracts import Action
from automotive_cosim.envs.base import SessionEnv, StepResult, action_of, ended, info_of, spaces_of
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.observer import Observer
from automotive_cosim.episode.session import TakesTime
from automotive_cosim.episode.situation import SituationFinder
from automotive_cosim.episode.specification import ACTION_COST_S, EpisodeSpec, SeedSource, SessionSetup
from automotive_cosim.errors import UserError
from automotive_cosim.formats.words import shown
from automotive_cosim.interface import spaces
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.scenarios import Scenario
from automotive_cosim.tasking.draws import SEED_LIMIT
from automotive_cosim.tasking.task import Task
from automotive_cosim.traffic.fork import Simulations


class CockpitEnv(SessionEnv[dict[str, Any], Any, Episode]):
    """An agent at the cockpit of a car in live traffic.

    ``reset`` loads the task's scenario, warms up its traffic, puts the ego on the road and drives until the task's
    trigger holds: that instant is the hand-over. ``step`` performs one action, which costs simulated time. The
    episode ends when the agent declares a status, when the ego's drive ends, or after ``max_steps`` (truncated).

    ``automotive_cosim.interface.spaces`` documents the observation and action spaces; ``step`` also takes an
    ``Action``, a JSON object or its text. ``env.unwrapped.episode`` is the typed episode behind it: its
    ``observation``, ``moments``, ``steps`` and ``verdict``; it can be branched.

    The reward is 1 at the end of a successful episode, else 0. ``info`` holds ``step``, ``action_result`` and
    ``events`` of the road; at the end also ``verdict`` and ``trace_sha256``.

    Seeds: ``reset(seed=s)`` warms up the traffic of seed ``s`` and draws everything else from it. ``reset()`` keeps
    that traffic and draws a new instance and drive, which is quick. ``options={"traffic_seed": t}`` takes the
    traffic of seed ``t`` in place of ``s``.
    """

    def __init__(
        self,
        task: str | Task = "road_speed_80_in_50",
        half: str = "first",
        *,
        scenario: str | None = None,
        origin: tuple[float, float] | None = None,
        gps: bool = True,
        from_place: str = "",
        to_place: str = "",
        channels: Iterable[str] = ALL,
        held_out: bool = False,
        max_steps: int | None = None,
        action_cost_s: float = ACTION_COST_S,
        render_mode: str | None = None,
        simulations: Simulations | None = None,
        observer: Observer | None = None,
        **conditions: str,
    ) -> None:
        """Makes an environment for one task; nothing runs before ``reset``.

        Args:
            task: a task or its id.
            half, scenario, origin, gps, from_place, to_place, held_out: as in ``EpisodeSpec``.
            channels, max_steps, action_cost_s: as in ``SessionSetup``.
            render_mode: ``"rgb_array"`` or None.
            simulations: warm simulations; by default those that the environments of this process share.
            observer: told of progress.
            conditions: ``geo``, ``see`` and so on, as in ``Conditions``.

        Raises:
            UnknownNameError: no such task, half, scenario or condition.
            ScenarioError: the scenario cannot be read, or has no such route.
            UserError: ``origin`` is not a position on earth, or ``see`` leaves nothing of the screen,
                or the driver has no words for the task in that language.
        """
        given = None if isinstance(task, str) else task
        name = task if isinstance(task, str) else task.id
        under = Conditions.named(conditions)
        spec = EpisodeSpec(
            name, half, scenario, origin, gps, from_place, to_place, held_out=held_out, conditions=under
        )
        wanted = frozenset(map(Channel, channels))
        self._setup = SessionSetup(wanted, under, max_steps, action_cost_s=action_cost_s)
        super().__init__(simulations, render_mode)
        self._finder = SituationFinder(spec, self._simulations, task=given, observer=observer)
        self._observer = observer
        self._seeds = SeedSource()
        self.observation_space, self.action_space = spaces_of(self._setup)

    @property
    def scenario(self) -> Scenario:
        """The scenario in which it takes place."""
        return self._finder.scenario

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Starts an episode at the instant its trigger holds.

        Raises:
            TriggerNotReachedError: the situation did not arise within its time limit.
            TrafficError: the traffic simulation failed.
        """
        super().reset(seed=seed)
        self._end()
        if seed is not None:
            self._seeds = SeedSource(seed)
        self._seeds.traffic = traffic_seed(options, self._seeds.traffic)
        hand_over = self._finder.find(self._seeds.next())
        self._episode = Episode.take_over(hand_over, self._setup, self._observer)
        return self._encoded(), self._info()

    def stepping(self, action: Action | Mapping[str, Any] | str) -> TakesTime[StepResult]:
        episode = self._running()
        yield from episode.stepping(action_of(action))
        return self._encoded(), *outcome(episode), self._info()

    def _encoded(self) -> dict[str, Any]:
        return spaces.encode(self.episode.observation, self._setup.given)

    def _info(self) -> dict[str, Any]:
        episode, info = self.episode, info_of(self.episode)
        if episode.verdict is not None:
            info |= {"verdict": episode.verdict.as_json(), "trace_sha256": episode.trace_sha256}
        return info


def traffic_seed(options: Mapping[str, Any] | None, own: int) -> int:
    """The traffic that the options of a ``reset`` ask for, or else its own.

    Raises:
        UserError: it is not a whole number.
    """
    given = (options or {}).get("traffic_seed")
    if given is None:
        return own % SEED_LIMIT
    if isinstance(given, bool) or not isinstance(given, int | np.integer):
        raise UserError(f"traffic_seed is {shown(given)}; it must be a whole number")
    return int(given) % SEED_LIMIT


def outcome(episode: Episode) -> tuple[float, bool, bool]:
    """Reward, terminated and truncated, as in gymnasium."""
    return float(episode.verdict is not None and episode.verdict.success), *ended(episode)
