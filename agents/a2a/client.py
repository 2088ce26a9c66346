"""The line to an agent behind an address: its card, and one message after the other. Needs ``a2a-sdk``.

Everything that comes from there is bounded: in size, in time, and in where it comes from. The card says in which
version of the protocol the agent speaks and under which path, never on which machine: that is the one that the user
named, and redirects are not followed.
"""

from __future__ import annotations

import asyncio
import json
import ssl
import uuid
from collections.abc import AsyncIterator, Iterable, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass
from functools import cache
from typing import Any
from urllib.parse import urlsplit, urlunsplit

import httpx
from a2a.client import ClientConfig, ClientFactory
from a2a.client.card_resolver import parse_agent_card
from a2a.helpers.proto_helpers import new_data_part, new_message, new_raw_part, new_text_part
from a2a.types import AgentCard, GetTaskRequest, Message, Part, Role, SendMessageRequest, Task, TaskState
from google.protobuf.json_format import MessageToDict

from automotive_cosim.agents.registry import PREFIX
from automotive_cosim.contracts import Json
from automotive_cosim.errors import AgentError, SetupError, UserError

CARD, FORMER_CARD = "/.well-known/agent-card.json", "/.well-known/agent.json"
"""Paths of the card, since protocol 0.3 and before."""
CARD_S = 10.0
"""Longest wait for the card."""
MOST_BYTES = 2**20
"""Longest answer; ten calls have some kilobytes."""
POLL_S = 0.5
"""Between two questions whether a task is done, which an agent makes of a message that takes longer."""
TOLD = 200
"""Characters kept of an error that comes from there."""
RUNNING = (TaskState.TASK_STATE_SUBMITTED, TaskState.TASK_STATE_WORKING)
FAILED = (
    TaskState.TASK_STATE_FAILED,
    TaskState.TASK_STATE_REJECTED,
    TaskState.TASK_STATE_CANCELED,
    TaskState.TASK_STATE_AUTH_REQUIRED,
)


@dataclass(frozen=True, slots=True)
class Said:
    """What came back: strings for text, all else for data."""

    parts: tuple[Any, ...]
    metadata: Json


class AgentLine:
    """A line to one agent, which has one conversation at a time."""

    def __init__(self, address: str) -> None:
        """Reads the agent's card.

        Raises:
            UserError: the address is none.
            SetupError: nothing answers there, or no agent that speaks A2A over JSON-RPC."""
        self._address = _checked(address)
        self._card = self._read_card()
        self.begin()

    def begin(self) -> None:
        """Begins another conversation."""
        self._context = str(uuid.uuid4())
        self._is_new = True
        self._task = ""
        self._heard: dict[str, tuple[Any, ...]] = {}

    def say(self, parts: Sequence[Any], source: str, limit_s: float) -> Said:
        """Sends a message and returns the answer.

        Args:
            parts: strings for text, bytes for a WAV file, all else for data.
            limit_s: wall seconds in which the whole answer has to be there.

        Raises AgentError: it does not answer, not in time, or something that is no answer."""
        message = new_message(list(map(_made, parts)), self._context, self._task or None, Role.ROLE_USER)
        message.metadata.update({"source": source})
        try:
            return asyncio.run(asyncio.wait_for(self._exchange(message), limit_s))
        except TimeoutError as error:
            raise AgentError(f"the agent at {self._address} gave no answer within {limit_s:.3g} s") from error
        except AgentError:
            raise
        except Exception as error:  # whatever is made of what it sent
            raise AgentError(f"the agent at {self._address} gave no answer: {_told(error)}") from error

    async def _exchange(self, message: Message) -> Said:
        async with _http(self._address) as http:
            client = ClientFactory(ClientConfig(streaming=False, httpx_client=http)).create(self._card)
            answers = [each async for each in client.send_message(SendMessageRequest(message=message))]
            answer = answers[-1]
            if answer.HasField("message"):
                self._follow(answer.message.context_id, "")
                return Said(_plain(answer.message.parts), _metadata(answer.message))
            task = answer.task
            while task.status.state in RUNNING:
                await asyncio.sleep(POLL_S)
                task = await client.get_task(GetTaskRequest(id=task.id))
            return self._done(task)

    def _done(self, task: Task) -> Said:
        if task.status.state in FAILED:
            state = TaskState.Name(task.status.state).removeprefix("TASK_STATE_").lower()
            words = " ".join(map(str, _plain(task.status.message.parts)))
            raise AgentError(f"the agent at {self._address} calls its task {state}: {words[:TOLD]}")
        answer, metadata = self._answer(task)
        asks_more = task.status.state == TaskState.TASK_STATE_INPUT_REQUIRED
        self._follow(task.context_id, task.id if asks_more else "")
        if not asks_more:
            self._heard = {}
        return Said(answer, metadata)

    def _answer(self, task: Task) -> tuple[tuple[Any, ...], Json]:
        """What a task says that it had not said before, once, with the metadata.

        Artifacts are its result, and a status message tells only what they do not. An open task has those of its
        earlier answers, too."""
        metadata, artifacts, status = _metadata(task), list[Any](), list[Any]()
        for each in task.artifacts:
            parts, before = _plain(each.parts), self._heard.get(each.artifact_id, ())
            self._heard[each.artifact_id] = parts
            if new := parts[len(before) :] if parts[: len(before)] == before else parts:
                artifacts += _joined(new)
                metadata |= _metadata(each)
        message = task.status.message
        if task.status.HasField("message") and self._heard.get(message.message_id) is None:
            status += _plain(message.parts)
            self._heard[message.message_id] = ()
            metadata |= _metadata(message)
        kinds = set(map(_kind, artifacts))
        answer = [*artifacts, *(part for part in status if _kind(part) not in kinds)]
        if not answer and task.artifacts:  # the same again, under the same name
            answer = _joined(_plain(task.artifacts[-1].parts))
        return tuple(answer), metadata

    def _follow(self, context: str, task: str) -> None:
        """Takes over the context that an agent gives its first answer; after that it cannot change."""
        if context and context != self._context and not self._is_new:
            raise AgentError(f"the agent at {self._address} answered in another context than it was asked in")
        self._context, self._task, self._is_new = context or self._context, task, False

    def _read_card(self) -> AgentCard:
        try:
            told = asyncio.run(asyncio.wait_for(self._fetch_card(), CARD_S))
            card = parse_agent_card(told)
            for interface in card.supported_interfaces:
                interface.url = self._here(interface.url)
            if not any(each.protocol_binding == "JSONRPC" for each in card.supported_interfaces):
                raise ValueError("its card has no interface with the binding JSONRPC")
        except TimeoutError as error:
            raise SetupError(f"{self._address} gives no agent card within {CARD_S:g} s; is it an agent?") from error
        except Exception as error:
            raise SetupError(
                f"{self._address} gives no card of an agent that speaks A2A over JSON-RPC: {_told(error)}; "
                "start the agent, or give another address"
            ) from error
        return card

    async def _fetch_card(self) -> Json:
        async with _http(self._address) as http:
            response = await http.get(self._address + CARD)
            if response.status_code == httpx.codes.NOT_FOUND:
                response = await http.get(self._address + FORMER_CARD)
            response.raise_for_status()
            told = response.json()
            if not isinstance(told, dict):
                raise ValueError("the card is no JSON object")
            return told

    def _here(self, url: str) -> str:
        """An interface's address, on the machine that the user named."""
        named, told = urlsplit(self._address), urlsplit(url)
        return urlunsplit((named.scheme, named.netloc, told.path or "/", told.query, ""))


class _Bounded(httpx.AsyncBaseTransport):
    """Reads answers up to their greatest length, uncompressed, and only those to the question."""

    def __init__(self, is_encrypted: bool) -> None:
        self._inner = httpx.AsyncHTTPTransport(verify=_certificates() if is_encrypted else False)

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        request.headers["Accept-Encoding"] = "identity"
        response = await self._inner.handle_async_request(request)
        try:
            if response.headers.get("Content-Encoding", "identity") != "identity":
                raise ValueError("its answer is compressed, which nobody asked for")
            content = b""
            assert isinstance(response.stream, httpx.AsyncByteStream)
            async for chunk in response.stream:
                content += chunk
                if len(content) > MOST_BYTES:
                    raise ValueError(f"its answer has over {MOST_BYTES:,} bytes")
        finally:
            await response.aclose()
        if response.is_redirect:
            raise ValueError("it redirects to another address; give the agent's own")
        if request.method == "POST" and response.is_success:
            _check_answers(request.content, content)
        headers = {"Content-Type": response.headers.get("Content-Type", "application/json")}
        return httpx.Response(response.status_code, headers=headers, content=content, request=request)

    async def aclose(self) -> None:
        await self._inner.aclose()


@asynccontextmanager
async def _http(address: str) -> AsyncIterator[httpx.AsyncClient]:
    """A client whose waits are limited by who waits. It reads no proxies from the environment."""
    transport = _Bounded(address.startswith("https:"))
    async with httpx.AsyncClient(transport=transport, timeout=None, trust_env=False) as http:
        yield http


@cache
def _certificates() -> ssl.SSLContext:
    """Whom to trust; reading them takes longer than a short message."""
    return ssl.create_default_context()


def _made(part: Any) -> Part:
    if isinstance(part, bytes):
        return new_raw_part(part, media_type="audio/wav")
    return new_text_part(part) if isinstance(part, str) else new_data_part(part)


def _check_answers(question: bytes, content: bytes) -> None:
    answer = json.loads(content)
    if not isinstance(answer, dict):
        raise ValueError("its answer is no JSON object")
    if "error" not in answer and answer.get("id") != json.loads(question).get("id"):
        raise ValueError("its answer has the id of another question")


def _checked(address: str) -> str:
    wrong = UserError(f"agent {PREFIX}{address} does not have the form a2a:http://HOST:PORT")
    try:
        parts = urlsplit(address)
        _ = parts.port
    except ValueError as error:
        raise wrong from error
    is_address = parts.scheme in ("http", "https") and bool(parts.hostname)
    if not is_address or parts.username or parts.query or parts.fragment:
        raise wrong
    return address.rstrip("/")


def _plain(parts: Iterable[Part]) -> tuple[Any, ...]:
    """Text and data of parts; files are left out."""
    found: list[Any] = []
    for part in parts:
        if part.HasField("text"):
            found.append(part.text)
        elif part.HasField("data"):
            found.append(MessageToDict(part.data))
    return tuple(found)


def _joined(parts: Iterable[Any]) -> list[Any]:
    """The parts of an artifact, whose texts are pieces of one."""
    found: list[Any] = []
    for part in parts:
        if isinstance(part, str) and found and isinstance(found[-1], str):
            found[-1] += part
        else:
            found.append(part)
    return found


def _kind(part: Any) -> str:
    """Words, calls or anything else; blank words are the latter."""
    if isinstance(part, str):
        return "words" if part.strip() else ""
    return "calls" if isinstance(part, dict) and part.keys() & {"tool_calls", "toolCalls"} else ""


def _metadata(message: Any) -> Json:
    told: Json = MessageToDict(message.metadata)
    return told


def _told(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())[:TOLD]
