"""A system optimum to compare an equilibrium with: routes with a lower total travel time.

In an equilibrium everyone takes the route that is quickest for themselves; in a system optimum, the one whose
marginal time is least: their own time and what they cost all others (Wardrop's second principle). On a road whose
time is t0 (1 + a (q / c)^b), the formula of the Bureau of Public Roads, one more vehicle costs the others b (t -
t0), whatever the capacity. Here t is what a micro simulation measured in five minutes, red lights and queues
included, and t0 the least that an edge took in any five minutes so far.

A micro simulation has no such formula, so the result is not a proven optimum. Total times are measured, though:
from the planned departures to the arrivals of all trips that count, in simulations with seeds of their own. Their
ratio, the price of anarchy, is at least the one printed.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from importlib.util import find_spec
from pathlib import Path
from statistics import fmean, stdev

import numpy as np

from automotive_cosim.contracts import Json
from automotive_cosim.errors import ScenarioError, SetupError, install_hint
from automotive_cosim.formats.xml import read_tree
from automotive_cosim.scenarios import variant
from automotive_cosim.studies.equilibrium.equilibrium import ROUTES, Assigned, changes, is_stuck, opened, rerouted
from automotive_cosim.studies.equilibrium.gap import TAIL_S, DrivenTrip, EdgeTimes, drive, run, vehicle_types
from automotive_cosim.studies.equilibrium.settings import EquilibriumSettings
from automotive_cosim.traffic.options import copied, read_configuration

RECORD = "optimum.json"

POWER = 4.0
"""b: the exponent of the Bureau of Public Roads (Traffic Assignment Manual, 1964)."""


@dataclass(frozen=True, slots=True)
class StateTotal:
    """What all trips that count took together in one simulation."""

    trips: int
    total_s: float
    """From the planned departures to the arrivals; to the end of the simulation for those not there yet."""
    unfinished: int
    """Trips that had not arrived at the end."""
    teleports: int

    @property
    def mean_s(self) -> float:
        """Mean travel time per trip, in seconds."""
        return self.total_s / max(1, self.trips)


@dataclass(frozen=True, slots=True)
class OptimumStep:
    """One step of the search."""

    number: int
    """0 is the equilibrium."""
    total: StateTotal
    changed: int
    """Trips that get another route for the next step."""


@dataclass(frozen=True, slots=True)
class SystemOptimum:
    """An equilibrium beside the best that was found."""

    steps: tuple[OptimumStep, ...]
    kept: int
    """Number of the step with the least total."""
    equilibrium: tuple[StateTotal, ...]
    """With each of the seeds that the search did not use."""
    optimum: tuple[StateTotal, ...]
    """With the same seeds."""

    @property
    def ratios(self) -> tuple[float, ...]:
        """Total time of the equilibrium by that of the optimum, for each seed."""
        pairs = zip(self.equilibrium, self.optimum, strict=True)
        return tuple(own.total_s / best.total_s if best.total_s else 1.0 for own, best in pairs)

    @property
    def price_of_anarchy(self) -> float:
        """Mean of the ratios."""
        return fmean(self.ratios)

    @property
    def interval(self) -> tuple[float, float]:
        """Bounds of its 95 % t interval over seeds, of which there are two or more."""
        from scipy.special import stdtrit

        count = len(self.ratios)
        reach = float(stdtrit(count - 1, 0.975)) * stdev(self.ratios) / count**0.5
        return self.price_of_anarchy - reach, self.price_of_anarchy + reach

    def as_json(self) -> Json:
        """All of it, with the price of anarchy and its bounds."""
        return asdict(self) | {"price_of_anarchy": self.price_of_anarchy, "interval": list(self.interval)}


def compare(
    folder: Path,
    target: Path,
    options: EquilibriumSettings,
    seeds: Sequence[int],
    tell: Callable[[OptimumStep], None],
) -> SystemOptimum:
    """Looks for a system optimum from an equilibrium on, and drives both with seeds of their own.

    Args:
        folder: what ``equilibrate`` wrote.
        target: folder of a copy of it on the routes of the best step; it appears once it is complete.
        options: as for the equilibrium; its gap is not used.
        seeds: with which both are driven, two or more, none of them that of the search.

    Raises:
        UserError: the target exists.
        ScenarioError: SUMO refuses the scenario.
        SetupError: eclipse-sumo or scipy is not installed."""
    if find_spec("scipy") is None:
        raise SetupError(f"a system optimum requires scipy: {install_hint('reports')}")
    with variant.new_folder(target) as draft:
        with tempfile.TemporaryDirectory(prefix="automotive-cosim-optimum-") as scratch:
            path = Path(scratch) / ROUTES
            begun = _equilibrium(folder, options, Path(scratch))
            steps, best = _search(begun, options, tell, path)
            kept = min(steps, key=lambda step: step.total.total_s).number
            own, least = (tuple(_driven(each, path, options, seed) for seed in seeds) for each in (begun, best))
        found = SystemOptimum(steps, kept, own, least)
        record: Json = {"options": asdict(options)} | found.as_json()
        variant.write_variant(draft, begun.scenario, begun.configuration, (ROUTES, best.demand), (RECORD, record))
    return found


def _equilibrium(folder: Path, options: EquilibriumSettings, scratch: Path) -> Assigned:
    """The routes of the folder's demand."""
    scenario = opened(folder, options)
    configuration = read_configuration(scenario.config)
    types = vehicle_types(copied(configuration, scratch), ["route-files"])
    trips = []
    for element in read_tree(folder / ROUTES, error=ScenarioError).iter("vehicle"):
        route = element.find("route")
        assert route is not None
        edges = tuple(route.attrib["edges"].split())
        departs_s = float(element.attrib["depart"])
        trips.append(
            DrivenTrip(element.attrib["id"], element.attrib["type"], departs_s, edges, (-1.0,) * len(edges))
        )
    return Assigned(scenario, configuration, types, tuple(trips))


def _search(
    begun: Assigned, options: EquilibriumSettings, tell: Callable[[OptimumStep], None], path: Path
) -> tuple[tuple[OptimumStep, ...], Assigned]:
    """All steps, and the routes of the one with the least total."""
    rng = np.random.default_rng(options.seed)
    calm_s: dict[str, float] = {}

    def marginal(times: EdgeTimes) -> EdgeTimes:
        for edge, least_s in times.least_s.items():
            calm_s[edge] = min(least_s, calm_s.get(edge, least_s))
        return times.raised(calm_s, POWER)

    now = best = begun
    steps: list[OptimumStep] = []
    for number in range(options.steps + 1):
        driven = drive(now.written(path), now.scenario, options.observe_s, options.seed, marginal)
        total = _total(now, driven.trips, driven.gap.teleports, options)
        totals_s = [*(step.total.total_s for step in steps), total.total_s]
        if total.total_s <= min(totals_s):
            best = now
        is_last = number == options.steps or is_stuck(totals_s)
        routes = {} if is_last else changes(driven, 1 / (number + 2), rng)
        steps.append(OptimumStep(number, total, len(routes)))
        tell(steps[-1])
        if not routes:
            break
        now = rerouted(now, routes)
    return tuple(steps), best


def _driven(assigned: Assigned, path: Path, options: EquilibriumSettings, seed: int) -> StateTotal:
    """What the trips take with a seed."""
    with tempfile.TemporaryDirectory(prefix="automotive-cosim-optimum-") as scratch:
        ran = run(assigned.written(path), assigned.scenario, options.observe_s, seed, Path(scratch))
    return _total(assigned, ran.trips, ran.teleports, options)


def _total(
    assigned: Assigned, trips: tuple[DrivenTrip, ...], teleports: int, options: EquilibriumSettings
) -> StateTotal:
    """The total of the trips that count: those planned after the warm-up."""
    first_s = assigned.configuration.begin_s + assigned.scenario.sumo.warm_up_s
    end_s = first_s + options.observe_s + TAIL_S
    arrived_s = {trip.id: trip.exits_s[-1] for trip in trips if trip.has_arrived}
    planned = [trip for trip in assigned.trips if trip.departed_s >= first_s]
    return StateTotal(
        trips=len(planned),
        total_s=sum(arrived_s.get(trip.id, end_s) - trip.departed_s for trip in planned),
        unfinished=sum(trip.id not in arrived_s for trip in planned),
        teleports=teleports,
    )
