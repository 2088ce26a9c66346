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

from dataclasses import dataclass
from datetime import time
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le, MinLen

from automotive_cosim.formats.annotations import Form, TaggedBy

FOR_GOOD_S = 86_400.0
Edge = Annotated[str, MinLen(1)]
"""Id of an edge of the network."""
LocalTime = Annotated[time, Form(r"^\d\d:\d\d(:\d\d(\.\d+)?)?$", "08:00:00", time.fromisoformat)]
"""By the clock of the place."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Incident:
    """What all kinds have."""

    kind: str
    """Which of the classes below."""
    from_s: float = 0.0
    """Seconds after the ego's departure."""
    to_s: float = FOR_GOOD_S
    """Likewise; without it it stays."""
    trip: str = ""
    """Name of the ego's trip that it belongs to; empty: it happens whatever the ego does."""

    def __post_init__(self) -> None:
        if self.from_s >= self.to_s:
            raise ValueError(f"from_s = {self.from_s:g} is not before to_s = {self.to_s:g}")
        if self.from_s < 0 and self.trip:
            raise ValueError(f"from_s = {self.from_s:g}: what belongs to a trip cannot begin in the warm-up")


@dataclass(frozen=True, slots=True, kw_only=True)
class EgoIncident(Incident):
    """One that comes about around the ego, from ``from_s`` on and once it has driven ``at_m``."""

    from_s: Annotated[float, Ge(0)] = 0.0
    """Seconds after the ego's departure."""
    at_m: Annotated[float, Ge(0)] = 0.0
    """Metres that the ego must have driven."""


# --- on the road, whoever comes ---------------------------------------------------------------------------


@dataclass(frozen=True, slots=True, kw_only=True)
class Breakdown(Incident):
    """A car stands in a lane with its hazard lights on."""

    kind: Literal["breakdown"] = "breakdown"
    edge: Edge
    """Where it stands."""
    position_m: Annotated[float, Ge(0)]
    """Its front bumper, from the start of the edge."""
    lane: Annotated[int, Ge(0)] = 0
    """Among the edge's lanes for cars, 0 nearest the kerb."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Roadworks(Incident):
    """A lower limit is signed, and lanes may be closed."""

    kind: Literal["roadworks"] = "roadworks"
    edge: Edge
    """Where they are."""
    limit_kmh: Annotated[float, Gt(0)]
    """What is signed there."""
    closed_lanes: tuple[Annotated[int, Ge(0)], ...] = ()
    """Among the edge's lanes for cars, 0 nearest the kerb."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Jam(Incident):
    """A queue before a narrow place at the end of the last edge; its tail is ``length_m`` further back at first."""

    kind: Literal["jam"] = "jam"
    edges: Annotated[tuple[Edge, ...], MinLen(1)]
    """In driving order, each leading to the next; together at least as long as the queue."""
    length_m: Annotated[float, Gt(0)]
    """Of the queue, at first."""
    hold_s: Annotated[float, Gt(0)] = 20.0
    """One vehicle a lane passes the narrow place in about this time."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Closure(Incident):
    """A road closed to all but the authorities; the others go round."""

    kind: Literal["closure"] = "closure"
    edge: Edge
    """What is closed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SchoolZone(Incident):
    """A lower limit at certain hours of school days, Monday to Friday, by the clock of the place."""

    kind: Literal["school_zone"] = "school_zone"
    edges: Annotated[tuple[Edge, ...], MinLen(1)]
    """The roads beside the school."""
    limit_kmh: Annotated[float, Gt(0)]
    """What holds between the two times."""
    opens: LocalTime
    """Local time of the place, as in ``opens = 08:00:00``."""
    closes: LocalTime
    """Later on the same day."""

    def __post_init__(self) -> None:
        Incident.__post_init__(self)
        if self.opens >= self.closes:
            raise ValueError(f"opens = {self.opens} is not before closes = {self.closes}")


@dataclass(frozen=True, slots=True, kw_only=True)
class RushHour(Incident):
    """The demand is multiplied; several in a row make a profile."""

    kind: Literal["rush_hour"] = "rush_hour"
    scale: Annotated[float, Gt(0)]
    """Factor on the demand."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tractor(Incident):
    """A slow vehicle drives from one edge to another."""

    kind: Literal["tractor"] = "tractor"
    from_edge: Edge
    """Where it sets out."""
    to_edge: Edge
    """Where it leaves the road."""
    speed_kmh: Annotated[float, Gt(0)] = 25.0
    """25 is a common speed on the plates that slow vehicles carry in Germany (StVZO section 58)."""
    length_m: Annotated[float, Gt(0)] = 9.0
    """With its trailer."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Pedestrians(Incident):
    """People walk from the end of one edge to the start of another, over the crossings between them.

    The network needs sidewalks and crossings (``netconvert --sidewalks.guess --crossings.guess``).
    """

    kind: Literal["pedestrians"] = "pedestrians"
    from_edge: Edge
    """They come from its end."""
    to_edge: Edge
    """They go to its start."""
    every_s: Annotated[float, Ge(1)] = 10.0
    """Time between two groups."""
    group: Annotated[int, Ge(1)] = 3
    """How many walk together."""


# --- around the ego ---------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True, kw_only=True)
class EmergencyVehicle(EgoIncident):
    """An ambulance with blue light comes up from behind on the ego's way.

    Others make a corridor for it only where ``[sumo] lateral_resolution_m`` asks for SUMO's sublane model.
    """

    kind: Literal["emergency"] = "emergency"
    behind_m: Annotated[float, Gt(0)] = 250.0
    """Where it appears: out of sight, on the way that the ego has come."""
    speed_ratio: Annotated[float, Gt(0)] = 1.5
    """What it drives where it can, over the limit."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BrakingLeader(EgoIncident):
    """The vehicle ahead of the ego brakes hard. Where there is none, a car pulls out before the ego first."""

    kind: Literal["braking_leader"] = "braking_leader"
    within_m: Annotated[float, Gt(0)] = 80.0
    """How near a vehicle must be to be the one."""
    ahead_m: Annotated[float, Gt(0)] = 30.0
    """Gap to a car that pulls out."""
    deceleration_mps2: Annotated[float, Gt(0), Le(10)] = 6.0
    """How hard."""
    to_kmh: Annotated[float, Ge(0)] = 0.0
    """What it brakes to."""
    hold_s: Annotated[float, Ge(0)] = 4.0
    """It keeps that speed so long, then drives on."""


AnyIncident = Annotated[
    Breakdown
    | Roadworks
    | Jam
    | Closure
    | SchoolZone
    | RushHour
    | Tractor
    | Pedestrians
    | EmergencyVehicle
    | BrakingLeader,
    TaggedBy("kind"),
]
"""One of ``[[incidents]]``."""
