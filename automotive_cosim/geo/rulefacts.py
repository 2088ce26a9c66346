"""The conditions that a rule may have, and the facts on which they are evaluated.

A condition is one entry of a rule's ``when`` table. It holds, does not hold, or is unknown because the facts
do not say; several in one table must all hold. Those marked *fixed* depend only on place, road and date; the
others change even while the car is stationary (weather, light, traffic, the clock).
"""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import date, datetime, time
from functools import lru_cache
from typing import TYPE_CHECKING, Annotated, Any

import shapely
from annotated_types import Ge, Le, MinLen

from automotive_cosim.formats.annotations import Called, Form, Latitude, Longitude, Made, OneOf
from automotive_cosim.formats.words import matches
from automotive_cosim.geo.weather import PHENOMENA

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler
    from pydantic_core import CoreSchema


@dataclass(frozen=True, slots=True)
class RuleFacts:
    """Place, road, sky, traffic and motion at one instant; None if unknown."""

    local_time: datetime
    lon_deg: float | None
    lat_deg: float | None
    street: str
    road_class: str
    motorway: bool | None
    dual_carriageway: bool | None
    expressway: bool | None
    """For motor vehicles only, but not a motorway."""
    built_up: bool | None
    lit: bool | None
    centre_line: bool | None
    lanes: int
    """Number of lanes in the direction of travel."""
    tunnel: bool
    speed_kmh: float
    standing: bool
    oncoming_m: float | None
    """Distance of oncoming traffic; None if none is in sight."""
    leader_m: float | None
    """Distance of the vehicle ahead; None without one."""
    phenomena: frozenset[str] | None
    visibility_m: float | None
    after_sunset: bool | None
    trailer: bool
    """Whether the car tows one."""


@dataclass(frozen=True, slots=True)
class RuleCondition:
    """One word of the ``when`` language.

    ``takes`` is the type of the word's value, the argument of ``holds``; ``expects`` describes it in words."""

    expects: str
    takes: Any
    holds: Callable[[RuleFacts, Any], bool | None]
    fixed: bool = False


@dataclass(frozen=True, slots=True)
class Test:
    """A condition with its argument."""

    word: str
    argument: Any

    @property
    def fixed(self) -> bool:
        """Whether it depends only on place, road and date."""
        return CONDITIONS[self.word].fixed

    def holds(self, facts: RuleFacts) -> bool | None:
        """True, False, or None if the facts do not determine it."""
        return CONDITIONS[self.word].holds(facts, self.argument)


def all_hold(tests: tuple[Test, ...], facts: RuleFacts) -> bool | None:
    """False if one fails, else None if one is unknown, else True."""
    unknown = False
    for test in tests:
        holds = test.holds(facts)
        if holds is False:
            return False
        unknown = unknown or holds is None
    return None if unknown else True


class _When:
    """A table of conditions, each word with its value."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        from pydantic_core import core_schema
        from typing_extensions import TypedDict

        words = {word: Annotated[one.takes, Called(one.expects)] for word, one in CONDITIONS.items()}
        table: Any = TypedDict("Conditions", words, total=False)  # type: ignore[misc]
        return core_schema.no_info_after_validator_function(
            lambda read: tuple(Test(word, argument) for word, argument in read.items()),
            handler.generate_schema(table),
        )


When = Annotated[tuple[Test, ...], _When()]
"""Conditions, written as a table: ``{ motorway = true, weather = ["rain"] }``."""


@lru_cache(maxsize=4096)
def folded(name: str) -> str:
    """A street name for comparison, without accents, case, hyphens, apostrophes or double spaces."""
    plain = unicodedata.normalize("NFKD", name)
    plain = "".join(" " if char in "-'’" else char for char in plain if not unicodedata.combining(char))
    return " ".join(plain.casefold().split())


def polygon(corners: Sequence[tuple[float, float]]) -> shapely.Polygon:
    """A polygon from at least three longitudes and latitudes in degrees. Raises ValueError: its edges cross."""
    area = shapely.Polygon(corners)
    if not area.is_valid:
        raise ValueError("the polygon's edges cross")
    shapely.prepare(area)
    return area


Corner = Annotated[tuple[Longitude, Latitude], Called("a pair [lon, lat] in degrees")]
AreaPolygon = Annotated[shapely.Polygon, Made(Annotated[tuple[Corner, ...], MinLen(3)], polygon)]
"""Written as a list of corners."""


# --- the values of the words ---------------------------------------------------------------------------


def _month_day(text: str) -> tuple[int, int]:
    day = date.fromisoformat(f"2000-{text}")
    return day.month, day.day


def _some(kind: Any) -> Any:
    return Annotated[tuple[kind, ...], MinLen(1)]


_TEXTS = _some(str)
_STREETS = Annotated[Any, Made(_TEXTS, lambda names: tuple(map(folded, names)))]
_PHENOMENA = Annotated[Any, Made(_some(Annotated[str, OneOf(sorted(PHENOMENA))]), frozenset)]
_DAY = Annotated[str, Form(r"^\d\d-\d\d$", "03-31", _month_day)]
_HOUR = Annotated[str, Form(r"^\d\d:\d\d$", "08:00", time.fromisoformat)]
_WEEKDAYS = Annotated[Any, Made(_some(Annotated[int, Ge(1), Le(7)]), frozenset)]


# --- when they hold -----------------------------------------------------------------------------------------


def _same(name: str) -> Callable[[RuleFacts, Any], bool | None]:
    def holds(facts: RuleFacts, wanted: bool) -> bool | None:
        actual = getattr(facts, name)
        return None if actual is None else bool(actual == wanted)

    return holds


def _inside(facts: RuleFacts, area: shapely.Polygon) -> bool | None:
    if facts.lon_deg is None or facts.lat_deg is None:
        return None
    if id(area) not in _BOUNDS:
        _BOUNDS[id(area)] = area, area.bounds
    west, south, east, north = _BOUNDS[id(area)][1]
    if not (west <= facts.lon_deg <= east and south <= facts.lat_deg <= north):
        return False
    return bool(shapely.contains_xy(area, facts.lon_deg, facts.lat_deg))


_BOUNDS: dict[int, tuple[shapely.Polygon, tuple[float, float, float, float]]] = {}
"""By the id of an area, which it keeps: to compare with them takes a tenth of the time."""


def _on_street(facts: RuleFacts, patterns: tuple[str, ...]) -> bool:
    return _is_named(facts.street, patterns)


@lru_cache(maxsize=4096)
def _is_named(street: str, patterns: tuple[str, ...]) -> bool:
    """Cached, as a car asks every second, and of the same streets."""
    name = folded(street)
    return any(matches(name, pattern) for pattern in patterns)


def _on_class(facts: RuleFacts, classes: tuple[str, ...]) -> bool | None:
    return facts.road_class in classes if facts.road_class else None


def _in_season(facts: RuleFacts, season: tuple[tuple[int, int], tuple[int, int]]) -> bool:
    first, last = season
    today = (facts.local_time.month, facts.local_time.day)
    return first <= today <= last if first <= last else today >= first or today <= last


def _in_hours(facts: RuleFacts, hours: tuple[time, time]) -> bool:
    first, last = hours
    now = facts.local_time.time()
    return first <= now < last if first <= last else now >= first or now < last


def _in_weather(facts: RuleFacts, wanted: frozenset[str]) -> bool | None:
    return None if facts.phenomena is None else not wanted.isdisjoint(facts.phenomena)


def _sees_less(facts: RuleFacts, metres: float) -> bool | None:
    return None if facts.visibility_m is None else facts.visibility_m < metres


def _within(distance_m: float | None, metres: float) -> bool:
    return distance_m is not None and distance_m <= metres


CONDITIONS: dict[str, RuleCondition] = {
    "built_up": RuleCondition("true or false", bool, _same("built_up"), fixed=True),
    "motorway": RuleCondition("true or false", bool, _same("motorway"), fixed=True),
    "dual_carriageway": RuleCondition("true or false", bool, _same("dual_carriageway"), fixed=True),
    "expressway": RuleCondition("true or false", bool, _same("expressway"), fixed=True),
    "centre_line": RuleCondition("true or false", bool, _same("centre_line"), fixed=True),
    "lanes_at_least": RuleCondition("a number", float, lambda now, lanes: now.lanes >= lanes, fixed=True),
    "lanes_at_most": RuleCondition("a number", float, lambda now, lanes: now.lanes <= lanes, fixed=True),
    "trailer": RuleCondition("true or false", bool, _same("trailer"), fixed=True),
    "road_classes": RuleCondition("a list of OSM highway values", _TEXTS, _on_class, fixed=True),
    "streets": RuleCondition("a list of street names, * for any text", _STREETS, _on_street, fixed=True),
    "inside": RuleCondition("a list of [lon, lat] corners", AreaPolygon, _inside, fixed=True),
    "season": RuleCondition('["MM-DD", "MM-DD"], both included', tuple[_DAY, _DAY], _in_season, fixed=True),
    "since": RuleCondition("a date", date, lambda now, day: now.local_time.date() >= day, fixed=True),
    "weekdays": RuleCondition(
        "a list of 1 (Monday) to 7", _WEEKDAYS, lambda now, days: now.local_time.isoweekday() in days
    ),
    "hours": RuleCondition('["HH:MM", "HH:MM"], the last excluded', tuple[_HOUR, _HOUR], _in_hours),
    "lit": RuleCondition("true or false", bool, _same("lit")),
    "tunnel": RuleCondition("true or false", bool, _same("tunnel")),
    "after_sunset": RuleCondition("true or false", bool, _same("after_sunset")),
    "standing": RuleCondition("true or false", bool, _same("standing")),
    "weather": RuleCondition(f"a list of {', '.join(sorted(PHENOMENA))}", _PHENOMENA, _in_weather),
    "visibility_below_m": RuleCondition("a number of metres", float, _sees_less),
    "speed_above_kmh": RuleCondition("a number of km/h", float, lambda now, kmh: now.speed_kmh > kmh),
    "oncoming_within_m": RuleCondition("a number of metres", float, lambda now, m: _within(now.oncoming_m, m)),
    "leader_within_m": RuleCondition("a number of metres", float, lambda now, m: _within(now.leader_m, m)),
}
"""Every word that a ``when`` table may have."""
