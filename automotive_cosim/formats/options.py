"""How the fields of a type are given on the command line, where a message must name the option."""

from __future__ import annotations

from typing import Any, get_type_hints

from automotive_cosim.formats.annotations import Option

UNIT = "_s"
"""The unit that the name of a field has, but not that of its option: the help says it."""
PLAIN = Option()


def option(kind: type, field: str) -> str:
    """The option of a field, such as ``--warm-up`` of ``warm_up_s``."""
    return f"--{option_name(field, get_type_hints(kind, include_extras=True)[field])}"


def option_name(field: str, hint: Any) -> str:
    """The same without the dashes, of a field with this annotation."""
    return shown_as(hint).name or field.removesuffix(UNIT).replace("_", "-")


def shown_as(hint: Any) -> Option:
    """What an annotation says about the option."""
    return next((each for each in getattr(hint, "__metadata__", ()) if isinstance(each, Option)), PLAIN)
