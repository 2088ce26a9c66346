"""Kinds of events, grouped by subject.

base     what a kind of event is, a sighting, an act
tracker  folds a drive's moments into events
law      what law and measurement say at one moment
speed, light, weather, road, car, people, border, errands
"""

from __future__ import annotations

from collections.abc import Mapping

from automotive_cosim.drives.events import border, car, errands, light, people, road, speed, weather
from automotive_cosim.drives.events.base import DriveAct, EventKind, Sighting
from automotive_cosim.drives.events.tracker import DriveEvent, Tracker

KINDS: Mapping[str, EventKind] = {
    kind.name: kind
    for kind in (
        speed.OverLimit(),
        speed.LimitFalls(),
        speed.SchoolHours(),
        speed.WeatherSpeed(),
        light.LampsMissing(),
        light.HighBeam(),
        light.FogLamps(),
        weather.GlassFogs(),
        weather.Wipers(),
        weather.Slippery(),
        road.TunnelAhead(),
        road.JamTail(),
        road.RearEnd(),
        road.BreakdownAhead(),
        road.RoadworksAhead(),
        road.BlueLight(),
        road.Corridor(),
        road.LeaderClose(),
        road.LeaderBrakes(),
        road.TractorAhead(),
        car.Belt(),
        car.FlapOpen(),
        car.Tyre(),
        car.RangeShort(),
        people.Fatigue(),
        people.PhoneUse(),
        people.LeftBehind(),
        border.LimitUnits(),
        border.RuleChange(),
        *errands.ERRANDS,
    )
}
"""Every kind by its name."""

__all__ = ["KINDS", "DriveAct", "DriveEvent", "EventKind", "Sighting", "Tracker"]
