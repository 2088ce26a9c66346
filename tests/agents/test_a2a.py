"""Agents behind an address: the contract, both protocols, metrics, and agents that mean harm."""

import base64
import json
import re
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager
from dataclasses import replace
from typing import Any

import pytest

from automotive_cosim.agents import AgentSettings, Caller, StageName, make_agent
from automotive_cosim.agents.a2a.agent import MOST_CALLS, AnswerReader
from automotive_cosim.agents.registry import PREFIX
from automotive_cosim.contracts import Action, ActionType, Feedback, FeedbackCode, Observation
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.specification import SessionSetup
from automotive_cosim.errors import ActionError, AgentError, OutOfBudgetError, SetupError, UserError
from automotive_cosim.interface.functions import as_openai, functions, offered
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.models.base import DEAREST_USD, IN_PER_S, OUT_PER_S
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.fork_server import ForkServer
from automotive_cosim.run.outside import OutsideAgent
from automotive_cosim.run.trial import run_trial
from automotive_cosim.tasking.task import Task
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations
from tests.agents.test_caller import CALLS, Scripted
from tests.remote_agent import (
    CARD_0_3,
    CARD_1_0,
    DONE,
    FAN,
    Json,
    RawError,
    RemoteAgent,
    Script,
    data,
    served,
    text,
)

pytest.importorskip("a2a")
Seen = Callable[..., Observation]
Serve = Callable[..., RemoteAgent]
SETTINGS = AgentSettings(CALLS)
METRICS = {"prompt_tokens": 70, "completion_tokens": 5, "thinking_tokens": 3, "cost": 0.05, "num_llm_calls": 2}


@pytest.fixture
def serve() -> Iterator[Serve]:
    """Serves an agent until the test ends."""
    with ExitStack() as ends:
        yield lambda *args, **named: ends.enter_context(served(RemoteAgent(*args, **named)))


def answering(*answers: list[Any]) -> Script:
    """Gives these answers in turn, in each context."""
    return lambda agent, message, turn: answers[turn]


def calls(*told: Json) -> Json:
    return {"tool_calls": list(told)}


def play(served: RemoteAgent, seen: Observation, settings: AgentSettings = SETTINGS) -> Any:
    agent = make_agent(PREFIX + served.address, settings=settings)
    agent.reset(seen.goal)
    return agent


@pytest.mark.parametrize("card", [CARD_1_0, CARD_0_3], ids=["1.0", "0.3"])
def test_a_task_is_told_as_car_bench_tells_it_and_calls_are_steps(
    serve: Serve, observation: Seen, card: Json
) -> None:
    remote = serve(
        answering(["One moment.", calls(FAN, {"toolName": "get_signals", "arguments": {"path": "hvac"}})],
                  [calls(DONE)], ["It is done."]),
        card, "agent.json" if card is CARD_0_3 else "agent-card.json",
    )  # fmt: skip
    remote.metadata = {"turn_metrics": METRICS}
    seen = observation("Fan to the maximum")
    agent = play(remote, seen)
    first = agent.act(seen)
    assert (first.function, first.arguments) == ("set_hvac_fan_speed", {"percent": 100.0})
    assert agent.act(replace(seen, feedback=Feedback(FeedbackCode.OK, "done"))).function == "get_signals"
    (opening,) = remote.messages
    assert text(opening).startswith("System: You operate a car")
    assert text(opening).endswith("\n\nUser: Fan to the maximum")
    assert "## The car now\nspeed_kmh" in text(opening)
    assert opening["metadata"] == {"source": "user"}
    tools = data(opening)["tools"]
    assert tools == [as_openai(each) for each in offered(CALLS.interface, CALLS.geo)]
    last = agent.act(replace(seen, feedback=Feedback(FeedbackCode.OK, "{}")))
    assert last.action_type is ActionType.STATUS
    told = remote.messages[1]
    assert told["metadata"] == {"source": "environment"}
    results = data(told)["tool_results"]
    assert [each["tool_name"] for each in results] == ["set_hvac_fan_speed", "get_signals"]
    assert results[0]["content"] == "ok: done"
    assert results[1]["content"].startswith("ok: {}\n\n## What the driver said")
    assert len({each["tool_call_id"] for each in results}) == 2
    assert len(remote.messages) == 2  # it has reported; nothing is to be asked any more
    (reply,) = [stage.reply for stage in agent.stages if stage.reply is not None]
    assert (reply.tokens_in, reply.tokens_out, reply.tokens_reasoning, reply.cost_usd) == (70, 8, 3, 0.05)
    assert len(remote.heard) == 1
    agent.reset("x")
    agent.act(seen)
    assert len(remote.heard) == 2  # another context


@pytest.mark.parametrize("card", [CARD_1_0, CARD_0_3], ids=["1.0", "0.3"])
def test_words_as_sound_are_parts_of_their_own_each_once(serve: Serve, observation: Seen, card: Json) -> None:
    where = "agent.json" if card is CARD_0_3 else "agent-card.json"
    remote = serve(answering(["Pardon?"], ["Pardon?"], [calls(DONE)]), card, where)
    seen = replace(observation("[spoken]"), sounds=(b"RIFF wish",))
    agent = play(remote, seen)
    agent.act(seen)
    again = replace(seen, said=("[spoken]",), sounds=(b"RIFF wish", b"RIFF again"))
    agent.act(again)
    agent.act(again)
    heard = [re.findall(r"UklGR[\w+/=]*", json.dumps(message)) for message in remote.messages]
    sounds = [[base64.b64decode(each) for each in found] for found in heard]
    assert sounds[:2] == [[b"RIFF wish"], [b"RIFF again"]]
    assert not any(sounds[2:])
    assert all("audio/wav" in json.dumps(message) for message in remote.messages[:2])


def test_episodes_side_by_side_have_contexts_of_their_own(serve: Serve, observation: Seen) -> None:
    remote = serve(answering([calls(FAN)], [calls(DONE)], ["Done."]))
    seen = observation("x")
    first, second = play(remote, seen), play(remote, seen)
    for agent in (first, second):
        assert agent.act(seen).function == "set_hvac_fan_speed"
    for agent in (second, first):
        assert agent.act(seen).action_type is ActionType.STATUS
    assert [len(messages) for messages in remote.heard.values()] == [3, 3]


def test_metrics_that_come_with_the_last_words_are_waited_for(serve: Serve, observation: Seen) -> None:
    def script(agent: RemoteAgent, message: Json, turn: int) -> list[Any]:
        agent.metadata = {"turn_metrics": METRICS} if turn else {}
        return ["You are welcome." if turn else calls(DONE)]

    seen = observation("Nothing")
    remote = serve(script)
    agent = play(remote, seen)
    assert agent.act(seen).action_type is ActionType.STATUS
    assert sum(stage.reply.tokens_in for stage in agent.stages if stage.reply) == 70
    assert [each["content"] for each in data(remote.messages[1])["tool_results"]] == ["ok"]


def test_no_more_is_believed_of_its_figures_than_can_have_been(serve: Serve, observation: Seen) -> None:
    remote = serve(answering([calls(DONE)]))
    remote.metadata = {"turn_metrics": dict.fromkeys(METRICS, 10**9)}
    agent = play(remote, seen := observation("Nothing"))
    agent.act(seen)
    (reply,) = [stage.reply for stage in agent.stages if stage.reply is not None]
    most_in, most_out = (rate * (1.01 + reply.seconds) for rate in (IN_PER_S, OUT_PER_S))
    assert (reply.tokens_in <= most_in, reply.tokens_out <= most_out) == (True, True)
    assert reply.cost_usd <= DEAREST_USD * (reply.tokens_in + reply.tokens_out)


def test_a_failure_after_the_declaration_changes_nothing(serve: Serve, observation: Seen) -> None:
    def script(agent: RemoteAgent, message: Json, turn: int) -> list[Any]:
        if turn:
            raise RawError(status=500)
        return [calls(DONE)]

    agent = play(serve(script), observation("Nothing"))
    assert agent.act(observation("Nothing")).action_type is ActionType.STATUS


def test_words_alone_are_put_to_the_driver_and_the_answer_comes_back(serve: Serve, observation: Seen) -> None:
    remote = serve(answering(["Which\nseat? " + "x" * 200], [calls(FAN)]))
    seen = observation("Warm it")
    agent = play(remote, seen)
    asked = agent.act(seen)
    assert asked == Action(ActionType.ASK_DRIVER, text=("Which seat? " + "x" * 200)[:120])
    agent.act(replace(seen, said=("Mine.",)))
    assert text(remote.messages[1]).startswith("Mine.\n\n## What the driver said")
    assert not data(remote.messages[1])
    assert remote.messages[1]["metadata"] == {"source": "user"}


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        ([], "neither words nor a call"),
        ([{"other": 1}], "neither words nor a call"),
        ([calls({"tool_name": "set_fan", "arguments": {}})], "no function 'set_fan'"),
        ([calls({})], "no function empty"),
        ([calls({"tool_name": "click", "arguments": {"x": 1, "y": 1}})], "no function 'click'"),
        ([calls({"tool_name": "set_hvac_fan_speed", "arguments": {"percent": 400}})], "goes from 0 to 100"),
        ([calls({"tool_name": "set_hvac_fan_speed", "arguments": "{"})], "not JSON"),
        ([calls(*[FAN] * (MOST_CALLS + 1))], "at most 10"),
    ],
)
def test_an_answer_that_does_nothing_is_one_failed_step(
    serve: Serve, observation: Seen, answer: list[Any], why: str
) -> None:
    seen = observation("x")
    agent = play(serve(answering(answer, [calls(DONE)], [])), seen)
    with pytest.raises(ActionError, match=re.escape(why)):
        agent.act(seen)
    assert agent.act(seen).action_type is ActionType.STATUS


def raising(error: Exception) -> Script:
    def script(agent: RemoteAgent, message: Json, turn: int) -> list[Any]:
        raise error

    return script


def deep(agent: RemoteAgent, message: Json, turn: int) -> list[Any]:
    raise RawError(b"[" * 100_000)


def slow(agent: RemoteAgent, message: Json, turn: int) -> list[Any]:
    time.sleep(2.0)
    return [calls(FAN)]


def changing(agent: RemoteAgent, message: Json, turn: int) -> list[Any]:
    agent.context = f"another-{len(agent.messages)}"
    return [calls(FAN)]


HOSTILE = {
    "an error": (raising(RawError(status=500)), "HTTP"),
    "broken JSON": (raising(RawError(b'{"jsonrpc": ')), "JSON"),
    "no object": (raising(RawError(b"[]")), "no JSON object"),
    "no result": (raising(RawError(b'{"jsonrpc": "2.0"}')), "another question"),
    "no words": (
        raising(RawError(b'{"jsonrpc": "2.0", "id": "1", "error": {"code": -32603, "message": "x"}}')),
        "x",
    ),
    "deep": (deep, "no answer"),
    "giant": (lambda agent, message, turn: ["x" * 2**20], "bytes"),
    "compressed": (raising(RawError(b"x", Content_Encoding="gzip")), "compressed"),
    "a redirect": (raising(RawError(status=307, Location="http://127.0.0.1:1/")), "redirects"),
    "another question's id": (
        raising(RawError(b'{"jsonrpc": "2.0", "id": "0", "result": {}}')),
        "another question",
    ),
    "another context": (changing, "another context"),
    "slow": (slow, "within 0.2 s"),
    "no list": (answering([{"tool_calls": 7}]), "not a list"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_whatever_else_it_does_is_its_own_failure(serve: Serve, observation: Seen, name: str) -> None:
    script, why = HOSTILE[name]
    seen = observation("x")
    agent = play(serve(script), seen, replace(SETTINGS, answer_s=0.2 if name == "slow" else 5.0))
    if name == "another context":
        agent.act(seen)  # the first answer may name one
    with pytest.raises(AgentError, match=why) as caught:
        agent.act(seen)
    assert len(str(caught.value)) < 400
    assert "\n" not in str(caught.value)


def test_half_characters_and_senseless_figures_do_no_harm(serve: Serve, observation: Seen) -> None:
    said = AnswerReader({}).read(
        ["\ud800 hm"], {"turn_metrics": {"prompt_tokens": float("nan"), "cost": -1, "x": {}}}
    )
    assert (said.say, said.metrics and said.metrics.cost_usd) == ("? hm", 0.0)
    for figure in (10**30, "9", None, True, [], float("inf")):
        metrics = AnswerReader({}).read([], {"turn_metrics": {"prompt_tokens": figure}}).metrics
        assert metrics is not None
        assert metrics.tokens_in == 0


WORDS = ["Which ", "tem", "perature ", "would you ", "like?"]
MANNERS = {
    "message": "a message",
    "status": "a task, with the answer in the message of its status",
    "artifact": "a task, with the answer in an artifact",
    "chunks": "an artifact in chunks",
    "both": "an artifact, repeated in the status",
    "chunks and status": "an artifact in chunks, repeated in the status",
    "split": "words in the status, calls in an artifact, and the other way round",
    "open": "one task for the whole conversation, with the answer in the status",
    "open, artifacts": "the same, with an artifact for each answer",
    "open, one artifact": "the same, with one artifact that each answer replaces",
    "open, growing artifact": "the same, with one artifact to which each answer is appended",
}


@pytest.mark.parametrize(
    ("version", "manner"), [*(("1.0", each) for each in MANNERS), ("0.3", "message"), ("0.3", "both")]
)
def test_agents_made_with_the_sdk_are_heard_once_and_whole(observation: Seen, version: str, manner: str) -> None:
    seen = observation("Fan to the maximum")
    with sdk_agent(version, manner) as address:
        agent = make_agent(PREFIX + address, settings=SETTINGS)
        agent.reset(seen.goal)
        assert agent.act(seen) == Action(ActionType.ASK_DRIVER, text="".join(WORDS))
        for _ in range(3):  # the same call in two answers, and twice in the second
            assert agent.act(seen).function == "set_hvac_fan_speed"
        assert agent.act(seen).action_type is ActionType.STATUS
        assert sum(stage.reply.tokens_in for stage in agent.stages if stage.reply) == 70


@contextmanager
def sdk_agent(version: str, manner: str) -> Iterator[str]:
    """Serves an agent of CAR-bench's kind: words, calls, the end, then words with metrics. Its address."""
    import uvicorn
    from a2a.helpers.proto_helpers import new_data_part, new_message, new_task_from_user_message, new_text_part
    from a2a.server.agent_execution import AgentExecutor
    from a2a.server.request_handlers import DefaultRequestHandler
    from a2a.server.routes import create_agent_card_routes, create_jsonrpc_routes
    from a2a.server.tasks import InMemoryTaskStore, TaskUpdater
    from a2a.types import AgentCard, Role, TaskState
    from google.protobuf.json_format import ParseDict
    from starlette.applications import Starlette

    answers = [
        [new_text_part("".join(WORDS))],
        [new_data_part(calls(FAN))],
        [new_data_part(calls(FAN, FAN))],
        [new_data_part(calls(DONE))],
        [new_text_part("Done.")],
    ]

    class Executor(AgentExecutor):
        def __init__(self) -> None:
            self.turns: dict[str, int] = {}

        async def execute(self, context: Any, event_queue: Any) -> None:
            turn = self.turns[context.context_id] = self.turns.get(context.context_id, -1) + 1
            metadata = {"turn_metrics": METRICS} if turn == 4 else {}
            answer = new_message(answers[turn], context.context_id, role=Role.ROLE_AGENT)
            answer.metadata.update(metadata)
            if manner == "message":
                await event_queue.enqueue_event(answer)
                return
            task = context.current_task or new_task_from_user_message(context.message)
            if context.current_task is None:
                await event_queue.enqueue_event(task)
            updater = TaskUpdater(event_queue, task.id, task.context_id)
            await updater.start_work(new_message([new_text_part("Hm.")], context.context_id, role=Role.ROLE_AGENT))
            in_status = manner in ("status", "open", "both", "chunks and status") or (
                manner == "split" and turn % 2
            )
            if "chunks" in manner and not turn:
                for at, word in enumerate(WORDS):
                    await updater.add_artifact([new_text_part(word)], artifact_id="a", append=at > 0)
            elif manner == "open, growing artifact":
                await updater.add_artifact(answers[turn], artifact_id="a", append=turn > 0, metadata=metadata)
            elif manner == "open, one artifact":
                await updater.add_artifact(answers[turn], artifact_id="a", metadata=metadata)
            elif not in_status or manner in ("both", "chunks and status"):
                await updater.add_artifact(answers[turn], metadata=metadata)
            said = answer if in_status else None
            if manner.startswith("open"):
                await updater.update_status(TaskState.TASK_STATE_INPUT_REQUIRED, said)
            else:
                await updater.complete(said)

        async def cancel(self, context: Any, event_queue: Any) -> None:
            raise NotImplementedError

    card = ParseDict(CARD_1_0, AgentCard())
    card.supported_interfaces[0].url = "http://elsewhere.invalid/"
    card.supported_interfaces[0].protocol_version = version
    handler = DefaultRequestHandler(agent_executor=Executor(), task_store=InMemoryTaskStore(), agent_card=card)
    routes = [*create_jsonrpc_routes(handler, "/", enable_v0_3_compat=True), *create_agent_card_routes(card)]
    server = uvicorn.Server(uvicorn.Config(Starlette(routes=routes), log_level="error", lifespan="off"))
    with socket.create_server(("127.0.0.1", 0)) as listening:
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
        thread.start()
        try:
            yield f"http://127.0.0.1:{listening.getsockname()[1]}"
        finally:
            server.should_exit = True
            thread.join()


def test_whole_numbers_are_whole_again() -> None:
    called = {"tool_name": "wait", "arguments": {"seconds": 3.0}}
    (call,) = AnswerReader(functions()).read([calls(called)], {}).calls
    assert repr(call.arguments) == "{'seconds': 3}"


def test_the_budget_ends_the_conversation(serve: Serve, observation: Seen) -> None:
    remote = serve(answering([calls(FAN)]))
    remote.metadata = {"turnMetrics": {"promptTokens": 100.0}}
    seen = observation("x")
    agent = play(remote, seen, replace(SETTINGS, most_tokens=100))
    agent.act(seen)
    with pytest.raises(OutOfBudgetError, match="100 of 100 tokens"):
        agent.act(seen)


@pytest.mark.parametrize("address", ["", "127.0.0.1:9", "ftp://x", "http://", "http://me:secret@x", "http://x:y"])
def test_what_is_no_address_is_said(address: str) -> None:
    with pytest.raises(UserError, match="a2a:http://HOST:PORT"):
        make_agent(f"a2a:{address}")


@pytest.mark.parametrize("card", [None, [], {"name": "x"}, CARD_1_0 | {"supportedInterfaces": 7}])
def test_an_address_without_an_agent_is_an_error_of_the_user(serve: Serve, card: Any) -> None:
    remote = serve(answering(), card)
    with pytest.raises(SetupError, match="no card of an agent"):
        make_agent(PREFIX + remote.address)
    with pytest.raises(SetupError, match="start the agent"):
        make_agent("a2a:http://127.0.0.1:9")


def test_it_gets_no_picture_and_is_refused_where_it_would_see_nothing(serve: Serve) -> None:
    agent = make_agent(PREFIX + serve(answering()).address)
    assert ALL - agent.channels == {Channel.SCREENSHOT}
    with pytest.raises(UserError, match="see tree"):
        SessionSetup(agent.channels, Conditions.named({"see": "picture"}))


def test_it_sees_what_the_caller_sees_and_nothing_else(serve: Serve, observation: Seen) -> None:
    """Whatever the conditions, the words are those of the agent ``caller``, the picture aside."""
    seen = observation("Warm it")
    remote = serve(answering([calls(FAN)]))
    for words in ({}, {"geo": "none"}, {"see": "nothing"}, {"geo": "gps", "see": "tree"}):
        settings = AgentSettings(Conditions.named({"interface": "functions", **words}))
        agent = play(remote, seen, settings)
        agent.act(seen)
        model = Scripted([{"name": "wait", "arguments": {}}])
        caller = Caller(model, settings)
        caller.reset(seen.goal)
        caller.act(seen)
        goal, situation = model.asked[0][-1].text.split("## Last result")
        assert text(remote.messages[-1]).endswith(f"## Last result{situation}\n\nUser: Warm it")
        assert goal.split() == ["##", "What", "the", "driver", "said", "Warm", "it"]


@pytest.mark.slow
def test_outside_its_time_is_the_plans_and_its_figures_are_kept(serve: Serve, observation: Seen) -> None:
    remote = serve(lambda agent, message, turn: slow(agent, message, turn) if turn else [calls(FAN)])
    remote.metadata = {"turn_metrics": METRICS}
    seen = observation("x")
    with closing(ForkServer()) as fork_server:
        name = PREFIX + remote.address
        with closing(OutsideAgent(fork_server, name, settings=replace(SETTINGS, answer_s=1.5), step_s=30)) as agent:
            agent.reset("x")
            assert agent.act(seen).function == "set_hvac_fan_speed"
            assert [stage.reply.tokens_in for stage in agent.stages if stage.reply] == [70]
            assert agent.stages[0].name is StageName.PERCEIVE
            with pytest.raises(AgentError, match="gave no answer within"):
                agent.act(seen)
        with closing(OutsideAgent(fork_server, "a2a:http://127.0.0.1:9", settings=SETTINGS)) as agent:
            agent.reset("x")
            with pytest.raises(AgentError, match="no card"):
                agent.act(seen)


def test_an_episode_is_won_and_nothing_tells_the_task(serve: Serve, simulations: Simulations) -> None:
    remote = serve(answering([calls(FAN)], [calls(DONE)], ["Done."]))
    agent = make_agent(PREFIX + remote.address, settings=SETTINGS)
    setup = EpisodeSetup("hvac_fan_max", scenario="grid", agent=agent.name, model="none", conditions=CALLS)
    result = run_trial(setup, agent, simulations=simulations)
    assert result.success
    task: Task = CATALOGUE["hvac_fan_max"]
    heard = json.dumps(remote.messages).lower()
    for word in (task.id, "verdict", "success", "oracle", "trace_sha256"):
        assert word not in heard.replace("successful", "")
