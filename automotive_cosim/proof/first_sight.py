"""What tells the halves of a pair apart at first sight, and what their declared difference may change.

A pair declares kinds of difference (``tasking.task.Differs``). Each frees some facets of the first observation. A
fact of an observation follows from one facet or several; unless one of them is free, it has to be the same in both
halves to the last digit, or an agent could tell them apart by what has nothing to do with the task.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, replace
from datetime import datetime
from enum import StrEnum
from typing import Any

from automotive_cosim.cockpit.notices import LOW_KPA, NAMES, NOTICED, TYRES
from automotive_cosim.cockpit.signals import GLASS
from automotive_cosim.cockpit.telltales import Telltale
from automotive_cosim.contracts import BoundingBox, Element, Observation, VehicleState
from automotive_cosim.contracts.ids import key_of
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.rules import Rule
from automotive_cosim.tasking.task import Differs


class Facet(StrEnum):
    """A part of what an agent sees first."""

    WORDS = "what the driver says"
    PLACE = "the place"
    ROAD = "the road"
    SIGN = "the sign"
    VIEW = "where on the road"
    LINK = "fix and connection"
    GEAR = "gear and restrictions"
    SPEED = "the speed"
    TRAFFIC = "the car in front"
    CLOCK = "the clock"
    LIGHT = "the light"
    WEATHER = "the weather"
    CABIN = "air and glass of the cabin"
    ABOARD = "who is aboard"
    SETTINGS = "the settings"
    UNITS = "the units"
    CAR = "the rest of the car"


_DRIVING = {Facet.SPEED, Facet.TRAFFIC, Facet.VIEW}
"""What another pace changes: where on the road the situation comes about, and with whom."""
FREED: Mapping[Differs, frozenset[Facet]] = {
    Differs.PLACE: frozenset({Facet.PLACE, Facet.SIGN}),
    Differs.ROAD: frozenset({Facet.PLACE, Facet.ROAD, Facet.SIGN, Facet.LINK, *_DRIVING}),
    Differs.TRAFFIC: frozenset({*_DRIVING}),
    Differs.WEATHER: frozenset({Facet.WEATHER, Facet.CABIN, *_DRIVING}),
    Differs.VISIBILITY: frozenset({Facet.WEATHER, *_DRIVING}),
    Differs.DATE: frozenset({Facet.CLOCK, Facet.LIGHT, Facet.SIGN, *_DRIVING}),
    Differs.TIME: frozenset({Facet.CLOCK, Facet.LIGHT, Facet.SIGN, *_DRIVING}),
    Differs.MOTION: frozenset({Facet.GEAR, *_DRIVING}),
    Differs.SETTINGS: frozenset({Facet.SETTINGS, Facet.CABIN}),
    Differs.UNITS: frozenset({Facet.UNITS}),
    Differs.EVENTS: frozenset(),
    Differs.ABOARD: frozenset({Facet.ABOARD, Facet.CABIN}),
    Differs.VOICE: frozenset({Facet.WORDS}),
    Differs.EQUIPMENT: frozenset({Facet.SIGN, Facet.SETTINGS, Facet.LINK, Facet.WEATHER}),
    Differs.CONTENT: frozenset(),
}
"""What each kind of difference changes by itself; what follows from that names it among its causes."""

READINGS: Mapping[str, frozenset[Facet]] = {
    name: frozenset(causes)
    for name, causes in {
        "speed_kmh": {Facet.SPEED},
        "gear": {Facet.GEAR},
        "restrictions": {Facet.GEAR, Facet.SPEED},
        "ambient_temperature_c": {Facet.WEATHER},
        "cabin_temperature_c": {Facet.CABIN},
        "cabin_humidity_pct": {Facet.CABIN},
        "rain_intensity_pct": {Facet.WEATHER, Facet.ROAD},
        "driver_temperature_set_c": {Facet.SETTINGS},
        "fan_speed_pct": {Facet.SETTINGS},
        "is_low_beam_on": {Facet.LIGHT, Facet.ROAD, Facet.SETTINGS},
        "is_high_beam_on": {Facet.SETTINGS},
        "is_front_fog_on": {Facet.SETTINGS},
        "is_rear_fog_on": {Facet.SETTINGS},
        "is_hazard_on": {Facet.SETTINGS},
        "energy_level_pct": {Facet.CAR},
        "range_km": {Facet.CAR},
        "speed_limit_sign_kmh": {Facet.SIGN},
        "leader_gap_m": {Facet.TRAFFIC},
        "leader_time_to_collision_s": {Facet.TRAFFIC},
        "aboard": {Facet.ABOARD},
        "noticed": {Facet.TRAFFIC, Facet.CAR, Facet.WEATHER},
    }.items()
}
"""What each reading follows from. In a tunnel no rain falls, and lamps on auto come on."""
_ELEMENTS: Mapping[str, frozenset[Facet]] = {
    begin: frozenset(causes)
    for begin, causes in {
        "home.map": {Facet.VIEW, Facet.PLACE},
        "map.": {Facet.VIEW, Facet.PLACE},
        "home.street": {Facet.VIEW, Facet.ROAD, Facet.PLACE},
        "home.turn": {Facet.VIEW, Facet.PLACE},
        "home.route": {Facet.VIEW, Facet.PLACE},
        "home.speed": {Facet.SPEED},
        "home.telltales": {Facet.SPEED},  # they stand beside its figures
        "home.sign": {Facet.SIGN},
        "status.speed": {Facet.SPEED},
        "status.gear": {Facet.GEAR},
        "status.clock": {Facet.CLOCK},
        "status.limit_sign": {Facet.SIGN},
        "status.connectivity": {Facet.LINK},
        "status.gps": {Facet.LINK},
        "status.outside_temperature": {Facet.WEATHER},
        "status.": {Facet.CAR},
        "home.outside": {Facet.WEATHER, Facet.ROAD, Facet.LIGHT},
        "home.cabin_note": {Facet.CABIN, Facet.WEATHER, Facet.LIGHT, Facet.ABOARD, Facet.SETTINGS, Facet.GEAR},
        "home.cabin": {Facet.CABIN},
        "dock.": {Facet.SETTINGS},
        "": {Facet.CAR},
    }.items()
}
"""What elements follow from, by the beginning of their resource id; the first that fits. Streets have the names of
their place."""
_IN_UNITS = ("home.speed", "status.speed", "home.sign", "status.limit_sign", "home.turn", "home.r", "map.",
    "status.outside_temperature", "home.outside", "home.cabin", "dock.")  # fmt: skip
"""Elements with figures that the display's units change."""
_MAP = frozenset({Facet.VIEW, Facet.PLACE})
"""Elements without a name: the streets on the map."""
_LINES: Mapping[str, frozenset[Facet]] = {
    "gps": frozenset({Facet.PLACE, Facet.VIEW}),
    "road": frozenset({Facet.ROAD, Facet.SIGN, Facet.VIEW, Facet.PLACE}),
    "motion": frozenset({Facet.SPEED, Facet.VIEW, Facet.PLACE}),
    "traffic": frozenset({Facet.TRAFFIC}),
    "sky": frozenset({Facet.CLOCK, Facet.PLACE, Facet.VIEW}),
    "weather": frozenset({Facet.WEATHER, Facet.PLACE}),
    "climate": frozenset({Facet.PLACE, Facet.CLOCK}),
}
"""What the lines of the geo-context follow from, by their source: many are in the place's units, and the line of
the road has its name here. Whatever they are made of is compared by itself too."""
_LAW: Mapping[str, frozenset[Facet]] = {
    "streets": frozenset({Facet.ROAD, Facet.VIEW}),
    "inside": frozenset({Facet.VIEW}),
    "season": frozenset({Facet.CLOCK}),
    "since": frozenset({Facet.CLOCK}),
}
"""What the words of a rule follow from (``geo.rulefacts.CONDITIONS``) by which it is stated or not; all others of
them follow from the kind of road."""
_MATTERS: Mapping[str, frozenset[Facet]] = {
    "front_fog": frozenset({Facet.WEATHER}),
    "rear_fog": frozenset({Facet.WEATHER}),
    "high_beam": frozenset({Facet.LIGHT, Facet.ROAD, Facet.WEATHER}),
    "idling": frozenset({Facet.SPEED}),
    "winter_tyres": frozenset({Facet.WEATHER}),
    "studs": frozenset({Facet.WEATHER}),
    "cold": frozenset({Facet.WEATHER}),
    "heat": frozenset({Facet.WEATHER}),
}
"""What decides whether a topic can matter here and now, or is left to a query; of all others,
the kind of road does."""


def undeclared(
    differs: frozenset[Differs], one: tuple[Observation, Moment], other: tuple[Observation, Moment]
) -> Iterator[str]:
    """What differs between two first observations though nothing declared frees it, in words.

    Args:
        differs: the declared kinds of difference."""
    free = frozenset[Facet]().union(*(FREED[kind] for kind in differs))
    seen, as_well = (dict(_facts(*each)) for each in (one, other))
    for name, (causes, _) in {**seen, **as_well}.items():
        has, had = (facts[name][1] if name in facts else None for facts in (seen, as_well))
        if not causes & free and has != had:
            told = ", ".join(sorted(causes))
            yield f"{told}, {name}: {_shown(has)} in one half, {_shown(had)} in the other"


_NOWHERE = BoundingBox(0, 0, 0, 0)
Fact = tuple[str, tuple[frozenset[Facet], Any]]
"""Its name, what it follows from, and what it says."""


def _facts(observation: Observation, moment: Moment) -> Iterator[Fact]:
    assert observation.vehicle is not None
    assert observation.elements is not None
    yield "the goal", (frozenset({Facet.WORDS}), observation.goal)
    yield "the local time", (frozenset({Facet.CLOCK}), _clock(moment.local_time))
    yield "the weather", (frozenset({Facet.WEATHER}), moment.weather)
    yield "the connection", (frozenset({Facet.LINK}), moment.connectivity)
    yield from _fix(observation)
    yield from _readings(observation.vehicle)
    yield from _on_screen(observation.elements, moment.signals)
    yield from _in_context(moment.context)


def _fix(observation: Observation) -> Iterator[Fact]:
    gps = observation.gps
    yield "a position fix", (frozenset({Facet.LINK}), gps is not None and gps.has_fix)
    if gps is not None:
        quality = {"accuracy_m", "age_s", "has_fix"}
        for field in fields(gps):
            causes = {Facet.LINK} if field.name in quality else {Facet.PLACE, Facet.VIEW, Facet.LINK}
            yield f"gps {field.name}", (frozenset(causes), getattr(gps, field.name))


def _readings(vehicle: VehicleState) -> Iterator[Fact]:
    for name, causes in READINGS.items():
        yield name, (causes, getattr(vehicle, name))


def _on_screen(elements: Sequence[Element], signals: Mapping[str, Any]) -> Iterator[Fact]:
    counts: dict[str, int] = {}
    for element in elements:
        name = key_of(element.resource_id)
        counts[name] = counts.get(name, 0) + 1
        causes = next(found for begin, found in _ELEMENTS.items() if name.startswith(begin)) if name else _MAP
        causes |= {Facet.UNITS} if name.startswith(_IN_UNITS) else set()
        told = f"{name or 'map'} {counts[name]}"
        yield f"box of {told}", (causes | {Facet.PLACE}, element.bbox_pixels)  # the driver's side
        element = replace(element, bbox_pixels=_NOWHERE)
        if name == "status.notifications":
            words, _, count = element.content_description.rpartition(" ")
            yield from _notices(int(count), signals)
            element = replace(element, content_description=words)
        if name in ("status.telltales", "home.telltales"):
            yield from _telltales(told, element.content_description)
            element = replace(element, content_description=element.content_description.partition(": ")[0])
        yield told, (causes, element)


_LAMPS: Mapping[Telltale, frozenset[Facet]] = {
    Telltale.WARNING: frozenset({Facet.WEATHER, Facet.SETTINGS}),
    Telltale.BELT: frozenset({Facet.ABOARD, Facet.GEAR}),
    Telltale.DOOR: frozenset({Facet.SETTINGS}),
    Telltale.BATTERY: frozenset({Facet.CAR}),
    Telltale.HAZARD: frozenset({Facet.SETTINGS}),
    Telltale.TYRE: frozenset({Facet.WEATHER}),
    Telltale.STABILITY: frozenset({Facet.SETTINGS}),
    Telltale.FROST: frozenset({Facet.WEATHER}),
    Telltale.CABLE: frozenset({Facet.SETTINGS}),
    Telltale.HIGH_BEAM: READINGS["is_high_beam_on"],
    Telltale.LOW_BEAM: READINGS["is_low_beam_on"],
    Telltale.POSITION: READINGS["is_low_beam_on"],
    Telltale.FRONT_FOG: READINGS["is_front_fog_on"],
    Telltale.REAR_FOG: READINGS["is_rear_fog_on"],
}
"""What each tell-tale follows from."""


def _telltales(where: str, words: str) -> Iterator[Fact]:
    """Each tell-tale that is lit, apart from the others."""
    lit = words.partition(": ")[2].split(", ")
    for telltale, causes in _LAMPS.items():
        yield f"{telltale} of {where}", (causes, NAMES[telltale] in lit)


def _notices(count: int, signals: Mapping[str, Any]) -> Iterator[Fact]:
    """The number on the badge, apart from the notices that follow from the air outside and inside."""
    soft = any(signals[tyre.path] < LOW_KPA for tyre in TYRES)
    fogged = signals[GLASS.WINDSHIELD_FOG.path] >= NOTICED
    yield "notice of a soft tyre", (frozenset({Facet.WEATHER}), soft)
    yield "notice of fogged glass", (frozenset({Facet.CABIN}), fogged)
    yield "number of other notices", (frozenset({Facet.CAR}), count - soft - fogged)


def _in_context(context: GeoContext) -> Iterator[Fact]:
    sun, road = context.sun, context.road
    if sun is not None:
        yield "the darkness", (frozenset({Facet.LIGHT}), sun.darkness)
        yield "glare of the sun", (frozenset({Facet.LIGHT, Facet.VIEW}), sun.glares(context.heading_deg))
    kind = (road.road_class, road.lane_count, road.lit, road.built_up, road.centre_line)
    yield "kind of road", (frozenset({Facet.ROAD}), kind)
    yield "tunnel or school zone", (frozenset({Facet.ROAD}), (road.in_tunnel, road.school_zone))
    yield "limit", (frozenset({Facet.SIGN}), (road.limit, road.limit_hours))
    rules = {
        found.rule.id: found.rule for found in (*context.default_limits, *context.reduced_limits, *context.rules)
    }
    counts: dict[str, int] = {}
    for line in context.lines:
        counts[line.source] = counts.get(line.source, 0) + 1
        if line.source == "place":  # how near a border is depends on where on the road
            named, _, border = line.text.partition("; within")
            yield f"line of place {counts['place']}", (frozenset({Facet.PLACE}), named)
            yield f"border of place {counts['place']}", (_MAP, border)
            continue
        causes = _LINES[line.source] if line.source in _LINES else _of(rules[line.source])
        yield f"line of {line.source} {counts[line.source]}", (causes, line.text)
    for line in context.shown:
        if rule := rules.get(line.source):
            causes = _of(rule) | _MATTERS.get(rule.topic, frozenset({Facet.ROAD}))
            yield f"whether {rule.id} is shown", (causes, True)


def _of(rule: Rule) -> frozenset[Facet]:
    """What a rule's line follows from: whose law it is, and where and when it applies; a lower limit also from what
    is posted."""
    words = (test.word for test in rule.tests if test.fixed)
    causes = frozenset[Facet]().union(*(_LAW.get(word, {Facet.ROAD}) for word in words))
    return causes | {Facet.PLACE} | ({Facet.SIGN} if rule.topic == "limit" else set())


def _clock(time: datetime) -> datetime:
    """The local clock and calendar."""
    return time.replace(tzinfo=None)


def _shown(value: Any) -> str:
    if isinstance(value, Element):
        return f"{value.text} {value.content_description}".strip() or "nothing"
    return "; ".join(map(str, value)) if isinstance(value, tuple) else str(value)
