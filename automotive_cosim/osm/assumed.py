"""The limit of a road whose map states none: the one that the law of its place sets.

Where the rules of ``geo`` determine it (``US-CA:urban``: California's 25 mph; ``DE:motorway``: none), it is theirs,
else the country's most common one (``country``). Either way it is assumed, not posted: no sign was mapped.
"""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime

from automotive_cosim.geo.applied import limits
from automotive_cosim.geo.place import Atlas, Place
from automotive_cosim.geo.rulefacts import RuleFacts
from automotive_cosim.osm.country import assumed_limit_kmh
from automotive_cosim.osm.lanes import COUNTED, built_of
from automotive_cosim.osm.oneway import directions
from automotive_cosim.osm.speed_limits import CYCLE_ZONES, WALKING_ZONES, Zone, zones_of
from automotive_cosim.traffic.network import class_of
from automotive_cosim.traffic.posted_limits import WALK_KMH

AS_OF = datetime(2026, 11, 1, 12, tzinfo=UTC)
"""The day whose law fills the gaps."""

PEDESTRIAN_ZONE_KMH = {"CZ": 20.0, "SK": 20.0}
"""Where the code sets a number for pedestrian zones (CZ: 361/2000 Sb. § 39; SK: 8/2009 Z. z. § 59), not a pace."""

MAYBE_DUAL = frozenset(("trunk", "trunk_link", "primary", "primary_link", "secondary", "secondary_link"))
"""One-way roads of these classes may be one carriageway of two; other one-way roads are streets."""


def assumed_sign(tags: Mapping[str, str], atlas: Atlas, place: Place, *, built_up: bool) -> str:
    """The most likely limit, as netconvert reads it: ``"50"``, ``"25 mph"`` or ``"none"``.

    Args:
        tags: the way's, with ``highway``; a zone among them names the place whose law applies.
        built_up: whether it lies in a town or village.
    """
    zone = next(zones_of(tags), None)
    country = zone.country if zone else place.country
    if zone and zone.name in WALKING_ZONES:
        return f"{PEDESTRIAN_ZONE_KMH.get(country, WALK_KMH):g}"
    there = place if zone is None else _named(zone, atlas, place)
    facts = _facts(tags, zone.name if zone else "", built_up=built_up)
    found = [applied for applied in limits(there, facts) if applied.rule.fixed]
    if len(found) == 1 and found[0].certain:
        value, unit = found[0].value, found[0].rule.unit
        if value == "none":
            return "none"
        return f"{value:g} mph" if unit == "mph" else f"{value:g}"
    dual = tags.get("oneway") == "yes" or "motorroad" in tags
    road_class = "motorway" if facts.motorway else facts.road_class
    return f"{assumed_limit_kmh(country, road_class, built_up=built_up, dual=dual):g}"


def _named(zone: Zone, atlas: Atlas, place: Place) -> Place:
    """The place that a zone names, as exactly as it is known: the way's own, if that lies in it; else the region
    with its country, or the country alone. A region without rules of its own is the country around the way."""
    around = {layer.code for layer in place.layers}
    known = {layer.code for layer in atlas.country(zone.country)}
    if zone.place in around or (zone.country == place.country and zone.place not in known):
        return place
    wanted = (zone.country, zone.place)
    layers = tuple(layer for layer in atlas.country(zone.country) if layer.code in wanted)
    return Place(country=zone.country, layers=layers)


def _facts(tags: Mapping[str, str], zone: str, *, built_up: bool) -> RuleFacts:
    road_class = class_of(tags["highway"], tags)
    if zone in CYCLE_ZONES:
        road_class = "cycle_street"
    elif zone == "living_street":
        road_class = zone
    motorway = road_class == "motorway" or zone == "motorway" or (None if road_class == "motorway_link" else False)
    return RuleFacts(
        local_time=AS_OF,
        lon_deg=None,
        lat_deg=None,
        street=tags.get("name", ""),
        road_class=road_class,
        motorway=motorway,
        dual_carriageway=True if motorway else _dual_carriageway(tags, zone),
        expressway=_expressway(tags, zone),
        built_up=False if motorway else built_up,
        lit=None,
        centre_line={"yes": True, "no": False}.get(tags.get("lane_markings", "")),
        lanes=_lanes(tags),
        tunnel=tags.get("tunnel", "no") != "no",
        speed_kmh=0.0,
        standing=True,
        oncoming_m=None,
        leader_m=None,
        phenomena=frozenset(),
        visibility_m=None,
        after_sunset=False,
        trailer=False,
    )


def _dual_carriageway(tags: Mapping[str, str], zone: str) -> bool | None:
    if zone in ("nsl_single", "nsl_dual"):
        return zone == "nsl_dual"
    if tags.get("dual_carriageway") in ("yes", "no"):
        return tags["dual_carriageway"] == "yes"
    return None if tags.get("oneway") == "yes" and tags["highway"] in MAYBE_DUAL else False


def _expressway(tags: Mapping[str, str], zone: str) -> bool | None:
    if zone in ("trunk", "expressway", "motorroad") or tags.get("motorroad") == "yes":
        return True
    return None if tags["highway"] in ("trunk", "trunk_link") and "motorroad" not in tags else False


def _lanes(tags: Mapping[str, str]) -> int:
    """Number of lanes in each direction, the fewer; one where the map does not say."""
    if not any(key in tags for key in COUNTED):
        return 1
    may = directions(tags)
    return min((count for count, is_open in zip(built_of(tags, may), may, strict=True) if is_open), default=1)
