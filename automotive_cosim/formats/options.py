"""How the fields of a type are given on the command line, where a message must name the option."""

from __future__ import annotations

from typing import Any, get_type_hints

from automotive_cosim.formats.annotations import Option

UNITS = ("_s",)
"""Units that the name of a field has, but not that of its option: the help says it."""
PLAIN = Option()


def option(kind: type, field: str) -> str:
    """The option of a field, such as ``--warm-up`` of ``warm_up_s``."""
    return f"--{shown_as(get_type_hints(kind, include_extras=True)[field]).name or plain_name(field)}"


def shown_as(hint: Any) -> Option:
    """What an annotation says about the option."""
    return next((each for each in getattr(hint, "__metadata__", ()) if isinstance(each, Option)), PLAIN)


def plain_name(field: str) -> str:
    """The name of an option whose field says nothing else."""
    for unit in UNITS:
        field = field.removesuffix(unit)
    return field.replace("_", "-")
