"""The incidents that a scenario may stage on its roads: the kinds of ``[[incidents]]``.

    [[incidents]]
    kind = "breakdown"
    trip = "avenue"          # only when the ego drives this trip; without it, on every drive
    edge = "c1c2"
    position_m = 120.0
    from_s = 20.0

Times are seconds after the ego's departure, which is the scenario's ``start``; negative ones lie in the warm-up,
for incidents without ``trip``. Each kind's own fields are in its class. ``traffic.incidents`` stages them
in SUMO.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import time
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le, MinLen

from automotive_cosim.formats.annotations import Form, TaggedBy

FOR_GOOD_S = 86_400.0
EdgeId = Annotated[str, MinLen(1)]
"""Id of an edge of the network."""
LocalTime = Annotated[time, Form(r"^\d\d:\d\d(:\d\d(\.\d+)?)?$", "08:00:00", time.fromisoformat)]
"""A local time of day."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Incident:
    """The fields that all kinds of incidents share."""

    kind: str
    """Which of the classes below."""
    from_s: float = 0.0
    """Seconds after the ego's departure."""
    to_s: float = FOR_GOOD_S
    """Seconds after the ego's departure; without it, the incident stays."""
    trip: str = ""
    """Name of the ego's trip that it belongs to; if empty, it happens on every trip."""

    def __post_init__(self) -> None:
        if self.from_s >= self.to_s:
            raise ValueError(f"from_s = {self.from_s:g} is not before to_s = {self.to_s:g}")
        if self.from_s < 0 and self.trip:
            raise ValueError(f"from_s = {self.from_s:g}: an incident of a trip cannot begin in the warm-up")


@dataclass(frozen=True, slots=True, kw_only=True)
class EgoIncident(Incident):
    """An incident that arises around the ego, after ``from_s`` and once it has driven ``at_m``."""

    from_s: Annotated[float, Ge(0)] = 0.0
    """Seconds after the ego's departure."""
    at_m: Annotated[float, Ge(0)] = 0.0
    """Metres that the ego must have driven."""


# --- on the road, whatever the ego does ---------------------------------------------------------------------------


@dataclass(frozen=True, slots=True, kw_only=True)
class Breakdown(Incident):
    """A car stands in a lane with its hazard lights on."""

    kind: Literal["breakdown"] = "breakdown"
    edge: EdgeId
    """Edge on which the vehicle stands."""
    position_m: Annotated[float, Ge(0)]
    """Its front bumper, from the start of the edge."""
    lane: Annotated[int, Ge(0)] = 0
    """Among the edge's lanes for cars, 0 nearest the kerb."""
    aside: bool = False
    """Whether it stands beside the lane, so that others can pass."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Roadworks(Incident):
    """A lower limit is signed, and lanes may be closed."""

    kind: Literal["roadworks"] = "roadworks"
    edge: EdgeId
    """Edge on which the roadworks are."""
    limit_kmh: Annotated[float, Gt(0)]
    """What is signed there."""
    over: bool = False
    """Whether the works have ended and only their sign still stands; it holds, but nobody reports it."""
    closed_lanes: tuple[Annotated[int, Ge(0)], ...] = ()
    """Among the edge's lanes for cars, 0 nearest the kerb."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SpeedSign(Incident):
    """A sign of a lower limit: one with a plate, or a variable one."""

    kind: Literal["sign"] = "sign"
    edges: Annotated[tuple[EdgeId, ...], MinLen(1)]
    """The roads on which it holds."""
    limit_kmh: Annotated[float, Gt(0)]
    """What it shows."""
    plate: str = ""
    """When it holds, in OpenStreetMap's words: ``wet``, ``snow``, ``Mo-Fr 07:00-17:00``; without it, the sign is a
    variable one."""
    shows: Literal["over all lanes", "by lane"] = "over all lanes"
    """Where a variable sign shows it; by lane, over that at the kerb, and 20 km/h more over the others."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Jam(Incident):
    """A queue before a bottleneck at the end of the last edge; its tail is ``length_m`` further back at first."""

    kind: Literal["jam"] = "jam"
    edges: Annotated[tuple[EdgeId, ...], MinLen(1)]
    """In driving order, each leading to the next; together at least as long as the queue."""
    length_m: Annotated[float, Gt(0)]
    """Of the queue, at first."""
    hold_s: Annotated[float, Gt(0)] = 20.0
    """Average time between vehicles per lane that pass the bottleneck."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Closure(Incident):
    """A road closed to all except the authorities; other vehicles go round, or end their trip before it."""

    kind: Literal["closure"] = "closure"
    edge: EdgeId
    """Edge that is closed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SchoolZone(Incident):
    """A lower limit at certain hours of school days, Monday to Friday, in local time."""

    kind: Literal["school_zone"] = "school_zone"
    edges: Annotated[tuple[EdgeId, ...], MinLen(1)]
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
    from_edge: EdgeId
    """Where it sets out."""
    to_edge: EdgeId
    """Where it leaves the road."""
    speed_kmh: Annotated[float, Gt(0)] = 25.0
    """25 is a common speed on the plates that slow vehicles carry in Germany (StVZO section 58)."""
    length_m: Annotated[float, Gt(0)] = 9.0
    """Length including the trailer."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Pedestrians(Incident):
    """People walk from the end of one edge to the start of another, over the crossings between them.

    The network needs sidewalks and crossings (``netconvert --sidewalks.guess --crossings.guess``)."""

    kind: Literal["pedestrians"] = "pedestrians"
    from_edge: EdgeId
    """They come from its end."""
    to_edge: EdgeId
    """They go to its start."""
    every_s: Annotated[float, Ge(1)] = 10.0
    """Time between two groups."""
    group: Annotated[int, Ge(1)] = 3
    """Number of people who walk together."""


@dataclass(frozen=True, slots=True)
class VehicleCondition:
    """What a scripted vehicle's action waits for; it is looked at once a second."""

    what: Literal[
        "acceleration",
        "begun",
        "collision_time",
        "distance",
        "ended",
        "faster",
        "headway",
        "left",
        "place",
        "speed",
        "stands",
        "time",
        "travelled",
    ]
    """``begun``, ``ended``: the actions called ``of`` have; ``place``: ``of`` comes within ``value`` metres of
    ``x_m``, ``y_m``; ``time``: seconds after the departure; ``stands``, ``left`` (the road): for so many seconds;
    ``speed`` in m/s, ``acceleration`` in m/s2, ``travelled`` in m; ``distance`` (m), ``headway`` and
    ``collision_time`` (s) of ``of`` to ``to``, along the road; ``faster``: by so many m/s than it."""
    of: str = ""
    """The vehicle that it is about, ``ego`` for the ego, or the actions."""
    to: str = ""
    """The other vehicle."""
    value: float = 0.0
    """It holds above this, or as ``below`` and ``equal`` say."""
    below: bool = False
    """Whether it holds under ``value``, and before actions have begun or ended."""
    equal: bool = False
    """Whether it holds at ``value`` itself, within a hundredth."""
    x_m: float = 0.0
    """Of the place, where the front bumper comes to."""
    y_m: float = 0.0
    """Of the place."""
    bumper: bool = False
    """Whether distances are those between the vehicles, rather than between their fronts."""
    straight: bool = False
    """Whether the distance is that as the crow flies."""
    edge: Literal["none", "rising", "falling", "risingOrFalling"] = "none"
    """Whether it must have become true, or untrue, in the last second."""
    delay_s: Annotated[float, Ge(0)] = 0.0
    """How long ago it must have held."""
    group: Annotated[int, Ge(0)] = 0
    """The conditions of one group must hold together; one group is enough."""


@dataclass(frozen=True, slots=True)
class VehicleAction:
    """What a scripted vehicle does at a time, or once something holds: another speed, another lane, or both."""

    at_s: Annotated[float, Ge(0)]
    """Seconds after the ego's departure."""
    speed_kmh: Annotated[float, Ge(0)] | None = None
    """The speed that it keeps from then on, as far as traffic allows."""
    lanes: int = 0
    """Lanes to the left, or to the right if negative, into which it moves at once; with ``of``, from its lane."""
    name: str = ""
    """What conditions call it; several may share a name."""
    when: tuple[VehicleCondition, ...] = ()
    """What must hold besides."""
    of: str = ""
    """The vehicle that ``speed_share`` and ``lanes`` refer to, ``ego`` for the ego; if empty, itself."""
    speed_share: Annotated[float, Ge(0)] | None = None
    """The speed that it keeps, as a share of that of ``of``."""
    faster_kmh: float = 0.0
    """How much faster than that share."""
    keeps: bool = False
    """Whether it goes on keeping to the speed of ``of``, or the distance to it."""
    lane: Annotated[int, Ge(0)] | None = None
    """The lane into which it moves, among the edge's lanes for cars, 0 nearest the kerb."""
    over_s: Annotated[float, Ge(0)] = 0.0
    """How long the change takes; that of a lane is made at once all the same, and ended by then."""
    over_m: Annotated[float, Ge(0)] = 0.0
    """How far it drives meanwhile, instead."""
    rate: Annotated[float, Ge(0)] = 0.0
    """Change of speed in m/s2, instead."""
    alone: bool = False
    """Whether it ends what the vehicle is still at."""
    times: Annotated[int, Ge(1)] = 1
    """How often it is carried out: again once it is over and what must hold holds again."""
    meets_edge: str = ""
    """It adapts its speed so as to be at ``meets_m`` of this edge when ``of`` is at ``of_meets_m`` of
    ``of_meets_edge``; there it has the speed that is asked for."""
    meets_m: Annotated[float, Ge(0)] = 0.0
    """Of its front bumper, from the start of the edge."""
    of_meets_edge: str = ""
    """The edge on the way of ``of``."""
    of_meets_m: Annotated[float, Ge(0)] = 0.0
    """Of the front bumper of ``of``."""
    gap_m: Annotated[float, Ge(0)] | None = None
    """The distance to ``of`` that it comes to, and goes on keeping if it ``keeps``."""
    gap_s: Annotated[float, Ge(0)] | None = None
    """How long it takes to drive that distance, instead."""
    bumper: bool = False
    """Whether the distance is that between the vehicles, rather than between their fronts."""
    trails: bool = False
    """Whether it is to be behind ``of``, rather than where it is, ahead or behind."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ScriptedVehicle(Incident):
    """A vehicle on a route of its own, which acts at given times."""

    kind: Literal["vehicle"] = "vehicle"
    name: str = ""
    """What conditions and other vehicles' actions call it."""
    route: Annotated[tuple[EdgeId, ...], MinLen(1)]
    """Its edges, in driving order, each leading to the next."""
    position_m: Annotated[float, Ge(0)] = 0.0
    """Where its front bumper is at first, from the start of the first edge."""
    lane: Annotated[int, Ge(0)] = 0
    """Among the edge's lanes for cars, 0 nearest the kerb."""
    speed_kmh: Annotated[float, Ge(0)] = 50.0
    """The speed that it keeps at first, as far as traffic allows."""
    length_m: Annotated[float, Gt(0)] = 5.0
    """Its length."""
    keeps_lane: bool = False
    """Whether it changes the lane only when told or to follow its route, after its last action too."""
    actions: tuple[VehicleAction, ...] = ()
    """In the order of the times; until the last, it changes the lane only when told."""


# --- around the ego ---------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True, kw_only=True)
class EmergencyVehicle(EgoIncident):
    """An ambulance with blue lights comes up from behind on the ego's route, or a plain van as fast.

    Other drivers form a corridor for it only if ``[sumo] lateral_resolution_m`` enables SUMO's sublane model."""

    kind: Literal["emergency"] = "emergency"
    behind_m: Annotated[float, Gt(0)] = 250.0
    """Distance behind the ego at which it appears, out of sight on the ego's route."""
    speed_ratio: Annotated[float, Gt(0)] = 1.5
    """Its factor on the limit, where traffic allows."""
    blue_light: bool = True
    """False for a van: others need not make way for it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BrakingLeader(EgoIncident):
    """The vehicle ahead of the ego brakes hard. If there is none, a car first pulls out in front of the ego."""

    kind: Literal["braking_leader"] = "braking_leader"
    within_m: Annotated[float, Gt(0)] = 80.0
    """How near a vehicle must be to count as the one ahead."""
    beyond_m: Annotated[float, Ge(0)] = 0.0
    """How far away it must be at least; a nearer one is waited for."""
    from_kmh: Annotated[float, Ge(0)] = 0.0
    """How fast the ego must be; until then it is waited for."""
    ahead_m: Annotated[float, Gt(0)] = 30.0
    """Gap to a car that pulls out."""
    deceleration_mps2: Annotated[float, Gt(0), Le(10)] = 6.0
    """Deceleration of the car that brakes."""
    to_kmh: Annotated[float, Ge(0)] = 0.0
    """The speed that it brakes to."""
    hold_s: Annotated[float, Ge(0)] = 4.0
    """How long it keeps that speed before it drives on."""
    keeps_lane: bool = False
    """Whether it stays in its lane meanwhile, where it would let the ego pass or go round somebody."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CutIn(EgoIncident):
    """A vehicle beside the ego's lane moves into it, close in front, whether there is room or not."""

    kind: Literal["cut_in"] = "cut_in"
    gap_m: Annotated[float, Gt(0)] = 20.0
    """Gap to it when it moves over."""
    slower_kmh: Annotated[float, Ge(0)] = 15.0
    """By how much it is slower than the ego."""
    from_kmh: Annotated[float, Ge(0)] = 20.0
    """How fast the ego must be; until then, and for a road with two lanes, it is waited for."""
    hold_s: Annotated[float, Gt(0)] = 8.0
    """How long it keeps its speed and the lane before it drives on."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CutOut(EgoIncident):
    """The vehicle ahead of the ego leaves the lane and lets the ego see a car that stands in it. If there is none
    ahead, a car first pulls out in front of the ego."""

    kind: Literal["cut_out"] = "cut_out"
    within_m: Annotated[float, Gt(0)] = 60.0
    """How near a vehicle must be to count as the one ahead."""
    reveal_m: Annotated[float, Gt(0)] = 40.0
    """How far ahead of that vehicle the other one stands."""
    from_kmh: Annotated[float, Ge(0)] = 20.0
    """How fast the ego must be; until then, and for a road with two lanes, it is waited for."""
    ahead_m: Annotated[float, Gt(0)] = 25.0
    """Gap to a car that pulls out."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AheadIncident(EgoIncident):
    """An incident on the ego's route some way ahead, wherever that is by then, as far as a road there has room."""

    kind: Literal["ahead"] = "ahead"
    what: Literal["breakdown", "roadworks", "left_sign", "sign", "jam", "tractor"]
    """A car stands with its hazard lights on, on the verge where there is one lane; a lower limit is signed; such a
    sign still stands after roadworks; a sign with a plate, or a variable one, for 600 m; a queue; a slow vehicle
    drives a kilometre along the route."""
    ahead_m: Annotated[float, Gt(0)] = 600.0
    """Distance from the ego along its route."""
    length_m: Annotated[float, Gt(0)] = 100.0
    """Of the queue, at first."""
    plate: str = ""
    """Of the sign, as of ``kind = "sign"``."""
    shows: Literal["over all lanes", "by lane"] = "over all lanes"
    """Where a sign without a plate shows it."""
    other_way: bool = False
    """Whether it is on the carriageway of the other direction, where it concerns others."""


AnyIncident = Annotated[
    Breakdown
    | Roadworks
    | SpeedSign
    | Jam
    | Closure
    | SchoolZone
    | RushHour
    | Tractor
    | Pedestrians
    | ScriptedVehicle
    | EmergencyVehicle
    | BrakingLeader
    | CutIn
    | CutOut
    | AheadIncident,
    TaggedBy("kind"),
]
"""One of ``[[incidents]]``."""
