"""Triggers: which situation on the road a task starts from. Pure questions about one moment, no effects.

Each condition is a frozen dataclass, so that it can be compared and stored; ``str`` says it in words. What a
condition cannot know (no leader, no limit, no place) does not hold.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

from automotive_cosim.cockpit.restrictions import Motion, motion
from automotive_cosim.cockpit.signals import ENERGY, MOTION, Signal
from automotive_cosim.contracts import KMH_PER_MPS
from automotive_cosim.cosim import Moment

WALKING_MPS = 2.0
STANDING_MPS = 0.1
ANY = 1e9
"""Farther, faster and more than anything."""


class Condition(Protocol):
    """A question about one moment."""

    def __call__(self, moment: Moment) -> bool:
        """True while it holds."""
        ...


@dataclass(frozen=True, slots=True)
class Trigger:
    """The situation a task starts from: ``condition`` has held for ``for_s`` without a break."""

    condition: Condition
    for_s: float
    within_s: float
    """Simulated seconds from departure after which the trigger counts as not reached."""


# --- together ---------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class All:
    """Every one of them holds."""

    conditions: tuple[Condition, ...]

    def __call__(self, moment: Moment) -> bool:
        """Asks each."""
        return all(condition(moment) for condition in self.conditions)

    def __str__(self) -> str:
        return ", ".join(map(str, self.conditions))


@dataclass(frozen=True, slots=True)
class Not:
    """It does not hold."""

    condition: Condition

    def __call__(self, moment: Moment) -> bool:
        """Asks it."""
        return not self.condition(moment)

    def __str__(self) -> str:
        return f"not: {self.condition}"


# --- motion -----------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Driving:
    """The ego is on its way, faster than walking pace."""

    def __call__(self, moment: Moment) -> bool:
        """Above 2 m/s."""
        return moment.driving.speed_mps > WALKING_MPS

    def __str__(self) -> str:
        return "the car is on its way"


@dataclass(frozen=True, slots=True)
class Parked:
    """The ego stands in park."""

    def __call__(self, moment: Moment) -> bool:
        """Looks at the gear."""
        return (
            motion(moment.signals[MOTION.GEAR.path], moment.signals[MOTION.SPEED.path]) is Motion.PARKED
            and moment.driving.speed_mps < STANDING_MPS
        )

    def __str__(self) -> str:
        return "the car is parked"


@dataclass(frozen=True, slots=True)
class Standing:
    """The ego stands, in gear or not."""

    def __call__(self, moment: Moment) -> bool:
        """Below 0.1 m/s."""
        return moment.driving.speed_mps < STANDING_MPS

    def __str__(self) -> str:
        return "the car stands"


@dataclass(frozen=True, slots=True)
class SpeedAbove:
    """Faster than that, on a road with a posted limit between the two given (km/h, inclusive)."""

    speed_kmh: float
    limit_from_kmh: float
    limit_to_kmh: float

    def __call__(self, moment: Moment) -> bool:
        """Compares speed and limit."""
        limit_mps = moment.driving.road.posted_limit_mps
        return (
            moment.driving.speed_mps * KMH_PER_MPS > self.speed_kmh
            and limit_mps is not None
            and self.limit_from_kmh <= round(limit_mps * KMH_PER_MPS, 1) <= self.limit_to_kmh
        )

    def __str__(self) -> str:
        limits = f"{self.limit_from_kmh:g} to {self.limit_to_kmh:g}"
        return f"faster than {self.speed_kmh:g} km/h where {limits} km/h are posted"


@dataclass(frozen=True, slots=True)
class SpeedBetween:
    """Faster than the one and no faster than the other, whatever is posted."""

    from_kmh: float
    to_kmh: float = ANY

    def __call__(self, moment: Moment) -> bool:
        """Compares the speed."""
        return self.from_kmh < moment.driving.speed_mps * KMH_PER_MPS <= self.to_kmh

    def __str__(self) -> str:
        return f"faster than {self.from_kmh:g}" + (
            " km/h" if self.to_kmh == ANY else f", up to {self.to_kmh:g} km/h"
        )


@dataclass(frozen=True, slots=True)
class OverPosted:
    """Faster than the posted limit by so much of it."""

    share: float

    def __call__(self, moment: Moment) -> bool:
        """Compares speed and limit."""
        limit_mps = moment.driving.road.posted_limit_mps
        return limit_mps is not None and moment.driving.speed_mps > (1 + self.share) * limit_mps

    def __str__(self) -> str:
        return f"{self.share:.0%} above the posted limit"


# --- the road ---------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Unposted:
    """No limit is posted here."""

    def __call__(self, moment: Moment) -> bool:
        """Looks at the context, which knows what signs say."""
        return moment.context.posted_limit_kmh is None

    def __str__(self) -> str:
        return "no limit is posted"


@dataclass(frozen=True, slots=True)
class OnRoadClass:
    """On a road of one of these classes (OSM highway values)."""

    classes: tuple[str, ...]

    def __call__(self, moment: Moment) -> bool:
        """Compares the class."""
        return moment.driving.road.road_class in self.classes

    def __str__(self) -> str:
        return f"on a {' or '.join(self.classes)} road"


@dataclass(frozen=True, slots=True)
class OnStreet:
    """On the street of that name."""

    name: str

    def __call__(self, moment: Moment) -> bool:
        """Compares the name."""
        return moment.driving.road.name == self.name

    def __str__(self) -> str:
        return f"on {self.name}"


@dataclass(frozen=True, slots=True)
class Lit:
    """The map says whether the road is lit, and so it is."""

    lit: bool = True

    def __call__(self, moment: Moment) -> bool:
        """Looks at the road."""
        return moment.driving.road.lit is self.lit

    def __str__(self) -> str:
        return "on a lit road" if self.lit else "on an unlit road"


@dataclass(frozen=True, slots=True)
class BuiltUp:
    """In a built-up area, or outside."""

    built_up: bool = True

    def __call__(self, moment: Moment) -> bool:
        """As the context has it."""
        return moment.context.built_up is self.built_up

    def __str__(self) -> str:
        return "in a built-up area" if self.built_up else "outside built-up areas"


@dataclass(frozen=True, slots=True)
class CentreLine:
    """The road has a centre line, or none."""

    there: bool

    def __call__(self, moment: Moment) -> bool:
        """Looks at the road."""
        return moment.driving.road.centre_line is self.there

    def __str__(self) -> str:
        return f"on a road {'with' if self.there else 'without'} centre line"


@dataclass(frozen=True, slots=True)
class Lanes:
    """At least so many lanes in the ego's direction."""

    count: int

    def __call__(self, moment: Moment) -> bool:
        """Counts them."""
        return moment.driving.road.lane_count >= self.count

    def __str__(self) -> str:
        return f"{self.count} lanes or more"


@dataclass(frozen=True, slots=True)
class InTunnel:
    """In a tunnel."""

    def __call__(self, moment: Moment) -> bool:
        """Looks at the road."""
        return moment.driving.road.in_tunnel

    def __str__(self) -> str:
        return "in a tunnel"


@dataclass(frozen=True, slots=True)
class InSchoolZone:
    """In a school zone: one whose limit is in force by the clock of the place, or one whose hours are over."""

    in_force: bool = True

    def __call__(self, moment: Moment) -> bool:
        """Looks at the road and its signs; where no hours are posted the limit is always in force."""
        road = moment.driving.road
        return road.school_zone and (road.limit_by_clock or not road.limit_hours) == self.in_force

    def __str__(self) -> str:
        return f"in a school zone {'in' if self.in_force else 'outside'} its hours"


@dataclass(frozen=True, slots=True)
class TunnelWithin:
    """The route enters a tunnel within so many seconds at the speed driven."""

    seconds: float

    def __call__(self, moment: Moment) -> bool:
        """Divides distance by speed."""
        away_m, speed_mps = moment.driving.ahead.tunnel_distance_m, moment.driving.speed_mps
        return (
            away_m is not None
            and not moment.driving.road.in_tunnel
            and 0 < away_m <= self.seconds * max(speed_mps, 1)
        )

    def __str__(self) -> str:
        return f"{self.seconds:g} s before a tunnel"


@dataclass(frozen=True, slots=True)
class LowerLimitWithin:
    """A lower limit is posted within that distance on the route."""

    distance_m: float

    def __call__(self, moment: Moment) -> bool:
        """Compares this limit with the next."""
        here, ahead = moment.driving.road.posted_limit_mps, moment.driving.ahead
        return (
            ahead.next_limit_mps is not None
            and ahead.next_limit_distance_m is not None
            and ahead.next_limit_distance_m <= self.distance_m
            and (here is None or ahead.next_limit_mps < here)
        )

    def __str__(self) -> str:
        return f"a lower limit within {self.distance_m:g} m"


@dataclass(frozen=True, slots=True)
class GoalWithin:
    """No more than that is left of the route, or at least that."""

    distance_m: float

    def __call__(self, moment: Moment) -> bool:
        """Compares the distance left."""
        return moment.driving.ahead.route_left_m <= self.distance_m

    def __str__(self) -> str:
        return f"within {self.distance_m:g} m of the goal"


@dataclass(frozen=True, slots=True)
class OutOfRange:
    """The battery does not reach to the goal."""

    def __call__(self, moment: Moment) -> bool:
        """Compares the range with the distance left."""
        return float(moment.signals[ENERGY.RANGE.path]) < moment.driving.ahead.route_left_m

    def __str__(self) -> str:
        return "the way left is longer than the range"


@dataclass(frozen=True, slots=True)
class LessGripThan:
    """The lane's friction coefficient is below that; 1 is dry."""

    friction: float

    def __call__(self, moment: Moment) -> bool:
        """Looks at the road."""
        return moment.driving.road.friction < self.friction

    def __str__(self) -> str:
        return f"grip below {self.friction:g}"


# --- the others -------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class HeadwayBelow:
    """Closer behind the leader than that many seconds, while moving."""

    seconds: float

    def __call__(self, moment: Moment) -> bool:
        """Divides gap by speed."""
        leader, speed_mps = moment.driving.around.leader, moment.driving.speed_mps
        return leader is not None and speed_mps > WALKING_MPS and leader.gap_m < self.seconds * speed_mps

    def __str__(self) -> str:
        return f"less than {self.seconds:g} s behind the car in front"


@dataclass(frozen=True, slots=True)
class CollisionWithin:
    """The leader would be hit within that many seconds if both kept their speed."""

    seconds: float

    def __call__(self, moment: Moment) -> bool:
        """Looks at the leader."""
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
    """A vehicle in front, no farther than that."""

    distance_m: float

    def __call__(self, moment: Moment) -> bool:
        """Looks at the leader."""
        leader = moment.driving.around.leader
        return leader is not None and leader.gap_m <= self.distance_m

    def __str__(self) -> str:
        return f"a car in front within {self.distance_m:g} m"


@dataclass(frozen=True, slots=True)
class SlowLeaderWithin:
    """A vehicle in front that is slower than that, no farther than that; one that stands is slow too."""

    speed_kmh: float
    distance_m: float

    def __call__(self, moment: Moment) -> bool:
        """Looks at the leader."""
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
    """A vehicle behind, no farther than that."""

    distance_m: float

    def __call__(self, moment: Moment) -> bool:
        """Looks at the follower."""
        follower = moment.driving.around.follower
        return follower is not None and follower.gap_m <= self.distance_m

    def __str__(self) -> str:
        return f"a car behind within {self.distance_m:g} m"


@dataclass(frozen=True, slots=True)
class OncomingWithin:
    """An oncoming vehicle, no farther than that."""

    distance_m: float

    def __call__(self, moment: Moment) -> bool:
        """Looks at the other direction."""
        oncoming = moment.driving.around.oncoming
        return oncoming is not None and oncoming.gap_m <= self.distance_m

    def __str__(self) -> str:
        return f"an oncoming car within {self.distance_m:g} m"


@dataclass(frozen=True, slots=True)
class BlueLightWithin:
    """An emergency vehicle with its blue light on behind, no farther than that."""

    distance_m: float

    def __call__(self, moment: Moment) -> bool:
        """Looks behind."""
        behind = moment.driving.around.emergency_behind
        return behind is not None and behind.gap_m <= self.distance_m

    def __str__(self) -> str:
        return f"a blue light behind within {self.distance_m:g} m"


@dataclass(frozen=True, slots=True)
class JamWithin:
    """A jam on the route, its tail between the two distances; 0 is in it."""

    to_m: float
    from_m: float = 0.0

    def __call__(self, moment: Moment) -> bool:
        """Looks at the route."""
        away_m = moment.driving.ahead.jam_distance_m
        return away_m is not None and self.from_m <= away_m <= self.to_m

    def __str__(self) -> str:
        return f"a jam {self.from_m:g} to {self.to_m:g} m ahead"


@dataclass(frozen=True, slots=True)
class DelayAbove:
    """The route takes longer than by free flow, by so many seconds."""

    seconds: float

    def __call__(self, moment: Moment) -> bool:
        """Looks at the route."""
        return moment.driving.ahead.delay_s > self.seconds

    def __str__(self) -> str:
        return f"more than {self.seconds:g} s of delay on the route"


@dataclass(frozen=True, slots=True)
class OtherWayKnown:
    """The navigation knows another way that saves so many seconds (negative: costs no more than that)."""

    saves_s: float = 0.0

    def __call__(self, moment: Moment) -> bool:
        """Compares the times."""
        ahead = moment.driving.ahead
        return any(ahead.eta_s - way.eta_s > self.saves_s for way in ahead.alternatives)

    def __str__(self) -> str:
        return f"another way saves {self.saves_s:g} s"


@dataclass(frozen=True, slots=True)
class FlowBelow:
    """The ego's road is driven at less than that share of its limit."""

    share: float

    def __call__(self, moment: Moment) -> bool:
        """Looks at the ego's edge."""
        return moment.driving.around.relative_speed < self.share

    def __str__(self) -> str:
        return f"traffic at less than {self.share:.0%} of the limit"


@dataclass(frozen=True, slots=True)
class RedLight:
    """The next signal on the route shows red, no farther than that."""

    within_m: float

    def __call__(self, moment: Moment) -> bool:
        """Looks at the signal."""
        light = moment.driving.ahead.next_light
        return light is not None and light.state in "rR" and light.distance_m <= self.within_m

    def __str__(self) -> str:
        return f"a red light within {self.within_m:g} m"


# --- sky and place ----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class VisibilityBetween:
    """Visibility in metres from the one to below the other."""

    from_m: float
    to_m: float

    def __call__(self, moment: Moment) -> bool:
        """Looks at the weather."""
        return self.from_m <= moment.weather.visibility < self.to_m

    def __str__(self) -> str:
        return f"visibility {self.from_m:g} to {self.to_m:g} m"


@dataclass(frozen=True, slots=True)
class RainBetween:
    """Precipitation in mm/h from the one to below the other."""

    from_mm_h: float
    to_mm_h: float = ANY

    def __call__(self, moment: Moment) -> bool:
        """Looks at the weather."""
        return self.from_mm_h <= moment.weather.precipitation < self.to_mm_h

    def __str__(self) -> str:
        to = "more" if self.to_mm_h == ANY else f"{self.to_mm_h:g}"
        return f"{self.from_mm_h:g} to {to} mm/h of rain or snow"


@dataclass(frozen=True, slots=True)
class AirBetween:
    """Air temperature outside in degrees Celsius from the one to below the other."""

    from_c: float
    to_c: float

    def __call__(self, moment: Moment) -> bool:
        """Looks at the weather."""
        return self.from_c <= moment.weather.temperature_2m < self.to_c

    def __str__(self) -> str:
        return f"{self.from_c:g} to {self.to_c:g} degrees outside"


@dataclass(frozen=True, slots=True)
class Dark:
    """Between sunset and sunrise, or not."""

    dark: bool = True

    def __call__(self, moment: Moment) -> bool:
        """Looks at the sun."""
        return moment.context.sun is not None and moment.context.sun.is_set is self.dark

    def __str__(self) -> str:
        return "in the dark" if self.dark else "by day"


@dataclass(frozen=True, slots=True)
class InCountry:
    """On the soil of that country (ISO 3166-1 code)."""

    code: str

    def __call__(self, moment: Moment) -> bool:
        """As the context has it."""
        return moment.context.country == self.code

    def __str__(self) -> str:
        return f"in {self.code}"


@dataclass(frozen=True, slots=True)
class GpsLost:
    """The receiver has no fix."""

    def __call__(self, moment: Moment) -> bool:
        """Looks at the receiver."""
        return moment.gps is not None and not moment.gps.has_fix

    def __str__(self) -> str:
        return "no GPS"


@dataclass(frozen=True, slots=True)
class Offline:
    """The car has no link to the outside."""

    def __call__(self, moment: Moment) -> bool:
        """Looks at the modem."""
        return not moment.connectivity.online

    def __str__(self) -> str:
        return "no connection"


# --- the car ----------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class SignalAbove:
    """A numeric signal is greater than ``value``, e.g. the fog on a window."""

    signal: Signal[float]
    value: float

    def __call__(self, moment: Moment) -> bool:
        """Compares the value."""
        return float(moment.signals[self.signal.path]) > self.value

    def __str__(self) -> str:
        return f"{self.signal.path} above {self.value:g}"


@dataclass(frozen=True, slots=True)
class SignalBelow:
    """A numeric signal is less than ``value``, e.g. the battery's level."""

    signal: Signal[float]
    value: float

    def __call__(self, moment: Moment) -> bool:
        """Compares the value."""
        return float(moment.signals[self.signal.path]) < self.value

    def __str__(self) -> str:
        return f"{self.signal.path} below {self.value:g}"


@dataclass(frozen=True, slots=True)
class SignalHas:
    """A signal has that value, e.g. a lamp that is on."""

    signal: Signal[Any]
    value: Any

    def __call__(self, moment: Moment) -> bool:
        """Compares the value."""
        return bool(moment.signals[self.signal.path] == self.value)

    def __str__(self) -> str:
        return f"{self.signal.path} is {self.value}"
