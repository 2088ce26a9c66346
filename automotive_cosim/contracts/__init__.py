"""The data types that flow through the co-simulation, once round the loop.

    SUMO -> DrivingState -> GpsFix -> GeoContext -> vehicle signals -> Element -> Observation -> Action
      ^                                                                                            |
      +----------------------------------------- RoadRequest <-------------------------------------+

Everything here is frozen data without behaviour of its own. Field names carry the units: ``_s`` seconds,
``_m`` metres, ``_mps`` metres per second, ``_mps2`` metres per second squared, ``_deg`` degrees, ``_kmh``
kilometres per hour, ``_c`` degrees Celsius, ``_pct`` per cent. ``None`` means that there is none
(no leader, no limit, no projection), never zero.

driving      the car's state on the road, and what is around and ahead of it
roads        the network as a map draws it
snapshot     the road as a picture shows it, with every vehicle
place        weather, position fix, connection, surroundings
observation  what an agent sees
action       what an agent does
requests     the cockpit's requests to the road, and the answers
plain        factors between units, JSON, numbers in texts, and how progress is told
"""

from automotive_cosim.contracts.action import (
    BY_HAND,
    UNCALLED,
    Action,
    ActionType,
    Direction,
    GoalStatus,
    Reason,
)
from automotive_cosim.contracts.driving import (
    NO_LIMIT,
    OLDEST_NEWS_S,
    STANDING_BELOW_MPS,
    Around,
    DrivingState,
    EgoEnd,
    IncidentKind,
    Limit,
    LimitSource,
    OtherVehicle,
    RoadAhead,
    RoadHere,
    RoadIncident,
    RouteOption,
    TrafficLight,
)
from automotive_cosim.contracts.observation import (
    BoundingBox,
    Element,
    Feedback,
    FeedbackCode,
    Observation,
    VehicleState,
)
from automotive_cosim.contracts.place import Connectivity, GpsFix, Surroundings, Weather
from automotive_cosim.contracts.plain import KMH_PER_MPS, MPH_PER_MPS, Json, Tell, lon_lat
from automotive_cosim.contracts.requests import (
    Alert,
    AlertKind,
    Answer,
    Aware,
    Cruise,
    Hazards,
    PullOver,
    Redraw,
    Reroute,
    RoadRequest,
    Severity,
    SlowDown,
)
from automotive_cosim.contracts.roads import GroundArea, GroundKind, Road, RoadNetwork, in_drawing_order
from automotive_cosim.contracts.sensed import Sight, SightKind
from automotive_cosim.contracts.snapshot import LaneShape, RoadShapes, RoadSnapshot, SeenVehicle, SumoSignal

__all__ = [
    "BY_HAND",
    "KMH_PER_MPS",
    "MPH_PER_MPS",
    "NO_LIMIT",
    "OLDEST_NEWS_S",
    "STANDING_BELOW_MPS",
    "UNCALLED",
    "Action",
    "ActionType",
    "Alert",
    "AlertKind",
    "Answer",
    "Around",
    "Aware",
    "BoundingBox",
    "Connectivity",
    "Cruise",
    "Direction",
    "DrivingState",
    "EgoEnd",
    "Element",
    "Feedback",
    "FeedbackCode",
    "GoalStatus",
    "GpsFix",
    "GroundArea",
    "GroundKind",
    "Hazards",
    "IncidentKind",
    "Json",
    "LaneShape",
    "Limit",
    "LimitSource",
    "Observation",
    "OtherVehicle",
    "PullOver",
    "Reason",
    "Redraw",
    "Reroute",
    "Road",
    "RoadAhead",
    "RoadHere",
    "RoadIncident",
    "RoadNetwork",
    "RoadRequest",
    "RoadShapes",
    "RoadSnapshot",
    "RouteOption",
    "SeenVehicle",
    "Severity",
    "Sight",
    "SightKind",
    "SlowDown",
    "SumoSignal",
    "Surroundings",
    "Tell",
    "TrafficLight",
    "VehicleState",
    "Weather",
    "in_drawing_order",
    "lon_lat",
]
