"""The routes among which a fit chooses, and how much of the traffic each has before any count is known."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from automotive_cosim.calibration.capacity import Movement
from automotive_cosim.calibration.driving import HOUR_S, CountedTime
from automotive_cosim.calibration.fit import Floats
from automotive_cosim.scenery.gap import INTERVAL_S, DrivenTrip, EdgeTimes

SENSITIVITY = 0.15
"""Spread of the choice between the routes of one start and end, as a share of the quickest's time (logit)."""

UNSEEN = 0.5
"""Weight of a route that nobody drove in the given demand, in trips."""

Ends = tuple[str, str]
"""First and last edge."""

Passing = tuple[str | Movement, int]
"""An edge or turn, and the hour in which it is left."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """One route."""

    edges: tuple[str, ...]
    type_ids: tuple[str, ...]
    """Vehicle types that may drive it, as often as each did."""
    trips: float
    """How often the given demand has it."""

    @property
    def ends(self) -> Ends:
        """Its first and last edge."""
        return self.edges[0], self.edges[-1]


@dataclass(slots=True)
class Candidates:
    """All routes; new ones are appended, so that an index stays what it is."""

    routes: list[Candidate] = field(default_factory=list)
    weights: dict[Ends, float] = field(default_factory=dict)
    """Trips of each start and end in the given demand."""
    _known: set[tuple[str, ...]] = field(default_factory=set)

    @classmethod
    def of(cls, trips: Iterable[DrivenTrip]) -> Candidates:
        """Those of a demand that was driven."""
        counts: Counter[tuple[str, ...]] = Counter()
        types: dict[tuple[str, ...], list[str]] = {}
        for trip in trips:
            counts[trip.edges] += 1
            types.setdefault(trip.edges, []).append(trip.type_id)
        found = cls()
        for edges, count in counts.items():
            ends = edges[0], edges[-1]
            found.weights[ends] = found.weights.get(ends, 0.0) + count
            found.add(Candidate(edges, tuple(types[edges]), count))
        return found

    def add(self, candidate: Candidate, weight: float = 0.0) -> bool:
        """Adds a route unless it is known; ``weight`` is that of its ends if they are new."""
        if candidate.edges in self._known:
            return False
        self._known.add(candidate.edges)
        self.routes.append(candidate)
        self.weights.setdefault(candidate.ends, weight)
        return True

    def costs_s(self, times: EdgeTimes, free_s: Mapping[str, float], clock: CountedTime) -> Floats:
        """Travel time of each route that begins in the middle of each hour, (hours, routes)."""
        rows = [
            [
                free_s.get(route.edges[0], 0.0) + times.of(route.edges, clock.first_s + (hour + 0.5) * HOUR_S)
                for route in self.routes
            ]
            for hour in range(clock.hours)
        ]
        return np.array(rows)

    def prior(self, costs_s: Floats) -> Floats:
        """Share of all traffic that each route has, (hours, routes); each hour sums to one."""
        index = {ends: number for number, ends in enumerate(self.weights)}
        pair = np.array([index[route.ends] for route in self.routes])
        weight = np.array(list(self.weights.values()))
        seen = np.array([route.trips + UNSEEN for route in self.routes])
        rows = []
        for cost_s in costs_s:
            best_s = np.full(len(weight), np.inf)
            np.minimum.at(best_s, pair, cost_s)
            liked = seen * np.exp(-(cost_s - best_s[pair]) / (SENSITIVITY * np.maximum(best_s[pair], 30.0)))
            total = np.bincount(pair, liked, len(weight))
            share = weight[pair] * liked / total[pair]
            rows.append(np.maximum(share / share.sum(), 1e-12))
        return np.array(rows)


@dataclass(frozen=True, slots=True)
class Passes:
    """When each route passes the edges and turns of interest: entries of a matrix."""

    rows: list[int]
    columns: list[int]
    shares: list[float]


def passes(
    routes: Sequence[Candidate],
    wanted: Mapping[Passing, int],
    times: EdgeTimes,
    free_s: Mapping[str, float],
    clock: CountedTime,
) -> Passes:
    """The share of each route's departures of an hour that leaves an edge, or takes a turn, in each hour.

    Args:
        routes: n routes; column ``hour * n + route`` stands for the departures of one in an hour.
        wanted: edge or turn, and hour -> row.
        times: times of the edges.
        free_s: the same on empty roads, for the first edge.
        clock: the hours.
    """
    found = Passes([], [], [])
    interesting = {name for name, _ in wanted}
    for number, route in enumerate(routes):
        turns = list(pairwise(route.edges))
        if not any(edge in interesting for edge in route.edges) and not any(turn in interesting for turn in turns):
            continue
        for hour in range(clock.hours):
            start_s = clock.first_s + (hour + 0.5) * HOUR_S
            now_s = start_s
            for place, edge in enumerate(route.edges):
                now_s += times.at(edge, int(now_s // INTERVAL_S)) if place else free_s.get(edge, 0.0)
                names = (edge, turns[place]) if place < len(turns) else (edge,)
                for name in names:
                    if name in interesting:
                        _spread(found, wanted, name, hour, hour * len(routes) + number, (now_s - start_s) / HOUR_S)
    return found


def _spread(
    found: Passes,
    wanted: Mapping[Passing, int],
    name: str | Movement,
    hour: int,
    column: int,
    late_h: float,
) -> None:
    """Departures of an hour, spread evenly over it, that pass ``late_h`` hours later; the traffic of the warm-up is
    that of the first hour, and passes in its place."""
    whole, rest = divmod(late_h, 1.0)
    for later, share in ((int(whole), 1 - rest), (int(whole) + 1, rest)):
        row = wanted.get((name, hour + later))
        if row is not None and share > 0:
            found.rows.append(row)
            found.columns.append(column)
            found.shares.append(share)
    if hour == 0:
        for early in range(int(whole) + 1):
            row = wanted.get((name, early))
            share = rest if early == int(whole) else 1.0
            if row is not None and share > 0:
                found.rows.append(row)
                found.columns.append(column)
                found.shares.append(share)
