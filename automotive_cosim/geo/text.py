"""Lines of text for an agent: their sources, how many fit, and amounts in words."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from math import ceil

BUDGET_TOKENS = 1500
"""Enough for every line of the countries that have most."""

CHARACTERS_PER_TOKEN = 4
"""A usual estimate for English; models count differently."""

KM_PER_MILE = 1.609344


@dataclass(frozen=True, slots=True)
class Line:
    """One line of the text.

    ``source`` is the id of the rule it states, or ``place``, ``gps``, ``road``, ``motion``, ``sky``, ``weather``,
    ``traffic`` or ``climate``."""

    text: str
    source: str


def within_budget(all_lines: Iterable[Line], budget_tokens: int) -> str:
    """The first lines that together take at most ``budget_tokens``, at four characters per token. A line break in a
    name of the map does not make a second line."""
    kept: list[str] = []
    tokens = 0
    for line in all_lines:
        text, cost = _on_one_line(line.text)
        tokens += cost
        if tokens > budget_tokens:
            break
        kept.append(text)
    return "\n".join(kept)


@lru_cache(maxsize=1024)
def _on_one_line(text: str) -> tuple[str, int]:
    """The text, and its tokens. Cached, because most lines are the same from second to second."""
    return " ".join(text.split()), ceil((len(text) + 1) / CHARACTERS_PER_TOKEN)


def position(lon_deg: float, lat_deg: float) -> str:
    """A position in words."""
    return f"{_degrees(lat_deg, 'N', 'S')} {_degrees(lon_deg, 'E', 'W')}"


def _degrees(value: float, positive: str, negative: str) -> str:
    return f"{abs(value):.4f}°{negative if value < 0 else positive}"


def amount_of_speed(kmh: float, unit: str) -> str:
    """A speed in words, in ``"km/h"`` or ``"mph"``."""
    return f"{kmh / KM_PER_MILE if unit == 'mph' else kmh:.0f} {unit}"
