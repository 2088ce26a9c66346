"""What the workers of evaluations are forked from in tests: it has imported all that they import, their traffic
comes from where the tests' comes from, and each has an agents' process at once, forked before it knows of any job.

``multiprocessing`` imports this in the process that it forks them from. A test without ``preloaded.ADDRESS`` in its
environment has workers that start everything themselves.
"""

import os
import signal
import socket
import sys
from collections.abc import Mapping
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any

import automotive_cosim.drives.families
import automotive_cosim.proof.prover
import automotive_cosim.publish.verify  # noqa: F401, like the others for the workers
from automotive_cosim.agents import process
from automotive_cosim.agents.wire import Wire
from automotive_cosim.run import fork_server, processes, worker
from automotive_cosim.tasking.own_files import VARIABLE
from automotive_cosim.tasks import CATALOGUE
from tests import farm, preloaded

with suppress(ModuleNotFoundError):  # the studies may not be installed
    import_module("automotive_cosim.studies.reroute.batch")

_spare: list[Any] = []
len(CATALOGUE)  # reads it, for all workers
_started = fork_server._started


class _Child:
    """As much of ``subprocess.Popen`` as ``ForkServer`` uses."""

    def __init__(self, pid: int) -> None:
        self.pid = pid

    def wait(self) -> None:
        with suppress(ChildProcessError):
            os.waitpid(self.pid, 0)


class _ForkServer(fork_server.ForkServer):
    def __init__(self) -> None:
        super().__init__()
        if preloaded.ADDRESS in os.environ:
            ours, theirs = socket.socketpair()
            child = os.fork()
            if not child:
                _serve_agents(theirs)
            theirs.close()
            _spare.append((Wire(ours), _Child(child)))


def _serve_agents(connection: socket.socket) -> None:
    os.setsid()
    os.chdir("/")
    for stream in range(3):
        os.dup2(os.open(os.devnull, os.O_RDWR), stream)
    number = os.dup2(connection.detach(), 3)
    os.closerange(4, 1024)
    for name in [*os.environ]:
        if name in fork_server.WITHHELD_NAMES or name.startswith(fork_server.WITHHELD):
            del os.environ[name]
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    sys.argv[1:] = [str(number)]
    process.main()


_work = processes._work


def _work_with_own_tasks(jobs: Any, opener: Any, folder: Path, environment: Mapping[str, str]) -> None:
    if environment.get(VARIABLE):
        CATALOGUE.add_folder(Path(environment[VARIABLE]))
    _work(jobs, opener, folder, environment)


farm.use()
processes._work = _work_with_own_tasks
fork_server._started = lambda: _spare.pop() if _spare else _started()
worker.ForkServer = _ForkServer  # type: ignore[misc]
