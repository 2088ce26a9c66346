"""An environment for OpenEnv: one episode per session, over WebSocket, for clients on this machine.

    pip install -e . 'openenv>=0.10,<0.11'
    python docs/examples/openenv_server.py 8000

OpenEnv 0.10 and the package ``mcp`` 2 exclude each other, so it wants an environment of its own.
"""

# pyright: reportMissingImports=false
from __future__ import annotations

import base64
import sys
from contextlib import suppress
from typing import Any

import uvicorn
from openenv.core.env_server import Action, Environment, Observation, State, create_app
from pydantic import Field

from automotive_cosim.agents.marks import road
from automotive_cosim.cockpit.actions import grammar
from automotive_cosim.contracts import Json
from automotive_cosim.doors.guard import Guarded
from automotive_cosim.doors.shared import (
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
    functions: list[dict[str, Any]] | None = Field(None, description="At the beginning, what can be called.")
    outcome: dict[str, Any] | None = Field(None, description="Verdict and trace_sha256; null before the end.")


class CarEnvironment(Environment[CarAction, CarObservation, State]):
    """One session's episodes, one after the other, on the service that all sessions share."""

    SUPPORTS_CONCURRENT_SESSIONS = True

    def __init__(self) -> None:
        super().__init__()
        self._service = shared_service()
        self._under_way: str | None = None
        self._state = State()

    def reset(
        self,
        seed: int | None = None,
        episode_id: str | None = None,
        task: str = "road_speed_80_in_50",
        half: str = "first",
        pictures: bool = True,
        scenario: str | None = None,
        drive: str | None = None,
        minutes: float | None = None,
        **conditions: Any,
    ) -> CarObservation:
        """Drives to a task's hand-over, or departs on a drive; the episode before it is given up.

        ``conditions`` are ``geo``, ``see`` and so on, as in ``automotive-cosim run``."""
        self.close()
        under = conditions_of(conditions)
        spec = trial(None if drive else task, drive, half, seed, own_scenario(scenario, None), minutes, under)
        turn = self._service.start(spec, ALL if pictures else ALL - {Channel.SCREENSHOT})
        self._under_way = turn.episode_id
        self._state = State(episode_id=episode_id)
        return _observation(turn, functions=[as_openai(each) for each in functions_of(under)] or None)

    def step(self, action: CarAction, timeout_s: float | None = None, **kwargs: Any) -> CarObservation:
        """Performs one action. One that cannot be read counts as a step too."""
        if self._under_way is None:
            raise UserError("no episode is under way; reset first")
        turn = self._service.act(self._under_way, _given(action))
        self._state.step_count = turn.step
        if turn.end is None:
            return _observation(turn)
        outcome = self._service.finish(self._under_way)
        self._under_way = None
        return _observation(turn, outcome)

    @property
    def state(self) -> State:
        """The number of steps so far."""
        return self._state

    def close(self) -> None:
        """Gives up the episode that is under way, if there is one."""
        if self._under_way is not None:
            episode, self._under_way = self._under_way, None
            with suppress(CosimError):  # the road may have failed meanwhile
                self._service.finish(episode)


def _given(action: CarAction) -> Json | str:
    calls = not is_blank(action.function)
    if calls != (action.action is None):
        raise UserError("give an action, or a function with its arguments, one of the two")
    return action_json(str(action.function), action.arguments or {}) if calls else action.action or ""


def _observation(
    turn: EpisodeTurn, outcome: Json | None = None, functions: list[Json] | None = None
) -> CarObservation:
    return CarObservation(
        done=outcome is not None,
        reward=None if outcome is None else reward_of(outcome),
        turn={name: value for name, value in turn.as_json().items() if name != "episode_id"},
        picture=None if turn.picture is None else base64.b64encode(turn.picture).decode(),
        camera=next((base64.b64encode(each).decode() for each in road(turn.observation)), None),
        functions=functions,
        outcome=outcome,
    )


if __name__ == "__main__":
    port = int(sys.argv[1])
    served = create_app(CarEnvironment, CarAction, CarObservation, "automotive_cosim", max_concurrent_envs=SESSIONS)
    uvicorn.run(Guarded(served, "127.0.0.1", port), host="127.0.0.1", port=port, log_level="warning")
