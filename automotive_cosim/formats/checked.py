"""Turns values that a user wrote into an instance of a type, or refuses them in our own words.

pydantic checks them strictly as JSON, so whatever passes here also passes the type's JSON Schema. That schema also
provides the words: what a refusal expects is what an editor shows.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from datetime import date, time
from difflib import get_close_matches
from numbers import Integral, Real
from os import PathLike
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from automotive_cosim.contracts import Json
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.words import choices, expected, members, shown

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails

T = TypeVar("T")
Steps = tuple[str | int, ...]
"""The path to a value: keys of tables and indices of lists."""
Locator = Callable[[Steps], tuple[str, str]]
"""Gives the place of a value, such as ``"plan.toml line 12 [limits]"``, and its name there."""

LARGEST = 1e10
"""No quantity in a file, in any of our units, is beyond it either way; a computation with such a number could end
in infinities."""
MOST_PROBLEMS = 8
"""Most problems reported at once."""
MOST_COMPLAINTS = 200
"""Looked at; where pydantic has more of them the first are as good."""


def checked(kind: type[T], values: object, place: Locator, error: type[UserError] = UserError) -> T:
    """Turns values into an instance of a type.

    Args:
        kind: a dataclass whose annotations state what is valid (``annotations``).
        values: tables, lists, texts, numbers, dates, as in TOML and JSON.
        error: the class to raise, with one line per problem.

    Raises UserError: of the given class."""
    from pydantic import ValidationError

    from automotive_cosim.formats.schema import adapter, json_schema

    any_kind: Any = kind  # mypy takes no type for hashable, as a cache wants it
    try:
        made: T = adapter(any_kind).validate_json(as_json(values))
    except ValidationError as refused:
        complaints = refused.errors(include_url=False, include_input=False)
        raise error(*_told(complaints[:MOST_COMPLAINTS], json_schema(any_kind), values, place)) from None
    except (RecursionError, TypeError, ValueError) as broken:
        why = "it is nested too deeply" if isinstance(broken, RecursionError) else str(broken)
        raise error(f"{place(())[0]} cannot be read: {why}") from broken
    if far := [steps for steps, number in _numbers(values) if abs(number) > LARGEST]:
        told = [f"{where}: {name} is beyond {LARGEST:g}" for where, name in map(place, far[:MOST_PROBLEMS])]
        raise error(*dict.fromkeys(told))
    return made


def _numbers(values: object, steps: Steps = ()) -> Iterator[tuple[Steps, float]]:
    """Every number, with the path to it."""
    match values:
        case bool():
            pass
        case int() | float():
            yield steps, values
        case Mapping():
            for key, value in values.items():
                yield from _numbers(value, (*steps, str(key)))
        case list() | tuple():
            for index, value in enumerate(values):
                yield from _numbers(value, (*steps, index))


def as_json(values: object) -> str:
    """The values as a schema sees them: dates and times are texts.

    Raises:
        TypeError: something in them is nothing that a file can hold.
        RecursionError: they are nested too deeply."""
    return json.dumps(values, default=_plain)


def _plain(value: object) -> str | int | float:
    """What JSON has no word for: TOML's dates, and paths and numpy's numbers where a program gives the values."""
    match value:
        case date() | time():
            return value.isoformat()
        case PathLike():
            return str(value)
        case Integral():
            return int(value)
        case Real():
            return float(value)
    raise TypeError(f"{shown(value)} is nothing that a file can hold")


class _Problem(NamedTuple):
    """A problem: the value, its place, and the schemas that it should fit."""

    kind: str
    steps: Steps
    value: object
    schemas: list[Json]
    reason: str = ""


def _told(found: Sequence[ErrorDetails], root: Json, values: object, place: Locator) -> list[str]:
    """One line per problem, in the order of the type's fields."""
    problems: dict[Steps, _Problem] = {}
    for entry in found:
        problem = _problem(entry, values, root)
        problems.setdefault(problem.steps, problem)
    # Every member of a union reports problems; the one that got deepest is the one that was meant.
    meant = [one for one in problems.values() if not any(_leads(one.steps, other) for other in problems)]
    told = list(dict.fromkeys(_line(problem, meant, root, place) for problem in meant))
    more = len(told) - MOST_PROBLEMS
    return told if more <= 0 else [*told[:MOST_PROBLEMS], f"{place(())[0]}: and {more} more"]


def _leads(steps: Steps, other: Steps) -> bool:
    return len(steps) < len(other) and other[: len(steps)] == steps


def _problem(entry: ErrorDetails, values: object, root: Json) -> _Problem:
    """A problem from pydantic, whose location also names the members of unions that it tried."""
    kind, context, location = entry["type"], entry.get("ctx", {}), entry["loc"]
    if kind == LACKING and isinstance(location[-1], int):  # a list is too short
        kind, location = "too_short", location[:-1]
    steps: Steps = ()
    value, schemas = values, list(members(root, root))
    for part in location[:-1] if kind in (LACKING, *SURPLUS) else location:
        if isinstance(part, int) or (isinstance(value, Mapping) and part in value):
            steps, value, schemas = (*steps, part), value[part], list(_below(schemas, part, root))  # type: ignore[index]
        else:
            schemas = [schema for schema in schemas if part in _labels(schema)] or schemas
    if kind in SURPLUS:
        return _Problem(kind, (*steps, location[-1]), None, schemas)
    if kind == LACKING:
        return _Problem(kind, (*steps, location[-1]), None, list(_below(schemas, location[-1], root)))
    if kind.startswith("union_tag") and isinstance(value, Mapping):
        tag = context["discriminator"].strip("'")
        kind, inner = ("", value[tag]) if tag in value else (LACKING, None)
        return _Problem(kind, (*steps, tag), inner, list(_below(schemas, tag, root)))
    reason = str(context["error"]) if kind == "value_error" else entry["msg"]
    return _Problem(kind, steps, value, schemas, reason)


LACKING = "missing"
SURPLUS = ("unexpected_keyword_argument", "extra_forbidden")


def _below(schemas: Sequence[Json], part: str | int, root: Json) -> Iterator[Json]:
    """The schemas of a table's field or of a list's item."""
    for schema in schemas:
        if isinstance(part, str):
            inner = schema.get("properties", {}).get(part)
        else:
            items = schema.get("items")
            inner = items[part] if isinstance(items, list) else items
        if inner is not None:
            yield from members(inner, root)


def _labels(schema: Json) -> set[object]:
    """Pydantic's name for a member of a union."""
    return {schema.get("title"), *(field.get("const") for field in schema.get("properties", {}).values())}


def _line(problem: _Problem, together: Sequence[_Problem], root: Json, place: Locator) -> str:
    kind, steps, value, schemas, reason = problem
    if kind == "json_invalid":
        return f"{place(())[0]} cannot be read: {'it is nested too deeply' if 'recursion' in reason else reason}"
    where, name = place(steps)
    if kind == LACKING:
        where, table = place(steps[:-1])
        absent = [str(one.steps[-1]) for one in together if one.kind == kind and one.steps[:-1] == steps[:-1]]
        give = f"; give {expected(schemas, root)}" if len(absent) == 1 else ""
        return f"{where}{f': {table}' if table else ''} lacks {', '.join(map(repr, absent))}{give}"
    if kind in SURPLUS:
        table = place(steps[:-1])[1]
        known = {field for schema in schemas for field in schema.get("properties", ())}
        return f"{where}: {UnknownNameError(f'field of {table}' if table else 'field', str(steps[-1]), known)}"
    if kind == "value_error":
        return f"{where}: {f'{name} is {shown(value)}: ' if name else ''}{reason}"
    field = next((step for step in reversed(steps) if isinstance(step, str)), "value")
    legal = [choice for schema in schemas for choice in choices(schema) if isinstance(choice, str)]
    if isinstance(value, str) and legal and (all(map(choices, schemas)) or get_close_matches(value, legal, 1, 0.5)):
        what = next((schema["title"] for schema in schemas if "title" in schema), field)
        return f"{where}: {UnknownNameError(what, value, legal, whole=True)}"
    return f"{where}{f': {name}' if name else ''} is {shown(value)}; it must be {expected(schemas, root)}"
