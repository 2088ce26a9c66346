"""What a study does to a copy of the traffic without an ego: advice to other cars, and other signals.

Both begin at the instant of the copy, so two copies of one instant differ by the intervention alone.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Annotated, Any, Literal
from zlib import crc32

import numpy as np
from annotated_types import Ge, Le

from automotive_cosim.contracts import OLDEST_NEWS_S
from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.incidents import AnyIncident
from automotive_cosim.studies.calls.accounts import QUEUE_PERIOD_S, TrafficSummary
from automotive_cosim.studies.calls.divert import LEAST_LEFT_M
from automotive_cosim.studies.calls.ledger import Ledger, run_on
from automotive_cosim.traffic.router import Router
from automotive_cosim.traffic.running import Running
from automotive_cosim.traffic.sumo import LibSumo
from automotive_cosim.traffic.world import SEARCHING_TYPE

ADVISED_CLASS = "passenger"
"""SUMO's class of the vehicles that are advised; lorries and buses may not drive everywhere."""

LEAST_GREEN_S, MOST_GREEN_S = 5.0, 50.0
"""Bounds of a green phase under actuated control: SUMO's own defaults are 5 s and 50 s (netconvert
``--tls.min-dur``, ``--tls.max-dur``)."""

TRAINS = frozenset((1, 2))
"""Those of rail signals and rail crossings, which trains control."""

CONTROLS = {"static": 0, "actuated": 3, "delay_based": 5}
"""SUMO's numbers of the types of signal control."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Advice:
    """A share of the cars gets advice again and again: the route that is quickest by the traffic news.

    Who has followed a piece of advice goes by advice from then on, and no longer by SUMO's rerouting device."""

    kind: Literal["advice"] = "advice"
    share: Annotated[float, Ge(0), Le(1)]
    """Share of the cars that get it; a greater share contains the cars of every smaller one."""
    compliance: Annotated[float, Ge(0), Le(1)] = 1.0
    """Probability that a driver follows a piece of advice."""
    age_s: Annotated[float, Ge(0), Le(OLDEST_NEWS_S)] = 0.0
    """Age of the news."""
    every_s: Annotated[float, Ge(10), Le(3_600)] = 60.0
    """Time between two pieces of advice to one driver; the first comes with the departure."""
    least_s: Annotated[float, Ge(0), Le(3_600)] = 10.0
    """Expected saving from which another route is advised."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SignalControl:
    """All signals are controlled in another way, with the phases that they have."""

    kind: Literal["signals"] = "signals"
    control: Literal["static", "actuated", "delay_based"]
    """SUMO's type of control: fixed phases, or greens that vehicles extend by gaps or by their delay."""


@dataclass(frozen=True, slots=True)
class FlowSummary:
    """The traffic at the end of a period."""

    summary: TrafficSummary
    arrived: int
    """Vehicles that have arrived since the simulation began."""
    queues: tuple[dict[str, float], ...]
    """The length of the queue in each lane with one (``Ledger.queues_m``), every ``accounts.QUEUE_PERIOD_S``."""
    slowed: dict[str, tuple[float, float]]
    """Edges with another limit than at the start: that limit as a share of it, and how long vehicles were at their
    stops there in the period, in s. SUMO's time loss counts from the limit of the moment, so it does not see
    what roadworks cost."""
    consumed: dict[str, tuple[int, float, float, float, float, float]]
    """By emission class, since the simulation began: vehicles, CO2, NOx and fuel in g, electricity in Wh, noise in
    seconds of ``accounts.LOUD_DB``; empty if it is not recorded."""
    cut_short: int
    kept_in: int
    """Vehicles whose trip ended before a closed road, and those that would have set out on one, since the start
    (``detours``)."""


class _Advisor:
    """Gives the advice, step by step. Who is asked, and who follows, depends on the seed and the vehicle's name."""

    def __init__(self, sumo: LibSumo, router: Router, advice: Advice, seed: int) -> None:
        self._sumo = sumo
        self._router = router
        self._advice = advice
        self._seed = seed
        self._known: set[str] = set()
        self._due: dict[int, list[str]] = {}
        """Vehicles to advise, by the second."""
        self._draws: dict[str, np.random.Generator] = {}
        for vehicle in sorted(sumo.vehicle_ids()):
            self._meet(vehicle)

    def after_step(self) -> None:
        """Asks everyone who is due; called after every step."""
        sumo = self._sumo
        for vehicle in sumo.departed() if sumo.departed_count() else ():
            self._meet(vehicle)
        now = int(sumo.time())
        due = [self._due.pop(second) for second in sorted(self._due) if second <= now]
        running = set(sumo.vehicle_ids()) if due else set()
        asked = [vehicle for vehicles in due for vehicle in vehicles if vehicle in running]
        if asked:
            self._router.listen(self._advice.age_s)
        for vehicle in asked:
            self._advise(vehicle)
            self._due.setdefault(now + round(self._advice.every_s), []).append(vehicle)

    def _meet(self, vehicle: str) -> None:
        if vehicle in self._known or self._sumo.vehicle_class(vehicle) != ADVISED_CLASS:
            return
        self._known.add(vehicle)
        draws = np.random.default_rng((self._seed, crc32(vehicle.encode())))
        if draws.random() < self._advice.share:
            self._draws[vehicle] = draws
            self._due.setdefault(int(self._sumo.time()), []).append(vehicle)

    def _advise(self, vehicle: str) -> None:
        sumo = self._sumo
        lane = sumo.lane_of(vehicle)
        follows = self._draws[vehicle].random() < self._advice.compliance
        if not follows or not lane or lane.startswith(":"):
            return
        route = tuple(sumo.route(vehicle)[sumo.route_index(vehicle) :])
        is_late = sumo.lane.getLength(lane) - sumo.lane_position(vehicle) < LEAST_LEFT_M
        fixed = route[: 1 + is_late]
        if len(route) <= len(fixed):
            return
        saved_s, way = self._router.offer(route[len(fixed) - 1 :])
        if saved_s >= self._advice.least_s and way:
            try:
                sumo.keep_to(vehicle, (*fixed[:-1], *way))
            except sumo.refusals:  # such as a stop that the way leaves out
                return


def take(running: Running, intervention: AnyIncident | Advice | SignalControl, seed: int) -> None:
    """Takes an intervention now; the times of incidents count from the end of the warm-up.

    Raises ScenarioError: it does not fit the network."""
    world = running.world
    match intervention:
        case Advice():  # with a search of its own
            router = Router(running.sumo, world.network, world.congestion, SEARCHING_TYPE)
            running.watchers.append(_Advisor(running.sumo, router, intervention, seed))
        case SignalControl():
            if not control(running.sumo, intervention):
                raise ScenarioError("the network has no signals to control in another way")
        case _:
            world.stage(intervention)


def flow(running: Running, duration_s: float, every_s: float) -> tuple[FlowSummary, ...]:
    """Lets the traffic run without an ego; returns its state now and at the end of every period.

    Args:
        duration_s: how long, a multiple of the period.
        every_s: the period, a multiple of the step."""
    summaries = [_summary(running, (), Counter())]
    for number in range(round(duration_s / every_s)):
        running.done = number * every_s, duration_s
        queues, at_stops = [], Counter[str]()
        for _ in range(round(every_s / QUEUE_PERIOD_S)):
            run_on(running, QUEUE_PERIOD_S)
            queues.append(running.watcher(Ledger).queues_m())
            if running.world.slowed():
                at_stops.update(running.watcher(Ledger).at_stops())
        summaries.append(_summary(running, tuple(queues), at_stops))
    return tuple(summaries)


def _summary(running: Running, queues: tuple[dict[str, float], ...], at_stops: Counter[str]) -> FlowSummary:
    ledger, world = running.watcher(Ledger), running.world
    return FlowSummary(
        ledger.summary(),
        len(ledger.arrivals_s),
        queues,
        {edge: (share, at_stops[edge] * QUEUE_PERIOD_S) for edge, share in world.slowed().items()},
        ledger.consumed_by_class(),
        world.detours.cut_short,
        world.detours.kept_in,
    )


def control(sumo: LibSumo, signals: SignalControl) -> int:
    """Changes the control of all signals but those of railways; returns how many there are."""
    lights: Any = sumo.lights
    count = 0
    for light in sumo.light_ids():
        current = lights.getProgram(light)
        (logic,) = (each for each in lights.getAllProgramLogics(light) if each.programID == current)
        if logic.type in TRAINS:
            continue
        count += 1
        phases = [lights.Phase(each.duration, each.state, *_bounds(each)) for each in logic.phases]
        name = f"automotive_cosim.{signals.control}"
        lights.setProgramLogic(light, lights.Logic(name, CONTROLS[signals.control], 0, phases))
        lights.setProgram(light, name)
    return count


def _bounds(phase: Any) -> tuple[float, float]:
    """The shortest and the longest duration of a phase; only greens vary."""
    if "y" in phase.state.lower() or "g" not in phase.state.lower():
        return phase.duration, phase.duration
    return min(LEAST_GREEN_S, phase.duration), max(MOST_GREEN_S, phase.duration)
