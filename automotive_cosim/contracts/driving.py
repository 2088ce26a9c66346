"""What the ego does on the road, and what is around and ahead of it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

STANDING_BELOW_MPS = 0.1
"""Slower than this is standing, as SUMO counts halted vehicles."""


class EgoEnd(StrEnum):
    """Why the ego is no longer driving. SUMO removes an arrived, a collided and a removed vehicle alike; a
    teleported one is taken from its road because it stood too long, which voids the episode."""

    ARRIVED = "arrived"
    COLLIDED = "collided"
    REMOVED = "removed"
    TELEPORTED = "teleported"


class LimitSource(StrEnum):
    """Where the speed limit of a road in the network comes from."""

    POSTED = "posted"
    """A sign: the map or the scenario's author states it."""
    ASSUMED = "assumed"
    """A default taken for the road class when the map was made: advice, never a verdict's basis."""


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
    """Street name as signed; empty where it has none."""
    road_class: str
    """OSM highway value, e.g. ``"motorway"``, ``"primary"``, ``"residential"``; empty if unknown."""
    posted_limit_mps: float | None
    """The lane's limit in the network; None where there is none (derestricted)."""
    limit_source: LimitSource
    in_tunnel: bool
    lit: bool | None
    """Street lighting; None where the map does not say. Likewise the two below."""
    built_up: bool | None
    centre_line: bool | None
    friction: float
    """Friction coefficient of the lane, 1 is dry."""
    school_zone: bool = False
    """In a school zone, whether or not its limit is in force."""
    limit_hours: str = ""
    """What the signs post for certain hours, in words: ``"40 km/h Mo-Fr 08:00-09:30, 14:30-16:00"``; empty if the
    limit does not depend on the clock."""
    limit_by_clock: bool = False
    """The posted limit is one of those now."""
    bus_lane: bool = False
    """Another lane in this direction is for buses and not for cars."""


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
    """Gap over closing speed; None while the gap grows or stays."""
    drac_mps2: float | None = None
    """Deceleration rate to avoid a crash: closing speed squared over twice the gap (Cooper and Ferguson, 1976);
    None likewise."""


@dataclass(frozen=True, slots=True)
class RouteOption:
    """Another way to the ego's goal."""

    edges: tuple[str, ...]
    """From the present edge to the goal."""
    length_m: float
    eta_s: float
    """Seconds from now, at the speeds driven on it now."""
    delay_s: float
    """``eta_s`` above free flow at the posted limits."""


class IncidentKind(StrEnum):
    """What a live-traffic service tells of beside slow traffic; the values are those of ``incidents.KINDS``."""

    BREAKDOWN = "breakdown"
    ROADWORKS = "roadworks"
    JAM = "jam"
    CLOSURE = "closure"
    SCHOOL_ZONE = "school_zone"


@dataclass(frozen=True, slots=True)
class RoadIncident:
    """Something on the road that a live-traffic service tells of."""

    kind: IncidentKind
    edge_id: str
    position_m: float
    """Where one comes upon it, from the start of the edge."""


@dataclass(frozen=True, slots=True)
class RoadAhead:
    """The ego's route from here to its goal."""

    route_left_m: float
    eta_s: float
    """Travel time to the goal from the speeds driven on it now, seconds from now."""
    delay_s: float
    """``eta_s`` above free flow at the posted limits."""
    relative_speed: float
    """Mean speed over posted limit, length-weighted over the route left; 1 is free flow."""
    jam_distance_m: float | None
    """Distance to the first edge whose relative speed is under a quarter; None without one."""
    jam_length_m: float
    next_light: TrafficLight | None
    next_limit_mps: float | None
    """The next different limit on the route, and how far it is; None where it does not change."""
    next_limit_distance_m: float | None
    tunnel_distance_m: float | None
    exit_distance_m: float | None
    """Distance to the next place where the route could leave a road without junctions (motorway class)."""
    route_edges: tuple[str, ...] = ()
    """Edges of the route from the present one to the goal, for the map to draw."""
    alternatives: tuple[RouteOption, ...] = ()
    """Other ways there, the quickest first."""
    camera_distance_m: float | None = None
    """Distance to the next speed camera on the route; None where the map knows none."""
    slow_edges: tuple[tuple[str, float], ...] = ()
    """Edges anywhere in the network driven slower than three quarters of their limit, and their mean speed over
    the limit: what a live-traffic service tells a map."""
    incidents: tuple[RoadIncident, ...] = ()
    """Those anywhere in the network that such a service knows of now."""


@dataclass(frozen=True, slots=True)
class Around:
    """The vehicles about the ego."""

    leader: OtherVehicle | None
    follower: OtherVehicle | None
    oncoming: OtherVehicle | None
    """Nearest oncoming vehicle on the same road within 300 m."""
    emergency_behind: OtherVehicle | None
    """Nearest vehicle of SUMO's class ``emergency`` with its blue light on, behind, within 300 m."""
    relative_speed: float
    """Mean speed over posted limit of the ego's edge now; 1 is free flow."""


@dataclass(frozen=True, slots=True)
class DrivingState:
    """What the ego does on the road at one instant: everything the cockpit and the geo-context learn of it."""

    time_s: float
    """SUMO simulation time."""
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
    """How long it has been standing (under 0.1 m/s)."""
    distance_m: float
    """Driven since departure."""
    road: RoadHere
    ahead: RoadAhead
    around: Around
    hazard_lights: bool
    vehicle_count: int
    """Vehicles in the simulation, the ego included."""
    end: EgoEnd | None = None
    """Set in the ego's last state, which otherwise repeats the one before."""
