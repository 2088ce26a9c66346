"""What advice to a driver is for, and how long that is there: a place on the route, or the weather.

On a drive, advice holds while its reason does, and a speed that is named for a place is driven from there on.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

from automotive_cosim.contracts import AlertKind
from automotive_cosim.traffic.road_weather import WORSE_THAN_WET

WEATHER_KINDS = frozenset({AlertKind.SLIPPERY, AlertKind.WEATHER, AlertKind.VISIBILITY})
LIMIT_KINDS = frozenset({AlertKind.SPEED, AlertKind.SCHOOL})
QUEUE_KINDS = frozenset({AlertKind.SPEED, AlertKind.TRAFFIC, AlertKind.COLLISION})
STANDING_KINDS = QUEUE_KINDS | {AlertKind.MOVE_OVER}
"""Alerts by what they may be about; a request without one may be about anything."""
WITHIN_M, WITHIN_S = 500.0, 60.0
"""Advice is about a place that is as near, or as soon reached; our choice."""
PASSED_M = 15.0
"""What is farther away than before by more than this is another one."""


@dataclass(frozen=True, slots=True)
class RoadView:
    """What a driver knows of the road; distances in metres, None without such a thing."""

    speed_mps: float
    limit_mps: float | None
    next_limit_mps: float | None
    to_limit_m: float | None
    to_standing_m: float | None
    to_jam_m: float | None
    friction: float
    sight_mps: float
    """Speed from which one can stop within the visibility."""

    @property
    def is_poor(self) -> bool:
        """Whether grip or sight ask for less speed."""
        return self.friction < WORSE_THAN_WET or self.sight_mps < max(self.speed_mps, self.limit_mps or 0.0)

    def is_near(self, away_m: float | None) -> bool:
        """Whether advice can be about a place so far away."""
        return away_m is not None and away_m <= max(WITHIN_M, WITHIN_S * self.speed_mps)


class AdviceReason(Protocol):
    """Why a driver keeps to advice."""

    to_place_m: float
    """How far its place is; 0 in it, and where it has none."""

    def lasts(self, view: RoadView) -> bool:
        """Whether it is still there; called at each look."""
        ...


@dataclass(slots=True)
class _PoorRoad:
    """Little grip, or little sight."""

    to_place_m: float = 0.0

    def lasts(self, view: RoadView) -> bool:
        return view.is_poor


@dataclass(slots=True)
class _LowerLimit:
    """A lower limit ahead, and then that limit."""

    limit_mps: float
    to_place_m: float

    def lasts(self, view: RoadView) -> bool:
        if view.limit_mps == self.limit_mps:
            self.to_place_m = 0.0
        elif self.to_place_m > 0.0 and view.next_limit_mps == self.limit_mps and view.to_limit_m is not None:
            self.to_place_m = view.to_limit_m
        else:
            return False
        return True


@dataclass(slots=True)
class _StandingAhead:
    """A breakdown or roadworks ahead, with the lower limit there."""

    limit_mps: float | None
    """The limit before it."""
    to_place_m: float

    def lasts(self, view: RoadView) -> bool:
        away_m = view.to_standing_m
        if self.to_place_m > 0.0 and away_m is not None and away_m <= self.to_place_m + PASSED_M:
            self.to_place_m = away_m
            return True
        self.to_place_m = 0.0
        return (view.limit_mps or math.inf) < (self.limit_mps or math.inf)


@dataclass(slots=True)
class _JamAhead:
    """A queue, from before its tail to its head."""

    to_place_m: float

    def lasts(self, view: RoadView) -> bool:
        self.to_place_m = view.to_jam_m or 0.0
        return view.is_near(view.to_jam_m)


def reason_for(kind: AlertKind | None, view: RoadView) -> AdviceReason | None:
    """What an alert of a kind, or a request for a speed, is for; None if it is for this road as it is."""
    if kind in WEATHER_KINDS:
        return _PoorRoad() if view.is_poor else None
    found: list[AdviceReason] = []
    if view.to_limit_m is not None and (kind is None or kind in LIMIT_KINDS):
        lower_mps = view.next_limit_mps
        if lower_mps is not None and lower_mps < (view.limit_mps or math.inf):
            found.append(_LowerLimit(lower_mps, view.to_limit_m))
    if view.to_standing_m is not None and (kind is None or kind in STANDING_KINDS):
        found.append(_StandingAhead(view.limit_mps, view.to_standing_m))
    if view.to_jam_m is not None and (kind is None or kind in QUEUE_KINDS):
        found.append(_JamAhead(view.to_jam_m))
    near = [reason for reason in found if view.is_near(reason.to_place_m)]
    if near:
        return min(near, key=lambda reason: reason.to_place_m)
    about_road = kind is None or kind is AlertKind.SPEED
    return _PoorRoad() if about_road and view.is_poor else None
