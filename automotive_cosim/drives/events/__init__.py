"""Kinds of events, grouped by subject.

base     what a kind of event is, a sighting, an act
tracker  folds a drive's moments into events
law      what law and measurement say at one moment
speed, light, weather, road, car
"""

from __future__ import annotations

from collections.abc import Mapping

from automotive_cosim.drives.events import car, light, people, road, speed, weather
from automotive_cosim.drives.events.base import Act, EventKind, Sighting
from automotive_cosim.drives.events.tracker import Event, Tracker

KINDS: Mapping[str, EventKind] = {
    kind.name: kind
    for kind in (
        speed.OverLimit(),
        speed.LimitFalls(),
        speed.SchoolZone(),
        speed.WeatherSpeed(),
        light.Lamps(),
        light.HighBeam(),
        light.FogLamps(),
        weather.GlassFogs(),
        weather.Wipers(),
        weather.Slippery(),
        road.Tunnel(),
        road.JamTail(),
        road.Breakdown(),
        road.Roadworks(),
        road.BlueLight(),
        road.LeaderClose(),
        road.LeaderBrakes(),
        road.Tractor(),
        car.Belt(),
        car.FlapOpen(),
        car.Tyre(),
        car.RangeShort(),
        people.Fatigue(),
    )
}
"""Every kind by its name."""

__all__ = ["KINDS", "Act", "Event", "EventKind", "Sighting", "Tracker"]
