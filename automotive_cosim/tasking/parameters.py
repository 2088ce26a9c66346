"""Parameters of a task: values drawn for an instance, and their placeholders until then.

A task is written once with ``param("degrees")`` wherever the drawn value belongs, and ``"{degrees}"`` inside texts;
``bind`` fills both in. What a driver says may differ from what a signal takes: ``param("seat", {"my": 0, "her":
1})`` maps the one to the other.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from string import Formatter
from typing import Any, TypeVar

T = TypeVar("T")

Parameter = str | int | float
KEEP = object()
"""What ``rebuilt`` leaves as it is, but for its parts."""


@dataclass(frozen=True, slots=True)
class Param:
    """Placeholder for a drawn value, or with ``means`` for what that value means."""

    name: str
    means: Mapping[Any, Any] | None = None

    def value(self, parameters: Mapping[str, Parameter]) -> Any:
        """Its value in an instance."""
        drawn = parameters[self.name]
        return drawn if self.means is None else self.means[drawn]

    def __str__(self) -> str:
        return f"{{{self.name}}}"

    def __format__(self, spec: str) -> str:
        return str(self)

    __repr__ = __str__


@dataclass(frozen=True, slots=True)
class FromCockpit:
    """A parameter drawn from this cockpit's content: see ``Cockpit.content``."""

    kind: str
    """Kind of content, e.g. ``contacts``, ``stations``, ``places``."""


Choices = tuple[Parameter, ...] | FromCockpit


def param(name: str, means: Mapping[Any, Any] | None = None) -> Any:
    """A placeholder for the parameter, wherever a value is expected; ``Any`` because ``bind`` replaces it."""
    return Param(name, means)


def bind(value: T, parameters: Mapping[str, Parameter]) -> T:
    """The value with every parameter in it filled in: in dataclasses, tuples, sets, mappings and texts.

    Raises KeyError: it names a parameter that does not exist."""

    def filled(part: Any) -> Any:
        if isinstance(part, Param):
            found = part.value(parameters)
            return found if part.means is None else rebuilt(found, filled)  # which may name another one
        return part.format_map(parameters) if isinstance(part, str) and "{" in part else KEEP

    bound: Any = rebuilt(value, filled)
    return bound  # type: ignore[no-any-return]


def rebuilt(value: Any, change: Callable[[Any], Any]) -> Any:
    """The value with every part changed for which ``change`` returns something else than ``KEEP``: in dataclasses,
    tuples, sets and mappings. What it returns is not searched."""
    changed = change(value)
    if changed is not KEEP:
        return changed
    if isinstance(value, tuple | frozenset):
        return type(value)(rebuilt(entry, change) for entry in value)
    kind: Any = type(value)
    names = _field_names(kind)
    if names is not None:
        now = {name: getattr(value, name) for name in names}
        then = {name: rebuilt(entry, change) for name, entry in now.items()}
        differing = {name: entry for name, entry in then.items() if entry != now[name]}
        return replace(value, **differing) if differing else value
    if isinstance(value, Mapping):
        return {rebuilt(key, change): rebuilt(entry, change) for key, entry in value.items()}
    return value


@cache
def _field_names(of: type) -> tuple[str, ...] | None:
    """What a dataclass is made of; None if it is none."""
    return tuple(field.name for field in fields(of) if field.init) if is_dataclass(of) else None


def named_in(text: str) -> Iterator[str]:
    """The names in braces in a text.

    Raises ValueError: what stands in braces is more than a name, and how a number is written: an attribute, a
    width."""
    for _, name, width, conversion in _PARSE(text):
        if name is not None:
            if conversion or not _NAME.fullmatch(name) or not _FORM.fullmatch(width or ""):
                more = ", and more" if width or conversion else ""
                raise ValueError(f"has {name[:60]!r} in braces{more}; expected a name, or a number as {{name:.1f}}")
            yield name


_PARSE = Formatter().parse
_NAME = re.compile(r"\w{1,100}")
_FORM = re.compile(r"|\.[0-3]f|g|d")
"""How a number may be written. A width would fill memory."""


def names(value: object) -> frozenset[str]:
    """The names of the parameters in a value. Raises ValueError: as in ``named_in``."""
    asked = set[str]()
    parts: list[Any] = [value]
    seen: set[int] = set()  # the many shared parts of a catalogue are searched once
    while parts:
        part = parts.pop()
        if isinstance(part, str):
            if "{" in part:
                asked.update(named_in(part))
        elif isinstance(part, Param):
            asked.add(part.name)
            parts.append(part.means)
        elif id(part) not in seen:
            seen.add(id(part))
            if isinstance(part, tuple | frozenset):
                parts += part
            elif is_dataclass(part) and not isinstance(part, type):
                parts += (getattr(part, field.name) for field in fields(part))
            elif isinstance(part, Mapping):
                parts += part.keys()
                parts += part.values()
    return frozenset(asked)
