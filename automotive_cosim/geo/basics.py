"""What every driver has to know of a country: side of the road, units, emergency numbers, and the rules met daily.

``data/basics.csv`` has a row for each country and territory. A country without a file of rules has those of its
row; one with a file gets from its row the topics that its file lacks.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from datetime import date
from functools import cache
from importlib.resources import files

from automotive_cosim.geo.rulefacts import Test
from automotive_cosim.geo.rules import Case, Jurisdiction, Rule, Status

_STATUS = {"*": Status.SECONDARY, "?": Status.UNCERTAIN}
"""By the mark at the end of a cell."""
_READ = date(2023, 10, 21), "traffic law, on OpenStreetMap's wiki"
"""Date and name of the table from which limits marked as secondary were read."""
_WRITTEN = date(2026, 11, 25), "traffic law"
_UNKNOWN = "-"

_ROADS = {
    "motorway": ("on motorways", (Test("motorway", True),)),
    "town": ("in built-up areas", (Test("built_up", True),)),
    "rural": ("outside built-up areas", (Test("built_up", False),)),
}
"""In the order in which they rule each other out."""
_NAMES = {"motorway": "motorway", "town": "built_up", "rural": "rural"}
_WINTER = Test("season", ((11, 1), (3, 31)))
_OUT_OF_TOWN = Test("built_up", False)
_LAMPS = {
    "always": ("required at any time", ()),
    "rural": ("required outside built-up areas", (_OUT_OF_TOWN,)),
    "winter": ("required in winter", (_WINTER,)),
    "winter rural": ("required in winter outside built-up areas", (_WINTER, _OUT_OF_TOWN)),
}
_BELTS = {
    "all": ("on all seats", "required"),
    "front": ("on the front seats", "required"),
    "none": ("no law is known", "not_required"),
}
_PHONE = {"hand": ("forbidden in the hand", "forbidden"), "none": ("no law is known", "allowed")}


@dataclass(frozen=True, slots=True)
class Basics:
    """A row. Without a side, the country has a file that says side, units and numbers."""

    country: Jurisdiction
    """With its rules; of a country with a file, these are only the topics that its file may lack."""

    @property
    def is_whole(self) -> bool:
        """Whether it has all that a country needs."""
        return bool(self.country.driving_side)

    def completing(self, entry: Jurisdiction) -> Jurisdiction:
        """A country's own entry with the topics that it lacks, which are told on request only."""
        lacking = tuple(
            replace(rule, on_request=True) for rule in self.country.rules if rule.topic not in entry.by_topic
        )
        return replace(entry, rules=(*entry.rules, *lacking), by_topic={**entry.by_topic, **_by_topic(lacking)})


@cache
def basics_of(code: str) -> Basics | None:
    """The row of a country, by its ISO 3166-1 code; None without one."""
    row = rows().get(code)
    return None if row is None else Basics(_country(row))


@cache
def rows() -> Mapping[str, Mapping[str, str]]:
    """The cells of each row by the names of the columns, by ISO 3166-1 code."""
    text = files("automotive_cosim.geo.data").joinpath("basics.csv").read_text(encoding="utf-8")
    table = csv.DictReader(line for line in text.splitlines() if not line.startswith("#"))
    return {row["country"]: row for row in table}


def _country(row: Mapping[str, str]) -> Jurisdiction:
    speed, calls = _read(row["speed"]), _read(row["calls"])
    rules = tuple(_rules(row, speed[0]))
    return Jurisdiction(
        code=row["country"],
        name=row["name"],
        status=max((speed[1], calls[1]), key=[Status.SECONDARY, Status.KNOWLEDGE, Status.UNCERTAIN].index),
        driving_side=row["side"],
        speed_unit=speed[0],
        temperature_unit=row["temperature"],
        emergency=tuple(calls[0].split()),
        rules=rules,
        by_topic=_by_topic(rules),
    )


def _rules(row: Mapping[str, str], unit: str) -> Iterator[Rule]:
    code = row["country"]
    for road, (text, when) in _ROADS.items():
        limit, status = _read(row[road])
        if limit not in ("", _UNKNOWN):
            value = limit if limit == "none" else float(limit)
            case = Case(value, when)
            yield _rule(code, "limit", text, (case,), status, unit=unit, name=f"limit.{_NAMES[road]}")
    for topic, column, said in (("phone", "phone", _PHONE), ("seat_belts", "belts", _BELTS)):
        word, status = _read(row[column])
        if word:
            text, answer = said[word]
            yield _rule(code, topic, text, (Case(answer),), status)
    word, status = _read(row["lamps"])
    if word == "no":
        yield _rule(code, "daytime_lamps", "not required", (Case("not_required"),), status)
    elif word:
        text, tests = _LAMPS[word]
        cases = (Case("required", tests), Case("not_required")) if tests else (Case("required"),)
        yield _rule(code, "daytime_lamps", text, cases, status)
    figure, status = _read(row["alcohol"])
    if figure == _UNKNOWN:
        yield _rule(
            code, "alcohol", "driving under the influence; no figure is known", (Case("forbidden"),), status
        )
    elif figure:
        yield _rule(code, "alcohol", "at most", (Case(float(figure)),), status, unit="g/L")


def _rule(
    code: str, topic: str, text: str, cases: tuple[Case, ...], status: Status, *, unit: str = "", name: str = ""
) -> Rule:
    as_of, law = _READ if status is Status.SECONDARY else _WRITTEN
    return Rule(f"{code}.{name or topic}", topic, text, law, as_of, status, cases, unit)


def _read(cell: str) -> tuple[str, Status]:
    """A cell without its mark, and the status that the mark stands for."""
    return cell.rstrip("".join(_STATUS)), _STATUS.get(cell[-1:], Status.KNOWLEDGE)


def _by_topic(rules: Iterable[Rule]) -> dict[str, tuple[Rule, ...]]:
    found: dict[str, tuple[Rule, ...]] = {}
    for rule in rules:
        found[rule.topic] = (*found.get(rule.topic, ()), rule)
    return found
