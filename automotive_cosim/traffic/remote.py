"""Starts, calls, copies and ends a simulation's process, from the program that uses it."""

from __future__ import annotations

import fcntl
import os
import signal
import socket
import subprocess
import sys
import tempfile
import weakref
from collections.abc import Mapping
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from automotive_cosim.contracts import RoadNetwork
from automotive_cosim.errors import CosimError, TrafficError
from automotive_cosim.traffic.base import WarmUpProgress
from automotive_cosim.traffic.channel import LOADING_LIMIT_S, ClosedError, MessageChannel
from automotive_cosim.traffic.network import known_network
from automotive_cosim.traffic.options import SCRATCH, Setup
from automotive_cosim.traffic.processor_time import processor_s

TIMEOUT_S = 20.0
"""Processor time without a sign of life after which a simulation counts as hung; it gives one every second of the
wall. One that gets no processor time at all for as long counts as hung, too."""

ALARM_MARGIN_S = 25.0
"""The simulation's own alarm comes this much later, in case nobody is left to end it."""

CLOSING_LIMIT_S = 2.0

DROPPED_VARIABLES = ("SUMO_HOME", "PROJ_DATA", "PROJ_LIB", "LIBSUMO_AS_TRACI", "PYTHONSTARTUP", "PYTHONINSPECT")
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
"""A process with one thread can be forked safely; numpy's libraries would start more."""


LARGE_PAGES = {"GLIBC_TUNABLES": "glibc.malloc.hugetlb=1:glibc.malloc.trim_threshold=1073741824"}
"""Memory in pages of 2 MB where Linux has them: a fork copies the table of pages, not the pages, so it takes half
as long, and what a copy then writes to is still copied in pages of 4 kB. What SUMO frees while it loads is kept for
what it needs next: given back and taken again, such pages are cleared each time."""


class _Complaints:
    """The standard error of a simulation's process and its children, in an unnamed file."""

    def __init__(self) -> None:
        with tempfile.TemporaryFile() as file:
            self.descriptor = os.dup(file.fileno())
        weakref.finalize(self, os.close, self.descriptor)

    def last(self) -> str:
        """The end of it, on one line."""
        size = os.fstat(self.descriptor).st_size
        os.lseek(self.descriptor, max(0, size - 2000), os.SEEK_SET)
        return " ".join(os.read(self.descriptor, 2000).decode("utf-8", "replace").split())


@dataclass(slots=True)
class _Silence:
    """A wait for a process's next sign of life. On a crowded machine, a second of its work may take a minute."""

    pid: int
    limit_s: float
    """Processor time that it may use meanwhile."""
    _began_s: float | None = None
    _used_s: float | None = None
    """Processor time at the first look, and at the last."""

    def may_last(self) -> bool:
        """Asked every ``limit_s`` of wall time: whether it has worked since, and not too long."""
        before_s, self._used_s = self._used_s, processor_s(self.pid)
        if self._used_s is None:
            return False
        if before_s is None or self._began_s is None:
            self._began_s = self._used_s
            return True
        return before_s < self._used_s < self._began_s + self.limit_s


class Baton:
    """What one of several copies of a process has at a time; the kernel takes it from one that has died."""

    def __init__(self) -> None:
        with tempfile.TemporaryFile() as file:
            self._file = os.dup(file.fileno())
        weakref.finalize(self, os.close, self._file)

    def __enter__(self) -> None:
        fcntl.lockf(self._file, fcntl.LOCK_EX)

    def __exit__(self, *error: object) -> None:
        fcntl.lockf(self._file, fcntl.LOCK_UN)


class RemoteProcess:
    """A handle of a simulation's process."""

    def __init__(self, channel: MessageChannel, complaints: _Complaints, timeout_s: float, pid: int = 0) -> None:
        self._channel = channel
        self._complaints = complaints
        self._timeout_s = timeout_s
        self._broken = ""
        self._popen: subprocess.Popen[bytes] | None = None
        self.baton: AbstractContextManager[None] = nullcontext()
        """What a call is made in."""
        self.pid = pid
        self.kept_as = 0
        """By which name the keeper knows of what it is a copy; 0 without one."""
        self._end: weakref.finalize[..., RemoteProcess] = weakref.finalize(self, channel.close)
        """Finalizer; even without it, a process ends when its connection is gone."""

    @classmethod
    def start(
        cls, setup: Setup, progress: WarmUpProgress | None, timeout_s: float
    ) -> tuple[RemoteProcess, RoadNetwork]:
        """Starts a process that loads and warms up; returns it with the network.

        Raises:
            ScenarioError: the scenario cannot be loaded.
            SetupError: libsumo is missing or unsuitable.
            TrafficError: the process died or hung.
        """
        ours, theirs = socket.socketpair()
        process = cls(MessageChannel(ours), _Complaints(), timeout_s)
        with theirs:
            popen = _popen(theirs, process._complaints.descriptor, timeout_s + ALARM_MARGIN_S)
        process._popen, process.pid = popen, popen.pid
        process._end.detach()
        process._end = weakref.finalize(process, _end, process._channel, popen)
        try:
            with tempfile.TemporaryDirectory(prefix=SCRATCH, ignore_cleanup_errors=True) as scratch:
                known, known_map = known_network(setup.scenario.config)
                words = (setup, Path(scratch), known)
                loaded = process.call("load", *words, progress=progress, timeout_s=LOADING_LIMIT_S)
                network = loaded or known_map
                assert network is not None
        except TrafficError as error:
            process.close()
            raise TrafficError(f"{error}; it was loading or warming up {setup.scenario.config}") from None
        except BaseException:
            process.close()
            raise
        return process, network

    def fork(self, outputs: Path | None) -> RemoteProcess:
        """An exact copy of the process, with a connection of its own and a folder of its own for SUMO's outputs.

        Raises:
            TrafficError: the process or its copy died or hung.
        """
        ours, theirs = socket.socketpair()
        child = RemoteProcess(MessageChannel(ours), self._complaints, self._timeout_s)
        try:
            with theirs:
                child.pid = self.call("fork", outputs, hand_over=theirs)
            child.receive()
        except BaseException:
            child.close()
            raise
        return child

    @property
    def is_broken(self) -> bool:
        """Whether it died, hung or was interrupted, so every further call fails."""
        return bool(self._broken) or (self._popen is not None and self._popen.poll() is not None)

    def call(
        self,
        name: str,
        *arguments: object,
        progress: WarmUpProgress | None = None,
        timeout_s: float | None = None,
        hand_over: socket.socket | None = None,
    ) -> Any:
        """Calls a method of ``process.Server``.

        Raises:
            TrafficError: it died or hung; otherwise whatever the method raised.
        """
        with self.baton:
            self.send(name, *arguments, hand_over=hand_over)
            return self.receive(progress, timeout_s)

    def send(self, name: str, *arguments: object, hand_over: socket.socket | None = None) -> None:
        """Starts a call whose answer ``receive`` waits for.

        Raises:
            TrafficError: it died.
        """
        if self._broken:
            raise TrafficError(self._broken)
        try:
            self._channel.send((name, arguments))
            if hand_over is not None:
                self._channel.send_socket(hand_over)
        except ClosedError:
            self._give_up(self._death())

    def receive(self, progress: WarmUpProgress | None = None, timeout_s: float | None = None) -> Any:
        """Waits for an answer; raises like ``call``."""
        silence = _Silence(self.pid, max(self._timeout_s, timeout_s or 0.0))
        try:
            outcome, value = self._channel.receive(silence.limit_s, silence.may_last)
            while outcome in ("beat", "progress"):
                if outcome == "progress" and progress is not None:
                    progress(*value)
                silence = _Silence(self.pid, self._timeout_s)
                outcome, value = self._channel.receive(silence.limit_s, silence.may_last)
        except ClosedError:
            self._give_up(self._death())
        except TimeoutError:
            self._give_up(
                f"the simulation (process {self.pid}) hung: no sign of life for {silence.limit_s:g} s; it was ended"
            )
        except BaseException:
            self.kill()
            self._broken = "the simulation was interrupted"
            raise
        if outcome == "error":
            kind: type[CosimError]
            kind, text = value
            raise kind.__new__(kind, text)  # the text is whole already
        return value

    @classmethod
    def taken(cls, channel: MessageChannel, pid: int, timeout_s: float) -> RemoteProcess:
        """A process that somebody else hands over through a channel."""
        return cls(MessageChannel(channel.receive_socket()), _Complaints(), timeout_s, pid)

    def given_up(self) -> tuple[MessageChannel, _Complaints, float, int]:
        """What another handle of a process that was not started here is made of; this one is of none."""
        self._end.detach()
        return self._channel, self._complaints, self._timeout_s, self.pid

    def hand_over(self, channel: MessageChannel) -> None:
        """Hands it to whoever is on the other side of a channel; it is no longer this process's."""
        channel.send_socket(self._channel)
        self._channel.close()

    @property
    def memory_bytes(self) -> int:
        """Memory of the process; 0 if the platform does not say, or it has died."""
        try:
            pages = Path(f"/proc/{self.pid}/statm").read_text(encoding="ascii").split()[1]
        except OSError:
            return 0
        return int(pages) * os.sysconf("SC_PAGE_SIZE")

    @property
    def own_bytes(self) -> int:
        """Memory that it does not share, as a copy shares most; 0 if the platform does not say, or it has died."""
        try:
            lines = Path(f"/proc/{self.pid}/smaps_rollup").read_text(encoding="ascii").splitlines()
        except OSError:
            return 0
        return 1024 * sum(int(line.split()[1]) for line in lines if line.startswith("Private_"))

    def close(self) -> None:
        """Ends the process and waits for it; may be called again."""
        if not self._broken:
            self._broken = "the simulation is closed"
            self._channel.hang_up()
            try:
                while True:
                    self._channel.receive(CLOSING_LIMIT_S)
            except ClosedError:
                pass
            except TimeoutError:
                self.kill()
        self._end()

    def _give_up(self, why: str) -> NoReturn:
        self.kill()
        self._broken = why
        raise TrafficError(why) from None

    def kill(self) -> None:
        """Ends the process at once."""
        if self._popen is not None:
            self._popen.kill()
        elif self.pid:
            with suppress(ProcessLookupError):
                os.kill(self.pid, signal.SIGKILL)

    def _death(self) -> str:
        """How the process ended, as far as can be seen from outside."""
        cause = "killed, perhaps for lack of memory"
        if self._popen is not None:
            with suppress(subprocess.TimeoutExpired):
                code = self._popen.wait(CLOSING_LIMIT_S)
                cause = f"by {signal.Signals(-code).name}" if code < 0 else f"with exit code {code}"
        said = self._complaints.last()
        return f"the simulation (process {self.pid}) died: {cause}" + (f"; it said: {said}" if said else "")


def _end(channel: MessageChannel, popen: subprocess.Popen[bytes]) -> None:
    """Ends a process that we started, and waits for it."""
    channel.close()
    try:
        popen.wait(CLOSING_LIMIT_S)
    except subprocess.TimeoutExpired:
        popen.kill()
        popen.wait()


def environment(given: Mapping[str, str]) -> dict[str, str]:
    """The variables that a simulation's process gets, from some."""
    kept = {name: value for name, value in given.items() if name not in DROPPED_VARIABLES}
    path = os.pathsep.join(str(Path(entry).absolute()) for entry in sys.path)
    return LARGE_PAGES | kept | ONE_THREAD | {"PYTHONPATH": path}


def _popen(connection: socket.socket, complaints: int, alarm_s: float) -> subprocess.Popen[bytes]:
    """Starts ``process`` with one end of the connection and a controlled environment."""
    command = [
        sys.executable,
        "-P",
        "-m",
        "automotive_cosim.traffic.process",
        str(connection.fileno()),
        str(alarm_s),
    ]
    return subprocess.Popen(
        command,
        env=environment(os.environ),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=complaints,
        pass_fds=[connection.fileno()],
    )
