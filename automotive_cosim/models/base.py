"""The protocol of models: messages in; text, tokens, time and cost out."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from math import ceil
from typing import Any, Protocol

from automotive_cosim.contracts import Json

CHARACTERS_PER_TOKEN = 4
"""A usual estimate for English, for models that count no tokens themselves."""

NOTHING = '{"say": "", "calls": []}'
"""The text of an answer in calls that has neither words nor a call."""
ENDED_BY_ITSELF = ("stop", "tool_calls", "function_call", "eos", "end_turn", "stop_sequence")
"""What providers say of an answer that ended by itself."""


@dataclass(frozen=True, slots=True)
class ToolCall:
    """A function that a model calls."""

    id: str
    name: str
    arguments: Any
    """By name; as they came where they are no object."""
    back: Json | None = None
    """Fields of the call that its server wants back, such as Gemini's signature of the thoughts before it."""


@dataclass(frozen=True, slots=True)
class ChatMessage:
    """One turn of a conversation."""

    role: str
    """``"system"``, ``"user"``, ``"assistant"`` or, of a call's result, ``"tool"``."""
    text: str
    pictures: tuple[bytes, ...] = ()
    """PNG files, in the order in which the text mentions them; before them WAV files, if words came as sound."""
    calls: tuple[ToolCall, ...] = ()
    """What the assistant calls."""
    call_id: str = ""
    """The call that it is the result of."""
    form: Json | None = None
    """JSON Schema of the answer that is asked for, for models that can be held to one."""
    back: Json | None = None
    """Fields of the assistant's turn that its server wants back, such as the thoughts that led to calls."""


@dataclass(frozen=True, slots=True)
class ModelReply:
    """A model's answer, with its tokens, time and cost."""

    text: str
    tokens_in: int = 0
    """Input tokens, cached ones included."""
    tokens_out: int = 0
    """Those of its reasoning included."""
    cost_usd: float = 0.0
    seconds: float = 0.0
    """From the question to the whole answer, including failed attempts; 0 for models in this process."""
    finish: str = "stop"
    """Why it ended: ``"stop"``, ``"length"`` if it was cut off at its limit, or the provider's own word."""
    reasoning: str = ""
    """What the provider shows of its reasoning; no agent reads it."""
    tokens_reasoning: int = 0
    tokens_cached: int = 0

    def as_json(self) -> Json:
        return asdict(self)

    @property
    def is_cut(self) -> bool:
        """Whether it was cut off at its longest."""
        return self.finish == "length"

    @property
    def ending(self) -> str:
        """Why it did not end by itself, to be put after an error about its text; empty if it did."""
        if self.reasoning and self.text in ("", NOTHING):
            return "; the answer ended within its thoughts"
        if self.is_cut:
            return "; the answer was cut off at its longest"
        return "" if self.finish in ENDED_BY_ITSELF else f"; the provider ended the answer: {self.finish}"


class ChatModel(Protocol):
    """A model that answers a conversation."""

    @property
    def name(self) -> str: ...

    @property
    def sees_pictures(self) -> bool:
        """Whether to send it pictures."""
        ...

    def chat(self, messages: Sequence[ChatMessage]) -> ModelReply:
        """Answers the last message.

        Raises ModelError: it cannot be reached or does not answer; the episode then says nothing about the
        agent."""
        ...


def digest(messages: Sequence[ChatMessage]) -> str:
    """SHA-256 of a conversation, including pictures, as a hexadecimal string."""
    told = [
        [message.role, message.text, [hashlib.sha256(picture).hexdigest() for picture in message.pictures]]
        + ([[asdict(call) for call in message.calls], message.call_id] if message.calls or message.call_id else [])
        for message in messages
    ]
    return hashlib.sha256(json.dumps(told).encode()).hexdigest()


IN_PER_S, OUT_PER_S = 1_000_000, 10_000
"""Tokens that nobody's models read and write more of in a second."""
DEAREST_USD = 1e-3
"""What no token costs more than."""


def believed(reply: ModelReply, seconds: float) -> ModelReply:
    """A reply with as many tokens and dollars as whoever tells them can have used, and no more."""
    most_in, most_out = (int(rate * (1.0 + seconds)) for rate in (IN_PER_S, OUT_PER_S))
    tokens_in, tokens_out = min(reply.tokens_in, most_in), min(reply.tokens_out, most_out)
    return replace(
        reply,
        tokens_in=tokens_in,
        tokens_out=tokens_out,
        tokens_reasoning=min(reply.tokens_reasoning, tokens_out),
        tokens_cached=min(reply.tokens_cached, tokens_in),
        cost_usd=min(reply.cost_usd, DEAREST_USD * (tokens_in + tokens_out)),
    )


def estimated_tokens(*texts: str) -> int:
    """Estimated tokens of the texts, at four characters each."""
    return ceil(sum(map(len, texts)) / CHARACTERS_PER_TOKEN)
