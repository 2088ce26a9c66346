"""The benchmark as an evaluating agent: requests, progress, the result, and what is told before the end."""

import asyncio
import json
import re
import shlex
import socket
import threading
import time
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("a2a", reason="the extra doors is not installed")
import httpx
import uvicorn
from a2a.client import ClientConfig, ClientFactory
from a2a.client.card_resolver import parse_agent_card
from a2a.helpers.proto_helpers import get_data_parts, get_text_parts, new_data_part, new_message, new_text_part
from a2a.server.context import ServerCallContext
from a2a.server.events import EventQueue
from a2a.types import Role, SendMessageRequest, Task, TaskState

from automotive_cosim.doors import a2a
from automotive_cosim.doors.a2a import (
    CONFIG,
    MOST_PARTICIPANTS,
    MOST_WORDS,
    Assessor,
    _Stoppable,
    _StoppedError,
    make_app,
    read_assessment,
)
from automotive_cosim.doors.guard import MOST_BYTES
from automotive_cosim.errors import UserError
from automotive_cosim.run.batch import run_plan
from automotive_cosim.run.fork_server import ForkServer
from automotive_cosim.run.plan import Plan
from automotive_cosim.traffic.fork import Simulations
from tests.here import Here
from tests.laws import over
from tests.remote_agent import DONE, FAN, RemoteAgent, served

EXAMPLE = Path(__file__).parents[2] / "docs/examples/agentbeats"
SMALL = {"tasks": ["hvac_fan_max"], "scenarios": ["grid"], "seeds": [0.0], "repeats": 2.0}


@contextmanager
def assessing(run: Callable[..., object] = run_plan) -> Iterator[str]:
    """Serves an assessor; its address."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        port = listening.getsockname()[1]
        url = f"http://127.0.0.1:{port}/"
        assessor = Assessor(run=run)
        server = uvicorn.Server(uvicorn.Config(make_app(assessor, "127.0.0.1", port, url), log_level="error"))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
        thread.start()
        try:
            yield url
        finally:
            server.should_exit = True
            thread.join()


async def ask(url: str, part: Any, version: str = "1.0") -> list[Any]:
    """Everything that comes back."""
    async with httpx.AsyncClient(timeout=120, trust_env=False) as http:
        card = parse_agent_card((await http.get(url + ".well-known/agent-card.json")).json())
        for each in list(card.supported_interfaces):
            if each.protocol_version != version:
                card.supported_interfaces.remove(each)
        client = ClientFactory(ClientConfig(streaming=True, httpx_client=http)).create(card)
        request = SendMessageRequest(message=new_message([part], role=Role.ROLE_USER))
        return [each async for each in client.send_message(request)]


def words_of(events: list[Any]) -> list[str]:
    return [
        " ".join(get_text_parts(each.status_update.status.message.parts))
        for each in events
        if each.HasField("status_update")
    ]


@pytest.mark.slow
def test_an_assessment_tells_its_progress_then_its_result(
    tmp_path: Path, monkeypatch: Any, simulations: Simulations, fork_server: ForkServer
) -> None:
    def once(agent: RemoteAgent, message: Any, turn: int) -> list[Any]:
        agent.metadata = {"turn_metrics": {"prompt_tokens": 10, "completion_tokens": 1}}
        return [{"tool_calls": [FAN, DONE] if len(agent.heard) == 1 else [DONE]}]

    monkeypatch.chdir(tmp_path)
    with served(RemoteAgent(once)) as remote:
        here = Here(simulations, fork_server)

        def run(plan: Plan, folder: Path, executor: Any, tell: Any) -> None:
            run_plan(plan, folder, executor=here, tell=tell)

        with assessing(run) as url:
            asked = {"participants": {"mine": remote.address}, "config": SMALL}
            events = asyncio.run(ask(url, new_text_part(json.dumps(asked))))
    assert len(remote.heard) == 2  # a context for each episode
    (artifact,) = (each.artifact_update.artifact for each in events if each.HasField("artifact_update"))
    assert artifact.name == "Result"
    assert "solves 1 of 2 episodes" in " ".join(get_text_parts(artifact.parts))
    (result,) = get_data_parts(artifact.parts)
    assert (result["score"], result["max_score"], result["pass_rate"], result["errors"]) == (1, 2, 50, 0)
    (mine,) = result["participants"]["mine"]
    assert mine["pass^k"] == {"1": 0.5, "2": 0}
    assert (mine["tokens_in"], mine["tokens_out"]) == (20, 2)
    assert mine["conditions"]["interface"] == "functions"
    assert sorted(row["success"] for row in result["rows"]) == [False, True]
    *before, last = words_of(events)
    assert last == ""
    assert before[0] == "0 of 2 episodes"
    assert before[-1] == "2 of 2 episodes"
    at = next(index for index, each in enumerate(events) if each.HasField("artifact_update"))
    told = " ".join(map(str, events[1:at])) + json.dumps(remote.messages)  # the first event repeats the request
    for word in ("hvac_fan_max", "succe", "solved", "verdict", "grid"):
        assert word not in told


def test_cancelled_workers_end_although_no_episode_has(tmp_path: Path) -> None:
    stop = threading.Event()
    workers = _Stoppable(1, stop)
    assert workers.wait([], 0.0) == []
    stop.set()
    with pytest.raises(_StoppedError):
        workers.wait([], 600.0)


REFUSED = [
    "hello",
    "[]",
    "{}",
    '{"participants": {}}',
    '{"participants": {"x": 7}}',
    '{"participants": {"x": "http://127.0.0.1:9"}, "config": []}',
    *(
        json.dumps({"participants": {"x": "http://127.0.0.1:9"}, "config": config})
        for config in (
            {"agents": ["oracle"]},
            {"models": ["openai/x"]},
            {"drives": ["all"]},
            {"tasks": ["nothing"]},
            {"tasks": 7},
            {"scenarios": ["/etc"]},
            {"scenarios": [{}]},
            {"seeds": [-1]},
            {"seeds": list(range(1000)), "repeats": 1000},
            {"limits": {"steps": 0}},
        )
    ),
    "[" * 100_000,
]


@over(REFUSED)
def test_what_is_no_assessment_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(UserError) as caught:
        read_assessment(text)
    assert "\n" not in str(caught.value)


SEEDS = list(range(40_000))


def test_an_assessment_is_counted_before_it_is_unfolded(monkeypatch: Any) -> None:
    """The lists of one request of some hundred kilobytes can stand for millions of runs."""

    def unfolds(plan: Plan) -> Any:
        raise AssertionError("it was unfolded")

    for name in ("jobs", "unfolded"):
        monkeypatch.setattr(Plan, name, unfolds)
    began_s = time.process_time()
    for config in ({"seeds": SEEDS}, {"seeds": SEEDS[:90], "repeats": 1000}, {"tasks": ["*"], "seeds": SEEDS}):
        with pytest.raises(UserError, match="runs; "):
            read_assessment(json.dumps({"participants": {"x": "http://127.0.0.1:9"}, "config": config}))
    assert time.process_time() - began_s < 5.0


@pytest.mark.parametrize(
    ("participants", "config"),
    [
        ({str(number): f"http://127.0.0.1:{number}" for number in range(MOST_PARTICIPANTS + 1)}, {}),
        ({"x": "http://127.0.0.1:9"}, {"tasks": [f"a*{number}" for number in range(MOST_WORDS + 1)]}),
        ({"x": "http://127.0.0.1:9"}, {"scenarios": [str(number) for number in range(MOST_WORDS + 1)]}),
    ],
)
def test_an_assessment_has_so_many_names_and_no_more(participants: Any, config: Any) -> None:
    with pytest.raises(UserError, match="too many names"):
        read_assessment(json.dumps({"participants": participants, "config": config}))


class Told(EventQueue):  # type: ignore[misc]
    """Keeps what it is told."""

    def __init__(self) -> None:
        self.events: list[Any] = []

    async def enqueue_event(self, event: Any) -> None:
        self.events.append(event)


def asked_for(config: Any) -> Any:
    request = json.dumps({"participants": {"x": "http://127.0.0.1:9"}, "config": config})
    message = new_message([new_text_part(request)], role=Role.ROLE_USER)
    return SimpleNamespace(current_task=None, message=message, get_user_input=lambda: request)


def test_no_request_is_read_where_all_others_wait(monkeypatch: Any) -> None:
    where: list[bool] = []

    def reads(text: str) -> Any:
        where.append(threading.current_thread() is threading.main_thread())
        raise UserError("not now")

    monkeypatch.setattr(a2a, "read_assessment", reads)
    told = Told()
    asyncio.run(Assessor().execute(asked_for({}), told))
    assert where == [False]
    assert told.events[-1].status.state == TaskState.TASK_STATE_REJECTED


def test_so_many_assessments_wait_and_no_more(monkeypatch: Any) -> None:
    monkeypatch.setattr(a2a, "MOST_WAITING", 2)
    begun, go_on = threading.Semaphore(0), threading.Event()

    def reads(text: str) -> Any:
        begun.release()
        go_on.wait(20)
        raise UserError("not now")

    monkeypatch.setattr(a2a, "read_assessment", reads)

    async def together() -> str:
        assessor, last = Assessor(), Told()
        first = [asyncio.create_task(assessor.execute(asked_for({}), Told())) for _ in range(2)]
        for _ in first:
            await asyncio.to_thread(begun.acquire)
        await assessor.execute(asked_for({}), last)
        go_on.set()
        await asyncio.gather(*first)
        assert not assessor.running
        return " ".join(get_text_parts(last.events[-1].status.message.parts))

    assert "2 assessments run or wait already" in asyncio.run(together())


def test_of_tasks_the_newest_and_those_that_run_are_kept(monkeypatch: Any) -> None:
    monkeypatch.setattr(a2a, "MOST_TASKS", 3)
    store, context = a2a._Tasks({"1"}), ServerCallContext()

    async def kept() -> list[str]:
        for number in range(8):
            await store.save(Task(id=str(number), context_id="c"), context)
        return [str(number) for number in range(8) if await store.get(str(number), context)]

    assert asyncio.run(kept()) == ["1", "6", "7"]


def test_the_example_is_an_assessment_and_its_image_takes_what_agentbeats_gives(cli: Any) -> None:
    scenario = tomllib.loads((EXAMPLE / "scenario.toml").read_text(encoding="utf-8"))
    participants = {each["role"]: each["endpoint"] for each in scenario["participants"]}
    plan = read_assessment(json.dumps({"participants": participants, "config": scenario["config"]})).plan
    assert len(plan.jobs()) == 3 * 2 * 3  # one task has two halves
    entry, default = re.findall(r"^(?:ENTRYPOINT|CMD) (.*)$", (EXAMPLE / "Dockerfile").read_text(), re.MULTILINE)
    for line in ([*json.loads(entry), *json.loads(default)], shlex.split(scenario["green_agent"]["cmd"])):
        assert line[0] == "automotive-cosim"
        assert cli(*line[1:], "--card-url", "http://x:9009/", "--help").code == 0


def test_car_benchs_form_is_read_too() -> None:
    asked = read_assessment(json.dumps({"agent_under_test": "http://127.0.0.1:9/", "config": SMALL}))
    assert asked.participants == {"agent_under_test": "http://127.0.0.1:9"}
    assert asked.plan.agents == ("a2a:http://127.0.0.1:9",)
    assert (asked.plan.repeats, asked.plan.seeds) == (2, (0,))
    assert "agents" not in CONFIG


@pytest.mark.slow
def test_a_refusal_is_told_and_foreign_names_are_not_answered(tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(tmp_path)
    nobody = {"participants": {"x": "http://127.0.0.1:9"}, "config": SMALL}
    with assessing() as url:
        events = asyncio.run(ask(url, new_data_part(nobody), "0.3"))
        assert events[-1].status_update.status.state == TaskState.TASK_STATE_REJECTED
        assert "no card of an agent" in words_of(events)[-1]
        for name, value in (("Host", "evil.example"), ("Origin", "http://evil.example")):
            answer = httpx.get(url + ".well-known/agent.json", headers={name: value}, trust_env=False)
            assert answer.status_code in (403, 421)
        for giant, code in (({"content": b" " * (MOST_BYTES + 1)}, 413), ({"content": iter([b"{", b"}"])}, 411)):
            assert httpx.post(url, **giant, trust_env=False).status_code == code
        assert httpx.get(url + ".well-known/agent.json", trust_env=False).json()["name"] == "automotive_cosim"
    assert not list(tmp_path.iterdir())
