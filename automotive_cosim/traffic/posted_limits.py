"""Limits on signs: a number with its unit, and what holds at certain hours, limits, access and turns.

The words are OpenStreetMap's (wiki pages "Key:maxspeed" and "Conditional restrictions"):

    maxspeed              50        30 mph        none
    maxspeed:conditional  40 @ (Mo-Fr 08:00-09:30,14:30-16:00; SH off; PH off)
    access:conditional    no @ (Mo-Fr 07:30-08:30)

Conditions on weekdays, times of day, dates, months and weeks are understood (of rules that a semicolon parts, the
last with a day decides about it, as in OpenStreetMap's opening hours), ``wet`` and ``snow``, which the weather of
the drive decides, and what never holds for the car (``OF_OTHERS``). Public and school holidays (``PH``, ``SH``) are
left out of them: there is no calendar of holidays, so every Monday is a school day; an import lists them
(``names_holidays``). What holds under any other condition (axle load, daylight, ...) is omitted and reported.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import date, datetime, timedelta

from automotive_cosim.contracts import KMH_PER_MPS, MPH_PER_MPS

_PER_MPS = {"": KMH_PER_MPS, "km/h": KMH_PER_MPS, "mph": MPH_PER_MPS}

_DAYS = ("Mo", "Tu", "We", "Th", "Fr", "Sa", "Su")
_DAY_MINUTES = 24 * 60
_WHOLE_DAY = ((0, _DAY_MINUTES),)

_MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")

WALK_KMH = 7.0
"""``maxspeed=walk``: walking pace as interpreted by German courts (StVO sign 325)."""

WEATHERS = {"wet": "when wet", "snow": "in snow"}
"""Conditions that the weather decides, and how they are said."""
OF_OTHERS = {
    "hgv": "for lorries",
    "arrow": "for the exit that its arrow shows",
    "lane arrow": "for the other lane, which its arrow shows",
}
"""Plates that never bind the car where it is, and how they are said; OpenStreetMap has no word for an arrow."""
_SAID = WEATHERS | OF_OTHERS

_CLAUSE = re.compile(r"([^@;]+)@\s*(\([^()]*\)|[^;()]+)\s*(?:;|$)")
_SIGN = re.compile(r"(\d+(?:\.\d+)?)\s*(km/h|kmh|kph|mph)?", re.IGNORECASE)
_DAY = "(?:Mo|Tu|We|Th|Fr|Sa|Su)"
_HOLIDAY = "(?:PH|SH)"
_HOLIDAYS = re.compile(rf"{_HOLIDAY}(?:\s*,\s*{_HOLIDAY})*(?:\s+(?!{_DAY}).*)?|{_HOLIDAY}\s+{_DAY}.*")
"""A rule for holidays alone."""
_AND_HOLIDAYS = re.compile(rf"(?<=[a-z])\s*,\s*{_HOLIDAY}\b|\b{_HOLIDAY}\s*,\s*(?={_DAY})")
"""Holidays among weekdays."""
_MONTH = f"(?:{'|'.join(_MONTHS)})"
_OF_MONTH = r"\d\d?(?!\d|:\d)"
"""A day of a month; before minutes, it is the hour."""
_DATES = rf"{_MONTH}(?: {_OF_MONTH})?(?:-(?:{_MONTH}(?: {_OF_MONTH})?|{_OF_MONTH}))?"
_WEEKS = r"\d\d?(?:-\d\d?(?:/\d\d?)?)?"
_RULE = re.compile(
    rf"(?:week (?P<weeks>{_WEEKS}(?:\s*,\s*{_WEEKS})*)\s*)?(?P<dates>{_DATES})?:?\s*"
    rf"(?P<days>{_DAY}(?:[-,]\s*{_DAY})*)?:?\s*(?P<times>24/7|[\d:,\- ]+)?"
)
_DAYS_ONE = re.compile(_DAY)
_DASH = re.compile(r"\s*[-–]\s*")
_NTH = re.compile(r"(?<=[a-z])\[((?:-1|[1-5])(?:,(?:-1|[1-5]))*)\]")
"""Which of a weekday in a month: ``Su[1]`` is the first Sunday."""
_SEASONS = re.compile(rf"(?P<seasons>{_DATES}(?:\s*,\s*{_DATES})+)(?::?\s+(?P<rest>.+))?")
_NEXT_RULE = re.compile(rf"(?<=\d)\s*,\s*(?={_DAY}\b)")
"""Where a comma parts two rules: after a time, before a day (``Mo-Fr 07:00-17:00, Sa 08:00-12:00``)."""
_SPAN = re.compile(r"(\d\d?):(\d\d)-(\d\d?):(\d\d)")

Day = tuple[int, int]
"""A month and a day of it."""


@dataclass(frozen=True, slots=True)
class Hours:
    """When something on a sign holds."""

    days: frozenset[int]
    """ISO weekdays: 1 is Monday."""
    spans: tuple[tuple[int, int], ...]
    """Minutes of the day, the last excluded. A span that ends no later than it begins runs past midnight and
    belongs to the day on which it begins."""
    text: str
    """In words: ``Mo-Fr 08:00-09:30, 14:30-16:00``."""
    dates: tuple[Day, Day] = ((1, 1), (12, 31))
    """The first and the last day of the year on which it holds; the last may be in the next year."""
    weather: str = ""
    """A key of ``WEATHERS`` if it holds in that weather only; of ``OF_OTHERS`` if never for the car."""
    weeks: frozenset[int] = frozenset()
    """Which of these weekdays of a month, if not all: 1 is the first, -1 the last."""
    iso_weeks: frozenset[int] = frozenset()
    """The weeks of the year by ISO 8601, if not all."""
    unless: tuple[Hours, ...] = ()
    """Rules after it: on a day on which one of them holds, this one does not, nor does its night before."""

    def holds(self, local_time: datetime, weather: str = "") -> bool:
        """Whether it is in force at the local time, in a weather of ``WEATHERS`` or none of them."""
        return self.weather in ("", weather) and self._holds_at(local_time)

    def _holds_at(self, local_time: datetime) -> bool:
        minute, day = local_time.hour * 60 + local_time.minute, local_time.date()
        if any(later._has(day) for later in self.unless):
            return False
        today, yesterday = self._has(day), self._has(day - timedelta(days=1))
        for first, last in self.spans:
            if first < last:
                if today and first <= minute < last:
                    return True
            elif (today and minute >= first) or (yesterday and minute < last):
                return True
        return False

    def _has(self, day: date) -> bool:
        if not _is_within(day, self.dates) or day.isoweekday() not in self.days:
            return False
        if self.iso_weeks and day.isocalendar().week not in self.iso_weeks:
            return False
        is_last = (day + timedelta(days=7)).month != day.month
        return not self.weeks or (day.day - 1) // 7 + 1 in self.weeks or (is_last and -1 in self.weeks)


def _is_within(day: date, dates: tuple[Day, Day]) -> bool:
    """Whether a day is from the first of two dates to the last, which may be in the next year."""
    (first, last), today = dates, (day.month, day.day)
    return first <= today <= last if first <= last else today >= first or today <= last


@dataclass(frozen=True, slots=True)
class TimedLimit:
    """A limit at certain hours."""

    limit_mps: float | None
    """The limit; None for no limit."""
    hours: Hours
    text: str
    """In words: ``40 km/h Mo-Fr 08:00-09:30, 14:30-16:00``."""

    def holds(self, local_time: datetime, weather: str = "") -> bool:
        """Whether it is in force (``Hours.holds``)."""
        return self.hours.holds(local_time, weather)


@dataclass(frozen=True, slots=True)
class TimedAccess:
    """Whether cars may pass at certain hours."""

    is_open: bool
    hours: Hours


def in_force(limits: Sequence[TimedLimit], local_time: datetime, weather: str = "") -> TimedLimit | None:
    """The limit in force now; of several, the last one, as in OpenStreetMap."""
    return next((limit for limit in reversed(limits) if limit.holds(local_time, weather)), None)


def sign_mps(sign: str) -> float | None:
    """The speed of a sign (``"50"``, ``"30 mph"``); None for ``"none"``.

    Raises ValueError: it is not a ``maxspeed``."""
    if sign == "none":
        return None
    number, _, unit = sign.partition(" ")
    if unit not in _PER_MPS or not re.fullmatch(r"\d+(\.\d+)?", number):
        raise ValueError(f'{sign!r} is not a maxspeed; write "50", "30 mph" or "none"')
    return float(number) / _PER_MPS[unit]


def timed_limits(conditional: str) -> tuple[tuple[TimedLimit, ...], tuple[str, ...]]:
    """Reads a ``maxspeed:conditional``.

    Returns:
        The limits by the clock, and the parts that were not understood, verbatim."""
    found: list[TimedLimit] = []
    unread: list[str] = []
    for sign, condition, text in clauses(conditional):
        try:
            limit_mps, shown = _read_sign(sign)
            found += (
                TimedLimit(limit_mps, hours, f"{shown} {hours.text}".strip()) for hours in read_hours(condition)
            )
        except ValueError:
            unread.append(text)
    return tuple(found), tuple(unread)


def timed_access(conditional: str) -> tuple[TimedAccess, ...]:
    """Reads ``yes`` and ``no`` at certain hours, as an import writes them; anything else counts for nothing."""
    found: list[TimedAccess] = []
    for value, condition, _ in clauses(conditional):
        if value in ("yes", "no") and is_understood(condition):
            found += (TimedAccess(value == "yes", hours) for hours in read_hours(condition))
    return tuple(found)


def is_open(access: Sequence[TimedAccess], local_time: datetime, weather: str = "") -> bool:
    """Whether cars may pass now: the last that holds decides, as in OpenStreetMap; without any they may."""
    return next((each.is_open for each in reversed(access) if each.hours.holds(local_time, weather)), True)


def clauses(conditional: str) -> Iterator[tuple[str, str, str]]:
    """The value, the condition and the text of each ``value @ condition``; without both for what is none."""
    end = 0
    for clause in _CLAUSE.finditer(conditional):
        if between := conditional[end : clause.start()].strip(" ;"):
            yield "", "", between
        end = clause.end()
        yield clause[1].strip(), clause[2].strip(" ()"), clause[0].strip(" ;")
    if rest := conditional[end:].strip(" ;"):
        yield "", "", rest


def is_understood(condition: str) -> bool:
    """Whether a condition can be read (``read_hours``)."""
    try:
        read_hours(condition)
    except ValueError:
        return False
    return True


def read_hours(condition: str) -> list[Hours]:
    """When a condition holds: at any of these.

    Raises ValueError: it is none on the clock, the calendar or the weather."""
    condition, weather = _weather(_AND_HOLIDAYS.sub("", _DASH.sub("-", condition)))
    found: list[Hours] = []
    later: list[Hours] = []
    off: list[str] = []
    for text in reversed(list(map(str.strip, condition.split(";")))):
        rules = [part for part in _NEXT_RULE.split(text) if part and not _HOLIDAYS.fullmatch(part)]
        is_off = any(rule.endswith(" off") for rule in rules)
        seasons = [each for rule in rules for each in _by_season(rule.removesuffix(" off"))]
        read = [replace(_hours(each, off, weather), unless=tuple(later)) for each in seasons]
        if is_off and (len(rules) > 1 or any(hours.spans != _WHOLE_DAY for hours in read)):
            raise ValueError(condition)
        off[:0] = [rule.removesuffix(" off").strip() for rule in rules if is_off]
        found[:0] = [] if is_off else read
        later[:0] = read
    if not found and (later or not weather):
        raise ValueError(condition)
    return found or [_hours("24/7", (), weather)]


def names_holidays(condition: str) -> bool:
    """Whether a condition is about public or school holidays."""
    return re.search(rf"\b{_HOLIDAY}\b", condition) is not None


def _read_sign(sign: str) -> tuple[float | None, str]:
    """The speed of a sign as mappers write it, and how it is said."""
    if sign == "none":
        return None, "no limit"
    if sign == "walk":
        return WALK_KMH / KMH_PER_MPS, "walking pace"
    match = _SIGN.fullmatch(sign)
    if match is None:
        raise ValueError(sign)
    unit = "mph" if (match[2] or "").lower() == "mph" else "km/h"
    return float(match[1]) / _PER_MPS[unit], f"{match[1]} {unit}"


def _weather(condition: str) -> tuple[str, str]:
    """A condition without the weather, or whom it is for, in it (``22:00-06:00 AND wet``), and that."""
    parts = [part.strip() for part in condition.split(" AND ")]
    found = [part for part in parts if part in _SAID]
    rest = [part for part in parts if part not in _SAID]
    if len(found) > 1 or len(rest) > 1:
        raise ValueError(condition)
    return "".join(rest), "".join(found)


def _by_season(rule: str) -> Iterator[str]:
    """A rule for each of its parts of the year (``Jan-Mar,Oct-Dec Su 10:00-17:00``)."""
    match = _SEASONS.fullmatch(rule)
    if match is None:
        yield rule
    else:
        yield from (f"{season.strip()} {match['rest'] or ''}" for season in match["seasons"].split(","))


def _hours(rule: str, off: Sequence[str], weather: str) -> Hours:
    """One rule such as ``Mo-Fr 08:00-09:30,14:30-16:00``; ``off`` are the days of the rules that except some."""
    rule = rule.strip()
    nth = _NTH.search(rule)
    match = _RULE.fullmatch(rule[: nth.start()] + rule[nth.end() :] if nth else rule)
    if match is None or not rule or (nth is not None and not _DAYS_ONE.fullmatch(match["days"] or "")):
        raise ValueError(rule)
    dates, days = match["dates"] or "", re.sub(r"\s", "", match["days"] or "")
    times = (match["times"] or "").strip().removeprefix("24/7")
    spans = tuple(_span(span.strip()) for span in times.split(",")) if times else _WHOLE_DAY
    times_said = re.sub(r"\s*,\s*", ", ", times)
    but = f"but {', '.join(off)}" if off else ""
    said = days.replace(",", ", ") + (nth[0] if nth else "")
    of_year = f"week {match['weeks']}" if match["weeks"] else ""
    words = " ".join(part for part in (of_year, dates, said, times_said, but, _SAID.get(weather, "")) if part)
    weeks = frozenset(map(int, nth[1].split(","))) if nth else frozenset[int]()
    return Hours(_weekdays(days), spans, words, _dates(dates), weather, weeks, _iso_weeks(match["weeks"] or ""))


def _iso_weeks(text: str) -> frozenset[int]:
    """``10-20``, ``1-53/2``, ``1,3,5``."""
    found: set[int] = set()
    for part in filter(None, map(str.strip, text.split(","))):
        span, _, step = part.partition("/")
        first, _, last = span.partition("-")
        if not (1 <= int(first) <= int(last or first) <= 53 and int(step or 1) > 0):
            raise ValueError(text)
        found.update(range(int(first), int(last or first) + 1, int(step or 1)))
    return frozenset(found)


def _dates(text: str) -> tuple[Day, Day]:
    """``Apr-Oct``, ``Nov 15-Mar 15``, ``Dec 24-26``, ``May``; the whole year for none."""
    if not text:
        return (1, 1), (12, 31)
    first, _, last = text.partition("-")
    month, _, day = first.partition(" ")
    start = (_MONTHS.index(month) + 1, int(day or 1))
    if last.isdecimal():
        end = (start[0], int(last))
    elif last:
        month, _, day = last.partition(" ")
        end = (_MONTHS.index(month) + 1, int(day or 31))
    else:
        end = (start[0], int(day or 31))
    if not all(1 <= each[1] <= 31 for each in (start, end)):
        raise ValueError(text)
    return start, end


def _weekdays(text: str) -> frozenset[int]:
    if not text:
        return frozenset(range(1, 8))
    days: set[int] = set()
    for part in re.sub(r"\s", "", text).split(","):
        first, last = (_DAYS.index(day) for day in (part.split("-") * 2)[:2])
        days.update((first + step) % 7 + 1 for step in range((last - first) % 7 + 1))
    return frozenset(days)


def _span(text: str) -> tuple[int, int]:
    match = _SPAN.fullmatch(text)
    if match is None:
        raise ValueError(text)
    first, last = int(match[1]) * 60 + int(match[2]), int(match[3]) * 60 + int(match[4])
    if first + _DAY_MINUTES >= last > _DAY_MINUTES:  # 22:00-26:00
        last -= _DAY_MINUTES
    if max(first, last) > _DAY_MINUTES or first == _DAY_MINUTES or int(match[2]) > 59 or int(match[4]) > 59:
        raise ValueError(text)
    return first, last
