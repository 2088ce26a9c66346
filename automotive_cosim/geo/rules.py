"""Traffic rules as the program holds them; ``rulefile`` reads them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date
from enum import StrEnum
from functools import cached_property

import shapely

from automotive_cosim.formats.shipped import shipped_table
from automotive_cosim.geo.rulefacts import RuleFacts, Test, all_hold

Value = float | str


class Status(StrEnum):
    """How well a rule is supported."""

    VERIFIED = "verified"
    """The law's own text was read."""
    SECONDARY = "secondary"
    """A summary by press, trade or an authority."""
    KNOWLEDGE = "knowledge"
    """General knowledge, not looked up."""
    UNCERTAIN = "uncertain"
    """Known to be unsettled: pending, annulled or contradictory."""


_TOPICS = shipped_table("geo", "topics.toml")
TOPICS: Mapping[str, str] = {topic: told["title"] for topic, told in _TOPICS.items()}
"""Every topic of rules, and how the context prints it, in the context's order. ``heat`` and ``cold`` are customs of
drivers there, with ``law = "custom"``."""
ASKED: Mapping[str, frozenset[str]] = {
    topic: frozenset(told.get("asked", "").split()) for topic, told in _TOPICS.items()
}
"""The words that ask for a topic."""

ANSWERS = frozenset(("required", "allowed", "forbidden", "not_required", "advised", "applies"))
"""Values of a rule other than a number with a unit; a limit may also be ``none``."""

UNITS = frozenset(("km/h", "mph", "s", "m", "g/L", "min"))

USERS = frozenset(("car", "novice", "professional", "truck", "motorcycle"))
"""Road users that a rule may bind. The context states the rules for ordinary car drivers."""


@dataclass(frozen=True, slots=True)
class Case:
    """A rule's answer under conditions that must all hold."""

    value: Value
    when: tuple[Test, ...] = ()


@dataclass(frozen=True)
class Rule:
    """One statement of the law. What follows from its fields alone is worked out once."""

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
    """For a limit: whether it also lowers a higher limit posted by a sign."""
    on_request: bool = False
    """Whether the context's text leaves it out; queries are answered with it."""

    @property
    def country(self) -> str:
        """ISO 3166-1 code."""
        return self.id[:2]

    @cached_property
    def fixed(self) -> bool:
        """Whether its answer depends on place, road and date alone."""
        return all(test.fixed for test in self.tests)

    @cached_property
    def tests(self) -> tuple[Test, ...]:
        """The conditions of all its cases."""
        return tuple(test for case in self.cases for test in case.when)

    @property
    def said(self) -> str:
        """The rule in words, with its value if it has only one."""
        value = self.cases[0].value if len(self.cases) == 1 else ""
        amount = f"{value:g} {self.unit} " if isinstance(value, float) else ""
        if self.topic == "limit" and value == "none":
            amount = "none "
        return f"{amount}{self.text}"

    @cached_property
    def stated(self) -> str:
        """The same with its source."""
        return f"{self.said} ({self.country} {self.law}, {self.status} {self.as_of})"

    @cached_property
    def line(self) -> str:
        """The same after its topic, as the context prints it."""
        return f"{TOPICS[self.topic]}: {self.stated}"

    @cached_property
    def _lasting(self) -> tuple[tuple[Test, ...], ...]:
        """Of each case, the conditions on place, road and date."""
        return tuple(tuple(test for test in case.when if test.fixed) for case in self.cases)

    def answer(self, facts: RuleFacts) -> tuple[Value | None, bool]:
        """The rule's answer here and now.

        Returns:
            (value, certain). (None, True): it does not apply. If not certain, the facts do not determine the
            case, and the value is the first possible one."""
        for case in self.cases:
            holds = all_hold(case.when, facts)
            if holds is not False:
                return case.value, bool(holds)
        return None, True

    def may_apply(self, facts: RuleFacts) -> bool | None:
        """Whether place, road and date allow a case: True, False, or None if they do not determine it."""
        found: bool | None = False
        for tests in self._lasting:
            holds = all_hold(tests, facts)
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
    """Status of the fields here that are not rules."""
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
