"""The road that the car is on, and what comes next on it."""

from __future__ import annotations

from dataclasses import dataclass

from automotive_cosim.cockpit.signals import ENERGY
from automotive_cosim.cosim.moment import Moment


@dataclass(frozen=True, slots=True)
class Unposted:
    """No limit is posted here."""

    def __call__(self, moment: Moment) -> bool:
        return moment.context.posted_limit_kmh is None

    def __str__(self) -> str:
        return "no limit is posted"


@dataclass(frozen=True, slots=True)
class OnRoadClass:
    """On a road of one of these classes (OSM highway values)."""

    classes: tuple[str, ...]

    def __call__(self, moment: Moment) -> bool:
        return moment.driving.road.road_class in self.classes

    def __str__(self) -> str:
        return f"on a {' or '.join(self.classes)} road"


@dataclass(frozen=True, slots=True)
class OnStreet:
    """On the street with this name."""

    name: str

    def __call__(self, moment: Moment) -> bool:
        return moment.driving.road.name == self.name

    def __str__(self) -> str:
        return f"on {self.name}"


@dataclass(frozen=True, slots=True)
class Lit:
    """The road is lit, or unlit, according to the map."""

    lit: bool = True

    def __call__(self, moment: Moment) -> bool:
        return moment.driving.road.lit is self.lit

    def __str__(self) -> str:
        return "on a lit road" if self.lit else "on an unlit road"


@dataclass(frozen=True, slots=True)
class BuiltUp:
    """In a built-up area, or outside."""

    built_up: bool = True

    def __call__(self, moment: Moment) -> bool:
        return moment.context.built_up is self.built_up

    def __str__(self) -> str:
        return "in a built-up area" if self.built_up else "outside built-up areas"


@dataclass(frozen=True, slots=True)
class CentreLine:
    """The road has a centre line, or has none."""

    there: bool

    def __call__(self, moment: Moment) -> bool:
        return moment.driving.road.centre_line is self.there

    def __str__(self) -> str:
        return f"on a road {'with' if self.there else 'without'} a centre line"


@dataclass(frozen=True, slots=True)
class Lanes:
    """At least a number of lanes in the ego's direction."""

    count: int

    def __call__(self, moment: Moment) -> bool:
        return moment.driving.road.lane_count >= self.count

    def __str__(self) -> str:
        return f"{self.count} lanes or more"


@dataclass(frozen=True, slots=True)
class InTunnel:
    """In a tunnel."""

    def __call__(self, moment: Moment) -> bool:
        return moment.driving.road.in_tunnel

    def __str__(self) -> str:
        return "in a tunnel"


@dataclass(frozen=True, slots=True)
class InSchoolZone:
    """In a school zone whose limit is in force at the local time, or outside its hours."""

    in_force: bool = True

    def __call__(self, moment: Moment) -> bool:
        """Whether the school zone is, or is not, in force; without posted hours it always is."""
        road = moment.driving.road
        return road.school_zone and (road.limit_by_clock or not road.limit_hours) == self.in_force

    def __str__(self) -> str:
        return f"in a school zone {'in' if self.in_force else 'outside'} its hours"


@dataclass(frozen=True, slots=True)
class TunnelWithin:
    """The route enters a tunnel within a number of seconds at the present speed."""

    seconds: float

    def __call__(self, moment: Moment) -> bool:
        away_m, speed_mps = moment.driving.ahead.tunnel_distance_m, moment.driving.speed_mps
        return (
            away_m is not None
            and not moment.driving.road.in_tunnel
            and 0 < away_m <= self.seconds * max(speed_mps, 1)
        )

    def __str__(self) -> str:
        return f"{self.seconds:g} s before a tunnel"


@dataclass(frozen=True, slots=True)
class TunnelOnRoute:
    """A tunnel lies on the rest of the route, however far."""

    def __call__(self, moment: Moment) -> bool:
        return moment.driving.road.in_tunnel or moment.driving.ahead.tunnel_distance_m is not None

    def __str__(self) -> str:
        return "a tunnel on the route"


@dataclass(frozen=True, slots=True)
class LowerLimitWithin:
    """A lower limit is posted within that distance on the route."""

    distance_m: float

    def __call__(self, moment: Moment) -> bool:
        """Whether the next limit is posted, lower and near enough."""
        here, ahead = moment.driving.road.limit, moment.driving.ahead
        following_mps = None if ahead.next_limit is None else ahead.next_limit.posted_mps
        return (
            following_mps is not None
            and ahead.next_limit_distance_m is not None
            and ahead.next_limit_distance_m <= self.distance_m
            and (here.mps is None or following_mps < here.mps)
        )

    def __str__(self) -> str:
        return f"a lower limit posted within {self.distance_m:g} m"


@dataclass(frozen=True, slots=True)
class GoalWithin:
    """No more than a distance is left of the route."""

    distance_m: float

    def __call__(self, moment: Moment) -> bool:
        return moment.driving.ahead.route_left_m <= self.distance_m

    def __str__(self) -> str:
        return f"within {self.distance_m:g} m of the goal"


@dataclass(frozen=True, slots=True)
class OutOfRange:
    """The battery does not last to the destination."""

    def __call__(self, moment: Moment) -> bool:
        return float(moment.signals[ENERGY.RANGE.path]) < moment.driving.ahead.route_left_m

    def __str__(self) -> str:
        return "the remaining route is longer than the range"


@dataclass(frozen=True, slots=True)
class LessGripThan:
    """The lane's friction coefficient is below a value; 1 is dry."""

    friction: float

    def __call__(self, moment: Moment) -> bool:
        return moment.driving.road.friction < self.friction

    def __str__(self) -> str:
        return f"grip below {self.friction:g}"
