"""Any OpenAI-compatible endpoint, and others' by their own protocols (``apis``). Needs ``httpx2``.

Key and address come from ``<PROVIDER>_API_KEY`` and ``<PROVIDER>_BASE_URL``. The key never gets into a message,
log or record: every text about an endpoint passes ``_Endpoint.clean``.
"""

from __future__ import annotations

import asyncio
import json
import os
import re
import ssl
import time
import zlib
from collections.abc import Callable, Coroutine, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import cache
from types import NoneType
from typing import TYPE_CHECKING, Any, TypeVar, get_args, get_type_hints
from urllib.parse import parse_qsl

from automotive_cosim.errors import ModelError, SetupError, UnknownNameError, UserError, install_hint
from automotive_cosim.formats.keys import hidden
from automotive_cosim.models.apis import Chat, ProviderApi
from automotive_cosim.models.base import ChatMessage, ModelReply, believed
from automotive_cosim.models.refusal import LONGEST_REASON, pause_asked_s, reason, told
from automotive_cosim.models.turns import LocalTurns, Turns

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

BODY_LIMIT_BYTES = 4_000_000
"""Longest body to read; an answer of a few thousand tokens has some tens of kilobytes."""
HIDDEN_TOKENS = 10_000
"""Of a provider's own instructions, beyond those of a question, which has one in several bytes."""
LONGEST_FINISH = 40
"""Characters of the reason why an answer ends."""
FIRST_PAUSE_S = 0.5
LONGEST_PAUSE_S = 60.0
"""Between two attempts, if the server asks for no pause."""
SHORTEST_ASKED_PAUSE_S, LONGEST_ASKED_PAUSE_S = 1.0, 600.0
"""A server that says when to come back has not failed, and its pauses use up no attempt, until they are longer than
this together, as at the end of a day's quota."""
OPENAI_URL = "https://api.openai.com/v1"


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings after the ``?`` of a model's name. ``none`` leaves a value to the provider."""

    seed: int | None = 0
    temperature: float | None = 0.0
    max_tokens: int | None = 1024
    """Longest answer, in tokens."""
    timeout_s: float = 60.0
    """Time limit of one attempt, from the question to the answer's last byte, whatever the answer is."""
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

    Raises UserError: an unknown name, or a value that is not a number or out of range."""
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
        api: the protocol of its endpoint; by default chat completions.
        turns: where it takes its turns; by default its own.

    Raises:
        SetupError: ``httpx2``, the key or the address is missing.
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
        """The text without the key, wherever it came from and however it is spelled."""
        return hidden(text, self.key)

    def url(self, path: str) -> str:
        """The address of a request; a query of the endpoint's own stays at its end."""
        base, mark, query = (self.base_url or OPENAI_URL).partition("?")
        return f"{base.rstrip('/')}{path}{mark}{query}"


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
            api: the protocol in which to ask it.
            sleep: waits for a number of seconds, between attempts and for the rate limit.

        Raises SetupError: ``httpx2`` is missing."""
        try:
            import httpx2  # noqa: F401, whether it is there
        except ImportError as error:
            raise SetupError(f"the package httpx2 is missing: {install_hint('models')}") from error
        self.name = name
        self._model = model
        self._settings = settings
        self._endpoint = endpoint
        self._api = api
        self._turns = turns
        self._sleep = sleep

    def chat(self, messages: Sequence[ChatMessage]) -> ModelReply:
        """Asks, and repeats the question after a transient failure, each time after a longer pause, or after that
        which the server asks for.

        Raises ModelError: refused, or every attempt failed."""
        started_s, queued_s, asked_s = time.monotonic(), 0.0, 0.0
        retries, failed = self._settings.retries, 0
        longest_s = LONGEST_ASKED_PAUSE_S + (retries + 1) * self._settings.timeout_s
        while True:
            queued_s += self._take_turn()
            try:
                reply = self._ask(messages)
                return replace(reply, seconds=max(0.0, time.monotonic() - started_s - queued_s - asked_s))
            except _PassingError as error:
                why, pause_s = str(error), error.pause_s or 0.0
            is_late = time.monotonic() - started_s - queued_s > longest_s
            is_told = pause_s >= SHORTEST_ASKED_PAUSE_S and retries > 0 and not is_late
            if is_told and asked_s + pause_s > LONGEST_ASKED_PAUSE_S:
                raise self._error(f"is busy: {why}; it asks for a pause of {asked_s + pause_s:,.0f} s")
            failed += not is_told
            if failed > retries:
                raise self._error(f"gave no answer in {failed} attempts: {why}")
            asked_s += pause_s
            self._sleep(max(pause_s, min(LONGEST_PAUSE_S, FIRST_PAUSE_S * 2 ** max(0, failed - 1))))

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

        try:
            asked_s = time.monotonic()
            status, headers, body, asked_bytes = _in_a_loop(lambda: self._post(messages))
            took_s = time.monotonic() - asked_s
        except TimeoutError:
            raise _PassingError(f"the answer took over {self._settings.timeout_s:g} s") from None
        except (httpx2.HTTPError, httpx2.StreamError, OSError) as error:
            raise _PassingError(f"{type(error).__name__}: {error}") from None
        except (httpx2.InvalidURL, UnicodeError) as error:  # of the address, or in the key
            raise self._error(f"cannot be asked: {type(error).__name__}: {error}") from None
        if 200 <= status < 300:
            reply = self._read(body, headers)
            reply = replace(reply, tokens_in=min(reply.tokens_in, asked_bytes + HIDDEN_TOKENS))
            return self._priced(believed(reply, took_s))
        said = told(body)
        why = self._endpoint.clean(reason(said))[:LONGEST_REASON]
        why = f"status {status}: {why}" if why else f"status {status}"
        if status in (408, 409, 425, 429) or status >= 500:
            raise _PassingError(why, pause_asked_s(headers, said))
        if 300 <= status < 400:
            where = self._endpoint.clean(headers.get("location", "somewhere"))[:200]
            why += f"; it sends to {where}, and nothing is sent on: if that is right, make it the address"
        raise self._error(f"refused: {why}")

    async def _post(self, messages: Sequence[ChatMessage]) -> tuple[int, Mapping[str, str], bytes, int]:
        """Status, headers by names in small letters, and body of the answer; the bytes of the question.

        The time limit holds from the connection to the last byte, whatever comes; so does that of size, of what
        comes and of what that unpacks to.

        Raises:
            TimeoutError: it took longer.
            _PassingError: it is longer.
        """
        import httpx2

        settings, key = self._settings, self._endpoint.key
        wanted = {"seed": settings.seed, "temperature": settings.temperature, "max_tokens": settings.max_tokens}
        limits = {name: value for name, value in wanted.items() if value is not None}
        question = json.dumps(self._api.body(self._model, messages, limits)).encode()
        own = self._api.headers(key) or {"Authorization": f"Bearer {key}"}
        sent = {
            "Content-Type": "application/json",
            "Accept": "application/json",
            "Accept-Encoding": "identity",
            **own,
        }
        verify = _certificates() if self._endpoint.url("").startswith("https") else False
        async with (
            asyncio.timeout(settings.timeout_s),
            # To whom a redirect leads, the question and the key would go.
            httpx2.AsyncClient(follow_redirects=False, timeout=None, verify=verify) as http,
            http.stream(
                "POST", self._endpoint.url(self._api.path(self._model)), content=question, headers=sent
            ) as response,
        ):
            body = bytearray()
            async for piece in response.aiter_raw():
                body += piece
                if len(body) > BODY_LIMIT_BYTES:
                    raise _PassingError(f"the answer has over {BODY_LIMIT_BYTES} bytes")
            headers = {name.lower(): value for name, value in response.headers.items()}
            content = _unpacked(bytes(body), headers.get("content-encoding", ""))
            return response.status_code, headers, content, len(question)

    def _read(self, body: bytes, headers: Mapping[str, str]) -> ModelReply:
        try:
            reply = self._api.read(json.loads(body))
        except (ValueError, LookupError, TypeError, AttributeError, RecursionError):
            shown = self._endpoint.clean(body.decode(errors="replace"))[:80]  # cut first, half a key would pass
            wrong = f"the answer is not one of its protocol: {shown!r}"
            raise _PassingError(wrong, pause_asked_s(headers, told(body))) from None
        # Half a surrogate pair is valid JSON but not valid text: it could not be written into a record.
        text, finish, reasoning = (
            self._endpoint.clean(each).encode("utf-8", "replace").decode()
            for each in (reply.text, reply.finish, reply.reasoning)
        )
        finish = finish[:LONGEST_FINISH]
        return replace(reply, text=text, finish=finish, reasoning=reasoning)

    def _priced(self, reply: ModelReply) -> ModelReply:
        settings = self._settings
        in_usd, cached_usd = settings.usd_per_million_in, settings.usd_per_million_cached
        dollars = (reply.tokens_in - reply.tokens_cached) * in_usd
        dollars += reply.tokens_cached * (in_usd if cached_usd is None else cached_usd)
        dollars += reply.tokens_out * settings.usd_per_million_out
        return replace(reply, cost_usd=dollars / 1e6)


def _unpacked(body: bytes, encoding: str) -> bytes:
    """The body as it was before some servers packed it, although nobody asked for that.

    Raises _PassingError: it is packed in another way, damaged, or longer than what is read."""
    packed = encoding.strip().lower()
    if packed in ("", "identity"):
        return body
    if packed not in ("gzip", "x-gzip", "deflate"):
        raise _PassingError(f"the answer is packed by {packed[:LONGEST_FINISH]!r}, and nobody asked for that")
    try:
        content = zlib.decompressobj(wbits=zlib.MAX_WBITS | 32).decompress(body, BODY_LIMIT_BYTES + 1)
    except zlib.error as error:
        raise _PassingError(f"the answer is damaged: {error}") from None
    if len(content) > BODY_LIMIT_BYTES:
        raise _PassingError(f"the answer has over {BODY_LIMIT_BYTES} bytes")
    return content


T = TypeVar("T")


def _in_a_loop(make: Callable[[], Coroutine[Any, Any, T]]) -> T:
    """What a coroutine returns; where a loop runs already, as in a notebook, in another thread."""
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        return asyncio.run(make())
    with ThreadPoolExecutor(1) as other:
        return other.submit(lambda: asyncio.run(make())).result()


@cache
def _certificates() -> ssl.SSLContext:
    """Whom to trust; reading them takes longer than a short answer."""
    import httpx2

    return httpx2.create_ssl_context()
