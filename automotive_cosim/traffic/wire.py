"""States as plain tuples: pickling dataclasses costs ten times as much, more than a step of a small network."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields
from functools import lru_cache
from operator import attrgetter
from sys import intern
from typing import Any, TypeAlias

from automotive_cosim.contracts import (
    Around,
    DrivingState,
    Limit,
    LimitSource,
    OtherVehicle,
    RoadAhead,
    RoadHere,
    RoadSnapshot,
    SeenVehicle,
    TrafficLight,
)
from automotive_cosim.traffic.base import Advance, Event
from automotive_cosim.traffic.records import (
    make_ahead,
    make_around,
    make_light,
    make_other,
    make_road,
    make_seen,
    make_state,
)

Packed: TypeAlias = tuple[Any, ...]


def _getter(kind: type) -> attrgetter[Packed]:
    return attrgetter(*(field.name for field in fields(kind)))


_STATE, _ROAD, _AHEAD, _AROUND = (_getter(kind) for kind in (DrivingState, RoadHere, RoadAhead, Around))
_OTHER, _LIGHT, _EVENT, _SEEN = (_getter(kind) for kind in (OtherVehicle, TrafficLight, Event, SeenVehicle))
_ROAD_AT, _AHEAD_AT, _AROUND_AT = (
    [f.name for f in fields(DrivingState)].index(n) for n in ("road", "ahead", "around")
)
_LIGHT_AT, _ROUTE_AT, _SLOW_AT = (
    [f.name for f in fields(RoadAhead)].index(n) for n in ("next_light", "route_edges", "slow_edges")
)
_OTHERS = 4
"""The first fields of ``Around`` are other vehicles."""
_LIMIT_AT, _NEXT_AT = (
    [f.name for f in fields(kind)].index(name) for kind, name in ((RoadHere, "limit"), (RoadAhead, "next_limit"))
)


def pack_state(state: DrivingState) -> Packed:
    """A state as nested tuples."""
    row, ahead, around = list(_STATE(state)), list(_AHEAD(state.ahead)), _AROUND(state.around)
    light = ahead[_LIGHT_AT]
    ahead[_LIGHT_AT] = light and _LIGHT(light)
    ahead[_NEXT_AT] = ahead[_NEXT_AT] and pack_limit(ahead[_NEXT_AT])
    road = list(_ROAD(state.road))
    road[_LIMIT_AT] = pack_limit(road[_LIMIT_AT])
    row[_ROAD_AT] = road
    row[_AHEAD_AT] = ahead
    row[_AROUND_AT] = (*(other and _OTHER(other) for other in around[:_OTHERS]), *around[_OTHERS:])
    return tuple(row)


def pack_limit(limit: Limit) -> Packed:
    """A limit as a tuple."""
    return limit.mps, limit.source.value


def unpack_state(packed: Packed) -> DrivingState:
    """The state that was packed."""
    row, around = list(packed), packed[_AROUND_AT]
    road = _interned(row[_ROAD_AT])
    road[_LIMIT_AT] = _limit(*road[_LIMIT_AT])
    row[_ROAD_AT] = make_road(*road)
    row[_AHEAD_AT] = unpack_ahead(row[_AHEAD_AT])
    others: Packed = tuple(other and make_other(*_interned(other)) for other in around[:_OTHERS])
    row[_AROUND_AT] = make_around(*others, *around[_OTHERS:])
    return make_state(*row)


def unpack_ahead(packed: Packed) -> RoadAhead:
    """The road ahead in a state."""
    row = list(packed)
    light = row[_LIGHT_AT]
    row[_LIGHT_AT] = light and make_light(*_interned(light))
    row[_ROUTE_AT], row[_SLOW_AT] = _same(row[_ROUTE_AT]), _same(row[_SLOW_AT])
    row[_NEXT_AT] = row[_NEXT_AT] and _limit(*row[_NEXT_AT])
    return make_ahead(*row)


def _interned(packed: Packed) -> list[Any]:
    """With names that are the same ones as before."""
    return [intern(each) if type(each) is str else each for each in packed]


@lru_cache(maxsize=512)
def _limit(mps: float | None, source: str) -> Limit:
    """The same one as before, if it is."""
    return Limit(mps, LimitSource(source))


@lru_cache(maxsize=512)
def _same(edges: Packed) -> Packed:
    """The same route or traffic news as before, if they are: of what a drive keeps, copies of them were a third.
    The names in all of them are the same, too."""
    return tuple(intern(each) if isinstance(each, str) else _pair(*each) for each in edges)


@lru_cache(maxsize=4096)
def _pair(edge: str, relative_speed: float) -> Packed:
    return intern(edge), relative_speed


def pack_advance(states: Iterable[Packed], events: Iterable[Event]) -> Packed:
    """The result of an advance as nested tuples."""
    return tuple(states), tuple(map(_EVENT, events))


def unpack_advance(packed: Packed) -> Advance:
    """The advance that was packed."""
    states, events = packed
    return Advance(tuple(map(unpack_state, states)), tuple(Event(*event) for event in events))


def pack_snapshot(snapshot: RoadSnapshot) -> Packed:
    """A snapshot as nested tuples."""
    seen, people = (tuple(map(_SEEN, each)) for each in (snapshot.vehicles, snapshot.people))
    return snapshot.time_s, seen, snapshot.lights, people, snapshot.closed


def unpack_snapshot(packed: Packed) -> RoadSnapshot:
    """The snapshot that was packed."""
    time_s, vehicles, lights, people, closed = packed
    seen, walking = (tuple(make_seen(*each) for each in group) for group in (vehicles, people))
    return RoadSnapshot(time_s, seen, lights, walking, closed)
