"""The benchmark as an evaluating agent of AgentBeats, over A2A. Needs ``a2a-sdk`` (extra ``doors``).

    assessment request  ->  a plan  ->  "3 of 8 episodes" ...  ->  artifact: a sentence, and the result as data

{"participants": {ROLE: URL}, "config": {...}}  asks for it, and  {"score", ..., "rows"}  is the result.

Nothing of a task or a verdict is told before the end.
"""

from __future__ import annotations

import asyncio
import json
import threading
import time
from collections.abc import AsyncIterator, Callable, Collection, Mapping, Sequence
from contextlib import asynccontextmanager, suppress
from dataclasses import asdict, dataclass, field
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
from automotive_cosim.agents.registry import PREFIX
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.doors.guard import Guarded, Punctual
from automotive_cosim.episode.conditions import TABLE
from automotive_cosim.errors import CosimError, UnknownNameError, UserError
from automotive_cosim.report.answer import answer
from automotive_cosim.report.consistency import pass_hats
from automotive_cosim.report.results import Contestant, Results, pairs, read_results
from automotive_cosim.report.stats import Rate
from automotive_cosim.report.summary import rate_of
from automotive_cosim.run.batch import Progress, run_plan
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.plan import Plan, make_plan
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.record import stamped_folder
from automotive_cosim.run.rows import EpisodeRow, TrialRow
from automotive_cosim.scenarios import shipped

CONFIG = (
    "tasks",
    "suite",
    "scenarios",
    "everywhere",
    "seeds",
    "repeats",
    "held_out",
    "split",
    "limits",
    *(each.name for each in TABLE),
)
"""What an assessment may set of a plan."""
NAMES = ("tasks", "scenarios")
DEFAULTS: Json = {"interface": ["functions"], "see": ["nothing"]}
"""How agents of CAR-bench's contract are played unless the assessment says otherwise."""
MOST_RUNS = 100_000
"""Of one assessment, counted before it is unfolded."""
MOST_PARTICIPANTS, MOST_WORDS = 32, 1000
"""Of one assessment: agents, and names of tasks and scenarios."""


@dataclass(frozen=True, slots=True)
class Assessment:
    """What was asked for."""

    participants: Mapping[str, str]
    """Addresses by role."""
    plan: Plan


def read_assessment(text: str) -> Assessment:
    """Reads an assessment request: AgentBeats' form, or CAR-bench's with ``agent_under_test``.

    Raises UserError: it is none, or its plan cannot be run."""
    try:
        asked = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise UserError(f"the assessment request is not JSON ({error}); {FORM}") from error
    if not isinstance(asked, dict):
        raise UserError(f"the assessment request is no JSON object; {FORM}")
    named = asked.get("participants")
    if named is None and "agent_under_test" in asked:
        named = {"agent_under_test": asked["agent_under_test"]}
    if not isinstance(named, dict) or not named or not all(isinstance(url, str) for url in named.values()):
        raise UserError(f"the assessment request names no participants; {FORM}")
    config = {} if asked.get("config") is None else asked["config"]
    if not isinstance(config, dict):
        raise UserError(f"the config of the assessment request is no JSON object; {FORM}")
    for name in config:
        if name not in CONFIG:
            raise UnknownNameError("setting of an assessment", name, CONFIG)
    if len(named) > MOST_PARTICIPANTS or sum(map(_length, (config.get(name) for name in NAMES))) > MOST_WORDS:
        most = f"{MOST_PARTICIPANTS} participants and {MOST_WORDS:,} names of tasks and scenarios"
        raise UserError(f"the assessment has too many names; at most {most} are allowed")
    values = {name: _whole(value) for name, value in config.items()}
    participants = {str(role): url.rstrip("/") for role, url in named.items()}
    plan = make_plan({**DEFAULTS, **values, "agents": [PREFIX + url for url in participants.values()]})
    for name in plan.scenarios:
        if name not in shipped():  # no folder of this machine
            raise UnknownNameError("scenario", name, shipped(), "automotive-cosim scenarios list")
    if (count := plan.most_runs()) > MOST_RUNS:
        raise UserError(
            f"the assessment has {count:,} runs; at most {MOST_RUNS:,} are allowed, so take fewer seeds"
        )
    return Assessment(participants, plan)


FORM = 'send {"participants": {"ROLE": "http://HOST:PORT"}, "config": {"tasks": ["general"]}}'


def result_of(asked: Assessment, folder: Path) -> tuple[str, Json]:
    """The result of an evaluation in a sentence, and as data."""
    found = read_results(folder)
    everything = rate_of(found.rows)
    data: Json = {
        "score": everything.successes,
        "max_score": everything.planned,
        "pass_rate": 100 * (everything.value or 0.0),
        "errors": everything.errors,
        "participants": {
            role: [_standing(found, each) for each in found.contestants if each.agent == PREFIX + url]
            for role, url in asked.participants.items()
        },
        "rows": [as_json(row) for row in found.rows],
        "version": __version__,
    }
    return answer(found), data


def _standing(found: Results, each: Contestant) -> Json:
    rows: Sequence[EpisodeRow] = found.of(each)
    most = int(found.manifest["plan"]["repeats"])
    return {
        "agent": each.agent,
        "conditions": {one.name: str(getattr(each.conditions, one.name)) for one in TABLE},
        "episodes": _rate(rate_of(rows)),
        "pairs": _rate(rate_of(pair for pair, _ in pairs(rows))),
        "pass^k": {str(k): share for k, share in enumerate(pass_hats(rows, most), start=1)},
        "tokens_in": sum(row.tokens_in for row in rows),
        "tokens_out": sum(row.tokens_out for row in rows),
        "cost_usd": sum(row.cost_usd for row in rows),
    }


def _rate(rate: Rate) -> Json:
    return {
        "successes": rate.successes,
        "planned": rate.planned,
        "errors": rate.errors,
        "rate": rate.value,
        "interval": None if rate.interval is None else asdict(rate.interval),
    }


def _length(value: object) -> int:
    return len(value) if isinstance(value, list) else 0


def _whole(value: Any) -> Any:
    """The value with whole numbers as such: data in A2A knows only floats."""
    if isinstance(value, dict):
        return {name: _whole(entry) for name, entry in value.items()}
    if isinstance(value, list):
        return [_whole(entry) for entry in value]
    return int(value) if isinstance(value, float) and value.is_integer() else value


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
