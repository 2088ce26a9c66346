"""The APIs of providers: for each provider's protocol, the request and how its answer is read.

``chat``        OpenAI's chat completions, which most servers speak; also with functions
``openai``      OpenAI's responses with its tool ``computer``
``anthropic``   Anthropic's messages with its toolset or its earlier tools for a computer
``gemini``      Gemini's ``generateContent`` with its tool ``computer_use``

The last three answer with calls. Their text is a JSON object, ``{"say": text, "calls": [{"name", "arguments"}]}``,
so that they are recorded and replayed as any other answer.
"""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

from automotive_cosim.contracts import Json
from automotive_cosim.errors import ModelError
from automotive_cosim.models.base import ChatMessage, ModelReply, ToolCall

MOST_TOKENS = 10**9
"""No question or answer has more."""


class ProviderApi(Protocol):
    """How to speak one provider's protocol."""

    def path(self, model: str) -> str:
        """The path of a request, after the base address."""
        ...

    def headers(self, key: str) -> Mapping[str, str]:
        """Its own headers; empty for a bearer's key."""
        ...

    def body(self, model: str, messages: Sequence[ChatMessage], limits: Json) -> Json:
        """The request.

        Args:
            model: the provider's name of the model.
            limits: ``seed``, ``temperature`` and ``max_tokens``, those that are set.
        """
        ...

    def read(self, told: Any) -> ModelReply:
        """Text, tokens and end of an answer.

        An answer in which the model says nothing, or a call that cannot be read, is an answer; ``finish`` holds the
        provider's reason. Counts of tokens that cannot be are 0, or the least that they can be.

        Raises:
            LookupError, TypeError, AttributeError, ValueError: not an answer of this protocol.
        """
        ...


@dataclass(frozen=True, slots=True)
class Chat:
    """OpenAI's chat completions."""

    longest: str = "max_tokens"
    """Name of the limit of an answer's tokens, which OpenAI itself has changed."""
    is_guided: bool = False
    """Whether the server is told the form of the answer and holds the model to it."""

    def path(self, model: str) -> str:
        return "/chat/completions"

    def headers(self, key: str) -> Mapping[str, str]:
        return {}

    def body(self, model: str, messages: Sequence[ChatMessage], limits: Json) -> Json:
        named = {self.longest if name == "max_tokens" else name: value for name, value in limits.items()}
        told = {"model": model, "messages": [self._message(message) for message in messages]} | named
        form = messages[-1].form if self.is_guided else None
        if form is not None:
            told["response_format"] = {"type": "json_schema", "json_schema": {"name": "answer", "schema": form}}
        return told

    def read(self, told: Any) -> ModelReply:
        choice = _first(told, "choices")
        message = choice.get("message") or {}
        usage = told.get("usage") or {}
        cached = _detail(usage, "prompt_tokens_details", "cached_tokens")
        tokens_in = _count(usage.get("prompt_tokens"))
        return ModelReply(
            _text(message.get("content"))
            or _text(message.get("refusal"))
            or _tool_calls(message.get("tool_calls")),
            tokens_in + cached if cached > tokens_in else tokens_in,  # some gateways leave the cached ones out
            _count(usage.get("completion_tokens")),
            finish=str(choice.get("finish_reason") or "stop"),
            reasoning=_text(message.get("reasoning_content") or message.get("reasoning"))
            or _text(message.get("content"), is_thought=True),
            tokens_reasoning=_detail(usage, "completion_tokens_details", "reasoning_tokens"),
            tokens_cached=cached,
        )

    def _message(self, message: ChatMessage) -> Json:
        if not message.pictures:
            return {"role": message.role, "content": message.text}
        parts: list[Json] = [{"type": "text", "text": message.text}]
        for each in message.pictures:
            if is_sound(each):
                parts.append({"type": "input_audio", "input_audio": {"data": _encoded(each), "format": "wav"}})
            else:
                parts.append({"type": "image_url", "image_url": {"url": _data_url(each)}})
        return {"role": message.role, "content": parts}


@dataclass(frozen=True, slots=True)
class ChatTools(Chat):
    """OpenAI's chat completions with functions; an answer's text is ``{"say": ..., "calls": [...]}``."""

    tools: tuple[Json, ...] = ()
    """Each with name, description and parameters."""

    def body(self, model: str, messages: Sequence[ChatMessage], limits: Json) -> Json:
        tools = [{"type": "function", "function": tool} for tool in self.tools]
        return Chat.body(self, model, messages, limits) | {"tools": tools}

    def read(self, told: Any) -> ModelReply:
        plain = Chat.read(self, told)
        message = _first(told, "choices").get("message") or {}
        calls = [
            {"name": str(each["name"]), "arguments": _loaded(each.get("arguments"))} | _back(each, CALL_BACK)
            for each in _named(message.get("tool_calls"))
        ]
        say = _text(message.get("content")) or _text(message.get("refusal"))
        text = {"say": say, "calls": calls} | (_back(message, TURN_BACK) if calls else {})
        return replace(plain, text=json.dumps(text, ensure_ascii=False))

    def _message(self, message: ChatMessage) -> Json:
        if message.call_id:
            return {"role": "tool", "tool_call_id": message.call_id, "content": message.text}
        told = Chat._message(self, message)
        if not message.calls:
            return told
        calls = [
            {"id": call.id, "type": "function", "function": _called(call), **(call.back or {})}
            for call in message.calls
        ]
        return told | {"content": message.text or None, "tool_calls": calls} | (message.back or {})


@dataclass(frozen=True, slots=True)
class OpenAI:
    """OpenAI's responses with its computer tool."""

    functions: tuple[Json, ...] = ()
    """Further functions, each with name, description and parameters."""

    def path(self, model: str) -> str:
        return "/responses"

    def headers(self, key: str) -> Mapping[str, str]:
        return {}

    def body(self, model: str, messages: Sequence[ChatMessage], limits: Json) -> Json:
        named = {"max_output_tokens" if name == "max_tokens" else name: value for name, value in limits.items()}
        named.pop("seed", None)  # which this protocol does not have
        asked = [
            {
                "role": message.role,
                "content": [
                    {"type": "input_text", "text": message.text},
                    *({"type": "input_image", "image_url": _data_url(each)} for each in message.pictures),
                ],
            }
            for message in messages
        ]
        tools = [{"type": "computer"}, *({"type": "function"} | function for function in self.functions)]
        return {"model": model, "input": asked, "tools": tools} | named

    def read(self, told: Any) -> ModelReply:
        say, calls, reasoning = "", list[Json](), ""
        _check(told)
        for item in _objects(told["output"]):
            match item.get("type"):
                case "reasoning":
                    reasoning += _text(item.get("summary")) or _text(item.get("content"), is_thought=True)
                case "message":
                    say += "".join(
                        str(part.get("text") or part.get("refusal") or "") for part in item.get("content") or ()
                    )
                case "computer_call":
                    for action in _objects(item.get("actions")) or [item.get("action") or {}]:
                        given = dict(action)
                        calls.append({"name": given.pop("type", ""), "arguments": given})
                case "function_call":
                    calls.append({"name": item.get("name", ""), "arguments": _loaded(item.get("arguments"))})
        usage = told.get("usage") or {}
        reason = (told.get("incomplete_details") or {}).get("reason") or "stop"
        cached = _detail(usage, "input_tokens_details", "cached_tokens")
        tokens_in = _count(usage.get("input_tokens"))
        found = _reply(say, calls, max(tokens_in, cached), usage.get("output_tokens"), reason)
        return replace(
            found,
            reasoning=reasoning,
            tokens_reasoning=_detail(usage, "output_tokens_details", "reasoning_tokens"),
            tokens_cached=cached,
        )


TOOLSET = "computer_toolset_20260801"
"""Its members are tools of their own, and it needs no size of the display."""
NO_MEMBERS = (
    "cursor_position", "hold_key", "left_mouse_down", "left_mouse_up", "middle_click", "mouse_move", "right_click",
    "zoom",
)  # fmt: skip
"""Those that a touch screen does not have."""


@dataclass(frozen=True, slots=True)
class Anthropic:
    """Anthropic's messages with its tools for a computer."""

    functions: tuple[Json, ...] = ()
    tool: str = TOOLSET
    beta: str = ""
    """The beta header that the earlier tools require."""

    def path(self, model: str) -> str:
        return "/messages"

    def headers(self, key: str) -> Mapping[str, str]:
        named = {"x-api-key": key, "anthropic-version": "2023-06-01"}
        return named | ({"anthropic-beta": self.beta} if self.beta else {})

    def body(self, model: str, messages: Sequence[ChatMessage], limits: Json) -> Json:
        asked = [
            {
                "role": message.role,
                "content": [
                    *(
                        {
                            "type": "image",
                            "source": {"type": "base64", "media_type": "image/png", "data": _base64(each)},
                        }
                        for each in message.pictures
                    ),
                    {"type": "text", "text": message.text},
                ],
            }
            for message in messages
        ]
        computer: Json = {"type": self.tool}
        if self.tool == TOOLSET:
            computer["configs"] = {member: {"enabled": False} for member in NO_MEMBERS}
        else:
            width, height = _size(messages)
            computer |= {"name": "computer", "display_width_px": width, "display_height_px": height}
        functions = [
            {"name": each["name"], "description": each["description"], "input_schema": each["parameters"]}
            for each in self.functions
        ]
        named = {name: value for name, value in limits.items() if name != "seed"}  # which it does not have
        return {"model": model, "messages": asked, "tools": [computer, *functions], "max_tokens": 1024} | named

    def read(self, told: Any) -> ModelReply:
        say, calls, reasoning = "", list[Json](), ""
        _check(told)
        for block in _objects(told["content"]):
            if block.get("type") == "text":
                say += str(block.get("text") or "")
            elif block.get("type") == "thinking":
                reasoning += str(block.get("thinking", ""))
            elif block.get("type") == "tool_use":
                loaded = _loaded(block.get("input"))
                given = dict(loaded) if isinstance(loaded, dict) else {}
                name = given.pop("action", "") if block.get("name") == "computer" else block.get("name", "")
                calls.append({"name": name, "arguments": given})
        usage = told.get("usage") or {}
        cached = _count(usage.get("cache_read_input_tokens"))  # which input_tokens leaves out
        tokens_in = _count(usage.get("input_tokens")) + cached + _count(usage.get("cache_creation_input_tokens"))
        found = _reply(say, calls, tokens_in, usage.get("output_tokens"), told.get("stop_reason"))
        return replace(found, reasoning=reasoning, tokens_cached=cached)


@dataclass(frozen=True, slots=True)
class Gemini:
    """Gemini's ``generateContent`` with its computer tool."""

    functions: tuple[Json, ...] = ()

    def path(self, model: str) -> str:
        return f"/models/{model}:generateContent"

    def headers(self, key: str) -> Mapping[str, str]:
        return {"x-goog-api-key": key}

    def body(self, model: str, messages: Sequence[ChatMessage], limits: Json) -> Json:
        asked = [
            {
                "role": "model" if message.role == "assistant" else "user",
                "parts": [
                    {"text": message.text},
                    *(
                        {
                            "inlineData": {
                                "mimeType": "audio/wav" if is_sound(each) else "image/png",
                                "data": _encoded(each),
                            }
                        }
                        for each in message.pictures
                    ),
                ],
            }
            for message in messages
        ]
        tools: list[Json] = [{"computerUse": {"environment": "ENVIRONMENT_BROWSER"}}]
        if self.functions:
            tools.append({"functionDeclarations": list(self.functions)})
        named = {"maxOutputTokens" if name == "max_tokens" else name: value for name, value in limits.items()}
        return {"contents": asked, "tools": tools, "generationConfig": named}

    def read(self, told: Any) -> ModelReply:
        blocked = (told.get("promptFeedback") or {}).get("blockReason")
        if "usageMetadata" in told:  # a list without entries is left out
            told = {"candidates": []} | told
        candidate = _first(told, "candidates") if not blocked else {"finishReason": blocked}
        say, calls, reasoning = "", list[Json](), ""
        for part in _objects((candidate.get("content") or {}).get("parts")):
            if "functionCall" in part:
                called = part["functionCall"] or {}
                calls.append({"name": called.get("name", ""), "arguments": dict(called.get("args") or {})})
            elif part.get("thought"):
                reasoning += str(part.get("text", ""))
            else:
                say += str(part.get("text", ""))
        usage = told.get("usageMetadata") or {}
        thoughts = _count(usage.get("thoughtsTokenCount"))  # which the candidates' count leaves out
        tokens_out = _count(usage.get("candidatesTokenCount")) + thoughts
        cached = _count(usage.get("cachedContentTokenCount"))
        tokens_in = max(_count(usage.get("promptTokenCount")), cached)
        found = _reply(say, calls, tokens_in, tokens_out, candidate.get("finishReason"))
        return replace(found, reasoning=reasoning, tokens_reasoning=thoughts, tokens_cached=cached)


_ENDS = {"end_turn": "stop", "tool_use": "stop", "max_tokens": "length", "max_output_tokens": "length"}
"""The providers' words for an answer that ended by itself or was cut off; any other word is kept."""


def _reply(say: str, calls: Iterable[Json], tokens_in: Any, tokens_out: Any, reason: object) -> ModelReply:
    text = json.dumps({"say": say, "calls": list(calls)}, ensure_ascii=False)
    word = str(reason or "stop").lower()
    return ModelReply(text, _count(tokens_in), _count(tokens_out), finish=_ENDS.get(word, word))


def _first(told: Any, name: str) -> Json:
    """The first of a list of answers; an empty one for an empty list, which a model that says nothing may leave."""
    _check(told)
    found = told[name]
    if not isinstance(found, list):
        raise TypeError(f"{name} is no list")
    first: Json = found[0] if found else {"finish_reason": f"no {name}", "finishReason": f"no {name}"}
    _check(first)
    return first


def _check(told: Any) -> None:
    """Raises a ``ValueError`` where the endpoint tells an error of its own, which says nothing about the model."""
    if told.get("error"):
        raise ValueError("the endpoint reports an error in place of an answer")


def _objects(listed: object) -> list[Json]:
    """The objects of a list; anything else in it is none of the protocol.

    Raises TypeError: it is no list, nor left out."""
    if listed is not None and not isinstance(listed, list):
        raise TypeError("a list was expected")
    return [each for each in listed or () if isinstance(each, dict)]


def _loaded(arguments: object) -> object:
    """The arguments of a call; as they are if they are no JSON, which the format's reader then says."""
    try:
        return json.loads(arguments) if isinstance(arguments, str) else dict(arguments or {})  # type: ignore[call-overload]
    except (ValueError, TypeError, RecursionError):
        return str(arguments)


def _called(call: ToolCall) -> Json:
    """A call as its server takes it back, which need not be as the model wrote it: a name of certain characters, an
    object."""
    given = call.arguments if isinstance(call.arguments, dict) else {"unreadable": str(call.arguments)}
    name = re.sub(r"[^\w-]", "_", call.name, flags=re.ASCII)[:64] or "unnamed"
    return {"name": name, "arguments": json.dumps(given, ensure_ascii=False)}


CALL_BACK, TURN_BACK = ("extra_content",), ("reasoning_content", "reasoning_details")
"""Fields that a server gives with a call and with a turn of calls, and refuses the next question without (Gemini;
DeepSeek, Kimi, OpenRouter)."""


def _back(told: Json, names: Sequence[str]) -> Json:
    found = {name: told[name] for name in names if told.get(name)}
    return {"back": found} if found else {}


def _named(calls: object) -> list[Json]:
    """The functions of an answer's calls, with what their frame has besides; some servers leave the frame out."""
    listed = _objects(calls) if isinstance(calls, list) else []
    functions = (
        {**each, **function} for each in listed if isinstance(function := each.get("function", each), dict)
    )
    return [each for each in functions if each.get("name")]


def _tool_calls(calls: object) -> str:
    """Calls that the server has taken out of the answer, in the form in which models write them."""
    told = ({"name": each.get("name", ""), "arguments": _loaded(each.get("arguments"))} for each in _named(calls))
    return "\n".join(f"<tool_call>\n{json.dumps(each, ensure_ascii=False)}\n</tool_call>" for each in told)


LONGEST_COUNT = 20
"""Digits of a number of tokens that comes as text."""


def _count(tokens: object) -> int:
    """A number of tokens, also as text; 0 for what is none."""
    if isinstance(tokens, str) and tokens.isascii() and tokens.isdecimal() and len(tokens) < LONGEST_COUNT:
        tokens = int(tokens)
    if isinstance(tokens, bool) or not isinstance(tokens, int | float) or not 0 <= tokens <= MOST_TOKENS:
        return 0
    return int(tokens)


def _detail(usage: Json, group: str, name: str) -> int:
    details = usage.get(group)
    return _count(details.get(name)) if isinstance(details, dict) else 0


def _text(content: object, *, is_thought: bool = False) -> str:
    """A string, or the text parts of a list; nothing else counts as text.

    Args:
        is_thought: whether the thoughts among the parts are wanted, instead of the words.
    """
    if isinstance(content, str):
        return "" if is_thought else content
    found = ""
    for part in content if isinstance(content, list) else ():
        told = part if isinstance(part, dict) else {"text": part}
        thinks = told.get("thought") is True or bool(_THOUGHT.search(str(told.get("type"))))
        if thinks == is_thought:
            text = told.get("text") or (told.get("thinking") or told.get("reasoning") if thinks else "")
            found += _text(text)
    return found


_THOUGHT = re.compile("think|thought|reason")


def is_sound(data: bytes) -> bool:
    """Whether it is a WAV file, and no picture."""
    return data.startswith(b"RIFF")


def _base64(picture: bytes) -> str:
    if is_sound(picture):
        raise ModelError("this provider takes no sound; choose another, or --hear cabin")
    return _encoded(picture)


def _encoded(data: bytes) -> str:
    return base64.b64encode(data).decode()


def _data_url(picture: bytes) -> str:
    return f"data:image/png;base64,{_base64(picture)}"


def _size(messages: Sequence[ChatMessage]) -> tuple[int, int]:
    """Width and height of the last picture, from its PNG header."""
    picture = next(message.pictures[-1] for message in reversed(messages) if message.pictures)
    return int.from_bytes(picture[16:20]), int.from_bytes(picture[20:24])
