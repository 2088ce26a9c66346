"""Limits on signs: a number with its unit, and limits at certain hours.

The words are OpenStreetMap's (wiki pages "Key:maxspeed" and "Conditional restrictions"):

    maxspeed              50        30 mph        none
    maxspeed:conditional  40 @ (Mo-Fr 08:00-09:30,14:30-16:00; SH off; PH off)

Conditions on weekdays and times of day are understood. ``SH off`` and ``PH off`` are accepted but ignored: there is
no calendar of holidays, so every Monday is a school day. A limit under any other condition (weather, axle load,
season, ...) is omitted and reported.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from automotive_cosim.contracts import KMH_PER_MPS, MPH_PER_MPS

_PER_MPS = {"": KMH_PER_MPS, "km/h": KMH_PER_MPS, "mph": MPH_PER_MPS}

_DAYS = ("Mo", "Tu", "We", "Th", "Fr", "Sa", "Su")
_DAY_MINUTES = 24 * 60

_CLAUSE = re.compile(r"([^@;]+)@\s*(\([^()]*\)|[^;()]+)\s*(?:;|$)")
_HOLIDAYS_OFF = re.compile(r"(?:PH|SH)(?:\s*,\s*(?:PH|SH))*\s+off")
_RULE = re.compile(r"(?P<days>[A-Z][a-z](?:[-,][A-Z][a-z])*)?\s*(?P<times>[\d:,\- ]+)?")
_SPAN = re.compile(r"(\d\d?):(\d\d)-(\d\d?):(\d\d)")


@dataclass(frozen=True, slots=True)
class TimedLimit:
    """A limit at certain hours."""

    limit_mps: float | None
    """The limit; None for no limit."""
    days: frozenset[int]
    """ISO weekdays: 1 is Monday."""
    spans: tuple[tuple[int, int], ...]
    """Minutes of the day, the last excluded. A span that ends no later than it begins runs past midnight and
    belongs to the day on which it begins."""
    text: str
    """In words: ``40 km/h Mo-Fr 08:00-09:30, 14:30-16:00``."""

    def holds(self, local_time: datetime) -> bool:
        """Whether it is in force at the local time."""
        minute, day = local_time.hour * 60 + local_time.minute, local_time.isoweekday()
        today, yesterday = day in self.days, (day + 5) % 7 + 1 in self.days
        for first, last in self.spans:
            if first < last:
                if today and first <= minute < last:
                    return True
            elif (today and minute >= first) or (yesterday and minute < last):
                return True
        return False


def in_force(limits: Sequence[TimedLimit], local_time: datetime) -> TimedLimit | None:
    """The limit in force now; of several, the last one, as in OpenStreetMap."""
    return next((limit for limit in reversed(limits) if limit.holds(local_time)), None)


def sign_mps(sign: str) -> float | None:
    """The speed of a sign (``"50"``, ``"30 mph"``); None for ``"none"``.

    Raises:
        ValueError: it is not a ``maxspeed``.
    """
    if sign == "none":
        return None
    number, _, unit = sign.partition(" ")
    if unit not in _PER_MPS or not re.fullmatch(r"\d+(\.\d+)?", number):
        raise ValueError(f'{sign!r} is not a maxspeed; write "50", "30 mph" or "none"')
    return float(number) / _PER_MPS[unit]


def timed_limits(conditional: str) -> tuple[tuple[TimedLimit, ...], tuple[str, ...]]:
    """Reads a ``maxspeed:conditional``.

    Returns:
        The limits by the clock, and the parts that were not understood, verbatim.
    """
    found: list[TimedLimit] = []
    unread: list[str] = []
    end = 0
    for clause in _CLAUSE.finditer(conditional):
        if conditional[end : clause.start()].strip(" ;"):
            unread.append(conditional[end : clause.start()].strip(" ;"))
        end = clause.end()
        try:
            found += _limits(clause[1].strip(), clause[2].strip(" ()"))
        except ValueError:
            unread.append(clause[0].strip(" ;"))
    if conditional[end:].strip(" ;"):
        unread.append(conditional[end:].strip(" ;"))
    return tuple(found), tuple(unread)


def _limits(sign: str, condition: str) -> list[TimedLimit]:
    limit_mps = sign_mps(sign)
    unit = "" if sign == "none" or " " in sign else " km/h"
    rules = [rule for rule in map(str.strip, condition.split(";")) if not _HOLIDAYS_OFF.fullmatch(rule)]
    if not rules:
        raise ValueError(condition)
    return [_limit(limit_mps, "no limit" if sign == "none" else sign + unit, rule) for rule in rules]


def _limit(limit_mps: float | None, sign: str, rule: str) -> TimedLimit:
    """One rule such as ``Mo-Fr 08:00-09:30,14:30-16:00``."""
    match = _RULE.fullmatch(rule)
    if match is None or not rule:
        raise ValueError(rule)
    days, times = match["days"] or "", (match["times"] or "").strip()
    spans = tuple(_span(span.strip()) for span in times.split(",")) if times else ((0, _DAY_MINUTES),)
    words = " ".join(part for part in (days.replace(",", ", "), re.sub(r"\s*,\s*", ", ", times)) if part)
    return TimedLimit(limit_mps, _weekdays(days), spans, f"{sign} {words}")


def _weekdays(text: str) -> frozenset[int]:
    if not text:
        return frozenset(range(1, 8))
    days: set[int] = set()
    for part in text.split(","):
        first, last = (_DAYS.index(day) for day in (part.split("-") * 2)[:2])
        days.update((first + step) % 7 + 1 for step in range((last - first) % 7 + 1))
    return frozenset(days)


def _span(text: str) -> tuple[int, int]:
    match = _SPAN.fullmatch(text)
    if match is None:
        raise ValueError(text)
    first, last = int(match[1]) * 60 + int(match[2]), int(match[3]) * 60 + int(match[4])
    if max(first, last) > _DAY_MINUTES or first == _DAY_MINUTES or int(match[2]) > 59 or int(match[4]) > 59:
        raise ValueError(text)
    return first, last
