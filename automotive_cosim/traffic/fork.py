"""Simulations in processes of their own: warmed up once, then an exact copy for every drive and branch.

A copy is a fork, which takes milliseconds however long the warm-up took. SUMO's files are reopened through
``/proc``, which only Linux has.
"""

from __future__ import annotations

import sys
import threading
from collections import Counter, OrderedDict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeVar

from automotive_cosim.contracts import (
    Answer,
    DrivingState,
    Reroute,
    RoadNetwork,
    RoadRequest,
    RoadShapes,
    RoadSnapshot,
    RouteOption,
)
from automotive_cosim.errors import NO_FORK, SetupError, TrafficError
from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.formats.writing import make_folder
from automotive_cosim.traffic.base import Advance, EgoPlan, WarmUpProgress
from automotive_cosim.traffic.keeper import started
from automotive_cosim.traffic.options import Setup
from automotive_cosim.traffic.profiles import profile
from automotive_cosim.traffic.remote import TIMEOUT_S, RemoteProcess
from automotive_cosim.traffic.steering import KEEPS_ROUTE
from automotive_cosim.traffic.wire import Packed, pack_state, unpack_advance, unpack_snapshot, unpack_state

if TYPE_CHECKING:
    from automotive_cosim.traffic.running import Running

P = ParamSpec("P")
T = TypeVar("T")


class Forked:
    """A scenario's warm traffic in a process of its own, from which any number of drives depart."""

    def __init__(
        self,
        scenario: Scenario,
        seed: int = 0,
        progress: WarmUpProgress | None = None,
        *,
        allow_unprojected: bool = False,
        timeout_s: float = TIMEOUT_S,
        outputs: Path | None = None,
        flow_s: float | None = None,
        alike: Forked | None = None,
    ) -> None:
        """Loads the scenario and warms up its traffic, or copies that of one that has the same.

        Args:
            scenario: the scenario to run.
            seed: seed of SUMO's random numbers.
            progress: called with the progress of the warm-up.
            allow_unprojected: accept a network without projection, with lon and lat None.
            timeout_s: processor time without a sign of life after which a simulation counts as hung.
            outputs: an empty folder for SUMO's own outputs; the warm traffic writes to ``warm`` in it, each drive
                and branch to its ``drive-N``, from the start of the simulation, complete when it is closed.
            flow_s: write the flow on every edge in intervals of this length instead, from the end of the warm-up.
            alike: warm traffic of a setup with the same ``Setup.traffic``, of which this becomes a copy by fork.

        Raises:
            ScenarioError: the scenario cannot be loaded.
            SetupError: libsumo is missing or unsuitable, or the system is not Linux.
            TrafficError: the process died or hung.
        """
        if sys.platform != "linux":
            raise SetupError(NO_FORK)
        setup = Setup(scenario, seed, allow_unprojected, outputs, flow_s)
        self._source: _Source = _Source(setup, timeout_s, progress, None if alike is None else alike._source)
        self._is_closed = False

    def depart(self, plan: EgoPlan) -> RemoteTraffic:
        """Starts the ego in an exact copy of the warm traffic.

        Raises:
            ScenarioError: its trip has no route, or its edges are not in the network.
            UnknownNameError: no such driver.
            NoRoomError: no gap opened for it; another drive can still depart.
            TrafficError: the simulation died or hung; another drive can still depart.
        """
        profile(plan.driver)
        if self._is_closed:
            raise TrafficError("the simulation is closed")
        return self._source.departed(plan)

    def call(self, call: Callable[Concatenate[Running, P], T], *arguments: P.args, **named: P.kwargs) -> T:
        """Calls a function in the warm process itself, so that every copy made later has what it did.

        Args:
            call: a module's function, which is sent by its name, of what runs there and the arguments.
            arguments: its further arguments.
            named: the same.

        Raises:
            TrafficError: SUMO stopped at an error, died or hung.
        """
        answer: T = self._source.warm_call("call", call, arguments, named)
        return answer

    def copy(self) -> RemoteCopy:
        """A copy of the traffic without an ego.

        Raises:
            TrafficError: the simulation died or hung.
        """
        return self._source.without_ego()

    @property
    def memory_bytes(self) -> int:
        """Memory of the warm process; 0 if the platform does not say, or there is none."""
        return self._source.memory_bytes()

    def close(self) -> None:
        """Ends the warm process; drives that have departed continue until they are closed."""
        self._is_closed = True
        self._source.close()


class _Remote:
    """A copy in a process of its own."""

    def __init__(self, process: RemoteProcess) -> None:
        self._process = process
        self._is_busy = False

    @property
    def pid(self) -> int:
        """The process that runs it."""
        return self._process.pid

    def call(self, call: Callable[Concatenate[Running, P], T], *arguments: P.args, **named: P.kwargs) -> T:
        """Calls a function in this copy; arguments and errors are those of ``Forked.call``."""
        answer: T = self._process.call("call", call, arguments, named)
        return answer

    def begin(self, call: Callable[Concatenate[Running, P], object], *arguments: P.args, **named: P.kwargs) -> None:
        """Begins to call a function that takes long and drives on; ``ended`` gives its answer.

        Raises:
            TrafficError: it died.
        """
        self._process.send("run", call, arguments, named)
        self._is_busy = True

    def ended(self, progress: WarmUpProgress | None = None) -> Any:
        """Waits for the answer to what was begun.

        Args:
            progress: called with how much the function said to be done, and of how much.

        Raises:
            TrafficError: SUMO stopped at an error, died or hung.
        """
        state, answer = self._process.receive(progress)
        self._is_busy = False
        self._drove_on(state)
        return answer

    def close(self) -> None:
        """See ``Traffic.close``; what was begun is not waited for."""
        if self._is_busy:
            self._process.kill()
        self._process.close()

    def _drove_on(self, state: Packed | None) -> None:
        """Takes the ego's state after a long call."""


class RemoteCopy(_Remote):
    """A copy of the warm traffic without an ego, from that instant on."""

    def __init__(self, process: RemoteProcess, outputs: Path | None) -> None:
        super().__init__(process)
        self.outputs = outputs
        """Folder of SUMO's own outputs, complete when this is closed; None without any."""


class RemoteTraffic(_Remote):
    """One drive in a process of its own."""

    def __init__(self, source: _Source, process: RemoteProcess, state: Packed) -> None:
        super().__init__(process)
        self._source = source
        self._state = unpack_state(state)
        self._started_s: float | None = None
        self.is_steered = False
        """Whether a request since this copy was made has changed anything in the simulation."""

    @property
    def network(self) -> RoadNetwork:
        """The road network for maps."""
        return self._source.network

    @property
    def state(self) -> DrivingState:
        """The newest state."""
        return self._state

    def start(self, duration_s: float) -> None:
        if self._started_s is None:
            self._process.send("advance", duration_s)
            self._started_s = duration_s

    def advance(self, duration_s: float) -> Advance:
        self.start(duration_s)
        assert duration_s == self._started_s, "another advance was started"
        self._started_s = None
        advance = unpack_advance(self._process.receive())
        if advance.states:
            self._state = advance.states[-1]
        return advance

    def request(self, request: RoadRequest) -> Answer:
        answer: Answer = self._process.call("request", request)
        kept = not answer.accepted or answer.reason == KEEPS_ROUTE
        self.is_steered = self.is_steered or not (isinstance(request, Reroute) and kept)
        return answer

    def alternatives(self, age_s: float = 0.0) -> tuple[RouteOption, ...]:
        options: tuple[RouteOption, ...] = self._process.call("alternatives", age_s)
        return options

    def look(self) -> RoadSnapshot:
        return unpack_snapshot(self._process.call("look"))

    def shapes(self) -> RoadShapes:
        """See ``Traffic.shapes``; read once for all drives in the same traffic."""
        shapes: RoadShapes = self._source.shapes or self._process.call("shapes")
        self._source.shapes = shapes
        return shapes

    def branch(self) -> RemoteTraffic:
        """An exact copy that is independent from this instant, even if this one is closed."""
        return self._source.branched(self._process, self._state)

    def _drove_on(self, state: Packed | None) -> None:
        assert state is not None
        self._state = unpack_state(state)


class _Source:
    """The source of copies of a warm simulation."""

    def __init__(
        self,
        setup: Setup,
        timeout_s: float,
        progress: WarmUpProgress | None,
        alike: _Source | None,
    ) -> None:
        self._setup = setup
        self._timeout_s = timeout_s
        self._drives = 0
        self.shapes: RoadShapes | None = None
        self._lock = threading.Lock()
        """Lock for copying the warm process: threads may depart at the same time."""
        self._warm_calls: list[tuple[str, tuple[object, ...]]] = []
        self._warm: RemoteProcess | None
        self.network: RoadNetwork
        if alike is None:
            self._warm, self.network = started(self._writing("warm"), progress, timeout_s)
        else:
            with alike._lock:
                self._warm = alike._copied()
            try:
                self.network = self._warm.call("move", setup.scenario)
            except BaseException:
                self._warm.close()
                raise

    def departed(self, plan: EgoPlan) -> RemoteTraffic:
        """A drive in a process of its own."""
        with self._lock:
            process = self._copied()
        try:
            state = process.call("depart", plan)
        except BaseException:
            process.close()
            raise
        return RemoteTraffic(self, process, state)

    def without_ego(self) -> RemoteCopy:
        """A copy without an ego."""
        with self._lock:
            process = self._copied()
            return RemoteCopy(process, self._outputs_of(self._drives))

    def branched(self, process: RemoteProcess, state: DrivingState) -> RemoteTraffic:
        """A drive that continues from where another one is."""
        return RemoteTraffic(self, process.fork(self._next_outputs()), pack_state(state))

    def warm_call(self, name: str, *arguments: object) -> Any:
        """Calls the warm process itself, and any that takes its place."""
        assert self._warm is not None
        answer = self._warm.call(name, *arguments)
        self._warm_calls.append((name, arguments))
        return answer

    def close(self) -> None:
        """Ends the warm process."""
        if self._warm is not None:
            self._warm.close()
            self._warm = None

    def memory_bytes(self) -> int:
        """Memory of the warm process."""
        return 0 if self._warm is None else self._warm.memory_bytes

    def _copied(self) -> RemoteProcess:
        """A copy of the warm process, which is started again if it turns out to have died."""
        warm = self._ready()
        try:
            return warm.fork(self._next_outputs())
        except TrafficError:
            if not warm.is_broken:  # the copy died, not its source
                raise
        return self._ready().fork(self._next_outputs())

    def _ready(self) -> RemoteProcess:
        """The warm process, started again if it has died."""
        if self._warm is None or self._warm.is_broken:
            self.close()
            self._warm, _ = started(self._writing("warm"), None, self._timeout_s)
            for call, arguments in self._warm_calls:
                self._warm.call(call, *arguments)
        return self._warm

    def _writing(self, name: str) -> Setup:
        """The setup with its own folder for outputs."""
        outputs = self._setup.outputs
        if outputs is None:
            return self._setup
        return replace(self._setup, outputs=make_folder(outputs, name))

    def _next_outputs(self) -> Path | None:
        self._drives += 1
        return self._outputs_of(self._drives)

    def _outputs_of(self, drive: int) -> Path | None:
        return self._writing(f"drive-{drive}").outputs


class Simulations:
    """Keeps warm simulations for later drives; the least recently used one is removed first."""

    def __init__(self, count_limit: int = 4, memory_limit_bytes: int = 2 * 1024**3) -> None:
        """Starts empty.

        Args:
            count_limit: maximum number of simulations.
            memory_limit_bytes: maximum of their total memory; at least one is kept.
        """
        self._count_limit = count_limit
        self._memory_limit_bytes = memory_limit_bytes
        self._kept: OrderedDict[Setup, Forked] = OrderedDict()
        self._held: list[Forked] = []
        """Number of threads about to depart from each."""
        self._lock = threading.Lock()

    def warm(
        self,
        scenario: Scenario,
        seed: int = 0,
        progress: WarmUpProgress | None = None,
        *,
        allow_unprojected: bool = False,
    ) -> Forked:
        """The warm simulation of a scenario and seed, made now if there is none; the pool closes it.

        Raises:
            see ``Forked``.
        """
        setup = Setup(scenario, seed, allow_unprojected)
        if setup not in self._kept:
            same = (kept for other, kept in self._kept.items() if other.traffic == setup.traffic)
            self._kept[setup] = Forked(
                scenario, seed, progress, allow_unprojected=allow_unprojected, alike=next(same, None)
            )
            self._make_room()
        self._kept.move_to_end(setup)
        return self._kept[setup]

    @contextmanager
    def held(self, scenario: Scenario, seed: int, progress: WarmUpProgress | None = None) -> Iterator[Forked]:
        """Like ``warm``, for threads: while one makes a simulation, the others wait; none in use is closed.

        Raises:
            see ``Forked``.
        """
        with self._lock:
            simulation = self.warm(scenario, seed, progress)
            self._held.append(simulation)
        try:
            yield simulation
        finally:
            with self._lock:
                self._held.remove(simulation)
                self._make_room()

    def close(self) -> None:
        """Closes them all; may be called again."""
        while self._kept:
            self._kept.popitem()[1].close()

    def _make_room(self) -> None:
        while len(self._kept) > self._count_limit or self._memory_bytes > self._memory_limit_bytes:
            free = [setup for setup in list(self._kept)[:-1] if self._kept[setup] not in self._held]
            if not free:
                break
            traffics = Counter(setup.traffic for setup in self._kept)
            # first one whose traffic is kept elsewhere on earth: it comes back by a fork
            self._kept.pop(next((setup for setup in free if traffics[setup.traffic] > 1), free[0])).close()

    @property
    def _memory_bytes(self) -> int:
        return sum(simulation.memory_bytes for simulation in self._kept.values())
