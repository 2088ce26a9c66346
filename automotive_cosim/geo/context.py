"""The geo-context: what applies where the car is, as data and as the text an agent reads.

The text has one fact per line, in a fixed order, each with its source. Rules are stated with their conditions,
whether or not these hold now, so nothing in the text reveals when something is due. The line of the limit also
suits simple readers: ``Speed limit here: 50 km/h (posted on Avenue Foch)``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from functools import cached_property

from automotive_cosim.contracts import KMH_PER_MPS, DrivingState, GpsFix, RoadHere, Weather
from automotive_cosim.geo.applied import AppliedRule, RulesHere, built_up, facts_at, said_at
from automotive_cosim.geo.binding import BindingLimit, binding
from automotive_cosim.geo.climate import ClimateNorm, climate_norm
from automotive_cosim.geo.place import NOWHERE, Atlas, Place
from automotive_cosim.geo.rulefacts import RuleFacts
from automotive_cosim.geo.rules import Rule, Value
from automotive_cosim.geo.sun import Sun, sun_at
from automotive_cosim.geo.text import BUDGET_TOKENS, KM_PER_MILE, Line, amount_of_speed, position, within_budget
from automotive_cosim.geo.weather import visibility_class
from automotive_cosim.geo.weather import words as weather_words

WINTER_BELOW_C = 7.0
"""Where winter tyres grip better than summer tyres, as tyre makers say."""
WARM_FROM_C = 22.0
"""From here on a driver may want to be cooled; our choice, well below the 26 degrees of EN 16798-1."""
_HIDING = frozenset(("drizzle", "dust", "fog", "precipitation"))
"""Weather in which less is seen."""


def _hidden(now: RuleFacts) -> bool:
    return now.phenomena is None or not _HIDING.isdisjoint(now.phenomena)


def _in_town(now: RuleFacts) -> bool:
    return now.built_up is not False


def _off_motorways(now: RuleFacts) -> bool:
    return now.motorway is not True


def _wide(now: RuleFacts) -> bool:
    return now.motorway is not False or now.dual_carriageway is not False or now.lanes >= 2


_ONLY_IF: Mapping[str, Callable[[RuleFacts], bool]] = {
    "front_fog": _hidden,
    "rear_fog": _hidden,
    "high_beam": lambda now: now.after_sunset is not False or now.tunnel or _hidden(now),
    "emergency_corridor": _wide,
    "turn_on_red": _off_motorways,
    "bus_lane": _off_motorways,
    "through_traffic": _off_motorways,
    "low_emission": _in_town,
    "school_zone": _off_motorways,
    "idling": lambda now: now.standing,
    "alcohol": lambda now: False,  # nothing that is done at the wheel depends on it
    "seat_belts": lambda now: False,  # they are fastened before the drive
}
"""Topics that do not always matter; unknown conditions count as if they could hold."""


def can_matter(topic: str, now: RuleFacts, air_c: float | None) -> bool:
    """Whether a topic of ``rules.TOPICS`` can matter by these facts, with that air temperature outside."""
    if topic in ("winter_tyres", "studs", "cold"):
        return air_c is None or air_c < WINTER_BELOW_C
    if topic == "heat":
        return air_c is None or air_c >= WARM_FROM_C
    return topic not in _ONLY_IF or _ONLY_IF[topic](now)


@dataclass(frozen=True)
class GeoContext:
    """Place, road, law, sky and weather at one instant. States facts and rules; judges nothing.

    It holds its inputs; what follows from them is computed on first use, since most instants need little."""

    driving: DrivingState
    """Source of road, traffic and motion; its position is not used."""
    gps: GpsFix | None
    """Source of the place, by its last fix; None leaves it unknown."""
    weather: Weather | None
    local_time: datetime
    """Zone-aware."""
    atlas: Atlas = field(compare=False, repr=False)

    @property
    def road(self) -> RoadHere:
        """The road that the car is on."""
        return self.driving.road

    @property
    def speed_kmh(self) -> float:
        return self.driving.speed_mps * KMH_PER_MPS

    @property
    def heading_deg(self) -> float:
        """Heading, clockwise from north."""
        return self.driving.heading_deg

    @cached_property
    def place(self) -> Place:
        """Country, region, city, and whose rules apply. Raises UserError: a rule file of the country is invalid."""
        return NOWHERE if self.gps is None else self.atlas.place(self.gps.lon_deg, self.gps.lat_deg)

    @cached_property
    def sun(self) -> Sun | None:
        """The sun; None if the position is unknown, as for ``climate``."""
        return None if self.gps is None else sun_at(self.gps.lon_deg, self.gps.lat_deg, self.local_time)

    @cached_property
    def climate(self) -> ClimateNorm | None:
        """The month's normals of the nearest station; None also if that is far."""
        return None if self.gps is None else climate_norm(self.gps.lon_deg, self.gps.lat_deg, self.local_time.month)

    @property
    def built_up(self) -> bool | None:
        """Whether the road is in a built-up area; None if unknown."""
        return self._built_up[0]

    @property
    def built_up_source(self) -> str:
        """``"network"``, ``"road class"``, ``"place"`` or ``"unknown"``."""
        return self._built_up[1]

    @property
    def posted_limit_kmh(self) -> float | None:
        """The posted limit; None if no sign is known, or the sign lifts every limit."""
        posted = self.road.limit.posted_mps
        return None if posted is None else posted * KMH_PER_MPS

    @property
    def default_limits(self) -> tuple[AppliedRule, ...]:
        """The legal limits for this road: several if the network does not determine which, none if no law is
        known."""
        return self._said.fixed_limits

    @property
    def reduced_limits(self) -> tuple[AppliedRule, ...]:
        """Lower limits of this road under conditions of weather, light or hour, whether or not these hold now."""
        return self._said.reduced_limits

    @property
    def rules(self) -> tuple[AppliedRule, ...]:
        """The other topics, in the order of ``rules.TOPICS``."""
        return self._said.others

    @cached_property
    def country(self) -> str:
        """ISO 3166-1 code; empty if unknown."""
        return self.place.country

    @cached_property
    def default_limit(self) -> AppliedRule | None:
        """The legal limit for this road if it is certain."""
        return self.default_limits[0] if len(self.default_limits) == 1 and self.default_limits[0].certain else None

    @cached_property
    def binding_limit(self) -> BindingLimit | None:
        """The lowest limit that certainly applies (``binding.binding``)."""
        return binding(self.road, self.default_limit, self.reduced_limits)

    @property
    def speed_unit(self) -> str:
        """The country's unit of speed: ``"km/h"`` or ``"mph"``; km/h if the country is unknown."""
        return self.place.law.speed_unit if self.place.law else "km/h"

    def rule(self, topic: str) -> AppliedRule | None:
        """The first rule on a topic that applies now; None if there is none."""
        return next((found for found in self.rules if found.rule.topic == topic and found.value is not None), None)

    @property
    def lines(self) -> tuple[Line, ...]:
        """Every fact and rule with its source, the most important first."""
        return (*_lines(self), *self._said.lines)

    @property
    def shown(self) -> tuple[Line, ...]:
        """The lines that can matter here and now, and one that names the topics of the others; not kept, as a drive
        keeps its contexts."""
        air_c = None if self.weather is None else self.weather.temperature_2m
        said, facts = self._said, self._facts
        return (*_lines(self), *said.shown(tuple(can_matter(topic, facts, air_c) for topic in said.topics)))

    def text(self, budget_tokens: int = BUDGET_TOKENS) -> str:
        """The lines of ``shown`` as text, one fact per line: as many, from the first, as the budget allows."""
        return within_budget(self.shown, budget_tokens)

    @property
    def _built_up(self) -> tuple[bool | None, str]:
        return built_up(self.road, self.place)

    @property
    def _facts(self) -> RuleFacts:
        return facts_at(self.driving, self.gps, self.weather, self.local_time, self.sun, self.built_up)

    @cached_property
    def _said(self) -> RulesHere:
        return said_at(self.place, self._facts)


def answer(rule: Rule, context: GeoContext) -> Value | None:
    """What a rule of any place says to the facts here and now; None if it does not apply."""
    return rule.answer(context._facts)[0]


# --- in words ---------------------------------------------------------------------------------------------


SIGN_WITHIN_M = 300.0
"""A stop or give-way sign on the route is named from here on."""


def _lines(context: GeoContext) -> Iterator[Line]:
    yield Line(f"Place: {_place(context)}", "place")
    yield Line(f"Position: {_position(context)}", "gps")
    yield Line(f"Road: {_road(context)}", "road")
    yield Line(f"Speed limit here: {_posted(context)}", "road")
    if context.driving.trailer:
        yield Line("Vehicle: a car with a trailer", "motion")
    if context.road.limit_hours:
        yield Line(f"Posted for certain hours: {context.road.limit_hours}", "road")
    yield from _limits(context)
    ahead = context.driving.ahead
    if ahead.next_sign and ahead.sign_distance_m is not None and ahead.sign_distance_m <= SIGN_WITHIN_M:
        yield Line(f"Sign ahead: {ahead.next_sign.replace('_', ' ')} in {ahead.sign_distance_m:.0f} m", "road")
    yield Line(f"Speed: {_speed(context.speed_kmh, context)}, heading {_compass(context.heading_deg)}", "motion")
    yield Line(f"Time: {_time(context)}", "sky")
    yield Line(f"Weather: {_weather(context)}", "weather")
    if (blue := context.driving.around.emergency_behind) is not None:
        yield Line(f"Blue light: {blue.gap_m:.0f} m behind", "traffic")
    if context.climate:
        yield Line(_climate(context), "climate")
    if context.place.law:
        law = context.place.law
        yield Line(f"Country: traffic keeps {law.driving_side}; emergency call {', '.join(law.emergency)}", "place")


def _place(context: GeoContext) -> str:
    place = context.place
    if not place.time_zone:
        return "unknown"
    country = f"{place.country_name} ({place.country})" if place.country else "no country (at sea)"
    named = ", ".join(part for part in (place.city, place.region, country) if part)
    border = f"; within 2 km of {', '.join(place.near_border_to)}" if place.near_border_to else ""
    return f"{named}{border}"


def _position(context: GeoContext) -> str:
    gps = context.gps
    if gps is None:
        return "unknown"
    where = position(gps.lon_deg, gps.lat_deg)
    if gps.has_fix:
        return f"{where}, within {gps.accuracy_m:.0f} m"
    return f"no fix, {gps.age_s:.0f} s ago {where}"


def _road(context: GeoContext) -> str:
    road = context.road
    lanes = f"{road.lane_count} lane" + ("s" if road.lane_count != 1 else "")
    parts = [road.name or "unnamed", road.road_class.replace("_", " ") or "class unknown", lanes]
    if context.built_up is None:
        parts.append("built-up or not: unknown")
    else:
        parts.append("built-up" if context.built_up else "outside built-up areas")
    if road.lit is not None:
        parts.append("lit" if road.lit else "unlit")
    if road.in_tunnel:
        parts.append("tunnel")
    if road.school_zone:
        parts.append("school zone")
    return ", ".join(parts)


def _posted(context: GeoContext) -> str:
    road = context.road
    if not road.limit.is_posted:
        assumed_kmh = None if context.default_limit else road.limit.kmh
        return "not posted" + ("" if assumed_kmh is None else f"; the map assumes {_speed(assumed_kmh, context)}")
    if context.posted_limit_kmh is None:
        return "none posted"
    return f"{_speed(context.posted_limit_kmh, context)} ({road.limit.words} {road.name or 'this road'})"


def _speed(kmh: float, context: GeoContext) -> str:
    return amount_of_speed(kmh, context.speed_unit)


def _limits(context: GeoContext) -> Iterator[Line]:
    if not context.default_limits:
        yield Line("Default limit: unknown", "road")
    for found in context.default_limits:
        yield Line(found.rule.line, found.rule.id)
    for found in context.reduced_limits:
        if not _is_lower(found, context):
            continue
        yield Line(f"Reduced limit: {found.rule.stated}", found.rule.id)


def _is_lower(reduced: AppliedRule, context: GeoContext) -> bool:
    """Whether it could be the lowest limit on this road."""
    if context.posted_limit_kmh is not None:
        here = [context.posted_limit_kmh]
    else:
        here = [_kmh(found.rule) for found in context.default_limits]
    return not here or _kmh(reduced.rule) < max(here) - 0.5


def _kmh(limit: Rule) -> float:
    value = limit.cases[0].value
    if isinstance(value, str):
        return float("inf")
    return value * KM_PER_MILE if limit.unit == "mph" else value


def _time(context: GeoContext) -> str:
    time = context.local_time
    clock = f"{time.isoformat(' ', 'minutes')[:16]}, {_DAYS[time.weekday()]}"
    sun = context.sun
    if sun is None:
        return clock
    side = "above" if sun.elevation_deg >= 0 else "below"
    sky = f"{clock}; {sun.darkness}, sun {abs(sun.elevation_deg):.0f}° {side} the horizon"
    if not sun.glares(context.heading_deg):
        return sky
    return f"{sky}, {abs(sun.off_heading_deg(context.heading_deg)):.0f}° off the way ahead"


def _weather(context: GeoContext) -> str:
    weather = context.weather
    if weather is None:
        return "unknown"
    parts = [weather_words(weather.weather_code), _temperature(weather.temperature_2m, context)]
    parts.append(f"humidity {weather.relative_humidity_2m:.0f} %")
    if weather.precipitation > 0:
        parts.append(f"{weather.precipitation:.1f} mm/h")
    visibility = visibility_class(weather.visibility).replace("_", " ")
    parts.append(f"visibility {weather.visibility:.0f} m ({visibility})")
    parts.append(f"wind {weather.wind_speed_10m:.0f} km/h")
    return ", ".join(parts)


def _temperature(celsius: float, context: GeoContext) -> str:
    if context.place.law and context.place.law.temperature_unit == "F":
        return f"{celsius * 9 / 5 + 32:.0f} °F"
    return f"{celsius:.0f} °C"


def _climate(context: GeoContext) -> str:
    norm = context.climate
    assert norm is not None
    return (
        f"Usual in {_MONTHS[norm.month - 1]} at {norm.station}: "
        f"{_temperature(norm.usual_low_c, context)} at night to {_temperature(norm.usual_high_c, context)} by day, "
        f"{norm.precipitation_mm:.0f} mm in the month, humidity {norm.humidity_pct:.0f} % "
        f"(normals 1991-2020, {norm.status})"
    )


def _compass(heading_deg: float) -> str:
    return _POINTS[round(heading_deg / 45) % 8]


_DAYS = ("Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday", "Sunday")
_MONTHS = (
    *("January", "February", "March", "April", "May", "June"),
    *("July", "August", "September", "October", "November", "December"),
)
_POINTS = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")
