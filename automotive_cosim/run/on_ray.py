"""Runs jobs in actors of a Ray cluster, each with its own CPU; the only module that imports Ray.

No shared file system is needed: an actor runs a job in its own folder and sends back the row and the files, which
the driver writes. docs/reference/cluster.md says what has to be installed where.
"""

from __future__ import annotations

import logging
import os
import socket
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, Generic

from automotive_cosim.contracts import Json
from automotive_cosim.errors import InfrastructureError, SetupError, UserError, install_hint
from automotive_cosim.run.budget import Meter, MeterHandle, Spent
from automotive_cosim.run.executor import CannotWrite, J, JobPhase, LostError, Opener, R, Runner
from automotive_cosim.run.settings import Budget
from automotive_cosim.run.store import keep_files, stamp
from automotive_cosim.tasking.own_files import VARIABLE

# Read when Ray is imported or started: no usage statistics, and no printing into our output.
os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
os.environ.setdefault("RAY_DEDUP_LOGS_SKIP_REGEX", "^")
try:
    import ray
    from ray.exceptions import RayActorError, RayError, RayTaskError, RuntimeEnvSetupError
    from ray.util.scheduling_strategies import NodeAffinitySchedulingStrategy
except ImportError as error:
    raise SetupError(f"the ray package is missing; install it with `{install_hint('cluster')}`") from error

OBJECT_STORE_BYTES = 256 * 1024**2
"""Shared memory of our own cluster: the files of an episode and its screenshots take a few megabytes."""
PROBE_S = 10.0
"""Wall time in which the head node has to accept a connection."""
NEVER_SENT = (".git", ".venv", "__pycache__", "runs")
"""Patterns that are left out of a folder sent to the workers."""


class OnRay:
    """A Ray cluster; while it is entered, this process is its driver."""

    def __init__(self, address: str | None = None, workers: int | None = None, sent: Path | None = None) -> None:
        """Nothing is started or connected before it is entered.

        Args:
            address: of a running cluster, e.g. ``10.0.0.4:6379``; by default, a new one on this machine.
            workers: number of actors; None uses all the CPUs that the cluster has at the moment.
            sent: a folder of which every worker gets a copy to run in."""
        self._address = address or "local"
        self._workers = workers
        self._sent = sent

    def __enter__(self) -> OnRay:
        """Connects.

        Raises:
            SetupError: there is no such cluster, or it runs another version of Python or Ray.
            UserError: the folder to send does not exist."""
        if self._sent is not None and not self._sent.is_dir():
            raise UserError(f"{self._sent} is not a folder; give one to copy to the workers")
        _probe(self._address)
        own: Mapping[str, Any] = {}
        if self._address == "local":
            own = {
                "num_cpus": self._workers or os.cpu_count(),
                "include_dashboard": False,
                "object_store_memory": OBJECT_STORE_BYTES,
            }
        try:
            ray.init(
                self._address,
                runtime_env=self._environment(),
                log_to_driver=False,
                logging_level=logging.ERROR,
                **own,
            )
        except (RayError, ConnectionError, RuntimeError, ValueError) as error:
            why = " ".join(str(error).split())
            raise SetupError(
                f"cannot use a Ray cluster at {self._address}: {why}; start one with `ray start --head`, or omit "
                "the address"
            ) from error
        return self

    def __exit__(self, *error: object) -> None:
        """Disconnects from the cluster, and ends it if it is our own."""
        ray.shutdown()

    @property
    def count(self) -> int:
        """As many as requested, else one per CPU, so that nodes that join later get workers too."""
        return self._workers or max(1, int(ray.cluster_resources().get("CPU", 0)))

    @contextmanager
    def metered(self, budget: Budget, before: Spent) -> Iterator[MeterHandle]:
        """See ``Executor.metered``; the meter is an actor on this node, without a CPU of its own."""
        here = NodeAffinitySchedulingStrategy(ray.get_runtime_context().get_node_id(), soft=True)
        yield _RayMeter(_METER.options(scheduling_strategy=here).remote(budget, before))

    def start(self, opener: Opener[J, R], folder: Path) -> _Actor[J, R]:
        """See ``Executor.start``; the worker becomes ready when a node has a free CPU."""
        return _Actor(opener, folder)

    def wait(self, handles: Sequence[Any], timeout_s: float) -> Sequence[Any]:
        ready: Sequence[Any]
        ready, _ = ray.wait(list(handles), num_returns=1, timeout=timeout_s, fetch_local=False)
        return ready

    def _environment(self) -> Json:
        """The environment that Ray sets up for every worker."""
        tasks = os.environ.get(VARIABLE)
        if self._sent is None:
            return {"env_vars": {VARIABLE: tasks}} if tasks else {}
        sent = self._sent.resolve()
        made: Json = {"working_dir": str(sent), "excludes": list(NEVER_SENT)}
        if tasks:
            # A relative path refers to the worker's own copy.
            inside = Path(tasks).is_relative_to(sent)
            made["env_vars"] = {VARIABLE: Path(tasks).relative_to(sent).as_posix() if inside else tasks}
        return made


class _RayMeter:
    """The meter, as driver and workers ask it."""

    def __init__(self, actor: Any) -> None:
        self._actor = actor

    def wait_s(self, model: str, per_minute: float) -> float:
        return float(_asked(self._actor.wait_s.remote(model, per_minute)))

    def spend(self, tokens: int, usd: float) -> None:
        _asked(self._actor.spend.remote(tokens, usd))

    def spent(self) -> Spent:
        found: Spent = _asked(self._actor.spent.remote())
        return found

    def refusal(self) -> str:
        return str(_asked(self._actor.refusal.remote()))


def _asked(answer: Any) -> Any:
    try:
        return ray.get(answer)
    except RayError as error:
        raise InfrastructureError(
            f"the process that meters the budget has ended; rerun the command to resume: {_line(error)}"
        ) from error


class _Actor(Generic[J, R]):
    def __init__(self, opener: Opener[J, R], folder: Path) -> None:
        self._folder = folder
        self._actor = _ACTOR.remote(opener)
        self._asked = self._actor.stamp.remote()
        self.is_ready = False
        self.phase = JobPhase()  # an actor answers only when its job has ended

    @property
    def handles(self) -> Sequence[Any]:
        return (self._asked,)

    def give(self, job: J) -> None:
        self._asked = self._actor.run.remote(job)

    def answer(self) -> R | CannotWrite | None:
        try:
            answered = ray.get(self._asked)
        except RuntimeEnvSetupError as error:
            raise UserError(f"Ray cannot set up a worker: {_line(error)}") from error
        except RayTaskError as error:
            raise LostError(f"on its node: {_line(error.cause)}") from error
        except RayActorError as error:
            raise LostError(_line(error)) from error
        if not self.is_ready:
            _check_same(*answered)
            self.is_ready = True
            return None
        row: R = answered[0]
        try:
            keep_files(self._folder, answered[1])
        except OSError as error:
            return CannotWrite(error)
        return row

    def end(self, *, at_once: bool) -> None:
        ray.kill(self._actor)  # its simulations end with it


def _probe(address: str) -> None:
    """Refuses an address where nothing listens, which Ray would try for minutes.

    Raises SetupError: it cannot be reached."""
    if address in ("local", "auto"):
        return
    host, colon, port = address.rpartition(":")
    if not colon or not port.isdigit() or "/" in host:
        raise SetupError(
            f"{address!r} is not the address of a Ray cluster; give HOST:PORT of its head node, or auto"
        )
    try:
        socket.create_connection((host.strip("[]"), int(port)), PROBE_S).close()
    except (OSError, OverflowError) as error:
        raise SetupError(
            f"no Ray cluster answers at {address}: {error}; start one with `ray start --head`, or omit the address"
        ) from error


def _check_same(node: str, theirs: Json) -> None:
    """Refuses a node whose results would differ from ours. Raises UserError: it has other versions."""
    here, there = _compared(stamp()), _compared(theirs)
    for name in here.keys() & there.keys():  # a checkout here and a wheel there: only versions can be compared
        if here[name] != there[name]:
            raise UserError(
                f"node {node} has {name} {there[name]} and this machine {here[name]}; install the same on both"
            )


def _compared(stamp: Json) -> Json:
    commit = {} if stamp["git"] is None else {"commit": stamp["git"]["commit"]}
    return {**stamp["versions"], **commit}


def _line(error: BaseException) -> str:
    """The first line of a Ray error, without its pages of advice."""
    said = " ".join(str(error).split())
    return f"{type(error).__name__}: {said[:300]}"


# --- in the actor -----------------------------------------------------------------------------------------


class _Runs(Generic[J, R]):
    """Runs one job at a time."""

    def __init__(self, opener: Opener[J, R]) -> None:
        self._opener = opener
        self._open = ExitStack()
        self._runner: Runner[J, R] | None = None

    def stamp(self) -> tuple[str, Json]:
        """The node's address, and the versions installed on it."""
        return ray.util.get_node_ip_address(), stamp()

    def run(self, job: J) -> tuple[R, dict[str, bytes]]:
        """The row of a job, and the contents of its files by path."""
        if self._runner is None:
            self._runner = self._open.enter_context(self._opener())
        with tempfile.TemporaryDirectory(prefix="automotive-cosim-") as name:
            folder = Path(name)
            row = self._runner(job, folder)
            files = sorted(path for path in folder.rglob("*") if path.is_file())
            return row, {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


_ACTOR: Any = ray.remote(num_cpus=1, max_restarts=0, max_task_retries=0, scheduling_strategy="SPREAD")(_Runs)
_METER: Any = ray.remote(num_cpus=0, max_restarts=0)(Meter)
