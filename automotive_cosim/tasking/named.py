"""Conditions and checks that are written as functions: each is kept in a table by its name, with what it is called.

What such a function makes is its name with its values, so it can be compared, stored and told in words.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from inspect import Parameter, signature
from typing import Any, NamedTuple, TypeVar

N = TypeVar("N", bound="Named")
Wording = str | Callable[..., str]
"""What it is called, with its values in braces, or what makes that of them."""


class NamedRow(NamedTuple):
    """What is known of a name."""

    holds: Callable[..., bool]
    words: Wording
    writes: Callable[..., frozenset[str]]
    made: Callable[..., Named]
    """Makes it of its values."""
    values: tuple[str, ...]
    needed: tuple[str, ...]
    """Those without a default."""


ROWS: dict[str, NamedRow] = {}
"""Every condition and check by its name."""


@dataclass(frozen=True, slots=True)
class Named:
    """One of ``ROWS`` with its values."""

    name: str
    values: tuple[Any, ...] = ()

    def __str__(self) -> str:
        row = ROWS[self.name]
        if callable(row.words):
            return row.words(*self.values)
        return row.words.format_map(dict(zip(row.values, self.values, strict=True)))


def keep(
    kind: type[N], holds: Callable[..., bool], given: int, words: Wording, writes: Callable[..., frozenset[str]]
) -> Callable[..., N]:
    """Keeps a function in the table; returns what makes it of its values.

    Args:
        kind: what is made.
        given: how many arguments come before the values.
        writes: of the values, see ``Check.writes``."""
    name, asked = holds.__name__.rstrip("_"), signature(holds)
    own = asked.replace(parameters=list(asked.parameters.values())[given:])

    @wraps(holds)
    def made(*values: Any, **named: Any) -> N:
        found = own.bind(*values, **named)
        found.apply_defaults()
        return kind(name, found.args)

    made.__name__ = name  # without the line of a name that is a word of Python
    needed = tuple(each for each, value in own.parameters.items() if value.default is Parameter.empty)
    ROWS[name] = NamedRow(holds, words, writes, made, tuple(own.parameters), needed)
    return made
