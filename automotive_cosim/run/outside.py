"""Agents in separate processes: a fresh one for each episode, which gets the observation and nothing else.

Whatever its process does, whether it raises, exits, is killed, hangs or sends nonsense, is an ``AgentError``: the
episode is a failure. The model of an agent that has one is asked on this side, so a ``ModelError`` always comes
from this program's own client.

The references and negative controls are this project's own, and some are told the task: they stay inside.
"""

from __future__ import annotations

import base64
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from automotive_cosim.agents import MODELLED, AgentSettings, Stage, StageName, is_remote, model_of
from automotive_cosim.agents.cleanup import remove
from automotive_cosim.agents.process import AgentRequest
from automotive_cosim.agents.wire import GoneError, Wire, packed
from automotive_cosim.cockpit.actions import parse
from automotive_cosim.contracts import Action, Json, Observation
from automotive_cosim.errors import ActionError, AgentError, OutOfBudgetError, UserError
from automotive_cosim.interface.observe import Channel
from automotive_cosim.models import ChatMessage, ChatModel, ModelReply
from automotive_cosim.models.base import ToolCall
from automotive_cosim.run.fork_server import ForkServer

STEP_S, EPISODE_S = 120.0, 900.0
"""Default limits of the wall time that an agent's process takes, for one step and for all of an episode."""
GRACE_S = 2.0
"""Wall time in which a process that has closed its connection has to end."""
MOMENT_S = 0.01
"""Time left at the end of a limit; zero would mean not waiting for an answer that is on its way."""
LONGEST_FAILURE, LONGEST_REFUSAL = 500, 10_000
"""Number of characters kept of an agent's process's messages."""

T = TypeVar("T")


def is_outside(name: str) -> bool:
    """Whether an evaluation runs this agent in a separate process."""
    return ":" in name or name in MODELLED


def check_agent(name: str) -> None:
    """Makes a user's own agent in a process, to check that this works.

    Raises:
        UserError: it cannot.
        InfrastructureError: no process can be started."""
    with closing(ForkServer()) as fork_server, closing(OutsideAgent(fork_server, name)) as agent:
        _ = agent.channels
        if agent.failure is not None:
            raise UserError(agent.failure)


class OutsideAgent:
    """An agent whose process is outside, for one episode. ``stages`` are those of its last turn."""

    def __init__(
        self,
        fork_server: ForkServer,
        name: str,
        model: str = "rules",
        settings: AgentSettings = AgentSettings(),  # noqa: B008, frozen
        *,
        chat_model: ChatModel | None = None,
        step_s: float = STEP_S,
        episode_s: float = EPISODE_S,
    ) -> None:
        """Starts nothing before its channels are asked for.

        Args:
            name: for ``agents.make_agent``.
            settings: for an agent with a model or behind an address; others get none.
            chat_model: answers instead of that model.
            step_s: limit of the wall time that its process may take for one step."""
        self.name = name
        self.answer_s = 0.0
        """Wall seconds that its last answer took: its model's, or, without one, its own."""
        self.stages: tuple[Stage, ...] = ()
        self.failure: str | None = None
        """Why it cannot act any more."""
        self._fork_server = fork_server
        self._named = model
        self._model = chat_model or model_of(name, model, settings=settings)
        self.model = "none" if self._model is None else self._model.name
        self._settings = settings
        self._step_s = step_s
        self._step_left_s = step_s
        self._left_s = self._episode_s = episode_s
        self._replies: list[ModelReply] = []
        """What its model said in this turn."""
        self._wire: Wire | None = None
        self._process = 0
        self._folder: Path | None = None
        self._channels: frozenset[Channel] | None = None

    @property
    def channels(self) -> frozenset[Channel]:
        """The channels that it gets; none if it could not be made. The first time, this starts its process.

        Raises InfrastructureError: no process can be started."""
        if self._channels is None:
            self._channels = frozenset()
            self._start()
            with suppress(AgentError):
                self._channels = self._hello()
        return self._channels

    def reset(self, goal: str) -> None:
        """Passes on the driver's words; any error shows at the first turn."""
        _ = self.channels
        with suppress(AgentError):
            self._send("goal", goal)

    def act(self, observation: Observation) -> Action:
        """Its next action.

        Raises:
            ActionError: it raised, or its answer could not be read; the step still counts.
            OutOfBudgetError: it gives up, or its budget is spent.
            ModelError: this program's client could not reach the model.
            AgentError: its process has failed, ended or hung."""
        self.stages, self.answer_s, self._step_left_s = (), 0.0, self._step_s
        self._replies.clear()
        self._send("seen", observation)
        answer = self._answer()
        is_ours = self._model is not None or is_remote(self.name)  # whose stages are no guest's
        told = answer.get("stages", []) if is_ours else []
        self.stages = self._read(partial(self._stages, observation), told)
        if "spent" in answer:
            raise OutOfBudgetError(self._text(answer["spent"]))
        if "refused" in answer:
            raise ActionError(self._text(answer["refused"]))
        return self._read(parse, answer.get("action"))

    def close(self) -> None:
        """Ends its process and all that it has started, and removes its folder; may be called again."""
        self._end()
        if self._folder is not None:
            remove(self._folder)

    def _start(self) -> None:
        self._folder = Path(tempfile.mkdtemp(prefix="agent-"))
        request = AgentRequest(self.name, imports=str(Path.cwd()), folder=str(self._folder))
        if (model := self._model) is not None:
            request = replace(
                request,
                model=self._named,
                model_name=model.name,
                sees_pictures=model.sees_pictures,
                settings=self._settings,
            )
        elif is_remote(self.name):
            request = replace(request, settings=self._settings)
        self._wire, self._process = self._fork_server.start(request)

    def _hello(self) -> frozenset[Channel]:
        self._step_left_s = self._episode_s
        return self._read(lambda answer: frozenset(map(Channel, answer["channels"])), self._answer())

    def _answer(self) -> Json:
        """Its answer, after the model has answered all its questions."""
        while True:
            answer = self._received()
            if "failed" in answer:
                self._fail(self._text(answer["failed"]))
            if "ask" not in answer:
                return answer
            if self._model is None:
                self._fail("it asked a model, but has none")
            reply = self._model.chat(self._read(_messages, answer["ask"]))
            self.answer_s += reply.seconds
            self._replies.append(reply)
            self._send("reply", reply)

    def _stages(self, seen: Observation, told: list[Json]) -> tuple[Stage, ...]:
        """What it tells of its turn. What its model said and cost is known here, and told by nobody else."""
        stages = _stages(told)
        if self._model is None:
            return stages
        given = iter(self._replies)
        own = [each if each.reply is None else replace(each, reply=next(given, None)) for each in stages]
        return (*own, *(Stage(StageName.INTERPRET, each.text, seen.time_s, each) for each in given))

    def _received(self) -> Json:
        if self._wire is None:
            raise AgentError(self.failure or "its process has ended")
        try:
            with self._timed() as left_s:
                return self._wire.receive_json(left_s)
        except GoneError:
            self._fail(self._end(GRACE_S) or "its process closed its connection")
        except TimeoutError:
            self._too_slow()
        except ValueError as error:
            self._fail(f"it sent something that is not an answer: {error}")

    def _send(self, kind: str, value: object) -> None:
        if self._wire is None:
            raise AgentError(self.failure or "its process has ended")
        message = packed((kind, value))
        try:
            with self._timed() as left_s:
                self._wire.send(message, left_s)
        except GoneError:
            pass  # what it sent before it ended can still be read
        except TimeoutError:
            self._too_slow()

    @contextmanager
    def _timed(self) -> Iterator[float]:
        """What its process has left of its time, of which the block takes. It starts with the first byte that is
        sent to it: the rest may be read when it has thought."""
        began_s = time.monotonic()
        try:
            yield max(MOMENT_S, min(self._step_left_s, self._left_s))
        finally:
            took_s = time.monotonic() - began_s
            self._step_left_s -= took_s
            self._left_s -= took_s
            if self._model is None:
                self.answer_s += took_s

    def _text(self, told: Any) -> str:
        if not isinstance(told, str):
            self._fail("it sent something that is not an answer: no text in the place of one")
        return told[:LONGEST_REFUSAL]

    def _read(self, reads: Callable[[Any], T], told: Any) -> T:
        try:
            return reads(told)
        except (TypeError, ValueError, LookupError, AttributeError, ArithmeticError, RecursionError) as error:
            self._fail(f"it sent something that is not an answer: {error}")

    def _too_slow(self) -> NoReturn:
        if self._left_s <= self._step_left_s:
            self._fail(f"its process took over {self._episode_s:g} s in the whole episode")
        self._fail(f"its process took over {self._step_s:g} s for one step")

    def _fail(self, why: str) -> NoReturn:
        """Ends its process; it cannot act any more."""
        self.failure = "".join(c if c.isprintable() else " " for c in " ".join(why.split()))[:LONGEST_FAILURE]
        self._end()
        raise AgentError(self.failure)

    def _end(self, grace_s: float = 0.0) -> str:
        if self._wire is None:
            return ""
        self._wire.close()
        self._wire = None
        return self._fork_server.end(self._process, grace_s)


def _messages(told: list[Json]) -> list[ChatMessage]:
    return [
        ChatMessage(
            str(each["role"]),
            str(each["text"]),
            tuple(base64.b64decode(picture, validate=True) for picture in each["pictures"]),
            tuple(
                ToolCall(str(call["id"]), str(call["name"]), call["arguments"]) for call in each.get("calls", ())
            ),
            str(each.get("call_id", "")),
            form if isinstance(form := each.get("form"), dict) else None,
        )
        for each in told
    ]


def _stages(told: list[Json]) -> tuple[Stage, ...]:
    return tuple(
        Stage(
            StageName(each["stage"]),
            str(each["text"]),
            float(each["at_s"]),
            None if each["reply"] is None else ModelReply(**each["reply"]),
            str(each["asked"]),
            int(each["pictures"]),
        )
        for each in told
    )
