"""The nouns that flow through the co-simulation, once round the loop.

    SUMO -> DrivingState -> GpsFix -> GeoContext -> vehicle signals -> Element -> Observation -> Action
      ^                                                                                            |
      +----------------------------------------- RoadRequest <-------------------------------------+

Everything here is frozen data without behaviour of its own. Units stand in the field names: ``_s`` seconds,
``_m`` metres, ``_mps`` metres per second, ``_mps2`` metres per second squared, ``_deg`` degrees, ``_kmh``
kilometres per hour, ``_c`` degrees Celsius, ``_pct`` per cent. ``None`` means that there is no such thing
(no leader, no limit, no projection), never zero.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

KMH_PER_MPS = 3.6
MPH_PER_MPS = 3600 / 1609.344


# --- the road ---------------------------------------------------------------------------------------------


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


# --- what the cockpit asks of the road --------------------------------------------------------------------


class AlertKind(StrEnum):
    """What an alert to the driver is about. The order is that of the action space."""

    SPEED = "speed"
    DISTANCE = "distance"
    COLLISION = "collision"
    LANE = "lane"
    FATIGUE = "fatigue"
    DISTRACTION = "distraction"
    SEAT_BELT = "seat_belt"
    VISIBILITY = "visibility"
    SLIPPERY = "slippery"
    WEATHER = "weather"
    TRAFFIC = "traffic"
    CORRIDOR = "corridor"
    YIELD = "yield"
    MOVE_OVER = "move_over"
    SCHOOL = "school"
    TUNNEL = "tunnel"
    VEHICLE = "vehicle"


class Severity(StrEnum):
    """How loudly an alert is given."""

    INFO = "info"
    WARNING = "warning"
    CRITICAL = "critical"


@dataclass(frozen=True, slots=True)
class Alert:
    """Tells the driver something; a driver who complies slows down or opens the gap."""

    kind: AlertKind
    severity: Severity = Severity.WARNING
    text: str = ""
    speed_kmh: float | None = None
    """The speed advised; None leaves it to the posted limit."""


@dataclass(frozen=True, slots=True)
class SlowDown:
    """Asks the driver to go no faster than this."""

    speed_kmh: float


@dataclass(frozen=True, slots=True)
class Cruise:
    """Cruise control: hold at most this speed; None switches it off."""

    speed_kmh: float | None


@dataclass(frozen=True, slots=True)
class Hazards:
    """The hazard lights, seen by the others."""

    on: bool


@dataclass(frozen=True, slots=True)
class PullOver:
    """Asks the driver to stop at the side as soon as that is safe."""


@dataclass(frozen=True, slots=True)
class Reroute:
    """Asks for another route: to a street, edge or lon/lat, or along given edges."""

    destination: str = ""
    """Edge id or street name; empty keeps the goal."""
    edges: tuple[str, ...] = ()
    """The whole route from the current edge on, what lies behind left out; empty lets the router choose."""


RoadRequest = Alert | SlowDown | Cruise | Hazards | PullOver | Reroute


@dataclass(frozen=True, slots=True)
class Answer:
    """The road's answer to a request."""

    accepted: bool
    reason: str
    """Why not, or what will happen, in words."""


# --- the map ----------------------------------------------------------------------------------------------


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


@dataclass(frozen=True, slots=True)
class RoadNetwork:
    """The drivable network a scenario runs on."""

    roads: tuple[Road, ...]
    bounds_m: tuple[float, float, float, float]
    """(x_min, y_min, x_max, y_max)."""
    projection: str | None
    """PROJ string of the network's location tag; None if it has none."""
    offset_m: tuple[float, float]
    """``netOffset``: added to projected coordinates."""
    left_hand: bool


# --- where it is ------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Weather:
    """The weather at the car, in Open-Meteo's field names and units, WMO 4677 codes."""

    temperature_2m: float
    """Degrees Celsius."""
    relative_humidity_2m: float
    """Per cent."""
    precipitation: float
    """Millimetres per hour."""
    weather_code: int
    cloud_cover: float
    """Per cent."""
    visibility: float
    """Metres."""
    wind_speed_10m: float
    """Kilometres per hour."""


@dataclass(frozen=True, slots=True)
class GpsFix:
    """What the receiver reports. Without a fix it repeats the last one, ageing."""

    has_fix: bool
    lon_deg: float
    lat_deg: float
    accuracy_m: float
    """One standard deviation of the horizontal error."""
    age_s: float
    """Since the fix was taken."""
    heading_deg: float


@dataclass(frozen=True, slots=True)
class Connectivity:
    """The car's link to the outside."""

    online: bool
    kind: str
    """``"none"``, ``"4g"`` or ``"5g"``."""
    signal_bars: int
    """0 to 4."""


@dataclass(frozen=True, slots=True)
class Surroundings:
    """Everything outside the cockpit at one instant, as the cockpit's sensors meet it."""

    driving: DrivingState
    weather: Weather
    local_time: datetime
    """Zone-aware."""
    sun_elevation_deg: float | None
    """None where the position is not known."""
    gps: GpsFix | None
    """None in a network without projection."""
    connectivity: Connectivity


# --- what the agent sees ----------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class BoundingBox:
    """Pixels, the maxima exclusive, as AndroidWorld's ``bbox_pixels``."""

    x_min: int
    y_min: int
    x_max: int
    y_max: int


@dataclass(frozen=True, slots=True)
class Element:
    """One entry of the accessibility tree, AndroidWorld's ``UIElement``. Its place in the list is its index."""

    text: str
    content_description: str
    class_name: str
    bbox_pixels: BoundingBox
    resource_id: str
    package_name: str
    hint_text: str = ""
    is_checked: bool = False
    is_checkable: bool = False
    is_clickable: bool = False
    is_editable: bool = False
    is_enabled: bool = True
    is_focused: bool = False
    is_focusable: bool = False
    is_long_clickable: bool = False
    is_scrollable: bool = False
    is_selected: bool = False
    is_visible: bool = True


@dataclass(frozen=True, slots=True)
class VehicleState:
    """What the car's own sensors and switches tell an agent. A field the car does not have is None."""

    speed_kmh: float
    gear: str
    """``"P"``, ``"R"``, ``"N"`` or ``"D"``."""
    restrictions: int
    """Android ``CarUxRestrictions`` bits; 0 while parked."""
    ambient_temperature_c: float
    cabin_temperature_c: float
    cabin_humidity_pct: float
    rain_intensity_pct: float
    driver_temperature_set_c: float
    fan_speed_pct: float
    is_low_beam_on: bool
    is_high_beam_on: bool
    is_front_fog_on: bool
    is_rear_fog_on: bool
    is_hazard_on: bool
    energy_level_pct: float
    range_km: float
    speed_limit_sign_kmh: float | None
    """Read by the sign camera; None where the car has none or no sign stands."""
    leader_gap_m: float | None
    leader_time_to_collision_s: float | None


class FeedbackCode(StrEnum):
    """How an action went. The order is that of the observation space."""

    NONE = "none"
    """Nothing has been done yet."""
    OK = "ok"
    NO_EFFECT = "no_effect"
    """Well formed and possible, but nothing changed (e.g. a tap beside every widget)."""
    NO_SUCH_ELEMENT = "no_such_element"
    DISABLED = "disabled"
    RESTRICTED = "restricted"
    """Locked while driving."""
    REFUSED = "refused"
    """The road or the car could not do it; the text says why."""
    MALFORMED = "malformed"


@dataclass(frozen=True, slots=True)
class Feedback:
    """What came of the last action, in a code and in words."""

    code: FeedbackCode
    text: str


@dataclass(frozen=True, slots=True)
class Observation:
    """All an agent gets. A channel it is not given is None."""

    goal: str
    time_s: float
    """Seconds since the hand-over."""
    feedback: Feedback
    elements: tuple[Element, ...] | None = None
    screenshot: npt.NDArray[np.uint8] | None = None
    """(height, width, 3), RGB."""
    vehicle: VehicleState | None = None
    connectivity: Connectivity | None = None
    gps: GpsFix | None = None
    context: str | None = None
    """The geo-context as text: facts and rules that apply here, never a judgement."""


# --- what the agent does ----------------------------------------------------------------------------------


class ActionType(StrEnum):
    """AndroidWorld's action types, the car's safety calls, and two for places. The order is that of the
    action space."""

    CLICK = "click"
    DOUBLE_TAP = "double_tap"
    LONG_PRESS = "long_press"
    INPUT_TEXT = "input_text"
    SCROLL = "scroll"
    SWIPE = "swipe"
    KEYBOARD_ENTER = "keyboard_enter"
    NAVIGATE_HOME = "navigate_home"
    NAVIGATE_BACK = "navigate_back"
    OPEN_APP = "open_app"
    WAIT = "wait"
    ANSWER = "answer"
    STATUS = "status"
    SHOW_ALERT = "show_alert"
    HAZARD_LIGHTS = "hazard_lights"
    EMERGENCY_CALL = "emergency_call"
    REQUEST_SLOW_DOWN = "request_slow_down"
    REQUEST_REROUTE = "request_reroute"
    PULL_OVER = "pull_over"
    QUERY = "query"
    ESTIMATE_POSITION = "estimate_position"


class GoalStatus(StrEnum):
    """What ``status`` declares."""

    COMPLETE = "complete"
    INFEASIBLE = "infeasible"
    NOT_NEEDED = "not_needed"


class Reason(StrEnum):
    """Why a task is declined."""

    NONE = "none"
    LAW = "law"
    SAFETY = "safety"
    ALREADY_SO = "already_so"
    NOT_POSSIBLE = "not_possible"


class Direction(StrEnum):
    """Of ``scroll`` and ``swipe``."""

    UP = "up"
    DOWN = "down"
    LEFT = "left"
    RIGHT = "right"


@dataclass(frozen=True, slots=True)
class Action:
    """One thing an agent does; ``actions.parse`` reads it from JSON and says which fields each type takes."""

    action_type: ActionType
    index: int | None = None
    x: int | None = None
    y: int | None = None
    text: str | None = None
    direction: Direction | None = None
    distance_px: int | None = None
    app_name: str | None = None
    goal_status: GoalStatus | None = None
    reason: Reason | None = None
    clear_text: bool | None = None
    seconds: int | None = None
    kind: AlertKind | None = None
    severity: Severity | None = None
    speed_kmh: float | None = None
    on: bool | None = None
    destination: str | None = None


Json = dict[str, Any]
"""A JSON object: the edge of the package, where types end."""
