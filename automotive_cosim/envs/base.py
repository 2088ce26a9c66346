"""What every environment has: a session, a screen to render, and warm simulations that it shares."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, Generic, TypeVar

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from automotive_cosim.cockpit.actions import check, parse
from automotive_cosim.contracts import Action
from automotive_cosim.contracts.given import Hearing
from automotive_cosim.envs.pool import POOL
from automotive_cosim.episode.session import Session, TakesTime, driven
from automotive_cosim.episode.specification import SessionSetup
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.interface import spaces
from automotive_cosim.traffic.fork import Simulations

PlayedT = TypeVar("PlayedT", bound=Session)
ObsT = TypeVar("ObsT")
ActT = TypeVar("ActT")


StepResult = tuple[dict[str, Any], float, bool, bool, dict[str, Any]]
Stepped = tuple[ObsT, float, bool, bool, dict[str, Any]]


class SessionEnv(gym.Env[ObsT, ActT], Generic[ObsT, ActT, PlayedT]):
    """An environment of one session after another."""

    metadata = {"render_modes": ["rgb_array"], "render_fps": 1}  # noqa: RUF012, gymnasium's own form

    def __init__(self, simulations: Simulations | None, render_mode: str | None) -> None:
        """Begins without a session.

        Args:
            simulations: warm simulations; None for those that the environments of this process share.
            render_mode: ``"rgb_array"`` or None.

        Raises:
            UnknownNameError: there is no such render mode.
        """
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise UnknownNameError("render mode", str(render_mode), self.metadata["render_modes"])
        self.render_mode = render_mode
        self._leave: Callable[[], object] | None = None
        if simulations is None:
            simulations, self._leave = POOL.join(self)
        self._simulations = simulations
        self._episode: PlayedT | None = None

    @property
    def episode(self) -> PlayedT:
        """The episode that is running, or has just ended: its observation, moments, steps and judgement.

        Raises:
            ResetNeeded: there has been none yet.
        """
        if self._episode is None:
            raise gym.error.ResetNeeded("call reset() before anything else")
        return self._episode

    def step(self, action: ActT) -> Stepped[ObsT]:
        """Performs one action, lets its time pass, observes and, at the end, judges; see the class.

        Raises:
            ActionError: the action is malformed; nothing has happened.
            ResetNeeded: the episode is over, or there has been none.
            TrafficError: the traffic simulation failed.
        """
        return driven(self.stepping(action))

    @abstractmethod
    def stepping(self, action: ActT) -> TakesTime[Stepped[ObsT]]:
        """As ``step``, tick by tick (``Session.stepping``)."""

    def render(self) -> npt.NDArray[np.uint8] | None:
        """The cockpit's screen, (height, width, 3), or None without a render mode."""
        return self.episode.screenshot() if self.render_mode else None

    def close(self) -> None:
        """Ends the drive and, if nobody else shares them, the warm simulations."""
        self._end()
        if self._leave is not None:
            self._leave()

    def _running(self) -> PlayedT:
        """The session, which must not be over."""
        if self.episode.end is not None:
            raise gym.error.ResetNeeded("the episode has ended; call reset() to start another")
        return self.episode

    def _end(self) -> None:
        episode, self._episode = self._episode, None
        if episode is not None:
            episode.close()


def info_of(session: Session) -> dict[str, Any]:
    """What ``info`` holds after every step."""
    last = session.steps[-1]
    return {
        "step": last.number,
        "action_result": str(last.feedback.code),
        "events": [event.text for event in last.moment.events],
    }


def ended(session: Session) -> tuple[bool, bool]:
    """Terminated and truncated, as in gymnasium."""
    is_over, is_cut_off = session.end is not None, session.end is not None and session.end.is_cut_off
    return is_over and not is_cut_off, is_cut_off


def spaces_of(setup: SessionSetup) -> tuple[gym.spaces.Dict, gym.spaces.Dict]:
    """The observation and the action space of a session."""
    size, with_sound = setup.conditions.screen, setup.conditions.hear is Hearing.AUDIO
    return (
        spaces.observation_space(setup.given, size.width, size.height, with_sound=with_sound),
        spaces.action_space(size.width, size.height),
    )


def action_of(given: Action | Mapping[str, Any] | str) -> Action:
    """An action: one itself, a value of the action space, a JSON object or its text.

    Raises:
        ActionError: it is malformed.
    """
    if isinstance(given, Action):
        return check(given)
    if isinstance(given, Mapping) and isinstance(given.get("action_type"), int | np.integer):
        return spaces.decode_action(given)
    return parse(dict(given) if isinstance(given, Mapping) else given)
