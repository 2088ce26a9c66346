"""What a scenario may stage on its roads: the kinds of ``[[incidents]]``.

    [[incidents]]
    kind = "breakdown"
    trip = "avenue"          # only when the ego drives this trip; without it, on every drive
    edge = "c1c2"
    position_m = 120.0
    from_s = 20.0

Times are seconds after the ego's departure, which is the scenario's ``start``; negative ones lie in the warm-up,
for incidents without ``trip``. Each kind's further fields stand in its class. ``traffic.situations`` stages them
in SUMO.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import time
from typing import ClassVar

FOR_GOOD_S = 86_400.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Incident:
    """What all kinds have."""

    kind: ClassVar[str] = ""
    from_s: float = 0.0
    to_s: float = FOR_GOOD_S
    trip: str = ""
    """Name of the ego's trip that it belongs to; empty: it happens whatever the ego does."""

    def __post_init__(self) -> None:
        _require(self, self.from_s < self.to_s, "from_s must be before to_s")
        _require(self, self.from_s >= 0 or not self.trip, "what belongs to a trip cannot begin in the warm-up")


@dataclass(frozen=True, slots=True, kw_only=True)
class EgoIncident(Incident):
    """One that comes about around the ego, from ``from_s`` on and once it has driven ``at_m``."""

    at_m: float = 0.0

    def __post_init__(self) -> None:
        Incident.__post_init__(self)
        _require(self, self.from_s >= 0 and self.at_m >= 0, "from_s and at_m count from the ego's departure")


# --- on the road, whoever comes ---------------------------------------------------------------------------


@dataclass(frozen=True, slots=True, kw_only=True)
class Breakdown(Incident):
    """A car stands in a lane with its hazard lights on."""

    kind = "breakdown"
    edge: str
    position_m: float
    """Its front bumper, from the start of the edge."""
    lane: int = 0
    """Among the edge's lanes for cars, 0 nearest the kerb."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Roadworks(Incident):
    """A lower limit is signed, and lanes may be closed."""

    kind = "roadworks"
    edge: str
    limit_kmh: float
    closed_lanes: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        Incident.__post_init__(self)
        _require(self, self.limit_kmh > 0, "limit_kmh must be above 0")


@dataclass(frozen=True, slots=True, kw_only=True)
class Jam(Incident):
    """A queue before a narrow place at the end of the last edge; its tail is ``length_m`` further back at first."""

    kind = "jam"
    edges: tuple[str, ...]
    """In driving order, each leading to the next; together at least as long as the queue."""
    length_m: float
    hold_s: float = 20.0
    """One vehicle a lane passes the narrow place in about this time."""

    def __post_init__(self) -> None:
        Incident.__post_init__(self)
        _require(self, bool(self.edges) and self.length_m > 0 and self.hold_s > 0, "edges, length_m, hold_s: none")


@dataclass(frozen=True, slots=True, kw_only=True)
class Closure(Incident):
    """A road closed to all but the authorities; the others go round."""

    kind = "closure"
    edge: str


@dataclass(frozen=True, slots=True, kw_only=True)
class SchoolZone(Incident):
    """A lower limit at certain hours of school days, Monday to Friday, by the clock of the place."""

    kind = "school_zone"
    edges: tuple[str, ...]
    limit_kmh: float
    opens: time
    """``opens = 08:00:00``, TOML's local time."""
    closes: time

    def __post_init__(self) -> None:
        Incident.__post_init__(self)
        _require(self, self.limit_kmh > 0 and self.opens < self.closes, "limit_kmh above 0, opens before closes")
        _require(self, bool(self.edges), "it needs at least one edge")


@dataclass(frozen=True, slots=True, kw_only=True)
class RushHour(Incident):
    """The demand is multiplied; several in a row make a profile."""

    kind = "rush_hour"
    scale: float

    def __post_init__(self) -> None:
        Incident.__post_init__(self)
        _require(self, self.scale > 0, "scale must be above 0")


@dataclass(frozen=True, slots=True, kw_only=True)
class Tractor(Incident):
    """A slow vehicle drives from one edge to another."""

    kind = "tractor"
    from_edge: str
    to_edge: str
    speed_kmh: float = 25.0
    """25 is a common speed on the plates that slow vehicles carry in Germany (StVZO section 58)."""
    length_m: float = 9.0

    def __post_init__(self) -> None:
        Incident.__post_init__(self)
        _require(self, self.speed_kmh > 0 and self.length_m > 0, "speed_kmh and length_m must be above 0")


@dataclass(frozen=True, slots=True, kw_only=True)
class Pedestrians(Incident):
    """People walk from the end of one edge to the start of another, over the crossings between them.

    The network needs sidewalks and crossings (``netconvert --sidewalks.guess --crossings.guess``).
    """

    kind = "pedestrians"
    from_edge: str
    to_edge: str
    every_s: float = 10.0
    """Time between two groups."""
    group: int = 3

    def __post_init__(self) -> None:
        Incident.__post_init__(self)
        _require(self, self.every_s >= 1 and self.group >= 1, "every_s and group must be at least 1")


# --- around the ego ---------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True, kw_only=True)
class EmergencyVehicle(EgoIncident):
    """An ambulance with blue light comes up from behind on the ego's way.

    Others make a corridor for it only where ``[sumo] lateral_resolution_m`` asks for SUMO's sublane model.
    """

    kind = "emergency"
    behind_m: float = 250.0
    """Where it appears: out of sight, on the way that the ego has come."""
    speed_ratio: float = 1.5
    """What it drives where it can, over the limit."""

    def __post_init__(self) -> None:
        EgoIncident.__post_init__(self)
        _require(self, self.behind_m > 0 and self.speed_ratio > 0, "behind_m and speed_ratio must be above 0")


@dataclass(frozen=True, slots=True, kw_only=True)
class BrakingLeader(EgoIncident):
    """The vehicle ahead of the ego brakes hard. Where there is none, a car pulls out before the ego first."""

    kind = "braking_leader"
    within_m: float = 80.0
    """How near a vehicle must be to be the one."""
    ahead_m: float = 30.0
    """Gap to a car that pulls out."""
    deceleration_mps2: float = 6.0
    to_kmh: float = 0.0
    hold_s: float = 4.0
    """It keeps that speed so long, then drives on."""

    def __post_init__(self) -> None:
        EgoIncident.__post_init__(self)
        _require(self, self.ahead_m > 0 and self.within_m > 0, "ahead_m and within_m must be above 0")
        _require(self, 0 < self.deceleration_mps2 <= 10, "deceleration_mps2 must be above 0 and at most 10")
        _require(self, self.to_kmh >= 0 and self.hold_s >= 0, "to_kmh and hold_s must not be negative")


KINDS: Mapping[str, type[Incident]] = {
    kind.kind: kind
    for kind in (
        Breakdown,
        Roadworks,
        Jam,
        Closure,
        SchoolZone,
        RushHour,
        Tractor,
        Pedestrians,
        EmergencyVehicle,
        BrakingLeader,
    )
}
"""By the name that ``kind`` has in the file."""


def _require(incident: Incident, holds: bool, rule: str) -> None:
    if not holds:
        raise ValueError(f"[[incidents]] of kind {incident.kind!r}: {rule}")
