"""Triggers: the situation on the road that starts a task. Pure predicates on one moment, without effects.

Each condition is a frozen dataclass, so it can be compared and stored; ``str`` describes it in words. A condition
about something that does not exist (no leader, no limit, no place) does not hold.

base          what a trigger is; conjunction and negation
motion        how the car moves, and its own signals
road          the road that it is on, and what comes next
others        other vehicles on the road
surroundings  sky, place, position fix and connection
"""

from automotive_cosim.tasking.triggers.base import All, Not, Trigger, TriggerCondition
from automotive_cosim.tasking.triggers.motion import (
    Driving,
    OverPosted,
    Parked,
    SignalAbove,
    SignalBelow,
    SignalHas,
    SpeedAbove,
    SpeedBetween,
    Standing,
)
from automotive_cosim.tasking.triggers.others import (
    BlueLightWithin,
    CollisionWithin,
    DelayAbove,
    FlowBelow,
    FollowerWithin,
    HeadwayBelow,
    JamWithin,
    LeaderWithin,
    OncomingWithin,
    OtherWayKnown,
    RedLight,
    SlowLeaderWithin,
)
from automotive_cosim.tasking.triggers.road import (
    BuiltUp,
    CentreLine,
    GoalWithin,
    InSchoolZone,
    InTunnel,
    Lanes,
    LessGripThan,
    Lit,
    LowerLimitWithin,
    OnRoadClass,
    OnStreet,
    OutOfRange,
    TunnelOnRoute,
    TunnelWithin,
    Unposted,
)
from automotive_cosim.tasking.triggers.surroundings import (
    AirBetween,
    Dark,
    GpsLost,
    InCountry,
    Offline,
    RainBetween,
    VisibilityBetween,
)

__all__ = [
    "AirBetween",
    "All",
    "BlueLightWithin",
    "BuiltUp",
    "CentreLine",
    "CollisionWithin",
    "Dark",
    "DelayAbove",
    "Driving",
    "FlowBelow",
    "FollowerWithin",
    "GoalWithin",
    "GpsLost",
    "HeadwayBelow",
    "InCountry",
    "InSchoolZone",
    "InTunnel",
    "JamWithin",
    "Lanes",
    "LeaderWithin",
    "LessGripThan",
    "Lit",
    "LowerLimitWithin",
    "Not",
    "Offline",
    "OnRoadClass",
    "OnStreet",
    "OncomingWithin",
    "OtherWayKnown",
    "OutOfRange",
    "OverPosted",
    "Parked",
    "RainBetween",
    "RedLight",
    "SignalAbove",
    "SignalBelow",
    "SignalHas",
    "SlowLeaderWithin",
    "SpeedAbove",
    "SpeedBetween",
    "Standing",
    "Trigger",
    "TriggerCondition",
    "TunnelOnRoute",
    "TunnelWithin",
    "Unposted",
    "VisibilityBetween",
]
