"""The road network for maps."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, fields
from enum import StrEnum
from functools import cache
from operator import attrgetter
from typing import Any, TypeAlias, TypeVar

from automotive_cosim.contracts.driving import LimitSource

T = TypeVar("T")

Columns: TypeAlias = tuple[type[T], list[tuple[Any, ...]]]
"""Objects of a data class, by its fields."""


def in_columns(kind: type[T], rows: Iterable[T]) -> Columns[T]:
    """The form in which many objects of a data class are pickled: one by one, that takes five times as long."""
    values: Callable[[T], tuple[Any, ...]] = _values_of(kind)  # type: ignore[arg-type]
    return kind, list(zip(*map(values, rows), strict=True))


def of_columns(columns: Columns[T]) -> tuple[T, ...]:
    """The objects again."""
    kind, values = columns
    return tuple(map(kind, *values)) if values else ()


@cache
def _values_of(kind: Any) -> Callable[[object], tuple[Any, ...]]:
    return attrgetter(*(each.name for each in fields(kind)))


@dataclass(frozen=True, slots=True)
class Road:
    """One edge of the network, as a map draws it."""

    edge_id: str
    name: str
    road_class: str
    lane_count: int
    length_m: float
    limit_mps: float | None
    limit_source: LimitSource
    in_tunnel: bool
    shape_m: tuple[tuple[float, float], ...]
    """Centre line, network coordinates (x, y)."""
    school_zone: bool = False
    """Whether it runs beside a school."""
    limit_hours: str = ""
    """The hours of its limits that hold at certain hours only, as signed: ``"Mo-Fr 08:00-09:30"``."""


class GroundKind(StrEnum):
    """What covers the ground beside the roads, in the order in which it is drawn."""

    GREEN = "green"
    WATER = "water"
    BUILDING = "building"


@dataclass(frozen=True, slots=True)
class GroundArea:
    """An area beside the roads, which pictures show and nothing else reads."""

    kind: GroundKind
    outline_m: tuple[tuple[float, float], ...]
    """At least three corners, network coordinates (x, y)."""


def in_drawing_order(areas: Iterable[GroundArea]) -> tuple[GroundArea, ...]:
    """Green first, buildings last; what is of one kind in the order in which it came."""
    order = list(GroundKind)
    return tuple(sorted(areas, key=lambda area: order.index(area.kind)))


@dataclass(frozen=True, slots=True)
class RoadNetwork:
    """The drivable network of a scenario."""

    roads: tuple[Road, ...]
    bounds_m: tuple[float, float, float, float]
    """(x_min, y_min, x_max, y_max)."""
    projection: str | None
    """PROJ string of the network's location tag; None if it has none."""
    offset_m: tuple[float, float]
    """``netOffset``: added to projected coordinates."""
    left_hand: bool
    ground: tuple[GroundArea, ...] = ()
    """Water, green and buildings around the roads."""
    junctions_m: Mapping[tuple[str, str], float] = field(default_factory=dict, hash=False)
    """Length of the way through the junction between two edges."""

    def __reduce__(self) -> tuple[Any, ...]:
        _, *values = _values_of(RoadNetwork)(self)
        return _network, (in_columns(Road, self.roads), *values)


def _network(roads: Columns[Road], *values: Any) -> RoadNetwork:
    return RoadNetwork(of_columns(roads), *values)
