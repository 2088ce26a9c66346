"""Compares the default limits of the rule files with an independent table, and prints every disagreement.

    python benchmarks/default_limits.py legal_default_speeds.json

The table is the JSON that https://github.com/westnordost/osm-legal-default-speeds makes from the OpenStreetMap
wiki's page "Default speed limits" (CC BY-SA 2.0). It is not shipped: download it yourself. A disagreement is a
question, not an answer: the law's own text decides; once it has been read, its rule gets the status ``verified``.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from automotive_cosim.geo.applied import AppliedRule, limits
from automotive_cosim.geo.place import Atlas, Place, shipped
from automotive_cosim.geo.rulefacts import COUNTRY_ROAD, RuleFacts
from automotive_cosim.geo.text import KM_PER_MILE

MOTORWAY = replace(COUNTRY_ROAD, road_class="motorway", motorway=True, dual_carriageway=True, lanes=2)
DUAL = replace(COUNTRY_ROAD, road_class="trunk", dual_carriageway=True, lanes=2)
ROADS: Mapping[str, RuleFacts] = {
    "living street": replace(COUNTRY_ROAD, road_class="living_street", built_up=True),
    "urban": replace(COUNTRY_ROAD, built_up=True),
    "rural": COUNTRY_ROAD,
    "dual carriageway": DUAL,
    "rural dual carriageway": DUAL,
    "rural road with 2 or more lanes in each direction": replace(COUNTRY_ROAD, lanes=2),
    "motorroad": replace(COUNTRY_ROAD, road_class="trunk", expressway=True),
    "motorway": MOTORWAY,
    "Italy: Autostrada": MOTORWAY,
    "Italy: Strada extraurbana principale": DUAL,
}
"""The table's types of roads that the rules can tell apart."""

WALK_KMH = 7.0


class Compared(NamedTuple):
    """One limit in both sources."""

    code: str
    road: str
    here: AppliedRule | None
    """None: not certain."""
    there: str
    """As in OpenStreetMap; ``"none"`` without a limit."""

    @property
    def outcome(self) -> str:
        """``"same"``, ``"different"`` or ``"not certain here"``."""
        if self.here is None:
            return "not certain here"
        value = self.here.value
        kmh = None if isinstance(value, str) or value is None else value * _scale(self.here.rule.unit)
        return "same" if kmh == _kmh(self.there) else "different"

    def __str__(self) -> str:
        if self.here is None:
            return f"{self.code} {self.road}: not certain here, {self.there} there"
        value = self.here.value
        amount = f"{value:g} {self.here.rule.unit}" if isinstance(value, float) else str(value)
        rule = self.here.rule
        return f"{self.code} {self.road}: {amount} here ({rule.id}, {rule.status}), {self.there} there"


def compared(table: Mapping[str, Any], atlas: Atlas) -> Iterator[Compared]:
    """Every limit of the table for a country, or a region of one, that has a file here."""
    for code, roads in sorted(table["speedLimitsByCountryCode"].items()):
        layers = tuple(entry for entry in atlas.country(code[:2]) if entry.code in (code, code[:2]))
        if code not in {entry.code for entry in layers}:
            continue
        for road in roads:
            name = road.get("name") or "rural"
            if name in ROADS:
                found = [one for one in limits(Place(code[:2], layers=layers), ROADS[name]) if one.rule.fixed]
                here = found[0] if len(found) == 1 and found[0].certain else None
                yield Compared(code, name, here, road["tags"].get("maxspeed", "none"))


def _kmh(sign: str) -> float | None:
    if sign == "none":
        return None
    if sign == "walk":
        return WALK_KMH
    number, _, unit = sign.partition(" ")
    return float(number) * _scale(unit)


def _scale(unit: str) -> float:
    return KM_PER_MILE if unit == "mph" else 1.0


def main() -> None:
    """Prints the disagreements, how many limits were compared, and which places could not be."""
    if len(sys.argv) != 2:
        raise SystemExit("give the table: python benchmarks/default_limits.py legal_default_speeds.json")
    table = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    outcomes = Counter[str]()
    for one in dict.fromkeys(compared(table, shipped())):
        outcomes[one.outcome] += 1
        if one.outcome != "same":
            print(one)
    print(", ".join(f"{outcome}: {count}" for outcome, count in outcomes.most_common()))
    missing = sorted(set(table["speedLimitsByCountryCode"]) - set(shipped().codes()))
    print(f"{len(missing)} countries and regions of the table have no rules here: {', '.join(missing)}")
    print(f"table of {table['meta'].get('timestamp', 'an unknown date')}, {table['meta'].get('source', '')}")


if __name__ == "__main__":
    main()
