"""Drives that are driven once for all who depart alike, until one asks the road for something.

    drives = KnownDrives(simulations)
    with drives.held(scenario, seed) as simulation:
        one, other = simulation.depart(plan), simulation.depart(plan)    # exact copies
    one.advance(60.0)                                # simulated
    other.advance(60.0)                              # known already
    other.request(alert)                             # only now it gets a simulation of its own

The gates of a task play it some hundred times from one hand-over, hundreds of tasks have the same way up to it, and
few of the actions reach the road: without this, each play would fork a simulation and drive the same again. The
states equal those of a drive of one's own.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from weakref import WeakSet

from automotive_cosim.contracts import (
    Answer,
    DrivingState,
    RoadNetwork,
    RoadRequest,
    RoadShapes,
    RoadSnapshot,
    RouteOption,
)
from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.traffic.base import Advance, EgoPlan, Traffic, WarmUpProgress
from automotive_cosim.traffic.fork import Forked, RemoteTraffic, Simulations
from automotive_cosim.traffic.road_weather import felt
from automotive_cosim.traffic.running import react_anew
from automotive_cosim.traffic.shadow import Passed, by_step

KEPT = 12
"""Drives that are kept though nobody is on them."""
STOP_S = 5.0
"""From simulations so far apart on a known drive others get their own, so that they need not go all the way."""


class SharedFuture:
    """What a drive comes to if nobody asks it for anything: driven once, as far as somebody wants to know."""

    def __init__(
        self, traffic: Traffic, step_s: float, reseed: Callable[[Traffic, int], None] = lambda traffic, seed: None
    ) -> None:
        """Takes over a drive, which stays where it is.

        Args:
            traffic: the drive, to be used only through this object.
            reseed: gives the driver of a copy, who was asked for nothing yet, the reactions of another seed."""
        self.begin = traffic
        self.reseed = reseed
        self._step_s = step_s
        self._stops = {0: traffic}
        """The drive on its way, by the number of steps driven."""
        self.drives: WeakSet[FutureDrive] = WeakSet()
        """Those that have no simulation of their own, until they are closed."""
        self._front: Traffic | None = None
        """The drive at the end of what is known; None until something is."""
        self._known: list[Passed] = []
        self._heard: dict[tuple[int, float], tuple[RouteOption, ...]] = {}
        """Alternatives, by the number of steps driven and the age of the news."""

    def drive(self, seed: int = 0) -> FutureDrive:
        """A drive from the instant at which this begins, whose driver reacts by that seed."""
        return FutureDrive(self, seed)

    def known(self, done: int, duration_s: float) -> list[Passed]:
        """The steps of a duration after so many steps; fewer if the drive ends.

        Raises TrafficError: the simulation failed."""
        until = done + round(duration_s / self._step_s)
        missing = until - len(self._known)
        if missing > 0 and (not self._known or self._known[-1][0].end is None):
            if self._front is None:
                self._front = self.begin.branch()
            self._known += by_step(self._front.advance(missing * self._step_s))
        return self._known[done:until]

    def at(self, done: int) -> Traffic:
        """A simulation of its own, after so many steps. Raises TrafficError: the simulation failed."""
        if self._front is not None and done == len(self._known):
            return self._front.branch()
        stop, every = self._stop_before(done), round(STOP_S / self._step_s)
        if done - stop > every:
            near = done - done % every
            self._stops[near] = self._on(stop, near)
            stop = near
        return self._on(stop, done)

    def mark(self, done: int) -> None:
        """From here others are likely to begin: a simulation stays here, if it just is."""
        if self._front is not None and done == len(self._known) and self._stop_before(done) < done:
            self._stops[done] = self._front.branch()

    def _stop_before(self, done: int) -> int:
        return max(stop for stop in self._stops if stop <= done)

    def _on(self, stop: int, done: int) -> Traffic:
        traffic = self._stops[stop].branch()
        if done > stop:
            traffic.advance((done - stop) * self._step_s)
        return traffic

    def alternatives(self, done: int, age_s: float) -> tuple[RouteOption, ...]:
        """See ``Traffic.alternatives``, after so many steps."""
        key = done, age_s
        if key not in self._heard:
            if self._front is not None and done == len(self._known):
                self._heard[key] = self._front.alternatives(age_s)
            else:
                traffic = self.at(done)
                self._heard[key] = traffic.alternatives(age_s)
                traffic.close()
        return self._heard[key]

    def close(self) -> None:
        """Ends it; drives with a simulation of their own continue until they are closed."""
        for traffic in (*self._stops.values(), self._front):
            if traffic is not None:
                traffic.close()


class FutureDrive:
    """A drive into a future; it gets a simulation of its own when it asks the road for something."""

    def __init__(
        self, future: SharedFuture, seed: int = 0, done: int = 0, state: DrivingState | None = None
    ) -> None:
        self._future = future
        self._seed = seed
        self._done = done
        self._state = future.begin.state if state is None else state
        self._own: Traffic | None = None
        future.drives.add(self)

    @property
    def network(self) -> RoadNetwork:
        return self._future.begin.network

    @property
    def state(self) -> DrivingState:
        return self._state if self._own is None else self._own.state

    def start(self, duration_s: float) -> None:
        """See ``Traffic.start``; does nothing as long as it has no simulation of its own."""
        if self._own is not None:
            self._own.start(duration_s)

    def advance(self, duration_s: float) -> Advance:
        if self._own is not None:
            return self._own.advance(duration_s)
        passed = self._future.known(self._done, duration_s)
        self._done += len(passed)
        if passed:
            self._state = passed[-1][0]
        return Advance(tuple(state for state, _ in passed), tuple(each for _, events in passed for each in events))

    def request(self, request: RoadRequest) -> Answer:
        return self._now().request(request)

    def alternatives(self, age_s: float = 0.0) -> tuple[RouteOption, ...]:
        if self._own is not None:
            return self._own.alternatives(age_s)
        return self._future.alternatives(self._done, age_s)

    def look(self) -> RoadSnapshot:
        return self._now().look()

    def shapes(self) -> RoadShapes:
        return self._future.begin.shapes()

    def branch(self) -> Traffic:
        if self._own is not None:
            return self._own.branch()
        self._future.mark(self._done)
        return FutureDrive(self._future, self._seed, self._done, self._state)

    def close(self) -> None:
        """See ``Traffic.close``; the future stays for others."""
        self._future.drives.discard(self)
        if self._own is not None:
            self._own.close()

    def _now(self) -> Traffic:
        if self._own is None:
            self._own = self._future.at(self._done)
            self._future.reseed(self._own, self._seed)
            self._future.drives.discard(self)
        return self._own


class KnownDrives:
    """Warm simulations in which drives that depart alike share their future."""

    def __init__(self, simulations: Simulations) -> None:
        """Nothing is known yet.

        Args:
            simulations: the warm ones, which the caller closes."""
        self._simulations = simulations
        self._futures: OrderedDict[Hashable, SharedFuture] = OrderedDict()

    @contextmanager
    def held(self, scenario: Scenario, seed: int, progress: WarmUpProgress | None = None) -> Iterator[_Departures]:
        with self._simulations.held(scenario, seed, progress) as simulation:
            yield _Departures(self, simulation, scenario, seed)

    def future(self, simulation: Forked, scenario: Scenario, seed: int, plan: EgoPlan) -> SharedFuture:
        """What comes after a departure by a plan. Its seed is the driver's, whom nobody has asked for anything, and
        of the weather only what is felt on the road counts."""
        weather = felt(plan.weather or scenario.weather)
        alike = scenario, seed, replace(plan, seed=0, weather=()), weather
        future = self._futures.get(alike)
        if future is None:
            for old in [other for other, each in self._futures.items() if not each.drives][:-KEPT]:
                self._futures.pop(old).close()
            step_s = scenario.sumo.step_length_s
            future = self._futures[alike] = SharedFuture(simulation.depart(plan), step_s, _reseed)
        self._futures.move_to_end(alike)
        return future

    def close(self) -> None:
        """Forgets everything; drives with a simulation of their own continue until they are closed."""
        while self._futures:
            self._futures.popitem()[1].close()


@dataclass(frozen=True, slots=True)
class _Departures:
    """A warm simulation of which it is known where drives lead."""

    known: KnownDrives
    simulation: Forked
    scenario: Scenario
    seed: int

    def depart(self, plan: EgoPlan) -> Traffic:
        return self.known.future(self.simulation, self.scenario, self.seed, plan).drive(plan.seed)

    def close(self) -> None:
        """Leaves the simulation to its owner."""


def _reseed(traffic: Traffic, seed: int) -> None:
    assert isinstance(traffic, RemoteTraffic)
    traffic.call(react_anew, seed)
