"""The agent that calls functions: what is offered, what is told, several calls in an answer, and bad answers."""

import json
import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.agents import AgentSettings, Caller, StageName, make_agent
from automotive_cosim.agents.caller import MOST_CALLS, tools
from automotive_cosim.agents.written import written
from automotive_cosim.contracts import ActionType, Feedback, FeedbackCode, Observation
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import ActionError, UserError
from automotive_cosim.interface.functions import CAR, functions
from automotive_cosim.models import ChatMessage, ModelReply
from automotive_cosim.models.apis import ChatTools

FAN = {"name": "set_hvac_fan_speed", "arguments": {"percent": 100}}
DONE = {"name": "status", "arguments": {"goal_status": "complete"}}
CALLS = Conditions.named({"interface": "functions", "see": "nothing"})


class Scripted:
    """A model that gives these answers and keeps what it was asked."""

    name, sees_pictures = "scripted", False

    def __init__(self, *answers: object) -> None:
        self.left = list(answers)
        self.asked: list[Sequence[ChatMessage]] = []

    def chat(self, messages: Sequence[ChatMessage]) -> ModelReply:
        self.asked.append(tuple(messages))
        answer = self.left.pop(0)
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
    _, wish, told, *results = model.asked[1]
    assert wish.text == model.asked[0][1].text
    assert [call.name for call in told.calls] == ["set_hvac_fan_speed", "get_signals"]
    assert results[0].text == "ok: done"
    assert results[1].text.startswith("ok: {}\n\n## What the driver said\nFan to the maximum")
    assert len(results) == 2
    assert "## Last result" not in results[1].text


WORDS = "I would rather talk."
LOST = "<think>Perhaps <tool_call>{"
EPISODES = {
    "words in between": [WORDS, [FAN], WORDS, WORDS, [FAN, DONE], [DONE]],
    "several calls": [[FAN] * 10, [FAN] * 3, [DONE]],
    "bad calls": [[{"name": "set fan!", "arguments": "{"}], [{"name": "", "arguments": []}], [FAN], [DONE]],
    "too many": [[FAN] * 11, [FAN], [FAN] * 11, [DONE]],
    "within its thoughts": [LOST, [FAN], LOST, [DONE]],
    "a long watch": [[FAN, FAN]] * 30,
}


@pytest.mark.parametrize("name", EPISODES)
@pytest.mark.parametrize("see", ["nothing", "both"])
def test_the_order_of_turns_is_one_that_every_server_takes(observation: Seen, name: str, see: str) -> None:
    """A user's turn before the first call, none after a result, each call with its result at once, and names and
    arguments that can be sent back; the situation last, the picture in the only turn that may have one."""
    model = Scripted(*EPISODES[name])
    model.sees_pictures = True
    conditions = Conditions.named({"interface": "functions", "see": see})
    agent, api = Caller(model, AgentSettings(conditions)), ChatTools()
    agent.reset("x")
    picture = np.zeros((2, 2, 3), np.uint8) if see == "both" else None
    now = replace(seen(observation), on_watch=name == "a long watch", screenshot=picture)
    while model.left:
        with suppress(ActionError):
            agent.act(now)
    for asked in model.asked:
        told = api.body("m", asked, {})["messages"]
        assert [each["role"] for each in told[:2]] == ["system", "user"]
        assert {each["role"] for each in told[2:]} <= {"assistant", "tool"}
        for at, turn in enumerate(told[2:], 3):
            calls = turn.get("tool_calls")
            if calls:
                results = told[at : at + len(calls)]
                assert [each.get("tool_call_id") for each in results] == [each["id"] for each in calls]
                for call in calls:
                    assert re.fullmatch(r"[A-Za-z0-9]{9}", call["id"])  # Mistral takes no other
                    assert re.fullmatch(r"[\w-]{1,64}", call["function"]["name"])
                    assert isinstance(json.loads(call["function"]["arguments"]), dict)
            else:
                assert turn["role"] == "tool"
                assert isinstance(turn["content"], str)
                assert ("## What the driver said" in turn["content"]) == (at == len(told))
        pictured = [each["role"] for each in told if isinstance(each["content"], list)]
        assert pictured == (["user"] if see == "both" else [])


def test_what_a_server_wants_back_it_gets_back(observation: Seen) -> None:
    api = ChatTools()
    signature = {"extra_content": {"google": {"thought_signature": "abc"}}}
    call = {"id": "1", "type": "function", "function": {"name": FAN["name"], "arguments": "{}"}, **signature}
    message = {"content": None, "reasoning_content": "Hm.", "tool_calls": [call]}
    model = Scripted(api.read({"choices": [{"message": message}]}).text, [DONE])
    agent = Caller(model, AgentSettings(CALLS))
    agent.reset("x")
    with suppress(ActionError):
        agent.act(seen(observation))
    agent.act(seen(observation))
    turn = api.body("m", model.asked[1], {})["messages"][2]
    assert turn["reasoning_content"] == "Hm."
    assert turn["tool_calls"][0]["extra_content"] == signature["extra_content"]


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        ([], "calls no function"),
        ("I would rather talk.", "calls no function"),
        (f"<think>Perhaps <tool_call>{json.dumps(FAN)}</tool_call>, but", "within its thoughts"),
        (f"[THINK]{json.dumps(FAN)}[/THINK]", "within its thoughts"),
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


ONE = json.dumps(FAN)
NAME = FAN["name"]
JSON_100 = '{"percent": 100}'
TAGGED = f"<function={NAME}>\n<parameter=percent>\n100\n</parameter>\n</function>"
INVOKED = f'<invoke name="{NAME}">\n<parameter name="percent">100</parameter>\n</invoke>'
WRITTEN = {
    "hermes": f"<tool_call>\n{ONE}\n</tool_call>",
    "hermes, its end eaten": f"Gladly.\n<tool_call>{ONE}",
    "qwen3-coder": f"I set it.\n\n<tool_call>\n{TAGGED}\n</tool_call>",
    "qwen3-coder, its beginning eaten": f"{TAGGED}\n</tool_call>",
    "qwen3-coder, a tag left out": f"<tool_call>{TAGGED.replace('</parameter>', '')}</tool_call>",
    "qwen-agent": f"\u273fFUNCTION\u273f: {NAME}\n\u273fARGS\u273f: {JSON_100}",
    "react": f"Thought: the fan.\nAction: {NAME}\nAction Input: {JSON_100}",
    "grok": INVOKED.replace("invoke", "xai:function_call").replace("parameter", "xai:parameter"),
    "as python in hermes's tags": f"<tool_call>\n{NAME}(percent=100)\n</tool_call>",
    "qwen2.5-coder": f"```json\n{ONE}\n```",
    "qwen2.5-coder, tools": f"<tools>{ONE}</tools>",
    "seed-oss": f"<seed:tool_call>{TAGGED}</seed:tool_call>",
    "llama 3.1": f'{{"name": "{NAME}", "parameters": {JSON_100}}}',
    "llama 3.1, built in": f'<|python_tag|>{{"name": "{NAME}", "parameters": {JSON_100}}}',
    "llama 3.1, own": f"<function={NAME}>{JSON_100}</function>",
    "llama 3.2": f"[{NAME}(percent=100)]",
    "llama 4": f"<|python_start|>[{NAME}(percent=100)]<|python_end|>",
    "mistral v3": f"[TOOL_CALLS] [{ONE}]",
    "mistral v11": f"[TOOL_CALLS]{NAME}[CALL_ID]abc123def[ARGS]{JSON_100}",
    "mistral v13": f"[TOOL_CALLS]{NAME}[ARGS]{JSON_100}",
    "mistral, its token eaten": f"{NAME}[ARGS]{JSON_100}",
    "deepseek v3": f"<\uff5ctool\u2581calls\u2581begin\uff5c><\uff5ctool\u2581call\u2581begin\uff5c>function"
    f"<\uff5ctool\u2581sep\uff5c>{NAME}\n```json\n{JSON_100}\n```<\uff5ctool\u2581call\u2581end\uff5c>",
    "deepseek v3.1": f"<\uff5ctool\u2581call\u2581begin\uff5c>{NAME}<\uff5ctool\u2581sep\uff5c>{JSON_100}"
    "<\uff5ctool\u2581call\u2581end\uff5c>",
    "deepseek v3.2": re.sub("</?(?=invoke|param)", lambda tag: f"{tag[0]}\uff5cDSML\uff5c", INVOKED),
    "kimi k2": f"<|tool_call_begin|>functions.{NAME}:0<|tool_call_argument_begin|>{JSON_100}<|tool_call_end|>",
    "glm 4.5": f"<tool_call>{NAME}\n<arg_key>percent</arg_key>\n<arg_value>100</arg_value>\n</tool_call>",
    "longcat": f"<longcat_tool_call>functions.{NAME}\n<longcat_arg_key>percent</longcat_arg_key>\n"
    "<longcat_arg_value>100</longcat_arg_value>\n</longcat_tool_call>",
    "hunyuan 3": f"<tool_calls>\n<tool_call>{NAME}<tool_sep>\n<arg_key>percent</arg_key>\n"
    "<arg_value>100</arg_value>\n</tool_call>\n</tool_calls>",
    "hunyuan 4": f"<tool_call:6124c78e>{NAME}<arg_key:6124c78e>percent</arg_key:6124c78e>"
    "<arg_value:6124c78e>100</arg_value:6124c78e></tool_call:6124c78e>",
    "minicpm 5": f'<function name="{NAME}"><param name="percent"><![CDATA[100]]></param></function>',
    "deepseek, in ascii": re.sub("</?(?=invoke|param)", lambda tag: f"{tag[0]}|DSML|", INVOKED),
    "gpt-oss": f"<|channel|>analysis<|message|>Hm.<|end|><|start|>assistant<|channel|>commentary "
    f"to=functions.{NAME} <|constrain|>json<|message|>{JSON_100}<|call|>",
    "gpt-oss, by role": f"<|start|>assistant to=functions.{NAME}<|channel|>commentary json<|message|>{JSON_100}",
    "gpt-oss, as code": f"<|channel|>commentary to=functions.{NAME} code<|message|>{JSON_100}<|call|>",
    "minimax m2": f"<minimax:tool_call>{INVOKED}</minimax:tool_call>",
    "functiongemma": f"<start_function_call>call:{NAME}{{percent:100}}<end_function_call>",
    "gemma 4": f"<|tool_call>call:{NAME}{{percent:100}}<tool_call|>",
    "gemini": f"```tool_code\nprint(default_api.{NAME}(percent=100))\n```",
    "granite": f"<|tool_call|>[{ONE}]",
    "nemotron": f"<TOOLCALL>[{ONE}]</TOOLCALL>",
    "cohere": f'<|START_ACTION|>[{{"tool_name": "{NAME}", "parameters": {JSON_100}}}]<|END_ACTION|>',
    "apertus": f'<|tools_prefix|>[{{"{NAME}": {JSON_100}}}]<|tools_suffix|>',
    "hunyuan": f"<tool_calls>[{ONE}]</tool_calls>",
    "lfm2": f"<|tool_call_start|>[{NAME}(percent=100)]<|tool_call_end|>",
    "olmo 3": f"<function_calls>\n{NAME}(percent=100)\n</function_calls>",
    "step 3": f'<steptml:invoke name="{NAME}"><steptml:parameter name="percent">100</steptml:parameter>'
    "</steptml:invoke>",
    "phi 4": f"functools[{ONE}]",
    "xlam": f"[{ONE}]",
    "openai's frame": f'{{"type": "function", "function": {ONE}}}',
}
"""A call in the words, by the family whose template writes it so."""


@pytest.mark.parametrize("family", WRITTEN)
def test_a_call_that_a_server_leaves_in_the_words_is_a_call(observation: Seen, family: str) -> None:
    agent = Caller(Scripted(f"<think>{ONE}</think>{WRITTEN[family]}"), AgentSettings(CALLS))
    agent.reset("x")
    act = agent.act(seen(observation))
    assert (act.function, act.arguments) == (NAME, {"percent": 100.0})
    assert not agent._left


@pytest.mark.parametrize("family", ["hermes", "qwen3-coder", "llama 3.1, built in", "mistral v13", "kimi k2"])
def test_several_calls_in_the_words_keep_their_order(family: str) -> None:
    text = WRITTEN[family]
    both = f"{text}\n{text.replace('100', '50')}"
    schemas = {NAME: functions()[NAME].parameters}
    assert [given for _, given in written(both, schemas)] == [{"percent": 100}, {"percent": 50}]


@pytest.mark.parametrize(
    "text",
    [
        f"I could call {NAME}(percent=100), but it is loud.",
        f"One way is {ONE}, another to open the window.",
        f"```json\n{ONE}\n```\nwould be wrong here.",
        f"<function={NAME}>\n<parameter=percent>\n10",
        "[1, 2]",
        '{"percent": 100}',
        f"<tool_response>{ONE}</tool_response>",
        f"[{NAME}(percent=__import__('os').getpid())]",
    ],
)
def test_a_call_that_is_only_spoken_of_or_cut_off_is_none(text: str) -> None:
    assert written(text, {NAME: functions()[NAME].parameters}) == []


@given(st.text() | st.sampled_from(sorted(WRITTEN.values())).flatmap(lambda text: st.just(text[: len(text) // 2])))
def test_nothing_breaks_the_reader_of_calls(text: str) -> None:
    for each in (text, f"<tool_call>{text}", f"[TOOL_CALLS]{text}", f"<function=a>{text}</function>"):
        assert isinstance(written(each, {}), list)


def test_the_interface_and_the_place_say_what_is_offered_and_told(observation: Seen) -> None:
    def names(**words: str) -> set[str]:
        return {each.name for each in tools(AgentSettings(Conditions.named(words)))}

    assert "click" in names()
    assert CAR not in names()
    assert {"click", CAR} <= names(interface="both")
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
    called = body["messages"][2]["tool_calls"][0]
    assert json.loads(called["function"]["arguments"]) == {"percent": 100}
    assert body["messages"][3]["tool_call_id"] == called["id"]
    function = {"name": "honk", "arguments": "{}"}
    message = {"content": None, "tool_calls": [{"id": "1", "type": "function", "function": function}]}
    reply = api.read({"choices": [{"message": message, "finish_reason": "tool_calls"}]})
    assert json.loads(reply.text) == {"say": "", "calls": [{"name": "honk", "arguments": {}}]}
