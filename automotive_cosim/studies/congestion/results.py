"""Reads the results of a congestion study, and makes the figures that traffic engineers use.

| figure | what it is |
|---|---|
| delay | time lost on the road (SUMO's ``timeLoss``) and waited outside for room to enter |
| travel time index (TTI) | time of all vehicles divided by what their distances take without congestion |
| planning time index (PTI) | 95th percentile of the travel time indices of all five minutes of all seeds |
| buffer index | what that exceeds the mean by, as a share of the mean |

TTI, PTI and buffer index are FHWA's (Travel Time Reliability: Making It There On Time, All The Time, 2006), with
seeds for days; five minutes count by the distance driven in them, as free-flow time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from automotive_cosim.contracts import Json
from automotive_cosim.studies.congestion.outputs import EDGES, read_edges
from automotive_cosim.studies.congestion.plan import EPOCH_S, INTERVAL_S, CongestionPlan
from automotive_cosim.studies.congestion.rows import CongestionRow, EdgeRow, FlowCell, FlowSums, InterventionOutcome
from automotive_cosim.studies.content import StudyContent
from automotive_cosim.studies.intervals import SeedMean, seed_mean

LATE = 0.95
"""Quantile of the planning time index."""

HOUR_S = 3_600.0


@dataclass(frozen=True)
class CongestionStudy(StudyContent[CongestionPlan, CongestionRow]):
    """The content of a congestion study's folder, with a row per seed."""

    plan_type = CongestionPlan
    row_type = CongestionRow
    line_is = "seed and intervention"

    def lines(self) -> Iterator[Json]:
        """Every seed without an intervention, and with each."""
        plan = self.plan
        for row in self.rows:
            for outcome in row.outcomes:
                flow = flow_in(plan, outcome)
                yield {
                    "scenario": row.scenario,
                    "seed": row.seed,
                    "intervention": outcome.intervention or None,
                    "delay_vehicle_h_per_h": delay_h(plan, outcome),
                    "driven_km": flow.distance_m / 1000,
                    "time_h": flow.time_s / HOUR_S,
                    "lost_h": flow.lost_s / HOUR_S,
                    "waited_h": waited_s(plan, outcome) / HOUR_S,
                    "arrived_per_h": throughput_per_h(plan, outcome),
                    "co2_g": sum(each.co2_g for each in outcome.emitted),
                    "cut_short": outcome.cut_short,
                    "kept_in": outcome.kept_in,
                    "gridlock": outcome.gridlock or None,
                }

    @property
    def interventions(self) -> tuple[str, ...]:
        """No intervention, then all of the plan."""
        return ("", *self.plan.interventions)

    def outcomes(self, intervention: str) -> Iterator[tuple[int, InterventionOutcome]]:
        """Seed and outcome of an intervention."""
        for row in self.rows:
            for each in row.outcomes:
                if each.intervention == intervention:
                    yield row.seed, each

    @property
    def classes(self) -> tuple[str, ...]:
        """Classes of road, those with the most driving first."""
        driven: dict[str, float] = {}
        for _, outcome in self.outcomes(""):
            for cell in outcome.cells:
                driven[cell.road_class] = driven.get(cell.road_class, 0.0) + cell.flow.distance_m
        return tuple(sorted(driven, key=lambda name: -driven[name]))

    @cached_property
    def edges(self) -> dict[tuple[int, str, float], FlowSums]:
        """The flow by number of the intervention, edge and minute, summed over the seeds."""
        sums: dict[tuple[int, str, float], FlowSums] = {}
        for row in self.rows:
            for each in read_edges(self.folder / EDGES / f"{row.id}.csv.gz"):
                key = each.intervention, each.edge, each.from_s
                sums[key] = sums.get(key, FlowSums()) + _flow(each)
        return sums


def _flow(row: EdgeRow) -> FlowSums:
    return FlowSums(time_s=row.time_s, lost_s=row.lost_s, distance_m=row.distance_m)


@dataclass(frozen=True, slots=True)
class NetworkPart:
    """The part of a study that a figure is about: a class of road, a period of the demand, or all."""

    road_class: str | None = None
    period: int | None = None

    def cells(self, plan: CongestionPlan, outcome: InterventionOutcome) -> Iterator[FlowCell]:
        for cell in outcome.cells:
            if self.road_class in (None, cell.road_class) and self.period in (
                None,
                int(cell.from_s // plan.period_s),
            ):
                yield cell

    def hours(self, plan: CongestionPlan) -> float:
        """How long it lasts."""
        return (plan.duration_s if self.period is None else plan.period_s) / HOUR_S


WHOLE = NetworkPart()


def flow_in(plan: CongestionPlan, outcome: InterventionOutcome, part: NetworkPart = WHOLE) -> FlowSums:
    """The flow of a part."""
    return sum((cell.flow for cell in part.cells(plan, outcome)), FlowSums())


def waited_s(plan: CongestionPlan, outcome: InterventionOutcome, part: NetworkPart = WHOLE) -> float:
    """Vehicle-seconds outside, waiting for room to enter; only of all classes of road together."""
    states = [s for s in outcome.states[1:] if part.period in (None, int((s.at_s - 1) // plan.period_s))]
    return 0.0 if part.road_class else sum(each.backlog for each in states) * INTERVAL_S


def delay_h(plan: CongestionPlan, outcome: InterventionOutcome, part: NetworkPart = WHOLE) -> float:
    """Vehicle-hours of delay per hour; of a class of road alone, of time lost on it."""
    lost_s = flow_in(plan, outcome, part).lost_s + waited_s(plan, outcome, part)
    return lost_s / HOUR_S / part.hours(plan)


def detour_h(plan: CongestionPlan, before: InterventionOutcome, after: InterventionOutcome) -> float:
    """Vehicle-hours per hour that what is driven more takes without congestion; negative if less is driven."""
    free_s = flow_in(plan, after).free_s - flow_in(plan, before).free_s
    return free_s / HOUR_S / WHOLE.hours(plan)


def throughput_per_h(plan: CongestionPlan, outcome: InterventionOutcome, part: NetworkPart = WHOLE) -> float:
    """Arrivals per hour."""
    first_s = 0.0 if part.period is None else part.period * plan.period_s
    last_s = first_s + part.hours(plan) * HOUR_S
    arrived = {each.at_s: each.arrived for each in outcome.states}
    return (arrived[last_s] - arrived[first_s]) / part.hours(plan)


def queue_m(plan: CongestionPlan, outcome: InterventionOutcome, part: NetworkPart = WHOLE) -> tuple[float, float]:
    """Mean total length of the queues, and the longest one of a lane, in m."""
    found = list(part.cells(plan, outcome))
    epochs = part.hours(plan) * HOUR_S / EPOCH_S
    return sum(cell.queue_m for cell in found) / epochs, max((cell.longest_m for cell in found), default=0.0)


@dataclass(frozen=True, slots=True)
class Indices:
    """The indices of a part."""

    travel_time: float
    planning_time: float

    @property
    def buffer(self) -> float:
        """What the 95th percentile exceeds the mean by, as a share of the mean."""
        return self.planning_time / self.travel_time - 1


def indices(
    plan: CongestionPlan, outcomes: Iterable[InterventionOutcome], part: NetworkPart = WHOLE
) -> Indices | None:
    """The indices over all seeds and five minutes; None if nobody drove there."""
    epochs: dict[tuple[int, float], FlowSums] = {}
    for number, outcome in enumerate(outcomes):
        for cell in part.cells(plan, outcome):
            key = number, cell.from_s
            epochs[key] = epochs.get(key, FlowSums()) + cell.flow
    driven = [flow for flow in epochs.values() if flow.free_s > 0]
    if not driven:
        return None
    free_s = np.array([flow.free_s for flow in driven])
    index = np.array([flow.time_s for flow in driven]) / free_s
    order = np.argsort(index)
    reached = np.cumsum(free_s[order]) / free_s.sum()
    late = float(index[order][int(np.searchsorted(reached, LATE))])
    return Indices(float((index * free_s).sum() / free_s.sum()), late)


def strongest(study: CongestionStudy) -> int:
    """Number of the intervention that changes the delay most; 0 without interventions."""
    changes = [change(study, intervention) for intervention in study.plan.interventions]
    sizes = [0.0 if each is None else abs(each.value) for each in changes]
    return 1 + sizes.index(max(sizes)) if sizes else 0


def change(study: CongestionStudy, intervention: str, part: NetworkPart = WHOLE) -> SeedMean | None:
    """What an intervention adds to the delay, in vehicle-hours per hour, seed by seed."""
    return paired(
        study, intervention, lambda one, two: delay_h(study.plan, two, part) - delay_h(study.plan, one, part)
    )


def cost(study: CongestionStudy, intervention: str) -> SeedMean | None:
    """What an intervention costs in delay and detours, in vehicle-hours per hour, seed by seed."""
    plan = study.plan
    return paired(
        study, intervention, lambda one, two: delay_h(plan, two) - delay_h(plan, one) + detour_h(plan, one, two)
    )


def paired(
    study: CongestionStudy, intervention: str, of: Callable[[InterventionOutcome, InterventionOutcome], float]
) -> SeedMean | None:
    """The mean of a figure of the traffic without and with an intervention, seed by seed."""
    before = dict(study.outcomes(""))
    return seed_mean((seed, of(before[seed], outcome)) for seed, outcome in study.outcomes(intervention))
