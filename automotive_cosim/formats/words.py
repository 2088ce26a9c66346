"""Words of an error message: what came, and what a JSON Schema expects instead."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from datetime import date, time
from fnmatch import fnmatchcase
from reprlib import Repr
from typing import Any

from automotive_cosim.contracts import Json
from automotive_cosim.formats import bounds

_SHORT = Repr()
_SHORT.maxstring = _SHORT.maxother = 60
_SHORT.maxlist = _SHORT.maxdict = 4
_SHORT.maxlevel = 3


def shown(value: object) -> str:
    """What came, cut to a readable length."""
    match value:
        case None:
            return "null"
        case "" | [] | ():
            return "empty"
        case bool():
            return "true" if value else "false"
        case date() | time():
            return value.isoformat()
    try:
        return _SHORT.repr(value)
    except ValueError:  # Python does not print integers of more than 4300 digits
        return "a number too long to print"


def members(schema: Json, root: Json) -> Iterator[Json]:
    """The schemas that a value may fit, with references and unions resolved and without ``null``."""
    if "$ref" in schema:
        yield from members(root["$defs"][schema["$ref"].rpartition("/")[2]], root)
    elif "properties" not in schema and (union := schema.get("anyOf") or schema.get("oneOf")):
        for member in union:
            yield from members(member, root)
    elif schema.get("type") != "null":
        yield schema


def choices(schema: Json) -> list[Any]:
    """The only valid values, if they are listed."""
    return [schema["const"]] if "const" in schema else list(schema.get("enum", ()))


def matches(name: str, pattern: str) -> bool:
    """Whether a name fits a pattern with ``*`` and ``?``; one that is longer than any name fits none."""
    return len(pattern) <= bounds.PATTERN and fnmatchcase(name, pattern)


def expected(schemas: Sequence[Json], root: Json) -> str:
    """What a value must be, such as ``"a number from 0 to 1"`` or ``"a list of texts, at least 1"``.

    Args:
        schemas: the ``members`` that it may fit.
        root: the schema in which references are resolved."""
    return " or ".join(dict.fromkeys(_one(schema, root) for schema in schemas))


def _one(schema: Json, root: Json) -> str:
    kind = schema.get("type")
    if legal := choices(schema):
        return ("one of " if len(legal) > 1 else "") + ", ".join(map(shown, legal))
    if "title" in schema and kind != "object":
        return str(schema["title"])
    match kind:
        case "integer":
            return f"a whole number{_range(schema)}"
        case "number":
            return f"a number{_range(schema)}"
        case "string":
            return _text(schema)
        case "boolean":
            return "true or false"
        case "array":
            return _list(schema, root)
        case _:
            return "a table"


def _range(schema: Json) -> str:
    if "minimum" in schema and "maximum" in schema:
        return f" from {schema['minimum']} to {schema['maximum']}"
    words = {
        "minimum": "of at least",
        "exclusiveMinimum": "above",
        "maximum": "at most",
        "exclusiveMaximum": "below",
    }
    bounds = [f"{word} {schema[bound]}" for bound, word in words.items() if bound in schema]
    return " " + " and ".join(bounds) if bounds else ""


def _text(schema: Json) -> str:
    if schema.get("format") == "date":
        return "a date such as 2026-03-31"
    if "examples" in schema:
        return f"of the form {schema['examples'][0]}"
    return "a text that is not empty" if "minLength" in schema else "a text"


def _list(schema: Json, root: Json) -> str:
    items, least, most = schema.get("items", {}), schema.get("minItems"), schema.get("maxItems")
    item = expected(list(members(items[0] if isinstance(items, list) else items, root)), root)
    item = re.sub(r"^a ((?:whole )?\w+)", r"\1s", item).replace("one of", "any of", 1)
    if least is not None and least == most:
        return f"a list of {most} {item}"
    return f"a list of {item}" + {None: "", 1: ", not empty"}.get(least, f", at least {least} of them")
