"""The whole state at one instant."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from typing import Any

from automotive_cosim.contracts import Connectivity, DrivingState, GpsFix, Sight, SightKind, Surroundings, Weather
from automotive_cosim.contracts.errand import Errand
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.sun import elevation_deg
from automotive_cosim.traffic.base import Event


@dataclass(frozen=True, slots=True)
class Moment:
    """The whole state at one instant, as judges see it; an agent sees an ``Observation`` made from it."""

    time_s: float
    """SUMO simulation time."""
    local_time: datetime
    driving: DrivingState
    passed: tuple[DrivingState, ...]
    """Every SUMO step since the previous moment; the last one is ``driving``."""
    events: tuple[Event, ...]
    """Events on the road since the previous moment."""
    weather: Weather
    gps: GpsFix | None
    connectivity: Connectivity
    context: GeoContext
    signals: Mapping[str, Any]
    """Every VSS path and its value."""
    commands: Mapping[str, Any]
    """Everything that can be commanded: actuator signals, app data, sent messages and requests."""
    sights: tuple[Sight, ...] = ()
    """What the car notices and shows by itself; empty if it has no such equipment."""
    awareness: float | None = None
    """How much of the driver's attention was on the road since the previous moment, 0.1 to 1; None if nothing can
    take it."""
    asked: tuple[Errand, ...] = ()
    """What people aboard have asked for so far; times are simulation times."""

    def sight(self, kind: SightKind) -> Sight | None:
        """What the car notices of a kind, as its screens show it; None if nothing."""
        for sight in self.sights:  # a generator would take twice as long, and a drive asks often
            if sight.kind is kind:
                return sight
        return None

    def earlier(self, by: timedelta) -> Moment:
        """The same at an earlier time of day; what the car has sensed is not changed."""
        clock = (self.local_time.astimezone(UTC) - by).astimezone(self.local_time.tzinfo)
        return replace(self, local_time=clock, context=replace(self.context, local_time=clock))

    @property
    def surroundings(self) -> Surroundings:
        """Everything outside the cockpit."""
        return around(
            self.driving,
            self.weather,
            self.local_time,
            self.gps,
            self.connectivity,
            sign_unit=self.context.speed_unit,
            sign_country=self.context.country,
        )


def around(
    driving: DrivingState,
    weather: Weather,
    local_time: datetime,
    gps: GpsFix | None,
    connectivity: Connectivity,
    *,
    parked: bool = False,
    sign_unit: str = "km/h",
    sign_country: str = "",
) -> Surroundings:
    """Everything outside the cockpit, with the sun where it stands then and there."""
    sun_deg = (
        None
        if driving.lat_deg is None or driving.lon_deg is None
        else elevation_deg(driving.lat_deg, driving.lon_deg, local_time)
    )
    return Surroundings(driving, weather, local_time, sun_deg, gps, connectivity, parked, sign_unit, sign_country)
