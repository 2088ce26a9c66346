"""The processes in which an evaluation's agents live: ``python -m automotive_cosim.agents.process DESCRIPTOR``.

One process per worker, the *fork server*, imports this package and nothing of an agent's, and knows nothing of any
episode. For each episode, and each car of a fleet, it forks a process, which makes one agent, is told what the
driver says and what there is to see, and answers with actions. ``run.fork_server`` and ``run.outside`` are the
other side.

    worker ------------ fork server                 ("start", request), ("end", pid, grace)   pickled
      |                    | forks
      '---------------- agent's process             ("goal", words), ("seen", observation), ("reply", reply)
                                                    -> channels, action, refused, spent, ask, failed      JSON

What an agent asks its model goes to the worker, which asks the model: only what the worker's own client reports is
a model's error.

The process has a session and an empty working folder of its own and no open file but the connection; what it starts
ends with it.
"""

from __future__ import annotations

import base64
import gc
import os
import signal
import socket
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import NoReturn

import numpy as np

from automotive_cosim.agents import Agent, AgentSettings, Thinker, make_agent
from automotive_cosim.agents.cleanup import (
    POLL_S,
    children,
    end_all,
    end_with_parent,
    how_it_ended,
    remove,
    take_orphans,
)
from automotive_cosim.agents.wire import GoneError, Wire
from automotive_cosim.cockpit.actions import to_json
from automotive_cosim.contracts import Json, Observation
from automotive_cosim.errors import ActionError, CosimError, OutOfBudgetError
from automotive_cosim.models import ChatMessage, ModelReply


@dataclass(frozen=True, slots=True)
class AgentRequest:
    """Which agent to make, and where it lives."""

    name: str
    """For ``make_agent``."""
    imports: str
    """Folder where its module may be, before the others."""
    folder: str
    """Its working folder."""
    model: str = ""
    """For ``make_agent``; empty without a model."""
    model_name: str = ""
    """The name that the model has for itself."""
    sees_pictures: bool = False
    """Whether the model does."""
    settings: AgentSettings = field(default_factory=AgentSettings)


class _AskedModel:
    """The worker's model, asked over the wire. It has no errors here: one ends the episode on the other side."""

    def __init__(self, name: str, sees_pictures: bool, wire: Wire) -> None:
        self.name = name
        self.sees_pictures = sees_pictures
        self._wire = wire

    def chat(self, messages: Sequence[ChatMessage]) -> ModelReply:
        self._wire.send_json({"ask": [_message(message) for message in messages]})
        kind, reply = self._wire.receive_object()
        assert kind == "reply"
        assert isinstance(reply, ModelReply)
        return reply


class _AgentServer:
    """Starts and ends the agents' processes."""

    def __init__(self, wire: Wire) -> None:
        """Takes over the connection to the worker."""
        self._wire = wire
        self._folders: dict[int, str] = {}
        """Working folders of the agents that live, by their processes."""

    def run(self) -> None:
        take_orphans()  # of an agent, which end here
        try:
            while True:
                kind, *arguments = self._wire.receive_object()
                if kind == "start":
                    self._wire.send_json({"pid": self._start(*arguments)})
                else:
                    self._wire.send_json({"ended": self._end(*arguments)})
        except GoneError:
            for agent, folder in [*self._folders.items()]:
                self._end(agent)
                remove(Path(folder))  # the worker was killed, and removes it no more

    def _start(self, request: AgentRequest) -> int:
        connection = self._wire.receive_socket()
        fork_server = os.getpid()
        agent = os.fork()
        if not agent:
            self._wire.close()
            os.setsid()
            end_with_parent()
            if os.getppid() != fork_server:  # it ended before this one could be told
                os._exit(1)
            with suppress(OSError):  # should memory run out, this goes first, and not the traffic or the worker
                Path("/proc/self/oom_score_adj").write_text("500")
            np.random.seed()  # noqa: NPY002  # which no fork does by itself
            live(Wire(connection), request)
        connection.close()
        self._folders[agent] = request.folder
        return agent

    def _end(self, agent: int, grace_s: float = 0.0) -> str:
        """Ends an agent's process and all that it has started.

        Orphans do not tell whose they were: while others live, those of an agent are let be that are not of its
        session.

        Args:
            agent: its process.
            grace_s: time in which it may still end by itself.

        Returns:
            How it ended by itself; empty if it did not."""
        if self._folders.pop(agent, None) is None:
            return ""
        how, end_s = "", time.monotonic() + grace_s
        while not how and time.monotonic() < end_s:
            ended, status = os.waitpid(agent, os.WNOHANG)
            how = how_it_ended(os.waitstatus_to_exitcode(status)) if ended else ""
            time.sleep(0.0 if ended else POLL_S)
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(agent, signal.SIGKILL)
        end_all(lambda: self._left_by(agent))
        return how

    def _left_by(self, agent: int) -> list[int]:
        """The children of this process that are of an agent that ends: it, its orphans, and theirs."""
        others = self._folders
        return [
            pid
            for pid in children() or [agent]
            if pid == agent or (pid not in others and (not others or _session(pid) == agent))
        ]


def live(wire: Wire, request: AgentRequest) -> NoReturn:
    """Is the agent's process until the worker is gone or the agent has failed; never returns."""
    try:
        try:
            os.chdir(request.folder)
            sys.path.insert(0, request.imports)
            agent = _made(wire, request)
            wire.send_json({"channels": sorted(agent.channels)})
            while True:
                kind, value = wire.receive_object()
                if kind == "goal":
                    agent.reset(value)
                else:
                    wire.send_json(_turn(agent, value))
        except GoneError:
            pass
        except BaseException as error:  # even KeyboardInterrupt: whatever it raises is its own
            wire.send_json({"failed": str(error) if isinstance(error, CosimError) else _told(error)})
    finally:
        os._exit(0)  # without what the agent registered for its exit


def _made(wire: Wire, request: AgentRequest) -> Agent:
    if not request.model:
        return make_agent(request.name, settings=request.settings)
    asked = _AskedModel(request.model_name, request.sees_pictures, wire)
    return make_agent(request.name, request.model, request.settings, asked)


def _turn(agent: Agent, seen: Observation) -> Json:
    """The answer to an observation."""
    answer: Json
    try:
        answer = {"action": to_json(agent.act(seen))}
    except ActionError as error:
        answer = {"refused": str(error)}
    except OutOfBudgetError as error:
        answer = {"spent": str(error)}
    stages = agent.stages if isinstance(agent, Thinker) else ()
    return answer | {"stages": [stage.as_json() for stage in stages]}


def _message(message: ChatMessage) -> Json:
    pictures = [base64.b64encode(picture).decode("ascii") for picture in message.pictures]
    told: Json = {"role": message.role, "text": message.text, "pictures": pictures}
    if message.calls:
        told["calls"] = [asdict(call) for call in message.calls]
    told |= {"call_id": message.call_id} if message.call_id else {}
    return told | ({} if message.form is None else {"form": message.form})


def _session(pid: int) -> int | None:
    """The session of a process; None once it has ended."""
    try:
        return os.getsid(pid)
    except ProcessLookupError:
        return None


def _told(error: BaseException) -> str:
    return f"it raised {type(error).__name__}: {error}"


def main() -> None:
    """Serves the connection whose descriptor is the first argument."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    connection = socket.socket(fileno=int(sys.argv[1]))
    gc.collect()
    gc.freeze()  # collecting garbage would copy every page that the agents' processes share
    _AgentServer(Wire(connection)).run()
    os._exit(0)


if __name__ == "__main__":
    main()
