"""A day of traffic past one counted road, simulated and corrected until the road matches its counts.

Scaling all traffic until the one road is met would lock up the network, since hardly any random trip passes there.
So only the trips that pass the counted road are repeated, as often in each hour as its count requires, and they
never avoid that road when they reroute. All others follow the counted road's profile, so that in the busiest hour
both together equal the traffic that the import found to flow. A day is simulated, the trips are corrected in
proportion, and the next day is simulated.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial
from itertools import accumulate
from pathlib import Path
from typing import NamedTuple
from xml.sax.saxutils import quoteattr

import numpy as np

from automotive_cosim.contracts import Tell
from automotive_cosim.osm.counts import GOOD_GEH, HOURS, Counts, geh
from automotive_cosim.osm.demand import Journey, write
from automotive_cosim.scenarios import Scenario
from automotive_cosim.traffic.network import Edge
from automotive_cosim.traffic.options import Setup, command_line, read_configuration, run_options
from automotive_cosim.traffic.stability import StepFigures, summary

HOUR_S = 3600.0

WARM_UP_S = 900.0
"""Traffic before the ego departs."""

ENOUGH_GEH = 2.0
"""No further day is simulated once every GEH is this small; other seeds will do a little worse."""

CHANGE_MAX = 2.0
"""An hour's trips are at most doubled or halved from one day to the next, and never more than twice the count: a
road that does not carry more when more is sent is full, and the surplus stands on other roads."""

LOOK_EVERY_S = 1.0
"""How often to sample how many vehicles are halted; SUMO's lines are also its signs of life, and come in bursts."""


@dataclass(frozen=True, slots=True)
class Hour:
    """One local hour of the counted road, and of the network around it."""

    hour: int
    counted_per_h: float
    simulated_per_h: float
    """Distance driven on the counted edges divided by their length: vehicles per hour, also on several edges."""
    geh: float
    counted_occupancy: float | None
    """Share of time with a vehicle over the detector; None if the counts do not say."""
    simulated_occupancy: float
    """Share of the counted edges' lanes that vehicles cover, mean of the hour. The detector's share of time is
    somewhat higher, because a vehicle leaves it only with its tail."""
    passing: int
    """Number of trips sent past the counted road."""
    background: int
    """Number of other trips."""
    running: float
    """Vehicles in the network, mean."""
    halted_share: float
    """Share of them that are halted."""
    teleports: int
    """Vehicles that SUMO teleported after standing for 300 s, or that were stuck otherwise."""

    @property
    def is_met(self) -> bool:
        """Whether the GEH of the flow is below 5."""
        return self.geh < GOOD_GEH


class Span(NamedTuple):
    """A span of time with the traffic of one hour."""

    hour: int
    start_s: float
    length_s: float


WHOLE_DAY = tuple(Span(hour, hour * HOUR_S, HOUR_S) for hour in range(HOURS))


def _tried(minutes: float) -> tuple[Span, ...]:
    """A number of minutes of each hour in a row, after a warm-up with the traffic before midnight."""
    length_s = minutes * 60
    hours = (Span(hour, WARM_UP_S + hour * length_s, length_s) for hour in range(HOURS))
    return (Span(HOURS - 1, 0.0, WARM_UP_S), *hours)


@dataclass(frozen=True, slots=True)
class Demand:
    """Trips that can be repeated, and their numbers per hour."""

    passing: tuple[Journey, ...]
    """Trips over the counted road; ``depart_s`` is the departure relative to passing it, below 0."""
    others: tuple[Journey, ...]
    counted: tuple[Edge, ...]
    counts: Counts
    background: float
    """Other trips of the busiest hour, as a share of the import's."""
    others_per_h: tuple[int, ...]
    seed: int

    def journeys(self, sent: Sequence[float], spans: Sequence[Span]) -> tuple[Journey, ...]:
        """Traffic in order of departure.

        Args:
            sent: number of trips over the counted road in each hour.
            spans: the parts of the hours to simulate, and when.
        """
        made: list[Journey] = []
        for kind, (choice, counts) in enumerate(((self.passing, sent), (self.others, self.others_per_h))):
            for number, span in enumerate(spans if choice else ()):
                # Span by span, so that one more trip in an hour leaves all the others as they are.
                seed, count = (self.seed, kind, number), round(counts[span.hour] * span.length_s / HOUR_S)
                times = np.random.default_rng((*seed, 0)).uniform(span.start_s, span.start_s + span.length_s, count)
                which = np.random.default_rng((*seed, 1)).integers(len(choice), size=count)
                made += [
                    replace(choice[index], depart_s=max(0.0, time_s + choice[index].depart_s))
                    for time_s, index in zip(times.tolist(), which.tolist(), strict=True)
                ]
        return tuple(sorted(made, key=lambda journey: journey.depart_s))


def make_demand(
    ways: Sequence[tuple[Edge, ...]],
    per_h: float,
    counted: Sequence[Edge],
    counts: Counts,
    *,
    background: float | None,
    seed: int,
) -> Demand:
    """Divides an import's trips by whether they pass the counted road.

    Args:
        ways: the fastest route of each trip.
        per_h: departures per hour in the import.
        counted: edges of the counted road.
        counts: its counts.
        background: other traffic in the busiest hour, as a share of the import's; None takes the rest beside
            the counted traffic.
        seed: seed of departures and of SUMO.
    """
    ids = {edge.edge_id for edge in counted}
    passing: list[Journey] = []
    others: list[Journey] = []
    for way in ways:
        first = next((place for place, edge in enumerate(way) if edge.edge_id in ids), None)
        if first is None:
            others.append(Journey(0.0, way))
        else:
            lead_s = sum(edge.length_m / edge.speed_mps for edge in way[:first])
            # SUMO removes a via when the vehicle enters it, which one that departs there never does.
            passing.append(Journey(-lead_s, way, via=way[first].edge_id if first else ""))
    busiest = max(counts.flow_per_h)
    others_per_h = per_h * len(others) / len(ways)
    if background is None:
        background = round(max(0.0, per_h - busiest) / others_per_h, 2) if others else 0.0
    return Demand(
        passing=tuple(passing),
        others=tuple(others),
        counted=tuple(counted),
        counts=counts,
        background=background,
        others_per_h=tuple(round(others_per_h * background * flow / busiest) for flow in counts.flow_per_h),
        seed=seed,
    )


@dataclass(frozen=True, slots=True)
class Fitted:
    """The best of the simulated days."""

    sent: tuple[float, ...]
    """Trips over the counted road in each hour."""
    hours: tuple[Hour, ...]
    met: tuple[int, ...]
    """Hours with a GEH below 5 in each simulated day."""


def fit(
    scenario: Scenario,
    trips_file: Path,
    demand: Demand,
    *,
    days: int,
    minutes: float,
    scratch: Path,
    tell: Tell,
) -> Fitted:
    """Simulates days until the counts are met.

    Args:
        scenario: the scenario to simulate.
        trips_file: the scenario's trips; each day writes its own there.
        demand: the trips to send.
        days: maximum number of days to simulate.
        minutes: minutes of each hour to simulate.
        scratch: a folder for intermediate files.
        tell: called with the current activity.

    Raises:
        ScenarioError: SUMO refuses the scenario.
        TrafficError: SUMO hung or was killed.
        SetupError: eclipse-sumo is not installed.
    """
    sent = demand.counts.flow_per_h
    tried: list[tuple[tuple[float, ...], tuple[Hour, ...]]] = []
    for number in range(days):
        stage = partial(tell, f"simulating day {number + 1} of at most {days}")
        hours = _drive(scenario, trips_file, demand, sent, minutes, scratch, stage)
        tried.append((sent, hours))
        if all(each.geh < ENOUGH_GEH for each in hours):
            break
        sent = tuple(_next(before, each) for before, each in zip(sent, hours, strict=True))
    best_sent, best_hours = max(tried, key=lambda day: _quality(day[1]))
    return Fitted(best_sent, best_hours, tuple(sum(each.is_met for each in hours) for _, hours in tried))


def _next(sent: float, hour: Hour) -> float:
    """The number of trips to send in an hour, given that ``sent`` were sent before."""
    if not hour.simulated_per_h:
        return min(sent * CHANGE_MAX, hour.counted_per_h * CHANGE_MAX)
    change = hour.counted_per_h / hour.simulated_per_h
    return min(sent * min(CHANGE_MAX, max(1 / CHANGE_MAX, change)), hour.counted_per_h * CHANGE_MAX)


def _quality(hours: Sequence[Hour]) -> tuple[int, float]:
    return sum(each.is_met for each in hours), -sum(each.geh for each in hours)


def _drive(
    scenario: Scenario,
    trips_file: Path,
    demand: Demand,
    sent: Sequence[float],
    minutes: float,
    scratch: Path,
    tell: Callable[[float], None],
) -> tuple[Hour, ...]:
    """Simulates a day, or part of each hour, and measures the counted road."""
    spans = _tried(minutes)
    length_s, end_s = spans[-1].length_s, spans[-1].start_s + spans[-1].length_s
    write(demand.journeys(sent, spans), trips_file)
    measured, collector = scratch / "counted.xml", scratch / "counted.add.xml"
    edges = " ".join(edge.edge_id for edge in demand.counted)
    collector.write_text(
        f'<additional><edgeData id="counted" file={quoteattr(str(measured))} edges={quoteattr(edges)}'
        f' begin="{WARM_UP_S:g}" period="{length_s:g}"/></additional>',
        encoding="utf-8",
    )
    setup = Setup(scenario, seed=demand.seed)
    options = run_options(read_configuration(scenario.config), setup, scratch) | {
        "begin": "0",
        "end": f"{end_s:g}",
        "additional-files": str(collector),
        "summary-output": "stdout",
        "summary-output.period": f"{LOOK_EVERY_S:g}",
    }
    looks = [_Look() for _ in range(HOURS)]
    with closing(summary(scenario.config.name, command_line(options)[1:], scratch)) as steps:
        for step in steps:
            if step["time"] >= WARM_UP_S:
                looks[min(HOURS - 1, int((step["time"] - WARM_UP_S) // length_s))].add(step)
            tell(step["time"] / end_s)
    teleports = [0, *accumulate((look.teleports for look in looks), max)]
    road = _read_measured(measured, demand.counted, length_s)
    counts = demand.counts
    return tuple(
        Hour(
            hour=hour,
            counted_per_h=counts.flow_per_h[hour],
            simulated_per_h=round(flow_per_h, 1),
            geh=round(geh(flow_per_h, counts.flow_per_h[hour]), 2),
            counted_occupancy=counts.occupancy[hour] if counts.occupancy else None,
            simulated_occupancy=round(occupancy, 4),
            passing=round(sent[hour]),
            background=demand.others_per_h[hour],
            running=round(look.running / max(1, look.count), 1),
            halted_share=round(look.halting / max(1.0, look.running), 4),
            teleports=look.teleports - teleports[hour],
        )
        for hour, ((flow_per_h, occupancy), look) in enumerate(zip(road, looks, strict=True))
    )


@dataclass(slots=True)
class _Look:
    """Adds up SUMO's summary over an hour."""

    count: int = 0
    running: float = 0.0
    halting: float = 0.0
    teleports: int = 0
    """Seconds since the day began."""

    def add(self, step: StepFigures) -> None:
        self.count += 1
        self.running += step["running"]
        self.halting += step["halting"]
        self.teleports = int(step["teleports"])


def _read_measured(file: Path, counted: Sequence[Edge], length_s: float) -> list[tuple[float, float]]:
    """Flow (vehicles per hour) and occupancy (0 to 1) of the counted road in each interval of ``length_s``.

    The flow is Edie's: distance driven divided by the length of road and of time, also valid for several edges.
    """
    length_m = {edge.edge_id: edge.length_m for edge in counted}
    lane_m = {edge.edge_id: edge.length_m * len(edge.lane_ids) for edge in counted}
    found: list[tuple[float, float]] = []
    for interval in ET.parse(file).iter("interval"):
        rows = {row.get("id", ""): row for row in interval.iter("edge")}
        driven_m = sum(float(row.get("sampledSeconds", 0)) * float(row.get("speed", 0)) for row in rows.values())
        covered = sum(lane_m[name] * float(row.get("occupancy", 0)) / 100 for name, row in rows.items())
        found.append((driven_m / sum(length_m.values()) * HOUR_S / length_s, covered / sum(lane_m.values())))
    return found
