"""JSON Schemas of what users write and of bundles, as shipped; ``make`` renews them from the types that read it."""

from __future__ import annotations

import json
from importlib.resources import files

from automotive_cosim.errors import UnknownNameError

SUFFIX = ".schema.json"


def names() -> tuple[str, ...]:
    """The formats that have one."""
    found = (entry.name for entry in files(__name__).iterdir())
    return tuple(sorted(name.removesuffix(SUFFIX) for name in found if name.endswith(SUFFIX)))


def text(name: str) -> str:
    """A schema as it is shipped. Raises UnknownNameError: there is none of that name."""
    if name not in names():
        raise UnknownNameError("schema", name, names(), "automotive-cosim show schema")
    return (files(__name__) / f"{name}{SUFFIX}").read_text(encoding="utf-8")


def about(name: str) -> str:
    """What a schema is of, in a line. Raises UnknownNameError: there is none of that name."""
    return str(json.loads(text(name))["description"])
