"""A scenario at another place on earth: the same metres, that place's law, clock and climate."""

from __future__ import annotations

from dataclasses import replace
from zoneinfo import ZoneInfo

from automotive_cosim.geo.place import Atlas, Place
from automotive_cosim.scenarios import Scenario
from automotive_cosim.traffic.network import drives_on_left
from automotive_cosim.traffic.options import read_configuration


def relocated(scenario: Scenario, origin: tuple[float, float]) -> Scenario:
    """The scenario with the middle of its network at ``origin`` (longitude, latitude, degrees).

    The local time stays the same, in the zone of that place. The weather is drawn from its climate. Roads and the
    driving side stay the network's, signs show the country's round figures (``geo.signs``), and streets have names
    that do not tell where they really lie (``traffic.naming``); ``notes`` say so if the country drives on the other
    side.

    Raises:
        UserError: ``origin`` is not a position on earth.
        ScenarioError: the network cannot be read.
    """
    place = Atlas().place(*origin)
    side = "left" if drives_on_left(read_configuration(scenario.config).net) else "right"
    notes = [*scenario.notes]
    if place.law is None:
        where = place.country_name or "the sea"
        notes.append(f"no traffic law is known at {origin[0]:g},{origin[1]:g} ({where})")
    elif place.law.driving_side not in ("", side):
        notes.append(
            f"traffic keeps {side} in this network, but {place.law.driving_side} in {place.country_name}; "
            "only the law moves, not the lanes"
        )
    return replace(
        scenario,
        origin=origin,
        has_place=True,
        country=place.country,
        start=scenario.start.replace(tzinfo=zone_of(place)),
        weather=(),
        notes=tuple(notes),
    )


def zone_of(place: Place) -> ZoneInfo:
    """The time zone of a place, UTC if unknown."""
    return ZoneInfo(place.time_zone or "UTC")
