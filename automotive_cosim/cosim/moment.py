"""The whole state at one instant."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from automotive_cosim.contracts import Connectivity, DrivingState, GpsFix, Weather
from automotive_cosim.geo.context import GeoContext
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
