"""Drives a demand in SUMO and measures what passes where, and when."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from contextlib import closing
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from automotive_cosim.studies.calibration.capacity import Movement
from automotive_cosim.studies.equilibrium.gap import DrivenTrip, read_trips
from automotive_cosim.traffic.options import command_line
from automotive_cosim.traffic.stability import FEW_VEHICLES, summary

HOUR_S = 3600.0

FULL_S = 100.0
"""A turn is full if its vehicles lose this much on the edge before it: more than they would wait at a red light."""


@dataclass(frozen=True, slots=True)
class CountedTime:
    """The time that is simulated: a warm-up, then the counted hours in a row."""

    begin_s: float
    warm_up_s: float
    hours: int

    @property
    def first_s(self) -> float:
        """When the first counted hour begins."""
        return self.begin_s + self.warm_up_s

    @property
    def end_s(self) -> float:
        """When the last one ends."""
        return self.first_s + self.hours * HOUR_S

    def hour(self, time_s: float) -> int:
        """The index of the counted hour of an instant; below 0 or too large outside of all."""
        return int((time_s - self.first_s) // HOUR_S)


@dataclass(frozen=True, slots=True)
class DrivenDemand:
    """What one simulation carried."""

    trips: tuple[DrivenTrip, ...]
    flows: Mapping[tuple[str, int], int]
    """Edge and hour -> vehicles that left the edge."""
    teleports: int
    """Since the end of the warm-up."""
    backlog: int
    """Vehicles that could not enter the network by the end."""
    halted_share: float
    """Share of the vehicles that stand, mean of the last half of the last hour."""

    def full_turns(self, clock: CountedTime, free_s: Mapping[str, float]) -> dict[tuple[Movement, int], int]:
        """Turn and hour -> vehicles served, for the turns that served fewer than came.

        Those whose next edge is just as slow are left out: the queue there began farther on."""
        lost_s: dict[tuple[Movement, int], list[float]] = defaultdict(list)
        left: Counter[tuple[Movement, int]] = Counter()
        for trip in self.trips:
            entered_s = trip.departed_s
            for turn, left_s in zip(pairwise(trip.edges), trip.exits_s, strict=False):
                until_s = left_s if left_s >= 0 else clock.end_s
                key = turn, clock.hour(until_s - 1e-6)
                lost_s[key].append(until_s - entered_s - free_s.get(turn[0], 0.0))
                if left_s < 0:
                    break
                left[key] += 1
                entered_s = left_s
        means_s = {key: sum(each) / len(each) for key, each in lost_s.items()}
        slow = {(edge, hour) for ((edge, _), hour), mean_s in means_s.items() if mean_s > FULL_S}
        return {
            (turn, hour): left[turn, hour]
            for (turn, hour), mean_s in means_s.items()
            if mean_s > FULL_S and (turn[1], hour) not in slow and 0 <= hour < clock.hours
        }

    def mean_time_s(self, start: str, goal: str, hour: int, clock: CountedTime) -> float | None:
        """Mean time from the end of one edge to that of another of those who left the first in an hour; None if
        nobody did."""
        found = []
        for trip in self.trips:
            if start in trip.edges and goal in trip.edges:
                left_s, arrived_s = (trip.exits_s[trip.edges.index(edge)] for edge in (start, goal))
                if 0 <= left_s < arrived_s and clock.hour(left_s) == hour:
                    found.append(arrived_s - left_s)
        return round(sum(found) / len(found), 1) if found else None


def drive(config: str, options: Mapping[str, str], clock: CountedTime, scratch: Path) -> DrivenDemand:
    """Drives what the options name.

    Args:
        config: the scenario's configuration, for error texts.

    Raises:
        ScenarioError: SUMO refuses the scenario; the message is SUMO's.
        TrafficError: SUMO hung or was killed.
        SetupError: eclipse-sumo is not installed."""
    driven = scratch / "driven.xml"
    whole = dict(options) | {
        "begin": f"{clock.begin_s:g}",
        "end": f"{clock.end_s:g}",
        "summary-output": "stdout",
        "vehroute-output": driven.name,
        "vehroute-output.exit-times": "true",
        "vehroute-output.last-route": "true",
        "vehroute-output.write-unfinished": "true",
    }
    before, teleports, backlog, halting, running = 0, 0, 0, 0.0, 0.0
    with closing(summary(config, command_line(whole)[1:], scratch)) as steps:
        for step in steps:
            teleports, backlog = int(step["teleports"]), int(step["waiting"])
            if step["time"] <= clock.first_s:
                before = teleports
            if step["time"] > clock.end_s - HOUR_S / 2:
                halting += step["halting"]
                running += max(step["running"], FEW_VEHICLES)
    trips = tuple(sorted(read_trips(driven), key=lambda trip: trip.departed_s))
    return DrivenDemand(trips, passed(trips, clock), teleports - before, backlog, halting / max(1.0, running))


def passed(trips: Iterable[DrivenTrip], clock: CountedTime) -> dict[tuple[str, int], int]:
    """Edge and hour -> vehicles that left the edge."""
    found: Counter[tuple[str, int]] = Counter()
    for trip in trips:
        for edge, left_s in zip(trip.edges, trip.exits_s, strict=True):
            if left_s >= 0:
                found[edge, clock.hour(left_s)] += 1
    return {key: count for key, count in found.items() if 0 <= key[1] < clock.hours}
