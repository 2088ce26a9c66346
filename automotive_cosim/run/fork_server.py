"""Starts and ends agents' processes; ``agents.process`` is the other side."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

from automotive_cosim.agents.cleanup import SWEEP_S, children, end_all, strangers, take_orphans, tree
from automotive_cosim.agents.process import AgentRequest
from automotive_cosim.agents.wire import GoneError, Wire
from automotive_cosim.errors import InfrastructureError

ANSWER_S = 300.0
"""Wall time in which a fork server has to answer. It starts in a second, or a minute on a crowded machine; one that
ends is noticed at once."""
END_S = SWEEP_S + 5.0
"""The same for the end of an agent's process, beyond the time that this is given: an agent may have stopped it."""
WITHHELD = ("AUTOMOTIVE_COSIM_", "RAY_")
WITHHELD_NAMES = frozenset({"PWD", "OLDPWD", "_", "PYTHONSTARTUP", "PYTHONINSPECT"})
"""Environment variables that an agent's process does not get: they tell what was started, and where."""


class ForkServer:
    """Agents' processes. A worker has one fork server; closing it ends them all."""

    def __init__(self) -> None:
        self._popen: subprocess.Popen[bytes] | None = None
        self._wire: Wire | None = None
        self._known: frozenset[int] = frozenset()
        """This process's children before the fork server was started."""

    def start(self, request: AgentRequest) -> tuple[Wire, int]:
        """Starts an agent's process; returns the connection to it, and its id.

        Raises InfrastructureError: that did not work, twice."""
        for _ in range(2):  # the first fork server may have been killed since the last episode
            with suppress(GoneError, TimeoutError, ValueError):
                return self._forked(request)
            self.close()
        raise InfrastructureError("no process can be started for the agent; rerun the command to resume")

    def end(self, agent: int, grace_s: float = 0.0) -> str:
        """Ends an agent's process and all that it has started; returns how it ended, if by itself."""
        if self._wire is not None:
            try:
                self._wire.send_object(("end", agent, grace_s), END_S)
                return str(self._wire.receive_json(grace_s + END_S).get("ended", ""))
            except (GoneError, TimeoutError, ValueError):
                pass
        self.close()
        return ""

    def close(self) -> None:
        if self._wire is None or self._popen is None:
            return
        for pid in tree(self._popen.pid):
            with suppress(ProcessLookupError, PermissionError):
                os.kill(pid, signal.SIGKILL)
        self._popen.wait()
        self._wire.close()
        self._wire = self._popen = None
        end_all(lambda: strangers(self._known))  # orphans of an agent that has ended the fork server

    def _forked(self, request: AgentRequest) -> tuple[Wire, int]:
        if self._wire is None:
            take_orphans()
            self._known = frozenset(children())
            self._wire, self._popen = _started()
        self._wire.send_object(("start", request), ANSWER_S)
        ours, theirs = socket.socketpair()
        with theirs:
            self._wire.send_socket(theirs)
        agent = Wire(ours)
        try:
            return agent, int(self._wire.receive_json(ANSWER_S)["pid"])
        except BaseException:
            agent.close()
            raise


def _started() -> tuple[Wire, subprocess.Popen[bytes]]:
    """Starts a fork server; returns the connection to it."""
    environment = {
        name: value
        for name, value in os.environ.items()
        if name not in WITHHELD_NAMES and not name.startswith(WITHHELD)
    }
    environment["PYTHONPATH"] = os.pathsep.join(str(Path(entry).absolute()) for entry in sys.path)
    environment.setdefault("OPENBLAS_NUM_THREADS", "1")  # numpy would start threads, and forks have one
    ours, theirs = socket.socketpair()
    command = [sys.executable, "-P", "-m", "automotive_cosim.agents.process", str(theirs.fileno())]
    nowhere = subprocess.DEVNULL
    with theirs:
        popen = subprocess.Popen(
            command,
            stdin=nowhere,
            stdout=nowhere,
            stderr=nowhere,
            env=environment,
            cwd="/",
            pass_fds=[theirs.fileno()],
            start_new_session=True,
        )
    return Wire(ours), popen
