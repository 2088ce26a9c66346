"""The shipped scenarios as lists tell of them: from their files as they stand, whose form tests hold them to."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path

HOME = Path(__file__).parents[1] / "sumo_scenarios"


def shipped() -> tuple[str, ...]:
    """Names of the scenarios that come with the package."""
    return tuple(sorted(path.parent.name for path in HOME.glob("*/scenario.toml")))


def listed() -> Iterator[tuple[str, str, str, str]]:
    """Name, country, title and ego trips of each; to check all that a file says takes longer than to list it."""
    for name in shipped():
        table = tomllib.loads((HOME / name / "scenario.toml").read_text(encoding="utf-8"))
        yield name, table["country"], table["title"], ", ".join(trip["name"] for trip in table["ego"]["trips"])
