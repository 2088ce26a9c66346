"""A scenario at another place on earth: the same metres, that place's law, clock and climate."""

from __future__ import annotations

from dataclasses import replace
from zoneinfo import ZoneInfo

from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.geo.place import Place, shipped
from automotive_cosim.traffic.network import drives_on_left
from automotive_cosim.traffic.options import read_configuration

SPOKEN = {
    "ar": "AE BH DJ DZ EG EH IQ JO KM KW LB LY MA MR OM PS QA SA SD SY TN YE",
    "de": "AT CH DE LI",
    "es": "AR BO CL CO CR CU DO EC ES GQ GT HN MX NI PA PE PR PY SV UY VE",
    "fr": "BE BF BI BJ BL CD CF CG CI CM FR GA GF GN GP LU MC MF ML MQ NC NE PF PM RE SN TD TG WF YT",
    "it": "IT SM VA",
    "ja": "JP",
    "nl": "NL SR",
    "pl": "PL",
    "pt": "AO BR CV GW MZ PT ST",
    "sv": "AX SE",
    "tr": "TR",
    "zh": "CN TW",
}
"""Languages of street names, and the countries where they are named in them; elsewhere in English."""


def relocated(scenario: Scenario, origin: tuple[float, float]) -> Scenario:
    """The scenario with the middle of its network at ``origin`` (longitude, latitude, degrees).

    The local time stays the same, in the zone of that place. The weather is drawn from its climate. Where traffic
    keeps the other side, the network is mirrored. Signs show the country's round figures (``geo.signs``), and
    streets have names that do not tell where they really lie (``traffic.naming``).

    Raises:
        UserError: ``origin`` is not a position on earth.
        ScenarioError: the network cannot be read."""
    place = shipped().place(*origin)
    notes = [*scenario.notes]
    if place.law is None:
        where = place.country_name or "the sea"
        notes.append(f"no traffic law is known at {origin[0]:g},{origin[1]:g} ({where})")
    return replace(
        scenario,
        origin=origin,
        has_place=True,
        country=place.country,
        start=scenario.start.replace(tzinfo=zone_of(place)),
        weather=(),
        notes=tuple(notes),
    )


def at_home(scenario: Scenario) -> Scenario:
    """A scenario that has an ``origin``, with streets in the language of that place, and mirrored if traffic there
    keeps the other side than its network.

    Raises:
        UserError: its origin is not a position on earth.
        ScenarioError: the network cannot be read."""
    assert scenario.origin is not None
    place = shipped().place(*scenario.origin)
    law = place.law
    side = "left" if drives_on_left(read_configuration(scenario.config).net) else "right"
    language = next((code for code, countries in SPOKEN.items() if place.country in countries.split()), "")
    return replace(scenario, language=language, mirrored=law is not None and law.driving_side != side)


def zone_of(place: Place) -> ZoneInfo:
    """The time zone of a place, UTC if unknown."""
    return ZoneInfo(place.time_zone or "UTC")
