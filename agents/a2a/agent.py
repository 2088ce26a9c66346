"""An agent behind an address, on this project's tasks and drives, asked in A2A messages as CAR-bench does."""

from __future__ import annotations

import json
import math
import time
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from automotive_cosim.agents import prompt
from automotive_cosim.agents.base import Stage, StageName
from automotive_cosim.agents.registry import PREFIX
from automotive_cosim.agents.settings import AgentProfile, AgentSettings
from automotive_cosim.agents.thoughts import spoken
from automotive_cosim.cockpit.actions import TEXT_LIMIT
from automotive_cosim.contracts import UNCALLED, Action, ActionType, Json, Observation
from automotive_cosim.errors import ActionError, AgentError, OutOfBudgetError, SetupError, install_hint
from automotive_cosim.formats.words import shown
from automotive_cosim.interface.functions import Function, action_of, as_openai, offered
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.models.base import ModelReply, ToolCall, believed

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
        tools: what the agent can call."""
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


if TYPE_CHECKING:
    from automotive_cosim.agents.a2a.client import AgentLine

MOST_CALLS = 10
"""Most calls of one answer; each is a step."""
CLOSING_S = 30.0
"""Longest wait for an agent's last words, with which it reports its metrics."""
NOT_DONE = "not done"
SPOKEN = (
    "Words without a call are put to the driver as a question, of 120 characters at most, and distract; say only "
    "what has to be asked"
)
"""What the agent is told of its words."""
CHANNELS = ALL - {Channel.SCREENSHOT}
"""The contract has no pictures."""


class A2AAgent:
    """Sends each answer's results and the situation then to the agent, in one context for each episode.

    Words without a call are spoken to the driver (``ask_driver``), as the contract has it. Before the agent's
    declaration takes effect, it is sent its result like that of any call: agents report their metrics with their
    last words."""

    def __init__(self, name: str, settings: AgentSettings) -> None:
        """Reads the agent's card.

        Args:
            name: ``a2a:http://HOST:PORT``.
            settings: the conditions, the budget, and the time for an answer.

        Raises:
            UserError: the name has no address.
            SetupError: no such agent answers there, or ``a2a-sdk`` is missing."""
        self.name = name
        self.model = "none"
        self._settings = settings
        self._profile = AgentProfile("a2a", CHANNELS, frozenset(UNCALLED), reflects=False).under(settings)
        tools = offered(settings.conditions.interface, settings.conditions.geo)
        self._tools = {function.name: function for function in tools}
        self._line = _line(name.removeprefix(PREFIX))
        self.stages: list[Stage] = []
        self.reset("")

    @property
    def channels(self) -> frozenset[Channel]:
        """All channels but the picture."""
        return CHANNELS

    def reset(self, goal: str) -> None:
        self._line.begin()
        self._reader = AnswerReader(self._tools)
        self._is_new, self._heard = True, 0
        self._asked: tuple[ToolCall, ...] = ()
        self._results: dict[str, str] = {}
        self._left: deque[ToolCall] = deque()
        self._waiting: ToolCall | None = None
        self._tokens = 0
        self._seconds = self._unreported_s = 0.0
        self._is_reported = True
        self.stages.clear()

    def act(self, observation: Observation) -> Action:
        """The next call of the last answer, or the first of another one.

        Raises:
            ActionError: the answer has neither words nor a call, or one that does not fit its function.
            OutOfBudgetError: the episode's tokens or seconds are spent.
            AgentError: the agent does not answer, or not in its protocol."""
        self.stages.clear()
        began_s = time.monotonic()
        if self._waiting is not None:
            self._results[self._waiting.id] = prompt.result(observation)
            self._waiting = None
        if not self._left:
            words = self._ask(observation)
            if words is not None:
                return words
        call = self._waiting = self._left.popleft()
        try:
            if call.name not in self._tools:
                raise ActionError(f"there is no function {shown(call.name)} here; call one of those offered")
            action = action_of(call.name, call.arguments)
        except ActionError as error:
            self._note(StageName.ACT, observation, str(error))
            raise
        self._note(StageName.ACT, observation, prompt.action_words(action, observation))
        if action.action_type is ActionType.STATUS and not observation.on_watch:
            self._close(observation, (self._settings.answer_s - (time.monotonic() - began_s)) / 2)
        return action

    def _ask(self, seen: Observation) -> Action | None:
        """Asks for the next answer; returns what its words alone do."""
        now = self._situation(seen, is_resulting=self._is_new or not self._asked)
        self._note(StageName.PERCEIVE, seen, now)
        sounds = list(seen.sounds[0 if self._is_new else self._heard + 1 :])  # the wish is the first
        if self._is_new:
            system = f"{self._told(seen)}\n\n{self._situation(seen, is_spoken=False)}"
            opened = opening(system, prompt.driver_words(seen), self._tools.values())
            answer = self._say(seen, [*opened, *sounds], USER)
        elif self._asked:
            contents = [self._results.get(call.id, NOT_DONE) for call in self._asked]
            contents[-1] += f"\n\n{now}"
            answer = self._say(seen, [*results(self._asked, contents), *sounds], ENVIRONMENT)
        else:
            words = "\n".join(seen.said[self._heard :])
            answer = self._say(seen, [f"{words}\n\n{now}".strip(), *sounds], USER)
        self._is_new, self._heard = False, len(seen.said)
        self._asked, self._results = answer.calls, {}
        if len(answer.calls) > MOST_CALLS:
            wrong = f"the answer has {len(answer.calls)} calls; at most {MOST_CALLS} are allowed"
        elif answer.calls:
            self._left.extend(answer.calls)
            return None
        else:
            try:
                words = " ".join(spoken(answer.say).split())[:TEXT_LIMIT]
                wrong = "the answer has neither words nor a call"
            except ActionError as error:
                words, wrong = "", str(error)
            if words:
                action = Action(ActionType.ASK_DRIVER, text=words)
                self._note(StageName.ACT, seen, prompt.action_words(action, seen))
                return action
        self._note(StageName.ACT, seen, wrong)
        raise ActionError(wrong)

    def _say(self, seen: Observation, parts: list[object], source: str, limit_s: float = 0.0) -> RemoteAnswer:
        settings = self._settings
        if self._tokens >= settings.most_tokens or self._seconds >= settings.most_seconds:
            raise OutOfBudgetError(
                f"the episode's budget is spent: {self._tokens} of {settings.most_tokens} tokens, "
                f"{self._seconds:.0f} of {settings.most_seconds:g} s"
            )
        began_s = time.monotonic()
        said = self._line.say(parts, source, limit_s or settings.answer_s)
        took_s = time.monotonic() - began_s
        try:
            answer = self._reader.read(said.parts, said.metadata)
        except (ValueError, RecursionError) as error:
            raise AgentError(f"the agent {self.name} gave no answer of CAR-bench's contract: {error}") from error
        self._is_reported = answer.metrics is not None
        metrics = answer.metrics or Metrics()
        self._seconds += took_s
        self._unreported_s += took_s
        told = ModelReply(
            answer.say,
            metrics.tokens_in,
            metrics.tokens_out,
            metrics.cost_usd,
            round(took_s, 3),
            reasoning=answer.reasoning,
            tokens_reasoning=metrics.tokens_reasoning,
        )
        reply = believed(told, self._unreported_s)
        if self._is_reported:
            self._unreported_s = 0.0
        self._tokens += reply.tokens_in + reply.tokens_out
        called = "\n".join(f"{call.name} {call.arguments}" for call in answer.calls)
        self._note(StageName.INTERPRET, seen, "\n".join(filter(None, (answer.say, called))), reply)
        return answer

    def _close(self, seen: Observation, limit_s: float) -> None:
        """Lets the agent have its last words, for its metrics. What it says is heard by nobody, and how it takes
        the end changes nothing: it has declared."""
        if self._is_reported or limit_s <= 0:
            return
        contents = [self._results.get(call.id, NOT_DONE) for call in self._asked]
        contents[-1] = "ok"
        try:
            self._say(seen, results(self._asked, contents), ENVIRONMENT, min(limit_s, CLOSING_S))
        except (AgentError, OutOfBudgetError) as error:
            self._note(StageName.REFLECT, seen, str(error))

    def _situation(self, seen: Observation, *, is_spoken: bool = True, is_resulting: bool = True) -> str:
        return prompt.situation(self._profile, seen, pictures=False, is_spoken=is_spoken, is_resulting=is_resulting)

    def _told(self, seen: Observation) -> str:
        weigh = prompt.PLACE_COUNTS if Channel.CONTEXT in self._profile.channels else ""
        name = "caller_watch" if seen.on_watch else "caller"
        return prompt.fill(name, {"weigh": weigh, "words": SPOKEN, "policy": seen.policy})

    def _note(self, name: StageName, seen: Observation, text: str, reply: ModelReply | None = None) -> None:
        self.stages.append(Stage(name, text, seen.time_s, reply))


def _line(address: str) -> AgentLine:
    try:
        from automotive_cosim.agents.a2a.client import AgentLine
    except ImportError as error:
        if (error.name or "").partition(".")[0] not in ("a2a", "httpx", "google"):
            raise
        raise SetupError(f"the a2a-sdk package is missing; install it with `{install_hint('doors')}`") from error
    return AgentLine(address)
