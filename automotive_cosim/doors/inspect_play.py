"""What both of Inspect's tasks share: the tool ``act``, and an episode from start to verdict."""

from __future__ import annotations

# pyright: reportMissingImports=false
import base64
import json
from collections.abc import Callable
from typing import Any

import anyio
import anyio.to_thread
from inspect_ai.model import ChatMessageSystem, ChatMessageUser, Content, ContentAudio, ContentImage, ContentText
from inspect_ai.solver import Generate, TaskState
from inspect_ai.tool import ToolDef, ToolError, ToolParams

from automotive_cosim.cockpit.actions import grammar
from automotive_cosim.contracts import Json
from automotive_cosim.doors.shared import HANDS, functions_of, shared_service, words
from automotive_cosim.drives.specification import TrialSpec
from automotive_cosim.errors import InfrastructureError, UserError
from automotive_cosim.interface.functions import Function, action_json
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.service import EpisodeService
from automotive_cosim.service.turn import EpisodeTurn

OUTCOME = "automotive_cosim/outcome"
"""Key of an episode's outcome in its sample's store."""


def seeds_of(given: int | str | list[int]) -> list[int]:
    """Seeds, one or several. Raises UserError: not whole numbers from 0."""
    numbers = words(given)
    if not all(number.isdecimal() for number in numbers):
        raise UserError(f"seeds are {', '.join(numbers)}; give whole numbers from 0, separated by commas")
    return [int(number) for number in numbers]


async def played(
    state: TaskState, generate: Generate, spec: TrialSpec, instructions: str, pictures: bool
) -> TaskState:
    """Plays an episode, in which the model acts until it is over, the model stops acting or meets a limit.

    The outcome goes into the sample's store. In the instructions, ``{operated}`` and ``{acting}`` stand for what
    the conditions leave.

    Raises:
        UserError: something in the specification does not exist.
        InfrastructureError: the road failed; the sample has no outcome.
    """
    service, channels = shared_service(), ALL if pictures else ALL - {Channel.SCREENSHOT}
    turn = await _threaded(lambda: service.start(spec, channels))
    operated, acting = HANDS[spec.conditions.interface]
    told = instructions.format(operated=operated, acting=acting)
    state.messages = [ChatMessageSystem(content=told), ChatMessageUser(content=_content(turn))]
    interface = spec.conditions.interface
    by_hand = [_act(service, turn.episode_id)] if interface.touches else []
    state.tools = [*by_hand, *(_calls(service, turn.episode_id, each) for each in functions_of(spec.conditions))]
    try:
        state = await generate(state, tool_calls="loop")
    except InfrastructureError:
        raise
    except BaseException:  # a limit of Inspect's, or the user's Ctrl-C
        with anyio.CancelScope(shield=True):
            await _finish(state, service, turn.episode_id)
        raise
    await _finish(state, service, turn.episode_id)
    return state


def outcome_of(state: TaskState) -> Json:
    """The outcome of a sample's episode. Raises InfrastructureError: it was not judged."""
    stored: Json | None = state.store.get(OUTCOME)
    if stored is None:
        raise InfrastructureError("the episode was not judged")
    return stored


async def _finish(state: TaskState, service: EpisodeService, episode_id: str) -> None:
    outcome = await _threaded(lambda: service.finish(episode_id))
    state.store.set(OUTCOME, outcome)


async def _threaded(call: Callable[[], Any]) -> Any:
    return await anyio.to_thread.run_sync(call)


def _act(service: EpisodeService, episode_id: str) -> Any:
    async def act(action: dict[str, Any]) -> list[Content]:
        try:
            turn = await _threaded(lambda: service.act(episode_id, action))
        except UserError as error:
            raise ToolError(str(error)) from error
        return _content(turn)

    described = {"action": f"One action as a JSON object:\n{grammar()}\n`index` is that of the element list."}
    about = "Perform one action, let its time pass, and observe."
    return ToolDef(act, name="act", description=about, parameters=described, max_output=0).as_tool()


def _calls(service: EpisodeService, episode_id: str, function: Function) -> Any:
    """A function of the car as a tool. Inspect itself refuses arguments that do not fit its schema."""

    async def call(**kwargs: Any) -> list[Content]:
        try:
            turn = await _threaded(lambda: service.act(episode_id, action_json(function.name, kwargs)))
        except UserError as error:
            raise ToolError(str(error)) from error
        return _content(turn)

    # Inspect wants each argument described; where the function's words say it all, its name has to do.
    described = {
        name: {"description": name.replace("_", " ")} | schema
        for name, schema in function.parameters["properties"].items()
    }
    takes = ToolParams.model_validate({**function.parameters, "properties": described})
    return ToolDef(call, name=function.name, description=function.about, parameters=takes, max_output=0).as_tool()


def _content(turn: EpisodeTurn) -> list[Content]:
    told = turn.as_json()
    sounds = told.pop("sounds", ())
    found: list[Content] = [ContentText(text=json.dumps(told, ensure_ascii=False))]
    data = (base64.b64encode(picture).decode() for picture in turn.pictures)
    found += (ContentImage(image=f"data:image/png;base64,{each}") for each in data)
    return [*found, *(ContentAudio(audio=f"data:audio/wav;base64,{each}", format="wav") for each in sounds)]
