"""Warm traffic of the shipped scenarios, once for all workers of a test run: each gets exact copies by fork."""

import os
import socket
import tempfile
import threading
from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from automotive_cosim.contracts import RoadNetwork
from automotive_cosim.errors import CosimError
from automotive_cosim.sumo_scenarios.build import ROOT
from automotive_cosim.traffic import remote
from automotive_cosim.traffic.base import WarmUpProgress
from automotive_cosim.traffic.channel import ClosedError, MessageChannel
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.options import Setup
from automotive_cosim.traffic.remote import RemoteProcess, _Complaints
from tests import preloaded

ADDRESS = "AUTOMOTIVE_COSIM_TEST_FARM"
"""Names the socket to the children of the process that has the farm."""
NO_LIBSUMO = str(Path(__file__).parent / "no_libsumo")
"""What the children of a test that must not start SUMO find in the place of libsumo."""


class Farm:
    """The warm simulations, in the process that hands tests to workers."""

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="farm-")
        os.environ[ADDRESS] = str(Path(self._folder.name, "socket"))
        self._kept: dict[Setup, Forked] = {}
        self._locks: defaultdict[Setup, threading.Lock] = defaultdict(threading.Lock)
        self._listening = socket.socket(socket.AF_UNIX)
        self._listening.bind(os.environ[ADDRESS])
        self._listening.listen()
        threading.Thread(target=self._listen, daemon=True).start()

    def close(self) -> None:
        """Ends all simulations; copies live on."""
        self._listening.close()
        for each in self._kept.values():
            each.close()
        self._folder.cleanup()

    def _listen(self) -> None:
        with suppress(OSError):  # closed
            while True:
                theirs, _ = self._listening.accept()
                threading.Thread(target=self._answer, args=(theirs,), daemon=True).start()

    def _answer(self, theirs: socket.socket) -> None:
        with theirs, suppress(ClosedError):
            channel = MessageChannel(theirs)
            setup: Setup = channel.receive()
            with self._locks[setup]:
                try:
                    if setup not in self._kept:
                        self._kept[setup] = Forked(setup.scenario, setup.seed)
                    source = self._kept[setup]._source
                    copy = source._copied()
                except CosimError as error:
                    channel.send(error)
                    return
            channel.send((copy.pid, source.network))
            with copy._channel._socket as connection:
                channel.send_socket(connection)


def has(setup: Setup) -> bool:
    """Whether it is traffic that many tests want."""
    is_shipped = setup.scenario.folder.resolve().is_relative_to(ROOT.resolve())
    return is_shipped and setup == Setup(setup.scenario, setup.seed)


def copied(setup: Setup, progress: WarmUpProgress | None, timeout_s: float) -> tuple[RemoteProcess, RoadNetwork]:
    """What ``RemoteProcess.start`` does, by a copy from the farm. Raises CosimError: as it does."""
    with socket.socket(socket.AF_UNIX) as farm:
        farm.connect(os.environ[ADDRESS])
        channel = MessageChannel(farm)
        channel.send(setup)
        answer = channel.receive()
        if isinstance(answer, CosimError):
            raise answer
        process = RemoteProcess(MessageChannel(channel.receive_socket()), _Complaints(), timeout_s)
    process.pid, network = answer
    if progress is not None:
        progress(setup.scenario.sumo.warm_up_s, setup.scenario.sumo.warm_up_s)
    return process, network


_start, _popen = RemoteProcess.start, remote._popen


def _started(setup: Setup, progress: WarmUpProgress | None, timeout_s: float) -> Any:
    return (copied if ADDRESS in os.environ and has(setup) else _start)(setup, progress, timeout_s)


def use(set_: Callable[[object, str, Any], None] = setattr) -> None:
    """Lets simulations come from the farm or, if it has no such, from the process that has imported everything; but
    not for what must not start SUMO, or must start it as programs do."""

    def is_used() -> bool:
        return preloaded.ADDRESS in os.environ and NO_LIBSUMO not in os.environ.get("PYTHONPATH", "")

    def popen(*given: Any) -> Any:
        return (preloaded.popen if is_used() else _popen)(*given)

    def start(*given: Any) -> Any:
        return (_started if is_used() else _start)(*given)

    set_(remote, "_popen", popen)
    set_(RemoteProcess, "start", staticmethod(start))
