"""Reads rule files: one TOML file per country, region and city, in ``data/`` or in a folder of the user's own.

    [jurisdiction]
    code = "FR"                      # ISO 3166-1; a region or city: FR-paris, with within = "FR" and a polygon
    name = "France"
    ...                              # the fields of ``CountryEntry`` or ``RegionEntry``

    [[rules]]
    id = "FR.rear_fog"               # begins with the code
    topic = "rear_fog"               # a word of TOPICS
    text = "in fog or snow only"     # the rule in words, as the context prints it
    law = "Code de la route R416-7"
    as_of = 2026-03-31               # the version of this day was read
    status = "verified"              # or secondary (press, trade), knowledge (not looked up), uncertain (open)
    cases = [                        # the first case whose conditions hold is the rule's answer
        { value = "allowed", when = { weather = ["fog", "snow"] } },
        { value = "forbidden" },
    ]

A rule with a single case writes ``value`` and ``when`` straight into its table. Within a topic, exceptions come
before the general rule, and city before region before country.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from datetime import date
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from annotated_types import Ge, MinLen

from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats.annotations import Called, Chosen, Form, Made, OneOf
from automotive_cosim.formats.files import read_text
from automotive_cosim.formats.toml import parse
from automotive_cosim.geo.rulefacts import AreaPolygon, Test, When
from automotive_cosim.geo.rules import ANSWERS, TOPICS, UNITS, USERS, Case, Jurisdiction, Rule, Status, Value

if TYPE_CHECKING:
    from pydantic import GetJsonSchemaHandler
    from pydantic_core import CoreSchema


def _line(text: str) -> str:
    if not text.strip() or not text.isprintable():
        raise ValueError("it must be one line of text")
    return text


TextLine = Annotated[str, Made(str, _line)]
Amount = Annotated[float, Ge(0)] | Annotated[str, OneOf(sorted((*ANSWERS, "none")))]


@dataclass(frozen=True, slots=True, kw_only=True)
class CaseEntry:
    """One of a rule's ``cases``: its answer while all conditions hold."""

    value: Amount
    """A number in the rule's unit, or an answer such as ``allowed``."""
    when: When | None = None
    """Conditions that must all hold; without it, the case always applies."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RuleEntry:
    """``[[rules]]``: one statement of the law, with either ``value`` (and ``when``) or ``cases``."""

    id: str
    """Begins with the file's code and a dot: ``"FR.rear_fog"``."""
    topic: Annotated[str, OneOf(TOPICS)]
    """The topic of the rule."""
    text: TextLine
    """The rule in words, as the context prints it."""
    law: TextLine
    """Act and section; ``"custom"`` for a custom."""
    as_of: date
    """Date of the version that was read."""
    status: Annotated[Status, OneOf(Status)]
    """How well the rule is supported."""
    value: Amount | None = None
    """The only case's answer: a number in ``unit``, or an answer such as ``allowed``; a limit may be ``"none"``."""
    when: When | None = None
    """The only case's conditions, which must all hold."""
    cases: Annotated[tuple[CaseEntry, ...], MinLen(1)] | None = None
    """The cases; the first whose conditions hold gives the answer."""
    unit: Annotated[str, OneOf(sorted(UNITS))] | None = None
    """Unit of a number."""
    binds: Annotated[str, OneOf(sorted(USERS), "road user")] = "car"
    """The road user that the rule binds."""
    caps: Literal[True] | None = None
    """For a limit: it also lowers a higher limit posted by a sign. Omitted if it does not."""

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> Json:
        made = handler.resolve_ref_schema(handler(schema))
        value, when, cases = ({"required": [name]} for name in ("value", "when", "cases"))
        made["oneOf"] = [value | {"not": cases}, cases | {"not": {"anyOf": [value, when]}}]
        return made

    def __post_init__(self) -> None:
        if (self.value is None) == (self.cases is None):
            raise ValueError("it requires either value (with when) or cases")
        if self.cases is not None and self.when is not None:
            raise ValueError("put when inside each case")
        if self.topic == "limit" and self.cases is not None and len(self.cases) != 1:
            raise ValueError("each limit needs a separate rule, with value and when")
        for value, _ in self.answers:
            if isinstance(value, str) and (value == "none") != (self.topic == "limit"):
                raise ValueError(f"value is {value!r}; a limit is a number or 'none', and no other rule is 'none'")
            if not isinstance(value, str) and self.unit is None:
                raise ValueError(f"value is {value:g}; a number requires a unit, one of {', '.join(sorted(UNITS))}")
            if value == 0 and self.topic == "limit":
                raise ValueError("value is 0; a limit is above 0")

    @property
    def answers(self) -> Iterator[tuple[Value, tuple[Test, ...]]]:
        """Each case's value and conditions."""
        if self.value is not None:
            yield self.value, self.when or ()
        for case in self.cases or ():
            yield case.value, case.when or ()

    @property
    def rule(self) -> Rule:
        """The rule for the program."""
        return Rule(
            id=self.id,
            topic=self.topic,
            text=self.text,
            law=self.law,
            as_of=self.as_of,
            status=self.status,
            cases=tuple(Case(value, when) for value, when in self.answers),
            unit=self.unit or "",
            binds=self.binds,
            caps=self.caps is True,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class CountryEntry:
    """``[jurisdiction]`` of a country."""

    code: Annotated[str, Form(r"^[A-Z]{2}$", "FR")]
    """ISO 3166-1, the name of the file."""
    name: TextLine
    """In English, as the context prints it."""
    status: Annotated[Status, OneOf(Status)]
    """Status of the fields here that are not rules."""
    driving_side: Literal["left", "right"]
    speed_unit: Literal["km/h", "mph"]
    temperature_unit: Literal["C", "F"]
    emergency: tuple[str, ...]
    """Telephone numbers, the general one first."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RegionEntry:
    """``[jurisdiction]`` of a region or city."""

    code: Annotated[str, Form(r"^[A-Z]{2}-\w+$", "FR-paris")]
    """The country's code, a hyphen and a word; the name of the file."""
    name: TextLine
    """In English, as the context prints it."""
    status: Annotated[Status, OneOf(Status)]
    """Status of the fields here that are not rules."""
    within: Annotated[str, Form(r"^[A-Z]{2}$", "FR")]
    """The country's code."""
    kind: Literal["region", "city"]
    polygon: AreaPolygon
    """Its outline, as at least three [lon, lat] corners in degrees."""

    def __post_init__(self) -> None:
        if not self.code.startswith(f"{self.within}-"):
            raise ValueError(f"code {self.code!r} does not begin with within = {self.within!r} and a hyphen")


def _kind_of(table: Mapping[str, Any]) -> type:
    return RegionEntry if "-" in str(table.get("code", "")) else CountryEntry


@dataclass(frozen=True, slots=True, kw_only=True)
class RuleFile:
    """Traffic rules of one country, region or city."""

    jurisdiction: Annotated[CountryEntry | RegionEntry, Chosen(_kind_of)]
    """The place whose rules they are."""
    rules: Annotated[tuple[RuleEntry, ...], Called("a list of [[rules]] entries")] = ()
    """The rules; within a topic, exceptions come before the general rule."""


def read_jurisdiction(path: Path) -> Jurisdiction:
    """Reads and checks one file; the result is cached until the file changes.

    Raises UserError: with file, line of the entry, and reason."""
    return _read(read_text(path, UserError), path)


@lru_cache(maxsize=256)
def _read(text: str, path: Path) -> Jurisdiction:
    """Of a file's text, which is parsed once in a process: that takes longer than a second of simulation."""
    document = parse(text, path, UserError)
    file = document.read(RuleFile)
    head = file.jurisdiction
    ids: set[str] = set()
    for index, entry in enumerate(file.rules):
        if not entry.id.startswith(f"{head.code}."):
            raise document.refused(("rules", index, "id"), f"is {entry.id!r}; it must begin with '{head.code}.'")
        if entry.id in ids:
            raise document.refused(("rules", index, "id"), "occurs twice in the file")
        ids.add(entry.id)
    rules = tuple(entry.rule for entry in file.rules)
    by_topic: dict[str, tuple[Rule, ...]] = {}
    for rule in rules:
        if rule.binds == "car":
            by_topic[rule.topic] = (*by_topic.get(rule.topic, ()), rule)
    return replace(_bare(head), rules=rules, by_topic=by_topic)


def _bare(head: CountryEntry | RegionEntry) -> Jurisdiction:
    if isinstance(head, RegionEntry):
        return Jurisdiction(head.code, head.name, head.status, head.within, head.kind, head.polygon)
    return Jurisdiction(
        head.code,
        head.name,
        head.status,
        driving_side=head.driving_side,
        speed_unit=head.speed_unit,
        temperature_unit=head.temperature_unit,
        emergency=head.emergency,
    )
