"""Simulations in processes of their own: warmed up once, then an exact copy for every drive and branch.

A copy is a fork, which takes milliseconds however long the warm-up took. SUMO's files are reopened through
``/proc``, which only Linux has.
"""

from __future__ import annotations

import sys
import threading
from collections import Counter, OrderedDict, deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeVar
from weakref import WeakValueDictionary

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
from automotive_cosim.traffic.driven import DrivenProcess
from automotive_cosim.traffic.keeper import departing, handed_over, started
from automotive_cosim.traffic.options import Setup
from automotive_cosim.traffic.profiles import profile
from automotive_cosim.traffic.remote import TIMEOUT_S, Baton, RemoteProcess
from automotive_cosim.traffic.shadow import Passed, by_step
from automotive_cosim.traffic.steering import KEEPS_ROUTE
from automotive_cosim.traffic.sumo import EGO
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
            TrafficError: the process died or hung."""
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
            TrafficError: the simulation died or hung; another drive can still depart."""
        profile(plan.driver)
        if self._is_closed:
            raise TrafficError("the simulation is closed")
        return self._source.departed(plan)

    def call(self, call: Callable[Concatenate[Running, P], T], *arguments: P.args, **named: P.kwargs) -> T:
        """Calls a function in the warm process itself, so that every copy made later has what it did.

        Args:
            call: a module's function, which is sent by its name, of what runs there and the arguments.

        Raises:
            TrafficError: SUMO stopped at an error, died or hung."""
        answer: T = self._source.warm_call("call", call, arguments, named)
        return answer

    def road(self) -> RemoteRoad:
        """A copy of the traffic in which cars can be equipped. Raises TrafficError: the simulation died or hung."""
        road = RemoteRoad(self._source, self._source.copied())
        road.is_held = True
        road.run(0.0)
        return road

    def copy(self) -> RemoteCopy:
        """A copy of the traffic without an ego. Raises TrafficError: the simulation died or hung."""
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

        Raises TrafficError: it died."""
        self._process.send("run", call, arguments, named)
        self._is_busy = True

    def ended(self, progress: WarmUpProgress | None = None) -> Any:
        """Waits for the answer to what was begun.

        Args:
            progress: called with how much the function said to be done, and of how much.

        Raises:
            TrafficError: SUMO stopped at an error, died or hung."""
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


class RemoteRoad(_Remote):
    """The traffic in a process of its own, and the equipped cars in it, each of which is a drive.

    The car that asks first lets the road run for all. The others are behind until they have driven as far, and
    what they then ask the road for would come too late, so let all drive to one instant before any asks."""

    def __init__(self, source: _Source, process: RemoteProcess, original: RemoteTraffic | None = None) -> None:
        """Takes over a process.

        Args:
            source: where its copies come from.
            process: the traffic.
            original: the drive that its only car continues without the requests of that drive's cockpit: what the
                other cars of the original ask for is asked for here too, as far as the original has driven."""
        super().__init__(process)
        self.source = source
        self.step_s = source.step_s
        self.time_s = 0.0
        """Simulation time to which it has run."""
        self.is_held = False
        """Whether it goes on without an equipped car, until it is closed."""
        self._cars: WeakValueDictionary[str, RemoteTraffic] = WeakValueDictionary()
        """Who drops a drive without closing it ends it as well."""
        self.away: set[str] = set()
        """Cars whose drives another process has."""
        self.passed_away: list[bytes] = []
        """What they have passed that has not been told there."""
        self._entered: list[RemoteTraffic] = []
        self._started_s: float | None = None
        self.asked: list[tuple[float, str, RoadRequest]] = []
        """What its cars have asked for, while there are several: simulation time, car, request."""
        self._original = original
        self._heard = len(original.road.asked) if original else 0
        """How much of what the original's cars asked for has been heard here."""

    def send(self, car: str, plan: EgoPlan) -> None:
        """Sends an equipped car to the beginning of its trip, where it enters the traffic as soon as there is a gap
        (``entered``). Hour and weather are those of the first car.

        Raises:
            ScenarioError: its trip has no route, its edges are not in the network, or there is such a vehicle.
            TrafficError: the simulation died."""
        self._process.call("send", car, plan)

    def equip(self, car: str, plan: EgoPlan) -> RemoteTraffic:
        """Puts a cockpit into a vehicle that drives anyway, and goes on as it does until something is asked for.

        Raises:
            ScenarioError: there is no such vehicle on a road for cars.
            TrafficError: the simulation died."""
        return self.take(car, self._process.call("equip", car, plan))

    def entered(self) -> tuple[RemoteTraffic, ...]:
        """The cars that have entered the traffic since this was last called, where they are now."""
        new, self._entered = tuple(self._entered), []
        for traffic in new:
            traffic.catch_up()
        return new

    def take(self, car: str, state: Packed) -> RemoteTraffic:
        """The drive of a car that has entered."""
        traffic = self._cars[car] = RemoteTraffic(self, state, car)
        return traffic

    def branch(self) -> tuple[RemoteTraffic, ...]:
        """All equipped cars on an exact copy of the road, on which no cockpit has asked for anything since."""
        road = self._copied(None)
        return tuple(traffic._on(road) for traffic in list(self._cars.values()))

    def _copied(self, original: RemoteTraffic | None) -> RemoteRoad:
        road = RemoteRoad(self.source, self.source.branched(self._process), original)
        road.time_s = self.time_s
        return road

    def leave(self, car: str) -> None:
        """A cockpit is no longer used; without one, the process ends, unless it is held."""
        if self._cars.pop(car, None) is None and car not in self.away:
            return
        self.away.discard(car)
        if not (self._cars or self.away or self.is_held) or self._is_busy:
            self.close()
        elif not self._process.is_broken:
            self._process.call("forget", car)

    @property
    def is_shared(self) -> bool:
        """Whether several equipped cars drive on it."""
        return len(self._cars) + len(self.away) > 1

    def ask(self, car: str, state: DrivingState, request: RoadRequest) -> Answer:
        """Makes a request of a car."""
        if self.is_shared:
            self.asked.append((state.time_s, car, request))
        answer: Answer = self._process.call("request", request, car)
        return answer

    def start(self, duration_s: float) -> None:
        """Starts to run in the background; the next call must be ``run`` of that duration."""
        if self._started_s is None and not self._to_hear():
            self._send(duration_s)

    def run(self, duration_s: float) -> None:
        """Lets the traffic run, and tells every car what it has passed.

        Raises TrafficError: the simulation failed."""
        for part_s in self._parts(duration_s):
            if self._started_s is None:
                self._send(part_s)
            assert part_s == self._started_s, "another advance was started"
            self._started_s = None
            passed, elsewhere, entered, self.time_s = self._process.receive()
            self.tell(passed)
            if self.away:
                self.passed_away.append(elsewhere)
            if self._original is None:
                self._entered += [self.take(car, state) for car, state in entered.items()]

    def _send(self, duration_s: float) -> None:
        self._process.send("advance", duration_s, tuple(self._cars), tuple(self.away))
        self._started_s = duration_s

    def take_turns(self) -> None:
        """From here on, what this process and copies of it ask the road is asked one after the other."""
        if isinstance(self._process, DrivenProcess):
            self._process.turn_off()  # or each copy would by itself
        self._process.baton = Baton()

    def tell(self, passed: Mapping[str, Packed]) -> None:
        """Tells cars what they have passed."""
        for car, each in passed.items():
            if (traffic := self._cars.get(car)) is not None:
                traffic.see(unpack_advance(each))

    def reach(self, time_s: float) -> None:
        """Lets the traffic run to a simulation time, unless it has."""
        if (left_s := time_s - self.time_s) > self.step_s / 2:
            self.run(left_s)

    def _to_hear(self) -> list[tuple[float, str, RoadRequest]]:
        """What the other cars of the original have asked for and this copy has not heard."""
        return self._original.road.asked[self._heard :] if self._original else []

    def _parts(self, duration_s: float) -> Iterator[float]:
        """The duration, in parts between which the requests of the original's other cars are made."""
        original = self._original
        if original is None or self._started_s is not None or not self._to_hear():
            yield duration_s
            return
        steps = round(duration_s / self.step_s)
        now_s = self.time_s
        for time_s, car, request in self._to_hear():
            before = round((time_s - now_s) / self.step_s)
            if before >= steps:
                break
            if before > 0:
                yield before * self.step_s
                now_s, steps = time_s, steps - before
            self._heard += 1
            if car != original.car:
                try:
                    self._process.call("request", request, car)
                except TrafficError:  # a car that has not entered here, or is no longer there
                    if self._process.is_broken:
                        raise
        yield steps * self.step_s


class RemoteTraffic(_Remote):
    """One drive on a road in a process of its own, alone or beside others."""

    def __init__(self, road: RemoteRoad, state: Packed, car: str = EGO) -> None:
        super().__init__(road._process)
        self.road = road
        self.car = car
        """SUMO's id of the car."""
        self._state = unpack_state(state)
        self._ahead: deque[Passed] = deque()
        """Steps that the road has run and this drive has not come to."""
        self.is_steered = False
        """Whether a request since this copy was made has changed anything in the simulation."""

    @property
    def network(self) -> RoadNetwork:
        """The road network for maps."""
        return self.road.source.network

    @property
    def state(self) -> DrivingState:
        return self._state

    def start(self, duration_s: float) -> None:
        if not self._ahead:
            self.road.start(duration_s)

    def advance(self, duration_s: float) -> Advance:
        steps = round(duration_s / self.road.step_s)
        missing = steps - len(self._ahead)
        if missing > 0 and (self._ahead[-1][0] if self._ahead else self._state).end is None:
            self.road.run(duration_s if missing == steps else missing * self.road.step_s)
        told = [self._ahead.popleft() for _ in range(min(steps, len(self._ahead)))]
        if told:
            self._state = told[-1][0]
        return Advance(tuple(state for state, _ in told), tuple(event for _, passed in told for event in passed))

    def catch_up(self) -> None:
        """Goes to where the road has run to; what passed before is not told."""
        if self._ahead:
            self._state = self._ahead[-1][0]
            self._ahead.clear()

    def see(self, passed: Advance) -> None:
        """Takes note of what the road has run."""
        self._ahead.extend(by_step(passed))

    def request(self, request: RoadRequest) -> Answer:
        """See ``Traffic.request``.

        Raises RuntimeError: the road has run further for another car; drive on as far before asking."""
        if self._ahead:
            raise RuntimeError(
                f"car {self.car!r} cannot ask in the past; the road has run to {self.road.time_s:g} s"
            )
        answer = self.road.ask(self.car, self._state, request)
        kept = not answer.accepted or answer.reason == KEEPS_ROUTE
        self.is_steered = self.is_steered or not (isinstance(request, Reroute) and kept)
        return answer

    def alternatives(self, age_s: float = 0.0) -> tuple[RouteOption, ...]:
        options: tuple[RouteOption, ...] = self._process.call("alternatives", age_s, self.car)
        return options

    def look(self) -> RoadSnapshot:
        return unpack_snapshot(self._process.call("look", self.car))

    def shapes(self) -> RoadShapes:
        """See ``Traffic.shapes``; read once for all drives in the same traffic."""
        source = self.road.source
        shapes: RoadShapes = source.shapes or self._process.call("shapes", self.car)
        source.shapes = shapes
        return shapes

    def branch(self) -> RemoteTraffic:
        """An exact copy that is independent from this instant, even if this one is closed. Other equipped cars do
        in it what they do beside the original, as far as that has driven; then they go on by themselves."""
        return self._on(self.road._copied(self if self.road.is_shared else None))

    def _on(self, road: RemoteRoad) -> RemoteTraffic:
        """This drive on a copy of its road."""
        twin = road.take(self.car, pack_state(self._state))
        twin._ahead.extend(self._ahead)
        return twin

    def handed_over(self) -> None:
        """Somebody takes the drive over here: a later command in which one departs alike begins here."""
        handed_over(self._process)

    def close(self) -> None:
        """See ``Traffic.close``; the last of a road's drives ends its process."""
        self.road._is_busy = self.road._is_busy or self._is_busy
        self.road.leave(self.car)

    def _drove_on(self, state: Packed | None) -> None:
        assert state is not None
        self._state = unpack_state(state)


class _Source:
    """The source of copies of a warm simulation."""

    def __init__(
        self, setup: Setup, timeout_s: float, progress: WarmUpProgress | None, alike: _Source | None
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
            warm = self._ready()
        process = self.copied() if self._warm_calls else departing(warm, self._setup, plan, self.copied)
        try:
            state = process.call("depart", plan)
        except BaseException:
            process.close()
            raise
        road = RemoteRoad(self, process)
        traffic = road.take(EGO, state)
        road.time_s = traffic.state.time_s
        return traffic

    def copied(self) -> RemoteProcess:
        """A process that continues from where the warm one is."""
        with self._lock:
            return self._copied()

    def without_ego(self) -> RemoteCopy:
        with self._lock:
            process = self._copied()
            return RemoteCopy(process, self._outputs_of(self._drives))

    def branched(self, process: RemoteProcess) -> RemoteProcess:
        """A process that continues from where another one is."""
        return process.fork(self._next_outputs())

    @property
    def step_s(self) -> float:
        """Length of SUMO's steps."""
        return self._setup.scenario.sumo.step_length_s

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
            memory_limit_bytes: maximum of their total memory; at least one is kept."""
        self._count_limit = count_limit
        self._memory_limit_bytes = memory_limit_bytes
        self._kept: OrderedDict[Setup, Forked] = OrderedDict()
        self._held: list[Forked] = []
        """One entry for each thread that is about to depart from it: these are not closed."""
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
            see ``Forked``."""
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
            see ``Forked``."""
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
