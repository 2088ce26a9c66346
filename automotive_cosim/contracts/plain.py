"""Factors between units, JSON, numbers in texts, and how progress is told."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

KMH_PER_MPS = 3.6
MPH_PER_MPS = 3600 / 1609.344

Json = dict[str, Any]
"""A JSON object: the edge of the package, where types end."""

Tell = Callable[[str, float | None], None]
"""Told what is being done, and the share of it that is done (0 to 1), None where that is not known."""


def counted(number: int, noun: str, plural: str = "") -> str:
    """A number with its noun: ``1 step``, ``2,460 episodes``; ``plural`` is for nouns that add more than an "s"."""
    return f"{number:,} {noun if number == 1 else plural or noun + 's'}"


def megabytes_in_words(size_mb: float) -> str:
    """A size to a tenth of a megabyte, never as zero."""
    return "less than 0.1 MB" if size_mb < 0.1 else f"{size_mb:,.1f} MB"
