"""The ego's state on the road, and what is around and ahead of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum

from automotive_cosim.contracts.plain import KMH_PER_MPS, RARE, UNTRACED

STANDING_BELOW_MPS = 0.1
"""A slower vehicle is stationary, as in SUMO's count of halted vehicles."""
OLDEST_NEWS_S = 900.0
"""Maximum age of available travel times."""


class EgoEnd(StrEnum):
    """Why the ego is no longer driving. SUMO removes an arrived, a collided and a removed vehicle alike; a
    teleported one is moved because it stood too long, which voids the episode."""

    ARRIVED = "arrived"
    COLLIDED = "collided"
    REMOVED = "removed"
    TELEPORTED = "teleported"


class LimitSource(StrEnum):
    """Where a speed limit comes from."""

    POSTED = "posted"
    """A sign: the map or the scenario's author states it."""
    VARIABLE = "variable"
    """A variable sign that shows something now."""
    ASSUMED = "assumed"
    """A default for the road class from when the map was made: advice, never a verdict's basis."""
    LAW = "law"
    """A rule of the place."""
    NONE = "none"
    """Nothing is known."""


@dataclass(frozen=True, slots=True)
class Limit:
    """A speed limit that knows where it comes from."""

    mps: float | None
    """None if there is none (derestricted), or none is known."""
    source: LimitSource

    @property
    def kmh(self) -> float | None:
        """The limit in km/h; None as ``mps`` is."""
        return None if self.mps is None else self.mps * KMH_PER_MPS

    @property
    def is_posted(self) -> bool:
        """Whether a sign says so, even that there is no limit."""
        return self.source in (LimitSource.POSTED, LimitSource.VARIABLE)

    @property
    def words(self) -> str:
        """How it is posted, before a road's name."""
        return "posted on a variable sign of" if self.source is LimitSource.VARIABLE else "posted on"

    @property
    def posted_mps(self) -> float | None:
        """The speed on a sign; None without one, or if it lifts every limit."""
        return self.mps if self.is_posted else None


NO_LIMIT = Limit(None, LimitSource.NONE)
"""No limit is known."""


@dataclass(frozen=True, slots=True)
class RoadHere:
    """The piece of road under the ego."""

    edge_id: str
    """SUMO edge; inside a junction its internal edge (starts with ``:``)."""
    lane_id: str
    lane_index: int
    """0 is the lane nearest the kerb."""
    lane_count: int
    lane_position_m: float
    """Distance from the start of the lane."""
    name: str
    """Street name as signed; empty without one."""
    road_class: str
    """OSM highway value, e.g. ``"motorway"``, ``"primary"``, ``"residential"``, or ``"cycle_street"``; empty if
    unknown."""
    limit: Limit
    """The lane's limit in the network, from a sign or assumed."""
    in_tunnel: bool
    lit: bool | None
    """Street lighting; None if the map does not say. The same for the two below."""
    built_up: bool | None
    centre_line: bool | None
    friction: float
    """Friction coefficient of the lane, 1 is dry."""
    school_zone: bool = False
    """In a school zone, whether or not its limit is in force."""
    limit_hours: str = ""
    """Limits posted for certain hours, in words: ``"40 km/h Mo-Fr 08:00-09:30, 14:30-16:00"``; empty if the
    limit does not depend on the clock."""
    limit_by_clock: bool = False
    """Whether the present limit is one of those."""
    bus_lane: bool = False
    """Whether another lane in this direction is for buses and not for cars."""
    lane_alone: bool | None = field(default=None, metadata=RARE)
    """True where a variable sign shows the limit over this lane, and another or none over other lanes."""


@dataclass(frozen=True, slots=True)
class TrafficLight:
    """The next signal on the ego's route."""

    tls_id: str
    state: str
    """SUMO's letter for the ego's link: ``G g y Y r R u s o O``."""
    distance_m: float


@dataclass(frozen=True, slots=True)
class OtherVehicle:
    """A vehicle seen from the ego, along the road."""

    vehicle_id: str
    gap_m: float
    """Bumper to bumper, never negative; for oncoming traffic the straight distance."""
    speed_mps: float
    time_to_collision_s: float | None
    """Gap divided by closing speed; None while the gap does not shrink."""
    drac_mps2: float | None = None
    """Deceleration rate to avoid a crash: closing speed squared over twice the gap (Cooper and Ferguson, 1976);
    also None while the gap does not shrink."""
    kind: str = field(default="", metadata=UNTRACED)
    """SUMO's vehicle class, of the leader alone, which only a look through the windshield tells; so the next."""
    is_braking: bool = field(default=False, metadata=UNTRACED)
    """Whether its brake lamps are lit."""


@dataclass(frozen=True, slots=True)
class RouteOption:
    """An alternative route to the ego's destination."""

    edges: tuple[str, ...]
    """Edges from the present one to the destination."""
    length_m: float
    eta_s: float
    """Travel time from now, at present speeds."""
    delay_s: float
    """``eta_s`` above free flow at the limits."""


class IncidentKind(StrEnum):
    """What a live-traffic service reports besides slow traffic; the values are those of a scenario's incidents."""

    BREAKDOWN = "breakdown"
    ROADWORKS = "roadworks"
    JAM = "jam"
    CLOSURE = "closure"
    SCHOOL_ZONE = "school_zone"


@dataclass(frozen=True, slots=True)
class RoadIncident:
    """An incident on the road that a live-traffic service reports."""

    kind: IncidentKind
    edge_id: str
    position_m: float
    """Where a driver meets it, from the start of the edge."""


@dataclass(frozen=True, slots=True)
class RoadAhead:
    """The ego's route from here to its destination."""

    route_left_m: float
    eta_s: float
    """Travel time to the destination at present speeds."""
    delay_s: float
    """``eta_s`` above free flow at the limits."""
    relative_speed: float
    """Mean speed over the remaining route as a share of that at the limits: the rest of ``eta_s`` is ``delay_s``.
    1 is free flow."""
    jam_distance_m: float | None
    """Distance to the first edge whose relative speed is under a quarter; None without one."""
    jam_length_m: float
    next_light: TrafficLight | None
    next_limit: Limit | None
    """The next different limit on the route, and its distance; None if it does not change."""
    next_limit_distance_m: float | None
    tunnel_distance_m: float | None
    exit_distance_m: float | None
    """Distance to the next place where the route could leave a road without junctions (motorway class)."""
    route_edges: tuple[str, ...] = ()
    """Edges of the route from the present one to the destination, for the map to draw."""
    alternatives: tuple[RouteOption, ...] = ()
    """Alternative routes, the quickest first."""
    camera_distance_m: float | None = None
    """Distance to the next speed camera on the route; None if the map has none."""
    slow_edges: tuple[tuple[str, float], ...] = ()
    """Edges anywhere in the network with traffic slower than three quarters of their limit, and their mean speed
    divided by the limit, as reported by a live-traffic service."""
    incidents: tuple[RoadIncident, ...] = ()
    """Incidents anywhere in the network that such a service reports now."""
    next_sign: str | None = field(default=None, metadata=RARE)
    """The next stop or give-way sign on the route, ``"stop"`` or ``"give_way"``, and its distance, metres; None
    if the map has none."""
    sign_distance_m: float | None = field(default=None, metadata=RARE)

    @property
    def delay_min(self) -> int:
        """``delay_s`` in whole minutes, as drivers are told it; 0 is no delay."""
        return round(self.delay_s / 60)


@dataclass(frozen=True, slots=True)
class Around:
    """The vehicles around the ego."""

    leader: OtherVehicle | None
    follower: OtherVehicle | None
    oncoming: OtherVehicle | None
    """Nearest oncoming vehicle on the same road within 300 m."""
    emergency_behind: OtherVehicle | None
    """Nearest vehicle of SUMO's class ``emergency`` with its blue lights on, behind within 300 m."""
    relative_speed: float
    """Mean speed divided by the limit on the ego's edge; 1 is free flow."""


@dataclass(frozen=True, slots=True)
class DrivingState:
    """The ego's state on the road at one instant: all that the cockpit and the geo-context learn about it."""

    time_s: float
    """SUMO simulation time at the end of the step. SUMO's FCD output gives the same state the time of its
    beginning: one step less."""
    x_m: float
    y_m: float
    """Position of the front bumper in the network's coordinates."""
    lon_deg: float | None
    lat_deg: float | None
    """WGS 84; None in a network without projection."""
    heading_deg: float
    """Clockwise from north."""
    speed_mps: float
    acceleration_mps2: float
    standing_s: float
    """How long it has been stationary (under 0.1 m/s)."""
    distance_m: float
    """Distance driven since departure, by SUMO's odometer, which counts a step once the next one begins."""
    road: RoadHere
    ahead: RoadAhead
    around: Around
    hazard_lights: bool
    vehicle_count: int
    """Number of vehicles in the simulation, including the ego."""
    end: EgoEnd | None = None
    """Why the drive ended; set in the ego's last state, which otherwise repeats the previous one."""
    trailer: bool | None = field(default=None, metadata=RARE)
    """True if the car tows a trailer, of which only the law knows; None without one."""
