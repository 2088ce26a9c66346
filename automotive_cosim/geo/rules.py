"""Traffic rules as the program holds them; ``rulefile`` reads them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from datetime import date
from enum import StrEnum

import shapely

from automotive_cosim.geo.situation import Situation, Test, all_hold

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
