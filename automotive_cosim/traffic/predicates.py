"""Questions about the driving state that an advance can wait for (``base.Until``).

They are frozen dataclasses, so that they can be sent to the simulation's process and are evaluated there, on every
step of the traffic.
"""

from __future__ import annotations

from dataclasses import dataclass

from automotive_cosim.contracts import KMH_PER_MPS, DrivingState
from automotive_cosim.traffic.base import Predicate


@dataclass(frozen=True, slots=True)
class OverLimit:
    """Faster than ``ratio`` times the posted limit; never where there is none."""

    ratio: float = 1.0

    def __call__(self, state: DrivingState) -> bool:
        """Compares speed and limit."""
        limit_mps = state.road.posted_limit_mps
        return limit_mps is not None and state.speed_mps > self.ratio * limit_mps


@dataclass(frozen=True, slots=True)
class SpeedAbove:
    """Faster than that."""

    speed_kmh: float

    def __call__(self, state: DrivingState) -> bool:
        """Compares the speed."""
        return state.speed_mps * KMH_PER_MPS > self.speed_kmh


@dataclass(frozen=True, slots=True)
class InTunnel:
    """In a tunnel."""

    def __call__(self, state: DrivingState) -> bool:
        """Looks at the road."""
        return state.road.in_tunnel


@dataclass(frozen=True, slots=True)
class InSchoolZone:
    """In a school zone: one whose limit is in force by the clock of the place, or one whose hours are over."""

    in_force: bool = True

    def __call__(self, state: DrivingState) -> bool:
        """Looks at the road and its signs; where no hours are posted the limit is always in force."""
        road = state.road
        return road.school_zone and (road.limit_by_clock or not road.limit_hours) == self.in_force


@dataclass(frozen=True, slots=True)
class JamWithin:
    """A jam on the route, no farther than that; also when the car is in it."""

    distance_m: float

    def __call__(self, state: DrivingState) -> bool:
        """Looks at the route."""
        return state.ahead.jam_distance_m is not None and state.ahead.jam_distance_m <= self.distance_m


@dataclass(frozen=True, slots=True)
class HeadwayUnder:
    """Closer behind the leader than that many seconds at the speed driven, while moving."""

    headway_s: float

    def __call__(self, state: DrivingState) -> bool:
        """Divides gap by speed."""
        leader = state.around.leader
        return leader is not None and state.speed_mps > 1.0 and leader.gap_m < self.headway_s * state.speed_mps


@dataclass(frozen=True, slots=True)
class TimeToCollisionUnder:
    """The leader would be hit within that many seconds if both kept their speed."""

    time_s: float

    def __call__(self, state: DrivingState) -> bool:
        """Looks at the leader."""
        leader = state.around.leader
        return (
            leader is not None
            and leader.time_to_collision_s is not None
            and leader.time_to_collision_s < self.time_s
        )


@dataclass(frozen=True, slots=True)
class OnRoad:
    """On the street of that name."""

    name: str

    def __call__(self, state: DrivingState) -> bool:
        """Compares the name."""
        return state.road.name == self.name


@dataclass(frozen=True, slots=True)
class Driven:
    """At least that far from where the drive began."""

    distance_m: float

    def __call__(self, state: DrivingState) -> bool:
        """Compares the distance."""
        return state.distance_m >= self.distance_m


@dataclass(frozen=True, slots=True)
class Standing:
    """Standing for at least that long."""

    time_s: float = 0.0

    def __call__(self, state: DrivingState) -> bool:
        """Compares the time."""
        return state.speed_mps < 0.1 and state.standing_s >= self.time_s


@dataclass(frozen=True, slots=True)
class AllOf:
    """All of them hold."""

    predicates: tuple[Predicate, ...]

    def __call__(self, state: DrivingState) -> bool:
        """Asks each."""
        return all(predicate(state) for predicate in self.predicates)


@dataclass(frozen=True, slots=True)
class Not:
    """It does not hold."""

    predicate: Predicate

    def __call__(self, state: DrivingState) -> bool:
        """Asks it."""
        return not self.predicate(state)
