"""Any OpenAI-compatible endpoint, and others' by their own protocols (``apis``), through the ``openai`` package.

Key and address come from ``<PROVIDER>_API_KEY`` and ``<PROVIDER>_BASE_URL``. The key never gets into a message,
log or record: every text about an endpoint passes ``_Endpoint.clean``.
"""

from __future__ import annotations

import base64
import json
import os
import re
import time
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from functools import cache
from types import NoneType
from typing import TYPE_CHECKING, Any, TypeVar, get_args, get_type_hints
from urllib.parse import parse_qsl, quote

from automotive_cosim.errors import ModelError, SetupError, UnknownNameError, UserError, install_hint
from automotive_cosim.models.apis import Chat, ProviderApi
from automotive_cosim.models.base import ChatMessage, ModelReply
from automotive_cosim.models.turns import LocalTurns, Turns

if TYPE_CHECKING:
    import openai
    from _typeshed import DataclassInstance

BODY_LIMIT_BYTES = 4_000_000
"""Longest body to read; an answer of a few thousand tokens has some tens of kilobytes."""
LONGEST_FINISH = 40
"""Characters of the reason why an answer ends."""
LONGEST_PAUSE_S = 60.0
FIRST_PAUSE_S = 0.5
STREAMED = "X-Stainless-Raw-Response"
"""With this header and the value ``stream``, the ``openai`` package hands over the answer before it has read it."""
SHORTEST_KEY = 12
"""A shorter key is no secret but a dummy for a local server, and may occur in any answer."""


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings after the ``?`` of a model's name. ``none`` leaves a value to the provider."""

    seed: int | None = 0
    temperature: float | None = 0.0
    max_tokens: int | None = 1024
    """Longest answer, in tokens."""
    timeout_s: float = 60.0
    """Time limit of one attempt, from the question to the answer's last byte."""
    retries: int = 4
    """Further attempts after a transient failure."""
    per_minute: float | None = None
    """Maximum number of questions per minute."""
    usd_per_million_in: float = 0.0
    usd_per_million_out: float = 0.0
    usd_per_million_cached: float | None = None
    """Of those that go in, the ones that the provider has cached; None for the same price."""
    guided: bool = False
    """Whether the server holds the model to the JSON Schema of an action (``response_format``)."""

    @classmethod
    def read(cls, query: str) -> Settings:
        """Settings from ``name=value&name=value``; see ``read_settings``."""
        return read_settings(cls, query)


S = TypeVar("S", bound="DataclassInstance")


def read_settings(kind: type[S], query: str) -> S:
    """The settings of a model from ``name=value&name=value``.

    Raises:
        UserError: an unknown name, or a value that is not a number or out of range.
    """
    known = {name: get_args(each) or (each,) for name, each in get_type_hints(kind).items()}
    chosen: dict[str, Any] = {}
    for name, value in parse_qsl(query, keep_blank_values=True):
        if name not in known:
            raise UnknownNameError("model setting", name, known)
        chosen[name] = _switch(name, value) if bool in known[name] else _number(name, value, known[name])
    return kind(**chosen)


def _switch(name: str, value: str) -> bool:
    if value not in ("0", "1"):
        raise UserError(f"model setting {name} is {value!r}; give 0 or 1")
    return value == "1"


def _number(name: str, value: str, kinds: tuple[type, ...]) -> float | int | None:
    if value == "none" and NoneType in kinds:
        return None
    try:
        number = int(value) if int in kinds else float(value)
    except ValueError:
        number = -1
    positive = name in ("timeout_s", "max_tokens", "per_minute", "context", "threads")
    if not 0 <= number < 1e12 or (positive and number == 0):
        wanted = "a whole number" if int in kinds else "a number"
        raise UserError(f"model setting {name} is {value!r}; give {wanted} {'above' if positive else 'from'} 0")
    return number


def make_remote(spec: str, api: ProviderApi | None = None, turns: Turns | None = None) -> Remote:
    """The model ``PROVIDER/NAME`` or ``PROVIDER/NAME?settings``.

    Args:
        spec: its name.
        api: the protocol of its endpoint; by default chat completions.
        turns: where it takes its turns; by default its own.

    Raises:
        SetupError: the ``openai`` package, the key or the address is missing.
        UserError: a setting is wrong.
    """
    whole, _, query = spec.partition("?")
    provider, _, model = whole.partition("/")
    settings = Settings.read(query)
    prefix = re.sub(r"\W", "_", provider).upper()
    key, base_url = os.environ.get(f"{prefix}_API_KEY", ""), os.environ.get(f"{prefix}_BASE_URL", "")
    if not key:
        raise SetupError(
            f"model {whole!r} requires a key in {prefix}_API_KEY; for a local server, any word will do"
        )
    if not base_url and provider != "openai":
        raise SetupError(f"model {whole!r} requires an address in {prefix}_BASE_URL, e.g. http://127.0.0.1:8000/v1")
    longest = "max_completion_tokens" if provider == "openai" else "max_tokens"
    spoken = api or Chat(longest, is_guided=settings.guided)
    return Remote(spec, model, settings, _Endpoint(provider, base_url or None, key), spoken, turns or LocalTurns())


@dataclass(frozen=True, slots=True)
class _Endpoint:
    provider: str
    base_url: str | None
    key: str = field(repr=False)

    def clean(self, text: str) -> str:
        """The text without the key, wherever it came from, as it is or encoded."""
        for form in forms(self.key) if len(self.key) >= SHORTEST_KEY else ():
            text = text.replace(form, "***")
        return text

    def client(self, timeout_s: float) -> openai.OpenAI:
        try:
            import openai
        except ImportError as error:
            raise SetupError(f"the openai package is missing; install it with `{install_hint('llm')}`") from error
        http = openai.DefaultHttpx2Client(follow_redirects=False)  # to whom the question and the key would go
        return openai.OpenAI(
            api_key=self.key, base_url=self.base_url, timeout=timeout_s, max_retries=0, http_client=http
        )


@cache
def forms(key: str) -> tuple[str, ...]:
    """How a key may be written: as it is, in base64 at any place of a longer text, in hexadecimal, in a URL, in
    JSON, backwards."""
    data = key.encode()
    found = [key, data.hex(), data.hex().upper(), quote(key, safe=""), json.dumps(key)[1:-1], key[::-1]]
    for before in range(3):
        whole = base64.b64encode(b"\0" * before + data).decode()
        sure = whole[-(-before * 8 // 6) : (before + len(data)) * 8 // 6]  # what only the key determines
        found += [sure, sure.translate(str.maketrans("+/", "-_"))]
    return tuple(dict.fromkeys(found))


class _PassingError(Exception):
    """A failure worth another attempt."""

    def __init__(self, why: str, pause_s: float | None = None) -> None:
        super().__init__(why)
        self.pause_s = pause_s


class Remote:
    """A model at an endpoint."""

    sees_pictures = True

    def __init__(
        self,
        name: str,
        model: str,
        settings: Settings,
        endpoint: _Endpoint,
        api: ProviderApi,
        turns: Turns,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        """Makes the model without connecting to it.

        Args:
            name: the name written into results.
            model: the provider's name of it.
            settings: how to ask it.
            endpoint: where to ask it.
            api: the protocol in which to ask it.
            turns: where it takes its turns.
            sleep: waits for a number of seconds, between attempts and for the rate limit.

        Raises:
            SetupError: the ``openai`` package is missing.
        """
        self.name = name
        self._model = model
        self._settings = settings
        self._endpoint = endpoint
        self._api = api
        self._turns = turns
        self._sleep = sleep
        self._client = endpoint.client(settings.timeout_s)

    def chat(self, messages: Sequence[ChatMessage]) -> ModelReply:
        """Asks, and repeats the question after a transient failure, each time after a longer pause.

        Raises:
            ModelError: refused, or every attempt failed.
        """
        started_s, queued_s = time.monotonic(), 0.0
        attempts, why = self._settings.retries + 1, ""
        for attempt in range(attempts):
            queued_s += self._take_turn()
            try:
                reply = self._ask(messages)
            except _PassingError as error:
                why, pause_s = str(error), error.pause_s
                if attempt + 1 < attempts:
                    longer_s = FIRST_PAUSE_S * 2**attempt
                    self._sleep(min(LONGEST_PAUSE_S, longer_s if pause_s is None else max(pause_s, longer_s)))
            else:
                return replace(reply, seconds=max(0.0, time.monotonic() - started_s - queued_s))
        raise self._error(f"gave no answer in {attempts} attempts: {why}")

    def _error(self, what: str) -> ModelError:
        return ModelError(" ".join(self._endpoint.clean(f"{self.name} {what}").split()))

    def _take_turn(self) -> float:
        """Waits for its turn; the seconds that it took, which are not the model's."""
        if self._settings.per_minute is None:
            return 0.0
        wait_s = self._turns.wait_s(f"{self._endpoint.provider}/{self._model}", self._settings.per_minute)
        if wait_s > 0:
            self._sleep(wait_s)
        return wait_s

    def _ask(self, messages: Sequence[ChatMessage]) -> ModelReply:
        import httpx2
        import openai

        try:
            body = self._post(messages)
        except openai.APIStatusError as error:
            why = f"status {error.status_code}: {self._endpoint.clean(error.message)[:300]}"
            if error.status_code in (408, 409, 429) or error.status_code >= 500:
                raise _PassingError(why, _pause(error.response.headers.get("retry-after"))) from None
            if 300 <= error.status_code < 400:
                where = self._endpoint.clean(error.response.headers.get("location", "somewhere"))[:200]
                why += f"; it sends to {where}, and nothing is sent on: if that is right, make it the address"
            raise self._error(f"refused: {why}") from None
        except (openai.APIError, httpx2.HTTPError, httpx2.StreamError) as error:
            raise _PassingError(f"{type(error).__name__}: {error}") from None
        return self._read(body)

    def _post(self, messages: Sequence[ChatMessage]) -> bytes:
        """The body of the answer. It is read in pieces, so that the time limit applies to a slow server too."""
        import openai

        settings = self._settings
        wanted = {"seed": settings.seed, "temperature": settings.temperature, "max_tokens": settings.max_tokens}
        limits = {name: value for name, value in wanted.items() if value is not None}
        headers: dict[str, Any] = dict(self._api.headers(self._endpoint.key))
        if headers:  # a key of its own takes the bearer's place
            headers["Authorization"] = openai.Omit()
        limit_s = time.monotonic() + settings.timeout_s
        body = b""
        response = self._client.post(
            self._api.path(self._model),
            cast_to=openai.APIResponse[bytes],
            body=self._api.body(self._model, messages, limits),
            options={"headers": headers | {STREAMED: "stream"}},
        )
        with closing(response):
            for piece in response.iter_bytes():
                body += piece
                if time.monotonic() > limit_s:
                    raise _PassingError(f"the answer took over {settings.timeout_s:g} s")
                if len(body) > BODY_LIMIT_BYTES:
                    raise _PassingError(f"the answer has over {BODY_LIMIT_BYTES} bytes")
        return body

    def _read(self, body: bytes) -> ModelReply:
        try:
            reply = self._api.read(json.loads(body))
        except (ValueError, LookupError, TypeError, AttributeError, RecursionError):
            shown = self._endpoint.clean(body.decode(errors="replace"))[:80]  # cut first, half a key would pass
            raise _PassingError(f"the answer is not one of its protocol: {shown!r}") from None
        settings = self._settings
        in_usd, cached_usd = settings.usd_per_million_in, settings.usd_per_million_cached
        dollars = (reply.tokens_in - reply.tokens_cached) * in_usd
        dollars += reply.tokens_cached * (in_usd if cached_usd is None else cached_usd)
        dollars += reply.tokens_out * settings.usd_per_million_out
        # Half a surrogate pair is valid JSON but not valid text: it could not be written into a record.
        text, finish, reasoning = (
            self._endpoint.clean(each).encode("utf-8", "replace").decode()
            for each in (reply.text, reply.finish, reply.reasoning)
        )
        finish = finish[:LONGEST_FINISH]
        return replace(reply, text=text, finish=finish, reasoning=reasoning, cost_usd=dollars / 1e6)


def _pause(header: str | None) -> float | None:
    """The pause that the server requests, in seconds; None without one, or with a date."""
    try:
        return max(0.0, float(header)) if header else None
    except ValueError:
        return None
