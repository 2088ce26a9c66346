"""What is said to an agent behind an address and by it, as parts of A2A messages, in CAR-bench's contract."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from automotive_cosim.contracts import Json
from automotive_cosim.interface.functions import Function, as_openai
from automotive_cosim.models.base import ToolCall

USER, ENVIRONMENT = "user", "environment"
"""Whose words a message has, as its metadata says under ``source``."""
LARGEST_FIGURE = 10**9
"""Of a reported metric; more is nonsense."""


@dataclass(frozen=True, slots=True)
class Metrics:
    """What an agent reports of its model, for all answers since it last did."""

    tokens_in: int = 0
    tokens_out: int = 0
    """Those of its reasoning included."""
    tokens_reasoning: int = 0
    cost_usd: float = 0.0


@dataclass(frozen=True, slots=True)
class RemoteAnswer:
    """What an agent answers: words to the driver, calls, or both."""

    say: str = ""
    calls: tuple[ToolCall, ...] = ()
    reasoning: str = ""
    metrics: Metrics | None = None
    """None if it reports none with this answer."""


def opening(system: str, words: str, tools: Iterable[Function]) -> list[Any]:
    """The parts of the first message; a string is text, an object data.

    Args:
        words: what the driver says, and nothing else: some agents go by its words.
        tools: what the agent can call.
    """
    return [f"System: {system}\n\nUser: {words}", {"tools": [as_openai(each) for each in tools]}]


def results(calls: Sequence[ToolCall], contents: Sequence[str]) -> list[Any]:
    """The part that has the results of calls, in their order."""
    told = [
        {"tool_name": call.name, "tool_call_id": call.id, "content": content}
        for call, content in zip(calls, contents, strict=True)
    ]
    return [{"tool_results": told}]


@dataclass(slots=True)
class AnswerReader:
    """Reads answers; knows the functions, whose schemas say which numbers are whole."""

    tools: Mapping[str, Function]
    _count: int = field(default=0)

    def read(self, parts: Sequence[Any], metadata: Json) -> RemoteAnswer:
        """An answer from its parts: strings are text, all else is data.

        Raises ValueError: a part is not as the contract has it."""
        say: list[str] = []
        reasoning: list[str] = []
        calls: list[ToolCall] = []
        for part in map(_whole_characters, parts):
            if isinstance(part, str):
                say.append(part)
            elif isinstance(part, dict):
                told = part.get("tool_calls", part.get("toolCalls", []))
                if not isinstance(told, list) or not all(isinstance(each, dict) for each in told):
                    raise ValueError("tool_calls is not a list of objects")
                calls += map(self._call, told)
                thought = part.get("reasoning_content", part.get("reasoningContent", ""))
                reasoning += [thought] if isinstance(thought, str) else []
        reported = metadata.get("turn_metrics", metadata.get("turnMetrics"))
        metrics = _metrics(reported) if isinstance(reported, dict) else None
        return RemoteAnswer("\n".join(say).strip(), tuple(calls), "\n".join(reasoning), metrics)

    def _call(self, told: Json) -> ToolCall:
        name = str(told.get("tool_name", told.get("toolName", "")))
        arguments = told.get("arguments") or {}
        if isinstance(arguments, dict) and name in self.tools:
            arguments = _whole_numbers(arguments, self.tools[name].parameters)
        self._count += 1
        return ToolCall(f"call{self._count:05d}", name, arguments)


def _metrics(told: Json) -> Metrics:
    def figure(name: str, other: str) -> float:
        value = told.get(name, told.get(other))
        if not isinstance(value, int | float) or isinstance(value, bool) or not math.isfinite(value):
            return 0.0
        return float(value) if 0 <= value <= LARGEST_FIGURE else 0.0

    thinking = int(figure("thinking_tokens", "thinkingTokens"))
    return Metrics(
        int(figure("prompt_tokens", "promptTokens")),
        int(figure("completion_tokens", "completionTokens")) + thinking,
        thinking,
        figure("cost", "cost"),
    )


def _whole_numbers(value: Any, schema: Any) -> Any:
    """The value with whole numbers where its schema has them; JSON in A2A knows only floats."""
    if not isinstance(schema, dict):
        return value
    if isinstance(value, dict):
        properties = schema.get("properties", {})
        return {name: _whole_numbers(entry, properties.get(name)) for name, entry in value.items()}
    if isinstance(value, list):
        return [_whole_numbers(entry, schema.get("items")) for entry in value]
    is_whole = isinstance(value, float) and value.is_integer()
    return int(value) if is_whole and schema.get("type") == "integer" else value


def _whole_characters(value: Any) -> Any:
    """The value without half surrogate pairs, which no file can hold."""
    return json.loads(json.dumps(value, ensure_ascii=False).encode("utf-8", "replace"))
