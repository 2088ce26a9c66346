"""How the car moves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from automotive_cosim.cockpit.restrictions import Motion, motion
from automotive_cosim.cockpit.signals import MOTION, Signal
from automotive_cosim.contracts import KMH_PER_MPS
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.tasking.triggers.base import ANY, STANDING_MPS, WALKING_MPS


@dataclass(frozen=True, slots=True)
class SignalAbove:
    """A numeric signal is greater than ``value``, e.g. the fog on a window."""

    signal: Signal[float]
    value: float

    def __call__(self, moment: Moment) -> bool:
        return float(moment.signals[self.signal.path]) > self.value

    def __str__(self) -> str:
        return f"{self.signal.path} above {self.value:g}"


@dataclass(frozen=True, slots=True)
class SignalBelow:
    """A numeric signal is less than ``value``, e.g. the battery's level."""

    signal: Signal[float]
    value: float

    def __call__(self, moment: Moment) -> bool:
        return float(moment.signals[self.signal.path]) < self.value

    def __str__(self) -> str:
        return f"{self.signal.path} below {self.value:g}"


@dataclass(frozen=True, slots=True)
class SignalHas:
    """A signal has that value, e.g. a lamp that is on."""

    signal: Signal[Any]
    value: Any

    def __call__(self, moment: Moment) -> bool:
        return bool(moment.signals[self.signal.path] == self.value)

    def __str__(self) -> str:
        return f"{self.signal.path} is {'empty' if self.value == '' else self.value}"


@dataclass(frozen=True, slots=True)
class Driving:
    """The ego is driving, faster than walking pace."""

    def __call__(self, moment: Moment) -> bool:
        return moment.driving.speed_mps > WALKING_MPS

    def __str__(self) -> str:
        return "the car is driving"


@dataclass(frozen=True, slots=True)
class Parked:
    """The ego is in park."""

    def __call__(self, moment: Moment) -> bool:
        return (
            motion(moment.signals[MOTION.GEAR.path], moment.signals[MOTION.SPEED.path]) is Motion.PARKED
            and moment.driving.speed_mps < STANDING_MPS
        )

    def __str__(self) -> str:
        return "the car is parked"


@dataclass(frozen=True, slots=True)
class Standing:
    """The ego is stationary, in gear or not."""

    def __call__(self, moment: Moment) -> bool:
        return moment.driving.speed_mps < STANDING_MPS

    def __str__(self) -> str:
        return "the car is stationary"


@dataclass(frozen=True, slots=True)
class SpeedAbove:
    """Faster than a speed, on a road with a posted limit in a range (km/h, inclusive)."""

    speed_kmh: float
    limit_from_kmh: float
    limit_to_kmh: float

    def __call__(self, moment: Moment) -> bool:
        limit_mps = moment.driving.road.limit.posted_mps
        return (
            moment.driving.speed_mps * KMH_PER_MPS > self.speed_kmh
            and limit_mps is not None
            and self.limit_from_kmh <= round(limit_mps * KMH_PER_MPS, 1) <= self.limit_to_kmh
        )

    def __str__(self) -> str:
        limits = f"{self.limit_from_kmh:g}"
        if self.limit_to_kmh != self.limit_from_kmh:
            limits += f" to {self.limit_to_kmh:g}"
        return f"faster than {self.speed_kmh:g} km/h where {limits} km/h are posted"


@dataclass(frozen=True, slots=True)
class SpeedBetween:
    """Faster than one speed and not faster than another, whatever is posted."""

    from_kmh: float
    to_kmh: float = ANY

    def __call__(self, moment: Moment) -> bool:
        return self.from_kmh < moment.driving.speed_mps * KMH_PER_MPS <= self.to_kmh

    def __str__(self) -> str:
        if self.to_kmh == ANY:
            return f"faster than {self.from_kmh:g} km/h"
        return f"{max(self.from_kmh, 0):g} to {self.to_kmh:g} km/h"


@dataclass(frozen=True, slots=True)
class OverPosted:
    """Faster than the posted limit by a share of it."""

    share: float

    def __call__(self, moment: Moment) -> bool:
        limit_mps = moment.driving.road.limit.posted_mps
        return limit_mps is not None and moment.driving.speed_mps > (1 + self.share) * limit_mps

    def __str__(self) -> str:
        return f"{self.share:.0%} above the posted limit"
