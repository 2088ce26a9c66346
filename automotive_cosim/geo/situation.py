"""The conditions a rule may name, and the situation they are asked of.

A condition is one entry of a rule's ``when`` table. It holds, does not hold, or cannot be told because the
situation does not say; several in one table must all hold. Those marked *fixed* depend on place, road and date
alone; the others change while one stands still (weather, light, traffic, the clock).
"""

from __future__ import annotations

import unicodedata
from collections.abc import Callable
from dataclasses import dataclass
from datetime import date, datetime, time
from fnmatch import fnmatchcase
from math import isfinite
from typing import Any

import shapely

from automotive_cosim.errors import UnknownNameError
from automotive_cosim.geo.weather import PHENOMENA


@dataclass(frozen=True, slots=True)
class Situation:
    """Place, road, sky, traffic and motion at one instant; None where nothing tells."""

    local_time: datetime
    lon_deg: float | None
    lat_deg: float | None
    street: str
    road_class: str
    motorway: bool | None
    dual_carriageway: bool | None
    expressway: bool | None
    """For motor vehicles only, but no motorway."""
    built_up: bool | None
    lit: bool | None
    centre_line: bool | None
    lanes: int
    """In the direction of travel."""
    tunnel: bool
    speed_kmh: float
    standing: bool
    oncoming_m: float | None
    """None: nobody within sight."""
    leader_m: float | None
    """None: nobody ahead."""
    phenomena: frozenset[str] | None
    visibility_m: float | None
    after_sunset: bool | None


@dataclass(frozen=True, slots=True)
class Condition:
    """One word of the ``when`` language.

    ``expects`` says what stands beside the word, ``parse`` turns that into the argument of ``holds`` (ValueError or
    TypeError if it cannot).
    """

    expects: str
    parse: Callable[[Any], Any]
    holds: Callable[[Situation, Any], bool | None]
    fixed: bool = False


@dataclass(frozen=True, slots=True)
class Test:
    """A condition with its argument."""

    word: str
    argument: Any

    @property
    def fixed(self) -> bool:
        """Whether it depends on place, road and date alone."""
        return CONDITIONS[self.word].fixed

    def holds(self, situation: Situation) -> bool | None:
        """True, False, or None where the situation does not tell."""
        return CONDITIONS[self.word].holds(situation, self.argument)


def all_hold(tests: tuple[Test, ...], situation: Situation) -> bool | None:
    """False if one fails, else None if one cannot be told, else True."""
    unknown = False
    for test in tests:
        holds = test.holds(situation)
        if holds is False:
            return False
        unknown = unknown or holds is None
    return None if unknown else True


def parse_when(table: object) -> tuple[Test, ...]:
    """Reads a ``when`` table.

    Raises:
        UnknownNameError: a word that is no condition.
        ValueError: no table, or an argument that its condition does not take.
    """
    if not isinstance(table, dict):
        raise ValueError(f"when = {table!r} is no table of conditions")
    tests = []
    for word, argument in table.items():
        if word not in CONDITIONS:
            raise UnknownNameError("condition", word, CONDITIONS)
        condition = CONDITIONS[word]
        try:
            tests.append(Test(word, condition.parse(argument)))
        except (TypeError, ValueError, shapely.errors.ShapelyError) as error:
            raise ValueError(f"{word} takes {condition.expects}, not {argument!r}") from error
    return tuple(tests)


def folded(name: str) -> str:
    """A street name for comparing: no accents, case, hyphens, apostrophes or double spaces."""
    plain = unicodedata.normalize("NFKD", name)
    plain = "".join(" " if char in "-'’" else char for char in plain if not unicodedata.combining(char))
    return " ".join(plain.casefold().split())


def polygon(points: Any) -> shapely.Polygon:
    """A polygon from at least three [lon, lat] pairs in degrees.

    Raises:
        ValueError: too few points, some off the earth, or edges that cross.
    """
    corners = [(float(lon), float(lat)) for lon, lat in points]
    if len(corners) < 3:
        raise ValueError("a polygon has three corners or more")
    if not all(-180 <= lon <= 180 and -90 <= lat <= 90 for lon, lat in corners):
        raise ValueError("a corner is not on earth; write [lon, lat] in degrees")
    area = shapely.Polygon(corners)
    if not area.is_valid:
        raise ValueError("the polygon's edges cross")
    shapely.prepare(area)
    return area


# --- what stands beside the words ---------------------------------------------------------------------------


def _yes_or_no(value: Any) -> bool:
    if not isinstance(value, bool):
        raise TypeError
    return value


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
        raise TypeError
    return float(value)


def _words(value: Any) -> tuple[str, ...]:
    if not isinstance(value, list) or not value or not all(isinstance(word, str) for word in value):
        raise TypeError
    return tuple(value)


def _streets(value: Any) -> tuple[str, ...]:
    return tuple(folded(word) for word in _words(value))


def _phenomena(value: Any) -> frozenset[str]:
    found = frozenset(_words(value))
    if not found <= PHENOMENA:
        raise ValueError
    return found


def _month_day(text: str) -> tuple[int, int]:
    day = date.fromisoformat(f"2000-{text}")
    return day.month, day.day


def _season(value: Any) -> tuple[tuple[int, int], tuple[int, int]]:
    first, last = _words(value)
    return _month_day(first), _month_day(last)


def _hours(value: Any) -> tuple[time, time]:
    first, last = _words(value)
    return time.fromisoformat(first), time.fromisoformat(last)


def _weekdays(value: Any) -> frozenset[int]:
    days = frozenset(value)
    if not days or not days <= set(range(1, 8)):
        raise ValueError
    return days


def _date(value: Any) -> date:
    if not isinstance(value, date) or isinstance(value, datetime):
        raise TypeError
    return value


# --- when they hold -----------------------------------------------------------------------------------------


def _same(name: str) -> Callable[[Situation, Any], bool | None]:
    def holds(situation: Situation, wanted: bool) -> bool | None:
        actual = getattr(situation, name)
        return None if actual is None else bool(actual == wanted)

    return holds


def _inside(situation: Situation, area: shapely.Polygon) -> bool | None:
    if situation.lon_deg is None or situation.lat_deg is None:
        return None
    return bool(shapely.contains_xy(area, situation.lon_deg, situation.lat_deg))


def _on_street(situation: Situation, patterns: tuple[str, ...]) -> bool:
    street = folded(situation.street)
    return any(fnmatchcase(street, pattern) for pattern in patterns)


def _on_class(situation: Situation, classes: tuple[str, ...]) -> bool | None:
    return situation.road_class in classes if situation.road_class else None


def _in_season(situation: Situation, season: tuple[tuple[int, int], tuple[int, int]]) -> bool:
    first, last = season
    today = (situation.local_time.month, situation.local_time.day)
    return first <= today <= last if first <= last else today >= first or today <= last


def _in_hours(situation: Situation, hours: tuple[time, time]) -> bool:
    first, last = hours
    now = situation.local_time.time()
    return first <= now < last if first <= last else now >= first or now < last


def _in_weather(situation: Situation, wanted: frozenset[str]) -> bool | None:
    return None if situation.phenomena is None else not wanted.isdisjoint(situation.phenomena)


def _sees_less(situation: Situation, metres: float) -> bool | None:
    return None if situation.visibility_m is None else situation.visibility_m < metres


def _within(distance_m: float | None, metres: float) -> bool:
    return distance_m is not None and distance_m <= metres


CONDITIONS: dict[str, Condition] = {
    "built_up": Condition("true or false", _yes_or_no, _same("built_up"), fixed=True),
    "motorway": Condition("true or false", _yes_or_no, _same("motorway"), fixed=True),
    "dual_carriageway": Condition("true or false", _yes_or_no, _same("dual_carriageway"), fixed=True),
    "expressway": Condition("true or false", _yes_or_no, _same("expressway"), fixed=True),
    "centre_line": Condition("true or false", _yes_or_no, _same("centre_line"), fixed=True),
    "lanes_at_least": Condition("a number", _number, lambda now, lanes: now.lanes >= lanes, fixed=True),
    "lanes_at_most": Condition("a number", _number, lambda now, lanes: now.lanes <= lanes, fixed=True),
    "road_classes": Condition("a list of OSM highway values", _words, _on_class, fixed=True),
    "streets": Condition("a list of street names, * for any text", _streets, _on_street, fixed=True),
    "inside": Condition("a list of [lon, lat] corners", polygon, _inside, fixed=True),
    "season": Condition('["MM-DD", "MM-DD"], both included', _season, _in_season, fixed=True),
    "since": Condition("a date", _date, lambda now, day: now.local_time.date() >= day, fixed=True),
    "weekdays": Condition(
        "a list of 1 (Monday) to 7", _weekdays, lambda now, days: now.local_time.isoweekday() in days
    ),
    "hours": Condition('["HH:MM", "HH:MM"], the last excluded', _hours, _in_hours),
    "lit": Condition("true or false", _yes_or_no, _same("lit")),
    "tunnel": Condition("true or false", _yes_or_no, _same("tunnel")),
    "after_sunset": Condition("true or false", _yes_or_no, _same("after_sunset")),
    "standing": Condition("true or false", _yes_or_no, _same("standing")),
    "weather": Condition(f"a list of {', '.join(sorted(PHENOMENA))}", _phenomena, _in_weather),
    "visibility_below_m": Condition("metres", _number, _sees_less),
    "speed_above_kmh": Condition("km/h", _number, lambda now, kmh: now.speed_kmh > kmh),
    "oncoming_within_m": Condition("metres", _number, lambda now, m: _within(now.oncoming_m, m)),
    "leader_within_m": Condition("metres", _number, lambda now, m: _within(now.leader_m, m)),
}
"""Every word a ``when`` table may hold."""
