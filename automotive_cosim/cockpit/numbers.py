"""Numbers in what agents give: a number, or the text of one."""

from __future__ import annotations

from math import isfinite
from typing import Any

LONGEST_NUMBER = 40
"""Characters of a number's text; longer ones are no numbers."""


def number_in(value: Any, most: float) -> float | None:
    """A number from an int, a float or its text; None if it is none.

    Args:
        most: what is farther from zero becomes this: a float may not hold it.
    """
    if isinstance(value, str):
        try:
            value = float(value) if len(value) <= LONGEST_NUMBER else None
        except ValueError:
            return None
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    if isinstance(value, float) and not isfinite(value):
        return None
    return float(min(max(value, -most), most))


def whole_in(value: Any, most: float) -> int | None:
    """The same of a whole number, also from a float that holds one."""
    number = number_in(value, most)
    return int(number) if number is not None and number.is_integer() else None
