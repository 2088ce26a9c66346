"""The agent that calls functions: what is offered, what is told, several calls in an answer, and bad answers."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import pytest

from automotive_cosim.agents import AgentSettings, Caller, StageName, make_agent
from automotive_cosim.agents.caller import MOST_CALLS, tools
from automotive_cosim.contracts import ActionType, Feedback, FeedbackCode, Observation
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import ActionError, UserError
from automotive_cosim.models import ChatMessage, ModelReply
from automotive_cosim.models.apis import ChatTools

FAN = {"name": "set_hvac_fan_speed", "arguments": {"percent": 100}}
DONE = {"name": "status", "arguments": {"goal_status": "complete"}}
CALLS = Conditions.named({"interface": "functions", "see": "nothing"})


class Scripted:
    """A model that gives these answers and keeps what it was asked."""

    name, sees_pictures = "scripted", False

    def __init__(self, *answers: object) -> None:
        self._answers = list(answers)
        self.asked: list[Sequence[ChatMessage]] = []

    def chat(self, messages: Sequence[ChatMessage]) -> ModelReply:
        self.asked.append(tuple(messages))
        answer = self._answers.pop(0)
        return ModelReply(answer if isinstance(answer, str) else json.dumps({"say": "", "calls": answer}), 10, 5)


Seen = Callable[..., Observation]


def seen(observation: Seen, code: FeedbackCode = FeedbackCode.NONE, text: str = "") -> Observation:
    return replace(observation("Fan to the maximum"), feedback=Feedback(code, text))


def test_each_call_is_a_step_and_its_result_goes_back_to_the_model(observation: Seen) -> None:
    model = Scripted([FAN, {"name": "get_signals", "arguments": {"path": "hvac"}}], [DONE])
    agent = Caller(model, AgentSettings(CALLS))
    agent.reset("Fan to the maximum")
    first = agent.act(seen(observation))
    assert (first.function, first.arguments) == ("set_hvac_fan_speed", {"percent": 100.0})
    assert agent.act(seen(observation, FeedbackCode.OK, "done")).function == "get_signals"
    assert agent.act(seen(observation, FeedbackCode.OK, "{}")).action_type is ActionType.STATUS
    assert [stage.name for stage in agent.stages] == [StageName.PERCEIVE, StageName.INTERPRET, StageName.ACT]
    system, told, *results, now = model.asked[1]
    assert (system.role, now.role) == ("system", "user")
    assert [call.name for call in told.calls] == ["set_hvac_fan_speed", "get_signals"]
    assert [(each.role, each.text) for each in results] == [("tool", "ok: done"), ("tool", "ok: {}")]
    assert [each.call_id for each in results] == [call.id for call in told.calls]
    assert "Fan to the maximum" in now.text


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        ([], "calls no function"),
        ("I would rather talk.", "calls no function"),
        ([{"name": "set_fan", "arguments": {}}], "no function 'set_fan'"),
        ([{"name": "click", "arguments": {"x": 1, "y": 1}}], "no function 'click'"),
        ([{"name": "set_hvac_fan_speed", "arguments": {"percent": 400}}], "goes from 0 to 100"),
        ([{"name": "set_hvac_fan_speed", "arguments": "{"}], "not JSON"),
        ([FAN] * (MOST_CALLS + 1), "at most 10"),
    ],
)
def test_a_bad_answer_is_one_failed_step(observation: Seen, answer: Any, why: str) -> None:
    agent = Caller(Scripted(answer, [DONE]), AgentSettings(CALLS))
    agent.reset("x")
    with pytest.raises(ActionError, match=why):
        agent.act(seen(observation))
    assert agent.act(seen(observation, FeedbackCode.MALFORMED, why)).action_type is ActionType.STATUS


def test_a_call_that_is_written_in_the_words_is_a_call(observation: Seen) -> None:
    agent = Caller(Scripted(f"Gladly. <tool_call>{json.dumps(FAN)}</tool_call>"), AgentSettings(CALLS))
    agent.reset("x")
    assert agent.act(seen(observation)).function == "set_hvac_fan_speed"


def test_the_interface_and_the_place_say_what_is_offered_and_told(observation: Seen) -> None:
    def names(**words: str) -> set[str]:
        return {each.name for each in tools(AgentSettings(Conditions.named(words)))}

    assert "click" in names()
    assert "set_hvac_fan_speed" not in names()
    assert {"click", "set_hvac_fan_speed"} <= names(interface="both")
    assert "click" not in names(interface="functions")
    assert "query" not in names(interface="functions", geo="none")
    for see, geo, is_listed, is_placed in (("tree", "full", True, True), ("nothing", "none", False, False)):
        under = Conditions.named({"interface": "functions", "see": see, "geo": geo})
        model = Scripted([DONE])
        agent = Caller(model, AgentSettings(under))
        agent.reset("x")
        agent.act(seen(observation))
        text = model.asked[0][-1].text
        assert ("## The screen" in text, "## What applies here" in text) == (is_listed, is_placed)


def test_agents_of_the_screen_are_refused_by_name_without_it() -> None:
    for name in ("human", "native"):
        with pytest.raises(UserError, match="works on the screen"):
            make_agent(name, settings=AgentSettings(CALLS))
    assert make_agent("caller", settings=AgentSettings(CALLS)).channels


def test_the_protocol_carries_functions_calls_and_results(observation: Seen) -> None:
    api = ChatTools(tools=({"name": "honk", "description": "Sound the horn.", "parameters": {"type": "object"}},))
    model = Scripted([FAN], [DONE])
    agent = Caller(model, AgentSettings(CALLS))
    agent.reset("x")
    agent.act(seen(observation))
    agent.act(seen(observation, FeedbackCode.OK, "done"))
    body = api.body("m", model.asked[1], {"max_tokens": 9})
    assert body["tools"] == [{"type": "function", "function": dict(api.tools[0])}]
    assert [message["role"] for message in body["messages"]] == ["system", "assistant", "tool", "user"]
    called = body["messages"][1]["tool_calls"][0]
    assert json.loads(called["function"]["arguments"]) == {"percent": 100}
    assert body["messages"][2]["tool_call_id"] == called["id"]
    function = {"name": "honk", "arguments": "{}"}
    message = {"content": None, "tool_calls": [{"id": "1", "type": "function", "function": function}]}
    reply = api.read({"choices": [{"message": message, "finish_reason": "tool_calls"}]})
    assert json.loads(reply.text) == {"say": "", "calls": [{"name": "honk", "arguments": {}}]}
