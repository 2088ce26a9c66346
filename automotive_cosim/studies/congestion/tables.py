"""The tables of a congestion study."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from datetime import timedelta
from statistics import fmean

from automotive_cosim.contracts import KMH_PER_MPS
from automotive_cosim.report.tables import Table, TableRecord, TableRow
from automotive_cosim.studies.congestion.results import (
    HOUR_S,
    WHOLE,
    CongestionStudy,
    NetworkPart,
    change,
    cost,
    delay_h,
    detour_h,
    flow_in,
    indices,
    paired,
    queue_m,
    strongest,
    throughput_per_h,
    waited_s,
)
from automotive_cosim.studies.congestion.rows import Emitted, FlowSums, InterventionOutcome
from automotive_cosim.studies.congestion.words import name_of
from automotive_cosim.studies.intervals import LEAST_SEEDS, seed_mean
from automotive_cosim.studies.reroute.tables import NONE, errors_table, told, told_mean
from automotive_cosim.traffic.network import Network, read_network
from automotive_cosim.traffic.options import read_configuration

WORST = 15
"""Roads in the table of those where the time lost changes most."""


def tables(study: CongestionStudy) -> list[Table]:
    """All tables that apply, the most important first."""
    made = (whole(study), by_class(study), emissions(study), roads(study), errors(study))
    return [table for table in made if table.rows]


def mean(study: CongestionStudy, intervention: str, of: Callable[[InterventionOutcome], float]) -> float:
    """The mean of a figure over the seeds."""
    found = [of(outcome) for _, outcome in study.outcomes(intervention)]
    return fmean(found) if found else 0.0


def whole(study: CongestionStudy) -> Table:
    """The network as a whole, without an intervention and with each."""
    plan = study.plan
    rows: list[TableRecord] = []
    for intervention in study.interventions:
        outcomes = [outcome for _, outcome in study.outcomes(intervention)]
        found = indices(plan, outcomes)
        if found is None:
            continue
        flow = sum((flow_in(plan, outcome) for outcome in outcomes), FlowSums())
        before_h = mean(study, "", lambda each: delay_h(plan, each))
        added = change(study, intervention) if intervention else None
        waiting_s = mean(study, intervention, lambda each: waited_s(plan, each))
        rows.append(
            {
                "Intervention": name_of(intervention),
                "Delay, veh-h/h": f"{mean(study, intervention, lambda each: delay_h(plan, each)):.2f}",
                "Change, veh-h/h": told_mean(added, "+.2f"),
                "Change": NONE if added is None or not before_h else told(added.value / before_h, "+.0%"),
                "Detours, veh-h/h": told_mean(
                    paired(study, intervention, lambda one, two: detour_h(plan, one, two))
                    if intervention
                    else None,
                    "+.2f",
                ),
                "Both, veh-h/h": told_mean(cost(study, intervention) if intervention else None, "+.2f"),
                "Travel time index": f"{found.travel_time:.2f}",
                "Planning time index": f"{found.planning_time:.2f}",
                "Buffer index": f"{found.buffer:.0%}",
                "Mean speed, km/h": f"{KMH_PER_MPS * flow.distance_m / flow.time_s:.1f}",
                "Queues, m": f"{mean(study, intervention, lambda each: queue_m(plan, each)[0]):.0f}",
                "Longest queue, m": f"{max(queue_m(plan, each)[1] for each in outcomes):.0f}",
                "Arrivals per h": f"{mean(study, intervention, lambda each: throughput_per_h(plan, each)):.0f}",
                "Veh-km per h": f"{flow.distance_m / 1000 / len(outcomes) / WHOLE.hours(plan):.0f}",
                "Waiting outside, veh-h/h": f"{waiting_s / HOUR_S / WHOLE.hours(plan):.2f}",
            }
        )
    note = (
        "Means over the seeds. Delay: vehicle-hours of time lost on the road (SUMO's time loss, signals included) "
        "and of waiting outside for room to enter. Change: of the delay, seed by seed, against the copy of the same"
        f" traffic without the intervention; in brackets 95 % t intervals, from {LEAST_SEEDS} seeds. Detours: what "
        "is driven more, in vehicle-hours without congestion; negative if less is driven, as in a jam. Travel time "
        "index: time of all vehicles divided by that of the same distances without congestion; planning time index:"
        " its 95th percentile over all five minutes of all seeds; buffer index: what that exceeds the mean by. "
        "Queues: mean total length; longest: of a lane, in any seed."
    )
    return Table.of("whole", "The network with each intervention", rows, note)


def by_class(study: CongestionStudy) -> Table:
    """The same by class of road and period of the demand."""
    plan = study.plan
    rows: list[TableRecord] = []
    periods = (None, *range(len(plan.demand))) if len(plan.demand) > 1 else (None,)
    for period in periods:
        for road_class in study.classes:
            part = NetworkPart(road_class, period)
            for intervention in study.interventions:
                outcomes = [outcome for _, outcome in study.outcomes(intervention)]
                found = indices(plan, outcomes, part)
                if found is None:
                    continue
                flow = sum((flow_in(plan, outcome, part) for outcome in outcomes), FlowSums())
                queues = [queue_m(plan, outcome, part) for outcome in outcomes]
                rows.append(
                    {
                        **({"Time": period_name(study, period)} if len(periods) > 1 else {}),
                        "Road class": road_class,
                        "Intervention": name_of(intervention),
                        "Time lost, veh-h/h": f"{fmean(delay_h(plan, each, part) for each in outcomes):.2f}",
                        "Change, veh-h/h": told_mean(
                            change(study, intervention, part) if intervention else None, "+.2f"
                        ),
                        "Travel time index": f"{found.travel_time:.2f}",
                        "Planning time index": f"{found.planning_time:.2f}",
                        "Buffer index": f"{found.buffer:.0%}",
                        "Queues, m": f"{fmean(total for total, _ in queues):.0f}",
                        "Longest queue, m": f"{max(longest for _, longest in queues):.0f}",
                        "Veh-km per h": f"{flow.distance_m / 1000 / len(outcomes) / part.hours(plan):.0f}",
                    }
                )
    note = (
        "Classes are OpenStreetMap's. Time lost: on the road, the part of the delay that belongs to a class; "
        "waiting outside belongs to none. Other figures as above."
    )
    title = "By class of road and hour" if len(periods) > 1 else "By class of road"
    return Table.of("by_class", title, rows, note, heads=2 + (len(periods) > 1))


def period_name(study: CongestionStudy, period: int | None) -> str:
    """Clock times of a period with the factor on its demand, as ``08:30 to 09:00, demand × 1.5``."""
    plan = study.plan
    start = plan.opened.start
    if period is None:
        return "all"
    first, last = (start + timedelta(seconds=number * plan.period_s) for number in (period, period + 1))
    return f"{first:%H:%M} to {last:%H:%M}, demand × {plan.demand[period]:g}"


def emissions(study: CongestionStudy) -> Table:
    """What all vehicles emit and consume, by emission class."""
    hours = WHOLE.hours(study.plan)

    def per_h(outcome: InterventionOutcome, name: str, of: Callable[[Emitted], float]) -> float:
        return sum(of(each) for each in outcome.emitted if each.emission_class == name) / hours

    kinds: dict[str, tuple[Callable[[Emitted], float], str]] = {
        "CO2, kg/h": (lambda each: each.co2_g / 1000, ".1f"),
        "NOx, g/h": (lambda each: each.nox_g, ".1f"),
        "Fuel, kg/h": (lambda each: each.fuel_g / 1000, ".1f"),
        "Electricity, kWh/h": (lambda each: each.energy_wh / 1000, ".2f"),
        "Noise, h/h": (lambda each: each.noise_s / HOUR_S, ".2f"),
    }
    named = sorted({each.emission_class for _, outcome in study.outcomes("") for each in outcome.emitted})
    rows: list[TableRow] = []
    for name in named:
        before = dict(study.outcomes(""))
        for intervention in study.interventions:
            cells = []
            for of, form in kinds.values():
                if intervention:
                    added = seed_mean(
                        (seed, per_h(outcome, name, of) - per_h(before[seed], name, of))
                        for seed, outcome in study.outcomes(intervention)
                    )
                    cells.append(told_mean(added, f"+{form}"))
                else:
                    cells.append(f"{fmean(per_h(each, name, of) for each in before.values()):{form}}")
            rows.append((name, name_of(intervention), *cells))
    note = (
        "Without an intervention as it is, with one as the change. Classes are those that the demand's vehicle "
        "types declare (emissionClass), else SUMO's own for the kind of vehicle. Noise is sound energy at the "
        "vehicles (Harmonoise), in hours of a car at 50 km/h, 65 dB(A)."
    )
    columns = "Emission class", "Intervention", *kinds
    return Table("emissions", "Emissions and consumption", columns, tuple(rows), note, heads=2)


def roads(study: CongestionStudy) -> Table:
    """The roads where the strongest intervention changes the time lost most; without any, where most is lost."""
    network = network_of(study)
    rows = [
        (
            network.edges[edge].name or NONE,
            edge,
            f"{before:.2f}",
            *((f"{after:.2f}", told(after - before, "+.2f")) if study.plan.interventions else ()),
        )
        for edge, before, after in worst(study)
    ]
    measured = ("Time lost with the intervention", "Change") if study.plan.interventions else ()
    note = "Vehicle-hours lost on the edge per hour, means over the seeds."
    if study.plan.interventions:
        note = f"{note[:-1]}, with “{name_of(study.interventions[strongest(study)])}”."
    title = (
        "Roads where the time lost changes most" if study.plan.interventions else "Roads where most time is lost"
    )
    return Table("roads", title, ("Street", "Edge", "Time lost", *measured), tuple(rows), note, heads=2)


def worst(study: CongestionStudy, most: int = WORST) -> list[tuple[str, float, float]]:
    """Edges for cars with the vehicle-hours lost on them per hour without and with the strongest intervention."""
    before, after = (lost_on_edges(study, number) for number in (0, strongest(study)))
    known = network_of(study).edges
    by = (
        (lambda edge: after.get(edge, 0.0) - before.get(edge, 0.0))
        if study.plan.interventions
        else before.__getitem__
    )
    named = sorted({edge for edge in (*before, *after) if edge in known}, key=lambda edge: -abs(by(edge)))
    return [(edge, before.get(edge, 0.0), after.get(edge, 0.0)) for edge in named[:most]]


def lost_on_edges(study: CongestionStudy, number: int) -> dict[str, float]:
    """Vehicle-hours lost on every edge per hour with an intervention, mean over the seeds."""
    sums: dict[str, float] = {}
    for (intervention, edge, _), flow in study.edges.items():
        if intervention == number:
            sums[edge] = sums.get(edge, 0.0) + flow.lost_s
    divisor = HOUR_S * WHOLE.hours(study.plan) * max(1, sum(row.error is None for row in study.rows))
    return {edge: lost_s / divisor for edge, lost_s in sums.items()}


def network_of(study: CongestionStudy) -> Network:
    """The network of the scenario."""
    return read_network(read_configuration(study.plan.opened.config).net)


def errors(study: CongestionStudy) -> Table:
    """Seeds that ended in an infrastructure error."""
    return errors_table("Seed", study.errors)


def all_interventions(study: CongestionStudy) -> Iterator[tuple[int, str]]:
    """Number and name of no intervention and of each."""
    for number, intervention in enumerate(study.interventions):
        yield number, name_of(intervention)
