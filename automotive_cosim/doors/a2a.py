"""The benchmark as an evaluating agent of AgentBeats, over A2A. Needs ``a2a-sdk`` (extra ``doors``).

    assessment request  ->  "3 of 8 episodes" ...  ->  artifact: a sentence, and the result as data

Nothing of a task or a verdict is told before the end.
"""

from __future__ import annotations

import asyncio
import json
import threading
import time
from collections.abc import AsyncIterator, Callable, Collection, Sequence
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import uvicorn
from a2a.helpers.proto_helpers import get_data_parts, new_data_part, new_task_from_user_message, new_text_part
from a2a.server.agent_execution import AgentExecutor, RequestContext
from a2a.server.context import ServerCallContext
from a2a.server.events import EventQueue
from a2a.server.request_handlers import DefaultRequestHandler
from a2a.server.routes import create_agent_card_routes, create_jsonrpc_routes
from a2a.server.tasks import InMemoryTaskStore, TaskUpdater
from a2a.types import AgentCapabilities, AgentCard, AgentInterface, AgentSkill, Task, TaskState
from starlette.applications import Starlette

from automotive_cosim import __version__
from automotive_cosim.contracts.plain import counted
from automotive_cosim.doors.assessment import Assessment, read_assessment, result_of
from automotive_cosim.doors.guard import Guarded, Punctual
from automotive_cosim.errors import CosimError
from automotive_cosim.run.batch import Progress, run_plan
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.record import stamped_folder
from automotive_cosim.run.rows import TrialRow

MODES = ["text/plain", "application/json"]
GRACE_S = 1
"""Seconds in which connections have to end with the server; a stream of progress would not."""
MOST_WAITING = 16
"""Assessments at once, of which one runs: fewer than there are threads."""
MOST_TASKS = 64
"""Kept with their requests and results."""
LOOK_S = 0.5
"""Between two looks whether an assessment was cancelled."""


class _StoppedError(Exception):
    """The assessment was cancelled, or the server ends."""


@dataclass(frozen=True, slots=True)
class _Stoppable(Processes):
    """Workers that end when they are told to."""

    stop: threading.Event = field(default_factory=threading.Event)

    def wait(self, handles: Sequence[Any], timeout_s: float) -> Sequence[Any]:
        end_s = time.monotonic() + timeout_s
        while not self.stop.is_set():
            left_s = max(0.0, end_s - time.monotonic())
            ready = Processes.wait(self, handles, min(LOOK_S, left_s))
            if ready or left_s <= LOOK_S:
                return ready
        raise _StoppedError


class Assessor(AgentExecutor):
    """Runs assessments, one after the other."""

    def __init__(self, workers: int = 1, run: Callable[..., object] = run_plan) -> None:
        """An assessor that has nothing to do yet.

        Args:
            workers: how many episodes it runs in parallel.
            run: runs a plan, as ``run_plan`` does.
        """
        self._workers, self._run = workers, run
        self._turn = asyncio.Lock()
        self._stops: dict[str, threading.Event] = {}

    async def execute(self, context: RequestContext, event_queue: EventQueue) -> None:
        """Runs the assessment that a message asks for."""
        task = context.current_task
        if task is None:
            assert context.message is not None
            task = new_task_from_user_message(context.message)
            await event_queue.enqueue_event(task)
        updater = TaskUpdater(event_queue, task.id, task.context_id)
        if len(self._stops) >= MOST_WAITING:
            words = f"{MOST_WAITING} assessments run or wait already; ask again later"
            await updater.reject(updater.new_agent_message([new_text_part(words)]))
            return
        stop = self._stops[task.id] = threading.Event()
        try:
            await self._assess(context, updater, stop)
        except _StoppedError:
            pass  # ``cancel`` has said so
        except CosimError as error:
            words = " ".join(str(error).split())
            await updater.reject(updater.new_agent_message([new_text_part(words)]))
        finally:
            del self._stops[task.id]

    async def cancel(self, context: RequestContext, event_queue: EventQueue) -> None:
        """Ends an assessment; finished episodes stay in its folder."""
        task = context.current_task
        if task is not None:
            await TaskUpdater(event_queue, task.id, task.context_id).cancel()
            with suppress(KeyError):
                self._stops[task.id].set()

    @property
    def running(self) -> Collection[str]:
        """Ids of the tasks that run or wait, as they are at any time."""
        return self._stops.keys()

    def close(self) -> None:
        for stop in self._stops.values():
            stop.set()

    async def _assess(self, context: RequestContext, updater: TaskUpdater, stop: threading.Event) -> None:
        asked = await asyncio.to_thread(read_assessment, _text(context))
        await asyncio.to_thread(asked.plan.check)
        async with self._turn:
            folder = stamped_folder("assessment")
            loop = asyncio.get_running_loop()

            def tell(progress: Progress[TrialRow]) -> None:
                words = f"{progress.done} of {counted(progress.planned, 'episode')}"
                message = updater.new_agent_message([new_text_part(words)])
                said = updater.update_status(TaskState.TASK_STATE_WORKING, message)
                asyncio.run_coroutine_threadsafe(said, loop).result()

            workers = _Stoppable(self._workers, stop)
            await asyncio.to_thread(self._run, asked.plan, folder, executor=workers, tell=tell)
        words, data = await asyncio.to_thread(_result, asked, folder)
        await updater.add_artifact([new_text_part(words), new_data_part(data)], name="Result")
        await updater.complete()


class _Tasks(InMemoryTaskStore):
    """The newest tasks, and those that run: each keeps its request."""

    def __init__(self, running: Collection[str]) -> None:
        super().__init__()
        self._running, self._kept = running, dict[str, ServerCallContext]()

    async def save(self, task: Task, context: ServerCallContext) -> None:
        self._kept[task.id] = context
        await super().save(task, context)
        over = [each for each in self._kept if each not in self._running][: max(0, len(self._kept) - MOST_TASKS)]
        for old in over:
            await self.delete(old, self._kept.pop(old))


def _result(asked: Assessment, folder: Path) -> tuple[str, Any]:
    words, data = result_of(asked, folder)
    return words, json.loads(json.dumps(data, allow_nan=False))


def _text(context: RequestContext) -> str:
    """The request, which comes as the text of a JSON object or as data."""
    assert context.message is not None
    for data in get_data_parts(context.message.parts):
        if isinstance(data, dict):
            return json.dumps(data)
    return str(context.get_user_input())


def card(url: str) -> AgentCard:
    """The card of the evaluating agent at an address."""
    return AgentCard(
        name="automotive_cosim",
        description="Evaluates agents that operate a car's cockpit by functions, while it drives through live "
        "SUMO traffic; in CAR-bench's contract.",
        version=__version__,
        default_input_modes=MODES,
        default_output_modes=MODES,
        capabilities=AgentCapabilities(streaming=True),
        supported_interfaces=[
            AgentInterface(url=url, protocol_binding="JSONRPC", protocol_version=version)
            for version in ("1.0", "0.3")
        ],
        skills=[
            AgentSkill(
                id="assess",
                name="Assessment",
                description="Plays agents on tasks of the benchmark, and returns rates, pass^k and rows.",
                tags=["benchmark", "evaluation", "automotive"],
                examples=[
                    '{"participants": {"agent": "http://127.0.0.1:8080"}, "config": {"tasks": ["hvac_fan_max"]}}'
                ],
            )
        ],
    )


def make_app(assessor: Assessor, host: str, port: int, url: str) -> Guarded:
    """The application that serves an assessor.

    Args:
        url: its address, as its card says.
    """
    told = card(url)
    handler = DefaultRequestHandler(agent_executor=assessor, task_store=_Tasks(assessor.running), agent_card=told)
    routes = [
        *create_jsonrpc_routes(handler, "/", enable_v0_3_compat=True),
        *create_agent_card_routes(told),
        *create_agent_card_routes(told, card_url="/.well-known/agent.json"),
    ]

    @asynccontextmanager
    async def until_the_end(app: Starlette) -> AsyncIterator[None]:
        yield
        assessor.close()  # the server waits for the threads that run assessments

    return Guarded(Starlette(routes=routes, lifespan=until_the_end), host, port, also=[urlsplit(url).netloc])


def serve(host: str, port: int, url: str, workers: int) -> None:
    """Serves until it is interrupted. Raises SystemExit: the address cannot be used."""
    app = make_app(Assessor(workers), host, port, url)
    uvicorn.run(app, host=host, port=port, log_level="warning", timeout_graceful_shutdown=GRACE_S, http=Punctual)
