"""Fits a demand to counts, drives it, and goes on until the simulation carries the counts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from automotive_cosim.formats.writing import write_whole
from automotive_cosim.scenarios import variant
from automotive_cosim.studies.calibration.candidates import Candidate, Candidates, Ends, Passes, Passing, passes
from automotive_cosim.studies.calibration.capacity import USABLE, Capacity, Movement
from automotive_cosim.studies.calibration.driving import HOUR_S, CountedTime, DrivenDemand
from automotive_cosim.studies.calibration.fit import CountedFlows, Floats, fit
from automotive_cosim.studies.equilibrium.gap import DrivenTrip, EdgeTimes, quickest

COUNT_ERROR = 0.02
"""Variance of a count, as a share of it: a fit may miss 1,000 vehicles by some tens if the prior insists."""

ENOUGH_SITES = 5
"""With fewer sites, the total of all traffic stays the given demand's: they say too little of it."""

OTHER_SHARE, THROUGH_SHARE, COUNTED_SHARE = 0.2, 0.3, 0.1
"""Traffic that the prior has beside the given demand, as a share of it: between starts and ends of different trips,
from border to border of the map, and by way of counted edges."""

THROUGH_TRIPS = 2000
"""Most routes from border to border."""

BY_WAY = 40
"""Routes that are drawn through every counted edge."""

FEW = 5
"""A count that fewer routes pass says nothing of where its vehicles come from and go to."""

LEVELS = 0.02, 4.0
"""Least and most that the total of an hour may differ from the given demand's, as a factor."""

STEADY, CHANGE_MAX = 0.5, 1.2
"""Weight of one simulation in what the next fit is corrected by, and the limit of that."""

RELAXED = 1.25
"""Factor on a learned bound in each round in which its turn was not full."""

CALM_SHARE = 0.01
"""A simulation that teleports more of its vehicles corrects nothing."""

TIGHTENINGS = 4
"""How often a fit is repeated with bounds on the roads that it overloads."""

GOLDEN = 0.6180339887
"""Steps of this share of an hour spread departures evenly, however many there are."""

FloatsOf = Mapping[tuple[str, int], float]
"""Edge and hour -> vehicles."""


@dataclass(frozen=True, slots=True)
class SearchWorld:
    """What a search may use."""

    clock: CountedTime
    net: Path
    types: str
    """All vehicle types, as SUMO's XML."""
    own_types: str
    """Those that the new demand must bring, as SUMO's XML."""
    free_s: Mapping[str, float]
    capacity: Capacity
    border: tuple[tuple[str, ...], tuple[str, ...]]
    """Edges by which traffic enters the map, and by which it leaves."""
    counts: FloatsOf
    """The counts to meet."""
    seed: int
    simulate: Callable[[Path], DrivenDemand]
    """Drives a file of routes."""
    scratch: Path


@dataclass(frozen=True, slots=True)
class FitRound:
    """One fit and its simulation."""

    fitted: FloatsOf
    routes: int
    """Routes with at least one vehicle."""
    vehicles: int
    drive: DrivenDemand
    demand: str
    """As SUMO's XML."""
    thin: tuple[str, ...]
    """Counted edges that hardly any route passes."""


def search(world: SearchWorld, given: DrivenDemand, per_h: float, rounds: int) -> Iterator[FitRound]:
    """Fits and drives, up to ``rounds`` times.

    Args:
        per_h: its departures per hour."""
    clock = world.clock
    rng = np.random.default_rng(world.seed)
    trips = [trip for trip in given.trips if len(trip.edges) > 1]
    found = Candidates.of(trips)
    times = EdgeTimes(world.free_s, map(_ended(clock.end_s), given.trips))
    _add_others(found, trips, times, world, rng)
    _add_by_way(found, trips, times, world, rng)
    passing = Counter(edge for route in found.routes for edge in set(route.edges))
    thin = tuple(sorted({edge for edge, _ in world.counts if passing[edge] < FEW}))
    learned = _Learned()
    for _ in range(rounds):
        flows, fitted = _fit(world, found, times, per_h, learned)
        demand, vehicles, routes = _demand(found, flows, world)
        path = world.scratch / "fitted.rou.xml"
        write_whole(path, demand)
        drive = world.simulate(path)
        yield FitRound(fitted, routes, vehicles, drive, demand, thin)
        times = EdgeTimes(world.free_s, map(_ended(clock.end_s), drive.trips))
        learned.learn(drive, fitted, world)
        _add_quicker(found, flows, times, world, rng)


@dataclass(slots=True)
class _Learned:
    """What was learned from the simulations."""

    bounds: dict[Passing, float] = field(default_factory=dict)
    """Turn and hour -> what it carried when more came."""
    costs_s: Floats | None = None
    """Times of the routes, (hours, routes)."""
    seen: dict[tuple[str, int], float] = field(default_factory=dict)
    """Counted edge and hour -> what passed it as a share of what should have."""

    def learn(self, drive: DrivenDemand, fitted: FloatsOf, world: SearchWorld) -> None:
        """Adds a simulation. In a gridlock a road carries far less than it could, so bounds give way again."""
        full = drive.full_turns(world.clock, world.free_s)
        self.bounds = {each: RELAXED * most for each, most in self.bounds.items() if each not in full}
        for turn, served in full.items():
            self.bounds[turn] = max(1.0, float(served))
        if drive.teleports > CALM_SHARE * len(drive.trips):
            return  # what did not arrive says nothing of what should be sent
        for key, expected in fitted.items():
            if expected > 0:
                ratio = (drive.flows.get(key, 0) / expected) ** STEADY * self.seen.get(key, 1.0) ** (1 - STEADY)
                self.seen[key] = min(CHANGE_MAX, max(1 / CHANGE_MAX, ratio))


def _ended(end_s: float) -> Callable[[DrivenTrip], DrivenTrip]:
    """Lets who stands somewhere at the end leave the edge then, so that its time is at least that long."""

    def ended(trip: DrivenTrip) -> DrivenTrip:
        if trip.has_arrived:
            return trip
        place = trip.exits_s.index(-1.0)
        return replace(trip, exits_s=(*trip.exits_s[:place], end_s, *trip.exits_s[place + 1 :]))

    return ended


def _add_others(
    found: Candidates, trips: Sequence[DrivenTrip], times: EdgeTimes, world: SearchWorld, rng: np.random.Generator
) -> None:
    """Routes between starts and ends of different trips, and straight through the map."""
    total, count = sum(found.weights.values()), len(trips)
    starts, goals = rng.integers(count, size=(2, count)).tolist()
    ends = [(trips[start].edges[0], trips[goal].edges[-1]) for start, goal in zip(starts, goals, strict=True)]
    _add_between(found, ends, total * OTHER_SHARE, trips, times, world, rng)
    entries, exits = world.border
    if entries and exits:
        pairs = rng.integers((len(entries), len(exits)), size=(min(THROUGH_TRIPS, len(entries) * len(exits)), 2))
        ends = [(entries[start], exits[goal]) for start, goal in pairs.tolist()]
        _add_between(found, ends, total * THROUGH_SHARE, trips, times, world, rng)


def _add_between(
    found: Candidates,
    ends: Sequence[Ends],
    weight: float,
    trips: Sequence[DrivenTrip],
    times: EdgeTimes,
    world: SearchWorld,
    rng: np.random.Generator,
) -> None:
    """The quickest routes between some edges, which share a weight."""
    like = rng.integers(len(trips), size=len(ends)).tolist()
    asked = [
        _asked(number, trips[index], start, goal, world.clock, rng)
        for number, (index, (start, goal)) in enumerate(zip(like, ends, strict=True))
        if start != goal
    ]
    routes = quickest(asked, times, world.net, world.types, world.scratch)
    _add(found, asked, routes, weight / max(1, len(asked)))


def _add_by_way(
    found: Candidates, trips: Sequence[DrivenTrip], times: EdgeTimes, world: SearchWorld, rng: np.random.Generator
) -> None:
    """Routes through counted edges."""
    edges = sorted({edge for edge, _ in world.counts})
    asked: list[DrivenTrip] = []
    via: dict[str, str] = {}
    for edge in edges:
        for _ in range(BY_WAY):
            a, b = rng.integers(len(trips), size=2).tolist()
            trip = _asked(len(asked), trips[a], trips[a].edges[0], trips[b].edges[-1], world.clock, rng)
            if edge not in trip.edges:
                asked.append(trip)
                via[trip.id] = edge
    routes = quickest(asked, times, world.net, world.types, world.scratch, via)
    simple = {name: route for name, route in routes.items() if len(set(route)) == len(route)}
    weight = COUNTED_SHARE * sum(found.weights.values()) / max(1, len(asked))
    _add(found, asked, simple, weight)


def _add_quicker(
    found: Candidates, flows: Floats, times: EdgeTimes, world: SearchWorld, rng: np.random.Generator
) -> None:
    """For each route that is used, the one that was quickest in the simulation."""
    used = [(number, hour) for hour, number in zip(*np.nonzero(flows > 0.5), strict=True)]
    asked = []
    for index, (number, hour) in enumerate(used):
        route = found.routes[number]
        start_s = world.clock.first_s + (hour + rng.random()) * HOUR_S
        asked.append(
            DrivenTrip(f"q{index}", route.type_ids[0], start_s, (route.edges[0], route.edges[-1]), (start_s, -1.0))
        )
    _add(found, asked, quickest(asked, times, world.net, world.types, world.scratch), 0.0)


def _asked(
    number: int, like: DrivenTrip, start: str, goal: str, clock: CountedTime, rng: np.random.Generator
) -> DrivenTrip:
    departs_s = clock.first_s + rng.random() * (clock.end_s - clock.first_s)
    return DrivenTrip(f"a{number}", like.type_id, departs_s, (start, goal), (departs_s, -1.0))


def _add(
    found: Candidates, asked: Sequence[DrivenTrip], routes: Mapping[str, tuple[str, ...]], weight: float
) -> None:
    for trip in asked:
        edges = routes.get(trip.id, ())
        if len(edges) > 1:
            found.add(Candidate(edges, (trip.type_id,), 0.0), weight)


def _fit(
    world: SearchWorld, found: Candidates, times: EdgeTimes, per_h: float, learned: _Learned
) -> tuple[Floats, dict[tuple[str, int], float]]:
    """Vehicles of each route and hour, (hours, routes), and what the counted edges then see."""
    clock, routes = world.clock, found.routes
    learned.costs_s = _smoothed(learned.costs_s, found.costs_s(times, world.free_s, clock))
    shares = found.prior(learned.costs_s)
    rows: dict[Passing, int] = {key: number for number, key in enumerate(world.counts)}
    counts = np.array(list(world.counts.values()))
    seen = _matrix(passes(routes, rows, times, world.free_s, clock), len(rows), shares.size)
    trust = np.array([learned.seen.get(key, 1.0) for key in world.counts])
    level = _levels(world.counts, seen @ (per_h * shares).ravel(), clock.hours)
    problem = CountedFlows(
        prior=np.maximum(per_h * level[:, None] * shares, 1e-9).ravel(),
        counted_by=seen.multiply(trust[:, None]).tocsr(),
        counts=counts,
        variances=np.maximum(COUNT_ERROR * counts, 1.0),
    )
    names: list[str | Movement] = [*world.capacity.edges, *world.capacity.turns]
    most = USABLE * np.array([*world.capacity.edges.values(), *world.capacity.turns.values()])
    crossed = _crossed(routes, names)
    bounds = dict(learned.bounds)
    flows = shares
    for _ in range(TIGHTENINGS):
        bound_rows = {key: number for number, key in enumerate(bounds)}
        limited = _matrix(passes(routes, bound_rows, times, world.free_s, clock), len(bounds), shares.size)
        flows = fit(problem, limited, np.array(list(bounds.values()))).reshape(shares.shape)
        loads = crossed @ flows.T
        over = np.argwhere(loads > most[:, None]).tolist()
        new = {(names[name], hour): float(most[name]) for name, hour in over if (names[name], hour) not in bounds}
        if not new:
            break
        bounds |= new
    return flows, dict(zip(world.counts, (seen @ flows.ravel()).tolist(), strict=True))


def _smoothed(before: Floats | None, now: Floats) -> Floats:
    """Times between those of the last rounds, so that drivers do not all leave one road for another; routes that
    are new have those of now."""
    if before is None:
        return now
    mixed = now.copy()
    mixed[:, : before.shape[1]] = (before + now[:, : before.shape[1]]) / 2
    return mixed


def _crossed(routes: Sequence[Candidate], names: Sequence[str | Movement]) -> Any:
    """Which routes use which edges and turns, (names, routes)."""
    index = {name: number for number, name in enumerate(names)}
    used = [
        (index[name], number)
        for number, route in enumerate(routes)
        for name in (*route.edges, *pairwise(route.edges))
        if name in index
    ]
    rows, columns = np.array(used, dtype=int).reshape(-1, 2).T
    return _matrix(Passes(rows, columns, np.ones(len(used))), len(names), len(routes))


def _matrix(found: Passes, rows: int, columns: int) -> Any:
    from scipy.sparse import csr_array

    return csr_array((found.shares, (found.rows, found.columns)), shape=(rows, columns))


def _levels(counts: FloatsOf, expected: Floats, hours: int) -> Floats:
    """Factor on the given demand in each hour, (hours,)."""
    totals, unfitted = np.zeros(hours), np.zeros(hours)
    for ((_, hour), count), flow in zip(counts.items(), expected, strict=True):
        totals[hour] += count
        unfitted[hour] += flow
    if len({edge for edge, _ in counts}) >= ENOUGH_SITES:
        return np.clip(totals / np.maximum(unfitted, 1.0), LEVELS[0], LEVELS[1])
    return np.asarray(np.maximum(totals / max(1.0, totals.max()), LEVELS[0]))


def _demand(found: Candidates, flows: Floats, world: SearchWorld) -> tuple[str, int, int]:
    """The demand as SUMO's XML, its vehicles, and the number of routes they use."""
    clock = world.clock
    rng = np.random.default_rng(world.seed)
    offsets = rng.random(clock.hours + 1)
    phases = rng.random((len(found.routes), 2))
    spans = [(clock.begin_s, clock.warm_up_s, flows[0] * clock.warm_up_s / HOUR_S)]
    spans += [(clock.first_s + hour * HOUR_S, HOUR_S, row) for hour, row in enumerate(flows)]
    vehicles: list[tuple[float, int, int]] = []
    for (start_s, length_s, wanted), offset in zip(spans, offsets, strict=True):
        whole = np.floor(np.concatenate([[0.0], np.cumsum(wanted)]) + offset)
        for number in np.nonzero(np.diff(whole))[0].tolist():
            for each in range(int(whole[number + 1] - whole[number])):
                share = (phases[number, 0] + GOLDEN * each + start_s * 0.137) % 1.0
                vehicles.append((round(start_s + share * length_s, 2), number, each))
    vehicles.sort()
    lines = []
    for index, (depart_s, number, each) in enumerate(vehicles):
        route = found.routes[number]
        kind = route.type_ids[int((phases[number, 1] + GOLDEN * each) % 1.0 * len(route.type_ids))]
        lines.append(variant.vehicle(str(index), kind, depart_s, route.edges))
    return variant.demand(world.own_types, lines), len(vehicles), len({number for _, number, _ in vehicles})
