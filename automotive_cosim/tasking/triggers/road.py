"""What road the car is on, and what comes next on it."""

from __future__ import annotations

from dataclasses import dataclass

from automotive_cosim.cockpit.signals import ENERGY
from automotive_cosim.cosim.moment import Moment


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
