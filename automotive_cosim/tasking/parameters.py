"""Parameters of a task: values drawn for an instance, and their placeholders until then.

A task is written once with ``param("degrees")`` wherever the drawn value belongs, and ``"{degrees}"`` inside texts;
``bind`` fills both in. What a driver says may differ from what a signal takes: ``param("seat", {"my": 0, "her":
1})`` maps the one to the other.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any, TypeVar

T = TypeVar("T")

Parameter = str | int | float


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

    Raises:
        KeyError: it names a parameter that does not exist.
    """
    bound: Any = _bound(value, parameters)
    return bound  # type: ignore[no-any-return]


def names(value: object) -> frozenset[str]:
    """The names of the parameters in a value."""

    class Asked(dict[str, Any]):
        def __missing__(self, name: str) -> Param:
            asked.add(name)
            return Param(name)

    asked: set[str] = set()
    _bound(_without_meanings(value), Asked())
    return frozenset(asked)


def _bound(value: Any, parameters: Mapping[str, Parameter]) -> Any:
    if isinstance(value, Param):
        found = value.value(parameters)
        return found if value.means is None else _bound(found, parameters)  # which may name another one
    if isinstance(value, str):
        return value.format_map(parameters) if "{" in value else value
    if isinstance(value, tuple | frozenset):
        return type(value)(_bound(entry, parameters) for entry in value)
    if isinstance(value, Mapping):
        return {_bound(key, parameters): _bound(entry, parameters) for key, entry in value.items()}
    if is_dataclass(value) and not isinstance(value, type):
        now = {field.name: getattr(value, field.name) for field in fields(value) if field.init}
        then = {name: _bound(entry, parameters) for name, entry in now.items()}
        changed = {name: entry for name, entry in then.items() if entry != now[name]}
        return replace(value, **changed) if changed else value
    return value


def _without_meanings(value: Any) -> Any:
    if isinstance(value, Param):
        return Param(value.name)
    if isinstance(value, tuple | frozenset):
        return tuple(_without_meanings(entry) for entry in value)
    if isinstance(value, Mapping):
        return tuple((_without_meanings(key), _without_meanings(entry)) for key, entry in value.items())
    if is_dataclass(value) and not isinstance(value, type):
        return tuple(_without_meanings(getattr(value, field.name)) for field in fields(value))
    return value
