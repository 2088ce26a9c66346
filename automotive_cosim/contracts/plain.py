"""Factors between units, JSON, numbers in texts, and how progress is told."""

from __future__ import annotations

from collections.abc import Callable
from math import floor, isfinite, log10
from typing import Any

KMH_PER_MPS = 3.6
MPH_PER_MPS = 3600 / 1609.344

RARE = {"rare": True}
"""Metadata of a field that traces leave out where it is None: it came later than traces on record."""

UNTRACED = {"untraced": True}
"""Metadata of a field that traces leave out: judges may read it, and nothing simulated depends on it."""

Json = dict[str, Any]
"""A JSON object: the edge of the package, where types end."""

Tell = Callable[[str, float | None], None]
"""Told what is being done, and the share of it that is done (0 to 1), None where that is not known."""


def lon_lat(text: str) -> tuple[float, float] | None:
    """Longitude and latitude in degrees from ``"LON,LAT"``; None if it is something else.

    Raises ValueError: they are two numbers, but no place on earth; the message says so."""
    try:
        lon_deg, lat_deg = map(float, text.split(","))
    except ValueError:
        return None
    if not (abs(lon_deg) <= 180 and abs(lat_deg) <= 90):
        raise ValueError(
            f"{text[:80]!r} is not a position on earth; give LON,LAT in degrees, such as 2.3522,48.8566"
        )
    return lon_deg, lat_deg


def counted(number: int, noun: str, plural: str = "") -> str:
    """A number with its noun: ``1 step``, ``2,460 episodes``; ``plural`` is for nouns that add more than an "s"."""
    return f"{number:,} {noun if number == 1 else plural or noun + 's'}"


def model_and_options(spec: str) -> tuple[str, list[str]]:
    """The name of a model as people read it, and its options without the prices, which change nothing that it does:
    ``provider/model?temperature=0.5&usd_per_million_in=2`` is ``provider/model`` and ``temperature=0.5``."""
    name, _, query = spec.partition("?")
    return name, [each for each in query.split("&") if each and not each.startswith("usd_per_")]


def clock(seconds: float) -> str:
    """A span of time as ``3:05`` or ``1:03:05``."""
    minutes, rest = divmod(int(seconds), 60)
    told = f"{minutes // 60}:{minutes % 60:02d}" if minutes >= 60 else f"{minutes}"
    return f"{told}:{rest:02d}"


def rounded(value: float, digits: int = 3) -> str:
    """A number to so many significant digits as people write it: ``340``, ``0.0012``, never ``3.4e+02``."""
    if not isfinite(value) or value == 0:
        return f"{value:g}"
    places = max(0, digits - 1 - floor(log10(abs(value))))
    told = f"{float(f'{value:.{digits - 1}e}'):,.{places}f}"
    return told.rstrip("0").rstrip(".") if "." in told else told


def megabytes_in_words(size_mb: float) -> str:
    """A size to a tenth of a megabyte, never as zero."""
    return "less than 0.1 MB" if size_mb < 0.1 else f"{size_mb:,.1f} MB"
