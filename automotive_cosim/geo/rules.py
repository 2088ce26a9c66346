"""Traffic rules as data: one TOML file per country, region and city, in ``data/`` or in a folder of the user's own.

    [jurisdiction]
    code = "FR"                      # ISO 3166-1; a region or city: FR-paris, with within = "FR" and a polygon
    name = "France"
    ...                              # the fields of ``Jurisdiction``

    [[rules]]
    id = "FR.rear_fog"               # begins with the code
    topic = "rear_fog"               # a word of TOPICS
    text = "in fog or snow only"     # the rule in words, as the context prints it
    law = "Code de la route R416-7"
    as_of = 2026-03-31               # the text of this day was looked at
    status = "verified"              # or secondary (press, trade), knowledge (not looked up), uncertain (open)
    cases = [                        # the first case whose conditions hold is the rule's answer
        { value = "allowed", when = { weather = ["fog", "snow"] } },
        { value = "forbidden" },
    ]

A rule with a single case writes ``value`` and ``when`` straight into its table. Within a topic the rules stand from
the exception to the general, and city goes before region before country.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from datetime import date, datetime
from enum import StrEnum
from functools import lru_cache
from math import isfinite
from pathlib import Path
from typing import Any

import shapely

from automotive_cosim.errors import GeoDataError, UnknownNameError
from automotive_cosim.geo.situation import Situation, Test, all_hold, parse_when, polygon

Value = float | str


class Status(StrEnum):
    """How far a rule is to be trusted."""

    VERIFIED = "verified"
    """The law's own text was read."""
    SECONDARY = "secondary"
    """Press, trade or authority's summary."""
    KNOWLEDGE = "knowledge"
    """General knowledge, not looked up."""
    UNCERTAIN = "uncertain"
    """Known to be open: pending, annulled, contradictory."""


TOPICS = {
    "limit": "Default limit",
    "advisory_limit": "Advised speed",
    "dipped_beam": "Dipped beam",
    "daytime_lamps": "Daytime lamps",
    "high_beam": "High beam",
    "front_fog": "Front fog lamps",
    "rear_fog": "Rear fog lamp",
    "hazard_lights": "Hazard lights",
    "horn": "Horn",
    "following_distance": "Following distance",
    "phone": "Phone in hand",
    "screens": "Screens",
    "camera_warner": "Speed camera warners",
    "emergency_corridor": "Emergency corridor",
    "yield_emergency": "Emergency vehicles",
    "move_over": "Passing a stopped vehicle",
    "turn_on_red": "Turning on red",
    "bus_lane": "Bus lanes",
    "through_traffic": "Through traffic",
    "low_emission": "Low-emission zone",
    "school_zone": "School zones",
    "toll": "Tolls",
    "winter_tyres": "Winter equipment",
    "studs": "Studded tyres",
    "idling": "Engine at a standstill",
    "alcohol": "Blood alcohol limit",
    "heat": "Custom when hot",
    "cold": "Custom when cold",
}
"""Every topic a rule may have, and how the context prints it. The order is the context's. ``heat`` and ``cold``
hold what people do in their cars there, with ``law = "custom"``."""

ANSWERS = frozenset(("required", "allowed", "forbidden", "not_required", "advised", "applies"))
"""What a rule's value may be beside a number with a unit; a limit may be ``none`` as well."""

UNITS = frozenset(("km/h", "mph", "s", "m", "g/L", "min"))

USERS = frozenset(("car", "novice", "professional", "truck", "motorcycle"))
"""Whom a rule binds. The context states those for the ordinary driver of a car."""


@dataclass(frozen=True, slots=True)
class Case:
    """A rule's answer under conditions that must all hold."""

    value: Value
    when: tuple[Test, ...] = ()


@dataclass(frozen=True, slots=True)
class Rule:
    """One statement of the law."""

    id: str
    topic: str
    text: str
    law: str
    as_of: date
    status: Status
    cases: tuple[Case, ...]
    unit: str = ""
    binds: str = "car"
    caps: bool = False
    """Of a limit: it also lowers a higher limit that a sign states."""

    @property
    def country(self) -> str:
        """ISO 3166-1 code."""
        return self.id[:2]

    @property
    def fixed(self) -> bool:
        """Whether its answer depends on place, road and date alone."""
        return all(test.fixed for test in self.tests)

    @property
    def tests(self) -> Iterator[Test]:
        """The conditions of all its cases."""
        return (test for case in self.cases for test in case.when)

    def answer(self, situation: Situation) -> tuple[Value | None, bool]:
        """What the rule says here and now.

        Returns:
            (value, certain). (None, True): it does not apply. With certain False the situation does not tell
            which case it is, and the value is the first possible one.
        """
        for case in self.cases:
            holds = all_hold(case.when, situation)
            if holds is not False:
                return case.value, bool(holds)
        return None, True

    def may_apply(self, situation: Situation) -> bool | None:
        """Whether place, road and date leave a case open: True, False, or None where they do not tell."""
        found: bool | None = False
        for case in self.cases:
            holds = all_hold(tuple(test for test in case.when if test.fixed), situation)
            if holds:
                return True
            found = None if holds is None else found
        return found


@dataclass(frozen=True, slots=True)
class Jurisdiction:
    """A country, region or city with its rules in the order of the file."""

    code: str
    name: str
    status: Status
    """Of the fields here that are not rules."""
    within: str = ""
    """The country's code; empty for a country."""
    kind: str = "country"
    area: shapely.Polygon | None = None
    driving_side: str = ""
    """``"left"`` or ``"right"``; empty in a region or city, like the three below."""
    speed_unit: str = ""
    temperature_unit: str = ""
    emergency: tuple[str, ...] = ()
    """Telephone numbers, the general one first."""
    rules: tuple[Rule, ...] = ()
    by_topic: Mapping[str, tuple[Rule, ...]] = field(default_factory=dict, compare=False)
    """The rules that bind the driver of a car, in the order of the file."""


def read_jurisdiction(path: Path) -> Jurisdiction:
    """Reads and checks one file.

    Raises:
        GeoDataError: with file, line of the entry, and reason.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise GeoDataError(f"{path}: {error}") from error
    return _parsed(text, path)


@lru_cache(maxsize=256)
def _parsed(text: str, path: Path) -> Jurisdiction:
    """Of a file's text, which is parsed once in a process: that takes longer than a second of simulation."""
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise GeoDataError(f"{path}: {error}") from error
    entry = f"{path} [jurisdiction]"
    try:
        _only(table, {"jurisdiction", "rules"})
        head = _jurisdiction(_get(table, "jurisdiction", dict))
        rules: dict[str, Rule] = {}
        for row, line in zip(_rows(table), _entry_lines(text), strict=False):
            entry = f"{path} line {line} [[rules]] {row.get('id', 'without id')}"
            rule = _rule(row, head["code"])
            if rule.id in rules:
                raise ValueError("this id stands twice in the file")
            rules[rule.id] = rule
    except (ValueError, TypeError, UnknownNameError) as error:
        raise GeoDataError(f"{entry}: {error}") from error
    by_topic: dict[str, tuple[Rule, ...]] = {}
    for rule in rules.values():
        if rule.binds == "car":
            by_topic[rule.topic] = (*by_topic.get(rule.topic, ()), rule)
    return Jurisdiction(**head, rules=tuple(rules.values()), by_topic=by_topic)


def _rows(table: dict[str, Any]) -> list[dict[str, Any]]:
    rows = table.get("rules", [])
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise ValueError("rules are written as [[rules]] entries")
    return rows


def _entry_lines(text: str) -> Iterator[str]:
    """The line numbers of the ``[[rules]]`` entries, and question marks for rules written in another form."""
    for number, line in enumerate(text.splitlines(), 1):
        if line.split("#")[0].strip() == "[[rules]]":
            yield str(number)
    while True:
        yield "?"


def _jurisdiction(table: dict[str, Any]) -> dict[str, Any]:
    code = _get(table, "code", str)
    head: dict[str, Any] = {
        "code": code,
        "name": _line(table, "name"),
        "status": Status(_get(table, "status", str)),
    }
    if len(code) == 2:
        _only(table, {*head, "driving_side", "speed_unit", "temperature_unit", "emergency"})
        return head | {
            "driving_side": _one_of(table, "driving_side", ("left", "right")),
            "speed_unit": _one_of(table, "speed_unit", ("km/h", "mph")),
            "temperature_unit": _one_of(table, "temperature_unit", ("C", "F")),
            "emergency": tuple(str(number) for number in _get(table, "emergency", list)),
        }
    _only(table, {*head, "within", "kind", "polygon"})
    within = _get(table, "within", str)
    if not code.startswith(f"{within}-") or len(within) != 2:
        raise ValueError(f"code {code!r} does not begin with within = {within!r} and a hyphen")
    area = polygon(_get(table, "polygon", list))
    return head | {"within": within, "kind": _one_of(table, "kind", ("region", "city")), "area": area}


def _rule(row: dict[str, Any], code: str) -> Rule:
    _only(
        row,
        {"id", "topic", "text", "law", "as_of", "status", "cases", "value", "when", "unit", "binds", "caps"},
    )
    rule = Rule(
        id=_get(row, "id", str),
        topic=_get(row, "topic", str),
        text=_line(row, "text"),
        law=_line(row, "law"),
        as_of=_day(row),
        status=Status(_get(row, "status", str)),
        cases=_cases(row),
        unit=_get({"unit": ""} | row, "unit", str),
        binds=_get({"binds": "car"} | row, "binds", str),
        caps=row.get("caps") is True,
    )
    if row.get("caps", True) is not True:
        raise ValueError(f"caps = {row['caps']!r} is not true; leave it out where it does not hold")
    if not rule.id.startswith(f"{code}."):
        raise ValueError(f"its id does not begin with '{code}.'")
    if rule.topic not in TOPICS:
        raise UnknownNameError("topic", rule.topic, TOPICS)
    if rule.binds not in USERS:
        raise UnknownNameError("road user", rule.binds, USERS)
    if rule.topic == "limit" and len(rule.cases) != 1:
        raise ValueError("each limit is a rule of its own, with value and when")
    for case in rule.cases:
        _check_value(case.value, rule)
    return rule


def _cases(row: dict[str, Any]) -> tuple[Case, ...]:
    if ("cases" in row) == ("value" in row):
        raise ValueError("it needs either value (with when) or cases")
    if "value" in row:
        return (_case({key: row[key] for key in ("value", "when") if key in row}),)
    if "when" in row:
        raise ValueError("when stands inside each case")
    cases = _get(row, "cases", list)
    if not cases or not all(isinstance(case, dict) for case in cases):
        raise ValueError("cases is a list of tables with value and when")
    return tuple(_case(case) for case in cases)


def _case(table: dict[str, Any]) -> Case:
    _only(table, {"value", "when"})
    value = table["value"] if isinstance(table.get("value"), str) else float(_get(table, "value", (int, float)))
    return Case(value, parse_when(table.get("when", {})))


def _check_value(value: Value, rule: Rule) -> None:
    if not isinstance(value, str):
        if rule.unit not in UNITS:
            raise UnknownNameError("unit", rule.unit, UNITS)
        if not isfinite(value) or value < 0 or (rule.topic == "limit" and value == 0):
            raise ValueError(f"value {value:g} is too small, or no number")
    elif rule.topic == "limit":
        if value != "none":
            raise ValueError(f"a limit is a number or 'none', not {value!r}")
    elif value not in ANSWERS:
        raise UnknownNameError("value", value, ANSWERS)


def _line(table: Mapping[str, Any], name: str) -> str:
    text = str(_get(table, name, str))
    if not text.strip() or not text.isprintable():
        raise ValueError(f"{name} = {text!r} is no line of text")
    return text


def _day(row: dict[str, Any]) -> date:
    day = _get(row, "as_of", date)
    if isinstance(day, datetime):
        raise ValueError(f"as_of = {day} is a date with a time; write the date alone")
    return date(day.year, day.month, day.day)


def _get(table: Mapping[str, Any], name: str, kind: type | tuple[type, ...]) -> Any:
    if name not in table:
        raise ValueError(f"it lacks {name!r}")
    if not isinstance(table[name], kind) or isinstance(table[name], bool):
        raise ValueError(f"{name} = {table[name]!r} has the wrong type")
    return table[name]


def _one_of(table: Mapping[str, Any], name: str, choices: tuple[str, ...]) -> str:
    value = _get(table, name, str)
    if value not in choices:
        raise ValueError(f"{name} = {value!r} is none of {', '.join(choices)}")
    return str(value)


def _only(table: Mapping[str, Any], known: set[str]) -> None:
    for name in table:
        if name not in known:
            raise UnknownNameError("field", str(name), known)
