"""An environment for OpenEnv: one episode per session, over WebSocket.

    uvicorn --factory automotive_cosim.doors.openenv:app

Needs the package ``openenv`` (extra ``openenv``).
"""

# pyright: reportMissingImports=false
from __future__ import annotations

import base64
import os
from contextlib import suppress
from pathlib import Path
from typing import Any

from openenv.core.env_server import Action, Environment, Observation, State, create_app
from pydantic import Field

from automotive_cosim.agents.marks import road
from automotive_cosim.cockpit.actions import grammar
from automotive_cosim.contracts import Json
from automotive_cosim.doors.guard import SameSite
from automotive_cosim.doors.shared import (
    SCENARIOS,
    conditions_of,
    functions_of,
    own_scenario,
    reward_of,
    shared_service,
    trial,
)
from automotive_cosim.errors import CosimError, UserError
from automotive_cosim.formats.blank import is_blank
from automotive_cosim.interface.functions import action_json, as_openai
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.service import EpisodeTurn

FIRST = "road_speed_80_in_50"
"""The task of a ``reset`` that names none."""
SESSIONS = 16
"""Episodes at once on one server."""


class CarAction(Action):
    """One action at the cockpit, or one call of a function of the car."""

    action: dict[str, Any] | str | None = Field(
        None, description=f"One action as a JSON object:\n{grammar()}\n`index` is that of the element list."
    )
    function: str | None = Field(None, description="Instead of an action: the name of a function of the car.")
    arguments: dict[str, Any] | None = Field(None, description="Its arguments, by its JSON Schema.")


class CarObservation(Observation):
    """What the agent sees. At the end, ``reward`` is 1 for a success, else 0; of a drive, its score / 100."""

    turn: dict[str, Any] = Field(description="The driver's words, elements, readings, place, and the last result.")
    picture: str | None = Field(None, description="The screen: a PNG in base64; null for who is not given it.")
    camera: str | None = Field(None, description="The view through the windshield, likewise, with see = camera.")
    functions: list[dict[str, Any]] | None = Field(
        None, description="At the beginning, what can be called, as OpenAI's tools; null without the interface."
    )
    outcome: dict[str, Any] | None = Field(None, description="Verdict and trace_sha256; null before the end.")


class CarState(State):
    """The task or drive at hand."""

    task: str = ""
    half: str = ""
    drive: str = ""
    seed: int = 0


class CarEnvironment(Environment[CarAction, CarObservation, CarState]):
    """One session's episodes, one after the other, on the service that all sessions share."""

    SUPPORTS_CONCURRENT_SESSIONS = True

    def __init__(self) -> None:
        super().__init__()
        self._service = shared_service()
        self._episode_id: str | None = None
        self._state = CarState()

    def reset(
        self,
        seed: int | None = None,
        episode_id: str | None = None,
        task: str | None = None,
        half: str = "first",
        pictures: bool = True,
        scenario: str | None = None,
        drive: str | None = None,
        minutes: float | None = None,
        errands: bool = False,
        **conditions: Any,
    ) -> CarObservation:
        """Drives to a task's hand-over, or departs on a drive; the episode before it is given up.

        Args:
            seed: 0 if none is given; the same seed and actions give the same trace.
            episode_id: a name for the state.
            task: id of the task; ``road_speed_80_in_50`` if neither it nor a drive is given.
            half: ``first`` or ``second``.
            pictures: whether the agent sees the screen.
            scenario: in place of its own: a shipped one, or one in the folder ``AUTOMOTIVE_COSIM_SCENARIOS``.
            drive: a family of drives instead of a task.
            minutes: when a drive is over, if its script ends later.
            errands: whether people aboard also ask for things on a drive.
            conditions: ``geo``, ``see`` and so on, as in ``automotive-cosim run``.

        Raises:
            UserError: something of that does not exist.
            InfrastructureError: the road failed.
        """
        self.close()
        if not drive:
            task = task or FIRST
        under = conditions_of(conditions)
        folder = os.environ.get(SCENARIOS)
        where = own_scenario(scenario, Path(folder) if folder else None)
        spec = trial(task, drive, half, seed, where, minutes, under, errands=errands)
        turn = self._service.start(spec, ALL if pictures else ALL - {Channel.SCREENSHOT})
        self._episode_id = turn.episode_id
        self._state = CarState(episode_id=episode_id, task=task or "", half=half, drive=drive or "", seed=spec.seed)
        offered = [as_openai(function) for function in functions_of(under)]
        return _observation(turn, functions=offered or None)

    def step(self, action: CarAction, timeout_s: float | None = None, **kwargs: Any) -> CarObservation:
        """Performs one action. One that cannot be read counts as a step too.

        Raises:
            UserError: the episode is over, or none has begun.
            InfrastructureError: the road failed.
        """
        if self._episode_id is None:
            raise UserError("no episode is under way; reset first")
        turn = self._service.act(self._episode_id, _given(action))
        self._state.step_count = turn.step
        if turn.end is None:
            return _observation(turn)
        outcome = self._service.finish(self._episode_id).as_json()
        self._episode_id = None
        return _observation(turn, outcome)

    @property
    def state(self) -> CarState:
        """The task and the number of steps so far."""
        return self._state

    def close(self) -> None:
        """Gives up the episode that is under way, if there is one."""
        if self._episode_id is not None:
            episode_id, self._episode_id = self._episode_id, None
            with suppress(CosimError):  # the road may have failed meanwhile
                self._service.finish(episode_id)


def _given(action: CarAction) -> Json | str:
    acts = bool(action.action) and not is_blank(action.action)
    calls = not is_blank(action.function)
    if (acts and calls) or (action.action is None and not calls):
        raise UserError("give an action, or a function with its arguments, one of the two")
    if not calls:
        return action.action or ""
    return action_json(str(action.function), action.arguments or {})


def _observation(
    turn: EpisodeTurn, outcome: Json | None = None, functions: list[Json] | None = None
) -> CarObservation:
    told = {name: value for name, value in turn.as_json().items() if name != "episode_id"}
    picture = turn.picture
    return CarObservation(
        done=outcome is not None,
        reward=None if outcome is None else reward_of(outcome),
        turn=told,
        picture=None if picture is None else base64.b64encode(picture).decode(),
        camera=next((base64.b64encode(each).decode() for each in road(turn.observation)), None),
        functions=functions,
        outcome=outcome,
    )


def app() -> SameSite:
    """The HTTP server, as an application that answers no other site's pages."""
    return SameSite(
        create_app(
            CarEnvironment,
            CarAction,
            CarObservation,
            "automotive_cosim",
            max_concurrent_envs=SESSIONS,
            state_cls=CarState,
        )
    )
