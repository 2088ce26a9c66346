"""The routes among which a fit chooses, and how much of the traffic each has before any count is known."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest

import numpy as np
import numpy.typing as npt

from automotive_cosim.studies.calibration.capacity import Movement
from automotive_cosim.studies.calibration.driving import HOUR_S, CountedTime
from automotive_cosim.studies.calibration.fit import Floats
from automotive_cosim.studies.equilibrium.gap import INTERVAL_S, DrivenTrip, EdgeTimes

SENSITIVITY = 0.15
"""Spread of the choice between the routes of one start and end, as a share of the quickest's time (logit)."""

UNSEEN = 0.5
"""Weight of a route that nobody drove in the given demand, in trips."""

Ints = npt.NDArray[np.int_]

Ends = tuple[str, str]
"""First and last edge."""

Passing = tuple[str | Movement, int]
"""An edge or turn, and the hour in which it is left."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """A route that the calibration may put trips on."""

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
        """The candidates of a demand that was driven."""
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
        starts_s = _starts_s(clock)[:, None]
        left = _Places.of(self.routes).left_s(times, clock, np.repeat(starts_s, len(self.routes), axis=1))
        lasts = np.cumsum([len(route.edges) for route in self.routes]) - 1
        found: Floats = _first_s(self.routes, free_s) + (left[:, lasts] - starts_s)
        return found

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
class _Places:
    """Every edge of every route, one route after the other."""

    index: Mapping[str, int]
    """Edge -> number."""
    edges: Ints
    """(places,), numbers of edges."""
    begins: Ints
    """(routes,), the place of each route's first edge."""
    lengths: Ints
    """(routes,), edges of each route."""

    @classmethod
    def of(cls, routes: Sequence[Candidate]) -> _Places:
        index: dict[str, int] = {}
        edges = np.array([index.setdefault(edge, len(index)) for route in routes for edge in route.edges])
        lengths = np.array([len(route.edges) for route in routes])
        return cls(index, edges, np.cumsum(lengths) - lengths, lengths)

    def left_s(self, times: EdgeTimes, clock: CountedTime, first_left_s: Floats) -> Floats:
        """When each place is left, (hours, places).

        Args:
            first_left_s: when the first edge of each route is left, (hours, routes)."""
        first, table = times.table(self.index)
        count = table.shape[1] - 1
        left_s = np.empty((clock.hours, len(self.edges)))
        now_s = first_left_s.copy()
        left_s[:, self.begins] = now_s
        for place in range(1, int(self.lengths.max(initial=0))):
            routes = np.nonzero(self.lengths > place)[0]
            at = self.begins[routes] + place
            interval = (now_s[:, routes] // INTERVAL_S).astype(int) - first
            is_known = (interval >= 0) & (interval < count)
            now_s[:, routes] += table[self.edges[at], np.where(is_known, interval, count)]
            left_s[:, at] = now_s[:, routes]
        return left_s


def _starts_s(clock: CountedTime) -> Floats:
    """The middle of each hour, (hours,)."""
    return np.array([clock.first_s + (hour + 0.5) * HOUR_S for hour in range(clock.hours)])


def _first_s(routes: Sequence[Candidate], free_s: Mapping[str, float]) -> Floats:
    """Time of the first edge of each route on empty roads, (routes,)."""
    return np.array([free_s.get(route.edges[0], 0.0) for route in routes])


@dataclass(frozen=True, slots=True)
class Passes:
    """When each route passes the edges and turns of interest: entries of a matrix, which add up."""

    rows: Ints
    columns: Ints
    shares: Floats


def passes(
    routes: Sequence[Candidate],
    wanted: Mapping[Passing, int],
    times: EdgeTimes,
    free_s: Mapping[str, float],
    clock: CountedTime,
) -> Passes:
    """The share of each route's departures of an hour that leaves an edge, or takes a turn, in each hour.

    The departures of an hour are spread evenly over it, so what passes ``x`` hours later falls into two hours. The
    traffic of the warm-up is that of the first hour, and passes in its place.

    Args:
        routes: n routes; column ``hour * n + route`` stands for the departures of one in an hour.
        wanted: edge or turn, and hour -> row.
        free_s: the same on empty roads, for the first edge."""
    names = {name: number for number, name in enumerate(dict.fromkeys(name for name, _ in wanted))}
    row_of = np.full((len(names) + 1, clock.hours + 1), -1)
    for (name, hour), row in wanted.items():
        if 0 <= hour < clock.hours:
            row_of[names[name], hour] = row
    places = _Places.of(routes)
    met = np.array(list(_met(routes, names)), dtype=int).reshape(-1, 3)
    numbers, at, named = met.T
    starts_s = _starts_s(clock)[:, None]
    left_s = places.left_s(times, clock, starts_s + _first_s(routes, free_s))
    late_h = (left_s[:, at] - starts_s) / HOUR_S
    whole = np.floor(late_h).astype(int)
    rest = late_h - whole
    hours = np.arange(clock.hours)[:, None]
    departures = hours * len(routes) + numbers
    found: list[tuple[Ints, Ints, Floats]] = []

    def put(hour: Ints, share: Floats, column: Ints) -> None:
        """Entries of those that pass in an hour that is wanted."""
        row = row_of[named, np.minimum(hour, clock.hours)]
        kept = (row >= 0) & (share > 0)
        found.append((row[kept], column[kept], share[kept]))

    put(hours + whole, 1 - rest, departures)
    put(hours + whole + 1, rest, departures)
    for early in range(int(whole[0].max(initial=-1)) + 1):
        share = np.where(whole[0] > early, 1.0, np.where(whole[0] == early, rest[0], 0.0))
        put(np.full_like(named, early), share, departures[0])
    rows, columns, shares = zip(*found, strict=True)
    return Passes(np.concatenate(rows), np.concatenate(columns), np.concatenate(shares))


def _met(routes: Sequence[Candidate], names: Mapping[str | Movement, int]) -> Iterator[tuple[int, int, int]]:
    """Number of the route, place, and number of the name, wherever a route leaves an edge or takes a turn."""
    place = 0
    for number, route in enumerate(routes):
        for edge, after in zip_longest(route.edges, route.edges[1:]):
            if edge in names:
                yield number, place, names[edge]
            if after is not None and (edge, after) in names:
                yield number, place, names[edge, after]
            place += 1
