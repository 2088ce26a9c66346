"""Simulations' processes forked from one that has imported everything, which takes half a second of a core.

SUMO is started hundreds of times by the tests. Those that are about the process start it as programs do.
"""

import atexit
import json
import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
from contextlib import suppress
from pathlib import Path

from automotive_cosim.traffic.channel import MessageChannel
from automotive_cosim.traffic.process import Server
from automotive_cosim.traffic.remote import DROPPED_VARIABLES, ONE_THREAD

POSSIBLE = hasattr(os, "pidfd_open") and hasattr(socket, "recv_fds")
ADDRESS = "AUTOMOTIVE_COSIM_TEST_PRELOADED"
"""Names its socket to the workers of evaluations, which use it too."""
MOST = 65_536


class Process:
    """As much of ``subprocess.Popen`` as ``RemoteProcess`` uses."""

    def __init__(self, pid: int) -> None:
        self.pid = pid
        self._handle = os.pidfd_open(pid)

    def __del__(self) -> None:
        os.close(self._handle)

    def poll(self) -> int | None:
        return 0 if select.select([self._handle], [], [], 0)[0] else None

    def wait(self, timeout: float | None = None) -> int:
        if not select.select([self._handle], [], [], timeout)[0]:
            raise subprocess.TimeoutExpired("a simulation", timeout or 0.0)
        return 0

    def kill(self) -> None:
        with suppress(ProcessLookupError):
            signal.pidfd_send_signal(self._handle, signal.SIGKILL)


class Preloaded:
    """The process that others are forked from, as seen from the tests."""

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="preloaded-")
        os.environ[ADDRESS] = str(Path(self._folder.name, "socket"))
        environment = {name: value for name, value in os.environ.items() if name not in DROPPED_VARIABLES}
        environment |= ONE_THREAD | {"PYTHONPATH": os.pathsep.join(map(os.path.abspath, sys.path))}
        with socket.socket(socket.AF_UNIX) as listening:
            listening.bind(os.environ[ADDRESS])
            listening.listen()
            self._process = subprocess.Popen(
                [sys.executable, "-P", __file__, str(listening.fileno())],
                env=environment,
                stdin=subprocess.PIPE,  # whose end ends it
                stdout=subprocess.DEVNULL,
                pass_fds=[listening.fileno()],
            )
        atexit.register(self.close)

    def close(self) -> None:
        self._process.communicate()
        self._folder.cleanup()


def popen(connection: socket.socket, complaints: int, alarm_s: float) -> Process:
    """What ``remote._popen`` does."""
    with socket.socket(socket.AF_UNIX) as asking:
        asking.connect(os.environ[ADDRESS])
        request = json.dumps([alarm_s, str(Path.cwd())]).encode()
        socket.send_fds(asking, [request], [connection.fileno(), complaints])
        return Process(int(asking.recv(MOST)))


def main() -> None:
    from automotive_cosim.traffic.sumo import load_library

    load_library()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    requests = socket.socket(fileno=int(sys.argv[1]))
    while requests in select.select([0, requests], [], [])[0]:
        asking, _ = requests.accept()
        request, descriptors, _, _ = socket.recv_fds(asking, MOST, 2)
        connection, complaints = descriptors
        child = os.fork()
        if not child:
            requests.close()
            asking.close()
            os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
            os.dup2(complaints, 2)
            os.close(complaints)
            alarm_s, folder = json.loads(request)
            os.chdir(folder)
            Server(MessageChannel(socket.socket(fileno=connection)), alarm_s).run()
            os._exit(0)
        for each in descriptors:
            os.close(each)
        with asking:
            asking.send(str(child).encode())


if __name__ == "__main__":
    main()
