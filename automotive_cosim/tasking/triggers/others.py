"""Other vehicles on the road."""

from __future__ import annotations

from dataclasses import dataclass

from automotive_cosim.contracts import KMH_PER_MPS
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.tasking.triggers.base import WALKING_MPS


@dataclass(frozen=True, slots=True)
class HeadwayBelow:
    """Closer behind the leader than a number of seconds, while moving."""

    seconds: float

    def __call__(self, moment: Moment) -> bool:
        leader, speed_mps = moment.driving.around.leader, moment.driving.speed_mps
        return leader is not None and speed_mps > WALKING_MPS and leader.gap_m < self.seconds * speed_mps

    def __str__(self) -> str:
        return f"less than {self.seconds:g} s behind the car in front"


@dataclass(frozen=True, slots=True)
class CollisionWithin:
    """The leader would be hit within a number of seconds if both kept their speed."""

    seconds: float

    def __call__(self, moment: Moment) -> bool:
        leader = moment.driving.around.leader
        return (
            leader is not None
            and leader.time_to_collision_s is not None
            and leader.time_to_collision_s < self.seconds
        )

    def __str__(self) -> str:
        return f"{self.seconds:g} s from hitting the car in front"


@dataclass(frozen=True, slots=True)
class LeaderWithin:
    """A vehicle in front within a distance."""

    distance_m: float

    def __call__(self, moment: Moment) -> bool:
        leader = moment.driving.around.leader
        return leader is not None and leader.gap_m <= self.distance_m

    def __str__(self) -> str:
        return f"a car in front within {self.distance_m:g} m"


@dataclass(frozen=True, slots=True)
class SlowLeaderWithin:
    """A vehicle in front, slow or stationary, within a distance."""

    speed_kmh: float
    distance_m: float

    def __call__(self, moment: Moment) -> bool:
        leader = moment.driving.around.leader
        return (
            leader is not None
            and leader.gap_m <= self.distance_m
            and leader.speed_mps * KMH_PER_MPS <= self.speed_kmh
        )

    def __str__(self) -> str:
        return f"within {self.distance_m:g} m a vehicle in front at {self.speed_kmh:g} km/h or less"


@dataclass(frozen=True, slots=True)
class FollowerWithin:
    """A vehicle behind within a distance."""

    distance_m: float

    def __call__(self, moment: Moment) -> bool:
        follower = moment.driving.around.follower
        return follower is not None and follower.gap_m <= self.distance_m

    def __str__(self) -> str:
        return f"a car behind within {self.distance_m:g} m"


@dataclass(frozen=True, slots=True)
class OncomingWithin:
    """An oncoming vehicle within a distance."""

    distance_m: float

    def __call__(self, moment: Moment) -> bool:
        oncoming = moment.driving.around.oncoming
        return oncoming is not None and oncoming.gap_m <= self.distance_m

    def __str__(self) -> str:
        return f"an oncoming car within {self.distance_m:g} m"


@dataclass(frozen=True, slots=True)
class BlueLightWithin:
    """An emergency vehicle with its blue lights on, behind within a distance."""

    distance_m: float

    def __call__(self, moment: Moment) -> bool:
        behind = moment.driving.around.emergency_behind
        return behind is not None and behind.gap_m <= self.distance_m

    def __str__(self) -> str:
        return f"a blue light behind within {self.distance_m:g} m"


@dataclass(frozen=True, slots=True)
class JamWithin:
    """A jam on the route with its tail between two distances; 0 is in the jam."""

    to_m: float
    from_m: float = 0.0

    def __call__(self, moment: Moment) -> bool:
        away_m = moment.driving.ahead.jam_distance_m
        return away_m is not None and self.from_m <= away_m <= self.to_m

    def __str__(self) -> str:
        return f"a jam {self.from_m:g} to {self.to_m:g} m ahead"


@dataclass(frozen=True, slots=True)
class DelayAbove:
    """The route takes longer than at free flow, by a number of seconds."""

    seconds: float

    def __call__(self, moment: Moment) -> bool:
        return moment.driving.ahead.delay_s > self.seconds

    def __str__(self) -> str:
        return f"more than {self.seconds:g} s of delay on the route"


@dataclass(frozen=True, slots=True)
class OtherWayKnown:
    """The navigation knows another route that saves a number of seconds (if negative, costs no more than that)."""

    saves_s: float = 0.0

    def __call__(self, moment: Moment) -> bool:
        ahead = moment.driving.ahead
        return any(ahead.eta_s - way.eta_s > self.saves_s for way in ahead.alternatives)

    def __str__(self) -> str:
        return f"another route saves {self.saves_s:g} s"


@dataclass(frozen=True, slots=True)
class FlowBelow:
    """Traffic on the ego's road is slower than a share of its limit."""

    share: float

    def __call__(self, moment: Moment) -> bool:
        return moment.driving.around.relative_speed < self.share

    def __str__(self) -> str:
        return f"traffic at less than {self.share:.0%} of the limit"


@dataclass(frozen=True, slots=True)
class RedLight:
    """The next signal on the route shows red, within a distance."""

    within_m: float

    def __call__(self, moment: Moment) -> bool:
        light = moment.driving.ahead.next_light
        return light is not None and light.state in "rR" and light.distance_m <= self.within_m

    def __str__(self) -> str:
        return f"a red light within {self.within_m:g} m"
