"""A server of the Model Context Protocol: any assistant that speaks it can sit at the cockpit.

Every request stands alone, as the protocol has it since 2026: ``start`` returns an ``episode_id``, and every other
tool takes it. Needs the ``mcp`` package (extra ``doors``).
"""

from __future__ import annotations

import base64
import functools
import inspect
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import anyio.from_thread
from mcp.server.mcpserver import Context, MCPServer
from mcp.server.mcpserver.exceptions import ToolError
from mcp_types import (
    AudioContent,
    CallToolResult,
    ContentBlock,
    ImageContent,
    InputRequiredResult,
    TextContent,
    Tool,
)
from pydantic import BeforeValidator, Field, WithJsonSchema

from automotive_cosim import __version__
from automotive_cosim.cockpit.actions import grammar
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import Interface
from automotive_cosim.doors.shared import (
    SERVING,
    called,
    conditions_of,
    own_scenario,
    takes_blanks,
    takes_conditions,
    trial,
    typed,
)
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.episode.observer import Observer
from automotive_cosim.errors import CosimError, InfrastructureError, UnknownNameError
from automotive_cosim.interface.functions import Function, offered
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.run.choosing import choose
from automotive_cosim.scenarios import Scenario
from automotive_cosim.service import EpisodeService, EpisodeTurn
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasks import CATALOGUE

INSTRUCTIONS = f"""\
You operate the touch screen and the safety functions of a car for its driver, while it drives through live
traffic.

Call `start` to begin an episode. It returns an `episode_id`, what the driver wants (`goal`) and has said since
(`said`), the screen with its elements, the car's readings and what applies where the car is. Then call `act`,
one action at a time.

{SERVING}
Once `end` is not null, call `finish` for the verdict.

`start` also begins a drive (`list_drives`), on which you keep watch: `wait` until something changes, and act only
when safety or the law requires it. `status` ends nothing there; go on until `end` is not null."""

CALLING = f"""\
You operate a car for its driver by its functions, while it drives through live traffic.

Call `start` to begin an episode. It returns an `episode_id`, what the driver wants (`goal`) and has said since
(`said`), the car's readings and what applies where the car is. Then call the car's functions, one at a time,
each with the `episode_id`.

{SERVING}
Once `end` is not null, call `finish` for the verdict.

`start` also begins a drive (`list_drives`), on which you keep watch: `wait` until something changes, and act only
when safety or the law requires it. `status` ends nothing there; go on until `end` is not null."""

ActionArgument = Annotated[
    str,
    BeforeValidator(lambda action: json.dumps(action) if isinstance(action, dict) else action),
    WithJsonSchema({"anyOf": [{"type": "object", "additionalProperties": True}, {"type": "string"}]}),
    Field(description=f"One action as a JSON object:\n{grammar()}\n`index` is that of the element list."),
]
"""An object or its text. The host takes it for a text: it reads the JSON of others itself, and ``mcp`` 2.0.0 breaks
on what is nested too deep."""
EpisodeId = Annotated[str, Field(description="The id that `start` returned.")]


class _CockpitServer(MCPServer[Any]):
    """A server that refuses arguments which a tool does not have, in place of leaving them out."""

    async def list_tools(self) -> list[Tool]:
        """The tools, whose schemas say so."""
        tools: list[Tool] = await super().list_tools()
        for tool in tools:
            tool.input_schema = tool.input_schema | {"additionalProperties": False}
        return tools

    async def call_tool(
        self, name: str, arguments: dict[str, Any], context: Context[Any, Any] | None = None
    ) -> CallToolResult | InputRequiredResult:
        """Calls a tool. Raises ToolError: it has no such argument, or it says so itself."""
        for tool in await super().list_tools():
            known = tool.input_schema.get("properties", {})
            for unknown in arguments.keys() - known.keys() if tool.name == name else ():
                raise ToolError(str(UnknownNameError(f"argument of {name}", unknown, known)))
        return await super().call_tool(name, arguments, context)


def make_server(
    service: EpisodeService, interface: Interface = Interface.TOUCH, scenarios: Path | None = None
) -> MCPServer[Any]:
    """A server of the service's episodes, not yet running. The caller closes the service.

    Args:
        interface: how agents act unless ``start`` says otherwise. With ``functions`` or ``both``, every function of
            the car is a tool from the beginning, else from the first episode that is started with them: the
            protocol has no sessions that could have tools of their own.
        scenarios: folder of the scenarios that ``start`` takes beside the shipped ones.
    """
    told = INSTRUCTIONS if interface.touches else CALLING
    server = _CockpitServer("automotive-cosim", instructions=told, version=__version__, log_level="WARNING")
    tools = CockpitTools(service, server, interface, scenarios)
    acting = (tools.act,) if interface.touches else ()
    for tool in (tools.list_tasks, tools.list_drives, tools.start, tools.observe, *acting, tools.finish):
        server.add_tool(tool)
    if interface.calls:
        tools.add_functions()
    return server


def _told(call: Callable[..., CallToolResult]) -> Callable[..., CallToolResult]:
    """Tells the client of every error that this package raises on purpose; the server hides all others."""

    @functools.wraps(call)
    def told(*given: Any, **named: Any) -> CallToolResult:
        try:
            return call(*given, **named)
        except InfrastructureError as error:
            raise ToolError(f"infrastructure error, not yours: {error}") from error
        except CosimError as error:
            raise ToolError(str(error)) from error

    return told


class CockpitTools:
    """The tools; the server calls them on threads of its own. Their docstrings are what the client reads."""

    def __init__(
        self,
        service: EpisodeService,
        server: MCPServer[Any] | None = None,
        interface: Interface = Interface.TOUCH,
        scenarios: Path | None = None,
    ) -> None:
        self._scenarios = scenarios
        self._service = service
        self._server = server
        self._interface = interface
        self._has_functions = False

    def add_functions(self) -> None:
        """Makes every function a tool of the server, once."""
        if self._server is not None and not self._has_functions:
            self._has_functions = True
            for function in offered(Interface.FUNCTIONS):
                self._server.add_tool(self._calling(function), name=function.name, description=function.about)

    def _calling(self, function: Function) -> Callable[..., CallToolResult]:
        """The tool that calls a function."""

        def call(episode_id: str, **arguments: Any) -> CallToolResult:
            return _turn(self._service.act(episode_id, called(function, arguments)))

        takes = inspect.Parameter("episode_id", inspect.Parameter.KEYWORD_ONLY, annotation=EpisodeId)
        return typed(function, _told(call), takes, returns=CallToolResult)

    @_told
    @takes_blanks
    def list_tasks(
        self,
        tasks: Annotated[
            list[str] | str,
            Field(description="Ids, patterns, modules, general, safety or all; separated by commas."),
        ] = "all",
        suite: Annotated[
            str,
            Field(description=f"{', '.join(Suite)}, live or all; an id names its task in any."),
        ] = "standard",
    ) -> CallToolResult:
        """List the tasks that `start` takes, with their halves."""
        words = tasks.split(",") if isinstance(tasks, str) else tasks
        chosen = [CATALOGUE[name] for name in choose((word.strip() for word in words), suite)]
        return _result({"tasks": [{"id": task.id, "halves": list(task.halves)} for task in chosen]})

    @_told
    def list_drives(self) -> CallToolResult:
        """List the families of drives that `start` takes."""
        drives = [
            {"id": family.id, "scenario": family.scenario, "about": family.about} for family in FAMILIES.values()
        ]
        return _result({"drives": drives})

    @_told
    @takes_conditions
    @takes_blanks
    def start(
        self,
        context: Context[Any, Any],
        task: Annotated[str | None, Field(description="Id of a task; `list_tasks` lists them.")] = None,
        drive: Annotated[
            str | None, Field(description="A family of drives instead; `list_drives` lists them.")
        ] = None,
        half: Annotated[str, Field(description="first, or second for a task with two halves.")] = "first",
        seed: Annotated[
            Annotated[int, Field(ge=0)] | None, Field(description="The same seed and actions give the same trace.")
        ] = 0,
        scenario: Annotated[str | None, Field(description="A scenario in place of its own.")] = None,
        minutes: Annotated[
            float | None, Field(description="When a drive is over, if it would last longer.")
        ] = None,
        errands: Annotated[
            bool, Field(description="Whether people aboard also ask for things on a drive.")
        ] = False,
        channels: Annotated[
            list[str] | None, Field(description=f"What to observe: {', '.join(Channel)}; all by default.")
        ] = None,
        **conditions: str,
    ) -> CallToolResult:
        """Start an episode: a car drives until the situation of the task arises, then you take over its cockpit.
        Or start a drive, on which you keep watch from departure.
        With interface functions or both, the car's functions are tools from then on: list the tools again."""
        under = conditions_of(conditions)
        if under.interface is Interface.TOUCH:
            under = replace(under, interface=self._interface)
        if under.interface.calls:
            self.add_functions()
        where = own_scenario(scenario, self._scenarios)
        spec = trial(task, drive, half, seed, where, minutes, under, errands=errands)
        return _turn(self._service.start(spec, _channels(channels), _Progress(context)))

    @_told
    def observe(self, episode_id: EpisodeId) -> CallToolResult:
        """Look at the screen and the car's readings again; no time passes."""
        return _turn(self._service.observe(episode_id))

    @_told
    def act(self, episode_id: EpisodeId, action: ActionArgument) -> CallToolResult:
        """Perform one action, let its time pass, and observe. One that cannot be read counts as a step too."""
        return _turn(self._service.act(episode_id, action))

    @_told
    def finish(self, episode_id: EpisodeId) -> CallToolResult:
        """End the episode and get its verdict. One without a declared status is judged as it is."""
        return _result(self._service.finish(episode_id))


class _Progress(Observer):
    """Tells the client of the warm-up, from the thread of a tool."""

    def __init__(self, context: Context[Any, Any]) -> None:
        self._context = context

    def loading(self, scenario: Scenario) -> None:
        self._report(0.0, None, f"loading {scenario.title}")

    def warming(self, scenario: str, done_s: float, total_s: float) -> None:
        self._report(done_s, total_s, f"warming up the traffic of {scenario}")

    def _report(self, done: float, total: float | None, message: str) -> None:
        anyio.from_thread.run(self._context.report_progress, done, total, message)


def _channels(names: list[str] | None) -> frozenset[Channel]:
    if names is None:
        return ALL
    for name in names:
        if name not in set(Channel):
            raise UnknownNameError("channel", name, Channel)
    return frozenset(map(Channel, names))


def _turn(turn: EpisodeTurn) -> CallToolResult:
    data = (base64.b64encode(picture).decode() for picture in turn.pictures)
    seen = (ImageContent(type="image", data=each, mime_type="image/png") for each in data)
    told = turn.as_json()
    heard = (AudioContent(type="audio", data=each, mime_type="audio/wav") for each in told.pop("sounds", ()))
    return _result(told, *seen, *heard)


def _result(value: Json, *parts: ContentBlock) -> CallToolResult:
    """A value for programs, and the same as text, pictures and sounds for models."""
    text = TextContent(type="text", text=json.dumps(value, ensure_ascii=False))
    return CallToolResult(content=[text, *parts], structured_content=value)
